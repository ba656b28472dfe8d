"""Strict reader of library files: TOML whose every number has a unit, a source and a confidence."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from separatrix.errors import InputError, together
from separatrix.library.materials import material
from separatrix.library.records import KINDS, FrictionTable, LibraryFile, Record
from separatrix.library.tables import friction_table
from separatrix.library.words import long_text
from separatrix.toml_text import Kind, label_of, parsed, read_text
from separatrix.toml_values import nearest, text
from separatrix.units import printable, shown

LIBRARY = Kind(
    noun="a library of materials",
    most_bytes=1024 * 1024,
    empty="`separatrix materials show 440C` shows what a record holds.",
)
SECTIONS = {kind.replace(" ", "_"): kind for kind in KINDS}
"""Section of a file -> kind of its records."""

MOST_RECORDS = 2000
MOST_PROBLEMS = 100
TOP = ("title",)


@dataclass(frozen=True, slots=True, kw_only=True)
class Content:
    """What a library file holds."""

    file: LibraryFile
    records: tuple[Record | FrictionTable, ...]


def read_library(path: Path) -> Content:
    """Records of a library file.

    Raises
    ------
    InputError
        Everything that is wrong, on one line: file, line, record, rule, value, cure.
    """
    return library_of_text(read_text(path, LIBRARY), label_of(path))


def library_of_text(given: str, label: str) -> Content:
    """Records of the text of a library file."""
    data, lines = parsed(given, label, LIBRARY)
    return _Reading(_file(given, label, shipped=False), lines).content(data)


def _file(given: str, label: str, *, shipped: bool) -> LibraryFile:
    checksum = hashlib.sha256(given.encode()).hexdigest()
    return LibraryFile(label=label, checksum=checksum, shipped=shipped)


class Shipped(Mapping[str, Record | FrictionTable]):
    """Records of a shipped file, of one kind, by name; each is read when asked for, as a study needs few.

    Raises
    ------
    InputError
        A record is wrong, when it is asked for.
    """

    def __init__(self, path: Path) -> None:
        given = read_text(path, LIBRARY)
        data, lines = parsed(given, label_of(path), LIBRARY)
        self._reading = _Reading(_file(given, label_of(path), shipped=True), lines)
        ((self._section, self._items),) = data.items()
        self._read: dict[str, Record | FrictionTable] = {}

    def __getitem__(self, name: str) -> Record | FrictionTable:
        if name not in self._read:
            self._read[name] = self._reading.record(self._section, name, self._items[name])
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)


class _Reading:
    """One file being read: what is wrong is collected with its place."""

    def __init__(self, file: LibraryFile, lines: Mapping[str, int]) -> None:
        self.file, self.lines = file, lines
        self.problems: list[InputError] = []

    def content(self, data: Mapping[str, Any]) -> Content:
        """Read every section; refuse with everything wrong."""
        records = []
        for section, value in data.items():
            if section in TOP:
                self.attempt(long_text, value, f"{self.place(section)}: {section}")
            else:
                records += self.section(section, value)
        if not records and not self.problems:
            rule = (
                f"holds no record: it needs a section such as [cage_material.{chr(34)}My compound{chr(34)}]"
            )
            self.problems.append(InputError(self.file.label, rule))
        if self.problems:
            raise together(self.problems)
        return Content(file=self.file, records=tuple(records))

    def section(self, section: str, value: Any) -> list[Record | FrictionTable]:
        """Read the records of one kind."""
        where = f"{self.place(section, *self.first_below(section))}: [{printable(section)}]"
        if section not in SECTIONS or not isinstance(value, dict):
            rule = (
                "is no kind of record" if section not in SECTIONS else "must hold records, each with its name"
            )
            cure = nearest(section, SECTIONS) if section not in SECTIONS else ""
            self.problems.append(
                InputError(where, rule, "" if section not in SECTIONS else shown(value), cure)
            )
            return []
        if len(value) > MOST_RECORDS:
            self.problems.append(InputError(where, f"holds more than {MOST_RECORDS} records"))
            return []
        read = (
            self.attempt(self.record, section, name, item)
            for name, item in value.items()
            if len(self.problems) <= MOST_PROBLEMS
        )
        return [record for record in read if record is not None]

    def record(self, section: str, name: str, item: Any) -> Record | FrictionTable:
        """Read one record."""
        key = f"{section}.{name}"
        line = self.lines.get(key)
        at = f"{self.place(key, section)}: [{section}] {printable(name)}"
        if text(name, f"{at}, its name,") != name.strip():
            raise InputError(f"{at}, its name,", "must not begin or end with a space", shown(name))
        if not isinstance(item, dict):
            raise InputError(at, "must be a record: keys with values", shown(item))
        common = {"name": name, "file": self.file, "line": line}
        places = {field: self.place(f"{key}.{field}", key, section) for field in item}
        if section == "friction_table":
            return friction_table(item, at, common)
        return material(SECTIONS[section], item, at, common, places)

    def attempt(self, make: Callable[..., Any], *args: Any) -> Any:
        """What `make` returns, or None with its refusals noted."""
        try:
            return make(*args)
        except InputError as error:
            self.problems.extend(error.problems or (error,))
        return None

    def first_below(self, section: str) -> list[str]:
        """The first dotted key inside a section that has no header of its own."""
        return [key for key in self.lines if key.startswith(f"{section}.")][:1]

    def place(self, *keys: str) -> str:
        """File and line of the first of the dotted keys that has a line of its own."""
        line = next((self.lines[key] for key in keys if key in self.lines), None)
        return self.file.label if line is None else f"{self.file.label}, line {line}"
