"""What a step in space adds to the evidence of a run: the ledger of work, extremes, and integrals."""

from __future__ import annotations

import math

import numpy as np

from separatrix.cage.records import Pace
from separatrix.cage.series import peak
from separatrix.cage.space.events import at_time, scaled
from separatrix.cage.space.records import (
    AROUND,
    AXIAL,
    BALLS,
    BESIDE,
    CAGE_COLUMNS,
    CLEAR,
    CONTACTS,
    COS,
    DEPTH,
    DEPTH_L,
    FORCE_X,
    FRAME,
    FT,
    FZ,
    GA,
    GB,
    GX,
    GY,
    HOLD,
    LAST,
    LEAN,
    NONE,
    OUTER_CLEAR,
    PRESSED,
    PUSH,
    PUSH_L,
    RUB_Q,
    RUB_R,
    RUB_T,
    RUB_Z,
    SIN,
    SLIDE,
    SLIDE_L,
    SPEED,
    SPIN,
    STRIP_COLUMNS,
    VA,
    VB,
    VS,
    VX,
    VY,
    VZ,
    WAY,
    A,
    B,
    Motion,
    Numbers,
    Parts,
    SpaceLook,
    Works,
    X,
    Y,
    Z,
)
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

FEWEST, MOST = 3, 5
NODES, WEIGHTS = np.zeros((MOST + 1, MOST)), np.zeros((MOST + 1, MOST))
for _n in range(FEWEST, MOST + 1):
    _at, _weight = np.polynomial.legendre.leggauss(_n)
    NODES[_n, :_n], WEIGHTS[_n, :_n] = 0.5 * (_at + 1.0), 0.5 * _weight
"""Gauss's points and weights on 0 to 1 by their number; 5 are exact to the 9th power of the time."""

SHORT, SHORTER = 0.6, 0.25
"""Shares of the time for which the series are good, up to which a step has four points, and three."""

BITS = 36.0
"""Of a value at a time: powers whose terms are below 2 to the minus this are left out."""


@inner_kernel
def kinetic(p: Numbers, state: Motion) -> float:
    """Kinetic energy of the cage in the turning frame, over its mass."""
    across = state.vx * state.vx + state.vy * state.vy + p.spin_inertia * state.vs * state.vs
    axial = state.vz * state.vz / p.axial_swiftness if p.axial_swiftness != 0.0 else 0.0
    return 0.5 * (across + axial + p.tilt_inertia * (state.va * state.va + state.vb * state.vb))


@inner_kernel
def held_energy(p: Numbers, parts: Parts) -> float:
    """Energy in springs of pockets, grooves and lands, and in balls that move, over the mass."""
    total = 0.0
    for j in range(parts.moving.size):
        ball = parts.ball[j, 0]
        total += 0.5 * p.groove_stiffness * ball[AXIAL] ** 2
        if parts.creeping[j] == 0:
            total += 0.5 * p.ball_mass * ball[SPEED] ** 2
    for i in range(parts.kind.size):
        if parts.kind[i] != NONE and parts.kind[i] < OUTER_CLEAR:
            total += 0.5 * parts.stiff[i] * parts.contact[i, 0, DEPTH] ** 2
    for i in range(parts.mode.size):
        if parts.mode[i] != CLEAR:
            total += 0.5 * parts.strip_stiffness[i] * parts.strip[i, 0, DEPTH_L] ** 2
    return total


@inner_kernel
def total(works: Works) -> float:
    """Sum of the work of all sources."""
    pockets = works.pocket_friction + works.races + works.grooves + works.ball_drive
    return pockets + works.land_friction + works.land_damping + works.gravity + works.moving_frame


@inlined_kernel
def enter_step(
    p: Numbers,
    parts: Parts,
    now: Pace,
    h: float,
    end: float,
    share: float,
    works: Works,
    step: Works,
    look: SpaceLook,
    heat: Array,
) -> None:
    """Add a step of length `end` h to the ledger and to the tally of its look, by Gauss's rule.

    It is this share of the time for which its series are good.
    """
    t, cage, last = end * h, parts.here[0], parts.listed[LAST]
    count = FEWEST if share < SHORTER else (MOST - 1 if share < SHORT else MOST)
    if share < 1.0:
        # The terms fall by 2^(-34 / last) and this share from one to the next
        last = min(last, 2 + int(BITS / (BITS / last - math.log2(max(share, 1e-9)))))
    columns = CAGE_COLUMNS if p.needs_frame else FORCE_X
    clear(step)
    look.offset_max = max(look.offset_max, parts.cage[0, GX] ** 2 + parts.cage[0, GY] ** 2)
    ux, uy = parts.cage[0, VX], parts.cage[0, VY]
    for i in range(count):
        at, weight = t * NODES[count, i], WEIGHTS[count, i] * t
        at_time(parts.cage, last, at, columns, cage)
        look.turning += angle(ux, uy, cage[VX], cage[VY])
        ux, uy = cage[VX], cage[VY]
        enter_motion(p, cage, weight, look)
        frame_work(p, cage, now, at, weight, step)
        for b in range(parts.listed[BALLS]):
            pocket_work(p, parts, parts.active[b], now, last, at, weight, step, heat)
        for k in range(parts.mode.size):
            if parts.mode[k] != CLEAR:
                strip_work(p, parts, k, now, last, at, weight, step, look)
    # What the pockets do less what their springs have taken: their friction
    for a in range(parts.listed[CONTACTS]):
        i = parts.touching[a]
        c = parts.contact[i]
        before, depth = c[0, DEPTH], value_at(c, DEPTH, parts.listed[LAST], t)
        c[0, DEPTH] = depth
        if parts.kind[i] >= OUTER_CLEAR:
            continue
        step.pocket_friction += 0.5 * parts.stiff[i] * (depth - before) * (depth + before)
        if parts.stiff[i] * (abs(before) + c[0, WAY]) > look.force_max:
            scaled(c, parts.listed[LAST], PUSH, h, parts.c)
            look.force_max = max(look.force_max, peak(parts.c, 1.0, end))
    close(works, step)
    for k in range(parts.mode.size):
        if parts.mode[k] == PRESSED:
            way = scaled(parts.strip[k], parts.listed[LAST], PUSH_L, h, parts.c)
            if parts.c[0] + way > look.land_max:
                look.land_max = max(look.land_max, peak(parts.c, 1.0, end))


