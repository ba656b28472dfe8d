"""One run of the cage as a moving picture: cage, balls, contact forces, time and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from separatrix.errors import InputError
from separatrix.figures import simulation
from separatrix.figures.scene import (
    ROUND,
    Scene,
    ball_places,
    bars,
    land_arrow,
    land_radius,
    pocket_arrows,
    rails,
    ring,
    scene,
)
from separatrix.figures.style import BLACK, BLUE, GREY, ORANGE, VERMILION, journal
from separatrix.units import Array

KINDS = ("gif", "mp4")
MOST_FRAMES = 240
A_SECOND = 24
"""Frames a second."""

SIZE = (7.6, 4.4)
DOTS = 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

BAR, BALL = "#9fc7e3", "#e4e4e4"
DRAWN = (BLACK, GREY, BLUE, BAR, BALL, ORANGE, VERMILION)
SHADES = 16
"""Steps from each of these colours to white in a GIF."""

ARROW = 3.2
"""Length of the longest arrow, in radii of a ball."""

Progress = Callable[[int, int], None]


def animate(
    data: xr.Dataset, path: Path, *, kind: str, fixed: bool = False, progress: Progress | None = None
) -> None:
    """Write a run as an animation; an interrupt leaves no file, and an older one as it was.

    Parameters
    ----------
    data : Dataset
        Of a simulation.
    path : Path
        File to write.
    kind : str
        "gif", or "mp4", which needs the extra `animation`.
    fixed : bool
        Whether the picture stands still in space; else it turns with the ball set.
    progress : callable, optional
        Called with (done, total) frames.

    Raises
    ------
    InputError
        The kind is unknown, or what writes it is not installed.
    """
    if kind not in KINDS:
        raise InputError("The kind of an animation", f"must be {' or '.join(KINDS)}", value=f'"{kind}"')
    encoder = video_encoder() if kind == "mp4" else None
    moments = frame_moments(data)
    with journal(), _beside(path) as part:
        film = _told(_frames(data, scene(data, moments, fixed=fixed), moments), moments.size, progress)
        if encoder is None:
            _write_gif(film, part)
        else:
            _write_mp4(encoder, film, part)


def video_encoder() -> ModuleType:
    """Return the package that brings a video encoder along.

    Raises
    ------
    InputError
        It is not installed.
    """
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


def frame_moments(data: xr.Dataset, most: int = MOST_FRAMES) -> Array:
    """Return the samples that become frames, evenly along the axis of time as it is drawn."""
    time = simulation.milliseconds(data)
    first, last = simulation.time_limits(data)
    space = np.geomspace if simulation.is_logarithmic(data) else np.linspace
    wanted = np.searchsorted(time, space(first, last, most)).clip(0, time.size - 1)
    return np.unique(np.concatenate([[0], wanted]))[-most:]


def _told(film: Iterator[Image.Image], total: int, progress: Progress | None) -> Iterator[Image.Image]:
    """Yield the frames, telling of each."""
    for done, image in enumerate(film, start=1):
        yield image
        if progress is not None:
            progress(done, total)


def _write_gif(film: Iterator[Image.Image], part: Path) -> None:
    """Write the frames as a GIF that repeats, all in the same colours."""
    look: Any = {"palette": palette(), "dither": Image.Dither.NONE}
    images = (image.quantize(**look) for image in film)
    how: Any = {"save_all": True, "duration": 1000 // A_SECOND, "loop": 0}
    with part.open("wb") as file:
        next(images).save(file, "GIF", append_images=images, **how)


def palette() -> Image.Image:
    """Return an image that holds the colours of a film: each one that is drawn, in steps up to white."""
    drawn = 255 * np.array([to_rgb(colour) for colour in DRAWN])
    share = np.linspace(0.0, 1.0, SHADES)[:, np.newaxis, np.newaxis]
    shades = np.round(share * drawn + (1 - share) * 255.0).astype(np.uint8).reshape(-1, 3)
    image = Image.new("P", (1, 1))
    image.putpalette(shades.tobytes())
    return image


def _write_mp4(encoder: ModuleType, film: Iterator[Image.Image], part: Path) -> None:
    """Write the frames as H.264 video."""
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


def _frames(data: xr.Dataset, at: Scene, moments: Array) -> Iterator[Image.Image]:
    """Yield the picture of each moment; what stands still is drawn once."""
    figure = Figure(figsize=SIZE, dpi=DOTS)
    canvas: Any = FigureCanvasAgg(figure)
    cage = _Cage(figure.add_axes((0.01, 0.02, 0.56, 0.96)), at)
    cursor = _energy(figure.add_axes((0.67, 0.14, 0.31, 0.44)), data)
    clock = figure.text(0.63, 0.94, "", fontsize=10, va="top", animated=True)
    figure.text(0.63, 0.86, _explained(at), fontsize=7, color=GREY, va="top", linespacing=1.5)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    time, energy = simulation.milliseconds(data), 1e3 * simulation.total_energy(data)
    for frame, moment in enumerate(moments):
        cage.move(frame)
        clock.set_text(f"{time[moment]:.3f} ms")
        cursor.set_data([max(time[moment], cursor.axes.get_xlim()[0])], [energy[moment]])
        canvas.restore_region(still)
        for artist in (*cage.moving, cursor, clock):
            figure.draw_artist(artist)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _explained(at: Scene) -> str:
    """Return what the picture shows."""
    pocket, land = float(np.abs(at.force).max()), float(at.land_force.max())
    lines = [f"offset, lead and play drawn {at.enlarged:g} times too large"]
    lines.append("standing still in space" if at.frame.any() else "turning with the ball set")
    lines.append(f"orange: pockets' forces on the cage, longest {pocket:.3g} N")
    if land > 0.0:
        lines.append(f"red: land's force on the cage, longest {land:.3g} N")
    return "\n".join([*lines, "arrows as long as the root of the force"])


def _energy(axes: Axes, data: xr.Dataset) -> Any:
    """Draw the energy against time, and return the dot that moves on it."""
    energy = 1e3 * simulation.total_energy(data)
    axes.plot(simulation.milliseconds(data), energy, color=BLUE, lw=0.9)
    if energy.min() > 0.0 and energy.max() > 30 * energy.min():
        axes.set_yscale("log")
    axes.set_title("energy of the cage [mJ]")
    simulation.time_axis(axes, data)
    return axes.plot([], [], "o", color=BLACK, ms=4, clip_on=False, animated=True)[0]


class _Cage:
    """What moves in the plan of the bearing."""

    def __init__(self, axes: Axes, at: Scene) -> None:
        axes.set(xlim=(-at.reach, at.reach), ylim=(-at.reach, at.reach), aspect="equal")
        axes.set_axis_off()
        self.at = at
        count = at.angles.size
        if np.isfinite(at.gap):
            axes.plot(*ring(land_radius(at), ROUND).T, color=VERMILION, lw=1.0)
        axes.plot(*ring(at.radius, ROUND).T, color=GREY, lw=0.4, ls=":")
        axes.plot([0], [0], "+", color=GREY, ms=6)
        self.centre = axes.plot([0], [0], "o", color=BLUE, ms=3)[0]
        self.rails: Any = axes.add_collection(LineCollection([], colors=BLUE, linewidths=0.9))
        self.bars: Any = axes.add_collection(
            PolyCollection([], facecolors=BAR, edgecolors=BLUE, linewidths=0.7)
        )
        size = np.full(count, 2 * at.ball)
        look: Any = {"units": "xy", "facecolors": BALL, "edgecolors": BLACK, "linewidths": 0.8}
        places: Any = {"offsets": np.zeros((count, 2)), "offset_transform": axes.transData}
        self.balls = axes.add_collection(EllipseCollection(size, size, np.zeros(count), **look, **places))
        self.first = axes.plot([0], [0], "o", color=BLACK, ms=2.5)[0]
        self.pockets, self.land = (_arrows(axes, at, n, c) for n, c in ((count, ORANGE), (1, VERMILION)))
        cage = (self.bars, self.rails, self.balls, self.first, self.centre)
        self.moving = (*cage, self.pockets, self.land)
        for artist in self.moving:
            artist.set_animated(True)

    def move(self, moment: int) -> None:
        """Put everything where it is at a moment."""
        balls = ball_places(self.at, moment)
        self.bars.set_verts(bars(self.at, moment))
        self.rails.set_segments(rails(self.at, moment))
        self.balls.set_offsets(balls)
        self.first.set_data(balls[:1, 0], balls[:1, 1])
        middle = np.mean(rails(self.at, moment)[0][:-1], axis=0)
        self.centre.set_data(middle[:1], middle[1:])
        for arrows, (foot, along) in (
            (self.pockets, pocket_arrows(self.at, moment)),
            (self.land, land_arrow(self.at, moment)),
        ):
            along = np.ma.masked_invalid(along.reshape(-1, 2))
            arrows.set_offsets(foot.reshape(-1, 2))
            arrows.set_UVC(along[:, 0], along[:, 1])


def _arrows(axes: Axes, at: Scene, count: int, colour: str) -> Any:
    """Return arrows, yet without length."""
    nothing = np.zeros((4, count))
    scale: Any = {"angles": "xy", "scale_units": "xy", "scale": 1 / (ARROW * at.ball), "width": 0.008}
    return axes.quiver(*nothing, color=colour, zorder=4, minlength=0.1, **scale)
