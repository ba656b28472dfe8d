"""The ledger of work: what each source does on the cage in a step, by Gauss's rule.

The motion is evaluated at all points of a step side by side: at those of the ledger, at the fewer ones of the
tally of a look (`evidence`) and at the end.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.cage.features import (
    harmonics,
    has_gravity,
    has_hertz_pockets,
    has_inertia,
    has_own_series,
    has_unbalance,
)
from separatrix.cage.law import traction_power
from separatrix.cage.records import (
    CLEAR,
    ORDER,
    RELEASED,
    Balls,
    Coefficients,
    Ledger,
    Pace,
    Points,
    Room,
    Series,
    State,
    Sums,
)
from separatrix.cage.series import grip_at, slope, value
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


def _gauss(points: int) -> tuple[Array, Array]:
    """Gauss's points and weights on 0 to 1."""
    at, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (at + 1.0), 0.5 * weight


FEW, LAST = 4, 11
"""The first points are those of the tally, exact to the 7th power of the time; the last is the end of a step.
Those between are the ledger's, exact to the 13th power: it closes to 1e-12 with them."""

NODES = np.concatenate([_gauss(FEW)[0], _gauss(LAST - FEW)[0], [1.0]])
WEIGHTS = np.concatenate([_gauss(FEW)[1], _gauss(LAST - FEW)[1], [0.0]])


@inlined_kernel
def at_points(c: Array, t: Array, out: Array) -> None:
    """Values of a series at all points."""
    a0 = a1 = a2 = a3 = b0 = b1 = b2 = b3 = d0 = d1 = d2 = d3 = c[ORDER]
    for n in range(ORDER - 1, -1, -1):
        term = c[n]
        a0, a1, a2, a3 = a0 * t[0] + term, a1 * t[1] + term, a2 * t[2] + term, a3 * t[3] + term
        b0, b1, b2, b3 = b0 * t[4] + term, b1 * t[5] + term, b2 * t[6] + term, b3 * t[7] + term
        d0, d1, d2, d3 = d0 * t[8] + term, d1 * t[9] + term, d2 * t[10] + term, d3 * t[11] + term
    out[0], out[1], out[2], out[3] = a0, a1, a2, a3
    out[4], out[5], out[6], out[7] = b0, b1, b2, b3
    out[8], out[9], out[10], out[11] = d0, d1, d2, d3


@inlined_kernel
def at_late_points(c: Array, t: Array, out: Array) -> None:
    """Values of a series at the points of the ledger and at the end."""
    b0 = b1 = b2 = b3 = d0 = d1 = d2 = d3 = c[ORDER]
    for n in range(ORDER - 1, -1, -1):
        term = c[n]
        b0, b1, b2, b3 = b0 * t[4] + term, b1 * t[5] + term, b2 * t[6] + term, b3 * t[7] + term
        d0, d1, d2, d3 = d0 * t[8] + term, d1 * t[9] + term, d2 * t[10] + term, d3 * t[11] + term
    out[4], out[5], out[6], out[7] = b0, b1, b2, b3
    out[8], out[9], out[10], out[11] = d0, d1, d2, d3


@inlined_kernel
def place_points(p: Coefficients, w: Series, count: int, h: float, end: float, at: Points) -> None:
    """Motion of the cage at all points of a step up to `end`, with this number of pockets in touch."""
    for m in range(LAST + 1):
        at.t[m] = end * NODES[m]
    at_points(w.x, at.t, at.x)
    at_points(w.y, at.t, at.y)
    at_points(w.vx, at.t, at.vx)
    at_points(w.vy, at.t, at.vy)
    at_points(w.vs, at.t, at.vs)
    if count > 0 and (has_inertia(p) or not has_own_series(p)):
        at_late_points(w.ex, at.t, at.ex)
        at_late_points(w.ey, at.t, at.ey)
        if not has_own_series(p):
            at_late_points(w.es, at.t, at.es)
            at_late_points(w.kept, at.t, at.kept)
    if has_unbalance(p):
        at_points(w.gx, at.t, at.gx)
        at_points(w.gy, at.t, at.gy)
        for m in range(FEW, LAST):
            at.gvx[m], at.gvy[m] = slope(w.gx, at.t[m]) / h, slope(w.gy, at.t[m]) / h


