"""What a step adds to the evidence of a run: integrals, extremes, the ledger of work, and rows of history."""

from __future__ import annotations

import numpy as np

from separatrix.cage.events import penetration
from separatrix.cage.series import copy_column, grip_at, motion_at, peak, slope, value
from separatrix.cage.slots import (
    BALL_DRIVE,
    BALLS,
    CLEAR,
    CLOCK,
    COSINE,
    DEPTH,
    DRIVE,
    FELT,
    FORCE_MAX,
    FRAME,
    GONE,
    GRAVITY,
    GROSS,
    GX,
    GY,
    KINETIC,
    LAND_DAMPING,
    LAND_FRICTION,
    LAND_MAX,
    LEAD,
    LIST,
    MEAN_X,
    MEAN_Y,
    MOVING_FRAME,
    NORMAL,
    NX,
    NY,
    OFFSET,
    OFFSET_MAX,
    OFFSET_SQUARED,
    PENETRATION,
    PLAY,
    POCKET_FRICTION,
    PRESSED,
    RACE_DAMPERS,
    RELEASED,
    ROW_BALLS,
    ROW_LAND_ENERGY,
    ROW_LAND_FORCE,
    ROW_POCKET_ENERGY,
    ROW_WORK,
    RUBBED,
    SIDE,
    SINE,
    SLIDING,
    SPEED_SQUARED,
    STICK,
    SWEPT,
    TANGENT,
    TURNING,
    UNBALANCE,
    VX,
    VY,
    WORKS,
    S,
    W,
    X,
    Y,
)
from separatrix.compiled import inlined_kernel, inner_kernel


def _gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss's points and weights on 0 to 1."""
    at, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (at + 1.0), 0.5 * weight


FEW_NODES, FEW_WEIGHTS = _gauss(4)
"""For means over a window: exact to the 7th power of the time in a step."""

NODES, WEIGHTS = _gauss(7)
"""For the ledger: exact to the 13th power of the time; it closes to 1e-12 with them."""


@inlined_kernel
def enter_step(p, pockets, touch, w, count, land, deepest, h, end, after, tally, c):  # type: ignore[no-untyped-def]
    """Add a step, up to `end`, to the tally of its look."""
    length = end * h
    ux, uy = w[0, VX], w[0, VY]
    gx, gy = (w[0, GX], w[0, GY]) if p.eccentricity != 0.0 else (w[0, X], w[0, Y])
    late, was_far, leaving, farthest = 0.0, gx * gx + gy * gy, gx * ux + gy * uy, tally[OFFSET_MAX]
    twice, squared, turned = 2.0 * tally[KINETIC], tally[SPEED_SQUARED], tally[TURNING]
    offset, offset_squared, swept = tally[OFFSET], tally[OFFSET_SQUARED], tally[SWEPT]
    mean_x, mean_y = tally[MEAN_X], tally[MEAN_Y]
    for i in range(5):
        t = end * FEW_NODES[i] if i < 4 else end
        x, y, vx, vy, _, spin = motion_at(w, t) if i < 4 else after
        if p.eccentricity != 0.0:
            x, y = value(w, GX, t), value(w, GY, t)
        far = x * x + y * y
        going = x * vx + y * vy
        if leaving > 0.0 > going:
            # The largest lies between: by parabolas from both sides.
            at, gap = leaving / (leaving - going), (t - late) * h
            between = 0.5 * (was_far + far + gap * (leaving * at - going * (1.0 - at)))
            farthest = max(farthest, between)
        farthest = max(farthest, far)
        late, was_far, leaving = t, far, going
        cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
        size = np.sqrt(cross * cross + dot * dot)
        # An angle over its sine, to its 6th power: (14 + cos) / (9 + 6 cos).
        turned += cross * (14.0 * size + dot) / (9.0 * size + 6.0 * dot) if size > 0.0 else 0.0
        ux, uy = vx, vy
        if i < 4:
            weight = FEW_WEIGHTS[i] * length
            speed_squared = vx * vx + vy * vy
            twice += weight * (speed_squared + p.inertia * spin * spin)
            squared += weight * speed_squared
            offset += weight * np.sqrt(far)
            offset_squared += weight * far
            swept += weight * (x * vy - y * vx)
            mean_x += weight * x
            mean_y += weight * y
    tally[KINETIC], tally[SPEED_SQUARED], tally[TURNING] = 0.5 * twice, squared, turned
    tally[OFFSET], tally[OFFSET_SQUARED], tally[SWEPT] = offset, offset_squared, swept
    tally[MEAN_X], tally[MEAN_Y], tally[OFFSET_MAX] = mean_x, mean_y, farthest
    if p.hertz != 0.0 or p.stiffness * deepest > tally[FORCE_MAX]:
        enter_force(p, pockets, touch, w, count, end, tally, c)
    if land != CLEAR and land != RELEASED:
        copy_column(w, NORMAL, c)
        tally[LAND_MAX] = max(tally[LAND_MAX], peak(c, 1.0, end))
        for i in range(4):
            impulse = FEW_WEIGHTS[i] * length * value(w, NORMAL, end * FEW_NODES[i])
            tally[PRESSED] += impulse
            if land != STICK:
                tally[RUBBED] += impulse * abs(value(w, SLIDING, end * FEW_NODES[i]))


