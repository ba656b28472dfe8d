"""One run as a GIF: the cage among its balls, seen along the axis, beside panels in which a dot moves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from separatrix.ground.units import Array, format_quantity
from separatrix.present import draw
from separatrix.present.figure import BLACK, GREY, SKY, VERMILION, Panel
from separatrix.present.view import BAR_POINTS, Scene, force_key, span_key

A_SECOND, SIZE, DOTS = 24, (7.0, 4.2), 100
"""Frames in a second; inches without the heading, and dots an inch."""

BALLS, LAND = (LinearSegmentedColormap.from_list("force", [least, VERMILION]) for least in ("white", GREY))
"""Colours from no force to the largest."""

AROUND = np.linspace(0.0, 2 * np.pi, 361)


def animation(
    at: Scene,
    panels: Sequence[tuple[Panel, Array]],
    heading: Sequence[str],
    *,
    progress: Callable[[int, int], None] | None = None,
) -> bytes:
    """Return a scene as a GIF, and report (done, total) frames.

    Each panel has the place of its dot at each moment, shape (time, 2) [SI].
    """
    writer = PillowWriter(fps=A_SECOND)
    with mpl.rc_context(draw.STYLE), TemporaryDirectory() as folder:
        figure = _background(at, [panel for panel, _ in panels], heading)
        cage, *paths = figure.axes
        move = _draw_cage(cage, at)
        clock = cage.text(0.0, 1.0, "", transform=cage.transAxes, va="top")
        dots = [axes.plot([], [], "o", color=VERMILION, ms=5)[0] for axes in paths]
        path = Path(folder) / "animation.gif"
        writer.setup(figure, str(path), DOTS)
        for frame in range(at.time.size):
            move(frame)
            clock.set_text(format_quantity(float(at.time[frame]), "s"))
            for dot, (panel, places) in zip(dots, panels, strict=True):
                x, y = places[frame]
                dot.set_data([x / panel.x.size], [y / panel.y.size])
            writer.grab_frame()
            if progress is not None:
                progress(frame + 1, at.time.size)
        writer.finish()
        return path.read_bytes()


def _background(at: Scene, panels: Sequence[Panel], heading: Sequence[str]) -> Figure:
    """Return a figure with an image of what does not move, for texts are slow, and empty axes over it."""
    height = SIZE[1] + draw.LINE * len(heading)
    still = Figure(figsize=(SIZE[0], height), dpi=DOTS, layout="constrained")
    still.suptitle("\n".join(heading).replace("$", r"\$"), x=0.008, ha="left", fontsize=7.0)
    grid, reach = still.add_gridspec(max(1, len(panels)), 2), 1.25 * (at.radius + at.ball)
    still.add_subplot(grid[:, 0], xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal").set_axis_off()
    for row, panel in enumerate(panels):
        draw.draw_panel(still.add_subplot(grid[row, 1]), panel)
    scale = f"Movements and clearances enlarged {at.enlarged:g} times."
    still.supxlabel(f"{force_key(at)}.\n{scale} {span_key(at)}", x=0.008, ha="left", fontsize=7.0)
    canvas: Any = FigureCanvasAgg(still)
    canvas.draw()
    figure = Figure(figsize=(SIZE[0], height), dpi=DOTS)
    figure.figimage(np.array(canvas.buffer_rgba()), zorder=-1)
    for one in still.axes:
        figure.add_axes(one.get_position().bounds, xlim=one.get_xlim(), ylim=one.get_ylim()).set_axis_off()
    return figure


def _draw_cage(axes: Axes, at: Scene) -> Callable[[int], None]:
    """Draw balls, bars between pockets, ring and land, clearances enlarged; return what moves them."""
    half = np.arcsin(np.clip((at.ball + at.enlarged * at.plays) / at.radius, 0.0, 1.0))
    ends = np.append(at.angles[1:], at.angles[0] + 2.0 * np.pi) - np.roll(half, -1)
    bars = [np.linspace(a, max(a, b), BAR_POINTS + 1) for a, b in zip(at.angles + half, ends, strict=True)]
    low, high = at.radius - at.half_thickness, at.radius + at.half_thickness
    shapes = [np.concatenate([_ring(low, one), _ring(high, one[::-1])]) for one in bars]
    shapes += [_ring(low, AROUND), _ring(high, AROUND)]
    cage = PolyCollection(shapes, facecolors=[SKY] * len(bars) + ["none"] * 2, edgecolors=GREY, lw=0.6)
    size = [2.0 * at.ball]
    balls = EllipseCollection(size, size, [0.0], units="xy", offset_transform=axes.transData)
    balls.set(cmap=BALLS, clim=(0.0, 1.0), edgecolors=BLACK, lw=0.8)
    axes.add_collection(cage)
    axes.add_collection(balls)
    (land,) = axes.plot(*_ring(at.land + at.side * at.enlarged * at.gap, AROUND).T, lw=2.0 * abs(at.side))

    def move(frame: int) -> None:
        (x, y), turn = at.enlarged * at.centre[frame], at.enlarged * at.rotation[frame]
        cage.set_verts([one + [x, y] + turn * one[:, ::-1] * [-1.0, 1.0] for one in shapes])
        balls.set_offsets(_ring(at.radius, at.angles + at.enlarged * at.lead[frame] / at.radius))
        balls.set_array(np.sqrt(at.force[frame] / (at.largest[0] or 1.0)))
        land.set_color(LAND(np.sqrt(at.land_force[frame] / (at.largest[1] or 1.0))))

    return move


def _ring(radius: float, angle: Array) -> Array:
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
