"""What a comparison of two answers consists of."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeGuard

from separatrix.ground.units import Ratio

Plain = float | int | str | bool | None

EXACT, ROUNDED, DIFFERENT = "bit for bit", "to rounding", "different"


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value of a document is a number; true and false are not."""
    return isinstance(value, int | float) and not isinstance(value, bool)


class Noise(StrEnum):
    """A difference compared with the scatter of the runs."""

    BEYOND = "more than counting noise"
    WITHIN = "within counting noise"
    EXACT = "exact"
    UNJUDGED = "no interval"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """Which answer it is; `seed` is None where it does not state one."""

    path: str  # where the answer was read
    title: str  # of its study
    seed: int | None  # null where it does not state one


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """An input that differs: a number with its unit, a text, or a list of them; None where it is absent."""

    key: str  # of the input in the study
    first: object  # null where it is absent
    second: object  # null where it is absent
    unit: str | None  # of the numbers; null for a text


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A result in one answer, with its 95 % interval if it has one; `runs` are those it was counted in."""

    value: Plain  # null where this answer lacks it
    low: float | None = None  # lower end of the 95 % interval
    high: float | None = None  # upper end of the 95 % interval
    runs: int | None = None  # that it was counted in


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A result that differs.

    Attributes
    ----------
    place : str
        Where it is in the answer, for instance "liquid nitrogen, 440C / Armalon".
    name, unit : str
        Its JSON name; unit of its numbers, None if it has none or it is not known.
    first, second : Value
        In both answers.
    change, change_low, change_high, relative : float or None
        Second less first with its 95 % interval, and over the first.
    noise : Noise
        BEYOND if 0 is outside that interval, WITHIN if not; EXACT for what is not counted in runs; UNJUDGED
        for what is, and has no interval; CHANGED for a text, or a number that one of them lacks.
    """

    place: str
    name: str
    unit: str | None
    first: Value
    second: Value
    change: float | None = None
    change_low: float | None = None
    change_high: float | None = None
    relative: Ratio | None = None
    noise: Noise

    @property
    def is_verdict(self) -> bool:
        """Whether it is a verdict, a decision of a map, or the outcome of a run."""
        return names_verdict(self.name)


def names_verdict(name: str) -> bool:
    """Whether a result of this name is a verdict, a decision of a map, or the outcome of a run."""
    return name.endswith("verdict") or name in ("decision", "outcome")


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Two answers of the verb `of`.

    `differences` are the inputs that differ, `verdicts` those of the `shared_verdicts` that changed, `rows`
    the other results that differ: more than noise first, the largest change first. `same_seed`: both draw the
    same runs.
    `unchanged` results are equal, `left_out` rows were too many. `also` are verbs that both have, too.
    `environment` is the bearing's own, where both rank in the same.
    """

    of: str  # verb of both answers
    answers: tuple[Named, Named]  # the first and the second
    same_seed: bool  # whether both draw the same runs
    differences: tuple[Difference, ...]  # inputs that differ
    verdicts: tuple[Row, ...]  # verdicts that changed
    shared_verdicts: int  # number of verdicts that both have
    rows: tuple[Row, ...]  # other results that differ, more than noise first
    unchanged: int  # number of results that are equal
    left_out: int  # number of rows that were too many to list
    also: tuple[str, ...] = ()  # other verbs that both have
    environment: str | None = None  # the bearing's own, where both rank in the same


@dataclass(frozen=True, slots=True, kw_only=True)
class Differing:
    """A key whose value differs: numbers, texts, or what is there on one side only, in short."""

    key: str
    stored: object
    computed: object
    relative: Ratio | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How well two documents agree.

    `agreement` is "bit for bit", "to rounding" or "different". `largest_difference` is the largest relative
    difference of two numbers, at the key `largest_at`; None if no number differs. `differences` are the first
    of the `count` keys that differ beyond rounding.
    """

    agreement: str
    largest_difference: Ratio | None
    largest_at: str | None
    differences: tuple[Differing, ...]
    count: int

    @property
    def same(self) -> bool:
        """Whether they are equal, at least to rounding."""
        return self.agreement != DIFFERENT
