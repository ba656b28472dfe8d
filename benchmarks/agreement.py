"""How often two independent ensembles give the same verdict, around the boundary of the shipped study.

    python benchmarks/agreement.py [RESTITUTION_FACTOR ...]

Frictions go in 30 equal ratios from 0.7 times the band's lower end to 1.4 times its upper, so that they stand
densest where verdicts change; every kick and run of the study, followed as for `rank`, two seeds of which
neither placed the band.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

from separatrix.cage import MovingCage, moving_cage
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study
from separatrix.study.study import StabilitySettings
from separatrix.verdict.critical_friction import critical_friction
from separatrix.verdict.judgement import Verdict, judge, wilson_interval
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.response import SEARCHED_FRICTION, cage_at

SEEDS = (101, 102)
FACTORS = (0.05, 0.2, 0.35, 0.5, 0.6, 0.7, 0.8, 0.9)
STEPS = 30

Pairs = Counter[tuple[Verdict, ...]]


def pairs_at(cage: MovingCage, settings: StabilitySettings, eta: float) -> Pairs:
    """Verdicts of both seeds at each friction."""
    point = critical_friction(cage, eta, settings)
    low = 0.7 * (point.critical_friction_low or 0.01)
    high = 1.4 * (point.critical_friction_high or SEARCHED_FRICTION)
    frictions = [low * (high / low) ** (step / (STEPS - 1)) for step in range(STEPS)]
    return Counter(verdicts(cage_at(cage, eta, f), settings) for f in frictions)


def verdicts(cage: MovingCage, settings: StabilitySettings) -> tuple[Verdict, ...]:
    """Verdict of each seed."""
    return tuple(judge(cage, Runner().whole_ensemble(cage, replace(settings, seed=s))).verdict for s in SEEDS)


def report(pairs: Pairs) -> str:
    """Counts, and the share of agreement where both decide."""
    both = {pair: n for pair, n in pairs.items() if Verdict.UNDECIDED not in pair}
    decided, same = sum(both.values()), sum(n for (a, b), n in both.items() if a is b)
    low, high = wilson_interval(same, decided) if decided else (0.0, 1.0)
    one = sum(n for pair, n in pairs.items() if pair.count(Verdict.UNDECIDED) == 1)
    alike = sum(n for (a, b), n in pairs.items() if a is b)
    return (
        f"{sum(pairs.values())} points; both decided {decided}, of them the same {same} "
        f"({100 * low:.1f} to {100 * high:.1f} %); only one undecided {one}; "
        f"the same of three verdicts {alike}"
    )


def main() -> None:
    """Count over all restitution factors."""
    study = read_study("cryogenic-turbopump")
    cage, total = moving_cage(solve(study), 0.1), Counter[tuple[Verdict, ...]]()
    for eta in [float(text) for text in sys.argv[1:]] or FACTORS:
        found = pairs_at(cage, study.stability, eta)
        total += found
        print(f"eta {eta:g}: {report(found)}", flush=True)
    print(report(total))
    for pair, n in sorted(total.items(), key=lambda item: -item[1]):
        print(f"  {' and '.join(verdict.name for verdict in pair)}: {n}")


if __name__ == "__main__":
    main()
