"""The commands on saved answers: `compare` shows two side by side, `reproduce` computes one again."""

from __future__ import annotations

import json as plain_json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from separatrix.comparing.records import Agreement
from separatrix.comparing.saved import Document, Saved, read_answers
from separatrix.front.console import answer, answer_json, interruptible, progress_bar
from separatrix.front.verb_commands import FULL_HELP, OPTIONS, Jobs, Json, Quiet, folder, threads
from separatrix.ground.errors import InputError
from separatrix.ground.files import staged, writable_folder
from separatrix.ground.units import printable, shown
from separatrix.verbs import Verb, computed, verb_named

COMPARE = "Two answers of one verb side by side: what differs, and by more than counting noise?"
COMPARE_EPILOG = "A and B are folders of answers, their .json or .html files, of any verb with a study."


def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="Folder or file of an answer.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another one of the same verb.")],
    full: Annotated[bool, typer.Option("--full", help=FULL_HELP)] = False,
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help="Folder [default: compare].")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No effect: there is no progress bar.")] = False,  # noqa: ARG001
) -> int:
    """Compare two saved answers, draw them together, and return the exit status."""
    to = folder(out) or (None if json else Path("compare"))
    from separatrix.comparing.pair import compared, pair_of
    from separatrix.comparing.shown import comparison_document, in_words, save_comparison

    one, other, also = pair_of(read_answers(first), read_answers(second))
    found = compared(one, other, also)
    if to is not None:
        with writable_folder(to), staged(to) as stage:
            save_comparison(stage, found, one, other)
    if json:
        answer_json(comparison_document(found))
    else:
        where = "" if to is None else f"\nText, data and figures are in {to}/\n"
        answer(in_words(found, full=full) + where)
    return 0


REPRODUCE = "Compute a saved answer again, and report whether it is the same."
REPRODUCE_EPILOG = (
    "The study is the one that the answer keeps, with the texts of the files that it names; the same verb "
    "runs with the same options. RESULT is a folder, the .json of an answer, or a report (.html)."
)
RESULT_HELP = "Folder of answers, the .json of one, or a report."


@dataclass(frozen=True, slots=True, kw_only=True)
class Version:
    """A version that is another one here; None where the answer does not state it."""

    name: str
    stored: str | None
    here: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduced:
    """One answer computed again."""

    verb: str
    name: str
    title: str
    same: bool
    result: Agreement
    versions: tuple[Version, ...]


