"""Figures of one rolling contact: tractions over its area, slip and dissipated power.

x points along rolling, and material enters at the right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from separatrix.figures.style import PAGE, VERMILION, Look, canvas, colour_bar
from separatrix.ground.units import Array

ARROWS = 13, 17
"""Arrows along and across at most."""

ALONG = "x along rolling [mm]\nmaterial enters at the right"

LONGEST = 2.5
"""Ratio of the contact's sides above which its axes have different scales."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Area:
    """Fields over one contact, as a `ContactSolution` has them, too.

    `along` and `across` are centres of cells [m]; `fraction` is the share of each cell inside the contact;
    `slip` is per rolling speed; shapes ([direction,] row, column).
    """

    along: Array
    across: Array
    fraction: Array
    traction: Array
    slip: Array
    stick: NDArray[np.bool_]


def saved_area(case: xr.Dataset) -> Area:
    """Fields of one case of a dataset, without what fills up a smaller grid."""
    columns = np.isfinite(case["along"].values)
    rows = np.isfinite(case["across"].values)
    fields = {
        name: case[name].values[..., rows, :][..., columns] for name in ("fraction", "traction", "slip")
    }
    stick = case["stick"].values[rows][:, columns] > 0.5
    return Area(
        along=case["along"].values[columns], across=case["across"].values[rows], stick=stick, **fields
    )


def tractions(area: Area, *, stick_line: Array | None = None) -> Figure:
    """Return arrows of the tractions of at least two rows over their size, with the area of stick hatched.

    `stick_line` is the end of stick along x of another theory, shape (row,) [m]; NaN where a row slips.
    """
    figure, axes = canvas(3.9, 3.3)
    size = 1e-6 * np.hypot(*area.traction) / _share(area)
    mesh = _map(axes, area, size, "viridis")
    colour_bar(mesh, [axes], r"traction $|\tau|$ [MPa]", aspect=30)
    _stick(axes, area)
    _arrows(axes, area, 1e-6 * area.traction)
    if stick_line is not None:
        axes.plot(1e3 * stick_line, 1e3 * area.across, color=VERMILION, ls=(0, (4, 2)), label="strips")
        axes.legend(loc="upper left", fontsize=6.5)
    return figure


def slip_and_power(area: Area) -> Figure:
    """Return maps of the slip and of the power that it dissipates."""
    figure, (left, right) = canvas(PAGE, 3.1, ncols=2)
    slip = np.hypot(*area.slip)
    lost = -(area.slip * area.traction).sum(axis=0) / _share(area)
    power = "power per area and rolling speed [MPa]"
    shown = (1e2 * slip, "slip over rolling speed [%]"), (1e-6 * lost, power)
    for axes, letter, name, (field, label) in zip(
        (left, right), "ab", ("Slip", "Dissipated power"), shown, strict=True
    ):
        mesh = _map(axes, area, field, "magma_r" if axes is right else "cividis")
        _stick(axes, area, "black" if axes is right else "white")
        colour_bar(mesh, [axes], label, aspect=30)
        axes.set_title(f"{letter}  {name}")
    _arrows(left, area, area.slip)
    return figure


def _edges(centres: Array) -> Array:
    half = 0.5 * (centres[1] - centres[0])
    return 1e3 * np.append(centres - half, centres[-1] + half)


def outline(area: Area) -> Array:
    """Places around the contact, shape (place, 2) [m], from what of the cells at the row ends is inside."""
    x, f = area.along, area.fraction
    dx, dy = float(x[1] - x[0]), float(area.across[1] - area.across[0])
    rows = []
    for y, share in zip(area.across, f, strict=True):
        inside = np.flatnonzero(share)
        if inside.size > 1:
            first, last = inside[0], inside[-1]
            rows.append((y, x[first] + (0.5 - share[first]) * dx, x[last] + (share[last] - 0.5) * dx))
    low, high = rows[0], rows[-1]
    first = [(0.5 * (low[1] + low[2]), low[0] - 0.5 * dy)]
    last = [(0.5 * (high[1] + high[2]), high[0] + 0.5 * dy)]
    right = [(end, y) for y, _, end in rows]
    left = [(start, y) for y, start, _ in rows[::-1]]
    return np.array([*first, *right, *last, *left])


def _map(axes: Axes, area: Area, field: Array, colours: str) -> QuadMesh:
    """Colours over the contact, its outline, and axes that show it large."""
    around = 1e3 * outline(area)
    patch = Polygon(around, closed=True, fill=False, lw=0.9, ec="black", joinstyle="round")
    mesh = axes.pcolormesh(
        _edges(area.along), _edges(area.across), field, cmap=colours, vmin=0.0, rasterized=True
    )
    axes.add_patch(patch)
    mesh.set_clip_path(patch)
    (x0, y0), (x1, y1) = around.min(axis=0), around.max(axis=0)
    wide, high = x1 - x0, y1 - y0
    axes.set(xlim=(x0 - 0.07 * wide, x1 + 0.07 * wide), ylim=(y0 - 0.07 * high, y1 + 0.07 * high))
    ratio = max(high / wide, wide / high)
    if ratio <= LONGEST:
        axes.set_aspect("equal", adjustable="datalim")
    note = "" if ratio <= LONGEST else "; x and y to different scales"
    axes.set(xlabel=ALONG + note, ylabel="y across [mm]")
    axes.locator_params(axis="x", nbins=6)
    return mesh


def _share(area: Area) -> Array:
    """Share of each cell inside, 1 outside: fields of cut cells are averages over whole cells."""
    return np.where(area.fraction > 0.0, area.fraction, 1.0)


def _stick(axes: Axes, area: Area, colour: str = "white") -> None:
    inside = area.fraction > 0.0
    if not (area.stick & inside).any() or not (~area.stick & inside).any():
        axes.set_title("no slip" if area.stick.any() else "slip everywhere", fontsize=7.5, loc="right")
        return
    x, y = 1e3 * area.along, 1e3 * area.across
    sticks = area.stick.astype(float)
    for row, within in zip(sticks, inside, strict=True):  # beyond the outline as at it: no edge there
        if within.any():
            row[:] = np.interp(np.arange(row.size), np.flatnonzero(within), row[within])
    patch = axes.patches[-1]
    edge = axes.contour(x, y, sticks, levels=[0.5], colors=colour, linewidths=1.1)
    hatched = axes.contourf(x, y, sticks, levels=[0.5, 1.5], colors="none", hatches=["////"])
    hatched.set_edgecolor(colour)
    hatched.set_linewidth(0.0)
    for lines in (edge, hatched):
        lines.set_clip_path(patch)
    axes.set_title("hatched: stick", fontsize=7.5, loc="right")


def _arrows(axes: Axes, area: Area, field: Array) -> None:
    """Arrows in the middle of blocks of cells, along the field and as long as it is large."""
    steps = [-(-n // most) for n, most in zip((area.along.size, area.across.size), ARROWS, strict=True)]
    places = np.ix_(
        np.arange(steps[1] // 2, area.across.size, steps[1]),
        np.arange(steps[0] // 2, area.along.size, steps[0]),
    )
    u, v = field[0][places], field[1][places]
    inside = (area.fraction[places] > 0.3) & (np.hypot(u, v) > 0.04 * np.hypot(*field).max())
    x, y = np.meshgrid(1e3 * area.along, 1e3 * area.across)
    if not inside.any():
        return
    look: Look = {"angles": "uv", "pivot": "mid", "color": "black", "width": 0.005, "headwidth": 4.5}
    axes.quiver(
        x[places][inside], y[places][inside], u[inside], v[inside], scale=13.0 * np.hypot(u, v).max(), **look
    )
