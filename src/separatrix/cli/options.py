"""Options that several commands share, and the checks of what they are given."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from separatrix.errors import InputError
from separatrix.units import shown

Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
OUT_HELP = "Folder for figures and data [default: named after the study; none with --json, or of check]."
Out = Annotated[str | None, typer.Option(metavar="DIR", help=OUT_HELP)]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no notes: the answer alone.")]
Full = Annotated[bool, typer.Option("--full", help="The whole answer, not only what fits a screen.")]


def whole(option: typer.CallbackParam, value: str | None) -> int | None:
    """Return the whole number that an option gives; None if it is left out without a default.

    Raises
    ------
    InputError
        It is none.
    """
    try:
        return None if value is None else int(value)
    except ValueError:
        cure = "Write it in digits, or leave it out."
        raise InputError(option.opts[0], "must be a whole number", shown(value), cure) from None


WHOLE: dict[str, Any] = {"metavar": "N", "parser": str, "callback": whole}
"""Of every option that takes a whole number: typer leaves it as text, `whole` reads it."""

Jobs = Annotated[int | None, typer.Option(**WHOLE, help="Threads [default: one for each processor].")]
StudyArgument = Annotated[
    str, typer.Argument(metavar="STUDY", help="A study file or workbook, or the name of a shipped study.")
]
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
Cluster = Annotated[str | None, typer.Option(metavar="ADDRESS", help=CLUSTER_HELP)]
MOST_JOBS = 1024


def processors() -> int:
    """Return the number of processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads(jobs: int | None) -> int:
    """Return the number of threads asked for, or one for each processor.

    Raises
    ------
    InputError
        It is not a sensible number.
    """
    if jobs is not None and not 1 <= jobs <= MOST_JOBS:
        cure = f"Leave it out for one thread on each of the {processors()} processors."
        raise InputError("--jobs", f"must lie between 1 and {MOST_JOBS}", got=str(jobs), cure=cure)
    return jobs or processors()


def folder(out: str | None) -> Path | None:
    """Return the folder asked for; an empty name, as from an unset variable, is refused.

    Raises
    ------
    InputError
        The name is empty.
    """
    if out is not None and not out.strip():
        raise InputError("--out", "needs the name of a folder", got='""', cure="The current one is .")
    return None if out is None else Path(out)


def named(text: str, option: str, what: str) -> str:
    """Return the name that an option gives; an empty one, as from an unset variable, is refused.

    Raises
    ------
    InputError
        The name is empty.
    """
    if not text.strip() or "\0" in text:
        raise InputError(option, f"needs the name of {what}", got='""')
    return text
