"""The answers that a folder keeps: the document of each verb, and its dataset."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.comparing.saved import read_file
from separatrix.errors import InputError
from separatrix.present import load

if TYPE_CHECKING:
    import xarray as xr

    from separatrix.study import Study

NEEDED = {
    "bearing": ("balls", "contacts"),
    "traction": ("inner", "outer", "models", "outside"),
    "restitution": ("restitution_factor", "race_damping", "inner", "outer"),
    "stability": ("curve", "here", "chain", "cage"),
    "rank": ("environment", "environments", "stability", "chain", "pocket"),
    "sensitivity": ("environment", "environments", "drivers", "next_tests", "undecided"),
    "map": (),
    "sweep": ("parameters", "cases", "worst", "duty"),
}
"""Verbs that a report shows, in the order of the chain, and the keys that each document must have."""

ALWAYS = ("separatrix_version", "title", "name", "study", "seed", "warnings")


@dataclass(frozen=True, slots=True)
class Kept:
    """One answer: its document, and its dataset if that was kept, too."""

    document: Mapping[str, Any]
    data: xr.Dataset | None = None


def read_folder(folder: Path, *, needed: bool = True) -> dict[str, Kept]:
    """Return the answers of a folder that a report can show, by verb.

    Parameters
    ----------
    folder : Path
        It exists.
    needed : bool
        Whether a folder without any is refused.

    Raises
    ------
    InputError
        There is none, or a file is not an answer of separatrix.
    """
    found = {}
    for verb in NEEDED:
        path = folder / f"{verb}.json"
        if path.exists():
            data = folder / f"{verb}.nc"
            found[verb] = Kept(read_document(path, verb), load(data) if data.exists() else None)
    if needed and not found:
        names = ", ".join(f"{verb}.json" for verb in NEEDED)
        cure = "Name the folder of an answer, or a study: separatrix report cryogenic-turbopump."
        raise InputError(str(folder), f"holds no answer of separatrix ({names})", cure=cure)
    return found


def read_document(path: Path, verb: str) -> Mapping[str, Any]:
    """Return a saved document; one that is not of this verb, or lacks what a report needs, is refused."""
    where, cure = str(path), "Compute this answer again, or remove the file."
    saved = read_file(path)
    if saved.verb != verb or saved.document is None:
        raise InputError(where, f"is not a document of `{verb}`", cure=cure)
    found = saved.document
    missing = [key for key in (*ALWAYS, *NEEDED[verb]) if key not in found]
    if missing or not isinstance(found["study"].get("bearing"), dict):
        raise InputError(where, f"lacks {', '.join(missing) or 'its study'}", cure=cure)
    return found


def differing(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[str]:
    """Return the names of the inputs that differ between two documents, and the version if that does."""
    ours, theirs = (dict(_inputs(one["study"])) for one in (first, second))
    names = [name for name in {**ours, **theirs} if ours.get(name) != theirs.get(name)]
    versions = {one["separatrix_version"] for one in (first, second)}
    seeds = {one["seed"] for one in (first, second)}
    return names + ["version of separatrix"] * (len(versions) > 1) + ["seed"] * (len(seeds) > 1)


def _inputs(entry: object, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every input of a resolved study with its value; not where it was written."""
    if not isinstance(entry, dict):
        yield path, entry
        return
    for key, item in entry.items():
        if key in ("origin", "name", "title", "record", "source", "confidence", "table", "other_tests"):
            continue
        yield from _inputs(item, path if key == "value" else f"{path}.{key}".lstrip("."))


def verbs_of(study: Study) -> Iterator[str]:
    """Yield the verbs that a report of a study needs, in the order of the chain."""
    yield from ("bearing", "traction")
    if study.cage is not None:
        yield "restitution"
        yield "stability" if study.ranking is None else "rank"


def answers(kept: Kept, study: Study) -> bool:
    """Whether an answer is complete, from this version, and to this study."""
    from separatrix import __version__
    from separatrix.present import plain
    from separatrix.study_file import resolved

    document = kept.document
    asked = {"study": plain(resolved(study), "study"), "seed": study.stability.seed}
    same = all(document[key] == value for key, value in asked.items())
    return same and document["separatrix_version"] == __version__ and document.get("complete", True) is True
