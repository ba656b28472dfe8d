"""Mutated studies and logs: each is answered or refused, and a change without meaning changes no answer.

    python benchmarks/mutants.py studies|logs COUNT [FIRST] [FILES...]

A number is the same mutant in every run. FIRST and those after it are made, COUNT in all, from the files of
package and tests and from FILES. One in ten has a change without meaning, and must have the answer of its
seed; the others have one that may have a meaning, or several, two on average. A study is answered as by
`check` and `bearing`, some as by `restitution`; with the exact contact, which takes seconds, only a few. A
log is reduced as by `tribometer`, and once more with the draft of a column map that it got.

A fault, shown with its number, is an error other than a refusal in lines of where, rule and cure, a warning
of Python, a number that is not finite, more than `LONGEST`, or another answer where nothing was meant.
"""

import faulthandler
import io
import json
import re
import resource
import sys
import tempfile
import time
import traceback
import warnings
import zipfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from decimal import Decimal
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "unit"))
import raw_logs
import rich_studies
import test_tribometer_layouts as layouts
import test_tribometer_reading as reading
import test_tribometer_workbooks as workbooks
from commands import message_of
from minimal_xlsx import workbook, zipped
from test_reader_mutants import CHANGES, PAIR, changed_at

from separatrix.ground.errors import InputError, SeparatrixError, json_text
from separatrix.present.text import text as page_text
from separatrix.study.reading import read_study
from separatrix.study.study import shipped_studies
from separatrix.verbs import computed, tool_named, verb_named
from separatrix.verbs.answer_files import asked_by, document, page_of_document

LONGEST = 10.0
"""Processor time from which a mutant is a fault [s]."""

MEMORY = 6 * 1024**3
"""Address space of a worker [bytes]."""

NEUTRAL_ONE, RESTITUTION, EXACT = 10, 50, 1000
"""One in so many has a change without meaning, is answered by `restitution`, with the exact contact."""

AT_ONCE = 100
"""Mutants of one task of a worker."""

Rng = np.random.Generator
More = tuple[Path, ...]


@cache
def seeds(kind: str, more: More) -> dict[str, bytes]:
    """Return the files that are mutated: shipped and rich studies, or every layout of logs of the tests."""
    if kind == "studies":
        found = {path.name: path.read_bytes() for path in shipped_studies().values()}
        found |= {"space.toml": rich_studies.SPACE.encode(), "plane.toml": rich_studies.PLANE.encode()}
    else:
        texts = [*reading.THE_SAME.values(), reading.GAPS, reading.STROKES, layouts.te67(), layouts.lvm(60)]
        texts += [layouts.umt(1), layouts.FORCE_ONLY, *layouts.SECOND.values(), *layouts.EDITED.values()]
        texts += [layouts.reciprocating(10, is_sine=sine) for sine in (True, False)]
        texts += [raw_logs.umt(reading.FRICTION, reading.TIME, steps=2, reciprocating=True)]
        logs = [one[0] if isinstance(one, tuple) else one for one in texts]
        books = [one if isinstance(one, bytes) else workbook(one) for one in workbooks.READ.values()]
        coded = [one.encode("cp1252") if isinstance(one, str) else one for one in logs]
        found = {f"{i}.{'xlsx' if one[:2] == b'PK' else 'txt'}": one for i, one in enumerate(coded + books)}
    return found | {path.name[-20:]: path.read_bytes() for path in more}


# Changes of a text, which has a character for each byte.

NUMBER = r"(?<![\w.])\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"
PLACES = (NUMBER, r"[^\W\d]\w*", r'"[^"\n]*"', r"(?<= = )[^\n]+", r"[^\t;,|\n]+", r"[^\n]*\n")
PLACES += (r"(?:[^\n]+\n)+", r"(?s:.{1,200})", r"(?s:.)", r"(?s:.)")
"""What is removed, doubled or replaced: numbers, words, texts, values, fields, lines, paragraphs, bytes."""

ODD = (
    "0 -0.0 -1 1e308 -1e308 1e-308 5e-324 1e999 nan inf -inf 1_0 0x1f 1,5 1.5.2 + 1e-9 1e12 12:30 true "
    '1979-05-27 "x" "5" [] [[[[1]]]] {} {mean=1,count="2"} """ \' \\ # %s {0} $x^2$ ../../etc <b> =1+1 \0 \r '
    "\t \n\n \x1b[31m \u00b5 \u00b2 \u2212 \u0660 \uff11 \u202e \u200b \ufeff \U0001f600 \u0130 \u00df  "
) + " ".join(("9" * 400, "1" * 5000, "[" * 3000, "a." * 2000 + "a", "LONG"))
LONG = 100_000
"""Characters that are written for LONG."""


