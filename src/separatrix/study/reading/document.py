"""A study document: its sections key by key, each with its place, merged over the file it extends."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from os.path import exists, isfile
from pathlib import Path

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.input_files import place
from separatrix.ground.toml import Places, folded, label_of, nearest, path_text, places_of, read_toml
from separatrix.ground.units import printable, shown
from separatrix.study.distribution import Distribution
from separatrix.study.library import Library, beside, library_files, with_files

SECTIONS = ("bearing", "operation", "kinematics", "film", "traction", "cage", "stability", "ranking")
TEMPLATE = Path(__file__).with_name("template.toml")
MOST_BASES = 8
MOST_NAMED = 20
"""Libraries that the key `library` may name."""

WORKBOOK_ENDINGS = (".xlsx", ".xlsm", ".xltx", ".xls", ".xlsb", ".ods")
WORKBOOK_MAGICS = (b"PK\x03\x04", b"PK\x05\x06", b"\xd0\xcf\x11\xe0")
MOST_PROBLEMS = 100
"""After this number of mistakes a file is read no further."""

ALTERNATIVES = {
    "bearing": (("radial_clearance",), ("contact_angle",)),
    "operation": (("tilt",), ("moment",)),
    "cage": (("pocket_angles",), ("pocket_spacing_scatter",)),
    "film": (("elastic_modulus", "poisson_ratio"), ("material",)),
    "ranking": (("candidates",), ("friction", "materials")),
}
"""Keys that exclude each other: a variant with one side drops the other side of its base."""

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


class Unfinished(Exception):  # noqa: N818 - not an error: it never leaves this package
    """A section cannot be built because one of its values was refused already."""


@dataclass(slots=True)
class Document:
    """Sections of a study, from a text file or a workbook, before any value is converted.

    A value may be an InputError, where a cell has none. A fault is noted under the path of its key,
    ``[cage] mass`` or ``[ranking] candidates[2].name``; `places` has its place.
    """

    path: Path
    top: dict[str, object] = field(default_factory=dict)
    sections: dict[str, dict[str, object]] = field(default_factory=dict)
    places: Places = field(default_factory=lambda: Places(""))
    problems: list[InputError] = field(default_factory=list)
    distributions: dict[str, Distribution] = field(default_factory=dict)
    """Distributions of the uncertain numbers by their names."""

    libraries: list[tuple[Path, object]] = field(default_factory=list)
    """The study files of the chain, and the key `library` of each."""

    friction_folder: Path = field(default_factory=Path)
    """Folder of the file that gives [ranking] friction."""

    film_folder: Path = field(default_factory=Path)
    """Folder of the file that gives [film] wear."""

    @contextmanager
    def noting(self) -> Iterator[None]:
        """Note a refusal instead of raising it."""
        with suppress(Unfinished), noted(self.problems):
            yield

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
    folder = Path(__file__).parents[2] / "examples"
    return {path.stem: path for path in sorted(folder.iterdir()) if path.suffix == ".toml"}


def find(study: str | Path) -> Path:
    """Path of a study file, or of the shipped example of that name.

    A regular file of that very name comes first; a folder does not hide a shipped example.
    """
    text = str(study)
    if not text or "\0" in text:
        raise InputError("STUDY", "must be a path or a name", shown(text), _shipped_names(text))
    if isfile(text):
        return Path(text)
    if text in shipped_studies():
        return shipped_studies()[text]
    if not exists(text):
        raise InputError(path_text(Path(text)), "does not exist", cure=_shipped_names(text))
    return Path(text)


def load(path: Path, above: tuple[Path, ...] = ()) -> Document:
    """Document of a file, merged over the file it extends."""
    document = _own(path)
    if "extends" not in document.top:
        return document
    where, base = document.locate("extends"), document.top["extends"]
    if not isinstance(base, str):
        raise InputError(where, "must be a path or the name of a shipped example", shown(base))
    beside_it = place(path.parent, base)
    target = beside_it if base and isfile(beside_it) else shipped_studies().get(base)
    if target is None:
        raise InputError(where, "does not name a file beside this one", shown(base), _shipped_names(base))
    chain = (*above, path.resolve())
    if target.resolve() in chain:
        raise InputError(where, "leads back to a file that extends this one", shown(base))
    if len(chain) > MOST_BASES:
        raise InputError(where, f"makes a chain of more than {MOST_BASES} files", shown(base))
    return _merged(load(target, chain), document)


def is_workbook(path: Path) -> bool:
    """Whether a file is a workbook, by its name or its first bytes."""
    if not isfile(path):  # a pipe may never end
        return False
    if path.suffix.casefold() in WORKBOOK_ENDINGS:
        return True
    try:
        with path.open("rb") as file:
            return file.read(4) in WORKBOOK_MAGICS
    except OSError:
        return False


def _own(path: Path) -> Document:
    if is_workbook(path):
        from separatrix.study.reading.workbook import document_of

        return document_of(path)
    data, lines = read_toml(path)
    places, folder = places_of(label_of(path), data, lines), path.parent
    document = Document(path, places=places, friction_folder=folder, film_folder=folder)
    for name, value in data.items():
        if len(document.problems) > MOST_PROBLEMS:
            break
        at = f"[{printable(name)}]"
        with document.noting():
            if name in TOP:
                document.top[name] = value
            elif name in SECTIONS:
                document.sections[name] = value if isinstance(value, dict) else {}
                if not isinstance(value, dict):
                    raise InputError(at, f"must be one section, headed [{name}]", shown(value))
            elif isinstance(value, dict):
                raise InputError(at, "is not a section of a study", cure=nearest(name, SECTIONS))
            else:
                where = f"{document.places.of(name)}: {printable(name) or chr(34) * 2}"
                raise InputError(where, "is outside a section", cure=_OUTSIDE)
    document.libraries.append((path, document.top.get("library")))
    return document


def _merged(base: Document, document: Document) -> Document:
    own, film = document.sections.get("ranking", {}), document.sections.get("film", {})
    merged = Document(
        document.path,
        {"title": base.top["title"], **document.top} if "title" in base.top else document.top,
        places=Places(document.places.label, base.places.known | document.places.known),
        problems=base.problems + document.problems,
        libraries=document.libraries + base.libraries,
        friction_folder=(document if "friction" in own else base).friction_folder,
        film_folder=(document if "wear" in film else base).film_folder,
    )
    for name in SECTIONS:
        below, above = base.sections.get(name), document.sections.get(name)
        if below is not None or above is not None:
            merged.sections[name] = {**_kept(name, below or {}, above or {}), **(above or {})}
    return merged


def _kept(name: str, below: dict[str, object], above: dict[str, object]) -> dict[str, object]:
    """Keys of the base that the variant does not replace by an alternative."""
    dropped: set[str] = set()
    one, other = ALTERNATIVES.get(name, ((), ()))
    if any(key in above for key in one):
        dropped.update(other)
    if any(key in above for key in other):
        dropped.update(one)
    for (key, choice), keys in _MEANINGLESS.items() if name == "cage" else ():
        if key in above and folded(str(above[key])) == choice:
            dropped.update(keys)
    return {key: value for key, value in below.items() if key not in dropped}


def _shipped_names(text: str) -> str:
    names = list(shipped_studies())
    near = get_close_matches(text[:80], names, 1, 0.6)
    return f"Did you mean {near[0]}?" if near else f"Shipped examples: {', '.join(names)}."


def library_of(document: Document) -> Library:
    """Library of a study: the shipped records, and those of files beside it or named in it."""
    paths: list[Path] = []
    for study, given in document.libraries:
        if study not in shipped_studies().values():
            paths += beside(study.parent, besides=study)
        if given is not None:
            names = given if isinstance(given, list) else [given]
            if not 0 < len(names) <= MOST_NAMED:
                rule = f"must be one path or a list of 1 to {MOST_NAMED}"
                raise InputError("library", rule, shown(given))
            for name in names:
                paths += _named(study.parent, name)
    return with_files(paths)


def _named(folder: Path, name: object) -> list[Path]:
    if not isinstance(name, str) or not name or not name.isprintable():
        raise InputError("library", "must be the path of a file or a folder, in quotes", shown(name))
    path = place(folder, name)
    if not exists(path):
        cure = "It is taken from the folder of the study."
        raise InputError("library", "does not name a file or folder", shown(name), cure)
    found = library_files(path)
    if not found:
        raise InputError("library", "names a folder without a .toml file", shown(name))
    return found
