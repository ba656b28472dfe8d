"""A study document: its sections key by key, each with its place, after `extends` has been followed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

from separatrix.distribution import Distribution
from separatrix.errors import InputError, together
from separatrix.library import Library, beside, library_files, with_files
from separatrix.toml_text import Places, label_of, path_text, places_of, read_toml
from separatrix.toml_values import folded, nearest
from separatrix.units import printable, shown

SECTIONS = ("bearing", "operation", "kinematics", "film", "cage", "stability", "ranking")
MOST_BASES = 8
MOST_NAMED = 20
"""Libraries that the key `library` may name."""

WORKBOOK_ENDINGS = (".xlsx", ".xlsm", ".xltx", ".xls", ".xlsb", ".ods")
WORKBOOK_MAGICS = (b"PK\x03\x04", b"PK\x05\x06", b"\xd0\xcf\x11\xe0")
MOST_PROBLEMS = 100
"""After so many mistakes a file is read no further."""

_ALTERNATIVES = {
    "bearing": (("contact_angle",), ("radial_clearance",)),
    "operation": (("moment",), ("tilt",)),
    "cage": (("pocket_angles",), ("pocket_spacing_scatter",)),
    "film": (("material",), ("elastic_modulus", "poisson_ratio")),
    "ranking": (("friction", "materials"), ("candidates",)),
}
"""Keys that exclude each other: a variant that gives one side drops the other side of its base."""

TOP = ("title", "extends", "library")
"""Keys before the first section."""

_OUTSIDE = "Before the first [section] there are only title, extends and library; move it into its section."
_LAND_KEYS = (
    *("land_clearance", "land_friction", "land_stiffness", "land_restitution"),
    *("land_count", "land_out_of_round", "land_lobes"),
)
_MEANINGLESS = {
    ("guidance", "ball"): _LAND_KEYS,
    ("pocket_shape", "square"): ("pocket_axial_clearance", "pocket_axial_offset"),
    ("pocket_shape", "cylindrical"): ("pocket_axial_clearance",),
}
"""A choice in [cage] and the keys of the base that a variant with this choice drops."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One value as the file gives it, or why it has none; and the folder of the file."""

    value: Any
    folder: Path = Path()


@dataclass(frozen=True, slots=True)
class LibraryPlace:
    """A study file of the chain, whose neighbours and whose key `library` give the libraries."""

    study: Path
    given: Entry | None


@dataclass(slots=True)
class Document:
    """Sections of a study, from a text file or a workbook, before anything is converted.

    What is wrong is noted under the path of its key, ``[cage] mass`` or ``[ranking] candidates[2].name``;
    `locate` places it.
    """

    label: str
    top: dict[str, Entry] = field(default_factory=dict)
    sections: dict[str, dict[str, Entry]] = field(default_factory=dict)
    places: Places = field(default_factory=lambda: Places(""))
    problems: list[InputError] = field(default_factory=list)
    distributions: dict[str, Distribution] = field(default_factory=dict)
    """Of the uncertain numbers, by their names, as they are read."""

    libraries: list[LibraryPlace] = field(default_factory=list)
    folder: Path = Path()

    def locate(self, path: str) -> str:
        """Return a path with its place; one of another file as it is."""
        own = not path or path.startswith("[") or path in TOP
        return self.places.locate(path) if own else path

    def refusal(self) -> InputError:
        """Everything that is wrong, each fault in its place."""
        return together([problem.at(self.locate(problem.path)) for problem in self.problems])


@cache
def shipped_studies() -> dict[str, Path]:
    """Path of each shipped example by its name."""
    folder = Path(__file__).parents[1] / "examples"
    return {path.stem: path for path in sorted(folder.iterdir()) if path.suffix == ".toml"}


def find(study: str | Path) -> Path:
    """Path of a study file, or of the shipped example of that name.

    A regular file of that very name comes first; a folder does not hide a shipped example.
    """
    text = str(study)
    path = Path(text)
    shipped = shipped_studies()
    if not text or "\0" in text:
        raise InputError("STUDY", "must be a path or a name", shown(text), _shipped_names(text))
    if _is_file(path):
        return path
    if text in shipped:
        return shipped[text]
    if not _exists(path):
        raise InputError(path_text(path), "does not exist", cure=_shipped_names(text))
    return path


