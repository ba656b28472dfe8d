"""The operating envelope: margin, P(stable) and frequencies over the cases of a sweep, and their texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from separatrix.figures.hover import Dashes, Plot, Series, floats
from separatrix.figures.map import axis_label, axis_values, is_proportional
from separatrix.figures.stability import ETA_LABEL
from separatrix.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE,
    PURPLE,
    SKY,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    VERMILION,
    Look,
    canvas,
    with_ends,
)
from separatrix.ground.units import Array, format_quantity
from separatrix.told.sentences import deciding
from separatrix.told.tables import interval, number, significant

FACTOR, PROBABILITY, FREQUENCY, TIME = r"$\eta$ [-]", "P(stable) [-]", "frequency [Hz]", "time [%]"
HEIGHTS = {FACTOR: 1.5, PROBABILITY: 1.1, FREQUENCY: 1.9, TIME: 0.8}
"""Panels of the envelope from the top, each with its height [inch]."""

MOST_PANELS = 6
"""Parameters of a sweep that have a panel."""

SIZES = {"STABLE": 5.0, "UNSTABLE": 4.0, "UNDECIDED": 3.0}
"""Marks of each verdict in a sweep: where several fall on one place, each is seen."""

MOST_CASES = 60
"""Cases of several parameters that are drawn side by side."""

MOST_WORDS = 9
"""Cases below which their values are written under the axis."""

FREQUENCIES: dict[str, tuple[str, str, Dashes]] = {
    "linear_whirl_frequency": ("whirl without clearance", BLACK, "-"),
    "inner_pass_frequency": ("balls past the inner ring", PURPLE, (0, (1, 1))),
    "outer_pass_frequency": ("balls past the outer ring", ORANGE, (0, (4, 1, 1, 1))),
    "shaft_frequency": ("shaft, 1x", BLUE, (0, (5, 2))),
    "cage_frequency": ("cage and ball set, 1x", GREEN, (0, (3, 1.5))),
}
"""Whirl and orders of the bearing: words, colour and dashes."""

Place = tuple[Array, bool]
"""Place of each case along the axis, and whether lines between them have a meaning."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `sweep`; one without a finished case has none."""
    if "case" in data.sizes:
        yield "sweep", sweep(data)
    if has_envelope(data):
        yield "envelope", envelope(data)


def has_envelope(data: xr.Dataset) -> bool:
    """Whether a sweep has an envelope to draw: a finished case, and not too many of several parameters."""
    if "case" not in data.sizes or not np.isfinite(data["cage_speed"].values.astype(float)).any():
        return False
    return data.sizes["parameter"] == 1 or has_duty(data) or data.sizes["case"] <= MOST_CASES


def envelope(data: xr.Dataset) -> Figure:
    """Draw restitution factor and threshold, P(stable), frequencies and time over the cases."""
    plots, place = envelope_plots(data), places(data)
    heights = [HEIGHTS[plot.y_label] for plot in plots]
    marks = [float(one.x[0] or 0.0) for one in plots[0].series if one.kind == "upright"]
    look: Look = {"nrows": len(plots), "sharex": True, "squeeze": False, "height_ratios": heights}
    figure, grid = canvas(PAGE, sum(heights) + 0.9, **look)
    for axes, plot in zip(grid[:, 0], plots, strict=True):
        _draw(axes, plot)
        axes.set_ylabel(plot.y_label)
        if plot.y_label == FACTOR:
            _bands(axes, data, place)
            _mark_refused(axes, data, place)
        elif plot.y_label == PROBABILITY:
            axes.set(ylim=(-0.06, 1.06), yticks=(0.0, 0.5, 1.0))
        for at in marks:
            axes.axvline(at, color=VERMILION, lw=0.9, ls=(0, (4, 2)), zorder=0)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
    grid[0, 0].set_title(plots[0].title, color=VERMILION if marks else BLACK)
    _name_axis(grid[-1, 0], data, place)
    return figure