@inlined_kernel
def add_work(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    land: int,
    now: Pace,
    h: float,
    end: float,
    room: Room,
    work: Ledger,
) -> None:
    """Add the work that each source does from the start of the step to `end`."""
    at, count, length = room.points, state.touching, end * h
    place_points(p, w, count, h, end, at)
    vx, vy = (at.gvx, at.gvy) if has_unbalance(p) else (at.vx, at.vy)
    if has_inertia(p):
        work.race_dampers -= traction_work(p, balls.moving, count + state.coasting, at, length)
    if count > 0 and not has_own_series(p) and harmonics(p) == 0:
        pockets_work(p, balls, now, count, h, length, vx, vy, at, room.sums, work)
    elif count > 0:
        for m in range(FEW, LAST):
            share = now.share + now.rise * h * at.t[m]
            pocket_work(p, balls, w, count, vx[m], vy[m], share, at, m, WEIGHTS[m] * length, work)
    frame_work(p, now, h, length, at, work)
    if land != CLEAR:
        land_work(p, w, land, h, length, vx, vy, at, work)
    if has_gravity(p):
        for m in range(FEW, LAST):
            pull = value(w.frame[:, 0], at.t[m]) * at.vx[m] - value(w.frame[:, 1], at.t[m]) * at.vy[m]
            work.gravity += WEIGHTS[m] * length * p.gravity * pull


@inlined_kernel
def pockets_work(
    p: Coefficients,
    balls: Balls,
    now: Pace,
    count: int,
    h: float,
    length: float,
    vx: Array,
    vy: Array,
    at: Points,
    sums: Sums,
    work: Ledger,
) -> None:
    """Add the work of all linear pockets in touch, by the sums of `gather`."""
    # sum_j N_j e_r . v and sum_j N_j^2 of all pockets in touch:
    # friction does -sigma f sum_j N_j e_r . v, the dampers take sum_j N_j^2 / C_mu
    cc, cs, ss, c, s, qc, qs, q = sums.cc, sums.cs, sums.ss, sums.c, sums.s, sums.qc, sums.qs, sums.q
    share, rise, squares, number = now.share, now.rise * h, 0.0, float(count)
    for i in range(count):
        squares += balls.penetration[balls.touching[i]] ** 2
    for m in range(FEW, LAST + 1):
        ex, ey, es, e = at.ex[m], at.ey[m], at.es[m], at.kept[m]
        along_x = e * qc + cc * ey - cs * ex + c * es
        along_y = e * qs + cs * ey - ss * ex + s * es
        square = e * (e * squares + 2.0 * (ey * qc - ex * qs + es * q))
        square += ey * (cc * ey - 2.0 * cs * ex + 2.0 * c * es)
        square += ex * (ss * ex - 2.0 * s * es) + number * es * es
        at.rubbing[m] = WEIGHTS[m] * (along_x * vx[m] + along_y * vy[m])
        at.yielding[m] = WEIGHTS[m] * ((share + rise * at.t[m]) * square)
    rubbing = yielding = 0.0
    for m in range(FEW, LAST):
        rubbing += at.rubbing[m]
        yielding += at.yielding[m]
    work.pocket_friction -= length * p.friction * p.stiffness * rubbing
    work.race_dampers -= length * p.yielding * p.stiffness**2 * yielding


@inlined_kernel
def frame_work(p: Coefficients, now: Pace, h: float, length: float, at: Points, work: Ledger) -> None:
    """Add the work of the turning of the frame."""
    # Omega^2 r . v, of which the part of the unbalance is Omega^2 epsilon . v; in a ramp also
    # Omega' (y v_x - x v_y - R^2 d(theta)/dt J / M R^2)
    share, rise, turning = now.share, now.rise * h, p.turning
    x, y = (at.gx, at.gy) if has_unbalance(p) else (at.x, at.y)
    for m in range(FEW, LAST + 1):
        speed = turning * (share + rise * at.t[m])
        at.driving[m] = WEIGHTS[m] * (speed * speed) * (x[m] * at.vx[m] + y[m] * at.vy[m])
    driving = 0.0
    for m in range(FEW, LAST):
        driving += at.driving[m]
    work.moving_frame += length * driving
    if not has_unbalance(p) and now.rise == 0.0:
        return
    for m in range(FEW, LAST):
        weight, speed = WEIGHTS[m] * length, turning * (share + rise * at.t[m])
        off = (at.x[m] - x[m]) * at.vx[m] + (at.y[m] - y[m]) * at.vy[m]
        work.unbalance += weight * (speed * speed) * off
        euler = at.y[m] * at.vx[m] - at.x[m] * at.vy[m] - p.radius * p.inertia * at.vs[m]
        work.moving_frame += weight * turning * now.rise * euler


