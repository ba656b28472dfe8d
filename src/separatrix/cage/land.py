r"""The land that guides a cage: a one-sided spring and damper with dry friction, as power series.

With n the direction of the centre, :math:`r = |r|\,n`, and t across it:
:math:`\delta = |r| - c_g + a\cos m\beta`, :math:`P = K\delta + c\,\dot\delta`,
:math:`v_s = \dot r\cdot t + q\,[R\dot\theta - (\omega_\text{ring} - \Omega) R]`. The lobes, of amplitude a
and number m, turn with the cage: :math:`\beta` is the angle of n against it.
"""

from __future__ import annotations

import math

from separatrix.cage.events import (
    LAND_CLEAR,
    LAND_LEAVE,
    LAND_PRESS,
    LAND_TOUCH,
    SLIDE_START,
    SLIDE_STOP,
)
from separatrix.cage.features import is_out_of_round
from separatrix.cage.records import CLEAR, FORWARD, ORDER, RELEASED, STICK, Coefficients, Pace, Room, Series
from separatrix.cage.series import THIRD, Knots, centre, copy_column, first_zero, larger, product
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inner_kernel
def land_geometry(p: Coefficients, w: Series, lobes: Array, n: int) -> None:
    """Coefficient n of the centre's distance, its direction and the depth in the land."""
    gx, gy = centre(p, w)
    if n == 0:
        w[0].distance = math.sqrt(gx[0] * gx[0] + gy[0] * gy[0])
        w[0].nx, w[0].ny = gx[0] / w[0].distance, gy[0] / w[0].distance
    else:
        # |r|^2 = x^2 + y^2, whence 2 |r|_0 |r|_n = (x^2 + y^2)_n - sum_(0<i<n) |r|_i |r|_(n-i)
        square = product(gx, gx, n) + product(gy, gy, n)
        for i in range(1, n):
            square -= w[i].distance * w[n - i].distance
        w[n].distance = square / (2.0 * w[0].distance)
        # r = |r| n, whence |r|_0 n_n = r_n - sum_(i>0) |r|_i n_(n-i)
        along, across = gx[n], gy[n]
        for i in range(1, n + 1):
            along -= w[i].distance * w[n - i].nx
            across -= w[i].distance * w[n - i].ny
        w[n].nx, w[n].ny = along / w[0].distance, across / w[0].distance
    # delta = |r| - c_g + a cos(m beta)
    w[n].depth = w[n].distance
    if n == 0:
        w[0].depth -= p.land_gap
    if is_out_of_round(p):
        turn_lobes(p, w, lobes, n)
        w[n].depth += p.roundness * w[n].lobe_cos


@inner_kernel
def turn_lobes(p: Coefficients, w: Series, lobes: Array, n: int) -> None:
    """Coefficient n of cosine and sine of the lobes' angle m beta, and of that sine over the distance."""
    # cos beta = n . (cos theta, sin theta), sin beta = n x (cos theta, sin theta)
    w[n].turn_cos = product(w.nx, w.cos, n) + product(w.ny, w.sin, n)
    w[n].turn_sin = product(w.ny, w.cos, n) - product(w.nx, w.sin, n)
    # cos k beta = cos((k-1) beta) cos beta - sin((k-1) beta) sin beta, and the sine likewise
    last = 2 * (p.lobes - 1)
    lobes[n, 0], lobes[n, 1] = w[n].turn_cos, w[n].turn_sin
    for k in range(2, last + 2, 2):
        cos, sin = lobes[:, k - 2], lobes[:, k - 1]
        lobes[n, k] = product(cos, w.turn_cos, n) - product(sin, w.turn_sin, n)
        lobes[n, k + 1] = product(sin, w.turn_cos, n) + product(cos, w.turn_sin, n)
    w[n].lobe_cos, w[n].lobe_sin = lobes[n, last], lobes[n, last + 1]
    # tilt = sin(m beta) / |r|
    tilt = w[n].lobe_sin
    for i in range(1, n + 1):
        tilt -= w[i].distance * w[n - i].tilt
    w[n].tilt = tilt / w[0].distance


@inner_kernel
def push_land(p: Coefficients, w: Series, n: int) -> None:
    """Add coefficient n of the land's normal force to that of the forces and of the torque over M R."""
    # P = K delta + c d(delta)/dt; F = -P n
    w[n].normal = p.land_stiffness * w[n].depth + p.land_damping * (n + 1) * w[n + 1].depth
    w[n].fx -= product(w.normal, w.nx, n)
    w[n].fy -= product(w.normal, w.ny, n)
    if is_out_of_round(p):
        # F = -P grad(delta) with grad(delta) = n - a m sin(m beta)/|r| t; its moment about the centre is
        # -P d(delta)/d(theta)
        a = p.roundness * p.lobes
        w[n].pushed = product(w.normal, w.tilt, n)
        w[n].fx -= a * product(w.pushed, w.ny, n)
        w[n].fy += a * product(w.pushed, w.nx, n)
        w[n].torque -= a * product(w.normal, w.lobe_sin, n) / p.radius


@inner_kernel
def rub_land(p: Coefficients, w: Series, n: int) -> None:
    """Add coefficient n of the land's friction to that of the forces and of the torque over M R."""
    # F = F_t t with t = (-n_y, n_x); T / (M R) = q F_t
    w[n].fx -= product(w.tangent, w.ny, n)
    w[n].fy += product(w.tangent, w.nx, n)
    w[n].torque += p.land_side * w[n].tangent


