"""The frames of an animation: cage, balls and forces; the path of the centre; energy and time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from separatrix.figures import simulation
from separatrix.figures.heading import heading
from separatrix.figures.orbit import (
    AROUND,
    half_plays,
    land_boundary,
    orbit_reach,
    pocket_angles,
    pocket_boundary,
    ring,
    smooth_path,
)
from separatrix.figures.scene import (
    ROUND,
    Scene,
    ball_places,
    bars,
    land_arrow,
    land_radius,
    pocket_arrows,
    rails,
    turned,
)
from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION
from separatrix.units import Array, format_number

SIZE = (7.6, 4.8)
DOTS = 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

BAR, BALL, SHADE = "#9fc7e3", "#e4e4e4", "#d8d8d8"
DRAWN = (BLACK, GREY, BLUE, BAR, BALL, SKY, VERMILION)
"""What is drawn with, for the colours of a GIF."""

ARROW = 3.2
"""Length of the longest arrow, in radii of a ball."""

INSIDE = 0.66
"""Half the side of the picture of the path, over the inner radius of the cage."""

TAIL = 8
"""Frames for which the path stays."""

MOST_TAIL, DRIFT = 4000, 1.5
"""Most samples of the path that stays; steps over the usual one from which frames have a gap."""


def pictures(data: xr.Dataset, at: Scene, moments: Array) -> Iterator[Image.Image]:
    """Yield the picture of each moment; what stands still is drawn once."""
    figure = Figure(figsize=SIZE, dpi=DOTS)
    canvas: Any = FigureCanvasAgg(figure)
    plan = (0.0, 0.0, 0.6, 0.9)
    parts = (
        _Cage(figure.add_axes(plan), at),
        _Path(figure.add_axes(_middle(at, plan)), data, at, moments),
        _Energy(figure.add_axes((0.69, 0.11, 0.29, 0.32)), data, moments),
        _Clock(figure, simulation.milliseconds(data)[moments]),
    )
    figure.text(0.01, 0.985, "\n".join(heading(data)), fontsize=6.5, va="top", linespacing=1.4)
    _explained(figure, data, at, moments)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    for frame in range(moments.size):
        canvas.restore_region(still)
        for part in parts:
            part.move(frame)
            for artist in part.moving:
                figure.draw_artist(artist)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def shown_parts(data: xr.Dataset, moments: Array) -> list[tuple[float, float]]:
    """Return beginning and end of each part of the run that the frames show [ms]."""
    time = simulation.milliseconds(data)[moments]
    if simulation.is_logarithmic(data) or time.size < 3:
        return [(float(time[0]), float(time[-1]))]
    steps = np.diff(moments)
    cuts = np.flatnonzero(steps > DRIFT * np.median(steps) + 1) + 1
    return [(float(part[0]), float(part[-1])) for part in np.split(time, cuts)]


def _middle(at: Scene, plan: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    """Return the place of the path's picture: inside the ring, around the axis."""
    width, height = SIZE
    left, low, wide, high = plan
    unit = 0.5 * min(wide * width, high * height) / at.reach
    half = INSIDE * (at.radius - at.half_width) * unit
    x, y = (left + 0.5 * wide) * width, (low + 0.5 * high) * height
    return (x - half) / width, (y - half) / height, 2 * half / width, 2 * half / height


def _explained(figure: Figure, data: xr.Dataset, at: Scene, moments: Array) -> None:
    """Say what the picture shows, and on which scales."""
    pocket, land = float(np.abs(at.force).max()), float(at.land_force.max())
    arrow: Any = {"marker": r"$\rightarrow$", "ls": "", "ms": 9}
    named = [
        (
            Line2D([], [], color=VERMILION, **arrow),
            f"force of a pocket on the cage, up to {format_number(pocket, 3)} N",
        )
    ]
    if np.isfinite(at.gap):
        named.append(
            (Line2D([], [], color=BLACK, **arrow), f"force of the land, up to {format_number(land, 3)} N")
        )
        named.append((Line2D([], [], color=GREY, lw=1.6), "land"))
    figure.legend(
        *zip(*named, strict=True),
        loc="upper left",
        bbox_to_anchor=(0.6, 0.83),
        fontsize=6.5,
        handlelength=1.6,
        labelspacing=0.25,
    )
    figure.text(0.615, 0.66, _notes(data, at, moments), fontsize=6.5, color=BLACK, va="top", linespacing=1.4)


def _notes(data: xr.Dataset, at: Scene, moments: Array) -> str:
    """Return the scales and the times of the frames as text."""
    parts = shown_parts(data, moments)
    steps = np.diff(simulation.milliseconds(data)[moments])
    pace = f"{1e3 * np.median(steps):.3g} \N{MICRO SIGN}s a frame" if steps.size else "one frame"
    spans = " and ".join(f"{first:.3g} to {last:.4g} ms" for first, last in parts)
    lines = [
        *to_scale(at.enlarged),
        "Arrow length: square root of force.",
        "Fixed frame." if at.frame.any() else "Frame of the ball set.",
        "Logarithmic time." if simulation.is_logarithmic(data) else f"Shown: {spans}, {pace}.",
    ]
    return "\n".join(lines)


def to_scale(enlarged: float) -> tuple[str, str]:
    """Return how many times too large movements are drawn, in two lines."""
    times = "to scale" if enlarged == 1.0 else f"enlarged {format_number(enlarged, 2)} times"
    return f"Displacements and clearances {times};", "overlaps are contact deformation."


class _Clock:
    """The time of the frame."""

    def __init__(self, figure: Figure, times: Array) -> None:
        self.times = times
        self.text = figure.text(0.615, 0.895, "", fontsize=10, va="top", animated=True)
        self.moving = (self.text,)

    def move(self, frame: int) -> None:
        """Say the time."""
        self.text.set_text(f"{self.times[frame]:.3f} ms")


