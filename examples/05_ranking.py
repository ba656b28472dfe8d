"""Ranking one's own compound beside two of the library's materials."""

from dataclasses import replace

from separatrix.ranking import rank
from separatrix.study import Candidate, Friction, RankingQuestion, StabilitySettings
from separatrix.study_file import read_study

study = read_study("cryogenic-turbopump")
environment = "liquid nitrogen, 440C"
known = [c for c in study.ranking.candidates if c.name in ("Armalon", "PEEK 450 GL 30")]
mine = Candidate(
    name="My compound", friction={environment: Friction(mean=0.12, standard_deviation=0.02, count=8)}
)
question = RankingQuestion(
    environments=study.ranking.environments, environment=environment, candidates=(*known, mine)
)
# a small ensemble, for a quick look
quick = StabilitySettings(kicks=(0.5,), runs=12, duration=0.05, restitution_factors=(0.1, 0.3, 0.5, 0.7, 0.9))

found = rank(replace(study, ranking=question, stability=quick), jobs=2)
for row in found.overall:
    print(f"{row.rank}  {row.name}: {row.reason}")

order = [row.name for row in found.overall]
