"""One run from a kick to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.evidence import pocket_energy
from separatrix.cage.motion import advance, kinetic, land_energy, make_room
from separatrix.cage.planar import RunOutcome
from separatrix.cage.series import POWERS
from separatrix.cage.slots import (
    CLEAR,
    COSINE,
    DIRECTION,
    DRIFT_RATE,
    DRIVE,
    FOLLOWED,
    FORCE,
    FORCE_MAX,
    GROSS,
    GROWTH,
    GROWTH_RATE,
    IMBALANCE,
    KINETIC,
    LAND_FORCE,
    LAND_HITS,
    LAND_IMPACTS,
    LAND_MAX,
    LARGEST_OFFSET,
    LEAD,
    LEDGER,
    LIST,
    MEAN_OFFSET,
    MEAN_X,
    MEAN_Y,
    OFFSET,
    OFFSET_MAX,
    OFFSET_SPREAD,
    OFFSET_SQUARED,
    ORBIT_SPEED,
    OUTCOME,
    PENETRATION,
    PLAY,
    ROWS,
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

FIFTHS = 5
LOOKS = 20  # looks at the energy in each fifth
LOOKS_ABOVE, LOOKS_BELOW, LOOKS_EVEN = 3, 10, 12
"""Looks in a row, at the mean energy since the last, that tell how a run ends: beyond limits, or alike."""

LONG_LOOK = 25.0
"""Time between looks from which on they tell: some turns, in radians of the motion with one ball in touch."""

NOTHING_LEFT = 2.0**-104
"""Share of the kick's energy below which speeds are rounding: growth rates count no further."""

EVEN, SURELY, WEAK = 0.15, 1.5, 0.5
"""Share by which looks may differ that are alike; shares of the kick's energy beyond which they tell, where
the last is no nearer to it than the first: a slow growth from little energy does not pass for a whirl."""

UNKNOWN = -1
DIES, GROWS, DRIFT, STALLED = (
    int(RunOutcome.DIES),
    int(RunOutcome.GROWS),
    int(RunOutcome.DRIFT),
    int(RunOutcome.STALLED),
)


class Limits(NamedTuple):
    """Where a run is drift, or its end known before its time: an offset [m], and energies over the mass."""

    drift: float
    grows_above: float
    dies_below: float
    mean_grows_above: float  # of the mean since the last look
    mean_grows_at_once: float  # of the same, at a single look
    mean_dies_below: float


@kernel
def held_energy(p, pockets, touch, count):  # type: ignore[no-untyped-def]
    """Energy in the pockets' springs, over the mass."""
    held = 0.0
    for i in range(count):
        held += pocket_energy(p, pockets[PENETRATION, touch[LIST, i]])
    return held


@kernel
def watch(  # type: ignore[no-untyped-def]
    p, pockets, touch, s, w, mode, ledger, tally, hits, fifth, start, limits, rows, books, room
):
    """Run until the outcome is known or the time is over; `start` is the kick's energy over the mass.

    Returns
    -------
    tuple
        Outcome or `UNKNOWN`, the last window looked at, its length, and whether a steady whirl told it.
    """
    look = fifth / LOOKS
    above = below = even = touches = 0
    level, may_die = -1.0, limits.mean_dies_below > 0.0
    for window in range(FIFTHS):
        for part in range(LOOKS):
            before = tally[window, KINETIC]
            going = advance(
                p,
                pockets,
                touch,
                s,
                w,
                mode,
                ledger,
                tally[window],
                hits,
                look,
                limits.grows_above,
                rows,
                books,
                room,
            )
            if not going:
                return STALLED, window, (part + 1) * look, False
            energy = kinetic(p, s) + held_energy(p, pockets, touch, mode[0])
            if energy > limits.grows_above:
                return GROWS, window, (part + 1) * look, False
            if energy < limits.dies_below:
                return DIES, window, (part + 1) * look, False
            if look < LONG_LOOK:
                continue
            mean = (tally[window, KINETIC] - before) / look
            above = above + 1 if mean > limits.mean_grows_above else 0
            below = below + 1 if mean < limits.mean_dies_below else 0
            met = mode[0] > 0 or np.sum(hits) > touches
            touches = np.sum(hits)
            even = even + 1 if met and abs(mean - level) <= EVEN * level else 1
            if even == 1:
                level = mean
            settled = even >= LOOKS_EVEN and limits.mean_grows_above < np.inf
            if above == LOOKS_ABOVE or mean > limits.mean_grows_at_once:
                return GROWS, window, (part + 1) * look, False
            if settled and mean >= max(level, SURELY * start):
                return GROWS, window, (part + 1) * look, True
            if below == LOOKS_BELOW:
                return DIES, window, (part + 1) * look, False
            if settled and may_die and mean <= min(level, WEAK * start):
                return DIES, window, (part + 1) * look, True
    return UNKNOWN, FIFTHS - 1, fifth, False


