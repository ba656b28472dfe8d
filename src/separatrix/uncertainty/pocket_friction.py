"""Frictions of a study as the pockets see them, before they are drawn."""

from __future__ import annotations

from dataclasses import replace

from separatrix.friction_fit import TestedFriction
from separatrix.ranking import ranking_question
from separatrix.ranking.friction import frictions_seen
from separatrix.study import Friction, Study


def as_pockets_see(study: Study) -> Study:
    """Return the study with the frictions of its tests asked for at the conditions of the pockets.

    A friction that is stated without its tests keeps its scatter, that of an unrepeated test if none is
    given: by how much it differs in the pocket nobody knows. What was not tested is said of both.
    """
    asked = ranking_question(study)
    every = [one for candidate in asked.candidates for one in candidate.friction.values()]
    if all(one is None or one.law is None for one in every):
        return study
    seen = ranking_question(frictions_seen(study)).candidates
    candidates = tuple(
        replace(old, friction={name: _seen(one, new.friction[name]) for name, one in old.friction.items()})
        for old, new in zip(asked.candidates, seen, strict=True)
    )
    return replace(study, ranking=replace(asked, candidates=candidates))


def _seen(stated: Friction | None, seen: Friction | None) -> Friction | None:
    """Friction of the tests as the pocket sees it; a stated one as it is, with what was not tested."""
    if stated is None or seen is None or isinstance(stated.law, TestedFriction):
        return seen
    return replace(stated, extrapolation=seen.extrapolation)
