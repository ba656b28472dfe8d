"""What a reader may point at in a figure: the points of its series in data units, each with its text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from separatrix.figures.map import axis_label, axis_values, cells, is_proportional, parameter
from separatrix.figures.ranking import own_environment, shift, text_order
from separatrix.figures.stability import (
    ETA_LABEL,
    FRICTION_LABEL,
    band_ends,
    has_band,
    highest,
    linear_limit,
    own_point,
)
from separatrix.figures.style import BLACK, BLUE, CYCLE, GREY, VERDICT_COLOURS, VERMILION, Json, with_ends
from separatrix.told.sentences import pocket_force
from separatrix.told.tables import ABSENT, interval, number, significant

Floats = tuple[float | None, ...]
"""Numbers along a series; None where there is none."""

Kind = Literal["line", "points", "band", "upright", "cells", "bars"]
Dashes = str | tuple[int, tuple[float, ...]]
POINTS = 72.0
"""Points of an inch: the unit of matplotlib's SVG."""

Place = tuple[float, float, str]
"""Centre in points of an SVG, from its upper left corner, and text."""

SYMBOLS = {r"$\eta$": "\N{GREEK SMALL LETTER ETA}", r"$f_{BC}$": "f_BC", r"$C_T$": "C_T"}
"""Symbols of labels, and as plain text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One line, band, cloud of points or grid of cells of a figure.

    `x` and `y` are its points, `text` one line for each. `low` and `high` are the interval of each `y` (of
    `x` in `candidates_plot`), empty without one; of a band they are its ends. `value` is what the colour of
    a cell shows. `marker`, `size` and `dashes` are those of matplotlib.
    """

    name: str
    kind: Kind
    x: Floats
    y: Floats
    text: tuple[str, ...] = ()
    colour: str = BLACK
    low: Floats = ()
    high: Floats = ()
    value: Floats = ()
    marker: str = ""
    size: float = 4.0
    dashes: Dashes = "-"


@dataclass(frozen=True, slots=True, kw_only=True)
class Plot:
    """The series of a figure, and its axes; `y_names` are the names of the places 0, 1, ... along y."""

    title: str
    x_label: str
    y_label: str
    series: tuple[Series, ...]
    x_log: bool = False
    y_log: bool = False
    y_names: tuple[str, ...] = ()


def stability_plot(data: xr.Dataset) -> Plot:
    """Return the stability curve with its limits, the bearing's own point, and the candidates of a ranking.

    Of a ranking they are those of the bearing's own environment, or of the one that `data` is cut to.
    """
    if "environment" in data.dims:
        data = data.isel(environment=own_environment(data) or 0)
    series = [*_curve(data), *_own_point(data)]
    title = "Critical friction against restitution factor"
    if "material_friction" in data:
        series += _candidates(data)
        title = str(data["environment"].values)
    return Plot(title=title, x_label=ETA_LABEL, y_label=FRICTION_LABEL, series=tuple(series))


def _curve(data: xr.Dataset) -> Iterator[Series]:
    eta, top = data["restitution_factor"].values.astype(float), highest(data, candidates=True)
    critical = data["critical_friction"].values.astype(float)
    low, high = (data[f"scatter_{end}"].values.astype(float) for end in ("low", "high"))
    at = np.isfinite(critical)
    text = [
        f"eta {number(e, 2)}: half of the runs whirl at a friction of {_between(c, a, b)}"
        for e, c, a, b in zip(eta[at], critical[at], low[at], high[at], strict=True)
    ]
    if has_band(data):
        first, last = map(floats, band_ends(data, top))
        name, x, y = "band in which the kick decides", floats(eta), floats(critical)
        yield Series(name=name, kind="band", x=x, y=y, colour=BLUE, low=first, high=last)
    yield Series(
        name=f"half of {int(data['runs'])} runs whirl",
        kind="line",
        x=floats(eta[at]),
        y=floats(critical[at]),
        text=tuple(text),
        colour=BLUE,
        low=floats(low[at]),
        high=floats(high[at]),
    )
    fine = np.linspace(1e-3, 1.0, 100)
    limit = linear_limit(fine, int(data["cage_ball_count"]))
    yield Series(name="linear limit", kind="line", x=floats(fine), y=floats(limit), colour=GREY)


