"""One run in space from its start to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from separatrix.cage.ending import (
    FED,
    FEWEST_LOOKS,
    HALF,
    SETTLES,
    UNKNOWN,
    UNRESOLVED,
    Limits,
    end_by_trend,
    fed,
    high_end,
    mean_energy,
    plain_end,
)
from separatrix.cage.planar import Cause
from separatrix.cage.records import Whole
from separatrix.cage.run import DRIFTS, drift_rate, growth
from separatrix.cage.space.motion import advance
from separatrix.cage.space.records import (
    AXIAL,
    CLEAR,
    GRIPPED,
    LEAD,
    NONE,
    PRESSED,
    PUSH_L,
    Books,
    Motion,
    Numbers,
    Parts,
    SpaceEvidence,
)
from separatrix.cage.space.tally import held, kinetic, total
from separatrix.cage.step import LONGEST
from separatrix.compiled import kernel, part
from separatrix.units import Array

BY_NOTHING, IMPACTS, NO_CONTACT, FALLING, NOT_FINITE, BY_LAND = (int(cause) for cause in Cause)
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


@part
def watch(
    p: Numbers, parts: Parts, state: Motion, books: Books, hits: Whole, heat: Array, limits: Limits
) -> tuple[int, int, int]:
    """Run, look by look, until the end of the motion is plain; as `cage.run.watch`."""
    length, looks, ledger, memory = limits.beats * limits.beat, books.looks, books.works[0], books.memory[0]
    outcome, judged, touches, touched = UNKNOWN, 0, 0, bool(p.grips)
    for i in range(limits.most):
        looks[i] = looks[limits.most]  # type: ignore[index]
        look = looks[i]
        pocket, land, ball = ledger.pocket_friction, ledger.land_friction, ledger.ball_drive
        gravity, frame = ledger.gravity, ledger.moving_frame
        going, beat = True, 0
        while going and beat < limits.beats and kinetic(p, state) < limits.grown:
            going = advance(
                p, parts, state, ledger, books.works[1], look, hits, heat, limits.beat, limits.grown
            )
            beat += 1
        look.pocket_work = ledger.pocket_friction - pocket
        look.land_work = ledger.land_friction - land
        look.ball_work, look.gravity_work = ledger.ball_drive - ball, ledger.gravity - gravity
        if limits.drifts and limits.drive == 0.0:
            look.frame_work = ledger.moving_frame - frame
        energy, spring = kinetic(p, state), held(p, parts)
        if not (going and np.isfinite(energy + look.kinetic)):
            cause = NOT_FINITE if going else IMPACTS
            return (UNRESOLVED, i + 1, cause) if outcome == UNKNOWN else (outcome, judged, BY_NOTHING)
        hit = int(np.sum(hits))
        met = bool(np.any(parts.kind != NONE) or hit > touches)
        touches = hit
        touched = touched or met or look.land_hits > 0.0
        if outcome == UNKNOWN:
            judged = i + 1
            if energy + spring > limits.grown:
                outcome = high_end(looks, judged)
            elif touched and energy + spring < limits.still:
                outcome = SETTLES
            elif touched and state.clock >= p.ramp_time:
                outcome = plain_end(looks, i, length, met, limits, memory)
            if outcome == UNKNOWN and judged == limits.most:
                outcome = end_by_trend(looks, judged, length, limits)
        if outcome != UNKNOWN and (i + 1 >= limits.least or energy + spring > limits.grown):
            break
    if not touched:
        return UNRESOLVED, judged, NO_CONTACT
    if outcome == UNRESOLVED:
        return outcome, judged, FALLING
    first = max(0, judged - FED)
    lively = outcome == SETTLES and mean_energy(looks, first, judged, length) > limits.drive
    return outcome, judged, BY_LAND if lively and fed(looks, first, judged)[2] > HALF else BY_NOTHING


@part
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
    length = limits.beats * limits.beat
    begin(p, parts, start, kicks, state, axial_place)
    energy = kinetic(p, state)
    outcome, end, cause = watch(p, parts, state, books, hits, heat, limits)
    out.outcome, out.cause = DRIFTS if limits.drifts and outcome == SETTLES else outcome, cause
    unexplained = kinetic(p, state) + held(p, parts) - energy - total(works)
    out.energy_imbalance = abs(unexplained) / (works.gross + energy)
    if cause == NOT_FINITE:
        return
    out.followed = end * length * p.unit
    out.growth_rate = growth(looks, end, length, energy) / p.unit
    out.drift_rate = drift_rate(looks, end, limits.window) / (length * p.unit)
    farthest = force = land_force = steepest = 0.0
    for i in range(end):
        look = looks[i]
        farthest, force = max(farthest, look.offset_max), max(force, look.force_max)
        land_force, steepest = max(land_force, look.land_max), max(steepest, look.tilt_max)
        out.land_impacts += int(look.land_hits)
        out.axial_low, out.axial_high = (
            min(out.axial_low, look.axial_low),
            max(out.axial_high, look.axial_high),
        )
    out.largest_offset, out.largest_tilt = np.sqrt(farthest), np.sqrt(steepest) / p.radius
    out.largest_contact_force, out.largest_land_force = force / p.unit**2, land_force / p.unit**2
    enter_end(p, books, end, length, limits, out)


@part
def enter_end(p: Numbers, books: Books, end: int, length: float, limits: Limits, out: SpaceEvidence) -> None:
    """Write what the motion is in the looks by which it was judged: the last fifth, or the last window."""
    n = max(1, end // FEWEST_LOOKS, min(end, limits.window))
    first, time, sums = end - n, n * length, books.looks[limits.most + 1]
    books.looks[limits.most + 1] = books.looks[limits.most]  # type: ignore[index]
    for i in range(first, end):
        look = books.looks[i]
        sums.kinetic += look.kinetic
        sums.turning += look.turning
        sums.speed_squared += look.speed_squared
        sums.offset += look.offset
        sums.offset_squared += look.offset_squared
        sums.swept += look.swept
        sums.tilt += look.tilt
        sums.tilt_squared += look.tilt_squared
        sums.tilt_swept += look.tilt_swept
        sums.together += look.together
        sums.crossed += look.crossed
        sums.axial += look.axial
        sums.axial_squared += look.axial_squared
        sums.pocket_work += look.pocket_work
        sums.land_work += look.land_work
        sums.pressed += look.pressed
        sums.rubbed += look.rubbed
        sums.strikes += look.strikes
    out.judged_from = first * length * p.unit
    out.end_energy = sums.kinetic / time / p.unit**2
    whirl = sums.turning / sums.speed_squared / p.unit if sums.speed_squared > 0.0 else 0.0
    out.whirl_frequency, out.whirl_direction = abs(whirl) / (2.0 * np.pi), int(np.sign(whirl))
    out.mean_offset = sums.offset / time
    out.offset_spread = np.sqrt(max(0.0, sums.offset_squared / time - out.mean_offset**2))
    orbit = sums.swept / sums.offset_squared if sums.offset_squared > 0.0 else 0.0
    out.orbit_speed = (orbit + p.turning) / p.unit
    cone = sums.tilt_swept / sums.tilt_squared if sums.tilt_squared > 0.0 else 0.0
    out.cone_speed = (cone + p.turning) / p.unit if sums.tilt_squared > 0.0 else 0.0
    out.cone_phase = np.arctan2(sums.crossed, sums.together)
    out.mean_tilt = sums.tilt / time / p.radius
    out.axial_place = sums.axial / time
    out.axial_spread = np.sqrt(max(0.0, sums.axial_squared / time - out.axial_place**2))
    out.strike_rate = sums.strikes / (time * p.unit)
    out.pocket_power, out.land_power = sums.pocket_work / time / p.unit**3, sums.land_work / time / p.unit**3
    out.rubbing_force = sums.pressed / time / p.unit**2
    out.rubbing_speed = sums.rubbed / sums.pressed / p.unit if sums.pressed > 0.0 else 0.0


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
    and its place along the groove, then by strip of the lands its force.
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
        row[12], row[13] = kinetic(p, now), held(p, parts)
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
    return int(times.size)
