"""Rank a compound of your own beside two materials of the library."""

from dataclasses import replace

import matplotlib.pyplot as plt

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
environment = "liquid nitrogen, 440C"
known = [c for c in study.ranking.candidates if c.name in ("Armalon", "PEEK 450 GL 30")]
measured = separatrix.Friction(mean=0.12, standard_deviation=0.02, count=8)
mine = separatrix.Candidate(name="My compound", friction={environment: measured})
question = separatrix.RankingQuestion(
    environments=study.ranking.environments, environment=environment, candidates=(*known, mine)
)
# a small ensemble, for a quick look
quick = replace(
    study.stability, kicks=(0.5,), runs=12, duration=0.05, restitution_factors=(0.1, 0.3, 0.5, 0.7, 0.9)
)

found = separatrix.rank(replace(study, ranking=question, stability=quick), jobs=2).ranking
rows = next(one for one in found.environments if one.name == environment).materials
for row in rows:
    print(f"{row.rank}  {row.name}: {row.judgement.verdict.name}. {row.reason}")

order = [row.name for row in rows]
thresholds = [row.restitution_threshold for row in rows]
below = [row.restitution_threshold - row.restitution_threshold_low for row in rows]
above = [row.restitution_threshold_high - row.restitution_threshold for row in rows]
figure, axes = plt.subplots(layout="constrained")
axes.errorbar(thresholds, order, xerr=(below, above), fmt="o", label="threshold, 95 %")
axes.axvline(found.restitution_factor, color="black", label="this bearing")
axes.set_xlabel("restitution factor [-]")
axes.invert_yaxis()
axes.legend()