@inner_kernel
def slide_speed(p: Coefficients, w: Series, now: Pace, n: int) -> float:
    """Coefficient n of the speed of the cage's surface on the ring's, from places up to n + 1."""
    # v_s = n_x dy/dt - n_y dx/dt + q [ds/dt - (omega_ring - Omega) R]
    gx, gy = centre(p, w)
    speed = p.land_side * w[n].vs
    if n < 2:
        speed -= p.land_side * p.ring_slide * now[n]
    for i in range(n + 1):
        m = n - i + 1
        speed += m * (w[i].nx * gy[m] - w[i].ny * gx[m])
    return speed


@inner_kernel
def land_change(
    p: Coefficients,
    w: Series,
    land: int,
    h: float,
    end: float,
    kind: int,
    x: Knots,
    y: Knots,
    off: float,
    room: Room,
) -> tuple[float, int]:
    """Earliest change up to a time, if the land's comes first, and what it is.

    What ends a step at the land: it is met, left or pressed again, or its sliding stops or starts.
    """
    c = room.c
    if land == CLEAR:
        return meet_land(p, w, end, kind, x, y, off, room)
    if land == RELEASED:
        return return_land(p, w, h, end, kind, room)
    # Left where P = 0
    copy_column(w.normal, c)
    t = first_zero(c, max(0.0, c[0]), 1.0, end, p.land_stiffness * p.land_gap)
    if t < end:
        end, kind = t, LAND_LEAVE
    if land == STICK:
        # Slides from mu P = |F_t|
        sign = 1.0 if w[0].tangent >= 0.0 else -1.0
        for n in range(ORDER + 1):
            c[n] = p.land_friction * w[n].normal - sign * w[n].tangent
        t = first_zero(c, max(0.0, c[0]), 1.0, end, p.land_stiffness * p.land_gap)
        return (t, SLIDE_START) if t < end else (end, kind)
    # Slides until v_s = 0
    sign = 1.0 if land == FORWARD else -1.0
    copy_column(w.sliding, c)
    # The force is a difference of places of the size of the gap, and moves the sliding by as much rounding.
    noise = abs(w[0].vx) + abs(w[0].vy) + abs(w[0].vs) + abs(p.ring_slide)
    noise += h * p.land_stiffness * p.land_gap * (1.0 + p.swiftness)
    t = first_zero(c, max(0.0, sign * c[0]), sign, end, noise)
    return (t, SLIDE_STOP) if t < end else (end, kind)


@inlined_kernel
def farthest(x: Knots, y: Knots) -> float:
    """Bound on the distance of the centre by its knots, without the error of the cubics between them."""
    u, v = x[0], y[0]
    square = u * u + v * v
    u, v = u + THIRD * x[1], v + THIRD * y[1]
    square = larger(square, u * u + v * v)
    for row, side in ((2, -THIRD), (2, THIRD), (4, -THIRD), (4, 0.0)):
        u, v = x[row] + side * x[row + 1], y[row] + side * y[row + 1]
        square = larger(square, u * u + v * v)
    return math.sqrt(square)


@inlined_kernel
def meet_land(
    p: Coefficients, w: Series, end: float, kind: int, x: Knots, y: Knots, off: float, room: Room
) -> tuple[float, int]:
    """Earliest change up to a time, if the cage meets its land before, and what it is."""
    if farthest(x, y) < (p.land_gap - abs(p.roundness) - off / 384.0):
        return end, kind
    gx, gy = centre(p, w)
    c = room.c
    if not is_out_of_round(p):
        # Met where |r|^2 = c_g^2
        near = math.sqrt(gx[0] ** 2 + gy[0] ** 2)
        for n in range(ORDER + 1):
            c[n] = product(gx, gx, n) + product(gy, gy, n)
        t = first_zero(c, (p.land_gap - near) * (p.land_gap + near), -1.0, end, p.land_gap**2)
    else:
        # Met where delta = 0
        for n in range(ORDER + 1):
            land_geometry(p, w, room.lobes, n)
        copy_column(w.depth, c)
        t = first_zero(c, -c[0], -1.0, end, p.land_gap)
    return (t, LAND_TOUCH) if t < end else (end, kind)


@inner_kernel
def return_land(p: Coefficients, w: Series, h: float, end: float, kind: int, room: Room) -> tuple[float, int]:
    """Earliest change up to a time, if a cage pushed off leaves its land, or is pressed again, before."""
    c = room.c
    for n in range(ORDER + 1):
        land_geometry(p, w, room.lobes, n)
    # Left where delta = 0
    copy_column(w.depth, c)
    t = first_zero(c, c[0], 1.0, end, p.land_gap)
    if t < end:
        end, kind = t, LAND_CLEAR
    # Pressed again where K delta + c d(delta)/dt = 0; times are in steps, c is not
    for n in range(ORDER):
        c[n] = p.land_stiffness * w[n].depth + p.land_damping / h * (n + 1) * w[n + 1].depth
    c[ORDER] = 0.0
    t = first_zero(c, max(0.0, -c[0]), -1.0, end, p.land_stiffness * p.land_gap)
    return (t, LAND_PRESS) if t < end else (end, kind)
