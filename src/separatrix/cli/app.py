"""The commands: one entry of the table of verbs becomes one command with its options."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from separatrix.cli import comparing, materials, reproducing
from separatrix.cli import contact as one_contact
from separatrix.cli import page as the_page
from separatrix.cli import report as reporting
from separatrix.cli.console import Interruptible, answer, complain, interrupted
from separatrix.cli.run import Options, check_animation, make_study, run
from separatrix.cli.tribometer import TribometerOptions, tribometer
from separatrix.cli.verbs import FULL_HELP, OPTIONS, Jobs, Json, Quiet, folder, named, threads
from separatrix.errors import InputError, SeparatrixError
from separatrix.questions import VERBS, Verb

ANSWERED, FAULT, WRONG_INPUT = 0, 1, 2

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""


def _command(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of one verb; its signature is made from the table."""

    def command(**given: Any) -> int:
        question = {name: given[name] for name in verb.question}
        animate = question.pop("animate", None)
        if animate is not None:
            check_animation(animate, writes=not given["json"] or given["out"] is not None)
        if "vary" in question:
            question["vary"] = tuple(question["vary"] or ())
            question["cases"] = named(question["cases"], "--cases", "a file")
        named(given.get("cluster"), "--cluster", "a scheduler, or local:N")
        options = Options(
            json=given["json"],
            out=folder(given["out"]),
            quiet=given["quiet"],
            jobs=threads(given["jobs"]),
            full=given.get("full", False),
            cluster=given.get("cluster"),
            animate=animate,
            models={name: given[name] for name in ("motion", "ball") if given.get(name) is not None},
            question=question,
        )
        kept = verb.keeps_runs and not (options.json and options.out is None)
        ended = "runs that were finished are kept." if kept else "no file was written."
        return _interruptible(lambda: run(verb, given["study"], options), ended)

    named_only = inspect.Parameter.KEYWORD_ONLY
    command.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(
                name,
                named_only,
                annotation=kind,
                default=inspect.Parameter.empty if default is ... else default,
            )
            for name, (kind, default) in ((one, OPTIONS[one]) for one in verb.options)
        ]
    )
    return command


def _interruptible(work: Callable[[], int], ended: str) -> int:
    """Do the work and return its exit status; here an interrupt ends it, for typer would swallow it."""
    try:
        with Interruptible():
            return work()
    except KeyboardInterrupt:
        return interrupted(ended)


def _compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="Folder or file of an answer.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another one of the same verb.")],
    full: Annotated[bool, typer.Option("--full", help=FULL_HELP)] = False,
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help="Folder [default: compare].")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No effect: there is no progress bar.")] = False,  # noqa: ARG001
) -> int:
    return comparing.compare(first, second, folder(out), as_json=json, full=full)


def _reproduce(
    path: Annotated[Path, typer.Argument(metavar="RESULT", help=reproducing.PATH_HELP)],
    json: Json = False,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    def work() -> int:
        return reproducing.reproduce(path, as_json=json, quiet=quiet, jobs=threads(jobs))

    return _interruptible(work, "no answer is compared.")


def _report(
    asked: Annotated[str, typer.Argument(metavar="STUDY|FOLDER", help=reporting.ASKED_HELP)],
    second: Annotated[
        str | None, typer.Argument(metavar="[STUDY|FOLDER]", help=reporting.SECOND_HELP, show_default=False)
    ] = None,
    pdf: Annotated[bool, typer.Option("--pdf", help=reporting.PDF_HELP)] = False,
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help=reporting.OUT_HELP)] = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    options = reporting.ReportOptions(out=folder(out), pdf=pdf, json=json, quiet=quiet, jobs=threads(jobs))
    return _interruptible(lambda: reporting.report(asked, second, options), "no report was written.")


def _contact(
    path: Annotated[Path, typer.Argument(metavar="FILE", help=one_contact.FILE_HELP)],
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help=one_contact.OUT_HELP)] = None,
    quiet: Quiet = False,
) -> int:
    def work() -> int:
        return one_contact.contact(path, folder(out), as_json=json, quiet=quiet)

    return _interruptible(work, "no file was written.")


