"""Angles, loads, speeds and spin of solved balls, and Jones's criterion."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.equilibrium.continuation import solve_kinematics
from separatrix.chain.equilibrium.controlled import kinematic_start
from separatrix.chain.equilibrium.free import slip_coefficients
from separatrix.chain.equilibrium.groove import Touch, touch
from separatrix.chain.equilibrium.problem import Method, Problem
from separatrix.chain.equilibrium.race_control import inertia_loads
from separatrix.chain.equilibrium.ring import groove_vector
from separatrix.chain.hertz import elliptic_integrals
from separatrix.compiled import kernel
from separatrix.units import Array

COLUMNS = 21
"""Columns of `ball_table`, in the order that `solve.finished` reads."""


@kernel
def _grip(t: Touch) -> float:
    """Jones's measure of how well a race holds the spin of a ball, Q a E [N m]."""
    K, D, _ = elliptic_integrals(t.axis_ratio)
    E = K - (1.0 - t.axis_ratio) * (1.0 + t.axis_ratio) * D
    return float(t.major_coefficient * t.load ** (4.0 / 3.0) * E)


@kernel
def _speeds_at(p: Problem, side: float, t: Touch, state: Array) -> tuple[float, float]:
    """Spin/roll ratio [-] and mean rolling speed over the speed difference [m] of one contact."""
    c, n = np.empty(4), np.empty(2)
    slip_coefficients(p, side, t, state, c, n)
    D, ring = p.ball_diameter, 1.0 - state[2] if side < 0.0 else -state[2]
    ball_surface = 0.5 * D * (state[3] * n[1] - state[4] * n[0])
    ring_surface = 0.5 * ring * (p.pitch_diameter + D * n[1])
    return c[0] / c[1], 0.5 * abs(ball_surface + ring_surface)


@kernel
def _edge(p: Problem, angle: float, t: Touch) -> float:
    """Angle from the bottom of the groove to the far end of the ellipse on the ball; 0 without load."""
    if not t.load > 0.0:
        return 0.0
    half_width = t.major_coefficient * t.load ** (1.0 / 3.0)
    return abs(angle) + math.asin(min(2.0 * half_width / p.ball_diameter, 1.0))


@kernel
def _place(p: Problem, q: Array, azimuth: float, state: Array, A: Array) -> None:
    """Groove vector of a ball; one that floats at rest is put between the grooves at their first touch."""
    groove_vector(p, q, azimuth, A)
    touching = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    length = math.hypot(A[0], A[1])
    if p.inertia_factor == 0.0 and length < touching:
        A *= touching / length
        state[:2] = A * ((p.outer_conformity - 0.5) * p.ball_diameter / touching)


@kernel
def ball_table(p: Problem, q: Array, azimuths: Array, states: Array) -> Array:
    """One row a ball: angles, loads, orbit, spin, pitch, yaw, ratios, rolling speeds, inertia, control.

    Then whether each race is touched, and the edge of each contact: the angle from the bottom of the groove
    to the far end of the ellipse.
    """
    table, A = np.empty((azimuths.size, COLUMNS)), np.empty(2)
    for j in range(azimuths.size):
        row, s = table[j], states[j]
        _place(p, q, azimuths[j], s, A)
        i = touch(p, -1.0, A[0] - s[0], A[1] - s[1], 0.0)
        o = touch(p, 1.0, s[0], s[1], 0.0)
        row[0], row[1] = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
        row[2], row[3] = i.load, o.load
        row[4] = p.outer_speed + p.speed * s[2]
        row[5], row[6], row[7] = p.speed * s[3], p.speed * s[4], p.speed * s[5]
        forward = 1.0 if s[3] >= 0.0 else -1.0
        row[8] = math.atan2(-forward * s[4], math.hypot(s[3], s[5]))
        row[9] = math.atan2(forward * s[5], abs(s[3]))
        row[10], row[12] = _speeds_at(p, -1.0, i, s)
        row[11], row[13] = _speeds_at(p, 1.0, o, s)
        row[12] *= abs(p.speed)
        row[13] *= abs(p.speed)
        row[14], G = inertia_loads(p, s[2], math.hypot(s[4], s[5]))
        row[15] = abs(G)
        row[16] = _grip(o) * math.cos(row[0] - row[1]) - _grip(i)
        row[17], row[18] = 1.0 if i.load > 0.0 else 0.0, 1.0 if o.load > 0.0 else 0.0
        row[19], row[20] = _edge(p, row[0], i), _edge(p, row[1], o)
    return table


@kernel
def controlled_states(p: Problem, q: Array, azimuths: Array, states: Array) -> Array:
    """Complete V, shape (ball, 2 or more), with orbit and spin under race control, shape (ball, 6)."""
    full, A = np.empty((azimuths.size, 6)), np.empty(2)
    for j in range(azimuths.size):
        full[j, 0], full[j, 1] = states[j, 0], states[j, 1]
        _place(p, q, azimuths[j], full[j], A)
        kinematic_start(p, A, full[j])
    return full


@kernel
def settle_free_states(p: Problem, q: Array, azimuths: Array, states: Array, method: Method) -> int:
    """Bring orbit and spin of every ball to the free balance, V held; -1, or the first ball that fails."""
    A = np.empty(2)
    for j in range(azimuths.size):
        _place(p, q, azimuths[j], states[j], A)
        if not solve_kinematics(p, A, states[j], method):
            return j
    return -1
