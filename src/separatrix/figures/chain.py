"""Figures before the cage: equilibrium, traction (the paper's Fig. 7), restitution (Fig. 8), mobility."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PAGE,
    VERMILION,
    Look,
    canvas,
    label_lines,
    stated,
    study_of,
)
from separatrix.ground.units import Array, format_number

RACES = (("inner", BLUE, "o"), ("outer", VERMILION, "s"))
DASHED = (0, (4, 2))
DASHES = ((0, (1, 1.5)), (0, (4, 2)), (0, (6, 1.5, 1, 1.5)), (0, (9, 2)), "-")
"""Lines from the least to the largest race friction: those that run along 0 remain distinct."""


def bearing(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `bearing`."""
    yield "bearing-balls", balls(data)
    yield "bearing-contacts", contacts(data)


def balls(data: xr.Dataset) -> Figure:
    """Loads and contact angles around the bearing, against the azimuth of the ball, back to the first ball.

    A contact without a load has no angle.
    """
    figure, (left, right) = canvas(PAGE, 2.5, ncols=2)
    azimuth = np.append(np.degrees(data["azimuth"].values), 360.0)
    for name, axes, scale in (("load", left, 1.0), ("contact_angle", right, np.degrees(1.0))):
        ends = []
        for race, colour, marker in RACES:
            around = scale * data[f"{name}_{race}"].values
            if axes is right:
                around = np.where(data[f"load_{race}"].values > 0.0, around, np.nan)
            closed = np.append(around, around[0])
            axes.plot(azimuth, closed, color=colour, lw=0.8)
            axes.plot(azimuth[:-1], around, marker=marker, color=colour, ls="none")
            axes.plot(360.0, closed[-1], marker=marker, color=colour, mfc="white", ls="none")
            ends.append((364.0, float(np.nan_to_num(closed[-1])), race, colour))
        axes.set(xlabel="azimuth of the ball [deg] (open marker: ball 1 again)", xlim=(-8, 425))
        axes.set_xticks(range(0, 361, 60))
        lowest, highest = min(axes.dataLim.y0, 0.0), max(axes.dataLim.y1, 0.0)
        room = 0.15 * (highest - lowest)
        axes.set_ylim(lowest - (room if lowest < 0.0 else 0.0), highest + room)
        label_lines(axes, ends)
    left.set(ylabel="load [N]", title="a  Ball load")
    right.set(ylabel="contact angle [deg]", title="b  Contact angle")
    return figure


def contacts(data: xr.Dataset) -> Figure:
    """The contacts of the most loaded ball: ellipses to scale, pressure, creep across the groove."""
    figure, (plan, pressure, creep) = canvas(PAGE, 2.5, ncols=3)
    creep.axhline(0.0, color=GREY, lw=0.6)
    for (race, colour, _), side, dashes in zip(RACES, (1, -1), ("-", (0, (5, 1.2))), strict=True):
        of = data.sel(race=race)
        a, b, p0 = (float(of[f"contact_{name}"]) for name in ("semi_major", "semi_minor", "max_pressure"))
        look: Look = {"color": colour, "ls": dashes, "label": f"{race} race"}
        angle, centre = np.linspace(0.0, 2 * np.pi, 181), side * 2.2 * b
        ellipse = 1e3 * a * np.cos(angle), 1e3 * (centre + b * np.sin(angle))
        plan.fill(*ellipse, color=colour, alpha=0.25, lw=0)
        plan.plot(*ellipse, lw=1, **look)
        plan.annotate(race, (0, 1e3 * centre), ha="center", va="center", color=colour)
        y = np.linspace(-a, a, 201)
        pressure.plot(1e3 * y, 1e-6 * p0 * np.sqrt(np.maximum(0.0, 1 - (y / a) ** 2)), **look)
        xi = float(of["contact_creep_spin"]) * y + float(of["contact_creep_curvature"]) * y**2
        creep.plot(1e3 * y, 100 * xi, **look)
    widest = 1e3 * float(data["contact_semi_major"].max())
    for axes in (plan, pressure, creep):
        axes.set(xlabel="y across the groove [mm]", xlim=(-1.12 * widest, 1.12 * widest))
    plan.set(title="a  Ellipses, to scale", ylabel="x along rolling, same scale", yticks=[])
    plan.set_aspect("equal", adjustable="datalim")
    pressure.set(title="b  Pressure on the axis x = 0", ylabel="pressure [MPa]", ylim=(0, None))
    creep.set(title="c  Creep by spin and curvature", ylabel="creep ratio [%]")
    pressure.legend(loc="lower center", handlelength=2.2)
    creep.legend(loc="best", handlelength=2.2)
    return figure


