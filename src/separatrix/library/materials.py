"""A material or a fluid of a library file: its words, its facts, and numbers with source and conditions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from separatrix.errors import InputError, together
from separatrix.library.records import ELASTIC, FLUID, SOLID, Datum, Property, Record
from separatrix.library.words import BLANK, confidence_of, in_range, long_text, raw, span, yes_or_no
from separatrix.toml_values import nearest, ratio, table, text
from separatrix.units import format_quantity, parse, printable, shown

MOST_DATA = 100
_WHO = "Say who measured or printed it, and where."
_WORDS = ("medium", "form")
_DATUM = ("value", "source", "confidence", "range", "temperature", "pressure", *_WORDS)


def material(
    kind: str, item: Mapping[str, Any], at: str, common: dict[str, Any], places: Mapping[str, str]
) -> Record:
    """Read a material or a fluid: its words, its facts and its numbers."""
    numbers = FLUID if kind == "fluid" else SOLID
    words: dict[str, Callable[[Any, str], Any]] = {"remark": long_text, "replaces": yes_or_no}
    words |= _FACTS if kind == "fluid" else {"composition": long_text, "aliases": _aliases}
    tail = at.partition(": ")[2]
    given: dict[str, Any] = {}
    data: dict[str, tuple[Datum, ...]] = {}
    problems: list[InputError] = []
    for key, value in item.items():
        where = f"{places[key]}: {tail}.{printable(key)}"
        try:
            if key in words:
                given[key] = words[key](value, where)
            elif key in numbers:
                data[key] = _data(numbers[key], value, where)
            else:
                raise InputError(where, f"is no key of a {kind}", cure=nearest(key, [*numbers, *words]))
        except InputError as error:
            problems.extend(error.problems or (error,))
    required = ("substance", "phase") if kind == "fluid" else ELASTIC
    if missing := [key for key in required if key not in item]:
        problems.append(InputError(at, f"lacks: {', '.join(missing)}"))
    if problems:
        raise together(problems)
    facts = {key: given.pop(key, None) for key in (_FACTS if kind == "fluid" else ("aliases",))}
    return Record(kind=kind, data=data, facts=facts, **given, **common)


def _data(known: Property, value: Any, where: str) -> tuple[Datum, ...]:
    """Read one datum, or several of one property under different conditions."""
    if not isinstance(value, list):
        return (_datum(known, value, where),)
    if not 0 < len(value) <= MOST_DATA:
        raise InputError(where, f"must hold 1 to {MOST_DATA} data", f"{len(value)} of them", BLANK)
    data = tuple(_datum(known, item, f"{where}[{i}]") for i, item in enumerate(value, 1))
    conditions = [(d.temperature, d.pressure, d.medium, d.form) for d in data]
    if len(set(conditions)) < len(conditions):
        rule = "holds two data for the same temperature, pressure, medium and form"
        raise InputError(where, rule, cure="Keep one, or say in which condition they differ.")
    return data


def _datum(known: Property, value: Any, where: str) -> Datum:
    if not isinstance(value, dict):
        example = '{ value = "5 GPa", source = "our test 12", confidence = "measured" }'
        raise InputError(where, "must be a number with its source", shown(value), f"Write it like {example}.")
    given = table(value, where, dict.fromkeys(_DATUM, raw), ("value", "source", "confidence"))
    words: dict[str, Any] = {
        name: long_text(given[name], f"{where}.{name}") for name in _WORDS if name in given
    }
    if "temperature" in given:
        words["temperature"] = span("K", given["temperature"], f"{where}.temperature", 1e-3, 5000.0)
    if "pressure" in given:
        words["pressure"] = in_range("Pa", given["pressure"], f"{where}.pressure", 1e-9, 1e11)
    number = _number(known, given["value"], f"{where}.value")
    expected = _expected(known, given["range"], f"{where}.range", number) if "range" in given else None
    confidence = confidence_of(given["confidence"], f"{where}.confidence")
    source = long_text(given["source"], f"{where}.source")
    if len(source.strip()) < 3:
        raise InputError(f"{where}.source", "must name a source", shown(source), _WHO)
    return Datum(value=number, unit=known.unit, range=expected, source=source, confidence=confidence, **words)


def _number(known: Property, value: Any, where: str) -> float:
    number = ratio(value, where) if known.unit == "-" else parse(value, known.unit, where)
    if not known.low <= number <= known.high:
        low, high = (format_quantity(bound, known.unit) for bound in (known.low, known.high))
        cure = BLANK if number == 0.0 else "Check the unit."
        raise InputError(where, f"must lie between {low} and {high}", shown(value), cure)
    return number


def _expected(known: Property, value: Any, where: str, number: float) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(where, "must be a list of the lowest and the highest value", shown(value))
    low, high = (_number(known, bound, where) for bound in value)
    if not low <= number <= high:
        raise InputError(where, "must hold the value between its ends, the lower one first", shown(value))
    return low, high


def _phase(value: Any, where: str) -> str:
    if value not in ("liquid", "gas"):
        raise InputError(where, 'must be "liquid" or "gas"', shown(value))
    return str(value)


def _coolprop(value: Any, where: str) -> str:
    given = text(value, where)
    if not (given.isascii() and given.replace("-", "").isalnum()):
        raise InputError(where, "must be the plain name of a pure fluid, letters and digits", shown(given))
    return given


def _aliases(value: Any, where: str) -> list[str]:
    if not isinstance(value, list) or not 0 < len(value) <= 20:
        raise InputError(where, "must be a list of 1 to 20 names", shown(value))
    return [text(name, where) for name in value]


_FACTS: dict[str, Callable[[Any, str], Any]] = {
    "substance": text,
    "phase": _phase,
    "coolprop": _coolprop,
    "aliases": _aliases,
}
