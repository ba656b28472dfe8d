"""The operating envelope: margin, P(stable) and frequencies over the cases of a sweep, and their texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from separatrix.figures.hover import Plot, Series, floats, plain
from separatrix.figures.map import MOST_PANELS, axis_label, axis_values, is_proportional, sweep
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
from separatrix.present.text.tables import interval, number, significant
from separatrix.units import Array, format_quantity

MOST_CASES = 60
"""Cases of several parameters that are drawn side by side."""

MOST_WORDS = 9
"""Cases below which their values are written under the axis."""

ORDERS = {
    "inner_pass_frequency": ("balls past the inner ring", PURPLE, (0, (1, 1))),
    "outer_pass_frequency": ("balls past the outer ring", ORANGE, (0, (4, 1, 1, 1))),
    "shaft_frequency": ("shaft, 1x", BLUE, (0, (5, 2))),
    "cage_frequency": ("cage and ball set, 1x", GREEN, (0, (3, 1.5))),
}
"""Orders of the bearing: words, colour and dashes."""

SENTENCES = {
    "margin": "lowest margin, {:.3f}",
    "probability_stable": "lowest P(stable), {:.3g}",
    "restitution_factor": "highest restitution factor, {:.3f}",
}
"""What decides the worst case."""

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
    panels: list[tuple[float, Callable[[Axes, xr.Dataset, Place], None]]] = []
    if column(data, "restitution_factor") is not None:
        panels.append((1.5, _margin))
    if column(data, "probability_stable") is not None:
        panels.append((1.1, _probability))
    panels.append((1.9, _frequencies))
    if has_duty(data):
        panels.append((0.8, _time))
    heights = [height for height, _ in panels]
    look: Look = {"nrows": len(panels), "sharex": True, "squeeze": False, "height_ratios": heights}
    figure, grid = canvas(PAGE, sum(heights) + 0.9, **look)
    axes, place = [row[0] for row in grid], places(data)
    for one, (_, draw) in zip(axes, panels, strict=True):
        draw(one, data, place)
        if one.get_legend_handles_labels()[0]:
            one.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
    _name_axis(axes[-1], data, place)
    _name_worst(axes, data, place)
    _mark_refused(axes[0], data, place)
    return figure


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


def _margin(axes: Axes, data: xr.Dataset, place: Place) -> None:
    """Draw the restitution factor below its threshold; the distance is the margin."""
    x, is_line = place
    eta = np.asarray(data["restitution_factor"].values, dtype=float)
    axes.plot(x, eta, "o-" if is_line else "o", ms=3.0, color=BLACK, label=r"restitution factor $\eta$")
    threshold, top = column(data, "restitution_threshold"), float(np.nanmax(eta))
    if threshold is not None:
        top = 1.0
        _, low, high = with_ends(data, "restitution_threshold")
        error = np.abs(np.stack([threshold - low, high - threshold]))
        look: Look = {"ms": 3.0, "color": BLUE, "elinewidth": 0.8, "capsize": 1.5}
        axes.errorbar(x, threshold, error, fmt="s-" if is_line else "s", label="threshold (95 %)", **look)
        for words, colour, those in (
            ("margin", SKY, eta <= threshold),
            ("beyond the threshold", VERMILION, eta > threshold),
        ):
            band: Look = {"color": colour, "alpha": 0.4, "label": words, "zorder": 0}
            if those.any() and is_line:
                axes.fill_between(x, eta, threshold, where=those, interpolate=True, lw=0.0, **band)
            elif those.any():
                axes.vlines(x[those], eta[those], threshold[those], lw=5.0, **band)
    axes.set(ylim=(-0.03 * top, 1.08 * top), ylabel=r"$\eta$ [-]")


def _probability(axes: Axes, data: xr.Dataset, place: Place) -> None:
    x, _ = place
    value, low, high = (data[f"probability_{end}"].values.astype(float) for end in ("stable", "low", "high"))
    verdict = data["verdict"].values.astype(str)
    for name, colour in VERDICT_COLOURS.items():
        those = verdict == name
        if those.any():
            error = np.abs(np.stack([value - low, high - value]))[:, those]
            look: Look = {"fmt": VERDICT_MARKERS[name], "ms": 4.0, "elinewidth": 0.8, "capsize": 1.5}
            axes.errorbar(x[those], value[those], error, color=colour, label=name, **look)
    axes.set(ylim=(-0.06, 1.06), yticks=(0.0, 0.5, 1.0), ylabel="P(stable) [-]")


def _frequencies(axes: Axes, data: xr.Dataset, place: Place) -> None:
    """Draw the whirl without clearance and the orbits of whirling runs among the orders of the bearing."""
    x, is_line = place
    stroke: Look = {} if is_line else {"ls": "", "marker": "_", "ms": 13.0, "mew": 1.6}
    linear = column(data, "linear_whirl_frequency")
    if linear is not None:
        axes.plot(x, linear, color=BLACK, label="whirl without clearance", **stroke)
    for name, (words, colour, dashes) in ORDERS.items():
        values = np.asarray(data[name].values, dtype=float)
        look = {"ls": dashes} if is_line else stroke
        axes.plot(x, np.where(values > 0.0, values, np.nan), color=colour, label=words, **look)
    orbit = column(data, "orbit_frequency")
    for sign, marker, words in ((1.0, "^", "forward"), (-1.0, "v", "backward")):
        those = np.zeros(x.size, bool) if orbit is None else np.sign(orbit) == sign
        if orbit is not None and those.any():
            label = f"orbit of whirling runs, {words}"
            axes.plot(x[those], np.abs(orbit[those]), marker, ls="", ms=5.0, color=VERMILION, label=label)
    axes.set(yscale="log", ylabel="frequency [Hz]")
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("")


def _time(axes: Axes, data: xr.Dataset, place: Place) -> None:
    x, _ = place
    step = float(np.diff(np.sort(x)).min()) if x.size > 1 else 1.0
    axes.bar(x, 100.0 * data["time_share"].values.astype(float), width=0.6 * step, color=GREY)
    axes.set_ylabel("time [%]")


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
    why = SENTENCES[str(data["worst_quantity"].values)].format(float(data["worst_value"]))
    why = why.replace("-", "\N{MINUS SIGN}")
    if alike == int(data["worst_compared"]) > 1:
        return None, f"no worst case: all {alike} have the {why}"
    at = place[0][data["case"].values == case][0]
    name = str(data["parameter"].values[0])
    value = data[name].values[data["case"].values == case][0]
    words = f"{name.rpartition('.')[2].replace('_', ' ')} {format_quantity(value, data[name].attrs['units'])}"
    which = (words if place[1] else f"case {case}") + f" and {alike - 1} more" * (alike > 1)
    return float(at), f"{which}: {why}"


def _name_worst(panels: list[Axes], data: xr.Dataset, place: Place) -> None:
    """Mark the worst case in every panel, and name it with its reason above them."""
    found = worst(data, place)
    if found is None:
        return
    at, words = found
    if at is None:
        panels[0].set_title(words)
        return
    for axes in panels:
        axes.axvline(at, color=VERMILION, lw=0.9, ls=(0, (1, 2)), zorder=0)
    panels[0].set_title(f"worst case (dotted line): {words}", color=VERMILION)


def _mark_refused(axes: Axes, data: xr.Dataset, place: Place) -> None:
    refused = np.isnan(data["restitution_factor"].values.astype(float))
    if refused.any() and not refused.all():
        foot = axes.get_xaxis_transform()
        look: Look = {"color": GREY, "transform": foot, "clip_on": False, "label": "refused: see reason"}
        axes.plot(place[0][refused], np.full(refused.sum(), 0.04), "x", ls="", ms=4.0, **look)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)


def envelope_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of the operating envelope from the top, as `figures.envelope` draws them."""
    place, names = places(data), _names(data)
    panels = [("\N{GREEK SMALL LETTER ETA} [-]", [*_margin_series(data, place, names)])]
    panels.append(("P(stable) [-]", [*_probability_series(data, place, names)]))
    panels.append(("frequency [Hz]", [*_frequencies_series(data, place, names)]))
    panels.append(("time [%]", [*_time_series(data, place, names)]))
    drawn = [(label, series) for label, series in panels if series]
    title, found = "Operating envelope", worst(data, place)
    if found is not None:
        at, words = found
        title = words if at is None else f"Worst case: {words}"
        if at is not None:
            drawn[0][1].append(Series(name="", kind="upright", x=(at,), y=(None,), colour=VERMILION))
    only = str(data["parameter"].values[0])
    return tuple(
        Plot(
            title=title,
            x_label=plain(axis_label(data, only, only)) if place[1] else "case",
            y_label=label,
            series=tuple(series),
            x_log=place[1] and is_proportional(place[0]),
            y_log=label.startswith("frequency"),
        )
        for label, series in drawn
    )


