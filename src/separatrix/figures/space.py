"""One run of a cage in space on pages: motion, whirl and spectra, forces and where they fall, energies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from separatrix.cage.space.contacts import touches
from separatrix.figures import motion, simulation
from separatrix.figures.motion import is_logarithmic, milliseconds, time_axis
from separatrix.figures.scene import axial_play
from separatrix.figures.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    PAGE,
    SKY,
    VERMILION,
    Look,
    canvas,
    colour_bar,
    label_lines,
    legend_above,
)
from separatrix.units import Array, format_number

MICRO = "\N{MICRO SIGN}"
POLES = ("front", "+ axial", "rear", "\N{MINUS SIGN} axial")
"""Poles of a pocket at 0, 90, 180 and 270 deg."""

DEEPEST = 1e-4
"""Least amplitude of a picture of a spectrum, over the largest."""

SEEN, MOST_DOTS = 0.02, 4000
"""Share of the largest amplitude up to whose last frequency a spectrum is drawn; touches drawn as dots."""

CAGE_MARK: Look = {"color": GREY, "lw": 0.7, "ls": (0, (4, 1.5)), "zorder": 1.5}


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `simulate` of a cage in space."""
    yield "simulation", course(data)
    yield "simulation-whirl", whirl(data)
    yield "simulation-forces", forces(data)
    yield "simulation-energy", energy(data)


def is_in_space(data: xr.Dataset) -> bool:
    """Whether a saved run is one of a cage in space."""
    return "lean" in data and "contact_angle" in data


def in_plane(data: xr.Dataset) -> xr.Dataset:
    """Return a run in space with the names of a planar one, for what draws or compares such; others as is."""
    if not is_in_space(data):
        return data
    return data.assign(
        position=data["centre"],
        velocity=data["centre_velocity"],
        spring_energy=data["stored_energy"],
        land_energy=0.0 * data["stored_energy"],
        land_force=data["land_force"].sum("strip"),
    ).drop_vars("contact_angle")


def course(data: xr.Dataset) -> Figure:
    """Orbit of the centre, lean of the axis, and offset, axial place, tilt and rotation against time."""
    figure = Figure(figsize=(PAGE, 7.6), layout="constrained")
    above, below = figure.subfigures(nrows=2, height_ratios=[1.0, 1.9], squeeze=False)[:, 0]
    orbit, lean = above.subplots(ncols=2)
    motion.draw_orbit(orbit, in_plane(data))
    orbit.set_title("a  Cage centre, turning frame")
    _lean(lean, data)
    rows = below.subplots(nrows=4, sharex=True)
    time, offset = milliseconds(data), 1e3 * np.hypot(*data["centre"].values.T)
    tilt = 1e3 * np.hypot(*data["lean"].values.T)
    axial, slip = 1e3 * data["position"].values[:, 2], 1e3 * data["rotation"].values
    drawn = (
        (offset, "offset [mm]", "c  Offset of the centre from the bearing axis; shaded: the judged part"),
        (axial, "axial place [mm]", "d  Axial place of the cage"),
        (tilt, "tilt [mrad]", "e  Angle between the axes of cage and bearing"),
        (slip, "rotation [mrad]", "f  Rotation of the cage against the ball set"),
    )
    for axes, (values, label, title) in zip(rows, drawn, strict=True):
        axes.plot(time, values, color=BLUE, lw=0.7, zorder=3)
        axes.set(ylabel=label)
        axes.set_title(title)
        motion.shade_judged(axes, data)
        time_axis(axes, data)
        if axes is not rows[-1]:
            axes.set_xlabel("")
    _limits(rows, data)
    figure.align_ylabels(rows)
    return figure


