"""What logs of one layout do not state: their columns and conditions (docs/reference/tribometer-logs.md)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from functools import cache
from importlib.resources import files as files_of
from pathlib import Path, PurePosixPath
from typing import Any, ClassVar, Literal

import numpy as np

from separatrix.friction.friction_file import Place, place
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS, SHAPES, known_units, scale_of
from separatrix.ground.errors import InputError
from separatrix.ground.reader import read_text
from separatrix.ground.schema import Fault, Faults, between, check, key, keys_of, positive, record
from separatrix.ground.toml import Kind, label_of, nearest, parsed
from separatrix.ground.toml import read_text as text_of
from separatrix.ground.units import (
    Array,
    Kelvin,
    Metre,
    MetrePerSecond,
    Newton,
    Pascal,
    RadianPerSecond,
    Second,
    SquareMetre,
    format_quantity,
    printable,
    shown,
)


# --- conditions of a test --------------------------------------------------------------------------
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
    """Of the sample."""

    slip_speed: MetrePerSecond | None = key(positive(1e-9, 1e3), default=None)
    pressure: Pascal | None = key(positive(1e-3, 1e12), default=None)
    """Mean contact pressure."""

    normal_force: Newton | None = key(positive(1e-9, 1e7), default=None)
    """Of the sample on what it slides on."""

    cycle_time: Second | None = key(positive(1e-6, 1e7), default=None)
    """Of one revolution or of one stroke there and back."""

    contact_area: SquareMetre | None = key(positive(1e-18, 1e3), default=None)
    """Of a flat pin."""

    pin_diameter: Metre | None = key(positive(1e-9, 1e2), default=None)
    """Of a flat round pin."""

    track_radius: Metre | None = key(positive(1e-9, 1e2), default=None)
    """Of the pin from the axis of the disk."""

    rotational_speed: RadianPerSecond | None = key(positive(1e-9, 1e6), default=None)
    """Of the disk."""

    run_in_end: Place | None = key(default=None, read=lambda raw, *_: place(raw, ""))
    """Where running-in ends."""

    @property
    def environment(self) -> str | None:
        """Medium and counterface as friction tables name them: ``"liquid nitrogen, 440C"``."""
        if self.medium is None or self.counterface is None:
            return None
        return f"{self.medium}, {self.counterface}"


QUANTITIES = {name: one.unit for name, one in keys_of(Conditions).items() if one.unit}
"""Conditions that are a number, and the SI unit of each."""

AGREE = 0.01
"""Share by which two values of one condition may differ: set points are written with two or three digits."""

MAP, MEDIAN = "column map", "median of its column"  # where a condition comes from
TURNED, OVER_AREA = "rotational speed times radius of the track", "normal force over the area of the pin"
Found = dict[str, tuple[object, str]]  # value of each condition, and where it comes from


def conditions_of(
    given: Mapping[str, object], columns: Mapping[str, Array], source: str
) -> tuple[Conditions, frozenset[str], tuple[str, ...]]:
    """Conditions of a log, which of them are measured, and a sentence on each that the map does not state.

    The slip speed is the rotational speed times the radius of the track, the time of a cycle that of one
    turn, and the pressure the normal force over the area of the pin, where these are known.
    """
    found: Found = {key: (value, MAP) for key, value in given.items()}
    for name, column in columns.items():  # the median, which a ramp at the start does not move
        if name in QUANTITIES and np.isfinite(column).any():
            middle = float(np.nanmedian(column if name == "temperature" else np.abs(column)))
            if middle > 0.0:
                found.setdefault(name, (middle, MEDIAN))
    _derive(found, source)
    sentences = tuple(
        f"{name.replace('_', ' ')} {format_quantity(value, QUANTITIES[name])}: {reason}"
        for name, (value, reason) in found.items()
        if reason != MAP and isinstance(value, float)
    )
    try:
        conditions = Conditions(**{key: value for key, (value, _) in found.items()})  # type: ignore[arg-type]
    except InputError as error:
        raise of_log(error, source) from None
    measured = {key for key, (_, reason) in found.items() if reason == MEDIAN}
    follows = (("slip_speed", "rotational_speed", TURNED), ("pressure", "normal_force", OVER_AREA))
    measured |= {key for key, base, way in follows if base in measured and found.get(key, ("", ""))[1] == way}
    return conditions, frozenset(measured), sentences


def of_log(error: InputError, source: str) -> InputError:
    """The first refusal of a record as one of its log: its field in words in place of its class."""
    first = (error.problems or (error,))[0]
    return first.at(f"{source}: {first.path.rpartition('.')[2].replace('_', ' ')}")


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


# --- columns --------------------------------------------------------------------------------------
LAST = between(1, 1_000_000_000)  # numbers of columns and lines
SEPARATORS = {"tab": "\t", ";": ";", ",": ",", "|": "|", "blanks": " "}


def _column_name(raw: object, *_: object) -> tuple[str, ...] | int:
    if isinstance(raw, int) and not isinstance(raw, bool):
        if LAST.low <= raw <= LAST.high:
            return raw
        raise InputError("", "must be the number of a column, counted from 1", shown(raw))
    names = raw if isinstance(raw, list) and raw else [raw]
    if not all(isinstance(one, str) and one.strip() for one in names):
        cure = 'Write friction = "COF", or normal_force = { name = "Fz", unit = "N" }.'
        raise InputError("", "must be the name or the number of a column", shown(raw), cure)
    return tuple(names)


@record
class Column:
    """Which column, by one of its names or by its number from 1, and its unit."""

    SHORT: ClassVar = "name"

    name: tuple[str, ...] | int = key(read=_column_name)
    unit: str | None = key(default=None, without="as the file states it")
    sign: Literal[1, -1] = key(default=1)
    """-1 where compression counts negative."""

    optional: bool = key(default=False)
    """In the map of a layout whose files do not all have it."""

    origin: str = "column map"
    """Who states it."""

    @property
    def names(self) -> tuple[str, ...]:
        """Its names; empty where it has a number."""
        return self.name if isinstance(self.name, tuple) else ()

    @property
    def number(self) -> int | None:
        """Its number; None where it has names."""
        return self.name if isinstance(self.name, int) else None


@record
class TextFormat:
    """How the table is written; what is not given the file shows."""

    separator: Literal["tab", ";", ",", "|", "blanks"] | None = key(default=None)
    decimal: Literal[".", ","] | None = key(default=None)
    encoding: (
        Literal["utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp1250", "cp932", "gbk"]
        | None
    ) = key(default=None)
    header_line: int | None = key(LAST, default=None)
    units_below: bool = key(default=False)
    """Whether the line below the names is that of the units."""

    missing: tuple[str, ...] = key(default=())
    """Texts that mean a missing value, besides the usual ones."""

    tables: tuple[str, ...] = key(default=())
    """Names of the tables (sheets, steps) to read; all of them if empty."""

    skip: tuple[str, ...] = key(default=())
    """Beginnings of lines among the rows that are not rows."""

    ends: tuple[str, ...] = key(default=())
    """Beginnings of lines behind which there are no rows."""

    tests: tuple[str, ...] = key(default=())
    """Columns; a change in the first of them that is there begins another test."""

    series: tuple[str, ...] = key(default=())
    """Patterns of lines above a table, whose groups all parts of a test share."""

    spellings: Mapping[str, str] = key(default={})
    """What the layout means by a unit: g = "gf"."""


@check(TextFormat)
def _commas(separator: str, decimal: str) -> Faults:
    if separator == decimal == ",":
        yield Fault("", "cannot have a comma both as separator and as decimal sign", got="")


@record
class ColumnMap:
    """What is stated about files: their columns, text format, conditions for all and by file pattern."""

    FILE: ClassVar = Kind(
        noun="a column map", empty='Write for instance [columns], and below it: friction = "COF".'
    )

    name: str = key(default="column map")
    signature: tuple[str, ...] = key(default=())
    """Texts that the beginning of each file of a shipped layout has."""

    columns: Mapping[str, Column] = key(default={})
    format: TextFormat = key(default=TextFormat())
    test: Conditions = key(default=Conditions())
    files: Mapping[str, Conditions] = key(default={})
    source: str = ""
    as_written: Mapping[str, Any] = field(default_factory=dict)
    """Sections of the file, for a draft."""

    is_shipped: bool = False

    @property
    def is_complete(self) -> bool:
        """Whether it names all columns that a log needs."""
        has_friction = "friction" in self.columns or "tangential_force" in self.columns
        return has_friction and any(name in self.columns for name in ABSCISSAE)

    def by(self, origin: str) -> ColumnMap:
        """Return this map, its columns stated by somebody else than the user."""
        columns = {meaning: replace(one, origin=origin) for meaning, one in self.columns.items()}
        return replace(self, columns=columns)

    def over(self, base: ColumnMap) -> ColumnMap:
        """Return this map, with what it does not state from another."""
        columns = dict(base.columns)
        if "tangential_force" in self.columns and "friction" not in self.columns:
            columns.pop("friction", None)  # forces that are named go before a coefficient
        form = replace(base.format, **given_in(self.format))
        return replace(self, columns={**columns, **self.columns}, format=form, name=base.name)

    def conditions(self, path: Path) -> dict[str, Any]:
        """What is stated about one file: `[test]`, then every matching pattern in the order written."""
        found = given_in(self.test)
        for pattern, stated in self.files.items():
            found |= given_in(stated) if _fits(path, pattern) else {}
        return found

    def unused(self, paths: Iterable[Path]) -> list[InputError]:
        """What is wrong with each pattern that fits none of the files."""
        files = list(paths)
        names = ", ".join(printable(path.name, 60) for path in files[:3])
        names += f" and {len(files) - 3} more" if len(files) > 3 else ""
        rule, cure = "must fit a file that is named", "Mend it, or leave it out of this column map."
        idle = [pattern for pattern in self.files if not any(_fits(path, pattern) for path in files)]
        return [InputError(f'{self.source}: [files."{printable(one)}"]', rule, names, cure) for one in idle]


def given_in(one: Any) -> dict[str, Any]:
    """Keys of a record that have another value than none."""
    return {name: value for name in keys_of(type(one)) if (value := getattr(one, name))}


def _fits(path: Path, pattern: str) -> bool:
    """Whether a pattern is one of the file's name, or of the names of its last folders, too."""
    return PurePosixPath(path.absolute().as_posix()).match(pattern)