@inner_kernel
def enter_force(p, pockets, touch, w, count, end, tally, c):  # type: ignore[no-untyped-def]
    """Add the largest forces of the pockets in touch, up to `end`, to the tally of its look."""
    for i in range(count):
        j = touch[LIST, i]
        penetration(p, pockets, w, j, c)
        sign = float(touch[SIDE, j])
        if touch[SIDE, j] == 2:
            sign = 1.0 if pockets[PENETRATION, j] > 0.0 else -1.0
        deepest = peak(c, sign, end)
        force = p.hertz * deepest**1.5 if p.hertz != 0.0 else p.stiffness * deepest
        tally[FORCE_MAX] = max(tally[FORCE_MAX], force)


@inner_kernel
def add_work(p, pockets, touch, w, count, land, now, h, end, sums, work):  # type: ignore[no-untyped-def]
    """Add the work that each source does from the start of the step to `end`, by Gauss's rule."""
    alike = p.hertz == 0.0 and p.harmonics == 0
    squares = 0.0
    for i in range(count):
        squares += pockets[PENETRATION, touch[LIST, i]] ** 2
    for i in range(NODES.size):
        t, weight = end * NODES[i], WEIGHTS[i] * end * h
        mx, my, ux, uy, _, spin = motion_at(w, t)
        share = now[0] + now[1] * h * t
        x, y, vx, vy = mx, my, ux, uy
        if p.eccentricity != 0.0:
            x, y = value(w, GX, t), value(w, GY, t)
            vx, vy = slope(w, GX, t) / h, slope(w, GY, t) / h
        if count == 0:
            pass
        elif alike:
            ex, ey, es, e = grip_at(w, t)
            along_x = e * sums[5] + sums[0] * ey - sums[1] * ex + sums[3] * es
            along_y = e * sums[6] + sums[1] * ey - sums[2] * ex + sums[4] * es
            square = e * (e * squares + 2.0 * (ey * sums[5] - ex * sums[6] + es * sums[7]))
            square += ey * (sums[0] * ey - 2.0 * sums[1] * ex + 2.0 * sums[3] * es)
            square += ex * (sums[2] * ex - 2.0 * sums[4] * es) + count * es * es
            work[POCKET_FRICTION] -= weight * p.friction * p.stiffness * (along_x * vx + along_y * vy)
            work[RACE_DAMPERS] -= weight * p.yielding * share * p.stiffness**2 * square
        else:
            pocket_work(p, pockets, touch, w, count, vx, vy, share, t, weight, work)
        if land != CLEAR and land != RELEASED:
            tangent, normal = value(w, TANGENT, t), value(w, NORMAL, t)
            along = value(w, NX, t) * vy - value(w, NY, t) * vx
            work[LAND_FRICTION] += weight * tangent * (along + p.land_side * spin)
            lost = normal - p.land_stiffness * value(w, DEPTH, t)
            work[LAND_DAMPING] -= weight * lost * slope(w, DEPTH, t) / h
        elif land == RELEASED:
            # The damper holds the land's spring back alone.
            work[LAND_DAMPING] += weight * p.land_stiffness * value(w, DEPTH, t) * slope(w, DEPTH, t) / h
        if p.gravity != 0.0:
            pull = value(w, FRAME, t) * ux - value(w, FRAME + 1, t) * uy
            work[GRAVITY] += weight * p.gravity * pull
        second = (p.turning * share) ** 2
        work[MOVING_FRAME] += weight * second * (x * ux + y * uy)
        work[UNBALANCE] += weight * second * ((mx - x) * ux + (my - y) * uy)
        euler = my * ux - mx * uy - p.radius * p.inertia * spin
        work[MOVING_FRAME] += weight * p.turning * now[1] * euler


