"""What a step adds to the evidence of a run: integrals, extremes, the ledger of work, and rows of history."""

from __future__ import annotations

import math

import numpy as np

from separatrix.cage.ending import Look
from separatrix.cage.events import penetration
from separatrix.cage.records import (
    CLEAR,
    RELEASED,
    SPEED,
    STICK,
    WAY,
    Balls,
    Coefficients,
    Ledger,
    Pace,
    Room,
    Samples,
    Series,
    State,
    Sums,
)
from separatrix.cage.series import Motion, centre, copy_column, grip_at, motion_at, peak, slope, value
from separatrix.cage.traction import moving_at, traction_power
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


def _gauss(points: int) -> tuple[Array, Array]:
    """Gauss's points and weights on 0 to 1."""
    at, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (at + 1.0), 0.5 * weight


FEW_NODES, FEW_WEIGHTS = _gauss(4)
"""For means over a window: exact to the 7th power of the time in a step."""

NODES, WEIGHTS = _gauss(7)
"""For the ledger: exact to the 13th power of the time; it closes to 1e-12 with them."""


@inlined_kernel
def enter_step(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    deepest: float,
    h: float,
    end: float,
    after: Motion,
    look: Look,
    room: Room,
) -> None:
    """Add a step, up to `end`, to the tally of its look."""
    length = end * h
    gx, gy = centre(p, w)
    ux, uy, late = w[0].vx, w[0].vy, 0.0
    was_far, leaving = gx[0] * gx[0] + gy[0] * gy[0], gx[0] * ux + gy[0] * uy
    twice, squared, turned, farthest = 2.0 * look.kinetic, look.speed_squared, look.turning, look.offset_max
    offset, offset_squared, swept = look.offset, look.offset_squared, look.swept
    mean_x, mean_y = look.mean_x, look.mean_y
    for i in range(5):
        t = end * FEW_NODES[i] if i < 4 else end
        x, y, vx, vy, _, vs = motion_at(w, t) if i < 4 else after
        if p.eccentricity != 0.0:
            x, y = value(gx, t), value(gy, t)
        far = x * x + y * y
        going = x * vx + y * vy
        if leaving > 0.0 > going:
            # The largest is between: by parabolas from both sides.
            at, gap = leaving / (leaving - going), (t - late) * h
            between = 0.5 * (was_far + far + gap * (leaving * at - going * (1.0 - at)))
            farthest = max(farthest, between)
        farthest = max(farthest, far)
        late, was_far, leaving = t, far, going
        cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
        size = math.sqrt(cross * cross + dot * dot)
        # An angle over its sine, to its 6th power: (14 + cos) / (9 + 6 cos).
        turned += cross * (14.0 * size + dot) / (9.0 * size + 6.0 * dot) if size > 0.0 else 0.0
        ux, uy = vx, vy
        if i < 4:
            weight = FEW_WEIGHTS[i] * length
            speed_squared = vx * vx + vy * vy
            twice += weight * (speed_squared + p.inertia * vs * vs)
            squared += weight * speed_squared
            offset += weight * math.sqrt(far)
            offset_squared += weight * far
            swept += weight * (x * vy - y * vx)
            mean_x += weight * x
            mean_y += weight * y
    look.kinetic, look.speed_squared, look.turning, look.offset_max = 0.5 * twice, squared, turned, farthest
    look.offset, look.offset_squared, look.swept = offset, offset_squared, swept
    look.mean_x, look.mean_y = mean_x, mean_y
    if p.hertz != 0.0 or p.stiffness * deepest > look.force_max:
        enter_force(p, balls, w, state.touching, end, look, room.c)
    if state.land != CLEAR and state.land != RELEASED:
        copy_column(w.normal, room.c)
        look.land_max = max(look.land_max, peak(room.c, 1.0, end))
        for i in range(4):
            impulse = FEW_WEIGHTS[i] * length * value(w.normal, end * FEW_NODES[i])
            look.pressed += impulse
            if state.land != STICK:
                look.rubbed += impulse * abs(value(w.sliding, end * FEW_NODES[i]))