class _Energy:
    """The energy against time, with a dot at the frame's."""

    def __init__(self, axes: Axes, data: xr.Dataset, moments: Array) -> None:
        simulation.draw_energy(axes, data)
        parts = shown_parts(data, moments)
        for first, last in parts if len(parts) > 1 else ():
            axes.axvspan(first, last, color=SHADE, lw=0, zorder=0)
        self.time = np.maximum(simulation.milliseconds(data)[moments], axes.get_xlim()[0])
        self.energy = np.asarray(axes.lines[0].get_ydata(), dtype=float)[moments]
        self.dot = axes.plot([], [], "o", color=BLACK, ms=4, clip_on=False, animated=True)[0]
        self.moving = (self.dot,)

    def move(self, frame: int) -> None:
        """Put the dot on the curve."""
        self.dot.set_data([self.time[frame]], [self.energy[frame]])


class _Path:
    """The path of the centre within its boundaries, in the middle of the ring."""

    def __init__(self, axes: Axes, data: xr.Dataset, at: Scene, moments: Array) -> None:
        reach = orbit_reach(data)
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
        axes.set_axis_off()
        self.at, self.moments = at, moments
        self.samples = [np.asarray(data[name].values) for name in ("time", "position", "velocity")]
        size = 1.0 / reach * INSIDE * (at.radius - at.half_width)
        axes.text(
            0.5,
            0.0,
            f"path of the centre,\nenlarged {format_number(size, 2)} times",
            **NOTE,
            transform=axes.transAxes,
        )
        self.pockets = pocket_boundary(pocket_angles(data), half_plays(data))
        land = land_boundary(data)
        if land is not None:
            axes.plot(*ring(land, AROUND).T, color=GREY, lw=1.2)
        self.outline = axes.plot([], [], color=BLACK, lw=0.6)[0]
        self.tail = axes.plot([], [], color=BLUE, lw=0.8)[0]
        self.dot = axes.plot([], [], "o", color=BLUE, ms=3.5)[0]
        self.moving = (self.outline, self.tail, self.dot)
        for artist in self.moving:
            artist.set_animated(True)

    def move(self, frame: int) -> None:
        """Put the end of the path where the centre is."""
        angle, last = self.at.frame[frame], int(self.moments[frame])
        before = int(self.moments[max(0, frame - TAIL)])
        first = max(before, last - MOST_TAIL, 0)
        time, position, velocity = (sample[first : last + 1] for sample in self.samples)
        path = smooth_path(time, position, velocity)
        self.tail.set_data(*turned(path, angle).T)
        self.dot.set_data(*turned(path[-1:], angle).T)
        outline = np.where(np.isfinite(self.pockets), self.pockets, np.nan)
        self.outline.set_data(*turned(ring(outline, AROUND), angle).T)


NOTE: Any = {"ha": "center", "va": "top", "fontsize": 6.0, "color": BLACK, "linespacing": 1.3}


class _Cage:
    """What moves in the plan of the bearing."""

    def __init__(self, axes: Axes, at: Scene) -> None:
        axes.set(xlim=(-at.reach, at.reach), ylim=(-at.reach, at.reach), aspect="equal")
        axes.set_axis_off()
        self.at = at
        count = at.angles.size
        if np.isfinite(at.gap):
            axes.plot(*ring(land_radius(at), ROUND).T, color=GREY, lw=1.6)
        axes.plot(*ring(at.radius, ROUND).T, color=GREY, lw=0.4, ls=":")
        self.rails: Any = axes.add_collection(LineCollection([], colors=BLUE, linewidths=0.9))
        self.bars: Any = axes.add_collection(
            PolyCollection([], facecolors=BAR, edgecolors=BLUE, linewidths=0.7)
        )
        size = np.full(count, 2 * at.ball)
        look: Any = {"units": "xy", "facecolors": BALL, "edgecolors": BLACK, "linewidths": 0.8}
        places: Any = {"offsets": np.zeros((count, 2)), "offset_transform": axes.transData}
        self.balls = axes.add_collection(EllipseCollection(size, size, np.zeros(count), **look, **places))
        self.first = axes.plot([0], [0], "o", color=BLACK, ms=2.5)[0]
        self.pockets, self.land = (_arrows(axes, at, n, c) for n, c in ((count, VERMILION), (1, BLACK)))
        self.moving = (self.bars, self.rails, self.balls, self.first, self.pockets, self.land)
        for artist in self.moving:
            artist.set_animated(True)

    def move(self, frame: int) -> None:
        """Put everything where it is at a moment."""
        balls = ball_places(self.at, frame)
        self.bars.set_verts(bars(self.at, frame))
        self.rails.set_segments(rails(self.at, frame))
        self.balls.set_offsets(balls)
        self.first.set_data(balls[:1, 0], balls[:1, 1])
        for arrows, (foot, along) in (
            (self.pockets, pocket_arrows(self.at, frame)),
            (self.land, land_arrow(self.at, frame)),
        ):
            along = np.ma.masked_invalid(along.reshape(-1, 2))
            arrows.set_offsets(foot.reshape(-1, 2))
            arrows.set_UVC(along[:, 0], along[:, 1])


def _arrows(axes: Axes, at: Scene, count: int, colour: str) -> Any:
    """Return arrows, yet without length."""
    nothing = np.zeros((4, count))
    scale: Any = {"angles": "xy", "scale_units": "xy", "scale": 1 / (ARROW * at.ball), "width": 0.008}
    return axes.quiver(*nothing, color=colour, zorder=4, minlength=0.1, **scale)
