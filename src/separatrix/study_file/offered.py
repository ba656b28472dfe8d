"""Names that a study may use, for the pick-lists of a form: of its library and of its friction tests."""

from __future__ import annotations

from dataclasses import dataclass

from separatrix.errors import DataError, InputError
from separatrix.input_files import place
from separatrix.library import Library
from separatrix.study_file.document import Document, library_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Offered:
    """Names for the candidates of a study; empty where nothing can be offered."""

    cage_materials: tuple[str, ...] = ()
    """Of the library of the study."""

    environments: tuple[str, ...] = ()
    """Those of the friction tables of the library."""

    tested: tuple[str, ...] = ()
    """Materials of what [ranking] friction names, a table of the library or a file."""


NOTHING = Offered()


def offered_by(document: Document) -> Offered:
    """Return the names that a study may use; none if its library cannot be read."""
    try:
        library = library_of(document)
    except InputError:  # refused where the study is read
        return NOTHING
    tables = [library.friction_table(name) for name in library.names("friction table")]
    return Offered(
        cage_materials=library.names("cage material"),
        environments=tuple(dict.fromkeys(env for one in tables for env in one.environments)),
        tested=_tested(document, library),
    )


def _tested(document: Document, library: Library) -> tuple[str, ...]:
    """Materials of what [ranking] friction names; a file that cannot be read has none."""
    name = document.sections.get("ranking", {}).get("friction")
    if not isinstance(name, str):
        return ()
    try:
        if not name.endswith(".toml"):
            return tuple(library.friction_table(library.named("friction table", name) or name).friction)
        from separatrix.friction.file import read_friction

        tests = read_friction(place(document.friction_folder, name))
        return tuple(dict.fromkeys(test.material for test in tests))
    except (DataError, InputError):  # refused where the study is read
        return ()
