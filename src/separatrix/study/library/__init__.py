"""Named materials, fluids and friction tables, each number with its source, conditions and confidence.

The shipped data are the TOML files in `data/`; libraries of the user have the same form
(docs/reference/materials.md). A `Library` has the shipped records, and over them those of the user's files.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TypeVar, cast

from separatrix.ground import reader
from separatrix.ground.errors import DataError, InputError
from separatrix.ground.toml import folded, label_of, path_text, read_text
from separatrix.ground.units import Kelvin, printable, shown
from separatrix.study.ball_bearing import ROOM, Expansion, Material
from separatrix.study.library.records import (
    KINDS,
    AnyRecord,
    Content,
    Fluid,
    FrictionTable,
    LibraryFile,
    Record,
    Solid,
    choose,
)

SHIPPED_FILES = {
    "bearing material": "bearing_materials.toml",
    "cage material": "cage_materials.toml",
    "film": "films.toml",
    "fluid": "fluids.toml",
    "friction table": "pin-on-disk-77K.toml",
}
"""Shipped file of each kind; each is read when it is first used."""

ALONE, FOLDER = "materials.toml", "materials"
"""Library beside a study, and folder beside it whose files are all read."""

MOST_FILES = 200
Records = Mapping[str, AnyRecord]
Wanted = TypeVar("Wanted", Solid, Fluid, FrictionTable)

WORDS = {
    "elastic_modulus": "modulus",
    "poisson_ratio": "Poisson's ratio",
    "density": "density",
    "compressive_strength": "compressive strength",
}
"""Properties of which one datum serves, in words; of the thermal expansion all serve, at any temperature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Library:
    """The shipped records and, over them, those of the user's files."""

    files: tuple[LibraryFile, ...] = ()
    """Files of the user."""

    own: Mapping[str, Records] = field(default_factory=dict)
    """Records of the user by kind and name."""

    def records(self, kind: str) -> Records:
        """Records of one kind by name, the shipped ones first."""
        return {**shipped_records(kind), **self.own.get(kind, {})}

    def names(self, kind: str) -> tuple[str, ...]:
        """Names of one kind, in the order of the files."""
        return tuple(self.records(kind))

    def material(self, kind: str, name: str, temperature: Kelvin | None = None) -> Material:
        """One solid by its exact name, with the data that serve at a temperature."""
        return as_material(self._found(Solid, kind, name), temperature)

    def friction_table(self, name: str) -> Record[FrictionTable]:
        """One table of measured friction by its exact name."""
        return self._found(FrictionTable, "friction table", name)

    def _found(self, wanted: type[Wanted], kind: str, name: str) -> Record[Wanted]:
        found = self.records(kind).get(name)
        if found is None or not isinstance(found.content, wanted):
            raise DataError(f'no {kind} "{printable(name)}"; the library has {", ".join(self.names(kind))}')
        return cast("Record[Wanted]", found)

    def named(self, kind: str, name: str) -> str | None:
        """Exact name of a record by its name or another name of it, in any spelling; None if unknown.

        Case of letters, spaces, hyphens and the like do not count.
        """
        records, wanted = self.records(kind), folded(name)
        if name in records:
            return name
        found = [known for known in records if folded(known) == wanted]
        found = found or [one.name for one in records.values() if wanted in map(folded, one.aliases)]
        return found[0] if wanted and len(found) == 1 else None

    def fluid(self, name: str) -> Record[Fluid] | None:
        """Record of a fluid by its name or another name of it, in any spelling; None if unknown."""
        known = self.named("fluid", name)
        return None if known is None else self._found(Fluid, "fluid", known)


def as_material(record: Record[Solid], temperature: Kelvin | None = None) -> Material:
    """Solid with the data of a record that serve at a temperature, and the whole record behind it."""
    solid, data = record.content, record.data
    chosen = {key: choose(data[key], temperature, words) for key, words in WORDS.items() if key in data}
    sources = [f"{WORDS[key]}: {choice.datum.source}" for key, choice in chosen.items()]
    confidences = [f"{WORDS[key]}: {choice.datum.confidence}" for key, choice in chosen.items()]
    composition = [f"Composition: {solid.composition}"] if solid.composition else []
    remark = [solid.remark.rstrip(".")] if solid.remark else []
    # numbers on which any answer depends
    acting = ("elastic_modulus", "poisson_ratio", *["density"] * (record.kind == "bearing material"))
    taken = {key: data[key].index(choice.datum) for key, choice in chosen.items()}
    expansions = (
        Expansion(*(d.temperature or (ROOM, ROOM)), d.value, d.confidence) for d in solid.thermal_expansion
    )
    return Material(
        name=record.name,
        expansions=tuple(sorted(expansions)),
        source=". ".join([*composition, *remark, *sources]),
        confidence=", ".join(confidences),
        record={**record.plain(), "taken": taken, "taken_at": temperature},
        cautions=tuple(one.caution for key, one in chosen.items() if one.caution and key in acting),
        **{key: choice.datum.value for key, choice in chosen.items()},
    )


