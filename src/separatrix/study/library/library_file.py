"""Reader of library files: TOML whose every number has a unit, a source and a confidence."""

from __future__ import annotations

import hashlib
from pathlib import Path

from separatrix.ground import reader
from separatrix.ground.toml import label_of, read_text
from separatrix.study.library.records import KINDS, AnyRecord, Content, LibraryFile, Record


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
    sections = {kind: kind.replace(" ", "_") for kind in KINDS}
    return tuple(
        Record(kind=kind, name=name, content=content, file=file, place=loaded.sources[section, name].place)
        for kind, section in sections.items()
        for name, content in getattr(loaded.value, section).items()
    )
