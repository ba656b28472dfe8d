"""One run of a cage in space as a moving picture: cage, balls coloured by force, lands, path and lean."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from separatrix.figures.motion import AROUND, land_boundary, ring
from separatrix.figures.simulation import draw_energy, is_logarithmic, milliseconds
from separatrix.figures.space import in_plane
from separatrix.figures.space_scene import SpaceScene, space_scene
from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION, heading
from separatrix.units import Array, format_number

SIZE, DOTS = (7.6, 4.8), 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

VIEW = np.deg2rad([28.0, -62.0])
"""Height of the eye over the plane of the bearing, and the angle around it."""

TAIL = 40
"""Frames for which the paths stay."""

DISC = ring(1.0, np.linspace(0.0, 2.0 * np.pi, 29)[:-1])
HOLE, LIGHT = 0.35, np.array([0.3, -0.5, 0.8])


def pictures(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Iterator[Image.Image]:
    """Yield the picture of each moment; what does not move is drawn once."""
    at = space_scene(data, moments, fixed=fixed)
    figure = Figure(figsize=SIZE, dpi=DOTS)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 0.66, 0.9))
    reach = 1.28 * (at.radius + at.ball)
    axes.set(xlim=(-reach, reach), ylim=(-0.86 * reach, 0.86 * reach), aspect="equal")
    axes.set_axis_off()
    body = PolyCollection([], linewidths=0.4)
    axes.add_collection(body)
    clock = figure.text(0.67, 0.895, "", fontsize=10, va="top")
    times = milliseconds(data)[moments]
    paths = [
        _path(figure.add_axes((0.71, 0.36, 0.125, 0.2)), 1e3 * at.centre, "centre [mm]", _land(data)),
        _path(figure.add_axes((0.86, 0.36, 0.125, 0.2)), 1e3 * at.lean, "lean [mrad]", None),
    ]
    energy = figure.add_axes((0.73, 0.10, 0.255, 0.15))
    draw_energy(energy, in_plane(data))
    line = energy.axvline(times[0], color=VERMILION, lw=1.0)
    figure.text(0.01, 0.985, "\n".join(heading(data)), fontsize=6.5, va="top", linespacing=1.4)
    figure.text(0.67, 0.83, "\n".join(notes(data, at)), fontsize=6.5, va="top", linespacing=1.4)
    moving = [body, clock, line, *(artist for pair in paths for artist in pair)]
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    still, faces = canvas.copy_from_bbox(figure.bbox), at.faces()
    for frame in range(moments.size):
        canvas.restore_region(still)
        _pose(body, at, faces, frame)
        clock.set_text(f"{times[frame]:.3f} ms")
        line.set_xdata([times[frame]] * 2)
        for (tail, dot), path in zip(paths, (1e3 * at.centre, 1e3 * at.lean), strict=True):
            tail.set_data(*path[max(0, frame - TAIL) : frame + 1].T)
            dot.set_data(*path[frame : frame + 1].T)
        for artist in moving:
            figure.draw_artist(artist)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _land(data: xr.Dataset) -> Array | None:
    land = land_boundary(data)
    return None if land is None else 1e3 * ring(land, AROUND)


def _path(axes: Axes, path: Array, label: str, land: Array | None) -> tuple[Any, Any]:
    """Draw the axes of a path and what does not move in them; return its tail and its end."""
    far = float(np.hypot(*path.T).max(initial=0.0)) or 1.0
    most = 1.15 * max(far, 0.0 if land is None else float(np.abs(land).max()))
    axes.set(xlim=(-most, most), ylim=(-most, most), aspect="equal")
    axes.tick_params(labelsize=5.5, pad=1.5, length=2.0)
    axes.set_title(label, fontsize=6.5)
    if land is not None:
        axes.plot(*land.T, color=GREY, lw=0.8)
    axes.plot(*path.T, color=SKY, lw=0.3, alpha=0.5)
    (tail,) = axes.plot([], [], color=BLUE, lw=0.9)
    (dot,) = axes.plot([], [], "o", color=BLUE, ms=3.0)
    return tail, dot


def seen(points: Array, turn: float) -> tuple[Array, Array]:
    """Return points on the picture, shape (..., 2), and how near they are to the eye, shape (...)."""
    high, around = VIEW
    c, s = np.cos(around + turn), np.sin(around + turn)
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    across, away = c * x - s * y, s * x + c * y
    up = np.cos(high) * z + np.sin(high) * away
    return np.stack([across, up], axis=-1), np.asarray(np.sin(high) * z - np.cos(high) * away)


def _pose(body: PolyCollection, at: SpaceScene, faces: Array, frame: int) -> None:
    """Put cage, balls and lands where they are, from the farthest to the nearest."""
    turn = float(at.frame[frame])
    flat, near = seen(at.moved(faces, frame), turn)
    cage_colours = _shades(faces, turn)
    middle, depth = seen(at.ball_places(frame), turn)
    share = np.sqrt(at.force[frame] / (at.largest_force or 1.0))[:, np.newaxis]
    ball_colours = (1.0 - share) * np.ones(3) + share * np.array(to_rgb(VERMILION))
    discs = middle[:, np.newaxis] + at.ball * DISC
    rings, ring_depth = _rings(at, turn)
    depths = np.concatenate([near.mean(axis=1), depth, ring_depth])
    shapes = [*flat, *discs, *rings]
    fills = np.concatenate(
        [
            np.column_stack([cage_colours, np.ones(len(flat))]),
            np.column_stack([ball_colours, np.ones(len(discs))]),
            np.zeros((len(rings), 4)),
        ]
    )
    edge = [*map(to_rgb, [BLUE] * len(flat) + [BLACK] * len(discs) + [GREY] * len(rings))]
    widths = np.repeat([0.25, 0.8, 1.6], [len(flat), len(discs), len(rings)])
    order = np.argsort(depths, kind="stable")
    body.set_verts([shapes[i] for i in order])
    body.set_facecolor(list(map(tuple, fills[order])))
    body.set_edgecolor([edge[i] for i in order])
    body.set_linewidth(widths[order].tolist())


def _shades(faces: Array, turn: float) -> Array:
    """Return the colour of each face of the cage: lighter where it looks to the light, shape (face, 3)."""
    normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 3] - faces[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, np.newaxis] + 1e-30
    c, s = np.cos(turn), np.sin(turn)
    seen_from = np.stack([c * normal[:, 0] - s * normal[:, 1], s * normal[:, 0] + c * normal[:, 1]], axis=1)
    light = np.abs(seen_from @ LIGHT[:2])
    share = (0.35 + 0.5 * light / np.hypot(*LIGHT[:2]))[:, np.newaxis]
    return np.asarray(share * np.array(to_rgb(SKY)) + (1.0 - share))


def _rings(at: SpaceScene, turn: float) -> tuple[list[Array], Array]:
    """Return short pieces of each land's circle, and how near they are."""
    found, depths, angle = [], [], np.linspace(0.0, 2.0 * np.pi, 73)
    for height in at.heights:
        circle = np.column_stack([ring(at.land_radius, angle), np.full(angle.size, height)])
        flat, near = seen(circle, turn)
        found += [flat[i : i + 2] for i in range(angle.size - 1)]
        depths.append(0.5 * (near[1:] + near[:-1]))
    return found, np.concatenate(depths) if depths else np.zeros(0)


def notes(data: xr.Dataset, at: SpaceScene) -> list[str]:
    """Return what the colours mean, and the scales."""
    times = "to scale" if at.enlarged == 1.0 else f"enlarged {format_number(at.enlarged, 2)} times"
    largest = format_number(at.largest_force, 3)
    return [
        f"Balls: white to red, 0 to {largest} N in the pocket,",
        "root scale, the largest since the last frame.",
        "Light blue: cage. Grey: land." if at.side else "Light blue: cage.",
        f"Movements and clearances {times}.",
        "Fixed frame." if at.frame.any() else "Frame of the ball set.",
        "Logarithmic time." if is_logarithmic(data) else "Linear time.",
    ]
