"""The command of each verb of a study, with its options: read, compute, print, write."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from separatrix.front.console import answer, answer_json, complain, interrupted, interruptible, progress_bar
from separatrix.ground.errors import InputError
from separatrix.ground.files import writable_folder
from separatrix.ground.units import shown
from separatrix.verbs import Computed, Verb, asked_study, computed, processors
from separatrix.verdict.ledger import NAME as LEDGER
from separatrix.verdict.parameter_axes import DEFAULT_X, DEFAULT_Y

if TYPE_CHECKING:
    from separatrix.study.study import Study

ANSWERED = 0
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


def whole_number(text: str) -> Any:
    """Return an option that takes a whole number: typer leaves it as text, `whole` reads it."""
    return typer.Option(metavar="N", parser=str, callback=whole, help=text)


Jobs = Annotated[int | None, whole_number("Threads [default: one for each processor].")]

ANIMATE_HELP = "Also write an animation."
FULL_HELP = "The whole answer, not only what fits a screen."
VARY_HELP = f"PARAM={AXIS}; may be repeated."
VERDICTS_HELP = "Run the ensemble of every case, too."
MARGINS_HELP = "Compute threshold and margin of every case, too."
ADAPTIVE_HELP = "Run only points near a change of the answer; infer the others, and check some of them."
CASES_HELP = "CSV: parameters in its first row, then a case a row; with time_share a duty cycle."
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
MOTION_HELP = "Where the cage moves [default: as in the study, or in the plane]."
BALL_HELP = "Model of the ball that a pocket pushes [default: that of the study]."
KICK_HELP = 'For instance "0.5 m/s" [default: the reference kick of the study].'
ETA_HELP = "Damp the races so that eta is this, as at a point of a map [default: that of the study]."
STUDY_HELP = "A study file or workbook, or the name of a shipped study."

OPTIONS: dict[str, tuple[object, object]] = {
    "study": (Annotated[str, typer.Argument(metavar="STUDY", help=STUDY_HELP)], ...),
    "x": (Annotated[str, typer.Option("--x", metavar="AXIS", help=f"PARAM={AXIS}.")], DEFAULT_X),
    "y": (
        Annotated[str, typer.Option("--y", metavar="AXIS", help="Vertical axis, same syntax as --x.")],
        DEFAULT_Y,
    ),
    "points": (Annotated[int, whole_number("Points per axis, unless the axis states a number.")], 100),
    "runs": (Annotated[int, whole_number("Most runs of a point.")], 16),
    "kick": (Annotated[str | None, typer.Option(metavar="SPEED", help=KICK_HELP)], None),
    "adaptive": (Annotated[bool, typer.Option("--adaptive", help=ADAPTIVE_HELP)], False),
    "motion": (Annotated[str | None, typer.Option(metavar="plane|space", help=MOTION_HELP)], None),
    "ball": (Annotated[str | None, typer.Option(metavar="damper|traction|free|auto", help=BALL_HELP)], None),
    "run": (Annotated[int, whole_number("Which run of the ensemble.")], 0),
    "restitution_factor": (Annotated[str | None, typer.Option(metavar="ETA", help=ETA_HELP)], None),
    "animate": (Annotated[str | None, typer.Option(metavar="gif", help=ANIMATE_HELP)], None),
    "samples": (Annotated[int, whole_number("Bearings drawn, a power of two.")], 512),
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
    """Return the number of threads of an option, or one for each processor that this process may use."""
    if jobs is not None and not 1 <= jobs <= MOST_JOBS:
        cure = f"Leave it out for one thread on each of the {processors()} processors."
        raise InputError("--jobs", f"must lie between 1 and {MOST_JOBS}", got=str(jobs), cure=cure)
    return jobs or processors()


def folder(out: str | None) -> Path | None:
    """Return the folder of an option; an empty name, as from an unset variable, is refused."""
    if out is not None and not out.strip():
        raise InputError("--out", "needs the name of a folder", got='""', cure="The current one is .")
    return None if out is None else Path(out)


def named(text: str | None, option: str, what: str) -> Path | None:
    """Return the path or address that an option gives; an empty one is refused."""
    if text is not None and (not text.strip() or "\0" in text):
        raise InputError(option, f"needs the name of {what}", got='""')
    return None if text is None else Path(text)


def command_of(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of a verb; its signature is made from the table."""

    def command(**given: Any) -> int:
        return run(verb, **given)

    command.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                annotation=kind,
                default=inspect.Parameter.empty if default is ... else default,
            )
            for name, (kind, default) in ((one, OPTIONS[one]) for one in verb.options)
        ]
    )
    return command


