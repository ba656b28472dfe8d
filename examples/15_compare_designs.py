"""Compare two designs: the same wheel with a tighter pocket."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("momentum-wheel")
quick = replace(study.stability, kicks=(0.4,), runs=8, duration=0.05)
first = replace(study, stability=quick)
second = replace(first, cage=replace(study.cage, pocket_clearance=0.15e-3))

shares = {}
for name, design in (("0.30 mm", first), ("0.15 mm", second)):
    rows = separatrix.rank(design, jobs=2).ranking.environments[0].materials
    shares[name] = {row.name: row.judgement.probability_stable for row in rows}
    for row in rows:
        print(
            f"pocket clearance {name}: {row.name:<13} margin {row.margin:+.2f}  {row.judgement.verdict.name}"
        )

tight = shares["0.15 mm"]["Vespel SP-3"]
figure, axes = plt.subplots(layout="constrained")
for name, row in shares.items():
    axes.plot(list(row), list(row.values()), "o", label=f"pocket clearance {name}")
axes.set(ylabel="P(stable) [-]", ylim=(-0.05, 1.05))
axes.legend()
