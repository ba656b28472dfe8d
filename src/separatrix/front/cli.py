"""The command line: its commands with their help, those on files among them, and the form of a refusal."""

from __future__ import annotations

import contextlib
import webbrowser
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from separatrix.front.commands import (
    ANSWERED,
    Jobs,
    Json,
    Quiet,
    command,
    computed_with_progress,
    deliver,
    folder,
    named,
    options_of,
    print_place,
    threads,
    tool_command,
    verb_command,
    whole_number,
    with_progress,
)
from separatrix.front.console import (
    answer,
    answer_json,
    complain,
    interrupted,
    interruptible,
)
from separatrix.ground.errors import InputError, SeparatrixError, harmless
from separatrix.ground.files import refuse_existing, staged, writable_folder, write_new
from separatrix.ground.units import printable, shown
from separatrix.verbs import TOOLS, VERBS, tool_named, verb_named

if TYPE_CHECKING:
    from separatrix.ground.document import Document
    from separatrix.verbs.report import Report
    from separatrix.verbs.verb import Tool, Verb

FAULT, WRONG_INPUT = 1, 2

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""
PAGE = "Open the page: edit, run and look at the studies of a folder in a browser."
PAGE_EPILOG = (
    "Only this computer can open the page, by the printed link. If you stop the page during a job, start the "
    'job again to resume it. Needs the extra app: pip install "separatrix[app]".'
)
FOLDER_HELP = "Where the studies are [default: here]."
NEEDED = ("starlette", "uvicorn", "plotly")
MOST_PORT = 65535

REPORT = "Everything on one study as a document: HTML, and PDF with --pdf."
REPORT_EPILOG = (
    "Of a folder: from the answers in it. Of a study: bearing, traction, "
    "restitution and rank (without [ranking]: stability) are computed into its folder first; answers to the "
    "same inputs that are there already are taken. The HTML needs no other file and no network."
)
ASKED_HELP = "A study, or a folder of answers."
REPORT_OUT = "Folder of the report [default: that of the answers; none with --json]."
PDF_HELP = "Also write report.pdf; needs the extra pdf."


NEW_HELP = "The file to make, a workbook if it ends in .xlsx; it must not exist yet."


def _new(
    path: Annotated[Path, typer.Argument(metavar="PATH", help=NEW_HELP)],
    json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing.")] = False,
) -> int:
    from separatrix.ground.sheet import WORKBOOK_ENDINGS

    ending = path.suffix.casefold()
    if path.is_dir():
        cure = f'Name a file: "{path / "my-bearing.toml"}".'
        raise InputError(str(path), "is a folder", cure=cure)
    if ending in WORKBOOK_ENDINGS and ending != ".xlsx":
        cure = f"Name it {path.stem}.xlsx, or {path.stem}.toml."
        raise InputError(str(path), "is a kind of workbook that is not read", cure=cure)
    refuse_existing(path)
    from separatrix.study.template import template, template_workbook

    write_new(path, template_workbook() if ending == ".xlsx" else template().encode())
    if json:
        answer_json({"path": str(path)})
    elif not quiet:
        answer(f"{path} is written. Fill it in, then: separatrix check {path}\n")
    return ANSWERED


def _page(
    place: Annotated[Path, typer.Argument(metavar="FOLDER", help=FOLDER_HELP, show_default=False)] = Path(
        "."
    ),
    port: Annotated[int | None, whole_number("Port to listen on [default: any that is free].")] = None,
    open_it: Annotated[bool, typer.Option("--open", help="Open it in the browser, too.")] = False,
) -> int:
    if not place.is_dir():
        raise InputError(str(place), "is not a folder", cure="Name the folder of your studies.")
    if port is not None and not 1 <= port <= MOST_PORT:
        raise InputError("--port", f"must lie between 1 and {MOST_PORT}", got=str(port))
    if lacking := [name for name in NEEDED if find_spec(name) is None]:
        cure = 'Install the extra: pip install "separatrix[app]".'
        raise InputError("separatrix app", f"needs {', '.join(lacking)}", cure=cure)
    from separatrix.front.page.server import Server

    server = Server(place.resolve(), port=port or 0)
    answer(f"The page of {place.resolve()} is at\n\n  {server.link}\n\nCtrl-C ends it.\n")
    if open_it:
        webbrowser.open(server.link)
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
        server.serve_until_ended()
    return ANSWERED


