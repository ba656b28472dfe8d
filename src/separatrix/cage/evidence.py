"""What a step adds to the evidence of a run: integrals, extremes, and rows of history."""

from __future__ import annotations

import math

from separatrix.cage.ending import Look
from separatrix.cage.events import penetration
from separatrix.cage.features import harmonics, has_hertz_pockets, has_inertia, has_unbalance
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
)
from separatrix.cage.series import centre, copy_column, grip_at, motion_at, peak, value
from separatrix.cage.traction import moving_at
from separatrix.cage.work import FEW, LAST, WEIGHTS, add_work, depth_at
from separatrix.compiled import inlined_kernel, inner_kernel


@inlined_kernel
def enter_step(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    deepest: float,
    h: float,
    end: float,
    look: Look,
    room: Room,
) -> None:
    """Add a step, up to `end`, to the tally of its look, from its motion by `place_points`."""
    length, at = end * h, room.points
    gx, gy = centre(p, w)
    ux, uy, late = w[0].vx, w[0].vy, 0.0
    was_far, leaving = gx[0] * gx[0] + gy[0] * gy[0], gx[0] * ux + gy[0] * uy
    twice, squared, turned, farthest = 2.0 * look.kinetic, look.speed_squared, look.turning, look.offset_max
    offset, offset_squared, swept = look.offset, look.offset_squared, look.swept
    mean_x, mean_y = look.mean_x, look.mean_y
    for i in range(FEW + 1):
        m = i if i < FEW else LAST
        t, x, y, vx, vy, vs = at.t[m], at.x[m], at.y[m], at.vx[m], at.vy[m], at.vs[m]
        if has_unbalance(p):
            x, y = at.gx[m], at.gy[m]
        far = x * x + y * y
        going = x * vx + y * vy
        if leaving > 0.0 > going:
            # The largest is between: by parabolas from both sides.
            part, gap = leaving / (leaving - going), (t - late) * h
            between = 0.5 * (was_far + far + gap * (leaving * part - going * (1.0 - part)))
            farthest = max(farthest, between)
        farthest = max(farthest, far)
        late, was_far, leaving = t, far, going
        cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
        size = math.sqrt(cross * cross + dot * dot)
        # An angle over its sine, to its 6th power: (14 + cos) / (9 + 6 cos).
        turned += cross * (14.0 * size + dot) / (9.0 * size + 6.0 * dot) if size > 0.0 else 0.0
        ux, uy = vx, vy
        if i < FEW:
            weight = WEIGHTS[i] * length
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
    if has_hertz_pockets(p) or p.stiffness * deepest > look.force_max:
        enter_force(p, balls, w, state.touching, end, look, room)
    if state.land != CLEAR and state.land != RELEASED:
        copy_column(w.normal, room.c)
        look.land_max = max(look.land_max, peak(room.c, 1.0, end))
        for i in range(FEW):
            impulse = WEIGHTS[i] * length * value(w.normal, at.t[i])
            look.pressed += impulse
            if state.land != STICK:
                look.rubbed += impulse * abs(value(w.sliding, at.t[i]))


@inner_kernel
def enter_force(
    p: Coefficients, balls: Balls, w: Series, count: int, end: float, look: Look, room: Room
) -> None:
    """Add the largest forces of the pockets in touch, up to `end`, to the tally of its look."""
    c = room.c
    for i in range(count):
        if not has_hertz_pockets(p) and p.stiffness * room.depths[i] <= look.force_max:
            continue
        j = balls.touching[i]
        penetration(p, balls, w, j, c)
        sign = float(balls.side[j])
        if balls.side[j] == 2:
            sign = 1.0 if balls.penetration[j] > 0.0 else -1.0
        deepest = peak(c, sign, end)
        force = p.hertz * deepest**1.5 if has_hertz_pockets(p) else p.stiffness * deepest
        look.force_max = max(look.force_max, force)


@inner_kernel
def pocket_energy(p: Coefficients, depth: float) -> float:
    """Energy in the spring of a pocket, over the mass."""
    # k q^2 / 2, or 2/5 K (q^2.5 - onset^2.5)
    size = abs(depth)
    if has_hertz_pockets(p):
        return float(0.4 * p.hertz * (size**2.5 - p.onset**2.5))
    return 0.5 * p.stiffness * size * size


@inlined_kernel
def copy_work(ledger: Ledger, work: Ledger) -> None:
    """Copy the work of every source."""
    work.pocket_friction, work.race_dampers = ledger.pocket_friction, ledger.race_dampers
    work.ball_drive, work.land_friction = ledger.ball_drive, ledger.land_friction
    work.land_damping, work.gravity = ledger.land_damping, ledger.gravity
    work.moving_frame, work.unbalance = ledger.moving_frame, ledger.unbalance


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
        if has_unbalance(p):
            x, y = value(w.gx, t), value(w.gy, t)
        row.x, row.y, row.s = x, y, slip
        copy_work(ledger, samples.work[state.rows])
        add_work(p, balls, w, state, land, now, h, t, room, samples.work[state.rows])
        grip = grip_at(w, t)
        if land != CLEAR:
            row.land_energy = 0.5 * p.land_stiffness * value(w.depth, t) ** 2
        if land != CLEAR and land != RELEASED:
            row.land_force = value(w.normal, t)
        for j in range(balls.play.size):
            lead[j] = balls.lead[j]
            if balls.side[j] == 0:
                for k in range(2 * harmonics(p)):
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
            if has_hertz_pockets(p):
                force[j] = p.hertz * depth * math.sqrt(abs(depth))
            speed[j] = p.yielding * (now.share + now.rise * h * t) * force[j]
            if has_inertia(p):
                speed[j] = moving_at(balls, SPEED, i, t)
        state.rows += 1
