"""One run of the cage: orbit, energies, forces, and the spectrum of its whirl."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, CYCLE, GREY, PAGE, VERMILION, canvas, label_lines
from separatrix.units import Array


def run(data: xr.Dataset) -> Figure:
    """Orbit of the cage centre, energies, forces and whirl spectrum of one run."""
    figure, axes = canvas(PAGE, 5.0, nrows=2, ncols=2)
    _orbit(axes[0, 0], data)
    _energy(axes[0, 1], data)
    _force(axes[1, 0], data)
    _spectrum(axes[1, 1], data)
    return figure


def _orbit(axes: Axes, data: xr.Dataset) -> None:
    """Draw the centre's path inside the circles of the pocket play and of the land."""
    x, y = 1e3 * data["position"].values.T
    axes.plot(x, y, color=BLUE, lw=0.3, alpha=0.8)
    axes.plot(x[:1], y[:1], "o", color=BLACK, ms=3)
    rings = [(0.5e3 * float(data["cage_pocket_clearance"]), GREY, "half the\npocket play", -35.0)]
    if "cage_land_clearance" in data and np.isfinite(data["cage_land_clearance"]):
        rings.append((0.5e3 * float(data["cage_land_clearance"]), VERMILION, "land", 35.0))
    reach = 1.08 * max(np.abs([x, y]).max(), *(radius for radius, *_ in rings))
    for ring in rings:
        _ring(axes, *ring, reach=reach)
    axes.set(ylim=(-reach, reach), xlabel="x [mm]", ylabel="y [mm]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title("a  Orbit of the cage centre, turning frame")


def _ring(axes: Axes, radius: float, colour: str, name: str, degrees: float, *, reach: float) -> None:
    """Draw a circle, named at its right."""
    angle, at = np.linspace(0, 2 * np.pi, 181), np.radians(degrees)
    axes.plot(radius * np.cos(angle), radius * np.sin(angle), color=colour, lw=0.9, ls=(0, (4, 2)))
    axes.annotate(
        name,
        (radius * np.cos(at), radius * np.sin(at)),
        xytext=(1.0 * reach, 1.0 * reach * np.sin(at)),
        color=colour,
        fontsize=7,
        va="center",
        arrowprops={"arrowstyle": "-", "lw": 0.5, "color": colour},
    )


def _energy(axes: Axes, data: xr.Dataset) -> None:
    """Draw the kinetic energy and the work of each source since the start."""
    time = 1e3 * data["time"].values
    axes.plot(time, 1e3 * data["kinetic_energy"].values, color=BLACK, lw=1.0)
    ends = [(time[-1], 1e3 * float(data["kinetic_energy"][-1]), "kinetic energy", BLACK)]
    works = [name for name in data if str(name).startswith("work_") and np.any(data[name].values)]
    for name, colour in zip(works, CYCLE, strict=False):
        axes.plot(time, 1e3 * data[name].values, color=colour, lw=0.8)
        label = str(name).removeprefix("work_").replace("_", " ")
        ends.append((time[-1], 1e3 * float(data[name][-1]), label, colour))
    axes.set(ylabel="energy, work [mJ]", title="b  Kinetic energy and the work behind it")
    _time_axis(axes, data)
    label_lines(axes, ends, gap=0.075)


def _time_axis(axes: Axes, data: xr.Dataset) -> None:
    """Set the axis of time: logarithmic for a motion that dies, because it does so early."""
    time = 1e3 * data["time"].values
    if str(data["outcome"].values) == "DIES":
        axes.set(xscale="log", xlim=(time[1], time[-1]), xlabel="time, logarithmic [ms]")
        axes.xaxis.set_major_formatter("{x:g}")
    else:
        axes.set(xlim=(0, time[-1]), xlabel="time [ms]")


def _force(axes: Axes, data: xr.Dataset) -> None:
    """Draw the largest pocket force at each instant, and the land's."""
    time = 1e3 * data["time"].values
    axes.plot(
        time,
        np.abs(data["contact_force"].values).max(axis=1),
        color=BLUE,
        lw=0.5,
        label="largest pocket force",
    )
    if np.any(data["land_force"].values):
        axes.plot(time, np.abs(data["land_force"].values), color=VERMILION, lw=0.5, label="land")
    axes.set(ylabel="force [N]", title="c  Contact forces")
    _time_axis(axes, data)
    axes.set_ylim(0, 1.25 * axes.get_ylim()[1])
    axes.legend(loc="upper right", ncols=2, handlelength=1.4)


def _spectrum(axes: Axes, data: xr.Dataset) -> None:
    """Draw the two-sided spectrum of the velocity; forward whirl turns as the ball set does."""
    frequency, share = whirl_spectrum(data["time"].values, data["velocity"].values)
    axes.plot(1e-3 * frequency, share, color=BLUE, lw=0.8)
    axes.axvline(0.0, color=GREY, lw=0.5)
    axes.set(
        xlabel="frequency [kHz]; backward < 0 < forward", ylabel="share of the largest [-]", ylim=(0, 1.1)
    )
    axes.set_title("d  Whirl spectrum of the centre's velocity")
    strong = np.abs(frequency[share > 0.05])
    reach = 1e-3 * 1.3 * (strong.max() if strong.size else np.abs(frequency).max())
    axes.set_xlim(-reach, reach)


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
    even = np.linspace(0.0, time[-1], count)
    v = np.interp(even, time, velocity[:, 0]) + 1j * np.interp(even, time, velocity[:, 1])
    amplitude = np.abs(np.fft.fft(v))
    frequency = np.fft.fftfreq(count, even[1] - even[0])
    order = np.argsort(frequency)
    return frequency[order], amplitude[order] / (amplitude.max() or 1.0)
