"""Figures of the traction curves (the paper's Fig. 7)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, GREY, PAGE, canvas


def curves(data: xr.Dataset) -> Figure:
    """Traction coefficient against creep increment: as it runs with its tangent, and at other ratios."""
    figure, axes = canvas(PAGE, 3.2, ncols=2, sharey=True)
    for panel, race, letter in zip(axes, ("inner", "outer"), "ab", strict=True):
        _race(panel, data.sel(race=race))
        panel.set(title=f"{letter}  Ball on {race} race", xlabel="creep increment [%]")
    axes[0].set_ylabel("traction coefficient $C_T$ [-]")
    return figure


def _race(axes: Axes, data: xr.Dataset) -> None:
    """Draw one race: other ratios in colour, the bearing's own in black with its tangent."""
    increment = 100 * data["creep_increment"].values
    ratios = data["ratio_spin_roll_ratio"].values
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.axvline(0.0, color=GREY, lw=0.5)
    for i, colour in enumerate(colormaps["viridis"](np.linspace(0.05, 0.8, ratios.size))):
        coefficient = data["ratio_traction_coefficient"].isel(ratio=i).values
        axes.plot(increment, coefficient, color=colour, lw=0.9, label=signed(ratios[i], 2))
    own = data["traction_coefficient"].values
    label = f"{signed(float(data['spin_roll_ratio']), 3)}, this bearing"
    axes.plot(
        increment,
        own,
        color=BLACK,
        lw=1.8,
        label=label,
    )
    _tangent(axes, float(data["slope"]), float(np.abs(own).max()))
    title = r"$\Delta\omega_{piv}\,/\,\Delta\omega_{roul}$"
    axes.legend(
        title=title, title_fontsize=7.5, fontsize=7, loc="upper left", handlelength=1.4, alignment="left"
    )


def _tangent(axes: Axes, slope: float, top: float) -> None:
    """Draw the slope at the origin, up to most of the height."""
    rise = np.array([-0.85, 0.85]) * top
    label = rf"slope $\alpha$ = {slope:.3g}"
    axes.plot(100 * rise / slope, rise, color=BLACK, lw=0.9, ls=(0, (4, 2)), label=label)


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
    text = "x along rolling [mm]; free rolling: the surfaces enter the contact at the right"
    figure.supxlabel(text, fontsize=8)
    axes[0, 0].legend(loc="upper left", handlelength=1.6, fontsize=6.5)
    return figure


def signed(value: float, digits: int) -> str:
    """Return a number as text, with the minus sign that the axes have and no negative zero."""
    return f"{value + 0.0:.{digits}g}".replace("-", "\N{MINUS SIGN}")


def _strip(axes: Axes, data: xr.Dataset, letter: str) -> None:
    """Draw one strip, with its place across the groove as title."""
    x = 1e3 * data["shear_along"].values
    bound = 1e-6 * float(data["race_friction"]) * data["shear_pressure"].values
    axes.fill_between(x, -bound, bound, color=GREY, alpha=0.15, lw=0, label=r"$|\tau| \leq f_{BT}\,p$")
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.plot(
        x,
        1e-6 * data["shear_shear_without_slip"].values,
        color=BLACK,
        lw=0.8,
        ls=(0, (4, 2)),
        label="no slip",
    )
    axes.plot(x, 1e-6 * data["shear_shear"].values, color=BLUE, label="with slip")
    axes.set_ylim(-1.6 * bound.max(), 2.2 * bound.max())
    place, creep = 1e3 * float(data["shear_across"]), 100 * float(data["shear_creep_ratio"])
    axes.set_title(f"{letter}  y = {signed(place, 2)} mm, creep {signed(creep, 2)} %")
    axes.locator_params(axis="x", nbins=5)
