"""The commands: one entry of the table of verbs becomes one command with the same options."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from separatrix.cli import materials
from separatrix.cli.comparing import compare
from separatrix.cli.console import Interruptible, complain, interrupted
from separatrix.cli.options import (
    WHOLE,
    Cluster,
    Full,
    Jobs,
    Json,
    Out,
    Quiet,
    StudyArgument,
    folder,
    named,
    threads,
)
from separatrix.cli.run import Options, make_study, run
from separatrix.cli.simulating import check_animation, write_animation
from separatrix.cli.verbs import VERBS, Verb
from separatrix.errors import InputError, SeparatrixError
from separatrix.explore.axes import DEFAULT_X, DEFAULT_Y

ANSWERED, FAULT, WRONG_INPUT = 0, 1, 2

AXIS = "LOW..HIGH[unit][:N][:log]"
KICK_HELP = 'For instance "0.5 m/s" [default: the reference kick of the study].'
ADAPTIVE_HELP = "Run only points near a change of the answer; infer the others, and check some of them."
EPILOGS = {
    "map": "An axis is a numeric key of the study file with its section, or restitution_factor, "
    "ball_cage_friction, kick: --x cage.pocket_clearance=0.1..1mm --y film.race_friction=0.02..0.3:40:log. "
    "Finished runs are kept in the folder of the answer: after Ctrl-C run the same command to resume. "
    "With --json and no --out nothing is kept.",
    "sensitivity": "Every number that the study writes with a distribution is drawn, and the frictions with "
    "their scatter: 9 % of the mean where none was measured, a guess.",
    "sweep": "Every value of one --vary goes with every value of the others. A case that is refused is a row "
    "with its reason. The table is sweep.csv, sweep.xlsx and sweep.nc in the folder of the answer: "
    '--vary "film.thickness=0.2..2um:10:log" --vary bearing.contact_angle=15..25deg:11.',
    "simulate": "An unresolved run says why. --animate mp4 needs the extra animation.",
    "tribometer": "What is read is shown before it is trusted: without --out nothing is written. A file that "
    "exists is never overwritten.",
    "stability": "Beside the curve: its sub-critical band, each kick's own curve, the linear and the "
    "hard-impact limit, and the critical friction at the bearing's own restitution factor.",
}

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""


def _answer(
    verb: Verb,
    study: str,
    question: Mapping[str, Any] | None = None,
    *,
    json: bool,
    out: str | None,
    quiet: bool,
    jobs: int | None,
    full: bool = False,
    cluster: str | None = None,
) -> int:
    """Answer the question of a verb and return the exit status."""
    if cluster is not None:
        named(cluster, "--cluster", "a scheduler, or local:N")
    options = Options(
        json=json,
        out=folder(out),
        quiet=quiet,
        jobs=threads(jobs),
        full=full,
        cluster=cluster,
        question=question or {},
    )
    try:
        with Interruptible():
            return run(verb, study, options)
    except KeyboardInterrupt:  # here, for typer would swallow it
        kept = verb.keeps_runs and not (json and out is None)
        return interrupted("runs that were finished are kept." if kept else "no file was written.")


def _command(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of one verb."""

    def command(
        study: StudyArgument,
        json: Json = False,
        out: Out = None,
        quiet: Quiet = False,
        jobs: Jobs = None,
    ) -> int:
        return _answer(verb, study, json=json, out=out, quiet=quiet, jobs=jobs)

    return command


def _check(
    study: StudyArgument,
    full: Full = False,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    return _answer(VERB["check"], study, json=json, out=out, quiet=quiet, jobs=jobs, full=full)


def _stability(
    study: StudyArgument,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
    cluster: Cluster = None,
) -> int:
    return _answer(VERB["stability"], study, json=json, out=out, quiet=quiet, jobs=jobs, cluster=cluster)


def _rank(
    study: StudyArgument,
    full: Full = False,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
    cluster: Cluster = None,
) -> int:
    verb = VERB["rank"]
    return _answer(verb, study, json=json, out=out, quiet=quiet, jobs=jobs, full=full, cluster=cluster)


def _map(
    study: StudyArgument,
    x: Annotated[str, typer.Option("--x", metavar="AXIS", help=f"PARAM={AXIS}.")] = DEFAULT_X,
    y: Annotated[str, typer.Option("--y", metavar="AXIS", help="The same, upward.")] = DEFAULT_Y,
    points: Annotated[int, typer.Option(**WHOLE, help="Values of an axis that says no number.")] = 100,
    runs: Annotated[int, typer.Option(**WHOLE, help="Most runs of a point.")] = 16,
    kick: Annotated[str | None, typer.Option(metavar="SPEED", help=KICK_HELP)] = None,
    adaptive: Annotated[bool, typer.Option("--adaptive", help=ADAPTIVE_HELP)] = False,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
    cluster: Cluster = None,
) -> int:
    asked = {"x": x, "y": y, "points": points, "runs": runs, "kick": kick, "adaptive": adaptive}
    return _answer(VERB["map"], study, asked, json=json, out=out, quiet=quiet, jobs=jobs, cluster=cluster)


def _simulate(
    study: StudyArgument,
    kick: Annotated[str | None, typer.Option(metavar="SPEED", help=KICK_HELP)] = None,
    number: Annotated[int, typer.Option("--run", **WHOLE, help="Which run of the ensemble.")] = 0,
    animate: Annotated[str | None, typer.Option(metavar="gif|mp4", help="Also write an animation.")] = None,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    verb = VERB["simulate"]
    if animate is not None:
        check_animation(animate, writes=not json or out is not None)
        verb = replace(verb, draw=partial(write_animation, kind=animate))
    return _answer(verb, study, {"kick": kick, "run": number}, json=json, out=out, quiet=quiet, jobs=jobs)


def _sensitivity(
    study: StudyArgument,
    samples: Annotated[int, typer.Option(**WHOLE, help="Bearings drawn, a power of two.")] = 512,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
    cluster: Cluster = None,
) -> int:
    return _answer(
        VERB["sensitivity"],
        study,
        {"samples": samples},
        json=json,
        out=out,
        quiet=quiet,
        jobs=jobs,
        cluster=cluster,
    )


def _sweep(
    study: StudyArgument,
    vary: Annotated[
        list[str] | None, typer.Option("--vary", metavar="AXIS", help=f"PARAM={AXIS}; may be repeated.")
    ] = None,
    cases: Annotated[
        str | None, typer.Option(metavar="FILE", help="CSV: parameters in its first row, then a case a row.")
    ] = None,
    verdicts: Annotated[
        bool, typer.Option("--verdicts", help="Run the ensemble of every case, too.")
    ] = False,
    json: Json = False,
    out: Out = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
    cluster: Cluster = None,
) -> int:
    table = None if cases is None else Path(named(cases, "--cases", "a file"))
    asked = {"vary": tuple(vary or ()), "cases": table, "verdicts": verdicts}
    return _answer(VERB["sweep"], study, asked, json=json, out=out, quiet=quiet, jobs=jobs, cluster=cluster)


def _compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="Folder or .nc of simulate or of rank.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another one.")],
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help="Folder [default: compare].")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No effect: there is no progress bar.")] = False,  # noqa: ARG001
) -> int:
    return compare(first, second, folder(out), as_json=json)


