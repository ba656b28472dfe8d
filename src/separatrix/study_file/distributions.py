"""Distributions as a study file writes them, wherever it holds a number (docs/uncertainty.md)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from separatrix.distribution import (
    COVERAGE,
    MOST_SAMPLES,
    Distribution,
    LogUniform,
    Normal,
    Samples,
    Uniform,
)
from separatrix.errors import InputError
from separatrix.toml_values import Reader, nearest, ratio, whole
from separatrix.units import parse, printable, shown

Made = TypeVar("Made", bound=Distribution)

_SIGN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_PLAIN = re.compile(_NUMBER)
_PERCENT = re.compile(rf"({_NUMBER}) ?%")
_BRACKETS = re.compile(r"\(([^()]*)\) ?([^()]+)")
_FORMS = "between, or mean with standard_deviation, or samples"
_CERTAIN = "This key takes one certain value."


@dataclass(frozen=True, slots=True)
class Uncertain:
    """A value whose numbers are uncertain: the value with the means, and the distributions by their names."""

    value: Any
    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    """Under ``""`` that of the value itself, under the name of a property that of the property."""


def number(reader: Reader, unit: str) -> Reader:
    """Read a number, or what is known of an uncertain one, as `Uncertain`."""

    def read(value: Any, where: str) -> Any:
        found = distribution(value, where, reader, unit)
        return reader(value, where) if found is None else Uncertain(found.mean, {"": found})

    return read


def count(value: Any, where: str) -> Any:
    """Read a whole number, or a list of those that it may be, as `Uncertain`."""
    if _is_spread(value) or (isinstance(value, dict) and set(value) != {"samples"}):
        rule = "must be a whole number, or a list of whole numbers that are equally likely"
        raise InputError(where, rule, shown(value), "Write it like [12, 13].")
    items = value["samples"] if isinstance(value, dict) else value
    if not isinstance(items, list):
        return whole(value, where)
    found = _samples(items, where, whole, written(value))
    return Uncertain(int(found.mean), {"": found})


def certain(reader: Reader) -> Reader:
    """Read with `reader`; a distribution is refused as one."""

    def read(value: Any, where: str) -> Any:
        if _is_spread(value):
            raise InputError(where, "takes no distribution", shown(value), _CERTAIN)
        if isinstance(value, dict) and {"between", "standard_deviation", "samples"} & set(value):
            raise InputError(where, "takes no distribution", written(value), _CERTAIN)
        return reader(value, where)

    return read


def distribution(value: Any, where: str, reader: Reader, unit: str) -> Distribution | None:
    """Read a distribution of a number that `reader` reads; None if the value is no distribution."""
    if isinstance(value, list):
        return _samples(value, where, reader, written(value))
    if isinstance(value, dict):
        return _table(value, where, reader, unit)
    return _plus_minus(value, where, reader, unit) if _is_spread(value) else None


def written(value: Any) -> str:
    """The value as the file has it, on one short line."""
    if isinstance(value, dict):
        inside = ", ".join(f"{printable(str(key))} = {written(item)}" for key, item in value.items())
        return f"{{ {inside} }}"
    if isinstance(value, list):
        few = [written(item) for item in (value if len(value) <= 6 else value[:3])]
        return f"[{', '.join(few)}{f', ... {len(value)} of them' if len(value) > 6 else ''}]"
    return shown(value)


def friction_deviation(value: Mapping[str, Any], where: str) -> Any:
    """Standard deviation of a friction: a number, or percent of the mean."""
    width, mean = value.get("standard_deviation"), value.get("mean")
    if not isinstance(width, str) or "%" not in width:
        return width
    return _width(width, ratio(mean, f"{where}.mean"), str(mean), f"{where}.standard_deviation", "-")


def unwrapped(value: Any) -> tuple[Any, Mapping[str, Distribution]]:
    """The value with its means, and the distributions in it."""
    return (value.value, value.distributions) if isinstance(value, Uncertain) else (value, {})


def gathered(given: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Distribution]]:
    """Values of a table with their means, and the distributions in them by dotted names."""
    values: dict[str, Any] = {}
    found: dict[str, Distribution] = {}
    for key, item in given.items():
        values[key], inside = unwrapped(item)
        found |= {f"{key}.{name}".removesuffix("."): one for name, one in inside.items()}
    return values, found


def _is_spread(value: Any) -> bool:
    return isinstance(value, str) and _SIGN.search(value) is not None


def _plus_minus(text: str, where: str, reader: Reader, unit: str) -> Distribution:
    """Read ``"0.5 um +- 20 %"``: a mean and its expanded uncertainty, `COVERAGE` standard deviations."""
    parts = _sides(text.strip())
    if len(text) > 120 or len(parts) != 2 or not all(parts):
        rule = "must be one value, +- and one expanded uncertainty"
        raise InputError(where, rule, shown(text), f'Write it like "{_example(unit)} +- 20 %".')
    if unit != "-" and _PLAIN.fullmatch(parts[0]):
        cure = f'Write it like "{_example(unit)} +- 20 %", with a unit on either side of +-.'
        raise InputError(where, "needs a unit before +- too", shown(text), cure)
    mean = _written_number(parts[0], where, reader, unit)
    half = _width(parts[1], mean, parts[0], f"{where}, after +-,", unit)
    return _made(Normal, where, mean=mean, standard_deviation=half / COVERAGE, text=shown(text))


def _sides(text: str) -> list[str]:
    """What stands on either side of the sign; ``"(0.5 +- 0.1) um"`` has one unit for both (GUM, 7.2.4)."""
    shared = _BRACKETS.fullmatch(text)
    if shared is None:
        return _SIGN.split(text)
    return [f"{part} {shared.group(2)}" for part in _SIGN.split(shared.group(1).strip())]


def _table(value: dict[str, Any], where: str, reader: Reader, unit: str) -> Distribution:
    """Read a table with bounds, with mean and standard deviation, or with samples."""
    known = {"between": _between, "mean": _moments, "standard_deviation": _moments, "samples": _sampled}
    for key in value:
        if key not in (*known, "log"):
            at = f"{where}.{printable(key) or chr(34) * 2}"
            raise InputError(at, f"is no key of a distribution: {_FORMS}", cure=nearest(key, (*known, "log")))
    forms = {known[key] for key in value if key in known}
    if len(forms) != 1:
        rule = f"must have {_FORMS}" if not forms else f"must have only one of {_FORMS}"
        raise InputError(where, rule, written(value))
    if "log" in value and "between" not in value:
        raise InputError(f"{where}.log", "has a meaning only with between")
    return forms.pop()(value, where, reader, unit)


def _between(value: dict[str, Any], where: str, reader: Reader, unit: str) -> Distribution:
    del unit
    bounds, log = value["between"], value.get("log", False)
    if not isinstance(log, bool):
        raise InputError(f"{where}.log", "must be true or false", shown(log))
    if not isinstance(bounds, list) or len(bounds) != 2:
        got = f"a list of {len(bounds)}" if isinstance(bounds, list) else shown(bounds)
        raise InputError(f"{where}.between", "must be a list of two bounds", got)
    low, high = (reader(bound, f"{where}.between, item {i},") for i, bound in enumerate(bounds, 1))
    if not low < high:
        got = f"{written(bounds[0])} and {written(bounds[1])}"
        cure = "Write the value alone if it is certain." if low == high else "Write the lower one first."
        raise InputError(f"{where}.between", "must rise", got, cure)
    if log and low <= 0.0:
        cure = "A logarithm needs positive numbers: raise the lower bound, or leave log out."
        raise InputError(f"{where}.between", "must be > 0 with log = true", shown(bounds[0]), cure)
    return _made(LogUniform if log else Uniform, f"{where}.between", low=low, high=high, text=written(value))


def _moments(value: dict[str, Any], where: str, reader: Reader, unit: str) -> Distribution:
    if missing := [key for key in ("mean", "standard_deviation") if key not in value]:
        raise InputError(where, f"lacks: {missing[0]}", written(value))
    mean, width = reader(value["mean"], f"{where}.mean"), value["standard_deviation"]
    at = f"{where}.standard_deviation"
    if isinstance(width, str) and (unit != "-" or "%" in width):
        deviation = _width(width, mean, str(value["mean"]), at, unit)
    else:
        deviation = _not_zero(reader(width, at), width, at)
    return _made(Normal, where, mean=mean, standard_deviation=deviation, text=written(value))


def _sampled(value: dict[str, Any], where: str, reader: Reader, unit: str) -> Distribution:
    del unit
    items = value["samples"]
    if not isinstance(items, list):
        raise InputError(f"{where}.samples", "must be a list in [brackets]", shown(items))
    return _samples(items, f"{where}.samples", reader, written(value))


def _samples(items: list[Any], where: str, reader: Reader, text: str) -> Samples:
    """Read equally likely values."""
    if not 2 <= len(items) <= MOST_SAMPLES:
        cure = "Write one value without brackets." if len(items) == 1 else ""
        raise InputError(where, f"must hold 2 to {MOST_SAMPLES} samples", str(len(items)), cure)
    values = tuple(reader(item, f"{where}, item {i},") for i, item in enumerate(items, 1))
    if min(values) == max(values):
        cure = "Write the value alone if it is certain."
        raise InputError(where, "must differ: there is no spread in them", written(items), cure)
    return _made(Samples, where, values=values, text=text)


def _made(kind: type[Made], where: str, **values: Any) -> Made:
    """Make a distribution; its refusals are given the place in the file."""
    try:
        return kind(**values)
    except InputError as error:
        raise error.at(where) from None


def _width(text: str, mean: float, mean_text: str, where: str, unit: str) -> float:
    """Read a width: percent of the mean, or a difference of two values of the quantity."""
    percent = _PERCENT.fullmatch(text.strip())
    if percent is None and unit != "-" and _PLAIN.fullmatch(text.strip()):
        cure = f'Write "{printable(text.strip())} %", or the width with its unit.'
        raise InputError(where, "needs a unit, or %", shown(text), cure)
    if percent is None:
        return _not_zero(_difference(text, where, unit), text, where)
    if unit == "K" and not re.search(r"[0-9] ?K$", mean_text.strip()):
        cure = "Write the width in kelvin."
        raise InputError(where, "is a share of a temperature, whose zero is arbitrary", shown(text), cure)
    share = _not_zero(float(percent.group(1)) / 100.0, text, where)
    if mean == 0.0:
        raise InputError(where, "is a share of 0", shown(text), "Write the width with its unit.")
    return share * abs(mean)


def _difference(text: str, where: str, unit: str) -> float:
    """Read a difference: of temperatures, without the zero of the scale."""
    if unit == "-":
        return _written_number(text, where, ratio, unit)
    value = parse(text, unit, where)
    if unit != "K":
        return value
    scale = re.sub(r"^\s*[-+.0-9eE]+\s*", "", text)
    return value - parse(f"0 {scale}", unit, where)


def _written_number(text: str, where: str, reader: Reader, unit: str) -> float:
    """Read a number inside a text; a ratio stands there without quotes of its own."""
    if unit != "-":
        return float(reader(text, where))
    if _PLAIN.fullmatch(text.strip()) is None:
        cure = "Write a decimal point." if "," in text else f'Write it like "{_example(unit)} +- 20 %".'
        raise InputError(where, "must be a plain number, without a unit", shown(text), cure)
    return float(reader(float(text), where))


def _not_zero(width: float, written_as: Any, where: str) -> float:
    if not width > 0.0:
        cure = "Write the value alone if it is certain." if width == 0.0 else "A width has no sign."
        raise InputError(where, "must be a width > 0", shown(written_as), cure)
    return width


def _example(unit: str) -> str:
    return {"m": "0.5 um", "N": "300 daN", "Pa": "1.5 GPa", "-": "0.1"}.get(unit, "1.5 " + unit)