def _own_point(data: xr.Dataset) -> Iterator[Series]:
    """Yield the upright line of the bearing's own factor, and the critical friction there."""
    eta = float(data["chain_restitution_factor"])
    yield Series(
        name="this bearing",
        kind="upright",
        x=floats([eta]),
        y=(None,),
        text=(f"this bearing: eta {number(eta, 2)} (Eq. 18)",),
    )
    at, middle, low, high = own_point(data)
    if np.isfinite([at, middle]).all():
        text = f"this bearing, eta {number(at, 2)}: critical friction {_between(middle, low, high)}"
        yield Series(
            name="critical friction of this bearing",
            kind="points",
            x=floats([at]),
            y=floats([middle]),
            text=(text,),
            low=floats([low]),
            high=floats([high]),
        )


def _candidates(data: xr.Dataset) -> Iterator[Series]:
    """Yield the candidates of one environment at their own factor, a series for each verdict."""
    rows = [(data.isel(material=i), str(name)) for i, name in enumerate(data["material"].values)]
    for verdict, colour in VERDICT_COLOURS.items():
        those = [(one, name) for one, name in rows if str(one["material_verdict"].values) == verdict]
        if those:
            yield Series(
                name=verdict,
                kind="points",
                x=floats([float(one["material_restitution_factor"]) for one, _ in those]),
                y=floats([float(one["material_friction"]) for one, _ in those]),
                text=tuple(_candidate_text(one, name, "material_") for one, name in those),
                colour=colour,
            )


def _candidate_text(one: xr.Dataset, name: str, prefix: str) -> str:
    known = {
        key: _or_none(float(one[f"{prefix}{key}"]))
        for key in (
            *("friction", "restitution_threshold", "margin"),
            *("probability_stable", "probability_low", "probability_high", "largest_contact_force"),
            "force_limit",
        )
    }
    share = interval(known["probability_stable"], known["probability_low"], known["probability_high"])
    verdict = str(one[f"{prefix}verdict"].values) or "no verdict"
    largest = known["largest_contact_force"]
    force = ABSENT if largest is None else pocket_force(largest, known["force_limit"])
    margin = "" if known["margin"] is None else f"{known['margin']:+.2f}"
    return (
        f"{name}: {verdict}; friction {significant(known['friction'], 3)}, threshold "
        f"{number(known['restitution_threshold'], 2)}, margin {margin or '-'}, P(stable) {share}, "
        f"pocket force up to {force}"
    )


def candidates_plot(data: xr.Dataset) -> Plot:
    """Return the restitution threshold of every candidate, a series for each environment and one overall."""
    data = data.isel(material=text_order(data)[::-1])
    names, count = [str(name) for name in data["material"].values], data.sizes["environment"]
    series = [
        _thresholds(data.isel(environment=i), "material_", shift(i, count), names, str(title), colour)
        for i, (title, colour) in enumerate(zip(data["environment"].values, cycle(CYCLE), strict=False))
    ]
    series.append(_thresholds(data, "overall_", 0.0, names, "overall", BLACK))
    return Plot(
        title="Restitution thresholds",
        x_label=f"threshold of the {ETA_LABEL}",
        y_label="",
        series=tuple(series),
        y_names=tuple(names),
    )


def _thresholds(
    data: xr.Dataset, prefix: str, above: float, names: Sequence[str], title: str, colour: str
) -> Series:
    found, low, high = with_ends(data, f"{prefix}restitution_threshold")
    places = np.flatnonzero(np.isfinite(found))
    data = data[[name for name in data.data_vars if str(name).startswith(prefix)]]  # few are sliced faster
    return Series(
        name=title,
        kind="points",
        x=floats(found[places]),
        y=floats(places + above),
        text=tuple(
            f"{title}, {_candidate_text(data.isel(material=i), names[i], prefix)}" for i in places.tolist()
        ),
        colour=colour,
        low=floats(low[places]),
        high=floats(high[places]),
    )