def pick(rng: Rng, of: Any) -> Any:
    """Return one of a sequence."""
    return of[rng.integers(len(of))]


@cache
def others(kind: str, more: More, place: str) -> list[str]:
    """Return what is at the places of a sort in all files of text."""
    texts = [of.decode("latin-1") for of in seeds(kind, more).values() if of[:2] != b"PK"]
    return list(dict.fromkeys(found for text in texts for found in re.findall(place, text)[:2000]))


def changed(text: str, rng: Rng, kind: str, more: More) -> str:
    """Return the text with one change that may have a meaning."""
    if kind == "studies" and rng.random() < 0.3 and (pairs := [*PAIR.finditer(text)]):
        return changed_at(text, pick(rng, pairs), pick(rng, [*CHANGES]))
    place = NUMBER if (is_scaled := rng.random() < 0.3) else pick(rng, PLACES)
    if not (found := [*re.finditer(place, text)]):
        return text
    at, odd = pick(rng, found), pick(rng, ODD.split(" ")).encode().decode("latin-1")
    another = pick(rng, others(kind, more, place))
    new = pick(rng, (odd, odd, another, another, "", at[0] * 2, chr(rng.integers(256))))
    new = f"{float(at[0]) * 10 ** rng.uniform(-3.0, 3.0):.4g}" if is_scaled else new
    return text[: at.start()] + new + text[at.end() :]


def in_utf_16(text: str) -> str:
    """Return the text in another encoding, if it is in UTF-8."""
    try:
        return ("\ufeff" + text.encode("latin-1").decode()).encode("utf-16-le").decode("latin-1")
    except UnicodeDecodeError:
        return text


NEUTRAL = {
    "studies": (
        lambda text: "# a remark\n" + text.replace("\n", "\n\n# another = 1\n", 3),
        lambda text: text.replace("\n", "\r\n"),
        lambda text: re.sub(r"(?m)^(\w+) = (.*)$", r"\t\1   =  \2\t# a = remark", text),
        lambda text: re.sub(r'"([^"\n]*)"', r"'\1'", text),
        lambda text: re.sub(r"([0-9.]+) mm\b", lambda of: f"{1000 * Decimal(of[1])} um", text),
        lambda text: re.sub(r"(?m)^(\w+ = [0-9]+\.[0-9]+)", r"\g<1>00", text),
        lambda text: "".join(sorted(re.split(r"(?m)^(?=\[)", text), key=lambda one: one.startswith("[op"))),
    ),
    "logs": (
        lambda text: text + "\n\n",
        lambda text: text.rstrip("\r\n"),
        lambda text: text.replace("\r\n", "\n").replace("\r", "\n"),
        lambda text: text.replace("\r\n", "\n").replace("\r", "\n").replace("\n", "\r\n"),
        in_utf_16,
    ),
}


def mutant(kind: str, more: More, number: int) -> tuple[str, bytes]:
    """Return name of the seed and bytes of a mutant."""
    rng = np.random.default_rng([number, kind == "logs"])
    name, content = pick(rng, [*seeds(kind, more).items()])
    is_neutral, part, parts = number % NEUTRAL_ONE == 0, "", {}
    if content[:2] == b"PK" and (is_neutral or rng.random() < 0.8):  # packed anew, it is a workbook again
        with zipfile.ZipFile(io.BytesIO(content)) as book:
            parts = {one: book.read(one) for one in book.namelist()}
        part = pick(rng, [one for one in parts if "sheet" in one or rng.random() < 0.2])
        content = parts[part]
    text = content.decode("latin-1")
    if not is_neutral:
        for _ in range(rng.geometric(0.5)):
            text = changed(text, rng, kind, more)
        text = text.replace("LONG", "x" * LONG)  # at last: patterns take the square of a line's length
    elif not parts and "\0" not in text:  # not in UTF-16 already
        text = pick(rng, NEUTRAL[kind])(text)
    return name, zipped(parts | {part: text.encode("latin-1")}) if parts else text.encode("latin-1")


# Answers.


def answer_to_study(path: Path, number: int) -> tuple[str, list[Any]]:
    """Return what came of a study, and its answers."""
    study = read_study(path)
    if study.traction.model.value == "exact" and number % EXACT:
        return "read, exact contact not computed", [asked_by(study)]
    answers, refused = [], ""
    for verb in map(verb_named, ("check", "bearing", *["restitution"] * (number % RESTITUTION == 0))):
        try:
            if not any(getattr(study, section) is None for section in verb.needs):
                found = document(verb, computed(verb, study))
                assert "not finite" not in str(found["warnings"]), found["warnings"]
                answers.append((json_text(found), page_text(page_of_document(verb, found)), found)[-1])
        except SeparatrixError as error:
            refused = f", {verb.name} refused ({type(error).__name__})"
            if isinstance(error, InputError):
                message_of(error)
    return f"read and answered{refused}", answers


