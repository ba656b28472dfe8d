"""Drawn bearings of every candidate, their probabilities, what decides them, and the films they allow."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withTickedStroke

from separatrix.figures.ranking import file_name, own_environment
from separatrix.figures.stability import ETA_LABEL, EXTRAPOLATED, FRICTION_LABEL, explain_extrapolated
from separatrix.figures.style import (
    BLACK,
    CYCLE,
    GREY,
    MARKERS,
    PAGE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    Look,
    canvas,
    label_lines,
    legend_below,
)
from separatrix.ground.units import Array

OVERALL = "over all environments"
LEAST, MOST = 0.02, 7  # smallest share of an input that is drawn; most inputs, and most cases
NARROW = 0.01
"""Spread of the restitution factor below which bearings are drawn in the order of their numbers instead."""

SETTLES: Look = {"ls": "", "marker": ".", "ms": 3.5, "mew": 0.0}
OTHERS: Look = {"ls": "", "marker": "x", "ms": 2.8, "mew": 0.6}
BESIDE: Look = {"xycoords": "axes fraction", "textcoords": "offset points", "fontsize": 6.5, "color": GREY}


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `sensitivity`: of each environment, of what decides and of films, if known."""
    yield "sensitivity-probabilities", probabilities(data)
    yield "sensitivity-convergence", convergence(data)
    counted = data.sizes["sample"] > 0  # none were where the work was interrupted early
    for i, name in enumerate(data["environment"].values.astype(str) if counted else ()):
        yield f"sensitivity-{i + 1}-{file_name(name)}", bearings(data.isel(environment=i))
    if "driver_share" in data and np.isfinite(_floats(data, "driver_share")).any():
        yield "sensitivity-drivers", drivers(data)
    if "film_limit" in data:
        yield "sensitivity-film", film(data)


def _floats(data: xr.Dataset, name: str, *dims: str) -> Array:
    return np.asarray(data[name].transpose(*dims).values, dtype=float)


def _chance(data: xr.Dataset, of: str, *dims: str) -> tuple[Array, Array]:
    """Return a probability, and how far its interval reaches below and above it."""
    value, low, high = (_floats(data, f"{of}_probability_{end}", *dims) for end in ("stable", "low", "high"))
    return value, np.maximum([value - low, high - value], 0.0)


def _title(axes: Axes, title: str, text: str = "") -> None:
    rows = [row for line in text.splitlines() for row in textwrap.wrap(line, 85)]
    axes.set_title(title[:1].upper() + title[1:], pad=6 + 9 * len(rows))
    axes.annotate("\n".join(rows), (0, 1), xytext=(0, 5), **BESIDE)


