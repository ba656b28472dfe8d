"""`rank`: verdict, margin, rank and reason of each candidate material."""

from __future__ import annotations

from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    reference,
    warn_if_overdamped,
)
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.ranking import rank as rank_materials


def compute(study: Study, runner: Runner) -> answers.RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    solution, cage = reference(study)
    warn_if_overdamped(solution.restitution)
    return made_into(
        lambda found: answers.RankingAnswer(solution=solution, cage=cage, ranking=found),
        lambda: rank_materials(study, runner=runner),
    )
