r"""The forces of a land on the cage and of a pocket on its ball: one-sided springs and dampers with friction.

A land is strips at their heights. At the height :math:`\zeta` of a strip the centre of the cage is at
:math:`e = r + \zeta(\tau_y, -\tau_x)`. With :math:`\delta = |e| - c_g + a \cos m\beta` (lobes of the cage's
land, which turn with it) the strip presses by :math:`P = K\delta + c\dot\delta` while both are positive, and
rubs along the sliding of the cage's surface on the ring's. Friction is in proportion to the sliding only
below the speed that it would stop within a step, where it would turn round otherwise.

Seen along the radius a pocket is a rectangle with half-lengths `apart` along the orbit and `beside` along the
axis, and its wall stands `around` outside it: a bore is (0, 0, c), a slot (c - c_a, 0, c_a), a square pocket
(c, c_z, 0); one that grips its ball is (0, ..., 0). The ball touches where it is more than `around` outside
the rectangle. A spherical pocket is a bore in which the way along the radius counts as well. Friction acts
along the true sliding.
"""

from __future__ import annotations

import math

from separatrix.cage.frame import turning
from separatrix.cage.rows import *
from separatrix.cage.rows import ONE, TINY, ZERO
from separatrix.ground.compiled import inlined


@inlined
def pocket_depth(along, across, outward, around, apart, beside):
    """Depth of the wall in its ball, and direction (axial, radial, along the orbit) in which it is pushed.

    `along`, `across`, `outward`: place of the pocket less that of its ball; the last is 0 unless spherical.
    """
    t = along - min(max(along, -apart), apart)
    z = across - min(max(across, -beside), beside)
    off = math.sqrt(t * t + z * z + outward * outward + TINY)
    per = -ONE / off
    return max(off - around, ZERO), per * z, per * outward, per * t


@inlined
def pocket_friction(limit, nz, nr, nt, lever, oz, o_r, ot, ball_speed, vz, vr, vt, pivot):
    """Friction on the wall (axial, radial, along the orbit), and the speed of the sliding.

    Along the sliding of the ball's surface, of spin (oz, o_r, ot), on the wall, of velocity (vz, vr, vt) at
    the point that touches; in proportion to it well below the pivoting speed, whose square is `pivot`
    (Contensou).
    """
    sz = lever * (o_r * nt - ot * nr) - vz
    sr = lever * (ot * nz - oz * nt) - vr
    st = ball_speed + lever * (oz * nr - o_r * nz) - vt
    sn = sz * nz + sr * nr + st * nt
    sz, sr, st = sz - sn * nz, sr - sn * nr, st - sn * nt
    slide = math.sqrt(sz * sz + sr * sr + st * st + pivot)
    share = limit / slide
    return share * sz, share * sr, share * st, slide


@inlined
def level_depth(along, play):
    """Depth of a wall that is met across the orbit, and in which sense along it the ball pushes it."""
    return max(abs(along) - play, ZERO), math.copysign(ONE, -along)


@inlined
def level_friction(limit, nt, lever, oz, o_r, vr, pivot):
    """Friction (axial, radial) of such a contact of a cage in the plane, and the speed of the sliding."""
    sz, sr = lever * o_r * nt, -lever * oz * nt - vr
    slide = math.sqrt(sz * sz + sr * sr + pivot)
    share = limit / slide
    return share * sz, share * sr, slide


@inlined
def land_forces(s, a, p, strips, lobe_number, space):
    """Add what every strip does to the cage; write the normal force and the heat of all of them."""
    for e in range(LX, LAND_HEAT + LANES):
        a[e] = ZERO
    for i in range(strips.shape[0]):
        strip = strips[i]
        if lobe_number > 0:
            lobes(a, strip, lobe_number, space)
        for l in range(LANES):
            height = strip[HEIGHT + l]
            x, y, vx, vy = a[GX + l], a[GY + l], a[GVX + l], a[GVY + l]
            vz, wa, wb = ZERO, ZERO, ZERO
            if space:
                wa, wb, vz = a[GWA + l], a[GWB + l], s[VZ + l]
                x, y = x + height * a[GB + l], y - height * a[GA + l]
                vx, vy = vx + height * wb, vy - height * wa
            r = math.sqrt(x * x + y * y + TINY)
            per = ONE / r
            nx, ny = per * x, per * y
            around, outward = nx * vy - ny * vx, nx * vx + ny * vy
            bump, tilted = p[LOBE + l] * a[LOBES_COSINE + l], p[LOBE_SLOPE + l] * a[LOBES_SINE + l]
            depth = r - p[LAND_GAP + l] + bump
            # d(cos m beta)/dt = -m sin(m beta) (around / r - turning)
            rate = outward - tilted * (per * around - s[VS + l] * p[PER_RADIUS + l])
            push = max(strip[STRIP_STIFFNESS + l] * depth + strip[STRIP_DAMPING + l] * rate, ZERO)
            push = push if depth > ZERO else ZERO
            lever = p[LAND_LEVER + l]
            slide_t = around + lever * s[VS + l] - p[RING_SLIDE + l] * s[RAMP + l]
            slide_z = vz - lever * p[RADIUS + l] * (nx * wb - ny * wa)
            stopped = p[LAND_STOPS + l] * push
            slide = math.sqrt(slide_t * slide_t + slide_z * slide_z + stopped * stopped + TINY)
            share = -p[LAND_FRICTION + l] * push / slide
            ft, fz, side = share * slide_t, share * slide_z, push * tilted * per
            fx, fy = -push * nx - (ft + side) * ny, (ft + side) * nx - push * ny
            turning = lever * ft - push * tilted * p[PER_RADIUS + l]
            a[LX + l] += fx
            a[LY + l] += fy
            a[LS + l] += turning
            rub = ft * around + fz * vz + lever * ft * s[VS + l]
            if space:
                arm = lever * p[RADIUS + l]
                rub -= arm * fz * (nx * wb - ny * wa)
                a[LZ + l] += fz
                a[LMX + l] += arm * fz * ny - height * fy
                a[LMY + l] += height * fx - arm * fz * nx
            a[LAND_RUB + l] += rub
            a[LAND_PRESS + l] -= push * rate
            a[LAND_N + l] += push
            a[LAND_HEAT + l] += push * slide


@inlined
def lobes(a, strip, number, space):
    """Cosine and sine of the lobes' angle: that of the contact against the cage, times their number."""
    for l in range(LANES):
        x, y = a[GX + l], a[GY + l]
        if space:
            x, y = x + strip[HEIGHT + l] * a[GB + l], y - strip[HEIGHT + l] * a[GA + l]
        per = ONE / math.sqrt(x * x + y * y + TINY)
        c, n = turning(a[TURN + l])
        a[LOBES_COSINE + l] = a[ONE_COSINE + l] = per * (x * c + y * n)
        a[LOBES_SINE + l] = a[ONE_SINE + l] = per * (y * c - x * n)
    for _ in range(number - 1):
        for l in range(LANES):
            c, n = a[LOBES_COSINE + l], a[LOBES_SINE + l]
            a[LOBES_COSINE + l] = c * a[ONE_COSINE + l] - n * a[ONE_SINE + l]
            a[LOBES_SINE + l] = n * a[ONE_COSINE + l] + c * a[ONE_SINE + l]
