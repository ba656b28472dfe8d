"""How many outcomes change when a run is followed ten times as long.

    python benchmarks/where_motion_ends.py [--studies 20] [--runs 50] [--first 0]

Random bearings of three classes (tests/properties/sane_studies.py); of each, random frictions from 0.02 to
0.5, kicks from 0.25 to 20 times the pocket speed and run numbers. Each run is made with the default duration,
which it exceeds up to four times (twenty without a land), and with ten times that duration. Some minutes on
two cores.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import warnings
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from separatrix.cage import MovingCage, RunOutcome, moving_cage, run_ensemble
from separatrix.chain.pocket import pocket_speed
from separatrix.chain.solution import solve
from separatrix.study import StabilitySettings
from separatrix.verdict.judgement import wilson_interval

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))
from sane_studies import sane_study

LONGER = 10.0
FRICTIONS = 0.02, 0.5
KICKS = 0.25, 20.0  # over the pocket speed

Pair = tuple[RunOutcome, RunOutcome, float, float]


def pair(cage: MovingCage, settings: StabilitySettings, rng: np.random.Generator) -> Pair:
    """Outcome of one random run, and of the same followed ten times as long; where each ended [s]."""
    friction = float(np.exp(rng.uniform(*np.log(FRICTIONS))))
    kick = pocket_speed(cage.cage_speed, cage.pocket_clearance) * float(np.exp(rng.uniform(*np.log(KICKS))))
    number = int(rng.integers(1_000_000))
    cage = replace(cage, ball_cage_friction=friction)
    found = [
        run_ensemble(cage, one, kicks=(kick,), runs=1, first_run=number)
        for one in (settings, replace(settings, duration=LONGER * settings.duration))
    ]
    outcomes = [RunOutcome(int(each.outcome[0, 0])) for each in found]
    return outcomes[0], outcomes[1], float(found[0].followed[0, 0]), float(found[1].followed[0, 0])


def main() -> None:
    """Count, study by study, and print what changes."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("studies", 20), ("runs", 50), ("first", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    changes: Counter[tuple[str, str]] = Counter()
    total, spent = 0, [0.0, 0.0]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for seed in range(asked.first, asked.first + asked.studies):
            state = solve(sane_study(seed, Path(folder)))
            streams = [np.random.default_rng((29, seed, k)) for k in range(asked.runs)]
            begun = time.perf_counter()
            pairs = list(
                pool.map(lambda rng, s=state: pair(moving_cage(s, 0.1), s.study.stability, rng), streams)
            )
            counts = Counter((short.name, long.name) for short, long, _, _ in pairs)
            changes += counts
            total += len(pairs)
            spent[0] += sum(at for _, _, at, _ in pairs)
            spent[1] += sum(at for _, _, _, at in pairs)
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
    print(f"simulated {spent[0]:.1f} s, ten times as long {spent[1]:.1f} s")


if __name__ == "__main__":
    main()