def _limits(rows: Sequence[Axes], data: xr.Dataset) -> None:
    """Draw the clearances below offset, axial place and tilt, where they are near enough, and name them."""
    gaps = motion.clearances(in_plane(data))
    leans = [(1e3 * size, look, name) for size, look, name in lean_limits(data)]
    play = axial_play(data)
    places = [] if play is None else [(1e3 * play, motion.POCKETS, "pockets")]
    for axes, limits in ((rows[0], gaps), (rows[1], places), (rows[2], leans)):
        top = max(abs(value) for value in axes.get_ylim())
        near = [one for one in limits if one[0] <= 2.5 * top]
        for size, look, _ in near:
            axes.axhline(size, **look)
            if axes is rows[1]:
                axes.axhline(-size, **look)
        most = 1.12 * max([top, *(one[0] for one in near)])
        axes.set_ylim(-most if axes is rows[1] else 0.0, most)
        ends = [(float(axes.get_xlim()[1]), size, name, look["color"]) for size, look, name in near]
        label_lines(axes, ends, gap=0.16)


def lean_limits(data: xr.Dataset) -> list[tuple[float, Look, str]]:
    """Tilts at which a centred cage touches its balls, and its lands, each with look and name [rad]."""
    found, play, radius = [], axial_play(data), float(data["cage_pitch_radius"])
    if play is not None:
        found.append((play / radius, motion.POCKETS, "pockets"))
    land, heights = motion.land_boundary(data), np.abs(np.atleast_1d(data["cage_space_land_heights"].values))
    reach = float(heights.max(initial=0.0)) + 0.5 * float(data["cage_space_land_width"])
    if land is not None and reach > 0.0:
        found.append((float(land.max()) / reach, motion.LAND, "land"))
    return found


def _lean(axes: Axes, data: xr.Dataset) -> None:
    """Draw where the axis of the cage leans, in mrad, with the tilts at which a centred cage touches."""
    samples = (data[name].values.astype(float) for name in ("time", "lean", "lean_rate"))
    path = 1e3 * motion.smooth_path(*samples)
    far = float(np.abs(path).max(initial=0.0)) or 1.0
    limits = [(1e3 * size, look, name) for size, look, name in lean_limits(data) if 1e3 * size <= 2.0 * far]
    most = 1.12 * max([far, *(size for size, _, _ in limits)])
    circles = [(motion.ring(size, motion.AROUND), look, f"{name}, if centred") for size, look, name in limits]
    motion.draw_path(axes, path, most, circles, "turns")
    axes.set(xlabel="lean along x [mrad]", ylabel="along y [mrad]", title="b  Lean of the cage's axis")


def whirl(data: xr.Dataset) -> Figure:
    """Amplitude spectra in the fixed frame, and whirl ratios and slip against time."""
    figure, panels = canvas(PAGE, 6.4, nrows=3, ncols=2)
    turn = float(data["analysis_whirl_cage_speed"]) / (2.0 * np.pi)
    both = data["analysis_spectra_frequency"] if "analysis_spectra_frequency" in data else data["frequency"]
    tone = data["analysis_spectra_tone"] if "analysis_spectra_tone" in data else data["tone"]
    drawn = (
        (panels[0, 0], both, 1e6, "offset", f"amplitude [{MICRO}m]", "a  Offset, fixed frame"),
        (panels[0, 1], both, 1e3, "lean", "amplitude [mrad]", "b  Lean of the axis, fixed frame"),
        (panels[1, 0], tone, 1e6, "axial", f"amplitude [{MICRO}m]", "c  Axial place"),
        (panels[1, 1], tone, 1.0, "slip_rate", "amplitude [rad/s]", "d  Speed of rotation against the balls"),
    )
    for axes, frequency, scale, name, label, title in drawn:
        values = scale * data[f"analysis_spectra_{name}"].values
        _spectrum(axes, np.asarray(frequency.values, dtype=float), values, turn)
        axes.set(ylabel=label)
        axes.set_title(title)
    for axes, titled in ((panels[2, 0], "e  Whirl ratio, in windows"), (panels[2, 1], "f  Cage slip")):
        axes.axhline(0.0, color=GREY, lw=0.4)
        axes.set(xlabel="time [ms]")
        axes.set_title(titled)
        axes.set_xlim(0.0, float(milliseconds(data)[-1]) or 1.0)
        motion.shade_judged(axes, data)
    _ratios(panels[2, 0], data)
    time = 1e3 * data["analysis_whirl_window_time"].values
    slip = 100.0 * data["analysis_whirl_window_cage_slip"].values
    panels[2, 1].plot(time, slip, "o-", color=BLUE, ms=2.5, lw=0.8)
    panels[2, 1].set_ylabel("slip against the balls [%]")
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
    """Draw the whirl ratios of offset and tilt in windows; 1 turns with the cage."""
    time = 1e3 * data["analysis_whirl_window_time"].values
    axes.axhline(1.0, **CAGE_MARK)
    looks = (("offset", "o-", BLUE), ("tilt", "s--", VERMILION))
    for name, marks, colour in looks:
        values = data[f"analysis_whirl_window_{name}_ratio"].values.astype(float)
        axes.plot(time, values, marks, color=colour, ms=2.5, lw=0.8, label=name)
    axes.set_ylabel("over the cage's speed [-]")
    axes.legend(loc="best", ncols=2, handlelength=1.6)


