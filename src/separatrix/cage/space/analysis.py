"""What one run in space shows: orbit, axial motion and tilt, whirl, slip, impacts, forces and rubbing.

Everything is computed from the samples of a `SpaceHistory`, but for impacts, rubbing and extremes of forces,
which the engine counts itself. A number that does not exist is None.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated

import numpy as np

from separatrix.cage.space.contacts import clock_histogram, histogram, touches
from separatrix.cage.space.ensemble import turned_forward_in_space
from separatrix.cage.space.spectra import Spectra, spectra
from separatrix.study import Guidance
from separatrix.units import (
    Array,
    Metre,
    Newton,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    Watt,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage
    from separatrix.cage.space.history import SpaceHistory

FEWEST, WINDOWS = 16, 24
"""Samples of the judged part below which the whole run is taken; windows in which the whirl is followed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lengths:
    """Mean, standard deviation, root mean square about zero, and extremes of a length over time [m]."""

    mean: Metre  # over the run
    standard_deviation: Metre  # about the mean
    rms: Metre  # root of the mean square
    low: Metre  # smallest
    high: Metre  # largest


@dataclass(frozen=True, slots=True, kw_only=True)
class Angles:
    """As `Lengths`, of an angle [rad]."""

    mean: Radian  # over the run
    standard_deviation: Radian  # about the mean
    rms: Radian  # root of the mean square
    low: Radian  # smallest
    high: Radian  # largest


