"""Orders of magnitude of the restitution factor, bare to thick film (the paper's Fig. 8)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, GREY, PAGE, Look, canvas, study_of

DASHES = ((0, (1, 1.5)), (0, (4, 2)), (0, (6, 1.5, 1, 1.5)), (0, (9, 2)), "-")
"""Lines from the least to the largest race friction: those that run along 0 remain distinct."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the picture of `restitution`; bare races have none."""
    if "film_thickness" in data.sizes:
        yield "restitution-film", lubrication(data)


def lubrication(data: xr.Dataset) -> Figure:
    """Restitution factor against film thickness and race friction: dampings summed, and ball free to spin."""
    figure, axes = canvas(PAGE, 3.1, ncols=2, sharey=True)
    _panel(axes[0], data, "lubrication_restitution_factor", float(data["chain_restitution_factor"]))
    free = "restitution_factor_free_spin"
    _panel(axes[1], data, f"lubrication_{free}", float(data[free]))
    axes[0].set(title="a  Race dampings summed (Eq. 18)", ylabel=r"restitution factor $\eta$ [-]")
    axes[1].set(title="b  Ball free to spin in the impact")
    figure.supxlabel("total thickness of the film [\u00b5m]", fontsize=8)
    handles, labels = axes[0].get_legend_handles_labels()
    look: Look = {"title": "race friction", "fontsize": 7.0, "title_fontsize": 7.0, "handlelength": 3.2}
    figure.legend(handles[::-1], labels[::-1], loc="outside right center", **look)
    return figure


def _panel(axes: Axes, data: xr.Dataset, name: str, own: float) -> None:
    """Draw one line for each race friction; bare races are apart from it, at the left."""
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
    friction = study_of(data).get("film", {}).get("race_friction", {}).get("value")
    at = "" if friction is None else f", $f_{{BT}}$ = {friction:g}"
    (star,) = axes.plot(here if here > 0 else bare, own, "*", color=BLACK, ms=9, mfc="white", zorder=5)
    axes.legend([star], [rf"this bearing{at}: $\eta$ = {own:.2f}"], loc="upper right", handletextpad=0.3)
    zero = [f"{f:g}" for f, eta in zip(frictions, data[name].values, strict=True) if not eta.any()]
    if zero:
        words = rf"$\eta$ = 0 throughout for $f_{{BT}}$ = {', '.join(zero)}"
        axes.annotate(words, (0.98, 0.83), xycoords="axes fraction", fontsize=7.5, color=GREY, ha="right")
