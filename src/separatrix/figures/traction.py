"""Figures of the traction curves (the paper's Fig. 7)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, GREY, PAGE, canvas, label_lines


def curves(data: xr.Dataset) -> Figure:
    """Traction coefficient against creep increment: as it runs with its tangent, and at other ratios."""
    figure, axes = canvas(PAGE, 3.0, ncols=2, sharey=True)
    for panel, race, letter in zip(axes, ("inner", "outer"), "ab", strict=True):
        _race(panel, data.sel(race=race))
        panel.set(title=f"{letter}  Ball on {race} race", xlabel="creep increment [%]")
    axes[0].set_ylabel("traction coefficient $C_T$ [-]")
    return figure


def _race(axes: Axes, data: xr.Dataset) -> None:
    increment = 100 * data["creep_increment"].values
    ratios = data["ratio_spin_roll_ratio"].values
    colours = colormaps["viridis"](np.linspace(0.05, 0.85, ratios.size))
    ends: list[tuple[float, float, str, Any]] = []
    for i, ratio in enumerate(ratios):
        coefficient = data["ratio_traction_coefficient"].isel(ratio=i).values
        axes.plot(increment, coefficient, color=colours[i], lw=0.9)
        ends.append((*_label_point(increment, coefficient, i, ratios.size), f"{ratio:g}", colours[i]))
    axes.plot(increment, data["traction_coefficient"].values, color=BLACK, lw=1.8)
    _tangent(axes, data, float(np.abs(data["traction_coefficient"]).max()))
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.axvline(0.0, color=GREY, lw=0.5)
    _legend(axes, data, ends)


def _label_point(x: np.ndarray, y: np.ndarray, place: int, count: int) -> tuple[float, float]:  # type: ignore[type-arg]
    at = int(np.searchsorted(x, 0.0) + (place + 1) * (x.size / 2) / (count + 2))
    return float(x[at]), float(y[at])


def _tangent(axes: Axes, data: xr.Dataset, top: float) -> None:
    slope = float(data["slope"]) / 100
    reach = 0.9 * top / slope
    axes.plot([-reach, reach], [-0.9 * top, 0.9 * top], color=BLACK, lw=0.9, ls=(0, (4, 2)))


def _legend(axes: Axes, data: xr.Dataset, ends: list[tuple[float, float, str, Any]]) -> None:
    """Name the curves by their ratio at the right, and the curve of the study at the lower right."""
    right = axes.get_xlim()[1]
    curves = data["ratio_traction_coefficient"].values[:, -1]
    labels = [(right, float(y), text, colour) for y, (_, _, text, colour) in zip(curves, ends, strict=True)]
    label_lines(axes, labels)
    axes.text(
        0.97,
        0.05,
        f"black: this bearing\n$\\Delta\\omega_{{piv}}/\\Delta\\omega_{{roul}}$ = "
        f"{float(data['spin_roll_ratio']):.3g}\n"
        f"dashed: slope $\\alpha$ = {float(data['slope']):.3g}",
        transform=axes.transAxes,
        ha="right",
        va="bottom",
        fontsize=7.0,
    )
