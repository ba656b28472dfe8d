"""One run from a kick to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.motion import advance, kinetic_energy, record
from separatrix.cage.planar import RunOutcome
from separatrix.cage.slots import (
    DIRECTION,
    DRIFT_RATE,
    FORCE,
    FORCE_MAX,
    GROSS,
    GROWTH,
    IMBALANCE,
    KINETIC,
    LEDGER,
    OFFSET,
    OFFSET_MAX,
    OFFSET_X,
    OFFSET_Y,
    OUTCOME,
    ROWS,
    SOURCES,
    SPEED_SQUARED,
    STATE,
    STEP,
    STORED,
    TALLY,
    TURNING,
    VX,
    VY,
    WHIRL,
    X,
)
from separatrix.compiled import kernel

if TYPE_CHECKING:
    from separatrix.units import Array

FIFTHS = 5
LOOKS = 10  # looks at the energy in each fifth
UNKNOWN = -1
DIES, GROWS, DRIFT = int(RunOutcome.DIES), int(RunOutcome.GROWS), int(RunOutcome.DRIFT)


class Limits(NamedTuple):
    """Where a run is drift, or its end known before its time: an offset [m], and energies [J]."""

    drift: float
    grows_above: float
    dies_below: float
    mean_grows_above: float  # of the mean over a fifth, from the second on
    mean_dies_below: float


def random_start(seed: int, run: int, ball_count: int) -> Array:
    """Direction of the kick [rad] and lead of each ball (share of the scatter, -1 to 1), shape (1 + ball,).

    They depend on the seed and the number of the run only: the same for any cage, kick and number of workers.
    """
    numbers = Generator(Philox(key=np.array([seed, run], dtype=np.uint64))).random(1 + ball_count)
    start = 2.0 * numbers - 1.0
    start[0] = 2.0 * math.pi * numbers[0]
    return start


@kernel
def watch(p, cos, sin, counts, s, lead, ledger, tally, fifth, limits, rows):  # type: ignore[no-untyped-def]
    """Run until the outcome is known or the time is over.

    Returns
    -------
    tuple
        Outcome or `UNKNOWN`, the last window looked at, its length [s], and the rows of history filled.
    """
    place, slack, load = np.zeros(3), -lead, np.zeros(cos.size)
    filled = record(p, cos, sin, s, ledger, place, slack, load, 0.0, rows, 0)
    step = (fifth + LOOKS - 1) // LOOKS
    for window in range(FIFTHS):
        done = 0
        while done < fifth:
            units = min(fifth - done, step)
            filled = advance(
                p,
                cos,
                sin,
                counts,
                s,
                place,
                slack,
                load,
                ledger,
                tally[window],
                units,
                limits.grows_above,
                rows,
                filled,
            )
            done = s[STEP] - window * fifth
            energy = kinetic_energy(p, s) + ledger[STORED]
            if energy > limits.grows_above:
                return GROWS, window, done * p.unit, filled
            if energy < limits.dies_below:
                return DIES, window, done * p.unit, filled
        mean = tally[window, KINETIC] / (fifth * p.unit)
        if window > 0 and mean > limits.mean_grows_above:
            return GROWS, window, fifth * p.unit, filled
        if window > 0 and mean < limits.mean_dies_below:
            return DIES, window, fifth * p.unit, filled
    return UNKNOWN, FIFTHS - 1, fifth * p.unit, filled


@kernel
def drift_rate(tally, length):  # type: ignore[no-untyped-def]
    """Growth rate of the mean offset between the last two fifths [1/s]; 0 where there is no offset."""
    last = np.hypot(tally[FIFTHS - 1, OFFSET_X], tally[FIFTHS - 1, OFFSET_Y])
    before = np.hypot(tally[FIFTHS - 2, OFFSET_X], tally[FIFTHS - 2, OFFSET_Y])
    return np.log(last / before) / length if last > 0.0 and before > 0.0 else 0.0


@kernel
def imbalance(p, s, ledger, start):  # type: ignore[no-untyped-def]
    """Energy that the ledger does not explain, over the work done and the kick's energy [-]."""
    unexplained = kinetic_energy(p, s) + ledger[STORED] - start - np.sum(ledger[:SOURCES])
    return abs(unexplained) / (ledger[GROSS] + start)


@kernel
def run_one(p, cos, sin, counts, direction, kick, lead, fifth, limits, sense, rows, out):  # type: ignore[no-untyped-def]
    """Run from one kick; write outcome and evidence into `out`, shape (evidence,).

    `limits` are `Limits`.
    """
    s, ledger, tally = np.zeros(STATE), np.zeros(LEDGER), np.zeros((FIFTHS, TALLY))
    s[X], s[VX], s[VY] = p.eccentricity, kick * np.cos(direction), kick * np.sin(direction)
    start = kinetic_energy(p, s)
    outcome, window, length, filled = watch(p, cos, sin, counts, s, lead, ledger, tally, fifth, limits, rows)
    end = tally[window]
    out[OFFSET] = np.sqrt(np.max(tally[:, OFFSET_MAX]))
    out[GROWTH] = end[KINETIC] / length / start
    if outcome == UNKNOWN:
        out[DRIFT_RATE] = drift_rate(tally, length)
        outcome = GROWS if out[GROWTH] > 1.0 else (DRIFT if out[OFFSET] > limits.drift else DIES)
    whirl = end[TURNING] / end[SPEED_SQUARED] if end[SPEED_SQUARED] > 0.0 else 0.0
    out[OUTCOME] = outcome
    out[WHIRL] = abs(whirl) / (2.0 * np.pi)
    out[DIRECTION] = np.sign(whirl) * sense
    out[FORCE] = np.max(tally[:, FORCE_MAX])
    out[IMBALANCE] = imbalance(p, s, ledger, start)
    out[ROWS] = filled


@kernel
def run_chunk(p, cos, sin, counts, starts, kick, fifth, limits, sense, rows, out):  # type: ignore[no-untyped-def]
    """Run from every row of `starts`, shape (run, 1 + ball); evidence into `out`, shape (run, evidence)."""
    for i in range(starts.shape[0]):
        lead = starts[i, 1:]
        run_one(p, cos, sin, counts, starts[i, 0], kick, lead, fifth, limits, sense, rows, out[i])
