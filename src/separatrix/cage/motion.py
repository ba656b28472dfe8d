"""Motion of the cage in the plane from event to event, each mode by its series."""

from __future__ import annotations

import math

from separatrix.cage.ending import Look
from separatrix.cage.events import (
    LAND_CLEAR,
    LAND_LEAVE,
    LAND_PRESS,
    LAND_TOUCH,
    NOTHING,
    PART,
    SLIDE_START,
    TOUCH,
    pocket_change,
)
from separatrix.cage.evidence import enter_step, record
from separatrix.cage.expand import expand
from separatrix.cage.features import (
    harmonics,
    has_hertz_pockets,
    has_inertia,
    has_own_series,
    has_unbalance,
    is_ramped,
    needs_frame,
    needs_rotation,
)
from separatrix.cage.land import land_change, land_geometry, slide_speed
from separatrix.cage.records import (
    BACKWARD,
    CLEAR,
    FORWARD,
    ORDER,
    RELEASED,
    STICK,
    Balls,
    Coefficients,
    Ledger,
    Pace,
    Points,
    Room,
    Samples,
    Series,
    State,
    Whole,
)
from separatrix.cage.series import ROUNDING, centre, fourths, knots, slope, value
from separatrix.cage.step import longest_step
from separatrix.cage.traction import begin_moving, dropped, move_balls, rescale_balls
from separatrix.cage.work import LAST, enter_work
from separatrix.compiled import inlined_kernel, inner_kernel

HOLD = 1e-9
"""Share by which the friction that a sticking land needs may exceed what it can carry, by rounding."""

MOST_STEPS, HERTZ_STEPS = 200.0, 30.0
"""Steps in the time of a radian of the fastest motion: a run that needs more makes no progress in time."""


@inlined_kernel
def pace_at(p: Coefficients, clock: float) -> Pace:
    """Share of the full speed at a time, and its rate."""
    if not is_ramped(p) or clock >= p.ramp_time:
        return Pace(1.0, 0.0)
    rise = (1.0 - p.ramp_start) / p.ramp_time
    return Pace(p.ramp_start + rise * clock, rise)


@inner_kernel
def frame_angle(p: Coefficients, clock: float) -> float:
    """Angle by which the frame has turned."""
    # alpha = Omega (t - T) + Omega (lambda_0 T + lambda' T^2 / 2), with T = t within the ramp
    ramped = min(clock, p.ramp_time)
    angle = p.turning * (clock - ramped)
    if ramped > 0.0:
        rise = (1.0 - p.ramp_start) / p.ramp_time
        angle += p.turning * ramped * (p.ramp_start + 0.5 * rise * ramped)
    return angle


@inlined_kernel
def load_state(p: Coefficients, balls: Balls, state: State, w: Series) -> None:
    """First coefficients of the series from the state."""
    start = w[0]
    start.x, start.y, start.vx, start.vy = state.x, state.y, state.vx, state.vy
    start.s, start.vs = state.s, state.vs
    if needs_rotation(p):
        theta = state.s / p.radius
        start.cos, start.sin = math.cos(theta), math.sin(theta)
    if has_unbalance(p):
        start.gx = start.x - p.eccentricity * start.cos
        start.gy = start.y - p.eccentricity * start.sin
    if needs_frame(p):
        angle = frame_angle(p, state.clock)
        for h in range(max(1, harmonics(p))):
            start.frame[2 * h] = math.cos((h + 1) * angle)
            start.frame[2 * h + 1] = math.sin((h + 1) * angle)
    if has_own_series(p):
        for i in range(state.touching):
            j = balls.touching[i]
            balls.depth[0, j] = balls.penetration[j]
    if has_inertia(p):
        begin_moving(balls, state)


@inlined_kernel
def rescale(p: Coefficients, balls: Balls, w: Series, state: State, h: float, pressed: bool) -> None:
    """Make the step the unit of time of all series that are looked at."""
    power, count = h, state.touching
    if has_inertia(p):
        rescale_balls(w, balls.moving, count + state.coasting, h)
    for n in range(1, ORDER + 1):
        t = w[n]
        t.x, t.y, t.vx, t.vy = t.x * power, t.y * power, t.vx * power, t.vy * power
        t.s, t.vs = t.s * power, t.vs * power
        if count > 0 and not has_own_series(p):
            t.ex, t.ey, t.es, t.kept = t.ex * power, t.ey * power, t.es * power, t.kept * power
        elif count > 0:
            for i in range(count):
                balls.depth[n, balls.touching[i]] *= power
                balls.force[n, balls.touching[i]] *= power
        if needs_rotation(p):
            t.gx, t.gy, t.cos, t.sin = t.gx * power, t.gy * power, t.cos * power, t.sin * power
        if needs_frame(p):
            for k in range(max(2, 2 * harmonics(p))):
                t.frame[k] *= power
                t.felt[k] *= power
                t.gone[k] *= power
        if pressed:
            t.nx, t.ny, t.depth = t.nx * power, t.ny * power, t.depth * power
            t.normal, t.tangent, t.sliding = t.normal * power, t.tangent * power, t.sliding * power
        power *= h


