"""The saved studies of the page, and whether an answer is still that of its study."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from separatrix import __version__
from separatrix.app.draft import ONE_AT_A_TIME
from separatrix.errors import InputError
from separatrix.input_files import noting, reading_only_in
from separatrix.limits.map_records import varied
from separatrix.messages import noted_warnings
from separatrix.study import Study
from separatrix.study_file import read_study, resolved
from separatrix.units import printable

MOST_KEPT = 4000
"""Studies and judgements that are kept in memory."""

MOST_NAMED = 4
"""Inputs that a sentence names."""

OTHER_VERSION = "version of separatrix"
"""How `reporting.content.differing` names it."""

NOT_INPUTS = ("name", "title")


class Studies:
    """The studies of a folder; each is read once, and each answer judged once, until a file of it changes."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self._kept: OrderedDict[object, tuple[dict[Path, int | None], Any]] = OrderedDict()

    def read(self, path: Path, models: Mapping[str, str] | None = None) -> Study:
        """Return the study of a file, with other models of motion and ball if there are any; or refuse it."""
        return self._read(path, models or {})[0]

    def change(self, path: Path, answer: Path, values: Mapping[str, float] | None = None) -> str:
        """Return in one sentence why an answer is not that of a study as it is now; empty if it is.

        Parameters
        ----------
        path, answer : Path
            The study, and the document of the answer.
        values : mapping, optional
            Numbers that the answer had in place of those of the study, by the names of a map.
        """
        given = dict(values or {})
        key = (path, answer, tuple(sorted(given.items())))
        return str(self._known(key, lambda: self._judged(path, answer, given)))

    def _read(self, path: Path, models: Mapping[str, str]) -> tuple[Study, tuple[Path, ...]]:
        def load() -> tuple[object, Iterable[Path]]:
            with ONE_AT_A_TIME, noting() as reading, reading_only_in(self.root), noted_warnings():
                study = read_study(path, models)
            files = (path, *reading.files)
            return (study, files), files

        found: tuple[Study, tuple[Path, ...]] = self._known((path, tuple(sorted(models.items()))), load)
        return found

    def _judged(self, path: Path, answer: Path, values: Mapping[str, float]) -> tuple[str, Iterable[Path]]:
        try:
            document = json.loads(answer.read_text(encoding="utf-8"))
        except (OSError, ValueError):  # not an answer; where it is shown, that is said
            return "", ()
        try:
            study, files = self._read(path, _models(document))
            study = varied(study, values) if values else study
        except InputError as error:
            first = error.problems[0] if error.problems else error
            return f"The study cannot be read, so this answer may be outdated: {first}", ()
        return _sentence(document, study), (*files, answer)

    def _known(self, key: object, make: Callable[[], tuple[object, Iterable[Path]]]) -> Any:
        """Return what was made from files, made again if one of them has changed; of no files always."""
        times, content = self._kept.get(key, ({}, None))
        if not times or any(_time(path) != then for path, then in times.items()):
            content, files = make()
            self._kept[key] = {path: _time(path) for path in files}, content
            if len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        return content


def _time(path: Path) -> int | None:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return None


def _models(document: Any) -> dict[str, str]:
    """Return the models of motion and ball that were chosen beside the study when it was answered."""
    try:
        found = document["provenance"]["command"]["models"]
        return {str(name): str(found[name]) for name in ("motion", "ball") if name in found}
    except (KeyError, TypeError):
        return {}


def _sentence(document: Any, study: Study) -> str:
    from separatrix.present import plain
    from separatrix.reporting.content import differing

    now: dict[str, Any] = {"study": plain(resolved(study), "study"), "seed": study.stability.seed}
    now["separatrix_version"] = __version__
    then: dict[str, Any] = {key: document.get(key) if isinstance(document, dict) else None for key in now}
    then["study"] = then["study"] if isinstance(then["study"], dict) else {}
    names = differing(then, now)
    changed = [one for one in names if one != OTHER_VERSION] or list(_sections(then["study"], now["study"]))
    if changed:
        more = len(changed) - MOST_NAMED
        listed = ", ".join(changed[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
        return f"The study was changed after this answer: {printable(listed, 300)}. Run it again."
    if names:
        version = printable(str(then["separatrix_version"]), 40)
        return f"This answer is of separatrix {version}, not {__version__}. Run it again."
    return ""


def _sections(then: Mapping[str, object], now: Mapping[str, object]) -> Iterator[str]:
    """Yield the sections that differ in anything but where it is written in the file."""
    for section in now:
        if section not in NOT_INPUTS and _inputs(now[section]) != _inputs(then.get(section)):
            yield f"[{section}]"


def _inputs(node: object) -> object:
    if isinstance(node, dict):
        return {key: _inputs(one) for key, one in node.items() if key != "origin"}
    return [_inputs(one) for one in node] if isinstance(node, list) else node