MAP_HELP = "Column map (TOML) for what the logs do not state."
PLOTS_HELP = "Folder of a page for each test [default: beside the friction file]."
RUN_IN_HELP = 'Where running-in ends, for instance "200 m" [default: found].'
FILES_HELP = "Raw tribometer logs, or folders of them; the format is recognised."
FRICTION_HELP = "Friction file to write, say friction.toml [default: none]."
JOIN_HELP = "The logs of one folder are strokes or parts of one test."


def _tribometer(
    files: Annotated[list[Path], typer.Argument(metavar="FILES...", help=FILES_HELP)],
    out: Annotated[str | None, typer.Option(metavar="FILE", help=FRICTION_HELP)] = None,
    column_map: Annotated[Path | None, typer.Option("--map", metavar="FILE", help=MAP_HELP)] = None,
    plots: Annotated[str | None, typer.Option(metavar="DIR", help=PLOTS_HELP)] = None,
    run_in: Annotated[str | None, typer.Option(metavar="END", help=RUN_IN_HELP)] = None,
    join: Annotated[bool, typer.Option("--join", help=JOIN_HELP)] = False,
    json: Json = False,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    asked = TribometerOptions(
        out=named(out, "--out", "a file"),
        map=column_map,
        plots=named(plots, "--plots", "a folder"),
        run_in=run_in,
        join=join,
        json=json,
        quiet=quiet,
        jobs=threads(jobs),
    )
    return _interruptible(lambda: tribometer(files, asked), "no friction file was written.")


def _new(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="The file to make; it must not exist yet.")],
    excel: Annotated[
        bool, typer.Option("--excel", help="A workbook, .xlsx, in place of a text file.")
    ] = False,
    json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing.")] = False,
) -> int:
    return make_study(path, excel=excel, as_json=json, quiet=quiet)


def _application() -> typer.Typer:
    """Return the command line, with the verbs in the order of the chain."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.callback(invoke_without_command=True, help=HELP)(_start)
    app.command("new", help="Write a commented study file to fill in.")(_new)
    for verb in VERBS:
        app.command(verb.name, help=verb.help, epilog=verb.epilog)(_command(verb))
    app.command(
        "tribometer",
        help="Friction with its scatter from raw logs of tests.",
        epilog="What is read is shown before it is trusted: without --out nothing is written. A file that "
        "exists is never overwritten.",
    )(_tribometer)
    app.command("contact", help=one_contact.HELP, epilog=one_contact.EPILOG)(_contact)
    app.command("compare", help=comparing.HELP, epilog=comparing.EPILOG)(_compare)
    app.command("reproduce", help=reproducing.HELP, epilog=reproducing.EPILOG)(_reproduce)
    app.command("report", help=reporting.HELP, epilog=reporting.EPILOG)(_report)
    app.command("app", help=the_page.HELP, epilog=the_page.EPILOG)(the_page.page)
    app.add_typer(materials.application(), name="materials", help=materials.HELP)
    return app


def _start(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and stop.")] = False,
) -> None:
    if version:
        from separatrix import __version__

        answer(f"separatrix {__version__}\n")
        raise typer.Exit
    if context.invoked_subcommand is None:
        others = ("tribometer", "contact", "compare", "reproduce", "report", "app", "materials")
        verbs = ", ".join(["new", *(verb.name for verb in VERBS), *others])
        raise InputError("The command", f"is missing; choose one of {verbs}", cure='Try "separatrix --help".')


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, as `separatrix.cli.main` says."""
    command = typer.main.get_command(_application())
    try:
        status = command.main(arguments, prog_name="separatrix", standalone_mode=False)
    except typer.TyperException as error:
        text = error.format_message().rstrip(". ")
        complain(f'{text}{"" if text.endswith("?") else "."} Try "separatrix --help".')
        return WRONG_INPUT
    except SeparatrixError as error:
        for line in str(error).split("\n"):
            complain(line)
        return WRONG_INPUT if isinstance(error, ValueError | LookupError) else FAULT
    return int(status or ANSWERED)
