"""One run from a kick to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.ending import (
    FED,
    FEWEST_LOOKS,
    HALF,
    MEMORY,
    SETTLES,
    UNKNOWN,
    UNRESOLVED,
    end_by_trend,
    fed,
    high_end,
    mean_energy,
    plain_end,
)
from separatrix.cage.evidence import pocket_energy
from separatrix.cage.motion import advance, kinetic, land_energy, make_room
from separatrix.cage.planar import Cause, RunOutcome
from separatrix.cage.series import POWERS
from separatrix.cage.slots import (
    BALL_DRIVE,
    BALL_WORK,
    CAUSE,
    CLEAR,
    CLOCK,
    COSINE,
    DIRECTION,
    DRIFT_RATE,
    DRIVE,
    END_ENERGY,
    FOLLOWED,
    FORCE,
    FORCE_MAX,
    FRAME_WORK,
    GRAVITY,
    GRAVITY_WORK,
    GROSS,
    GROWTH_RATE,
    IMBALANCE,
    JUDGED,
    KINETIC,
    LAND_FORCE,
    LAND_FRICTION,
    LAND_HITS,
    LAND_IMPACTS,
    LAND_MAX,
    LAND_WORK,
    LARGEST_OFFSET,
    LEAD,
    LEDGER,
    LIST,
    MEAN_OFFSET,
    MEAN_X,
    MEAN_Y,
    MOVING_FRAME,
    OFFSET,
    OFFSET_MAX,
    OFFSET_SPREAD,
    OFFSET_SQUARED,
    ORBIT_SPEED,
    OUTCOME,
    PENETRATION,
    PLAY,
    POCKET_FRICTION,
    POCKET_POWER,
    POCKET_WORK,
    PRESSED,
    ROWS,
    RUBBED,
    RUBBING_FORCE,
    RUBBING_SPEED,
    SIDE,
    SINE,
    SPEED_SQUARED,
    STATE,
    SWEPT,
    TALLY,
    TURNING,
    VX,
    VY,
    WHIRL,
    WORKS,
    X,
)
from separatrix.compiled import kernel

if TYPE_CHECKING:
    from separatrix.units import Array

DRIFTS = int(RunOutcome.DRIFTS)
NONE, IMPACTS, NO_CONTACT, FALLING, NOT_FINITE, BY_LAND = (int(cause) for cause in Cause)
NOTHING_LEFT = 2.0**-104
"""Share of the kick's energy below which speeds are rounding: growth rates count no further."""


@kernel
def held_energy(p, pockets, touch, count):  # type: ignore[no-untyped-def]
    """Energy in the pockets' springs, over the mass."""
    held = 0.0
    for i in range(count):
        held += pocket_energy(p, pockets[PENETRATION, touch[LIST, i]])
    return held


@kernel
def watch(  # type: ignore[no-untyped-def]
    p, pockets, touch, s, w, mode, ledger, tally, hits, limits, rows, room
):
    """Run, look by look, until the end of the motion is plain.

    Returns
    -------
    tuple
        Outcome, the looks up to which it was judged, and the cause.
    """
    memory, look = np.zeros(MEMORY), limits.beats * limits.beat
    outcome, judged, touches, touched = UNKNOWN, 0, 0, mode[0] > 0
    for i in range(limits.most):
        tally[i] = 0.0
        pocket, land = ledger[POCKET_FRICTION], ledger[LAND_FRICTION]
        ball, gravity, frame = ledger[BALL_DRIVE], ledger[GRAVITY], ledger[MOVING_FRAME]
        going, beat = True, 0
        while going and beat < limits.beats and kinetic(p, s) < limits.grown:
            going = advance(
                p, pockets, touch, s, w, mode, ledger, tally[i], hits, limits.beat, limits.grown, rows, room
            )
            beat += 1
        tally[i, POCKET_WORK] = ledger[POCKET_FRICTION] - pocket
        tally[i, LAND_WORK] = ledger[LAND_FRICTION] - land
        tally[i, BALL_WORK], tally[i, GRAVITY_WORK] = ledger[BALL_DRIVE] - ball, ledger[GRAVITY] - gravity
        if limits.drifts and limits.drive == 0.0:
            tally[i, FRAME_WORK] = ledger[MOVING_FRAME] - frame
        energy = kinetic(p, s)
        held = held_energy(p, pockets, touch, mode[0])
        if not (going and np.isfinite(energy + tally[i, KINETIC])):
            cause = NOT_FINITE if going else IMPACTS
            return (UNRESOLVED, i + 1, cause) if outcome == UNKNOWN else (outcome, judged, NONE)
        hit = np.sum(hits)
        met = mode[0] > 0 or hit > touches
        touches = hit
        touched = touched or met or tally[i, LAND_HITS] > 0.0
        if outcome == UNKNOWN:
            judged = i + 1
            if energy + held > limits.grown:
                outcome = high_end(tally, judged)
            elif touched and energy + held < limits.still:
                outcome = SETTLES
            elif touched and s[CLOCK] >= p.ramp_time:
                outcome = plain_end(tally, i, look, met, limits, memory)
            if outcome == UNKNOWN and judged == limits.most:
                outcome = end_by_trend(tally, judged, look, limits)
        if outcome != UNKNOWN and (i + 1 >= limits.least or energy + held > limits.grown):
            break
    if not touched:
        return UNRESOLVED, judged, NO_CONTACT
    if outcome == UNRESOLVED:
        return outcome, judged, FALLING
    lively = outcome == SETTLES and mean_energy(tally, max(0, judged - FED), judged, look) > limits.drive
    return outcome, judged, BY_LAND if lively and fed(tally, max(0, judged - FED), judged)[2] > HALF else NONE


