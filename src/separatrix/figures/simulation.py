"""Runs of the cage on a page: orbit, energy, work, offset and whirl; contact forces; two runs together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.typing import HashableList

from separatrix.figures import motion
from separatrix.figures.motion import (
    is_logarithmic,
    milliseconds,
    time_axis,
)
from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    ORANGE,
    PAGE,
    SKY,
    VERMILION,
    Look,
    colour_bar,
    cut,
    heading,
    label_lines,
    legend_above,
)
from separatrix.units import Array

SPRINGS = ("spring_energy", "land_energy")
SOURCES = (
    *("pocket friction", "race dampers", "moving frame", "land friction", "land damping"),
    *("ball drive", "gravity", "unbalance", "races", "grooves"),
)
"""What does work, in the order of its colours: one source looks alike in every picture."""

UNITS = ((1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, "\N{MICRO SIGN}J"))

WIDE = 30.0
"""Ratio of the largest to the smallest energy beyond which its axis is logarithmic."""

COLUMNS = 600
"""Most columns of the picture of the forces; each shows the largest force of its samples."""

TURNS, FEWEST, BEFORE = 6.0, 40, 0.15
"""Turns of the whirl and least samples of the close view; its least share before the largest force."""

FAINT, NAME_WIDTH = 1e-3, 60
"""In a comparison: least force on a logarithmic axis, over the largest; letters on a line above a column."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `simulate`."""
    yield "simulation", run(data)
    yield "simulation-forces", forces(data)


def run(data: xr.Dataset) -> Figure:
    """Orbit of the cage centre, energy, work, offset and whirl of one run."""
    figure = Figure(figsize=(PAGE, 7.0), layout="constrained")
    parts = figure.subfigures(nrows=3, squeeze=False)[:, 0]
    (orbit, energy), (offset, work), (spectrum, against_time) = (part.subplots(ncols=2) for part in parts)
    motion.draw_orbit(orbit, data)
    orbit.set_title("a  Orbit of the cage centre, turning frame")
    draw_energy(energy, data)
    energy.set_title("b  Energy; shaded: the judged part")
    _offset(offset, data)
    draw_work(work, data)
    work.set_title(f"d  Work; energy balance closes to {energy_gap(data):.0e}")
    for axes in (energy, offset, work):
        motion.shade_judged(axes, data)
    motion.draw_spectrum(spectrum, data)
    frequency, share = motion.of_run(data)
    strongest = 1e-3 * frequency[share.argmax()] if share.any() else 0.0
    words = f", largest at {strongest:.2g} kHz".replace("-", "\N{MINUS SIGN}") if strongest else ""
    spectrum.set_title(f"e  Whirl spectrum{words}")
    motion.draw_against_time(against_time, data)
    against_time.set_title("f  Whirl spectrum against time")
    return figure


def works(data: xr.Dataset) -> dict[str, Array]:
    """Return the work of each source that did any, by its name [J]."""
    names = [str(name) for name in data.data_vars if str(name).startswith("work_")]
    found = {name.removeprefix("work_").replace("_", " "): data[name].values for name in names}
    return {name: work for name, work in found.items() if np.any(work)}


def total_energy(data: xr.Dataset) -> Array:
    """Return kinetic energy and the energy of the springs [J]."""
    stored = (data[name].values for name in SPRINGS if name in data)
    return np.asarray(data["kinetic_energy"].values + sum(stored), dtype=float)


def energy_gap(data: xr.Dataset) -> float:
    """Return what the energy balance leaves open at most, over the largest work [-]; 0 without work."""
    done = works(data)
    if not done:
        return 0.0
    change = total_energy(data) - total_energy(data)[0]
    gap = np.abs(change - sum(work - work[0] for work in done.values())).max()
    return float(gap / max(np.abs(work).max() for work in done.values()))


def source_look(name: str) -> Look:
    """Return colour and dashes of a source's line."""
    place = SOURCES.index(name) if name in SOURCES else len(SOURCES)
    colours = CYCLE[:-1]
    return {"color": colours[place % len(colours)], "ls": "-" if place < len(colours) else (0, (4, 1))}


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
        axes.set(
            yscale="log", ylim=(0.7 * low, 1.5 * high * (high / low) ** 0.12)
        )  # a legend above the lines
    else:
        axes.set_ylim(0.0, 1.25 * high or 1.0)
    axes.set(ylabel=f"energy [{symbol}]")
    time_axis(axes, *runs)


