"""The verb `report`: the answers of a study or of a folder as one document to hand over."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.console import answer, interrupted
from separatrix.cli.run import ANSWERED, Options, computed_with_progress
from separatrix.errors import InputError
from separatrix.messages import grouped, harmless, noted_warnings
from separatrix.questions import verb_named
from separatrix.staged import staged, writable_folder

if TYPE_CHECKING:
    from separatrix.comparing.saved import Saved
    from separatrix.reporting.kept import Kept
    from separatrix.reporting.record import Report
    from separatrix.study import Study

HELP = "Everything on one study as a document: HTML, and PDF with --pdf."
EPILOG = (
    "Of a folder: from the answers that it holds; nothing long is computed. Of a study: bearing, traction, "
    "restitution and rank (without [ranking]: stability) are computed into its folder first; answers to the "
    "same inputs that are there already are taken. Of two, each a study, a folder, a .json or a .html file: "
    "what changed, by more than counting noise or not. The HTML needs no other file and no network."
)
ASKED_HELP = "A study, or a folder of answers."
SECOND_HELP = "Another one: the report is on what differs."
OUT_HELP = "Folder of the report [default: that of the answers; report for two; none with --json]."
TWO = "report"
"""Default folder of the report of two answers."""
PDF_HELP = "Also write report.pdf; needs the extra pdf."
CHAIN = ("bearing", "traction", "restitution")
"""Verbs that take seconds: computed for the report of a folder that lacks them."""

DAMAGE = (KeyError, IndexError, TypeError, AttributeError, ValueError)
"""What a document lacks that was edited, or is of another version."""

UNFINISHED = "no report was written. Run the same command to resume."

KEYS = ("name", "verdict", "rank", "margin", "probability_stable", "probability_low", "probability_high")


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportOptions:
    """What follows the study or folder on the command line."""

    out: Path | None
    pdf: bool
    json: bool
    quiet: bool
    jobs: int


def report(asked: str, second: str | None, options: ReportOptions) -> int:
    """Write the report of a study, of a folder, or of two answers, and return the exit status.

    Raises
    ------
    InputError
        Neither, or what is there cannot be read or written; nothing was written then.
    """
    from separatrix.reporting.content import report_of
    from separatrix.reporting.kept import answers_of
    from separatrix.reporting.pdf import typesetter
    from separatrix.study_file import shipped_studies

    if options.pdf:
        if options.json and options.out is None:
            raise InputError("--pdf", "needs a folder with --json", cure="Give --out DIR.")
        typesetter()
    writes = options.out is not None or not options.json
    if second is not None:
        return _report_of_two(asked, second, options, writes=writes)
    with contextlib.ExitStack() as stack:
        if Path(asked).is_dir() and asked not in shipped_studies():
            folder = (options.out or Path(asked)) if writes else None
            if folder is not None:
                stack.enter_context(writable_folder(folder))
            made = _report_of_folder(Path(asked), options)
        else:
            study, notes = _read(asked)
            folder = (options.out or Path(study.name)) if writes else None
            if folder is not None:
                stack.enter_context(writable_folder(folder))
            kept, missing, complete = answers_of(study, folder, _computing(study, notes, folder, options))
            if not complete:
                return interrupted(UNFINISHED)
            made = report_of(kept, missing)
        _deliver(made, folder, options)
    return ANSWERED


def _report_of_folder(folder: Path, options: ReportOptions) -> Report:
    """Return the report of a folder; one whose documents were edited is refused."""
    from separatrix.reporting.content import report_of

    kept, missing = _of_folder(folder, options)
    try:
        return report_of(kept, missing)
    except DAMAGE as error:
        if isinstance(error, InputError):
            raise
        cure = "Compute the answers again, with this version."
        raise InputError(str(folder), "holds an answer that is not complete", repr(error), cure) from error


def _report_of_two(first: str, second: str, options: ReportOptions, *, writes: bool) -> int:
    from separatrix.reporting.two import report_of_two

    folder = (options.out or Path(TWO)) if writes else None
    with contextlib.nullcontext() if folder is None else writable_folder(folder):
        sides = [(asked, _read_side(asked)) for asked in (first, second)]  # a fault of either comes first
        both = [_answers(asked, side, options, writes=writes) for asked, side in sides]
        if not all(both):
            return interrupted(UNFINISHED)
        _deliver(report_of_two(*both), folder, options)
    return ANSWERED


def _read_side(asked: str) -> dict[str, Saved] | tuple[Study, list[str]]:
    """Return the answers of one of two by verb, or its study with what was noted."""
    from separatrix.comparing.saved import ENDINGS, read_answers
    from separatrix.study_file import shipped_studies

    path = Path(asked)
    kept = path.suffix.casefold() in ENDINGS or (path.is_dir() and asked not in shipped_studies())
    return read_answers(path) if kept else _read(asked)


def _answers(
    asked: str, side: dict[str, Saved] | tuple[Study, list[str]], options: ReportOptions, *, writes: bool
) -> dict[str, Saved]:
    """Return the answers of one of two; those of a study are computed, none if that was interrupted."""
    from separatrix.comparing.saved import Saved
    from separatrix.reporting.kept import answers_of

    if isinstance(side, dict):
        return side
    study, notes = side
    folder = Path(study.name) if writes else None
    with contextlib.nullcontext() if folder is None else writable_folder(folder):
        kept, _, complete = answers_of(study, folder, _computing(study, notes, folder, options))
    both = ((verb, one.document, one.data) for verb, one in kept.items() if complete)
    return {verb: Saved(path=asked, verb=verb, document=found, data=data) for verb, found, data in both}


def _read(asked: str) -> tuple[Study, list[str]]:
    """Return a study with what was noted when it was read."""
    from separatrix.study_file import read_study

    with noted_warnings() as notes:
        return read_study(asked), notes


def _of_folder(folder: Path, options: ReportOptions) -> tuple[dict[str, Kept], list[str]]:
    """Return the answers of a folder, and of the chain those that it lacks, if its study can be read back."""
    from separatrix.reporting.kept import NEEDED, add_missing, read_folder, verbs_of

    found, missing = read_folder(folder), list[str]()
    study = _read_back(next(iter(found.values())).document, str(folder))
    if study is not None:
        wanted = [verb for verb in verbs_of(study) if verb in CHAIN]
        missing = add_missing(found, wanted, _computing(study, [], None, options))
    return {verb: found[verb] for verb in NEEDED if verb in found}, missing


def _read_back(document: Mapping[str, Any], where: str) -> Study | None:
    """Return the study of an answer, from the files that it keeps; None where that gives another one."""
    from separatrix.cli.reproducing import kept_of, models_of, restored_study
    from separatrix.comparing.saved import Saved
    from separatrix.present import plain
    from separatrix.study import with_models
    from separatrix.study_file import read_study, resolved

    saved = Saved(path=where, verb=str(document["verb"]), document=document)
    verb = verb_named(saved.verb)
    try:
        kept = kept_of(saved)
        with noted_warnings(), restored_study(kept, where) as (entry, _, _):
            study = read_study(entry)
        models = models_of(verb, kept["command"].get("models"))
        study = with_models(study, models) if models else study
    except InputError:  # it keeps no files, or those of another version
        return None
    return study if plain(resolved(study), "study") == document["study"] else None


def _computing(
    study: Study, notes: list[str], folder: Path | None, options: ReportOptions
) -> Callable[[str], Kept]:
    """Return what computes one answer and writes its files if there is a folder."""
    from separatrix.reporting.kept import keep

    asked = Options(json=options.json, out=folder, quiet=options.quiet, jobs=options.jobs)

    def compute(verb: str) -> Kept:
        with noted_warnings() as own:
            made = computed_with_progress(verb_named(verb), study, asked, folder)
        return keep(verb, made, [*notes, *grouped(own)], folder)

    return compute


def _deliver(found: Report, folder: Path | None, options: ReportOptions) -> None:
    """Write the files, then print the answer and where they are."""
    files: list[Path] = []
    if folder is not None:
        contents = {"report.html": found.html().encode()} | (
            {"report.pdf": found.pdf()} if options.pdf else {}
        )
        with staged(folder) as stage:
            for name, content in contents.items():
                (stage / name).write_bytes(content)
        files = [folder / name for name in contents]
    if options.json:
        answer(json.dumps(_document(found, files), indent=1, allow_nan=False) + "\n")
        return
    lines = [harmless(one) for one in found.lead]
    if files and not options.quiet:
        lines += ["", f"The report is {' and '.join(map(str, files))}"]
    answer("\n".join(lines) + "\n")


def _document(found: Report, files: list[Path]) -> dict[str, Any]:
    """Return a report as one JSON document, with the verdicts under the names that `rank` has."""
    from separatrix import __version__
    from separatrix.reporting.record import as_data
    from separatrix.reporting.words import own_rows

    head = {"separatrix_version": __version__, "verb": "report", "title": found.title}
    tail = {"files": [str(path) for path in files], "report": as_data(found)}
    if not found.documents:  # of two answers
        return {**head, "summary": list(found.lead), **tail}
    rank: Mapping[str, Any] | None = found.documents.get("rank")
    first = next(iter(found.documents.values()))
    rows = [] if rank is None else own_rows(rank)
    return {
        **head,
        "name": first["name"],
        "answers": [*found.documents],
        "summary": list(found.lead),
        "environment": None if rank is None else rank["environment"],
        "materials": [{key: row.get(key) for key in KEYS} for row in rows],
        **tail,
    }
