r"""Balls with inertia among races whose traction saturates, as power series.

A ball goes at the speed :math:`u` beyond its free orbit, :math:`m_e\dot u = N - F(u)`, with
:math:`F(u) = \sum_i C_i c / (1 + (c/v_i)^n)^{1/n}`, n = 2 or 4, of the creep :math:`c = u/\lambda`: in a
ramp all speeds are a share :math:`\lambda` of their values, and traction is a matter of their ratio. A ball
that no pocket touches coasts by itself until it is at rest in its free orbit.
"""

from __future__ import annotations

from separatrix.cage.features import harmonics, has_hertz_pockets, has_inertia
from separatrix.cage.law import LAST_ROW, blocks, coast, lanes_at
from separatrix.cage.records import (
    AT_END,
    AT_KNOTS,
    COSINE,
    DEPTH,
    IS_TOUCHED,
    LANES,
    ORDER,
    PLACE,
    SINE,
    SPEED,
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
from separatrix.cage.series import AFTER, Place, centre, gone_at, value
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inner_kernel
def moving_at(balls: Balls, quantity: int, slot: int, t: float) -> float:
    """Value at a time of a series of a ball that moves."""
    return value(balls.moving[slot // LANES, quantity, :, slot % LANES], t)


@inner_kernel
def begin_moving(balls: Balls, state: State) -> None:
    """Give the balls that move a slot each, and their speeds there; slots that fill a block are at rest.

    First those in touch, then those that coast, the last to leave first: slow ones share blocks.
    """
    count = state.touching
    used = count + state.coasting
    for b in range(blocks(used)):
        speed, way, place = balls.moving[b, SPEED], balls.moving[b, WAY], balls.moving[b, PLACE]
        depth = balls.moving[b, DEPTH]
        for m in range(LANES):
            i = b * LANES + m
            speed[0, m] = way[0, m] = depth[0, m] = 0.0
            place[IS_TOUCHED, m] = place[COSINE, m] = place[SINE, m] = 0.0
            if i < count:
                j = balls.touching[i]
                place[IS_TOUCHED, m], place[COSINE, m], place[SINE, m] = 1.0, balls.cosine[j], balls.sine[j]
                balls.slot[j], speed[0, m], depth[0, m] = i, balls.own_speed[j], balls.penetration[j]
            elif i < used:
                j = balls.coasting[used - 1 - i]
                balls.slot[j], speed[0, m] = i, balls.own_speed[j]


@inlined_kernel
def push_balls(p: Coefficients, balls: Balls, w: Series, count: int, n: int) -> tuple[float, float, float]:
    """Coefficient n of the forces of linear pockets on balls with inertia, as `own_forces`."""
    gx, gy = centre(p, w)
    dx, dy, ds, after = gx[n + 1], gy[n + 1], w[n + 1].s, AFTER[n]
    push, k = p.lightness, p.stiffness
    for b in range(blocks(count)):
        speed, depth, place = balls.moving[b, SPEED], balls.moving[b, DEPTH], balls.moving[b, PLACE]
        f0, f1, f2, f3 = k * depth[n, 0], k * depth[n, 1], k * depth[n, 2], k * depth[n, 3]
        u0, u1, u2, u3 = speed[n, 0], speed[n, 1], speed[n, 2], speed[n, 3]
        # m_e du_j/dt = N_j - F(u_j), and dq_j/dt = d(place_j)/dt - u_j, less the free speed
        v0, v1 = speed[n + 1, 0] + push * f0 * after, speed[n + 1, 1] + push * f1 * after
        v2, v3 = speed[n + 1, 2] + push * f2 * after, speed[n + 1, 3] + push * f3 * after
        q0 = dy * place[COSINE, 0] - dx * place[SINE, 0] + ds - u0 * after
        q1 = dy * place[COSINE, 1] - dx * place[SINE, 1] + ds - u1 * after
        q2 = dy * place[COSINE, 2] - dx * place[SINE, 2] + ds - u2 * after
        q3 = dy * place[COSINE, 3] - dx * place[SINE, 3] + ds - u3 * after
        q0, q1 = q0 * place[IS_TOUCHED, 0], q1 * place[IS_TOUCHED, 1]
        q2, q3 = q2 * place[IS_TOUCHED, 2], q3 * place[IS_TOUCHED, 3]
        speed[n + 1, 0], speed[n + 1, 1], speed[n + 1, 2], speed[n + 1, 3] = v0, v1, v2, v3
        depth[n + 1, 0], depth[n + 1, 1], depth[n + 1, 2], depth[n + 1, 3] = q0, q1, q2, q3
    sum_cos = sum_sin = total = 0.0
    for i in range(count):
        j, b, m = balls.touching[i], i // LANES, i % LANES
        force = k * balls.moving[b, DEPTH, n, m]
        for wave in range(2 * harmonics(p)):
            balls.moving[b, DEPTH, n + 1, m] -= balls.drive[wave, j] * w[n + 1].gone[wave]
        balls.force[n, j], balls.depth[n + 1, j] = force, balls.moving[b, DEPTH, n + 1, m]
        sum_cos += force * balls.cosine[j]
        sum_sin += force * balls.sine[j]
        total += force
    w[n].ex, w[n].ey = sum_cos, sum_sin
    return sum_sin - p.friction * sum_cos, -sum_cos - p.friction * sum_sin, -total


@inner_kernel
def own_forces(
    p: Coefficients, balls: Balls, w: Series, state: State, now: Pace, n: int
) -> tuple[float, float, float]:
    """Coefficient n of the forces of pockets with series of their own, and n + 1 of their penetrations."""
    gx, gy = centre(p, w)
    sum_cos = sum_sin = total = 0.0
    after, count = 1.0 / (n + 1), state.touching
    if has_inertia(p):
        coast(p, balls.moving, count, count + state.coasting, now, n)
        if not has_hertz_pockets(p):
            return push_balls(p, balls, w, count, n)
    for i in range(count):
        j = balls.touching[i]
        # N_j = K |q_j|^1.5 sign q_j, or k q_j
        force = hertz_power(p, balls, j, n) if has_hertz_pockets(p) else p.stiffness * balls.depth[n, j]
        balls.force[n, j] = force
        if has_inertia(p):
            # m_e du_j/dt = N_j - F(u_j), and dq_j/dt = d(place_j)/dt - u_j, less the free speed
            speed, lane = balls.moving[i // LANES, SPEED], i % LANES
            give = speed[n, lane]
            speed[n + 1, lane] += p.lightness * force * after
        else:
            # dq_j/dt = d(place_j)/dt - N_j / C_mu, less the free speed
            give = p.yielding * now.share * force
            if n > 0:
                give += p.yielding * now.rise * balls.force[n - 1, j]
        balls.depth[n + 1, j] = (
            gy[n + 1] * balls.cosine[j] - gx[n + 1] * balls.sine[j] + w[n + 1].s - give * after
        )
        for k in range(2 * harmonics(p)):
            balls.depth[n + 1, j] -= balls.drive[k, j] * w[n + 1].gone[k]
        sum_cos += force * balls.cosine[j]
        sum_sin += force * balls.sine[j]
        total += force
    if has_inertia(p):
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
            speed, last = max(speed, abs(u[0, m])), max(last, abs(u[ORDER, m]))
            before = max(before, abs(u[ORDER - 1, m]))
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
        for n in range(1, ORDER + 1):
            for m in range(LANES):
                speed[n, m] *= power
                way[n, m] *= power
                traction[n, m] *= power
            power *= h


@inner_kernel
def move_balls(p: Coefficients, balls: Balls, state: State, end: float, share: float, ledger: Ledger) -> None:
    """Speeds and places of the balls at the end of a step; one that is about at rest is put there."""
    count = state.touching
    used = count + state.coasting
    for b in range(blocks(used)):
        lanes_at(balls.moving[b, SPEED], end)
        lanes_at(balls.moving[b, WAY], end)
    for i in range(count):
        balls.own_speed[balls.touching[i]] = balls.moving[i // LANES, SPEED, LAST_ROW, i % LANES]
    kept = 0
    for i in range(state.coasting):
        j = balls.coasting[i]
        block, lane = balls.slot[j] // LANES, balls.slot[j] % LANES
        balls.lead[j] += balls.moving[block, WAY, LAST_ROW, lane]
        u = balls.moving[block, SPEED, LAST_ROW, lane]
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
            c[n] -= balls.moving[block, WAY, n, lane]


@inner_kernel
def way_at(balls: Balls, j: int, t: float) -> float:
    """Way that a ball has coasted at a time."""
    return moving_at(balls, WAY, balls.slot[j], t) if balls.own_speed[j] != 0.0 else 0.0


@inner_kernel
def way_knots(balls: Balls, j: int) -> tuple[float, float, float, float, float, float, float, float]:
    """Knots of the way that a ball coasts, and bounds of what bends it, by `learn_ways`."""
    at, m = balls.moving[balls.slot[j] // LANES, AT_KNOTS], balls.slot[j] % LANES
    return at[0, m], at[1, m], at[2, m], at[3, m], at[4, m], at[5, m], at[6, m], at[7, m]


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
    if has_inertia(p):
        for i in range(state.touching):
            squares += balls.own_speed[balls.touching[i]] ** 2
        for i in range(state.coasting):
            squares += balls.own_speed[balls.coasting[i]] ** 2
        squares *= 0.5 / p.lightness
    return squares
