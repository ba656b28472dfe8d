"""The files of answers: documents, and pages as text, HTML, workbook and pictures; and their reading.

Files that are read may come from anybody: documents, folders of them, reports. Each is refused in one line
that names its file. An interrupted answer is read as any other.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeGuard

from separatrix import __version__
from separatrix.ground.errors import InputError, grouped, harmless, json_text
from separatrix.ground.files import size_of, staged, unreadable
from separatrix.ground.plain_data import NOTES, Document, Group, part_of, plain, shape, units_of
from separatrix.ground.toml import path_text
from separatrix.ground.units import printable, shown
from separatrix.verbs.verb import Tool, Verb

if TYPE_CHECKING:
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study
    from separatrix.verbs import Computed


def document(verb: Verb, found: Computed) -> Document:
    """Return an answer as plain data: SI units, no NaN, None where something is absent.

    The resolved inputs of the study go into it with their sources; the notes of study and answer are its
    warnings.
    """
    from separatrix.study.sources import provenance_of
    from separatrix.verbs import chain_answers  # noqa: F401 - with the shapes of its records

    if verb.moves_a_cage:
        from separatrix.verbs import cage_answers  # noqa: F401

    left_out: list[str] = []
    study = found.study
    node = Group(shape(found.record))
    body = plain(node, verb.name, left_out)
    warnings = [*notes_of(found.record, study)]
    if left_out:
        more = f" and {len(left_out) - 1} more" if left_out[1:] else ""
        words = f"A number is not finite and is left out: {left_out[0]}{more}. The inputs are far from those "
        warnings.append(f"{words}of a bearing, or this is a fault of separatrix.")
    return {
        "verb": verb.name,
        "name": study.name,
        "title": study.title,
        **asked_by(study),
        **body,
        "units": units_of(node),
        "warnings": warnings,
        "provenance": plain(provenance_of(study, verb.name, found.question), "provenance"),
    }


def asked_by(study: Study) -> Document:
    """Return what each answer to a study has of the study, with this version."""
    from separatrix.study.sources import resolved

    known = {"separatrix_version": __version__, "seed": study.stability.seed}
    return known | {"study": plain(resolved(study), "study")}


def notes_of(answer: object, asked: Study) -> tuple[str, ...]:
    """Return what an answer and its study note; of those alike but for numbers the first."""
    own: tuple[str, ...] = getattr(answer, NOTES, ())
    return tuple(grouped([*own, *asked.notes]))


def page_of_document(verb: Tool, found: Document, where: str = "The answer") -> Page:
    """Return the page of a document; one that is not what its page takes is refused under `where`."""
    with refusing_damage(where):
        return verb.page(part_of(found, where))


def save_answer(
    folder: Path, asked: Tool, found: Document, *, page: Page | None = None, pictures: bool = True
) -> None:
    """Write the files of an answer into a folder that exists, all or none.

    Of an interrupted one, and of `check`, these are its document and its text; of a tool with `pictures`
    these alone. `page` is that of the document if it has been made already; `pictures` says whether figures,
    and the page with them, are written, too.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    from separatrix.present.blocks import Level
    from separatrix.present.text import text

    page, name = page or page_of_document(asked, found), asked.name
    with staged(folder) as stage:
        if not asked.pictures:
            (stage / f"{name}.json").write_text(harmless(json_text(found) + "\n"), encoding="utf-8")
            (stage / f"{name}.txt").write_text(harmless(text(page, Level.FULL)), encoding="utf-8")
        if not asked.writes_data or found.get("complete") is False:
            return
        from separatrix.present.html import write_drawn
        from separatrix.present.spreadsheet import spreadsheet

        if pictures:
            write_drawn(page, stage, "" if asked.pictures else name)
        if not asked.pictures:
            (stage / f"{name}.xlsx").write_bytes(spreadsheet(page))
        if isinstance(asked, Verb):
            from separatrix.present.dataset import dataset

            dataset(found).to_netcdf(stage / f"{name}.nc", engine="h5netcdf")


# What is read back.

VERBS = (
    *("rank", "sensitivity", "life", "stability", "map", "sweep", "simulate"),
    *("mobility", "restitution", "traction", "bearing", "check"),
)
"""Verbs of a study; of two folders with several, the first that both have is compared."""

REPORTS = (".html", ".htm")
MOST_BYTES = 256 * 1024**2
REPORT = re.compile(rb"""(?s)<script\b[^>]{0,200}\bid=["']separatrix-answers["'][^>]{0,200}>(.*?)</script""")
"""The documents of the answers in a report."""

ENVELOPE: dict[str, type] = dict.fromkeys(("separatrix_version", "name", "title"), str)
ENVELOPE |= {"seed": int, "units": dict, "warnings": list}
"""What every answer has beside those of its verb, and the type of each."""

DAMAGE = (ValueError, TypeError, LookupError, AttributeError, RecursionError, ArithmeticError, StopIteration)
"""What a document raises whose parts are not those of an answer."""

MOST = 1e150  # magnitude from which a number of a document is damage; below it the square is finite