def run(
    verb: Verb,
    study: str,
    *,
    json: bool,
    out: str | None,
    quiet: bool,
    jobs: int | None,
    full: bool = False,
    cluster: str | None = None,
    animate: str | None = None,
    motion: str | None = None,
    ball: str | None = None,
    **question: Any,
) -> int:
    """Answer one question and return the exit status."""
    if animate is not None:
        _check_animation(animate, writes=not json or out is not None)
    if "vary" in question:
        question["vary"] = tuple(question["vary"] or ())
        question["cases"] = named(question["cases"], "--cases", "a file")
    named(cluster, "--cluster", "a scheduler, or local:N")
    place, count = folder(out), threads(jobs)
    models = {name: one for name, one in (("motion", motion), ("ball", ball)) if one is not None}
    is_kept = verb.keeps_runs and not (json and out is None)

    @interruptible("runs that were finished are kept." if is_kept else "no file was written.")
    def work() -> int:
        with contextlib.ExitStack() as stack:
            asked = asked_study(verb, study, models)
            to = Path(asked.name) if place is None and verb.writes_files and not json else place
            if to is not None:
                stack.enter_context(writable_folder(to))
            found = computed_with_progress(
                verb, asked, question, quiet=quiet, jobs=count, folder=to, cluster=cluster
            )
            _deliver(verb, found, to, json=json, quiet=quiet, full=full, animate=animate)
        if found.is_complete:
            return ANSWERED
        more = " Run the same command to resume." if verb.keeps_runs and to is not None else ""
        return interrupted(f"the answer has what was finished, and is marked complete: false.{more}")

    return work()


def computed_with_progress(
    verb: Verb,
    study: Study,
    question: Mapping[str, object],
    *,
    quiet: bool,
    jobs: int,
    folder: Path | None,
    cluster: str | None = None,
) -> Computed:
    """Compute the answer with a bar of progress; print how many runs an earlier call had kept."""
    with progress_bar(f"{verb.name} {study.name}", quiet=quiet) as progress:
        found = computed(verb, study, question, jobs=jobs, folder=folder, cluster=cluster, progress=progress)
    if found.runs_taken and not quiet:
        kept = f"{folder}/{LEDGER}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return found


def _deliver(
    verb: Verb,
    found: Computed,
    folder: Path | None,
    *,
    json: bool,
    quiet: bool,
    full: bool,
    animate: str | None,
) -> None:
    """Write the answer, then the files, which take as long again, and print where they are."""
    from separatrix.told.answer import in_words, whereabouts
    from separatrix.verbs.answer_files import document

    made = document(verb.name, found.record, found.study, found.question)
    if json:
        answer_json(made)
    else:
        asked = (verb.name, found.record, found.study, list(made["warnings"]))
        answer(in_words(*asked, full=full, quiet=quiet))
    if folder is None:
        return
    from separatrix.verbs.answer_files import save_answer

    with progress_bar("animation", quiet=quiet or animate is None) as progress:
        save_answer(folder, found.record, found.study, made, animation=animate is not None, progress=progress)
    if not json and not quiet:
        overview = verb.name == "rank" and bool(made["complete"])
        answer("\n" + whereabouts(verb.name, str(folder), overview=overview))


def _check_animation(kind: str, *, writes: bool) -> None:
    """Refuse an animation of another kind, or without a folder."""
    if kind != "gif":
        raise InputError("--animate", "must be gif", got=f'"{kind}"')
    if not writes:
        raise InputError("--animate", "needs a folder with --json", cure="Give --out DIR.")
