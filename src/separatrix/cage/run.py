"""Runs side by side: sixteen at a time from their starts to their ends, a queue that refills the lanes.

A run's bits depend on its own numbers and start only: not on its lane, its neighbours, the number of threads.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from separatrix.cage.contact_force import pocket_depth
from separatrix.cage.frame import place
from separatrix.cage.motion import held_spins, held_stage_end, hold_spins, rates, stage_end
from separatrix.cage.outcome import (
    BY_WALL,
    GROWS,
    LEAST,
    RAMP_START,
    RAMP_TIME,
    TURNS_AT,
    UNKNOWN,
    UNRESOLVED,
    end_of_motion,
)
from separatrix.cage.rows import *
from separatrix.ground.compiled import inlined, kernel, part

OUTCOME, CAUSE, JUDGED, OPEN, DONE, LEFT_AT, FIRST_EXTREME = range(7)
RAMP_UP = np.float32(1e-6)
"""What a ramp may lack of full speed at its end: some roundings in single precision."""

GLANCE = 8
"""Steps between two glances at whether a run has grown too far to go on."""

EVIDENCE_COLUMNS = FIRST_EXTREME + of(EXTREMES_END - WATCHED)
"""What is written of a run; after these the extremes of `rows`, in their order."""


def extreme(row: int) -> int:
    """Column of an extreme in the evidence of a run."""
    return FIRST_EXTREME + of(row - WATCHED)


LEAST_HELD = np.float32(0.02)
"""Least share of capacity and slope of a ball: a few harmonics of a loaded zone swing below 0 outside it."""


@inlined
def around(s, p, places, waves, turned):
    """What a ball has at its azimuth: speed of its free orbit beyond the ball set's; how races hold it.

    Halfway through the step that begins, for all of it.
    """
    power, lanes = turned[2 * LANES :], turned.size // 4
    for j in range(places.shape[0]):
        q = places[j]
        for l in range(lanes):
            half = HALF * p[STEP + l] * p[ORBIT + l] * s[RAMP + l]
            c, n = s[TURN_COSINE + l] - half * s[TURN_SINE + l], s[TURN_SINE + l] + half * s[TURN_COSINE + l]
            turned[l] = power[l] = q[COSINE + l] * c - q[SINE + l] * n
            turned[LANES + l] = power[LANES + l] = q[SINE + l] * c + q[COSINE + l] * n
            q[OWN_SPEED + l] = q[BY_SIZE + l]
            q[CAPACITY_SHARE + l], q[SLOPE_SHARE + l] = p[CAPACITY_MEAN + l], p[SLOPE_MEAN + l]
        for h in range(waves.shape[0]):
            wave = waves[h]
            for l in range(lanes):
                c, n = power[l], power[LANES + l]
                q[OWN_SPEED + l] += wave[ORBIT_COSINE + l] * c + wave[ORBIT_SINE + l] * n
                q[CAPACITY_SHARE + l] += wave[CAPACITY_COSINE + l] * c + wave[CAPACITY_SINE + l] * n
                q[SLOPE_SHARE + l] += wave[SLOPE_COSINE + l] * c + wave[SLOPE_SINE + l] * n
                power[l] = c * turned[l] - n * turned[LANES + l]
                power[LANES + l] = n * turned[l] + c * turned[LANES + l]
        for l in range(lanes):
            capacity = q[CAPACITY_SHARE + l] = max(q[CAPACITY_SHARE + l], LEAST_HELD)
            slope = q[SLOPE_SHARE + l] = max(q[SLOPE_SHARE + l], LEAST_HELD)
            q[KNEE_SHARE + l] = slope / capacity


@inlined
def speed_up(s, a, p):
    """Rate of the ball set's share of its speed in this step: the last of a ramp brings it to 1."""
    for l in range(LANES):
        left = ONE - s[RAMP + l]
        a[RAMP_NOW + l] = min(p[RAMP_RATE + l], left / p[STEP + l]) if left > RAMP_UP else ZERO


