"""Two runs of the cage side by side, on common scales."""

from __future__ import annotations

import textwrap

import xarray as xr
from matplotlib.figure import Figure

from separatrix.figures import simulation
from separatrix.figures.orbit import draw_orbit
from separatrix.figures.style import PAGE, canvas, legend_below

NAME_WIDTH = 44
"""Letters of a name that fit on a line above a column."""


def comparison(data_a: xr.Dataset, data_b: xr.Dataset, names: tuple[str, str]) -> Figure:
    """Orbit, energy, spectrum and forces of two runs, each on the scale of both.

    Parameters
    ----------
    data_a, data_b : Dataset
        Of two simulations.
    names : tuple of str
        What stands above each column.
    """
    figure, axes = canvas(PAGE, 8.8, nrows=4, ncols=2, height_ratios=[1.6, 1.1, 1.0, 1.0])
    runs = (data_a, data_b)
    draw = (draw_orbit, simulation.draw_energy, simulation.draw_spectrum, simulation.draw_force)
    for column, data, other, name in zip(axes.T, runs, runs[::-1], names, strict=True):
        for panel, draw_panel in zip(column, draw, strict=True):
            draw_panel(panel, data, other)
        column[0].set_title(heading(name, data))
    for row, title in zip(axes[1:], TITLES, strict=True):
        row[0].set_title(title)
    legend_below(figure, axes[1], columns=4)
    return figure


TITLES = ("Energy and work", "Whirl spectrum of the velocity", "Contact forces")


def heading(name: str, data: xr.Dataset) -> str:
    """Return the name on at most two lines, and below it how the run ended."""
    lines = textwrap.wrap(name, NAME_WIDTH, max_lines=2, placeholder=" ...") or [""]
    time = simulation.milliseconds(data)[-1]
    return "\n".join(
        [*lines, f"kick {float(data['kick']):g} m/s; {data['outcome'].values} after {time:.4g} ms"]
    )
