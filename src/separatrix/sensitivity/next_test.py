"""Which test to run next: what measuring one input better is expected to settle.

Pre-posterior analysis. A result of the test that might come out is drawn, the samples are weighted by how
likely each makes that result, and with the weights the probability of STABLE is found again; then the mean
over possible results. The value for choosing a material follows the same road, and for an input known
exactly the regression of Strong, Oakley & Brennan (2014), Medical Decision Making 34, 311-326.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from separatrix.distribution import Distribution, Samples
from separatrix.errors import InputError
from separatrix.sensitivity.design import BLOCKS, Design
from separatrix.sensitivity.likelihood import likelihood
from separatrix.sensitivity.question import Input, Question
from separatrix.sensitivity.records import (
    SETTLED_HIGH,
    SETTLED_LOW,
    CaseGain,
    Measurement,
    NextTest,
    TestGain,
)
from separatrix.sensitivity.scatter import estimate, jackknife
from separatrix.sensitivity.value import best_choices, perfect_choice
from separatrix.units import Array, Ratio

RESULTS = 128
"""Results of a test that are looked at, equally likely."""

ERROR: Ratio = 0.05
"""Standard deviation of what is measured to 10 %, written ``+- 10 %`` in a study."""

TWICE_AS_WELL: Ratio = 0.5
REPEATS = 3
FEWEST_EFFECTIVE = 100
"""Samples that a result must leave some weight on; a test sharper than that is taken as this sharp."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Asked:
    """Samples of all matrices, block by block, and which cases are undecided."""

    question: Question
    design: Design
    entering: NDArray[np.bool_]
    margin: Array
    stable: Array
    undecided: NDArray[np.bool_]
    borderline: NDArray[np.bool_]


def next_test(
    question: Question, design: Design, measurements: Sequence[Measurement] | None = None
) -> NextTest:
    """Tests ranked by how many undecided cases each is expected to settle.

    Parameters
    ----------
    question : Question
        Model and its independent inputs.
    design : Design
        Its samples; the more, the sharper the tests that can be told apart.
    measurements : sequence of Measurement, optional
        Tests that might be made; by default `default_measurements`.

    Raises
    ------
    InputError
        A measurement of an input that there is not.
    """
    tests = default_measurements(question) if measurements is None else tuple(measurements)
    _require_inputs(question, tests)
    asked = _asked(question, design)
    found = [_gain(asked, one, place) for place, one in enumerate(tests)]
    return NextTest(
        undecided=_names(question, asked.undecided),
        borderline=_names(question, asked.borderline),
        cases=len(question.cases),
        environments=len({case.environment for case in question.cases}),
        tests=tuple(sorted(found, key=lambda one: (-one.settled.value, -one.avoided.value))),
        samples=asked.margin.shape[0] * asked.margin.shape[1],
    )


def _names(question: Question, chosen: NDArray[np.bool_]) -> tuple[tuple[str, str], ...]:
    return tuple((question.cases[c].candidate, question.cases[c].environment) for c in np.flatnonzero(chosen))


def default_measurements(
    question: Question, *, reducible: Mapping[int, Ratio] | None = None
) -> tuple[Measurement, ...]:
    """Every input measured to 10 %, or twice as well as it is known if that is better.

    Every friction by three more tests. Single tests scatter as the irreducible part of the friction does, or
    as all of it where all is reducible. What is counted, or set for the runs, is not measured.

    Parameters
    ----------
    question : Question
        Whose inputs.
    reducible : mapping, optional
        By place of the input, see `Measurement`; 1 where nothing is said.
    """
    frictions = {case.friction for case in question.cases}
    shares = reducible or {}
    return tuple(
        _three_tests(i, one.distribution, shares.get(i, 1.0))
        if i in frictions
        else Measurement(input=i, error=_better(one.distribution))
        for i, one in enumerate(question.inputs)
        if _is_measured(one)
    )


def _is_measured(one: Input) -> bool:
    """Whether it is neither counted, as the boundaries that runs allow are, nor a setting of the runs."""
    counted = isinstance(one.distribution, Samples) and one.distribution.is_whole
    return not counted and not one.name.startswith("stability.")


def _better(known: Distribution) -> Ratio:
    """Error of 10 %, or half of what is known if that is less; of a mean of 0 there is no share."""
    if known.mean == 0.0:
        return ERROR
    return min(ERROR, TWICE_AS_WELL * known.standard_deviation / abs(known.mean))


def _three_tests(place: int, known: Distribution, reducible: Ratio) -> Measurement:
    share = 1.0 - reducible if reducible < 1.0 else 1.0
    error = share**0.5 * known.standard_deviation / abs(known.mean)
    return Measurement(input=place, error=error, repeats=REPEATS, reducible=reducible)