@inner_kernel
def land_work(
    p: Coefficients,
    w: Series,
    land: int,
    h: float,
    length: float,
    vx: Array,
    vy: Array,
    at: Points,
    work: Ledger,
) -> None:
    """Add the work of the land that is touched."""
    for m in range(FEW, LAST):
        t, weight = at.t[m], WEIGHTS[m] * length
        if land == RELEASED:
            # The damper alone balances the land's spring.
            work.land_damping += weight * p.land_stiffness * value(w.depth, t) * slope(w.depth, t) / h
            continue
        # F_t v_s without the ring's speed: the work on the cage alone; c (d delta/dt)^2
        along = value(w.nx, t) * vy[m] - value(w.ny, t) * vx[m]
        work.land_friction += weight * value(w.tangent, t) * (along + p.land_side * at.vs[m])
        lost = value(w.normal, t) - p.land_stiffness * value(w.depth, t)
        work.land_damping -= weight * lost * slope(w.depth, t) / h


@inner_kernel
def traction_work(p: Coefficients, moving: Array, used: int, at: Points, length: float) -> float:
    """Work that the races take from the balls that move, over the mass of the cage."""
    total = 0.0
    for m in range(FEW, LAST, 2):
        power, later = traction_power(moving, used, at.t[m], at.t[m + 1])
        total += WEIGHTS[m] * power + WEIGHTS[m + 1] * later
    return total * length / p.lightness


@inner_kernel
def pocket_work(
    p: Coefficients,
    balls: Balls,
    w: Series,
    count: int,
    vx: float,
    vy: float,
    share: float,
    at: Points,
    m: int,
    weight: float,
    work: Ledger,
) -> None:
    """Add a point's share of the work of pockets, one by one; with inertia by the sums of the forces."""
    if has_inertia(p):
        work.pocket_friction -= weight * p.friction * (at.ex[m] * vx + at.ey[m] * vy)
        if harmonics(p) == 0:
            return
    t = at.t[m]
    grip = grip_at(w, t)
    for i in range(count):
        j = balls.touching[i]
        depth = depth_at(p, balls, w, grip, j, t)
        load = p.hertz * depth * math.sqrt(abs(depth)) if has_hertz_pockets(p) else p.stiffness * depth
        if not has_inertia(p):
            along = balls.cosine[j] * vx + balls.sine[j] * vy
            work.pocket_friction -= weight * p.friction * load * along
            work.race_dampers -= weight * p.yielding * share * load * load
        for k in range(2 * harmonics(p)):
            work.ball_drive -= weight * load * share * balls.drive[k, j] * value(w.frame[:, k], t)


@inner_kernel
def depth_at(
    p: Coefficients, balls: Balls, w: Series, grip: tuple[float, float, float, float], j: int, t: float
) -> float:
    """Penetration of a pocket in touch at a time of the step; `grip` as by `grip_at` there."""
    if has_own_series(p):
        return value(balls.depth[:, j], t)
    ex, ey, es, kept = grip
    depth: float = balls.penetration[j] * kept + ey * balls.cosine[j] - ex * balls.sine[j] + es
    for k in range(2 * harmonics(p)):
        depth -= balls.drive[k, j] * value(w.felt[:, k], t)
    return depth


@inlined_kernel
def enter_work(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    now: Pace,
    h: float,
    end: float,
    ledger: Ledger,
    room: Room,
) -> None:
    """Add the work of the step, up to `end`, to the ledger."""
    work = room.work
    work.pocket_friction = work.race_dampers = work.ball_drive = work.land_friction = 0.0
    work.land_damping = work.gravity = work.moving_frame = work.unbalance = 0.0
    add_work(p, balls, w, state, state.land, now, h, end, room, work)
    ledger.pocket_friction += work.pocket_friction
    ledger.gross += abs(work.pocket_friction)
    ledger.race_dampers += work.race_dampers
    ledger.gross += abs(work.race_dampers)
    ledger.ball_drive += work.ball_drive
    ledger.gross += abs(work.ball_drive)
    ledger.land_friction += work.land_friction
    ledger.gross += abs(work.land_friction)
    ledger.land_damping += work.land_damping
    ledger.gross += abs(work.land_damping)
    ledger.gravity += work.gravity
    ledger.gross += abs(work.gravity)
    ledger.moving_frame += work.moving_frame
    ledger.gross += abs(work.moving_frame)
    ledger.unbalance += work.unbalance
    ledger.gross += abs(work.unbalance)


@inner_kernel
def total_work(ledger: Ledger) -> float:
    """Sum of the work of all sources."""
    pockets = ledger.pocket_friction + ledger.race_dampers + ledger.ball_drive
    return (
        pockets + ledger.land_friction + ledger.land_damping + ledger.gravity + ledger.moving_frame
        + ledger.unbalance
    )  # fmt: skip
