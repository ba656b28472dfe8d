"""Small models with known answers, to ask for their sensitivity."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from separatrix.distribution import Distribution, Normal, Uniform
from separatrix.sensitivity import Case, Input, Question
from separatrix.sensitivity.question import STABLE


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a model answers, shape (sample, case)."""

    margin: np.ndarray
    threshold: np.ndarray
    verdict: np.ndarray


def answer(margin: np.ndarray, threshold: np.ndarray | None = None) -> Answer:
    """STABLE from a margin of 0 on."""
    return Answer(
        margin=margin,
        threshold=margin if threshold is None else threshold,
        verdict=np.where(margin >= 0.0, STABLE, -1),
    )


def inputs(*known: Distribution, names: Sequence[str] = ()) -> tuple[Input, ...]:
    """Inputs x0, x1, ... or of these names."""
    called = names or [f"x{i}" for i in range(len(known))]
    return tuple(
        Input(name=name, words=f"the {name}", unit="-", distribution=one)
        for name, one in zip(called, known, strict=True)
    )


def question(
    known: Sequence[Distribution], *margins: Callable[[np.ndarray], np.ndarray], cases: Sequence[Case] = ()
) -> Question:
    """One case for each margin, a function of values of shape (sample, input)."""
    named = cases or [Case(candidate=f"c{k}", environment="gas") for k in range(len(margins))]

    def judge(values: np.ndarray, eta: np.ndarray) -> Answer:
        limit = np.column_stack([margin(values) for margin in margins])
        return answer(limit - eta, limit)

    return Question(
        inputs=inputs(*known), cases=tuple(named), evaluate=lambda values: judge(values, 0.0), judge=judge
    )


ISHIGAMI_A, ISHIGAMI_B = 7.0, 0.1


def ishigami(x: np.ndarray) -> np.ndarray:
    """T. Ishigami & T. Homma (1990), ISUMA '90, 398-403: sin x1 + a sin^2 x2 + b x3^4 sin x1."""
    return (1.0 + ISHIGAMI_B * x[:, 2] ** 4) * np.sin(x[:, 0]) + ISHIGAMI_A * np.sin(x[:, 1]) ** 2


ISHIGAMI = question([Uniform(low=-np.pi, high=np.pi)] * 3, ishigami)


def ishigami_indices() -> tuple[np.ndarray, np.ndarray]:
    """First-order and total indices in closed form, with x uniform between -pi and pi."""
    a, b = ISHIGAMI_A, ISHIGAMI_B
    v1 = 0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2
    v2 = a * a / 8.0
    v13 = b * b * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    return np.array([v1, v2, 0.0]) / (v1 + v2 + v13), np.array([v1 + v13, v2, v13]) / (v1 + v2 + v13)


LINEAR = (1.0, -2.0, 0.5)
LINEAR_KNOWN = (
    Normal(mean=1.0, standard_deviation=0.3),
    Normal(mean=-2.0, standard_deviation=0.1),
    Uniform(low=0.0, high=2.0),
)


def linear(x: np.ndarray) -> np.ndarray:
    """Sum of a_i x_i."""
    return x[:, :3] @ np.array(LINEAR)


def linear_shares() -> np.ndarray:
    """Shares a_i^2 s_i^2 / sum."""
    parts = (np.array(LINEAR) * [one.standard_deviation for one in LINEAR_KNOWN]) ** 2
    return parts / parts.sum()


def as_arrays(indices: Sequence[object]) -> tuple[np.ndarray, np.ndarray]:
    """Values, low and high ends of first-order and total indices in the order of the factors' names.

    Each of shape (3, factor).
    """
    rows = sorted(indices, key=lambda one: one.factor)
    return tuple(
        np.array([[getattr(getattr(one, which), end) for one in rows] for end in ("value", "low", "high")])
        for which in ("first", "total")
    )
