"""The stability curve with its band (the paper's Fig. 2), alone and with candidates on it (Figs 9-12)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, GREY, PAGE, VERMILION, canvas

HIGHEST = 0.5
"""Friction at the top of the picture: above it no cage material is of interest."""


def stability(data: xr.Dataset) -> Figure:
    """Critical friction against restitution factor: curve, band, linear limit, and the bearing's own eta."""
    figure, axes = canvas(0.72 * PAGE, 3.4)
    frame(axes, data)
    return figure


def frame(axes: Axes, data: xr.Dataset) -> None:
    """Draw the curve with its band, the linear limit, the regions and the lines of eta."""
    eta = data["restitution_factor"].values
    middle, low, high = (data[name].values for name in CURVES)
    axes.set(xlim=(0, 1), ylim=(0, top(data)), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    axes.fill_between(
        eta, low, np.where(np.isnan(high), axes.get_ylim()[1], high), color=BLUE, alpha=0.15, lw=0
    )
    axes.plot(eta, middle, color=BLUE)
    axes.plot(eta, data["linear_limit_critical_friction"].values, color=GREY, lw=0.9, ls=(0, (4, 2)))
    chain_lines(axes, data)


CURVES = ("critical_friction", "critical_friction_low", "critical_friction_high")
ETA_LABEL = r"restitution factor $\eta$ [-]"
FRICTION_LABEL = r"ball/cage friction $f_{BC}$ [-]"


def top(data: xr.Dataset) -> float:
    """Return the highest friction to draw."""
    found = data["critical_friction_high"].values
    found = found[np.isfinite(found)]
    return float(min(HIGHEST, 1.1 * found.max())) if found.size else HIGHEST


def chain_lines(axes: Axes, data: xr.Dataset) -> None:
    """Draw the restitution factors of the chain as upright lines, named at their tops."""
    for name, style, text in (
        ("chain_restitution_factor", "-", r"this bearing, $\eta$ = {:.2f}"),
        ("chain_restitution_factor_free_spin", ":", r"ball free to spin, {:.2f}"),
    ):
        value = float(data[name])
        axes.axvline(value, color=VERMILION, ls=style, lw=1.0)
        axes.text(value, 1.01, text.format(value), transform=axes.get_xaxis_transform(), color=VERMILION)


def _unused() -> str:
    return BLACK