def bearings(data: xr.Dataset) -> Figure:
    """Friction of every drawn bearing in one environment against its restitution factor.

    Where that hardly varies, which would put all bearings on one line, against the number of the bearing.
    """
    figure, axes = canvas(PAGE, 4.3)
    eta = _floats(data, "cloud_restitution_factor", "material", "sample")
    central = _floats(data, "material_friction")
    names, shares = data["material"].values.astype(str), _floats(data, "material_probability_stable")
    x, xlabel = np.broadcast_to(np.arange(1.0, eta.shape[1] + 1), eta.shape), "number of the bearing [-]"
    spread, limits = np.fmax.reduce(eta, axis=1) - np.fmin.reduce(eta, axis=1), (0.0, eta.shape[1] + 1.0)
    varies = bool((spread > NARROW).any())
    if varies:
        x, xlabel = eta, ETA_LABEL
        limits = max(float(np.nanmin(eta)) - 0.02, 0.0), min(float(np.nanmax(eta)) + 0.02, 1.0)
    top = 1.08 * max(0.01, *np.nan_to_num([*_floats(data, "cloud_friction").ravel(), *central]))
    axes.set(xlim=limits, ylim=(0, top), xlabel=xlabel, ylabel=FRICTION_LABEL)
    labels = []
    for i in np.flatnonzero(np.isfinite(central)):
        of, colour = data.isel(material=i), CYCLE[i % len(CYCLE)]
        friction, settles = _floats(of, "cloud_friction"), _floats(of, "cloud_settles")
        for kind, look in ((1, SETTLES), (0, OTHERS)):
            axes.plot(x[i][settles == kind], friction[settles == kind], color=colour, alpha=0.7, **look)
        middle = float(np.median([*friction[np.isfinite(friction)]] or central[i]))
        axes.axhline(middle, color=colour, lw=0.3, alpha=0.6, zorder=1)
        mark = EXTRAPOLATED if str(of["material_extrapolation"].values) else ""
        own = "" if varies or not np.isfinite(spread[i]) else rf"  $\eta$ {np.nanmedian(eta[i]):.2f}"
        share = f"{shares[i]:.2f}".replace("nan", "-")
        labels.append((limits[1], middle, f"{names[i]}  {middle:.3f}{mark}{own}  P(stable) {share}", colour))
    label_lines(axes, labels, gap=0.04)
    axes.plot([], [], color=GREY, label="a bearing whose cage settles", **SETTLES)
    axes.plot([], [], color=GREY, label="a bearing whose cage does not settle", **OTHERS)
    explain_extrapolated(axes, data["material_extrapolation"])
    axes.annotate("candidate  median friction", (1, 1), xytext=(12, 5), **BESIDE)
    absent = ", ".join(names[~np.isfinite(central)])
    _title(axes, f"{data['environment'].values}: drawn bearings", absent and f"not measured: {absent}")
    legend_below(figure, columns=3)
    return figure


