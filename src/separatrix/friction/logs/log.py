"""A log of a tribometer, whatever its format, with its conditions; parts of one test joined to one log."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from separatrix.friction.logs.column_map import QUANTITIES, TEXTS
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS, conditions_named, header_parts, scale_in
from separatrix.ground.errors import InputError
from separatrix.ground.schema import key, positive, record
from separatrix.ground.units import (
    Array,
    Kelvin,
    MetrePerSecond,
    Newton,
    Pascal,
    Second,
    format_number,
    format_quantity,
    printable,
    unit_of,
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


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnRead:
    """How one column of a file was understood."""

    header: str  # as in the file
    meaning: str | None  # A key of `MEANINGS`; None where the column is not used
    unit: str  # as the file or the column map writes it; empty where there is none
    why: str  # for instance ``"its name"`` or ``"column map"``


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RawLog:
    """Friction of one test as it was logged, in SI units, with where it comes from."""

    source: str  # name of the file, and of the sheet, channel group or section in it
    checksum: str  # SHA-256 of the file
    format: str  # of the file, in words
    friction: Array  # Magnitude, shape (row,) [-]
    time: Array | None = None  # since the start, shape (row,) [s]
    distance: Array | None = None  # slid, shape (row,) [m]
    cycles: Array | None = None  # turns or strokes, shape (row,)
    normal_force: Array | None = None  # shape (row,) [N]
    tangential_force: Array | None = None  # with the sign that was logged, shape (row,) [N]
    temperature: Array | None = None  # shape (row,) [K]
    wear_depth: Array | None = None  # shape (row,) [m]
    slip_speed: Array | None = None  # shape (row,) [m/s]
    missing: int = 0  # rows left out because friction or its abscissa was not there
    columns: tuple[ColumnRead, ...] = ()  # how each was understood
    metadata: Mapping[str, str] = field(default_factory=dict)  # what the header states, by its name there
    conditions: Conditions = field(default_factory=Conditions)  # from header, column map and columns
    measured: frozenset[str] = frozenset()
    """Conditions that are the median of a column, or follow from one; the others are stated."""
    series: str = ""  # what the header states about the test that this is a part of; empty if nothing
    notes: tuple[str, ...] = ()  # what the reading did that a user should know, a sentence each

    def __post_init__(self) -> None:
        if not self.abscissae:
            raise InputError(self.source, f"needs one of {', '.join(ABSCISSAE)}")
        if self.rows < 2:
            raise InputError(self.source, "needs at least two rows with a friction", str(self.rows))
        for name in MEANINGS.keys() & {f.name for f in fields(self)}:
            column = getattr(self, name)
            if column is not None and len(column) != self.rows:
                raise InputError(f"RawLog.{name}", "must have as many rows as friction", str(len(column)))

    @property
    def rows(self) -> int:
        """Rows that are kept."""
        return len(self.friction)

    @property
    def abscissae(self) -> tuple[str, ...]:
        """Which of time, distance and cycles the log has."""
        return tuple(name for name in ABSCISSAE if getattr(self, name) is not None)


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


def two_ways(text: str, decimal: str) -> list[str]:
    """The two values of a text whose mark may be a decimal sign or between thousands; else empty."""
    match = _VALUE.fullmatch(text.strip())
    group = match and _GROUPED.fullmatch(match[1])
    if not match or not group or group[1] == decimal:
        return []
    unit = f" {match[2].strip()}" if match[2] else ""
    return [f"{re.sub('[.,]', '', match[1])}{unit}", f"{match[1].replace(',', '.')}{unit}"]


def metadata_of(lines: Sequence[str], *, keys_above: bool = False) -> dict[str, str]:
    """Pairs in the lines: ``key: value``, ``key = value``, or a row of keys over one of values.

    Two lines of two fields are taken as two pairs, unless the layout is known for its row of keys.
    """
    pairs: dict[str, str] = {}
    skip = False
    for line, below in zip(lines, [*lines, ""][1:], strict=True):
        if skip:
            skip = False
        elif rows := _keys_over_values(line, below, 1 if keys_above else 2):
            pairs |= rows
            skip = True
        elif found := _NUMBERED.match(line) or _PAIR.match(line):
            pairs[_clean(found[1])] = _clean(found[2])
    return {key[:100]: value[:200] for key, value in list(pairs.items())[:MOST_PAIRS]}


def _keys_over_values(line: str, below: str, least: int) -> dict[str, str]:
    """Two rows of as many commas, semicolons or tabs, the upper of words alone."""
    for separator in "\t;,":
        count = line.count(separator)
        if line.rstrip(separator).count(separator) >= least and below.count(separator) == count:
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
    if ways := two_ways(text, decimal):
        return f'{shown} may be {" or ".join(ways)}; put {first} = "..." under [test]'
    unit = (match[2] or beside).strip() if match else ""
    for condition in conditions:
        scale = scale_in(unit, QUANTITIES[condition])
        if match and scale is not None:
            size = float(match[1].replace(",", ".")) * scale.factor / scale.divisor + scale.offset
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

    def number(key: str) -> float | None:
        value = found.get(key, (None, ""))[0]
        return value if isinstance(value, float) else None

    def settle(key: str, value: float, reason: str) -> None:
        there = number(key)
        if there is None:
            found[key] = (value, reason)
        elif found[key][1] != MEDIAN and abs(there - value) > AGREE * abs(value):
            ways = ((there, found[key][1]), (value, reason))
            got = " and ".join(f"{format_quantity(one, QUANTITIES[key])} ({way})" for one, way in ways)
            rule = f"has two values of {key.replace('_', ' ')} that differ"
            raise InputError(source, rule, got, "Leave out the wrong one.")

    rotation, radius = number("rotational_speed"), number("track_radius")
    if rotation is not None and radius is not None:
        settle("slip_speed", rotation * radius, TURNED)
    if rotation is None and radius is not None and (speed := number("slip_speed")) is not None:
        settle("cycle_time", 2.0 * math.pi * radius / speed, "2 pi radius / slip speed")
    if rotation is not None:
        settle("cycle_time", 2.0 * math.pi / rotation, "one turn")
    area, diameter, force = (number(key) for key in ("contact_area", "pin_diameter", "normal_force"))
    if area is not None and diameter is not None:
        rule = "cannot have both a contact_area and a pin_diameter"
        raise InputError(source, rule, cure="Give the one that is measured.")
    if diameter is not None:
        area = math.pi / 4.0 * diameter**2
    if area is not None and force is not None:
        settle("pressure", force / area, OVER_AREA)


ALIKE = 0.1  # share by which measured conditions of parts may differ; beyond it they are of different tests
LISTED = 12  # parts whose friction is listed


def in_order(name: str) -> list[tuple[int, str]]:
    """Key that sorts ``part 2`` before ``part 10``."""
    return [(int(part or 0), "") if part.isdigit() else (0, part) for part in re.split(r"(\d+)", name)]


def joined(parts: Sequence[RawLog]) -> RawLog:
    """Return one log of the parts of a test, one after the other; time goes on from one to the next."""
    if len(parts) == 1:
        return parts[0]
    parts = sorted(parts, key=lambda part: in_order(part.source))
    source = f"{parts[0].source} and {len(parts) - 1} more"
    columns: dict[str, Any] = {}
    for name in (f.name for f in fields(RawLog) if f.name in MEANINGS):
        pieces = [getattr(part, name) for part in parts]
        if any(piece is None for piece in pieces):
            columns[name] = None
            continue
        for i in range(1, len(pieces) if name in ABSCISSAE else 0):  # one that begins anew goes on
            last, piece = pieces[i - 1][-1], pieces[i]
            if piece[0] < last:
                pieces[i] = piece + (last - piece[0] + float(np.median(np.diff(piece))))
        columns[name] = np.concatenate(pieces)
    if all(columns[name] is None for name in ABSCISSAE):
        raise InputError(source, "have no column of time, distance or cycles in common to be joined by")
    if len({part.series for part in parts}) == 1 and parts[0].series and columns["cycles"] is None:
        # a cycle is a stroke there and the one back
        strokes = [(k + np.arange(part.rows) / part.rows) / 2.0 for k, part in enumerate(parts)]
        columns["cycles"] = np.concatenate(strokes)
    means = [format_number(float(part.friction.mean()), 3) for part in parts]
    more = "" if len(means) <= LISTED else f" and {len(means) - LISTED} more"
    note = (
        f"{len(parts)} parts of one test are joined, {parts[0].source} to {parts[-1].source}; "
        f"their frictions: {', '.join(means[:LISTED])}{more}"
    )
    return replace(
        parts[0],
        source=source,
        checksum=hashlib.sha256("".join(part.checksum for part in parts).encode()).hexdigest(),
        missing=sum(part.missing for part in parts),
        conditions=_common_conditions(parts, source),
        measured=frozenset.intersection(*(part.measured for part in parts)),
        notes=(note, *parts[0].notes),
        series="",
        **columns,
    )


def _common_conditions(parts: Sequence[RawLog], source: str) -> Conditions:
    """Conditions of all parts: words that agree, and the middle of measured values that are alike."""
    found: dict[str, Any] = {}
    for f in fields(Conditions):
        values = [value for part in parts if (value := getattr(part.conditions, f.name)) is not None]
        numbers = [value for value in values if isinstance(value, float)]
        if numbers:
            found[f.name] = float(np.median(numbers))
            differs = max(numbers) - min(numbers) > ALIKE * found[f.name]
        else:
            found[f.name] = values[0] if values else None
            differs = len(set(values)) > 1
        if differs:
            unit = unit_of(Conditions, f.name)
            ends = (min(values), max(values))
            texts = [format_quantity(v, unit) if unit else printable(str(v)) for v in ends]
            rule = f"cannot be one test: their {f.name.replace('_', ' ')} differs"
            raise InputError(source, rule, " and ".join(texts), "Name the parts of one test only.")
    return Conditions(**found)
