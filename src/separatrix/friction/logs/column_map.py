"""A column map: a small TOML file with what a log does not state (docs/reference/tribometer-logs.md)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from pathlib import Path, PurePosixPath

from separatrix.friction.file import place
from separatrix.friction.logs.dialect import ENCODINGS, SEPARATORS
from separatrix.friction.logs.names import MEANINGS, known_units, scale_of, torque_scale
from separatrix.ground import units
from separatrix.ground.errors import InputError
from separatrix.ground.toml import Kind, build, quantity, read_toml
from separatrix.ground.units import printable, shown

KIND = Kind(noun="a column map", empty='Write for instance [columns], and below it: friction = "COF".')
MOST = 1_000_000_000  # number of a column or a line, at most

QUANTITIES = {
    "temperature": "K",
    "slip_speed": "m/s",
    "pressure": "Pa",
    "normal_force": "N",
    "cycle_time": "s",
    "contact_area": "m2",
    "pin_diameter": "m",
    "track_radius": "m",
    "rotational_speed": "rad/s",
}
"""Conditions that are a number with a unit."""

TEXTS = ("material", "counterface", "medium", "sample", "test")  # conditions that are words
RUN_IN_END = "run_in_end"  # where running-in ends: not a condition, but stated with them
_AREAS = {"m2": 1.0, "cm2": 1e-4, "mm2": 1e-6}
_DECIMALS = {".": ".", ",": ",", "point": ".", "comma": ","}


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnChoice:
    """One line of `[columns]`: which column, by its name or its number from 1, and its unit."""

    name: str | None = None
    number: int | None = None
    unit: str | None = None
    sign: int = 1  # -1 where compression counts negative


@dataclass(frozen=True, slots=True, kw_only=True)
class TextFormat:
    """`[format]`: how the text is written; None where that is detected."""

    separator: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    header_line: int | None = None
    units_line: int | None = None
    missing: frozenset[str] = frozenset()
    """Texts that mean a missing value besides `MISSING`, in small letters."""
    tables: tuple[str, ...] = ()  # names of the tables (sheets, steps) to read; all of them if empty

    @property
    def begin(self) -> int:
        """Lines above the rows, where the line of the header is given."""
        return max(self.header_line or 0, self.units_line or 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnMap:
    """What a user states about the files: columns, text format, conditions for all and by file pattern."""

    columns: Mapping[str, ColumnChoice] = field(default_factory=dict)
    format: TextFormat = field(default_factory=TextFormat)
    test: Mapping[str, str | float] = field(default_factory=dict)
    """Conditions in SI units, by the keys of `QUANTITIES` and `TEXTS`, and `RUN_IN_END` as written."""
    files: Mapping[str, Mapping[str, str | float]] = field(default_factory=dict)
    source: str = ""

    def conditions(self, path: Path) -> dict[str, str | float]:
        """Conditions of one file, in SI units: `[test]`, then every matching pattern in the order written."""
        found = self._stated(path)
        found.pop(RUN_IN_END, None)
        return found

    def run_in_end(self, path: Path) -> str | None:
        """Where running-in ends in one file; None to find it."""
        found = self._stated(path).get(RUN_IN_END)
        return None if found is None else str(found)

    def _stated(self, path: Path) -> dict[str, str | float]:
        found = dict(self.test)
        for pattern, given in self.files.items():
            found |= given if _fits(path, pattern) else {}
        return found

    def unused(self, paths: Iterable[Path]) -> list[InputError]:
        """What is wrong with each pattern that fits none of the files."""
        files = list(paths)
        names = ", ".join(printable(path.name, 60) for path in files[:3])
        names += f" and {len(files) - 3} more" if len(files) > 3 else ""
        rule, cure = "must fit a file that is named", "Mend it, or leave it out of this column map."
        idle = [pattern for pattern in self.files if not any(_fits(path, pattern) for path in files)]
        return [InputError(_section(self.source, pattern), rule, names, cure) for pattern in idle]


def _fits(path: Path, pattern: str) -> bool:
    """Whether a pattern is one of the file's name, or of the names of its last folders, too."""
    return PurePosixPath(path.absolute().as_posix()).match(pattern)


def _section(source: str, pattern: str) -> str:
    return f'{source}: [files."{printable(pattern)}"]'


def read_column_map(path: str | Path) -> ColumnMap:
    """Column map of a TOML file.

    Raises
    ------
    InputError
        The file, section and key that is wrong, and how to write it.
    """
    path = Path(path)
    document, _ = read_toml(path, KIND)
    return column_map(document, printable(path.name or str(path), 100))


def column_map(document: Mapping[str, object], source: str = "column map") -> ColumnMap:
    """Column map of a parsed TOML document."""
    sections = ("columns", "format", "test", "files")
    _known(document, sections, source, "section")
    parts = {key: _table(document.get(key, {}), f"{source}: [{key}]") for key in sections}
    where = f"{source}: [columns]"
    _known(parts["columns"], tuple(MEANINGS), where, "column")
    files = {}
    for pattern, given in parts["files"].items():
        section = _section(source, pattern)
        if not PurePosixPath(pattern).name:
            raise InputError(section, "must be a pattern of names of files", cure='Write "peek_*.csv".')
        files[pattern] = _conditions(_table(given, section), section)
    return ColumnMap(
        columns={name: _choice(name, value, f"{where} {name}") for name, value in parts["columns"].items()},
        format=_format(parts["format"], f"{source}: [format]"),
        test=_conditions(parts["test"], f"{source}: [test]"),
        files=files,
        source=source,
    )


