"""The chain's model of a study as a question, and the tests that its inputs might get."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from separatrix.distribution import Samples
from separatrix.draws import UncertainInput, sample
from separatrix.sensitivity.fit import FitError, fitted_question
from separatrix.sensitivity.question import Case, Evaluated, Input, Question, Verdicts
from separatrix.sensitivity.words import case_name, input_words
from separatrix.study import Candidate, Friction
from separatrix.uncertainty.model import Case as ModelCase
from separatrix.uncertainty.model import Model
from separatrix.uncertainty.polynomial import LEAST_FOR_A_TERM
from separatrix.units import Array, Ratio

BOUNDARY = "boundary"
"""Name of the input that says which of the boundaries that the runs allow a sample has."""

BOUNDARIES = 64
"""As many as behind the probabilities of the verb."""

AS_THE_RUNS_SAY = -1.0
"""Its central value: the boundary that the runs say, none of those that they allow."""

LEAST_UNKNOWN: Ratio = 0.5
"""Of the variance of a friction whose tests are not told, the share that tests could take away at least."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """Answers of some cases of a model."""

    margin: Array
    threshold: Array
    verdict: Verdicts


def question_of(model: Model) -> Question:
    """What sensitivity asks of the chain: every candidate in each environment where it was measured.

    What the finite number of runs leaves open of the boundary is one more input, the last.

    Parameters
    ----------
    model : Model
        From `uncertain_model`.
    """
    chosen = _asked(model)
    frictions = {i for case in model.cases for i in case.columns}
    count = len(model.inputs)
    shared = (*(i for i in range(count) if i not in frictions), count)

    def evaluate(values: Array) -> Evaluated:
        factors = model.factors(values[:, :count]).restitution_factor
        return judge(in_pockets(values), factors[:, [model.cases[c].place for c in chosen]])

    def in_pockets(values: Array) -> Array:
        return np.column_stack((model.in_pockets(values[:, :count]), values[:, count:]))

    def judge(values: Array, restitution_factor: Array) -> Evaluated:
        every = np.empty((len(values), len(model.cases)))
        by_place = {model.cases[c].place: restitution_factor[:, k] for k, c in enumerate(chosen)}
        for c, case in enumerate(model.cases):
            every[:, c] = by_place[case.place]
        draws = values[:, count].astype(int)
        known = None if (draws == AS_THE_RUNS_SAY).all() else draws
        return _part(model.judge(values[:, :count], every, known), chosen)

    return Question(
        inputs=(*_inputs(model), _boundary(model)),
        cases=tuple(_case(model.cases[c], shared) for c in chosen),
        evaluate=evaluate,
        judge=judge,
        in_pockets=in_pockets,
        boundary=count,
    )


def _asked(model: Model) -> list[int]:
    """Cases that are asked about: those of one environment."""
    return [c for c, case in enumerate(model.cases) if case.environment]


def _part(found: Evaluated, chosen: list[int]) -> _Part:
    return _Part(
        margin=found.margin[:, chosen], threshold=found.threshold[:, chosen], verdict=found.verdict[:, chosen]
    )


def fitted_to(model: Model, values: Array, factors: Array) -> tuple[Question, FitError | None]:
    """Return the question with its chain fitted to samples; as it is where the chain does not vary.

    Parameters
    ----------
    model : Model
        From `uncertain_model`.
    values : ndarray
        Samples that the chain solved, shape (sample, input) [SI]; more are drawn where a fit needs more.
    factors : ndarray
        Their restitution factors, shape (sample, case of the model) [-].
    """
    question, places = question_of(model), [case.place for case in model.cases]
    if not model.chain_varies:
        return question, None
    fewest = LEAST_FOR_A_TERM * len(question.inputs)
    if len(values) < fewest:
        values = sample(model.study, 2 * fewest).values
        found = model.factors(values)
        values, factors = values[found.solved], found.restitution_factor[found.solved][:, places]
    known = np.column_stack((values, np.full(len(values), AS_THE_RUNS_SAY)))
    answers = question.judged()(question.in_pockets(known), factors[:, _asked(model)])
    return fitted_question(question, known, answers)


def _boundary(model: Model) -> Input:
    runs = sum(kind.runs for kind in model.kinds)
    return Input(
        name=BOUNDARY,
        words=f"the boundary itself, known from {runs} runs",
        unit="-",
        distribution=Samples(values=tuple(range(BOUNDARIES))),
        central=AS_THE_RUNS_SAY,
    )


def _inputs(model: Model) -> tuple[Input, ...]:
    words = _words(model.study.ranking.candidates if model.study.ranking else ())
    return tuple(
        Input(
            name=one.key,
            words=words.get(one.key) or input_words(one.key),
            unit=one.unit,
            distribution=one.distribution,
            central=one.central,
        )
        for one in model.inputs
    )


def _words(candidates: Sequence[Candidate]) -> dict[str, str]:
    """Words for the frictions of candidates; their names may hold anything, a dot, say."""
    return {
        f"ranking.{one.name}.{environment}": f"the pocket friction of {case_name(one.name, environment)}"
        for one in candidates
        for environment in one.friction
    }


def _case(case: ModelCase, shared: tuple[int, ...]) -> Case:
    return Case(
        candidate=case.candidate,
        environment=case.environment,
        inputs=(*shared, *case.columns),
        friction=case.columns[0] if len(case.columns) == case.count == 1 else None,
    )


def reducible_shares(model: Model) -> dict[int, Ratio]:
    """For each friction, the share of its variance that more tests of the material could take away.

    The friction of the next cage scatters as single tests do, and their mean is known with an error of its
    own: that part, e^2 of s^2 + e^2, is lack of knowledge, 1/(n + 1) after n tests. So is what s holds for
    conditions that were not tested: a test under those of the pocket takes it away. A scatter without a count
    comes with a mean taken as exact. Where the tests are not told it is what lies beyond the default scatter
    of single tests, and a half at least, as after one test.
    """
    places, ranking = {one.key: i for i, one in enumerate(model.inputs)}, model.study.ranking
    if ranking is None:
        return {}
    return {
        places[key]: _reducible(friction, model.inputs[places[key]], ranking.friction_scatter)
        for one in ranking.candidates
        for environment, friction in one.friction.items()
        if friction is not None and (key := f"ranking.{one.name}.{environment}") in places
    }


def _reducible(friction: Friction, known: UncertainInput, scatter: Ratio) -> Ratio:
    deviation, error = friction.standard_deviation, friction.standard_error
    if known.source == "study" or deviation is None:
        single = scatter * known.distribution.mean
        return max(LEAST_UNKNOWN, 1.0 - (single / known.distribution.standard_deviation) ** 2)
    if error is None:
        return 1.0 / (friction.count + 1) if friction.count else 0.0
    return (error**2 + friction.widening**2) / (error**2 + deviation**2)
