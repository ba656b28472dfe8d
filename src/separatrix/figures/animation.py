"""One run of the cage as a moving picture: cage, balls, contact forces, path, time and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from separatrix.errors import InputError
from separatrix.figures.motion import (
    AROUND,
    frame_moments,
    land_boundary,
    milliseconds,
    pocket_boundary,
    ring,
    shown_parts,
    smooth_path,
)
from separatrix.figures.scene import BAR_POINTS, Scene, scene, turned
from separatrix.figures.simulation import draw_energy
from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION, Look, heading, journal, literal_texts
from separatrix.units import Array, format_number

Part = tuple[list[Artist], Callable[[int], None]]
"""What moves in a picture, and what puts it where it is in a frame."""

KINDS = ("gif", "mp4")
A_SECOND = 24
"""Frames of a film in a second."""

SIZE, DOTS = (7.6, 4.8), 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

SHADE = "#d8d8d8"
DRAWN = (BLACK, GREY, BLUE, SKY, VERMILION)
SHADES = 16
"""What is drawn with, for the colours of a GIF, and steps from each of these to white."""

TAIL, MOST_TAIL = 8, 4000
"""Frames and most samples for which the paths stay."""

DISC = ring(1.0, np.linspace(0.0, 2.0 * np.pi, 29)[:-1])
LIGHT = np.array([0.3, -0.5])


def animate(
    data: xr.Dataset,
    path: Path,
    *,
    kind: str | None = None,
    fixed: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Write a run as an animation; an interrupt leaves no file, and an older one as it was.

    Parameters
    ----------
    data : Dataset
        Of a simulation.
    path : Path
        File to write.
    kind : str or None
        "gif", or "mp4", which needs the extra `animation`; by default the ending of the file.
    fixed : bool
        Whether the picture is fixed in space; else it turns with the ball set.
    progress : callable, optional
        Called with (done, total) frames.
    """
    kind = path.suffix[1:].lower() if kind is None else kind
    if kind not in KINDS:
        raise InputError("The kind of an animation", f"must be {' or '.join(KINDS)}", got=f'"{kind}"')
    encoder = video_encoder() if kind == "mp4" else None
    data, moments = literal_texts(data), frame_moments(data)

    def film() -> Iterator[Image.Image]:
        for done, image in enumerate(pictures(data, moments, fixed=fixed), start=1):
            yield image
            if progress is not None:
                progress(done, moments.size)

    with journal(), _beside(path) as part:
        if encoder is None:
            _write_gif(film(), part)
        else:
            _write_mp4(encoder, film(), part)


def video_encoder() -> ModuleType:
    """Return the package that brings a video encoder along; refused where it is not installed."""
    try:
        import imageio_ffmpeg
    except ImportError as error:
        cure = "pip install 'separatrix[animation]', or take a GIF."
        raise InputError("An MP4", "needs the package imageio-ffmpeg", cure=cure) from error
    encoder: ModuleType = imageio_ffmpeg
    return encoder


