"""Clouds of the candidates about the stability curve (the paper's Figs 9-12), probabilities, convergence."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withTickedStroke

from separatrix.figures.ranking import file_name, untested
from separatrix.figures.stability import ETA_LABEL, FRICTION_LABEL
from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    MARK,
    MARKERS,
    ORANGE,
    PAGE,
    VERMILION,
    canvas,
    label_lines,
    legend_below,
)
from separatrix.units import Array

VERDICTS = (("stable", BLUE), ("undecided", ORANGE), ("unstable", VERMILION))
ENDS_95 = (0.025, 0.975)
OVERALL = "over all environments"


def environments(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield a figure for each environment: every candidate's cloud about the curve with its band."""
    top = 1.08 * float(np.nanmax(data["cloud_friction"].values, initial=0.1))
    for i, name in enumerate(data["environment"].values):
        yield f"sensitivity-{i + 1}-{file_name(str(name))}", environment(data.isel(environment=i), top)


def each(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the figures of the environments, of the sources of uncertainty, of the film if there is one."""
    yield from environments(data)
    if "sobol_margin_total" in data:
        yield "sensitivity-drivers", drivers(data)
    if "film_probability_stable" in data:
        yield "sensitivity-film", film(data)


def is_friction(name: str) -> bool:
    """Whether an input is the friction of a candidate."""
    return name.startswith("ranking.") and ".material." not in name


def environment(data: xr.Dataset, top: float) -> Figure:
    """Stability curve with its scatter, and the samples of the candidates in one environment."""
    figure, axes = canvas(PAGE, 4.3)
    axes.set(xlim=(0, 1), ylim=(0, top), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    for kind in np.unique(data["boundary_of"].values).astype(int):
        _line(axes, data.isel(boundary=kind), first=kind == 0)
    labels = []
    for i in _rising(data):
        labels += _cloud(axes, data.isel(material=i), CYCLE[i % len(CYCLE)], MARKERS[i % len(MARKERS)])
    label_lines(axes, [(1.0, y, text, colour) for y, text, colour in labels], gap=0.04)
    _missing(axes, data)
    untested(axes, data["material_extrapolation"])
    name = str(data["environment"].values)
    axes.set_title(f"{name[:1].upper() + name[1:]}: predicted scatter of a new cage")
    legend_below(figure)
    return figure


def _line(axes: Axes, data: xr.Dataset, *, first: bool) -> None:
    """Draw the critical friction with its interval, and the stretch in which nothing is decided."""
    eta = data["restitution_factor"].values
    low, high = data["line_stable_up_to"].values, data["line_unstable_above"].values
    label = "undecided: neither verdict is reached"
    axes.fill_between(eta, low, high, color=GREY, alpha=0.15, lw=0, label=label if first else None)
    ends = data["line_critical_friction_low"].values, data["line_critical_friction_high"].values
    axes.fill_between(eta, *ends, color=BLACK, alpha=0.3, lw=0, label="its 95 % interval" if first else None)
    label = "half of the runs whirl from the reference kick"
    axes.plot(eta, data["line_critical_friction"].values, color=BLACK, lw=1.0, label=label if first else None)


def _rising(data: xr.Dataset) -> list[int]:
    """Places of the measured candidates, rising in friction."""
    friction = data["material_friction"].values.astype(float)
    return [int(i) for i in np.argsort(friction, kind="stable") if np.isfinite(friction[i])]


def _cloud(axes: Axes, data: xr.Dataset, colour: str, marker: str) -> list[tuple[float, str, str]]:
    """Draw one candidate's samples with bars that hold 95 % of them; return its label."""
    eta, friction = (
        data[f"cloud_{name}"].values.astype(float) for name in ("restitution_factor", "friction")
    )
    axes.plot(eta, friction, ".", color=colour, ms=1.6, alpha=0.35, ls="", mew=0, zorder=2)
    middle = float(np.median(eta)), float(np.median(friction))
    bars = [
        np.abs(np.quantile(x, ENDS_95) - m)[:, None] for x, m in zip((eta, friction), middle, strict=True)
    ]
    look: Any = {"marker": marker, "ms": 4.0, "mfc": "white", "mec": colour, "ecolor": colour, "ls": ""}
    axes.errorbar(*middle, xerr=bars[0], yerr=bars[1], elinewidth=1.2, zorder=4, **look)
    axes.plot([middle[0], 1.0], [middle[1]] * 2, color=colour, lw=0.3, alpha=0.5, zorder=1)
    share = float(data["material_probability_stable"])
    mark = MARK if str(data["material_extrapolation"].values) else ""
    text = f"{data['material'].values}  {middle[1]:.3f}{mark}  P(stable) {share:.2f}"
    return [(middle[1], text, colour)]


def _missing(axes: Axes, data: xr.Dataset) -> None:
    """Name the candidates that were not measured."""
    friction = data["material_friction"].values.astype(float)
    names = [str(name) for name in data["material"].values[~np.isfinite(friction)]]
    if names:
        text = f"not measured: {', '.join(names)}"
        axes.text(0.99, 0.985, text, transform=axes.transAxes, ha="right", va="top", fontsize=6.5, color=GREY)


def probabilities(data: xr.Dataset) -> Figure:
    """Probabilities of each verdict and of being best, with the intervals of the first and the last."""
    places = [*(str(name) for name in data["environment"].values), OVERALL]
    count = data.sizes["material"]
    shape: Any = {"nrows": len(places), "ncols": 2, "sharex": "col", "squeeze": False}
    shape["gridspec_kw"] = {"width_ratios": (2.0, 1.0)}
    figure, axes = canvas(PAGE, 0.6 + len(places) * (0.6 + 0.16 * count), **shape)
    for row, name in enumerate(places):
        part = _part(data, row)
        _verdicts(axes[row, 0], part)
        _best(axes[row, 1], part)
        axes[row, 0].set_title(name[:1].upper() + name[1:])
    axes[-1, 0].set_xlabel("probability of the verdict [-]")
    axes[-1, 1].set_xlabel("probability of being best [-]")
    legend_below(figure, [axes[0, 0], axes[0, 1]], columns=3)
    return figure


COLUMNS = (
    *("friction", "probability_stable", "probability_stable_low", "probability_stable_high"),
    *("probability_undecided", "probability_unstable", "probability_best", "probability_best_low"),
    *("probability_best_high", "tie_group"),
)


def _part(data: xr.Dataset, row: int) -> dict[str, Array]:
    """Columns of one environment, or over all of them, best group at the top."""
    inside = row < data.sizes["environment"]
    at = data.isel(environment=row) if inside else data
    prefix = "material" if inside else "overall"
    found = {name: at[f"{prefix}_{name}"].values.astype(float) for name in COLUMNS}
    group = np.where(np.isfinite(found["tie_group"]), found["tie_group"], np.inf)
    order = np.lexsort((found["friction"], group))[::-1]
    return {name: values[order] for name, values in found.items()} | {
        "name": data["material"].values.astype(str)[order]
    }


def _verdicts(axes: Axes, part: dict[str, Array]) -> None:
    """Draw the shares of the verdicts beside each other, and the interval of the first."""
    places, left = np.arange(len(part["name"])), np.zeros(len(part["name"]))
    for name, colour in VERDICTS:
        share = np.nan_to_num(part[f"probability_{name}"])
        axes.barh(places, share, left=left, color=colour, alpha=0.75, height=0.65, label=name.upper())
        left = left + share
    value, low, high = (part[f"probability_stable{end}"] for end in ("", "_low", "_high"))
    label = "95 % interval of STABLE: samples and runs"
    axes.errorbar(value, places, xerr=[value - low, high - value], fmt="none", ecolor=BLACK, elinewidth=1.0,
                  capsize=2.0, label=label)  # fmt: skip
    names = [
        name if np.isfinite(friction) else f"{name}: not measured"
        for name, friction in zip(part["name"], part["friction"], strict=True)
    ]
    axes.set_yticks(places, names, fontsize=6.5)
    axes.set_xlim(0, 1)
    axes.tick_params(axis="y", length=0)


def _best(axes: Axes, part: dict[str, Array]) -> None:
    """Draw the probabilities of being best with their intervals; the leaders' tie group is filled."""
    places = np.arange(len(part["name"]))
    value, low, high = (np.nan_to_num(part[f"probability_best{end}"]) for end in ("", "_low", "_high"))
    leading = part["tie_group"] == 1
    axes.barh(places[leading], value[leading], color=BLACK, alpha=0.55, height=0.65, label="tied for first")
    axes.barh(places[~leading], value[~leading], color=GREY, alpha=0.3, height=0.65, label="others")
    axes.errorbar(value, places, xerr=[value - low, high - value], fmt="none", ecolor=BLACK, elinewidth=1.0,
                  capsize=2.0)  # fmt: skip
    axes.set_xlim(0, 1)
    axes.set_yticks([])
    for place in places[leading & ~np.isfinite(part["probability_best"])]:
        axes.text(0.02, place, "none: no other measured", va="center", fontsize=6.5, color=GREY)


def convergence(data: xr.Dataset) -> Figure:
    """Probabilities of STABLE, and of being best, against the number of samples, with their intervals."""
    figure, panels = canvas(PAGE, 3.4, ncols=2, sharey=True)
    for axes, name, title in (
        (panels[0], "probability_stable", "a  P(stable)"),
        (panels[1], "probability_best", "b  P(best)"),
    ):
        _converging(axes, data, name)
        axes.set(xscale="log", ylim=(-0.02, 1.02), xlabel="samples [-]", ylabel="probability [-]")
        axes.set_xticks(data["size"].values, [str(n) for n in data["size"].values], fontsize=6.5)
        axes.minorticks_off()
        axes.set_title(f"{title}, least decided of each environment")
    legend_below(figure, [panels[0], panels[1]], columns=2)
    return figure


def _converging(axes: Axes, data: xr.Dataset, name: str) -> None:
    """Draw the candidate whose probability lies nearest to one half, for each environment and overall."""
    sizes = data["size"].values
    for row, place in enumerate(data["place"].values.astype(str)):
        at = data.isel(place=row)
        last = at[f"convergence_{name}"].values[:, -1].astype(float)
        if not np.isfinite(last).any():
            continue
        chosen = int(np.nanargmin(np.abs(last - 0.5)))
        value, low, high = (
            at[f"convergence_{name}{end}"].values[chosen].astype(float) for end in ("", "_low", "_high")
        )
        colour, shift = CYCLE[row % len(CYCLE)], 1.0 + 0.05 * (row - 2)
        label = f"{name[12:]}: {data['material'].values[chosen]}, {place or OVERALL}"
        axes.errorbar(sizes * shift, value, yerr=[np.maximum(value - low, 0), np.maximum(high - value, 0)],
                      color=colour, marker=MARKERS[row % len(MARKERS)], ms=3.0, lw=0.8, elinewidth=0.8,
                      label=label)  # fmt: skip


def drivers(data: xr.Dataset) -> Figure:
    """Total Sobol indices of the margin, for the inputs that matter, in every environment."""
    total = data["sobol_margin_total"].transpose("environment", "material", "factor").values.astype(float)
    own = _own_friction(data, total)
    chosen = [i for i in np.argsort(-np.nan_to_num(own).max(axis=(0, 1)), kind="stable")
              if np.nan_to_num(own[:, :, i]).max() >= LEAST][:MOST]  # fmt: skip
    factors = [*data["factor"].values, FRICTIONS]
    names = ["the boundary itself (runs)" if factors[i] == "boundary" else str(factors[i]) for i in chosen]
    rows = [(e, m) for e in range(own.shape[0]) for m in range(own.shape[1]) if np.isfinite(own[e, m]).any()]
    figure, axes = canvas(PAGE, 1.8 + 0.16 * len(rows))
    left = np.zeros(len(rows))
    for k, (i, name) in enumerate(zip(chosen, names, strict=True)):
        share = np.array([np.nan_to_num(own[e, m, i]) for e, m in rows])
        axes.barh(range(len(rows)), share, left=left, color=CYCLE[k % len(CYCLE)], alpha=0.75, label=name)
        left = left + share
    labels = [f"{data['material'].values[m]}, {data['environment'].values[e]}" for e, m in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize=6.0)
    axes.invert_yaxis()
    axes.set_xlabel("total Sobol index of the margin [-]; beyond 1 the inputs act together")
    axes.set_title("Main sources of uncertainty in the margin")
    legend_below(figure, columns=3)
    return figure


LEAST, MOST = 0.02, 7
FRICTIONS = "its own pocket friction"


def _own_friction(data: xr.Dataset, total: Array) -> Array:
    """Indices with one more input at the end: the frictions, of which each case has but its own."""
    frictions = np.array([is_friction(str(name)) for name in data["factor"].values])
    sums = np.nansum(np.where(frictions, total, np.nan), axis=2, keepdims=True)
    kept = np.where(frictions, np.nan, total)
    return np.concatenate(
        [kept, np.where(np.isfinite(total).any(axis=2, keepdims=True), sums, np.nan)], axis=2
    )


THICKNESS_LABEL = "film thickness [um]; bare races: as at the left end"
RACE_FRICTION_LABEL = "friction of ball on race [-]"


def film(data: xr.Dataset) -> Figure:
    """Which film keeps each candidate stable: lines of P(STABLE) in the plane of thickness and friction."""
    places = [str(name) for name in data["environment"].values]
    rows, columns = -(-len(places) // 2), min(len(places), 2)
    shape: Any = {"nrows": rows, "ncols": columns, "sharex": True, "sharey": True, "squeeze": False}
    figure, panels = canvas(PAGE, 1.0 + 2.5 * rows, **shape)
    for i, axes in enumerate(panels.flat):
        axes.set_visible(i < len(places))
        if i < len(places):
            _film_panel(axes, data.isel(environment=i))
            axes.set_title(places[i][:1].upper() + places[i][1:])
    for axes in panels[-1]:
        axes.set_xlabel(THICKNESS_LABEL)
    for axes in panels[:, 0]:
        axes.set_ylabel(RACE_FRICTION_LABEL)
    legend_below(figure)
    return figure


def _film_panel(axes: Axes, data: xr.Dataset) -> None:
    """Draw the line of each candidate, and say of which there is none; mark the film of the study."""
    thickness, friction = 1e6 * data["film_thickness"].values[1:], data["race_friction"].values
    level, limit = float(data["film_probability"]), 1e6 * float(data["film_holds_up_to"])
    axes.set(xscale="log", yscale="log", xlim=thickness[[0, -1]], ylim=friction[[0, -1]])
    axes.set_xticks(decades := 10.0 ** np.arange(-3, 2), [f"{x:g}" for x in decades])
    axes.set_yticks(friction, [f"{f:g}" for f in friction])
    axes.minorticks_off()
    without: dict[str, list[str]] = {"any film": [], "no film": []}
    for i in _rising(data):
        share = data["film_probability_stable"].isel(material=i).values[:, 1:].astype(float)
        name, colour = str(data["material"].values[i]), CYCLE[i % len(CYCLE)]
        if share.min() >= level or share.max() < level:
            without["any film" if share.min() >= level else "no film"].append(name)
            continue
        lines = axes.contour(thickness, friction, share, levels=[level], colors=[colour], linewidths=1.2)
        lines.set(path_effects=[withTickedStroke(angle=90, spacing=9, length=0.5)])
        axes.plot([], [], color=colour, label=name)
    ticks: Any = {"color": GREY, "lw": 1.2, "path_effects": [withTickedStroke(angle=90, length=0.5)]}
    axes.plot(
        [], [], label=f"ticks: the side that is stable with a probability of {level:.2f} or more", **ticks
    )
    if limit < thickness[-1]:
        label = "thicker than the model of a film holds for"
        axes.axvspan(limit, thickness[-1], color=GREY, alpha=0.12, lw=0, label=label)
    _own_film(axes, data)
    said = [f"{what}: {', '.join(names)}" for what, names in without.items() if names]
    axes.text(0.02, 0.02, "\n".join(said), transform=axes.transAxes, fontsize=6.0, color=GREY)


def _own_film(axes: Axes, data: xr.Dataset) -> None:
    """Mark the film of the study, with two standard deviations where it is uncertain."""
    names = [str(name) for name in data["input"].values]
    bars = [
        2.0 * scale * float(data["input_standard_deviation"][names.index(key)]) if key in names else 0.0
        for key, scale in (("film.thickness", 1e6), ("film.race_friction", 1.0))
    ]
    x, y = 1e6 * float(data["film_thickness_here"]), float(data["film_race_friction_here"])
    axes.errorbar(x, y, xerr=bars[0], yerr=bars[1], fmt="o", ms=3.5, color=BLACK, elinewidth=1.0,
                  label="film of the study, with two standard deviations")  # fmt: skip
