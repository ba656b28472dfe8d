"""A page for each friction test: friction with its steady mean, distribution, correlation, spectra."""

from __future__ import annotations

import json
import textwrap

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.typing import HashableList

from separatrix.figures.style import (
    BLUE,
    GREEN,
    GREY,
    LINE,
    ORANGE,
    PAGE,
    SKY,
    VERMILION,
    Json,
    Look,
    journal,
    literal,
    settled,
)
from separatrix.friction.friction_file import in_words
from separatrix.friction.reduction import GIVEN
from separatrix.ground.units import format_number, format_quantity

ROWS = 2.1
"""Height of a row of panels [inch]."""

WIDTH = 136
"""Letters on a line of the heading."""

MOST_LINES = 3
"""Lines that one flag may take."""

WHITE: Look = {"frameon": True, "framealpha": 0.9, "edgecolor": "none"}
"""Look of a legend over lines."""

NAMES = {"time": "time", "distance": "sliding distance", "cycles": "cycles"}

SCALES = {
    "time": ((3600.0, "h"), (60.0, "min"), (1.0, "s")),
    "distance": ((1000.0, "km"), (1.0, "m"), (1e-3, "mm")),
    "cycles": ((1.0, "-"),),
}
"""Sizes and names of the units an abscissa may be drawn in, the largest first."""

BESIDE = {
    "normal_force": ("normal force [N]", 1.0),
    "temperature": ("temperature [K]", 1.0),
    "wear_depth": ("wear depth [\N{MICRO SIGN}m]", 1e6),
    "slip_speed": ("slip speed [m/s]", 1.0),
}
"""What is drawn in the last row if the log has it: label and factor."""


