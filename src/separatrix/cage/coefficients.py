"""Numbers of a cage as the kernels want them, and the steps that its contacts ask for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.cage.land import rebound_damping
from separatrix.study import Guidance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, Second

STEPS_PER_RADIAN = 6.0
UNITS = 4
CALM_RADIANS = 17.0
LONGEST_FLIGHT = 1024


class Coefficients(NamedTuple):
    """Numbers of one cage as the kernel wants them; `dt` and what follows from it included."""

    unit: float
    mass: float
    inertia: float
    lightness: float  # 1 / mass
    swiftness: float  # 1 / inertia
    radius: float
    turning: float
    stiffness: float
    yielding: float  # 1 / C_mu
    half_play: float
    friction: float  # sigma f
    longest_flight: float
    calm_after: float  # units of lasting contact after which steps may be longer
    land_side: float
    land_gap: float
    land_stiffness: float
    land_damping: float
    land_friction: float
    ring_slide: float
    eccentricity: float
    gravity: float


def unit_step(cage: PlanarCage) -> Second:
    """Unit of time of which every step is a multiple: a quarter of the step with all balls in touch [s]."""
    return _step(_contact_rate(cage, cage.ball_count)) / UNITS


def step_counts(cage: PlanarCage, unit: Second) -> NDArray[np.int64]:
    """Units in a step, by the number of balls in touch, shape (ball + 1,).

    One more ball than touches at the start may touch within the step; the land may as well.
    """
    rates = [_contact_rate(cage, min(n + 1, cage.ball_count)) for n in range(cage.ball_count + 1)]
    return np.array([max(1, int(_step(rate) / unit * (1 + 1e-9))) for rate in rates])


def _step(rate_squared: float) -> Second:
    return 1.0 / (STEPS_PER_RADIAN * math.sqrt(rate_squared))


def _contact_rate(cage: PlanarCage, touching: int) -> float:
    """Bound on the squared rate of the fastest motion with this many balls in touch, and the land [1/s2]."""
    turning, k = cage.pitch_radius**2 / cage.moment_of_inertia, cage.ball_cage_stiffness
    few = touching * k * (turning + 1.0 / cage.mass)
    rate = min(few, cage.ball_count * k * max(turning, 0.5 / cage.mass))
    if cage.guidance is not Guidance.BALL:
        rate += cage.land_stiffness / cage.mass
    return rate


def _longest_flight(cage: PlanarCage, unit: Second) -> Second:
    """Longest step without touch: the frame turns by no more than a tenth of a radian in it [s]."""
    turning = 0.1 / abs(cage.cage_speed) if cage.cage_speed else math.inf
    return min(turning, LONGEST_FLIGHT * unit)


def coefficients(cage: PlanarCage, dt: Second) -> Coefficients:
    """Kernel's numbers of a cage at a step."""
    k, m = cage.ball_cage_stiffness, cage.mass
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    return Coefficients(
        unit=dt,
        mass=m,
        inertia=cage.moment_of_inertia,
        lightness=1.0 / m,
        swiftness=1.0 / cage.moment_of_inertia,
        radius=cage.pitch_radius,
        turning=cage.cage_speed,
        stiffness=k,
        yielding=1.0 / cage.race_damping,
        half_play=cage.half_play,
        friction=cage.friction_sense * cage.ball_cage_friction,
        longest_flight=_longest_flight(cage, dt),
        calm_after=CALM_RADIANS * STEPS_PER_RADIAN * UNITS,
        land_side=side,
        land_gap=cage.land_gap,
        land_stiffness=cage.land_stiffness,
        land_damping=2.0 * rebound_damping(cage.land_restitution) * math.sqrt(cage.land_stiffness * m),
        land_friction=cage.land_friction,
        ring_slide=(cage.guiding_ring_speed - cage.cage_speed) * cage.pitch_radius,
        eccentricity=cage.unbalance / m,
        gravity=cage.gravity,
    )


def ball_directions(count: int) -> tuple[Array, Array]:
    """Cosines and sines of the balls' angles, shape (ball,) each [-]."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return np.cos(angle), np.sin(angle)
