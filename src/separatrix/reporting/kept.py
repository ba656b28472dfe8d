"""The answers that a folder keeps: the document of each verb, and its dataset."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from separatrix.comparing.pair import differences, of_study
from separatrix.comparing.saved import Document, read_file
from separatrix.errors import InputError
from separatrix.messages import grouped, noted_warnings
from separatrix.present import load
from separatrix.questions import Computed, Verb, verb_named

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

    document: Document
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


def read_document(path: Path, verb: str) -> Document:
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


def differing(first: Document, second: Document) -> list[str]:
    """Return the names of the inputs that differ between two documents, and the version if that does."""
    ours, theirs = (dict(of_study(one["study"])) for one in (first, second))
    names = [at.key for at in differences(ours, theirs)]
    beside = {"version of separatrix": "separatrix_version", "seed": "seed"}
    return names + [words for words, key in beside.items() if first[key] != second[key]]


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

    found = kept.document
    asked = {"study": plain(resolved(study), "study"), "seed": study.stability.seed}
    asked["separatrix_version"] = __version__
    return all(found[key] == value for key, value in asked.items()) and found.get("complete", True) is True


def keeping(
    compute: Callable[[Verb], Computed], notes: list[str], folder: Path | None
) -> Callable[[str], Kept]:
    """Return what computes an answer; its files are written if there is a folder, without figures."""
    from separatrix.present import dataset, document
    from separatrix.saving import save_answer

    def kept(verb: str) -> Kept:
        with noted_warnings() as own:
            made = compute(verb_named(verb))
        found = document(verb, made.record, made.study, [*notes, *grouped(own)])
        if folder is not None:
            save_answer(folder, made.record, made.study, found, pictures=False)
        return Kept(found, dataset(verb, made.record, made.study, list(found["warnings"])))

    return kept


def answers_of(
    study: Study, folder: Path | None, compute: Callable[[str], Kept]
) -> tuple[dict[str, Kept], list[str], bool]:
    """Return the answers to a study, what was refused, and whether no answer was interrupted.

    Those that the folder holds already are taken; the others that a report needs are computed.
    """
    known = read_folder(folder, needed=False) if folder is not None else {}
    found = {verb: one for verb, one in known.items() if answers(one, study)}
    missing = add_missing(found, verbs_of(study), compute)
    complete = all(one.document.get("complete", True) for one in found.values())
    return {verb: found[verb] for verb in NEEDED if verb in found}, missing, complete


def add_missing(found: dict[str, Kept], wanted: Iterable[str], compute: Callable[[str], Kept]) -> list[str]:
    """Compute the wanted answers that are not there; return what was refused, a sentence each."""
    missing = []
    for verb in wanted:
        if verb in found:
            continue
        try:
            found[verb] = compute(verb)
        except InputError as error:
            if not found:
                raise
            missing.append(f"`{verb}` was not computed: {error}")
            continue
        if found[verb].document.get("complete") is False:
            break
    return missing
