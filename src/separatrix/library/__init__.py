"""Named materials, fluids and friction tables, each number with its source, conditions and confidence.

The shipped data are the TOML files in `data/`; libraries of the user have the same form
(docs/materials.md). The functions here answer from the shipped ones; a study asks its own `Library`.
"""

from __future__ import annotations

from separatrix.library.collection import (
    Library,
    as_material,
    beside,
    joined,
    library_files,
    shipped,
    with_files,
)
from separatrix.library.reading import Content, library_of_text, read_library
from separatrix.library.records import KINDS, Choice, Datum, FrictionTable, LibraryFile, Record, choose
from separatrix.library.writing import add_records
from separatrix.study import Material

__all__ = [
    "KINDS",
    "Choice",
    "Content",
    "Datum",
    "FrictionTable",
    "Library",
    "LibraryFile",
    "Record",
    "add_records",
    "as_material",
    "bearing_material",
    "beside",
    "cage_material",
    "choose",
    "film_material",
    "friction_table",
    "joined",
    "library_files",
    "library_of_text",
    "material",
    "names",
    "read_library",
    "shipped",
    "with_files",
]


def names(kind: str) -> tuple[str, ...]:
    """Names of the shipped records of one kind, a member of `KINDS`."""
    return shipped().names(kind)


def material(kind: str, name: str) -> Material:
    """One shipped material by its exact name.

    Raises
    ------
    DataError
        The library has no material of that name.
    """
    return shipped().material(kind, name)


def bearing_material(name: str) -> Material:
    """A material of balls and rings."""
    return material("bearing material", name)


def film_material(name: str) -> Material:
    """A solid lubricant film."""
    return material("film", name)


def cage_material(name: str) -> Material:
    """A cage material."""
    return material("cage material", name)


def friction_table(name: str) -> FrictionTable:
    """One shipped table of measured friction by its exact name.

    Raises
    ------
    DataError
        The library has no table of that name.
    """
    return shipped().friction_table(name)
