"""The operating envelope: margin, P(stable) and frequencies over the cases of a sweep; the worst named."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from separatrix.figures import map
from separatrix.figures.map import axis_label, axis_values, is_proportional
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
)
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
"""Where each case lies along the axis, and whether lines between them have a meaning."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `sweep`; one without a finished case has none."""
    yield from map.sweep_figures(data)
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
    ratios: Look = {"height_ratios": heights}
    figure, grid = canvas(
        PAGE, sum(heights) + 0.9, nrows=len(panels), sharex=True, squeeze=False, gridspec_kw=ratios
    )
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
    """Draw the restitution factor below its threshold; what lies between is the margin."""
    x, is_line = place
    eta = np.asarray(data["restitution_factor"].values, dtype=float)
    axes.plot(x, eta, "o-" if is_line else "o", ms=3.0, color=BLACK, label=r"restitution factor $\eta$")
    threshold, top = column(data, "restitution_threshold"), float(np.nanmax(eta))
    if threshold is not None:
        top = 1.0
        low, high = (data[f"restitution_threshold_{end}"].values.astype(float) for end in ("low", "high"))
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
    """Draw P(stable) with its interval, marked by verdict."""
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
    """Draw the share of the time that each case takes."""
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
    """Return where the worst case lies, and which it is and why; no place where all cases are alike."""
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
    """Mark the worst case in every panel, and say above which and why; not where all are alike."""
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
    """Mark cases without a restitution factor at the foot of the first panel."""
    refused = np.isnan(data["restitution_factor"].values.astype(float))
    if refused.any() and not refused.all():
        foot: Any = axes.get_xaxis_transform()
        look: Look = {"color": GREY, "transform": foot, "clip_on": False, "label": "refused: see reason"}
        axes.plot(place[0][refused], np.full(refused.sum(), 0.04), "x", ls="", ms=4.0, **look)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
