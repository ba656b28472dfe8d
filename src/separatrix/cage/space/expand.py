r"""The motion of one mode in space as power series.

Beside the planar equations, along the axis :math:`M\ddot z = F_z + M g_z`, and for the tilt :math:`\tau =
\tau_x + i\tau_y` in the frame that turns at :math:`\Omega`, with :math:`\omega = \Omega + \dot\theta`:

.. math:: J_t\ddot\tau + i(2J_t\Omega - J_p\omega)\dot\tau + (J_p\omega\Omega - J_t\Omega^2 + iJ_t\dot\Omega)
   \tau = m.
"""

from __future__ import annotations

import math

from separatrix.cage.motion import frame_angle
from separatrix.cage.records import ORDER, Pace
from separatrix.cage.space.ball import move_ball
from separatrix.cage.space.land import dent_strip, press_strip, strip_forces
from separatrix.cage.space.pocket import expand_contact, place_pocket
from separatrix.cage.space.records import (
    AXIAL,
    BALLS,
    CLEAR,
    CONTACTS,
    COS,
    FAR_L,
    FORCE_X,
    FORCE_Y,
    FRAME,
    FT,
    FZ,
    GA,
    GB,
    GONE,
    GX,
    GY,
    LAST,
    LEAN,
    MOMENT_A,
    MOMENT_B,
    NONE,
    PRESSED,
    PUSH,
    RIM_COS,
    RIM_SIN,
    RIMS,
    RUB_Q,
    RUB_R,
    SIN,
    SPEED,
    SPIN,
    VA,
    VB,
    VS,
    VX,
    VY,
    VZ,
    A,
    B,
    Motion,
    Numbers,
    Parts,
    S,
    X,
    Y,
    Z,
)
from separatrix.cage.space.rim import expand_rim, is_on_round
from separatrix.cage.step import LONGEST, PRECISION
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

FEW, MORE = 7, 10
"""Powers at which the series may end where a step is short; else they go on to `ORDER`."""


@inlined_kernel
def ramped(c: Array, column: int, first: float, rise: float, n: int) -> float:
    """Coefficient n of a series times `first` + `rise` t."""
    total = first * c[n, column]
    if n > 0:
        total += rise * c[n - 1, column]
    return float(total)


@inlined_kernel
def ramped_twice(c: Array, column: int, first: float, rise: float, n: int) -> float:
    """Coefficient n of a series times the square of `first` + `rise` t."""
    total = first * first * c[n, column]
    if n > 0:
        total += 2.0 * first * rise * c[n - 1, column]
    if n > 1:
        total += rise * rise * c[n - 2, column]
    return float(total)


@inner_kernel
def load(p: Numbers, parts: Parts, state: Motion) -> None:
    """First coefficients of the series of the cage."""
    cage = parts.cage
    cage[0, X], cage[0, Y], cage[0, Z], cage[0, S] = state.x, state.y, state.z, state.s
    cage[0, A], cage[0, B] = state.a, state.b
    cage[0, VX], cage[0, VY], cage[0, VZ], cage[0, VS] = state.vx, state.vy, state.vz, state.vs
    cage[0, VA], cage[0, VB] = state.va, state.vb
    if p.needs_rotation:
        cage[0, COS], cage[0, SIN] = math.cos(state.s / p.radius), math.sin(state.s / p.radius)
    place_geometry(p, cage, 0)
    if p.needs_frame:
        angle = frame_angle(p, state.clock)  # type: ignore[arg-type]  # reads the ramp of either record
        for h in range(max(1, p.harmonics)):
            cage[0, FRAME + 2 * h] = math.cos((h + 1) * angle)
            cage[0, FRAME + 2 * h + 1] = math.sin((h + 1) * angle)
            cage[0, GONE + 2 * h] = cage[0, GONE + 2 * h + 1] = 0.0