@dataclass(frozen=True, slots=True, kw_only=True)
class Whirl:
    r"""Whirl of the centre and of the tilt in the fixed frame, positive with the rotation.

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
    window_tilt_ratio: Annotated[tuple[float | None, ...], "-", ("window",)]
    window_cage_slip: Annotated[tuple[float | None, ...], "-", ("window",)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Impacts:
    """Impacts of balls in their pockets over the whole run.

    Attributes
    ----------
    count, land_count : float
        Impacts that the engine counted in all pockets, and at the strips of the lands.
    rate, rate_per_turn : ndarray or None
        Of each pocket, by time and by turn of the cage, shape (ball,); None for a cage at rest [1/s], [-].
    sampled : int
        Touches that the samples show, which the histograms are of.
    force_edges, force_count, impulse_edges, impulse_count, duration_edges, duration_count : ndarray
        Histograms of peak force, impulse and duration: logarithmic over three decades below the largest,
        smaller ones in the first bin. Edges have shape (edge,), one more than the counts (bin,).
    clock_edges, clock_count, clock_impulse : ndarray
        Touches and their impulse by the angle on the ball where it is pressed most: 0 in front of it, 90 deg
        towards the positive axis, 180 deg behind it [rad], [-], [N s].
    front_share, rear_share, axial_share : float or None
        Shares of the impulse within 45 deg of the front, of the rear, and of the axial poles.
    """

    count: int
    land_count: int
    rate: Annotated[Array, "1/s", ("ball",)]
    rate_per_turn: Annotated[Array | None, "-", ("ball",)]
    sampled: int
    force_edges: Annotated[Array, "N", ("edge",)]
    force_count: Annotated[Array, "-", ("bin",)]
    impulse_edges: Annotated[Array, "N s", ("edge",)]
    impulse_count: Annotated[Array, "-", ("bin",)]
    duration_edges: Annotated[Array, "s", ("edge",)]
    duration_count: Annotated[Array, "-", ("bin",)]
    clock_edges: Annotated[Array, "rad", ("edge",)]
    clock_count: Annotated[Array, "-", ("bin",)]
    clock_impulse: Annotated[Array, "N s", ("bin",)]
    front_share: Ratio | None
    rear_share: Ratio | None
    axial_share: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Rubbing:
    r"""Sliding under load over the whole run, :math:`\int N v\,dt`: times a wear coefficient, lost volume.

    Attributes
    ----------
    pocket_sliding, land_sliding : ndarray
        Of each pocket, shape (ball,), and of each land, shape (guide,) [J].
    pocket_power, land_power : ndarray
        Friction times that, over the run: mean power turned into heat, shapes (ball,) and (guide,) [W].
    """

    pocket_sliding: Annotated[Array, "J", ("ball",)]
    land_sliding: Annotated[Array, "J", ("guide",)]
    pocket_power: Annotated[Array, "W", ("ball",)]
    land_power: Annotated[Array, "W", ("guide",)]
    total_power: Watt  # mean friction heat of all pockets and lands


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceAnalysis:
    r"""What one run in space shows; statistics are of its judged part unless stated.

    Attributes
    ----------
    whole_run : bool
        Whether the judged part has too few samples, so that statistics are of the whole run.
    offset, axial : Lengths
        Distance of the centre from the bearing axis; its place along it.
    tilt, slip_angle : Angles
        Angle between the axes of cage and bearing; rotation of the cage against the ball set.
    largest_offset, largest_axial, largest_tilt : float
        Of the whole run [m], [m], [rad].
    cage_slip : float or None
        :math:`1 - \omega_c / \omega_{kinematic}`, with the orbital speed of the free balls; None at rest.
    force_share : float or None
        Largest pocket force over what the races can transmit to a ball; None if that is not known.
    """

    run_length: Second  # time over which the means are taken
    whole_run: bool
    offset: Lengths
    axial: Lengths
    tilt: Angles
    slip_angle: Angles
    largest_offset: Metre
    largest_axial: Metre
    largest_tilt: Radian
    cage_slip: Ratio | None
    whirl: Whirl  # of the cage centre and of the tilt
    spectra: Spectra  # of the motion's parts, with their strongest tones
    impacts: Impacts  # counts, rates and impulses of pockets and lands
    rubbing: Rubbing  # friction heat of pockets and lands
    force_share: Ratio | None


def analyse(cage: PlanarCage, history: SpaceHistory, *, capacity: Newton | None = None) -> SpaceAnalysis:
    """Analyse a run in space; `capacity` is what the races can transmit to a ball [N]."""
    cage, time = turned_forward_in_space(cage), history.time
    judged = (time >= history.judged_from) & (time <= history.judged_until)
    whole_run = int(judged.sum()) < FEWEST
    part = np.flatnonzero(judged) if not whole_run else np.arange(time.size)
    here = slice(int(part[0]), int(part[-1]) + 1)
    offset, tilt = np.hypot(*history.centre.T), np.hypot(*history.lean.T)
    speed = ball_set_speed(cage, time)
    share = None if capacity is None or capacity <= 0.0 else history.largest_contact_force / capacity
    return SpaceAnalysis(
        run_length=float(time[-1]),
        whole_run=whole_run,
        offset=Lengths(**spread(offset[here])),
        axial=Lengths(**spread(history.position[here, 2])),
        tilt=Angles(**spread(tilt[here])),
        slip_angle=Angles(**spread(history.rotation[here])),
        largest_offset=float(offset.max()),
        largest_axial=float(np.abs(history.position[:, 2]).max()),
        largest_tilt=float(tilt.max()),
        cage_slip=cage_slip(time[here], speed[here], history.rotation_rate[here]),
        whirl=_whirl(history, speed, here),
        spectra=spectra(
            time,
            ball_set_angle(cage, time),
            centre=history.centre,
            lean=history.lean,
            axial=history.position[:, 2],
            slip_rate=history.rotation_rate,
        ),
        impacts=_impacts(history, speed),
        rubbing=_rubbing(cage, history),
        force_share=share,
    )


def spread(values: Array) -> dict[str, float]:
    """Mean, standard deviation, root mean square about zero, and extremes of even samples."""
    return {
        "mean": float(np.mean(values)),
        "standard_deviation": float(np.std(values)),
        "rms": math.sqrt(float(np.mean(values**2))),
        "low": float(np.min(values)),
        "high": float(np.max(values)),
    }


def integral(time: Array, values: Array) -> float:
    """Integral over time by trapezoids."""
    return float(np.trapezoid(values, time))


def ball_set_speed(cage: PlanarCage, time: Array) -> Array:
    """Angular speed of the ball set at times, with its start-up ramp [rad/s]."""
    within = np.minimum(time / cage.ramp_time, 1.0) if cage.ramp_time > 0.0 else np.ones(time.size)
    start = cage.ramp_start if cage.ramp_time > 0.0 else 1.0
    return np.asarray(cage.cage_speed * (start + (1.0 - start) * within))


def ball_set_angle(cage: PlanarCage, time: Array) -> Array:
    """Angle by which the ball set has turned at times [rad]."""
    speed, ramp = cage.cage_speed, cage.ramp_time
    if not ramp > 0.0:
        return np.asarray(speed * time)
    within, missing = np.minimum(time, ramp), 1.0 - cage.ramp_start
    return np.asarray(speed * (time - missing * within + missing * within**2 / (2.0 * ramp)))


def cage_slip(time: Array, speed: Array, rotation_rate: Array) -> Ratio | None:
    """Return by how much the cage turns slower than the ball set, over that; None at rest."""
    turned = integral(time, speed)
    return -integral(time, rotation_rate) / turned if turned > 0.0 else None


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


def _ratio(speed: float | None, over: float) -> Ratio | None:
    return None if speed is None or over == 0.0 else speed / over


def _whirl(history: SpaceHistory, speed: Array, here: slice) -> Whirl:
    """Whirl of the judged part, and in windows over the whole run."""
    time, cage_speed = history.time, speed + history.rotation_rate

    def ratios(part: slice) -> tuple[float, float | None, float | None]:
        at, frame = time[part], speed[part]
        length = float(at[-1] - at[0])
        mean = integral(at, cage_speed[part]) / length if length > 0.0 else float(cage_speed[part].mean())
        orbit = whirl_speed(at, history.centre[part], history.centre_velocity[part], frame)
        cone = whirl_speed(at, history.lean[part], history.lean_rate[part], frame)
        return mean, _ratio(orbit, mean), _ratio(cone, mean)

    edges = np.unique(np.linspace(0, time.size - 1, WINDOWS + 1).astype(int))
    windows = [slice(int(a), int(b) + 1) for a, b in pairwise(edges)]
    found = [ratios(window) for window in windows]
    slips = [cage_slip(time[one], speed[one], history.rotation_rate[one]) for one in windows]
    mean, offset, tilt = ratios(here)
    phase, coherence = phase_of(history.centre[here], history.lean[here], time[here])
    return Whirl(
        cage_speed=mean,
        offset_ratio=offset,
        tilt_ratio=tilt,
        tilt_phase=phase,
        tilt_coherence=coherence,
        window_time=tuple(float(0.5 * (time[one][0] + time[one][-1])) for one in windows),
        window_offset_ratio=tuple(one[1] for one in found),
        window_tilt_ratio=tuple(one[2] for one in found),
        window_cage_slip=tuple(slips),
    )


def _impacts(history: SpaceHistory, speed: Array) -> Impacts:
    time = history.time
    seen = touches(time, history.contact_force, history.contact_angle)
    length, turns = float(time[-1]), integral(time, speed + history.rotation_rate) / (2.0 * math.pi)
    total = float(seen.impulse.sum())

    def share(near: NDArray[np.bool_]) -> Ratio | None:
        return float(seen.impulse[near].sum()) / total if total > 0.0 else None

    along = np.cos(seen.angle)
    clock = clock_histogram(seen.angle, seen.impulse)
    force, impulse, duration = (histogram(one) for one in (seen.peak_force, seen.impulse, seen.duration))
    pole = math.cos(math.pi / 4.0)
    return Impacts(
        count=int(history.pocket_impacts.sum()),
        land_count=history.land_impacts,
        rate=history.pocket_impacts / length,
        rate_per_turn=history.pocket_impacts / turns if turns > 0.0 else None,
        sampled=seen.impulse.size,
        force_edges=force[0],
        force_count=force[1],
        impulse_edges=impulse[0],
        impulse_count=impulse[1],
        duration_edges=duration[0],
        duration_count=duration[1],
        clock_edges=clock[0],
        clock_count=clock[1],
        clock_impulse=clock[2],
        front_share=share(along >= pole),
        rear_share=share(along <= -pole),
        axial_share=share(np.abs(along) < pole),
    )


def land_sliding(cage: PlanarCage, history: SpaceHistory) -> Array:
    """Sliding speed of the cage on its land around the axis, shape (time,) [m/s]."""
    body = cage.space
    reach = cage.pitch_radius if body is None or body.land_radius is None else body.land_radius
    running = ball_set_speed(cage, history.time) / cage.cage_speed if cage.cage_speed else 1.0
    ring = (cage.guiding_ring_speed - cage.cage_speed) * running
    return np.asarray(np.abs(ring - history.rotation_rate) * reach)


def _rubbing(cage: PlanarCage, history: SpaceHistory) -> Rubbing:
    """Rubbing of pockets as the engine counts it, and of lands, whose sum it counts, by their samples."""
    lands = 0 if cage.guidance is Guidance.BALL or cage.space is None else len(cage.space.land_heights)
    length = float(history.time[-1])
    force = (
        history.land_force.reshape(history.time.size, lands, -1).sum(axis=2) if lands else np.zeros((0, 0))
    )
    each = np.array([integral(history.time, force[:, i] * land_sliding(cage, history)) for i in range(lands)])
    even = np.full(lands, 1.0 / max(lands, 1))
    share = each / each.sum() if each.sum() > 0.0 else even
    land = history.land_rubbing * share
    pocket_power = cage.ball_cage_friction * history.pocket_rubbing / length
    land_power = cage.land_friction * land / length
    return Rubbing(
        pocket_sliding=history.pocket_rubbing,
        land_sliding=land,
        pocket_power=pocket_power,
        land_power=land_power,
        total_power=float(pocket_power.sum() + land_power.sum()),
    )
