"""One run, or a chunk of runs, from a kick to its outcome."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.motion import (
    FORCE_MAX,
    GRAVITY,
    GROSS,
    KINETIC,
    LAND,
    LEDGER,
    MOVING_FRAME,
    OFFSET_MAX,
    OFFSET_X,
    OFFSET_Y,
    POCKET_FRICTION,
    RACE_DAMPERS,
    SPEED_SQUARED,
    SPIN,
    STATE,
    STORED,
    TALLY,
    TURNING,
    UNBALANCE,
    VX,
    VY,
    advance,
)
from separatrix.cage.planar import RunOutcome
from separatrix.cage.pocket import kernel

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage
    from separatrix.units import Array, Joule

FIFTHS = 5
LOOKS = 10  # looks at the energy in each fifth
EVIDENCE = 8
OUTCOME, GROWTH, OFFSET, DRIFT_RATE, WHIRL, DIRECTION, FORCE, IMBALANCE = range(EVIDENCE)
_DIES, _GROWS, _DRIFT = int(RunOutcome.DIES), int(RunOutcome.GROWS), int(RunOutcome.DRIFT)


def random_start(seed: int, run: int, ball_count: int) -> Array:
    """Direction of the kick [rad] and lead of each ball (share of the scatter, -1 to 1), shape (1 + ball,).

    They depend on the seed and the number of the run only: the same for any cage, kick and number of workers.
    """
    numbers = Generator(Philox(key=np.array([seed, run], dtype=np.uint64))).random(1 + ball_count)
    start = 2.0 * numbers - 1.0
    start[0] = 2.0 * math.pi * numbers[0]
    return start


def energy_scale(cage: PlanarCage, kick: float) -> Joule:
    """Energy beside which growth is judged early: the kick's, or of a cage at rest in space as the frame sees it [J]."""
    reach = 2.0 * cage.half_play if math.isinf(cage.land_gap) else cage.land_gap
    return 0.5 * cage.mass * (kick**2 + (cage.cage_speed * reach) ** 2)


@kernel
def run_one(p, cos, sin, counts, direction, kick, lead, fifth, limits, sense, out):  # type: ignore[no-untyped-def]
    """Run from the kick; write the outcome and its evidence into `out`, shape (evidence,).

    `limits`: offset of drift [m], and the energies above which the run is known to grow and below which to die [J].
    """
    state, ledger = np.zeros(STATE), np.zeros(LEDGER)
    tally = np.zeros((FIFTHS, TALLY))
    seat, load = np.zeros(cos.size), np.zeros(cos.size)
    state[VX], state[VY] = kick * np.cos(direction), kick * np.sin(direction)
    start = 0.5 * p.mass * kick * kick
    if p.eccentricity != 0.0:
        state[0] = p.eccentricity
    drift_limit, grows_above, dies_below = limits
    decided = -1
    look = tally[0]
    for window in range(FIFTHS):
        look = tally[window]
        left = fifth
        while left > 0 and decided < 0:
            steps = min(left, (fifth + LOOKS - 1) // LOOKS)
            advance(p, cos, sin, counts, state, seat, lead, load, ledger, look, steps)
            left -= steps
            energy = 0.5 * (p.mass * (state[VX] ** 2 + state[VY] ** 2) + p.inertia * state[SPIN] ** 2)
            energy += ledger[STORED]
            if energy > grows_above:
                decided = _GROWS
            elif energy < dies_below:
                decided = _DIES
        if decided >= 0:
            elapsed = (fifth - left) * p.unit
            break
        elapsed = fifth * p.unit
    largest = 0.0
    force = 0.0
    for window in range(FIFTHS):
        largest = max(largest, tally[window, OFFSET_MAX])
        force = max(force, tally[window, FORCE_MAX])
    largest = np.sqrt(largest)
    energy = 0.5 * (p.mass * (state[VX] ** 2 + state[VY] ** 2) + p.inertia * state[SPIN] ** 2)
    mean = look[KINETIC] / elapsed
    grew = mean / start if start > 0.0 else (0.0 if mean == 0.0 else grows_above)
    if decided < 0:
        decided = _GROWS if mean > start else (_DRIFT if largest > drift_limit else _DIES)
        last = np.hypot(tally[4, OFFSET_X], tally[4, OFFSET_Y])
        before = np.hypot(tally[3, OFFSET_X], tally[3, OFFSET_Y])
        out[DRIFT_RATE] = np.log(last / before) / elapsed if last > 0.0 and before > 0.0 else 0.0
    whirl = look[TURNING] / look[SPEED_SQUARED] if look[SPEED_SQUARED] > 0.0 else 0.0
    work = (
        ledger[POCKET_FRICTION]
        + ledger[RACE_DAMPERS]
        + ledger[LAND]
        + ledger[GRAVITY]
        + ledger[MOVING_FRAME]
        + ledger[UNBALANCE]
    )
    gross = ledger[GROSS] + start
    out[OUTCOME] = decided
    out[GROWTH] = grew
    out[OFFSET] = largest
    out[WHIRL] = abs(whirl) / (2.0 * np.pi)
    out[DIRECTION] = np.sign(whirl) * sense
    out[FORCE] = force
    out[IMBALANCE] = abs(energy + ledger[STORED] - start - work) / gross if gross > 0.0 else 0.0


@kernel
def run_chunk(p, cos, sin, counts, starts, scatter, kick, fifth, limits, sense, out):  # type: ignore[no-untyped-def]
    """Run from every row of `starts`, shape (run, 1 + ball); evidence into `out`, shape (run, evidence)."""
    for i in range(starts.shape[0]):
        lead = starts[i, 1:] * scatter
        run_one(p, cos, sin, counts, starts[i, 0], kick, lead, fifth, limits, sense, out[i])
