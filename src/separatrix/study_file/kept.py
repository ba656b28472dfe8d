"""Provenance of an answer: the question, the files that the study was read from, and the versions."""

from __future__ import annotations

import base64
import hashlib
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import separatrix
from separatrix.errors import InputError
from separatrix.input_files import MOST_BYTES, MOST_FILES, Reading, checksum_of_name, refuse_unsafe
from separatrix.study import Study, with_models

KEPT, ASKED = "provenance.files", "provenance.command"
"""Among the records of a study: what it was read from, and what was asked of it."""

SHIPPED = "shipped:"
"""Before the name of a file that comes with the package: its checksum is kept, not its content."""

ELSEWHERE = "elsewhere-"
"""Before the number of a folder that is named by an absolute path."""

PACKAGES = ("numpy", "scipy", "numba")

_IN_PYTHON = "The study was made in Python, not read from a file."
_CHANGED = "The study was changed in Python after it was read."
_TOO_MUCH = f"The files of the study are more than {MOST_FILES}, or larger than {MOST_BYTES >> 20} MB."
_APART = "The files of the study have no folder in common."


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """Files of a study by relative names with slashes; `reason` says why there are none.

    `links` has the name of each absolute path that a file names. `as_read` is the study as its files have it.
    """

    entry: str | None = None
    files: Mapping[str, Mapping[str, str]]
    links: Mapping[str, str]
    reason: str | None = None
    as_read: Study | None = None


def keep(study: Study, path: Path, reading: Reading) -> Study:
    """Return a study just read with the files that it was read from."""
    found = _kept(path, reading, study)
    return replace(study, records={**study.records, KEPT: found})


def _kept(path: Path, reading: Reading, study: Study) -> Kept:
    own = {file: content for file, content in reading.files.items() if _shipped_name(file) is None}
    shipped = {name: {"sha256": checksum} for name, checksum in _shipped_library().items()}
    for file, content in reading.files.items():
        if name := _shipped_name(file):
            shipped[name] = {"sha256": _sha256(content)}
    if len(own) > MOST_FILES or sum(map(len, own.values())) > MOST_BYTES:
        return Kept(files={}, links={}, reason=_TOO_MUCH, as_read=study)
    entry = _shipped_name(path)
    if entry is not None:
        return Kept(entry=entry, files=shipped, links={}, as_read=study)
    try:
        names = _Names(path, own, reading.absolute)
        files = {names.of(file): _content(content) for file, content in own.items()}
        links = {checksum_of_name(name): names.of(Path(name)) for name in reading.absolute}
        entry = names.of(path)
        for name in files:
            refuse_unsafe(name)
    except ValueError as error:  # InputError is one
        reason = f"{error}" if isinstance(error, InputError) else _APART
        return Kept(files={}, links={}, reason=reason, as_read=study)
    return Kept(entry=entry, files={**files, **shipped}, links=links, as_read=study)


class _Names:
    """Relative names of files, under which they name each other as they do where they are.

    The root is the deepest folder of all, except for what is named by an absolute path elsewhere.

    Raises
    ------
    ValueError
        There is no such folder but that of the whole drive.
    """

    def __init__(self, entry: Path, files: Iterable[Path], absolute: Iterable[str]) -> None:
        home = _absolute(entry).parent
        far = {_absolute(Path(name)).parent for name in absolute}
        far = {one for one in far if not any(one != two and one.is_relative_to(two) for two in far)}
        paths = [_absolute(file) for file in files]
        near = [one for one in paths if one.is_relative_to(home) or not any(map(one.is_relative_to, far))]
        self.root = Path(os.path.commonpath([home, *(one.parent for one in near)]))
        if self.root.parent == self.root != home:
            raise ValueError
        self.far = sorted(one for one in far if not one.is_relative_to(self.root))

    def of(self, file: Path) -> str:
        """Name of a file or folder."""
        path = _absolute(file)
        if path.is_relative_to(self.root):
            return path.relative_to(self.root).as_posix()
        for number, folder in enumerate(self.far, start=1):
            if path.is_relative_to(folder):
                return f"{ELSEWHERE}{number}/{path.relative_to(folder).as_posix()}"
        raise ValueError


