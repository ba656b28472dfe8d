"""What a step adds to the evidence of a run: integrals, extremes, the ledger of work, and rows of history."""

from __future__ import annotations

import numpy as np

from separatrix.cage.events import penetration
from separatrix.cage.series import body_values, copy_column, peak, slope, travel, value
from separatrix.cage.slots import (
    BALL_DRIVE,
    BALLS,
    BODY,
    CLEAR,
    CLOCK,
    DEPTH,
    ES,
    EX,
    EY,
    FELT,
    FORCE_MAX,
    FRAME,
    GONE,
    GRAVITY,
    GROSS,
    GX,
    GY,
    KEPT,
    KINETIC,
    LAND_DAMPING,
    LAND_ENERGY,
    LAND_FRICTION,
    LAND_MAX,
    MEAN_X,
    MEAN_Y,
    MOVING_FRAME,
    NORMAL,
    NX,
    NY,
    OFFSET,
    OFFSET_MAX,
    OFFSET_SQUARED,
    POCKET_ENERGY,
    POCKET_FRICTION,
    RACE_DAMPERS,
    RELEASED,
    ROW_BALLS,
    ROW_LAND_ENERGY,
    ROW_LAND_FORCE,
    ROW_POCKET_ENERGY,
    ROW_WORK,
    SPEED_SQUARED,
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
from separatrix.compiled import kernel


def _gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss's points and weights on 0 to 1."""
    at, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (at + 1.0), 0.5 * weight


FEW_NODES, FEW_WEIGHTS = _gauss(4)
"""For means over a window: exact to the 7th power of the time in a step."""

NODES, WEIGHTS = _gauss(10)
"""For the ledger: exact to the 19th power, as the series themselves."""


@kernel
def enter_step(p, cos, sin, w, q, side, active, count, pressed, h, end, tally, c):  # type: ignore[no-untyped-def]
    """Add a step, up to `end`, to the tally of its window."""
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    length = end * h
    b = np.empty(BODY)
    ux, uy = w[0, VX], w[0, VY]
    for i in range(5):
        body_values(w, end * FEW_NODES[i] if i < 4 else end, b)
        x, y, vx, vy, spin = b[gx], b[gy], b[VX], b[VY], b[W]
        far = x * x + y * y
        tally[OFFSET_MAX] = max(tally[OFFSET_MAX], far)
        cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
        tally[TURNING] += cross * (1.0 + (cross / dot) ** 2 / 6.0) if abs(cross) < abs(dot) else cross
        ux, uy = vx, vy
        if i < 4:
            weight = FEW_WEIGHTS[i] * length
            tally[KINETIC] += weight * 0.5 * (vx * vx + vy * vy + p.inertia * spin * spin)
            tally[SPEED_SQUARED] += weight * (vx * vx + vy * vy)
            tally[OFFSET] += weight * np.sqrt(far)
            tally[OFFSET_SQUARED] += weight * far
            tally[SWEPT] += weight * (x * vy - y * vx)
            tally[MEAN_X] += weight * x
            tally[MEAN_Y] += weight * y
    far_felt = travel(w, EX) + travel(w, EY) + travel(w, ES) if p.harmonics == 0 else np.inf
    for i in range(count):
        j = active[i]
        if p.hertz == 0.0 and p.stiffness * (abs(q[j]) + far_felt) < tally[FORCE_MAX]:
            continue
        penetration(p, cos, sin, w, q, j, c)
        sign = float(side[j])
        if side[j] == 2:
            sign = 1.0 if q[j] > 0.0 else -1.0
        deepest = peak(c, sign, end)
        force = p.hertz * deepest**1.5 if p.hertz != 0.0 else p.stiffness * deepest
        tally[FORCE_MAX] = max(tally[FORCE_MAX], force)
    if pressed:
        copy_column(w, NORMAL, c)
        tally[LAND_MAX] = max(tally[LAND_MAX], peak(c, 1.0, end))


@kernel
def add_work(p, cos, sin, w, q, active, count, land, now, h, end, sums, work):  # type: ignore[no-untyped-def]
    """Add the work that each source does from the start of the step to `end`, by Gauss's rule."""
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    b = np.empty(BODY)
    alike = p.hertz == 0.0 and p.harmonics == 0
    squares = 0.0
    for i in range(count):
        squares += q[active[i]] ** 2
    for i in range(NODES.size):
        t, weight = end * NODES[i], WEIGHTS[i] * end * h
        body_values(w, t, b)
        share = now[0] + now[1] * h * t
        vx, vy = b[VX], b[VY]
        if p.eccentricity != 0.0:
            vx, vy = slope(w, GX, t) / h, slope(w, GY, t) / h
        if count == 0:
            pass
        elif alike:
            e, ex, ey, es = b[KEPT], b[EX], b[EY], b[ES]
            along_x = e * sums[5] + sums[0] * ey - sums[1] * ex + sums[3] * es
            along_y = e * sums[6] + sums[1] * ey - sums[2] * ex + sums[4] * es
            square = e * (e * squares + 2.0 * (ey * sums[5] - ex * sums[6] + es * sums[7]))
            square += ey * (sums[0] * ey - 2.0 * sums[1] * ex + 2.0 * sums[3] * es)
            square += ex * (sums[2] * ex - 2.0 * sums[4] * es) + count * es * es
            work[POCKET_FRICTION] -= weight * p.friction * p.stiffness * (along_x * vx + along_y * vy)
            work[RACE_DAMPERS] -= weight * p.yielding * share * p.stiffness**2 * square
        else:
            pocket_work(p, cos, sin, w, q, active, count, b, vx, vy, share, t, weight, work)
        if land != CLEAR and land != RELEASED:
            tangent, normal = value(w, TANGENT, t), value(w, NORMAL, t)
            along = value(w, NX, t) * vy - value(w, NY, t) * vx
            work[LAND_FRICTION] += weight * tangent * (along + p.land_side * b[W])
            lost = normal - p.land_stiffness * value(w, DEPTH, t)
            work[LAND_DAMPING] -= weight * lost * slope(w, DEPTH, t) / h
        elif land == RELEASED:
            # The damper holds the land's spring back alone.
            work[LAND_DAMPING] += weight * p.land_stiffness * value(w, DEPTH, t) * slope(w, DEPTH, t) / h
        if p.gravity != 0.0:
            pull = value(w, FRAME, t) * b[VX] - value(w, FRAME + 1, t) * b[VY]
            work[GRAVITY] += weight * p.gravity * pull
        second = (p.turning * share) ** 2
        work[MOVING_FRAME] += weight * second * (b[gx] * b[VX] + b[gy] * b[VY])
        work[UNBALANCE] += weight * second * ((b[X] - b[gx]) * b[VX] + (b[Y] - b[gy]) * b[VY])
        euler = b[Y] * b[VX] - b[X] * b[VY] - p.radius * p.inertia * b[W]
        work[MOVING_FRAME] += weight * p.turning * now[1] * euler


@kernel
def pocket_work(p, cos, sin, w, q, active, count, b, vx, vy, share, t, weight, work):  # type: ignore[no-untyped-def]
    """Add a node's share of the work of pockets, one by one."""
    for k in range(count):
        j = active[k]
        depth = depth_at(p, cos, sin, w, q, b, j, t)
        load = p.hertz * depth * np.sqrt(abs(depth)) if p.hertz != 0.0 else p.stiffness * depth
        work[POCKET_FRICTION] -= weight * p.friction * load * (cos[j] * vx + sin[j] * vy)
        work[RACE_DAMPERS] -= weight * p.yielding * share * load * load
        for m in range(2 * p.harmonics):
            work[BALL_DRIVE] -= weight * load * share * p.drive[m, j] * value(w, FRAME + m, t)


@kernel
def depth_at(p, cos, sin, w, q, b, j, t):  # type: ignore[no-untyped-def]
    """Penetration of a pocket in touch at a time of the step; `b` holds the body's values there."""
    if p.hertz != 0.0:
        return value(w, BALLS + j, t)
    depth = q[j] * b[KEPT] + b[EY] * cos[j] - b[EX] * sin[j] + b[ES]
    for k in range(2 * p.harmonics):
        depth -= p.drive[k, j] * value(w, FELT + k, t)
    return depth


@kernel
def pocket_energy(p, depth):  # type: ignore[no-untyped-def]
    """Energy in the spring of a pocket, over the mass."""
    size = abs(depth)
    if p.hertz != 0.0:
        return 0.4 * p.hertz * (size**2.5 - p.onset**2.5)
    return 0.5 * p.stiffness * size * size


@kernel
def enter_work(p, cos, sin, w, q, active, count, land, now, h, end, sums, ledger):  # type: ignore[no-untyped-def]
    """Add the work of the step, up to `end`, to the ledger."""
    work = np.zeros(WORKS)
    add_work(p, cos, sin, w, q, active, count, land, now, h, end, sums, work)
    for k in range(WORKS):
        ledger[k] += work[k]
        ledger[GROSS] += abs(work[k])
    b = np.empty(BODY)
    body_values(w, end, b)
    ledger[POCKET_ENERGY] = 0.0
    for i in range(count):
        ledger[POCKET_ENERGY] += pocket_energy(p, depth_at(p, cos, sin, w, q, b, active[i], end))
    ledger[LAND_ENERGY] = 0.0
    if land != CLEAR:
        ledger[LAND_ENERGY] = 0.5 * p.land_stiffness * value(w, DEPTH, end) ** 2


@kernel
def record(  # type: ignore[no-untyped-def]
    p, cos, sin, half, w, s, lead, q, side, active, count, land, now, h, end, sums, ledger, rows, filled
):
    """Write the rows of the history that are due within the step; return how many there are."""
    gx, gy = (GX, GY) if p.eccentricity != 0.0 else (X, Y)
    until = (s[CLOCK] + end * h) * (1.0 + 1e-12)
    balls = cos.size
    b, work = np.empty(BODY), np.zeros(WORKS)
    while filled < rows.shape[0] and rows[filled, CLOCK] <= until:
        row = rows[filled]
        t = min(end, max(0.0, (row[CLOCK] - s[CLOCK]) / h))
        body_values(w, t, b)
        row[X], row[Y] = b[gx], b[gy]
        row[VX], row[VY], row[S], row[W] = b[VX], b[VY], b[S], b[W]
        work[:] = ledger[:WORKS]
        add_work(p, cos, sin, w, q, active, count, land, now, h, t, sums, work)
        row[ROW_WORK : ROW_WORK + WORKS] = work
        if land != CLEAR:
            row[ROW_LAND_ENERGY] = 0.5 * p.land_stiffness * value(w, DEPTH, t) ** 2
        if land != CLEAR and land != RELEASED:
            row[ROW_LAND_FORCE] = value(w, NORMAL, t)
        for j in range(balls):
            row[ROW_BALLS + j] = lead[j]
            if side[j] == 0:
                for k in range(2 * p.harmonics):
                    row[ROW_BALLS + j] += p.drive[k, j] * value(w, GONE + k, t)
        row[ROW_POCKET_ENERGY] = 0.0
        for i in range(count):
            j = active[i]
            depth = depth_at(p, cos, sin, w, q, b, j, t)
            row[ROW_POCKET_ENERGY] += pocket_energy(p, depth)
            edge = 0.0 if side[j] == 2 else side[j] * half[j]
            row[ROW_BALLS + j] = b[gy] * cos[j] - b[gx] * sin[j] + b[S] - edge - depth
            row[ROW_BALLS + balls + j] = p.stiffness * depth
            if p.hertz != 0.0:
                row[ROW_BALLS + balls + j] = p.hertz * depth * np.sqrt(abs(depth))
        filled += 1
    return filled
