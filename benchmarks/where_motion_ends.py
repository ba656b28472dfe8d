"""How many outcomes change when a run is followed ten times as long, and nothing ends it early.

    python benchmarks/where_motion_ends.py [--studies 20] [--runs 50] [--first 0]

Random bearings of three classes (tests/properties/sane_studies.py), without those that have no land: they
drift. Of each, random frictions from 0.02 to 0.5, kicks from 0.25 to 20 times the pocket speed and run
numbers. Each run is made as a study would, and with ten times the default duration, all of it, so that its
last fifth decides. Ten minutes on a core.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from separatrix.cage import RunOutcome, moving_cage, outcome, rows
from separatrix.cage.ensemble import Piece, Runs, follow, piece_of
from separatrix.cage.moving_cage import turned_forward
from separatrix.cage.numbers import numbers_of
from separatrix.cage.outcome import Cause
from separatrix.cage.rows import of
from separatrix.chain.pocket_friction import pocket_speed
from separatrix.chain.solution import Solution, solve
from separatrix.ground.units import Array
from separatrix.study.study import Guidance
from separatrix.verdict.judgement import wilson_interval

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))
from sane_studies import sane_study

LONGER = 10.0
FRICTIONS = 0.02, 0.5
KICKS = 0.25, 20.0  # over the pocket speed


def random_pieces(state: Solution, runs: int, seed: int) -> list[Piece]:
    """One run each, of random friction, disturbance and number."""
    pieces, cage, settings = [], turned_forward(moving_cage(state, 0.1)), state.study.stability
    for k in range(runs):
        rng = np.random.default_rng((29, seed, k))
        friction = float(np.exp(rng.uniform(*np.log(FRICTIONS))))
        speed = pocket_speed(cage.cage_speed, cage.pocket_clearance)
        kick = speed * float(np.exp(rng.uniform(*np.log(KICKS))))
        number = int(rng.integers(1_000_000))
        pieces.append(piece_of(Runs(replace(cage, ball_cage_friction=friction), settings, number, 1), kick))
    return pieces


def longer(piece: Piece, duration: float) -> Piece:
    """The same run, followed as long as that is, unless it runs away."""
    numbers = numbers_of(piece.cage, piece.kick, duration, whole=True)
    limits = numbers.limits.copy()
    limits[outcome.GROWS] *= 1e4
    return piece._replace(numbers=numbers._replace(limits=limits))


def names(found: dict[str, Array]) -> list[str]:
    """Outcomes; apart those that whirl by their land."""
    by_land = found["cause"] == Cause.LAND_FRICTION
    return [
        RunOutcome(int(one)).name + " BY THE LAND" * bool(land)
        for one, land in zip(found["outcome"], by_land, strict=True)
    ]


def main() -> None:
    """Count, study by study, and print what changes."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("studies", 20), ("runs", 50), ("first", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    asked = parser.parse_args()
    changes: Counter[tuple[str, str]] = Counter()
    total, spent, early = 0, [0.0, 0.0], [0, 0]
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(asked.first, asked.first + asked.studies):
            state = solve(sane_study(seed, Path(folder)))
            if state.study.cage is None or state.study.cage.guidance is Guidance.BALL:
                continue
            pieces, begun = random_pieces(state, asked.runs, seed), time.perf_counter()
            usual, ten = (
                follow(some)
                for some in (pieces, [longer(one, LONGER * state.study.stability.duration) for one in pieces])
            )
            ends = [names(found) for found in (usual, ten)]
            counts = Counter(zip(*ends, strict=True))
            changes += counts
            total += len(pieces)
            for i, found in enumerate((usual, ten)):
                spent[i] += found["followed"].sum()
            for piece, at, before, after in zip(pieces, usual["followed"], *ends, strict=True):
                step = piece.numbers.numbers[of(rows.STEP)] * piece.numbers.kind.steps
                is_early = at < (piece.numbers.limits[outcome.MOST] - 0.5) * step
                early[int(is_early)] += before != after
            words = ", ".join(f"{a} -> {b} {n}" for (a, b), n in sorted(counts.items()) if a != b)
            same = ", ".join(f"{a} {n}" for (a, b), n in sorted(counts.items()) if a == b)
            took = time.perf_counter() - begun
            print(f"{seed:4d} {same}{'; CHANGED ' + words if words else ''} ({took:.1f} s)", flush=True)
    wrong = sum(n for (a, b), n in changes.items() if a != b)
    low, high = wilson_interval(wrong, total)
    print(
        f"{wrong} of {total} outcomes change: {100 * wrong / total:.2f} % "
        f"(95 %: {100 * low:.2f} to {100 * high:.2f})"
    )
    print(f"of runs that ended early {early[1]} change, of those followed to their end {early[0]}")
    print(f"simulated {spent[0]:.1f} s, ten times as long {spent[1]:.1f} s")


if __name__ == "__main__":
    main()
