"""The whirl of the cage centre: its spectrum over the run, and against time."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from separatrix.figures.style import BLUE, GREY
from separatrix.units import Array, Hertz

FAINTEST, SEEN = -50.0, -30.0
"""Weakest whirl of the picture against time, and weakest for which it goes on, under the strongest [dB]."""

SHORTEST = 8
"""Least samples of a piece of the run that has a spectrum of its own."""

STRONG, PRESENT = 0.3, 0.05
"""Shares of the largest amplitude from which a whirl is strong, and is shown."""

LABEL = "frequency [kHz]; backward < 0 < forward"


def even_velocity(time: Array, velocity: Array) -> tuple[Array, Array]:
    """Return evenly spaced times [s], at least `SHORTEST`, and the complex velocity at them [m/s]."""
    even = np.linspace(0.0, time[-1] or 1.0, max(SHORTEST, time.size))
    return even, np.interp(even, time, velocity[:, 0]) + 1j * np.interp(even, time, velocity[:, 1])


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
    even, v = even_velocity(time, velocity)
    amplitude = np.abs(np.fft.fft(v))
    frequency = np.fft.fftfreq(even.size, even[1] - even[0])
    order = np.argsort(frequency)
    return frequency[order], amplitude[order] / (amplitude.max() or 1.0)


BANDS = 12.0
"""Least frequencies between 0 and the highest that a picture against time shows."""


def spectrum_against_time(time: Array, velocity: Array, reach: Hertz = 0.0) -> tuple[Array, Array, Array]:
    """Spectra of pieces of the run, each with Hann's window and three quarters over the one before.

    Parameters
    ----------
    time, velocity : ndarray
        As for `whirl_spectrum`.
    reach : float
        Highest frequency to be shown, for which pieces are made long enough; 0 if it does not matter [Hz].

    Returns
    -------
    tuple of ndarray
        Middles of the pieces [s]; frequency, rising [Hz]; amplitude over the largest, shape
        (piece, frequency) [-].
    """
    even, v = even_velocity(time, velocity)
    fine = BANDS / (reach * (even[1] - even[0])) if reach > 0.0 else 1.0
    wanted = max(2.0 ** round(np.log2(3.0 * np.sqrt(v.size))), 2.0 ** np.ceil(np.log2(fine)))
    length = int(min(max(v.size // 4, SHORTEST), max(SHORTEST, wanted)))
    starts = np.arange(0, v.size - length + 1, max(1, length // 4))
    pieces = v[starts[:, np.newaxis] + np.arange(length)] * np.hanning(length)
    amplitude = np.abs(np.fft.fftshift(np.fft.fft(pieces, axis=1), axes=1))
    frequency = np.fft.fftshift(np.fft.fftfreq(length, even[1] - even[0]))
    return even[starts] + 0.5 * (even[length - 1] - even[0]), frequency, amplitude / (amplitude.max() or 1.0)


def of_run(data: xr.Dataset) -> tuple[Array, Array]:
    """Return the spectrum of a simulation."""
    return whirl_spectrum(data["time"].values, data["velocity"].values)


def spectrum_reach(data: xr.Dataset) -> float:
    """Return the frequency up to which a picture of the spectrum must go [Hz]."""
    frequency, share = of_run(data)
    shown = np.abs(frequency[share > PRESENT])
    return float(1.3 * shown.max(initial=0.0)) or float(np.abs(frequency).max()) or 1.0


def fastest_whirl(data: xr.Dataset) -> float:
    """Return the highest frequency that is strong in a simulation [Hz]; 0 for a cage at rest."""
    frequency, share = of_run(data)
    return float(np.abs(frequency[share > STRONG]).max(initial=0.0))


def strongest_whirl(data: xr.Dataset) -> float:
    """Return the frequency of the largest amplitude [Hz], negative backward; 0 for a cage at rest."""
    frequency, share = of_run(data)
    return float(frequency[share.argmax()]) if share.any() else 0.0


def in_words(data: xr.Dataset) -> str:
    """Return the frequency of the strongest whirl as words; nothing for a cage at rest."""
    strongest = strongest_whirl(data)
    if strongest == 0.0:
        return ""
    return f", largest at {1e-3 * strongest:.2g} kHz".replace("-", "\N{MINUS SIGN}")


def draw_spectrum(axes: Axes, *runs: xr.Dataset, looks: tuple[Any, ...] = ({"color": BLUE},)) -> None:
    """Draw the two-sided spectra of the velocity of some runs; forward whirl turns as the balls do."""
    for data, look in zip(runs, looks, strict=True):
        frequency, share = of_run(data)
        axes.plot(1e-3 * frequency, share, **{"lw": 0.8, **look})
    axes.axvline(0.0, color=GREY, lw=0.5)
    axes.set(xlabel=LABEL, ylabel="share of the largest [-]")
    most = 1e-3 * max(map(spectrum_reach, runs))
    axes.set(xlim=(-most, most), ylim=(0, 1.1))


def draw_against_time(axes: Axes, data: xr.Dataset) -> None:
    """Draw the spectrum against linear time while there is a whirl to see, darker for a stronger one."""
    most = spectrum_reach(data)
    middles, frequency, share = spectrum_against_time(data["time"].values, data["velocity"].values, most)
    shown = np.abs(frequency) <= max(1.1 * most, 2.1 * (frequency[1] - frequency[0]))
    level = 20.0 * np.log10(np.maximum(share[:, shown], 10.0 ** (FAINTEST / 20.0)))
    edges = 1e3 * edges_of(middles), 1e-3 * edges_of(frequency[shown])
    look: Any = {"cmap": "Greys", "vmin": FAINTEST, "vmax": 0.0, "rasterized": True}
    mesh = axes.pcolormesh(*edges, level.T, **look)
    axes.axhline(0.0, color=BLUE, lw=0.5)
    whole, seen = 1e3 * float(data["time"].values[-1]) or 1.0, (level > SEEN).any(axis=1)
    last = min(whole, float(1.5 * edges[0][1:][seen].max(initial=0.0)) or whole)
    axes.set(xlim=(0.0, last), ylim=(-1e-3 * most, 1e-3 * most), xlabel="time [ms]", ylabel="frequency [kHz]")
    bar = axes.figure.colorbar(mesh, ax=axes, pad=0.02, aspect=20)
    bar.set_label("level under the largest [dB]")
    bar.outline.set_visible(False)


def edges_of(middles: Array) -> Array:
    """Return edges half-way between evenly spaced values; a single value has a cell of twice its size."""
    half = 0.5 * (middles[1] - middles[0]) if middles.size > 1 else middles[0] or 0.5
    return np.asarray(np.append(middles - half, middles[-1] + half))
