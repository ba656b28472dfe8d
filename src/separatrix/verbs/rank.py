"""`rank`: verdict, margin, rank and reason of each candidate material."""

from __future__ import annotations

from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    overdamped_notes,
    reference,
)
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.ranking import rank as rank_materials
from separatrix.verdict.ranking_records import NotMeasured, Ranking


def compute(study: Study, runner: Runner) -> answers.RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    solution, cage = reference(study)
    notes = (*solution.notes, *cage.notes, *overdamped_notes(solution.restitution))

    def made(found: Ranking) -> answers.RankingAnswer:
        every = (*notes, *free_balls_decided(found), *found.notes)
        return answers.RankingAnswer(solution=solution, cage=cage, ranking=found, notes=every)

    return made_into(
        made,
        lambda: rank_materials(study, runner=runner),
    )


def free_balls_decided(found: Ranking) -> list[str]:
    """Return for which candidates free balls decided in the bearing's own environment; empty if for none."""
    rows = next(one.materials for one in found.environments if one.name == found.environment)
    judged = ((row.name, row.judgement) for row in rows if not isinstance(row, NotMeasured))
    free = [name for name, one in judged if one is not None and one.ball == "free" and one.ball_reason]
    if not free:
        return []
    return [f"Free balls decided for {', '.join(free)}: with one state the cage would not be called stable."]
