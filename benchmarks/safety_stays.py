"""Critical friction of random studies against what should not matter: seed, runs, duration, step.

    python benchmarks/safety_stays.py [--studies 20] [--runs 32] [--first 0]

Random bearings of three classes whose cage has a land (tests/properties/sane_studies.py). Each column is the
critical friction over that of the first; * marks one whose difference is outside the 95 % interval that the
numbers of runs of both leave (one in twenty by chance; those with the same starts differ by less). The safety
factor is this over one friction. One core; a
light wheel takes some four minutes.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from unittest import mock

from separatrix.cage import moving_cage, numbers, settings_for
from separatrix.chain.solution import Solution, solve
from separatrix.study.study import Guidance, StabilitySettings
from separatrix.verdict.critical_friction import CageLimit, cage_limit
from separatrix.verdict.long_jobs import Runner

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))
from sane_studies import sane_study

Changed = Callable[[StabilitySettings], StabilitySettings]
CASES: dict[str, Changed] = {
    "as stated": lambda one: one,
    "seed": lambda one: replace(one, seed=one.seed + 1),
    "runs x 2": lambda one: replace(one, runs=2 * one.runs),
    "duration / 2": lambda one: replace(one, duration=0.5 * one.duration),
    "duration x 4": lambda one: replace(one, duration=4.0 * one.duration),
}
REFINED = "step / 4"


def found(solution: Solution, settings: StabilitySettings) -> CageLimit:
    """Critical friction of a cage by the ball that its model asks for."""
    return cage_limit(solution, settings, Runner())


def compared(one: CageLimit, base: CageLimit) -> str:
    """Ratio of two critical frictions, marked where it differs beyond their intervals."""
    value, least = one.own_critical_friction, base.own_critical_friction
    if not value or not least:
        alike = value == least or max(one.own_critical_friction_low, base.own_critical_friction_low) >= 0.5
        return f"{'beyond':>12s}{' ' if alike else '*'}"
    halves = [
        0.5 * math.log((each.own_critical_friction_high or 1.0) / max(each.own_critical_friction_low, 1e-6))
        for each in (one, base)
    ]
    ratio = value / least
    return f"{ratio:12.3f}{' ' if abs(math.log(ratio)) <= math.hypot(*halves) else '*'}"


def line(seed: int, runs: int) -> str:
    """All cases of one study; empty for a cage without a land."""
    with tempfile.TemporaryDirectory() as name:
        study = sane_study(seed, Path(name))
    if study.cage is None or study.ranking is None or study.cage.guidance is Guidance.BALL:
        return ""
    solution = solve(study, study.ranking.candidates[0])
    settings = settings_for(replace(study.stability, runs=runs), moving_cage(solution, 0.0))
    limits = [found(solution, change(settings)) for change in CASES.values()]
    with mock.patch.object(numbers, "step_length", lambda *of: 0.25 * LENGTH(*of)):
        limits.append(found(solution, settings))
    first = limits[0].own_critical_friction
    return f"{seed:5d} {first or math.inf:8.3f} {''.join(compared(one, limits[0]) for one in limits[1:])}"


LENGTH = numbers.step_length


def main() -> None:
    """Print a line for each study, and how many are outside."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--runs", type=int, default=32)
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
    print("study  f_1/2  " + "".join(f"{head:>13s}" for head in [*CASES, REFINED][1:]))
    outside = compared_in_all = 0
    for seed in range(asked.first, asked.first + asked.studies):
        row = line(seed, asked.runs)
        if row:
            print(row, flush=True)
            outside += row.count("*")
            compared_in_all += len(CASES)
    print(f"{outside} of {compared_in_all} outside")


if __name__ == "__main__":
    main()
