"""Motion of the cage in the plane by small steps: exact free motion, and contact forces as kicks.

One step is kick, drift, kick (Strang): the drift is the exact free motion in the turning frame, the balls
yield exactly under an even motion of the cage, and the land acts as an impulse in the middle of the drift.
The error is of second order in the step. Steps follow the number of balls in touch; where nothing touches,
the flight to the next possible touch is one step.
"""

from __future__ import annotations

import numpy as np

from separatrix.cage.flight import centre, clear_time, drift, lean, near_land
from separatrix.cage.land import land_impulse
from separatrix.cage.pocket import kick, press, relaxation
from separatrix.cage.slots import (
    BALLS,
    FORCE_MAX,
    GROSS,
    KINETIC,
    LAND,
    LAND_FORCE,
    LAND_MAX,
    LEDGER,
    OFFSET_MAX,
    OFFSET_X,
    OFFSET_Y,
    RACE_DAMPERS,
    SPEED_SQUARED,
    SPIN,
    STATE,
    STEP,
    STORED,
    THETA,
    TURNING,
    VX,
    VY,
)
from separatrix.compiled import kernel

CALM_STRIDE = 3


@kernel
def pace(p, count):  # type: ignore[no-untyped-def]
    """Time of a number of units and what follows from it: relaxation, and the turn of the frame."""
    dt = count * p.unit
    a = p.stiffness * p.yielding * dt
    kept, followed = relaxation(a)
    angle = p.turning * dt
    return dt, a, kept, followed, np.cos(angle), np.sin(angle), np.cos(0.5 * angle), np.sin(0.5 * angle)


@kernel
def strike_land(p, t, s, ledger, tally, dt, c, i):  # type: ignore[no-untyped-def]
    """Drift one step with the land's impulse in its middle; return its mean force [N].

    `c` and `i` turn the frame by half the step.
    """
    half = 0.5 * dt
    drift(p, t, s, ledger, half, c, i)
    x, y = centre(p, s)
    e = p.eccentricity
    vx, vy = s[VX], s[VY]
    if e != 0.0:
        vx, vy = vx + e * s[SPIN] * np.sin(s[THETA]), vy - e * s[SPIN] * np.cos(s[THETA])
    px, py, moment, normal = land_impulse(p, x, y, vx, vy, s[SPIN], dt)
    if normal > 0.0:
        work = lean(p, s, px, py, moment)
        ledger[LAND] += work
        ledger[GROSS] += abs(work)
        tally[LAND_MAX] = max(tally[LAND_MAX], normal / dt)
    drift(p, t + half, s, ledger, half, c, i)
    return normal / dt


@kernel
def enter(p, s, tally, before_vx, before_vy, before_energy, peak, dt):  # type: ignore[no-untyped-def]
    """Enter one step into the tally of its window."""
    x, y = centre(p, s)
    now = s[VX] * s[VX] + s[VY] * s[VY]
    energy = 0.5 * (p.mass * now + p.inertia * s[SPIN] * s[SPIN])
    cross = before_vx * s[VY] - before_vy * s[VX]
    dot = before_vx * s[VX] + before_vy * s[VY]
    tally[KINETIC] += 0.5 * (before_energy + energy) * dt
    tally[OFFSET_X] += x * dt
    tally[OFFSET_Y] += y * dt
    if dot != 0.0:
        tally[TURNING] += cross * (1.0 + (cross / dot) ** 2 / 6.0) if abs(cross) < abs(dot) else cross
    tally[SPEED_SQUARED] += now * dt
    tally[OFFSET_MAX] = max(tally[OFFSET_MAX], x * x + y * y)
    tally[FORCE_MAX] = max(tally[FORCE_MAX], peak)
    return energy


@kernel
def kinetic_energy(p, s):  # type: ignore[no-untyped-def]
    """Kinetic energy of the cage in the turning frame [J]."""
    return 0.5 * (p.mass * (s[VX] * s[VX] + s[VY] * s[VY]) + p.inertia * s[SPIN] * s[SPIN])


