"""The command line: its commands with their help, those on files among them, and the form of a refusal."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from separatrix.front.commands import (
    ANSWERED,
    Given,
    answered,
    beside,
    command,
    document_of,
    options_of,
    result_of,
    tool_command,
    verb_command,
)
from separatrix.front.console import answer, answer_json, complain, interrupted, interruptible
from separatrix.ground.errors import InputError, SeparatrixError, harmless
from separatrix.ground.files import refuse_existing, staged, writable_folder, write_new
from separatrix.ground.units import shown
from separatrix.verbs import TOOLS, VERBS, tool_named, verb_named
from separatrix.verbs.verb import Option, shown_options

if TYPE_CHECKING:
    from separatrix.ground.document import Document
    from separatrix.verbs.report import Report
    from separatrix.verbs.verb import Tool

FAULT, WRONG_INPUT = 1, 2

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewOptions:
    """What `new` takes."""

    path: Annotated[Path, Option("The file to make; its name ends in .toml.", "PATH", True)]


def _new(given: Given) -> int:
    path = given["path"]
    if path.suffix != ".toml" or path.is_dir():
        cure = 'Name a file like "my-bearing.toml".'
        raise InputError(str(path), "must name a file that ends in .toml", cure=cure)
    from separatrix.study.template import template

    write_new(path, template().encode())
    if given["json"]:
        answer_json({"path": str(path)})
    elif not given["quiet"]:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


# The local page.


PAGE_EPILOG = (
    "Only this computer can open the page, by the printed link. If you stop the page during a job, start the "
    'job again to resume it. Needs the extra app: pip install "separatrix[app]".'
)
NEEDED = ("starlette", "uvicorn")
PORT = "Port to listen on [default: any that is free]."


@dataclass(frozen=True, slots=True, kw_only=True)
class PageOptions:
    """What `app` takes."""

    place: Annotated[Path, Option("Where the studies are [default: here].", "FOLDER", True)] = Path()
    port: Annotated[int | None, Option(PORT, "N", most=65535)] = None
    open: Annotated[bool, Option("Open it in the browser, too.")] = False


def _page(given: Given) -> int:
    place, port = given["place"], given["port"]
    if not place.is_dir():
        raise InputError(str(place), "is not a folder", cure="Name the folder of your studies.")
    if lacking := [name for name in NEEDED if find_spec(name) is None]:
        cure = 'Install the extra: pip install "separatrix[app]".'
        raise InputError("separatrix app", f"needs {', '.join(lacking)}", cure=cure)
    from separatrix.front.page.server import Server

    server = Server(place.resolve(), port=port or 0)
    answer(f"The page of {place.resolve()} is at\n\n  {server.link}\n\nCtrl-C ends it.\n")
    if given["open"]:
        import webbrowser

        webbrowser.open(server.link)
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
        server.serve_until_ended()
    return ANSWERED


# The report.


REPORT_EPILOG = (
    "Of a folder: from the answers in it. Of a study: bearing, traction, "
    "restitution and rank (without [ranking]: stability) are computed into its folder first; answers to the "
    "same inputs that are there already are taken. The HTML needs no other file and no network."
)
REPORT_OUT = "Folder of the report [default: that of the answers; none with --json]."


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportOptions:
    """What `report` takes."""

    asked: Annotated[str, Option("A study, or a folder of answers.", "STUDY|FOLDER", True)]
    pdf: Annotated[bool, Option("Also write report.pdf; needs the extra pdf.")] = False
    out: Annotated[Path | None, Option(REPORT_OUT, "DIR")] = None


def _report(given: Given) -> int:
    """Write the report of a study or of a folder, and return the exit status."""
    asked, to, json, pdf = (given[name] for name in ("asked", "out", "json", "pdf"))
    if pdf:
        from separatrix.present.pdf import typesetter

        if json and to is None:
            raise InputError("--pdf", "needs a folder with --json", cure="Give --out DIR.")
        typesetter()
    from separatrix.study.reading import read_study
    from separatrix.study.study import shipped_studies
    from separatrix.verbs.report import report_of, report_of_study
    from separatrix.verbs.saved_answers import read_folder

    with interruptible("no report was written."), contextlib.ExitStack() as stack:
        is_folder = Path(asked).is_dir() and asked not in shipped_studies()
        study = None if is_folder else read_study(asked)
        usual = Path(asked) if study is None else Path(study.name)
        place = None if to is None and json else to or usual
        if place is not None:
            stack.enter_context(writable_folder(place))
        if study is None:
            made: Report | None = report_of(read_folder(usual), where=str(usual))
        else:
            made = report_of_study(study, lambda verb: document_of(verb, study, given, place), place)
        if made is None:
            return interrupted("no report was written. Run the same command to resume.")
        files = [] if place is None else made.write(place, with_pdf=pdf)
        if json:
            answer_json(made.document(files))
            return ANSWERED
        where = f"\nThe report is {' and '.join(map(str, files))}\n"
        written = where if files and not given["quiet"] else ""
        answer(f"{harmless(made.summary())}\n{written}")
    return ANSWERED


# The friction of logs.


@dataclass(frozen=True, slots=True, kw_only=True)
class Written:
    """What `tribometer` writes."""

    out: Annotated[Path | None, Option("Friction file to write, such as friction.toml.", "FILE")] = None


def _reduce(tool: Tool, given: Given) -> int:
    """Reduce logs; write a friction file and pictures of the tests."""
    to = given["out"]
    pictures = None if to is None else to.with_name(f"{to.stem}-plots")
    with interruptible("no friction file was written."), contextlib.ExitStack() as stack:
        if to is not None:
            if to.suffix != ".toml" or os.path.isdir(to):
                cure = 'Name a file like "friction.toml".'
                raise InputError("--out", "must name a file that ends in .toml", shown(str(to)), cure)
            refuse_existing(to)
            stack.enter_context(writable_folder(to.parent))
        answered(tool, given, partial(_reduced, tool, given, to), pictures, only_pictures=True)
    return ANSWERED


def _reduced(tool: Tool, given: Given, to: Path | None) -> Document:
    """Compute the document of logs, and write their friction file; a draft of a map if one is needed."""
    from separatrix.friction.logs import UnmappedError
    from separatrix.verbs.tribometer import document, reduced

    try:
        compute = partial(reduced, options_of(tool, given), complete=to is not None)
        found = result_of(tool, compute, given)
    except UnmappedError as error:
        raise error.with_draft_written() from None
    if to is not None and found.friction_tests is not None:
        from separatrix.friction.friction_file import friction_text

        with staged(to.parent) as stage:
            (stage / to.name).write_text(friction_text(found.friction_tests), encoding="utf-8")
            refuse_existing(to)  # it may have been made since the first check
    return document(found, None if to is None else str(to))


# The commands by name.


COMMANDS = {
    "new": "Write a commented study file to fill in.",
    **VERBS,
    **TOOLS,
    "report": "Everything on one study as a document: HTML, and PDF with --pdf.",
    "app": "Open the page: edit, run and look at the studies of a folder in a browser.",
    "materials": "The library of materials.",
}
"""Command -> its line of help, in the order of the chain."""


def _command(name: str) -> click.Command:
    """Return a command; only its own module is loaded."""
    about = COMMANDS[name]
    if name in VERBS:
        return verb_command(verb_named(name), about)
    match name:
        case "new":
            return command(name, _new, shown_options(NewOptions) | beside("json", "quiet"), about)
        case "report":
            takes = shown_options(ReportOptions) | beside("json", "quiet", "jobs")
            return command(name, _report, takes, about, REPORT_EPILOG)
        case "app":
            return command(name, _page, shown_options(PageOptions), about, PAGE_EPILOG)
        case "tribometer":
            tool = tool_named(name)
            takes = tool.shown_options() | shown_options(Written) | beside("full", "json", "quiet", "jobs")
            return command(name, partial(_reduce, tool), takes, about, tool.epilog)
        case "materials":
            from separatrix.verbs.materials import LIST, SHOW

            both = [tool_command(one, one.help) for one in (LIST, SHOW)]
            return click.Group(name, {str(one.name): one for one in both}, help=about, no_args_is_help=False)
    return tool_command(tool_named(name), about)


class _Commands(click.Group):
    """The commands by name, each made when it is asked for: the list of them loads none."""

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Return one of them, None of another name."""
        return _command(cmd_name) if cmd_name in COMMANDS else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write their lines of help."""
        with formatter.section("Commands"):
            formatter.write_dl([*COMMANDS.items()])


@click.pass_context
def _start(context: click.Context, /, *, version: bool) -> None:
    if version:
        from separatrix import __version__

        answer(f"separatrix {__version__}\n")
        context.exit()
    if context.invoked_subcommand is None:
        choices = ", ".join(COMMANDS)
        raise InputError(
            "The command", f"is missing; choose one of {choices}", cure='Try "separatrix --help".'
        )


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, that of `separatrix.front.main`."""
    version = click.Option(["--version"], is_flag=True, help="Show the version and stop.")
    names: Any = dict.fromkeys(COMMANDS)  # to suggest one
    app = _Commands(commands=names, callback=_start, params=[version], help=HELP, invoke_without_command=True)
    try:
        status = app.main(arguments, prog_name="separatrix", standalone_mode=False)
    except click.Abort:  # an interrupt before the work
        return interrupted("no file was written.")
    except click.ClickException as error:
        text = error.format_message().rstrip(". ")
        complain(f'{text}{"" if text.endswith("?") else "."} Try "separatrix --help".')
        return WRONG_INPUT
    except SeparatrixError as error:
        for line in str(error).split("\n"):
            complain(line)
        return WRONG_INPUT if isinstance(error, ValueError | LookupError) else FAULT
    return int(status or ANSWERED)