@kernel
def drift_rate(tally, end, window):  # type: ignore[no-untyped-def]
    """Logarithmic growth of the mean offset between the last two fifths; 0 where there is no offset.

    Between the halves of the window by which a short run was judged: before it the kick still had its effect.
    """
    n = max(end // FEWEST_LOOKS, min(end, window) // 2)
    if n == 0:
        return 0.0
    last = np.hypot(np.sum(tally[end - n : end, MEAN_X]), np.sum(tally[end - n : end, MEAN_Y]))
    before = np.hypot(
        np.sum(tally[end - 2 * n : end - n, MEAN_X]), np.sum(tally[end - 2 * n : end - n, MEAN_Y])
    )
    return np.log(last / before) / n if last > 0.0 and before > 0.0 else 0.0


@kernel
def growth(tally, end, look, start):  # type: ignore[no-untyped-def]
    """Half the logarithmic rate of the mean energy from half way to the last fifth.

    From the kick's energy, `start`, in a run that ends within five looks.
    """
    n = max(1, end // FEWEST_LOOKS)
    last = mean_energy(tally, end - n, end, look)
    if end < FEWEST_LOOKS:
        before, span = start, end - 0.5 * n
    else:
        first = end // 2 - n // 2
        before, span = mean_energy(tally, first, first + n, look), end - n - first
    least = NOTHING_LEFT * start
    return 0.5 * np.log(max(last, least) / max(before, least)) / (span * look)


@kernel
def imbalance(p, pockets, touch, s, w, mode, ledger, start):  # type: ignore[no-untyped-def]
    """Energy that the ledger does not explain, over the work done and the kick's energy [-]."""
    held = held_energy(p, pockets, touch, mode[0])
    if mode[1] != CLEAR:
        held += land_energy(p, pockets, touch, s, w, mode[0])
    unexplained = kinetic(p, s) + held - start - np.sum(ledger[:WORKS])
    return abs(unexplained) / (ledger[GROSS] + start)


@kernel
def run_one(p, pockets, direction, kick, w, limits, tally, rows, out, hits):  # type: ignore[no-untyped-def]
    """Run from one kick; write outcome and evidence into `out` and the impacts of every pocket into `hits`.

    `kick` is in units of the engine; `tally` is room for the looks.
    """
    balls, look = pockets.shape[1], limits.beats * limits.beat
    s, ledger = np.zeros(STATE), np.zeros(LEDGER)
    touch, mode = np.zeros((2, balls), np.int64), np.zeros(3, np.int64)
    if p.gripped:
        touch[SIDE] = 2
        pockets[PENETRATION] = -pockets[LEAD]
        touch[LIST] = np.arange(balls)
        mode[0] = balls
    s[X], s[VX], s[VY] = p.eccentricity, kick * np.cos(direction), kick * np.sin(direction)
    start = kinetic(p, s)
    outcome, end, cause = watch(
        p, pockets, touch, s, w, mode, ledger, tally, hits, limits, rows, make_room(balls)
    )
    out[LARGEST_OFFSET] = np.sqrt(np.max(tally[:end, OFFSET_MAX]))
    if limits.drifts and outcome == SETTLES:
        outcome = DRIFTS
    out[OUTCOME], out[CAUSE] = outcome, cause
    out[IMBALANCE] = imbalance(p, pockets, touch, s, w, mode, ledger, start)
    out[ROWS] = mode[2]
    if cause == NOT_FINITE:
        out[LARGEST_OFFSET] = 0.0
        return
    out[FOLLOWED] = end * look * p.unit
    out[GROWTH_RATE] = growth(tally, end, look, start) / p.unit
    out[DRIFT_RATE] = drift_rate(tally, end, limits.window) / (look * p.unit)
    force = 1.0 / p.unit**2
    out[FORCE] = np.max(tally[:end, FORCE_MAX]) * force
    out[LAND_FORCE] = np.max(tally[:end, LAND_MAX]) * force
    out[LAND_IMPACTS] = np.sum(tally[:end, LAND_HITS])
    enter_end(p, tally, end, look, limits, out)


@kernel
def enter_end(p, tally, end, look, limits, out):  # type: ignore[no-untyped-def]
    """Write what the motion is in the looks by which it was judged: the last fifth, or the last window."""
    n = max(1, end // FEWEST_LOOKS, min(end, limits.window))
    first, length = end - n, n * look
    last = np.zeros(TALLY)
    for i in range(first, end):
        last += tally[i]
    out[JUDGED] = first * look * p.unit
    out[END_ENERGY] = last[KINETIC] / length / p.unit**2
    whirl = last[TURNING] / last[SPEED_SQUARED] / p.unit if last[SPEED_SQUARED] > 0.0 else 0.0
    out[WHIRL] = abs(whirl) / (2.0 * np.pi)
    out[DIRECTION] = np.sign(whirl)
    out[MEAN_OFFSET] = last[OFFSET] / length
    out[OFFSET_SPREAD] = np.sqrt(max(0.0, last[OFFSET_SQUARED] / length - out[MEAN_OFFSET] ** 2))
    orbit = last[SWEPT] / last[OFFSET_SQUARED] if last[OFFSET_SQUARED] > 0.0 else 0.0
    out[ORBIT_SPEED] = (orbit + p.turning) / p.unit
    for k in range(2):
        out[POCKET_POWER + k] = last[POCKET_WORK + k] / length / p.unit**3
    out[RUBBING_FORCE] = last[PRESSED] / length / p.unit**2
    out[RUBBING_SPEED] = last[RUBBED] / last[PRESSED] / p.unit if last[PRESSED] > 0.0 else 0.0


@kernel
def run_chunk(p, drive, starts, kick, w, limits, rows, out, hits):  # type: ignore[no-untyped-def]
    """Run from every row of `starts`; evidence into `out`, impacts into `hits`.

    A row of `starts`, of length 1 + 3 ball: direction of the kick [rad], then for each pocket its ball's lead
    [m], its half play [m] and its angle [rad].
    """
    balls = hits.shape[1]
    pockets = np.zeros((DRIVE + drive.shape[0], balls))
    pockets[DRIVE:] = drive
    tally = np.zeros((limits.most, TALLY))
    for i in range(starts.shape[0]):
        start = starts[i]
        angle = start[1 + 2 * balls :]
        pockets[COSINE], pockets[SINE], pockets[PENETRATION] = np.cos(angle), np.sin(angle), 0.0
        pockets[LEAD], pockets[PLAY] = start[1 : 1 + balls], start[1 + balls : 1 + 2 * balls]
        run_one(p, pockets, start[0], kick, w, limits, tally, rows, out[i], hits[i])


@lru_cache(maxsize=512)
def random_start(seed: int, run: int, ball_count: int) -> Array:
    """Numbers drawn for a run, shape (4, ball).

    First the direction of the kick [rad] (repeated) and the lead of each ball (share of the scatter, -1 to
    1), then normal deviations of ball diameters and of pocket positions, cut at 3, then displacements of
    pockets with their balls (-1 to 1). They depend on the seed and the number of the run only: the same for
    any cage, kick and number of workers, so they are kept, read-only.
    """
    stream = Generator(Philox(key=np.array([seed, run], dtype=np.uint64)))
    numbers = stream.random(1 + ball_count)
    rows = np.empty((5, ball_count))
    rows[0] = 2.0 * math.pi * numbers[0]
    rows[1] = 2.0 * numbers[1:] - 1.0
    for row in (2, 3):
        rows[row] = _cut_normal(stream, ball_count)
    rows[4] = 2.0 * stream.random(ball_count) - 1.0
    rows.flags.writeable = False
    return rows


def _cut_normal(stream: Generator, count: int) -> Array:
    """Normal deviations, those beyond 3 drawn again."""
    drawn = stream.standard_normal(count)
    while (far := np.abs(drawn) > 3.0).any():
        drawn[far] = stream.standard_normal(int(far.sum()))
    return drawn


def series_of(columns: int) -> Array:
    """Room for the series of a step."""
    return np.zeros((POWERS, columns))