@kernel
def record(p, cos, sin, s, ledger, place, slack, load, land_force, rows, filled):  # type: ignore[no-untyped-def]
    """Write a row of the history if one is due; return how many there are."""
    if filled >= rows.shape[0] or s[STEP] < rows[filled, 0]:
        return filled
    row = rows[filled]
    for j in range(STATE):
        row[j] = s[j]
    row[STEP] = s[STEP] * p.unit
    for j in range(LEDGER):
        row[STATE + j] = ledger[j]
    row[LAND_FORCE] = land_force
    balls = slack.size
    for j in range(balls):
        row[BALLS + j] = place[1] * cos[j] - place[0] * sin[j] + place[2] - slack[j]
        row[BALLS + balls + j] = load[j]
    return filled + 1


@kernel
def next_due(rows, filled):  # type: ignore[no-untyped-def]
    """Time from which the next row is due, in units; infinite when all are filled."""
    return rows[filled, 0] if filled < rows.shape[0] else np.inf


@kernel
def units_of_step(p, counts, s, slack, touching, calm, left):  # type: ignore[no-untyped-def]
    """Units in the next step: what the contacts ask for, more in flight and in lasting contact."""
    count = counts[touching] * (CALM_STRIDE if calm > p.calm_after else 1)
    if touching == 0:
        count = max(count, int(clear_time(p, s, slack, p.longest_flight) / p.unit))
    return min(count, left)


@kernel
def advance(p, cos, sin, counts, s, place, slack, load, ledger, tally, units, ceiling, rows, filled):  # type: ignore[no-untyped-def]
    """Advance the cage by a time, in place; return how many rows of the history are filled.

    Parameters
    ----------
    p : Coefficients
        The cage and its unit of time.
    cos, sin, place, slack, load : ndarray
        As in `press`.
    counts : ndarray
        Units in a step by the number of balls in touch, shape (ball + 1,).
    s, ledger, tally : ndarray
        State, work since the start, and integrals of this window, as in `slots`.
    units : int
        Time to advance; no more steps are taken, so the work is bounded.
    ceiling : float
        Kinetic energy above which to stop [J], before the numbers end.
    rows : ndarray
        History, shape (row, slot); the first slot of an unfilled row holds the time from which it is due, in
        units.
    filled : int
        Rows filled so far.
    """
    f = press(p, cos, sin, s, place, slack, load, 0.0, 1.0, 1.0)
    energy = kinetic_energy(p, s)
    done, length, calm, land_force = 0, -1, 0, 0.0
    now = pace(p, 1)
    due = next_due(rows, filled)
    while done < units and energy < ceiling:
        count = units_of_step(p, counts, s, slack, f.touching, calm, units - done)
        if count != length:
            now = pace(p, count)
            length = count
        dt, a, kept, followed, c, i, c_half, i_half = now
        vx, vy, was = s[VX], s[VY], f.squares
        if f.touching > 0:
            kick(p, s, ledger, f.cos, f.sin, f.total, 0.5 * dt)
        if near_land(p, s, dt):
            land_force = strike_land(p, s[STEP] * p.unit, s, ledger, tally, dt, c_half, i_half)
        else:
            land_force = 0.0
            drift(p, s[STEP] * p.unit, s, ledger, dt, c, i)
        f = press(p, cos, sin, s, place, slack, load, a, kept, followed)
        calm = calm + count if f.changes == 0 and f.touching > 0 else 0
        if f.touching > 0 or f.changes > 0:
            kick(p, s, ledger, f.cos + f.edge_cos, f.sin + f.edge_sin, f.total + f.edge, 0.5 * dt)
        lost = 0.5 * (was + f.squares) * p.yielding * dt
        ledger[RACE_DAMPERS] -= lost
        ledger[GROSS] += lost
        ledger[STORED] = 0.5 * f.squares / p.stiffness
        energy = enter(p, s, tally, vx, vy, energy, f.peak, dt)
        done += count
        s[STEP] += count
        if s[STEP] >= due:
            filled = record(p, cos, sin, s, ledger, place, slack, load, land_force, rows, filled)
            due = next_due(rows, filled)
    return filled
