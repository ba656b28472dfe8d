"""One run of the cage as a moving picture: cage, balls, contact forces, path, time and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from separatrix.errors import InputError
from separatrix.figures import space_film
from separatrix.figures.motion import (
    AROUND,
    Part,
    filmed,
    frame_moments,
    is_logarithmic,
    land_boundary,
    milliseconds,
    orbit_reach,
    pocket_boundary,
    ring,
    shown_parts,
    smooth_path,
)
from separatrix.figures.scene import ROUND, Scene, scene, turned
from separatrix.figures.simulation import draw_energy
from separatrix.figures.space import is_in_space
from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION, Look, heading, journal, literal_texts
from separatrix.units import Array, format_number

KINDS = ("gif", "mp4")
A_SECOND = 24
"""Frames of a film in a second."""

SIZE, DOTS = (7.6, 4.8), 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

BAR, BALL, SHADE = "#9fc7e3", "#e4e4e4", "#d8d8d8"
DRAWN = (BLACK, GREY, BLUE, BAR, BALL, SKY, VERMILION)
SHADES = 16
"""What is drawn with, for the colours of a GIF, and steps from each of these to white."""

ARROW, INSIDE = 3.2, 0.66
"""Longest arrow over the radius of a ball; half the side of the path's picture over the inner radius."""

TAIL, MOST_TAIL = 8, 4000
"""Frames and most samples for which the path stays."""


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
        if is_in_space(data):
            images = space_film.pictures(data, moments, fixed=fixed)
        else:
            images = pictures(data, scene(data, moments, fixed=fixed), moments)
        for done, image in enumerate(images, start=1):
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


def pictures(data: xr.Dataset, at: Scene, moments: Array) -> Iterator[Image.Image]:
    """Return the picture of each moment."""
    figure = Figure(figsize=SIZE, dpi=DOTS)
    (width, height), (left, low, wide, high) = SIZE, (0.0, 0.0, 0.6, 0.9)
    half = INSIDE * (at.radius - at.half_width) * 0.5 * min(wide * width, high * height) / at.reach
    x, y = (left + 0.5 * wide) * width, (low + 0.5 * high) * height
    middle = (x - half) / width, (y - half) / height, 2 * half / width, 2 * half / height
    clock = figure.text(0.615, 0.895, "", fontsize=10, va="top")
    times = milliseconds(data)[moments]
    parts: tuple[Part, ...] = (
        _cage(figure.add_axes((left, low, wide, high)), at),
        _path(figure.add_axes(middle), data, at, moments),
        _energy(figure.add_axes((0.69, 0.11, 0.29, 0.32)), data, moments),
        ([clock], lambda frame: clock.set_text(f"{times[frame]:.3f} ms")),
    )
    figure.text(0.01, 0.985, "\n".join(heading(data)), fontsize=6.5, va="top", linespacing=1.4)
    _explain(figure, data, at, moments)
    return filmed(figure, parts, moments.size)


def _explain(figure: Figure, data: xr.Dataset, at: Scene, moments: Array) -> None:
    pocket, land = (format_number(float(np.abs(one).max()), 3) for one in (at.force, at.land_force))
    arrow: Look = {"marker": r"$\rightarrow$", "ls": "", "ms": 9}
    named = [(Line2D([], [], color=VERMILION, **arrow), f"force of a pocket on the cage, up to {pocket} N")]
    if np.isfinite(at.land):
        named.append((Line2D([], [], color=BLACK, **arrow), f"force of the land, up to {land} N"))
        named.append((Line2D([], [], color=GREY, lw=1.6), "land"))
    look: Look = {"bbox_to_anchor": (0.6, 0.83), "fontsize": 6.5, "handlelength": 1.6, "labelspacing": 0.25}
    figure.legend(*zip(*named, strict=True), loc="upper left", **look)
    words = "\n".join(notes(data, at, moments))
    figure.text(0.615, 0.66, words, fontsize=6.5, color=BLACK, va="top", linespacing=1.4)


