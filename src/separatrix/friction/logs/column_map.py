"""A column map: a TOML file with what logs of one layout do not state (docs/reference/tribometer-logs.md)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from difflib import get_close_matches
from functools import cache
from importlib.resources import files as files_of
from pathlib import Path, PurePosixPath

from separatrix.friction.file import place
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS, SHAPES, known_units, scale_of
from separatrix.ground import units
from separatrix.ground.errors import InputError
from separatrix.ground.toml import Kind, build, parsed, quantity, read_toml, truth
from separatrix.ground.toml import text as text_of
from separatrix.ground.units import printable, shown

KIND = Kind(noun="a column map", empty='Write for instance [columns], and below it: friction = "COF".')
MOST = 1_000_000_000  # number of a column or a line, at most
SEPARATORS = {"tab": "\t", "\t": "\t", ";": ";", ",": ",", "|": "|", "blanks": " ", " ": " "}
"""What `[format] separator` may be, and the character meant."""

ENCODINGS = ("utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp1250", "cp932", "gbk")
"""What `[format] encoding` may be."""

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
    """One line of `[columns]`: which column, by one of its names or its number from 1, and its unit."""

    names: tuple[str, ...] = ()
    number: int | None = None
    unit: str | None = None  # None: as the file states it
    sign: int = 1  # -1 where compression counts negative
    optional: bool = False  # in the map of a layout whose files do not all have it
    origin: str = "column map"  # who states it


@dataclass(frozen=True, slots=True, kw_only=True)
class TextFormat:
    """`[format]`: how the table is written; None where the file shows it."""

    separator: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    header_line: int | None = None
    units_line: int | None = None
    units_below: bool = False  # the line below the names is that of the units
    missing: tuple[str, ...] = ()  # texts that mean a missing value, besides the usual ones
    tables: tuple[str, ...] = ()  # names of the tables (sheets, steps) to read; all of them if empty
    skip: tuple[str, ...] = ()  # beginnings of lines among the rows that are not rows
    ends: tuple[str, ...] = ()  # beginnings of lines behind which there are no rows
    tests: tuple[str, ...] = ()  # of these columns the first that is there: its change begins another test
    series: tuple[str, ...] = ()  # patterns of lines above a table, whose groups all parts of a test share
    spellings: Mapping[str, str] = field(default_factory=dict)  # what the layout means by a unit: g = "gf"


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnMap:
    """What is stated about files: their columns, text format, conditions for all and by file pattern."""

    name: str = "column map"
    signature: tuple[str, ...] = ()  # texts that the beginning of each file of a shipped layout has
    columns: Mapping[str, ColumnChoice] = field(default_factory=dict)
    format: TextFormat = field(default_factory=TextFormat)
    test: Mapping[str, str | float] = field(default_factory=dict)
    """Conditions in SI units, by the keys of `QUANTITIES` and `TEXTS`, and `RUN_IN_END` as written."""
    files: Mapping[str, Mapping[str, str | float]] = field(default_factory=dict)
    stated: Mapping[str, object] = field(default_factory=dict)
    """`[test]` and `[files]` as written, for a draft."""
    source: str = ""
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
        own = {f.name: value for f in fields(TextFormat) if (value := getattr(self.format, f.name))}
        form = replace(base.format, **own)
        return replace(self, columns={**columns, **self.columns}, format=form, name=base.name)

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
    _known(document, (*sections, "name", "signature"), source, "section")
    parts = {key: _table(document.get(key, {}), f"{source}: [{key}]") for key in sections}
    where = f"{source}: [columns]"
    _known(parts["columns"], (*MEANINGS, *SHAPES), where, "column")
    files = {}
    for pattern, given in parts["files"].items():
        section = _section(source, pattern)
        if not PurePosixPath(pattern).name:
            raise InputError(section, "must be a pattern of names of files", cure='Write "peek_*.csv".')
        files[pattern] = _conditions(_table(given, section), section)
    return ColumnMap(
        name=text_of(document.get("name", "column map"), f"{source}: name"),
        signature=_texts(document.get("signature", []), f"{source}: signature"),
        columns={name: _choice(name, value, f"{where} {name}") for name, value in parts["columns"].items()},
        format=_format(parts["format"], f"{source}: [format]"),
        test=_conditions(parts["test"], f"{source}: [test]"),
        files=files,
        stated={key: parts[key] for key in ("test", "files") if parts[key]},
        source=source,
    )


@cache
def shipped_maps() -> tuple[ColumnMap, ...]:
    """Maps of known layouts; one with a longer signature goes before a shorter."""
    found = []
    for one in sorted(files_of(__package__).joinpath("maps").iterdir(), key=lambda one: one.name):
        if one.name.endswith(".toml"):
            document, _ = parsed(one.read_text("utf-8"), one.name, KIND)
            found.append(replace(column_map(document, one.name).by("its layout"), is_shipped=True))
    return tuple(sorted(found, key=lambda one: -len(one.signature)))


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


def _texts(value: object, where: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(one, str) for one in value):
        raise InputError(where, "must be a list of texts", cure=f'Write {where.split()[-1]} = ["..."].')
    return tuple(value)


def _choice(meaning: str, value: object, where: str) -> ColumnChoice:
    table = value if isinstance(value, dict) else {"name": value}
    _known(table, ("name", "unit", "sign", "optional"), where, "key")
    name, unit, sign = table.get("name"), table.get("unit"), table.get("sign", 1)
    names = name if isinstance(name, list) and name else [name]
    number = name if isinstance(name, int) and not isinstance(name, bool) else None
    if number is None and not all(isinstance(one, str) and one.strip() for one in names):
        got = "" if name is None else shown(name)
        cure = f'Write {meaning} = "Fz", or {meaning} = {{ name = "Fz", unit = "N" }}.'
        raise InputError(where, "must be the name or the number of a column", got, cure)
    if number is not None and not 1 <= number <= MOST:
        raise InputError(where, "must be the number of a column, counted from 1", shown(name))
    if sign not in (1, -1) or isinstance(sign, bool):
        raise InputError(f"{where} sign", "must be 1 or -1", shown(sign))
    if unit is not None and not (isinstance(unit, str) and scale_of(unit, meaning) is not None):
        cure = "The draft asks for it: write the true one." if unit == "..." else ""
        raise InputError(f"{where} unit", f"must be a unit such as {known_units(meaning)}", shown(unit), cure)
    return ColumnChoice(
        names=() if number is not None else tuple(map(str, names)),
        number=number,
        unit=unit,
        sign=sign,
        optional=truth(table.get("optional", False), f"{where} optional"),
    )


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
        elif key == "units_below":
            found[key] = truth(value, f"{where} {key}")
        elif key == "spellings":
            table = _table(value, f"{where} {key}")
            found[key] = {name: text_of(unit, f"{where} {key} {name}") for name, unit in table.items()}
        else:
            found[key] = _texts(value, f"{where} {key}")
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
