"""A study document: its sections key by key, each key with its place, after `extends` has been followed."""

from __future__ import annotations

from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from separatrix.distribution import Distribution
from separatrix.errors import InputError
from separatrix.study_file.shipped import shipped_studies
from separatrix.toml_text import label_of, path_text, read_toml
from separatrix.toml_values import folded, nearest
from separatrix.units import printable, shown

SECTIONS = ("bearing", "operation", "kinematics", "film", "cage", "stability", "ranking")
MOST_BASES = 8
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
    """One value as the file gives it, and where it stands."""

    value: Any
    place: str
    item_places: tuple[str, ...] = ()
    """Place of each item, if it is a list of tables."""

    folder: Path = Path()
    """Folder of the file, beside which the files stand that it names."""


@dataclass(frozen=True, slots=True)
class LibraryPlace:
    """A study file of the chain, whose neighbours and whose key `library` say where materials are."""

    study: Path
    given: Entry | None


@dataclass(slots=True)
class Document:
    """Sections of a study file, before anything is converted."""

    label: str
    top: dict[str, Entry] = field(default_factory=dict)
    sections: dict[str, dict[str, Entry]] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    problems: list[InputError] = field(default_factory=list)
    distributions: dict[str, Distribution] = field(default_factory=dict)
    """Of the uncertain numbers, by their names, as they are read."""

    libraries: list[LibraryPlace] = field(default_factory=list)

    folder: Path = Path()
    cells: dict[str, str] = field(default_factory=dict)
    """Of a workbook: the cell of each value, by the name that refusals give it."""

    def place(self, *keys: str) -> str:
        """File and line of the first of the dotted keys that has a line of its own."""
        line = next((self.lines[key] for key in keys if key in self.lines), None)
        return self.label if line is None else f"{self.label}, line {line}"


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
    where = f"{base.place}: extends"
    if not isinstance(base.value, str):
        raise InputError(where, "must be a path or the name of a shipped example", shown(base.value))
    target = _base(path, base.value, where)
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
    document = Document(label_of(path), lines=lines, folder=path.parent)
    for name, value in data.items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        place = document.place(name, f"{name}.0")
        plain = printable(name) or '""'
        if name in TOP:
            document.top[name] = Entry(value, place, folder=document.folder)
        elif name in SECTIONS and isinstance(value, dict):
            document.sections[name] = {key: _entry(document, f"{name}.{key}", v) for key, v in value.items()}
        elif name in SECTIONS:
            rule = f"must be one section, headed [{name}]"
            document.sections[name] = {}
            document.problems.append(InputError(f"{place}: {name}", rule, shown(value)))
        elif isinstance(value, dict):
            cure = nearest(name, SECTIONS)
            document.problems.append(InputError(f"{place}: [{plain}]", "is no section of a study", cure=cure))
        else:
            document.problems.append(
                InputError(f"{place}: {plain}", "stands outside a section", cure=_OUTSIDE)
            )
    document.libraries.append(LibraryPlace(path, document.top.get("library")))
    return document


def _entry(document: Document, key: str, value: Any) -> Entry:
    items = value if isinstance(value, list) else []
    places = tuple(document.place(f"{key}.{i}", key) for i in range(len(items)))
    return Entry(value, document.place(key, f"{key}.0"), places, document.folder)


def _base(path: Path, text: str, where: str) -> Path:
    beside = path.parent / text if text and "\0" not in text else None
    if beside is not None and _is_file(beside):
        return beside
    if text in shipped_studies():
        return shipped_studies()[text]
    raise InputError(where, "names no file beside this one", shown(text), _shipped_names(text))


def _merged(base: Document, document: Document) -> Document:
    merged = Document(
        document.label, document.top, problems=base.problems + document.problems, folder=document.folder
    )
    merged.libraries = document.libraries + base.libraries
    merged.cells = base.cells | document.cells
    for name in SECTIONS:
        below, above = base.sections.get(name), document.sections.get(name)
        if below is not None or above is not None:
            merged.sections[name] = {**_kept(name, below or {}, above or {}), **(above or {})}
    if "title" not in merged.top and "title" in base.top:
        merged.top = {**merged.top, "title": base.top["title"]}
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
