"""Numbers of a cage as the kernels want them: lengths in metres, time in units, forces over the mass."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.cage.land import rebound_damping
from separatrix.cage.slots import BALLS
from separatrix.study import Guidance
from separatrix.units import Array, MetrePerSecond, Second

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage

ONSET = 1e-5
"""Depth at which a Hertz contact starts and ends, over that of an impact at the kick's speed: at zero depth
the force has no power series. The force there is 3e-8 of the impact's largest."""


class Coefficients(NamedTuple):
    """Numbers of one cage and one kick."""

    unit: float  # of time [s]
    inertia: float  # J / (M R^2)
    swiftness: float  # its inverse
    radius: float
    turning: float
    stiffness: float
    hertz: float  # 0: linear
    onset: float
    yielding: float  # 1 / C_mu
    friction: float  # sigma f over the cosine of the contact's tilt
    slowest: float  # speed whose rounding is of no interest
    gravity: float
    eccentricity: float
    land_side: float
    land_gap: float
    land_stiffness: float
    land_damping: float
    land_friction: float
    ring_slide: float
    roundness: float  # positive takes from the gap where the cosine is positive
    lobes: int
    lobe_rows: int
    harmonics: int
    driven: float  # bound on the free speed of any ball
    ramp_time: float
    ramp_start: float
    needs_rotation: bool
    needs_frame: bool
    gripped: bool  # no play: both sides of a pocket hold its ball
    fastest: float  # bound on the rate of the motion in contact


def coefficients(cage: PlanarCage, kick: MetrePerSecond) -> Coefficients:
    """Kernel's numbers of a cage."""
    T, M, R = time_unit(cage), cage.mass, cage.pitch_radius
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    tilt = cage.pocket_tilt[0]
    rotating = cage.unbalance != 0.0 or cage.land_out_of_round != 0.0
    K = 0.0 if cage.hertz_coefficient is None else cage.hertz_coefficient * tilt**2.5
    harmonics = len(cage.orbital_cosines)
    land_stiffness = cage.land_count * cage.land_stiffness
    damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(land_stiffness * M)
    sign = -1.0 if cage.guidance is Guidance.INNER and cage.land_lobes % 2 else 1.0
    return Coefficients(
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
        lobe_rows=BALLS + 2 * cage.ball_count,
        harmonics=harmonics,
        driven=float(np.sum(np.hypot(cage.orbital_cosines, cage.orbital_sines))) * T,
        ramp_time=cage.ramp_time / T,
        ramp_start=cage.ramp_start,
        needs_rotation=rotating,
        needs_frame=harmonics > 0 or cage.gravity > 0.0,
        gripped=cage.half_play == 0.0,
        fastest=fastest_rate(cage) * T,
    )


def as_record(p: Coefficients) -> np.void:
    """The same as a record, which kernels hand on by its address instead of copying 30 numbers."""
    kinds = {"float": np.float64, "int": np.int64, "bool": np.bool_}
    fields = [(name, kinds[kind.__forward_arg__]) for name, kind in Coefficients.__annotations__.items()]
    record: np.void = np.array([tuple(p)], dtype=fields)[0]
    return record


def free_speeds(cage: PlanarCage, angles: Array) -> Array:
    """Free speed of each ball as it goes round, by harmonics: cosines and sines, shape (2 harmonic, ball).

    In metres by the engine's unit of time.
    """
    rows = []
    for h, (a, b) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
        c, s = np.cos(h * angles), np.sin(h * angles)
        rows += [a * c + b * s, b * c - a * s]
    return np.array(rows).reshape(len(rows), angles.size) * time_unit(cage)


def series_columns(cage: PlanarCage) -> int:
    """Columns of the series of a step."""
    return BALLS + 2 * cage.ball_count + 2 * cage.land_lobes


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