def _absolute(path: Path) -> Path:
    """Path without ``..``; a link on the way must not change where that leads."""
    found = Path(os.path.abspath(path))
    if found != path and not (found.exists() and found.samefile(path)):
        raise ValueError
    return found


def _content(raw: bytes) -> dict[str, str]:
    """Content of a file as JSON can have it, byte for byte."""
    try:
        return {"sha256": _sha256(raw), "text": raw.decode("utf-8")}
    except UnicodeDecodeError:
        return {"sha256": _sha256(raw), "base64": base64.b64encode(raw).decode("ascii")}


def _sha256(raw: bytes) -> str:
    return hashlib.sha256(raw).hexdigest()


_FOLDERS = tuple(Path(separatrix.__file__).resolve().parent / name for name in ("examples", "library/data"))


def _shipped_name(path: Path) -> str | None:
    return f"{SHIPPED}{path.name}" if path.resolve().parent in _FOLDERS else None


@cache
def _shipped_library() -> dict[str, str]:
    paths = sorted(_FOLDERS[1].glob("*.toml"))
    return {f"{SHIPPED}{path.name}": _sha256(path.read_bytes()) for path in paths}


def shipped_checksums() -> dict[str, str]:
    """Checksum of every shipped file of this version by its name in an answer."""
    paths = sorted(_FOLDERS[0].glob("*.toml"))
    return _shipped_library() | {f"{SHIPPED}{path.name}": _sha256(path.read_bytes()) for path in paths}


def asked_by(study: Study, verb: str, question: Mapping[str, Any], reading: Reading | None = None) -> Study:
    """Return the study with what was asked of it, for `provenance_of`.

    Parameters
    ----------
    question : mapping
        Options of the verb as they were given.
    reading : Reading, optional
        Files that were read to answer: a table of cases is one.
    """
    given, files = dict(question), dict[str, Mapping[str, str]]()
    table = given.get("cases")
    if isinstance(table, Path):
        content = None if reading is None else reading.files.get(table)
        name = f"cases/{table.name}"
        given["cases"] = name
        files = {} if content is None else {name: _content(content)}
    return replace(study, records={**study.records, ASKED: (verb, given, files)})


def provenance_of(study: Study, verb: str) -> dict[str, Any]:
    """Return what an answer of a verb needs to be computed again, as plain data."""
    _, question, more = study.records.get(ASKED, (verb, {}, {}))
    found = _of(study)
    command = {"verb": verb, "question": question, "models": _models(study)}
    return {
        "command": command,
        "entry": found.entry,
        "files": dict(found.files) | (dict(more) if found.entry else {}),
        "links": dict(found.links),
        "reason": found.reason,
        "versions": versions(),
    }


def _of(study: Study) -> Kept:
    found: Kept | None = study.records.get(KEPT)
    if found is None:
        return Kept(files={}, links={}, reason=_IN_PYTHON)
    if found.as_read is not None and found.reason is None:
        models = _models(study)
        expected = with_models(found.as_read, models) if models else found.as_read
        if expected != study:
            return Kept(files={}, links={}, reason=_CHANGED)
    return found


def _models(study: Study) -> dict[str, str]:
    """Models that the command line chose in place of those of the study."""
    return dict(_chosen(study))


def _chosen(study: Study) -> Iterator[tuple[str, str]]:
    for name in ("motion", "ball"):
        before, _, value = study.origins.get(f"cage.{name}", "").partition(" ")
        if before == f"--{name}":
            yield name, value


@cache
def versions() -> dict[str, str]:
    """Versions of what computes, without that of separatrix."""
    return {"python": platform.python_version(), **{name: version(name) for name in PACKAGES}}
