"""P(stable) over uncertain inputs against brute force: fresh ensembles of 64 runs for 60 random cages.

    python benchmarks/brute_force.py

Mass, both clearances, film thickness and axial load of three shipped studies are uncertain. At frictions
about the critical one each study is answered twice: by 512 bearings that run once from each kick, as
`sensitivity` does, and by 20 other bearings that run 64 times each. Printed are both shares of settled runs
from the reference kick, both verdicts over all kicks, and in five bins what the regression behind the drivers
foretells of each of the 60 cages, from its inputs alone, beside what was counted of it (where neither outcome
is rarer than 30 of 512).
"""

from __future__ import annotations

import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.special import expit

from separatrix.cage import Ensemble, RunOutcome, moving_cage
from separatrix.ground.units import Array
from separatrix.study.reading import read_study
from separatrix.study.study import Study
from separatrix.verdict.critical_friction import critical_friction
from separatrix.verdict.drawn_frictions import Case, DrawnBearings, drawn_bearings
from separatrix.verdict.drivers import FEWEST, fitted
from separatrix.verdict.judgement import Verdict, judge, wilson_interval
from separatrix.verdict.long_jobs import Runner, joined

STUDIES = {
    "momentum-wheel": ("3.5 g", "0.3 mm", "0.3 mm", "1 um", "40 N"),
    "lox-turbopump": ("10 g", "0.4 mm", "0.4 mm", "0.5 um", "1500 N"),
    "cryogenic-turbopump": ("25 g", "0.6 mm", "1 mm", "0.5 um", "3000 N"),
}
"""Mass, pocket and land clearance, film thickness, axial load."""

TEXT = """
extends = "{}"
[cage]
mass = "{} +- 10 %"
pocket_clearance = "{} +- 10 %"
land_clearance = "{} +- 10 %"
[film]
thickness = "{} +- 20 %"
[operation]
axial_load = "{} +- 15 %"
"""
FACTORS = (0.6, 0.9, 1.1, 1.6)
"""Frictions, over the critical one of the central bearing."""

BEARINGS, CAGES, RUNS, SEED = 512, 20, 64, 99


def uncertain(name: str) -> Study:
    """Return a shipped study with its inputs uncertain."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "uncertain.toml"
        path.write_text(TEXT.format(name, *STUDIES[name]))
        return read_study(path)


def once_each(drawn: DrawnBearings, case: Case, friction: float) -> Ensemble:
    """Run every bearing once from each kick."""
    runner, places = Runner(), range(len(drawn.runs))
    return drawn.ensemble(
        case, drawn.kicks, places, runner, lambda _, cage: replace(cage, ball_cage_friction=friction)
    )


def often(drawn: DrawnBearings, case: Case, friction: float) -> list[Ensemble]:
    """Run each bearing `RUNS` times from each kick of the central one."""
    found = []
    for states in drawn.solved:
        state = states[case.candidate]
        cage = moving_cage(state, friction)
        settings = replace(state.study.stability, seed=SEED)
        found.append(Runner().ensemble(cage, settings, kicks=drawn.kicks, runs=RUNS))
    return found


def settled(ensemble: Ensemble, kick: int = 1) -> Array:
    """Whether each run from a kick settles, by default from the reference kick, shape (run,)."""
    return np.asarray(ensemble.outcome[kick] == RunOutcome.SETTLES, dtype=np.float64)


def main() -> None:
    """Print a line for each study and friction, then the bins."""
    pairs: Counter[tuple[Verdict, Verdict]] = Counter()
    foretold, counted = [], []
    for name in STUDIES:
        study = uncertain(name)
        drawn = drawn_bearings(study, BEARINGS)
        others = drawn_bearings(replace(study, stability=replace(study.stability, seed=SEED)), CAGES)
        case = next(iter(drawn.friction))
        cage = moving_cage(drawn.central[case.candidate], 0.1)
        critical = critical_friction(cage, None, study.stability, band=False).critical_friction or 0.5
        frictions = [factor * critical for factor in FACTORS]
        with ThreadPoolExecutor(2) as pool:
            asked = list(pool.map(partial(once_each, drawn, case), frictions))
            brute = list(pool.map(partial(often, others, case), frictions))
        for friction, one, many in zip(frictions, asked, brute, strict=True):
            share, each = settled(one), np.array([settled(ensemble).mean() for ensemble in many])
            low, high = wilson_interval(int(share.sum()), share.size)
            error = each.std(ddof=1) / np.sqrt(each.size)
            verdicts = judge(cage, one).verdict, judge(cage, joined(many)).verdict
            pairs[verdicts] += 1
            print(
                f"{name} f {friction:.3f}: {share.mean():.3f} ({low:.3f} to {high:.3f}), brute force "
                f"{each.mean():.3f} +- {1.96 * error:.3f}; {verdicts[0].name}, {verdicts[1].name}",
                flush=True,
            )
            if min(share.sum(), share.size - share.sum()) < FEWEST:
                continue  # `sensitivity` says nothing there either
            b = fitted(drawn.scores, share)
            foretold += expit(b[0] + others.scores @ b[1:]).tolist()
            counted += each.tolist()
    print({f"{a.name}, {b.name}": n for (a, b), n in pairs.items()})
    places = np.digitize(foretold, np.linspace(0.0, 1.0, 6)[1:-1])
    for bin_ in range(5):
        here = places == bin_
        if here.any():
            means = np.array(foretold)[here].mean(), np.array(counted)[here].mean()
            print(f"foretold {means[0]:.3f}, counted {means[1]:.3f}, {here.sum()} cages and frictions")


if __name__ == "__main__":
    main()