@kernel
def drift_rate(tally, length):  # type: ignore[no-untyped-def]
    """Growth rate of the mean offset between the last two fifths; 0 where there is no offset."""
    last = np.hypot(tally[FIFTHS - 1, MEAN_X], tally[FIFTHS - 1, MEAN_Y])
    before = np.hypot(tally[FIFTHS - 2, MEAN_X], tally[FIFTHS - 2, MEAN_Y])
    return np.log(last / before) / length if last > 0.0 and before > 0.0 else 0.0


@kernel
def imbalance(p, pockets, touch, s, w, mode, ledger, start):  # type: ignore[no-untyped-def]
    """Energy that the ledger does not explain, over the work done and the kick's energy [-]."""
    held = held_energy(p, pockets, touch, mode[0])
    if mode[1] != CLEAR:
        held += land_energy(p, pockets, touch, s, w, mode[0])
    unexplained = kinetic(p, s) + held - start - np.sum(ledger[:WORKS])
    return abs(unexplained) / (ledger[GROSS] + start)


@kernel
def run_one(p, pockets, direction, kick, w, fifth, limits, rows, books, out, hits):  # type: ignore[no-untyped-def]
    """Run from one kick; write outcome and evidence into `out` and the impacts of every pocket into `hits`.

    `kick` and `fifth` are in units of the engine.
    """
    balls = pockets.shape[1]
    s, ledger, tally = np.zeros(STATE), np.zeros(LEDGER), np.zeros((FIFTHS, TALLY))
    touch, mode = np.zeros((2, balls), np.int64), np.zeros(3, np.int64)
    if p.gripped:
        touch[SIDE] = 2
        pockets[PENETRATION] = -pockets[LEAD]
        touch[LIST] = np.arange(balls)
        mode[0] = balls
    s[X], s[VX], s[VY] = p.eccentricity, kick * np.cos(direction), kick * np.sin(direction)
    start = kinetic(p, s)
    outcome, window, length, steady = watch(
        p,
        pockets,
        touch,
        s,
        w,
        mode,
        ledger,
        tally,
        hits,
        fifth,
        start,
        limits,
        rows,
        books,
        make_room(balls),
    )
    end = tally[window]
    out[LARGEST_OFFSET] = np.sqrt(np.max(tally[:, OFFSET_MAX]))
    mean = end[KINETIC] / length
    out[GROWTH] = mean / start
    # A steady whirl lasts: its energy is that of the last fifth.
    middle = ((FIFTHS - 0.5) * fifth if steady else window * fifth + 0.5 * length) * p.unit
    out[FOLLOWED] = (window * fifth + length) * p.unit
    out[GROWTH_RATE] = 0.5 * np.log(max(out[GROWTH], NOTHING_LEFT)) / middle
    if outcome == UNKNOWN:
        out[DRIFT_RATE] = drift_rate(tally, length * p.unit)
        outcome = GROWS if out[GROWTH] > 1.0 else (DRIFT if out[LARGEST_OFFSET] > limits.drift else DIES)
    whirl = end[TURNING] / end[SPEED_SQUARED] / p.unit if end[SPEED_SQUARED] > 0.0 else 0.0
    out[OUTCOME] = outcome
    out[WHIRL] = abs(whirl) / (2.0 * np.pi)
    out[DIRECTION] = np.sign(whirl)
    force = 1.0 / p.unit**2
    out[FORCE] = np.max(tally[:, FORCE_MAX]) * force
    out[LAND_FORCE] = np.max(tally[:, LAND_MAX]) * force
    out[IMBALANCE] = imbalance(p, pockets, touch, s, w, mode, ledger, start) if books else 0.0
    out[MEAN_OFFSET] = end[OFFSET] / length
    out[OFFSET_SPREAD] = np.sqrt(max(0.0, end[OFFSET_SQUARED] / length - out[MEAN_OFFSET] ** 2))
    orbit = end[SWEPT] / end[OFFSET_SQUARED] if end[OFFSET_SQUARED] > 0.0 else 0.0
    out[ORBIT_SPEED] = (orbit + p.turning) / p.unit
    out[LAND_IMPACTS] = np.sum(tally[:, LAND_HITS])
    out[ROWS] = mode[2]


@kernel
def run_chunk(p, drive, starts, kick, w, fifth, limits, rows, books, out, hits):  # type: ignore[no-untyped-def]
    """Run from every row of `starts`; evidence into `out`, impacts into `hits`.

    A row of `starts`, of length 1 + 3 ball: direction of the kick [rad], then for each pocket its ball's lead
    [m], its half play [m] and its angle [rad].
    """
    balls = hits.shape[1]
    pockets = np.zeros((DRIVE + drive.shape[0], balls))
    pockets[DRIVE:] = drive
    for i in range(starts.shape[0]):
        start = starts[i]
        angle = start[1 + 2 * balls :]
        pockets[COSINE], pockets[SINE], pockets[PENETRATION] = np.cos(angle), np.sin(angle), 0.0
        pockets[LEAD], pockets[PLAY] = start[1 : 1 + balls], start[1 + balls : 1 + 2 * balls]
        run_one(p, pockets, start[0], kick, w, fifth, limits, rows, books, out[i], hits[i])


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
