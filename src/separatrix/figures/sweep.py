"""Figure of a sweep: the restitution factor of every case against each parameter."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.map import axis_values, shown_unit
from separatrix.figures.style import BLACK, PAGE, VERDICT_COLOURS, VERDICT_MARKERS, canvas

MOST_PANELS = 6


LOOK = {"STABLE": 5.0, "UNSTABLE": 4.0, "UNDECIDED": 3.0}
"""Size of the marks of each verdict: where several fall on one place, each is seen."""


def sweep(data: xr.Dataset) -> Figure:
    """Restitution factor against each of the first parameters, marked by verdict where there is one."""
    names = [str(name) for name in data["parameter"].values[:MOST_PANELS]]
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    figure, axes = canvas(PAGE, 2.4 * rows + 0.4, nrows=rows, ncols=columns, sharey=True, squeeze=False)
    for panel, name in zip(axes.flat, names, strict=False):
        _panel(panel, data, name)
    for panel in axes.flat[len(names) :]:
        panel.set_visible(False)
    for row in axes:
        row[0].set_ylabel(r"restitution factor $\eta$ [-]")
    top = float(np.nanmax(data["restitution_factor"].values, initial=0.05))
    axes.flat[0].set_ylim(-0.03 * top, 1.08 * top)
    if np.any(data["verdict"].values != ""):
        figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _panel(axes: Axes, data: xr.Dataset, name: str) -> None:
    x, eta, verdict = axis_values(data, name), data["restitution_factor"].values, data["verdict"].values
    axes.plot(x[verdict == ""], eta[verdict == ""], "o", ms=2.5, mew=0.0, color=BLACK)
    for known, colour in VERDICT_COLOURS.items():
        those, mark = verdict == known, VERDICT_MARKERS[known]
        if those.any():
            axes.plot(
                x[those], eta[those], mark, ms=LOOK[known], mew=0.8, mfc="none", color=colour, label=known
            )
    axes.set_xlabel(f"{name.replace('_', ' ')} [{shown_unit(data, name)[1]}]")