@interruptible("no answer is compared.")
def reproduce(
    path: Annotated[Path, typer.Argument(metavar="RESULT", help=RESULT_HELP)],
    json: Json = False,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    """Compute the answers of a folder or file again, and return the exit status."""
    from separatrix import __version__
    from separatrix.ground.plain_data import plain

    count = threads(jobs)
    found = [_again(saved, quiet, count) for saved in read_answers(path).values()]
    if json:
        head = {
            "separatrix_version": __version__,
            "verb": "reproduce",
            "same": all(one.same for one in found),
        }
        answer_json({**head, "answers": plain(found)})
    else:
        answer("\n".join(line for one in found for line in _lines(one)) + "\n")
    return 0


def _again(saved: Saved, quiet: bool, jobs: int) -> Reproduced:
    from separatrix.comparing.pair import agreement
    from separatrix.study.reading import require, study_again
    from separatrix.verbs.answer_files import document
    from separatrix.verdict.long_jobs import Interrupted

    stored, kept = saved.document, kept_by(saved)
    if stored.get("complete") is False:
        raise InputError(saved.path, "was interrupted", cure="Resume it: run its command again.")
    verb = verb_named(saved.verb)
    study, question = study_again(kept["study"]), _question(verb, kept["command"].get("question"))
    require(study, verb.name, *verb.needs)
    with progress_bar(f"reproduce {verb.name} {study.name}", quiet=quiet) as progress:
        found = computed(verb, study, question, jobs=jobs, progress=progress)
    if not found.is_complete:
        raise Interrupted
    made = document(verb.name, found.record, found.study, found.question)
    result = agreement(stored, plain_json.loads(plain_json.dumps(made)))
    versions = tuple(_versions(stored, kept))
    return Reproduced(
        verb=verb.name, name=study.name, title=study.title, same=result.same, result=result, versions=versions
    )


def kept_by(saved: Saved) -> Document:
    """Provenance of an answer, with what must be there."""
    kept = saved.document.get("provenance")
    if not isinstance(kept, dict) or not isinstance(kept.get("command"), dict):
        raise InputError(saved.path, "has no provenance", cure="Answer its question again.")
    study = kept.get("study")
    if not isinstance(study, dict):
        why = kept.get("reason")
        raise InputError(saved.path, "does not keep its study", cure=printable(why, 200) if why else "")
    is_right = isinstance(study.get("name"), str) and isinstance(study.get("data"), dict)
    for one in (study.get("files"), study.get("origins")):
        is_right = is_right and isinstance(one, dict) and all(isinstance(x, str) for x in one.values())
    if not is_right:
        raise InputError(saved.path, "is damaged: provenance.study must have name, data, files and origins")
    return kept


def _question(verb: Verb, given: object) -> dict[str, object]:
    """Options of the verb, each of the type that its command takes; the verb judges their values."""
    if not isinstance(given, dict):
        raise InputError("question", "must be the options of the verb", shown(given))
    found: dict[str, object] = {}
    for name, value in given.items():
        if name not in verb.question:
            raise InputError(f"--{printable(name, 40)}", f"is not an option of {verb.name}")
        if name == "animate":
            continue
        if not _is_right(name, value):
            raise InputError(f"--{name}", "has a value that is not one of this option", shown(value))
        found[name] = tuple(value) if name == "vary" else value
    return found


def _is_right(name: str, value: object) -> bool:
    default = OPTIONS[name][1]
    if name in ("kick", "restitution_factor"):
        return value is None or (isinstance(value, str | int | float) and not isinstance(value, bool))
    if name == "vary":
        return isinstance(value, list) and all(isinstance(v, str) for v in value)
    if name == "cases":
        return value is None or (isinstance(value, list) and all(map(_is_case, value)))
    return type(value) is type(default)


def _is_case(value: object) -> bool:
    return isinstance(value, dict) and all(type(number) in (int, float) for number in value.values())


def _versions(stored: Document, kept: Document) -> Iterator[Version]:
    from separatrix import __version__
    from separatrix.study.sources import versions

    given = kept.get("versions")
    before = {"separatrix": stored.get("separatrix_version"), **(given if isinstance(given, dict) else {})}
    for name, here in {"separatrix": __version__, **versions()}.items():
        if before.get(name) != here:
            value = before.get(name)
            yield Version(name=name, stored=printable(str(value), 40) if value else None, here=here)


def _lines(one: Reproduced) -> Iterator[str]:
    found = one.result
    verdict = "the same" if one.same else "different"
    differ = "value differs" if found.count == 1 else "values differ"
    how = f", {found.agreement}" if found.same else f": {found.count} {differ}"
    yield f"{one.verb} {one.name}: {verdict}{how}."
    if found.largest_at is not None:
        yield f"  Largest relative difference {found.largest_difference:.2g}, of {found.largest_at}."
    for at in found.differences[:5]:
        yield f"  {at.key}: {_text(at.stored)} in the answer, {_text(at.computed)} now"
    if found.count > 5:
        yield f"  and {found.count - 5} more; --json shows the first {len(found.differences)}."
    if one.versions:
        others = [f"{at.name} {at.here} (then {at.stored or 'unknown'})" for at in one.versions]
        yield f"  Other versions here: {', '.join(others)}."


def _text(value: object) -> str:
    return "nothing" if value is None else printable(str(value), 60)
