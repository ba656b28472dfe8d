"""Figures of the traction curves (the paper's Fig. 7)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, GREY, PAGE, Look, canvas

DASHED = (0, (4, 2))


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `traction`."""
    yield "traction-curves", curves(data)
    yield "traction-shear", shear(data)


def curves(data: xr.Dataset) -> Figure:
    """Traction coefficient against creep increment: the bearing's own with its tangent, and other ratios."""
    figure, panels = canvas(PAGE, 3.2, ncols=2, sharey=True)
    for axes, race, letter in zip(panels, ("inner", "outer"), "ab", strict=True):
        of = data.sel(race=race)
        increment, ratios = 100 * of["creep_increment"].values, of["ratio_spin_roll_ratio"].values
        axes.axhline(0.0, color=GREY, lw=0.5)
        axes.axvline(0.0, color=GREY, lw=0.5)
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
        axes.set(title=f"{letter}  Ball on {race} race", xlabel="creep increment [%]")
    panels[0].set_ylabel("traction coefficient $C_T$ [-]")
    return figure


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
    """Draw one strip, with its place across the groove as title."""
    x = 1e3 * data["shear_along"].values
    bound = 1e-6 * float(data["race_friction"]) * data["shear_pressure"].values
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
