"""The chain's model of a study as a question, and the tests that its inputs might get."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.sensitivity.question import Case, Evaluated, Input, Question, Verdicts
from separatrix.sensitivity.words import input_words
from separatrix.study import Friction
from separatrix.uncertainty.model import Case as ModelCase
from separatrix.uncertainty.model import Model
from separatrix.units import Array, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """Answers of some cases of a model."""

    margin: Array
    threshold: Array
    verdict: Verdicts


def question_of(model: Model, *, overall: bool = False) -> Question:
    """What sensitivity asks of the chain: every candidate in each environment where it was measured.

    Parameters
    ----------
    model : Model
        From `uncertain_model`.
    overall : bool
        Ask of each candidate over all its environments, instead of in each of them.
    """
    chosen = [c for c, case in enumerate(model.cases) if (case.environment == "") is overall]
    frictions = {i for case in model.cases for i in case.columns}
    shared = tuple(i for i in range(len(model.inputs)) if i not in frictions)

    def evaluate(values: Array) -> Evaluated:
        return _part(model.evaluate(values), chosen)

    def judge(values: Array, restitution_factor: Array) -> Evaluated:
        every = np.empty((len(values), len(model.cases)))
        by_place = {model.cases[c].place: restitution_factor[:, k] for k, c in enumerate(chosen)}
        for c, case in enumerate(model.cases):
            every[:, c] = by_place[case.place]
        return _part(model.judge(values, every), chosen)

    return Question(
        inputs=_inputs(model),
        cases=tuple(_case(model.cases[c], shared) for c in chosen),
        evaluate=evaluate,
        judge=judge,
    )


def _part(found: Evaluated, chosen: list[int]) -> _Part:
    return _Part(
        margin=found.margin[:, chosen], threshold=found.threshold[:, chosen], verdict=found.verdict[:, chosen]
    )


def _inputs(model: Model) -> tuple[Input, ...]:
    return tuple(
        Input(
            name=one.key,
            words=input_words(one.key),
            unit=one.unit,
            distribution=one.distribution,
            central=one.central,
        )
        for one in model.inputs
    )


def _case(case: ModelCase, shared: tuple[int, ...]) -> Case:
    return Case(
        candidate=case.candidate,
        environment=case.environment,
        inputs=(*shared, *case.columns),
        friction=case.columns[0] if len(case.columns) == case.count == 1 else None,
    )


def reducible_shares(model: Model) -> dict[int, Ratio]:
    """For each friction, the share of its variance that more tests of the material could take away.

    The friction of the next cage scatters as single tests do, and the mean of n tests is not known better
    than that over the root of n: of the variance s^2 (1 + 1/n) the share 1/(n + 1) is lack of knowledge. An
    assumed scatter is that of a single test; a scatter without a count comes with a mean taken as exact.
    """
    found = {}
    places = {one.key: i for i, one in enumerate(model.inputs)}
    for candidate in model.study.ranking.candidates if model.study.ranking else ():
        for environment, friction in candidate.friction.items():
            place = places.get(f"ranking.{candidate.name}.{environment}")
            if place is not None and friction is not None:
                found[place] = _reducible(friction, model.inputs[place].source)
    return found


def _reducible(friction: Friction, source: str) -> Ratio:
    if source == "assumed":
        return 0.5
    return 1.0 / (friction.count + 1) if friction.count else 0.0
