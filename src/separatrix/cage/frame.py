r"""The frame that turns with the ball set, and where the geometric centre and axis of the cage are.

The state is that of the centre of mass and of the principal axis. Contacts act on the geometric ones, which
unbalance sets apart: the centre by :math:`\varepsilon`, the axis by the angle :math:`\delta`, both in a
direction fixed to the cage.

A fluid that moves with the cage is at rest in a frame that turns at its own mean speed: there its force is
:math:`-m_a \ddot z - c \dot z`, and here that with :math:`W` and :math:`\Omega - W` in place of the speeds.
"""

from __future__ import annotations

import numpy as np

from separatrix.cage.rows import *
from separatrix.ground.compiled import inlined

SIXTH, TWELFTH = np.float32(1 / 6), np.float32(1 / 12)


@inlined
def turning(angle):
    """Cosine and sine of the small angle of the cage against the ball set, to its fourth power."""
    square = angle * angle
    return ONE - HALF * square * (ONE - TWELFTH * square), angle * (ONE - SIXTH * square)


@inlined
def place(s, a, p, space):
    """Geometric centre and axis of the cage, and their rates."""
    for l in range(LANES):
        turn, rate = s[S + l] * p[PER_RADIUS + l], s[VS + l] * p[PER_RADIUS + l]
        c, n = turning(turn)
        e = p[ECCENTRICITY + l]
        a[TURN + l], a[PER_RAMP + l] = turn, ONE / s[RAMP + l]
        a[GX + l], a[GY + l] = s[X + l] - e * c, s[Y + l] - e * n
        a[GVX + l] = s[VX + l] + e * n * rate
        a[GVY + l] = s[VY + l] - e * c * rate
        if space:
            lean = p[LEAN + l]
            a[GA + l], a[GB + l] = s[TX + l] + lean * n, s[TY + l] - lean * c
            a[GWA + l] = s[WX + l] + lean * c * rate
            a[GWB + l] = s[WY + l] + lean * n * rate


@inlined
def cage_rates(s, d, a, p, space):
    """Rates of the cage from the forces of pockets and land in the turning frame; powers."""
    for l in range(LANES):
        x, y, vx, vy, vs = s[X + l], s[Y + l], s[VX + l], s[VY + l], s[VS + l]
        share, full = s[RAMP + l], p[ORBIT + l]
        rate = a[RAMP_NOW + l]
        om, rises, per_m = share * full, full * rate, p[PER_MASS + l]
        c, n = turning(a[TURN + l])
        pull = p[GRAVITY + l]
        ax = om * om * x + rises * y + pull * s[TURN_COSINE + l]
        ay = om * om * y - rises * x - pull * s[TURN_SINE + l]
        fx, fy = a[FX + l] + a[LX + l], a[FY + l] + a[LY + l]
        fs, radius = a[FS + l] + a[LS + l], p[RADIUS + l]
        fs += p[ECCENTRICITY + l] * p[PER_RADIUS + l] * (fx * n - fy * c)
        swirl, drag, lag = share * p[SWIRL + l], share * p[FLUID_DECAY + l], share * p[FLUID_LAG + l]
        pulled, turned = share * share * p[SWIRL_PULL + l], rate * p[SWIRL + l]
        ax += pulled * x - turned * y - drag * (vx - lag * y)
        ay += pulled * y + turned * x - drag * (vy + lag * x)
        given = p[MASS + l] * (ax * vx + ay * vy)
        spun_up = -rises * radius
        d[X + l], d[Y + l], d[S + l] = vx, vy, vs
        d[VX + l] = fx * per_m + TWO * (om - swirl) * vy + ax
        d[VY + l] = fy * per_m - TWO * (om - swirl) * vx + ay
        d[TURN_COSINE + l] = -om * s[TURN_SINE + l]
        d[TURN_SINE + l] = om * s[TURN_COSINE + l]
        d[RAMP + l] = rate
        d[POCKET_WORK + l], d[BALL_WORK + l] = a[RUB + l], a[DRIVE + l]
        d[LAND_WORK + l], d[LAND_PRESS_WORK + l] = a[LAND_RUB + l], a[LAND_PRESS + l]
        if space:
            mx, my = a[MX + l] + a[LMX + l], a[MY + l] + a[LMY + l]
            tx, ty, wx, wy = s[TX + l], s[TY + l], s[WX + l], s[WY + l]
            jt, jp, per_jt, vz = p[TRANSVERSE + l], p[POLAR + l], p[PER_TILTING + l], s[VZ + l]
            fs += p[LEAN + l] * p[PER_RADIUS + l] * (mx * c + my * n)
            whole = om + vs * p[PER_RADIUS + l]
            gyro, spun, rising = TWO * jt * om - jp * whole, (jp * whole - jt * om) * om, jt * rises
            d[Z + l], d[TX + l], d[TY + l] = vz, wx, wy
            d[VZ + l] = (
                a[FZ + l] * p[PER_AXIAL_MASS + l] + a[LZ + l] * p[PER_AXIAL_MASS + l] + p[AXIAL_GRAVITY + l]
            )
            d[WX + l] = (mx + gyro * wy - spun * tx + rising * ty) * per_jt
            d[WY + l] = (my - gyro * wx - spun * ty - rising * tx) * per_jt
            given += p[AXIAL_MASS + l] * p[AXIAL_GRAVITY + l] * vz
            given += rising * (ty * wx - tx * wy) - spun * (tx * wx + ty * wy)
        d[VS + l] = fs * p[PER_TURNING + l] + spun_up
        d[FRAME_WORK + l] = given + spun_up * vs / p[PER_TURNING + l]
