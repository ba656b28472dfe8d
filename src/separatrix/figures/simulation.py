"""One run of the cage on a page: orbit, energy and work, offset, and the whirl of the centre."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures import spectrum
from separatrix.figures.orbit import draw_orbit, land_boundary, largest_play
from separatrix.figures.style import BLACK, BLUE, CYCLE, GREY, PAGE, VERMILION, label_lines
from separatrix.units import Array

SPRINGS = ("spring_energy", "land_energy")
WIDE = 30.0
"""Ratio of the largest to the smallest energy beyond which its axis is logarithmic."""


def run(data: xr.Dataset) -> Figure:
    """Orbit of the cage centre, energy, work, offset and whirl of one run."""
    figure = Figure(figsize=(PAGE, 7.0), layout="constrained")
    parts: Any = figure.subfigures(nrows=3)
    rows = [part.subplots(ncols=2) for part in parts]
    draw_orbit(rows[0][0], data)
    rows[0][0].set_title("a  Orbit of the cage centre, turning frame")
    draw_energy(rows[0][1], data)
    rows[0][1].set_title("b  Energy; shaded: the judged part")
    _offset(rows[1][0], data)
    for panel in (rows[0][1], rows[1][0], rows[1][1]):
        mark_judged(panel, data)
    draw_work(rows[1][1], data)
    rows[1][1].set_title(f"d  Work; energy balance closes to {ledger_gap(data):.0e}")
    spectrum.draw_spectrum(rows[2][0], data)
    rows[2][0].set_title(f"e  Whirl spectrum{spectrum.in_words(data)}")
    spectrum.draw_against_time(rows[2][1], data)
    rows[2][1].set_title("f  Whirl spectrum against time")
    return figure


def milliseconds(data: xr.Dataset) -> Array:
    """Return the times of the samples [ms]."""
    return 1e3 * np.asarray(data["time"].values, dtype=float)


def is_logarithmic(*runs: xr.Dataset) -> bool:
    """Whether time is drawn logarithmic: a motion that settles does so early."""
    return any(str(run["outcome"].values) == "SETTLES" and run.sizes["time"] > 2 for run in runs)


def time_limits(*runs: xr.Dataset) -> tuple[float, float]:
    """Return both ends of the axis of time [ms]; a millisecond if nothing but the start is there."""
    times = [time for time in map(milliseconds, runs) if time.size > 1]
    last = max((float(time[-1]) for time in times), default=0.0)
    first = min(float(time[1]) for time in times) if is_logarithmic(*runs) else 0.0
    return first, last if last > first else first + 1.0


def mark_judged(axes: Axes, data: xr.Dataset) -> None:
    """Shade the last part of a run, by which it is judged where the motion ends."""
    if "judged_from" in data and float(data["judged_until"]) > float(data["judged_from"]):
        span = (1e3 * float(data[f"judged_{end}"]) for end in ("from", "until"))
        axes.axvspan(*span, color=GREY, alpha=0.2, lw=0, zorder=0)


def time_axis(axes: Axes, *runs: xr.Dataset) -> None:
    """Set the axis of time for one or several runs."""
    if is_logarithmic(*runs):
        axes.set(xscale="log", xlim=time_limits(*runs), xlabel="time, logarithmic [ms]")
        axes.xaxis.set_major_formatter("{x:g}")
    else:
        axes.set(xlim=time_limits(*runs), xlabel="time [ms]")


def works(data: xr.Dataset) -> dict[str, Array]:
    """Return the work of each source that did any, by its name [J]."""
    names = [str(name) for name in data.data_vars if str(name).startswith("work_")]
    found = {name.removeprefix("work_").replace("_", " "): data[name].values for name in names}
    return {name: work for name, work in found.items() if np.any(work)}


def total_energy(data: xr.Dataset) -> Array:
    """Return kinetic energy and the energy of the springs [J]."""
    stored = (data[name].values for name in SPRINGS if name in data)
    return np.asarray(data["kinetic_energy"].values + sum(stored), dtype=float)


def ledger_gap(data: xr.Dataset) -> float:
    """Return what the ledger leaves open at most, as a share of the largest work [-]; 0 without work."""
    done = works(data)
    if not done:
        return 0.0
    change = total_energy(data) - total_energy(data)[0]
    gap = np.abs(change - sum(work - work[0] for work in done.values())).max()
    return float(gap / max(np.abs(work).max() for work in done.values()))


SOURCES = (
    *("pocket friction", "race dampers", "moving frame", "land friction", "land damping"),
    *("ball drive", "gravity", "unbalance"),
)
"""What does work, in the order of its colours: one source looks alike in every picture."""


def source_look(name: str) -> dict[str, Any]:
    """Return colour and dashes of a source's line."""
    place = SOURCES.index(name) if name in SOURCES else len(SOURCES)
    colours = CYCLE[:-1]
    return {"color": colours[place % len(colours)], "ls": "-" if place < len(colours) else (0, (4, 1))}