def forces(data: xr.Dataset) -> Figure:
    """Forces of pockets and lands against time, where on the pocket they fall, and how large they are."""
    figure = Figure(figsize=(PAGE, 7.2), layout="constrained")
    grid = figure.add_gridspec(4, 3, height_ratios=[1.5, 1.0, 1.0, 2.7])
    raster, largest, land = (figure.add_subplot(grid[row, :]) for row in range(3))
    most = max(float(data["contact_force"].max()), 1e-9)
    mesh = simulation.raster(raster, data, most, logarithmic=is_logarithmic(data))
    raster.set(title="a  Force in each pocket", ylabel="pocket")
    colour_bar(mesh, [raster], "force [N], root scale", pad=0.01, aspect=14)
    largest.plot(milliseconds(data), data["contact_force"].values.max(axis=1), color=BLUE, lw=0.7)
    peak = float(data["largest_contact_force"])
    largest.set(ylabel="force [N]", ylim=(0.0, 1.08 * peak or 1.0))
    largest.set_title(f"b  Largest pocket force; {format_number(peak, 3)} N at most")
    _lands(land, data)
    for axes in (raster, largest, land):
        time_axis(axes, data)
        if axes is not land:
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)
    figure.align_ylabels([raster, largest, land])
    clock, dots = (figure.add_subplot(grid[3, column], projection="polar") for column in range(2))
    _clocks(clock, dots, data)
    _sizes(figure.add_subplot(grid[3, 2]), data)
    return figure


def land_forces(data: xr.Dataset) -> list[tuple[str, Array]]:
    """Return the force of each land [N], with its name."""
    force = data["land_force"].values
    count = 0 if force.shape[1] == 0 else np.atleast_1d(data["cage_space_land_heights"].values).size
    each = np.split(force, count, axis=1) if count else []
    names = ["land"] if count == 1 else ["land at \N{MINUS SIGN}", "land at +"]
    return [(name, one.sum(axis=1)) for name, one in zip(names, each, strict=False)]


def _lands(axes: Axes, data: xr.Dataset) -> None:
    found = land_forces(data)
    axes.set(ylabel="force [N]")
    if not found:
        axes.set_ylim(0.0, 1.0)
        axes.set_title("c  Ball-guided: the cage has no land")
        return
    looks: tuple[Look, ...] = ({"color": VERMILION}, {"color": BLACK, "ls": "--"})
    for (name, force), look in zip(found, looks, strict=False):
        axes.plot(milliseconds(data), force, lw=0.7, label=name, **look)
    most = max(float(force.max(initial=0.0)) for _, force in found)
    axes.set_ylim(0.0, 1.08 * most or 1.0)
    title = f"c  Force of each land; {format_number(most, 3)} N at most"
    axes.set_title(title if most else "c  The land was not touched")
    if len(found) > 1:
        legend_above(axes, columns=2)


