"""From converted values to records: what is missing, and what a record refuses, in the words of the file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, fields
from typing import Any, ParamSpec, TypeVar

from separatrix.errors import InputError, together
from separatrix.study_file.document import Document
from separatrix.units import printable, shown

Record = TypeVar("Record")
Inputs = ParamSpec("Inputs")

_SECTION_OF = {
    "BallBearing": "bearing",
    "Operation": "operation",
    "Film": "film",
    "CageDesign": "cage",
    "StabilitySettings": "stability",
    "RankingQuestion": "ranking",
}


class Unfinished(Exception):  # noqa: N818 - not an error: it never leaves this package
    """A section cannot be built because one of its values was refused already."""


def attempt(
    document: Document, make: Callable[Inputs, Record], *args: Inputs.args, **kwargs: Inputs.kwargs
) -> Record | None:
    """What `make` returns, or None with its refusals noted in the document."""
    try:
        return make(*args, **kwargs)
    except InputError as error:
        document.problems.extend(error.problems or (error,))
    except Unfinished:
        pass
    return None


def record_of(
    document: Document, record: type[Record], given: dict[str, Any], lacks: tuple[str, ...] = ()
) -> Record:
    """Record of a section.

    Raises
    ------
    InputError
        A key is missing, or the record refuses its values.
    Unfinished
        A value that was written has been refused.
    """
    section = _SECTION_OF[record.__name__]
    written = document.sections.get(section, {})
    required = [f.name for f in fields(record) if f.default is f.default_factory is MISSING]  # type: ignore[arg-type]
    missing = [*lacks, *(key for key in required if key not in written and key not in given)]
    if missing:
        raise InputError(f"{document.label}: [{section}]", f"lacks: {', '.join(missing)}")
    if any(key not in given for key in required):
        raise Unfinished
    try:
        return record(**given)
    except InputError as error:
        raise relocated(document, error) from None


def relocated(document: Document, error: InputError) -> InputError:
    """The refusals of a record with their places in the file and what the file says there."""
    return together([_relocated(document, problem) for problem in error.problems or (error,)])


def where(document: Document, section: str, key: str) -> str:
    """Place of a key: ``case.toml, line 7: [bearing] bore``."""
    entry = document.sections.get(section, {}).get(key)
    name = printable(key) or '""'
    return f"{entry.place if entry else document.label}: [{section}] {name}"


def refuse_both(document: Document, section: str, one: str, other: str) -> None:
    """Refuse two keys that exclude each other."""
    written = document.sections.get(section, {})
    if one in written and other in written:
        rule = f"and {other} exclude each other"
        raise InputError(where(document, section, one), rule, cure="Give one of the two.")


def _relocated(document: Document, problem: InputError) -> InputError:
    record, _, key = problem.path.partition(".")
    section = _SECTION_OF.get(record)
    if section is None:
        return problem
    entry = document.sections.get(section, {}).get(key)
    value, uncertain = problem.got, document.distributions.get(f"{section}.{key}")
    if value and uncertain is not None:
        value = f"{uncertain.text}, whose mean is {value}"
    elif value and entry is not None and isinstance(entry.value, (str, int, float)):
        value = shown(entry.value)
    return InputError(where(document, section, key), problem.rule, value, problem.cure)
