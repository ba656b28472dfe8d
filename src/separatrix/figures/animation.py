"""One run as a GIF: the cage among its balls, seen along the axis, beside the paths of centre and lean."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from separatrix.figures.motion import AROUND, draw_lean, draw_orbit, frame_moments, milliseconds, ring
from separatrix.figures.style import BLACK, GREY, SKY, VERMILION, headed, journal, literal_texts, settled
from separatrix.figures.view import BAR_POINTS, Scene, force_key, scene, span_key
from separatrix.ground.errors import InputError
from separatrix.ground.files import staged
from separatrix.ground.units import Array

A_SECOND, SIZE, DOTS = 24, (7.0, 4.2), 100
"""Frames in a second; inches without the heading, and dots an inch."""

BALLS, LAND = (LinearSegmentedColormap.from_list("force", [least, VERMILION]) for least in ("white", GREY))
"""Colours from no force to the largest."""


def animate(data: xr.Dataset, path: Path, *, progress: Callable[[int, int], None] | None = None) -> None:
    """Write a simulation as a GIF, and report (done, total) frames; an interrupt leaves an older file."""
    if path.suffix.lower() != ".gif":
        raise InputError(str(path), "must end in .gif", got=f'"{path.suffix}"')
    data, moments, writer = literal_texts(data), frame_moments(data), PillowWriter(fps=A_SECOND)
    at, time = scene(data, moments), milliseconds(data)[moments]
    with journal(), staged(path.parent) as stage:
        figure = background(data, moments, at)
        cage, *paths = figure.axes
        move = draw_cage(cage, at)
        clock = cage.text(0.0, 1.0, "", transform=cage.transAxes, va="top")
        dots = [axes.plot([], [], "o", color=VERMILION, ms=5)[0] for axes in paths]
        writer.setup(figure, str(stage / path.name), DOTS)
        for frame in range(moments.size):
            move(frame)
            clock.set_text(f"{time[frame]:.3f} ms")
            for dot, place in zip(dots, (at.centre, at.lean), strict=False):
                dot.set_data(*(1e3 * place[frame : frame + 1].T))
            writer.grab_frame()
            if progress is not None:
                progress(frame + 1, moments.size)
        writer.finish()


def background(data: xr.Dataset, moments: Array, at: Scene) -> Figure:
    """Return a figure with an image of what does not move, for texts are slow, and empty axes over it."""
    still = Figure(figsize=SIZE, dpi=DOTS, layout="constrained")
    grid, reach = still.add_gridspec(1 + at.in_space, 2), 1.25 * (at.radius + at.ball)
    still.add_subplot(grid[:, 0], xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal").set_axis_off()
    titles = ((draw_orbit, "Cage centre, turning frame"), (draw_lean, "Lean of the cage's axis"))
    for row, (draw, title) in enumerate(titles[: 1 + at.in_space]):
        draw(still.add_subplot(grid[row, 1], title=title), data)
    scale = f"Movements and clearances enlarged {at.enlarged:g} times."
    key = f"{force_key(at)}.\n{scale} {span_key(data, moments)}"
    still.supxlabel(key, x=0.008, ha="left", fontsize=7.0)
    canvas: Any = FigureCanvasAgg(settled(headed(still, data)))
    canvas.draw()
    width, height = still.get_size_inches()
    figure = Figure(figsize=(width, height), dpi=DOTS)
    figure.figimage(np.array(canvas.buffer_rgba()), zorder=-1)
    for one in still.axes:
        figure.add_axes(one.get_position().bounds, xlim=one.get_xlim(), ylim=one.get_ylim()).set_axis_off()
    return figure


def draw_cage(axes: Axes, at: Scene) -> Callable[[int], None]:
    """Draw balls, bars between pockets, ring and land, clearances enlarged; return what moves them."""
    half = np.arcsin(np.clip((at.ball + at.enlarged * at.plays) / at.radius, 0.0, 1.0))
    ends = np.append(at.angles[1:], at.angles[0] + 2.0 * np.pi) - np.roll(half, -1)
    bars = [np.linspace(a, max(a, b), BAR_POINTS + 1) for a, b in zip(at.angles + half, ends, strict=True)]
    low, high = at.radius - at.half_thickness, at.radius + at.half_thickness
    shapes = [np.concatenate([ring(low, one), ring(high, one[::-1])]) for one in bars]
    shapes += [ring(low, AROUND), ring(high, AROUND)]
    cage = PolyCollection(shapes, facecolors=[SKY] * len(bars) + ["none"] * 2, edgecolors=GREY, lw=0.6)
    size = [2.0 * at.ball]
    balls = EllipseCollection(size, size, [0.0], units="xy", offset_transform=axes.transData)
    balls.set(cmap=BALLS, clim=(0.0, 1.0), edgecolors=BLACK, lw=0.8)
    axes.add_collection(cage)
    axes.add_collection(balls)
    (land,) = axes.plot(*ring(at.land + at.side * at.enlarged * at.gap, AROUND).T, lw=2.0 * abs(at.side))

    def move(frame: int) -> None:
        (x, y), turn = at.enlarged * at.centre[frame], at.enlarged * at.rotation[frame]
        cage.set_verts([one + [x, y] + turn * one[:, ::-1] * [-1.0, 1.0] for one in shapes])
        balls.set_offsets(ring(at.radius, at.angles + at.enlarged * at.lead[frame] / at.radius))
        balls.set_array(np.sqrt(at.force[frame] / (at.largest[0] or 1.0)))
        land.set_color(LAND(np.sqrt(at.land_force[frame] / (at.largest[1] or 1.0))))

    return move
