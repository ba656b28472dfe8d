"""How often two independent ensembles give the same verdict, around the boundary of the shipped study.

    python benchmarks/agreement.py [RESTITUTION_FACTOR ...]

Frictions go in ten equal ratios from 0.7 times the band's lower end to 1.4 times its upper; two seeds, every
kick and run of the study.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

from separatrix.cage import Verdict, judge, run_ensemble
from separatrix.chain import cage_state
from separatrix.stability import cage_at, critical_friction
from separatrix.study_file import read_study

SEEDS = (1, 2)
FACTORS = (0.1, 0.3, 0.5, 0.7, 0.9)
STEPS = 10

study = read_study("cryogenic-turbopump")
cage = cage_state(study).cage
pairs: Counter[tuple[str, str]] = Counter()
for eta in [float(text) for text in sys.argv[1:]] or FACTORS:
    point = critical_friction(cage, eta, study.stability)
    low, high = 0.7 * (point.critical_friction_low or 0.01), 1.4 * (point.critical_friction_high or 1.0)
    for step in range(STEPS):
        rubbing = cage_at(cage, eta, low * (high / low) ** (step / (STEPS - 1)))
        verdicts = (
            judge(
                rubbing, run_ensemble(rubbing, replace(study.stability, seed=seed), growth_only=True, jobs=2)
            )
            for seed in SEEDS
        )
        pairs[tuple(found.verdict.name for found in verdicts)] += 1  # type: ignore[index]

undecided = Verdict.UNDECIDED.name
both = {pair: count for pair, count in pairs.items() if undecided not in pair}
one = sum(count for pair, count in pairs.items() if pair.count(undecided) == 1)
same = sum(count for (a, b), count in both.items() if a == b)
print(f"points {sum(pairs.values())}: {dict(pairs)}")
print(f"both decided {sum(both.values())}, the same verdict {same}; one of two undecided {one}")