def probabilities(data: xr.Dataset) -> Figure:
    """Probability that a bearing's cage settles, of every candidate in every environment and overall."""
    places = [*data["environment"].values.astype(str), OVERALL]
    rows, height = -(-len(places) // 2), 0.4 + 0.17 * data.sizes["material"]
    figure, panels = canvas(PAGE, 0.9 + rows * height, nrows=rows, ncols=2, sharex=True, squeeze=False)
    for row, (axes, place) in enumerate(zip(panels.flat, places, strict=False)):
        over = place == OVERALL
        _probabilities(axes, data if over else data.isel(environment=row), "overall" if over else "material")
        _title(axes, place)
        if row >= len(places) - 2:
            axes.set_xlabel("probability that a bearing's cage settles [-]", loc="right")
            axes.tick_params(labelbottom=True)
    panels.flat[-1].set_visible(len(places) % 2 == 0)
    first = panels[0, 0]
    for verdict, marker in VERDICT_MARKERS.items():
        first.plot([], [], marker, color=VERDICT_COLOURS[verdict], ms=4.5, label=verdict)
    first.plot([], [], color=GREY, lw=1.2, label="95 % interval")
    first.plot([], [], color=GREY, lw=0.6, ls=":", label="probabilities of 0.5 and 0.9")
    both = xr.concat([data["material_extrapolation"], data["overall_extrapolation"]], "any")
    explain_extrapolated(first, both)
    legend_below(figure, columns=3)
    return figure


def _probabilities(axes: Axes, data: xr.Dataset, prefix: str) -> None:
    """Draw one environment, or all of them: the best at the top, those not measured at the bottom."""
    (value, reach), names = _chance(data, prefix), []
    for place, i in enumerate(np.argsort(np.nan_to_num(value, nan=-1.0), kind="stable")):
        verdict = str(data[f"{prefix}_verdict"].values[i])
        colour, sign = VERDICT_COLOURS.get(verdict, GREY), VERDICT_MARKERS.get(verdict, ".")
        axes.errorbar(value[i], place, xerr=reach[:, [i]], fmt=sign, ms=4.5, color=colour, capsize=1.5)
        mark = EXTRAPOLATED if str(data[f"{prefix}_extrapolation"].values[i]) else ""
        names.append(f"{data['material'].values[i]}{mark}{'' if value[i] >= 0 else ': not measured'}")
    axes.vlines([0.5, 0.9], -1, len(names), color=GREY, lw=0.6, ls=":", zorder=0)
    axes.set_yticks(range(len(names)), names, fontsize=6.5)
    axes.set(xlim=(-0.02, 1.02), ylim=(-0.6, len(names) - 0.4))
    axes.tick_params(axis="y", length=0)


def convergence(data: xr.Dataset) -> Figure:
    """P(stable) of the least decided candidate of each place against the number of bearings."""
    figure, axes = canvas(PAGE, 3.4)
    size, places = _floats(data, "size"), data["place"].values.astype(str)
    ticks: list[float] = []
    for row, (place, colour, marker) in enumerate(zip(places, cycle(CYCLE), cycle(MARKERS), strict=False)):
        value, reach = _chance(data.isel(place=row), "convergence", "material", "size")
        known = {i: np.flatnonzero(np.isfinite(one)) for i, one in enumerate(value) if np.isfinite(one).any()}
        for i in sorted(known, key=lambda i: abs(value[i, known[i][-1]] - 0.5))[:1]:
            x, label = size[known[i]], f"{data['material'].values[i]}, {place or OVERALL}"
            y, ends, shift = value[i, known[i]], reach[:, i, known[i]], 1.0 + 0.03 * (row - len(places) / 2)
            axes.errorbar(x * shift, y, yerr=ends, marker=marker, color=colour, ms=3.5, lw=0.8, label=label)
            ticks = sorted({*ticks, *x})
    apart = [one for k, one in enumerate(ticks) if k == 0 or one > 1.15 * ticks[k - 1]]
    axes.set(xscale="log", ylim=(-0.02, 1.02), xlabel="number of bearings [-]", ylabel="P(stable) [-]")
    axes.set_xticks(apart, [f"{one:g}" for one in apart])
    if ticks:
        axes.set_xlim(0.6 * ticks[0], 1.6 * ticks[-1])
    axes.minorticks_off()
    axes.set_title("P(stable) of the least decided candidate of each environment, with its 95 % interval")
    legend_below(figure)
    return figure


def drivers(data: xr.Dataset) -> Figure:
    """Show which inputs decide whether a cage settles, and whether the fit behind it predicts the counts."""
    known = np.isfinite(_floats(data, "driver_share", "environment", "material", "driver")).any(axis=2)
    stable = _floats(data, "material_probability_stable", "environment", "material")
    cases = sorted(sorted(np.argwhere(known).tolist(), key=lambda case: abs(stable[*case] - 0.5))[:MOST])
    parts = [data.isel(environment=e, material=m) for e, m in cases]
    shares = _shares(parts)
    height = max(1.7 + len(shares) * (0.1 + 0.055 * len(cases)), 3.4)
    figure, (left, right) = canvas(PAGE, height, ncols=2, width_ratios=(1.35, 1.0))
    for k, part in enumerate(parts):
        look: Look = {"color": CYCLE[k], "marker": MARKERS[k], "ms": 3.5}
        value, low, high = np.array([rows[:, k] for rows in shares.values()]).T
        y = np.arange(len(shares)) + 0.7 * ((k + 0.5) / len(cases) - 0.5)
        reach = np.maximum([value - low, high - value], 0.0)
        label = f"{part['material'].values}, {part['environment'].values}"
        left.errorbar(value, y, xerr=reach, ls="", elinewidth=0.8, label=label, **look)
        predicted, counted = (_floats(part, f"calibration_{kind}") for kind in ("predicted", "counted"))
        right.plot(predicted, counted, lw=0.8, **look)
    for place in range(0, len(shares), 2):
        left.axhspan(place - 0.5, place + 0.5, color=GREY, alpha=0.08, lw=0)
    left.set_yticks(range(len(shares)), [textwrap.fill(name, 26) for name in shares], fontsize=6.5)
    left.tick_params(axis="y", length=0)
    left.set(ylim=(len(shares) - 0.5, -0.5), xlabel="share of the variance of the logit\nof P(settles) [-]")
    left.set(xlim=(min(left.get_xlim()[0], -0.02), 1.02), title="a  Inputs that matter most, 95 % intervals")
    right.plot([0, 1], [0, 1], color=BLACK, lw=0.6, ls="--", label="counted as predicted")
    right.set(xlim=(-0.02, 1.02), xlabel="predicted P(settles) [-]", title="b  Bearings left out of the fit")
    right.set(ylim=(-0.02, 1.02), ylabel="counted share that settles [-]", aspect="equal", anchor="N")
    legend_below(figure)
    return figure


def _shares(parts: list[xr.Dataset]) -> dict[str, Array]:
    """Return the inputs to draw, each with share, low and high end of every case; chance comes last."""
    table = np.array([[_floats(of, f"driver_share{end}") for of in parts] for end in ("", "_low", "_high")])
    found: dict[str, list[Array]] = {}
    for column, key in enumerate(parts[0]["driver"].values.astype(str)):
        name = f"the candidate's own {key.partition('.material.')[2] or 'pocket friction'}"
        rows = found.setdefault(name if key.startswith("ranking.") else key, [])
        rows.append(table[:, :, column])  # of candidates' own inputs each case has but one
    joined = {name: np.fmax.reduce(rows) for name, rows in found.items()}
    largest = {name: np.nan_to_num(rows[0]).max() for name, rows in joined.items()}
    *others, chance = joined
    chosen = sorted((name for name in others if largest[name] >= LEAST), key=lambda name: -largest[name])
    return {name: joined[name] for name in [*chosen[:MOST], chance]}


def film(data: xr.Dataset) -> Figure:
    """Which film keeps each candidate stable: lines in the plane of thickness and race friction."""
    figure, axes = canvas(PAGE, 4.3)
    thickness, friction = 1e6 * _floats(data, "film_thickness")[1:], _floats(data, "race_friction")
    axes.set(xscale="log", yscale="log", xlim=thickness[[0, -1]], ylim=friction[[0, -1]])
    axes.set(xlabel="film thickness [\N{MICRO SIGN}m]", ylabel="friction of ball on race [-]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    axes.set_yticks(friction)
    axes.minorticks_off()
    factor = _floats(data, "film_restitution_factor", "material", "race_friction", "film_thickness")
    below = _floats(data, "film_limit")[:, None, None] - factor[:, :, 1:]  # 0 on the line, allowed above
    names, labels = data["material"].values.astype(str), []
    for i in np.flatnonzero([one.min() < 0.0 <= one.max() for one in below]):
        colour = CYCLE[i % len(CYCLE)]
        lines = axes.contour(thickness, friction, below[i], levels=[0.0], colors=[colour], linewidths=1.2)
        lines.set(path_effects=[withTickedStroke(angle=90, spacing=9, length=0.5)])
        points = np.concatenate([path.vertices for path in lines.get_paths()])
        end, y = points[np.argmax(points[:, 0])].tolist()
        labels.append((round(y, 9), -end, names[i], colour))
    at_edge = [(float(thickness[-1]), y, name, colour) for y, _, name, colour in sorted(labels)]
    label_lines(axes, at_edge, gap=0.045)  # of lines that end at the top, the first from the left is highest
    label = f"ticks: the side of the films with P(stable) of {float(data['film_probability']):.2f} or more"
    axes.plot([], [], color=GREY, lw=1.2, label=label, path_effects=[withTickedStroke(angle=90, length=0.5)])
    here = 1e6 * float(data["film_thickness_here"]), float(data["race_friction_here"])
    axes.plot(*here, "o", ms=4.5, color=BLACK, clip_on=False, label="film of the study")
    own, text = own_environment(data), ""
    every, no_film = below.min(axis=(1, 2)) >= 0.0, below.max(axis=(1, 2)) < 0.0
    for these, words in ((every, "every film here is allowed"), (no_film, "no film here is allowed")):
        text += f"{words}: {', '.join(names[these])}\n" if these.any() else ""
    where = "" if own is None else f" in {data['environment'].values[own]}"
    _title(axes, f"Films that keep the cage stable{where}", text)
    legend_below(figure)
    return figure
