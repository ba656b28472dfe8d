"""What the course of one run shows: offset, tilt, whirl, slip, spectra, touches in the pockets, rubbing.

Everything is computed from the samples of a `History`, but for impacts and rubbing, which the engine counts
itself. What does not exist, as all of tilt and axial motion in the plane, is None.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np

from separatrix.cage.numbers import look_time
from separatrix.units import (
    Array,
    Metre,
    MetrePerSecond,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    Watt,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.course import History
    from separatrix.cage.moving_cage import MovingCage

FEWEST, WINDOWS = 16, 24
"""Samples of the judged part below which the whole run is taken; windows in which the whirl is followed."""

BINS, DECADES = 24, 3.0
"""Bins of a histogram, and how far a logarithmic one goes down from the largest value."""

LONGEST, SHORTEST = 4096, 64
"""Samples of a piece of the run with its own spectrum."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Whirl:
    r"""Whirl of the centre and of the lean of the axis in the fixed frame, positive with the rotation.

    Attributes
    ----------
    cage_speed : float
        Mean angular speed :math:`\omega_c` of the cage about the bearing axis [rad/s].
    offset_ratio, tilt_ratio : float or None
        :math:`\int (r \times r')_z dt / (\omega_c \int |r|^2 dt)` of the centre's offset, and of the lean of
        the axis (a cone): 1 turns with the cage, 0 stands still in space. None without a motion or rotation.
    tilt_phase : float or None
        Angle from the offset to the lean, in the sense of the rotation: 0 is a forward cone, whose axis leans
        outward where the centre is; None if one of the two is zero [rad].
    tilt_coherence : float or None
        How far the lean keeps that angle and follows the offset: 1 always, 0 not at all.
    window_time, window_offset_ratio, window_tilt_ratio, window_cage_slip : tuple
        Middles of equal windows over the whole run [s], and ratios and slip in each.
    """

    cage_speed: RadianPerSecond
    offset_ratio: Ratio | None
    tilt_ratio: Ratio | None
    tilt_phase: Radian | None
    tilt_coherence: Ratio | None
    window_time: Annotated[tuple[float, ...], "s", ("window",)]
    window_offset_ratio: Annotated[tuple[float | None, ...], "-", ("window",)]
    window_tilt_ratio: Annotated[tuple[float | None, ...] | None, "-", ("window",)]
    window_cage_slip: Annotated[tuple[float | None, ...], "-", ("window",)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Spectra:
    """Amplitudes in the fixed frame, by Welch's method; of a pure tone its amplitude at its frequency.

    Attributes
    ----------
    frequency : ndarray
        Rises from negative (backward) to positive (forward, as the cage turns) [Hz].
    offset, lean : ndarray
        Of the centre, and of the lean of the cage's axis, as complex numbers x + iy.
    tone : ndarray
        From 0 up [Hz].
    axial, slip_rate : ndarray
        Of the axial place, and of the speed of the cage's rotation against the ball set.
    """

    frequency: Annotated[Array, "Hz", ("frequency",)]
    offset: Annotated[Array, "m", ("frequency",)]
    lean: Annotated[Array | None, "rad", ("frequency",)]
    tone: Annotated[Array, "Hz", ("tone",)]
    axial: Annotated[Array | None, "m", ("tone",)]
    slip_rate: Annotated[Array, "rad/s", ("tone",)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Impacts:
    """Impacts of balls in their pockets over the whole run.

    Attributes
    ----------
    rate, rate_per_turn : ndarray or None
        Of each pocket, as the engine counts them: by time, and by turn of the cage (None at rest).
    force_edges, force_count : ndarray
        Histogram of the peak force of touches that the samples show: logarithmic over three decades below
        the largest, smaller ones in the first bin. Edges have shape (edge,), one more than the counts.
    clock_edges, clock_impulse : ndarray
        Impulse of touches by the angle on the ball where it is pressed most: 0 in front of it, 90 deg
        towards the positive axis, 180 deg behind it.
    front_share, rear_share, axial_share : float or None
        Shares of the impulse within 45 deg of the front, of the rear, and of the axial poles.
    """

    rate: Annotated[Array, "1/s", ("ball",)]
    rate_per_turn: Annotated[Array | None, "-", ("ball",)]
    force_edges: Annotated[Array, "N", ("edge",)]
    force_count: Annotated[Array, "-", ("bin",)]
    clock_edges: Annotated[Array, "rad", ("edge",)]
    clock_impulse: Annotated[Array, "N s", ("bin",)]
    front_share: Ratio | None
    rear_share: Ratio | None
    axial_share: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Rubbing:
    """Power that friction turns into heat."""

    pocket_power: Annotated[Array, "W", ("ball",)]  # in each pocket, mean of the run
    land_power: Watt  # on the land, mean of the judged part


@dataclass(frozen=True, slots=True, kw_only=True)
class CourseAnalysis:
    r"""What one run shows; statistics are of its judged part unless stated.

    Attributes
    ----------
    whole_run : bool
        Whether the judged part has too few samples, so that statistics are of the whole run.
    mean_offset, offset_spread : float
        Distance of the centre from the bearing axis: its mean and standard deviation [m].
    whirl_speed : float
        Root of the mean square speed of the centre, seen from the balls [m/s].
    largest_tilt, mean_tilt : float or None
        Angle between the axes of cage and bearing, the largest of the whole run [rad].
    largest_axial, axial_low, axial_high : float or None
        Farthest of the centre along the axis in the whole run, and between which places it is [m].
    cage_slip : float or None
        :math:`1 - \omega_c / \omega_{kinematic}`, with the orbital speed of the free balls; None at rest.
    """

    run_length: Second  # of the samples
    whole_run: bool
    mean_offset: Metre
    offset_spread: Metre
    whirl_speed: MetrePerSecond
    largest_tilt: Radian | None
    mean_tilt: Radian | None
    largest_axial: Metre | None
    axial_low: Metre | None
    axial_high: Metre | None
    cage_slip: Ratio | None
    whirl: Whirl  # of the cage centre and of the tilt
    spectra: Spectra  # of the motion's parts
    impacts: Impacts  # rates and impulses in the pockets
    rubbing: Rubbing  # friction heat of pockets and land


def analyse(cage: MovingCage, history: History) -> CourseAnalysis:
    """Analyse a run of a cage."""
    time, (turned, speed) = history.time, ball_set(cage, history.time)
    judged = (time >= history.judged_from) & (time <= history.judged_until)
    whole_run = int(judged.sum()) < FEWEST
    part = np.flatnonzero(judged | whole_run)
    here = slice(int(part[0]), int(part[-1]) + 1)
    offset, lean, axial = np.hypot(*history.position.T)[here], history.lean, history.axial_place
    tilt = None if lean is None else np.hypot(*lean.T)
    look = look_time(cage)  # of which the engine counts whole ones
    ended = math.ceil(time[-1] / look - 1e-9) * look or math.inf
    return CourseAnalysis(
        run_length=float(time[-1]),
        whole_run=whole_run,
        mean_offset=float(offset.mean()),
        offset_spread=float(offset.std()),
        whirl_speed=math.sqrt(float(np.mean(np.sum(history.velocity[here] ** 2, axis=1)))),
        largest_tilt=None if tilt is None else float(tilt.max()),
        mean_tilt=None if tilt is None else float(tilt[here].mean()),
        largest_axial=None if axial is None else float(np.abs(axial).max()),
        axial_low=None if axial is None else float(axial[here].min()),
        axial_high=None if axial is None else float(axial[here].max()),
        cage_slip=cage_slip(time[here], speed[here], history.rotation_rate[here]),
        whirl=_whirl(history, speed, here, cage.rotation_sense),
        spectra=_spectra(history, turned, cage.rotation_sense),
        impacts=_impacts(history, speed, ended, cage.rotation_sense),
        rubbing=Rubbing(
            pocket_power=cage.ball_cage_friction * history.pocket_rubbing / ended,
            land_power=cage.land_friction * history.rubbing_force * history.rubbing_speed,
        ),
    )


def ball_set(cage: MovingCage, time: Array) -> tuple[Array, Array]:
    """Angle by which the ball set has turned at times [rad], and its speed then [rad/s], with its ramp."""
    ramp, missing = cage.ramp_time or 1.0, 1.0 - cage.ramp_start if cage.ramp_time else 0.0
    within = np.minimum(time, ramp)
    angle = time - missing * within + missing * within**2 / (2.0 * ramp)
    return cage.cage_speed * angle, cage.cage_speed * (1.0 - missing + missing * within / ramp)


def integral(time: Array, values: Array) -> float:
    """Integral over time by trapezoids."""
    return float(np.trapezoid(values, time))


def cage_slip(time: Array, speed: Array, rotation_rate: Array) -> Ratio | None:
    """Return by how much the cage turns slower than the ball set, over that; None at rest."""
    turned = integral(time, speed)
    return -integral(time, rotation_rate) / turned if turned else None


def whirl_speed(time: Array, place: Array, velocity: Array, speed: Array) -> RadianPerSecond | None:
    """Mean angular speed of a vector about the axis in the fixed frame [rad/s]; None for none.

    Parameters
    ----------
    time, speed : ndarray
        Samples [s], and angular speed of the frame [rad/s], shape (time,).
    place, velocity : ndarray
        The vector and its rate in the turning frame, shape (time, 2).
    """
    squared = np.sum(place**2, axis=1)
    swept = place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0]
    weight = integral(time, squared)
    return integral(time, swept + speed * squared) / weight if weight > 0.0 else None


def phase_of(offset: Array, lean: Array, time: Array) -> tuple[Radian | None, Ratio | None]:
    """Angle from one vector to another, weighted by both, and how steadily it is that; shape (time, 2)."""
    along = integral(time, np.sum(offset * lean, axis=1))
    across = integral(time, offset[:, 0] * lean[:, 1] - offset[:, 1] * lean[:, 0])
    both = math.sqrt(integral(time, np.sum(offset**2, axis=1)) * integral(time, np.sum(lean**2, axis=1)))
    if not both > 0.0:
        return None, None
    return math.atan2(across, along), min(1.0, math.hypot(along, across) / both)


def _whirl(history: History, speed: Array, here: slice, sense: int) -> Whirl:
    """Whirl of the judged part, and in windows over the whole run."""
    time, rate = history.time, history.rotation_rate

    def ratio(place: Array | None, velocity: Array | None, part: slice) -> Ratio | None:
        mean = float(np.mean(speed[part] + rate[part]))
        if place is None or velocity is None or mean == 0.0:
            return None
        found = whirl_speed(time[part], place[part], velocity[part], speed[part])
        return None if found is None else found / mean

    edges = np.unique(np.linspace(0, time.size - 1, WINDOWS + 1).astype(int))
    windows = [slice(int(a), int(b) + 1) for a, b in pairwise(edges)]
    centre, lean = (history.position, history.velocity), (history.lean, history.lean_rate)
    phase, coherence = None, None
    if history.lean is not None:
        phase, coherence = phase_of(history.position[here], history.lean[here], time[here])
    return Whirl(
        cage_speed=float(np.mean(speed[here] + rate[here])),
        offset_ratio=ratio(*centre, here),
        tilt_ratio=ratio(*lean, here),
        tilt_phase=None if phase is None else sense * phase,
        tilt_coherence=coherence,
        window_time=tuple(float(0.5 * (time[one][0] + time[one][-1])) for one in windows),
        window_offset_ratio=tuple(ratio(*centre, one) for one in windows),
        window_tilt_ratio=None if history.lean is None else tuple(ratio(*lean, one) for one in windows),
        window_cage_slip=tuple(cage_slip(time[one], speed[one], rate[one]) for one in windows),
    )


def _spectra(history: History, turned: Array, sense: int) -> Spectra:
    step, axial = float(history.time[-1]) / max(history.time.size - 1, 1) or 1.0, history.axial_place

    def of_vector(vector: Array) -> tuple[Array, Array]:
        return amplitudes((vector[:, 0] + 1j * sense * vector[:, 1]) * np.exp(1j * sense * turned), step)

    frequency, offset = of_vector(history.position)
    tone, slip_rate = amplitudes(history.rotation_rate, step)
    return Spectra(
        frequency=frequency,
        offset=offset,
        lean=None if history.lean is None else of_vector(history.lean)[1],
        tone=tone,
        axial=None if axial is None else amplitudes(axial, step)[1],
        slip_rate=slip_rate,
    )


def amplitudes(signal: Array | NDArray[np.complex128], step: float) -> tuple[Array, Array]:
    """Frequency [Hz] and amplitude of even samples less their mean, by Welch's method.

    Root of the mean square over half overlapping pieces, with Hann's window. Two-sided for a complex
    signal, else from 0 up. A tone between two frequencies has up to 15 % less than its amplitude.
    """
    signal = signal - signal.mean()
    n = max(2, min(LONGEST, signal.size, max(SHORTEST, 2 ** int(np.log2(max(signal.size // 3, 1))))))
    signal = np.resize(signal, max(n, signal.size))
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


class Touches(NamedTuple):
    """Every stretch of samples in which a pocket presses on its ball; arrays have shape (touch,).

    Its ball, peak force [N], impulse [N s], and where on the ball it is pressed at the peak [rad].
    """

    ball: NDArray[np.int64]
    peak_force: Array
    impulse: Array
    angle: Array


def touches(time: Array, force: Array, angle: Array) -> Touches:
    """Touches of samples of force [N] and angle [rad], shape (time, ball); a sample stands for its step."""
    step = np.gradient(time) if time.size > 1 else np.ones(time.size)
    pressed = np.zeros((force.shape[1], time.size + 2), bool)
    pressed[:, 1:-1] = force.T > 0.0
    change = np.diff(pressed.astype(np.int8), axis=1)
    ball, first = np.nonzero(change == 1)
    last = np.nonzero(change == -1)[1]
    weighted = np.concatenate([np.zeros((force.shape[1], 1)), np.cumsum(force.T * step, axis=1)], axis=1)
    peaks = [a + int(np.argmax(force[a:b, j])) for j, a, b in zip(ball, first, last, strict=True)]
    peak = np.array(peaks, dtype=np.int64)
    return Touches(ball, force[peak, ball], weighted[ball, last] - weighted[ball, first], angle[peak, ball])


def histogram(values: Array) -> tuple[Array, Array]:
    """Edges and counts, logarithmic over `DECADES` below the largest; smaller ones in the first bin.

    Where there is no value the edges end at 1.
    """
    largest = float(values.max(initial=0.0)) or 1.0
    edges = largest * np.logspace(-DECADES, 0.0, BINS + 1)
    edges[-1] = largest
    return edges, np.histogram(np.clip(values, edges[0], largest), edges)[0].astype(np.float64)


def clock_histogram(angle: Array, impulse: Array) -> tuple[Array, Array]:
    """Edges, and impulses around the pocket, in bins whose middles are the poles."""
    half = math.pi / BINS
    edges = np.linspace(-half, 2.0 * math.pi - half, BINS + 1)
    return edges, np.histogram(np.mod(angle + half, 2.0 * math.pi) - half, edges, weights=impulse)[0]


def _impacts(history: History, speed: Array, ended: Second, sense: int) -> Impacts:
    time, pole = history.time, math.cos(math.pi / 4.0)
    seen = touches(time, history.contact_force, history.contact_angle)
    angle = seen.angle if sense > 0 else math.pi - seen.angle  # in front is where the balls go
    turns = abs(integral(time, speed + history.rotation_rate)) / (2.0 * math.pi)
    total, along = float(seen.impulse.sum()), np.cos(angle)

    def share(near: NDArray[np.bool_]) -> Ratio | None:
        return float(seen.impulse[near].sum()) / total if total > 0.0 else None

    force, clock = histogram(seen.peak_force), clock_histogram(angle, seen.impulse)
    return Impacts(
        rate=history.pocket_impacts / ended,
        rate_per_turn=history.pocket_impacts / turns if turns > 0.0 else None,
        force_edges=force[0],
        force_count=force[1],
        clock_edges=clock[0],
        clock_impulse=clock[1],
        front_share=share(along >= pole),
        rear_share=share(along <= -pole),
        axial_share=share(np.abs(along) < pole),
    )
