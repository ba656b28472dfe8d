"""One run of the cage: orbit, energies and whirl on one page, contact forces on another."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from separatrix.figures.orbit import draw_orbit, half_plays, land_boundary
from separatrix.figures.style import BLACK, BLUE, CYCLE, GREY, PAGE, SKY, VERMILION, canvas, label_lines
from separatrix.units import Array

SPRINGS = ("spring_energy", "land_energy")
COLUMNS = 600
"""Most columns of the picture of the forces; each shows the largest force of its samples."""


def run(data: xr.Dataset) -> Figure:
    """Orbit of the cage centre, energies, offset and whirl spectrum of one run."""
    figure, axes = canvas(PAGE, 5.4, nrows=2, ncols=2)
    draw_orbit(axes[0, 0], data)
    axes[0, 0].set_title("a  Orbit of the cage centre, turning frame")
    draw_energy(axes[0, 1], data)
    _energy_names(axes[0, 1], data)
    axes[0, 1].set_title(f"b  Energy and work; the ledger closes to {ledger_gap(data):.1g}")
    _offset(axes[1, 0], data)
    draw_spectrum(axes[1, 1], data)
    axes[1, 1].set_title(f"d  Whirl spectrum{_strongest(data)}")
    return figure


def forces(data: xr.Dataset) -> Figure:
    """Contact forces pocket by pocket and at the land, and how often each pocket touches."""
    figure, axes = canvas(PAGE, 5.6, nrows=3, height_ratios=[2.0, 1.3, 1.3])
    _raster(figure, axes[0], data)
    axes[0].set_title("a  Force in each pocket")
    draw_force(axes[1], data)
    axes[1].set_title("b  Largest pocket force, and the land's")
    _touches(axes[2], data)
    return figure


def milliseconds(data: xr.Dataset) -> Array:
    """Return the times of the samples [ms]."""
    return 1e3 * np.asarray(data["time"].values, dtype=float)


def is_logarithmic(*runs: xr.Dataset) -> bool:
    """Whether time is drawn logarithmic: a motion that dies does so early."""
    return any(str(run["outcome"].values) == "DIES" and run.sizes["time"] > 2 for run in runs)


def time_limits(*runs: xr.Dataset) -> tuple[float, float]:
    """Return both ends of the axis of time [ms]; a millisecond if nothing but the start is there."""
    times = [time for time in map(milliseconds, runs) if time.size > 1]
    last = max((float(time[-1]) for time in times), default=0.0)
    first = min(float(time[1]) for time in times) if is_logarithmic(*runs) else 0.0
    return first, last if last > first else first + 1.0


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


def draw_energy(axes: Axes, data: xr.Dataset, *others: xr.Dataset) -> None:
    """Draw the energy with its kinetic part, and the work of each source since the start.

    Beside other runs the scale has room for them: linear up to about that of the kick, logarithmic beyond.
    """
    time, total = milliseconds(data), 1e3 * total_energy(data)
    axes.plot(time, total, color=BLACK, lw=1.0, label="energy", zorder=2.1)
    axes.plot(time, 1e3 * data["kinetic_energy"].values, color=GREY, lw=0.7, label="its kinetic part")
    for name, work in works(data).items():
        axes.plot(time, 1e3 * work, lw=0.9, label=name, **source_look(name))
    axes.axhline(0.0, color=GREY, lw=0.4)
    low, high = _energy_limits(data, *others)
    if others:
        kick = max(float(total[0]), 1e-3 * (high - low))
        axes.set_yscale("symlog", linthresh=10.0 ** np.ceil(np.log10(kick)), linscale=1.5)
        low, high = 2.0 * low, 2.0 * high
    axes.set(ylabel="energy, work [mJ]", ylim=(low, high))
    time_axis(axes, data, *others)


def _energy_names(axes: Axes, data: xr.Dataset) -> None:
    """Write the names of the energy's lines at their ends."""
    last = float(milliseconds(data)[-1])
    ends = [(last, 1e3 * float(total_energy(data)[-1]), "energy (thin: kinetic)", BLACK)]
    for name, work in works(data).items():
        ends.append((last, 1e3 * float(work[-1]), name, source_look(name)["color"]))
    label_lines(axes, ends, gap=0.075)


def _energy_limits(*runs: xr.Dataset) -> tuple[float, float]:
    """Return both ends of the axis of energy [mJ]."""
    found = np.concatenate(
        [[0.0, 1e-9], *(v for run in runs for v in (total_energy(run), *works(run).values()))]
    )
    low, high = 1e3 * found.min(), 1e3 * found.max()
    return low - 0.05 * (high - low), high + 0.05 * (high - low)


WORK_COLOURS = CYCLE[:-1]


def _offset(axes: Axes, data: xr.Dataset) -> None:
    """Draw how far the centre is from the axis, with the pocket play and the land."""
    limit = [(half_plays(data).max(), GREY, "half play")]
    land = land_boundary(data)
    if land is not None:
        limit.append((land.max(), VERMILION, "land"))
    axes.plot(milliseconds(data), 1e3 * np.hypot(*data["position"].values.T), color=BLUE, lw=0.8)
    for radius, colour, _ in limit:
        axes.axhline(1e3 * radius, color=colour, lw=0.9, ls=(0, (4, 1.5)))
    axes.set(ylabel="offset of the centre [mm]", title="c  Distance of the centre from the axis")
    axes.set_ylim(0.0, 1.08 * max(axes.get_ylim()[1], 1e-6))
    time_axis(axes, data)
    label_lines(axes, [(axes.get_xlim()[1], 1e3 * r, name, colour) for r, colour, name in limit], gap=0.07)


