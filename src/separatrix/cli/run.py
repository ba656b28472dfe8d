"""One verb, from the name of a study to its answer: read, compute, print, write."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.console import answer, complain, interrupted, progress_bar
from separatrix.errors import InputError
from separatrix.ledger import NAME as LEDGER
from separatrix.messages import grouped, noted_warnings
from separatrix.questions import Computed, Verb, computed
from separatrix.staged import refuse_existing, writable_folder, write_new

if TYPE_CHECKING:
    from separatrix.study import Study

ANSWERED = 0
ANIMATIONS = ("gif", "mp4")


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What follows the study on the command line; `question` are the options of the verb alone."""

    json: bool
    out: Path | None
    quiet: bool
    jobs: int
    full: bool = False
    cluster: str | None = None
    animate: str | None = None
    models: Mapping[str, str] = field(default_factory=dict)
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
    from separatrix.study import with_models
    from separatrix.study_file import read_study, require

    with noted_warnings() as notes, contextlib.ExitStack() as stack:
        study = read_study(name)
        require(study, verb.name, *verb.needs)
        if options.models:
            study = with_models(study, options.models)
        folder = options.out
        if folder is None and verb.writes_files and not options.json:
            folder = Path(study.name)
        if folder is not None:
            stack.enter_context(writable_folder(folder))
        found = computed_with_progress(verb, study, options, folder)
        _deliver(verb, found.record, found.study, grouped(notes), folder, options)
    if found.is_complete:
        return ANSWERED
    more = " Run the same command to resume." if verb.keeps_runs and folder is not None else ""
    return interrupted(f"the answer holds what was finished, and is marked complete: false.{more}")


def computed_with_progress(verb: Verb, study: Study, options: Options, folder: Path | None) -> Computed:
    """Compute the answer with a bar of progress; say how many runs an earlier call had kept."""
    with progress_bar(f"{verb.name} {study.name}", quiet=options.quiet) as progress:
        found = computed(
            verb,
            study,
            options.question,
            jobs=options.jobs,
            folder=folder,
            cluster=options.cluster,
            progress=progress,
        )
    if found.runs_taken and not options.quiet:
        kept = f"{folder}/{LEDGER}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return found


def _deliver(
    verb: Verb, record: object, study: Study, notes: list[str], folder: Path | None, options: Options
) -> None:
    """Write the answer, then the files, which take as long again, and say where they are."""
    from separatrix.present import document, in_words, whereabouts

    found = document(verb.name, record, study, notes)
    asked = (verb.name, record, study, list(found["warnings"]))
    if options.json:
        answer(json.dumps(found, indent=1, allow_nan=False) + "\n")
    else:
        answer(in_words(*asked, full=options.full, quiet=options.quiet))
    if folder is None:
        return
    from separatrix.saving import save_answer

    with progress_bar("animation", quiet=options.quiet or options.animate is None) as progress:
        save_answer(folder, record, study, found, animation=options.animate, progress=progress)
    if not options.json and not options.quiet:
        overview = verb.name == "rank" and bool(found["complete"])
        answer("\n" + whereabouts(verb.name, str(folder), overview=overview))


def check_animation(kind: str, *, writes: bool) -> None:
    """Refuse an animation of no kind that there is, or without a folder or an encoder for it."""
    if kind not in ANIMATIONS:
        raise InputError("--animate", f"must be {' or '.join(ANIMATIONS)}", got=f'"{kind}"')
    if not writes:
        raise InputError("--animate", "needs a folder with --json", cure="Give --out DIR.")
    if kind == "mp4":
        from separatrix.figures.animation import video_encoder

        video_encoder()


def make_study(path: Path, *, excel: bool, as_json: bool, quiet: bool) -> int:
    """Write the commented study file of the verb `new`, text or workbook, and return the exit status.

    Raises
    ------
    InputError
        There is something of that name already, it cannot be written, or its name says otherwise.
    """
    from separatrix.study_file.document import WORKBOOK_ENDINGS

    ending = path.suffix.casefold()
    if path.is_dir():
        cure = f'Name a file: "{path / ("my-bearing.xlsx" if excel else "my-bearing.toml")}".'
        raise InputError(str(path), "is a folder", cure=cure)
    if excel and ending != ".xlsx":
        better = path.with_suffix(".xlsx") if ending in WORKBOOK_ENDINGS else f"{path}.xlsx"
        raise InputError(str(path), "must end in .xlsx with --excel", cure=f'Name it "{better}".')
    if ending in WORKBOOK_ENDINGS and not excel:
        cure = f"Name it {path.stem}.toml, or {path.stem}.xlsx with --excel."
        raise InputError(str(path), "is the name of a workbook", cure=cure)
    refuse_existing(path)
    write_new(path, _new_study(excel=excel))
    if as_json:
        answer(json.dumps({"path": str(path)}) + "\n")
    elif not quiet:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


def _new_study(*, excel: bool) -> bytes:
    if excel:
        from separatrix.study_file.templates import template_workbook

        return template_workbook()
    from separatrix.study_file import template

    return template().encode()
