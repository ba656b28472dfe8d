"""What figures, animations and the view of a run share: time, boundaries, paths, whirl spectrum, frames."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from separatrix.figures.style import BLACK, BLUE, GREY, SKY, VERMILION, Look
from separatrix.ground.units import Array, Hertz

AROUND = np.linspace(0.0, 2 * np.pi, 1441)
"""Directions in which boundaries are drawn: a quarter of a degree apart."""

FINE, LAST = 6, 5
"""Points drawn for a sample of the path, and turns at its end that are drawn darker."""

BEYOND = 2.0
"""Half the play over the land's gap from which the pockets are left out of the picture."""

NEVER = 1e3
"""A boundary farther away than this multiple of the play, along the radius of one ball, does not exist."""

LAND: Look = {"color": VERMILION, "lw": 3.5, "alpha": 0.45, "zorder": 1.5}
POCKETS: Look = {"color": BLACK, "lw": 0.8, "ls": (0, (4, 1.5)), "zorder": 1.5}
"""Boundaries are below the path, the land wide and light: neither hides the other or a path along it."""

SHORTEST = 8
"""Least samples of a spectrum."""

STRONG, PRESENT = 0.3, 0.05
"""Shares of the largest amplitude from which a whirl is strong, and is shown."""

MOST_FRAMES, A_TURN = 240, 6
"""Most frames of a GIF; least frames in a turn of the fastest strong whirl: fewer may reverse its sense."""

GAP = 1.5
"""Steps over the usual one from which frames have a gap."""


def milliseconds(data: xr.Dataset) -> Array:
    """Return the times of the samples [ms]."""
    return 1e3 * np.asarray(data["time"].values, dtype=float)


def is_in_space(data: xr.Dataset) -> bool:
    """Whether a saved run is one of a cage that tilts and moves along the axis."""
    return "lean" in data and data["lean"].ndim == 2


def time_axis(axes: Axes, *runs: xr.Dataset) -> None:
    """Set the axis of time for one or several runs; a millisecond if they have only their start."""
    last = max(float(milliseconds(run)[-1]) for run in runs)
    axes.set(xlim=(0.0, last or 1.0), xlabel="time [ms]")


def ring(radius: Array | float, angle: Array) -> Array:
    """Return points at angles on a circle, or at a radius for each, shape (angle, 2)."""
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def pocket_boundary(angles: Array, plays: Array) -> Array:
    """Return how far the centre may go in each direction until a pocket touches its ball [m].

    Without rotation and lead that is where |r . e_t,j| = c_j: the polygon inside 2 Z lines. A single ball
    leaves the way along its own radius free: there it is infinite.
    """
    across = np.abs(np.sin(AROUND[:, np.newaxis] - angles))
    reach = plays / np.maximum(across, 1.0 / NEVER)
    return np.where((across < 1.0 / NEVER).all(axis=1), np.inf, reach.min(axis=1))


def land_boundary(data: xr.Dataset) -> Array | None:
    """Return how far the centre may go in each direction until the land touches [m]; None without one."""
    clearance, guidance = float(data["cage_land_clearance"]), str(data["cage_guidance"].values)
    if guidance == "ball" or not np.isfinite(clearance):
        return None
    wave, lobes = float(data["cage_land_out_of_round"]), int(data["cage_land_lobes"])
    sign = (-1) ** lobes if guidance == "inner" else 1
    return 0.5 * clearance - wave * sign * np.cos(lobes * AROUND)


def smooth_path(time: Array, position: Array, velocity: Array) -> Array:
    """Return the path through samples as the cubics that have their positions and velocities.

    Straight lines between the samples of a fast whirl would be drawn as a polygon.
    """
    s = np.linspace(0.0, 1.0, FINE, endpoint=False)[:, np.newaxis]
    step = np.diff(time)[:, np.newaxis, np.newaxis]
    start, end = position[:-1, np.newaxis], position[1:, np.newaxis]
    slope, next_slope = step * velocity[:-1, np.newaxis], step * velocity[1:, np.newaxis]
    there = start + (end - start) * s**2 * (3 - 2 * s)
    path = there + slope * s * (1 - s) ** 2 - next_slope * s**2 * (1 - s)
    return np.concatenate([path.reshape(-1, 2), position[-1:]])


def last_turns(path: Array) -> int:
    """Return the first point of the `LAST` turns, by their length; 0 if the path is not much longer."""
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    around = 2 * np.pi * float(np.hypot(*path[-1]))
    first = int(np.searchsorted(length, length[-1] - LAST * around))
    return first if length[-1] > 2 * LAST * around and around > 0.0 else 0


