"""Conditions of a test: what its column map, the lines above its table and its columns state."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

import numpy as np

from separatrix.friction.logs.column_map import QUANTITIES, TEXTS
from separatrix.friction.logs.names import conditions_named, header_parts, scale_in
from separatrix.ground.errors import InputError
from separatrix.ground.schema import key, positive, record
from separatrix.ground.units import (
    Array,
    Kelvin,
    MetrePerSecond,
    Newton,
    Pascal,
    Second,
    format_quantity,
    printable,
)


@record
class Conditions:
    """Under which one test was run; None where that is not known."""

    material: str | None = key(default=None)
    """Of the sample."""

    counterface: str | None = key(default=None)
    """What the sample slides on."""

    medium: str | None = key(default=None)
    """In which it slides."""

    sample: str | None = key(default=None)
    """Name of the piece; tests of one piece share it."""

    test: str | None = key(default=None)
    """Name of the test."""

    temperature: Kelvin | None = key(positive(0.1, 3000.0), default=None)
    """Of the test."""

    slip_speed: MetrePerSecond | None = key(positive(1e-9, 1e3), default=None)
    """Of the test."""

    pressure: Pascal | None = key(positive(1e-3, 1e12), default=None)
    """Mean contact pressure."""

    normal_force: Newton | None = key(positive(1e-9, 1e7), default=None)
    """Of the test."""

    cycle_time: Second | None = key(positive(1e-6, 1e7), default=None)
    """Of one revolution or of one stroke there and back."""

    @property
    def environment(self) -> str | None:
        """Medium and counterface as friction tables name them: ``"liquid nitrogen, 440C"``."""
        if self.medium is None or self.counterface is None:
            return None
        return f"{self.medium}, {self.counterface}"


AGREE = 0.01
"""Share by which two values of one condition may differ: set points are written with two or three digits."""

MAP, MEDIAN = "column map", "median of its column"  # where a condition comes from
TURNED, OVER_AREA = "rotational speed times radius of the track", "normal force over the area of the pin"
_VALUE = re.compile(
    r"([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)\s*[\[(]?\s*([^\d\s\[\]()][^\[\]()]*?)?\s*[\])]?"
)
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}([.,])[0-9]{3}")
_PAIR = re.compile(r"[\s#%]*([^:=\t;]{1,60}?)\s*(?:[:=\t;]\s*)+(\S.*?)[\s;,]*$")
_NUMBERED = re.compile(r"\s*(Run|Step)\s*(?:#|No\.?)\s*(\d+)\s*$", re.IGNORECASE)
MOST_PAIRS = 400  # kept of one table
Found = dict[str, tuple[str | float, str]]  # value of each condition, and where it comes from


def conditions_of(
    given: Mapping[str, str | float],
    metadata: Mapping[str, str],
    columns: Mapping[str, Array],
    source: str,
    decimal: str,
) -> tuple[Conditions, frozenset[str], tuple[str, ...]]:
    """Conditions of a log, which of them are measured, and a sentence on each that the map does not state.

    The slip speed is the rotational speed times the radius of the track, the time of a cycle that of one
    turn, and the pressure the normal force over the area of the pin, where these are known.
    """
    found: Found = {key: (value, MAP) for key, value in given.items()}
    pairs = metadata.items()
    notes = [note for key, text in pairs if text and (note := _from_metadata(key, text, found, decimal))]
    for name, column in columns.items():  # the median, which a ramp at the start does not move
        if name in QUANTITIES and np.isfinite(column).any():
            middle = float(np.nanmedian(column if name == "temperature" else np.abs(column)))
            if middle > 0.0:
                found.setdefault(name, (middle, MEDIAN))
    _derive(found, source)
    known = {key: one for key, one in found.items() if key in Conditions.__dataclass_fields__}
    sentences = []
    for name, (value, reason) in known.items():
        text = printable(value, 200) if isinstance(value, str) else format_quantity(value, QUANTITIES[name])
        if reason != MAP:
            sentences.append(f"{name.replace('_', ' ')} {text}: {reason}")
    try:
        conditions = Conditions(**{key: value for key, (value, _) in known.items()})  # type: ignore[arg-type]
    except InputError as error:
        raise of_log(error, source) from None
    measured = {key for key, (_, reason) in found.items() if reason == MEDIAN}
    follows = (("slip_speed", "rotational_speed", TURNED), ("pressure", "normal_force", OVER_AREA))
    measured |= {key for key, base, way in follows if base in measured and found.get(key, ("", ""))[1] == way}
    return conditions, frozenset(measured & known.keys()), (*sentences, *notes)


def metadata_of(lines: Sequence[str]) -> dict[str, str]:
    """Pairs in the lines: ``key: value``, ``key = value``, or a row of keys over one of values.

    Two lines of two fields are two pairs, not a row of keys and one of values.
    """
    pairs: dict[str, str] = {}
    skip = False
    for line, below in zip(lines, [*lines, ""][1:], strict=True):
        if skip:
            skip = False
        elif rows := _keys_over_values(line, below):
            pairs |= rows
            skip = True
        elif found := _NUMBERED.match(line) or _PAIR.match(line):
            pairs[_clean(found[1])] = _clean(found[2])
    return {key[:100]: value[:200] for key, value in list(pairs.items())[:MOST_PAIRS]}


def _keys_over_values(line: str, below: str) -> dict[str, str]:
    """Two rows of as many commas, semicolons or tabs, the upper of words alone."""
    for separator in "\t;,":
        count = line.count(separator)
        if line.rstrip(separator).count(separator) >= 2 and below.count(separator) == count:
            keys, values = line.split(separator), below.split(separator)
            if not any(re.match(r"\s*[+-]?\d", key) for key in keys):
                pairs = [(_clean(key), _clean(value)) for key, value in zip(keys, values, strict=True)]
                return {key: value for key, value in pairs if key and value}
    return {}


def _clean(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text).strip().strip('"').strip()


def of_log(error: InputError, source: str) -> InputError:
    """The first refusal of a record as one of its log: its field in words in place of its class."""
    first = (error.problems or (error,))[0]
    return first.at(f"{source}: {first.path.rpartition('.')[2].replace('_', ' ')}")


def _from_metadata(key: str, text: str, found: Found, decimal: str) -> str:
    """Keep the first condition whose unit the value has; return a note on a value that is not used."""
    conditions, beside = conditions_named(key), header_parts(key)[0][1]
    if not conditions:
        return ""
    first, reason = conditions[0], f'"{printable(key)}" in the file'
    if first in TEXTS:
        found.setdefault(first, (text, reason))
        return ""
    match, shown = _VALUE.fullmatch(text.strip()), f"{printable(key)} {printable(text)}"
    if match and (group := _GROUPED.fullmatch(match[1])) and group[1] != decimal:
        return f'{shown} may hold a mark between thousands; put {first} = "..." under [test]'
    unit = (match[2] or beside).strip() if match else ""
    for condition in conditions:
        scale = scale_in(unit, QUANTITIES[condition])
        if match and scale is not None:
            size = float(match[1].replace(",", ".")) * scale.factor + scale.offset
            if size > 0.0:
                found.setdefault(condition, (size, reason))
                return ""
    if first in found:
        return ""
    number = match[1].lstrip("+-") if match and not unit else ""
    if not number:
        return f'{shown} is not understood; put {first} = "..." with its unit under [test]'
    unit = "mm" if first in ("track_radius", "pin_diameter") else "<unit>"
    return f'{shown} has no unit; put {first} = "{number} {unit}" under [test]'


def _derive(found: Found, source: str) -> None:
    """Add what follows from other conditions; a given one must agree, unless it is measured."""
    at = {key: value for key, (value, _) in found.items() if isinstance(value, float)}
    rotation, radius, area, diameter = map(
        at.get, ("rotational_speed", "track_radius", "contact_area", "pin_diameter")
    )
    follows: list[tuple[str, float, str]] = []
    if rotation is not None:
        follows += [("slip_speed", rotation * radius, TURNED)] if radius is not None else []
        follows.append(("cycle_time", 2.0 * math.pi / rotation, "one turn"))
    elif radius is not None and "slip_speed" in at:
        time = 2.0 * math.pi * radius / at["slip_speed"]
        follows.append(("cycle_time", time, "2 pi radius / slip speed"))
    if area is not None and diameter is not None:
        rule = "cannot have both a contact_area and a pin_diameter"
        raise InputError(source, rule, cure="Give the one that is measured.")
    area = area if diameter is None else math.pi / 4.0 * diameter**2
    if area is not None and "normal_force" in at:
        follows.append(("pressure", at["normal_force"] / area, OVER_AREA))
    for name, value, reason in follows:
        there, why = at.get(name), found.setdefault(name, (value, reason))[1]
        if there is not None and why != MEDIAN and abs(there - value) > AGREE * abs(value):
            ways = ((there, why), (value, reason))
            got = " and ".join(f"{format_quantity(one, QUANTITIES[name])} ({way})" for one, way in ways)
            rule = f"has two values of {name.replace('_', ' ')} that differ"
            raise InputError(source, rule, got, "Leave out the wrong one.")
