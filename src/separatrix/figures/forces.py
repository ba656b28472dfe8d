"""Contact forces of one run: pocket by pocket, the largest and the land's, and who takes the impacts."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from separatrix.figures.simulation import is_logarithmic, milliseconds, time_axis, time_limits
from separatrix.figures.spectrum import fastest_whirl
from separatrix.figures.style import BLUE, GREY, PAGE, SKY, VERMILION, canvas
from separatrix.units import Array

COLUMNS = 600
"""Most columns of the picture of the forces; each shows the largest force of its samples."""

TURNS, FEWEST = 6.0, 40
"""Turns of the whirl, and least samples, in the close view."""


BEFORE = 0.15
"""Share of the close view that lies before the largest force at least."""


def forces(data: xr.Dataset) -> Figure:
    """Contact forces pocket by pocket and at the land, and how often each pocket touches."""
    figure, axes = canvas(PAGE, 5.8, nrows=3, ncols=2, height_ratios=[2.0, 1.3, 1.3], width_ratios=[2.2, 1.0])
    largest = max(float(np.abs(data["contact_force"].values).max(initial=0.0)), 1e-9)
    near = close_view(data)
    mesh = _raster(axes[0, 0], data, largest, logarithmic=is_logarithmic(data))
    _raster(axes[0, 1], near, largest)
    axes[0, 0].set(title="a  Force in each pocket", ylabel="pocket")
    axes[0, 1].set_title("b  Around the largest force")
    bar = figure.colorbar(mesh, ax=axes[0, :].tolist(), pad=0.01, aspect=14)
    bar.set_label("force [N], root scale")
    bar.outline.set_visible(False)
    draw_force(axes[1, 0], data)
    time_axis(axes[1, 0], data)
    draw_force(axes[1, 1], near)
    axes[1, 1].set(xlabel="time [ms]", ylabel="", xlim=view_ends(near), ylim=axes[1, 0].get_ylim())
    axes[0, 1].set_xlim(view_ends(near))
    axes[1, 0].set_title("c  Largest forces")
    axes[1, 0].legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, handlelength=1.4)
    axes[1, 1].set_title("d  The same")
    grid = axes[2, 0].get_gridspec()
    for panel in axes[2]:
        panel.remove()
    _touches(figure.add_subplot(grid[2, :]), data)
    return figure


def close_view(data: xr.Dataset) -> xr.Dataset:
    """Return the samples of some turns of the fastest strong whirl, around the largest pocket force."""
    time = data["time"].values
    middle = int(np.abs(data["contact_force"].values).max(axis=1).argmax())
    whirl = fastest_whirl(data)
    span = TURNS / whirl if whirl > 0.0 else np.inf
    first = int(np.searchsorted(time, time[middle] - 0.5 * span))
    last = int(np.searchsorted(time, time[middle] + 0.5 * span))
    first = max(0, min(first, middle - FEWEST // 2))
    return data.isel(time=slice(first, max(last, middle + FEWEST // 2)))


def view_ends(near: xr.Dataset) -> tuple[float, float]:
    """Return both ends of the axis of a close view [ms], with time before the largest force.

    Where the kick itself throws the cage into a pocket, that is time before the start of the run.
    """
    first, last = _ends(near)
    peak = float(milliseconds(near)[int(largest_force(near).argmax())])
    return min(first, peak - BEFORE * (last - first)), last


def _ends(data: xr.Dataset) -> tuple[float, float]:
    """Return the first and the last time of a close view [ms]; a millisecond if they are the same."""
    time = milliseconds(data)
    return float(time[0]), float(time[-1]) if time[-1] > time[0] else float(time[0]) + 1.0


def draw_force(axes: Axes, data: xr.Dataset) -> None:
    """Draw the largest pocket force at each instant, and the land's."""
    time, pockets = milliseconds(data), largest_force(data)
    axes.plot(time, pockets, color=BLUE, lw=0.7, label="largest pocket force")
    land = np.abs(data["land_force"].values)
    if np.any(land):
        axes.plot(time, land, color=VERMILION, lw=0.9, ls=(0, (4, 1)), label="land")
    axes.set(ylabel="force [N]", ylim=(0, 1.05 * max(pockets.max(), land.max(), 1e-9)))


def largest_force(data: xr.Dataset) -> Array:
    """Return the largest of the pockets' forces at each sample [N]."""
    return np.asarray(np.abs(data["contact_force"].values).max(axis=1), dtype=float)


def pooled(time: Array, force: Array, edges: Array) -> Array:
    """Return the largest absolute force between neighbouring edges, of each pocket.

    Parameters
    ----------
    time, force : ndarray
        Shapes (time,) and (time, ball).
    edges : ndarray
        Rising times.

    Returns
    -------
    ndarray
        Shape (edges - 1, ball); a space without a sample has that of the sample before it.
    """
    starts = np.searchsorted(time, edges[:-1], side="left").clip(0, time.size - 1)
    size = np.abs(force)
    ends = np.searchsorted(time, edges[1:], side="left").clip(1, time.size)
    rows = [
        size[a:b].max(axis=0) if b > a else size[max(0, b - 1)] for a, b in zip(starts, ends, strict=True)
    ]
    return np.array(rows)


def _raster(axes: Axes, data: xr.Dataset, largest: float, *, logarithmic: bool | None = None) -> Any:
    """Draw the force in each pocket against time: white for none. A close view if None."""
    first, last = _ends(data) if logarithmic is None else time_limits(data)
    space = np.geomspace if logarithmic else np.linspace
    edges = space(first, last, min(COLUMNS, max(2, data.sizes["time"])) + 1)
    force = pooled(milliseconds(data), data["contact_force"].values, edges)
    count = force.shape[1]
    look: Any = {"cmap": "Greys", "norm": PowerNorm(0.5, 0.0, largest), "rasterized": True}
    mesh = axes.pcolormesh(edges, np.arange(count + 1) + 0.5, force.T, **look)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set(xlabel="time [ms]", xlim=(first, last))
    if logarithmic is not None:
        time_axis(axes, data)
    return mesh


def touches(force: Array) -> Array:
    """Return how often each pocket begins to touch its ball, pushing it forward or holding it back.

    Parameters
    ----------
    force : ndarray
        Samples of the contact force, shape (time, ball).

    Returns
    -------
    ndarray
        Shape (2, ball): forward, back. What falls between two samples is not seen.
    """
    sides = np.stack([force > 0.0, force < 0.0])
    before = np.concatenate([np.zeros_like(sides[:, :1]), sides[:, :-1]], axis=1)
    return np.asarray((sides & ~before).sum(axis=1), dtype=float)


def _touches(axes: Axes, data: xr.Dataset) -> None:
    """Draw the share of each pocket in the touches of all."""
    counts = touches(data["contact_force"].values)
    total = counts.sum()
    forward, back = 100 * counts / (total or 1.0)
    places = np.arange(1, forward.size + 1)
    axes.bar(places, forward, 0.7, color=BLUE, label="pushing the ball forward")
    hatched: Any = {"color": SKY, "hatch": "///", "edgecolor": "white", "lw": 0}
    axes.bar(places, back, 0.7, bottom=forward, label="holding it back", **hatched)
    axes.axhline(100 / forward.size, color=GREY, lw=0.8, ls=(0, (4, 1.5)), label="even share")
    axes.set(xlabel="pocket", ylabel="share of touches [%]", xlim=(0.3, forward.size + 0.7))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_ylim(0, 1.05 * max((forward + back).max(), 100 / forward.size))
    axes.set_title(f"e  {total:.0f} touches seen")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=3, handlelength=1.6)