UNITS = ((1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, "\N{MICRO SIGN}J"))


def energy_unit(largest: float) -> tuple[float, str]:
    """Return size [J] and symbol of the unit in which the largest energy is at least 1, from uJ to kJ."""
    return next((unit for unit in UNITS if largest >= unit[0]), UNITS[-1])


def draw_energy(axes: Axes, *runs: xr.Dataset, looks: tuple[Any, ...] = ({"color": BLACK},)) -> None:
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
    _energy_limits(axes, found[found > 0.0])
    axes.set(ylabel=f"energy [{symbol}]")
    time_axis(axes, *runs)


def _energy_limits(axes: Axes, found: Array) -> None:
    """Set the axis of energy, with room for a legend above the lines."""
    low, high = float(found.min(initial=np.inf)), float(found.max(initial=0.0))
    if found.size and high > WIDE * low:
        low = max(low, 1e-9 * high)
        axes.set(yscale="log", ylim=(0.7 * low, 1.5 * high * (high / low) ** 0.12))
    else:
        axes.set_ylim(0.0, 1.25 * high or 1.0)


def draw_work(axes: Axes, data: xr.Dataset) -> None:
    """Draw the work of each source since the start, named at the ends of the lines."""
    time, done = milliseconds(data), works(data)
    size, symbol = energy_unit(max((float(np.abs(work).max()) for work in done.values()), default=0.0))
    axes.axhline(0.0, color=GREY, lw=0.4)
    for name, work in done.items():
        axes.plot(time, work / size, lw=1.0, **source_look(name))
    axes.set(ylabel=f"work [{symbol}]")
    time_axis(axes, data)
    ends = [
        (float(axes.get_xlim()[1]), float(work[-1]) / size, name, source_look(name)["color"])
        for name, work in done.items()
    ]
    label_lines(axes, ends, gap=0.085)


def _offset(axes: Axes, data: xr.Dataset) -> None:
    """Draw how far the centre is from the axis, with the clearances of pockets and land below it."""
    play = largest_play(data)
    limit: list[tuple[float, str, str]] = [] if play is None else [(play, BLACK, "pockets")]
    land = land_boundary(data)
    if land is not None:
        limit.append((float(land.max()), VERMILION, "land"))
    for radius, colour, _ in limit:
        wide = {"lw": 3.5, "alpha": 0.45} if colour == VERMILION else {"lw": 0.8, "ls": (0, (4, 1.5))}
        axes.axhline(1e3 * radius, color=colour, zorder=1.5, **wide)
    axes.plot(milliseconds(data), 1e3 * np.hypot(*data["position"].values.T), color=BLUE, lw=0.8, zorder=3)
    axes.set(ylabel="offset of the centre [mm]", title="c  Offset of the centre from the axis")
    axes.set_ylim(0.0, 1.08 * max(axes.get_ylim()[1], 1e-6))
    time_axis(axes, data)
    label_lines(axes, [(axes.get_xlim()[1], 1e3 * r, name, colour) for r, colour, name in limit], gap=0.085)
