"""Runs side by side: sixteen at a time from their starts to their ends, a queue that refills the lanes.

A run's bits depend on its own numbers and start only: not on its lane, its neighbours, the number of threads.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from separatrix.cage.frame import place
from separatrix.cage.motion import rates
from separatrix.cage.outcome import FROM, LEAST, MOST, RAMP_START, RAMP_TIME, TURNS_AT, UNKNOWN, end_of_motion
from separatrix.cage.pocket_force import pocket_depth, pocket_depth_in_plane
from separatrix.cage.rows import *  # noqa: F403
from separatrix.cage.step import held_stage_end, hold, stage_end
from separatrix.compiled import inlined, kernel, part

OUTCOME, CAUSE, ENDED, JUDGED, OPEN, DONE, LEFT_AT, FIRST_EXTREME = range(8)
EVIDENCE_COLUMNS = FIRST_EXTREME + EXTREMES_END - WATCHED


@inlined
def orbit_speeds(s, places, waves, turned, balls):
    """Speed of every ball's free orbit beyond that of the ball set, at its azimuth in space."""
    for j in range(balls):
        q = places[j * BALL_ROWS * LANES : (j + 1) * BALL_ROWS * LANES]
        for l in range(LANES):
            c, n = s[TURN_COSINE * LANES + l], s[TURN_SINE * LANES + l]
            turned[l] = q[COSINE * LANES + l] * c - q[SINE * LANES + l] * n
            turned[LANES + l] = q[SINE * LANES + l] * c + q[COSINE * LANES + l] * n
            turned[2 * LANES + l], turned[3 * LANES + l] = turned[l], turned[LANES + l]
            q[OWN_SPEED * LANES + l] = ZERO
        for h in range(waves.size // (HARMONIC_NUMBERS * LANES)):
            row = h * HARMONIC_NUMBERS * LANES
            for l in range(LANES):
                c, n = turned[2 * LANES + l], turned[3 * LANES + l]
                q[OWN_SPEED * LANES + l] += waves[row + l] * c + waves[row + LANES + l] * n
                turned[2 * LANES + l] = c * turned[l] - n * turned[LANES + l]
                turned[3 * LANES + l] = n * turned[l] + c * turned[LANES + l]


@inlined
def kinetic_energy(s, p, l, space):
    """Kinetic energy of the cage in the turning frame."""
    e = p[MASS * LANES + l] * (s[VX * LANES + l] ** 2 + s[VY * LANES + l] ** 2)
    e += s[VS * LANES + l] ** 2 / p[PER_TURNING * LANES + l]
    if space:
        e += p[AXIAL_MASS * LANES + l] * s[VZ * LANES + l] ** 2
        e += p[TRANSVERSE * LANES + l] * (s[WX * LANES + l] ** 2 + s[WY * LANES + l] ** 2)
    return HALF * e


@part
def spring_energy(s, a, p, places, l, balls, one, space, hertz):
    """Energy in the pockets' springs of the run in lane l; `a` has its geometric centre."""
    total, states = 0.0, SPACE_STATES if space else PLANE_STATES
    for j in range(balls):
        b, q = (states + j * one) * LANES + l, j * BALL_ROWS * LANES + l
        c, e = places[q + COSINE * LANES], places[q + SINE * LANES]
        along = a[GY * LANES + l] * c - a[GX * LANES + l] * e + s[S * LANES + l] - s[b]
        if space:
            across = s[Z * LANES + l] - p[RADIUS * LANES + l] * (a[GB * LANES + l] * c - a[GA * LANES + l] * e) - s[b + LANES]
            depth = pocket_depth(along, across, places[q + AROUND * LANES], places[q + APART * LANES], p[BESIDE * LANES + l])[0]
        else:
            depth = pocket_depth_in_plane(along, places[q + APART * LANES], p[LEAN_SINE * LANES + l], p[LEAN_COSINE * LANES + l])[0]
        k = p[STIFFNESS * LANES + l]
        total += 0.4 * k * depth * depth * math.sqrt(depth) if hertz else 0.5 * k * depth * depth
    return total


@inlined
def watch(s, d, a, p, places, w, balls, i, space):
    """Add what is watched of this moment to the sums of the look and the extremes of the run."""
    for l in range(LANES):
        x, y, gvx, gvy = a[GX * LANES + l], a[GY * LANES + l], a[GVX * LANES + l], a[GVY * LANES + l]
        vx, vy, push = s[VX * LANES + l], s[VY * LANES + l], a[LAND_N * LANES + l]
        square = x * x + y * y
        r = math.sqrt(square)
        w[ENERGY * LANES + l] += kinetic_energy(s, p, l, space)
        w[OFFSET_MEAN * LANES + l] += r
        w[OFFSET_SQUARE * LANES + l] += square
        w[SWEPT * LANES + l] += x * gvy - y * gvx
        w[CURL * LANES + l] += vx * d[VY * LANES + l] - vy * d[VX * LANES + l]
        w[SPEED_SQUARE * LANES + l] += vx * vx + vy * vy
        w[PRESSED * LANES + l] += push
        w[HEATED * LANES + l] += a[LAND_HEAT * LANES + l]
        w[MEAN_X * LANES + l] += x
        w[MEAN_Y * LANES + l] += y
        on = ONE if push > ZERO else ZERO
        w[LAND_STRIKES * LANES + l] += max(on - w[LAND_TOUCHED * LANES + l], ZERO)
        w[LAND_TOUCHED * LANES + l] = on
        w[PEAK_LAND * LANES + l] = max(w[PEAK_LAND * LANES + l], push)
        w[PEAK_OFFSET * LANES + l] = max(w[PEAK_OFFSET * LANES + l], r)
        if space:
            ta, tb, z = a[GA * LANES + l], a[GB * LANES + l], s[Z * LANES + l]
            tilt2 = ta * ta + tb * tb
            tilt = math.sqrt(tilt2)
            w[TILT * LANES + l] += tilt
            w[TILT_SQUARE * LANES + l] += tilt2
            w[CONE * LANES + l] += ta * a[GWB * LANES + l] - tb * a[GWA * LANES + l]
            w[LEAN_CROSS * LANES + l] -= x * ta + y * tb
            w[LEAN_DOT * LANES + l] += x * tb - y * ta
            w[AXIAL * LANES + l] += z
            w[AXIAL_SQUARE * LANES + l] += z * z
            w[PEAK_TILT * LANES + l] = max(w[PEAK_TILT * LANES + l], tilt)
            w[AXIAL_LOW * LANES + l] = min(w[AXIAL_LOW * LANES + l], z)
            w[AXIAL_HIGH * LANES + l] = max(w[AXIAL_HIGH * LANES + l], z)
    for j in range(balls):
        q, number = places[j * BALL_ROWS * LANES : (j + 1) * BALL_ROWS * LANES], np.float32(j + 1)
        for l in range(LANES):
            push = q[FORCE * LANES + l]
            on = ONE if push > ZERO else ZERO
            strike = max(on - q[TOUCHING * LANES + l], ZERO)
            q[TOUCHING * LANES + l] = on
            q[HITS * LANES + l] += strike
            q[RUBBED * LANES + l] += q[HEAT * LANES + l]
            w[STRIKES * LANES + l] += strike
            w[PEAK_FORCE * LANES + l] = max(w[PEAK_FORCE * LANES + l], push)
            out = a[GX * LANES + l] * q[COSINE * LANES + l] + a[GY * LANES + l] * q[SINE * LANES + l]
            beyond = max(out - p[MARGIN_IN * LANES + l], -out - p[MARGIN_OUT * LANES + l])
            was, when = w[LEFT_BALL * LANES + l], w[LEFT_STEP * LANES + l]
            is_first = (beyond > ZERO) & (push > ZERO) & (was == ZERO)
            w[LEFT_BALL * LANES + l] = number if is_first else was
            w[LEFT_STEP * LANES + l] = i if is_first else when


@part
def frame_angle(time, limits):
    """Angle of the frame against the housing, and the share of its speed that the ball set has."""
    rise, start = limits[RAMP_TIME], limits[RAMP_START]
    if time >= rise:
        return limits[TURNS_AT] * (time - 0.5 * (1.0 - start) * rise), 1.0
    share = start + (1.0 - start) * time / rise
    return limits[TURNS_AT] * 0.5 * (start + share) * time, share


@cache
def queue(ball: int, space: bool, leans: bool = False, hertz: bool = False, lobe_number: int = 0, real: type = np.float32) -> Callable[..., None]:
    """Compiled queue of runs of a cage among balls of this level, in the plane or in space.

    It closes over plain numbers only, so that its code can be kept.
    """
    states, one = cage_states(space=space), ball_states(ball, space=space)
    speed_row = 2 if space else 1

    def run_queue(start, numbers, places_of, strips_of, waves_of, limits, steps, looks, evidence, hits_of, heat_of, record, every, stop):  # noqa: E501
        balls = hits_of.shape[1]
        size = (states + one * balls) * LANES
        s, t, d, q = np.zeros(size, real), np.zeros(size, real), np.zeros(size, real), np.zeros(size, real)
        a, w = np.zeros(SUMS * LANES, real), np.zeros(EXTREMES_END * LANES, real)
        p = np.ones(NUMBERS * LANES, real)
        places, strips = np.zeros(balls * BALL_ROWS * LANES, real), np.zeros(strips_of.shape[1] * LANES, real)
        waves, turned = np.zeros(waves_of.shape[1] * LANES, real), np.zeros(4 * LANES, real)
        before, first_rate, middle_rate = np.zeros(balls * LANES, real), np.zeros(balls * LANES, real), np.zeros(balls * LANES, real)
        h = np.zeros(size, real)
        run, look, had = np.full(LANES, -1), np.full(LANES, -1), np.zeros(LANES)
        next_run = live = row = 0
        while stop[0] == 0:
            for l in range(LANES):
                if look[l] < 0:  # a lane that is done takes the next run
                    run[l], look[l] = -1, 0
                    s[l::LANES] = ZERO
                    w[l::LANES] = ZERO
                    places[l::LANES] = ZERO
                    if next_run < start.shape[0]:
                        run[l], next_run, live = next_run, next_run + 1, live + 1
                        take(start[run[l]], s, l)
                        take(numbers[run[l]], p, l)
                        h[l::LANES] = p[STEP * LANES + l]
                        for j in range(balls):
                            for i in range(BALL_NUMBERS):
                                places[(j * BALL_ROWS + i) * LANES + l] = places_of[run[l], j * BALL_NUMBERS + i]
                        take(strips_of[run[l]], strips, l)
                        take(waves_of[run[l]], waves, l)
                        w[AXIAL_LOW * LANES + l] = w[AXIAL_HIGH * LANES + l] = s[Z * LANES + l] if space else ZERO
                n = run[l]
                if n >= 0:
                    time = look[l] * steps * numbers[n, STEP]
                    angle, share = frame_angle(time, limits[n])
                    s[TURN_COSINE * LANES + l], s[TURN_SINE * LANES + l] = math.cos(angle), math.sin(angle)
                    s[RAMP * LANES + l] = share
                else:
                    s[RAMP * LANES + l] = ONE
                for work in range(POCKET_WORK, FRAME_WORK + 1):
                    s[work * LANES + l] = ZERO
            if live == 0:
                return
            w[: WATCHED * LANES] = ZERO
            t[:] = s
            for i in range(steps):
                for stage in range(4):
                    if waves.size > 0:
                        orbit_speeds(t, places, waves, turned, balls)
                    rates(t, d, a, p, places, strips, balls, ball, space, leans, hertz, lobe_number)
                    if stage == 0:
                        if i == 0:
                            for l in range(LANES):
                                had[l] = kinetic_energy(s, p, l, space) + spring_energy(s, a, p, places, l, balls, one, space, hertz)
                        watch(s, d, a, p, places, w, balls, np.float32(i), space)
                        if row < record.shape[0] and (look[0] * steps + i) % every == 0:
                            write_row(record[row], (look[0] * steps + i) * numbers[0, STEP], s, a, places, balls)
                            row += 1
                    if ball == ONE_STATE and stage == 0:
                        hold(s, before, (states + speed_row) * LANES, one * LANES, balls)
                    stage_end(stage, s, t, d, q, h)
                    if ball == ONE_STATE:
                        held_stage_end(stage, s, t, d, before, first_rate, middle_rate, p, (states + speed_row) * LANES, one * LANES, balls)
            place(t, a, p, space)
            for l in range(LANES):
                n = run[l]
                if n < 0:
                    continue
                found, at = looks[n, look[l]], evidence[n]
                for column in range(WATCHED):
                    found[column] = w[column * LANES + l] / steps
                step = numbers[n, STEP]
                found[STRIKES] /= step
                found[WORK_POCKET], found[WORK_LAND] = s[POCKET_WORK * LANES + l], s[LAND_WORK * LANES + l]
                found[WORK_PRESS], found[WORK_BALL] = s[LAND_PRESS_WORK * LANES + l], s[BALL_WORK * LANES + l]
                found[WORK_FRAME] = s[FRAME_WORK * LANES + l]
                works = done = 0.0
                for work in range(WORK_POCKET, WORK_FRAME + 1):
                    works += found[work]
                    done += abs(found[work])
                kept = kinetic_energy(s, p, l, space) + spring_energy(s, a, p, places, l, balls, one, space, hertz) - had[l]
                at[OPEN] += abs(kept - works)
                at[DONE] += done
                touched = w[PEAK_FORCE * LANES + l] + w[PEAK_LAND * LANES + l] > ZERO
                for e in range(EXTREMES_END - WATCHED):
                    at[FIRST_EXTREME + e] = w[(WATCHED + e) * LANES + l]
                for j in range(balls):
                    pocket = j * BALL_ROWS * LANES + l
                    hits_of[n, j] += places[pocket + HITS * LANES]
                    heat_of[n, j] += places[pocket + RUBBED * LANES] * step
                    places[pocket + HITS * LANES] = places[pocket + RUBBED * LANES] = ZERO
                look[l] += 1
                if at[OUTCOME] == UNKNOWN:
                    at[OUTCOME], at[CAUSE] = end_of_motion(looks[n], look[l] - 1, touched, limits[n])
                    at[JUDGED] = look[l]
                    if w[LEFT_BALL * LANES + l] > ZERO:
                        at[OUTCOME], at[CAUSE] = 3, 1
                        at[LEFT_AT] = ((look[l] - 1) * steps + w[LEFT_STEP * LANES + l]) * step
                at[ENDED] = look[l]
                is_over = look[l] >= limits[n, LEAST] or not math.isfinite(found[ENERGY])
                if at[OUTCOME] != UNKNOWN and is_over:
                    look[l], live = -1, live - 1

    return kernel(run_queue)


@part
def take(numbers, into, lane):
    """Put the numbers of a run into its lane."""
    for i in range(numbers.size):
        into[i * LANES + lane] = numbers[i]


@part
def write_row(row, time, s, a, places, balls):
    """Time, state, geometric centre and axis, forces of the pockets and of the land, of the first lane."""
    row[0] = time
    n = 1
    for i in range(s.size // LANES):
        row[n] = s[i * LANES]
        n += 1
    for i in range(GX, GWB + 1):
        row[n] = a[i * LANES]
        n += 1
    for j in range(balls):
        row[n] = places[(j * BALL_ROWS + FORCE) * LANES]
        n += 1
    row[n] = a[LAND_N * LANES]
