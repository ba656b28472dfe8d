"""Polynomials of uncertain inputs, fitted to samples; their error is that of samples not seen by the fit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import comb

import numpy as np

from separatrix.errors import InputError
from separatrix.units import Array

DEGREES = (1, 2, 3, 4)
LEAST_FOR_A_TERM = 4
"""Samples that a term of a polynomial needs."""


@dataclass(frozen=True, slots=True)
class Basis:
    """Polynomials of standardised inputs up to a total degree; positive inputs perhaps by their logarithm."""

    columns: tuple[int, ...]
    logarithmic: tuple[bool, ...]
    middle: Array
    width: Array
    degree: int

    def of(self, values: Array) -> Array:
        """Terms, shape (sample, term)."""
        x = (_maybe_log(values, self.columns, self.logarithmic) - self.middle) / self.width
        terms: dict[tuple[int, ...], Array] = {(): np.ones(len(x))}
        for degree in range(1, self.degree + 1):
            for places in combinations_with_replacement(range(x.shape[1]), degree):
                terms[places] = terms[places[:-1]] * x[:, places[-1]]
        return np.column_stack(list(terms.values()))

    def fitted(self, values: Array, target: Array) -> Array:
        """Weights of the terms, shape (term, target)."""
        return np.asarray(np.linalg.lstsq(self.of(values), target, rcond=None)[0], dtype=np.float64)


def best_basis(values: Array, columns: Sequence[int], target: Array) -> tuple[Basis, Array]:
    """Basis of the least error in samples it has not seen, and what it says of each of them.

    Parameters
    ----------
    values : ndarray
        Shape (sample, input).
    columns : sequence of int
        Inputs that the target depends on; each varies.
    target : ndarray
        Shape (sample, target).

    Raises
    ------
    InputError
        Too few samples for a straight line.
    """
    found = [(basis, _unseen(basis.of(values), target)) for basis in _bases(values, columns)]
    if not found:
        rule = "must be enough for a straight line in every input"
        raise InputError("samples", rule, "", str(len(values)), "Take more samples.")
    return min(found, key=lambda one: float(np.mean((one[1] - target) ** 2)))


def _bases(values: Array, columns: Sequence[int]) -> Iterator[Basis]:
    positive = tuple(bool((values[:, i] > 0.0).all()) for i in columns)
    for logarithmic in dict.fromkeys(((False,) * len(columns), positive)):
        x = _maybe_log(values, columns, logarithmic)
        for degree in DEGREES:
            if comb(len(columns) + degree, degree) * LEAST_FOR_A_TERM <= len(values):
                yield Basis(tuple(columns), logarithmic, x.mean(axis=0), x.std(axis=0), degree)


def _maybe_log(values: Array, columns: Iterable[int], logarithmic: Iterable[bool]) -> Array:
    found = [
        np.log(values[:, i]) if log else values[:, i] for i, log in zip(columns, logarithmic, strict=True)
    ]
    return np.column_stack(found) if found else np.empty((len(values), 0))


def _unseen(terms: Array, target: Array) -> Array:
    """What a fit to all other samples says of each.

    The residual over one less the leverage: D. M. Allen's prediction sum of squares, Technometrics 16, 1974,
    125-127.
    """
    q = np.linalg.qr(terms)[0]
    leverage = np.minimum(np.sum(q * q, axis=1), 1.0 - 1e-9)
    return np.asarray(target - (target - q @ (q.T @ target)) / (1.0 - leverage)[:, None])
