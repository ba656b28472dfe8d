"""Pages of a run of the cage, in the plane or in space: course, whirl, forces, energy; two runs together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from separatrix.figures import motion
from separatrix.figures.motion import is_in_space, milliseconds, time_axis
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
from separatrix.present.text.sentences import pocket_force
from separatrix.units import Array

MICRO = "\N{MICRO SIGN}"
UNITS = ((1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, f"{MICRO}J"))

WIDE = 30.0
"""Ratio of the largest to the smallest energy beyond which its axis is logarithmic."""

COLUMNS = 600
"""Most columns of the picture of the forces; each shows the largest force of its samples."""

TURNS, FEWEST, BEFORE = 6.0, 40, 0.15
"""Turns of the whirl and least samples of the close view; its least share before the largest force."""

FAINT, NAME_WIDTH = 1e-3, 60
"""In a comparison: least force on a logarithmic axis, over the largest; letters on a line above a column."""

SEEN, DEEPEST = 0.02, 1e-4
"""Share of the largest amplitude up to whose last frequency a spectrum is drawn; least amplitude over it."""

POLES = ("front", "+ axial", "rear", "\N{MINUS SIGN} axial")
"""Poles of a pocket at 0, 90, 180 and 270 deg."""

COURSES = (
    ("position", "offset [mm]", "Offset of the centre from the bearing axis"),
    ("axial_place", "axial place [mm]", "Axial place of the cage"),
    ("lean", "tilt [mrad]", "Angle between the axes of cage and bearing"),
    ("rotation", "rotation [mrad]", "Rotation of the cage against the ball set"),
)
"""Variables against time, each with label and title."""

SPECTRA = (
    ("offset", 1e6, f"{MICRO}m", "Offset, fixed frame"),
    ("slip_rate", 1.0, "rad/s", "Speed of rotation against the balls"),
    ("lean", 1e3, "mrad", "Lean of the axis, fixed frame"),
    ("axial", 1e6, f"{MICRO}m", "Axial place"),
)
"""Spectra, each with the scale of its unit and a title."""

CAGE_MARK: Look = {"color": GREY, "lw": 0.7, "ls": (0, (4, 1.5)), "zorder": 1.5}


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `simulate`."""
    yield "simulation", course(data)
    yield "simulation-whirl", whirl(data)
    yield "simulation-forces", forces(data)
    yield "simulation-energy", energy(data)


def course(data: xr.Dataset) -> Figure:
    """Orbit of the centre, and its spectrum or, in space, lean; offsets and rotation against time."""
    drawn = [one for one in COURSES if data[one[0]].ndim > 0]
    heights = [2.4, 1.25 * len(drawn)]
    figure = Figure(figsize=(PAGE, sum(heights)), layout="constrained")
    above, below = figure.subfigures(nrows=2, height_ratios=heights, squeeze=False)[:, 0]
    orbit, beside = above.subplots(ncols=2)
    motion.draw_orbit(orbit, data)
    orbit.set_title("a  Cage centre, turning frame")
    if is_in_space(data):
        motion.draw_lean(beside, data)
        beside.set_title("b  Lean of the cage's axis")
    else:
        motion.draw_spectrum(beside, data)
        beside.set_title("b  Whirl, turning frame")
    rows = below.subplots(nrows=len(drawn), sharex=True)
    for axes, letter, (name, label, title) in zip(rows, "cdef", drawn, strict=False):
        values = 1e3 * data[name].values
        values = np.hypot(*values.T) if values.ndim > 1 else values
        axes.plot(milliseconds(data), values, color=BLUE, lw=0.7, zorder=3)
        axes.set(ylabel=label)
        axes.set_title(f"{letter}  {title}{'; shaded: the judged part' if letter == 'c' else ''}")
        motion.shade_judged(axes, data)
        time_axis(axes, data)
        if axes is not rows[-1]:
            axes.set_xlabel("")
    _limit(rows[0], motion.clearances(data))
    if is_in_space(data):
        _limit(rows[1], [(1e3 * motion.axial_play(data), motion.POCKETS, "pockets")], both=True)
        _limit(rows[2], motion.lean_limits(data))
    figure.align_ylabels(rows)
    return figure


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


