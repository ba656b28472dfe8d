"""The table of verbs, in the order of the chain, and the options they take. To add a verb, add an entry."""

from __future__ import annotations

import os
from dataclasses import dataclass
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
ADAPTIVE_HELP = "Run only points near a change of the answer; infer the others, and check some of them."
CASES_HELP = "CSV: parameters in its first row, then a case a row."
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
MOTION_HELP = "Where the cage moves [default: as the study says, or in the plane]."
BALL_HELP = "What a ball does that is pushed [default: as the study says, or a damper]."
KICK_HELP = 'For instance "0.5 m/s" [default: the reference kick of the study].'
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
    "animate": (Annotated[str | None, typer.Option(metavar="gif|mp4", help=ANIMATE_HELP)], None),
    "samples": (Annotated[int, typer.Option(**WHOLE, help="Bearings drawn, a power of two.")], 512),
    "vary": (Annotated[list[str] | None, typer.Option("--vary", metavar="AXIS", help=VARY_HELP)], None),
    "cases": (Annotated[str | None, typer.Option(metavar="FILE", help=CASES_HELP)], None),
    "verdicts": (Annotated[bool, typer.Option("--verdicts", help=VERDICTS_HELP)], False),
    "full": (Annotated[bool, typer.Option("--full", help=FULL_HELP)], False),
    "json": (Json, False),
    "out": (Annotated[str | None, typer.Option(metavar="DIR", help=OUT_HELP)], None),
    "quiet": (Quiet, False),
    "jobs": (Jobs, None),
    "cluster": (Annotated[str | None, typer.Option(metavar="ADDRESS", help=CLUSTER_HELP)], None),
}
"""Parameter of a command -> its type with its help, and its default."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question: its name and its line of help.

    The function of that name in `separatrix.verbs` computes its record from the options in `question`.
    `needs` are the sections of a study that may be left out but not for this question. `keeps_runs` is for
    an answer whose runs are kept in its folder as they are finished, and may be made on a cluster.
    `moves_a_cage` is for one whose models of motion and ball may be chosen.
    """

    name: str
    help: str
    needs: tuple[str, ...] = ()
    epilog: str | None = None
    question: tuple[str, ...] = ()
    moves_a_cage: bool = False
    has_full: bool = False
    writes_files: bool = True
    keeps_runs: bool = False

    @property
    def options(self) -> tuple[str, ...]:
        """Names of what its command takes, in order."""
        full, cluster = ("full",) * self.has_full, ("cluster",) * self.keeps_runs
        models = ("motion", "ball") * self.moves_a_cage
        return ("study", *self.question, *models, *full, "json", "out", "quiet", "jobs", *cluster)


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study; show what was understood and from where.",
        has_full=True,
        writes_files=False,
    ),
    Verb(name="bearing", help="Ball loads, contact angles, speeds and contacts."),
    Verb(name="traction", help="Traction curves of ball on race, and their slopes."),
    Verb(name="restitution", help="Restitution factor of a ball/cage impact.", needs=("cage",)),
    Verb(
        name="mobility",
        help="How the races hold a ball that is pushed along its orbit.",
        epilog="Rates, dampings and effective mass of the most loaded ball, its law of traction F(u) with "
        "the capacity of the races, and with a cage the restitution of impacts against their speed.",
    ),
    Verb(
        name="stability",
        help="Critical friction against restitution factor.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="Beside the curve: its sub-critical band, each kick's own curve, the linear and the "
        "hard-impact limit, and the critical friction at the bearing's own restitution factor.",
        keeps_runs=True,
    ),
    Verb(
        name="map",
        help="Where the cage is stable in the plane of two parameters.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="An axis is a numeric key of the study file with its section, or restitution_factor, "
        "ball_cage_friction, kick: --x cage.pocket_clearance=0.1..1mm --y film.race_friction="
        "0.02..0.3:40:log. Finished runs are kept in the folder of the answer: after Ctrl-C run the same "
        "command to resume. With --json and no --out nothing is kept.",
        question=("x", "y", "points", "runs", "kick", "adaptive"),
        keeps_runs=True,
    ),
    Verb(
        name="simulate",
        help="Follow one run of the cage, in the plane or in space.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="An unresolved run says why. --animate mp4 needs the extra animation.",
        question=("kick", "run", "animate"),
    ),
    Verb(
        name="rank",
        help="Rank the cage materials: verdict, margin, reason.",
        needs=("cage", "ranking"),
        moves_a_cage=True,
        has_full=True,
        keeps_runs=True,
    ),
    Verb(
        name="sensitivity",
        help="Verdicts over uncertain inputs, and what to test next.",
        needs=("cage", "ranking"),
        moves_a_cage=True,
        epilog="Every number that the study writes with a distribution is drawn, and the frictions with "
        "their scatter: 9 % of the mean where none was measured, a guess.",
        question=("samples",),
        keeps_runs=True,
    ),
    Verb(
        name="sweep",
        help="Chain and verdict of many cases: one table.",
        moves_a_cage=True,
        epilog="Every value of one --vary goes with every value of the others. A case that is refused is a "
        "row with its reason. The table is sweep.csv, sweep.xlsx and sweep.nc in the folder of the answer: "
        '--vary "film.thickness=0.2..2um:10:log" --vary bearing.contact_angle=15..25deg:11.',
        question=("vary", "cases", "verdicts"),
        keeps_runs=True,
    ),
)


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
