"""Compare two designs: the same cage with tighter pockets."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
settings = replace(study.stability, kicks=(0.5,), runs=8, duration=0.02, restitution_factors=(0.3, 0.6, 0.9))
first = replace(study, stability=settings)
second = replace(first, cage=replace(study.cage, pocket_clearance=0.3e-3))

margins = {}
for name, design in (("0.6 mm", first), ("0.3 mm", second)):
    rows = separatrix.rank(design, jobs=2).ranking.overall
    margins[name] = {row.name: row.margin for row in rows}
    for row in rows:
        verdict = row.judgement.verdict.name
        print(f"pocket clearance {name}: {row.name:<15} margin {row.margin:+.2f}  {verdict}")

best = max(margins["0.3 mm"], key=margins["0.3 mm"].get)
figure, axes = plt.subplots(layout="constrained")
for name, row in margins.items():
    axes.plot(list(row.values()), list(row), "o", label=f"pocket clearance {name}")
axes.set_xlabel("margin of the restitution factor [-]")
axes.legend()