@inner_kernel
def first_sliding(p: Coefficients, w: Series, now: Pace) -> float:
    """Speed at which the cage's surface slides on the ring's, from the first coefficients."""
    # v_s = t . dr_g/dt + q [ds/dt - (omega_ring - Omega) R], dr_g/dt = v + epsilon d(theta)/dt (sin, -cos)
    start = w[0]
    gx, gy, vx, vy = start.x, start.y, start.vx, start.vy
    if has_unbalance(p):
        gx, gy = start.gx, start.gy
        rate = p.eccentricity * start.vs / p.radius
        vx, vy = vx + rate * start.sin, vy - rate * start.cos
    r = math.sqrt(gx * gx + gy * gy)
    return (gx * vy - gy * vx) / r + p.land_side * (start.vs - p.ring_slide * now.share)


@inner_kernel
def change_land(
    p: Coefficients, balls: Balls, w: Series, state: State, now: Pace, kind: int, room: Room
) -> None:
    """Mode of the land after a change; the state is in the first coefficients of the series."""
    if kind == LAND_CLEAR:
        state.land = CLEAR
        return
    if kind == LAND_LEAVE:
        land_geometry(p, w, room.lobes, 0)
        state.land = RELEASED if w[0].depth > ROUNDING * p.land_gap else CLEAR
        return
    if kind in (LAND_TOUCH, LAND_PRESS):
        sliding = first_sliding(p, w, now)
        if abs(sliding) > ROUNDING * (abs(w[0].vs) + abs(p.ring_slide)):
            state.land = FORWARD if sliding > 0.0 else BACKWARD
            return
    if kind != SLIDE_START:
        # Nothing slides: it sticks if |F_t| <= mu P, else it starts to slide
        state.land = STICK
        expand(p, balls, w, state, now, room)
        if abs(w[0].tangent) <= p.land_friction * max(0.0, w[0].normal) * (1.0 + HOLD):
            return
    state.land = BACKWARD if w[0].tangent > 0.0 else FORWARD


@inlined_kernel
def kinetic(p: Coefficients, state: State) -> float:
    """Kinetic energy of the cage in the turning frame, over its mass."""
    return 0.5 * (state.vx * state.vx + state.vy * state.vy + p.inertia * state.vs * state.vs)


@inner_kernel
def land_energy(p: Coefficients, balls: Balls, state: State, w: Series, room: Room) -> float:
    """Energy in the land's spring, over the mass."""
    load_state(p, balls, state, w)
    land_geometry(p, w, room.lobes, 0)
    return 0.5 * p.land_stiffness * w[0].depth ** 2


@inlined_kernel
def place_of(p: Coefficients, balls: Balls, state: State, j: int) -> float:
    """Place of pocket j along the circumference, against a ball without lead."""
    x, y = state.x, state.y
    if has_unbalance(p):
        x -= p.eccentricity * math.cos(state.s / p.radius)
        y -= p.eccentricity * math.sin(state.s / p.radius)
    return float(y * balls.cosine[j] - x * balls.sine[j] + state.s)


@inlined_kernel
def finish_step(
    p: Coefficients,
    balls: Balls,
    w: Series,
    state: State,
    now: Pace,
    h: float,
    end: float,
    at: Points,
    ledger: Ledger,
) -> None:
    """State at the end of a step, from its series and its motion by `place_points`."""
    state.x, state.y, state.s = at.x[LAST], at.y[LAST], value(w.s, end)
    state.vx, state.vy, state.vs = at.vx[LAST], at.vy[LAST], at.vs[LAST]
    state.clock += end * h
    if has_own_series(p):
        for i in range(state.touching):
            j = balls.touching[i]
            balls.penetration[j] = value(balls.depth[:, j], end)
    elif state.touching > 0:
        ex, ey, es, kept = at.ex[LAST], at.ey[LAST], at.es[LAST], at.kept[LAST]
        for i in range(state.touching):
            j = balls.touching[i]
            q = balls.penetration[j] * kept + ey * balls.cosine[j] - ex * balls.sine[j] + es
            for k in range(2 * harmonics(p)):
                q -= balls.drive[k, j] * value(w.felt[:, k], end)
            balls.penetration[j] = q
    for k in range(2 * harmonics(p)):
        gone = value(w.gone[:, k], end)
        for j in range(balls.play.size):
            if balls.side[j] == 0:
                balls.lead[j] += balls.drive[k, j] * gone
    if has_inertia(p):
        move_balls(p, balls, state, end, now.share, ledger)