def draw_work(axes: Axes, data: xr.Dataset) -> None:
    """Draw the work of each source since the start, named at the ends of the lines."""
    done = works(data)
    size, symbol = energy_unit(max((float(np.abs(work).max()) for work in done.values()), default=0.0))
    axes.axhline(0.0, color=GREY, lw=0.4)
    for name, work in done.items():
        axes.plot(milliseconds(data), work / size, lw=1.0, **source_look(name))
    axes.set(ylabel=f"work [{symbol}]")
    time_axis(axes, data)
    last = float(axes.get_xlim()[1])
    ends = [(last, float(work[-1]) / size, name, source_look(name)["color"]) for name, work in done.items()]
    label_lines(axes, ends, gap=0.085)


def _offset(axes: Axes, data: xr.Dataset) -> None:
    """Draw how far the centre is from the axis, with the clearances of pockets and land below it."""
    limits = motion.clearances(data)
    for radius, look, _ in limits:
        axes.axhline(radius, **look)
    axes.plot(milliseconds(data), 1e3 * np.hypot(*data["position"].values.T), color=BLUE, lw=0.8, zorder=3)
    axes.set(ylabel="offset of the centre [mm]", title="c  Offset of the centre from the axis")
    axes.set_ylim(0.0, 1.08 * max(axes.get_ylim()[1], 1e-6))
    time_axis(axes, data)
    ends = [(float(axes.get_xlim()[1]), radius, name, look["color"]) for radius, look, name in limits]
    label_lines(axes, ends, gap=0.085)


def forces(data: xr.Dataset) -> Figure:
    """Contact forces pocket by pocket and at the land, and how often each pocket touches its ball."""
    rows: list[HashableList[str]] = [
        ["raster", "near raster"],
        ["force", "near force"],
        ["contacts", "contacts"],
    ]
    figure = Figure(figsize=(PAGE, 5.8), layout="constrained")
    panels = figure.subplot_mosaic(rows, height_ratios=[2.0, 1.3, 1.3], width_ratios=[2.2, 1.0])
    near, largest = close_view(data), max(float(largest_force(data).max()), 1e-9)
    mesh = raster(panels["raster"], data, largest, logarithmic=is_logarithmic(data))
    time_axis(panels["raster"], data)
    panels["raster"].set(title="a  Force in each pocket", ylabel="pocket")
    raster(panels["near raster"], near, largest, logarithmic=False)
    panels["near raster"].set(title="b  Around the largest force", xlabel="time [ms]", xlim=view_ends(near))
    rasters = [panels["raster"], panels["near raster"]]
    colour_bar(mesh, rasters, "force [N], root scale", pad=0.01, aspect=14)
    top = 1.05 * max(largest, float(np.abs(data["land_force"].values).max()))
    for name, part in (("force", data), ("near force", near)):
        axes, time, land = panels[name], milliseconds(part), np.abs(part["land_force"].values)
        axes.plot(time, largest_force(part), color=BLUE, lw=0.7, label="largest pocket force")
        if np.any(land):
            axes.plot(time, land, color=VERMILION, lw=0.9, ls=(0, (4, 1)), label="land", zorder=1.9)
        axes.set_ylim(0.0, top)
    time_axis(panels["force"], data)
    panels["force"].set(title="c  Largest forces", ylabel="force [N]")
    legend_above(panels["force"], columns=2)
    panels["near force"].set(title="d  The same", xlabel="time [ms]", xlim=view_ends(near))
    _contacts(panels["contacts"], data)
    return figure


