"""Numbers of one cage and one kick, as the kernels want them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

import numpy as np

from separatrix.ball_traction import MOST_ELEMENTS
from separatrix.cage.closed_forms import fastest_rate, rebound_damping, time_unit
from separatrix.cage.features import is_plain
from separatrix.cage.records import BENT, LANES, POWERS, WAVES, Balls, Coefficients, dtype_of, plain_dtype
from separatrix.study import Guidance

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, MetrePerSecond

ONSET = 1e-5
"""Depth at which a Hertz contact starts and ends, over that of an impact at the kick's speed: at zero depth
the force has no power series. The force there is 3e-8 of the impact's largest."""

SLOWEST = 1e-2
"""Speed whose rounding is of no interest, over the kick's."""

COAST_END = 2.0**-34
"""Speed below which a ball that coasts is put at the end of its way, over `SLOWEST`: what a step may leave of
its speed by the last terms of the series. Unbounded decay would end in denormal numbers."""


def coefficients(cage: PlanarCage, kick: MetrePerSecond) -> Coefficients:
    """Numbers of a cage as a record, which kernels pass on by its address; of a plain cage with `PLAIN`."""
    T, M, R = time_unit(cage), cage.mass, cage.pitch_radius
    side = {Guidance.OUTER: 1.0, Guidance.INNER: -1.0, Guidance.BALL: 0.0}[cage.guidance]
    tilt = cage.pocket_tilt[0]
    K = 0.0 if cage.hertz_coefficient is None else cage.hertz_coefficient * tilt**2.5
    harmonics = len(cage.orbital_cosines)
    land_stiffness = cage.land_count * cage.land_stiffness
    damping = 2.0 * rebound_damping(cage.land_restitution) * math.sqrt(land_stiffness * M)
    sign = -1.0 if cage.guidance is Guidance.INNER and cage.land_lobes % 2 else 1.0
    damper, slopes, bends = law_numbers(cage)
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
        slowest=SLOWEST * kick * T,
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
        own=K > 0.0 or cage.traction is not None,
        inertial=cage.traction is not None,
        lightness=0.0 if cage.traction is None else M / cage.traction.mass,
        damper=damper,
        elements=len(slopes),
        sharp=cage.traction is not None and cage.traction.sharpness == 4,
        power=1.0 / (2 if cage.traction is None else cage.traction.sharpness),
        slopes=_padded(slopes),
        bends=_padded(bends),
        coast_end=COAST_END * SLOWEST * kick * T,
        coast_time=1.0 / (damper + sum(slopes)) if cage.traction is not None else 0.0,
    )
    if is_plain(numbers):
        return cast("Coefficients", np.array([(*numbers, True)], plain_dtype())[0])
    return cast("Coefficients", np.array([tuple(numbers)], dtype_of(Coefficients))[0])


def balls_of(cage: PlanarCage) -> Balls:
    """Room for the balls of a cage, with their free speed as they go round, in metres by the unit of time."""
    angles, count, waves = np.array(cage.ball_angles), cage.ball_count, []
    for h, (a, b) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
        c, s = np.cos(h * angles), np.sin(h * angles)
        waves += [a * c + b * s, b * c - a * s]
    drive = np.array(waves).reshape(len(waves), count) * time_unit(cage)
    cosine, sine, play, lead, penetration = np.zeros((5, count))
    side, touching = np.zeros((2, count), np.int64)
    depth, force = np.zeros((2, POWERS, count))
    coasting, slot = np.zeros((2, count), np.int64)
    moving = np.zeros((-(-count // LANES), BENT + MOST_ELEMENTS, POWERS, LANES))
    common = (cosine, sine, play, lead, penetration, drive, side, touching, depth, force)
    return Balls(*common, np.zeros(count), coasting, slot, moving)


def law_numbers(cage: PlanarCage) -> tuple[float, list[float], list[float]]:
    """Sum of C_i / m_e of the dampers; C_i / m_e and 1 / v_i^n of the elements that saturate."""
    if cage.traction is None:
        return 0.0, [], []
    T, law = time_unit(cage), cage.traction
    pairs = [(C * T / law.mass, v * T) for C, v in zip(law.slopes, law.speeds, strict=True)]
    bent = [(C, 1.0 / v**law.sharpness) for C, v in pairs if v < math.inf]
    return sum(C for C, v in pairs if v == math.inf), [C for C, _ in bent], [b for _, b in bent]


def _padded(values: list[float]) -> Array:
    """Numbers as a field of a record of the kernels."""
    return np.array(values + [0.0] * (WAVES - len(values)))
