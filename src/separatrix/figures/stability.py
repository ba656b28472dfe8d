"""The stability curve with its band (the paper's Fig. 2)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, GREY, PAGE, canvas

HIGHEST = 0.5
"""Friction at the top of the picture: above it no cage material is of interest."""

ETA_LABEL = r"restitution factor $\eta$ [-]"
FRICTION_LABEL = r"ball/cage friction $f_{BC}$ [-]"


def stability(data: xr.Dataset) -> Figure:
    """Critical friction against restitution factor: curve, band, linear limit, and the bearing's own eta."""
    figure, axes = canvas(PAGE, 3.9)
    frame(axes, data, highest(data))
    chain_lines(axes, data)
    axes.text(0.42, 0.05, "stable", transform=axes.transAxes, color=GREY, style="italic")
    axes.text(0.97, 0.5, "unstable", transform=axes.transAxes, color=GREY, style="italic", ha="right")
    axes.set_title("Stability of the cage: critical friction and its band")
    figure.legend(loc="outside lower left", ncols=2, fontsize=6.5, handlelength=1.8, columnspacing=1.5)
    return figure


def highest(data: xr.Dataset) -> float:
    """Friction at the top of the picture: the band, up to a limit."""
    found = data["critical_friction_high"].values
    found = found[np.isfinite(found)]
    return float(min(HIGHEST, 1.5 * found.max())) if found.size else HIGHEST


def frame(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Draw the curve with its band and the linear limit; the band reaches the edge where it has no end."""
    eta = data["restitution_factor"].values
    middle, low, high = (data[f"critical_friction{end}"].values for end in ("", "_low", "_high"))
    kicks = data["kicks"].values
    axes.set(xlim=(0, 1), ylim=(0, top), xlabel=ETA_LABEL, ylabel=FRICTION_LABEL)
    low, high = (np.where(np.isnan(end), edge, end) for end, edge in ((low, 0.0), (high, 2 * top)))
    known = np.isfinite(middle)
    ends = f"{kicks.min():g} to {kicks.max():g} m/s"
    several = f"10 % of the runs grow at some kick, to 90 % at every kick ({ends})"
    span = several if kicks.size > 1 else f"10 to 90 % of the runs grow, kick {kicks[0]:g} m/s"
    label = f"half of {int(data['runs'])} runs grow, kick {float(data['middle_kick']):g} m/s"
    axes.plot(eta, middle, color=BLUE, label=label)
    scatter = data["scatter_low"].values, data["scatter_high"].values
    axes.fill_between(eta, *scatter, color=BLUE, alpha=0.3, lw=0, label="its 95 % interval")
    axes.fill_between(
        eta,
        low,
        high,
        where=known,
        color=BLUE,
        alpha=0.15,
        lw=0,
        label=span,
    )
    limit = data["linear_limit_critical_friction"].values
    axes.plot(
        eta, limit, color=GREY, lw=0.9, ls=(0, (4, 2)), label="linear limit: no clearance, balls at rest"
    )


def chain_lines(axes: Axes, data: xr.Dataset) -> None:
    """Draw the restitution factors of the chain as upright lines."""
    for name, style, text in (
        ("chain_restitution_factor", "-", r"this bearing, $\eta$ = {:.2f} (Eq. 18)"),
        ("chain_restitution_factor_free_spin", ":", r"the same, ball free to spin, $\eta$ = {:.2f}"),
    ):
        value = float(data[name])
        axes.axvline(value, color=BLACK, ls=style, lw=1.0, label=text.format(value))