@inner_kernel
def enter_force(
    p: Coefficients, balls: Balls, w: Series, count: int, end: float, look: Look, c: Array
) -> None:
    """Add the largest forces of the pockets in touch, up to `end`, to the tally of its look."""
    for i in range(count):
        j = balls.touching[i]
        penetration(p, balls, w, j, c)
        sign = float(balls.side[j])
        if balls.side[j] == 2:
            sign = 1.0 if balls.penetration[j] > 0.0 else -1.0
        deepest = peak(c, sign, end)
        force = p.hertz * deepest**1.5 if p.hertz != 0.0 else p.stiffness * deepest
        look.force_max = max(look.force_max, force)


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
    sums: Sums,
    work: Ledger,
) -> None:
    """Add the work that each source does from the start of the step to `end`, by Gauss's rule."""
    gx, gy = centre(p, w)
    alike, count = not p.own and p.harmonics == 0, state.touching
    squares = 0.0
    if p.inertial:
        work.race_dampers -= traction_work(p, balls.moving, count + state.coasting, end * h, end)
    for i in range(count):
        squares += balls.penetration[balls.touching[i]] ** 2
    for i in range(NODES.size):
        t, weight = end * NODES[i], WEIGHTS[i] * end * h
        mx, my, ux, uy, _, vs = motion_at(w, t)
        share = now.share + now.rise * h * t
        x, y, vx, vy = mx, my, ux, uy
        if p.eccentricity != 0.0:
            x, y = value(gx, t), value(gy, t)
            vx, vy = slope(gx, t) / h, slope(gy, t) / h
        if count == 0:
            pass
        elif alike:
            # sum_j N_j e_r . v and sum_j N_j^2 of all pockets in touch, by the sums of `gather`:
            # friction does -sigma f sum_j N_j e_r . v, the dampers take sum_j N_j^2 / C_mu
            ex, ey, es, e = grip_at(w, t)
            along_x = e * sums.qc + sums.cc * ey - sums.cs * ex + sums.c * es
            along_y = e * sums.qs + sums.cs * ey - sums.ss * ex + sums.s * es
            square = e * (e * squares + 2.0 * (ey * sums.qc - ex * sums.qs + es * sums.q))
            square += ey * (sums.cc * ey - 2.0 * sums.cs * ex + 2.0 * sums.c * es)
            square += ex * (sums.ss * ex - 2.0 * sums.s * es) + count * es * es
            work.pocket_friction -= weight * p.friction * p.stiffness * (along_x * vx + along_y * vy)
            work.race_dampers -= weight * p.yielding * share * p.stiffness**2 * square
        else:
            pocket_work(p, balls, w, count, vx, vy, share, t, weight, work)
        if land != CLEAR and land != RELEASED:
            # F_t v_s without the ring's speed: the work on the cage alone; c (d delta/dt)^2
            tangent, normal = value(w.tangent, t), value(w.normal, t)
            along = value(w.nx, t) * vy - value(w.ny, t) * vx
            work.land_friction += weight * tangent * (along + p.land_side * vs)
            lost = normal - p.land_stiffness * value(w.depth, t)
            work.land_damping -= weight * lost * slope(w.depth, t) / h
        elif land == RELEASED:
            # The damper alone balances the land's spring.
            work.land_damping += weight * p.land_stiffness * value(w.depth, t) * slope(w.depth, t) / h
        if p.gravity != 0.0:
            pull = value(w.frame[:, 0], t) * ux - value(w.frame[:, 1], t) * uy
            work.gravity += weight * p.gravity * pull
        # Omega^2 r . v, of which the part of the unbalance is Omega^2 epsilon . v; in a ramp also
        # Omega' (y v_x - x v_y - R^2 d(theta)/dt J / M R^2)
        second = (p.turning * share) ** 2
        work.moving_frame += weight * second * (x * ux + y * uy)
        work.unbalance += weight * second * ((mx - x) * ux + (my - y) * uy)
        euler = my * ux - mx * uy - p.radius * p.inertia * vs
        work.moving_frame += weight * p.turning * now.rise * euler


@inner_kernel
def traction_work(p: Coefficients, moving: Array, used: int, length: float, end: float) -> float:
    """Work that the races take from the balls that move up to `end`, over the mass of the cage."""
    total = 0.0
    for i in range(NODES.size):
        total += WEIGHTS[i] * traction_power(p, moving, used, end * NODES[i])
    return total * length


@inner_kernel
def pocket_work(
    p: Coefficients,
    balls: Balls,
    w: Series,
    count: int,
    vx: float,
    vy: float,
    share: float,
    t: float,
    weight: float,
    work: Ledger,
) -> None:
    """Add a node's share of the work of pockets, one by one; with inertia by the sums of the forces."""
    if p.inertial:
        along = value(w.ex, t) * vx + value(w.ey, t) * vy
        work.pocket_friction -= weight * p.friction * along
        if p.harmonics == 0:
            return
    grip = grip_at(w, t)
    for i in range(count):
        j = balls.touching[i]
        depth = depth_at(p, balls, w, grip, j, t)
        load = p.hertz * depth * math.sqrt(abs(depth)) if p.hertz != 0.0 else p.stiffness * depth
        if not p.inertial:
            along = balls.cosine[j] * vx + balls.sine[j] * vy
            work.pocket_friction -= weight * p.friction * load * along
            work.race_dampers -= weight * p.yielding * share * load * load
        for k in range(2 * p.harmonics):
            work.ball_drive -= weight * load * share * balls.drive[k, j] * value(w.frame[:, k], t)


