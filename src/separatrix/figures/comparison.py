"""Two stability curves together, and the margins of two rankings side by side."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.stability import ETA_LABEL, FRICTION_LABEL, HIGHEST
from separatrix.figures.style import BLUE, GREY, PAGE, VERMILION, Look, canvas, cut, legend_below

LOOKS = ((BLUE, "o", "-"), (VERMILION, "s", "--"))
"""Colour, marker and line of the first and the second answer."""

MOST_ROWS, NAME_WIDTH, BESIDE = 30, 60, 0.17
"""Most materials in the picture; letters of a title; distance of a pair of margins from their row."""


def curves(first: xr.Dataset, second: xr.Dataset, titles: Sequence[str]) -> Figure:
    """Critical friction of both against restitution factor; of two rankings also their margins."""
    pair = (first, second)
    ranked = all("material" in one.sizes and "material_restitution_threshold" in one for one in pair)
    place = _common_environment(*pair) if ranked else None
    if place is None:
        figure, axes = canvas(PAGE, 4.1)
    else:
        figure, (axes, beside) = canvas(PAGE, 4.6, ncols=2, width_ratios=[1.0, 1.0])
        _margins(beside, pair, place)
        beside.set_title(f"b  Margins in {cut(place, NAME_WIDTH)[0]}")
    axes.set(xlim=(0, 1), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    highest = 0.0
    for data, title, (colour, marker, line) in zip(pair, titles, LOOKS, strict=True):
        eta, middle = data["restitution_factor"].values, data["critical_friction"].values
        name = cut(title, NAME_WIDTH)[0] if title else ""
        look: Look = {"color": colour, "ls": line, "marker": marker, "ms": 3}
        axes.plot(eta, middle, label=f"{name} (95 % interval shaded)", **look)
        axes.fill_between(
            eta, data["scatter_low"].values, data["scatter_high"].values, color=colour, alpha=0.2
        )
        own = data.get("here_restitution_factor")
        if own is not None and own.size == 1 and np.isfinite(float(own)):
            axes.axvline(float(own), color=colour, ls=line, lw=0.8)
        known = np.concatenate([one[np.isfinite(one)] for one in (middle, data["scatter_high"].values)])
        highest = max(highest, float(known.max(initial=0.0)))
    axes.set_ylim(0.0, 1.1 * highest if highest > 0.0 else HIGHEST)
    axes.set_title(f"{'a  ' if place else ''}Critical friction; vertical: the bearing's own $\\eta$")
    legend_below(figure, columns=1)
    return figure


def _common_environment(first: xr.Dataset, second: xr.Dataset) -> str | None:
    """Environment of both in which the margins are drawn: that of the first that names its own, if it can."""
    names = [[str(name) for name in one["environment"].values] for one in (first, second)]
    shared = [name for name in names[0] if name in names[1]]
    own = [str(one.attrs.get("study", "")) for one in (first, second)]
    stated = [name for name in shared if all(f'"value": "{name}"' in study for study in own)]
    return next(iter(stated or shared), None)


def _margins(axes: Axes, pair: Sequence[xr.Dataset], environment: str) -> None:
    """Margin of each material with its interval, the first answer above the second."""
    tables = []
    for data in pair:
        place = [str(name) for name in data["environment"].values].index(environment)
        here = data.isel(environment=place)
        eta = here["material_restitution_factor"].values
        columns = [here[f"material_restitution_threshold{end}"].values - eta for end in ("", "_low", "_high")]
        tables.append({str(m): row for m, *row in zip(here["material"].values, *columns, strict=True)})
    names = [*dict.fromkeys([*tables[0], *tables[1]])]
    names.sort(key=lambda name: -np.nan_to_num(tables[0].get(name, [np.nan])[0], nan=-9.0))
    names = names[:MOST_ROWS]
    rows = np.arange(len(names))[::-1]
    for table, (colour, marker, _), shift in zip(tables, LOOKS, (BESIDE, -BESIDE), strict=True):
        middle, low, high = np.array([table.get(name, [np.nan] * 3) for name in names]).T
        axes.hlines(rows + shift, low, high, color=colour, lw=1.5)
        axes.plot(middle, rows + shift, marker, color=colour, ms=4, ls="")
    axes.axvline(0.0, color=GREY, lw=0.8)
    axes.set_yticks(rows, names)
    axes.set_xlabel("margin: threshold less own $\\eta$ [-]; bars: 95 %")