@inlined
def kinetic_energy(s, p, l, space):
    """Kinetic energy of the cage in the turning frame."""
    e = p[MASS + l] * (s[VX + l] ** 2 + s[VY + l] ** 2) + s[VS + l] ** 2 / p[PER_TURNING + l]
    if space:
        e += p[AXIAL_MASS + l] * s[VZ + l] ** 2 + p[TRANSVERSE + l] * (s[WX + l] ** 2 + s[WY + l] ** 2)
    return HALF * e


@part
def stored_energy(s, of_balls, a, p, places, l, space):
    """Kinetic energy of the cage, and that in the pockets' springs; `a` has its geometric centre."""
    total = float(kinetic_energy(s, p, l, space))
    for b, q in zip(of_balls, places):  # noqa: B905 - numba knows no `strict`
        c, n = q[COSINE + l], q[SINE + l]
        along = a[GY + l] * c - a[GX + l] * n + s[S + l] - b[LEAD + l]
        across = p[OFFSET + l]
        if space:
            across = s[Z + l] - p[RADIUS + l] * (a[GB + l] * c - a[GA + l] * n) - b[GROOVE + l]
        outward = p[WRAPPED + l] * (a[GX + l] * c + a[GY + l] * n) + p[OUTWARD + l]
        depth = pocket_depth(along, across, outward, q[AROUND + l], q[APART + l], p[BESIDE + l])[0]
        total += (0.5 * p[STIFFNESS + l] + 0.4 * p[HERTZ + l] * math.sqrt(depth)) * depth * depth
    return total


@inlined
def watch(s, d, a, p, places, w, step, space):
    """Add what is watched of this moment to the sums of the look and the extremes of the run."""
    for l in range(LANES):
        x, y, gvx, gvy = a[GX + l], a[GY + l], a[GVX + l], a[GVY + l]
        vx, vy, push = s[VX + l], s[VY + l], a[LAND_N + l]
        square = x * x + y * y
        r = math.sqrt(square)
        w[ENERGY + l] += kinetic_energy(s, p, l, space)
        w[OFFSET_MEAN + l] += r
        w[OFFSET_SQUARE + l] += square
        w[SWEPT + l] += x * gvy - y * gvx
        w[CURL + l] += vx * d[VY + l] - vy * d[VX + l]
        w[SPEED_SQUARE + l] += vx * vx + vy * vy
        w[PRESSED + l] += push
        w[HEATED + l] += a[LAND_HEAT + l]
        w[MEAN_X + l] += x
        w[MEAN_Y + l] += y
        on = ONE if push > ZERO else ZERO
        w[LAND_STRIKES + l] += max(on - w[LAND_TOUCHED + l], ZERO)
        w[LAND_TOUCHED + l] = on
        w[PEAK_LAND + l] = max(w[PEAK_LAND + l], push)
        w[PEAK_OFFSET + l] = max(w[PEAK_OFFSET + l], r)
        if space:
            ta, tb, z = a[GA + l], a[GB + l], s[Z + l]
            square = ta * ta + tb * tb
            w[TILT_SQUARE + l] += square
            w[CONE + l] += ta * a[GWB + l] - tb * a[GWA + l]
            w[PEAK_TILT + l] = max(w[PEAK_TILT + l], math.sqrt(square))
            w[AXIAL_LOW + l] = min(w[AXIAL_LOW + l], z)
            w[AXIAL_HIGH + l] = max(w[AXIAL_HIGH + l], z)
    for j in range(places.shape[0]):
        q = places[j]
        for l in range(LANES):
            push = q[FORCE + l]
            on = ONE if push > ZERO else ZERO
            strike = max(on - q[TOUCHING + l], ZERO)
            q[TOUCHING + l] = on
            q[HITS + l] += strike
            q[RUBBED + l] += q[HEAT + l]
            w[STRIKES + l] += strike
            w[PEAK_FORCE + l] = max(w[PEAK_FORCE + l], push)
    if is_far(w, p):
        for j in range(places.shape[0]):
            watch_walls(a, p, places[j], w, np.float32(j + 1), step)


