"""The path of the cage centre between the true boundaries of the pockets and of the land."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from separatrix.figures.style import BLACK, BLUE, SKY, VERMILION
from separatrix.units import Array

AROUND = np.linspace(0.0, 2 * np.pi, 1441)
"""Directions in which boundaries are drawn: a quarter of a degree apart."""

FINE, LAST = 6, 5
"""Points drawn for a sample of the path, and turns at its end that are drawn darker."""

BEYOND = 2.0
"""Half the play over the land's gap from which the pockets are left out of the picture."""

NEVER = 1e3
"""A pocket boundary so many times the play away, along the radius of a single ball, is none."""


def pocket_angles(data: xr.Dataset) -> Array:
    """Return the angle of each pocket in the frame of the ball set [rad]; even unless the data say more."""
    if "pocket_angle" in data:
        return np.asarray(data["pocket_angle"].values, dtype=float)
    count = data.sizes["ball"]
    return 2 * np.pi * np.arange(count) / count


def half_plays(data: xr.Dataset) -> Array:
    """Return half the play of each ball in its pocket [m]."""
    if "half_play" in data:
        return np.asarray(data["half_play"].values, dtype=float)
    return np.full(data.sizes["ball"], 0.5 * float(data["cage_pocket_clearance"]))


def pocket_boundary(angles: Array, plays: Array, around: Array = AROUND) -> Array:
    """Return how far the centre may go in each direction until a pocket touches its ball [m].

    Without rotation and lead that is where |r . e_t,j| = c_j: the polygon inside 2 Z lines. A single ball
    leaves the way along its own radius free: there it is infinite.

    Parameters
    ----------
    angles, plays : ndarray
        Of each pocket, shape (ball,) [rad] and [m].
    around : ndarray
        Directions [rad].
    """
    across = np.abs(np.sin(around[:, np.newaxis] - angles))
    reach = plays / np.maximum(across, 1.0 / NEVER)
    return np.where((across < 1.0 / NEVER).all(axis=1), np.inf, reach.min(axis=1))


def land_boundary(data: xr.Dataset, around: Array = AROUND, turned: float = 0.0) -> Array | None:
    """Return how far the centre may go in each direction until the cage touches its land [m]; None without.

    Parameters
    ----------
    data : Dataset
        Of a simulation.
    around : ndarray
        Directions [rad].
    turned : float
        Rotation of the cage, which takes its lobes along [rad].
    """
    clearance = float(data["cage_land_clearance"]) if "cage_land_clearance" in data else np.nan
    guidance = str(data["cage_guidance"].values) if "cage_guidance" in data else "ball"
    if guidance == "ball" or not np.isfinite(clearance):
        return None
    wave = float(data.get("cage_land_out_of_round", 0.0))
    lobes = int(data.get("cage_land_lobes", 2))
    sign = (-1) ** lobes if guidance == "inner" else 1
    return 0.5 * clearance - wave * sign * np.cos(lobes * (around - turned))


def smooth_path(time: Array, position: Array, velocity: Array, fine: int = FINE) -> Array:
    """Return the path through samples as the cubics that have their positions and velocities.

    Straight lines between the samples of a fast whirl would be drawn as a polygon.

    Parameters
    ----------
    time, position, velocity : ndarray
        Shapes (sample,) [s], (sample, 2) [m] and (sample, 2) [m/s].
    fine : int
        Points for each sample but the last.
    """
    s = np.linspace(0.0, 1.0, fine, endpoint=False)[:, np.newaxis]
    step = np.diff(time)[:, np.newaxis, np.newaxis]
    start, end = position[:-1, np.newaxis], position[1:, np.newaxis]
    slope, next_slope = step * velocity[:-1, np.newaxis], step * velocity[1:, np.newaxis]
    there = start + (end - start) * s**2 * (3 - 2 * s)
    path = there + slope * s * (1 - s) ** 2 - next_slope * s**2 * (1 - s)
    return np.concatenate([path.reshape(-1, 2), position[-1:]])


def path_of(data: xr.Dataset) -> Array:
    """Return the smooth path of the centre in a simulation, shape (point, 2) [m]."""
    time, position, velocity = (data[name].values.astype(float) for name in ("time", "position", "velocity"))
    return smooth_path(time, position, velocity)


def last_turns(path: Array, turns: float = LAST) -> int:
    """Return the first point of so many last turns, by their length; 0 if the path is not much longer."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    around = 2 * np.pi * float(np.hypot(*path[-1]))
    first = int(np.searchsorted(length, length[-1] - turns * around))
    return first if length[-1] > 2 * turns * around and around > 0.0 else 0


def draw_orbit(axes: Axes, data: xr.Dataset, *others: xr.Dataset, legend: bool = True) -> None:
    """Draw the centre's path between its boundaries, on a scale that has room for the other runs."""
    path = 1e3 * path_of(data)
    most = 1e3 * max(map(orbit_reach, (data, *others)))
    axes.set(xlim=(-most, most), ylim=(-most, most), xlabel="x [mm]", ylabel="y [mm]")
    axes.set_aspect("equal", adjustable="box", anchor="NW")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5))
    first = last_turns(path)
    if first:
        axes.plot(*path.T, color=SKY, lw=0.35, alpha=0.8, rasterized=True, label="path")
    _boundaries(axes, data)
    label = "path" if not first else f"last {LAST} orbits"
    axes.plot(*path[first:].T, color=BLUE, lw=0.8 if first else 0.6, label=label, zorder=3)
    axes.plot(*path[0], "o", color=BLACK, ms=3.5, ls="", label="start")
    axes.plot(*path[-1], "s", mfc="white", mec=BLACK, ms=3.5, ls="", label="end")
    if legend:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=6.5, handlelength=2.0)


def orbit_reach(data: xr.Dataset) -> float:
    """Return what a picture of the orbit must show on either side [m]."""
    far, land, play = (float(np.abs(data["position"].values).max()), land_boundary(data), largest_play(data))
    found = max(far, play or 0.0, 0.0 if land is None else float(land.max()))
    return 1.12 * max(found, 1e-9)


def largest_play(data: xr.Dataset) -> float | None:
    """Return half the largest play of the pockets [m]; None if the centre stays far within."""
    play, land = float(half_plays(data).max()), land_boundary(data)
    far = float(np.hypot(*data["position"].values.T).max())
    least = max(far, 0.0 if land is None else float(land.max()))
    return play if land is None or play <= BEYOND * least else None


def _boundaries(axes: Axes, data: xr.Dataset) -> None:
    """Draw where the first pocket and where the land touches, if there are such places.

    They lie below the path, the land wide and light, so that neither hides the other or a path along it.
    """
    pockets, land = pocket_boundary(pocket_angles(data), half_plays(data)), land_boundary(data)
    known: list[tuple[Array, dict[str, Any], str]] = []
    if land is not None:
        known.append((land, {"color": VERMILION, "lw": 3.5, "alpha": 0.45}, "land clearance"))
    if largest_play(data) is not None:
        known.append((pockets, {"color": BLACK, "lw": 0.8, "ls": (0, (4, 1.5))}, "pocket clearance"))
    for radius, look, label in known:
        if radius.max() > 0.0:
            outline = ring(np.where(np.isfinite(radius), 1e3 * radius, np.nan), AROUND)
            axes.plot(*outline.T, **look, label=label, zorder=1.5)


def ring(radius: Array | float, angle: Array) -> Array:
    """Return points at angles on a circle, or at a radius for each, shape (angle, 2)."""
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
