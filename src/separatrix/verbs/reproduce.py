"""`reproduce`: saved answers computed again from the study that they keep, and compared in every value."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from separatrix import __version__
from separatrix.ground.errors import InputError
from separatrix.ground.plain_data import Document, Part
from separatrix.ground.quantity import ABSENT, Quantity
from separatrix.ground.toml import path_text
from separatrix.ground.units import printable, shown
from separatrix.present.blocks import Block, Cell, Column, Note, Page, Table, text_column
from separatrix.verbs import verb_named
from separatrix.verbs.answer_files import is_number, read_answers, refusing_damage
from separatrix.verbs.verb import Option, Tool, Verb, shown_options

if TYPE_CHECKING:
    from separatrix.verdict.long_jobs import Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What `reproduce` takes."""

    result: Annotated[Path, Option("Folder of answers, the .json of one, or a report.", "RESULT", True)]


DIFFERENT = "different"
ROUNDING = 1e-9
"""Relative difference up to which numbers are equal to rounding; a change of an input is far larger."""

MOST_SHOWN = 20
IGNORED = ("separatrix_version", "provenance", "warnings", "notes", "units")
"""Keys of a document that are not the answer: warnings name the lines of files."""


def compute(options: Options, jobs: int = 1, progress: Progress | None = None) -> Document:
    """Compute the answers of a folder or file again, and compare them."""
    where = path_text(options.result)
    found = []
    for one in read_answers(options.result).values():
        with refusing_damage(where):
            found.append(_again(one, where, jobs, progress))
    same = all(one["agreement"] != DIFFERENT for one in found)
    return {"separatrix_version": __version__, "verb": "reproduce", "same": same, "answers": found}


def _again(stored: Document, where: str, jobs: int, progress: Progress | None) -> Document:
    from separatrix.study.reading import require, study_again
    from separatrix.verbs import computed
    from separatrix.verbs.answer_files import document
    from separatrix.verdict.long_jobs import Interrupted

    kept = stored.get("provenance")
    if not isinstance(kept, dict) or not isinstance(kept.get("command"), dict):
        raise InputError(where, "has no provenance", cure="Answer its question again.")
    if not isinstance(kept.get("study"), dict):
        raise InputError(where, "does not keep its study", cure=printable(kept.get("reason") or "", 200))
    if stored.get("complete") is False:
        raise InputError(where, "was interrupted", cure="Resume it: run its command again.")
    verb, study = verb_named(stored["verb"]), study_again(kept["study"])
    options = options_from(verb, kept["command"].get("question"))
    require(study, verb.name, *verb.needs)
    found = computed(verb, study, options, jobs=jobs, progress=progress)
    if not found.is_complete:  # what was finished cannot be compared
        raise Interrupted
    known = {"verb": verb.name, "name": study.name, "title": study.title}
    again = json.loads(json.dumps(document(verb, found)))
    return known | agreement(stored, again) | {"versions": [*_versions(stored, kept)]}


def options_from(verb: Verb, given: object) -> Any:
    """Return the options of a verb from an answer, each of its type; the verb judges their values."""
    from pydantic import TypeAdapter, ValidationError

    if not isinstance(given, dict):
        raise InputError("question", "must be the options of the verb", shown(given))
    known, found = shown_options(verb.options), {}
    for name, value in given.items():
        option = f"--{printable(str(name), 40)}"
        if name not in known and value is None:  # of an earlier version, and not asked for
            continue
        if name not in known:
            raise InputError(option, f"is not an option of {verb.name}")
        try:
            found[name] = TypeAdapter(known[name][0]).validate_json(json.dumps(value), strict=True)
        except ValidationError:
            raise InputError(option, "has a value that is not one of this option", shown(value)) from None
    return verb.options(**found)


def agreement(stored: Document, computed: Document) -> Document:
    """Compare two documents in their values; not in their versions, provenance and warnings."""
    found = [*_differing(stored, computed, "", None)]
    beyond = [one for one in found if one["relative"] is None or one["relative"] > ROUNDING]
    words = DIFFERENT if beyond else "to rounding" if found else "bit for bit"
    shown = beyond or sorted(found, key=itemgetter("relative"), reverse=True)
    return {"agreement": words, "count": len(beyond), "differences": shown[:MOST_SHOWN]}


def _differing(a: object, b: object, key: str, scale: float | None) -> Iterator[Document]:
    """Yield what differs; numbers of a list are compared with the largest of that list."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for name in {**a, **b}:
            if name not in IGNORED:
                path = f"{key}.{name}".removeprefix(".")
                yield from _differing(a.get(name, ...), b.get(name, ...), path, None)
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        size = max((abs(one) for one in (*a, *b) if is_number(one)), default=None)
        for i, (one, other) in enumerate(zip(a, b, strict=True)):
            yield from _differing(one, other, f"{key}[{i}]", size)
    elif a != b or isinstance(a, bool) != isinstance(b, bool):
        relative = abs(a - b) / (scale or max(abs(a), abs(b))) if is_number(a) and is_number(b) else None
        yield {"key": key, "stored": _short(a), "computed": _short(b), "relative": relative}


def _short(value: object) -> object:
    if isinstance(value, Mapping | list):
        return f"{len(value)} {'values' if isinstance(value, list) else 'keys'}"
    return None if value is ... else value


def _versions(stored: Document, kept: Document) -> Iterator[Document]:
    """Yield each version that is another one here; null where the answer does not state it."""
    from separatrix.study.sources import versions

    before = {"separatrix": stored["separatrix_version"], **(kept.get("versions") or {})}
    for name, here in {"separatrix": __version__, **versions()}.items():
        if before.get(name) != here:
            yield {"name": name, "stored": printable(str(before.get(name) or "unknown"), 40), "here": here}


# --- the page -----------------------------------------------------------------------------------
RELATIVE = Quantity(label="relative difference", form=".2g")


def page(answer: Part) -> Page:
    """Return the page of `reproduce`: a line for each answer, and what differs."""
    return Page(
        "Answers computed again",
        f"Computed by separatrix {answer.separatrix_version}",
        tuple(block for one in answer.answers for block in _blocks(one)),
    )


def _blocks(one: Part) -> Iterator[Block]:
    differ = "value differs" if one.count == 1 else "values differ"
    how = f"different: {one.count} {differ}" if one.count else f"the same, {one.agreement}"
    yield Note(f"{one.verb} {one.name}: {how}.", "lead")
    caption = f"{one.count - MOST_SHOWN} more." if one.count > MOST_SHOWN else ""
    yield Table(f"{one.verb} differs", COLUMNS, tuple(one.differences or ()), caption)
    if others := [f"{at.name} {at.here} (then {at.stored})" for at in one.versions or ()]:
        yield Note(f"Other versions here: {', '.join(others)}.")


def _words(value: object) -> str:
    return ABSENT if value is None else printable(str(value), 60)


COLUMNS = (
    text_column("key", lambda row: row.key),
    text_column("in the answer", lambda row: _words(row.stored)),
    text_column("now", lambda row: _words(row.computed)),
    Column("relative difference", lambda row: Cell(row.relative, RELATIVE)),
)

VERB = Tool(
    name="reproduce",
    compute=compute,
    page=page,
    epilog="The study is the one that the answer keeps, with the texts of the files that it names; the same "
    "verb runs with the same options. RESULT is a folder, the .json of an answer, or a report (.html).",
    options=Options,
    rows="answers",
    takes_time=True,
)