def draw_force(axes: Axes, data: xr.Dataset, *others: xr.Dataset) -> None:
    """Draw the largest pocket force at each instant, and the land's; with room for the other runs."""
    time, pockets = milliseconds(data), np.abs(data["contact_force"].values).max(axis=1)
    axes.plot(time, pockets, color=BLUE, lw=0.6, label="largest pocket force")
    if np.any(data["land_force"].values):
        axes.plot(time, np.abs(data["land_force"].values), color=VERMILION, lw=0.6, label="land")
    axes.set(ylabel="force [N]")
    time_axis(axes, data, *others)
    largest = [
        np.abs(run[name].values).max() for run in (data, *others) for name in ("contact_force", "land_force")
    ]
    axes.set_ylim(0, 1.25 * max(*largest, 1e-9))
    axes.legend(loc="upper right", ncols=2, handlelength=1.4)


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


def _raster(figure: Figure, axes: Axes, data: xr.Dataset) -> None:
    """Draw the force in each pocket against time: white for none."""
    first, last = time_limits(data)
    space = np.geomspace if is_logarithmic(data) else np.linspace
    edges = space(first, last, min(COLUMNS, max(2, data.sizes["time"])) + 1)
    force = pooled(milliseconds(data), data["contact_force"].values, edges)
    count = force.shape[1]
    norm = PowerNorm(0.5, 0.0, max(float(force.max()), 1e-9))
    look: Any = {"cmap": "Greys", "norm": norm, "rasterized": True}
    mesh = axes.pcolormesh(edges, np.arange(count + 1) + 0.5, force.T, **look)
    axes.set(ylabel="pocket")
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    time_axis(axes, data)
    bar = figure.colorbar(mesh, ax=axes, pad=0.01, aspect=14)
    bar.set_label("force [N], root scale")
    bar.outline.set_visible(False)


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
    axes.bar(
        places,
        back,
        0.7,
        bottom=forward,
        color=SKY,
        hatch="///",
        edgecolor="white",
        lw=0,
        label="holding it back",
    )
    axes.axhline(100 / forward.size, color=GREY, lw=0.8, ls=(0, (4, 1.5)), label="even share")
    axes.set(xlabel="pocket", ylabel="share of touches [%]", xlim=(0.3, forward.size + 0.7))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_ylim(0, 1.3 * max(axes.get_ylim()[1], 1.0))
    axes.set_title(f"c  Share of each pocket in the {total:.0f} touches seen in the samples")
    axes.legend(loc="upper right", ncols=3, handlelength=1.6)


def draw_spectrum(axes: Axes, data: xr.Dataset, *others: xr.Dataset) -> None:
    """Draw the two-sided spectrum of the velocity; forward whirl turns as the balls do."""
    frequency, share = whirl_spectrum(data["time"].values, data["velocity"].values)
    axes.plot(1e-3 * frequency, share, color=BLUE, lw=0.8)
    axes.axvline(0.0, color=GREY, lw=0.5)
    axes.set(xlabel="frequency [kHz]; backward < 0 < forward", ylabel="share of the largest [-]")
    most = 1e-3 * max(map(spectrum_reach, (data, *others)))
    axes.set(xlim=(-most, most), ylim=(0, 1.1))


def spectrum_reach(data: xr.Dataset) -> float:
    """Return the frequency up to which a picture of the spectrum must go [Hz]."""
    frequency, share = whirl_spectrum(data["time"].values, data["velocity"].values)
    strong = np.abs(frequency[share > 0.05])
    return float(1.3 * strong.max()) if np.any(strong) else float(np.abs(frequency).max()) or 1.0


def _strongest(data: xr.Dataset) -> str:
    """Return the frequency of the strongest whirl as words; nothing for a cage at rest."""
    frequency, share = whirl_spectrum(data["time"].values, data["velocity"].values)
    if not share.any():
        return ""
    peak = f"{1e-3 * frequency[share.argmax()]:.2g}".replace("-", "\N{MINUS SIGN}")
    return f", largest at {peak} kHz"


def whirl_spectrum(time: Array, velocity: Array) -> tuple[Array, Array]:
    """Amplitude of the complex velocity over frequency, the largest being 1.

    Parameters
    ----------
    time : ndarray
        Shape (time,) [s]; need not be even.
    velocity : ndarray
        Shape (time, 2) [m/s].

    Returns
    -------
    tuple of ndarray
        Frequency, rising from negative (backward) to positive (forward) [Hz], and amplitude [-].
    """
    count = max(8, time.size)
    even = np.linspace(0.0, time[-1] or 1.0, count)
    v = np.interp(even, time, velocity[:, 0]) + 1j * np.interp(even, time, velocity[:, 1])
    amplitude = np.abs(np.fft.fft(v))
    frequency = np.fft.fftfreq(count, even[1] - even[0])
    order = np.argsort(frequency)
    return frequency[order], amplitude[order] / (amplitude.max() or 1.0)
