"""One run in space from its start to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from separatrix.cage.ending import (
    BY_NOTHING,
    SETTLES,
    UNKNOWN,
    UNRESOLVED,
    Limits,
    after_look,
    book,
    with_cause,
)
from separatrix.cage.records import Pace, Whole
from separatrix.cage.run import DRIFTS, IMPACTS, NOT_FINITE, enter_looks, last_part
from separatrix.cage.space.expand import load
from separatrix.cage.space.motion import advance
from separatrix.cage.space.records import (
    AXIAL,
    CLEAR,
    GRIPPED,
    LEAD,
    NONE,
    OUTER_CLEAR,
    OUTER_RIM,
    PRESSED,
    PUSH,
    PUSH_L,
    TO_Z,
    Books,
    Motion,
    Numbers,
    Parts,
    SpaceEvidence,
    SpaceLook,
)
from separatrix.cage.space.rim import expand_rim
from separatrix.cage.space.rim_events import place_ball
from separatrix.cage.space.tally import held_energy, kinetic, total
from separatrix.cage.step import LONGEST
from separatrix.compiled import kernel, part, unfolded
from separatrix.units import Array

DIRECTION, TILT_WAY, AXIAL_WAY, FIRST_LEAD = range(4)
"""Columns of a start: directions of the kick and of the tilt's [rad], sense of the axial one, then leads."""


@part
def begin(p: Numbers, parts: Parts, start: Array, kicks: Array, state: Motion, axial_place: float) -> None:
    """Put the cage and its balls where a run starts; `kicks` across, along the axis and of the tilt."""
    count = parts.moving.size
    state.x, state.z = p.eccentricity, axial_place
    state.b, state.reach = p.leaning, LONGEST
    state.vx, state.vy = kicks[0] * np.cos(start[DIRECTION]), kicks[0] * np.sin(start[DIRECTION])
    state.vz = kicks[1] * start[AXIAL_WAY] if p.axial_swiftness > 0.0 else 0.0
    if p.tilt_swiftness > 0.0:
        state.va, state.vb = kicks[2] * np.cos(start[TILT_WAY]), kicks[2] * np.sin(start[TILT_WAY])
    parts.kind[:], parts.moving[:], parts.mode[:], parts.region[:] = NONE, 0, CLEAR, 0
    parts.stiff[:], parts.paired[:] = p.stiffness, 0
    parts.creeping[:] = 1 if p.slides_from > 0.0 else 0
    parts.ball[:, :, :], parts.contact[:, :, :] = 0.0, 0.0
    angle = start[FIRST_LEAD + 2 * count :]
    parts.cosine[:], parts.sine[:] = np.cos(angle), np.sin(angle)
    parts.play[:] = start[FIRST_LEAD + count : FIRST_LEAD + 2 * count]
    parts.ball[:, 0, LEAD] = start[FIRST_LEAD : FIRST_LEAD + count]
    if p.is_slot:
        for j in range(count):
            along = -parts.ball[j, 0, LEAD]
            parts.region[j] = int(np.sign(along)) if abs(along) > p.apart else 0
    if p.grips:
        parts.kind[::2] = GRIPPED
    if p.grips_axially:
        parts.kind[1::2] = GRIPPED
    if p.grips or p.grips_axially:
        parts.moving[:] = 1


@unfolded
def watch(
    p: Numbers, parts: Parts, state: Motion, books: Books, hits: Whole, heat: Array, limits: Limits
) -> tuple[int, int, int]:
    """Run, look by look, until the end of the motion is plain; returns as `cage.run.watch`."""
    looks, ledger, memory = books.looks, books.works[0], books.memory[0]
    outcome, judged, touches, touched = UNKNOWN, 0, 0, bool(p.grips)
    for i in range(limits.most):
        looks[i] = looks[limits.most]  # type: ignore[index]
        look = looks[i]
        look.axial_low = look.axial_high = state.z
        book(looks, i, ledger, -1.0, limits)
        going, beat = True, 0
        while going and beat < limits.beats and kinetic(p, state) < limits.grown:
            going = advance(
                p, parts, state, ledger, books.works[1], look, hits, heat, limits.beat, limits.grown
            )
            beat += 1
        book(looks, i, ledger, 1.0, limits)
        energy, held = kinetic(p, state), held_energy(p, parts)
        if not (going and np.isfinite(energy + look.kinetic)):
            cause = NOT_FINITE if going else IMPACTS
            return (UNRESOLVED, i + 1, cause) if outcome == UNKNOWN else (outcome, judged, BY_NOTHING)
        hit = int(np.sum(hits))
        met = bool(np.any((parts.kind != NONE) & (parts.kind < OUTER_CLEAR)) or hit > touches)
        touches = hit
        touched = touched or met or look.land_hits > 0.0
        if outcome == UNKNOWN:
            judged = i + 1
            outcome = after_look(
                looks, i, energy + held, met, touched, state.clock >= p.ramp_time, limits, memory
            )
        if outcome != UNKNOWN and (i + 1 >= limits.least or energy + held > limits.grown):
            break
    return with_cause(looks, outcome, judged, touched, limits)


@unfolded
def run_one(
    p: Numbers,
    parts: Parts,
    start: Array,
    kicks: Array,
    axial_place: float,
    books: Books,
    limits: Limits,
    out: SpaceEvidence,
    hits: Whole,
    heat: Array,
) -> None:
    """Run from one start; write outcome and evidence into `out`."""
    books.state[0], books.works[0], books.memory[0] = books.state[1], books.works[2], books.memory[1]  # type: ignore[index]
    state, works, looks = books.state[0], books.works[0], books.looks
    begin(p, parts, start, kicks, state, axial_place)
    energy = kinetic(p, state)
    outcome, end, cause = watch(p, parts, state, books, hits, heat, limits)
    out.outcome, out.cause = DRIFTS if limits.drifts and outcome == SETTLES else outcome, cause
    unexplained = kinetic(p, state) + held_energy(p, parts) - energy - total(works)
    out.energy_imbalance = abs(unexplained) / (works.gross + energy)
    if cause == NOT_FINITE:
        return
    enter_looks(p, looks, end, energy, limits, out)
    enter_tilt(p, looks, end, limits, out)


