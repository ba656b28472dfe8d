"""A page of a run of the cage, in the plane or in space: orbit, whirl, forces, energy; two runs together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures import motion
from separatrix.figures.motion import is_in_space, milliseconds, time_axis
from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    ORANGE,
    PAGE,
    VERMILION,
    Look,
    cut,
    heading,
    label_lines,
    legend_above,
)
from separatrix.ground.units import Array
from separatrix.told.sentences import pocket_force

MICRO = "\N{MICRO SIGN}"
UNITS = ((1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, f"{MICRO}J"))

WIDE = 30.0
"""Ratio of the largest to the smallest energy beyond which its axis is logarithmic."""

FAINT, NAME_WIDTH = 1e-3, 60
"""In a comparison: least force on a logarithmic axis, over the largest; letters on a line above a column."""

COURSES = (
    ("position", "offset [mm]", "Offset of the centre from the bearing axis"),
    ("axial_place", "axial place [mm]", "Axial place of the cage"),
    ("lean", "tilt [mrad]", "Angle between the axes of cage and bearing"),
)
"""Variables against time, each with label and title."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the picture of `simulate`."""
    yield "simulation", course(data)


def course(data: xr.Dataset) -> Figure:
    """Orbit and whirl of the centre, in space its lean; offsets, forces and energy against time."""
    drawn = [one for one in COURSES if data[one[0]].ndim > 0]
    in_space, count = is_in_space(data), len(drawn) + 2
    heights = [2.4] * (1 + in_space) + [1.25 * count]
    figure = Figure(figsize=(PAGE, sum(heights)), layout="constrained")
    parts = figure.subfigures(nrows=len(heights), height_ratios=heights, squeeze=False)[:, 0]
    orbit, whirl = parts[0].subplots(ncols=2)
    motion.draw_orbit(orbit, data)
    orbit.set_title("a  Cage centre, turning frame")
    motion.draw_spectrum(whirl, data)
    whirl.set_title("b  Whirl: velocity of the centre, turning frame")
    if in_space:
        lean, clock = parts[1].subplots(ncols=2)
        motion.draw_lean(lean, data)
        lean.set_title("c  Lean of the cage's axis")
        draw_work(clock, data)
        clock.set_title("d  Work on the cage since the start")
    rows = parts[-1].subplots(nrows=count, sharex=True)
    for axes, (name, label, _) in zip(rows, drawn, strict=False):
        values = 1e3 * data[name].values
        axes.plot(milliseconds(data), np.hypot(*values.T) if values.ndim > 1 else values, color=BLUE, lw=0.7)
        axes.set_ylabel(label)
    draw_forces(rows[-2], data)
    draw_energy(rows[-1], data)
    limit = float(data.get("force_limit", np.nan))
    peak = pocket_force(float(data["largest_contact_force"]), limit if limit > 0.0 else None, short=True)
    titles = (*(title for *_, title in drawn), f"Forces; largest of a pocket {peak}", "Energy")
    for axes, letter, title in zip(rows, "efghi" if in_space else "cde", titles, strict=True):
        axes.set_title(f"{letter}  {title}{'; shaded: the judged part' if axes is rows[0] else ''}")
        motion.shade_judged(axes, data)
        time_axis(axes, data)
        if axes is not rows[-1]:
            axes.set_xlabel("")
    _limit(rows[0], motion.clearances(data))
    if in_space:
        _limit(rows[1], [(1e3 * motion.axial_play(data), motion.POCKETS, "pockets")], both=True)
        _limit(rows[2], motion.lean_limits(data))
    figure.align_ylabels(rows)
    return figure


def draw_forces(axes: Axes, data: xr.Dataset) -> None:
    """Draw the largest force of any pocket, and that of the land, against time."""
    land, largest = data["land_force"].values, largest_force(data)
    axes.plot(milliseconds(data), largest, color=BLUE, lw=0.7, label="largest pocket force")
    if np.any(land):
        look: Look = {"color": VERMILION, "lw": 0.9, "ls": (0, (4, 1)), "zorder": 1.9, "label": "land"}
        axes.plot(milliseconds(data), land, **look)
        axes.legend(loc="upper right", ncols=2, handlelength=1.6)
    axes.set(ylabel="force [N]", ylim=(0.0, 1.3 * max(float(largest.max()), float(land.max()), 1e-9)))


def _limit(axes: Axes, limits: Sequence[tuple[float, Look, str]], *, both: bool = False) -> None:
    """Draw clearances that are near enough, on both sides of 0 or above it, and name them."""
    top = max(abs(value) for value in axes.get_ylim())
    near = [one for one in limits if one[0] <= 2.5 * top]
    for size, look, _ in near:
        for place in (size, -size)[: 1 + both]:
            axes.axhline(place, **look)
    most = 1.12 * max([top, *(one[0] for one in near)])
    axes.set_ylim(-most if both else 0.0, most)
    ends = [(float(axes.get_xlim()[1]), size, name, look["color"]) for size, look, name in near]
    label_lines(axes, ends, gap=0.16)


