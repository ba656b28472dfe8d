"""The stability curve with its band (the paper's Fig. 2), its limits, and the candidates beside it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREEN,
    GREY,
    MARK,
    MARKERS,
    PAGE,
    SKY,
    canvas,
    legend_below,
)
from separatrix.units import Array

HIGHEST = 0.5
"""Friction at the top of a picture without any curve: above it no cage material is of interest."""

ETA_LABEL = r"restitution factor $\eta$ [-]"
FRICTION_LABEL = r"ball/cage friction $f_{BC}$ [-]"
RUG = 0.012
"""Height of the ticks at the foot that mark the computed restitution factors, as a share of the picture."""


def stability(data: xr.Dataset) -> Figure:
    """Critical friction against restitution factor, and the frictions of the candidates, if there are any."""
    candidates = "material_friction" in data and bool(np.isfinite(data["material_friction"].values).any())
    if candidates:
        shares = [3.0, 1.0 + 0.12 * data.sizes["material"]]
        figure, (axes, beside) = canvas(PAGE, 4.6, ncols=2, sharey=True, width_ratios=shares)
    else:
        figure, axes = canvas(PAGE, 4.1)
    frame(axes, data, highest(data, candidates=candidates))
    chain_lines(axes, data)
    mark_here(axes, data)
    _ends(axes, data)
    band = " and its band" if has_band(data) else ""
    axes.set_title(f"{'a  ' if candidates else ''}Critical friction{band}")
    if candidates:
        _candidates(beside, data)
    legend_below(figure)
    return figure


def highest(data: xr.Dataset, *, candidates: bool = False) -> float:
    """Friction at the top of the picture: every curve and mark in it lies below."""
    names = [*DRAWN, *(["material_friction"] if candidates else [])]
    found = np.concatenate(
        [[0.0], *(data[name].values.ravel().astype(float) for name in names if name in data)]
    )
    top = float(np.nanmax(found))
    return 1.12 * top if top > 0.0 else HIGHEST


DRAWN = (
    *("critical_friction", "scatter_high", "critical_friction_high", "kick_critical_friction"),
    *("here_critical_friction", "here_scatter_high", "here_critical_friction_high"),
)
"""Variables whose largest value is the top of the picture; the limits are drawn as far as they go."""


def frame(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Draw the curve with its band and its limits; the band reaches the edge where it has no end."""
    axes.set(xlim=(0, 1), ylim=(0, top), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    eta = data["restitution_factor"].values
    label = f"half of {int(data['runs'])} runs whirl, kick {float(data['middle_kick']):g} m/s"
    axes.plot(eta, data["critical_friction"].values, color=BLUE, marker=".", ms=4, label=label)
    scatter = data["scatter_low"].values, data["scatter_high"].values
    axes.fill_between(eta, *scatter, color=BLUE, alpha=0.35, lw=0, label="its 95 % interval")
    if has_band(data):
        _band(axes, eta, data, top)
        _other_kicks(axes, data)
    _limits(axes, data)


def has_band(data: xr.Dataset) -> bool:
    """Whether the points of the curve were asked for their band."""
    return bool(data["band"]) if "band" in data else True


def band_ends(data: xr.Dataset, top: float) -> tuple[Array, Array]:
    """Return both ends of the band at each restitution factor, as far as anything is known there.

    An end without a number is at 0 (runs whirl without friction) or beyond `top` (they settle up to it).
    """
    low, high = (data[f"critical_friction_{end}"].values.astype(float) for end in ("low", "high"))
    unknown = np.isnan(low) & np.isnan(high) & np.isnan(data["critical_friction"].values.astype(float))
    ends = np.where(np.isnan(low), 0.0, low), np.where(np.isnan(high), 2 * top, high)
    return np.where(unknown, np.nan, ends[0]), np.where(unknown, np.nan, ends[1])


BAND = {"band_few": 0.1, "band_most": 0.9}
"""Shares of whirling runs at the ends of the band, in a dataset that does not say them."""


def _band(axes: Axes, eta: Array, data: xr.Dataset, top: float) -> None:
    """Shade what lies between the band's ends, where the kick decides, and name it."""
    low, high = band_ends(data, top)
    kicks = data["kicks"].values
    span = f"{kicks.min():g} to {kicks.max():g} m/s" if kicks.size > 1 else f"{kicks[0]:g} m/s"
    label = (
        f"sub-critical band: the kick decides ({span})"
        if kicks.size > 1
        else f"scatter of the runs, kick {span}"
    )
    axes.fill_between(eta, low, high, color=BLUE, alpha=0.15, lw=0, label=label)
    few, most = (float(data[name]) if name in data else other for name, other in BAND.items())
    every = "every kick" if kicks.size > 1 else "that kick"
    for end, style, text in (
        (high, "-.", rf"$f_{{high}}$: above it {100 * most:.0f} % or more whirl from {every}"),
        (low, ":", rf"$f_{{low}}$: below it {100 - 100 * few:.0f} % or more settle from {every}"),
    ):
        axes.plot(eta, np.where(end > top, np.nan, end), color=BLUE, lw=0.8, ls=style, label=text)


DENSE = np.linspace(1e-3, 1.0, 400)


def linear_limit(restitution_factor: Array, ball_count: int) -> Array:
    """Return the critical friction of the linear law, 2 zeta sqrt(2/Z), at factors above 0 [-]."""
    decay = -np.log(restitution_factor)
    return np.asarray(2 * decay / np.hypot(np.pi, decay) * np.sqrt(2 / ball_count))


def _limits(axes: Axes, data: xr.Dataset) -> None:
    """Draw the limits that the dataset has; the linear law, in closed form, as smooth as it is."""
    eta, known = data["restitution_factor"].values, data["linear_limit_critical_friction"].values
    linear = (
        (DENSE, linear_limit(DENSE, int(data["cage_ball_count"])))
        if "cage_ball_count" in data
        else (eta, known)
    )
    label = "linear limit: no clearance, balls at rest"
    axes.plot(*linear, color=GREY, lw=1.0, ls=(0, (5, 2)), label=label)
    name = "hard_limit_critical_friction"
    if name in data and np.isfinite(data[name].values.astype(float)).any():
        label = "hard-impact limit: walls, no land, balls at rest"
        axes.plot(eta, data[name].values, color=GREEN, lw=1.0, ls=(0, (6, 1.5, 1, 1.5)), label=label)


def _other_kicks(axes: Axes, data: xr.Dataset) -> None:
    """Draw where half the runs whirl from the smallest and from the largest kick, if the dataset has it."""
    if "kick_critical_friction" not in data or data.sizes["kick"] < 2:
        return
    kicks, found = (
        data["kicks"].values,
        data["kick_critical_friction"].transpose("restitution_factor", "kick"),
    )
    for place, marker in ((int(kicks.argmin()), "v"), (int(kicks.argmax()), "^")):
        if kicks[place] != float(data["middle_kick"]):
            label = f"half whirl, kick {kicks[place]:g} m/s"
            look: Any = {"color": SKY, "marker": marker, "ms": 2.5, "lw": 0.7, "label": label}
            axes.plot(data["restitution_factor"].values, found.values[:, place], **look)


def mark_here(axes: Axes, data: xr.Dataset) -> None:
    """Mark the critical friction at the bearing's own restitution factor, with its interval."""
    names = [
        f"here_{name}" for name in ("restitution_factor", "critical_friction", "scatter_low", "scatter_high")
    ]
    values = [float(data[name]) if name in data else np.nan for name in names]
    if np.isfinite(values).all():
        eta, middle, low, high = values
        label = rf"this bearing's critical friction, {middle:.2g} ({low:.2g} to {high:.2g})"
        axes.vlines(eta, low, high, color=BLACK, lw=2.5, zorder=3)
        axes.plot(eta, middle, "D", mfc="white", mec=BLACK, ms=4.5, ls="", zorder=4, label=label)
        if not has_band(data):
            _here_band(axes, eta, data)


def _here_band(axes: Axes, eta: float, data: xr.Dataset) -> None:
    """Draw the band at the bearing's own restitution factor, where the curve has none."""
    low, high = here_band(data, axes.get_ylim()[1])
    kicks = data["kicks"].values
    span = f"kicks of {kicks.min():g} to {kicks.max():g} m/s" if kicks.size > 1 else f"kick {kicks[0]:g} m/s"
    label = f"band at this bearing's $\\eta$, {span}"
    axes.vlines(eta, low, high, color=BLUE, alpha=0.25, lw=9, zorder=1, label=label)


def here_band(data: xr.Dataset, top: float) -> tuple[float, float]:
    """Return both ends of the band at the bearing's own restitution factor, as `band_ends` does."""
    low, high = (float(data[f"here_critical_friction_{end}"]) for end in ("low", "high"))
    return (low if np.isfinite(low) else 0.0), (high if np.isfinite(high) else 2 * top)


CHAIN_LINES = {
    "chain_restitution_factor": ("-", r"this bearing, {whose}$\eta$ = {:.2f} (Eq. 18)"),
    "chain_restitution_factor_free_spin": (":", r"the same, ball free to spin, $\eta$ = {:.2f}"),
}


def chain_lines(axes: Axes, data: xr.Dataset) -> None:
    """Draw the restitution factors of the chain as upright lines."""
    whose = f"with {data['candidate'].values}, " if "own_critical_friction" in data else ""
    for name, (style, text) in CHAIN_LINES.items():
        value = float(data[name])
        axes.axvline(value, color=BLACK, ls=style, lw=1.0, label=text.format(value, whose=whose))


def _ends(axes: Axes, data: xr.Dataset) -> None:
    """Name both sides outside the picture, where no curve is, and mark where the curve was computed."""
    look: Any = {"transform": axes.transAxes, "color": GREY, "style": "italic", "ha": "right", "fontsize": 7}
    axes.text(1.0, 1.01, "above the curve: unstable; below: stable", va="bottom", **look)
    axes.vlines(data["restitution_factor"].values, 0, RUG * axes.get_ylim()[1], color=BLUE, lw=0.6)


def _candidates(axes: Axes, data: xr.Dataset) -> None:
    """Draw each candidate's friction in every environment, with the band at its own restitution factor."""
    data = data.isel(material=np.argsort(_measured_mean(_frictions(data)), kind="stable"))
    count = data.sizes["material"]
    axes.set(xlim=(-0.6, count - 0.4), title=r"b  Candidates at their $\eta$")
    said = data["material_extrapolation"].transpose("environment", "material").values.astype(str)
    untested = (said != "").any(axis=0)
    names = data["material"].values.astype(str)
    marked = [f"{name} {MARK}" if mark else name for name, mark in zip(names, untested, strict=True)]
    axes.set_xticks(range(count), marked, rotation=90, fontsize=6.5)
    axes.tick_params(axis="x", length=0)
    if untested.any():
        label = "friction extrapolated"
        axes.plot([], [], ls="", marker=f"${MARK}$", color=GREY, ms=4, label=label)
    _own_bands(axes, data)
    friction, error = _frictions(data), _errors(data)
    for place in range(count):
        if np.isfinite(friction[:, place]).any():
            ends = np.nanmin(friction[:, place]), np.nanmax(friction[:, place])
            axes.vlines(place, *ends, color=GREY, lw=0.8)
        else:
            axes.text(place, 0.02 * axes.get_ylim()[1], "not measured", **UNMEASURED)
    shift = 0.5 / max(1, friction.shape[0])
    for i, name in enumerate(data["environment"].values.astype(str)):
        places = np.arange(count) + shift * (i - 0.5 * (friction.shape[0] - 1))
        look: Any = {"marker": MARKERS[i % len(MARKERS)], "color": CYCLE[i % len(CYCLE)], "ms": 3.4, "ls": ""}
        axes.errorbar(places, friction[i], yerr=error[i], elinewidth=0.9, label=name, **look)


UNMEASURED: Any = {"rotation": 90, "ha": "center", "va": "bottom", "fontsize": 6.5, "color": GREY}


def _measured_mean(table: Array) -> Array:
    """Return the mean of each column over what is known; infinite for a column of nothing."""
    known = np.isfinite(table)
    total = np.where(known, table, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    return np.where(known.any(axis=0), total, np.inf)


def _frictions(data: xr.Dataset) -> Array:
    """Return the friction of each environment and material."""
    return data["material_friction"].transpose("environment", "material").values.astype(float)


def _errors(data: xr.Dataset) -> Array:
    """Return the stated error of each friction, 0 where there is none."""
    if "material_friction_error" not in data:
        return np.zeros_like(_frictions(data))
    found = data["material_friction_error"].transpose("environment", "material").values
    return np.asarray(np.nan_to_num(found), dtype=float)


def _own_bands(axes: Axes, data: xr.Dataset) -> None:
    """Shade the band at each candidate's restitution factor, with a line where half the runs whirl."""
    eta, top = data["restitution_factor"].values, axes.get_ylim()[1]
    if not has_band(data):
        _shared_band(axes, data, top)
        return
    low, high = band_ends(data, top)
    middle = data["critical_friction"].values
    own = data["material_restitution_factor"].transpose("environment", "material").values.astype(float)
    for place in range(data.sizes["material"]):
        at = float(_measured_mean(own)[place])
        if eta.size and eta[0] <= at <= eta[-1]:
            ends = np.interp(at, eta, low), np.interp(at, eta, high)
            axes.fill_between([place - 0.4, place + 0.4], *ends, color=BLUE, alpha=0.15, lw=0)
            axes.hlines(np.interp(at, eta, middle), place - 0.4, place + 0.4, color=BLUE, lw=1.3)


def _shared_band(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Shade the band of this bearing beside the candidates that have its restitution factor."""
    if "here_restitution_factor" not in data or not np.isfinite(float(data["here_critical_friction"])):
        return
    own = data["material_restitution_factor"].transpose("environment", "material").values.astype(float)
    for place, at in enumerate(_measured_mean(own)):
        if np.isclose(at, float(data["here_restitution_factor"]), rtol=1e-9):
            axes.fill_between([place - 0.4, place + 0.4], *here_band(data, top), color=BLUE, alpha=0.15, lw=0)
            axes.hlines(float(data["here_critical_friction"]), place - 0.4, place + 0.4, color=BLUE, lw=1.3)
