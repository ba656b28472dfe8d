"""What a record checks about itself, as problems to collect and report together."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from enum import Enum
from functools import cache
from itertools import pairwise
from numbers import Real
from typing import TYPE_CHECKING, Concatenate, NamedTuple, ParamSpec, TypeGuard

from separatrix.ground.errors import InputError, together
from separatrix.ground.units import UNITS, format_quantity, parse, shown, unit_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Problems = Iterator[InputError]
Check = Callable[[object, str], Problems]
"""From a record and the name of one of its fields to what is wrong with it."""

Arguments = ParamSpec("Arguments")


def must(
    check: Callable[Concatenate[object, str, Arguments], Problems],
    *args: Arguments.args,
    **kwargs: Arguments.kwargs,
) -> dict[str, Check]:
    """Metadata of a field: the check that it must pass, with the arguments of the check."""

    def checked(record: object, field: str) -> Problems:
        return check(record, field, *args, **kwargs)

    return {"check": checked}


def each_field(record: DataclassInstance) -> Problems:
    """Check each field by its metadata (`must`); a text such as ``"25 g"`` becomes the number in SI first."""
    for name, unit, check, is_optional in _plan(type(record)):
        value = getattr(record, name)
        if value is None and (is_optional or check is not None):
            if not is_optional:
                yield InputError(f"{type(record).__name__}.{name}", "is missing")
            continue
        texts = value if isinstance(value, tuple | list) else (value,)
        if unit and any(isinstance(text, str) for text in texts):
            where = f"{type(record).__name__}.{name}"
            try:
                numbers = tuple(parse(text, unit, where) if isinstance(text, str) else text for text in texts)
            except InputError as error:
                yield error
                continue
            object.__setattr__(record, name, numbers if texts is value else numbers[0])
        if check is not None:
            yield from check(record, name)


@cache
def _plan(record: type[DataclassInstance]) -> tuple[tuple[str, str, Check | None, bool], ...]:
    """Name, unit in which text is read, and check of each field of a record; whether it may be None."""
    units = {f.name: unit_of(record, f.name) for f in fields(record)}
    return tuple(
        (f.name, units[f.name] if units[f.name] in UNITS else "", f.metadata.get("check"), f.default is None)
        for f in fields(record)
    )


def settle(*checks: Iterable[InputError]) -> None:
    """Raise every problem of the checks at once; the first problem of a field hides its others."""
    found: dict[str, InputError] = {}
    for check in checks:
        for problem in check:
            found.setdefault(problem.path, problem)
    if found:
        raise together(list(found.values()))


class Bound(NamedTuple):
    """Numbers that a quantity takes."""

    low: float
    high: float
    open_low: bool = False
    open_high: bool = False
    sign: str = ""
    """``"> 0"`` or ``">= 0"`` of a one-sided bound: it names only the side that is wrong."""

    def rule(self, value: object, unit: str) -> str:
        """Rule that a value breaks; empty if it breaks none."""
        low, high = self.low, self.high
        if not is_number(value) or not math.isfinite(value):
            return f"must be a finite number{f' {self.sign}' if self.sign else ''}"
        is_end = (self.open_low and value == low) or (self.open_high and value == high)
        if low <= value <= high and not is_end:
            return ""
        bottom, top = ("0" if end == 0.0 else format_quantity(end, unit) for end in (low, high))
        if self.sign and (value < 0.0 or (value == 0.0 and self.sign == "> 0")):
            return f"must be {self.sign}"
        if self.sign:
            return f"must be >= {bottom}" if value < low else f"must be <= {top}"
        if self.open_low or self.open_high:
            below, above = ">" if self.open_low else ">=", "<" if self.open_high else "<="
            return f"must be {below} {bottom} and {above} {top}"
        return f"must lie between {bottom} and {top}"


def between(
    record: object,
    field: str,
    low: float,
    high: float,
    *,
    hint: str = "",
    open_low: bool = False,
    open_high: bool = False,
) -> Problems:
    """Refuse what is not a finite number in [low, high], without its open ends. None passes."""
    yield from _within(record, field, Bound(low, high, open_low, open_high), hint)


def positive(record: object, field: str, low: float, high: float, *, hint: str = "") -> Problems:
    """Refuse what is not above zero, or outside [low, high], where nothing real lies. None passes."""
    yield from _within(record, field, Bound(low, high, sign="> 0"), hint)


def not_negative(record: object, field: str, high: float, *, hint: str = "") -> Problems:
    """Refuse what is below zero, or above `high`, where nothing real lies. None passes."""
    yield from _within(record, field, Bound(0.0, high, sign=">= 0"), hint)


def _within(record: object, field: str, bound: Bound, hint: str) -> Problems:
    value = getattr(record, field)
    if value is not None and (rule := bound.rule(value, unit_of(type(record), field))):
        yield problem(record, field, rule, hint)


def whole(record: object, field: str, low: int, high: int, *, hint: str = "") -> Problems:
    """Refuse what is not an integer between `low` and `high`."""
    value = getattr(record, field)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        yield problem(record, field, f"must be a whole number from {low} to {high}", hint)


def one_of(record: object, field: str, options: type[Enum]) -> Problems:
    """Refuse what is not a member of an Enum."""
    value = getattr(record, field)
    if not isinstance(value, options):
        names = ", ".join(f"{options.__name__}.{option.name}" for option in options)
        yield problem(record, field, f"must be one of {names}")


def printable_text(record: object, field: str, longest: int = 200) -> Problems:
    """Refuse what is not printable text of 1 to `longest` characters."""
    value = getattr(record, field)
    if value is None:
        return
    if not isinstance(value, str) or not 0 < len(value) <= longest or not value.isprintable():
        yield problem(record, field, f"must be printable text of 1 to {longest} characters")


def problem(record: object, field: str, rule: str, cure: str = "") -> InputError:
    """Build the refusal of one field: where, rule, value and cure."""
    value = getattr(record, field)
    unit = unit_of(type(record), field)
    text = "" if value is None else shown(value)
    if unit and is_number(value) and math.isfinite(value):
        text = format_quantity(float(value), unit, 8) + (f" ({value:.5g} rad)" if unit == "rad" else "")
    return InputError(f"{type(record).__name__}.{field}", rule, text, cure)


def increasing(
    record: object, field: str, low: float, high: float, *, least: int = 0, most: int, hint: str = ""
) -> Problems:
    """Refuse a tuple that is too short or long, or not strictly inside the limits or increasing."""
    values, where = getattr(record, field), f"{type(record).__name__}.{field}"
    unit = unit_of(type(record), field)
    of_unit = f" [{unit}]" if unit != "-" else ""
    if not least <= len(values) <= most:
        yield InputError(where, f"must have {least} to {most} values", str(len(values)))
    outside = [value for value in values if not is_number(value) or not low < value < high]
    if outside:
        rule = f"must each be a finite number > {low:g} and < {high:g}{of_unit}"
        yield InputError(where, rule, str(outside[0]), hint)
    falls = [f"{b:g} after {a:g}" for a, b in pairwise(values) if not outside and a >= b]
    if falls:
        yield InputError(where, f"must be strictly increasing{of_unit}", falls[0])


def is_number(value: object) -> TypeGuard[float]:
    """True for a real number that is not a bool, nor an integer too long for a float."""
    too_long = isinstance(value, int) and abs(value) >= 10**300
    return isinstance(value, Real) and not isinstance(value, bool) and not too_long
