"""The stability map over two parameters of a study, and axes named by a key of a study."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

from separatrix.figures.stability import ETA_LABEL, FRICTION_LABEL, draw_linear_limit
from separatrix.figures.style import BLACK, GREY, PAGE, VERMILION, Look, canvas, colour_bar, legend_below
from separatrix.ground.units import Array, format_quantity, parse

Mask = NDArray[np.bool_]

SPACE = 1.5
"""Ratio of the last step of an axis to its first beyond which values in proportion are logarithmic."""

HALF = 0.5 - 1e-6
"""Level of the contour: no share equals it, which would make the contour cross itself."""

COLOURS = ListedColormap(colormaps["cividis"](np.linspace(0.0, 1.0, 256)), "whirling")
"""Even for the eye, for the colour-blind and in grey: dark blue where the cage is stable, bright yellow, as a
warning, where it is not."""

NAMES = {"restitution_factor": ETA_LABEL, "ball_cage_friction": FRICTION_LABEL}
"""Parameters with a symbol."""


class Cells(NamedTuple):
    """State of each point of a map, shape (y, x).

    The share of the runs that whirl, NaN if unknown; which points the program refused; which were not run,
    for an interrupt or as the points around agree, whose share they then have; where there is no verdict.
    """

    share: Array
    refused: Mask
    not_run: Mask
    agreed: Mask
    undecided: Mask


def cells(data: xr.Dataset) -> Cells:
    """Return the state of each point of a map."""
    table = {
        name: data[name].transpose("y", "x").values for name in ("probability_whirl", "reason", "decision")
    }
    share, reason = table["probability_whirl"].astype(float), table["reason"].astype(str)
    not_run, agreed = np.char.startswith(reason, "not run"), np.char.find(reason, "agree") >= 0
    refused = np.isnan(share) & ~not_run
    rows, columns = np.nonzero(np.isfinite(share))
    for row, column in np.argwhere(agreed) if rows.size else ():
        near = np.argmin(np.maximum(np.abs(rows - row), np.abs(columns - column)))
        share[row, column] = share[rows[near], columns[near]]
    return Cells(share, refused, not_run, agreed, table["decision"].astype(str) == "UNDECIDED")


def stability_map(data: xr.Dataset) -> Figure:
    """Share of the runs that whirl, with its contour at one half, what is undecided and what was refused."""
    figure, axes = canvas(PAGE, 4.7)
    known, values = cells(data), [axis_values(data, name) for name in "xy"]
    edges, share = [cell_edges(one) for one in values], np.ma.masked_invalid(known.share)
    look: Look = {"rasterized": True, "shading": "flat"}
    mesh = axes.pcolormesh(*edges, share, cmap=COLOURS, vmin=0.0, vmax=1.0, **look)
    refused: Look = {"fc": "#9a9a9a", "ec": "white", "hatch": "xxxx", "label": "refused"}
    _hatch(axes, edges, known.refused, refused)
    if (known.not_run & ~known.agreed).any():
        axes.fill_between([], [], facecolor="white", edgecolor=GREY, lw=0.5, label="not run")
    if known.agreed.any():
        y, x = np.nonzero(~known.not_run)
        dots: Look = {"color": BLACK, "ms": 2.2, "mec": "white", "mew": 0.4, "clip_on": False, "ls": ""}
        label = "was run; elsewhere the points around agree"
        axes.plot(values[0][x], values[1][y], "o", label=label, **dots)
    _hatch(axes, edges, known.undecided, {"fc": "none", "ec": "white", "hatch": "////"})
    if known.undecided.any():
        look = {"fc": COLOURS(0.5), "ec": "white", "hatch": "////", "lw": 0.0}
        axes.fill_between([], [], label="undecided: the runs, or their drift, allow no verdict", **look)
    for name, one, edge in zip("xy", values, edges, strict=True):
        _axis(axes, data, name, one, edge)
    if min(share.shape) > 1 and share.count() and share.min() < 0.5 < share.max():
        for colour, width in (("white", 3.2), (VERMILION, 1.6)):
            axes.contour(*values, share, levels=[HALF], colors=[colour], linewidths=[width])
        axes.plot([], [], color=VERMILION, lw=1.6, label="half of the runs whirl")
    names = parameter(data, "x"), parameter(data, "y")
    if set(names) == set(NAMES):
        swapped = names[0] == "ball_cage_friction"
        draw_linear_limit(axes, int(data["cage_ball_count"]), swapped=swapped, halo=True)
    _mark_study(axes, data)
    kick = "as on the axis" if "kick" in names else f"{float(data['kick']):g} m/s"
    runs = f", at most {int(data['stopping_most_runs'])} runs a point"
    axes.set_title(f"Share of the runs that whirl, kick {kick}{runs}")
    colour_bar(mesh, [axes], "share of the runs that whirl [-]", pad=0.02, aspect=30)
    legend_below(figure, [axes])
    return figure


def _hatch(axes: Axes, edges: list[Array], where: Mask, look: Look) -> None:
    x, y = edges
    corners = [
        [(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])]
        for j, i in np.argwhere(where)
    ]
    if corners:
        axes.add_collection(PolyCollection(corners, linewidths=0.0, **look), autolim=False)


def _mark_study(axes: Axes, data: xr.Dataset) -> None:
    found = [float(data[f"{name}_here"]) / shown_unit(data, name)[0] for name in "xy"]
    limits = axes.get_xlim(), axes.get_ylim()
    if all(low <= value <= high for value, (low, high) in zip(found, limits, strict=True)):
        look: Look = {"mfc": "white", "mec": BLACK, "mew": 1.0, "ls": ""}
        axes.plot(*found, "*", ms=11, label="the study itself", **look)


def parameter(data: xr.Dataset, name: str) -> str:
    """Return the name of the parameter along x or y."""
    return str(data[f"{name}_parameter"].values)


def shown_unit(data: xr.Dataset, name: str) -> tuple[float, str]:
    """Return the size and the symbol of the unit that an engineer would write an axis in."""
    unit = str(data[name].attrs.get("units", "-"))
    largest = float(np.abs(data[name].values).max())
    if unit in ("-", "") or not largest > 0.0:
        return 1.0, unit or "-"
    symbol = format_quantity(largest, unit).partition(" ")[2]
    return parse(f"1 {symbol}", unit), symbol


def axis_values(data: xr.Dataset, name: str) -> Array:
    """Return the values along x or y, or of a parameter of a sweep, in the unit that is shown."""
    return np.asarray(data[name].values, dtype=float) / shown_unit(data, name)[0]


def axis_label(data: xr.Dataset, name: str, key: str) -> str:
    """Return a key of a study as a label with its unit; without a section that the key names already."""
    section, _, last = key.rpartition(".")
    words = last.replace("_", " ")
    if section not in ("", "operation") and section not in words and last != "race_friction":
        words = f"{section.replace('_', ' ')} {words}"
    symbol = shown_unit(data, name)[1].replace("um", "\N{MICRO SIGN}m")
    return NAMES.get(last, f"{words} [{symbol}]")


def is_proportional(values: Array) -> bool:
    """Whether values rise by a factor rather than by a step: their axis is logarithmic."""
    if values.size < 3 or not values[0] > 0.0:
        return False
    steps, factors = np.diff(values), values[1:] / values[:-1]
    return bool(steps[-1] > SPACE * steps[0] and factors.max() < 1.05 * factors.min())


def cell_edges(values: Array) -> Array:
    """Return edges half-way between neighbouring values, and as far beyond the first and the last."""
    if is_proportional(values):
        return np.asarray(np.exp(cell_edges(np.log(values))))
    if values.size == 1:
        reach = 0.5 * abs(values[0]) or 0.5
        return np.array([values[0] - reach, values[0] + reach])
    middle = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def _axis(axes: Axes, data: xr.Dataset, name: str, values: Array, edges: Array) -> None:
    """Name an axis and end it at its first and last value, so that nothing is drawn beyond what was run."""
    ends = values if values.size > 1 else edges
    label = axis_label(data, name, parameter(data, name))
    axes.set(**{f"{name}lim": (float(ends[0]), float(ends[-1])), f"{name}label": label})
    if is_proportional(values):
        axes.set(**{f"{name}scale": "log"})
        axis = axes.xaxis if name == "x" else axes.yaxis
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("")