def _clocks(clock: Axes, dots: Axes, data: xr.Dataset) -> None:
    """Draw the share of the impulse by the angle on the pocket, and the peak of each touch."""
    edges, impulse = (data[f"analysis_impacts_clock_{name}"].values for name in ("edges", "impulse"))
    share = 100.0 * impulse / (impulse.sum() or 1.0)
    middles = 0.5 * (edges[:-1] + edges[1:])
    clock.bar(middles, share, width=0.92 * np.diff(edges), color=SKY, edgecolor=BLUE, lw=0.5)
    clock.set_title("d  Share of impulse [%]", pad=12.0)
    seen = touches(data["time"].values, data["contact_force"].values, data["contact_angle"].values)
    few = np.argsort(seen.peak_force)[-MOST_DOTS:]
    dots.plot(seen.angle[few], np.sqrt(seen.peak_force[few]), ".", color=BLUE, ms=4.0, alpha=0.5, mew=0)
    dots.set_title("e  Peaks [N], root scale", pad=12.0)
    most = float(seen.peak_force.max(initial=0.0)) or 1.0
    dots.set_ylim(0.0, 1.05 * np.sqrt(most))
    rings = [float(f"{share * most:.1g}") for share in (0.1, 0.4, 0.9)]
    for axes in (clock, dots):
        axes.set_xticks(0.5 * np.pi * np.arange(4), POLES)
        axes.set(rlabel_position=45.0)
        axes.tick_params(axis="y", labelsize=6.0)
        axes.tick_params(axis="x", labelsize=6.5, pad=1.0)
        axes.grid(lw=0.4, color="#cccccc")
        axes.spines["polar"].set_linewidth(0.5)
    clock.yaxis.set_major_locator(MaxNLocator(3, min_n_ticks=2))
    clock.set_ylim(0.0)
    dots.set_yticks(np.sqrt(rings), [f"{one:g}" for one in rings])


def _sizes(axes: Axes, data: xr.Dataset) -> None:
    edges, count = data["analysis_impacts_force_edges"].values, data["analysis_impacts_force_count"].values
    axes.stairs(count, edges, color=BLUE, fill=True, alpha=0.6)
    axes.set(xscale="log", xlabel="peak force [N]", ylabel="touches", xlim=(edges[0], edges[-1]))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_title(f"f  {count.sum():.0f} touches in samples")
    axes.set_box_aspect(1.0)


def energy(data: xr.Dataset) -> Figure:
    """Energy, the work of each source, and where the rubbing is."""
    flat = in_plane(data)
    figure = Figure(figsize=(PAGE, 5.0), layout="constrained")
    panels = figure.subplot_mosaic([["energy", "work"], ["pockets", "lands"]], width_ratios=[1.0, 1.0])
    simulation.draw_energy(panels["energy"], flat)
    panels["energy"].set_title("a  Energy; shaded: the judged part")
    simulation.draw_work(panels["work"], flat)
    panels["work"].set_title(f"b  Work; energy balance closes to {float(data['energy_imbalance']):.0e}")
    for name in ("energy", "work"):
        motion.shade_judged(panels[name], data)
    for name, what, title in (
        ("pockets", "pocket", "c  Rubbing in each pocket, mean of the run"),
        ("lands", "land", "d  Rubbing on each land, mean of the run"),
    ):
        _rubbing(panels[name], data[f"analysis_rubbing_{what}_power"].values, what, title)
    return figure


def _rubbing(axes: Axes, power: Array, what: str, title: str) -> None:
    places = np.arange(1, power.size + 1)
    axes.bar(places, power, 0.7 if power.size > 2 else 0.3, color=BLUE if what == "pocket" else ORANGE)
    axes.set(ylabel="friction power [W]", xlabel=what, xlim=(0.3, max(power.size, 1) + 0.7))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.set_title(title if power.size else "d  Ball-guided: the cage has no land")
