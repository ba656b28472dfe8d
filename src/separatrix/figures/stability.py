"""The stability curve with its band (the paper's Fig. 2), its limits and candidates; two of them compared."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    MARKERS,
    PAGE,
    SKY,
    VERMILION,
    Look,
    canvas,
    cut,
    legend_below,
    with_ends,
)
from separatrix.ground.units import Array

HIGHEST = 0.5
"""Friction at the top of a picture without any curve: above it no cage material is of interest."""

ETA_LABEL = r"restitution factor $\eta$ [-]"
FRICTION_LABEL = r"ball/cage friction $f_{BC}$ [-]"
EXTRAPOLATED = "*"
"""After a friction that was not measured at the conditions in the pocket."""

DRAWN = (
    *("critical_friction", "scatter_high", "critical_friction_high", "kick_critical_friction"),
    *("here_critical_friction", "here_scatter_high", "here_critical_friction_high"),
)
"""Variables whose largest value is the top of the picture; the limits are drawn as far as they go."""

RUG = 0.012
"""Height of the ticks at the foot that mark the computed restitution factors, as a share of the picture."""

LOOKS = ((BLUE, "o", "-"), (VERMILION, "s", "--"))
"""Colour, marker and line of the first and the second answer."""

MOST_ROWS, NAME_WIDTH, BESIDE = 30, 60, 0.17
"""Most materials in the picture; letters of a title; distance of a pair of margins from their row."""


def stability(data: xr.Dataset) -> Figure:
    """Critical friction against restitution factor, and the frictions of the candidates, if there are any."""
    candidates = "material_friction" in data and bool(np.isfinite(data["material_friction"].values).any())
    if candidates:
        shares = [3.0, 1.0 + 0.12 * data.sizes["material"]]
        figure, (axes, beside) = canvas(PAGE, 4.6, ncols=2, sharey=True, width_ratios=shares)
    else:
        figure, axes = canvas(PAGE, 4.1)
    draw_curve(axes, data, highest(data, candidates=candidates))
    look: Look = {"transform": axes.transAxes, "color": GREY, "style": "italic", "ha": "right", "fontsize": 7}
    axes.text(1.0, 1.01, "above the curve: unstable; below: stable", va="bottom", **look)
    axes.vlines(data["restitution_factor"].values, 0, RUG * axes.get_ylim()[1], color=BLUE, lw=0.6)
    band = " and its band" if has_band(data) else ""
    axes.set_title(f"{'a  ' if candidates else ''}Critical friction{band}")
    if candidates:
        _candidates(beside, data)
    legend_below(figure)
    return figure


def highest(data: xr.Dataset, *, candidates: bool = False) -> float:
    """Friction at the top of the picture: above every curve and mark in it."""
    names = [*DRAWN, *(["material_friction"] if candidates else [])]
    found = [data[name].values.ravel().astype(float) for name in names if name in data]
    top = float(np.nanmax(np.concatenate([[0.0], *found])))
    return 1.12 * top if top > 0.0 else HIGHEST


def has_band(data: xr.Dataset) -> bool:
    """Whether the band was computed at the points of the curve."""
    return bool(data.get("band", True))


def band_ends(data: xr.Dataset, top: float, of: str = "") -> tuple[Array, Array]:
    """Return both ends of the band at each restitution factor, or of the bearing's own with "here_".

    An end without a number is at 0 (runs whirl without friction) or beyond `top` (they settle up to it);
    where nothing is known there is no band.
    """
    middle, low, high = with_ends(data, f"{of}critical_friction")
    unknown = np.isnan(low) & np.isnan(high) & np.isnan(middle)
    low, high = np.where(np.isnan(low), 0.0, low), np.where(np.isnan(high), 2 * top, high)
    return np.where(unknown, np.nan, low), np.where(unknown, np.nan, high)


def kicks_text(data: xr.Dataset) -> str:
    """Return the range of the kicks."""
    kicks = data["kicks"].values
    return f"{kicks.min():g} to {kicks.max():g} m/s" if kicks.size > 1 else f"{kicks[0]:g} m/s"


def linear_limit(restitution_factor: Array, ball_count: int) -> Array:
    """Return the critical friction of the linear law, 2 zeta sqrt(2/Z), at factors above 0 [-]."""
    decay = -np.log(restitution_factor)
    return np.asarray(2 * decay / np.hypot(np.pi, decay) * np.sqrt(2 / ball_count))


def draw_linear_limit(axes: Axes, ball_count: int, *, swapped: bool = False, halo: bool = False) -> None:
    """Draw the linear law, in closed form, as smooth as it is; in black with a white halo above colours."""
    eta = np.linspace(1e-3, 1.0, 400)
    points = (eta, linear_limit(eta, ball_count))[:: -1 if swapped else 1]
    if halo:
        axes.plot(*points, color="white", lw=2.4)
    look: Look = {"color": BLACK if halo else GREY, "lw": 1.0, "ls": (0, (5, 2))}
    axes.plot(*points, label="linear limit: no clearance, balls at rest", **look)


def own_point(data: xr.Dataset) -> list[float]:
    """Return the restitution factor of the bearing and its critical friction with both ends; else NaN."""
    names = ("restitution_factor", "critical_friction", "scatter_low", "scatter_high")
    return [float(data.get(f"here_{name}", np.nan)) for name in names]


def draw_curve(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Draw the curve with its interval and band, the limits, and the bearing's own point."""
    axes.set(xlim=(0, 1), ylim=(0, top), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    eta = data["restitution_factor"].values
    label = f"half of {int(data['runs'])} runs whirl, kick {float(data['middle_kick']):g} m/s"
    axes.plot(eta, data["critical_friction"].values, color=BLUE, marker=".", ms=4, label=label)
    scatter = data["scatter_low"].values, data["scatter_high"].values
    axes.fill_between(eta, *scatter, color=BLUE, alpha=0.35, lw=0, label="its 95 % interval")
    if has_band(data):
        _band(axes, data, top)
    draw_linear_limit(axes, int(data["cage_ball_count"]))
    draw_chain(axes, data)
    at, middle, low, high = own_point(data)
    if np.isfinite([at, middle, low, high]).all():
        label = rf"this bearing's critical friction, {middle:#.2g} ({low:#.2g} to {high:#.2g})"
        axes.vlines(at, low, high, color=BLACK, lw=2.5, zorder=3)
        axes.plot(at, middle, "D", mfc="white", mec=BLACK, ms=4.5, ls="", zorder=4, label=label)
        if not has_band(data):
            label = f"band at this bearing's $\\eta$, kick of {kicks_text(data)}"
            look: Look = {"color": BLUE, "alpha": 0.25, "lw": 9, "zorder": 1}
            axes.vlines(at, *band_ends(data, top, "here_"), label=label, **look)


def _band(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Draw the band in which the kick decides, its ends, and the curves of the extreme kicks."""
    eta, kicks, (low, high) = data["restitution_factor"].values, data["kicks"].values, band_ends(data, top)
    several = kicks.size > 1
    label = "sub-critical band: the kick decides ({})" if several else "scatter of the runs, kick {}"
    axes.fill_between(eta, low, high, color=BLUE, alpha=0.15, lw=0, label=label.format(kicks_text(data)))
    few, most = float(data["band_few"]), float(data["band_most"])
    every = "every kick" if several else "that kick"
    above = rf"$f_{{high}}$: above it {100 * most:.0f} % or more whirl from {every}"
    below = rf"$f_{{low}}$: below it {100 - 100 * few:.0f} % or more settle or roll, from {every}"
    for end, style, text in ((high, "-.", above), (low, ":", below)):
        axes.plot(eta, np.where(end > top, np.nan, end), color=BLUE, lw=0.8, ls=style, label=text)
    if several and "kick_critical_friction" in data:
        found = data["kick_critical_friction"].transpose("restitution_factor", "kick").values
        for place, marker in ((int(kicks.argmin()), "v"), (int(kicks.argmax()), "^")):
            if kicks[place] != float(data["middle_kick"]):
                look: Look = {"color": SKY, "marker": marker, "ms": 2.5, "lw": 0.7}
                axes.plot(eta, found[:, place], label=f"half whirl, kick {kicks[place]:g} m/s", **look)


def draw_chain(axes: Axes, data: xr.Dataset) -> None:
    """Draw the restitution factors of the bearing as upright lines."""
    whose = f"with {data['candidate'].values}, " if "own_critical_friction" in data else ""
    eta, free = (float(data[f"chain_restitution_factor{end}"]) for end in ("", "_free_spin"))
    axes.axvline(eta, color=BLACK, lw=1.0, label=rf"this bearing, {whose}$\eta$ = {eta:.2f} (Eq. 18)")
    label = rf"the same, ball free to spin, $\eta$ = {free:.2f}"
    axes.axvline(free, color=BLACK, ls=":", lw=1.0, label=label)


def explain_extrapolated(axes: Axes, sentences: xr.DataArray) -> None:
    """Add to the legend that a friction is extrapolated; the printed answer states the reason."""
    if (sentences.values.astype(str) != "").any():
        look: Look = {"ls": "", "marker": f"${EXTRAPOLATED}$", "color": GREY, "ms": 4}
        axes.plot([], [], label="friction extrapolated", **look)


def _candidates(axes: Axes, data: xr.Dataset) -> None:
    """Draw each candidate's friction in every environment, with the band at its own restitution factor."""

    def table(name: str) -> Array:
        return data[name].transpose("environment", "material").values.astype(float)

    friction, own = table("material_friction"), table("material_restitution_factor")
    error = np.nan_to_num(table("material_friction_error"))
    order = np.argsort(_measured_mean(friction), kind="stable")
    data, friction, own, error = data.isel(material=order), friction[:, order], own[:, order], error[:, order]
    count, top = order.size, axes.get_ylim()[1]
    axes.set(xlim=(-0.6, count - 0.4), title=r"b  Candidates at their $\eta$")
    extrapolated = (data["material_extrapolation"].values.astype(str) != "").any(axis=0)
    marks = [f" {EXTRAPOLATED}" if mark else "" for mark in extrapolated]
    names = [f"{name}{mark}" for name, mark in zip(data["material"].values, marks, strict=True)]
    axes.set_xticks(range(count), names, rotation=90, fontsize=6.5)
    axes.tick_params(axis="x", length=0)
    explain_extrapolated(axes, data["material_extrapolation"])
    for place, at in enumerate(_measured_mean(own)):
        low, middle, high = _own_band(data, at, top)
        if np.isfinite(middle):
            axes.fill_between([place - 0.4, place + 0.4], low, high, color=BLUE, alpha=0.15, lw=0)
            axes.hlines(middle, place - 0.4, place + 0.4, color=BLUE, lw=1.3)
        if not np.isfinite(friction[:, place]).any():
            look: Look = {"rotation": 90, "ha": "center", "va": "bottom", "fontsize": 6.5, "color": GREY}
            axes.text(place, 0.02 * top, "not measured", **look)
    shift = 0.5 / max(1, friction.shape[0])
    for i, name in enumerate(data["environment"].values.astype(str)):
        places = np.arange(count) + shift * (i - 0.5 * (friction.shape[0] - 1))
        look = {"marker": MARKERS[i % len(MARKERS)], "color": CYCLE[i % len(CYCLE)], "ms": 3.4, "ls": ""}
        axes.errorbar(places, friction[i], yerr=error[i], elinewidth=0.9, label=name, **look)


def _measured_mean(table: Array) -> Array:
    """Return the mean of each column over its finite numbers; infinite without any."""
    known = np.isfinite(table)
    total = np.where(known, table, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    return np.where(known.any(axis=0), total, np.inf)


def _own_band(data: xr.Dataset, at: float, top: float) -> tuple[float, float, float]:
    """Return lower end, middle and upper end of the band at a restitution factor; NaN where not computed."""
    if not has_band(data):
        same = np.isclose(at, float(data.get("here_restitution_factor", np.nan)), rtol=1e-9)
        low, high = band_ends(data, top, "here_") if same else (np.nan, np.nan)
        return float(low), float(data["here_critical_friction"]) if same else np.nan, float(high)
    eta, (low, high) = data["restitution_factor"].values, band_ends(data, top)
    if not (eta.size and eta[0] <= at <= eta[-1]):
        return np.nan, np.nan, np.nan
    ends = (low, data["critical_friction"].values.astype(float), high)
    first, middle, last = (float(np.interp(at, eta, one)) for one in ends)
    return first, middle, last


def comparison(first: xr.Dataset, second: xr.Dataset, titles: Sequence[str]) -> Figure:
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
        low, high = (data[f"scatter_{end}"].values for end in ("low", "high"))
        axes.fill_between(eta, low, high, color=colour, alpha=0.2)
        own = data.get("here_restitution_factor")
        if own is not None and own.size == 1 and np.isfinite(float(own)):
            axes.axvline(float(own), color=colour, ls=line, lw=0.8)
        known = np.concatenate([one[np.isfinite(one)] for one in (middle, high)])
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
        columns = [one - eta for one in with_ends(here, "material_restitution_threshold")]
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