def answer_to_log(path: Path, _number: int) -> tuple[str, list[Any]]:
    """Return what came of a log, and its answer."""
    tool, draft = tool_named("tribometer"), path.with_name(f"{path.name}.map.toml")
    outcome = "reduced"
    try:
        found = tool.compute(tool.options(files=(path,)))
    except InputError as error:
        if not draft.exists():
            raise
        message_of(error)
        try:
            outcome = "reduced with the draft of a column map"
            found = tool.compute(tool.options(files=(path,), column_map=draft))
        except InputError as again:
            return "a draft with open questions", [message_of(again), draft.read_text("utf-8")]
    return outcome, [(json_text(found), page_text(page_of_document(tool, found)), found)[-1]]


def compared(value: Any) -> Any:
    """Return an answer without what states how the file was written."""
    if isinstance(value, dict):
        known = {"origin", "provenance", "checksum", "format"}
        return {key: compared(one) for key, one in value.items() if key not in known}
    if isinstance(value, list):
        return [compared(one) for one in value]
    return re.sub(r"line \d+", "line", value) if isinstance(value, str) else value


def answered(kind: str, name: str, content: bytes, number: int) -> tuple[str, str]:
    """Return what came of a file with this content, and its answer as text."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        try:
            found, answers = {"studies": answer_to_study, "logs": answer_to_log}[kind](path, number)
        except InputError as refusal:
            said = message_of(refusal)
            return "refused as TOML" if "is not valid TOML" in said else "refused", said
        return found, json.dumps(compared(answers)).replace(folder, "")


@cache
def answer_of_seed(kind: str, more: More, name: str, number: int) -> tuple[str, str]:
    """Return the answer to a seed as it is."""
    return answered(kind, name, seeds(kind, more)[name], number)


def tried(kind: str, more: More, numbers: range) -> tuple[Counter[str], list[str], float]:
    """Return how often each came out of these mutants, the faults, and the longest time."""
    outcomes, faults, longest = Counter(), [], 0.0
    for number in numbers:
        name, content = mutant(kind, more, number)
        begin = time.process_time()
        faulthandler.dump_traceback_later(20 * LONGEST, exit=True)  # of one that hangs
        try:
            found = answered(kind, name, content, number)
            longest = max(longest, taken := time.process_time() - begin)
            assert taken < LONGEST, f"took {taken:.1f} s"
            if is_neutral := number % NEUTRAL_ONE == 0:
                of = next(one for one in (EXACT, RESTITUTION, NEUTRAL_ONE) if number % one == 0)
                assert found == answer_of_seed(kind, more, name, of), found[1][:1000]
            outcomes["no meaning: " * is_neutral + found[0]] += 1
        except Exception:  # noqa: BLE001 - every one is a fault of the program
            outcomes["FAULT"] += 1
            faults.append(f"mutant {number} of {name}:\n{traceback.format_exc()}")
    faulthandler.cancel_dump_traceback_later()
    return outcomes, faults, longest


def prepared(kind: str, more: More) -> None:
    """Make a warning an error in a worker, and memory without end, too; load what the seeds need."""
    warnings.simplefilter("error")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for name in seeds(kind, more):
        answer_of_seed(kind, more, name, EXACT)


def main(kind: str, count: int, first: int, more: More) -> int:
    """Print each fault, and how often each outcome came; return the number of faults."""
    start, outcomes, longest = time.monotonic(), Counter(), 0.0
    tasks = [range(i, min(i + AT_ONCE, first + count)) for i in range(first, first + count, AT_ONCE)]
    with ProcessPoolExecutor(2, initializer=prepared, initargs=(kind, more)) as pool:
        for found, faults, most in pool.map(partial(tried, kind, more), tasks):
            outcomes, longest = outcomes + found, max(longest, most)
            print(*faults, sep="\n", end="", flush=True)
    print(*(f"| {outcome} | {times} |" for outcome, times in sorted(outcomes.items())), sep="\n")
    print(f"{count} {kind} in {time.monotonic() - start:.0f} s, the longest {longest:.1f} s")
    return outcomes["FAULT"]


if __name__ == "__main__":
    kind, count, first, *files = [*sys.argv[1:], "0"] if len(sys.argv) < 4 else sys.argv[1:]
    sys.exit(main(kind, int(count), int(first), tuple(map(Path, files))) > 0)