def whirl(data: xr.Dataset) -> Figure:
    """Amplitude spectra in the fixed frame, whirl ratios and slip, and the whirl's spectrum against time."""
    drawn = [one for one in SPECTRA if data[f"analysis_spectra_{one[0]}"].ndim > 0]
    count = len(drawn) // 2
    figure = Figure(figsize=(PAGE, 2.1 * (count + 2)), layout="constrained")
    grid = figure.add_gridspec(count + 2, 2)
    turn = abs(float(data["analysis_whirl_cage_speed"])) / (2.0 * np.pi)
    for place, (name, scale, unit, title) in enumerate(drawn):
        axes, found = figure.add_subplot(grid[place // 2, place % 2]), data[f"analysis_spectra_{name}"]
        _spectrum(axes, data[found.dims[0]].values, scale * found.values, turn)
        axes.set_ylabel(f"amplitude [{unit}]")
        axes.set_title(f"{'abcd'[place]}  {title}")
    ratios, slip = (figure.add_subplot(grid[count, column]) for column in range(2))
    for axes in (ratios, slip):
        axes.axhline(0.0, color=GREY, lw=0.4)
        axes.set(xlabel="time [ms]", xlim=(0.0, float(milliseconds(data)[-1]) or 1.0))
        motion.shade_judged(axes, data)
    letters = "abcdefg"[len(drawn) :]
    _ratios(ratios, data)
    ratios.set_title(f"{letters[0]}  Whirl over the cage's speed, in windows")
    time = 1e3 * data["analysis_whirl_window_time"].values
    slip.plot(time, 100.0 * data["analysis_whirl_window_cage_slip"].values, "o-", color=BLUE, ms=2.5, lw=0.8)
    slip.set_ylabel("slip [%]")
    slip.set_title(f"{letters[1]}  Slip of the cage against the balls")
    against_time = figure.add_subplot(grid[count + 1, :])
    motion.draw_against_time(against_time, data)
    against_time.set_title(f"{letters[2]}  Spectrum of the velocity against time, turning frame")
    return figure


def _spectrum(axes: Axes, frequency: Array, amplitude: Array, turn: float) -> None:
    """Draw an amplitude spectrum; dashed: the frequency at which the cage turns."""
    largest = float(amplitude.max(initial=0.0))
    two_sided = bool((frequency < 0.0).any())
    seen = np.abs(frequency[amplitude > SEEN * largest]) if largest > 0.0 else np.abs(frequency)
    reach = max(float(seen.max(initial=0.0)) * 1.3, 3.0 * turn) or 1.0
    scale, unit = (1e-3, "kHz") if reach >= 2000.0 else (1.0, "Hz")
    axes.plot(scale * frequency, amplitude, color=BLUE, lw=0.8)
    axes.axvline(scale * turn, **CAGE_MARK)
    words = f"frequency [{unit}]" + ("; backward < 0 < forward" if two_sided else "")
    axes.set(xlim=(-scale * reach if two_sided else 0.0, scale * reach), xlabel=words)
    if largest > 0.0:
        axes.set(yscale="log", ylim=(DEEPEST * largest, 3.0 * largest))
    else:
        axes.set(ylim=(0.0, 1.0))
    axes.text(scale * turn, 0.98, " cage turn", transform=axes.get_xaxis_transform(), fontsize=6.5, va="top")


def _ratios(axes: Axes, data: xr.Dataset) -> None:
    """Draw the whirl ratios of the offset, and in space of the tilt, in windows; 1 turns with the cage."""
    time = 1e3 * data["analysis_whirl_window_time"].values
    axes.axhline(1.0, **CAGE_MARK)
    looks = (("offset", "o-", BLUE), ("tilt", "s--", VERMILION))[: 1 + is_in_space(data)]
    for name, marks, colour in looks:
        values = data[f"analysis_whirl_window_{name}_ratio"].values.astype(float)
        axes.plot(time, values, marks, color=colour, ms=2.5, lw=0.8, label=name)
    axes.set_ylabel("ratio [-]")
    axes.legend(loc="best", ncols=2, handlelength=1.6)


def forces(data: xr.Dataset) -> Figure:
    """Forces of pockets and land in the run and around the largest; where touches are, and how strong."""
    figure = Figure(figsize=(PAGE, 6.0), layout="constrained")
    above, below = figure.subfigures(nrows=2, height_ratios=[3.4, 2.6], squeeze=False)[:, 0]
    panels = above.subplots(nrows=2, ncols=2, height_ratios=[1.5, 1.0], width_ratios=[2.2, 1.0])
    near, largest = close_view(data), max(float(largest_force(data).max()), 1e-9)
    mesh = raster(panels[0, 0], data, largest)
    raster(panels[0, 1], near, largest)
    colour_bar(mesh, [*panels[0]], "force [N], root scale", pad=0.01, aspect=14)
    top = 1.05 * max(largest, float(data["land_force"].max()))
    for axes, part in zip(panels[1], (data, near), strict=True):
        axes.plot(milliseconds(part), largest_force(part), color=BLUE, lw=0.7, label="largest pocket force")
        if np.any(data["land_force"].values):
            land: Look = {"color": VERMILION, "lw": 0.9, "ls": (0, (4, 1)), "zorder": 1.9, "label": "land"}
            axes.plot(milliseconds(part), part["land_force"].values, **land)
        axes.set_ylim(0.0, top)
    for whole, close in panels:
        time_axis(whole, data)
        close.set(xlabel="time [ms]", xlim=view_ends(near))
    limit = float(data.get("force_limit", np.nan))
    peak = pocket_force(float(data["largest_contact_force"]), limit if limit > 0.0 else None, short=True)
    panels[0, 0].set(title=f"a  Force in each pocket, largest {peak}", ylabel="pocket", xlabel="")
    panels[0, 1].set(title="b  Around the largest", xlabel="")
    panels[1, 0].set(title="c  Largest forces", ylabel="force [N]")
    panels[1, 1].set_title("d  The same")
    legend_above(panels[1, 0], columns=2)
    grid = below.add_gridspec(
        1, 3 if is_in_space(data) else 2, width_ratios=[1.6, 1.0, 1.0][: 2 + is_in_space(data)]
    )
    _contacts(below.add_subplot(grid[0]), data)
    _sizes(below.add_subplot(grid[1]), data)
    if is_in_space(data):
        _clock(below.add_subplot(grid[2], projection="polar"), data)
    return figure


def close_view(data: xr.Dataset) -> xr.Dataset:
    """Return the samples of some turns of the fastest strong whirl, around the largest pocket force."""
    time, fastest = data["time"].values, motion.fastest_whirl(data)
    middle = int(largest_force(data).argmax())
    span = TURNS / fastest if fastest > 0.0 else np.inf
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
    return np.asarray(data["contact_force"].values.max(axis=1), dtype=float)


def pooled(time: Array, force: Array, edges: Array) -> Array:
    """Return the largest force between neighbouring edges of time, of each pocket; shape (edges - 1, ball).

    A space without a sample has the force of the sample before it.
    """
    starts = np.searchsorted(time, edges[:-1], side="left").clip(0, time.size - 1)
    ends = np.searchsorted(time, edges[1:], side="left").clip(1, time.size)
    spaces = zip(starts, ends, strict=True)
    return np.array([force[a:b].max(axis=0) if b > a else force[max(0, b - 1)] for a, b in spaces])


def raster(axes: Axes, data: xr.Dataset, largest: float) -> ScalarMappable:
    """Draw the force in each pocket against time: white for none."""
    time = milliseconds(data)
    last = float(time[-1]) if time[-1] > time[0] else float(time[0]) + 1.0
    edges = np.linspace(float(time[0]), last, min(COLUMNS, max(2, time.size)) + 1)
    force = pooled(time, data["contact_force"].values, edges)
    look: Look = {"cmap": "Greys", "norm": PowerNorm(0.5, 0.0, largest), "rasterized": True}
    mesh = axes.pcolormesh(edges, np.arange(force.shape[1] + 1) + 0.5, force.T, **look)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    return mesh


def contact_counts(force: Array, angle: Array) -> Array:
    """Return how often each pocket begins to push its ball forward, backward, and axially; shape (3, ball).

    From samples of the force and of where on the ball it acts, shape (time, ball): what falls between two
    samples is not seen.
    """
    pole = np.sqrt(0.5)
    sides = np.stack([np.cos(angle) <= -pole, np.cos(angle) >= pole, np.abs(np.cos(angle)) < pole]) & (
        force > 0.0
    )
    before = np.concatenate([np.zeros_like(sides[:, :1]), sides[:, :-1]], axis=1)
    return np.asarray((sides & ~before).sum(axis=1), dtype=float)


def _contacts(axes: Axes, data: xr.Dataset) -> None:
    counts = contact_counts(data["contact_force"].values, data["contact_angle"].values)
    share, places = 100.0 * counts / (counts.sum() or 1.0), np.arange(1, counts.shape[1] + 1)
    looks: tuple[Look, ...] = (
        {"color": BLUE, "label": "forward"},
        {"color": SKY, "hatch": "///", "edgecolor": "white", "lw": 0, "label": "backward"},
        {"color": ORANGE, "label": "axially"},
    )
    low = np.zeros(places.size)
    for part, look in zip(share, looks[: 2 + is_in_space(data)], strict=False):
        axes.bar(places, part, 0.7, bottom=low, **look)
        low = low + part
    axes.axhline(100 / places.size, color=GREY, lw=0.8, ls=(0, (4, 1.5)), label="even share")
    axes.set(xlabel="pocket", ylabel="share of touches [%]", xlim=(0.3, places.size + 0.7))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_ylim(0, 1.4 * max(low.max(), 100 / places.size))
    axes.set_title("e  How pockets push their balls")
    axes.legend(loc="upper left", ncols=2, handlelength=1.2, columnspacing=1.0)


def _sizes(axes: Axes, data: xr.Dataset) -> None:
    edges, count = data["analysis_impacts_force_edges"].values, data["analysis_impacts_force_count"].values
    axes.stairs(count, edges, color=BLUE, fill=True, alpha=0.6)
    axes.set(xscale="log", xlabel="peak force [N]", ylabel="touches", xlim=(edges[0], edges[-1]))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_title(f"f  {count.sum():.0f} touches")


def _clock(axes: Axes, data: xr.Dataset) -> None:
    """Draw the share of the impulse by the angle on the pocket."""
    edges, impulse = (data[f"analysis_impacts_clock_{name}"].values for name in ("edges", "impulse"))
    share, middles = 100.0 * impulse / (impulse.sum() or 1.0), 0.5 * (edges[:-1] + edges[1:])
    axes.bar(middles, share, width=0.92 * np.diff(edges), color=SKY, edgecolor=BLUE, lw=0.5)
    axes.set_title("g  Share of impulse [%]", pad=12.0)
    axes.set_xticks(0.5 * np.pi * np.arange(4), POLES)
    axes.set(rlabel_position=45.0)
    axes.tick_params(axis="y", labelsize=6.0)
    axes.tick_params(axis="x", labelsize=6.5, pad=1.0)
    axes.grid(lw=0.4, color="#cccccc")
    axes.spines["polar"].set_linewidth(0.5)
    axes.yaxis.set_major_locator(MaxNLocator(3, min_n_ticks=2))
    axes.set_ylim(0.0)


def energy(data: xr.Dataset) -> Figure:
    """Energy, the work of each source, and where the rubbing is."""
    figure = Figure(figsize=(PAGE, 4.4), layout="constrained")
    panels = figure.subplot_mosaic([["energy", "work"], ["rubbing", "rubbing"]], height_ratios=[1.4, 1.0])
    draw_energy(panels["energy"], data)
    panels["energy"].set_title("a  Energy; shaded: the judged part")
    draw_work(panels["work"], data)
    panels["work"].set_title(f"b  Work; energy balance closes to {float(data['energy_imbalance']):.0e}")
    for name in ("energy", "work"):
        motion.shade_judged(panels[name], data)
    axes = panels["rubbing"]
    power = data["analysis_rubbing_pocket_power"].values
    names = {i: str(i) for i in range(1, power.size + 1, max(1, power.size // 20))}
    axes.bar(np.arange(1, power.size + 1), power, 0.7, color=BLUE)
    if motion.land_boundary(data) is not None:
        names[power.size + 2] = "land"
        axes.bar([power.size + 2], [float(data["analysis_rubbing_land_power"])], 0.7, color=ORANGE)
    axes.set_xticks([*names], [*names.values()])
    axes.set(ylabel="friction power [W]", xlabel="pocket", xlim=(0.3, max([power.size, *names]) + 0.7))
    axes.set_title("c  Rubbing: in pockets, mean of the run; on the land, mean of its judged part")
    return figure


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
