"""Numbers of a cage as the kernels want them: lengths in metres, time in units, forces over the mass."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from separatrix.cage.records import POWERS, Balls, dtype_of
from separatrix.study import Guidance
from separatrix.units import MetrePerSecond, Ratio, Second

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage

ONSET = 1e-5
"""Depth at which a Hertz contact starts and ends, over that of an impact at the kick's speed: at zero depth
the force has no power series. The force there is 3e-8 of the impact's largest."""

LOWEST_RESTITUTION = 1e-4


class Coefficients(NamedTuple):
    """Numbers of one cage and one kick."""

    unit: float  # of time [s]
    inertia: float  # J / (M R^2)
    swiftness: float  # its inverse
    radius: float  # R
    turning: float  # Omega
    stiffness: float  # k of a linear pocket
    hertz: float  # K of a Hertz pocket; 0: linear
    onset: float
    yielding: float  # 1 / C_mu
    friction: float  # sigma f over the cosine of the contact's tilt
    slowest: float  # speed whose rounding is of no interest
    gravity: float
    eccentricity: float  # of the centre of mass
    land_side: float  # q: 1 outer, -1 inner, 0 without a land
    land_gap: float  # c_g
    land_stiffness: float  # K of the land
    land_damping: float  # c of the land
    land_friction: float  # mu
    ring_slide: float  # (omega_ring - Omega) R
    roundness: float  # positive takes from the gap where the cosine is positive
    lobes: int
    harmonics: int
    driven: float  # bound on the free speed of any ball
    ramp_time: float
    ramp_start: float
    needs_rotation: bool
    needs_frame: bool
    gripped: bool  # no clearance: both sides of a pocket hold its ball
    fastest: float  # bound on the rate of the motion in contact


def coefficients(cage: PlanarCage, kick: MetrePerSecond) -> Coefficients:
    """Numbers of a cage as a record, which kernels hand on by its address instead of copying 29 numbers."""
    T, M, R = time_unit(cage), cage.mass, cage.pitch_radius
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    tilt = cage.pocket_tilt[0]
    K = 0.0 if cage.hertz_coefficient is None else cage.hertz_coefficient * tilt**2.5
    harmonics = len(cage.orbital_cosines)
    land_stiffness = cage.land_count * cage.land_stiffness
    damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(land_stiffness * M)
    sign = -1.0 if cage.guidance is Guidance.INNER and cage.land_lobes % 2 else 1.0
    numbers = Coefficients(
        unit=T,
        inertia=cage.moment_of_inertia / (M * R * R),
        swiftness=M * R * R / cage.moment_of_inertia,
        radius=R,
        turning=cage.cage_speed * T,
        stiffness=cage.ball_cage_stiffness * tilt**2 * T * T / M,
        hertz=K * T * T / M,
        onset=ONSET * (1.25 * M * kick**2 / K) ** 0.4 if K > 0.0 else 0.0,
        yielding=M / (cage.race_damping * T),
        friction=cage.friction_sense * cage.ball_cage_friction / tilt,
        slowest=1e-2 * kick * T,
        gravity=cage.gravity * T * T,
        eccentricity=cage.unbalance / M,
        land_side=side,
        land_gap=cage.land_gap,
        land_stiffness=land_stiffness * T * T / M,
        land_damping=damping * T / M,
        land_friction=cage.land_friction,
        ring_slide=(cage.guiding_ring_speed - cage.cage_speed) * R * T,
        roundness=sign * cage.land_out_of_round,
        lobes=cage.land_lobes,
        harmonics=harmonics,
        driven=float(np.sum(np.hypot(cage.orbital_cosines, cage.orbital_sines))) * T,
        ramp_time=cage.ramp_time / T,
        ramp_start=cage.ramp_start,
        needs_rotation=cage.unbalance != 0.0 or cage.land_out_of_round != 0.0,
        needs_frame=harmonics > 0 or cage.gravity > 0.0,
        gripped=cage.half_play == 0.0,
        fastest=fastest_rate(cage) * T,
    )
    return cast("Coefficients", np.array([tuple(numbers)], dtype_of(Coefficients))[0])


def balls_of(cage: PlanarCage) -> Balls:
    """Room for the balls of a cage, with their free speed as they go round, in metres by the unit of time."""
    angles, count, waves = np.array(cage.ball_angles), cage.ball_count, []
    for h, (a, b) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
        c, s = np.cos(h * angles), np.sin(h * angles)
        waves += [a * c + b * s, b * c - a * s]
    drive = np.array(waves).reshape(len(waves), count) * time_unit(cage)
    numbers, whole, powers = np.zeros((5, count)), np.zeros((2, count), np.int64), np.zeros((2, POWERS, count))
    return Balls(*numbers, drive, *whole, *powers)


def time_unit(cage: PlanarCage) -> Second:
    """Unit of time: a radian of the motion with one ball in touch [s]."""
    R, J = cage.pitch_radius, cage.moment_of_inertia
    return 1.0 / math.sqrt(cage.ball_cage_stiffness * (1.0 / cage.mass + R * R / J))


def fastest_rate(cage: PlanarCage) -> float:
    """Bound on the rates of any motion in contact [1/s]."""
    turning, k, Z = cage.pitch_radius**2 / cage.moment_of_inertia, cage.ball_cage_stiffness, cage.ball_count
    squared = Z * k * (turning + 1.0 / cage.mass)
    rate = 1.0 / cage.race_damping * k
    if cage.guidance is not Guidance.BALL:
        K = cage.land_count * cage.land_stiffness
        squared += K / cage.mass
        rate += 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(K / cage.mass)
    return math.sqrt(squared) + rate + abs(cage.cage_speed)


def rebound(damping_ratio: Ratio) -> Ratio:
    r"""Restitution of a mass on a spring and a parallel damper that can push but not pull [-].

    The impact ends when the force is back at zero, before the spring is. With :math:`\beta = \zeta\omega` and
    :math:`\Omega = \omega\sqrt{|1-\zeta^2|}` (Schwager and Poeschel 2007, with their :math:`\omega_0` as unit
    of time).
    """
    zeta = damping_ratio
    if zeta == 0.0:
        return 1.0
    if zeta < 1.0:
        root = math.sqrt(1.0 - zeta * zeta)
        turned = math.atan2(2.0 * zeta * root, 2.0 * zeta * zeta - 1.0)
        return math.exp(-zeta / root * turned)
    if zeta == 1.0:
        return math.exp(-2.0)
    root = math.sqrt(zeta * zeta - 1.0)
    return math.exp(-zeta / root * 2.0 * math.log(zeta + root))


@lru_cache(maxsize=64)
def rebound_damping(restitution: Ratio) -> Ratio:
    """Damping ratio of the land whose `rebound` is this [-]; below 1e-4 that of 1e-4, close to 0."""
    if restitution >= 1.0:
        return 0.0
    target = max(restitution, LOWEST_RESTITUTION)
    low, high = 0.0, 100.0
    while low < (middle := 0.5 * (low + high)) < high:  # down to neighbouring numbers
        low, high = (middle, high) if rebound(middle) > target else (low, middle)
    return low
