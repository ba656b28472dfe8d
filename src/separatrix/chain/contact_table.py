"""Both contacts of every ball in balance, as numbers: how it is pressed, held and heated."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.grooved_ball import (
    SMOOTHING,
    Problem,
    Touch,
    contact_friction,
    slip_coefficients,
    touches,
)
from separatrix.chain.hertz import elliptic_integrals
from separatrix.chain.slip_friction import NODES
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array


@part
def _heat(p: Problem, side: float, t: Touch, u: Array) -> float:
    """Heat of the friction of the whole slip field in one contact [W]."""
    if t.load <= 0.0:
        return 0.0
    r, c, normal = np.empty((5, 7)), np.empty(4), np.empty(2)
    contact_friction(p, side, t, t.load, u, SMOOTHING * 0.25 * p.pitch_diameter, NODES, r)
    slip_coefficients(p, side, t, u, c, normal)
    power = c[0] * r[0, 0] + c[1] * r[1, 0] + c[2] * r[2, 0] + c[3] * r[3, 0]
    return float(p.friction * t.load * abs(p.speed) * power)


@kernel
def contact_table(p: Problem, A: Array, u: Array) -> Array:
    """Angle, load, semi-major axis, grip, heat of friction of every ball at both races, (ball, race, 5).

    The grip is Jones's measure of how strongly a race controls the spin of a ball, Q a E [N m].
    """
    table = np.empty((A.shape[0], 2, 5))
    for j in range(A.shape[0]):
        i, o = touches(p, A[j], u[j])
        for race in range(2):
            side, t = (-1.0, i) if race == 0 else (1.0, o)
            K, D, _ = elliptic_integrals(t.axis_ratio)
            E = K - (1.0 - t.axis_ratio) * (1.0 + t.axis_ratio) * D
            a = t.major_coefficient * t.load ** (1.0 / 3.0)
            table[j, race, 0], table[j, race, 1] = math.atan2(t.sine, t.cosine), t.load
            table[j, race, 2], table[j, race, 3] = a, a * t.load * E
            table[j, race, 4] = _heat(p, side, t, u[j])
    return table
