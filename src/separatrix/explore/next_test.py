"""Which input to measure next: how many undecided cases a measurement would settle on average.

A measurement tells of an input what is lack of knowledge, a share of its variance: all of a thickness, but of
the friction of a new cage only how well the mean is known. Its result is not known beforehand, so P(settles)
of each case is predicted for equally likely results by the regression of its runs (`drivers`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.special import expit, ndtri

from separatrix.draws import UncertainInput
from separatrix.explore.records import TestGain
from separatrix.study import Friction, Study
from separatrix.units import Array, Ratio

RESULTS = 64
"""Equally likely results of a measurement."""

NODES = 17
"""Equally likely values of what a measurement leaves open."""

SETTLED: Ratio = 0.95
"""A case is settled where P(settles) is at least this, or at most one less it."""

LEAST_CHANCE: Ratio = 0.01
"""Probability of settling a case below which the case is not listed."""

LEAST_UNKNOWN: Ratio = 0.5
"""Share of a stated friction's variance that tests could take away at least: as after one test."""


def next_tests(
    inputs: Sequence[UncertainInput], known: Mapping[str, Ratio], cases: Mapping[str, tuple[Array, Array]]
) -> tuple[TestGain, ...]:
    """What measuring each input would settle, the best first; those that would settle nothing are left out.

    Parameters
    ----------
    inputs : sequence of UncertainInput
        In the order of the scores.
    known : mapping
        Share of each friction's variance that tests could take away, by its key; of other inputs all.
    cases : mapping
        By the words of an undecided case: coefficients of its regression, shape (1 + input,), and scores of
        its bearings, shape (bearing, input).
    """
    found = []
    for i, one in enumerate(inputs):
        chances = {
            case: _chance(b, scores, i, known.get(one.key, 1.0)) for case, (b, scores) in cases.items()
        }
        likely = {case: chance for case, chance in chances.items() if chance >= LEAST_CHANCE}
        if likely:
            order = sorted(likely, key=lambda case: -likely[case])
            found.append(
                TestGain(
                    name=one.key,
                    settled=float(sum(chances.values())),
                    cases=tuple(order),
                    chances=tuple(likely[case] for case in order),
                )
            )
    return tuple(sorted(found, key=lambda test: -test.settled))


def _chance(b: Array, scores: Array, i: int, known: Ratio) -> Ratio:
    """Probability that the result of measuring input i settles a case."""
    if b[1 + i] == 0.0 or known <= 0.0:
        return 0.0
    rest = b[0] + scores @ b[1:] - scores[:, i] * b[1 + i]
    results = ndtri((np.arange(RESULTS) + 0.5) / RESULTS) * np.sqrt(known)
    left = ndtri((np.arange(NODES) + 0.5) / NODES) * np.sqrt(1.0 - known)
    settles = np.array([expit(rest[:, None] + b[1 + i] * (y + left)).mean() for y in results])
    return float(np.mean((settles >= SETTLED) | (settles <= 1.0 - SETTLED)))


def reducible_shares(study: Study, inputs: Sequence[UncertainInput]) -> dict[str, Ratio]:
    """For each friction, the share of its variance that more tests of the material could take away.

    The friction of a new cage scatters as single tests do, and their mean is known with an error of its own:
    that part is lack of knowledge, 1/(n + 1) after n tests, and so is what the scatter was widened by for
    conditions that were not tested. Where the tests are not known it is what lies beyond the default scatter
    of single tests, and a half at least, as after one test.
    """
    places, ranking = {one.key: one for one in inputs}, study.ranking
    if ranking is None:
        return {}
    return {
        key: _reducible(friction, places[key], ranking.friction_scatter)
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