def load(path: Path, above: tuple[Path, ...] = ()) -> Document:
    """Document of a file, merged over the file it extends."""
    document = _own(path)
    base = document.top.get("extends")
    if base is None:
        return document
    where = document.locate("extends")
    if not isinstance(base.value, str):
        raise InputError(where, "must be a path or the name of a shipped example", shown(base.value))
    target = path.parent / base.value if base.value and "\0" not in base.value else None
    if target is None or not _is_file(target):
        target = shipped_studies().get(base.value)
    if target is None:
        rule = "does not name a file beside this one"
        raise InputError(where, rule, shown(base.value), _shipped_names(base.value))
    chain = (*above, path.resolve())
    if target.resolve() in chain:
        raise InputError(where, "leads back to a file that extends this one", shown(base.value))
    if len(chain) > MOST_BASES:
        raise InputError(where, f"makes a chain of more than {MOST_BASES} files", shown(base.value))
    return _merged(load(target, chain), document)


def is_workbook(path: Path) -> bool:
    """Whether a file is a workbook, by its name or its first bytes."""
    try:
        if not path.is_file():  # a pipe may never end
            return False
        if path.suffix.casefold() in WORKBOOK_ENDINGS:
            return True
        with path.open("rb") as file:
            return file.read(4) in WORKBOOK_MAGICS
    except (OSError, ValueError):
        return False


def _own(path: Path) -> Document:
    if is_workbook(path):
        from separatrix.study_file.workbook import document_of

        return document_of(path)
    data, lines = read_toml(path)
    document = Document(label_of(path), folder=path.parent)
    document.places = places_of(document.label, data, lines)
    for name, value in data.items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        at = f"[{printable(name)}]"
        if name in TOP:
            document.top[name] = Entry(value, document.folder)
        elif name in SECTIONS:
            document.sections[name] = {}
            if isinstance(value, dict):
                document.sections[name] = {key: Entry(item, document.folder) for key, item in value.items()}
            else:
                rule = f"must be one section, headed [{name}]"
                document.problems.append(InputError(at, rule, shown(value)))
        elif isinstance(value, dict):
            cure = nearest(name, SECTIONS)
            document.problems.append(InputError(at, "is not a section of a study", cure=cure))
        else:
            where = f"{document.places.of(name)}: {printable(name) or chr(34) * 2}"
            document.problems.append(InputError(where, "is outside a section", cure=_OUTSIDE))
    document.libraries.append(LibraryPlace(path, document.top.get("library")))
    return document


def _merged(base: Document, document: Document) -> Document:
    merged = Document(
        document.label,
        {"title": base.top["title"], **document.top} if "title" in base.top else document.top,
        places=Places(document.label, base.places.known | document.places.known),
        problems=base.problems + document.problems,
        libraries=document.libraries + base.libraries,
        folder=document.folder,
    )
    for name in SECTIONS:
        below, above = base.sections.get(name), document.sections.get(name)
        if below is not None or above is not None:
            merged.sections[name] = {**_kept(name, below or {}, above or {}), **(above or {})}
    return merged


def _kept(name: str, below: dict[str, Entry], above: dict[str, Entry]) -> dict[str, Entry]:
    """Keys of the base that the variant does not replace by an alternative."""
    dropped: set[str] = set()
    one, other = _ALTERNATIVES.get(name, ((), ()))
    if any(key in above for key in one):
        dropped.update(other)
    if any(key in above for key in other):
        dropped.update(one)
    for (key, choice), keys in _MEANINGLESS.items() if name == "cage" else ():
        if key in above and folded(str(above[key].value)) == choice:
            dropped.update(keys)
    return {key: entry for key, entry in below.items() if key not in dropped}


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name too long for the file system
        return False


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:
        return False


def _shipped_names(text: str) -> str:
    names = list(shipped_studies())
    near = get_close_matches(text[:80], names, 1, 0.6)
    return f"Did you mean {near[0]}?" if near else f"Shipped examples: {', '.join(names)}."


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
    """Whole records of what a study names besides materials: its fluid, its friction table."""
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
    names = given.value if isinstance(given.value, list) else [given.value]
    if not 0 < len(names) <= MOST_NAMED:
        raise InputError("library", f"must be one path or a list of 1 to {MOST_NAMED}", shown(given.value))
    for name in names:
        yield from _existing(folder, name)


def _existing(folder: Path, name: Any) -> list[Path]:
    if not isinstance(name, str) or not name or not name.isprintable():
        raise InputError("library", "must be the path of a file or a folder, in quotes", shown(name))
    path = folder / name
    try:
        found = library_files(path) if path.exists() else None
    except OSError:  # a name too long for the file system
        found = None
    if found is None:
        cure = "It is taken from the folder of the study."
        raise InputError("library", "does not name a file or folder", shown(name), cure)
    if not found:
        raise InputError("library", "names a folder without a .toml file", shown(name))
    return found
