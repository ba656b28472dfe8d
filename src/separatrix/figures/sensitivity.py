"""Drawn bearings of every candidate, their probabilities, what decides them, and the films they allow."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withTickedStroke
from matplotlib.ticker import NullLocator

from separatrix.figures.ranking import file_name, own_environment, untested
from separatrix.figures.stability import ETA_LABEL, FRICTION_LABEL
from separatrix.figures.style import (
    BLACK,
    CYCLE,
    GREY,
    MARK,
    MARKERS,
    PAGE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    canvas,
    label_lines,
    legend_below,
)
from separatrix.units import Array

OVERALL = "over all environments"
OWN = "its own "
FRICTION = "pocket friction"
LEAST, MOST = 0.02, 7
"""Smallest share of an input that is drawn, and the most inputs and cases."""


def each(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the figures of the environments, of what decides, and of the film if there is one."""
    yield from environments(data)
    if "driver_share" in data and np.isfinite(_floats(data, "driver_share")).any():
        yield "sensitivity-drivers", drivers(data)
    if "film_allowed" in data:
        yield "sensitivity-film", film(data)


def environments(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield a figure for each environment: every candidate's bearings, on the same axes."""
    top = 1.08 * float(np.nanmax(_floats(data, "cloud_friction"), initial=0.01))
    eta = _floats(data, "cloud_restitution_factor")
    eta = eta[np.isfinite(eta)] if np.isfinite(eta).any() else np.array([0.0, 1.0])
    space = max(0.05 * float(np.ptp(eta)), 0.02)
    limits = max(float(eta.min()) - space, 0.0), min(float(eta.max()) + space, 1.0)
    for i, name in enumerate(data["environment"].values.astype(str)):
        figure, axes = canvas(PAGE, 4.3)
        axes.set(xlim=limits, ylim=(0, top), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
        _bearings(axes, data.isel(environment=i))
        legend_below(figure, columns=3)
        yield f"sensitivity-{i + 1}-{file_name(name)}", figure


def _floats(data: xr.Dataset, name: str, *dims: str) -> Array:
    """Return numbers with NaN where they are absent; the dimensions in this order if given."""
    return data[name].transpose(*dims).values.astype(float)


def _headed(axes: Axes, title: str, lines: list[str]) -> None:
    """Write a title, and below it further lines in grey, all above the axes."""
    rows = [row for line in lines for row in textwrap.wrap(line, 100)]
    axes.set_title(_capital(title), pad=6 + 9 * len(rows))
    beside: Any = {"xycoords": "axes fraction", "textcoords": "offset points"}
    axes.annotate("\n".join(rows), (0, 1), xytext=(0, 5), fontsize=6.5, color=GREY, **beside)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _bearings(axes: Axes, data: xr.Dataset) -> None:
    """Draw the bearings of the candidates in one environment, and write the names at the right."""
    central, right, labels = _floats(data, "material_friction"), axes.get_xlim()[1], []
    for i in np.flatnonzero(np.isfinite(central)):
        at, colour = data.isel(material=i), CYCLE[i % len(CYCLE)]
        eta, friction, settles = (
            _floats(at, f"cloud_{name}") for name in ("restitution_factor", "friction", "settles")
        )
        look: Any = {"color": colour, "ls": ""}
        axes.plot(eta[settles == 1], friction[settles == 1], ".", ms=3.0, mew=0, alpha=0.6, **look)
        axes.plot(eta[settles == 0], friction[settles == 0], "x", ms=2.8, mew=0.6, alpha=0.8, **look)
        known = np.isfinite(eta) & np.isfinite(friction)
        middle = float(np.median(friction[known])) if known.any() else float(central[i])
        if known.any():
            axes.plot([np.median(eta[known]), right], [middle] * 2, color=colour, lw=0.3, alpha=0.6, zorder=1)
        mark = MARK if str(at["material_extrapolation"].values) else ""
        share = float(_floats(at, "material_probability_stable"))
        chance = f"  P(stable) {share:.2f}" if np.isfinite(share) else ""
        labels.append((right, middle, f"{at['material'].values}  {middle:.3f}{mark}{chance}", colour))
    label_lines(axes, labels, gap=0.04)
    beside: Any = {"xycoords": "axes fraction", "textcoords": "offset points"}
    head = "candidate  median friction"
    axes.annotate(head, (1, 1), xytext=(12, 5), fontsize=6.5, color=GREY, **beside)
    absent = ", ".join(data["material"].values.astype(str)[~np.isfinite(central)])
    title = f"{data['environment'].values}: drawn bearings"
    _headed(axes, title, [f"not measured: {absent}"] if absent else [])
    axes.plot([], [], ".", color=GREY, ms=3.0, mew=0, label="a bearing whose cage settles")
    axes.plot([], [], "x", color=GREY, ms=2.8, mew=0.6, label="a bearing whose cage does not settle")
    untested(axes, data["material_extrapolation"])


def probabilities(data: xr.Dataset) -> Figure:
    """Probability that a bearing's cage settles, of every candidate in every environment and overall."""
    places = [*data["environment"].values.astype(str), OVERALL]
    rows = -(-len(places) // 2)
    shape: Any = {"nrows": rows, "ncols": 2, "sharex": True, "squeeze": False}
    figure, panels = canvas(PAGE, 0.9 + rows * (0.4 + 0.17 * data.sizes["material"]), **shape)
    for row, axes in enumerate(panels.flat):
        axes.set_visible(row < len(places))
        if row < len(places):
            inside = row < data.sizes["environment"]
            part = data.isel(environment=row) if inside else data
            _chances(axes, part, "material" if inside else "overall")
            axes.set_title(_capital(places[row]))
        if row >= len(places) - 2:
            axes.set_xlabel("probability that a bearing's cage settles [-]")
            axes.tick_params(labelbottom=True)
    for verdict, marker in VERDICT_MARKERS.items():
        label = f"{verdict}, with the 95 % interval"
        panels[0, 0].plot([], [], marker, color=VERDICT_COLOURS[verdict], ms=4.5, label=label)
    panels[0, 0].plot([], [], color=GREY, lw=0.6, ls=":", label="probabilities of 0.5 and 0.9")
    untested(panels[0, 0], xr.concat([data["material_extrapolation"], data["overall_extrapolation"]], "any"))
    legend_below(figure, columns=3)
    return figure


def _chances(axes: Axes, data: xr.Dataset, prefix: str) -> None:
    """Draw one environment, or all of them: the best at the top, those not measured at the bottom."""
    value, low, high = (
        _floats(data, f"{prefix}_probability_{end}", "material") for end in ("stable", "low", "high")
    )
    names = []
    for place, i in enumerate(np.argsort(np.where(np.isfinite(value), value, -1.0), kind="stable")):
        verdict = str(data[f"{prefix}_verdict"].values[i])
        look: Any = {"color": VERDICT_COLOURS.get(verdict, GREY), "marker": VERDICT_MARKERS.get(verdict, ".")}
        ends = [[max(value[i] - low[i], 0.0)], [max(high[i] - value[i], 0.0)]]
        axes.errorbar(value[i], place, xerr=ends, ms=4.5, elinewidth=1.2, capsize=1.5, **look)
        mark = MARK if str(data[f"{prefix}_extrapolation"].values[i]) else ""
        absent = "" if np.isfinite(value[i]) else ": not measured"
        names.append(f"{data['material'].values[i]}{mark}{absent}")
    for line in (0.5, 0.9):
        axes.axvline(line, color=GREY, lw=0.6, ls=":", zorder=0)
    axes.set_yticks(range(len(names)), names, fontsize=6.5)
    axes.set(xlim=(-0.02, 1.02), ylim=(-0.6, len(names) - 0.4))
    axes.tick_params(axis="y", length=0)


def convergence(data: xr.Dataset) -> Figure:
    """P(stable) of the least decided candidate of each place against the number of bearings."""
    figure, axes = canvas(PAGE, 3.4)
    size, drawn = data["size"].values.astype(float), []
    places = data["place"].values.astype(str)
    for row, place in enumerate(places):
        value, low, high = (
            _floats(data.isel(place=row), f"convergence_probability_{end}", "material", "size")
            for end in ("stable", "low", "high")
        )
        known = np.isfinite(value)
        last = [one[there][-1] if there.any() else np.nan for one, there in zip(value, known, strict=True)]
        if not known.any():
            continue
        i = int(np.nanargmin(np.abs(np.array(last) - 0.5)))
        there, shift = known[i], 1.0 + 0.03 * (row - (len(places) - 1) / 2)
        middle = value[i, there]
        ends = np.maximum([middle - low[i, there], high[i, there] - middle], 0.0)
        label = f"{data['material'].values[i]}, {place or OVERALL}"
        look: Any = {"color": CYCLE[row % len(CYCLE)], "marker": MARKERS[row % len(MARKERS)], "label": label}
        axes.errorbar(size[there] * shift, middle, yerr=ends, ms=3.5, lw=0.8, elinewidth=0.8, **look)
        drawn += [*size[there]]
    ticks: list[float] = []
    for one in sorted(set(drawn)):
        ticks += [one] if not ticks or one > 1.15 * ticks[-1] else []
    axes.set(xscale="log", ylim=(-0.02, 1.02), xlabel="number of bearings [-]", ylabel="P(stable) [-]")
    axes.set_xticks(ticks, [f"{one:g}" for one in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    title = "P(stable) of the least decided candidate of each environment, with its 95 % interval"
    axes.set_title(title)
    legend_below(figure)
    return figure


def drivers(data: xr.Dataset) -> Figure:
    """Show which inputs decide whether a cage settles, and whether the fit behind it predicts the counts."""
    share = _floats(data, "driver_share", "environment", "material", "driver")
    stable = _floats(data, "material_probability_stable", "environment", "material")
    rows = sorted(np.argwhere(np.isfinite(share).any(axis=2)).tolist(), key=lambda c: abs(stable[*c] - 0.5))
    cases = sorted(rows[:MOST])
    groups = _groups(data, cases)
    height = 1.7 + len(groups) * (0.1 + 0.06 * len(cases))
    figure, (left, right) = canvas(PAGE, max(height, 3.4), ncols=2, width_ratios=(1.35, 1.0))
    for k, (e, m) in enumerate(cases):
        at = data.isel(environment=e, material=m)
        name = f"{at['material'].values}, {at['environment'].values}"
        look: Any = {"color": CYCLE[k % len(CYCLE)], "marker": MARKERS[k % len(MARKERS)], "ms": 3.5}
        ends = np.array([_largest(at, columns) for columns in groups.values()])
        value, errors = ends[:, 0], np.maximum([ends[:, 0] - ends[:, 1], ends[:, 2] - ends[:, 0]], 0.0)
        y = np.arange(len(groups)) + 0.7 * ((k + 0.5) / len(cases) - 0.5)
        left.errorbar(value, y, xerr=errors, ls="", elinewidth=0.8, label=name, **look)
        counts = (_floats(at, f"calibration_{kind}") for kind in ("predicted", "counted"))
        right.plot(*counts, lw=0.8, **look)
    for place in range(0, len(groups), 2):
        left.axhspan(place - 0.5, place + 0.5, color=GREY, alpha=0.08, lw=0)
    left.set_yticks(range(len(groups)), [textwrap.fill(name, 26) for name in groups], fontsize=6.5)
    left.set(ylim=(len(groups) - 0.5, -0.5), xlabel="share of the variance of the logit\nof P(settles) [-]")
    left.set_xlim(min(left.get_xlim()[0], -0.02), 1.02)
    left.tick_params(axis="y", length=0)
    left.set_title("a  Inputs that matter most, 95 % intervals")
    right.plot([0, 1], [0, 1], color=BLACK, lw=0.6, ls="--", label="counted as predicted")
    right.set(xlim=(-0.02, 1.02), ylim=(-0.02, 1.02), aspect="equal", anchor="N")
    right.set(xlabel="predicted P(settles) [-]", ylabel="counted share that settles [-]")
    right.set_title("b  Bearings left out of the fit")
    legend_below(figure)
    return figure


def _groups(data: xr.Dataset, cases: list[list[int]]) -> dict[str, list[int]]:
    """Return the inputs to draw, each with its columns: a candidate's own are one; chance comes last."""
    share = _floats(data, "driver_share", "environment", "material", "driver")
    found: dict[str, list[int]] = {}
    for column, key in enumerate(data["driver"].values.astype(str)):
        part = key.partition(".material.")[2]
        own = key.startswith("ranking.")
        found.setdefault(OWN + (part or FRICTION) if own else key, []).append(column)
    largest = {
        name: max(np.nan_to_num(share[e, m, columns]).max() for e, m in cases)
        for name, columns in found.items()
    }
    chance = list(found)[-1]
    chosen = sorted((name for name in found if name != chance), key=lambda name: -largest[name])
    return {name: found[name] for name in [*[n for n in chosen if largest[n] >= LEAST][:MOST], chance]}


def _largest(data: xr.Dataset, columns: list[int]) -> list[float]:
    """Return the largest share among these columns of one case, and its interval; NaN without one."""
    share = _floats(data, "driver_share")[columns]
    chosen = columns[int(np.argmax(np.where(np.isfinite(share), share, -np.inf)))]
    return [float(_floats(data, f"driver_share{end}")[chosen]) for end in ("", "_low", "_high")]


def film(data: xr.Dataset) -> Figure:
    """Which film keeps each candidate stable: lines in the plane of thickness and race friction."""
    figure, axes = canvas(PAGE, 4.3)
    thickness, friction = 1e6 * _floats(data, "film_thickness")[1:], _floats(data, "race_friction")
    axes.set(xscale="log", yscale="log", xlim=thickness[[0, -1]], ylim=friction[[0, -1]])
    axes.set(xlabel="film thickness [um]", ylabel="friction of ball on race [-]")
    steps = np.outer(10.0 ** np.arange(-4, 3), [1, 2, 5]).ravel()
    for axis, ends in ((axes.xaxis, thickness), (axes.yaxis, friction)):
        ticks = steps[(steps >= 0.999 * ends[0]) & (steps <= 1.001 * ends[-1])]
        axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.set_minor_locator(NullLocator())
    allowed = _floats(data, "film_allowed", "material", "race_friction", "film_thickness")[:, :, 1:]
    names = data["material"].values.astype(str)
    known = [i for i in range(names.size) if np.isfinite(allowed[i]).all()]
    lined = [i for i in known if np.ptp(allowed[i]) > 0]
    for i, level in zip(lined, np.linspace(0.4, 0.6, len(lined)), strict=True):  # else equal lines hide
        look: Any = {"levels": [level], "colors": [CYCLE[i % len(CYCLE)]], "linewidths": 1.2}
        lines = axes.contour(thickness, friction, allowed[i], **look)
        lines.set(path_effects=[withTickedStroke(angle=90, spacing=9, length=0.5)])
        axes.plot([], [], color=CYCLE[i % len(CYCLE)], label=names[i])
    chance = f"P(stable) of {float(data['film_probability']):.2f} or more"
    ticked: Any = {"color": GREY, "lw": 1.2, "path_effects": [withTickedStroke(angle=90, length=0.5)]}
    axes.plot([], [], label=f"ticks: the side of the films with {chance}", **ticked)
    here = 1e6 * float(data["film_thickness_here"]), float(data["race_friction_here"])
    axes.plot(*here, "o", ms=4.5, color=BLACK, clip_on=False, label="film of the study", ls="")
    said = (("every film here is thin enough", 1), ("no film here is enough", 0))
    own = own_environment(data)
    where = "" if own is None else f" in {data['environment'].values[own]}"
    parts = {head: [names[i] for i in known if i not in lined and allowed[i, 0, 0] == v] for head, v in said}
    _headed(
        axes,
        f"Films that keep the cage stable{where}",
        [f"{a}: {', '.join(b)}" for a, b in parts.items() if b],
    )
    legend_below(figure)
    return figure
