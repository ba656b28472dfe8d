"""The command line: its commands with their help, `new` and `app` among them, and the form of a refusal."""

from __future__ import annotations

import contextlib
import json as plain_json
import webbrowser
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from separatrix.front import (
    commands_without_bearing as without_bearing,
)
from separatrix.front import report_command as reporting
from separatrix.front import (
    saved_answer_commands as saved_answers,
)
from separatrix.front.console import answer, complain
from separatrix.front.verb_commands import ANSWERED, Json, command_of, whole_number
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.files import refuse_existing, write_new
from separatrix.verbs import VERBS

FAULT, WRONG_INPUT = 1, 2

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""
PAGE = "Open the page: edit, run and look at the studies of a folder in a browser."
PAGE_EPILOG = (
    "It is served on 127.0.0.1 only, to who has the link that is printed; nothing leaves this machine. Jobs "
    "keep their finished runs: a page that is ended in the middle of one goes on when it is asked again. "
    'Needs the extra app: pip install "separatrix[app]".'
)
FOLDER_HELP = "Where the studies are [default: here]."
NEEDED = ("fastapi", "uvicorn", "plotly", "tomlkit")
MOST_PORT = 65535


def _new(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="The file to make; it must not exist yet.")],
    excel: Annotated[
        bool, typer.Option("--excel", help="A workbook, .xlsx, in place of a text file.")
    ] = False,
    json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing.")] = False,
) -> int:
    from separatrix.ground.sheet import WORKBOOK_ENDINGS

    ending = path.suffix.casefold()
    if path.is_dir():
        cure = f'Name a file: "{path / ("my-bearing.xlsx" if excel else "my-bearing.toml")}".'
        raise InputError(str(path), "is a folder", cure=cure)
    if excel and ending != ".xlsx":
        better = path.with_suffix(".xlsx") if ending in WORKBOOK_ENDINGS else f"{path}.xlsx"
        raise InputError(str(path), "must end in .xlsx with --excel", cure=f'Name it "{better}".')
    if ending in WORKBOOK_ENDINGS and not excel:
        cure = f"Name it {path.stem}.toml, or {path.stem}.xlsx with --excel."
        raise InputError(str(path), "is the name of a workbook", cure=cure)
    refuse_existing(path)
    from separatrix.study.template import template, template_workbook

    write_new(path, template_workbook() if excel else template().encode())
    if json:
        answer(plain_json.dumps({"path": str(path)}) + "\n")
    elif not quiet:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


def _page(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help=FOLDER_HELP, show_default=False)] = Path(
        "."
    ),
    port: Annotated[int | None, whole_number("Port to listen on [default: any that is free].")] = None,
    open_it: Annotated[bool, typer.Option("--open", help="Open it in the browser, too.")] = False,
) -> int:
    if not folder.is_dir():
        raise InputError(str(folder), "is not a folder", cure="Name the folder of your studies.")
    if port is not None and not 1 <= port <= MOST_PORT:
        raise InputError("--port", f"must lie between 1 and {MOST_PORT}", got=str(port))
    if lacking := [name for name in NEEDED if find_spec(name) is None]:
        cure = 'Install the extra: pip install "separatrix[app]".'
        raise InputError("separatrix app", f"needs {', '.join(lacking)}", cure=cure)
    from separatrix.front.page.server import Server

    server = Server(folder.resolve(), port=port or 0)
    answer(f"The page of {folder.resolve()} is at\n\n  {server.link}\n\nCtrl-C ends it.\n")
    if open_it:
        webbrowser.open(server.link)
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
        server.serve_until_ended()
    return ANSWERED


def _application() -> typer.Typer:
    """Return the command line, with the verbs in the order of the chain."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.callback(invoke_without_command=True, help=HELP)(_start)
    app.command("new", help="Write a commented study file to fill in.")(_new)
    for verb in VERBS:
        app.command(verb.name, help=verb.help, epilog=verb.epilog)(command_of(verb))
    for name, command, text, epilog in (
        (
            "tribometer",
            without_bearing.tribometer,
            without_bearing.TRIBOMETER,
            without_bearing.TRIBOMETER_EPILOG,
        ),
        ("compare", saved_answers.compare, saved_answers.COMPARE, saved_answers.COMPARE_EPILOG),
        ("reproduce", saved_answers.reproduce, saved_answers.REPRODUCE, saved_answers.REPRODUCE_EPILOG),
        ("report", reporting.report, reporting.HELP, reporting.EPILOG),
        ("app", _page, PAGE, PAGE_EPILOG),
    ):
        app.command(name, help=text, epilog=epilog)(command)
    app.add_typer(without_bearing.materials_application(), name="materials", help=without_bearing.MATERIALS)
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
        others = ("tribometer", "compare", "reproduce", "report", "app", "materials")
        verbs = ", ".join(["new", *(verb.name for verb in VERBS), *others])
        raise InputError("The command", f"is missing; choose one of {verbs}", cure='Try "separatrix --help".')


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, that of `separatrix.front.main`."""
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