def sweep(data: xr.Dataset) -> Figure:
    """Restitution factor against each of the first parameters, marked by verdict where there is one."""
    plots = sweep_plots(data)
    columns = min(3, len(plots))
    rows = -(-len(plots) // columns)
    figure, panels = canvas(PAGE, 2.4 * rows + 0.4, nrows=rows, ncols=columns, sharey=True, squeeze=False)
    for axes, plot in zip(panels.flat, plots, strict=False):
        _draw(axes, plot, mfc="none", mew=0.8)
        axes.set_xlabel(plot.x_label)
    for axes in panels.flat[len(plots) :]:
        axes.set_visible(False)
    for row in panels:
        row[0].set_ylabel(ETA_LABEL)
    panels.flat[0].set_ylim(*_from_zero(data["restitution_factor"].values))
    if np.any(data["verdict"].values.astype(str) != ""):
        figure.legend(*panels.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw(axes: Axes, plot: Plot, **look: Any) -> None:
    """Draw the lines, points and bars of a plot with their intervals, and scale its y axis."""
    for one in plot.series:
        x, y, low, high = (np.array(values, dtype=float) for values in (one.x, one.y, one.low, one.high))
        if one.kind == "bars":
            step = float(np.diff(np.sort(x)).min()) if x.size > 1 else 1.0
            axes.bar(x, y, width=0.6 * step, color=one.colour)
        elif one.kind in ("line", "points"):
            dashes = one.dashes if one.kind == "line" else ""
            own: Look = {"marker": one.marker, "ms": one.size, "ls": dashes, "color": one.colour}
            own |= {"_": {"mew": 1.6}, ".": {}}.get(one.marker, look)
            if low.size:
                own |= {"yerr": np.abs([y - low, high - y]), "elinewidth": 0.8, "capsize": 1.5}
            (axes.errorbar if low.size else axes.plot)(x, y, label=one.name, **own)
    if plot.y_log:
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("")


def _from_zero(values: Array) -> tuple[float, float]:
    top = float(np.nanmax(values, initial=0.05))
    return -0.03 * top, 1.08 * top


def column(data: xr.Dataset, name: str) -> Array | None:
    """Return a number of each case, NaN where it is not known; None where it never is."""
    values = np.asarray(data[name].values, dtype=float)
    return values if np.isfinite(values).any() else None


def has_duty(data: xr.Dataset) -> bool:
    """Whether the cases are a duty cycle: they have shares of the time."""
    return column(data, "time_share") is not None


def places(data: xr.Dataset) -> Place:
    """Values of the only parameter where these rise; else the numbers of the cases."""
    names = [str(name) for name in data["parameter"].values]
    if len(names) == 1:
        x = axis_values(data, names[0])
        if (np.diff(x) > 0.0).all():
            return x, True
    return data["case"].values.astype(float), False


def _bands(axes: Axes, data: xr.Dataset, place: Place) -> None:
    """Fill the distance from restitution factor to threshold, the margin; limit the axis."""
    x, is_line = place
    eta = np.asarray(data["restitution_factor"].values, dtype=float)
    threshold = column(data, "restitution_threshold")
    axes.set_ylim(*_from_zero(eta if threshold is None else np.ones(1)))
    if threshold is None:
        return
    for words, colour, those in (
        ("margin", SKY, eta <= threshold),
        ("beyond the threshold", VERMILION, eta > threshold),
    ):
        band: Look = {"color": colour, "alpha": 0.4, "label": words, "zorder": 0}
        if those.any() and is_line:
            axes.fill_between(x, eta, threshold, where=those, interpolate=True, lw=0.0, **band)
        elif those.any():
            axes.vlines(x[those], eta[those], threshold[those], lw=5.0, **band)


def _name_axis(axes: Axes, data: xr.Dataset, place: Place) -> None:
    """Name the axis; where it counts cases, write their values if there is room."""
    x, is_line = place
    names = [str(name) for name in data["parameter"].values]
    if is_line:
        axes.set_xlabel(axis_label(data, names[0], names[0]))
        if is_proportional(x):
            axes.set_xscale("log")
        return
    axes.set_xlabel("case")
    axes.set_xlim(x[0] - 0.6, x[-1] + 0.6)
    if x.size < MOST_WORDS:
        units = [str(data[name].attrs.get("units", "-")) for name in names]
        columns = [[format_quantity(v, u) for v in data[n].values] for n, u in zip(names, units, strict=True)]
        columns.insert(0, [f"{one:g}" for one in x])
        axes.set_xticks(x, ["\n".join(words) for words in zip(*columns, strict=True)])
        keys = ", ".join(name.rpartition(".")[2].replace("_", " ") for name in names)
        axes.set_xlabel(f"case: {keys}")


def worst(data: xr.Dataset, place: Place) -> tuple[float | None, str] | None:
    """Return the place of the worst case, its name and reason; no place where all cases are alike."""
    if "worst_case" not in data:
        return None
    case, alike = int(data["worst_case"]), int(data["worst_alike"])
    why = deciding(str(data["worst_quantity"].values), float(data["worst_value"]))
    why = why.replace("-", "\N{MINUS SIGN}")
    if alike == int(data["worst_compared"]) > 1:
        return None, f"No worst case: all {alike} have the {why}"
    at = place[0][data["case"].values == case][0]
    name = str(data["parameter"].values[0])
    value = data[name].values[data["case"].values == case][0]
    words = f"{name.rpartition('.')[2].replace('_', ' ')} {format_quantity(value, data[name].attrs['units'])}"
    which = (words if place[1] else f"case {case}") + f" and {alike - 1} more" * (alike > 1)
    return float(at), f"{which}: {why}"


def _mark_refused(axes: Axes, data: xr.Dataset, place: Place) -> None:
    refused = np.isnan(data["restitution_factor"].values.astype(float))
    if refused.any() and not refused.all():
        foot = axes.get_xaxis_transform()
        look: Look = {"color": GREY, "transform": foot, "clip_on": False, "label": "refused: see reason"}
        axes.plot(place[0][refused], np.full(refused.sum(), 0.04), "x", ls="", ms=4.0, **look)


def envelope_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of the operating envelope from the top, as `figures.envelope` draws them."""
    place, names = places(data), _names(data)
    drawn = [
        (label, series)
        for label, of in zip(HEIGHTS, (_margin, _probability, _frequencies, _time), strict=True)
        if (series := [*of(data, place, names)])
    ]
    title, found = "Operating envelope", worst(data, place)
    if found is not None:
        at, words = found
        title = words if at is None else f"Worst case (dashed line): {words}"
        if at is not None:
            drawn[0][1].append(Series(name="", kind="upright", x=(at,), y=(None,), colour=VERMILION))
    only = str(data["parameter"].values[0])
    return tuple(
        Plot(
            title=title,
            x_label=axis_label(data, only, only) if place[1] else "case",
            y_label=label,
            series=tuple(series),
            x_log=place[1] and is_proportional(place[0]),
            y_log=label == FREQUENCY,
        )
        for label, series in drawn
    )


def sweep_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of a sweep of several parameters, as `figures.sweep` draws them: cases by verdict."""
    eta, verdict = data["restitution_factor"].values.astype(float), data["verdict"].values.astype(str)
    rows = zip(_names(data), eta, verdict, strict=True)
    texts = [f"{name}: restitution factor {number(e, 3)}{v and f', {v}'}" for name, e, v in rows]
    groups = [("cases", "", BLACK, ".", 4.0)]
    groups += [(v, v, c, VERDICT_MARKERS[v], SIZES[v]) for v, c in VERDICT_COLOURS.items()]
    return tuple(
        Plot(
            title="Restitution factor of every case",
            x_label=axis_label(data, name, name),
            y_label=ETA_LABEL,
            series=tuple(
                _series(words, values, texts, (at, False), colour, marker=marker, size=size)
                for words, known, colour, marker, size in groups
                if np.isfinite(values := np.where(verdict == known, eta, np.nan)).any()
            ),
        )
        for name in map(str, data["parameter"].values[:MOST_PANELS])
        for at in [axis_values(data, name)]
    )


def _names(data: xr.Dataset) -> list[str]:
    parts = [[f"case {one}" for one in data["case"].values.tolist()]]
    for name in map(str, data["parameter"].values):
        words, unit = name.rpartition(".")[2].replace("_", " "), str(data[name].attrs.get("units", "-"))
        parts.append([f"{words} {format_quantity(value, unit)}" for value in data[name].values.tolist()])
    return [", ".join(one) for one in zip(*parts, strict=True)]


def _series(
    name: str,
    values: Array,
    texts: list[str],
    place: Place,
    colour: str,
    ends: tuple[Array, ...] = (),
    **look: Any,
) -> Series:
    """Return the values of the cases as a line, or the finite ones as points where lines have no meaning."""
    at = np.isfinite(values) | place[1]
    low, high = (floats(one[at]) for one in ends) if ends else ((), ())
    return Series(
        name=name,
        kind="line" if place[1] else "points",
        x=floats(place[0][at]),
        y=floats(values[at]),
        text=tuple(text for text, has in zip(texts, at, strict=True) if has),
        colour=colour,
        low=low,
        high=high,
        **look,
    )


def _margin(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    eta, threshold = column(data, "restitution_factor"), column(data, "restitution_threshold")
    if eta is None:
        return
    texts = [f"{name}: restitution factor {number(one, 3)}" for name, one in zip(names, eta, strict=True)]
    if threshold is not None:
        _, low, high = with_ends(data, "restitution_threshold")
        rows = list(zip(names, eta, threshold, low, high, strict=True))
        above = [f"{name}: threshold {interval(t, a, b)}, margin {t - e:+.3f}" for name, e, t, a, b in rows]
        yield _series("threshold (95 %)", threshold, above, place, BLUE, (low, high), marker="s", size=3.0)
        texts = [
            text + (f", margin {t - e:+.3f}" if np.isfinite(t) else "")
            for text, (_, e, t, _, _) in zip(texts, rows, strict=True)
        ]
    yield _series(r"restitution factor $\eta$", eta, texts, place, BLACK, marker="o", size=3.0)


def _probability(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    stable = column(data, "probability_stable")
    if stable is None:
        return
    ends = tuple(data[f"probability_{end}"].values.astype(float) for end in ("low", "high"))
    verdict = data["verdict"].values.astype(str)
    rows = zip(names, verdict, stable, *ends, data["reason"].values.astype(str), strict=True)
    texts = [f"{name}: {word}; P(stable) {interval(*p)}. {why}".strip() for name, word, *p, why in rows]
    at = place[0], False
    for name, colour in VERDICT_COLOURS.items():
        if (verdict == name).any():
            values = np.where(verdict == name, stable, np.nan)
            yield _series(name, values, texts, at, colour, ends, marker=VERDICT_MARKERS[name])


def _frequencies(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    look: Look = {"marker": "" if place[1] else "_", "size": 13.0}
    for name, (words, colour, dashes) in FREQUENCIES.items():
        values = column(data, name)
        if values is not None:
            values = np.where(values > 0.0, values, np.nan)
            yield _series(words, values, _hertz(names, words, values), place, colour, dashes=dashes, **look)
    orbit = column(data, "orbit_frequency")
    for sign, way, marker in ((1.0, "forward", "^"), (-1.0, "backward", "v")):
        if orbit is not None and (np.sign(orbit) == sign).any():
            words = f"orbit of whirling runs, {way}"
            values = np.where(np.sign(orbit) == sign, abs(orbit), np.nan)
            texts, at = _hertz(names, words, values), (place[0], False)
            yield _series(words, values, texts, at, VERMILION, marker=marker, size=5.0)


def _hertz(names: list[str], words: str, values: Array) -> list[str]:
    return [f"{name}: {words} {significant(one, 3)} Hz" for name, one in zip(names, values, strict=True)]


def _time(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    if has_duty(data):
        share = 100.0 * data["time_share"].values.astype(float)
        pairs = zip(names, share, strict=True)
        texts = tuple(f"{name}: {significant(one, 3)} % of the time" for name, one in pairs)
        x, y = floats(place[0]), floats(share)
        yield Series(name="share of the time", kind="bars", x=x, y=y, text=texts, colour=GREY)
