"""P(stable) of random studies against how long runs may last, and against the step of the engine.

    python benchmarks/shares_stay.py [--studies 20] [--runs 64] [--first 0]

Random bearings of three classes (tests/properties/sane_studies.py), each at three frictions, from three
disturbances. Each column is the share of runs that settle or roll: for half, once, twice and four times
the default duration, and at an eighth of the step; * marks one outside the 95 % interval of the default's.
Some minutes on two cores.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from separatrix.cage import MovingCage, RunOutcome, moving_cage, settings_for
from separatrix.cage.ensemble import Runs, follow, piece_of
from separatrix.cage.moving_cage import turned_forward
from separatrix.cage.numbers import numbers_of
from separatrix.chain.solution import solve
from separatrix.study.study import StabilitySettings
from separatrix.verdict.judgement import wilson_interval

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))
from sane_studies import sane_study

FRICTIONS = 0.05, 0.15, 0.35
CASES = (("1/2", 0.5, 1), ("1", 1.0, 1), ("2", 2.0, 1), ("4", 4.0, 1), ("step/8", 1.0, 8))
"""Head of a column, duration over the default, steps in one of the usual length."""


def settled(cage: MovingCage, settings: StabilitySettings, runs: int, longer: float, refine: int) -> int:
    """Runs that settle or roll, from all disturbances."""
    pieces = []
    for kick in settings_for(settings, cage).kicks:
        numbers = numbers_of(cage, kick, longer * settings.duration, refine=refine)
        pieces.append(piece_of(Runs(cage, settings, 0, runs), kick)._replace(numbers=numbers))
    outcome = follow(pieces)["outcome"]
    return int(np.isin(outcome, (int(RunOutcome.SETTLES), int(RunOutcome.ROLLS))).sum())


def main() -> None:
    """Print a row a study and friction."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("studies", 20), ("runs", 64), ("first", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    asked = parser.parse_args()
    moved, rows = dict.fromkeys((head for head, _, _ in CASES), 0), 0
    print("study friction " + " ".join(f"{head:>8s}" for head, _, _ in CASES))
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(asked.first, asked.first + asked.studies):
            state = solve(sane_study(seed, Path(folder)))
            settings, cage = state.study.stability, turned_forward(moving_cage(state, 0.1))
            whole = 3 * asked.runs
            for friction in FRICTIONS:
                each = replace(cage, ball_cage_friction=friction)
                counts = [settled(each, settings, asked.runs, *how) for _, *how in CASES]
                low, high = wilson_interval(counts[1], whole)
                outside = [not low <= count / whole <= high for count in counts]
                rows += 1
                for (head, _, _), is_out in zip(CASES, outside, strict=True):
                    moved[head] += is_out
                cells = (f"{n / whole:7.3f}{'*' if o else ' '}" for n, o in zip(counts, outside, strict=True))
                print(f"{seed:5d} {friction:8.2f} " + " ".join(cells), flush=True)
    print(f"outside of {rows}: " + ", ".join(f"{head} {n}" for head, n in moved.items()))


if __name__ == "__main__":
    main()
