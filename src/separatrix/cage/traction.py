r"""Balls with inertia among races whose traction saturates, as power series.

A ball goes at the speed :math:`u` beyond its free orbit, :math:`m_e\dot u = N - F(u)`, with
:math:`F(u) = \sum_i C_i c / \sqrt{1 + (c/v_i)^2}` of the creep :math:`c = u/\lambda`: in a ramp all speeds are
a share :math:`\lambda` of their values, and traction is a matter of their ratio. A ball that no pocket touches
coasts by itself until it is at rest in its free orbit.
"""

from __future__ import annotations

import math

from separatrix.cage.records import ORDER, Balls, Coefficients, Ledger, Pace, Series, State, Whole
from separatrix.cage.series import centre, value
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array


@inner_kernel
def traction_term(p: Coefficients, balls: Balls, now: Pace, j: int, n: int) -> None:
    """Coefficient n of the traction F(u) on ball j, over its mass; its speed is known as far."""
    u, c = balls.speed[j], balls.creep[j]
    # lambda c = u with lambda = lambda_0 + lambda' t
    creep = u[n]
    if n > 0:
        creep -= now.rise * c[n - 1]
    c[n] = creep / now.share
    force = p.damper * c[n]
    if p.elements > 0:
        square, grip = balls.square[j], balls.grip[j]
        total = 0.0
        for i in range((n + 1) // 2):
            total += c[i] * c[n - i]
        total *= 2.0
        if n % 2 == 0:
            total += c[n // 2] * c[n // 2]
        square[n] = total
        grip[n] = 0.0
        for e in range(p.elements):
            grip[n] += p.slopes[e] * bent_term(p.bends[e], square, balls.bent[j, e], n)
        for i in range(n + 1):
            force += c[i] * grip[n - i]
    balls.traction[j, n] = force


@inlined_kernel
def bent_term(bend: float, square: Array, bent: Array, n: int) -> float:
    """Coefficient n of (1 + bend square)^(-1/2)."""
    if n == 0:
        bent[0] = 1.0 / math.sqrt(1.0 + bend * square[0])
        return float(bent[0])
    # g = w^(-1/2) has w dg/dt = -g dw/dt / 2, whence n w_0 g_n = -sum_(i<n) ((n - i) / 2 + i) w_(n-i) g_i
    total = 0.0
    for i in range(n):
        total -= 0.5 * (n + i) * square[n - i] * bent[i]
    bent[n] = bend * total / (n * (1.0 + bend * square[0]))
    return float(bent[n])


@inner_kernel
def own_forces(
    p: Coefficients, balls: Balls, w: Series, count: int, now: Pace, n: int
) -> tuple[float, float, float]:
    """Coefficient n of the forces of pockets with series of their own, and n + 1 of their penetrations."""
    gx, gy = centre(p, w)
    sum_cos = sum_sin = total = 0.0
    after = 1.0 / (n + 1)
    for i in range(count):
        j = balls.touching[i]
        # N_j = K |q_j|^1.5 sign q_j, or k q_j
        force = hertz_power(p, balls, j, n) if p.hertz != 0.0 else p.stiffness * balls.depth[n, j]
        balls.force[n, j] = force
        if p.inertial:
            # m_e du_j/dt = N_j - F(u_j), and dq_j/dt = d(place_j)/dt - u_j, less the free speed
            traction_term(p, balls, now, j, n)
            give = balls.speed[j, n]
            balls.speed[j, n + 1] = (p.lightness * force - balls.traction[j, n]) * after
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
def coast(p: Coefficients, balls: Balls, count: int, now: Pace) -> None:
    """Fill the series of the balls that coast, from their speeds."""
    for i in range(count):
        j = balls.coasting[i]
        u, way = balls.speed[j], balls.way[j]
        u[0], way[0] = balls.own_speed[j], 0.0
        for n in range(ORDER + 1):
            traction_term(p, balls, now, j, n)
            after = 1.0 / (n + 1)
            u[n + 1] = -balls.traction[j, n] * after
            way[n + 1] = u[n] * after


@inner_kernel
def fastest_ball(balls: Balls, list_of: Whole, count: int) -> tuple[float, float, float]:
    """Largest speed of some balls, and of the last two terms of their series."""
    speed = last = before = 0.0
    for i in range(count):
        u = balls.speed[list_of[i]]
        speed = max(speed, abs(u[0]))
        last, before = max(last, abs(u[ORDER])), max(before, abs(u[ORDER - 1]))
    return speed, last, before


@inner_kernel
def rescale_balls(balls: Balls, list_of: Whole, count: int, h: float) -> None:
    """Make the step the unit of time of the series of some balls."""
    for i in range(count):
        j = list_of[i]
        power = h
        for n in range(1, ORDER + 1):
            balls.speed[j, n] *= power
            balls.traction[j, n] *= power
            balls.way[j, n] *= power
            power *= h


@inner_kernel
def move_balls(p: Coefficients, balls: Balls, state: State, end: float, share: float, ledger: Ledger) -> None:
    """Speeds and places of the balls at the end of a step; one that is about at rest is put there."""
    for i in range(state.touching):
        j = balls.touching[i]
        balls.own_speed[j] = value(balls.speed[j], end)
    kept = 0
    for i in range(state.coasting):
        j = balls.coasting[i]
        balls.lead[j] += value(balls.way[j], end)
        u = value(balls.speed[j], end)
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
def traction_power(p: Coefficients, balls: Balls, list_of: Whole, count: int, t: float) -> float:
    """Power that the races take from some balls at a time, over the mass of the cage."""
    # F(u) u
    total = 0.0
    for i in range(count):
        j = list_of[i]
        total += value(balls.traction[j], t) * value(balls.speed[j], t)
    return total / p.lightness