@inlined_kernel
def place_geometry(p: Numbers, cage: Array, n: int) -> None:
    """Coefficient n of the geometric centre and axis, which an unbalance parts from those of the mass."""
    cage[n, GX], cage[n, GY], cage[n, GA], cage[n, GB] = cage[n, X], cage[n, Y], cage[n, A], cage[n, B]
    if p.needs_rotation:
        cage[n, GX] -= p.eccentricity * cage[n, COS]
        cage[n, GY] -= p.eccentricity * cage[n, SIN]
        cage[n, GA] += p.leaning * cage[n, SIN]
        cage[n, GB] -= p.leaning * cage[n, COS]


@inlined_kernel
def turn(p: Numbers, cage: Array, now: Pace, n: int) -> None:
    """Coefficients n + 1 of the rotation, of the turning of the frame and of the ways of free balls."""
    after = 1.0 / (n + 1.0)
    if p.needs_rotation:
        cosine = sine = 0.0
        for m in range(n + 1):
            cosine -= cage[m, VS] * cage[n - m, SIN]
            sine += cage[m, VS] * cage[n - m, COS]
        cage[n + 1, COS], cage[n + 1, SIN] = cosine * after / p.radius, sine * after / p.radius
    if p.needs_frame:
        for k in range(0, max(2, 2 * p.harmonics), 2):
            scale = (1 + k // 2) * after * p.turning
            cage[n + 1, FRAME + k] = -scale * ramped(cage, FRAME + k + 1, now.share, now.rise, n)
            cage[n + 1, FRAME + k + 1] = scale * ramped(cage, FRAME + k, now.share, now.rise, n)
        for k in range(2 * p.harmonics):
            cage[n + 1, GONE + k] = ramped(cage, FRAME + k, now.share, now.rise, n) * after


@inlined_kernel
def expand(p: Numbers, parts: Parts, now: Pace, aim: float, edged: bool) -> None:
    """Fill the series of the motion from the state in their first coefficients.

    As far as a step of length `aim` needs them: many steps end at an event long before 14 terms are used.
    """
    parts.listed[LAST] = ORDER
    cage = parts.cage
    for n in range(ORDER + 1):
        after = 1.0 / (n + 1.0)
        for k in range(6):
            cage[n + 1, X + k] = cage[n, VX + k] * after
        turn(p, cage, now, n)
        place_geometry(p, cage, n + 1)
        fx, fy, fz, ts, ta, tb = pocket_forces(p, parts, now, n, edged)
        for i in range(parts.mode.size):
            if parts.mode[i] == CLEAR:
                continue
            if n == 0:
                dent_strip(p, parts, i, 0)
            dent_strip(p, parts, i, n + 1)
            if parts.mode[i] == PRESSED:
                press_strip(p, parts, i, now, n)
                lx, ly, lz, ls, la, lb = strip_forces(p, parts, i, n)
                fx, fy, fz, ts, ta, tb = fx + lx, fy + ly, fz + lz, ts + ls, ta + la, tb + lb
        accelerate(p, cage, now, fx, fy, fz, ts, ta, tb, n)
        if n in (FEW, MORE) and is_enough(p, parts, n, aim):
            parts.listed[LAST] = n
            return


@inlined_kernel
def tails(p: Numbers, parts: Parts, n: int) -> tuple[float, float, float]:
    """Sum of the speeds, and the largest coefficients n and n - 1 of any of them.

    Of those too that each contact alone would give: forces of several may balance.
    """
    first, one, two = parts.cage[0], parts.cage[n], parts.cage[n - 1]
    scale, last, before = p.slowest, 0.0, 0.0
    for k in range(VX, VB + 1):
        scale += abs(first[k])
        last, before = max(last, abs(one[k])), max(before, abs(two[k]))
    for b in range(parts.listed[BALLS]):
        ball = parts.ball[parts.active[b]]
        last = max(last, abs(ball[n, SPEED]), n * abs(ball[n, AXIAL]))
        before = max(before, abs(ball[n - 1, SPEED]), (n - 1) * abs(ball[n - 1, AXIAL]))
    after, at = 1.0 / n, 1.0 / (n - 1)
    for a in range(parts.listed[CONTACTS]):
        c = parts.contact[parts.touching[a]]
        for k in (PUSH, RUB_R, FT, FZ):
            last, before = max(last, abs(c[n - 1, k]) * after), max(before, abs(c[n - 2, k]) * at)
    for i in range(parts.mode.size):
        if parts.mode[i] != CLEAR:
            last = max(last, n * abs(parts.strip[i, n, FAR_L]))
            before = max(before, (n - 1) * abs(parts.strip[i, n - 1, FAR_L]))
    return scale, last, before


@inlined_kernel
def is_enough(p: Numbers, parts: Parts, n: int, aim: float) -> bool:
    """Whether the terms n and n - 1 of the series are below `PRECISION` of the speeds after a time."""
    scale, last, before = tails(p, parts, n)
    return max(last * aim, before) * aim ** (n - 1) < PRECISION * scale


@inlined_kernel
def step_length(p: Numbers, parts: Parts) -> float:
    """Time for which the last two terms of the series stay below `PRECISION` of the speeds."""
    n = parts.listed[LAST]
    scale, last, before = tails(p, parts, n)
    h, scale = LONGEST, PRECISION * scale
    if last > 0.0:
        h = min(h, (scale / last) ** (1.0 / n))
    if before > 0.0:
        h = min(h, (scale / before) ** (1.0 / (n - 1)))
    walls = parts.listed[CONTACTS] - parts.listed[RIMS]
    for a in range(walls, parts.listed[CONTACTS]):
        if is_on_round(p, parts, parts.touching[a]):
            e = parts.rim[parts.touching[a]]
            last = abs(e[n, RIM_SIN]) + abs(e[n, RIM_COS])
            before = abs(e[n - 1, RIM_SIN]) + abs(e[n - 1, RIM_COS])
            if last > 0.0:
                h = min(h, (ANGLE / last) ** (1.0 / n))
            if before > 0.0:
                h = min(h, (ANGLE / before) ** (1.0 / (n - 1)))
    return float(h)


ANGLE = 1e-8
"""Last two terms of the place on a round edge [rad]: near its evolute the nearest point swings fast, and
neither force nor depth shows it."""


@inlined_kernel
def pocket_forces(
    p: Numbers, parts: Parts, now: Pace, n: int, edged: bool
) -> tuple[float, float, float, float, float, float]:
    """Coefficient n of the pockets' forces on the cage and of their moments over R; and of balls' motion."""
    fx = fy = fz = ts = ta = tb = 0.0
    for b in range(parts.listed[BALLS]):
        place_pocket(p, parts, parts.active[b], n)
    walls = parts.listed[CONTACTS] - (parts.listed[RIMS] if edged else 0)
    for a in range(walls):
        expand_contact(p, parts, parts.touching[a], now, n)
    if edged:
        for a in range(walls, parts.listed[CONTACTS]):
            expand_rim(p, parts, parts.touching[a], now, n)
    for b in range(parts.listed[BALLS]):
        j = parts.active[b]
        along = axial = 0.0
        cos, sin = parts.cosine[j], parts.sine[j]
        for i in range(2 * j, 2 * j + 2):
            if parts.kind[i] == NONE:
                continue
            c = parts.contact[i, n]
            f_r, f_t, f_z = c[RUB_R], c[FT], c[FZ]
            fx += f_r * cos - f_t * sin
            fy += f_r * sin + f_t * cos
            fz += f_z
            ts += f_t + p.lever * c[SPIN]
            # m = -F_z e_t + h (F_r p_z e_t - F_q e_r), over R
            lean, roll = p.lever * c[LEAN] - f_z, -p.lever * c[RUB_Q]
            ta += roll * cos - lean * sin
            tb += roll * sin + lean * cos
            along -= f_t
            axial -= f_z
        move_ball(p, parts, j, now, along, axial, n)
    return fx, fy, fz, ts, ta, tb


@inlined_kernel
def accelerate(
    p: Numbers,
    cage: Array,
    now: Pace,
    fx: float,
    fy: float,
    fz: float,
    ts: float,
    ta: float,
    tb: float,
    n: int,
) -> None:
    """Coefficient n + 1 of the speeds, from the forces and what the turning frame adds."""
    W, rise, after = p.turning * now.share, p.turning * now.rise, 1.0 / (n + 1.0)
    # 2 v x Omega + Omega^2 r + r x dOmega/dt
    ax = 2.0 * ramped(cage, VY, W, rise, n) + ramped_twice(cage, X, W, rise, n) + rise * cage[n, Y]
    ay = -2.0 * ramped(cage, VX, W, rise, n) + ramped_twice(cage, Y, W, rise, n) - rise * cage[n, X]
    if p.gravity != 0.0:
        ax += p.gravity * cage[n, FRAME]
        ay -= p.gravity * cage[n, FRAME + 1]
    if p.eccentricity != 0.0:
        # T = -epsilon (cos theta, sin theta) x F
        cage[n, FORCE_X], cage[n, FORCE_Y] = fx, fy
        for m in range(n + 1):
            cross = cage[m, COS] * cage[n - m, FORCE_Y] - cage[m, SIN] * cage[n - m, FORCE_X]
            ts -= p.eccentricity * cross / p.radius
    if p.leaning != 0.0:
        # The geometric axis, on which the contacts' moments act, leans by L (sin theta, -cos theta) more
        cage[n, MOMENT_A], cage[n, MOMENT_B] = ta, tb
        for m in range(n + 1):
            turned = cage[m, COS] * cage[n - m, MOMENT_A] + cage[m, SIN] * cage[n - m, MOMENT_B]
            ts += p.leaning * turned / p.radius
    twist, axial = 0.0, 0.0
    if n == 0:
        twist, axial = -rise * p.radius, p.axial_gravity
    cage[n + 1, VX], cage[n + 1, VY] = (fx + ax) * after, (fy + ay) * after
    cage[n + 1, VZ] = (fz * p.axial_swiftness + axial) * after
    cage[n + 1, VS] = (ts / p.spin_inertia + twist) * after
    if p.tilt_swiftness == 0.0:
        return
    spun_a = spun_b = lean_a = lean_b = 0.0
    for m in range(n + 1):
        spun_a += cage[m, VS] * cage[n - m, VA]
        spun_b += cage[m, VS] * cage[n - m, VB]
        lean_a += cage[m, VS] * (now.share * cage[n - m, A])
        lean_b += cage[m, VS] * (now.share * cage[n - m, B])
    for m in range(n if now.rise != 0.0 else 0):
        lean_a += cage[m, VS] * (now.rise * cage[n - 1 - m, A])
        lean_b += cage[m, VS] * (now.rise * cage[n - 1 - m, B])
    jt, jp = p.tilt_inertia, p.spin_inertia
    gyro, pull = 2.0 * jt - jp, jp - jt
    slip = jp / p.radius
    ta += gyro * ramped(cage, VB, W, rise, n) - slip * spun_b + jt * rise * cage[n, B]
    tb -= gyro * ramped(cage, VA, W, rise, n) - slip * spun_a + jt * rise * cage[n, A]
    ta -= pull * ramped_twice(cage, A, W, rise, n) + slip * p.turning * lean_a
    tb -= pull * ramped_twice(cage, B, W, rise, n) + slip * p.turning * lean_b
    cage[n + 1, VA], cage[n + 1, VB] = ta * p.tilt_swiftness * after, tb * p.tilt_swiftness * after