@part
def is_far(w, p):
    """Whether a cage has been so far out that a ball may have met the edge of its pocket's wall."""
    far = False
    for l in range(LANES):
        far |= w[PEAK_OFFSET + l] > min(p[MARGIN_IN + l], p[MARGIN_OUT + l])
    return far


@inlined
def watch_walls(a, p, q, w, number, step):
    """Note the first ball that its pocket pushes where the pocket's wall has ended."""
    for l in range(LANES):
        out = a[GX + l] * q[COSINE + l] + a[GY + l] * q[SINE + l]
        beyond = max(out - p[MARGIN_IN + l], -out - p[MARGIN_OUT + l])
        was, when = w[LEFT_BALL + l], w[LEFT_STEP + l]
        is_first = (beyond > ZERO) & (q[FORCE + l] > ZERO) & (was == ZERO)
        w[LEFT_BALL + l] = number if is_first else was
        w[LEFT_STEP + l] = step if is_first else when


@part
def frame_angle(time, limits):
    """Angle of the frame against the housing, and the share of its speed that the ball set has."""
    rise, start = limits[RAMP_TIME], limits[RAMP_START]
    if time >= rise:
        return limits[TURNS_AT] * (time - 0.5 * (1.0 - start) * rise), 1.0
    share = start + (1.0 - start) * time / rise
    return limits[TURNS_AT] * 0.5 * (start + share) * time, share


@part
def take(numbers, into, l):
    """Put the numbers of a run into its lane."""
    for i in range(numbers.size):
        into[i * LANES + l] = numbers[i]


@part
def take_decay(held, p, l, first, one):
    """Put the gains of a step into its lane: those of the speeds of balls, others that decay by nothing."""
    h = p[STEP + l]
    plain = (1.0, 0.5 * h, 1.0, h / 6.0, h / 3.0, h / 6.0)
    for k in range(HELD_NUMBERS):
        held[k, l::LANES] = plain[k]
        held[k, first + l :: one] = p[DECAY_HALF + k * LANES + l]


@part
def begin_look(s, limits, time, l):
    """Set the frame's angle and speed from the clock, which single precision would lose; no works yet."""
    angle, share = frame_angle(time, limits)
    s[TURN_COSINE + l], s[TURN_SINE + l], s[RAMP + l] = math.cos(angle), math.sin(angle), share
    for work in range(POCKET_WORK, FRAME_WORK + LANES, LANES):
        s[work + l] = ZERO