AGAIN = "Compute this answer again with this version."
_MAKE = "Make one with: separatrix rank STUDY --out DIR."


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value of a document is a finite number; true and false are not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -MOST < value < MOST


def read_answers(path: Path) -> dict[str, Document]:
    """Answers of a folder, a document (.json) or a report (.html), by verb.

    Raises
    ------
    InputError
        There is none, or one that separatrix did not write.
    """
    if path.is_dir():
        return read_folder(path)
    if path.suffix.casefold() in REPORTS:
        return _read_report(path)
    one = read_answer(path)
    return {str(one["verb"]): one}


def read_answer(path: Path, named: str = "") -> Document:
    """Answer of a document (.json), of the verb that it is `named` after; refused as by `read_answers`."""
    where = path_text(path)
    if path.suffix.casefold() == ".nc":
        cure = f"Name the {path.stem}.json that was written beside it."
        raise InputError(where, "cannot be read back: answers are read from their .json", cure=cure)
    return _checked(_parsed(_bytes(path), where), where, named)


def read_folder(folder: Path) -> dict[str, Document]:
    """Answers of a folder, by verb; refused as by `read_answers`."""
    files = {verb: folder / f"{verb}.json" for verb in VERBS}
    found = {verb: read_answer(file, verb) for verb, file in files.items() if file.exists()}
    if not found:
        raise InputError(path_text(folder), "does not contain an answer", cure=_MAKE)
    return found


Input = tuple[object, str | None]
"""Value of an input, and its unit."""

BESIDE = ("record", "table", "other_tests", "distribution")
"""Parts of a resolved study that are not inputs: whole records of the library."""


def inputs_of_study(node: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Input]]:
    """Yield name, value and unit of every input of a resolved study; of an uncertain one its distribution."""
    if "value" in node:
        known, unit = node.get("distribution"), node.get("unit")
        words = known.get("written") or known.get("words") if isinstance(known, Mapping) else None
        yield path, (words or node["value"], unit if not words and isinstance(unit, str) else None)
        return
    if path and isinstance(node.get("name"), str):
        yield path, (node["name"], None)
    for key, item in node.items():
        if isinstance(item, Mapping) and key not in BESIDE:
            yield from inputs_of_study(item, f"{path}.{key}" if path else key)
        elif key == "candidates" and isinstance(item, list):
            for one in item:
                for place, measured in (one.get("friction") or {}).items():
                    for name in ("mean", "standard_deviation") if measured else ():
                        yield f"friction of {one['name']} in {place}, {name}", (measured.get(name), "-")
                yield from inputs_of_study(one.get("material") or {}, f"material of {one['name']}")


@contextmanager
def refusing_damage(where: str) -> Iterator[None]:
    """Refuse an answer, under its file, whose parts are not what its page or its comparison takes."""
    try:
        yield
    except InputError:
        raise
    except DAMAGE as error:
        raise InputError(where, "is damaged", printable(repr(error), 200), AGAIN) from error


def _read_report(path: Path) -> dict[str, Document]:
    where = path_text(path)
    match = REPORT.search(_bytes(path))
    answers = _parsed(match[1], where) if match else None
    if not answers or not isinstance(answers, dict):
        raise InputError(where, "is not a report with its answers in it", cure=_MAKE)
    return {verb: _checked(one, where, verb) for verb, one in answers.items()}


def _checked(found: object, where: str, named: str = "") -> Document:
    """Return a document that has what every answer has; that of its verb is checked where it is used.

    `named` is the verb whose name it has there.
    """
    if not isinstance(found, dict) or not isinstance(found.get("study"), dict):
        raise InputError(where, "is not the document of an answer", cure=_MAKE)
    verb = found.get("verb")
    if verb not in VERBS:
        got = shown(verb) if isinstance(verb, str) else "none"
        raise InputError(where, f"must be an answer of {', '.join(VERBS)}", got=got)
    if named not in ("", verb):
        raise InputError(where, f"must be an answer of {printable(named, 40)}", verb)
    for key, kind in ENVELOPE.items():
        if key not in found:
            raise InputError(where, f"lacks {key}", cure=AGAIN)
        if not isinstance(found[key], kind) or (kind is str and not found[key].strip()):
            raise InputError(where, f"is damaged: {key}", cure=AGAIN)
    if not all(isinstance(one, str) for one in found["warnings"]):
        raise InputError(where, "is damaged: warnings", cure=AGAIN)
    return found


def _bytes(path: Path) -> bytes:
    where = path_text(path)
    if size_of(path, where) > MOST_BYTES:
        raise InputError(where, f"is larger than an answer can be, {MOST_BYTES >> 20} MB")
    try:
        return path.read_bytes()
    except OSError as error:
        raise unreadable(where, error) from None


def _parsed(raw: bytes, where: str) -> Any:
    try:
        return json.loads(raw.decode("utf-8"), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        rule = "is not the document of an answer: no valid JSON"
        raise InputError(where, rule, printable(str(error), 80)) from None


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")