# The report.


def _report(
    asked: Annotated[str, typer.Argument(metavar="STUDY|FOLDER", help=ASKED_HELP)],
    pdf: Annotated[bool, typer.Option("--pdf", help=PDF_HELP)] = False,
    json: Json = False,
    out: Annotated[str | None, typer.Option(metavar="DIR", help=REPORT_OUT)] = None,
    quiet: Quiet = False,
    jobs: Jobs = None,
) -> int:
    """Write the report of a study or of a folder, and return the exit status."""
    to, count = folder(out), threads(jobs)
    if pdf:
        from separatrix.present.pdf import typesetter

        if json and to is None:
            raise InputError("--pdf", "needs a folder with --json", cure="Give --out DIR.")
        typesetter()
    from separatrix.study.reading import read_study
    from separatrix.study.study import shipped_studies
    from separatrix.verbs.answer_files import document
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
            how: dict[str, Any] = {"quiet": quiet, "jobs": count, "folder": place}

            def computed(verb: Verb) -> Document:
                return document(verb, computed_with_progress(verb, study, **how))

            made = report_of_study(study, computed, place)
        if made is None:
            return interrupted("no report was written. Run the same command to resume.")
        files = [] if place is None else made.write(place, with_pdf=pdf)
        if json:
            answer_json(made.document(files))
            return ANSWERED
        written = f"\nThe report is {' and '.join(map(str, files))}\n" if files and not quiet else ""
        answer(f"{harmless(made.summary())}\n{written}")
    return ANSWERED


# The friction of logs.


FRICTION_HELP = "Friction file to write, such as friction.toml [default: none]."
PLOTS_HELP = "Folder of a picture for each test [default: beside the friction file]."
WRITTEN: dict[str, tuple[Any, Any]] = {
    "out": (Annotated[str | None, typer.Option(metavar="FILE", help=FRICTION_HELP)], None),
    "plots": (Annotated[str | None, typer.Option(metavar="DIR", help=PLOTS_HELP)], None),
}


def _reduce(tool: Tool, given: Mapping[str, Any]) -> int:
    """Reduce logs; write a friction file and pictures of the tests."""
    from separatrix.ground.document import part_of
    from separatrix.verbs.answer_files import save_pictures

    to, pages = named(given["out"], "--out", "a file"), named(given["plots"], "--plots", "a folder")
    if to is not None:
        _refuse_out(to)
        pages = pages or to.with_name(f"{to.stem}-plots")
    with interruptible("no friction file was written."), contextlib.ExitStack() as stack:
        for place in filter(None, (to and to.parent, pages)):
            stack.enter_context(writable_folder(place))
        found = _reduced(tool, given, to)
        page = tool.page(part_of(found))
        if pages is not None:
            save_pictures(pages, page)
        deliver(found, lambda: page, given)
        if pages is not None:
            print_place("Pictures of the tests", pages, given)
    return ANSWERED


def _reduced(tool: Tool, given: Mapping[str, Any], to: Path | None) -> Document:
    """Compute the document of logs, and write their friction file; a draft of a map if one is needed."""
    from separatrix.friction.logs import UnmappedError
    from separatrix.verbs.tribometer import document, reduced

    try:
        compute = partial(reduced, options_of(tool, given), complete=to is not None)
        found = with_progress(tool, compute, given)
    except UnmappedError as error:
        raise error.with_draft_written() from None
    if to is not None and found.friction_tests is not None:
        from separatrix.friction.friction_file import friction_text

        with staged(to.parent) as stage:
            (stage / to.name).write_text(friction_text(found.friction_tests), encoding="utf-8")
            refuse_existing(to)  # it may have been made since the first check
    return document(found, None if to is None else str(to))