@contextmanager
def _beside(path: Path) -> Iterator[Path]:
    """Give a file beside the wanted one, and put it in its place if all went well."""
    part = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _write_gif(film: Iterator[Image.Image], part: Path) -> None:
    colours = palette()
    images = (image.quantize(palette=colours, dither=Image.Dither.NONE) for image in film)
    how: Look = {"save_all": True, "duration": 1000 // A_SECOND, "loop": 0}
    with part.open("wb") as file:
        next(images).save(file, "GIF", append_images=images, **how)


def palette() -> Image.Image:
    """Return an image with the colours of a film: each one that is drawn, in steps up to white."""
    drawn = 255 * np.array([to_rgb(colour) for colour in DRAWN])
    share = np.linspace(0.0, 1.0, SHADES)[:, np.newaxis, np.newaxis]
    shades = np.round(share * drawn + (1 - share) * 255.0).astype(np.uint8).reshape(-1, 3)
    image = Image.new("P", (1, 1))
    image.putpalette(shades.tobytes())
    return image


def _write_mp4(encoder: ModuleType, film: Iterator[Image.Image], part: Path) -> None:
    first = next(film)
    try:
        pipe = encoder.write_frames(str(part), first.size, fps=A_SECOND, quality=7, macro_block_size=2)
        pipe.send(None)
        try:
            pipe.send(first.tobytes())
            for image in film:
                pipe.send(image.tobytes())
        finally:
            pipe.close()
    except (OSError, RuntimeError) as error:
        raise InputError("The MP4", "could not be encoded", cure="Take a GIF.") from error


def pictures(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Iterator[Image.Image]:
    """Return the picture of each moment: the cage, path of its centre and lean of its axis, energy."""
    at = scene(data, moments, fixed=fixed)
    figure = Figure(figsize=SIZE, dpi=DOTS)
    axes = figure.add_axes((0.0, 0.0, 0.64, 0.9))
    reach = 1.28 * (at.radius + at.ball)
    axes.set(xlim=(-reach, reach), ylim=(-0.9 * reach, 0.9 * reach), aspect="equal")
    axes.set_axis_off()
    body, faces = PolyCollection([]), at.faces()
    axes.add_collection(body)
    clock = figure.text(0.65, 0.895, "", fontsize=10, va="top")
    times, land = milliseconds(data)[moments], land_boundary(data)
    parts: list[Part] = [
        ([body], lambda frame: _pose(body, at, faces, frame)),
        ([clock], lambda frame: clock.set_text(f"{times[frame]:.3f} ms")),
        _energy(figure.add_axes((0.73, 0.1, 0.255, 0.16)), data, moments),
    ]
    pockets = pocket_boundary(data["pocket_angle"].values, data["half_play"].values)
    known = [(one, width) for one, width in ((land, 1.2), (pockets, 0.6)) if one is not None]
    boundaries = [
        (ring(np.where(np.isfinite(one), one, np.nan), AROUND), {"lw": width}) for one, width in known
    ]
    paths = [("position", "velocity", "centre [mm]", boundaries)]
    paths += [("lean", "lean_rate", "lean [mrad]", [])] if at.in_space else []
    for place, (name, rate, label, limits) in enumerate(paths):
        box = (0.72 + 0.15 * place, 0.36, 0.115, 0.19) if at.in_space else (0.74, 0.35, 0.2, 0.25)
        samples = [np.asarray(data[one].values, dtype=float) for one in ("time", name, rate)]
        parts.append(_path(figure.add_axes(box), samples, label, limits, at, moments))
    figure.text(0.01, 0.985, "\n".join(heading(data)), fontsize=6.5, va="top", linespacing=1.4)
    figure.text(0.65, 0.84, "\n".join(notes(data, at, moments)), fontsize=6.5, va="top", linespacing=1.4)
    return filmed(figure, parts, moments.size)


def filmed(figure: Figure, parts: Sequence[Part], count: int) -> Iterator[Image.Image]:
    """Yield frames of a figure; what does not move is drawn once."""
    canvas: Any = FigureCanvasAgg(figure)
    for artist in (artist for moving, _ in parts for artist in moving):
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    for frame in range(count):
        canvas.restore_region(still)
        for moving, move in parts:
            move(frame)
            for artist in moving:
                figure.draw_artist(artist)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _path(
    axes: Axes,
    samples: Sequence[Array],
    label: str,
    limits: Sequence[tuple[Array, Look]],
    at: Scene,
    moments: Array,
) -> Part:
    """Draw boundaries, the last frames of a path and its end, in mm or mrad; they turn in a fixed frame."""
    shapes = [samples[1], *(boundary for boundary, _ in limits)]
    far = [float(np.nan_to_num(np.hypot(*one.T)).max(initial=0.0)) for one in shapes]
    most = 1.15e3 * (max(one for one in far if one <= 3.0 * (far[0] or 1.0)) or 1e-9)
    axes.set(xlim=(-most, most), ylim=(-most, most), aspect="equal")
    axes.tick_params(labelsize=5.5, pad=1.5, length=2.0)
    axes.set_title(label, fontsize=6.5)
    outlines = [axes.plot([], [], color=GREY, **look)[0] for _, look in limits]
    (tail,) = axes.plot([], [], color=BLUE, lw=0.9)
    (dot,) = axes.plot([], [], "o", color=BLUE, ms=3.0)

    def move(frame: int) -> None:
        angle, last = at.frame[frame], int(moments[frame])
        first = max(int(moments[max(0, frame - TAIL)]), last - MOST_TAIL, 0)
        path = 1e3 * turned(smooth_path(*(sample[first : last + 1] for sample in samples)), angle)
        tail.set_data(*path.T)
        dot.set_data(*path[-1:].T)
        for outline, (boundary, _) in zip(outlines, limits, strict=True):
            outline.set_data(*(1e3 * turned(boundary, angle)).T)

    return [*outlines, tail, dot], move


def _energy(axes: Axes, data: xr.Dataset, moments: Array) -> Part:
    draw_energy(axes, data)
    if (legend := axes.get_legend()) is not None:
        legend.remove()
    parts = shown_parts(data, moments)
    for first, last in parts if len(parts) > 1 else ():
        axes.axvspan(first, last, color=SHADE, lw=0, zorder=0)
    time = milliseconds(data)[moments]
    energy = np.asarray(axes.lines[0].get_ydata(), dtype=float)[moments]
    (dot,) = axes.plot([], [], "o", color=BLACK, ms=4, clip_on=False)
    return [dot], lambda frame: dot.set_data([time[frame]], [energy[frame]])


def seen(points: Array, view: tuple[float, float], turn: float) -> tuple[Array, Array]:
    """Return points on the picture, shape (..., 2), and how near they are to the eye, shape (...)."""
    high, around = view
    c, s = np.cos(around + turn), np.sin(around + turn)
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    across, away = c * x - s * y, s * x + c * y
    up = np.cos(high) * z + np.sin(high) * away
    return np.stack([across, up], axis=-1), np.asarray(np.sin(high) * z - np.cos(high) * away)


def _pose(body: PolyCollection, at: Scene, faces: Array, frame: int) -> None:
    """Put cage, balls and lands where they are, from the farthest to the nearest."""
    turn = float(at.frame[frame])
    flat, near = seen(at.moved(faces, frame), at.view, turn)
    middle, depth = seen(at.ball_places(frame), at.view, turn)
    discs = middle[:, np.newaxis] + at.ball * DISC
    rings, ring_depth = _rings(at, turn)
    forces = zip((at.force[frame], at.land_force[frame]), at.largest, strict=True)
    shares = [np.sqrt(force / (most or 1.0)) for force, most in forces]
    cage, red = _shades(faces, turn), np.array(to_rgb(VERMILION))
    balls = np.ones(3) + shares[0][:, np.newaxis] * (red - 1.0)
    land = np.array(to_rgb(GREY)) + shares[1] * (red - np.array(to_rgb(GREY)))
    fills = [*map(tuple, cage), *map(tuple, balls), *["none"] * len(rings)]
    is_bar = np.arange(len(cage)) >= len(cage) - at.angles.size * BAR_POINTS  # pieces, not outlined each
    outlines = cage * np.where(is_bar, 1.0, 0.8)[:, np.newaxis]
    edges = [*map(tuple, outlines), *[BLACK] * len(discs), *[tuple(land)] * len(rings)]
    widths = np.repeat([0.25, 0.8, 1.6], [len(flat), len(discs), len(rings)])
    shapes = [*flat, *discs, *rings]
    order = np.argsort(np.concatenate([near.mean(axis=1), depth, ring_depth]).round(9), kind="stable")
    body.set_verts([shapes[i] for i in order])
    body.set_facecolor([fills[i] for i in order])
    body.set_edgecolor([edges[i] for i in order])
    body.set_linewidth(widths[order].tolist())


def _shades(faces: Array, turn: float) -> Array:
    """Return the colour of each face of the cage: lighter where it looks to the light, shape (face, 3)."""
    normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 3] - faces[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, np.newaxis] + 1e-30
    light = np.abs(turned(normal[:, :2], turn) @ LIGHT) / np.hypot(*LIGHT)
    share = (0.35 + 0.5 * light)[:, np.newaxis]
    return np.asarray(share * np.array(to_rgb(SKY)) + (1.0 - share))


def _rings(at: Scene, turn: float) -> tuple[list[Array], Array]:
    """Return short pieces of each land's circle, and how near they are."""
    found, depths, angle = [], [], np.linspace(0.0, 2.0 * np.pi, 73)
    for height in at.heights:
        circle = np.column_stack([ring(at.land_radius, angle), np.full(angle.size, height)])
        flat, near = seen(circle, at.view, turn)
        found += [flat[i : i + 2] for i in range(angle.size - 1)]
        depths.append(0.5 * (near[1:] + near[:-1]))
    return found, np.concatenate(depths) if depths else np.zeros(0)


def notes(data: xr.Dataset, at: Scene, moments: Array) -> list[str]:
    """Return what the colours mean, the scales, and the times of the frames."""
    pocket, land = (format_number(one, 3) for one in at.largest)
    steps = np.diff(milliseconds(data)[moments])
    pace = f"{1e3 * np.median(steps):.3g} \N{MICRO SIGN}s a frame" if steps.size else "one frame"
    spans = " and ".join(f"{first:.3g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    size = "to scale" if at.enlarged == 1.0 else f"enlarged {format_number(at.enlarged, 2)} times"
    return [
        f"Balls: white to red, 0 to {pocket} N in the pocket.",
        *(
            [f"Land: grey to red, 0 to {land} N." if at.largest[1] else "Land: not touched."]
            if at.side
            else []
        ),
        "Root scale; the largest since the last frame.",
        f"Movements and clearances {size};",
        "overlaps are contact deformation.",
        "Fixed frame." if at.frame.any() else "Frame of the ball set.",
        f"Shown: {spans}, {pace}.",
    ]
