"""Readers of single values of a study: to what a record has, a number perhaps with its distribution."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from separatrix import study
from separatrix.cage_choice import NAMELESS
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
from separatrix.library import Library
from separatrix.study import Material
from separatrix.toml_files import (
    Reader,
    build,
    cut_list,
    list_of,
    nearest,
    quantity,
    ratio,
    table,
    text,
    whole,
)
from separatrix.units import NUMBER, parse, printable, shown

Made = TypeVar("Made", bound=Distribution)

_SIGN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
_PLAIN = re.compile(NUMBER)
_PERCENT = re.compile(rf"({NUMBER}) ?%")
_BRACKETS = re.compile(r"\(([^()]*)\) ?([^()]+)")
_FORM_OF = {"between": "between", "log": "between", "mean": "mean", "standard_deviation": "mean"} | {
    "samples": "samples"
}
"""Keys of a distribution, and the form that each belongs to."""

_FORMS = "between, or mean with standard_deviation, or samples"
_ALONE = "Write the value alone if it is certain."


@dataclass(frozen=True, slots=True)
class Uncertain:
    """A value whose numbers are uncertain: the value with the means, and the distributions by their names."""

    value: Any
    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    """Under ``""`` that of the value itself, under the name of a property that of the property."""


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


def number(unit: str) -> Reader:
    """Read a number, or what is known of an uncertain one, as `Uncertain`."""
    reader = quantity(unit)

    def read(value: Any, where: str) -> Any:
        found: Distribution
        if isinstance(value, list):
            found = _samples(value, where, reader, written(value))
        elif isinstance(value, dict):
            found = _table(value, where, unit)
        elif _is_spread(value):
            found = _plus_minus(value, where, unit)
        else:
            return reader(value, where)
        return Uncertain(found.mean, {"": found})

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
        is_table = isinstance(value, dict) and {"between", "standard_deviation", "samples"} & set(value)
        if is_table or _is_spread(value):
            cure = "This key takes one certain value."
            raise InputError(where, "takes no distribution", written(value), cure)
        return reader(value, where)

    return read


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


def _is_spread(value: Any) -> bool:
    return isinstance(value, str) and _SIGN.search(value) is not None


def _plus_minus(text: str, where: str, unit: str) -> Normal:
    """Read ``"0.5 um +- 20 %"``: a mean and its expanded uncertainty, `COVERAGE` standard deviations.

    ``"(0.5 +- 0.1) um"`` has one unit for both (GUM, 7.2.4).
    """
    shared = _BRACKETS.fullmatch(text.strip())
    parts = _SIGN.split(text.strip() if shared is None else shared[1].strip())
    if shared is not None:
        parts = [f"{part} {shared[2]}" for part in parts]
    like = f'Write it like "{_example(unit)} +- 20 %"'
    if len(text) > 120 or len(parts) != 2 or not all(parts):
        raise InputError(where, "must be one value, +- and one expanded uncertainty", shown(text), f"{like}.")
    if unit != "-" and _PLAIN.fullmatch(parts[0]):
        cure = f"{like}, with a unit on either side of +-."
        raise InputError(where, "needs a unit before +- too", shown(text), cure)
    mean = _written_number(parts[0], where, unit)
    half = _width(parts[1], mean, parts[0], f"{where}, after +-,", unit)
    return _made(Normal, where, mean=mean, standard_deviation=half / COVERAGE, text=shown(text))


def _table(value: dict[str, Any], where: str, unit: str) -> Distribution:
    """Read a table with bounds, with mean and standard deviation, or with samples."""
    for key in value:
        if key not in _FORM_OF:
            at, cure = f"{where}.{printable(key) or chr(34) * 2}", nearest(key, _FORM_OF)
            raise InputError(at, f"is not a key of a distribution: {_FORMS}", cure=cure)
    found = {_FORM_OF[key] for key in value if key != "log"}
    if len(found) != 1:
        rule = f"must have {_FORMS}" if not found else f"must have only one of {_FORMS}"
        raise InputError(where, rule, written(value))
    if "log" in value and "between" not in value:
        raise InputError(f"{where}.log", "has a meaning only with between")
    if "between" in found:
        return _between(value, where, quantity(unit))
    if "mean" in found:
        return _moments(value, where, unit)
    if not isinstance(value["samples"], list):
        raise InputError(f"{where}.samples", "must be a list in [brackets]", shown(value["samples"]))
    return _samples(value["samples"], f"{where}.samples", quantity(unit), written(value))


def _between(value: dict[str, Any], where: str, reader: Reader) -> Distribution:
    bounds, log, at = value["between"], value.get("log", False), f"{where}.between"
    if not isinstance(log, bool):
        raise InputError(f"{where}.log", "must be true or false", shown(log))
    if not isinstance(bounds, list) or len(bounds) != 2:
        got = f"a list of {len(bounds)}" if isinstance(bounds, list) else shown(bounds)
        raise InputError(at, "must be a list of two bounds", got)
    low, high = (reader(bound, f"{at}, item {i},") for i, bound in enumerate(bounds, 1))
    if not low < high:
        cure = _ALONE if low == high else "Write the lower one first."
        raise InputError(at, "must rise", f"{written(bounds[0])} and {written(bounds[1])}", cure)
    if log and low <= 0.0:
        cure = "A logarithm needs positive numbers: raise the lower bound, or leave log out."
        raise InputError(at, "must be > 0 with log = true", shown(bounds[0]), cure)
    return _made(LogUniform if log else Uniform, at, low=low, high=high, text=written(value))


def _moments(value: dict[str, Any], where: str, unit: str) -> Normal:
    if missing := [key for key in ("mean", "standard_deviation") if key not in value]:
        raise InputError(where, f"lacks: {missing[0]}", written(value))
    reader, at, width = quantity(unit), f"{where}.standard_deviation", value["standard_deviation"]
    mean = reader(value["mean"], f"{where}.mean")
    if isinstance(width, str) and (unit != "-" or "%" in width):
        deviation = _width(width, mean, str(value["mean"]), at, unit)
    else:
        deviation = _not_zero(reader(width, at), width, at)
    return _made(Normal, where, mean=mean, standard_deviation=deviation, text=written(value))


def _samples(items: list[Any], where: str, reader: Reader, text: str) -> Samples:
    """Read equally likely values."""
    if not 2 <= len(items) <= MOST_SAMPLES:
        cure = "Write one value without brackets." if len(items) == 1 else ""
        raise InputError(where, f"must hold 2 to {MOST_SAMPLES} samples", str(len(items)), cure)
    values = tuple(reader(item, f"{where}, item {i},") for i, item in enumerate(items, 1))
    if min(values) == max(values):
        raise InputError(where, "must differ: there is no spread in them", written(items), _ALONE)
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
        width = _written_number(text, where, unit)
        if unit == "K":  # a difference, without the zero of the scale
            scale = re.sub(r"^\s*[-+.0-9eE]+\s*", "", text)
            width -= parse(f"0 {scale}", unit, where)
        return _not_zero(width, text, where)
    if unit == "K" and not re.search(r"[0-9] ?K$", mean_text.strip()):
        cure = "Write the width in kelvin."
        raise InputError(where, "is a share of a temperature, whose zero is arbitrary", shown(text), cure)
    share = _not_zero(float(percent[1]) / 100.0, text, where)
    if mean == 0.0:
        raise InputError(where, "is a share of 0", shown(text), "Write the width with its unit.")
    return share * abs(mean)


def _written_number(text: str, where: str, unit: str) -> float:
    """Read a number inside a text; a ratio stands there without quotes of its own."""
    if unit != "-":
        return parse(text, unit, where)
    if _PLAIN.fullmatch(text.strip()) is None:
        cure = "Write a decimal point." if "," in text else f'Write it like "{_example(unit)} +- 20 %".'
        raise InputError(where, "must be a plain number, without a unit", shown(text), cure)
    return ratio(float(text), where)


def _not_zero(width: float, written_as: Any, where: str) -> float:
    if not width > 0.0:
        cure = _ALONE if width == 0.0 else "A width has no sign."
        raise InputError(where, "must be a width > 0", shown(written_as), cure)
    return width


def _example(unit: str) -> str:
    return {"m": "0.5 um", "N": "300 daN", "Pa": "1.5 GPa", "-": "0.1"}.get(unit, "1.5 " + unit)


_Reading = tuple[Library, float | None, Path]
_READING: ContextVar[_Reading] = ContextVar("reading", default=(Library(), None, Path()))


@contextmanager
def using(library: Library, temperature: float | None, folder: Path) -> Iterator[None]:
    """Read names from this library, with the data that serve at this temperature, until the end.

    `folder` has the files that [film] names.
    """
    before = _READING.set((library, temperature, folder))
    try:
        yield
    finally:
        _READING.reset(before)


def current_library() -> Library:
    """The library of the study that is being read; the shipped one otherwise."""
    return _READING.get()[0]


def current_temperature() -> float | None:
    """Temperature of the study that is being read; None where it states none."""
    return _READING.get()[1]


def current_folder() -> Path:
    """Folder of the files that [film] of the study that is being read names."""
    return _READING.get()[2]


def items(unit: str, default: str) -> Reader:
    """Read a list of numbers that is not empty; left out, there is a default."""

    def read(value: Any, where: str) -> tuple[float, ...]:
        if not value and isinstance(value, list):
            raise InputError(where, "must not be empty", cure=f"Leave it out to have {default}.")
        found: tuple[float, ...] = list_of(quantity(unit))(value, where)
        return found

    return read


def kicks(value: Any, where: str) -> tuple[float, ...]:
    """Read the speeds of the kicks, in any order."""
    return tuple(sorted(items("m/s", "them chosen")(value, where)))


def restitution_factors(value: Any, where: str) -> tuple[float, ...]:
    """Read ``{ from = 0.05, to = 0.95, count = 19 }``, or a list of numbers."""
    if not isinstance(value, dict):
        return tuple(items("-", "them chosen")(value, where))
    given = table(value, where, {"from": ratio, "to": ratio, "count": whole}, ("from", "to", "count"))
    if not 2 <= given["count"] <= 1000:
        raise InputError(where, "needs a count from 2 to 1000", shown(given["count"]))
    return study.evenly_spaced(given["from"], given["to"], given["count"])


def material(kind: str) -> Reader:
    """Read a material: a name of the library, or a table with its properties."""

    def read(value: Any, where: str) -> Material | Uncertain:
        if isinstance(value, str):
            return named_material(value, kind, where)
        if not isinstance(value, dict):
            rule = f"must be the name of a {kind}, or its properties elastic_modulus and poisson_ratio"
            cure = f'Write it like "{current_library().names(kind)[0]}".'
            raise InputError(where, rule, shown(value), cure)
        given, found = gathered(table(value, where, _PROPERTIES, ("elastic_modulus", "poisson_ratio")))
        made = build(Material, {"name": NAMELESS, **given}, where)
        return Uncertain(made, found) if found else made

    return read


_PROPERTIES: dict[str, Reader] = {
    "elastic_modulus": number("Pa"),
    "poisson_ratio": number("-"),
    "density": number("kg/m3"),
    "thermal_expansion": number("m/m/K"),
    "compressive_strength": quantity("Pa"),
    "name": text,
    "source": text,
    "confidence": text,
}


def named_material(name: str, kind: str, where: str) -> Material:
    """Material of the library, or a refusal that lists what there is."""
    return current_library().material(kind, known_name(name, kind, where), current_temperature())


def cage_material(value: Any, where: str) -> Material | Uncertain | str:
    """Read the cage's material; a name that the library lacks stays, for it may be that of a candidate."""
    if isinstance(value, str) and current_library().named("cage material", value) is None:
        return text(value, where)
    found: Material | Uncertain = material("cage material")(value, where)
    return found


def known_name(name: str, kind: str, where: str, more: str = "") -> str:
    """Exact name in the library of one in any spelling, or a refusal with what there is."""
    found = current_library().named(kind, name)
    if found is not None:
        return found
    names = current_library().names(kind)
    listed, near = cut_list(f"The library has {', '.join(names)}."), nearest(name, names)
    cure = f"{near} {listed}{more}" if near.startswith("Did") else f"{listed}{more}"
    raise InputError(where, f"is not a {kind} of the library", shown(name), cure)