def largest_force(data: xr.Dataset) -> Array:
    """Return the largest of the pockets' forces at each sample [N]."""
    return np.asarray(data["contact_force"].values.max(axis=1), dtype=float)


def works(data: xr.Dataset) -> dict[str, tuple[Array, Look]]:
    """Return the work of each source that did any [J], with its colour, the same in every picture."""
    names = [str(name) for name in data.data_vars if str(name).startswith("work_")]
    found = {
        name.removeprefix("work_").replace("_", " "): (data[name].values, {"color": colour})
        for name, colour in zip(names, CYCLE, strict=False)
    }
    return {name: one for name, one in found.items() if np.any(one[0])}


def total_energy(data: xr.Dataset) -> Array:
    """Return kinetic energy and the energy of the springs [J]."""
    return np.asarray(data["kinetic_energy"].values + data["stored_energy"].values, dtype=float)


def energy_unit(largest: float) -> tuple[float, str]:
    """Return size [J] and symbol of the unit in which the largest energy is at least 1, from uJ to kJ."""
    return next((unit for unit in UNITS if largest >= unit[0]), UNITS[-1])


def draw_energy(axes: Axes, *runs: xr.Dataset, looks: Sequence[Look] = ({"color": BLACK},)) -> None:
    """Draw the energy of some runs against time; logarithmic if it is wide, its kinetic part if it is one."""
    energies = [total_energy(data) for data in runs]
    size, symbol = energy_unit(max(float(energy.max()) for energy in energies))
    for data, energy, look in zip(runs, energies, looks, strict=True):
        axes.plot(milliseconds(data), energy / size, **{"lw": 1.1, "label": "energy", **look})
    if len(runs) == 1:
        kinetic = runs[0]["kinetic_energy"].values / size
        axes.plot(milliseconds(runs[0]), kinetic, color=BLUE, lw=0.6, label="its kinetic part")
        axes.legend(loc="upper right", bbox_to_anchor=(1.0, 1.02), ncols=2, handlelength=1.4)
    found = np.concatenate(energies) / size
    low, high = float(found[found > 0.0].min(initial=np.inf)), float(found.max(initial=0.0))
    if high > WIDE * low:
        low = max(low, 1e-9 * high)
        # a legend above the lines
        axes.set(yscale="log", ylim=(0.7 * low, 1.5 * high * (high / low) ** 0.12))
    else:
        axes.set_ylim(0.0, 1.25 * high or 1.0)
    axes.set(ylabel=f"energy [{symbol}]")
    time_axis(axes, *runs)


def draw_work(axes: Axes, data: xr.Dataset) -> None:
    """Draw the work of each source since the start, named at the ends of the lines."""
    done = works(data)
    size, symbol = energy_unit(max((float(np.abs(work).max()) for work, _ in done.values()), default=0.0))
    axes.axhline(0.0, color=GREY, lw=0.4)
    for work, look in done.values():
        axes.plot(milliseconds(data), work / size, lw=1.0, **look)
    axes.set(ylabel=f"work [{symbol}]")
    time_axis(axes, data)
    last = float(axes.get_xlim()[1])
    ends = [(last, float(work[-1]) / size, name, look["color"]) for name, (work, look) in done.items()]
    label_lines(axes, ends, gap=0.085)


def comparison(first: xr.Dataset, second: xr.Dataset, names: Sequence[str]) -> Figure:
    """Orbit, energy, spectrum and forces of two runs, each on the scale of both, with a name above each."""
    runs, figure = (first, second), Figure(figsize=(PAGE, 8.0), layout="constrained")
    above, below = figure.subfigures(nrows=2, height_ratios=[1.0, 2.0], squeeze=False)[:, 0]
    orbits, (stored, force, spectrum) = above.subplots(ncols=2), below.subplots(nrows=3)
    for axes, letter, data, other, name in zip(orbits, "AB", runs, runs[::-1], names, strict=True):
        motion.draw_orbit(axes, data, other)
        words = [*(cut(name, NAME_WIDTH) or [""]), *heading(data, NAME_WIDTH)[-2:]]
        axes.set_title(f"{letter}  " + "\n".join(words), fontsize=6.5, linespacing=1.35)
    looks: list[Look] = [{"color": colour, "lw": 0.9} for colour in (BLUE, ORANGE)]  # dark and light in grey
    most = max(1e-9, *(float(max(largest_force(one).max(), one["land_force"].max())) for one in runs))
    for letter, data, look in zip("AB", runs, looks, strict=True):
        look["label"] = letter
        force.plot(milliseconds(data), largest_force(data), **look)
        force.plot(milliseconds(data), data["land_force"].values, color=look["color"], lw=0.4)
    force.set(yscale="log", ylim=(FAINT * most, 1.5 * most), ylabel="force [N]")
    time_axis(force, *runs)
    draw_energy(stored, *runs, looks=looks)
    motion.draw_spectrum(spectrum, *runs, looks=tuple(looks))
    stored.set_title("Energy of cage and springs")
    force.set_title("Largest pocket force (thick) and land force (thin)")
    spectrum.set_title("Whirl spectrum of the velocity")
    for axes in (stored, force, spectrum):
        legend_above(axes, columns=2, length=2.0)
    return figure
