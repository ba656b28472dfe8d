"""Whether two documents of one question are the same: bit for bit, to rounding, or not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from separatrix.comparing.records import is_number
from separatrix.units import Ratio

ROUNDING = 1e-9
"""Relative difference up to which numbers are equal to rounding; a change of an input is far larger."""

MOST_SHOWN = 20
IGNORED = ("separatrix_version", "provenance")
"""Keys of a document that are not the answer."""

EXACT, ROUNDED, DIFFERENT = "bit for bit", "to rounding", "different"


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


def agreement(stored: Mapping[str, object], computed: Mapping[str, object]) -> Agreement:
    """Compare two documents, but for the version and the provenance in them."""
    first, second = ({k: v for k, v in one.items() if k not in IGNORED} for one in (stored, computed))
    found = list(_differing(first, second, "", None))
    beyond = [one for one in found if one.relative is None or one.relative > ROUNDING]
    numbers = [one for one in found if one.relative is not None]
    largest = max(numbers, key=lambda one: one.relative or 0.0, default=None)
    return Agreement(
        agreement=DIFFERENT if beyond else ROUNDED if found else EXACT,
        largest_difference=None if largest is None else largest.relative,
        largest_at=None if largest is None else largest.key,
        differences=tuple(beyond[:MOST_SHOWN]),
        count=len(beyond),
    )


def _differing(a: object, b: object, key: str, scale: float | None) -> Iterator[Differing]:
    """Yield what differs; numbers of a list are compared with the largest of that list."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for name in {**a, **b}:
            at = f"{key}.{name}" if key else str(name)
            if name in a and name in b:
                yield from _differing(a[name], b[name], at, None)
            else:
                yield Differing(
                    key=at, stored=_short(a.get(name)), computed=_short(b.get(name)), relative=None
                )
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        size = max((abs(one) for one in (*a, *b) if is_number(one)), default=None)
        for i, (one, other) in enumerate(zip(a, b, strict=True)):
            yield from _differing(one, other, f"{key}[{i}]", size)
    elif a != b or isinstance(a, bool) != isinstance(b, bool):
        relative = None
        if is_number(a) and is_number(b):
            relative = abs(a - b) / (scale or max(abs(a), abs(b)))
        yield Differing(key=key, stored=_short(a), computed=_short(b), relative=relative)


def _short(value: object) -> object:
    if isinstance(value, Mapping):
        return f"{len(value)} keys"
    return f"{len(value)} values" if isinstance(value, list) else value
