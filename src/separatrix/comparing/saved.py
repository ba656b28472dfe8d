"""Answers from files that may come from anybody: folders, documents, reports."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.toml import path_text
from separatrix.ground.units import printable, shown

if TYPE_CHECKING:
    import xarray as xr

VERBS = (
    *("rank", "sensitivity", "stability", "map", "sweep", "simulate"),
    *("mobility", "restitution", "traction", "bearing", "check"),
)
"""Verbs of a study whose answers are read; of a folder with several, two are compared in this order."""

REPORTS = (".html", ".htm")
ENDINGS = (".json", *REPORTS, ".nc")
"""Endings of files of answers: documents, reports, and the arrays, which are not read back."""

MOST_BYTES = 256 * 1024**2
REPORT = re.compile(
    rb"""<script\b[^>]{0,200}\bid=["']separatrix-answers["'][^>]{0,200}>(.*?)</script""", re.DOTALL
)
"""The documents of the answers in a report."""

Document = Mapping[str, Any]
"""An answer as JSON has it; what comes from a file is checked where it is used."""

DAMAGE = (ValueError, TypeError, KeyError, AttributeError, IndexError, RecursionError)
"""What a document raises whose parts are not those of an answer."""

_AGAIN = "Compute this answer again, with this version."
_MAKE = "Make one with: separatrix rank STUDY --out DIR."


@dataclass(frozen=True, slots=True, kw_only=True)
class Saved:
    """An answer of one verb; `path` is as it was named."""

    path: str
    verb: str
    document: Document


def read_answers(path: Path) -> dict[str, Saved]:
    """Answers of a folder, a document (.json) or a report (.html), by verb.

    Raises
    ------
    InputError
        There is none, or one that separatrix did not write.
    """
    where = path_text(path)
    if path.is_dir():
        found: dict[str, Saved] = {}
        for verb in VERBS:
            if (file := path / f"{verb}.json").exists():
                one = read_file(file)
                if one.verb != verb:
                    raise InputError(path_text(file), "must be an answer of that verb", one.verb)
                found[verb] = replace(one, path=where)
        if not found:
            raise InputError(where, "does not contain an answer", cure=_MAKE)
        return found
    if path.suffix.casefold() in REPORTS:
        match = REPORT.search(_bytes(path))
        if match is None:
            raise InputError(where, "is not a report with its answers in it", cure=_MAKE)
        documents = _parsed(match[1], where)
        return {verb: _document(one, where, verb) for verb, one in documents.items()}
    one = read_file(path)
    return {one.verb: one}


def read_file(path: Path) -> Saved:
    """Answer of a document (.json); refused as by `read_answers`."""
    where = path_text(path)
    if path.suffix.casefold() == ".nc":
        cure = f"Name the {path.stem}.json that was written beside it."
        raise InputError(where, "cannot be read back: answers are read from their .json", cure=cure)
    return _document(_parsed(_bytes(path), where), where)


def load(path: Path | str) -> xr.Dataset:
    """Return a saved answer, the .json of a verb, as labelled arrays: those of `Answer.to_xarray`.

    Raises
    ------
    InputError
        The file is not an answer of separatrix, is damaged, or is of an interrupted one.
    """
    saved = read_file(Path(path))
    data = arrays(saved.document, saved.path)
    if data is None:
        raise InputError(saved.path, "is not a complete answer of this version", cure=_AGAIN)
    return data


def arrays(found: Document, where: str) -> xr.Dataset | None:
    """Return the labelled arrays of a document; None of an interrupted answer, or one without units.

    Raises
    ------
    InputError
        It was changed, so that it has none.
    """
    if found.get("complete") is False or "units" not in found:
        return None
    from separatrix.present.dataset import dataset

    try:
        return dataset(found)
    except DAMAGE as error:
        raise InputError(where, "is damaged", printable(repr(error), 200), _AGAIN) from error


def _document(found: object, where: str, verb: str | None = None) -> Saved:
    if not isinstance(found, dict) or not isinstance(found.get("study"), dict):
        raise InputError(where, "is not the document of an answer", cure=_MAKE)
    known = _verb(found.get("verb"), where)
    if verb not in (None, known):
        raise InputError(where, f"must have the answer of {printable(str(verb), 40)} under that name", known)
    return Saved(path=where, verb=known, document=found)


def _verb(verb: object, where: str) -> str:
    if verb not in VERBS:
        got = shown(verb) if isinstance(verb, str) else "none"
        raise InputError(where, f"must be an answer of {', '.join(VERBS)}", got=got)
    return str(verb)


def _bytes(path: Path) -> bytes:
    where = path_text(path)
    if size_of(path, where) > MOST_BYTES:
        raise InputError(where, f"is larger than an answer can be, {MOST_BYTES >> 20} MB")
    try:
        return path.read_bytes()
    except OSError as error:
        raise unreadable(where, error) from None


def _parsed(raw: bytes, where: str) -> dict[str, object]:
    try:
        found = json.loads(raw.decode("utf-8"), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        rule = "is not the document of an answer: no valid JSON"
        raise InputError(where, rule, printable(str(error), 80)) from None
    if not isinstance(found, dict):
        raise InputError(where, "is not the document of an answer", cure=_MAKE)
    return found


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")
