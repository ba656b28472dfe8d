"""The commands: one entry of the table of verbs becomes one command with the same options."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from separatrix.cli.console import Interruptible, complain, interrupted
from separatrix.cli.run import Options, make_study, run
from separatrix.cli.verbs import VERBS, Verb
from separatrix.errors import InputError, SeparatrixError

ANSWERED, FAULT, WRONG_INPUT = 0, 1, 2

Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
Out = Annotated[
    str | None,
    typer.Option(metavar="DIR", help="Folder for figures and data [default: named after the study]."),
]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress bar.")]
Jobs = Annotated[int | None, typer.Option(metavar="N", help="Threads [default: one for each processor].")]
StudyArgument = Annotated[
    str, typer.Argument(metavar="STUDY", help="A study file, or the name of a shipped study.")
]
MOST_JOBS = 1024

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""


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
        raise InputError("--jobs", f"must lie between 1 and {MOST_JOBS}", value=str(jobs), cure=cure)
    return jobs or processors()


def folder(out: str | None) -> Path | None:
    """Return the folder asked for; an empty name, as from an unset variable, is refused.

    Raises
    ------
    InputError
        The name is empty.
    """
    if out is not None and not out.strip():
        raise InputError("--out", "needs the name of a folder", value='""', cure="The current one is .")
    return None if out is None else Path(out)


def _command(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of one verb."""

    def command(
        study: StudyArgument,
        json: Json = False,
        out: Out = None,
        quiet: Quiet = False,
        jobs: Jobs = None,
    ) -> int:
        options = Options(json=json, out=folder(out), quiet=quiet, jobs=threads(jobs))
        try:
            with Interruptible():
                return run(verb, study, options)
        except KeyboardInterrupt:  # here, for typer would swallow it
            return interrupted("nothing was written.")

    return command


def _new(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="The file to make; it must not exist yet.")],
    json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing.")] = False,
) -> int:
    return make_study(path, as_json=json, quiet=quiet)


def _application() -> typer.Typer:
    """Return the command line, with the verbs in the order of the chain."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.callback(invoke_without_command=True, help=HELP)(_start)
    app.command("new", help="Write a commented study file to fill in.")(_new)
    for verb in VERBS:
        app.command(verb.name, help=verb.help)(_command(verb))
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
        verbs = ", ".join(["new", *(verb.name for verb in VERBS)])
        raise InputError("The command line", f"lacks a verb: {verbs}", cure='Try "separatrix --help".')


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, as `separatrix.cli.main` says."""
    command = typer.main.get_command(_application())
    try:
        status = command.main(arguments, prog_name="separatrix", standalone_mode=False)
    except typer.TyperException as error:
        complain(_usage(error.format_message()))
        return WRONG_INPUT
    except SeparatrixError as error:
        complain(str(error))
        return WRONG_INPUT if isinstance(error, ValueError | LookupError) else FAULT
    return int(status or ANSWERED)


def _usage(message: str) -> str:
    return f'{message.rstrip(". ")}. Try "separatrix --help".'
