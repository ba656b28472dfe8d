r"""The frame that turns with the ball set: where the cage's centre and axis are, and what the frame does to them.

The state is that of the centre of mass and of the principal axis. Contacts act on the geometric ones, which unbalance
sets apart: the centre by :math:`\varepsilon`, the axis by the angle :math:`\delta`, both in a direction fixed to the cage.
"""

from __future__ import annotations

from separatrix.cage.rows import *  # noqa: F403
from separatrix.compiled import inlined

SIXTH, TWELFTH = np.float32(1 / 6), np.float32(1 / 12)


@inlined
def turning(angle):
    """Cosine and sine of the small angle by which the cage has turned against the ball set, to its fourth power."""
    square = angle * angle
    return ONE - HALF * square * (ONE - TWELFTH * square), angle * (ONE - SIXTH * square)


@inlined
def place(s, a, p, space):
    """Geometric centre and axis of the cage, and their rates."""
    for l in range(LANES):
        turn, rate = s[S * LANES + l] * p[PER_RADIUS * LANES + l], s[VS * LANES + l] * p[PER_RADIUS * LANES + l]
        c, n = turning(turn)
        e = p[ECCENTRICITY * LANES + l]
        a[TURN * LANES + l] = turn
        a[GX * LANES + l], a[GY * LANES + l] = s[X * LANES + l] - e * c, s[Y * LANES + l] - e * n
        a[GVX * LANES + l] = s[VX * LANES + l] + e * n * rate
        a[GVY * LANES + l] = s[VY * LANES + l] - e * c * rate
        if space:
            lean = p[LEAN * LANES + l]
            a[GA * LANES + l], a[GB * LANES + l] = s[TX * LANES + l] + lean * n, s[TY * LANES + l] - lean * c
            a[GWA * LANES + l] = s[WX * LANES + l] + lean * c * rate
            a[GWB * LANES + l] = s[WY * LANES + l] + lean * n * rate


@inlined
def cage_rates(s, d, a, p, space):
    """Rates of the cage from the forces of pockets and land in the turning frame; powers."""
    for l in range(LANES):
        x, y, vx, vy, vs = s[X * LANES + l], s[Y * LANES + l], s[VX * LANES + l], s[VY * LANES + l], s[VS * LANES + l]
        share, full = s[RAMP * LANES + l], p[ORBIT * LANES + l]
        om, rises, per_m = share * full, full * p[RAMP_RATE * LANES + l], p[PER_MASS * LANES + l]
        c, n = turning(a[TURN * LANES + l])
        pull = p[GRAVITY * LANES + l]
        ax = om * om * x + rises * y + pull * s[TURN_COSINE * LANES + l]
        ay = om * om * y - rises * x - pull * s[TURN_SINE * LANES + l]
        fx, fy = a[FX * LANES + l] + a[LX * LANES + l], a[FY * LANES + l] + a[LY * LANES + l]
        fs, radius = a[FS * LANES + l] + a[LS * LANES + l], p[RADIUS * LANES + l]
        fs += p[ECCENTRICITY * LANES + l] * p[PER_RADIUS * LANES + l] * (fx * n - fy * c)
        given = p[MASS * LANES + l] * (ax * vx + ay * vy)
        spun_up = -rises * radius
        d[X * LANES + l], d[Y * LANES + l], d[S * LANES + l] = vx, vy, vs
        d[VX * LANES + l] = fx * per_m + TWO * om * vy + ax
        d[VY * LANES + l] = fy * per_m - TWO * om * vx + ay
        d[TURN_COSINE * LANES + l] = -om * s[TURN_SINE * LANES + l]
        d[TURN_SINE * LANES + l] = om * s[TURN_COSINE * LANES + l]
        d[RAMP * LANES + l] = p[RAMP_RATE * LANES + l]
        d[POCKET_WORK * LANES + l], d[BALL_WORK * LANES + l] = a[RUB * LANES + l], a[DRIVE * LANES + l]
        d[LAND_WORK * LANES + l], d[LAND_PRESS_WORK * LANES + l] = a[LAND_RUB * LANES + l], a[LAND_PRESS * LANES + l]
        if space:
            mx, my = a[MX * LANES + l] + a[LMX * LANES + l], a[MY * LANES + l] + a[LMY * LANES + l]
            tx, ty, wx, wy = s[TX * LANES + l], s[TY * LANES + l], s[WX * LANES + l], s[WY * LANES + l]
            jt, jp, per_jt, vz = p[TRANSVERSE * LANES + l], p[POLAR * LANES + l], p[PER_TILTING * LANES + l], s[VZ * LANES + l]
            fs += p[LEAN * LANES + l] * p[PER_RADIUS * LANES + l] * (mx * c + my * n)
            whole = om + vs * p[PER_RADIUS * LANES + l]
            gyro, spun, rising = TWO * jt * om - jp * whole, (jp * whole - jt * om) * om, jt * rises
            d[Z * LANES + l], d[TX * LANES + l], d[TY * LANES + l] = vz, wx, wy
            d[VZ * LANES + l] = a[FZ * LANES + l] * p[PER_AXIAL_MASS * LANES + l] + a[LZ * LANES + l] * p[PER_AXIAL_MASS * LANES + l] + p[AXIAL_GRAVITY * LANES + l]
            d[WX * LANES + l] = (mx + gyro * wy - spun * tx + rising * ty) * per_jt
            d[WY * LANES + l] = (my - gyro * wx - spun * ty - rising * tx) * per_jt
            given += p[AXIAL_MASS * LANES + l] * p[AXIAL_GRAVITY * LANES + l] * vz
            given += rising * (ty * wx - tx * wy) - spun * (tx * wx + ty * wy)
        d[VS * LANES + l] = fs * p[PER_TURNING * LANES + l] + spun_up
        d[FRAME_WORK * LANES + l] = given + spun_up * vs / p[PER_TURNING * LANES + l]
