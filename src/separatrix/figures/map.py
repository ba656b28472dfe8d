"""The stability map: probability of whirl over two parameters of a study."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from separatrix.figures.stability import ETA_LABEL, FRICTION_LABEL, linear_limit
from separatrix.figures.style import BLACK, GREY, PAGE, VERMILION, canvas, legend_below
from separatrix.units import Array, format_quantity, parse

REFUSED, NOT_RUN = "#9a9a9a", "not run"
SPACE = 1.5
"""Steps of an axis that are in proportion beyond this are taken as logarithmic."""

HALF = 0.5 - 1e-6
"""Level of the contour: no share equals it, which would make the contour cross itself."""

COLOURS = ListedColormap(colormaps["cividis"](np.linspace(0.0, 1.0, 256)), "whirling")
"""Even for the eye, for the colour-blind and in grey: dark blue where the cage is stable, bright yellow, as a
warning, where it is not."""

NAMES = {"restitution_factor": ETA_LABEL, "ball_cage_friction": FRICTION_LABEL}
"""Parameters that go by a symbol."""


UNDECIDED = "undecided: the runs, or their drift, allow no verdict"
"""Hatched in the picture: a verdict asks for more than the share that the colour shows."""


def map(data: xr.Dataset) -> Figure:
    """Share of the runs that whirl, with its contour at one half, what is undecided and what was refused."""
    figure, axes = canvas(PAGE, 4.7)
    edges = [cell_edges(axis_values(data, name)) for name in "xy"]
    mesh = _cells(axes, data, edges)
    undecided = table(data, "decision").astype(str) == "UNDECIDED"
    _hatched(axes, edges, undecided, facecolors="none", edgecolors="white", hatch="////")
    if undecided.any():
        axes.fill_between([], [], fc=COLOURS(0.5), ec="white", hatch="////", lw=0.0, label=UNDECIDED)
    for name in "xy":
        _axis(axes, data, name)
    axes.set(xlim=ends(axis_values(data, "x"), edges[0]), ylim=ends(axis_values(data, "y"), edges[1]))
    _half(axes, data)
    _limit(axes, data)
    _here(axes, data)
    runs = f", at most {int(data['stopping_most_runs'])} runs a point" if "stopping_most_runs" in data else ""
    axes.set_title(f"Share of the runs that whirl, kick {kick_text(data)}{runs}")
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, aspect=30)
    bar.set_label("share of the runs that whirl [-]")
    bar.outline.set_visible(False)
    legend_below(figure, [axes])
    return figure


def kick_text(data: xr.Dataset) -> str:
    """Return the kick of the runs, or that it is an axis."""
    if "kick" in (parameter(data, "x"), parameter(data, "y")):
        return "as on the axis"
    return f"{float(data['kick']):g} m/s" if "kick" in data else "of the study"


def parameter(data: xr.Dataset, name: str) -> str:
    """Return the name of the parameter along x or y."""
    key = f"{name}_parameter"
    return str(data[key].values) if key in data else str(data.attrs.get(key, name))


def shown_unit(data: xr.Dataset, name: str) -> tuple[float, str]:
    """Return the size and the symbol of the unit that an engineer would write an axis in."""
    unit = str(data[name].attrs.get("units", "-"))
    largest = float(np.abs(data[name].values).max())
    if unit in ("-", "") or not largest > 0.0:
        return 1.0, unit or "-"
    symbol = format_quantity(largest, unit).partition(" ")[2]
    return parse(f"1 {symbol}", unit), symbol


def axis_values(data: xr.Dataset, name: str) -> Array:
    """Return the values along x or y, in the unit that is shown."""
    return np.asarray(data[name].values, dtype=float) / shown_unit(data, name)[0]


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


def ends(values: Array, edges: Array) -> tuple[float, float]:
    """Return both ends of an axis: its first and last value, so that nothing is drawn beyond what was run."""
    chosen = values if values.size > 1 else edges
    return float(chosen[0]), float(chosen[-1])


def _axis(axes: Axes, data: xr.Dataset, name: str) -> None:
    """Name an axis with its unit; logarithmic where its values are in proportion."""
    symbol = shown_unit(data, name)[1].replace("um", "\N{MICRO SIGN}m")
    of = parameter(data, name)
    axes.set(**{f"{name}label": NAMES.get(of, f"{parameter_words(of)} [{symbol}]")})
    if is_proportional(axis_values(data, name)):
        axes.set(**{f"{name}scale": "log"})
        which: Any = getattr(axes, f"{name}axis")
        which.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        which.set_major_formatter("{x:g}")
        which.set_minor_formatter("")


def parameter_words(name: str) -> str:
    """Return a key of a study as a label; the section is left out where the key names it already."""
    section, _, key = name.rpartition(".")
    words = key.replace("_", " ")
    return words if not section or section in words or key == "race_friction" else f"{section} {words}"


def table(data: xr.Dataset, name: str) -> Any:
    """Return a variable of the map as an array of shape (y, x)."""
    return data[name].transpose("y", "x").values


def not_run(data: xr.Dataset) -> Any:
    """Return where the map was not asked: an interrupt, or the points around agree."""
    return np.char.startswith(table(data, "reason").astype(str), NOT_RUN)


def refused(data: xr.Dataset) -> Any:
    """Return where there is no answer although it was asked for."""
    return np.isnan(table(data, "probability_whirl").astype(float)) & ~not_run(data)


def agreed(data: xr.Dataset) -> Any:
    """Return where nothing was run because the points around agree."""
    return np.char.find(table(data, "reason").astype(str), "agree") >= 0


def filled(data: xr.Dataset) -> Array:
    """Return the share of whirling runs; where the points around agree, that of the nearest point."""
    share = table(data, "probability_whirl").astype(float)
    rows, columns = np.nonzero(np.isfinite(share))
    for row, column in np.argwhere(agreed(data)) if rows.size else ():
        near = np.argmin(np.maximum(np.abs(rows - row), np.abs(columns - column)))
        share[row, column] = share[rows[near], columns[near]]
    return np.asarray(share)


def _cells(axes: Axes, data: xr.Dataset, edges: list[Array]) -> Any:
    """Draw the share of whirling runs, and grey for what was refused."""
    look: Any = {"rasterized": True, "shading": "flat"}
    share = np.ma.masked_invalid(filled(data))
    mesh = axes.pcolormesh(*edges, share, cmap=COLOURS, vmin=0.0, vmax=1.0, **look)
    _hatched(
        axes, edges, refused(data), facecolors=REFUSED, edgecolors="white", hatch="xxxx", label="refused"
    )
    if (not_run(data) & ~agreed(data)).any():
        axes.fill_between([], [], facecolor="white", edgecolor=GREY, lw=0.5, label="not run")
    if agreed(data).any():
        place = np.argwhere(~not_run(data))
        values = [axis_values(data, name)[place[:, i]] for name, i in (("x", 1), ("y", 0))]
        dots: Any = {"color": BLACK, "ms": 2.2, "mec": "white", "mew": 0.4, "clip_on": False, "ls": ""}
        axes.plot(*values, "o", **dots, label="was run; elsewhere the points around agree")
    return mesh


def _hatched(axes: Axes, edges: list[Array], where: Any, **look: Any) -> None:
    """Hatch cells."""
    x, y = edges
    cells = [
        [(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])]
        for j, i in np.argwhere(where)
    ]
    if cells:
        axes.add_collection(PolyCollection(cells, linewidths=0.0, **look), autolim=False)


def _half(axes: Axes, data: xr.Dataset) -> None:
    """Draw the contour on which half the runs whirl, if it runs through the map."""
    share = np.ma.masked_invalid(filled(data))
    if min(share.shape) < 2 or not share.count() or not share.min() < 0.5 < share.max():
        return
    values = [axis_values(data, name) for name in "xy"]
    for colour, width in (("white", 3.2), (VERMILION, 1.6)):
        axes.contour(*values, share, levels=[HALF], colors=[colour], linewidths=[width])
    axes.plot([], [], color=VERMILION, lw=1.6, label="half of the runs whirl")


def _limit(axes: Axes, data: xr.Dataset) -> None:
    """Draw the linear limit, if the axes are restitution factor and friction."""
    names = parameter(data, "x"), parameter(data, "y")
    if set(names) != set(NAMES) or "cage_ball_count" not in data:
        return
    eta = np.linspace(1e-3, 1.0, 400)
    curve = eta, linear_limit(eta, int(data["cage_ball_count"]))
    points = curve if names[0] == "restitution_factor" else curve[::-1]
    axes.plot(*points, color="white", lw=2.4)
    label = "linear limit: no clearance, balls at rest"
    axes.plot(*points, color=BLACK, lw=1.1, ls=(0, (5, 2)), label=label)


def _here(axes: Axes, data: xr.Dataset) -> None:
    """Mark the study's own point, if it has one in the map."""
    found = [float(data[f"{n}_here"]) if f"{n}_here" in data else np.nan for n in "xy"]
    x, y = (value / shown_unit(data, name)[0] for value, name in zip(found, "xy", strict=True))
    limits = axes.get_xlim(), axes.get_ylim()
    if all(low <= value <= high for value, (low, high) in zip((x, y), limits, strict=True)):
        look: Any = {"mfc": "white", "mec": BLACK, "mew": 1.0, "ls": ""}
        axes.plot(x, y, "*", ms=11, label="the study itself", **look)