def map_plot(data: xr.Dataset) -> Plot:
    """Return the points of a map, with the share of runs that whirl as the value of each, and the study."""
    known, (x, y) = cells(data), (axis_values(data, name) for name in "xy")
    labels = [plain(axis_label(data, name, parameter(data, name))) for name in "xy"]
    table = {
        name: data[name].transpose("y", "x").values
        for name in ("decision", "probability_low", "probability_high", "runs", "reason")
    }
    text = []
    for j, i in np.ndindex(known.share.shape):
        at = f"{_at(labels[0], float(x[i]))}, {_at(labels[1], float(y[j]))}"
        cell = {name: one[j, i] for name, one in table.items()}
        text.append(f"{at}: {_cell_text(cell, float(known.share[j, i]))}")
    grid = np.meshgrid(x, y)
    points = Series(
        name="share of the runs that whirl",
        kind="cells",
        x=floats(grid[0].ravel()),
        y=floats(grid[1].ravel()),
        text=tuple(text),
        value=floats(known.share.ravel()),
    )
    return Plot(
        title="Share of the runs that whirl",
        x_label=labels[0],
        y_label=labels[1],
        series=(points, *_study_point(data, labels)),
        x_log=is_proportional(x),
        y_log=is_proportional(y),
    )


def _cell_text(cell: Json, share: float) -> str:
    if str(cell["decision"]) == "" or not np.isfinite(share):
        return str(cell["reason"]) or "not run"
    low, high = (_or_none(float(cell[f"probability_{end}"])) for end in ("low", "high"))
    return f"{cell['decision']}; share that whirls {interval(share, low, high)}, {int(cell['runs'])} runs"


def _study_point(data: xr.Dataset, labels: Sequence[str]) -> Iterator[Series]:
    units = [axis_values(data, name)[-1] / float(data[name].values[-1] or 1.0) or 1.0 for name in "xy"]
    at = [float(data[f"{name}_here"]) * unit for name, unit in zip("xy", units, strict=True)]
    if all(np.isfinite(at)):
        text = ", ".join(_at(label, one) for label, one in zip(labels, at, strict=True))
        yield Series(
            name="the study itself",
            kind="points",
            x=floats(at[:1]),
            y=floats(at[1:]),
            text=(f"the study: {text}",),
            colour=VERMILION,
        )


def _at(label: str, value: float) -> str:
    name, _, unit = label.rpartition(" [")
    unit = unit.rstrip("]")
    return f"{name} {significant(value, 3)}{'' if unit in ('-', '') else f' {unit}'}"


def traction_plot(data: xr.Dataset) -> Plot:
    """Return the traction curve of the inner and of the outer race, creep increments in percent."""
    series = []
    for race, colour in zip(("inner", "outer"), (BLUE, VERMILION), strict=True):
        of = data.sel(race=race)
        increment, coefficient = 100.0 * of["creep_increment"].values, of["traction_coefficient"].values
        series.append(
            Series(
                name=f"{race} race",
                kind="line",
                x=floats(increment),
                y=floats(coefficient),
                text=tuple(
                    f"{race} race: creep {significant(x, 3)} %, traction coefficient {significant(y, 3)}"
                    for x, y in zip(increment.tolist(), coefficient.tolist(), strict=True)
                ),
                colour=colour,
            )
        )
    return Plot(
        title="Traction curves",
        x_label="creep increment [%]",
        y_label="traction coefficient $C_T$ [-]",
        series=tuple(series),
    )


def plain(label: str) -> str:
    """Return a label without formulas."""
    for formula, symbol in SYMBOLS.items():
        label = label.replace(formula, symbol)
    return label


def floats(values: Iterable[float]) -> Floats:
    """Return numbers as those of Python; None where they are not finite."""
    return tuple(_or_none(float(one)) for one in values)


def _or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _between(value: float, low: float, high: float) -> str:
    """Return a friction with its interval; an open end is left out."""
    ends = [significant(one, 2) for one in (low, high) if np.isfinite(one)]
    return significant(value, 2) + (f" ({ends[0]} to {ends[1]})" if len(ends) == 2 else "")


def places(axes: Axes, plot: Plot, most: int, *names: str) -> Iterator[Place]:
    """Yield where the points with text of a plot are in an SVG of its finished figure.

    They are those of all series, or of these names, thinned evenly to at most `most` of each.
    """
    figure = axes.figure.get_figure(root=True)
    if figure is None:
        return
    scale, height = POINTS / figure.dpi, figure.get_size_inches()[1] * POINTS
    left, right = sorted(axes.get_xlim())
    low, high = sorted(axes.get_ylim())
    for series in plot.series:
        if names and series.name not in names:
            continue
        step = -(-len(series.text) // most) if series.text else 1
        for x, y, text in [*zip(series.x, series.y, series.text, strict=False)][::step]:
            if x is None or y is None or not (left <= x <= right and low <= y <= high):
                continue
            across, up = axes.transData.transform((x, y))
            yield float(across * scale), float(height - up * scale), text