def page(data: xr.Dataset) -> Figure:
    """Return the page of one test, from `present.tribometer.page_data` or a file of it."""
    beside = [name for name in BESIDE if f"trace_{name}" in data][:3]
    lines = heading(data)
    rows = [row for row in (["trace"], ["histogram", "lags", "spectrum"], beside) if row]
    panels: list[HashableList[str]] = [[one for one in row for _ in range(6 // len(row))] for row in rows]
    heights = [2.4, ROWS, 0.8 * ROWS][: len(panels)]
    with journal():
        figure = Figure(figsize=(PAGE, sum(heights) + LINE * len(lines)), layout="constrained")
        axes = figure.subplot_mosaic(panels, height_ratios=heights)
        _trace(axes["trace"], data)
        _distribution(axes["histogram"], data)
        _correlation(axes["lags"], data)
        _spectrum(axes["spectrum"], data)
        for letter, name in zip("efg", beside, strict=False):
            _beside(axes[name], data, name, letter)
        figure.suptitle("\n".join(lines), x=0.008, ha="left", fontsize=7.0, linespacing=1.35)
        return settled(figure)


def heading(data: xr.Dataset) -> list[str]:
    """Return the lines above the page: which test, its conditions, its numbers, its flags."""
    parts = [str(data.attrs["title"]), conditions(data), numbers(data)]
    lines = [line for part in parts if part for line in _wrapped(part, WIDTH)]
    for flag in json.loads(data.attrs["flags"]):
        first, *rest = _wrapped(flag, WIDTH - 2)
        lines += [f"\N{BULLET} {first}", *(f"   {line}" for line in rest)]
    return [literal(line) for line in lines]


def _wrapped(text: str, width: int) -> list[str]:
    return textwrap.wrap(text, width, max_lines=MOST_LINES, placeholder=" ...") or [""]


def conditions(data: xr.Dataset) -> str:
    """Return material, counterface, medium and loads of the test, as far as the log states them."""
    known: Json = json.loads(data.attrs["conditions"])
    pair = " on ".join(str(known[key]) for key in ("material", "counterface") if known.get(key))
    named = [pair, known.get("medium") or ""]
    named += [f"{key} {known[key]}" for key in ("sample", "test") if known.get(key)]
    for key, unit, words in (
        ("temperature", "K", ""),
        ("slip_speed", "m/s", ""),
        ("pressure", "Pa", " mean pressure"),
        ("normal_force", "N", " normal force"),
        ("cycle_time", "s", " a cycle"),
    ):
        if known.get(key) is not None:
            named.append(f"{format_quantity(known[key], unit)}{words}")
    if known.get("slip_speed") is not None and known.get("pressure") is not None:
        product = 1e-6 * known["slip_speed"] * known["pressure"]
        named.append(f"pV {format_number(product)} MPa m/s")
    return "; ".join(part for part in named if part)


def numbers(data: xr.Dataset) -> str:
    """Return the friction of the test with its interval, and what it was made from."""
    mean, half, error = (float(data[name]) for name in ("friction", "half_width", "standard_error"))
    cycles, axis = data.attrs["cycles"], str(data.attrs["axis"])
    start, end = (in_words(float(data[name]), axis) for name in ("run_in_end", "steady_end"))
    start += " (given)" if data.attrs["run_in_method"] == GIVEN else ""
    return (
        f"Friction {format_number(mean)} \N{PLUS-MINUS SIGN} {format_number(half, 2)} (95 %) from {start} "
        f"to {end}; standard error {format_number(error, 2)}, {data.attrs['degrees_of_freedom']} degrees of "
        f"freedom; scatter {format_number(float(data['standard_deviation']), 2)} of "
        f"{f'{cycles} whole cycles' if cycles else str(data.attrs['steady_rows']) + ' rows'}, "
        f"worth {format_number(float(data['effective_count']), 3)} independent ones"
    )


def scale(data: xr.Dataset) -> tuple[float, str]:
    """Return size and label of the unit in which the abscissa is drawn."""
    axis = str(data.attrs["axis"])
    longest = float(np.asarray(data["trace"].values)[-1])
    choices = SCALES[axis]
    size, symbol = next((choice for choice in choices if longest >= 3.0 * choice[0]), choices[-1])
    return size, f"{NAMES[axis]} [{symbol}]"


def _trace(axes: Axes, data: xr.Dataset) -> None:
    """Draw friction along the test, the parts left out, means of spans and the steady mean."""
    size, label = scale(data)
    along = np.asarray(data["trace"].values) / size
    start, end = float(data["run_in_end"]) / size, float(data["steady_end"]) / size
    first, last = along[0], along[-1]
    axes.fill_between(along, data["trace_low"], data["trace_high"], color=SKY, alpha=0.35, lw=0, label="rows")
    cycles = float(data["span_cycles"])
    spans = f"{format_number(cycles, 2)} cycle{'s' if cycles > 1 else ''}" if cycles else "spans"
    axes.plot(along, data["trace_mean"], color=BLUE, lw=0.6, zorder=2.5)
    axes.plot(
        data["span"] / size,
        data["span_mean"],
        ".",
        color=BLUE,
        ms=3,
        mew=0,
        zorder=2.6,
        label=f"means of {spans}",
    )
    mean, half = float(data["friction"]), float(data["half_width"])
    drift = float(data["drift_rate"]) * size * (end - start) / 2
    axes.fill_between([start, end], mean - half, mean + half, color=VERMILION, alpha=0.2, lw=0)
    axes.plot([start, end], [mean, mean], color=VERMILION, lw=1.2, label="steady mean, 95 % interval")
    axes.plot([start, end], [mean - drift, mean + drift], color=GREEN, lw=0.9, ls=(0, (5, 2)), label="drift")
    outside = [(a, b) for a, b in ((first, start), (end, last)) if b - a > 2e-3 * (last - first)]
    for i, (a, b) in enumerate(outside):
        axes.axvspan(a, b, color=GREY, alpha=0.18, lw=0, label="left out" if i == 0 else None)
    axes.set(xlabel=label, ylabel="friction [-]", xlim=(first, last))
    axes.set_title("a  Friction along the test", pad=16)
    axes.set_ylim(*_limits(data))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.99), ncols=6, fontsize=6.5, handlelength=1.6)


def _limits(data: xr.Dataset) -> tuple[float, float]:
    low, high = float(data["trace_low"].min()), float(data["trace_high"].max())
    low = min(low, 0.0) if low < 0.5 * high else low
    room = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    return (low if low == 0.0 else low - room), high + room


def _distribution(axes: Axes, data: xr.Dataset) -> None:
    edges = np.asarray(data["edge"].values)
    axes.stairs(100 * data["row_share"].values, edges, fill=True, color=SKY, alpha=0.6, label="rows")
    if "cycle_share" in data:
        axes.stairs(100 * data["cycle_share"].values, edges, color=BLUE, lw=1.0, label="whole cycles")
    mean, half = float(data["friction"]), float(data["half_width"])
    axes.axvspan(mean - half, mean + half, color=VERMILION, alpha=0.2, lw=0)
    axes.axvline(mean, color=VERMILION, lw=1.0, label="mean")
    axes.set(xlabel="friction [-]", ylabel="share of the steady part [%]", title="b  Distribution")
    axes.set_ylim(0.0, 1.45 * axes.get_ylim()[1])
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.legend(loc="upper center", ncols=3, handlelength=1.0, columnspacing=1.0, fontsize=6.5, **WHITE)


def _correlation(axes: Axes, data: xr.Dataset) -> None:
    """Draw the correlation of spans against their distance, with the length from the spectrum."""
    size, label = scale(data)
    lag = np.asarray(data["lag"].values) / size
    bound = 2.0 / np.sqrt(data.sizes["span"])
    axes.axhspan(-bound, bound, color=GREY, alpha=0.15, lw=0, label="white noise, 95 %")
    axes.vlines(lag, 0.0, data["correlation"].values, color=BLUE, lw=0.8)
    axes.axhline(0.0, color=GREY, lw=0.5)
    length = float(data["correlation_length"]) / size
    if length > lag[1] / 4:
        axes.axvline(length, color=ORANGE, lw=1.0, label="correlation time")
    axes.set_xlabel(f"lag in {label}")
    axes.set(ylabel="autocorrelation [-]", ylim=(-0.6, 1.6), xlim=(0.0, lag[-1]))
    axes.set_title("c  Autocorrelation")
    axes.legend(loc="upper right", fontsize=6.5, handlelength=1.4, **WHITE)


def _spectrum(axes: Axes, data: xr.Dataset) -> None:
    """Draw the spectrum of the rows, the cycle's frequency and the strongest oscillation."""
    unit = {"time": "Hz", "distance": "1/m", "cycles": "1/cycle"}[str(data.attrs["axis"])]
    frequency = np.asarray(data["frequency"].values)
    axes.set(xlabel=f"frequency [{unit}]", title="d  Spectrum of the rows")
    axes.set_ylabel(f"density [{'1/Hz' if unit == 'Hz' else 'm' if unit == '1/m' else 'cycle'}]")
    if frequency.size < 3 or not data["cosine_power"].any():
        words = "too few rows" if frequency.size < 3 else "no noise"
        axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", color=GREY)
        return
    axes.plot(frequency[1:], data["density"].values[1:], color=BLUE, lw=0.7)
    axes.set(yscale="log", xlim=(0.0, frequency[-1]))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * (high / low) ** 0.3)
    found = float(data["stick_slip_frequency"])
    if found > 0.0:
        amplitude = format_number(float(data["stick_slip_amplitude"]), 2)
        words = f"{format_number(found, 3)} {unit}: {amplitude} peak to peak"
        axes.axvline(found, color=VERMILION, lw=0.8, ls=(0, (3, 2)), label=words)
        axes.legend(loc="upper right", fontsize=6.5, handlelength=1.6)


def _beside(axes: Axes, data: xr.Dataset, name: str, letter: str) -> None:
    size, label = scale(data)
    words, factor = BESIDE[name]
    axes.plot(data["trace"] / size, factor * data[f"trace_{name}"], color=BLUE, lw=0.8)
    for place in (float(data["run_in_end"]) / size, float(data["steady_end"]) / size):
        axes.axvline(place, color=GREY, lw=0.6, ls=(0, (3, 2)))
    axes.set(xlabel=label, ylabel=words, title=f"{letter}  {words.split(' [')[0].capitalize()}")