def standing(low: Array, high: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which cases are undecided, and which are on the border, by the ends of the interval of P(STABLE)."""
    undecided = (low > SETTLED_LOW) & (high < SETTLED_HIGH)
    settled = (high <= SETTLED_LOW) | (low >= SETTLED_HIGH)
    return undecided, ~undecided & ~settled


def _require_inputs(question: Question, tests: Sequence[Measurement]) -> None:
    for one in tests:
        if one.input >= len(question.inputs):
            rule = f"must be the place of an input, 0 to {len(question.inputs) - 1}"
            raise InputError("Measurement.input", rule, "", str(one.input))


def _asked(question: Question, design: Design) -> _Asked:
    stable = _in_blocks(design.stable.astype(float))
    share, half = jackknife(stable.mean(axis=1) / BLOCKS, np.asarray)
    undecided, borderline = standing(share - half, share + half)
    return _Asked(
        question=question,
        design=design,
        entering=question.entering(),
        margin=_in_blocks(design.margin),
        stable=stable,
        undecided=undecided,
        borderline=borderline,
    )


def _in_blocks(values: Array) -> Array:
    """Shape (block, sample of all matrices, ...) from (matrix, sample, ...)."""
    matrices, samples, *rest = values.shape
    parts = values.reshape(matrices, BLOCKS, samples // BLOCKS, *rest)
    return np.moveaxis(parts, 0, 1).reshape(BLOCKS, -1, *rest)


def _gain(asked: _Asked, test: Measurement, place: int) -> TestGain:
    cases = np.flatnonzero(asked.entering[test.input])
    x = _in_blocks(asked.design.values[:, :, test.input])
    sums = _weighted(asked, test, x, cases, place)
    groups = _environments(asked.question)
    every = len(asked.question.cases)
    open_, firm = asked.undecided[cases], ~(asked.undecided | asked.borderline)[cases]

    def quantities(of: Array) -> Array:
        stable, means = _posteriors(of, cases, every)
        high, low = share_above(stable, SETTLED_HIGH), share_above(1.0 - stable, 1.0 - SETTLED_LOW)
        settled, average = high + low, stable.mean(axis=0)
        avoided = np.minimum(average, 1.0 - average) - np.minimum(stable, 1.0 - stable).mean(axis=0)
        totals = [settled[open_].sum(), (1.0 - settled)[firm].sum(), avoided.sum()]
        return np.array([*totals, best_choices(means, groups), *high, *low])

    value, half = jackknife(sums, quantities)
    known = asked.question.inputs[test.input]
    perfect, perfect_half = perfect_choice(known.distribution, x, asked.margin, cases, groups)
    most = float(len(asked.undecided))
    return TestGain(
        name=known.name,
        words=known.words,
        measurement=test,
        settled=estimate(value[0], half[0], 0.0, float(open_.sum())),
        unsettled=estimate(value[1], half[1], 0.0, most),
        avoided=estimate(value[2], half[2], 0.0),
        choice=estimate(value[3], half[3], 0.0),
        choice_perfect=estimate(perfect, perfect_half, 0.0),
        cases=_case_gains(asked, cases, value[4:].reshape(2, -1)),
    )


def _case_gains(asked: _Asked, cases: NDArray[np.intp], shares: Array) -> tuple[CaseGain, ...]:
    """Undecided cases that the test touches, the most settled first; shares of shape (2, case)."""
    found = [
        CaseGain(
            candidate=asked.question.cases[c].candidate,
            environment=asked.question.cases[c].environment,
            settles=float(high + low),
            settles_stable=float(high),
            settles_unstable=float(low),
        )
        for c, high, low in zip(cases, *shares, strict=True)
        if asked.undecided[c]
    ]
    return tuple(sorted(found, key=lambda one: -one.settles))


def _environments(question: Question) -> list[NDArray[np.intp]]:
    names = [case.environment for case in question.cases]
    return [np.flatnonzero([name == one for one in names]) for name in dict.fromkeys(names)]


def _weighted(asked: _Asked, test: Measurement, x: Array, cases: NDArray[np.intp], place: int) -> Array:
    """Sums over each block, shape (block, number): margins of all cases, then weighted ones of some."""
    told = likelihood(asked.question.inputs[test.input].distribution, test, x.size, FEWEST_EFFECTIVE)
    results = told.results(RESULTS, (asked.design.seed, place))
    found = []
    for one, stable, margin in zip(x, asked.stable, asked.margin, strict=True):
        columns = np.column_stack((np.ones(len(one)), stable[:, cases], margin[:, cases]))
        weighted = told.weights(one, results) @ columns
        found.append(np.concatenate(([len(one)], margin.sum(axis=0), weighted.ravel())))
    return np.array(found)


def _posteriors(sums: Array, cases: NDArray[np.intp], every: int) -> tuple[Array, Array]:
    """Probability of STABLE, shape (result, case touched), and mean margins, shape (result, case)."""
    count, total, weighted = np.split(sums, [1, 1 + every])
    weight, stable, margin = np.split(weighted.reshape(RESULTS, -1), [1, 1 + len(cases)], axis=1)
    means = np.tile(total / count, (RESULTS, 1))
    means[:, cases] = margin / weight
    return stable / weight, means


def share_above(curve: Array, level: Ratio) -> Array:
    """Share of equally likely results above a level, with straight lines between the first axis's."""
    low, high = np.minimum(curve[:-1], curve[1:]), np.maximum(curve[:-1], curve[1:])
    rise = np.where(high > low, high - low, 1.0)
    between = np.where(high > low, np.clip((high - level) / rise, 0.0, 1.0), high >= level)
    ends = np.mean([curve[0] >= level, curve[-1] >= level], axis=0)
    return np.asarray((between.sum(axis=0) + ends) / len(curve))