def largest_play(data: xr.Dataset) -> float | None:
    """Return half the largest play of the pockets [m]; None if the centre stays far within."""
    play, land = float(data["half_play"].max()), land_boundary(data)
    far = float(np.hypot(*data["position"].values.T).max())
    return play if land is None or play <= BEYOND * max(far, float(land.max())) else None


def orbit_reach(data: xr.Dataset) -> float:
    """Return the least half width of a picture of the orbit [m]."""
    far, land, play = (float(np.abs(data["position"].values).max()), land_boundary(data), largest_play(data))
    return 1.12 * max(far, play or 0.0, 0.0 if land is None else float(land.max()), 1e-9)


def axial_play(data: xr.Dataset) -> float:
    """Return half the clearance of the pockets along the axis [m]; 0 for none."""
    return float(np.nan_to_num(data["cage_axial_half_play"]))


def land_heights(data: xr.Dataset) -> Array:
    """Return the height of the middle of each land over the pockets [m]."""
    if land_boundary(data) is None:
        return np.zeros(0)
    spacing = float(data["cage_land_spacing"])
    return np.zeros(1) if int(data["cage_land_count"]) == 1 else 0.5 * spacing * np.array([-1.0, 1.0])


def lean_limits(data: xr.Dataset) -> list[tuple[float, Look, str]]:
    """Return the tilts at which a centred cage touches balls and lands, each with look and name [mrad]."""
    play, land = axial_play(data) / float(data["cage_pitch_radius"]), land_boundary(data)
    found: list[tuple[float, Look, str]] = [(1e3 * play, POCKETS, "pockets")] if play > 0.0 else []
    reach = float(land_heights(data).max(initial=0.0)) + 0.5 * float(data["cage_land_width"])
    if land is not None and reach > 0.0:
        found.append((1e3 * float(land.max()) / reach, LAND, "land"))
    return found


def clearances(data: xr.Dataset) -> list[tuple[float, Look, str]]:
    """Return the clearances that a picture of the offset shows [mm], each with look and name."""
    play, land = largest_play(data), land_boundary(data)
    found = [] if play is None else [(1e3 * play, POCKETS, "pockets")]
    return found + ([] if land is None else [(1e3 * float(land.max()), LAND, "land")])


def draw_orbit(axes: Axes, data: xr.Dataset, *others: xr.Dataset) -> None:
    """Draw the centre's path between its boundaries, on a scale that has room for the other runs."""
    path = 1e3 * smooth_path(*(data[name].values.astype(float) for name in ("time", "position", "velocity")))
    most, land, pockets = 1e3 * max(map(orbit_reach, (data, *others))), land_boundary(data), None
    if largest_play(data):
        pockets = pocket_boundary(data["pocket_angle"].values, data["half_play"].values)
    boundaries = [
        (ring(np.where(np.isfinite(radius), 1e3 * radius, np.nan), AROUND), look, label)
        for radius, look, label in ((land, LAND, "land clearance"), (pockets, POCKETS, "pocket clearance"))
        if radius is not None and radius.max() > 0.0
    ]
    draw_path(axes, path, most, boundaries, "orbits")
    axes.set(xlabel="x [mm]", ylabel="y [mm]")


def draw_lean(axes: Axes, data: xr.Dataset) -> None:
    """Draw where the axis of the cage leans to, with the tilts at which a centred cage touches."""
    samples = (data[name].values.astype(float) for name in ("time", "lean", "lean_rate"))
    path = 1e3 * smooth_path(*samples)
    far = float(np.abs(path).max(initial=0.0)) or 1.0
    limits = [one for one in lean_limits(data) if one[0] <= 2.0 * far]
    circles = [(ring(size, AROUND), look, f"{name}, if centred") for size, look, name in limits]
    draw_path(axes, path, 1.12 * max([far, *(one[0] for one in limits)]), circles, "turns")
    axes.set(xlabel="lean along x [mrad]", ylabel="lean along y [mrad]")


