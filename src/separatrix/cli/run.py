"""One verb, from the name of a study to its answer: read, compute, print, write."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from separatrix.cli.console import answer, complain, harmless, interrupted, progress_bar
from separatrix.cli.files import refuse_existing, staged, writable_folder, write_new
from separatrix.cli.verbs import Verb
from separatrix.errors import InputError
from separatrix.notes import grouped, noted_warnings

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import xarray as xr

    from separatrix.ledger import Ledger
    from separatrix.study import Study

ANSWERED = 0


class Found(NamedTuple):
    """An answer to a study, and its document."""

    answer: object
    study: Study
    document: dict[str, Any]

    @property
    def notes(self) -> list[str]:
        """All warnings."""
        return list(self.document["warnings"])


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What follows the study on the command line; `question` are the options of the verb alone."""

    json: bool
    out: Path | None
    quiet: bool
    jobs: int
    full: bool = False
    cluster: str | None = None
    question: Mapping[str, Any] = field(default_factory=dict)


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
            found, complete = _computed(verb, study, options, notes, folder)
            _deliver(verb, found, folder, options)
    if complete:
        return ANSWERED
    more = " Run the same command to resume." if verb.keeps_runs and folder is not None else ""
    return interrupted(f"the answer holds what was finished, and is marked complete: false.{more}")


def _folder(verb: Verb, study: Study, options: Options) -> contextlib.AbstractContextManager[Path | None]:
    """Return the folder for the files, made and tried; None where no file is to be written."""
    if options.out is not None:
        return writable_folder(options.out)
    if options.json or not verb.writes_files:
        return contextlib.nullcontext(None)
    return writable_folder(Path(study.name))


def _computed(
    verb: Verb, study: Study, options: Options, notes: list[str], folder: Path | None
) -> tuple[Found, bool]:
    """Compute the answer, or the part that was finished before an interrupt; return whether it is all."""
    from separatrix.present import document
    from separatrix.runner import Interrupted, Runner

    complete = True
    with (
        progress_bar(f"{verb.name} {study.name}", quiet=options.quiet) as progress,
        _ledger(folder if verb.keeps_runs else None) as ledger,
        _executor(options.cluster) as (executor, threads),
    ):
        runner = Runner(jobs=threads or options.jobs, progress=progress, ledger=ledger, executor=executor)
        try:
            record = verb.compute(study, runner, options.question)
        except Interrupted as stop:
            if stop.finished is None:
                raise
            record, complete = stop.finished, False
    if ledger is not None and ledger.taken and not options.quiet:
        complain(f"{ledger.taken} runs were taken from {ledger.path}, where an earlier call had kept them.")
    return Found(record, study, document(verb.name, record, study, grouped(notes))), complete


@contextlib.contextmanager
def _executor(address: str | None) -> Iterator[tuple[Executor | None, int]]:
    """Yield what computes runs on a cluster, and how many at once; None and 0 without one."""
    if address is None:
        yield None, 0
        return
    from separatrix.cluster import cluster

    with cluster(address) as found:
        yield found


@contextlib.contextmanager
def _ledger(folder: Path | None) -> Iterator[Ledger | None]:
    """Yield the ledger in the folder of the answer; None where no file is to be written."""
    if folder is None:
        yield None
        return
    from separatrix.ledger import NAME, Ledger

    ledger = Ledger(folder / NAME)
    try:
        yield ledger
    finally:
        ledger.close()


def _deliver(verb: Verb, found: Found, folder: Path | None, options: Options) -> None:
    """Write the answer, then the files, which take as long again, and say where they are."""
    from separatrix.present import report, whereabouts

    text = json.dumps(found.document, indent=1, allow_nan=False) + "\n"
    asked = (verb.name, found.answer, found.study, found.notes)
    answer(text if options.json else report(*asked, full=options.full, quiet=options.quiet))
    if folder is None:
        return
    texts = {".json": text, ".txt": report(*asked, full=True)}
    with staged(folder) as stage:
        _write_files(verb, found, stage, texts, quiet=options.quiet)
    if not options.json and not options.quiet:
        overview = verb.name == "rank" and bool(found.document["complete"])
        answer("\n" + whereabouts(verb.name, str(folder), overview=overview))


def _write_files(verb: Verb, found: Found, folder: Path, texts: Mapping[str, str], *, quiet: bool) -> None:
    """Write texts, workbook, dataset and pictures."""
    for suffix, text in texts.items():
        path = folder / f"{verb.name}{suffix}"
        path.write_text(harmless(text), encoding="utf-8")
    if verb.has_workbook:
        from separatrix.workbook import results_workbook

        results_workbook(found.document, folder / f"{verb.name}.xlsx")
    if verb.writes_files:
        data = _write_data(verb, found, folder)
        if verb.draw is not None:
            verb.draw(data, folder, quiet=quiet)


def _write_data(verb: Verb, found: Found, folder: Path) -> xr.Dataset:
    """Write the dataset and the figures made from it; matplotlib keeps its remarks on fonts to itself."""
    import logging

    from separatrix import figures
    from separatrix.present import dataset, save

    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    data = dataset(verb.name, found.answer, found.study, found.notes)
    save(data, folder / f"{verb.name}.nc")
    for name, figure in figures.draw(verb.name, data):
        for suffix in (".png", ".svg"):
            figures.save(figure, folder / f"{name}{suffix}")
    return data


def make_study(path: Path, *, excel: bool, as_json: bool, quiet: bool) -> int:
    """Write the commented study file of the verb `new`, text or workbook, and return the exit status.

    Raises
    ------
    InputError
        There is something of that name already, it cannot be written, or its name says otherwise.
    """
    _check_name(path, excel=excel)
    refuse_existing(path)
    write_new(path, _new_study(excel=excel))
    if as_json:
        answer(json.dumps({"path": str(path)}) + "\n")
    elif not quiet:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


def _check_name(path: Path, *, excel: bool) -> None:
    """Refuse a folder, and a name that says another kind of file than is written."""
    from separatrix.study_file.document import WORKBOOK_ENDINGS

    if path.is_dir():
        cure = f'Name a file: "{path / ("my-bearing.xlsx" if excel else "my-bearing.toml")}".'
        raise InputError(str(path), "is a folder", cure=cure)
    ending = path.suffix.casefold()
    if excel and ending != ".xlsx":
        named = path.with_suffix(".xlsx") if ending in WORKBOOK_ENDINGS else f"{path}.xlsx"
        raise InputError(str(path), "must end in .xlsx with --excel", cure=f'Name it "{named}".')
    if ending in WORKBOOK_ENDINGS and not excel:
        cure = f"Name it {path.stem}.toml, or {path.stem}.xlsx with --excel."
        raise InputError(str(path), "is the name of a workbook", cure=cure)


def _new_study(*, excel: bool) -> bytes:
    """Return the file to fill in."""
    if excel:
        from separatrix.study_file.templates import template_workbook

        return template_workbook()
    from separatrix.study_file import template

    return template().encode()
