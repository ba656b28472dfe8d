r"""Balls with inertia among races whose traction saturates, as power series.

A ball goes at the speed :math:`u` beyond its free orbit, :math:`m_e\dot u = N - F(u)`, with
:math:`F(u) = \sum_i C_i c / (1 + (c/v_i)^n)^{1/n}`, n = 2 or 4, of the creep :math:`c = u/\lambda`: in a
ramp all speeds are a share :math:`\lambda` of their values, and traction is a matter of their ratio. A ball
that no pocket touches coasts by itself until it is at rest in its free orbit.
"""

from __future__ import annotations

import math

from separatrix.cage.records import (
    AT_END,
    BENT,
    CREEP,
    FOURTH,
    GRIP,
    LANES,
    ORDER,
    SPEED,
    SQUARE,
    TRACTION,
    WAY,
    Balls,
    Candidate,
    Coefficients,
    Ledger,
    Pace,
    Room,
    Series,
    State,
    Whole,
)
from separatrix.cage.series import AFTER, Place, bends, centre, copy_column, gone_at, knots, value
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inner_kernel
def moving_at(balls: Balls, quantity: int, slot: int, t: float) -> float:
    """Value at a time of a series of a ball that moves."""
    return value(balls.moving[slot // LANES, quantity, slot % LANES :: LANES], t)


@inner_kernel
def copy_moving(balls: Balls, quantity: int, slot: int, c: Array) -> None:
    """Copy a series of a ball that moves."""
    copy_column(balls.moving[slot // LANES, quantity, slot % LANES :: LANES], c)


@inner_kernel
def begin_moving(balls: Balls, state: State) -> None:
    """Give the balls that move a slot each, and their speeds there; slots that fill a block are at rest."""
    count = state.touching
    used = count + state.coasting
    for b in range(blocks(used)):
        speed, way = balls.moving[b, SPEED], balls.moving[b, WAY]
        for m in range(LANES):
            i = b * LANES + m
            speed[m] = way[m] = 0.0
            if i < used:
                j = balls.touching[i] if i < count else balls.coasting[i - count]
                balls.slot[j], speed[m] = i, balls.own_speed[j]


@inlined_kernel
def blocks(used: int) -> int:
    """Number of blocks of `LANES` slots for this number of balls."""
    return (used + LANES - 1) // LANES


@inner_kernel
def coast(p: Coefficients, moving: Array, used: int, now: Pace, n: int) -> None:
    """Coefficient n of the traction on balls that move, over their mass; n + 1 of their speeds and ways.

    As if none were touched; speeds are known up to n.
    """
    share, after, first = 1.0 / now.share, AFTER[n], LANES * n
    for b in range(blocks(used)):
        speed, way, traction = moving[b, SPEED], moving[b, WAY], moving[b, TRACTION]
        creep, square, grip = moving[b, CREEP], moving[b, SQUARE], moving[b, GRIP]
        for m in range(first, first + LANES):
            # lambda c = u with lambda = lambda_0 + lambda' t
            u = speed[m]
            if n > 0:
                u -= now.rise * creep[m - LANES]
            creep[m] = u * share
        f0, f1, f2, f3 = (p.damper * creep[first], p.damper * creep[first + 1], p.damper * creep[first + 2],
                          p.damper * creep[first + 3])  # fmt: skip
        if p.elements > 0:
            square_term(creep, square, n)
            if p.sharp:
                fourth = moving[b, FOURTH]
                square_term(square, fourth, n)
                square = fourth
            for m in range(first, first + LANES):
                grip[m] = 0.0
            for e in range(p.elements):
                grip_term(p.bends[e], p.slopes[e], p.power, square, moving[b, BENT + e], grip, n)
            # Four sums side by side: each waits for its own terms only
            k = first
            for i in range(0, first + LANES, LANES):
                f0, f1 = f0 + creep[i] * grip[k], f1 + creep[i + 1] * grip[k + 1]
                f2, f3 = f2 + creep[i + 2] * grip[k + 2], f3 + creep[i + 3] * grip[k + 3]
                k -= LANES
        traction[first], traction[first + 1], traction[first + 2], traction[first + 3] = f0, f1, f2, f3
        for m in range(first, first + LANES):
            speed[m + LANES] = -traction[m] * after
            way[m + LANES] = speed[m] * after


@inlined_kernel
def square_term(c: Array, square: Array, n: int) -> None:
    """Coefficient n of the squares of series, a block of them."""
    r0 = r1 = r2 = r3 = 0.0
    first = k = LANES * n
    for i in range(0, LANES * ((n + 1) // 2), LANES):
        r0, r1 = r0 + c[i] * c[k], r1 + c[i + 1] * c[k + 1]
        r2, r3 = r2 + c[i + 2] * c[k + 2], r3 + c[i + 3] * c[k + 3]
        k -= LANES
    square[first], square[first + 1], square[first + 2], square[first + 3] = 2 * r0, 2 * r1, 2 * r2, 2 * r3
    if n % 2 == 0:
        for m in range(LANES):
            square[first + m] += c[k + m] * c[k + m]


@inlined_kernel
def grip_term(
    bend: float, slope: float, power: float, square: Array, bent: Array, grip: Array, n: int
) -> None:
    """Add coefficient n of slope (1 + bend square)^-power to those of `grip`, a block of them."""
    first = k = LANES * n
    if n == 0:
        for m in range(LANES):
            root = math.sqrt(1.0 + bend * square[m])
            bent[m] = 1.0 / (root if power == 0.5 else math.sqrt(root))
            grip[m] += slope * bent[m]
        return
    # g = w^-a has w dg/dt = -a g dw/dt, whence n w_0 g_n = -sum_(i<n) (a (n - i) + i) w_(n-i) g_i
    r0 = r1 = r2 = r3 = 0.0
    factor = -power * n
    for i in range(0, first, LANES):
        r0, r1 = r0 + factor * square[k] * bent[i], r1 + factor * square[k + 1] * bent[i + 1]
        r2, r3 = r2 + factor * square[k + 2] * bent[i + 2], r3 + factor * square[k + 3] * bent[i + 3]
        factor -= 1.0 - power
        k -= LANES
    bent[first], bent[first + 1], bent[first + 2], bent[first + 3] = r0, r1, r2, r3
    for m in range(LANES):
        per = bent[m] * bent[m]  # 1/w_0 = g_0^(1/a)
        bent[first + m] *= bend * (per if power == 0.5 else per * per) * AFTER[n - 1]
        grip[first + m] += slope * bent[first + m]


@inner_kernel
def own_forces(
    p: Coefficients, balls: Balls, w: Series, state: State, now: Pace, n: int
) -> tuple[float, float, float]:
    """Coefficient n of the forces of pockets with series of their own, and n + 1 of their penetrations."""
    gx, gy = centre(p, w)
    sum_cos = sum_sin = total = 0.0
    after, count = 1.0 / (n + 1), state.touching
    if p.inertial:
        coast(p, balls.moving, count + state.coasting, now, n)
    for i in range(count):
        j = balls.touching[i]
        # N_j = K |q_j|^1.5 sign q_j, or k q_j
        force = hertz_power(p, balls, j, n) if p.hertz != 0.0 else p.stiffness * balls.depth[n, j]
        balls.force[n, j] = force
        if p.inertial:
            # m_e du_j/dt = N_j - F(u_j), and dq_j/dt = d(place_j)/dt - u_j, less the free speed
            speed, at = balls.moving[i // LANES, SPEED], LANES * n + i % LANES
            give = speed[at]
            speed[at + LANES] += p.lightness * force * after
        else:
            # dq_j/dt = d(place_j)/dt - N_j / C_mu, less the free speed
            give = p.yielding * now.share * force
            if n > 0:
                give += p.yielding * now.rise * balls.force[n - 1, j]
        balls.depth[n + 1, j] = (
            gy[n + 1] * balls.cosine[j] - gx[n + 1] * balls.sine[j] + w[n + 1].s - give * after
        )
        for k in range(2 * p.harmonics):
            balls.depth[n + 1, j] -= balls.drive[k, j] * w[n + 1].gone[k]
        sum_cos += force * balls.cosine[j]
        sum_sin += force * balls.sine[j]
        total += force
    if p.inertial:
        w[n].ex, w[n].ey = sum_cos, sum_sin
    # F = sum_j -N_j (e_t + sigma f e_r),  T / (M R) = -sum_j N_j
    return sum_sin - p.friction * sum_cos, -sum_cos - p.friction * sum_sin, -total


@inner_kernel
def hertz_power(p: Coefficients, balls: Balls, j: int, n: int) -> float:
    """Coefficient n of K |q|^1.5 with the sign of q."""
    start, side = float(balls.depth[0, j]), int(balls.side[j])
    if n == 0:
        size = side * start
        return float(p.hertz * size * side * size**0.5)
    # N = K q^1.5 has q dN/dt = 1.5 N dq/dt, whence n q_0 N_n = sum_(i<n) (1.5 (n - i) - i) q_(n-i) N_i
    total = 0.0
    for i in range(n):
        total += (1.5 * (n - i) - i) * balls.depth[n - i, j] * balls.force[i, j]
    return total / (n * start)


@inner_kernel
def fastest_ball(moving: Array, used: int) -> tuple[float, float, float]:
    """Largest speed of the balls that move, and of the last two terms of their series."""
    speed = last = before = 0.0
    for b in range(blocks(used)):
        u = moving[b, SPEED]
        for m in range(LANES):
            speed, last = max(speed, abs(u[m])), max(last, abs(u[LANES * ORDER + m]))
            before = max(before, abs(u[LANES * (ORDER - 1) + m]))
    return speed, last, before


@inner_kernel
def rescale_balls(w: Series, moving: Array, used: int, h: float) -> None:
    """Make the step the unit of time of the series of the balls that move."""
    power = h
    for n in range(1, ORDER + 1):
        w[n].ex, w[n].ey = w[n].ex * power, w[n].ey * power
        power *= h
    for b in range(blocks(used)):
        speed, way, traction = moving[b, SPEED], moving[b, WAY], moving[b, TRACTION]
        power = h
        for n in range(LANES, LANES * (ORDER + 1), LANES):
            for m in range(n, n + LANES):
                speed[m] *= power
                way[m] *= power
                traction[m] *= power
            power *= h


@inner_kernel
def move_balls(p: Coefficients, balls: Balls, state: State, end: float, share: float, ledger: Ledger) -> None:
    """Speeds and places of the balls at the end of a step; one that is about at rest is put there."""
    count = state.touching
    for i in range(count):
        balls.own_speed[balls.touching[i]] = moving_at(balls, SPEED, i, end)
    kept = 0
    for i in range(state.coasting):
        j = balls.coasting[i]
        balls.lead[j] += moving_at(balls, WAY, count + i, end)
        u = moving_at(balls, SPEED, count + i, end)
        if abs(u) > p.coast_end:
            balls.own_speed[j] = u
            balls.coasting[kept] = j
            kept += 1
            continue
        # The way that is left, by the slope of its law; the races take its energy
        balls.lead[j] += p.coast_time * share * u
        balls.own_speed[j] = 0.0
        ledger.race_dampers -= 0.5 * u * u / p.lightness
    state.coasting = kept


@inner_kernel
def subtract_way(balls: Balls, j: int, c: Array) -> None:
    """Take the way that a ball coasts from a series, but for its first term."""
    if balls.own_speed[j] != 0.0:
        block, lane = balls.slot[j] // LANES, balls.slot[j] % LANES
        for n in range(1, ORDER + 1):
            c[n] -= balls.moving[block, WAY, LANES * n + lane]


@inner_kernel
def way_at(balls: Balls, j: int, t: float) -> float:
    """Way that a ball has coasted at a time."""
    return moving_at(balls, WAY, balls.slot[j], t) if balls.own_speed[j] != 0.0 else 0.0


@inner_kernel
def way_knots(
    balls: Balls, j: int, c: Array
) -> tuple[float, float, float, float, float, float, float, float]:
    """Knots of the way that a ball coasts, and bounds of what bends it."""
    copy_moving(balls, WAY, balls.slot[j], c)
    a, b, d, e, f, g = knots(c)
    early, late = bends(c)
    return a, b, d, e, f, g, early, late


@inner_kernel
def depth_change(balls: Balls, j: int, t: float) -> float:
    """How much an own series of a penetration has risen at a time."""
    return value(balls.depth[:, j], t) - float(balls.depth[0, j])


@inner_kernel
def own_left_at(p: Coefficients, balls: Balls, row: Candidate, now: Place, t: float, room: Room) -> float:
    """What is queued, as `events.left_at`, of pockets with own series and of balls that coast."""
    j = row.ball
    if row.change == 0:
        return row.start + float(balls.side[j]) * depth_change(balls, j, t)
    sign = -float(row.change)
    left: float = balls.play[j] + p.onset
    left += sign * (balls.cosine[j] * now[1] - balls.sine[j] * now[0] + now[2] - balls.lead[j])
    left -= sign * way_at(balls, j, t)
    return left - sign * gone_at(p, balls, room.gone[AT_END], j)


@inner_kernel
def dropped(list_of: Whole, count: int, j: int) -> int:
    """Take a ball off a list; return how many are left."""
    kept = 0
    for i in range(count):
        if list_of[i] != j:
            list_of[kept] = list_of[i]
            kept += 1
    return kept


@inner_kernel
def ball_energy(p: Coefficients, balls: Balls, state: State) -> float:
    """Kinetic energy of the balls beyond their free orbits, over the mass of the cage."""
    squares = 0.0
    if p.inertial:
        for i in range(state.touching):
            squares += balls.own_speed[balls.touching[i]] ** 2
        for i in range(state.coasting):
            squares += balls.own_speed[balls.coasting[i]] ** 2
        squares *= 0.5 / p.lightness
    return squares


@inner_kernel
def traction_power(p: Coefficients, moving: Array, used: int, t: float) -> float:
    """Power that the races take from the balls that move at a time, over the mass of the cage."""
    total = 0.0
    for b in range(blocks(used)):
        speed, traction = moving[b, SPEED], moving[b, TRACTION]
        u0 = u1 = u2 = u3 = f0 = f1 = f2 = f3 = 0.0
        for n in range(LANES * ORDER, -1, -LANES):
            u0, f0 = u0 * t + speed[n], f0 * t + traction[n]
            u1, f1 = u1 * t + speed[n + 1], f1 * t + traction[n + 1]
            u2, f2 = u2 * t + speed[n + 2], f2 * t + traction[n + 2]
            u3, f3 = u3 * t + speed[n + 3], f3 * t + traction[n + 3]
        # F(u) u
        total += u0 * f0 + u1 * f1 + u2 * f2 + u3 * f3
    return total / p.lightness