@inner_kernel
def pocket_work(p, pockets, touch, w, count, vx, vy, share, t, weight, work):  # type: ignore[no-untyped-def]
    """Add a node's share of the work of pockets, one by one."""
    grip = grip_at(w, t)
    for k in range(count):
        j = touch[LIST, k]
        depth = depth_at(p, pockets, w, grip, j, t)
        load = p.hertz * depth * np.sqrt(abs(depth)) if p.hertz != 0.0 else p.stiffness * depth
        work[POCKET_FRICTION] -= (
            weight * p.friction * load * (pockets[COSINE, j] * vx + pockets[SINE, j] * vy)
        )
        work[RACE_DAMPERS] -= weight * p.yielding * share * load * load
        for m in range(2 * p.harmonics):
            work[BALL_DRIVE] -= weight * load * share * pockets[DRIVE + m, j] * value(w, FRAME + m, t)


@inner_kernel
def depth_at(p, pockets, w, grip, j, t):  # type: ignore[no-untyped-def]
    """Penetration of a pocket in touch at a time of the step; `grip` as by `grip_at` there."""
    if p.hertz != 0.0:
        return value(w, BALLS + j, t)
    ex, ey, es, kept = grip
    depth = pockets[PENETRATION, j] * kept + ey * pockets[COSINE, j] - ex * pockets[SINE, j] + es
    for k in range(2 * p.harmonics):
        depth -= pockets[DRIVE + k, j] * value(w, FELT + k, t)
    return depth


@inner_kernel
def pocket_energy(p, depth):  # type: ignore[no-untyped-def]
    """Energy in the spring of a pocket, over the mass."""
    size = abs(depth)
    if p.hertz != 0.0:
        return 0.4 * p.hertz * (size**2.5 - p.onset**2.5)
    return 0.5 * p.stiffness * size * size


@inner_kernel
def enter_work(p, pockets, touch, w, count, land, now, h, end, sums, ledger, work):  # type: ignore[no-untyped-def]
    """Add the work of the step, up to `end`, to the ledger."""
    for k in range(WORKS):
        work[k] = 0.0
    add_work(p, pockets, touch, w, count, land, now, h, end, sums, work)
    for k in range(WORKS):
        ledger[k] += work[k]
        ledger[GROSS] += abs(work[k])


@inner_kernel
def record(  # type: ignore[no-untyped-def]
    p, pockets, touch, w, s, count, land, now, h, end, sums, ledger, rows, filled, work
):
    """Write the rows of the history that are due within the step; return how many there are."""
    until = (s[CLOCK] + end * h) * (1.0 + 1e-12)
    balls = pockets.shape[1]
    while filled < rows.shape[0] and rows[filled, CLOCK] <= until:
        row = rows[filled]
        t = min(end, max(0.0, (row[CLOCK] - s[CLOCK]) / h))
        x, y, row[VX], row[VY], slip, row[W] = motion_at(w, t)
        if p.eccentricity != 0.0:
            x, y = value(w, GX, t), value(w, GY, t)
        row[X], row[Y], row[S] = x, y, slip
        for k in range(WORKS):
            work[k] = ledger[k]
        add_work(p, pockets, touch, w, count, land, now, h, t, sums, work)
        for k in range(WORKS):
            row[ROW_WORK + k] = work[k]
        grip = grip_at(w, t)
        if land != CLEAR:
            row[ROW_LAND_ENERGY] = 0.5 * p.land_stiffness * value(w, DEPTH, t) ** 2
        if land != CLEAR and land != RELEASED:
            row[ROW_LAND_FORCE] = value(w, NORMAL, t)
        for j in range(balls):
            row[ROW_BALLS + j] = pockets[LEAD, j]
            if touch[SIDE, j] == 0:
                for k in range(2 * p.harmonics):
                    row[ROW_BALLS + j] += pockets[DRIVE + k, j] * value(w, GONE + k, t)
        row[ROW_POCKET_ENERGY] = 0.0
        for i in range(count):
            j = touch[LIST, i]
            depth = depth_at(p, pockets, w, grip, j, t)
            row[ROW_POCKET_ENERGY] += pocket_energy(p, depth)
            edge = 0.0 if touch[SIDE, j] == 2 else touch[SIDE, j] * pockets[PLAY, j]
            row[ROW_BALLS + j] = y * pockets[COSINE, j] - x * pockets[SINE, j] + slip - edge - depth
            row[ROW_BALLS + balls + j] = p.stiffness * depth
            if p.hertz != 0.0:
                row[ROW_BALLS + balls + j] = p.hertz * depth * np.sqrt(abs(depth))
        filled += 1
    return filled
