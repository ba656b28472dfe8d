"""Sobol indices of margin and verdict, first-order and total, with intervals.

First-order by Saltelli et al. (2010), Computer Physics Communications 181, 259-270, table 2 (b); total by
Jansen (1999), Computer Physics Communications 117, 35-43, table 2 (f) of the former.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from separatrix.sensitivity.design import BLOCKS, Design, sampled_design
from separatrix.sensitivity.question import Question
from separatrix.sensitivity.records import CaseSobol, Estimate, Factor, SobolAnswer, SobolIndex
from separatrix.sensitivity.scatter import by_block, estimate, jackknife
from separatrix.units import Array

ALWAYS = "every sample is stable"
NEVER = "no sample is stable"
FEWEST = 30
"""Samples of the rarer verdict without which its indices are not told."""

CONSTANT = "the margin is the same in every sample"


def sobol_indices(
    question: Question, samples: int = 1024, *, seed: int = 0, factors: Sequence[Factor] | None = None
) -> SobolAnswer:
    """Sobol indices of each case's margin and verdict.

    Parameters
    ----------
    question : Question
        Model and its independent inputs.
    samples : int
        n, a power of two. Evaluations: n (2 + matrices), see `sampled_design`.
    seed : int
        Of the quasi-random points.
    factors : sequence of Factor, optional
        Groups of inputs that are varied as one; the others stand alone.

    Raises
    ------
    InputError
        See `sampled_design`.
    """
    return indices_of(question, sampled_design(question, samples, seed=seed, factors=factors))


def indices_of(question: Question, design: Design) -> SobolAnswer:
    """Sobol indices from samples that are there already."""
    return SobolAnswer(
        cases=tuple(_case(question, design, c) for c in range(len(question.cases))),
        samples=design.values.shape[1],
        evaluations=design.values.shape[0] * design.values.shape[1],
        blocks=BLOCKS,
        seed=design.seed,
    )


def _case(question: Question, design: Design, c: int) -> CaseSobol:
    margin, stable = design.margin[:, :, c], design.stable[:, :, c].astype(float)
    first_two = margin[:2]
    lone = float(np.ptp(first_two)) == 0.0
    rare = _too_few(stable[:2])
    return CaseSobol(
        candidate=question.cases[c].candidate,
        environment=question.cases[c].environment,
        probability_stable=_mean(stable, 0.0, 1.0),
        margin_mean=_mean(margin),
        margin_deviation=float(np.std(first_two)),
        margin=() if lone else _indices(design, c, margin),
        verdict=() if rare else _indices(design, c, stable),
        margin_reason=CONSTANT if lone else "",
        verdict_reason=rare,
    )


def _too_few(stable: Array) -> str:
    """Why the verdict's doubt cannot be shared out; empty if it can."""
    count = round(float(stable.sum()))
    if count in (0, stable.size):
        return ALWAYS if count else NEVER
    if min(count, stable.size - count) >= FEWEST:
        return ""
    few, kind = (count, "") if count < FEWEST else (stable.size - count, "not ")
    return f"only {few} of {stable.size} samples {'is' if few == 1 else 'are'} {kind}stable"


def _mean(values: Array, low: float = -np.inf, high: float = np.inf) -> Estimate:
    """Mean over A and B."""
    sums = by_block(values[0] + values[1], BLOCKS)
    value, half = jackknife(np.column_stack((sums, np.full(BLOCKS, 2.0 * values.shape[1] / BLOCKS))), _ratio)
    return estimate(float(value), float(half), low, high)


def _ratio(sums: Array) -> Array:
    return np.asarray(sums[0] / sums[1])


def _indices(design: Design, c: int, values: Array) -> tuple[SobolIndex, ...]:
    """Indices of one quantity of one case from its values, shape (matrix, sample), largest total first."""
    entering = [i for i in range(len(design.factors)) if design.enters[i, c]]
    mixed = values[[2 + design.colour[i] for i in entering]]
    value, half = jackknife(_moments(values[0], values[1], mixed), _first_and_total)
    found = [
        SobolIndex(
            factor=design.factors[i].name,
            words=design.factors[i].words,
            first=estimate(value[0, k], half[0, k], 0.0, 1.0),
            total=estimate(value[1, k], half[1, k], 0.0, 1.0),
        )
        for k, i in enumerate(entering)
    ]
    return tuple(sorted(found, key=lambda one: -one.total.value))


def _moments(a: Array, b: Array, mixed: Array) -> Array:
    """Sums that the estimators need, shape (block, 3 + 2 factors).

    The mean is taken off first: the estimators do not depend on it, but their scatter does.
    """
    middle = 0.5 * (a.mean() + b.mean())
    a, b, mixed = a - middle, b - middle, mixed - middle
    rows = np.vstack(
        [
            np.ones_like(a),
            0.5 * (a + b),
            0.5 * (a * a + b * b),
            b * (mixed - a),
            0.5 * (mixed - a) ** 2,
        ]
    )
    return by_block(rows.T, BLOCKS)


def _first_and_total(sums: Array) -> Array:
    """First-order and total indices, shape (2, factor); 0 if nothing is left that varies."""
    count, mean, square = sums[:3]
    variance = square / count - (mean / count) ** 2
    if variance <= 0.0:
        return np.zeros((2, (len(sums) - 3) // 2))
    return np.asarray(sums[3:].reshape(2, -1) / count / variance)