@part
def enter_tilt(p: Numbers, looks: Sequence[SpaceLook], end: int, limits: Limits, out: SpaceEvidence) -> None:
    """Write of tilt and axial motion: their extremes, and what they are in the last part of the looks."""
    steepest, out.axial_low, out.axial_high = 0.0, looks[0].axial_low, looks[0].axial_high
    for i in range(end):
        steepest = max(steepest, looks[i].tilt_max)
        out.axial_low = min(out.axial_low, looks[i].axial_low)
        out.axial_high = max(out.axial_high, looks[i].axial_high)
    out.largest_tilt = np.sqrt(steepest) / p.radius
    n = last_part(end, limits)
    tilt = tilt_squared = tilt_swept = together = crossed = axial = axial_squared = strikes = 0.0
    for i in range(end - n, end):
        look = looks[i]
        tilt += look.tilt
        tilt_squared += look.tilt_squared
        tilt_swept += look.tilt_swept
        together += look.together
        crossed += look.crossed
        axial += look.axial
        axial_squared += look.axial_squared
        strikes += look.strikes
    time = n * limits.beats * limits.beat
    if tilt_squared > 0.0:
        out.cone_speed = (tilt_swept / tilt_squared + p.turning) / p.unit
    out.cone_phase = np.arctan2(crossed, together)
    out.mean_tilt = tilt / time / p.radius
    out.axial_place = axial / time
    out.axial_spread = np.sqrt(max(0.0, axial_squared / time - out.axial_place**2))
    out.strike_rate = strikes / (time * p.unit)


@kernel
def run_chunk(
    p: Numbers,
    parts: Parts,
    starts: Array,
    kicks: Array,
    axial_place: float,
    books: Books,
    limits: Limits,
    out: Sequence[SpaceEvidence],
    hits: Whole,
    heat: Array,
) -> None:
    """Run from every row of `starts`; evidence into `out`, impacts and rubbing of every pocket beside it."""
    for i in range(starts.shape[0]):
        run_one(p, parts, starts[i], kicks, axial_place, books, limits, out[i], hits[i], heat[i])


@kernel
def follow_run(
    p: Numbers,
    parts: Parts,
    start: Array,
    kicks: Array,
    axial_place: float,
    books: Books,
    times: Array,
    ceiling: float,
    out: Array,
    hits: Whole,
    heat: Array,
) -> int:
    """Follow a run from time to time into rows of `out`; return how many were filled below the ceiling.

    A row: the twelve numbers of the motion, kinetic and held energy, work by source, then by ball its lead
    and its place along the groove, then by strip of the lands its force; of pockets whose edges may touch
    the balls see `enter_edges`.
    """
    now, count, works = books.state[0], parts.moving.size, books.works[0]
    begin(p, parts, start, kicks, now, axial_place)
    for i in range(times.size):
        length = times[i] - now.clock
        if length > 0.0:
            if not advance(p, parts, now, works, books.works[1], books.looks[0], hits, heat, length, ceiling):
                return i
            if kinetic(p, now) >= ceiling:
                return i
        row = out[i]
        row[0], row[1], row[2], row[3], row[4], row[5] = now.x, now.y, now.z, now.s, now.a, now.b
        row[6], row[7], row[8], row[9], row[10], row[11] = now.vx, now.vy, now.vz, now.vs, now.va, now.vb
        row[12], row[13] = kinetic(p, now), held_energy(p, parts)
        row[14], row[15], row[16], row[17] = (
            works.pocket_friction,
            works.races,
            works.grooves,
            works.ball_drive,
        )
        row[18], row[19] = works.land_friction, works.land_damping
        row[20], row[21] = works.gravity, works.moving_frame
        for j in range(count):
            row[22 + j], row[22 + count + j] = parts.ball[j, 0, LEAD], parts.ball[j, 0, AXIAL]
        for i_ in range(parts.mode.size):
            pressed = parts.mode[i_] == PRESSED
            row[22 + 2 * count + i_] = parts.strip[i_, 0, PUSH_L] if pressed else 0.0
        if p.margin < np.inf:
            load(p, parts, now)
            enter_edges(p, parts, row[22 + 2 * count + parts.mode.size :])
    return int(times.size)


@part
def enter_edges(p: Numbers, parts: Parts, row: Array) -> None:
    """Force of the edges on each ball, -1 where none is near; then its direction: axial, outward, along."""
    count = parts.moving.size
    row[:count], row[count:] = -1.0, 0.0
    for i in range(2 * count):
        if parts.kind[i] < OUTER_RIM:
            continue
        j = i // 2
        place_ball(parts, j)
        expand_rim(p, parts, i, Pace(1.0, 0.0), 0)
        push, before = parts.contact[i, 0, PUSH] if parts.kind[i] < OUTER_CLEAR else 0.0, max(0.0, row[j])
        squared = 0.0
        for k in range(3):
            at = (k + 1) * count + j
            row[at] = before * row[at] + push * parts.rim[i, 0, TO_Z + k]
            squared += row[at] * row[at]
        row[j] = np.sqrt(squared)
        for k in range(3):
            row[(k + 1) * count + j] /= row[j] if squared > 0.0 else 1.0
