"""Named materials, fluids and friction tables, each number with its source, conditions and confidence.

The shipped data are the TOML files in `data/`; libraries of the user have the same form
(docs/reference/materials.md). The functions here read the shipped ones; a study has its own `Library`.
"""

from __future__ import annotations

from separatrix.library.collection import (
    Library,
    as_material,
    beside,
    joined,
    library_files,
    with_files,
)
from separatrix.library.reading import Content, library_of_text, read_library
from separatrix.library.records import KINDS, Choice, Datum, FrictionTable, LibraryFile, Record, choose
from separatrix.library.writing import add_records

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
    "beside",
    "choose",
    "joined",
    "library_files",
    "library_of_text",
    "names",
    "read_library",
    "with_files",
]


def names(kind: str) -> tuple[str, ...]:
    """Names of the shipped records of one kind, a member of `KINDS`."""
    return Library().names(kind)