def _known(given: Mapping[str, object], names: tuple[str, ...], where: str, kind: str) -> None:
    for name in given:
        if name not in names:
            near = get_close_matches(name, names, 1, 0.6)
            cure = f'Did you mean "{near[0]}"?' if near else f"There are {', '.join(names)}."
            raise InputError(where, f"has no {kind} of that name", shown(name), cure)


def _table(value: object, where: str) -> Mapping[str, object]:
    if not isinstance(value, dict):
        raise InputError(where, "must be a section of the file", shown(value))
    return value


def _fits_meaning(unit: str, meaning: str) -> bool:
    """Whether a column of that meaning may have the unit; a torque becomes a tangential force."""
    is_torque = meaning == "tangential_force" and torque_scale(unit) is not None
    return is_torque or scale_of(unit, meaning) is not None


def _choice(meaning: str, value: object, where: str) -> ColumnChoice:
    table = value if isinstance(value, dict) else {"name": value}
    _known(table, ("name", "unit", "sign"), where, "key")
    name, unit, sign = table.get("name"), table.get("unit"), table.get("sign", 1)
    if isinstance(name, bool) or not isinstance(name, (str, int)) or name == "":
        got = "" if name is None else shown(name)
        cure = f'Write {meaning} = "Fz", or {meaning} = {{ name = "Fz", unit = "N" }}.'
        raise InputError(where, "must be the name or the number of a column", got, cure)
    if isinstance(name, int) and not 1 <= name <= MOST:
        raise InputError(where, "must be the number of a column, counted from 1", shown(name))
    if sign not in (1, -1) or isinstance(sign, bool):
        raise InputError(f"{where} sign", "must be 1 or -1", shown(sign))
    if unit is not None and not (isinstance(unit, str) and _fits_meaning(unit, meaning)):
        raise InputError(f"{where} unit", f"must be a unit such as {known_units(meaning)}", shown(unit))
    if isinstance(name, str):
        return ColumnChoice(name=name, unit=unit, sign=sign)
    return ColumnChoice(number=name, unit=unit, sign=sign)


def _format(given: Mapping[str, object], where: str) -> TextFormat:
    _known(given, tuple(f.name for f in fields(TextFormat)), where, "key")
    options = {"separator": SEPARATORS, "decimal": _DECIMALS, "encoding": {name: name for name in ENCODINGS}}
    found: dict[str, object] = {}
    for key, value in given.items():
        if key in options:
            if not isinstance(value, str) or value not in options[key]:
                names = [f'"{name}"' for name in options[key] if name.isprintable() and name.strip()]
                raise InputError(f"{where} {key}", f"must be one of {', '.join(names)}", shown(value))
            found[key] = options[key][value]
        elif key in ("header_line", "units_line"):
            if type(value) is not int or not 1 <= value <= MOST:
                rule = "must be the number of a line, counted from 1"
                raise InputError(f"{where} {key}", rule, shown(value))
            found[key] = value
        elif not isinstance(value, list) or not all(isinstance(text, str) for text in value):
            raise InputError(f"{where} {key}", "must be a list of texts", cure=f'Write {key} = ["..."].')
        elif key == "tables":
            found[key] = tuple(value)
        else:
            found[key] = frozenset(text.casefold() for text in value)
    if found.get("separator") == found.get("decimal") == ",":
        raise InputError(where, "cannot have a comma both as separator and as decimal sign")
    if found.get("units_line") and not found.get("header_line"):
        raise InputError(f"{where} units_line", "needs a header_line, too")
    return build(TextFormat, found, where)


def _conditions(given: Mapping[str, object], where: str) -> dict[str, str | float]:
    _known(given, (*TEXTS, *QUANTITIES, RUN_IN_END), where, "condition")
    return {key: _condition(key, value, f"{where} {key}") for key, value in given.items()}


def _condition(key: str, value: object, where: str) -> str | float:
    if key in TEXTS:
        if not isinstance(value, str) or not 0 < len(value) <= 200 or not value.isprintable():
            raise InputError(where, "must be printable text of 1 to 200 characters", shown(value))
        return value
    if key == RUN_IN_END:
        place(value, where)
        return str(value)
    if key == "contact_area":  # no study has one, so its units are here
        text = value if isinstance(value, str) else ""
        written, _, unit = text.strip().replace("\u00b2", "2").replace("^", "").partition(" ")
        if unit.strip() not in _AREAS:
            rule = f"needs a unit of area ({', '.join(_AREAS)})"
            raise InputError(where, rule, shown(value), 'Write "3 mm2".')
        number = units.parse(f"{written} m", "m", where) * _AREAS[unit.strip()]
    else:
        number = quantity(QUANTITIES[key])(value, where)
    if number <= 0.0:
        raise InputError(where, "must be > 0", shown(value))
    return number
