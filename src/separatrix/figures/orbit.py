"""The path of the cage centre between the true boundaries of the pockets and of the land."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from separatrix.figures.style import BLACK, BLUE, GREY, LEADER, VERMILION
from separatrix.units import Array

AROUND = np.linspace(0.0, 2 * np.pi, 1441)
"""Directions in which boundaries are drawn: a quarter of a degree apart."""

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


def draw_orbit(axes: Axes, data: xr.Dataset, *others: xr.Dataset) -> None:
    """Draw the centre's path between its boundaries, on a scale that has room for the other runs."""
    x, y = 1e3 * data["position"].values.T
    most = 1e3 * max(map(orbit_reach, (data, *others)))
    axes.plot(x, y, color=BLUE, lw=0.4, alpha=0.9)
    axes.plot(x[:1], y[:1], "o", color=BLACK, ms=3)
    axes.set(xlim=(-most, most), ylim=(-most, most), xlabel="x [mm]", ylabel="y [mm]")
    axes.set_aspect("equal", adjustable="box", anchor="NW")
    axes.locator_params(nbins=6)
    pockets = pocket_boundary(pocket_angles(data), half_plays(data))
    _boundary(axes, pockets, GREY, "first pocket\ntouches", -40.0, "-")
    land = land_boundary(data)
    if land is not None:
        _boundary(axes, land, VERMILION, "land", 35.0, (0, (4, 1.5)))


def orbit_reach(data: xr.Dataset) -> float:
    """Return what a picture of the orbit must show on either side [m]."""
    found = [float(np.abs(data["position"].values).max()), 2.0 * float(half_plays(data).max())]
    land = land_boundary(data)
    if land is not None:
        found.append(float(land.max()))
    else:
        found[1] /= 1.5
    return 1.08 * max(*found, 1e-9)


def _boundary(axes: Axes, radius: Array, colour: str, name: str, degrees: float, style: Any) -> None:
    """Draw a boundary, named at the right of the picture."""
    if not radius.max() > 0.0:
        return
    outline = np.where(np.isfinite(radius), 1e3 * radius, np.nan)
    axes.plot(outline * np.cos(AROUND), outline * np.sin(AROUND), color=colour, lw=0.9, ls=style)
    near = int(np.argmin(np.abs(np.angle(np.exp(1j * (AROUND - np.radians(degrees)))))))
    place = outline[near] * np.array([np.cos(AROUND[near]), np.sin(AROUND[near])])
    axes.annotate(
        name,
        (place[0], place[1]),
        xytext=(1.03, 0.5 + 0.5 * np.sin(np.radians(degrees))),
        textcoords="axes fraction",
        color=colour,
        fontsize=7,
        va="center",
        annotation_clip=False,
        arrowprops={**LEADER, "color": colour},
    )
