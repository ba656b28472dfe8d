"""Amplitude spectra of a run in space, in the fixed frame: of a pure tone its amplitude at its frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from separatrix.units import Array, Hertz, Metre, Radian, RadianPerSecond

LONGEST, SHORTEST = 4096, 64
"""Samples of a piece of the run with its own spectrum."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spectra:
    r"""Amplitudes by Welch's method: root of the mean square over half overlapping pieces, Hann's window.

    Attributes
    ----------
    frequency : ndarray
        Rises from negative (backward) to positive (forward, as the cage turns) [Hz].
    offset, lean : ndarray
        Of the centre and of the lean of the cage's axis as complex numbers x + iy in the fixed frame.
    tone : ndarray
        From 0 up [Hz].
    axial, slip_rate : ndarray
        Of the axial place, and of the speed of the cage's rotation against the ball set.
    offset_frequency, lean_frequency, axial_frequency, slip_frequency : float or None
        Where each is largest; None without a motion [Hz].
    """

    frequency: Annotated[Array, "Hz", ("frequency",)]
    offset: Annotated[Array, "m", ("frequency",)]
    lean: Annotated[Array, "rad", ("frequency",)]
    tone: Annotated[Array, "Hz", ("tone",)]
    axial: Annotated[Array, "m", ("tone",)]
    slip_rate: Annotated[Array, "rad/s", ("tone",)]
    offset_frequency: Hertz | None
    offset_amplitude: Metre  # of the strongest tone of the offset
    lean_frequency: Hertz | None
    lean_amplitude: Radian  # of the strongest tone of the lean
    axial_frequency: Hertz | None
    axial_amplitude: Metre  # of the strongest tone along the axis
    slip_frequency: Hertz | None
    slip_amplitude: RadianPerSecond  # of the strongest tone of the slip rate


def spectra(
    time: Array, turned: Array, *, centre: Array, lean: Array, axial: Array, slip_rate: Array
) -> Spectra:
    """Spectra of even samples; `centre` and `lean`, shape (time, 2), are in the frame turned by angles."""
    step = float(time[-1] - time[0]) / max(time.size - 1, 1)
    turn = np.exp(1j * turned)
    frequency, offset = amplitudes((centre[:, 0] + 1j * centre[:, 1]) * turn, step)
    _, leaning = amplitudes((lean[:, 0] + 1j * lean[:, 1]) * turn, step)
    tone, along = amplitudes(axial, step)
    _, slipping = amplitudes(slip_rate, step)
    at = {
        name: _largest(frequency if name in ("offset", "lean") else tone, found)
        for name, found in (("offset", offset), ("lean", leaning), ("axial", along), ("slip", slipping))
    }
    return Spectra(
        frequency=frequency,
        offset=offset,
        lean=leaning,
        tone=tone,
        axial=along,
        slip_rate=slipping,
        offset_frequency=at["offset"][0],
        offset_amplitude=at["offset"][1],
        lean_frequency=at["lean"][0],
        lean_amplitude=at["lean"][1],
        axial_frequency=at["axial"][0],
        axial_amplitude=at["axial"][1],
        slip_frequency=at["slip"][0],
        slip_amplitude=at["slip"][1],
    )


def _largest(frequency: Array, amplitude: Array) -> tuple[float | None, float]:
    place = int(np.argmax(amplitude))
    return (float(frequency[place]) if amplitude[place] > 0.0 else None), float(amplitude[place])


def amplitudes(signal: Array, step: float) -> tuple[Array, Array]:
    """Frequency [Hz] and amplitude of even samples less their mean, by Welch's method.

    Two-sided and rising for a complex signal, from 0 up for a real one. A tone between two frequencies has up
    to 15 % less than its amplitude.
    """
    signal = signal - signal.mean()
    n = max(2, min(LONGEST, signal.size, max(SHORTEST, 2 ** int(np.log2(max(signal.size // 3, 1))))))
    starts = np.arange(0, signal.size - n + 1, max(1, n // 2))
    window = np.hanning(n + 1)[:-1] if n > 2 else np.ones(n)
    pieces = signal[starts[:, np.newaxis] + np.arange(n)] * window
    if np.iscomplexobj(signal):
        power = np.mean(np.abs(np.fft.fft(pieces, axis=1)) ** 2, axis=0)
        return np.fft.fftshift(np.fft.fftfreq(n, step)), np.fft.fftshift(np.sqrt(power)) / window.sum()
    power = np.mean(np.abs(np.fft.rfft(pieces, axis=1)) ** 2, axis=0)
    amplitude = 2.0 * np.sqrt(power) / window.sum()
    amplitude[0] *= 0.5
    return np.asarray(np.fft.rfftfreq(n, step), dtype=float), amplitude