@part
def write_look(found, at, w, s, kept, moments, steps, step, l):
    """Write means, works and extremes of a look, and what the ledger of energy leaves open.

    Of a look that ends before its last step, after some `moments`, the works are those of a whole one.
    """
    for column in range(WATCHED // LANES):
        found[column] = w[column * LANES + l] / moments
    found[STRIKES // LANES] /= step
    works = done = 0.0
    for i in range((FRAME_WORK - POCKET_WORK) // LANES + 1):
        work = s[POCKET_WORK + i * LANES + l]
        found[WORK_POCKET // LANES + i] = work * (steps / moments)
        works += work
        done += abs(work)
    at[OPEN] += abs(kept - works)
    at[DONE] += done
    for i in range((EXTREMES_END - WATCHED) // LANES):
        at[FIRST_EXTREME + i] = w[WATCHED + i * LANES + l]


@part
def count_impacts(hits, heat, places, step, l):
    """Add impacts and heat of every pocket since the last look; the heat of all, summed over steps."""
    total = 0.0
    for j in range(hits.size):
        hits[j] += places[j, HITS + l]
        total += places[j, RUBBED + l]
        heat[j] += places[j, RUBBED + l] * step
        places[j, HITS + l] = places[j, RUBBED + l] = ZERO
    return total


@part
def end_look(n, look, moments, steps, books, w, s, places, kept, l):
    """Write the look of a run, and judge it; whether the run has ended."""
    looks, evidence, hits_of, heat_of, numbers, limits = books
    found, at, step = looks[n, look], evidence[n], numbers[n, STEP // LANES]
    write_look(found, at, w, s, kept, moments, steps, step, l)
    found[RUBBING // LANES] = count_impacts(hits_of[n], heat_of[n], places, step, l) / moments
    if at[OUTCOME] == UNKNOWN:
        touched = w[PEAK_FORCE + l] + w[PEAK_LAND + l] > ZERO
        at[OUTCOME], at[CAUSE] = end_of_motion(looks[n], look, touched, moments < steps, limits[n])
        at[JUDGED] = look + moments / steps
        if w[LEFT_BALL + l] > ZERO:
            at[OUTCOME], at[CAUSE] = UNRESOLVED, BY_WALL
            at[LEFT_AT] = (look * steps + w[LEFT_STEP + l]) * step
    is_over = look + 1 >= limits[n, LEAST] or not math.isfinite(found[ENERGY // LANES])
    return is_over and at[OUTCOME] != UNKNOWN


@part
def end_grown(i, steps, run, look, had, books, w, s, of_balls, a, p, places, space):
    """End within their look the runs that have grown too far; how many leave their lanes."""
    evidence, limits, ended = books[1], books[5], 0
    for l in range(LANES):
        n = run[l]
        if n < 0 or evidence[n, OUTCOME] != UNKNOWN or kinetic_energy(s, p, l, space) <= limits[n, GROWS]:
            continue
        kept = stored_energy(s, of_balls, a, p, places, l, space) - had[l]
        if end_look(n, look[l], i, steps, books, w, s, places, kept, l):
            run[l], look[l], ended = -1, -1, ended + 1
    return ended


@part
def write_row(row, time, s, of_balls, a, p, places, space):
    """Time, state, geometric centre and axis, forces of pockets, energies, force of the land: first lane."""
    row[0] = time
    n = 1
    for values in (s, a[GX : GWB + LANES]):
        for e in range(0, values.size, LANES):
            row[n] = values[e]
            n += 1
    for j in range(places.shape[0]):
        row[n + j] = places[j, FORCE]
    row[-3] = kinetic_energy(s, p, 0, space)
    row[-2] = stored_energy(s, of_balls, a, p, places, 0, space) - row[-3]
    row[-1] = a[LAND_N]


@cache
def queue(ball: int, space: bool, level: bool = False, real: type = np.float32) -> Callable[..., None]:
    """Compiled queue of runs of a cage among balls of this level, in the plane or in space.

    It closes over plain numbers only, so that its code can be kept, each kind under its own name: of two
    processes that write to one index at once, one might take the code of the other.

    `start` ... `limits`: a row a run (`numbers.Numbers`, `disturbance`); `looks`, `evidence`, `hits_of`,
    `heat_of`: what it writes, a row a run; `record`: rows of the first run, after each `every` steps;
    `stop`: a flag.
    """
    states, one = LANES * cage_states(space=space), LANES * ball_states(ball, space=space)
    speed = (2 if space else 1) * LANES

    def run_queue(
        start, numbers, places_of, strips_of, waves_of, limits, steps, looks, evidence, hits_of, heat_of,
        lobe_number, record, every, stop,
    ):  # fmt: skip
        balls = hits_of.shape[1]
        size = states + one * balls
        s, t, d = np.zeros(size, real), np.zeros(size, real), np.zeros(size, real)
        q, h = np.zeros(size, real), np.zeros(size, real)
        a, w, p = np.zeros(SUMS, real), np.zeros(EXTREMES_END, real), np.ones(NUMBERS, real)
        t_balls, d_balls = t[states:].reshape(balls, one), d[states:].reshape(balls, one)
        places = np.zeros((balls, BALL_ROWS), real)
        strips = np.zeros((strips_of.shape[1], STRIP_NUMBERS), real)
        of_waves, turned = np.zeros(waves_of.shape[1] * LANES, real), np.zeros(4 * LANES, real)
        waves = of_waves.reshape(-1, HARMONIC_NUMBERS)
        held = np.zeros((HELD_NUMBERS, size if ball == ONE_STATE else 0), real)
        first = np.zeros(held.shape[1], real)
        held_balls = balls if ball == FREE else 0
        stiff, before = np.zeros((held_balls, 10 * LANES), real), np.zeros((held_balls, 8 * LANES), real)
        run, look, had = np.full(LANES, -1), np.full(LANES, -1), np.zeros(LANES)
        books = looks, evidence, hits_of, heat_of, numbers, limits
        next_run, live, row, sixth = 0, 0, 0, real(1.0 / 6.0)
        s[RAMP : RAMP + LANES] = ONE
        while stop[0] == 0:
            for l in range(LANES):
                if look[l] < 0:  # a lane that is done takes the next run
                    run[l], look[l], s[l::LANES], w[l::LANES] = -1, 0, ZERO, ZERO
                    s[RAMP + l] = ONE
                    if next_run < start.shape[0]:
                        n = run[l] = next_run
                        next_run, live = next_run + 1, live + 1
                        take(start[n], s, l)
                        take(numbers[n], p, l)
                        take(waves_of[n], of_waves, l)
                        for i in range(strips.shape[0]):
                            take(strips_of[n, i], strips[i], l)
                        for j in range(balls):
                            take(places_of[n, j], places[j], l)
                        h[l::LANES] = p[STEP + l]
                        if ball == ONE_STATE:
                            take_decay(held, p, l, states + speed, one)
                        before[:, l::LANES] = ZERO  # what a run that overflowed has left
                        if space:
                            w[AXIAL_LOW + l] = w[AXIAL_HIGH + l] = s[Z + l]
                if run[l] >= 0:
                    n = run[l]
                    begin_look(s, limits[n], look[l] * steps * numbers[n, STEP // LANES], l)
            if live == 0:
                return
            w[:WATCHED] = ZERO
            t[:] = s
            for i in range(steps):
                if i % GLANCE == GLANCE - 1:
                    place(t, a, p, space)
                    live -= end_grown(i, steps, run, look, had, books, w, t, t_balls, a, p, places, space)
                    if run.max() < 0:
                        break
                speed_up(s, a, p)
                for stage in range(4):
                    if waves.shape[0] > 0 and stage == 0:
                        around(t, p, places, waves, turned)
                    rates(t, d, t_balls, d_balls, a, p, places, strips, ball, space, level, lobe_number)
                    if ball == FREE:
                        if stage == 0:
                            hold_spins(t, t_balls, p, places, stiff, space)
                        held_spins(stage, d_balls, stiff, before, space)
                    if stage == 0:
                        if i == 0:
                            for l in range(LANES):
                                had[l] = stored_energy(t, t_balls, a, p, places, l, space)
                        watch(s, d, a, p, places, w, np.float32(i), space)
                        if row < record.shape[0] and (look[0] * steps + i) % every == 0:
                            time = (look[0] * steps + i) * numbers[0, STEP // LANES]
                            write_row(record[row], time, t, t_balls, a, p, places, space)
                            row += 1
                    if ball == ONE_STATE:
                        held_stage_end(stage, s, t, d, first, q, held)
                    else:
                        stage_end(stage, s, t, d, q, h, sixth)
            place(t, a, p, space)
            for l in range(LANES):
                n = run[l]
                if n < 0:
                    continue
                has_ended = False
                if evidence[n, JUDGED] <= look[l]:  # else it had grown too far within the look
                    kept = stored_energy(t, t_balls, a, p, places, l, space) - had[l]
                    has_ended = end_look(n, look[l], steps, steps, books, w, s, places, kept, l)
                look[l] += 1
                if has_ended:
                    look[l], live = -1, live - 1

    run_queue.__qualname__ = f"queue_{ball}_{space:d}{level:d}_{real.__name__}"
    return kernel(run_queue)
