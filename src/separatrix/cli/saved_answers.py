"""The commands on saved answers: `compare` shows two side by side, `reproduce` computes one again."""

from __future__ import annotations

import base64
import binascii
import contextlib
import hashlib
import json as plain_json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from separatrix.cli.console import answer, answer_json, interruptible, progress_bar
from separatrix.cli.verbs import FULL_HELP, OPTIONS, Jobs, Json, Quiet, folder, threads
from separatrix.comparing.records import Agreement
from separatrix.comparing.saved import Document, Saved, read_answers
from separatrix.ground.errors import InputError
from separatrix.ground.messages import grouped, noted_warnings
from separatrix.ground.staged import staged, writable_folder
from separatrix.ground.units import printable, shown
from separatrix.questions import Verb, asked_study, computed, verb_named

if TYPE_CHECKING:
    from separatrix.study.study import Study

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
    "The study is read from the files that the answer keeps, in a temporary folder; the same verb runs with "
    "the same options. RESULT is a folder, the .json of an answer, or a report (.html)."
)
RESULT_HELP = "Folder of answers, the .json of one, or a report."

MOST_TEXTS = 100
"""Ranges of a sweep, and models."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Version:
    """A version that is another one here; None where the answer does not state it."""

    name: str
    stored: str | None
    here: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduced:
    """One answer computed again. `changed_files` are those that do not have their checksum."""

    verb: str
    name: str
    title: str
    same: bool
    result: Agreement
    versions: tuple[Version, ...]
    changed_files: tuple[str, ...]


@interruptible("no answer is compared.")
def reproduce(
    path: Annotated[Path, typer.Argument(metavar="RESULT", help=RESULT_HELP)],
    json: Json = False,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    """Compute the answers of a folder or file again, and return the exit status."""
    from separatrix import __version__
    from separatrix.present import plain

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
    from separatrix.present import document
    from separatrix.verdict.long_jobs import Interrupted

    stored, kept = saved.document, _kept_by(saved)
    if stored.get("complete") is False:
        raise InputError(saved.path, "was interrupted", cure="Resume it: run its command again.")
    verb = verb_named(saved.verb)
    with noted_warnings() as notes, restored_study(saved) as (study, root, changed):
        question = _question(verb, kept["command"].get("question"), root)
        with progress_bar(f"reproduce {verb.name} {study.name}", quiet=quiet) as progress:
            found = computed(verb, study, question, jobs=jobs, progress=progress)
        if not found.is_complete:
            raise Interrupted
        made = document(verb.name, found.record, found.study, grouped(notes))
    result = agreement(stored, plain_json.loads(plain_json.dumps(made)))
    return Reproduced(
        verb=verb.name,
        name=study.name,
        title=study.title,
        same=result.same and not changed,
        result=result,
        versions=tuple(_versions(stored, kept)),
        changed_files=tuple(changed),
    )


def _kept_by(saved: Saved) -> Document:
    """Provenance of an answer, with what must be there."""
    stored = saved.document
    kept = stored.get("provenance")
    if not isinstance(kept, dict):
        cure = "Only answers since provenance is kept can be computed again."
        raise InputError(saved.path, "has no provenance", cure=cure)
    if not isinstance(kept.get("entry"), str):
        why = kept.get("reason")
        cure = printable(why, 200) if isinstance(why, str) else ""
        raise InputError(saved.path, "does not keep the files of its study", cure=cure)
    for key, kind in (("command", dict), ("files", dict), ("links", dict)):
        if not isinstance(kept.get(key), kind):
            raise InputError(saved.path, f"lacks {key} in its provenance")
    if kept["command"].get("verb") != saved.verb:
        raise InputError(saved.path, "has the command of another verb", shown(kept["command"].get("verb")))
    return kept


@contextlib.contextmanager
def restored_study(saved: Saved) -> Iterator[tuple[Study, Path, list[str]]]:
    """Yield the study of an answer from the files that it keeps, their folder, and names of changed files.

    Raises
    ------
    InputError
        It keeps no files, or other ones than separatrix writes.
    """
    from separatrix.ground.input_files import restored
    from separatrix.study.reading.document import shipped_studies
    from separatrix.study.reading.provenance import SHIPPED, shipped_checksums

    kept, where, verb = _kept_by(saved), saved.path, verb_named(saved.verb)
    files: dict[str, bytes] = {}
    changed: list[str] = []
    shipped = shipped_checksums()
    for name, one in kept["files"].items():
        if not isinstance(one, dict) or not isinstance(one.get("sha256"), str):
            raise InputError(where, "must have a checksum for each file", f'"{printable(name, 80)}"')
        if name.startswith(SHIPPED):
            found = shipped.get(name)
        else:
            files[name] = _content(one, name, where)
            found = hashlib.sha256(files[name]).hexdigest()
        if found != one["sha256"]:
            changed.append(printable(name, 80))
    links, entry = kept["links"], str(kept["entry"])
    if not all(isinstance(name, str) for name in links.values()):
        raise InputError(where, "must have names as links")
    with restored(files, links) as root:
        path = root / entry
        if entry.startswith(SHIPPED):
            known = shipped_studies().get(entry.removeprefix(SHIPPED).removesuffix(".toml"))
            if known is None:
                raise InputError(where, "is of a study that this version does not ship", shown(entry))
            path = known
        elif entry not in files:
            raise InputError(where, "does not keep its study", shown(entry))
        models = kept["command"].get("models")
        takes = ("motion", "ball") if verb.moves_a_cage else ()
        if not isinstance(models, dict) or not all(
            key in takes and isinstance(one, str) for key, one in models.items()
        ):
            raise InputError("models", f"must be models that {verb.name} takes", shown(models))
        yield asked_study(verb, path, models), root, changed


def _content(one: Document, name: str, where: str) -> bytes:
    if isinstance(one.get("text"), str):
        return str(one["text"]).encode("utf-8", "surrogatepass")
    try:
        return base64.b64decode(one.get("base64", 0), validate=True)
    except (TypeError, ValueError, binascii.Error):
        raise InputError(where, "has a file without content", f'"{printable(name, 80)}"') from None


def _question(verb: Verb, given: object, root: Path) -> dict[str, object]:
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
        if name == "cases" and isinstance(value, str):
            if not (root / value).is_file() or not (root / value).resolve().is_relative_to(root.resolve()):
                raise InputError("--cases", "names a table that the answer does not keep", shown(value))
            found[name] = root / value
    return found


def _is_right(name: str, value: object) -> bool:
    default = OPTIONS[name][1]
    if name in ("kick", "restitution_factor"):
        return value is None or (isinstance(value, str | int | float) and not isinstance(value, bool))
    if name == "vary":
        return isinstance(value, list) and len(value) < MOST_TEXTS and all(isinstance(v, str) for v in value)
    if name == "cases":
        is_cases = isinstance(value, list) and all(map(_is_case, value))
        return value is None or isinstance(value, str) or is_cases
    return type(value) is type(default)


def _is_case(value: object) -> bool:
    return isinstance(value, dict) and all(type(number) in (int, float) for number in value.values())


def _versions(stored: Document, kept: Document) -> Iterator[Version]:
    from separatrix import __version__
    from separatrix.study.reading.provenance import versions

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
    if one.changed_files:
        yield f"  Not as they were when it was computed: {', '.join(one.changed_files)}."
    if one.versions:
        others = [f"{at.name} {at.here} (then {at.stored or 'unknown'})" for at in one.versions]
        yield f"  Other versions here: {', '.join(others)}."


def _text(value: object) -> str:
    return "nothing" if value is None else printable(str(value), 60)