@inner_kernel
def depth_at(
    p: Coefficients, balls: Balls, w: Series, grip: tuple[float, float, float, float], j: int, t: float
) -> float:
    """Penetration of a pocket in touch at a time of the step; `grip` as by `grip_at` there."""
    if p.own:
        return value(balls.depth[:, j], t)
    ex, ey, es, kept = grip
    depth: float = balls.penetration[j] * kept + ey * balls.cosine[j] - ex * balls.sine[j] + es
    for k in range(2 * p.harmonics):
        depth -= balls.drive[k, j] * value(w.felt[:, k], t)
    return depth


@inner_kernel
def pocket_energy(p: Coefficients, depth: float) -> float:
    """Energy in the spring of a pocket, over the mass."""
    # k q^2 / 2, or 2/5 K (q^2.5 - onset^2.5)
    size = abs(depth)
    if p.hertz != 0.0:
        return float(0.4 * p.hertz * (size**2.5 - p.onset**2.5))
    return 0.5 * p.stiffness * size * size


@inlined_kernel
def copy_work(ledger: Ledger, work: Ledger) -> None:
    """Copy the work of every source."""
    work.pocket_friction, work.race_dampers = ledger.pocket_friction, ledger.race_dampers
    work.ball_drive, work.land_friction = ledger.ball_drive, ledger.land_friction
    work.land_damping, work.gravity = ledger.land_damping, ledger.gravity
    work.moving_frame, work.unbalance = ledger.moving_frame, ledger.unbalance


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
    add_work(p, balls, w, state, state.land, now, h, end, room.sums, work)
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


@inner_kernel
def record(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    now: Pace,
    h: float,
    end: float,
    ledger: Ledger,
    samples: Samples,
    room: Room,
) -> None:
    """Write the rows of the history that are due within the step."""
    until = (state.clock + end * h) * (1.0 + 1e-12)
    count, land = state.touching, state.land
    while state.rows < len(samples.row) and samples.row[state.rows].clock <= until:
        row, lead, force = samples.row[state.rows], samples.lead[state.rows], samples.force[state.rows]
        speed = samples.speed[state.rows]
        t = min(end, max(0.0, (row.clock - state.clock) / h))
        x, y, row.vx, row.vy, slip, row.vs = motion_at(w, t)
        if p.eccentricity != 0.0:
            x, y = value(w.gx, t), value(w.gy, t)
        row.x, row.y, row.s = x, y, slip
        copy_work(ledger, samples.work[state.rows])
        add_work(p, balls, w, state, land, now, h, t, room.sums, samples.work[state.rows])
        grip = grip_at(w, t)
        if land != CLEAR:
            row.land_energy = 0.5 * p.land_stiffness * value(w.depth, t) ** 2
        if land != CLEAR and land != RELEASED:
            row.land_force = value(w.normal, t)
        for j in range(balls.play.size):
            lead[j] = balls.lead[j]
            if balls.side[j] == 0:
                for k in range(2 * p.harmonics):
                    lead[j] += balls.drive[k, j] * value(w.gone[:, k], t)
            if balls.own_speed[j] != 0.0 and balls.side[j] == 0:
                lead[j] += moving_at(balls, WAY, balls.slot[j], t)
                speed[j] = moving_at(balls, SPEED, balls.slot[j], t)
        row.pocket_energy = 0.0
        for i in range(count):
            j = balls.touching[i]
            depth = depth_at(p, balls, w, grip, j, t)
            row.pocket_energy += pocket_energy(p, depth)
            edge = 0.0 if balls.side[j] == 2 else balls.side[j] * balls.play[j]
            lead[j] = y * balls.cosine[j] - x * balls.sine[j] + slip - edge - depth
            force[j] = p.stiffness * depth
            if p.hertz != 0.0:
                force[j] = p.hertz * depth * math.sqrt(abs(depth))
            speed[j] = p.yielding * (now.share + now.rise * h * t) * force[j]
            if p.inertial:
                speed[j] = moving_at(balls, SPEED, i, t)
        state.rows += 1