@inlined_kernel
def value_at(c: Array, column: int, last: int, t: float) -> float:
    """Value of one series at a time."""
    total = c[last, column]
    for n in range(last - 1, -1, -1):
        total = total * t + c[n, column]
    return float(total)


@inlined_kernel
def contact_at(
    c: Array, last: int, t: float
) -> tuple[float, float, float, float, float, float, float, float]:
    """Values at a time of what the work of a contact needs: its first eight columns."""
    z = y = out = across = spin = lean = push = slide = 0.0
    for n in range(last, -1, -1):
        z, y, out, across = (
            z * t + c[n, FZ],
            y * t + c[n, FT],
            out * t + c[n, RUB_R],
            across * t + c[n, RUB_Q],
        )
        spin, lean = spin * t + c[n, SPIN], lean * t + c[n, LEAN]
        push, slide = push * t + c[n, PUSH], slide * t + c[n, SLIDE]
    return z, y, out, across, spin, lean, push, slide


@inlined_kernel
def angle(ux: float, uy: float, vx: float, vy: float) -> float:
    """Angle from one velocity to another times the square of their size."""
    # An angle over its sine, to its 6th power: (14 + cos) / (9 + 6 cos)
    cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
    size = math.sqrt(cross * cross + dot * dot)
    return cross * (14.0 * size + dot) / (9.0 * size + 6.0 * dot) if size > 0.0 else 0.0


@inlined_kernel
def enter_motion(p: Numbers, cage: Array, weight: float, look: SpaceLook) -> None:
    """Add one of Gauss's points to the tally of a look."""
    x, y, z, a, b = cage[GX], cage[GY], cage[Z], cage[GA], cage[GB]
    vx, vy, vz, vs, va, vb = cage[VX], cage[VY], cage[VZ], cage[VS], cage[VA], cage[VB]
    far, steep = x * x + y * y, a * a + b * b
    look.offset_max, look.tilt_max = max(look.offset_max, far), max(look.tilt_max, steep)
    look.axial_high, look.axial_low = max(look.axial_high, z), min(look.axial_low, z)
    squared = vx * vx + vy * vy
    axial = vz * vz / p.axial_swiftness if p.axial_swiftness != 0.0 else 0.0
    energy = squared + axial + p.spin_inertia * vs * vs + p.tilt_inertia * (va * va + vb * vb)
    look.kinetic += weight * 0.5 * energy
    look.speed_squared += weight * squared
    look.offset += weight * math.sqrt(far)
    look.offset_squared += weight * far
    look.swept += weight * (x * vy - y * vx)
    look.mean_x += weight * x
    look.mean_y += weight * y
    look.tilt += weight * math.sqrt(steep)
    look.tilt_squared += weight * steep
    look.tilt_swept += weight * (a * vb - b * va)
    # The axis leans towards (b, -a)
    look.together += weight * (x * b - y * a)
    look.crossed -= weight * (x * a + y * b)
    look.axial += weight * z
    look.axial_squared += weight * z * z


@inlined_kernel
def frame_work(p: Numbers, cage: Array, now: Pace, at: float, weight: float, step: Works) -> None:
    """Add one of Gauss's points to the work of gravity and of what the turning of the frame adds."""
    if p.gravity != 0.0:
        step.gravity += weight * p.gravity * (cage[FRAME] * cage[VX] - cage[FRAME + 1] * cage[VY])
    if p.axial_gravity != 0.0:
        step.gravity += weight * p.axial_gravity / p.axial_swiftness * cage[VZ]
    if p.turning == 0.0:
        return
    W, rise = p.turning * (now.share + now.rise * at), p.turning * now.rise
    x, y, vx, vy, vs = cage[X], cage[Y], cage[VX], cage[VY], cage[VS]
    a, b, va, vb = cage[A], cage[B], cage[VA], cage[VB]
    power = W * W * (x * vx + y * vy) + rise * (y * vx - x * vy) - rise * p.radius * p.spin_inertia * vs
    pull = (p.spin_inertia - p.tilt_inertia) * W * W + p.spin_inertia * W * vs / p.radius
    power += p.tilt_inertia * rise * (b * va - a * vb) - pull * (a * va + b * vb)
    step.moving_frame += weight * power


