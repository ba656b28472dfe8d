r"""The lands that guide a cage in space, as power series: strips at their heights, each a spring and damper.

At the height :math:`\zeta` the centre is at :math:`r + \zeta k_\perp`, with :math:`k_\perp = (\tau_y,
-\tau_x)`. A strip presses by :math:`P = K\delta + c\dot\delta` while that is positive, and rubs against the
sliding of the surface of the cage on that of the ring, around the axis and along it; below the pivoting speed
in proportion to it. To first order in the tilt: at 10 mrad a gap is off by 2 um.
"""

from __future__ import annotations

import math

from separatrix.cage.records import Pace
from separatrix.cage.space.records import (
    AROUND,
    BESIDE,
    DEPTH_L,
    FAR_L,
    GA,
    GB,
    GX,
    GY,
    LX,
    LY,
    NX,
    NY,
    PUSH_L,
    RUB_T,
    RUB_Z,
    SHARE_L,
    SLIDE_L,
    VS,
    VZ,
    Numbers,
    Parts,
)
from separatrix.compiled import inlined_kernel, inner_kernel


@inlined_kernel
def place_strip(parts: Parts, i: int, n: int) -> None:
    """Coefficient n of the centre at the height of a strip."""
    cage, strip = parts.cage, parts.strip[i]
    strip[n, LX] = cage[n, GX] + parts.height[i] * cage[n, GB]
    strip[n, LY] = cage[n, GY] - parts.height[i] * cage[n, GA]


@inner_kernel
def dent_strip(p: Numbers, parts: Parts, i: int, n: int) -> None:
    """Coefficient n of the distance of the centre at a strip, its direction and the depth in the land."""
    place_strip(parts, i, n)
    strip = parts.strip[i]
    if n == 0:
        far = math.sqrt(strip[0, LX] ** 2 + strip[0, LY] ** 2)
        strip[0, FAR_L], strip[0, NX], strip[0, NY] = far, strip[0, LX] / far, strip[0, LY] / far
        strip[0, DEPTH_L] = far - p.land_gap
        return
    along, across = strip[n, LX], strip[n, LY]
    square, per = strip[0, LX] * along + strip[0, LY] * across, 1.0 / strip[0, FAR_L]
    xx = yy = ff = back_x = back_y = 0.0
    for m in range(1, n):
        k = n - m
        xx += strip[m, LX] * strip[k, LX]
        yy += strip[m, LY] * strip[k, LY]
        ff += strip[m, FAR_L] * strip[k, FAR_L]
        back_x += strip[m, FAR_L] * strip[k, NX]
        back_y += strip[m, FAR_L] * strip[k, NY]
    far = (square + 0.5 * (xx + yy - ff)) * per
    strip[n, NX] = (along - back_x - far * strip[0, NX]) * per
    strip[n, NY] = (across - back_y - far * strip[0, NY]) * per
    strip[n, FAR_L] = strip[n, DEPTH_L] = far


@inlined_kernel
def press_strip(p: Numbers, parts: Parts, i: int, now: Pace, n: int) -> None:
    """Coefficient n of a strip's force and friction; its place is known up to n + 1."""
    cage, strip = parts.cage, parts.strip[i]
    strip[n, PUSH_L] = parts.strip_stiffness[i] * strip[n, DEPTH_L]
    strip[n, PUSH_L] += parts.strip_damping[i] * (n + 1) * strip[n + 1, DEPTH_L]
    # v_t = n_x dy/dt - n_y dx/dt + q l ds/dt - slide, v_z = dz/dt - q l (n_x db/dt - n_y da/dt), l = R_L/R
    around, beside = p.land_lever * cage[n, VS], cage[n, VZ]
    if n < 2:
        around -= p.ring_slide * now[n]
    for m in range(n + 1):
        k = n - m + 1
        around += k * (strip[m, NX] * strip[k, LY] - strip[m, NY] * strip[k, LX])
        beside -= p.land_lever * k * (strip[m, NX] * cage[k, GB] - strip[m, NY] * cage[k, GA])
    strip[n, AROUND], strip[n, BESIDE] = around, beside
    if n == 0:
        strip[0, SLIDE_L] = math.sqrt(around * around + beside * beside + p.pivoting)
        share = strip[0, SHARE_L] = p.land_friction * strip[0, PUSH_L] / strip[0, SLIDE_L]
        strip[0, RUB_T], strip[0, RUB_Z] = -share * around, -share * beside
        return
    aa = bb = vv = lag = tangent = axial = 0.0
    for m in range(1, n):
        k = n - m
        aa += strip[m, AROUND] * strip[k, AROUND]
        bb += strip[m, BESIDE] * strip[k, BESIDE]
        vv += strip[m, SLIDE_L] * strip[k, SLIDE_L]
        lag += strip[m, SLIDE_L] * strip[k, SHARE_L]
        tangent -= strip[m, SHARE_L] * strip[k, AROUND]
        axial -= strip[m, SHARE_L] * strip[k, BESIDE]
    first, per = strip[0, AROUND] * around + strip[0, BESIDE] * beside, 1.0 / strip[0, SLIDE_L]
    size = (first + 0.5 * (aa + bb - vv)) * per
    share = (p.land_friction * strip[n, PUSH_L] - lag - size * strip[0, SHARE_L]) * per
    strip[n, SLIDE_L], strip[n, SHARE_L] = size, share
    strip[n, RUB_T] = tangent - strip[0, SHARE_L] * around - share * strip[0, AROUND]
    strip[n, RUB_Z] = axial - strip[0, SHARE_L] * beside - share * strip[0, BESIDE]


@inlined_kernel
def strip_forces(p: Numbers, parts: Parts, i: int, n: int) -> tuple[float, float, float, float, float, float]:
    """Coefficient n of a strip's force on the cage (x, y, z), and its moments about z, x and y over R."""
    # F = -P n + F_t t, t = (-n_y, n_x); moments: q l F_t, height e_z x F - q l F_z t
    strip, side = parts.strip[i], p.land_lever
    fx = fy = mx = my = 0.0
    for m in range(n + 1):
        nx, ny = strip[n - m, NX], strip[n - m, NY]
        push, rub, axial = strip[m, PUSH_L], strip[m, RUB_T], strip[m, RUB_Z]
        fx -= push * nx + rub * ny
        fy += rub * nx - push * ny
        mx += axial * ny
        my -= axial * nx
    h = parts.height[i]
    return fx, fy, strip[n, RUB_Z], side * strip[n, RUB_T], side * mx - h * fy, side * my + h * fx
