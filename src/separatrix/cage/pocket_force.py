r"""The force of a pocket on its ball: a rounded rectangle, and friction along the true sliding.

Seen along the radius a pocket is a rectangle with half-lengths `apart` along the orbit and `beside` along the
axis, and its wall stands `around` outside it: a bore is (0, 0, c), a slot (c - c_a, 0, c_a), a square pocket
(c, c_z, 0); one that grips its ball is (0, ..., 0). The ball touches where it is more than `around` outside
the rectangle. A spherical pocket is a bore in which the way along the radius counts as well.
"""

from __future__ import annotations

import math

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