def _tribometer(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILES...",
            help="Raw tribometer logs, or folders of them; the format is recognised.",
        ),
    ],
    out: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Friction file to write, say friction.toml [default: none]."),
    ] = None,
    column_map: Annotated[
        Path | None,
        typer.Option("--map", metavar="FILE", help="Column map (TOML) for what the logs do not state."),
    ] = None,
    plots: Annotated[
        str | None,
        typer.Option(
            metavar="DIR", help="Folder of a page for each test [default: beside the friction file]."
        ),
    ] = None,
    run_in: Annotated[
        str | None,
        typer.Option(metavar="END", help='Where running-in ends, for instance "200 m" [default: found].'),
    ] = None,
    join: Annotated[
        bool, typer.Option("--join", help="The logs of one folder are strokes or parts of one test.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    from separatrix.cli.tribometer import TribometerOptions, tribometer

    asked = TribometerOptions(
        out=None if out is None else Path(named(out, "--out", "a file")),
        map=column_map,
        plots=None if plots is None else Path(named(plots, "--plots", "a folder")),
        run_in=run_in,
        join=join,
        json=json,
        quiet=quiet,
        jobs=threads(jobs),
    )
    try:
        with Interruptible():
            return tribometer(files, asked)
    except KeyboardInterrupt:  # here, for typer would swallow it
        return interrupted("no friction file was written.")


def _new(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="The file to make; it must not exist yet.")],
    excel: Annotated[
        bool, typer.Option("--excel", help="A workbook, .xlsx, in place of a text file.")
    ] = False,
    json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing.")] = False,
) -> int:
    return make_study(path, excel=excel, as_json=json, quiet=quiet)


OWN: dict[str, Callable[..., int]] = {
    "check": _check,
    "stability": _stability,
    "rank": _rank,
    "map": _map,
    "simulate": _simulate,
    "sensitivity": _sensitivity,
    "sweep": _sweep,
}
"""Verbs with options of their own."""

VERB = {verb.name: verb for verb in VERBS}


def _application() -> typer.Typer:
    """Return the command line, with the verbs in the order of the chain."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.callback(invoke_without_command=True, help=HELP)(_start)
    app.command("new", help="Write a commented study file to fill in.")(_new)
    for verb in VERBS:
        function = OWN.get(verb.name) or _command(verb)
        app.command(verb.name, help=verb.help, epilog=EPILOGS.get(verb.name))(function)
    app.command(
        "tribometer",
        help="Friction with its scatter from raw logs of tests.",
        epilog=EPILOGS["tribometer"],
    )(_tribometer)
    app.command("compare", help="Two saved answers of simulate, or of rank, side by side.")(_compare)
    app.add_typer(materials.application(), name="materials", help=materials.HELP)
    return app


def _start(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and stop.")] = False,
) -> None:
    """Show the version, or say that the verb is missing."""
    if version:
        from separatrix import __version__
        from separatrix.cli.console import answer

        answer(f"separatrix {__version__}\n")
        raise typer.Exit
    if context.invoked_subcommand is None:
        verbs = ", ".join(["new", *VERB, "tribometer", "compare", "materials"])
        raise InputError("The command", f"is missing; choose one of {verbs}", cure='Try "separatrix --help".')


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, as `separatrix.cli.main` says."""
    command = typer.main.get_command(_application())
    try:
        status = command.main(arguments, prog_name="separatrix", standalone_mode=False)
    except typer.TyperException as error:
        complain(_usage(error.format_message()))
        return WRONG_INPUT
    except SeparatrixError as error:
        for line in str(error).split("\n"):
            complain(line)
        return WRONG_INPUT if isinstance(error, ValueError | LookupError) else FAULT
    return int(status or ANSWERED)


def _usage(message: str) -> str:
    text = message.rstrip(". ")
    return f'{text}{"" if text.endswith("?") else "."} Try "separatrix --help".'
