"""Orders of magnitude of the restitution factor, bare to thick film (the paper's Fig. 8)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, GREY, PAGE, canvas, label_lines


def lubrication(data: xr.Dataset) -> Figure:
    """Restitution factor against film thickness and race friction: as printed, and ball free to spin."""
    figure, axes = canvas(PAGE, 3.1, ncols=2, sharey=True)
    names = ("restitution_factor", "restitution_factor_free_spin")
    titles = ("a  Dampings added, as printed (Eq. 18)", "b  Ball free to spin in the blow")
    for panel, name, title in zip(axes, names, titles, strict=True):
        own = float(data[f"chain_{name}" if name == "restitution_factor" else name])
        _panel(panel, data, f"lubrication_{name}", own)
        panel.set_title(title)
    axes[0].set_ylabel(r"restitution factor $\eta$ [-]")
    figure.supxlabel("total thickness of the film [\u00b5m]", fontsize=8)
    return figure


def _panel(axes: Axes, data: xr.Dataset, name: str, own: float) -> None:
    """Draw one line for each race friction; bare races stand apart at the left."""
    thickness = 1e6 * data["film_thickness"].values
    films = thickness > 0
    bare = 0.2 * thickness[films].min()
    frictions = data["race_friction"].values
    ends = []
    for i, colour in enumerate(colormaps["viridis"](np.linspace(0.05, 0.75, frictions.size))):
        eta = data[name].values[i]
        axes.plot(thickness[films], eta[films], color=colour)
        axes.plot(np.full((~films).sum(), bare), eta[~films], "o", color=colour, ms=3.5)
        ends.append((thickness.max(), float(eta[-1]), f"$f_{{BT}}$ = {frictions[i]:g}", colour))
    axes.set(xscale="log", xlim=(0.5 * bare, thickness.max()), ylim=(0, 1))
    ticks = [10.0**k for k in range(-3, 2) if bare < 10.0**k <= thickness.max() * 1.001]
    axes.set_xticks([bare, *ticks], ["bare", *(f"{tick:g}" for tick in ticks)])
    axes.minorticks_off()
    axes.axhline(own, color=GREY, lw=0.8, ls=(0, (4, 2)))
    here = 1e6 * float(data["film_thickness_here"])
    axes.plot(here if here > 0 else bare, own, "*", color=BLACK, ms=8)
    axes.annotate(
        rf"this bearing, $\eta$ = {own:.2f}",
        (0.6 * bare, own),
        xytext=(0, 3),
        textcoords="offset points",
        fontsize=7,
    )
    label_lines(axes, ends)