@check(ColumnMap)
def _meanings_and_units(columns: Mapping[str, Column]) -> Faults:
    known = (*MEANINGS, *SHAPES)
    for meaning, one in columns.items():
        if meaning not in known:
            yield Fault(("columns", meaning), "is not the meaning of a column", nearest(meaning, known), "")
        elif one.unit is not None and scale_of(one.unit, meaning) is None:
            cure = "The draft asks for it: write the true one." if one.unit == "..." else ""
            cure = 'Write a format of dates like "%d.%m.%Y %H:%M:%S".' if "%" in one.unit else cure
            rule = f"must be a unit such as {known_units(meaning)}"
            yield Fault(("columns", meaning, "unit"), rule, cure, shown(one.unit))


@check(ColumnMap)
def _patterns(files: Mapping[str, Conditions]) -> Faults:
    for pattern in files:
        if not PurePosixPath(pattern).name:
            yield Fault(("files", pattern), "must be a pattern of names of files", 'Write "peek_*.csv".', "")


def read_column_map(path: str | Path) -> ColumnMap:
    """Column map of a TOML file.

    Raises
    ------
    InputError
        Everything that is wrong with it, a line each: place, key, rule, value, cure.
    """
    label = label_of(Path(path))
    return column_map_of(text_of(Path(path), ColumnMap.FILE), label)


def column_map_of(text: str, label: str) -> ColumnMap:
    """Column map of the text of a file."""
    made = read_text(ColumnMap, text, label).value
    return replace(made, source=label, as_written=parsed(text, label, ColumnMap.FILE)[0])


@cache
def shipped_maps() -> tuple[ColumnMap, ...]:
    """Maps of known layouts; one with a longer signature goes before a shorter."""
    maps = sorted(files_of(__package__).joinpath("maps").iterdir(), key=lambda one: one.name)
    found = [column_map_of(one.read_text("utf-8"), one.name) for one in maps if one.name.endswith(".toml")]
    found = [replace(one.by("its layout"), is_shipped=True) for one in found]
    return tuple(sorted(found, key=lambda one: -len(one.signature)))