def sweep_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of a sweep of several parameters, as `figures.sweep` draws them: cases by verdict."""
    eta, verdict = data["restitution_factor"].values.astype(float), data["verdict"].values.astype(str)
    rows = zip(_names(data), eta, verdict, strict=True)
    texts = [f"{name}: restitution factor {number(e, 3)}{v and f', {v}'}" for name, e, v in rows]
    groups = [("cases", "", BLACK), *((v, v, c) for v, c in VERDICT_COLOURS.items())]
    return tuple(
        Plot(
            title="Restitution factor of every case",
            x_label=plain(axis_label(data, name, name)),
            y_label=plain(ETA_LABEL),
            series=tuple(
                _series(words, np.where(verdict == known, eta, np.nan), texts, (at, False), colour)
                for words, known, colour in groups
                if (verdict == known).any()
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
    name: str, values: Array, texts: list[str], place: Place, colour: str, ends: tuple[Array, ...] = ()
) -> Series:
    """Return the finite values of the cases as a line, or as points where lines have no meaning."""
    at = np.isfinite(values)
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
    )


def _margin_series(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    eta, threshold = column(data, "restitution_factor"), column(data, "restitution_threshold")
    if eta is None:
        return
    texts = [f"{name}: restitution factor {number(one, 3)}" for name, one in zip(names, eta, strict=True)]
    if threshold is not None:
        _, low, high = with_ends(data, "restitution_threshold")
        rows = list(zip(names, eta, threshold, low, high, strict=True))
        above = [f"{name}: threshold {interval(t, a, b)}, margin {t - e:+.3f}" for name, e, t, a, b in rows]
        yield _series("threshold (95 %)", threshold, above, place, BLUE, (low, high))
        texts = [
            text + (f", margin {t - e:+.3f}" if np.isfinite(t) else "")
            for text, (_, e, t, _, _) in zip(texts, rows, strict=True)
        ]
    yield _series("restitution factor", eta, texts, place, BLACK)


def _probability_series(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    stable = column(data, "probability_stable")
    if stable is None:
        return
    ends = tuple(data[f"probability_{end}"].values.astype(float) for end in ("low", "high"))
    verdict = data["verdict"].values.astype(str)
    rows = zip(names, verdict, stable, *ends, data["reason"].values.astype(str), strict=True)
    texts = [f"{name}: {word}; P(stable) {interval(*p)}. {why}".strip() for name, word, *p, why in rows]
    for name, colour in VERDICT_COLOURS.items():
        if (verdict == name).any():
            values = np.where(verdict == name, stable, np.nan)
            yield _series(name, values, texts, (place[0], False), colour, ends)


def _frequencies_series(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    rows = [("linear_whirl_frequency", "whirl without clearance", BLACK)]
    rows += [(name, words, colour) for name, (words, colour, _) in ORDERS.items()]
    for name, words, colour in rows:
        values = column(data, name)
        if values is not None:
            values = np.where(values > 0.0, values, np.nan)
            yield _series(words, values, _hertz(names, words, values), place, colour)
    orbit = column(data, "orbit_frequency")
    for sign, way in ((1.0, "forward"), (-1.0, "backward")):
        if orbit is not None and (np.sign(orbit) == sign).any():
            words = f"orbit of whirling runs, {way}"
            values = np.where(np.sign(orbit) == sign, abs(orbit), np.nan)
            yield _series(words, values, _hertz(names, words, values), (place[0], False), VERMILION)


def _hertz(names: list[str], words: str, values: Array) -> list[str]:
    return [f"{name}: {words} {significant(one, 3)} Hz" for name, one in zip(names, values, strict=True)]


def _time_series(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    if has_duty(data):
        share = 100.0 * data["time_share"].values.astype(float)
        pairs = zip(names, share, strict=True)
        texts = tuple(f"{name}: {significant(one, 3)} % of the time" for name, one in pairs)
        x, y = floats(place[0]), floats(share)
        yield Series(name="share of the time", kind="bars", x=x, y=y, text=texts, colour=GREY)