def close_view(data: xr.Dataset) -> xr.Dataset:
    """Return the samples of some turns of the fastest strong whirl, around the largest pocket force."""
    time, whirl = data["time"].values, motion.fastest_whirl(data)
    middle = int(largest_force(data).argmax())
    span = TURNS / whirl if whirl > 0.0 else np.inf
    first = int(np.searchsorted(time, time[middle] - 0.5 * span))
    last = int(np.searchsorted(time, time[middle] + 0.5 * span))
    first = max(0, min(first, middle - FEWEST // 2))
    return data.isel(time=slice(first, max(last, middle + FEWEST // 2)))


def view_ends(near: xr.Dataset) -> tuple[float, float]:
    """Return both ends of the axis of a close view [ms], with time before the largest force.

    Where the kick itself throws the cage into a pocket, that is time before the start of the run.
    """
    time = milliseconds(near)
    last = float(time[-1]) if time[-1] > time[0] else float(time[0]) + 1.0
    peak = float(time[int(largest_force(near).argmax())])
    return min(float(time[0]), peak - BEFORE * (last - float(time[0]))), last


def largest_force(data: xr.Dataset) -> Array:
    """Return the largest of the pockets' forces at each sample [N]."""
    return np.asarray(np.abs(data["contact_force"].values).max(axis=1), dtype=float)


def pooled(time: Array, force: Array, edges: Array) -> Array:
    """Return the largest force between neighbouring edges of time, of each pocket; shape (edges - 1, ball).

    A space without a sample has the force of the sample before it.
    """
    starts = np.searchsorted(time, edges[:-1], side="left").clip(0, time.size - 1)
    ends = np.searchsorted(time, edges[1:], side="left").clip(1, time.size)
    size, spaces = np.abs(force), zip(starts, ends, strict=True)
    return np.array([size[a:b].max(axis=0) if b > a else size[max(0, b - 1)] for a, b in spaces])


def raster(axes: Axes, data: xr.Dataset, largest: float, *, logarithmic: bool) -> ScalarMappable:
    """Draw the force in each pocket against time: white for none."""
    time = milliseconds(data)
    first = float(time[min(1, time.size - 1)]) if logarithmic else float(time[0])
    last = float(time[-1]) if time[-1] > first else first + 1.0
    space = np.geomspace if logarithmic else np.linspace
    edges = space(first, last, min(COLUMNS, max(2, time.size)) + 1)
    force = pooled(time, data["contact_force"].values, edges)
    look: Look = {"cmap": "Greys", "norm": PowerNorm(0.5, 0.0, largest), "rasterized": True}
    mesh = axes.pcolormesh(edges, np.arange(force.shape[1] + 1) + 0.5, force.T, **look)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    return mesh


def contact_counts(force: Array) -> Array:
    """Return how often each pocket begins to push its ball forward, and backward; shape (2, ball).

    From samples of the force, shape (time, ball): what falls between two of them is not seen.
    """
    sides = np.stack([force > 0.0, force < 0.0])
    before = np.concatenate([np.zeros_like(sides[:, :1]), sides[:, :-1]], axis=1)
    return np.asarray((sides & ~before).sum(axis=1), dtype=float)


def _contacts(axes: Axes, data: xr.Dataset) -> None:
    counts = contact_counts(data["contact_force"].values)
    total = counts.sum()
    forward, backward = 100 * counts / (total or 1.0)
    places = np.arange(1, forward.size + 1)
    axes.bar(places, forward, 0.7, color=BLUE, label="pushes the ball forward")
    hatched: Look = {"color": SKY, "hatch": "///", "edgecolor": "white", "lw": 0}
    axes.bar(places, backward, 0.7, bottom=forward, label="pushes it backward", **hatched)
    axes.axhline(100 / forward.size, color=GREY, lw=0.8, ls=(0, (4, 1.5)), label="even share")
    axes.set(xlabel="pocket", ylabel="share of contacts [%]", xlim=(0.3, forward.size + 0.7))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_ylim(0, 1.05 * max((forward + backward).max(), 100 / forward.size))
    axes.set_title(f"e  {total:.0f} contacts")
    legend_above(axes, columns=3)


def comparison(first: xr.Dataset, second: xr.Dataset, names: Sequence[str]) -> Figure:
    """Orbit, energy, spectrum and forces of two runs, each on the scale of both, with a name above each."""
    runs, figure = (first, second), Figure(figsize=(PAGE, 8.0), layout="constrained")
    above, below = figure.subfigures(nrows=2, height_ratios=[1.0, 2.0], squeeze=False)[:, 0]
    orbits, (energy, force, spectrum) = above.subplots(ncols=2), below.subplots(nrows=3)
    for axes, letter, data, other, name in zip(orbits, "AB", runs, runs[::-1], names, strict=True):
        motion.draw_orbit(axes, data, other)
        words = [*(cut(name, NAME_WIDTH) or [""]), *heading(data, NAME_WIDTH)[-2:]]
        axes.set_title(f"{letter}  " + "\n".join(words), fontsize=6.5, linespacing=1.35)
    looks: list[Look] = [{"color": colour, "lw": 0.9} for colour in (BLUE, ORANGE)]  # dark and light in grey
    most = max(1e-9, *(float(max(largest_force(one).max(), abs(one["land_force"]).max())) for one in runs))
    for letter, data, look in zip("AB", runs, looks, strict=True):
        look["label"] = letter
        force.plot(milliseconds(data), largest_force(data), **look)
        force.plot(milliseconds(data), np.abs(data["land_force"].values), color=look["color"], lw=0.4)
    force.set(yscale="log", ylim=(FAINT * most, 1.5 * most), ylabel="force [N]")
    time_axis(force, *runs)
    draw_energy(energy, *runs, looks=looks)
    motion.draw_spectrum(spectrum, *runs, looks=tuple(looks))
    energy.set_title("Energy of cage and springs")
    force.set_title("Largest pocket force (thick) and land force (thin)")
    spectrum.set_title("Whirl spectrum of the velocity")
    for axes in (energy, force, spectrum):
        legend_above(axes, columns=2, length=2.0)
    return figure
