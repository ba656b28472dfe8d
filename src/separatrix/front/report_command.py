"""The verb `report`: the answers of a study or of a folder as one document to hand over."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from separatrix.comparing.saved import DAMAGE
from separatrix.front.console import answer, answer_json, interrupted, interruptible
from separatrix.front.verb_commands import (
    ANSWERED,
    Jobs,
    Json,
    Quiet,
    computed_with_progress,
    folder,
    threads,
)
from separatrix.ground.errors import InputError, harmless
from separatrix.ground.files import writable_folder
from separatrix.verbs import Computed

if TYPE_CHECKING:
    from separatrix.comparing.saved import Document, Saved
    from separatrix.reporting.record import Kept, Report
    from separatrix.study.study import Study

    Compute = Callable[..., Computed]
    """`computed_with_progress`, with its options."""

HELP = "Everything on one study as a document: HTML, and PDF with --pdf."
EPILOG = (
    "Of a folder: from the answers in it; nothing long is computed. Of a study: bearing, traction, "
    "restitution and rank (without [ranking]: stability) are computed into its folder first; answers to the "
    "same inputs that are there already are taken. Of two, each a study, a folder, a .json or a .html file: "
    "what changed, by more than counting noise or not. The HTML needs no other file and no network."
)
ASKED_HELP = "A study, or a folder of answers."
SECOND_HELP = "Another one: the report is on what differs."
OUT_HELP = "Folder of the report [default: that of the answers; report for two; none with --json]."
PDF_HELP = "Also write report.pdf; needs the extra pdf."
CHAIN = ("bearing", "traction", "restitution")
"""Verbs that take seconds: computed for the report of a folder that lacks them."""

UNFINISHED = "no report was written. Run the same command to resume."

KEYS = ("name", "verdict", "rank", "margin", "probability_stable", "probability_low", "probability_high")


@interruptible("no report was written.")
def report(
    asked: Annotated[str, typer.Argument(metavar="STUDY|FOLDER", help=ASKED_HELP)],
    second: Annotated[
        str | None, typer.Argument(metavar="[STUDY|FOLDER]", help=SECOND_HELP, show_default=False)
    ] = None,
    pdf: Annotated[bool, typer.Option("--pdf", help=PDF_HELP)] = False,
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help=OUT_HELP)] = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    """Write the report of a study, of a folder, or of two answers, and return the exit status."""
    to, compute = folder(out), partial(computed_with_progress, question={}, quiet=quiet, jobs=threads(jobs))
    from separatrix.reporting.formats import typesetter, write
    from separatrix.study.reading import read_study
    from separatrix.study.study import shipped_studies

    if pdf:
        if json and to is None:
            raise InputError("--pdf", "needs a folder with --json", cure="Give --out DIR.")
        typesetter()
    writes = to is not None or not json
    with contextlib.ExitStack() as stack:

        def written_to(usual: str | Path) -> Path | None:
            place = (to or Path(usual)) if writes else None
            return None if place is None else stack.enter_context(writable_folder(place))

        place: Path | None
        made: Report | None
        if second is not None:
            place = written_to("report")
            made = _of_two((asked, second), compute, writes=writes)
        elif Path(asked).is_dir() and asked not in shipped_studies():
            place = written_to(asked)
            made = _of_folder(Path(asked), compute)
        else:
            study = read_study(asked)
            place = written_to(study.name)
            made = _of_study(study, place, compute)
        if made is None:
            return interrupted(UNFINISHED)
        files = [] if place is None else write(made, place, with_pdf=pdf)
        if json:
            answer_json(_document(made, files))
        else:
            lines = [harmless(one) for one in made.lead]
            if files and not quiet:
                lines += ["", f"The report is {' and '.join(map(str, files))}"]
            answer("\n".join(lines) + "\n")
    return ANSWERED


def _answers(study: Study, folder: Path | None, compute: Compute) -> tuple[dict[str, Kept], list[str], bool]:
    from separatrix.reporting.content import answers_of, keeping

    return answers_of(study, folder, keeping(lambda verb: compute(verb, study, folder=folder), folder))


def _of_study(study: Study, folder: Path | None, compute: Compute) -> Report | None:
    """Return the report of a study; None if that was interrupted."""
    from separatrix.reporting.content import report_of

    kept, missing, is_complete = _answers(study, folder, compute)
    return report_of(kept, missing) if is_complete else None


def _of_folder(folder: Path, compute: Compute) -> Report:
    """Return the report of a folder, with what its chain lacks if its study can be read back.

    One whose documents were edited is refused.
    """
    from separatrix.reporting.content import NEEDED, add_missing, keeping, read_folder, report_of, verbs_of

    found, missing = read_folder(folder), list[str]()
    study = _read_back(next(iter(found.values())).document, str(folder))
    if study is not None:
        wanted = [verb for verb in verbs_of(study) if verb in CHAIN]
        missing = add_missing(found, wanted, keeping(partial(compute, study=study, folder=None), None))
    try:
        return report_of({verb: found[verb] for verb in NEEDED if verb in found}, missing)
    except DAMAGE as error:
        if isinstance(error, InputError):
            raise
        cure = "Compute the answers again, with this version."
        raise InputError(str(folder), "contains an incomplete answer", repr(error), cure) from error


def _read_back(document: Document, where: str) -> Study | None:
    """Return the study of an answer, from what it keeps; None where that has another one."""
    from separatrix.comparing.saved import Saved
    from separatrix.front.saved_answer_commands import kept_by
    from separatrix.ground.plain_data import plain
    from separatrix.study.reading import study_again
    from separatrix.study.sources import resolved

    try:
        kept = kept_by(Saved(path=where, verb=str(document["verb"]), document=document))
        study = study_again(kept["study"])
    except InputError:  # it keeps no study, or that of another version
        return None
    return study if plain(resolved(study), "study") == document["study"] else None


def _of_two(asked: tuple[str, str], compute: Compute, *, writes: bool) -> Report | None:
    """Return the report of two designs, each a study or saved answers; None if it was interrupted."""
    from separatrix.reporting.content import report_of_two

    sides = [(one, _read_side(one)) for one in asked]  # a fault of either comes first
    first, second = (_answers_of_side(one, side, compute, writes=writes) for one, side in sides)
    return report_of_two(first, second) if first and second else None


def _read_side(asked: str) -> dict[str, Saved] | Study:
    """Return the answers of one of two by verb, or its study."""
    from separatrix.comparing.saved import ENDINGS, read_answers
    from separatrix.study.reading import read_study
    from separatrix.study.study import shipped_studies

    path = Path(asked)
    kept = path.suffix.casefold() in ENDINGS or (path.is_dir() and asked not in shipped_studies())
    return read_answers(path) if kept else read_study(asked)


def _answers_of_side(
    asked: str, side: dict[str, Saved] | Study, compute: Compute, *, writes: bool
) -> dict[str, Saved]:
    """Return the answers of one of two; those of a study are computed, none if that was interrupted."""
    from separatrix.comparing.saved import Saved

    if isinstance(side, dict):
        return side
    folder = Path(side.name) if writes else None
    with contextlib.nullcontext() if folder is None else writable_folder(folder):
        kept, _, is_complete = _answers(side, folder, compute)
    return {
        verb: Saved(path=asked, verb=verb, document=one.document) for verb, one in kept.items() if is_complete
    }


def _document(found: Report, files: list[Path]) -> dict[str, object]:
    """Return a report as one JSON document, with the verdicts under the names that `rank` has."""
    from separatrix import __version__
    from separatrix.reporting.formats import as_data
    from separatrix.reporting.record import own_rows

    head = {"separatrix_version": __version__, "verb": "report", "title": found.title}
    tail = {"files": [str(path) for path in files], "report": as_data(found)}
    if not found.documents:  # of two answers
        return {**head, "summary": list(found.lead), **tail}
    rank = found.documents.get("rank")
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
