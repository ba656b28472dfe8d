"""Figures of the equilibrium: loads and contact angles ball by ball, and the most loaded contact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from separatrix.figures.style import BLUE, GREY, PAGE, VERMILION, Look, canvas, label_lines

RACES = (("inner", BLUE, "o"), ("outer", VERMILION, "s"))


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `bearing`."""
    yield "bearing-balls", balls(data)
    yield "bearing-contacts", contacts(data)


def balls(data: xr.Dataset) -> Figure:
    """Loads and contact angles around the bearing, against the azimuth of the ball, back to the first ball.

    A contact without a load has no angle.
    """
    figure, (left, right) = canvas(PAGE, 2.5, ncols=2)
    azimuth = np.append(np.degrees(data["azimuth"].values), 360.0)
    for name, axes, scale in (("load", left, 1.0), ("contact_angle", right, np.degrees(1.0))):
        ends = []
        for race, colour, marker in RACES:
            around = scale * data[f"{name}_{race}"].values
            if axes is right:
                around = np.where(data[f"load_{race}"].values > 0.0, around, np.nan)
            closed = np.append(around, around[0])
            axes.plot(azimuth, closed, color=colour, lw=0.8)
            axes.plot(azimuth[:-1], around, marker=marker, color=colour, ls="none")
            axes.plot(360.0, closed[-1], marker=marker, color=colour, mfc="white", ls="none")
            ends.append((364.0, float(np.nan_to_num(closed[-1])), race, colour))
        axes.set(xlabel="azimuth of the ball [deg] (open marker: ball 1 again)", xlim=(-8, 425))
        axes.set_xticks(range(0, 361, 60))
        lowest, highest = min(axes.dataLim.y0, 0.0), max(axes.dataLim.y1, 0.0)
        room = 0.15 * (highest - lowest)
        axes.set_ylim(lowest - (room if lowest < 0.0 else 0.0), highest + room)
        label_lines(axes, ends)
    left.set(ylabel="load [N]", title="a  Ball load")
    right.set(ylabel="contact angle [deg]", title="b  Contact angle")
    return figure


def contacts(data: xr.Dataset) -> Figure:
    """The contacts of the most loaded ball: ellipses to scale, pressure, creep across the groove."""
    figure, (plan, pressure, creep) = canvas(PAGE, 2.5, ncols=3)
    creep.axhline(0.0, color=GREY, lw=0.6)
    for (race, colour, _), side, dashes in zip(RACES, (1, -1), ("-", (0, (5, 1.2))), strict=True):
        of = data.sel(race=race)
        a, b, p0 = (float(of[f"contact_{name}"]) for name in ("semi_major", "semi_minor", "max_pressure"))
        look: Look = {"color": colour, "ls": dashes, "label": f"{race} race"}
        angle, centre = np.linspace(0.0, 2 * np.pi, 181), side * 2.2 * b
        ellipse = 1e3 * a * np.cos(angle), 1e3 * (centre + b * np.sin(angle))
        plan.fill(*ellipse, color=colour, alpha=0.25, lw=0)
        plan.plot(*ellipse, lw=1, **look)
        plan.annotate(race, (0, 1e3 * centre), ha="center", va="center", color=colour)
        y = np.linspace(-a, a, 201)
        pressure.plot(1e3 * y, 1e-6 * p0 * np.sqrt(np.maximum(0.0, 1 - (y / a) ** 2)), **look)
        xi = float(of["contact_creep_spin"]) * y + float(of["contact_creep_curvature"]) * y**2
        creep.plot(1e3 * y, 100 * xi, **look)
    widest = 1e3 * float(data["contact_semi_major"].max())
    for axes in (plan, pressure, creep):
        axes.set(xlabel="y across the groove [mm]", xlim=(-1.12 * widest, 1.12 * widest))
    plan.set(title="a  Ellipses, to scale", ylabel="x along rolling, same scale", yticks=[])
    plan.set_aspect("equal", adjustable="datalim")
    pressure.set(title="b  Pressure on the axis x = 0", ylabel="pressure [MPa]", ylim=(0, None))
    creep.set(title="c  Creep by spin and curvature", ylabel="creep ratio [%]")
    pressure.legend(loc="lower center", handlelength=2.2)
    creep.legend(loc="best", handlelength=2.2)
    return figure
