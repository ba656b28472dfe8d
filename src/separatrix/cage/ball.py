r"""What its races do to a ball that its pocket pushes: at three levels, one function each.

- *damper*, the paper's: no inertia, :math:`\dot y = -F/C_\mu` (Eq. 18's sum).
- *one state*: :math:`m_e \dot u = -F - T(u)` with saturating traction :math:`T = C_f u / (1 +
  (u/v_f)^4)^{1/4}`.
- *free*: speed and three spins. Each race answers with traction, side force and pivoting moment of its whole
  slip
  field, in six strips across the groove. On a strip whose slip v is linear the mean of :math:`v/\sqrt{v^2 +
  w^2}` is exactly :math:`(v_0 + v_1)/(r_0 + r_1)`, :math:`r = \sqrt{v^2 + w^2}`: no table, no fit, no corner
  of Coulomb's law.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.cage.rows import *
from separatrix.ground.compiled import in_python_too, inlined

REST_SPEED, REST_PLACE, FLOOR, MOST = np.float32(1e-9), np.float32(1e-12), np.float32(1e-18), np.float32(1e18)
"""A ball's speed [m/s] and its place in the groove [m] decay to these, and squares to the next: numbers too
small to be normal are slow. The last keeps a fourth power finite."""

_EDGES = ((0.0, 1 / 3), (1 / 3, 2 / 3), (2 / 3, 1.0))
_SHARE = [0.75 * ((q - q**3 / 3) - (o - o**3 / 3)) for o, q in _EDGES]  # of the load (Hertz)
_ARM = [
    0.75 * ((q**2 / 2 - q**4 / 4) - (o**2 / 2 - o**4 / 4)) / w
    for (o, q), w in zip(_EDGES, _SHARE, strict=True)
]
E, F, E2, F2 = (
    np.float32(x) for x in (1 / 3, 2 / 3, 1 / 9, 4 / 9)
)  # edges of the strips over a: -1, -F, -E, 0, E, F, 1
W0, W1, W2 = (np.float32(x) for x in _SHARE)
A0, A1, A2 = (np.float32(x) for x in _ARM)  # middles of the strips, by load
D0, D1, D2 = (np.float32(1.0 - x * x) for x in _ARM)


@inlined
def traction(speed, slope, per_knee):
    """Traction of both races on a ball of one state, less its linear part `slope` times the speed."""
    x = speed * per_knee
    square = min(x * x, MOST) + FLOOR
    return slope * speed * (ONE / math.sqrt(math.sqrt(ONE + square * square)) - ONE)


@in_python_too
def edge_slips(slip, spin, side, heathcote, wide, creep):
    """Slip along the orbit at the edges of the six strips, -a to a; its root mean square with all else."""
    w2, x2 = side * side + creep, wide * spin * spin
    v0, v1, v2 = slip - spin - heathcote, slip - F * spin - F2 * heathcote, slip - E * spin - E2 * heathcote
    v3 = slip
    v6, v5, v4 = slip + spin - heathcote, slip + F * spin - F2 * heathcote, slip + E * spin - E2 * heathcote
    f2, e2 = w2 + x2 * (ONE - F2), w2 + x2 * (ONE - E2)
    r0, r1, r2 = math.sqrt(v0 * v0 + w2), math.sqrt(v1 * v1 + f2), math.sqrt(v2 * v2 + e2)
    r3 = math.sqrt(v3 * v3 + w2 + x2)
    r4, r5, r6 = math.sqrt(v4 * v4 + e2), math.sqrt(v5 * v5 + f2), math.sqrt(v6 * v6 + w2)
    return v0, v1, v2, v3, v4, v5, v6, r0, r1, r2, r3, r4, r5, r6


@inlined
def slip_field(slip, spin, side, heathcote, wide, creep):
    """Traction, pivoting moment over a, side force of a race; all over minus its friction times its load.

    At e = y/a the surface slides at slip + spin e - heathcote e^2 along the orbit and at `side` and, in the
    mean square over the length of the ellipse, wide spin^2 (1 - e^2) across; `creep` is the square of the
    elastic slip.
    """
    v0, v1, v2, v3, v4, v5, v6, r0, r1, r2, r3, r4, r5, r6 = edge_slips(
        slip, spin, side, heathcote, wide, creep
    )
    i0, i1, i2 = W2 / (r0 + r1), W1 / (r1 + r2), W0 / (r2 + r3)
    i3, i4, i5 = W0 / (r3 + r4), W1 / (r4 + r5), W2 / (r5 + r6)
    t0, t1, t2 = i0 * (v0 + v1), i1 * (v1 + v2), i2 * (v2 + v3)
    t3, t4, t5 = i3 * (v3 + v4), i4 * (v4 + v5), i5 * (v5 + v6)
    moment = A0 * (t3 - t2) + A1 * (t4 - t1) + A2 * (t5 - t0)
    moment += TWO * wide * spin * (D0 * (i2 + i3) + D1 * (i1 + i4) + D2 * (i0 + i5))
    return (t0 + t1) + (t2 + t3) + (t4 + t5), moment, TWO * side * ((i0 + i1) + (i2 + i3) + (i4 + i5))


@inlined
def slip_slopes(slip, spin, side, heathcote, wide, creep):
    """Slopes of `slip_field`: traction by slip and spin, moment over a by both, side force by side slip.

    Without what the spin's slip across adds, and that of the side force by the others.
    """
    v0, v1, v2, v3, v4, v5, v6, r0, r1, r2, r3, r4, r5, r6 = edge_slips(
        slip, spin, side, heathcote, wide, creep
    )
    g0, g1, g2, g3, g4, g5, g6 = ONE / r0, ONE / r1, ONE / r2, ONE / r3, ONE / r4, ONE / r5, ONE / r6
    c0, c1, c2, c3, c4, c5, c6 = v0 * g0, v1 * g1, v2 * g2, v3 * g3, v4 * g4, v5 * g5, v6 * g6
    a0, a1, a2 = ONE / (r0 + r1), ONE / (r1 + r2), ONE / (r2 + r3)
    a3, a4, a5 = ONE / (r3 + r4), ONE / (r4 + r5), ONE / (r5 + r6)
    q0, q1, q2, q3 = a0 * (v0 + v1), a1 * (v1 + v2), a2 * (v2 + v3), a3 * (v3 + v4)
    q4, q5 = a4 * (v4 + v5), a5 * (v5 + v6)
    i0, i1, i2, i3, i4, i5 = W2 * a0, W1 * a1, W0 * a2, W0 * a3, W1 * a4, W2 * a5
    s0, s1, s2 = i0 * (TWO - q0 * (c0 + c1)), i1 * (TWO - q1 * (c1 + c2)), i2 * (TWO - q2 * (c2 + c3))
    s3, s4, s5 = i3 * (TWO - q3 * (c3 + c4)), i4 * (TWO - q4 * (c4 + c5)), i5 * (TWO - q5 * (c5 + c6))
    p0, p1 = i0 * (q0 * (c0 + F * c1) - ONE - F), i1 * (q1 * (F * c1 + E * c2) - F - E)
    p2, p3 = i2 * E * (q2 * c2 - ONE), i3 * E * (ONE - q3 * c4)
    p4, p5 = i4 * (F + E - q4 * (E * c4 + F * c5)), i5 * (ONE + F - q5 * (F * c5 + c6))
    mixed = A0 * (s3 - s2) + A1 * (s4 - s1) + A2 * (s5 - s0)
    moment = A0 * (p3 - p2) + A1 * (p4 - p1) + A2 * (p5 - p0)
    moment += TWO * wide * (D0 * (i2 + i3) + D1 * (i1 + i4) + D2 * (i0 + i5))
    sides = side * side
    n0, n1 = i0 * (ONE - sides * a0 * (g0 + g1)), i1 * (ONE - sides * a1 * (g1 + g2))
    n2, n3 = i2 * (ONE - sides * a2 * (g2 + g3)), i3 * (ONE - sides * a3 * (g3 + g4))
    n4, n5 = i4 * (ONE - sides * a4 * (g4 + g5)), i5 * (ONE - sides * a5 * (g5 + g6))
    traction, across = (s0 + s1) + (s2 + s3) + (s4 + s5), (n0 + n1) + (n2 + n3) + (n4 + n5)
    return traction, (p0 + p1) + (p2 + p3) + (p4 + p5), mixed, moment, TWO * across


@in_python_too
def race_slips(p, row, l, speed, turn, o_r, lever):
    """Normal, friction times load and a of a race; slip and spin of a ball there; what else its field has."""
    nz, nr, held, a = p[row + l], p[row + LANES + l], p[row + 2 * LANES + l], p[row + 3 * LANES + l]
    slip, spin, heathcote = p[row + 4 * LANES + l], p[row + 5 * LANES + l], p[row + 6 * LANES + l]
    wide, creep = p[row + 7 * LANES + l], p[row + 8 * LANES + l]
    slip, spin = slip + speed + lever * (turn * nr - o_r * nz), spin + a * (turn * nz + o_r * nr)
    return nz, nr, held, a, slip, spin, heathcote, wide, creep


@inlined
def race_force(p, row, l, speed, turn, o_r, side, lever):
    """Force of a race on a free ball along the orbit, and its couple (z, r, t), less free rolling's."""
    nz, nr, held, a, slip, spin, heathcote, wide, creep = race_slips(p, row, l, speed, turn, o_r, lever)
    t, m, n = slip_field(slip, spin, side, heathcote, wide, creep)
    t, m = held * (p[row + 9 * LANES + l] - t), held * a * (p[row + 10 * LANES + l] - m)
    n = held * (p[row + 11 * LANES + l] - n)
    return t, m * nz + lever * t * nr, m * nr - lever * t * nz, lever * n


@inlined
def race_slopes(p, row, l, speed, turn, o_r, side, lever):
    """Slopes of `race_force`, sign turned: of force, couples z, r by speed, turn, o_r; of t by its spin."""
    nz, nr, held, a, slip, spin, heathcote, wide, creep = race_slips(p, row, l, speed, turn, o_r, lever)
    ts, tp, ms, mp, across = slip_slopes(slip, spin, side, heathcote, wide, creep)
    by_z, by_r, kept = lever * nr, lever * nz, held * a  # slip by turn, and by minus o_r
    tz, tr = ts * by_z + tp * a * nz, tp * a * nr - ts * by_r
    mz, mr = kept * (ms * by_z + mp * a * nz), kept * (mp * a * nr - ms * by_r)
    ts, tz, tr, ms = held * ts, held * tz, held * tr, kept * ms
    zs, zz, zr = ms * nz + by_z * ts, mz * nz + by_z * tz, mr * nz + by_z * tr
    rs, rz, rr = ms * nr - by_r * ts, mz * nr - by_r * tz, mr * nr - by_r * tr
    return ts, tz, tr, zs, zz, zr, rs, rz, rr, held * lever * lever * across