def notes(data: xr.Dataset, at: Scene, moments: Array) -> list[str]:
    """Return the scales and the times of the frames as lines."""
    steps = np.diff(milliseconds(data)[moments])
    pace = f"{1e3 * np.median(steps):.3g} \N{MICRO SIGN}s a frame" if steps.size else "one frame"
    spans = " and ".join(f"{first:.3g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    times = "to scale" if at.enlarged == 1.0 else f"enlarged {format_number(at.enlarged, 2)} times"
    return [
        f"Displacements and clearances {times};",
        "overlaps are contact deformation.",
        "Arrow length: square root of force.",
        "Fixed frame." if at.frame.any() else "Frame of the ball set.",
        "Logarithmic time." if is_logarithmic(data) else f"Shown: {spans}, {pace}.",
    ]


def _energy(axes: Axes, data: xr.Dataset, moments: Array) -> Part:
    draw_energy(axes, data)
    parts = shown_parts(data, moments)
    for first, last in parts if len(parts) > 1 else ():
        axes.axvspan(first, last, color=SHADE, lw=0, zorder=0)
    time = np.maximum(milliseconds(data)[moments], axes.get_xlim()[0])
    energy = np.asarray(axes.lines[0].get_ydata(), dtype=float)[moments]
    (dot,) = axes.plot([], [], "o", color=BLACK, ms=4, clip_on=False)
    return [dot], lambda frame: dot.set_data([time[frame]], [energy[frame]])


def _path(axes: Axes, data: xr.Dataset, at: Scene, moments: Array) -> Part:
    """Draw the path of the centre within its boundaries, in the middle of the ring."""
    reach, land = orbit_reach(data), land_boundary(data)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_axis_off()
    size = format_number(1.0 / reach * INSIDE * (at.radius - at.half_width), 2)
    look: Look = {"ha": "center", "va": "top", "fontsize": 6.0, "linespacing": 1.3}
    axes.text(0.5, 0.0, f"path of the centre,\nenlarged {size} times", transform=axes.transAxes, **look)
    if land is not None:
        axes.plot(*ring(land, AROUND).T, color=GREY, lw=1.2)
    (outline,) = axes.plot([], [], color=BLACK, lw=0.6)
    (tail,) = axes.plot([], [], color=BLUE, lw=0.8)
    (dot,) = axes.plot([], [], "o", color=BLUE, ms=3.5)
    pockets = pocket_boundary(data["pocket_angle"].values, data["half_play"].values)
    pockets = np.where(np.isfinite(pockets), pockets, np.nan)
    samples = [np.asarray(data[name].values) for name in ("time", "position", "velocity")]

    def move(frame: int) -> None:
        angle, last = at.frame[frame], int(moments[frame])
        first = max(int(moments[max(0, frame - TAIL)]), last - MOST_TAIL, 0)
        path = smooth_path(*(sample[first : last + 1] for sample in samples))
        tail.set_data(*turned(path, angle).T)
        dot.set_data(*turned(path[-1:], angle).T)
        outline.set_data(*turned(ring(pockets, AROUND), angle).T)

    return [outline, tail, dot], move


def _cage(axes: Axes, at: Scene) -> Part:
    axes.set(xlim=(-at.reach, at.reach), ylim=(-at.reach, at.reach), aspect="equal")
    axes.set_axis_off()
    count = at.angles.size
    if np.isfinite(at.land):
        axes.plot(*ring(at.land, ROUND).T, color=GREY, lw=1.6)
    axes.plot(*ring(at.radius, ROUND).T, color=GREY, lw=0.4, ls=":")
    rails = LineCollection([], colors=BLUE, linewidths=0.9)
    bars = PolyCollection([], facecolors=BAR, edgecolors=BLUE, linewidths=0.7)
    size, look = np.full(count, 2 * at.ball), {"units": "xy", "facecolors": BALL, "edgecolors": BLACK}
    places: Look = {"offsets": np.zeros((count, 2)), "offset_transform": axes.transData, **look}
    balls = EllipseCollection(size, size, np.zeros(count), linewidths=0.8, **places)
    for collection in (rails, bars, balls):
        axes.add_collection(collection)
    (first,) = axes.plot([0], [0], "o", color=BLACK, ms=2.5)
    scale: Look = {"angles": "xy", "scale_units": "xy", "scale": 1 / (ARROW * at.ball), "width": 0.008}
    pockets, land = (
        axes.quiver(*np.zeros((4, n)), color=colour, zorder=4, minlength=0.1, **scale)
        for n, colour in ((count, VERMILION), (1, BLACK))
    )

    def move(frame: int) -> None:
        centres = at.ball_places(frame)
        bars.set_verts(at.bars(frame))
        rails.set_segments(at.rails(frame))
        balls.set_offsets(centres)
        first.set_data(centres[:1, 0], centres[:1, 1])
        for arrows, (foot, along) in ((pockets, at.pocket_arrows(frame)), (land, at.land_arrow(frame))):
            along = np.ma.masked_invalid(along.reshape(-1, 2))
            arrows.set_offsets(foot.reshape(-1, 2))
            arrows.set_UVC(along[:, 0], along[:, 1])

    return [bars, rails, balls, first, pockets, land], move
