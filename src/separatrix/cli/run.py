"""One verb, from the name of a study to its answer: read, compute, print, write."""

from __future__ import annotations

import contextlib
import json
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.answers import Work
from separatrix.cli.console import answer, interrupted, progress_bar
from separatrix.cli.files import staged, writable_folder, write_new
from separatrix.cli.verbs import Verb
from separatrix.errors import InputError, ValidityWarning

if TYPE_CHECKING:
    from separatrix.study import Study

ANSWERED = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What follows the study on the command line."""

    json: bool
    out: Path | None
    quiet: bool
    jobs: int


def run(verb: Verb, name: str, options: Options) -> int:
    """Answer one question and return the exit status.

    Parameters
    ----------
    verb : Verb
        The question.
    name : str
        Path of a study file, or name of a shipped study.
    options : Options
        Where the answer goes.

    Raises
    ------
    SeparatrixError
        Wrong input, found before anything is computed where it can be.
    """
    from separatrix.study_file import read_study, require

    with noted_warnings() as notes:
        study = read_study(name)
        require(study, verb.name, *verb.needs)
        with _folder(verb, study, options) as folder:
            document = _document(verb, study, options, notes)
            _deliver(verb, document, folder, as_json=options.json)
    return _status(document)


def _status(document: Mapping[str, Any]) -> int:
    """Return the exit status; an answer cut short says so on standard error."""
    if document.get("complete", True):
        return ANSWERED
    return interrupted("what was finished is in the answer, marked complete: false.")


def _folder(verb: Verb, study: Study, options: Options) -> contextlib.AbstractContextManager[Path | None]:
    """Return the folder for the files, made and tried; None where no file is to be written."""
    if options.out is not None:
        return writable_folder(options.out)
    if options.json or not verb.writes_files:
        return contextlib.nullcontext(None)
    return writable_folder(Path(study.name))


def _document(verb: Verb, study: Study, options: Options, notes: list[str]) -> dict[str, Any]:
    """Compute the answer and return it as plain data with its provenance."""
    from separatrix.results import document

    with progress_bar(f"{verb.name} {study.name}", quiet=options.quiet) as progress:
        record = verb.compute(study, Work(jobs=options.jobs, progress=progress))
    return document(verb.name, record, study, notes)


def _deliver(verb: Verb, document: dict[str, Any], folder: Path | None, *, as_json: bool) -> None:
    """Write the files, then the answer: who reads "figures are in ..." finds them there."""
    text = json.dumps(document, indent=1, allow_nan=False) + "\n"
    summary = _summary(verb, document, folder)
    if folder is not None:
        _write_files(verb, document, folder, {".json": text, ".txt": summary})
    answer(text if as_json else summary)


def _summary(verb: Verb, document: dict[str, Any], folder: Path | None) -> str:
    from separatrix.report import report

    return report(verb.name, document, where=str(folder) if folder else None)


def _write_files(verb: Verb, document: dict[str, Any], folder: Path, texts: Mapping[str, str]) -> None:
    """Write texts, dataset and figures aside, then put them in their places together."""
    with staged(folder) as stage:
        for suffix, text in texts.items():
            path = stage / f"{verb.name}{suffix}"
            path.write_text(text, encoding="utf-8", errors="backslashreplace")
        if verb.writes_files:
            _write_data(verb, document, stage)


def _write_data(verb: Verb, document: dict[str, Any], folder: Path) -> None:
    """Write the dataset and the figures made from it; matplotlib keeps its remarks on fonts to itself."""
    import logging

    from separatrix import figures, results

    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    data = results.dataset(document)
    results.save(data, folder / f"{verb.name}.nc")
    for name, figure in figures.figures(verb.name, data):
        for suffix in (".png", ".svg"):
            figures.save(figure, folder / f"{name}{suffix}")


def make_study(path: Path, *, as_json: bool, quiet: bool) -> int:
    """Write the commented study file of the verb `new` and return the exit status.

    Raises
    ------
    InputError
        There is something of that name already, or it cannot be written.
    """
    from separatrix.study_file import template

    if path.is_dir():
        raise InputError(str(path), "is a folder", cure=f'Name a file: "{path / "my-bearing.toml"}".')
    write_new(path, template())
    if as_json:
        answer(json.dumps({"path": str(path)}) + "\n")
    elif not quiet:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


@contextlib.contextmanager
def noted_warnings() -> Iterator[list[str]]:
    """Collect what is said about validity, each sentence once; other warnings take their usual way."""
    notes: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("always", ValidityWarning)
        usual = warnings.showwarning

        def note(message: Warning | str, category: type[Warning], *place: Any, **rest: Any) -> None:
            if not issubclass(category, ValidityWarning):
                usual(message, category, *place, **rest)
            elif str(message) not in notes:
                notes.append(str(message))

        warnings.showwarning = note  # put back by catch_warnings
        yield notes
