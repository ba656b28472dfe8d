"""Two runs of the cage together: their orbits side by side, all else on the same axes."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures import simulation, spectrum
from separatrix.figures.forces import largest_force
from separatrix.figures.heading import cut, heading
from separatrix.figures.orbit import draw_orbit
from separatrix.figures.style import BLUE, ORANGE, PAGE

NAME_WIDTH = 60
"""Letters on a line above a column."""

LOOKS: tuple[dict[str, Any], ...] = ({"color": BLUE, "lw": 0.9}, {"color": ORANGE, "lw": 0.9})
"""Of the first and of the second run: dark and light, also in grey."""

FAINT = 1e-3
"""Least force on a logarithmic axis, over the largest."""


def comparison(data_a: xr.Dataset, data_b: xr.Dataset, names: tuple[str, str]) -> Figure:
    """Orbit, energy, spectrum and forces of two runs, each on the scale of both.

    Parameters
    ----------
    data_a, data_b : Dataset
        Of two simulations.
    names : tuple of str
        What stands above each column.
    """
    runs, figure = (data_a, data_b), Figure(figsize=(PAGE, 8.0), layout="constrained")
    parts: Any = figure.subfigures(nrows=2, height_ratios=[1.0, 2.0])
    above, below = parts
    axes = dict(zip(("A", "B", *TITLES), (*above.subplots(ncols=2), *below.subplots(nrows=3)), strict=True))
    for letter, data, other, name in zip("AB", runs, runs[::-1], names, strict=True):
        draw_orbit(axes[letter], data, other)
        axes[letter].set_title(f"{letter}  {headline(name, data)}", fontsize=6.5, linespacing=1.35)
    looks: Any = tuple({**look, "label": label} for look, label in zip(LOOKS, "AB", strict=True))
    simulation.draw_energy(axes["energy"], *runs, looks=looks)
    _forces(axes["force"], *runs, looks=looks)
    spectrum.draw_spectrum(axes["spectrum"], *runs, looks=looks)
    for name, title in TITLES.items():
        axes[name].set_title(title)
        axes[name].legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, handlelength=2.0)
    return figure


TITLES = {
    "energy": "Energy of cage and springs",
    "force": "Largest pocket force (thick) and land force (thin)",
    "spectrum": "Whirl spectrum of the velocity",
}


def headline(name: str, data: xr.Dataset) -> str:
    """Return the name on at most two lines, and below it which run it is and how it ended."""
    return "\n".join([*(cut(name, NAME_WIDTH) or [""]), *heading(data, NAME_WIDTH)[-2:]])


def _forces(axes: Axes, *runs: xr.Dataset, looks: tuple[Any, ...]) -> None:
    """Draw the largest pocket force and the land's of each run on a logarithmic scale."""
    most = 1e-9
    for data, look in zip(runs, looks, strict=True):
        time, land = simulation.milliseconds(data), np.abs(data["land_force"].values)
        axes.plot(time, largest_force(data), **look)
        axes.plot(time, land, color=look["color"], lw=0.4)
        most = max(most, float(largest_force(data).max()), float(land.max()))
    axes.set(yscale="log", ylim=(FAINT * most, 1.5 * most), ylabel="force [N]")
    simulation.time_axis(axes, *runs)