@inlined_kernel
def meet_ball(p: Coefficients, balls: Balls, state: State, ball: int, hits: Whole) -> None:
    """Put a ball on the list of those in touch; beyond the number of balls: on the negative side."""
    j = ball % balls.play.size
    side = 1 if ball < balls.play.size else -1
    balls.side[j] = side
    balls.penetration[j] = place_of(p, balls, state, j) - balls.lead[j] - side * balls.play[j]
    if has_hertz_pockets(p):
        balls.penetration[j] = side * p.onset
    balls.touching[state.touching] = j
    state.touching += 1
    hits[j] += 1
    if has_inertia(p):
        state.coasting = dropped(balls.coasting, state.coasting, j)


@inlined_kernel
def leave_ball(p: Coefficients, balls: Balls, w: Series, state: State, j: int, h: float, end: float) -> None:
    """Take a ball off the list of those in touch: it stays where it was left, or coasts."""
    side = balls.side[j]
    balls.lead[j] = place_of(p, balls, state, j) - side * balls.play[j] - balls.penetration[j]
    if has_hertz_pockets(p) and not has_inertia(p):
        follows = state.vy * balls.cosine[j] - state.vx * balls.sine[j] + state.vs
        for k in range(2 * harmonics(p)):
            follows -= balls.drive[k, j] * slope(w.gone[:, k], end) / h
        if side * follows > 0.0:
            # The pocket follows more slowly than the force at the onset drives the ball: without a distance
            # between the two it would meet the ball at once, and again without end.
            balls.lead[j] += 0.5 * side * p.onset
    balls.side[j] = 0
    state.touching = dropped(balls.touching, state.touching, j)
    if has_inertia(p):
        balls.coasting[state.coasting] = j
        state.coasting += 1


@inner_kernel
def advance(
    p: Coefficients,
    balls: Balls,
    state: State,
    w: Series,
    ledger: Ledger,
    look: Look,
    hits: Whole,
    length: float,
    ceiling: float,
    samples: Samples,
    room: Room,
) -> bool:
    """Advance the cage by a time, in place; False if more events came than any motion has.

    Parameters
    ----------
    p, balls, state, w
        The cage, its balls, its state, and series of a step.
    ledger, look, hits
        Work since the start, tally of this look, and impacts of every pocket.
    length, ceiling : float
        Time to advance, and the kinetic energy above which to stop.
    samples : Samples
        History.
    room : Room
        Room for a step.
    """
    done, taken = 0.0, 0
    most = MOST_STEPS * (1.0 + length * p.fastest) * (HERTZ_STEPS if has_hertz_pockets(p) else 1.0)
    gx, gy = centre(p, w)
    while done < length and kinetic(p, state) < ceiling:
        taken += 1
        if taken > most:
            return False
        now, land = pace_at(p, state.clock), state.land
        pressed = land != CLEAR and land != RELEASED
        load_state(p, balls, state, w)
        expand(p, balls, w, state, now, room)
        if pressed and land != STICK:
            for n in range(ORDER + 1):
                w[n].sliding = slide_speed(p, w, now, n)
        h = longest_step(p, balls, w, state, now, length - done)
        rescale(p, balls, w, state, h, pressed)
        x, y, s = knots(gx), knots(gy), knots(w.s)
        off, late_off = fourths(gx, gy, w.s, w.kept, 0.0)
        end, kind, ball, deepest = pocket_change(p, balls, w, state, h, x, y, s, off, late_off, room)
        if p.land_side != 0.0:
            end, kind = land_change(p, w, land, h, end, kind, x, y, max(off, late_off), room)
        if len(samples.row) > state.rows:
            record(p, balls, w, state, now, h, end, ledger, samples, room)
        enter_work(p, balls, w, state, now, h, end, ledger, room)
        enter_step(p, balls, w, state, deepest, h, end, look, room)
        finish_step(p, balls, w, state, now, h, end, room.points, ledger)
        done = length if kind == NOTHING and h == length - done else done + end * h
        if kind == TOUCH:
            meet_ball(p, balls, state, ball, hits)
        elif kind == PART:
            leave_ball(p, balls, w, state, ball, h, end)
        elif kind != NOTHING:
            load_state(p, balls, state, w)
            change_land(p, balls, w, state, now, kind, room)
            look.land_hits += kind == LAND_TOUCH
    look.steps += taken
    return True
