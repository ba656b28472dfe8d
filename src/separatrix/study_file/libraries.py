"""Which library a study reads: the shipped one, and files beside the study or named by its key `library`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from separatrix.errors import InputError
from separatrix.library import Library, beside, library_files, with_files
from separatrix.study_file.document import Document, Entry, LibraryPlace
from separatrix.study_file.shipped import shipped_studies
from separatrix.units import shown

MOST_NAMED = 20


def library_of(document: Document) -> Library:
    """Library of a study: what is shipped, stands beside its files, or is named in them.

    Raises
    ------
    InputError
        A library is missing or wrong, or two of them hold the same name.
    """
    paths = [path for place in document.libraries for path in _files(place)]
    return with_files(paths)


def used_records(library: Library, document: Document) -> dict[str, Any]:
    """Whole records of what a study names and what is no material: its fluid, its friction table."""
    records: dict[str, Any] = {}
    fluid = document.sections.get("operation", {}).get("fluid")
    known = library.fluid(fluid.value) if fluid is not None and isinstance(fluid.value, str) else None
    if known is not None:
        records["operation.fluid"] = known.plain()
    table = document.sections.get("ranking", {}).get("friction")
    if table is not None and table.value in library.names("friction table"):
        records["ranking.friction"] = library.friction_table(table.value).plain()
    return records


def _files(place: LibraryPlace) -> Iterator[Path]:
    if place.study not in shipped_studies().values():
        yield from beside(place.study.parent, besides=place.study)
    if place.given is not None:
        yield from _named(place.study.parent, place.given)


def _named(folder: Path, given: Entry) -> Iterator[Path]:
    where = f"{given.place}: library"
    names = given.value if isinstance(given.value, list) else [given.value]
    if not 0 < len(names) <= MOST_NAMED:
        raise InputError(where, f"must be one path or a list of 1 to {MOST_NAMED}", shown(given.value))
    for name in names:
        yield from _existing(folder, name, where)


def _existing(folder: Path, name: Any, where: str) -> list[Path]:
    if not isinstance(name, str) or not name or not name.isprintable():
        raise InputError(where, "must be the path of a file or a folder, in quotes", shown(name))
    path = folder / name
    try:
        found = library_files(path) if path.exists() else None
    except OSError:  # a name too long for the file system
        found = None
    if found is None:
        cure = "It is taken from the folder of the study."
        raise InputError(where, "names no file or folder", shown(name), cure)
    if not found:
        raise InputError(where, "names a folder without a .toml file", shown(name))
    return found
