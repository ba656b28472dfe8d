"""What a quantity is called, and its numbers as text: in a column, and alone in a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import floor, inf, isfinite, log10
from typing import NamedTuple

from separatrix.ground.units import format_number, readable

ABSENT = "-"
SPREAD = 2000.0
"""Ratio of the largest number of a column to its least, from which each has its own digits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """How a quantity is written; its unit stands at its value.

    `ends` are the names of the ends of its interval, by default its own with ``_low`` and ``_high``. `form`
    is for numbers of which a reader expects fixed decimals, such as ``"+.2f"``; others have `digits`
    significant ones. `unit` is one that readers expect where the size of a number does not choose it. A
    number at the `top` of what is possible or searched is written as beyond its lower end; one within
    `rounding` of 0 in SI, below what the solver resolves, as 0.
    """

    label: str
    symbol: str = ""
    head: str = ""
    meaning: str = ""
    form: str = ""
    digits: int = 3
    unit: str = ""
    ends: tuple[str, str] | None = None
    top: float = inf
    rounding: float = 0.0

    def seen(self, number: float) -> float:
        """Return the number that is written for this one."""
        return 0.0 if abs(number) < self.rounding else number


class Estimate(NamedTuple):
    """A number with the ends of its 95 % interval; None where it has none.

    Without a value but with a lower end it lies beyond what was searched, and is written "> 1.00".
    """

    value: float | None
    low: float | None = None
    high: float | None = None

    @property
    def is_beyond(self) -> bool:
        """Whether only its lower end is known."""
        return self.value is None and self.low is not None and self.high is None

    @property
    def has_ends(self) -> bool:
        """Whether it has an interval, perhaps without an upper end."""
        return self.low is not None and not self.is_beyond


Number = float | Estimate | None


def middle(value: Number) -> float | None:
    """Return a number without its interval."""
    return value.value if isinstance(value, Estimate) else value


def alone(value: Number, quantity: Quantity, unit: str) -> str:
    """Return a number as it stands in a sentence, in a unit of its size, with its interval."""
    if isinstance(value, Estimate) and value.is_beyond:
        return f"> {alone(value.low, quantity, unit)}"
    number = middle(value)
    if number is None:
        return ABSENT
    number = quantity.seen(number)
    size, symbol = scale([number], unit, quantity.unit)
    text = _one(number / size, quantity)
    if isinstance(value, Estimate) and value.low is not None:
        low, *high = (_one(end / size, quantity, sign=False) for end in value[1:] if end is not None)
        if {low, *high} != {text} or not high:
            text += f" ({low} to {high[0]})" if high else f" (> {low})"
    return f"{text} {symbol}" if symbol else text


def _one(number: float, quantity: Quantity, *, sign: bool = True) -> str:
    if not quantity.form:
        return format_number(number, quantity.digits)
    text = format(number, quantity.form if sign else quantity.form.lstrip("+"))
    return text.lstrip("-+") if float(text) == 0.0 and not text.startswith("+") else text


def in_column(values: Sequence[Number], quantity: Quantity, unit: str) -> tuple[list[str], str, float]:
    """Return the numbers of a column in one unit and with the same decimals, the unit, and its size."""
    known = [quantity.seen(one) for value in values for one in _parts(value)]
    size, symbol = scale(known, unit, quantity.unit)
    form = quantity.form or _form([one / size for one in known], quantity.digits)
    plain = form.lstrip("+")

    def text(number: float | None, form: str) -> str:
        if number is None:
            return ABSENT
        number = quantity.seen(number)
        if not form:
            return format_number(number / size, quantity.digits)
        written = format(number / size, form)
        return written.lstrip("-") if float(written) == 0.0 else written

    found = []
    for value in values:
        one = text(middle(value), form)
        if isinstance(value, Estimate) and value.has_ends and value.value is not None:
            low, high = (text(end, plain) for end in value[1:])
            one += f" (> {low})" if value.high is None else f" ({low} to {high})"
        if isinstance(value, Estimate) and value.is_beyond:
            one = f"> {text(value.low, form)}"
        found.append(one)
    return found, symbol, size


def _parts(value: Number) -> Iterable[float]:
    each = value if isinstance(value, Estimate) else (value,)
    return [one for one in each if one is not None]


def _form(numbers: Sequence[float], digits: int) -> str:
    """Return a form with as many decimals as the largest number needs; none where numbers differ much."""
    sizes = [abs(one) for one in numbers if one != 0.0 and isfinite(one)]
    if not sizes or max(sizes) > SPREAD * min(sizes):
        return ""
    decimals = digits - 1 - floor(log10(max(sizes)))
    return f".{min(max(decimals, 0), 9)}f" if max(sizes) < 10.0**6 else ""


def scale(numbers: Sequence[float], unit: str, wanted: str = "") -> tuple[float, str]:
    """Return the unit that suits the largest of some numbers, as its size in SI and its symbol."""
    if unit in ("", "-"):
        return (0.01, "%") if wanted == "%" else (1.0, "")
    largest = max((abs(one) for one in numbers if isfinite(one)), default=0.0)
    size, symbol = readable(largest, unit, wanted)
    return size, symbol.replace("u", "\N{MICRO SIGN}", 1) if symbol.startswith("u") else symbol