def traction(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `traction`."""
    yield "traction-curves", curves(data)
    yield "traction-shear", shear(data)


def curves(data: xr.Dataset) -> Figure:
    """Traction coefficient against creep increment: the bearing's own with its tangent, and other ratios."""
    figure, panels = canvas(PAGE, 3.2, ncols=2, sharey=True)
    for axes, of, increment in _by_race(panels, data):
        ratios = of["ratio_spin_roll_ratio"].values
        for i, colour in enumerate(colormaps["viridis"](np.linspace(0.05, 0.8, ratios.size))):
            coefficient = of["ratio_traction_coefficient"].isel(ratio=i).values
            axes.plot(increment, coefficient, color=colour, lw=0.9, label=signed(ratios[i], 2))
        own, slope = of["traction_coefficient"].values, float(of["slope"])
        label = f"{signed(float(of['spin_roll_ratio']), 3)}, this bearing"
        axes.plot(increment, own, color=BLACK, lw=1.8, label=label)
        rise = np.array([-0.85, 0.85]) * float(np.abs(own).max())
        label = rf"slope at 0: $\alpha$ = {slope:.3g}"
        axes.plot(100 * rise / slope, rise, color=BLACK, lw=0.9, ls=DASHED, label=label)
        look: Look = {"title_fontsize": 7.5, "fontsize": 7, "handlelength": 1.4, "alignment": "left"}
        axes.legend(title=r"$\Delta\omega_{piv}\,/\,\Delta\omega_{roul}$", loc="upper left", **look)
    return figure


def _by_race(panels: Sequence[Axes], data: xr.Dataset) -> Iterator[tuple[Axes, xr.Dataset, Array]]:
    """Yield a panel of traction against creep for each race, with its data and creep increments [%]."""
    panels[0].set_ylabel("traction coefficient $C_T$ [-]")
    for axes, race, letter in zip(panels, ("inner", "outer"), "ab", strict=True):
        axes.axhline(0.0, color=GREY, lw=0.5)
        axes.axvline(0.0, color=GREY, lw=0.5)
        axes.set(title=f"{letter}  Ball on {race} race", xlabel="creep increment [%]")
        of = data.sel(race=race)
        yield axes, of, 100 * of["creep_increment"].values


def shear(data: xr.Dataset) -> Figure:
    """Shear along rolling in three strips of each contact: without slip, with slip, and Coulomb's bound."""
    figure, axes = canvas(PAGE, 4.2, nrows=2, ncols=3, sharex="row", sharey="row")
    middle = data.sizes["strip"] // 2
    strips = [middle // 2, middle, data.sizes["strip"] - 1 - middle // 2]
    letters = iter("abcdef")
    for row, race in zip(axes, ("inner", "outer"), strict=True):
        for panel, strip in zip(row, strips, strict=True):
            _strip(panel, data.sel(race=race).isel(strip=strip), next(letters))
        row[0].set_ylabel(f"{race} race: shear [MPa]")
    figure.supxlabel("x along rolling [mm]; surfaces in free rolling enter at the right", fontsize=8)
    axes[0, 0].legend(loc="upper left", handlelength=1.6, fontsize=6.5)
    return figure


def _strip(axes: Axes, data: xr.Dataset, letter: str) -> None:
    x = 1e3 * data["shear_along"].values
    bound = 1e-6 * data["shear_bound"].values
    axes.fill_between(x, -bound, bound, color=GREY, alpha=0.15, lw=0, label=r"$|\tau| \leq f_{BT}\,p$")
    axes.axhline(0.0, color=GREY, lw=0.5)
    without = 1e-6 * data["shear_shear_without_slip"].values
    axes.plot(x, without, color=BLACK, lw=0.8, ls=DASHED, label="no slip")
    axes.plot(x, 1e-6 * data["shear_shear"].values, color=BLUE, label="with slip")
    axes.set_ylim(-1.6 * bound.max(), 2.2 * bound.max())
    place, creep = 1e3 * float(data["shear_across"]), round(100 * float(data["shear_creep_ratio"]), 4)
    axes.set_title(f"{letter}  y = {signed(place, 2)} mm, creep {signed(creep, 2)} %", fontsize=8)
    axes.locator_params(axis="x", nbins=5)


def signed(value: float, digits: int) -> str:
    """Return a number as text, with the minus sign that the axes have and no negative zero."""
    return f"{value + 0.0:.{digits}g}".replace("-", "\N{MINUS SIGN}")


def restitution(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the picture of `restitution`: of a film; bare races have none."""
    if "film_thickness" in data.sizes:
        yield "restitution-film", lubrication(data)


LEGEND_LINE = 11.0
"""Height of a line of text between a panel and its title [pt]."""


def lubrication(data: xr.Dataset) -> Figure:
    """Restitution factor against film thickness and race friction: dampings summed, and ball free to spin."""
    figure, axes = canvas(PAGE, 3.2, ncols=2, sharey=True)
    free = "restitution_factor_free_spin"
    lines = max(
        _panel(axes[0], data, "lubrication_restitution_factor", float(data["chain_restitution_factor"])),
        _panel(axes[1], data, f"lubrication_{free}", float(data[free])),
    )
    axes[0].set_title("a  Race dampings summed (Eq. 18)", pad=6.0 + LEGEND_LINE * lines)
    axes[0].set_ylabel(r"restitution factor $\eta$ [-]")
    axes[1].set_title("b  Ball free to spin in the impact", pad=6.0 + LEGEND_LINE * lines)
    figure.supxlabel("total thickness of the film [\u00b5m]", fontsize=8)
    handles, labels = axes[0].get_legend_handles_labels()
    look: Look = {"title": "race friction", "fontsize": 7.0, "title_fontsize": 7.0, "handlelength": 3.2}
    figure.legend(handles[::-1], labels[::-1], loc="outside right center", **look)
    return figure


def _panel(axes: Axes, data: xr.Dataset, name: str, own: float) -> int:
    """Draw one line for each race friction; bare races are apart from it, at the left.

    What names the study's own point is above the panel, where no curve can be; its lines are returned.
    """
    thickness, frictions = 1e6 * data["film_thickness"].values, data["race_friction"].values
    films = thickness > 0
    bare = 0.2 * thickness[films].min()
    for i, colour in enumerate(colormaps["viridis"](np.linspace(0.0, 0.85, frictions.size))):
        eta = data[name].values[i]
        label, style = f"$f_{{BT}}$ = {frictions[i]:g}", DASHES[i * len(DASHES) // frictions.size]
        axes.plot(thickness[films], eta[films], color=colour, ls=style, label=label)
        axes.plot(np.full((~films).sum(), bare), eta[~films], "o", color=colour, ms=3.5)
    axes.set(xscale="log", xlim=(0.5 * bare, 1.3 * thickness.max()), ylim=(-0.02, 1))
    ticks = [10.0**k for k in range(-3, 2) if bare < 10.0**k <= thickness.max() * 1.001]
    axes.set_xticks([bare, *ticks], ["bare", *(f"{tick:g}" for tick in ticks)])
    axes.minorticks_off()
    here = 1e6 * float(data["film_thickness_here"])
    friction = stated(study_of(data), "film", "race_friction")
    at = "" if friction is None else f", $f_{{BT}}$ = {friction:g}"
    (star,) = axes.plot(here if here > 0 else bare, own, "*", color=BLACK, ms=9, mfc="white", zorder=5)
    words = [rf"this bearing{at}: $\eta$ = {format_number(own, 2)}"]
    if zero := [f for f, eta in zip(frictions, data[name].values, strict=True) if not eta.any()]:
        words.append(rf"$\eta$ = 0 throughout up to $f_{{BT}}$ = {max(zero):g}")  # eta rises with friction
    place: Look = {"loc": "lower left", "bbox_to_anchor": (-0.03, 1.0), "handletextpad": 0.3}
    axes.legend([star], ["\n".join(words)], **place)
    return len(words)


def mobility(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the picture of `mobility`."""
    yield "mobility", push(data)


def push(data: xr.Dataset) -> Figure:
    """F(u) of the slip fields both ways, the law, the linear law and the capacity."""
    figure, axes = canvas(3.9, 3.3)
    u, capacity = np.append(0.0, data["speed"].values), float(data["capacity"])
    axes.axhline(capacity, color=GREY, lw=0.8, ls=DASHED, label=f"capacity {format_number(capacity, 3)} N")
    linear = np.array((0.0, 1.15 * capacity / float(data["damping"])))
    axes.plot(linear, float(data["damping"]) * linear, color=BLACK, lw=0.8, ls=(0, (1, 1.5)), label="$C_f u$")
    for way, colour in (("forward", BLUE), ("backward", VERMILION)):
        axes.plot(u, np.append(0.0, data[f"force_{way}"].values), color=colour, label=way)
    axes.plot(u, np.append(0.0, data["force_law"].values), color=GREEN, ls=DASHED, label="law")
    axes.set(xlim=(0, u[-1]), ylim=(0, 1.25 * capacity), title="Ball pushed along its orbit")
    axes.set(xlabel="speed beyond free orbit [m/s]", ylabel="force [N]")
    axes.legend(loc="lower right", fontsize=6.5, handlelength=2.2)
    return figure
