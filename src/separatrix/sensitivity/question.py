"""What is asked: a model as a function of uncertain inputs.

`evaluate(values)`, with values of shape (sample, input) in SI units, answers for every case, a candidate in
one environment. The model knows nothing of how it is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from separatrix import _check
from separatrix.distribution import Distribution
from separatrix.errors import InputError
from separatrix.units import Array

STABLE = 1
"""Verdict of a sample that is stable; every other number is not."""

Verdicts = NDArray[np.int_]


class Evaluated(Protocol):
    """What a model answers, each of shape (sample, case)."""

    @property
    def margin(self) -> Array:
        """Restitution threshold less the restitution factor [-]."""

    @property
    def threshold(self) -> Array:
        """Restitution threshold [-]."""

    @property
    def verdict(self) -> Verdicts:
        """`STABLE`, or another number."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Input:
    """An uncertain input.

    Attributes
    ----------
    name : str
        Key in the study: ``"film.thickness"``, ``"ranking.Armalon.liquid nitrogen, 440C"``.
    words : str
        As it stands in a sentence: ``"the film's thickness"``.
    unit : str
        SI unit of its values, ``"-"`` for a ratio.
    distribution : Distribution
        What is known of it.
    central : float, optional
        Its value where nothing is uncertain; by default the mean.
    """

    name: str
    words: str
    unit: str
    distribution: Distribution
    central: float | None = None

    def __post_init__(self) -> None:
        _check.settle(_check.printable_text(self, "name"), _check.printable_text(self, "words"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A candidate in an environment: one column of what the model answers.

    Attributes
    ----------
    candidate, environment : str
        Names; the environment is empty over all of them.
    inputs : tuple of int, optional
        Places of the inputs that enter it; None if any may. Inputs that share no case are varied together.
    friction : int, optional
        Place of its pocket friction among the inputs.
    """

    candidate: str
    environment: str
    inputs: tuple[int, ...] | None = None
    friction: int | None = None

    def __post_init__(self) -> None:
        _check.settle(_check.printable_text(self, "candidate"))


Evaluate = Callable[[Array], Evaluated]
Judge = Callable[[Array, Array], Evaluated]


def _as_drawn(values: Array) -> Array:
    return values


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A model, its uncertain inputs (independent of each other), and its cases.

    Attributes
    ----------
    inputs : tuple of Input
        In the order of the columns of values.
    cases : tuple of Case
        In the order of the columns of the answers.
    evaluate : callable
        evaluate(values (sample, input)) -> Evaluated.
    judge : callable, optional
        judge(values (sample, input), restitution_factor (sample, case)) -> Evaluated: the same with the
        restitution factor given. Cheap: the dear part of `evaluate` is not asked again for another friction
        or film. Without it there are no answers to inverse questions. A friction is that in the pocket.
    in_pockets : callable
        in_pockets(values (sample, input)) -> the same with each drawn friction as the pocket of the sample
        sees it: `evaluate` does this, `judge` does not.
    boundary : int, optional
        Place of the input that says which of the boundaries that a finite number of runs allow a sample has:
        nothing that is measured, and the restitution factor does not depend on it.
    """

    inputs: tuple[Input, ...]
    cases: tuple[Case, ...]
    evaluate: Evaluate
    judge: Judge | None = None
    in_pockets: Callable[[Array], Array] = _as_drawn
    boundary: int | None = None

    def __post_init__(self) -> None:
        _check.settle(_something(self, "inputs"), _something(self, "cases"), _places(self))

    def entering(self) -> NDArray[np.bool_]:
        """Whether an input enters a case, shape (input, case)."""
        enters = np.zeros((len(self.inputs), len(self.cases)), bool)
        for c, case in enumerate(self.cases):
            enters[slice(None) if case.inputs is None else list(case.inputs), c] = True
        return enters

    def judged(self) -> Judge:
        """Return `judge`.

        Raises
        ------
        InputError
            There is none.
        """
        if self.judge is None:
            cure = "Give it a judge of restitution factors."
            raise InputError("The model", "cannot be asked for another friction or film", cure=cure)
        return self.judge


def _something(record: object, field: str) -> _check.Problems:
    if not getattr(record, field):
        yield InputError(f"{type(record).__name__}.{field}", "must hold at least one")


def _places(question: Question) -> _check.Problems:
    count = len(question.inputs)
    for case in question.cases:
        given: Sequence[int | None] = (*(case.inputs or ()), case.friction)
        wrong = [i for i in given if i is not None and not 0 <= i < count]
        if wrong:
            where = f"Case {case.candidate}"
            yield InputError(where, f"must name inputs by their places, 0 to {count - 1}", "", str(wrong[0]))