@inlined_kernel
def pocket_work(
    p: Numbers,
    parts: Parts,
    j: int,
    now: Pace,
    last: int,
    at: float,
    weight: float,
    step: Works,
    heat: Array,
) -> None:
    """Add one of Gauss's points to the work of a ball and its pocket, and to the pocket's rubbing."""
    ball, cage = parts.ball[j], parts.here[0]
    share, free = now.share + now.rise * at, 0.0
    cos, sin = parts.cosine[j], parts.sine[j]
    for k in range(2 * p.harmonics):
        free += share * parts.drive[k, j] * cage[FRAME + k]
    # The pocket's velocity: rates of the geometric centre and axis
    vx, vy, va, vb = cage[VX], cage[VY], cage[VA], cage[VB]
    if p.needs_rotation:
        spin = cage[VS] / p.radius
        vx, vy = vx + p.eccentricity * spin * cage[SIN], vy - p.eccentricity * spin * cage[COS]
        va, vb = va + p.leaning * spin * cage[COS], vb + p.leaning * spin * cage[SIN]
    outward, along, axial = (
        vx * cos + vy * sin,
        vy * cos - vx * sin + cage[VS],
        cage[VZ] - (vb * cos - va * sin),
    )
    tilt_r, tilt_t = va * cos + vb * sin, vb * cos - va * sin
    force_t = force_z = 0.0
    for i in range(2 * j, 2 * j + 2):
        if parts.kind[i] == NONE:
            continue
        fz, ft, out, across, turn, lean, push, slide = contact_at(parts.contact[i], last, at)
        couple = turn * cage[VS] + lean * tilt_t - across * tilt_r
        step.pocket_friction += weight * (ft * along + fz * axial + out * outward + p.lever * couple)
        heat[j] += weight * push * slide
        force_t, force_z = force_t + ft, force_z + fz
    give = -force_z - p.groove_stiffness * value_at(ball, AXIAL, last, at)
    settles = p.groove_yielding * share * give
    if p.ball_mass == 0.0:
        speed = -p.yielding * share * force_t
        step.races += weight * force_t * speed
    else:
        speed = value_at(ball, SPEED, last, at)
        step.races -= weight * value_at(ball, HOLD, last, at) * speed
    step.grooves -= weight * give * settles
    step.ball_drive += weight * force_t * free
    step.pocket_friction -= weight * (force_t * (speed + free) + force_z * settles)


@inlined_kernel
def strip_work(
    p: Numbers,
    parts: Parts,
    i: int,
    now: Pace,
    last: int,
    at: float,
    weight: float,
    step: Works,
    look: SpaceLook,
) -> None:
    """Add one of Gauss's points to the work of a strip of a land, and to its rubbing."""
    strip, rate = parts.here[3], 0.0
    at_time(parts.strip[i], last, at, STRIP_COLUMNS, strip)
    for n in range(last, 0, -1):
        rate = rate * at + n * parts.strip[i, n, DEPTH_L]
    spring = parts.strip_stiffness[i] * strip[DEPTH_L]
    if parts.mode[i] != PRESSED:
        step.land_damping += weight * spring * rate
        return
    step.land_damping -= weight * (strip[PUSH_L] - spring) * rate
    around = strip[AROUND] + p.ring_slide * (now.share + now.rise * at)
    step.land_friction += weight * (strip[RUB_T] * around + strip[RUB_Z] * strip[BESIDE])
    look.pressed += weight * strip[PUSH_L]
    look.rubbed += weight * strip[PUSH_L] * strip[SLIDE_L]


@inlined_kernel
def clear(step: Works) -> None:
    """No work yet."""
    step.pocket_friction = step.races = step.grooves = step.ball_drive = 0.0
    step.land_friction = step.land_damping = step.gravity = step.moving_frame = 0.0


@inlined_kernel
def close(works: Works, step: Works) -> None:
    """Add the work of a step to the ledger."""
    works.pocket_friction += step.pocket_friction
    works.races += step.races
    works.grooves += step.grooves
    works.ball_drive += step.ball_drive
    works.land_friction += step.land_friction
    works.land_damping += step.land_damping
    works.gravity += step.gravity
    works.moving_frame += step.moving_frame
    works.gross += abs(step.pocket_friction) + abs(step.races) + abs(step.grooves) + abs(step.ball_drive)
    works.gross += abs(step.land_friction) + abs(step.land_damping) + abs(step.gravity)
    works.gross += abs(step.moving_frame)
