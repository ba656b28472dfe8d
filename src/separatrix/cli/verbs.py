"""The options of the commands, and the reading of those that name threads, folders and files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from separatrix.errors import InputError
from separatrix.explore.axes import DEFAULT_X, DEFAULT_Y
from separatrix.units import shown

MOST_JOBS = 1024
AXIS = "LOW..HIGH[unit][:N][:log]"

Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
OUT_HELP = "Folder for figures and data [default: named after the study; none with --json, or of check]."
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no notes: the answer alone.")]


def whole(option: typer.CallbackParam, value: str | None) -> int | None:
    """Return the whole number that an option gives; None if it is left out without a default."""
    try:
        return None if value is None else int(value)
    except ValueError:
        cure = "Write it in digits, or leave it out."
        raise InputError(option.opts[0], "must be a whole number", shown(value), cure) from None


WHOLE: dict[str, Any] = {"metavar": "N", "parser": str, "callback": whole}
"""Of every option that takes a whole number: typer leaves it as text, `whole` reads it."""

Jobs = Annotated[int | None, typer.Option(**WHOLE, help="Threads [default: one for each processor].")]

ANIMATE_HELP = "Also write an animation."
FULL_HELP = "The whole answer, not only what fits a screen."
VARY_HELP = f"PARAM={AXIS}; may be repeated."
VERDICTS_HELP = "Run the ensemble of every case, too."
MARGINS_HELP = "Compute threshold and margin of every case, too."
ADAPTIVE_HELP = "Run only points near a change of the answer; infer the others, and check some of them."
CASES_HELP = "CSV: parameters in its first row, then a case a row; with time_share a duty cycle."
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
MOTION_HELP = "Where the cage moves [default: as the study says, or in the plane]."
BALL_HELP = "What a ball does that is pushed [default: as the study says, or a damper]."
KICK_HELP = 'For instance "0.5 m/s" [default: the reference kick of the study].'
ETA_HELP = "Damp the races so that eta is this, as at a point of a map [default: that of the study]."
STUDY_HELP = "A study file or workbook, or the name of a shipped study."

OPTIONS: dict[str, tuple[Any, Any]] = {
    "study": (Annotated[str, typer.Argument(metavar="STUDY", help=STUDY_HELP)], ...),
    "x": (Annotated[str, typer.Option("--x", metavar="AXIS", help=f"PARAM={AXIS}.")], DEFAULT_X),
    "y": (Annotated[str, typer.Option("--y", metavar="AXIS", help="The same, upward.")], DEFAULT_Y),
    "points": (Annotated[int, typer.Option(**WHOLE, help="Values of an axis that says no number.")], 100),
    "runs": (Annotated[int, typer.Option(**WHOLE, help="Most runs of a point.")], 16),
    "kick": (Annotated[str | None, typer.Option(metavar="SPEED", help=KICK_HELP)], None),
    "adaptive": (Annotated[bool, typer.Option("--adaptive", help=ADAPTIVE_HELP)], False),
    "motion": (Annotated[str | None, typer.Option(metavar="plane|space", help=MOTION_HELP)], None),
    "ball": (Annotated[str | None, typer.Option(metavar="damper|traction", help=BALL_HELP)], None),
    "run": (Annotated[int, typer.Option("--run", **WHOLE, help="Which run of the ensemble.")], 0),
    "restitution_factor": (Annotated[str | None, typer.Option(metavar="ETA", help=ETA_HELP)], None),
    "animate": (Annotated[str | None, typer.Option(metavar="gif|mp4", help=ANIMATE_HELP)], None),
    "samples": (Annotated[int, typer.Option(**WHOLE, help="Bearings drawn, a power of two.")], 512),
    "vary": (Annotated[list[str] | None, typer.Option("--vary", metavar="AXIS", help=VARY_HELP)], None),
    "cases": (Annotated[str | None, typer.Option(metavar="FILE", help=CASES_HELP)], None),
    "verdicts": (Annotated[bool, typer.Option("--verdicts", help=VERDICTS_HELP)], False),
    "margins": (Annotated[bool, typer.Option("--margins", help=MARGINS_HELP)], False),
    "full": (Annotated[bool, typer.Option("--full", help=FULL_HELP)], False),
    "json": (Json, False),
    "out": (Annotated[str | None, typer.Option(metavar="DIR", help=OUT_HELP)], None),
    "quiet": (Quiet, False),
    "jobs": (Jobs, None),
    "cluster": (Annotated[str | None, typer.Option(metavar="ADDRESS", help=CLUSTER_HELP)], None),
}
"""Parameter of a command -> its type with its help, and its default."""


def threads(jobs: int | None) -> int:
    """Return the number of threads asked for, or one for each processor that this process may use."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if jobs is not None and not 1 <= jobs <= MOST_JOBS:
        cure = f"Leave it out for one thread on each of the {cores} processors."
        raise InputError("--jobs", f"must lie between 1 and {MOST_JOBS}", got=str(jobs), cure=cure)
    return jobs or cores


def folder(out: str | None) -> Path | None:
    """Return the folder asked for; an empty name, as from an unset variable, is refused."""
    if out is not None and not out.strip():
        raise InputError("--out", "needs the name of a folder", got='""', cure="The current one is .")
    return None if out is None else Path(out)


def named(text: str | None, option: str, what: str) -> Path | None:
    """Return the path or address that an option gives; an empty one is refused."""
    if text is not None and (not text.strip() or "\0" in text):
        raise InputError(option, f"needs the name of {what}", got='""')
    return None if text is None else Path(text)
