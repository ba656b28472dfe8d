"""Samples of a model in matrices A, B and A with columns of B, in independent randomisations.

The rows are Sobol' points of twice as many dimensions as there are inputs, in `BLOCKS` independent
scramblings: within one they spread evenly, between them their scatter is honest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from separatrix.errors import InputError
from separatrix.sensitivity.question import STABLE, Evaluated, Question
from separatrix.sensitivity.records import Factor
from separatrix.units import Array, shown

BLOCKS = 16
"""Independent scramblings that share the samples; intervals come from their scatter."""

LEAST_SAMPLES, MOST_SAMPLES = 128, 2**20
_HALF_STEP = 2.0**-31
"""Half the step of scipy's Sobol' points: keeps them off 0 and 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """What the model said on all matrices.

    Attributes
    ----------
    factors : tuple of Factor
        Inputs varied as one.
    colour : tuple of int
        For each factor, which mixed matrix has its columns of B.
    enters : ndarray
        Whether a factor enters a case, shape (factor, case).
    values : ndarray
        Shape (matrix, sample, input) [SI]: A, B, then the mixed ones.
    margin, stable : ndarray
        Shape (matrix, sample, case) [-].
    """

    factors: tuple[Factor, ...]
    colour: tuple[int, ...]
    enters: NDArray[np.bool_]
    values: Array
    margin: Array
    stable: NDArray[np.bool_]
    seed: int


def sampled_design(
    question: Question, samples: int, *, seed: int = 0, factors: Sequence[Factor] | None = None
) -> Design:
    """Evaluate a model on the matrices of Saltelli et al. (2010).

    Factors that enter no common case are varied in one matrix: n (2 + matrices) evaluations, where n (2 + d)
    would be needed if each of d factors had its own. All pocket frictions together need one.

    Parameters
    ----------
    question : Question
        Its inputs are independent.
    samples : int
        n, a power of two; each of `BLOCKS` scramblings has a share.
    seed : int
        Of the scramblings.
    factors : sequence of Factor, optional
        Groups of inputs; those in none stand alone.

    Raises
    ------
    InputError
        Not a power of two, an input in two groups, or a model that answers in a wrong shape.
    """
    _require_samples(samples)
    found = _all_factors(question, tuple(factors or ()))
    enters = np.array([question.entering()[list(one.inputs)].any(axis=0) for one in found])
    colour = _colours(enters)
    values = _matrices(question, samples, seed, found, colour)
    answers = [evaluated(question, one) for one in values]
    return Design(
        factors=found,
        colour=colour,
        enters=enters,
        values=values,
        margin=np.array([one.margin for one in answers], float),
        stable=np.array([is_stable(one) for one in answers]),
        seed=seed,
    )


def evaluated(question: Question, values: Array) -> Evaluated:
    """Ask the model, and check the shape of its answer.

    Raises
    ------
    InputError
        Wrong shape, or a margin that is no finite number.
    """
    found, wanted = question.evaluate(values), (len(values), len(question.cases))
    for name in ("margin", "threshold", "verdict"):
        shape = np.shape(getattr(found, name))
        if shape != wanted:
            raise InputError(f"The model's {name}", f"must have the shape {wanted}", "", str(shape))
    wrong = int(np.count_nonzero(~np.isfinite(found.margin)))
    if wrong:
        rule = f"must be finite in all {found.margin.size} samples"
        raise InputError("The model's margin", rule, "-", f"{wrong} that are not")
    return found


def is_stable(found: Evaluated) -> NDArray[np.bool_]:
    """Whether each sample of each case is STABLE, shape (sample, case)."""
    stable: NDArray[np.bool_] = np.asarray(found.verdict) == STABLE
    return stable


def central_values(question: Question) -> Array:
    """Central values of all inputs, shape (1, input)."""
    found = [one.distribution.mean if one.central is None else one.central for one in question.inputs]
    return np.array([found], float)


def sampled_values(question: Question, samples: int, *, seed: int = 0) -> Array:
    """Values of shape (sample, input), in blocks of independent scramblings."""
    _require_samples(samples)
    return _scaled(question, _points(len(question.inputs), samples, seed))


def _require_samples(samples: int) -> None:
    fits = isinstance(samples, int) and not isinstance(samples, bool)
    if not fits or not LEAST_SAMPLES <= samples <= MOST_SAMPLES or samples & (samples - 1):
        rule = f"must be a power of two from {LEAST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("samples", rule, "", shown(samples), "Write 4096.")


def _all_factors(question: Question, groups: tuple[Factor, ...]) -> tuple[Factor, ...]:
    taken = [i for group in groups for i in group.inputs]
    for i in taken:
        if not 0 <= i < len(question.inputs):
            where = "A group of inputs"
            raise InputError(where, f"must hold places from 0 to {len(question.inputs) - 1}", "", str(i))
        if taken.count(i) > 1:
            name = question.inputs[i].name
            raise InputError(name, "stands twice in the groups of inputs", cure="Leave it in one.")
    alone = (
        Factor(name=one.name, words=one.words, inputs=(i,))
        for i, one in enumerate(question.inputs)
        if i not in taken
    )
    return (*groups, *alone)


def _colours(enters: NDArray[np.bool_]) -> tuple[int, ...]:
    """For each factor the first matrix whose factors so far enter none of its cases."""
    used: list[NDArray[np.bool_]] = []
    found = []
    for cases in enters:
        place = next((g for g, taken in enumerate(used) if not (taken & cases).any()), len(used))
        if place == len(used):
            used.append(np.zeros_like(cases))
        used[place] = used[place] | cases
        found.append(place)
    return tuple(found)


def _matrices(
    question: Question, samples: int, seed: int, factors: Sequence[Factor], colour: Sequence[int]
) -> Array:
    d = len(question.inputs)
    points = _points(2 * d, samples, seed)
    a, b = _scaled(question, points[:, :d]), _scaled(question, points[:, d:])
    mixed = [a.copy() for _ in range(max(colour) + 1)]
    for factor, g in zip(factors, colour, strict=True):
        mixed[g][:, list(factor.inputs)] = b[:, list(factor.inputs)]
    return np.array([a, b, *mixed])


def _points(dimension: int, samples: int, seed: int) -> Array:
    """Points in the unit cube, shape (sample, dimension), each block a scrambling of its own."""
    from scipy.stats import qmc

    blocks = [
        qmc.Sobol(dimension, scramble=True, rng=np.random.default_rng((seed, block))).random(
            samples // BLOCKS
        )
        for block in range(BLOCKS)
    ]
    return np.concatenate(blocks) + _HALF_STEP


def _scaled(question: Question, points: Array) -> Array:
    columns = [one.distribution.quantile(points[:, i]) for i, one in enumerate(question.inputs)]
    return np.column_stack(columns).astype(float)