def _refuse_out(out: Path) -> None:
    try:
        is_folder = out.is_dir()
    except OSError as error:
        where = f"--out {printable(str(out), 200)}"
        raise InputError(where, "cannot be written", error.strerror or type(error).__name__) from None
    if out.suffix != ".toml" or is_folder:
        cure = 'Name a file like "friction.toml".'
        raise InputError("--out", "must name a file that ends in .toml", shown(str(out)), cure)
    refuse_existing(out)


PLAIN: dict[str, Any] = {
    "add_completion": False,
    "rich_markup_mode": None,
    "pretty_exceptions_enable": False,
}
"""How typer shows commands: as text."""


def _command(name: str) -> Any:
    """Return a command; only its own module is loaded."""
    app = typer.Typer(**PLAIN)
    if name == "materials":
        from separatrix.verbs.materials import LIST, SHOW

        app.callback(help=OTHERS[name])(lambda: None)
        for one in (LIST, SHOW):
            app.command(one.name.split()[-1], help=one.help, epilog=one.epilog)(tool_command(one))
        return typer.main.get_command(app)
    if name in VERBS:
        verb = verb_named(name)
        made, epilog = verb_command(verb), verb.epilog
    elif name in TOOLS:
        tool = tool_named(name)
        made, epilog = tool_command(tool), tool.epilog
        if name == "tribometer":
            made = command(_reduce, tool, "full", "json", "quiet", "jobs", more=WRITTEN)
    else:
        made, epilog = OWN[name]
    app.command(name, help=COMMANDS[name], epilog=epilog)(made)
    return typer.main.get_command(app)


OWN: dict[str, tuple[Callable[..., int], str | None]] = {
    "new": (_new, None),
    "report": (_report, REPORT_EPILOG),
    "app": (_page, PAGE_EPILOG),
}
"""Commands without a verb -> function and epilog."""

OTHERS = {
    "new": "Write a commented study file to fill in.",
    "report": REPORT,
    "app": PAGE,
    "materials": "The library of materials.",
}
COMMANDS = {"new": OTHERS["new"], **VERBS, **TOOLS, **OTHERS}
"""Command -> its line of help, in the order of the chain."""


class _Commands(typer.core.TyperGroup):
    """The commands by name, each made when it is asked for: the list of them loads none."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.commands = dict.fromkeys(COMMANDS)  # type: ignore[assignment] # names alone, to suggest one

    def list_commands(self, _ctx: Any) -> list[str]:
        """Return their names."""
        return [*COMMANDS]

    def get_command(self, _ctx: Any, cmd_name: str) -> Any:
        """Return one of them, None of another name."""
        return _command(cmd_name) if cmd_name in COMMANDS else None

    def format_commands(self, _ctx: Any, formatter: Any) -> None:
        """Write their lines of help."""
        with formatter.section("Commands"):
            formatter.write_dl([*COMMANDS.items()])


def _start(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and stop.")] = False,
) -> None:
    if version:
        from separatrix import __version__

        answer(f"separatrix {__version__}\n")
        raise typer.Exit
    if context.invoked_subcommand is None:
        raise InputError(
            "The command", f"is missing; choose one of {', '.join(COMMANDS)}", cure='Try "separatrix --help".'
        )


def run_command_line(arguments: Sequence[str] | None) -> int:
    """Run the command line; return its exit status, that of `separatrix.front.main`."""
    app = typer.Typer(cls=_Commands, **PLAIN)
    app.callback(invoke_without_command=True, help=HELP)(_start)
    try:
        status = typer.main.get_command(app).main(arguments, prog_name="separatrix", standalone_mode=False)
    except typer.Abort:  # an interrupt before the work
        return interrupted("no file was written.")
    except typer.TyperException as error:
        text = error.format_message().rstrip(". ")
        complain(f'{text}{"" if text.endswith("?") else "."} Try "separatrix --help".')
        return WRONG_INPUT
    except SeparatrixError as error:
        for line in str(error).split("\n"):
            complain(line)
        return WRONG_INPUT if isinstance(error, ValueError | LookupError) else FAULT
    return int(status or ANSWERED)