def draw_path(
    axes: Axes, path: Array, most: float, boundaries: Sequence[tuple[Array, Look, str]], turns: str
) -> None:
    """Draw a path about the axis, darker in its last turns, within boundaries that have a look and a name."""
    axes.set(xlim=(-most, most), ylim=(-most, most))
    axes.set_aspect("equal", adjustable="box", anchor="NW")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))
    first = last_turns(path)
    if first:
        axes.plot(*path.T, color=SKY, lw=0.35, alpha=0.8, rasterized=True, label="path")
    for boundary, look, label in boundaries:
        axes.plot(*boundary.T, **look, label=label)
    label = "path" if not first else f"last {LAST} {turns}"
    axes.plot(*path[first:].T, color=BLUE, lw=0.8 if first else 0.6, label=label, zorder=3)
    axes.plot(*path[0], "o", color=BLACK, ms=3.5, ls="", label="start")
    axes.plot(*path[-1], "s", mfc="white", mec=BLACK, ms=3.5, ls="", label="end", zorder=4)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=6.5, handlelength=2.0)


def shade_judged(axes: Axes, data: xr.Dataset) -> None:
    """Shade the part by which the run is judged."""
    first, last = (1e3 * float(data[name]) for name in ("judged_from", "followed"))
    if last > first:
        axes.axvspan(first, last, color=GREY, alpha=0.2, lw=0, zorder=0)


def complex_velocity(data: xr.Dataset) -> tuple[float, Array]:
    """Step of the samples [s], and velocity x + iy, seen so that the ball set turns anticlockwise.

    A run of few samples goes on at rest up to `SHORTEST` of them.
    """
    time, sense = data["time"].values, -1.0 if float(data["cage_cage_speed"]) < 0.0 else 1.0
    v = data["velocity"].values @ np.array([1.0, 1j * sense])
    return float(time[1] - time[0] if time.size > 1 else 1.0), np.pad(v, (0, max(0, SHORTEST - v.size)))


def whirl_spectrum(data: xr.Dataset) -> tuple[Array, Array]:
    """Return frequency [Hz] and amplitude of the velocity of a run, the largest being 1.

    Frequency rises from negative (backward) to positive (forward).
    """
    step, v = complex_velocity(data)
    amplitude = np.abs(np.fft.fftshift(np.fft.fft(v)))
    return np.fft.fftshift(np.fft.fftfreq(v.size, step)), amplitude / (amplitude.max() or 1.0)


def spectrum_reach(data: xr.Dataset) -> Hertz:
    """Return the frequency up to which a picture of the spectrum must go [Hz]."""
    frequency, share = whirl_spectrum(data)
    shown = np.abs(frequency[share > PRESENT])
    return float(1.3 * shown.max(initial=0.0)) or float(np.abs(frequency).max()) or 1.0


def fastest_whirl(data: xr.Dataset) -> Hertz:
    """Return the highest frequency that is strong in a simulation [Hz]; 0 for a cage at rest."""
    frequency, share = whirl_spectrum(data)
    return float(np.abs(frequency[share > STRONG]).max(initial=0.0))


def draw_spectrum(axes: Axes, *runs: xr.Dataset, looks: tuple[Look, ...] = ({"color": BLUE},)) -> None:
    """Draw the two-sided spectra of the velocity of some runs; forward whirl turns as the balls do."""
    for data, look in zip(runs, looks, strict=True):
        frequency, share = whirl_spectrum(data)
        axes.plot(1e-3 * frequency, share, **{"lw": 0.8, **look})
    axes.axvline(0.0, color=GREY, lw=0.5)
    most = 1e-3 * max(map(spectrum_reach, runs))
    axes.set(xlim=(-most, most), xlabel="frequency [kHz]; backward < 0 < forward")
    axes.set(ylim=(0, 1.1), ylabel="share of the largest [-]")


def frame_moments(data: xr.Dataset, most: int = MOST_FRAMES) -> Array:
    """Return the samples that become frames, rising, with the first and the last.

    They are close enough to show each turn of the whirl; if the whole run would take too many, its beginning
    and its end are shown.
    """
    time = milliseconds(data)
    even = np.unique(np.linspace(0, time.size - 1, min(most, time.size)).astype(int))
    turns = fastest_whirl(data) * float(data["time"].values[-1])
    step = max(1, int(time.size / (A_TURN * turns))) if turns > 0.0 else time.size
    if int(np.diff(even).max(initial=1)) <= step:
        return even
    half = np.arange(most // 2) * step
    return np.unique(np.concatenate([half, time.size - 1 - half]))


def shown_parts(data: xr.Dataset, moments: Array) -> list[tuple[float, float]]:
    """Return beginning and end of each part of the run that the frames show [ms]."""
    time = milliseconds(data)[moments]
    if time.size < 3:
        return [(float(time[0]), float(time[-1]))]
    steps = np.diff(moments)
    cuts = np.flatnonzero(steps > GAP * np.median(steps) + 1) + 1
    return [(float(part[0]), float(part[-1])) for part in np.split(time, cuts)]