def read_library(path: Path, *, shipped: bool = False) -> tuple[AnyRecord, ...]:
    """Records of a library file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: file, line, record, rule, value, cure.
    """
    return library_of_text(read_text(path, Content.FILE), label_of(path), shipped=shipped)


def library_of_text(text: str, label: str, *, shipped: bool = False) -> tuple[AnyRecord, ...]:
    """Records of the text of a library file."""
    loaded = reader.read_text(Content, text, label)
    file = LibraryFile(label=label, checksum=hashlib.sha256(text.encode()).hexdigest(), shipped=shipped)
    return tuple(
        Record(kind=kind, name=name, content=content, file=file, place=loaded.sources[section, name].place)
        for kind, section in ((kind, kind.replace(" ", "_")) for kind in KINDS)
        for name, content in getattr(loaded.value, section).items()
    )


def joined(contents: Sequence[Sequence[AnyRecord]]) -> Library:
    """Library of files of the user over the shipped records."""
    own: dict[str, dict[str, AnyRecord]] = {}
    for records in contents:
        for record in records:
            kind = own.setdefault(record.kind, {})
            _refuse_hiding(kind.get(record.name) or shipped_records(record.kind).get(record.name), record)
            kind[record.name] = record
    for name, of_kind in own.items():
        _refuse_alike({**shipped_records(name), **of_kind}.values())
    return Library(files=tuple(records[0].file for records in contents), own=own)


def _refuse_hiding(old: AnyRecord | None, new: AnyRecord) -> None:
    """Refuse a record that would replace another without stating so."""
    if old is None and new.content.replaces:
        rule = f"replaces a {new.kind} that is not shipped"
        raise InputError(_header(new), rule, cure="Leave replaces out, or correct the name.")
    if old is not None and not old.file.shipped:
        cure = "Rename or remove one of them."
        raise InputError(_header(new), f"is in {old.place} too", shown(new.name), cure)
    if old is not None and not new.content.replaces:
        cure = "Give it another name, or write replaces = true."
        raise InputError(_header(new), f"has the name of a shipped {new.kind}", shown(new.name), cure)


def _refuse_alike(records: Iterable[AnyRecord]) -> None:
    """Refuse a name that an earlier record has, but for capitals and spaces."""
    known: dict[str, AnyRecord] = {}
    for record in records:
        for name in (record.name, *record.aliases):
            old = known.setdefault(" ".join(name.casefold().split()), record)
            if old is not record:
                rule = f"has a name of {printable(old.name)} ({old.place})"
                raise InputError(_header(record), rule, shown(name), "Give it another name.")


def _header(record: AnyRecord) -> str:
    return f"{record.place}: [{record.kind.replace(' ', '_')}] {printable(record.name)}"


@cache
def shipped_records(kind: str) -> Records:
    """Records of one kind that come with the package, by name."""
    records = read_library(Path(__file__).with_name("data") / SHIPPED_FILES[kind], shipped=True)
    return {record.name: record for record in records}


def with_files(paths: Iterable[Path]) -> Library:
    """Shipped library with library files of the user."""
    return joined([read_library(path) for path in dict.fromkeys(path.resolve() for path in paths)])


def library_files(path: Path) -> list[Path]:
    """The file itself, or the TOML files of a folder, by name; hidden ones are left out."""
    if not path.is_dir():
        return [path]
    try:
        names = sorted(file.name for file in path.iterdir())
    except OSError as error:
        raise InputError(path_text(path), f"cannot be read ({error.strerror})") from None
    found = [path / name for name in names if name.endswith(".toml") and not name.startswith(".")]
    if len(found) > MOST_FILES:
        raise InputError(path_text(path), f"has more than {MOST_FILES} library files")
    return found


def beside(folder: Path, besides: Path | None = None) -> list[Path]:
    """Library files in a folder: `materials.toml`, and those of a folder `materials`."""
    alone, several = folder / ALONE, folder / FOLDER
    found = [alone] if alone.is_file() else []
    found += library_files(several) if several.is_dir() else []
    return [path for path in found if besides is None or path.resolve() != besides.resolve()]
