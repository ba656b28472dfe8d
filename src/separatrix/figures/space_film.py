"""One run of a cage in space to look at: as a moving picture, and as a page to turn and play it."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from separatrix.figures.motion import (
    AROUND,
    Part,
    filmed,
    frame_moments,
    is_logarithmic,
    land_boundary,
    milliseconds,
    ring,
    shown_parts,
)
from separatrix.figures.scene import POCKET_POINTS, RIM, SpaceScene, space_scene, turned_by
from separatrix.figures.simulation import draw_energy
from separatrix.figures.space import in_plane
from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION, WIDTH, cut, heading
from separatrix.units import Array, format_number

SIZE, DOTS = (7.6, 4.8), 100
"""Inches, and dots an inch: both sides even, as a video needs them."""

VIEW = np.deg2rad([28.0, -62.0])
"""Height of the eye over the plane of the bearing, and the angle around it."""

TAIL = 40
"""Frames for which the paths stay."""

DISC = ring(1.0, np.linspace(0.0, 2.0 * np.pi, 29)[:-1])
LIGHT = np.array([0.3, -0.5, 0.8])

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames of a page, and most numbers in all: they keep it under 1 MB."""

PAGE_PARTS = Path(__file__).with_name("space_view")
"""Folder of style, script and templates of pages that show a run."""

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""


def pictures(data: xr.Dataset, moments: Array, *, fixed: bool = False) -> Iterator[Image.Image]:
    """Return the picture of each moment."""
    at = space_scene(data, moments, fixed=fixed)
    figure = Figure(figsize=SIZE, dpi=DOTS)
    axes = figure.add_axes((0.0, 0.0, 0.66, 0.9))
    reach = 1.28 * (at.radius + at.ball)
    axes.set(xlim=(-reach, reach), ylim=(-0.86 * reach, 0.86 * reach), aspect="equal")
    axes.set_axis_off()
    body, faces = PolyCollection([], linewidths=0.4), at.faces()
    axes.add_collection(body)
    clock = figure.text(0.67, 0.895, "", fontsize=10, va="top")
    times, land = milliseconds(data)[moments], land_boundary(data)
    energy = figure.add_axes((0.73, 0.10, 0.255, 0.15))
    draw_energy(energy, in_plane(data))
    line = energy.axvline(times[0], color=VERMILION, lw=1.0)
    figure.text(0.01, 0.985, "\n".join(heading(data)), fontsize=6.5, va="top", linespacing=1.4)
    figure.text(0.67, 0.83, "\n".join(notes(data, at)), fontsize=6.5, va="top", linespacing=1.4)
    parts: list[Part] = [
        ([body], lambda frame: _pose(body, at, faces, frame)),
        ([clock], lambda frame: clock.set_text(f"{times[frame]:.3f} ms")),
        ([line], lambda frame: line.set_xdata([times[frame]] * 2)),
        _path(figure.add_axes((0.71, 0.36, 0.125, 0.2)), 1e3 * at.centre, "centre [mm]", land),
        _path(figure.add_axes((0.86, 0.36, 0.125, 0.2)), 1e3 * at.lean, "lean [mrad]", None),
    ]
    return filmed(figure, parts, moments.size)


def _path(axes: Axes, path: Array, label: str, land: Array | None) -> Part:
    """Draw the axes of a path and what does not move in them; its last frames and its end move."""
    far = float(np.hypot(*path.T).max(initial=0.0)) or 1.0
    boundary = np.zeros((0, 2)) if land is None else 1e3 * ring(land, AROUND)
    most = 1.15 * max(far, float(np.abs(boundary).max(initial=0.0)))
    axes.set(xlim=(-most, most), ylim=(-most, most), aspect="equal")
    axes.tick_params(labelsize=5.5, pad=1.5, length=2.0)
    axes.set_title(label, fontsize=6.5)
    if land is not None:
        axes.plot(*boundary.T, color=GREY, lw=0.8)
    axes.plot(*path.T, color=SKY, lw=0.3, alpha=0.5)
    (tail,) = axes.plot([], [], color=BLUE, lw=0.9)
    (dot,) = axes.plot([], [], "o", color=BLUE, ms=3.0)

    def move(frame: int) -> None:
        tail.set_data(*path[max(0, frame - TAIL) : frame + 1].T)
        dot.set_data(*path[frame : frame + 1].T)

    return [tail, dot], move


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


def write_page(data: xr.Dataset, path: Path) -> None:
    """Write a saved run of a cage in space as an HTML page that plays it."""
    path.write_text(page(data), encoding="utf-8")


def page(data: xr.Dataset) -> str:
    """Return the page as text; words of the study are escaped."""
    parts = {
        "TITLE": html.escape(str(data.attrs.get("title", "")) or "A cage in space"),
        "STYLE": _text(PAGE_PARTS / "view.css"),
        "VIEW": view(data),
        "SCRIPT": _text(PAGE_PARTS / "view.js"),
    }
    return _filled(_text(PAGE_PARTS / "page.html"), parts)


def view(data: xr.Dataset) -> str:
    """Return the part of a page that shows the run, with its data; it needs style and script of the page."""
    most = int(min(MOST_FRAMES, MOST_NUMBERS // (8 + 3 * data.sizes["ball"])))
    moments = frame_moments(data, max(2, most))
    run = run_for_page(data, moments)
    spans = " and ".join(f"{first:.4g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    title = cut(str(data.attrs.get("title", "")), WIDTH)
    # a text of the study may hold any mark: the JSON is inside a script
    found = json.dumps(run, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    parts = {
        "ABOUT": html.escape("\n".join(heading(data)[len(title) :])),
        "MOST": f"{run['most']:.3g}",
        "SHOWN": f"Frames show {spans}{', on logarithmic time' if is_logarithmic(data) else ''}.",
        "DATA": found,
    }
    return _filled(_text(PAGE_PARTS / "view.html"), parts)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _filled(template: str, parts: Mapping[str, str]) -> str:
    """Return a template with its marks replaced; the replacements are not searched again."""
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], template)


def run_for_page(data: xr.Dataset, moments: Array) -> dict[str, object]:
    """Return what the page draws as plain data."""
    at = space_scene(data, moments)
    largest = at.largest_force or 1.0
    return {
        "radius": at.radius,
        "ball": at.ball,
        "halfWidth": at.half_width,
        "halfThickness": at.half_thickness,
        "angles": at.angles.tolist(),
        "plays": at.plays.tolist(),
        "axialPlay": at.axial_play,
        "square": at.is_square,
        "land": at.land,
        "side": at.side,
        "heights": list(at.heights),
        "gap": at.gap,
        "enlarged": at.enlarged,
        "around": POCKET_POINTS,
        "rim": RIM,
        "most": largest,
        "time": [float(f"{one:.7g}") for one in data["time"].values[moments]],
        "turned": [round(float(one), 4) for one in np.mod(turned_by(data)[moments], 2.0 * np.pi)],
        "centre": _whole(NANO * at.centre),
        "lean": _whole(NANO * at.lean),
        "axial": _whole(NANO * at.axial),
        "rotation": _whole(NANO * at.rotation),
        "lead": _whole(NANO * at.lead),
        "ballAxial": _whole(NANO * at.ball_axial),
        "force": _whole(255.0 * at.force / largest),
    }


def _whole(values: Array) -> list[int]:
    return [int(one) for one in np.rint(values).ravel()]
