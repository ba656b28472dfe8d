"""The command line: commands made from descriptions of options, those on files, and the form of a refusal."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from separatrix.front.console import (
    answer,
    answer_json,
    breakable,
    complain,
    interrupted,
    interruptible,
    progress_bar,
)
from separatrix.ground.errors import InputError, SeparatrixError, harmless
from separatrix.ground.files import writable_folder, write_new
from separatrix.ground.units import shown
from separatrix.verbs import TOOLS, VERBS, asked_study, computed, processors, tool_named, verb_named
from separatrix.verbs.verb import Option, Shown, kind_of, shown_options

if TYPE_CHECKING:
    from separatrix.ground.plain_data import Document
    from separatrix.study.study import Study
    from separatrix.verbs.report import Report
    from separatrix.verbs.verb import Tool, Verb

Given = Mapping[str, Any]

HELP = """Will the cage of this dry-lubricated ball bearing run stably, and which cage material is best?

STUDY is the path of a study file, or the name of a shipped study. Begin with:

separatrix rank cryogenic-turbopump
"""

ANSWERED, FAULT, WRONG_INPUT = 0, 1, 2

MODEL = "The best estimate or the paper's method [default: that of the study]."
OUT = "named after the study; none with --json, or of check"
CLUSTER = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."


@dataclass(frozen=True, slots=True, kw_only=True)
class Beside:
    """What commands take beside the options of their verbs."""

    study: Annotated[str, Option("A study file, or the name of a shipped study.", "STUDY", True)]
    model: Annotated[str | None, Option(MODEL, "full|paper")] = None
    full: Annotated[bool, Option("The whole answer, not only what fits a screen.")] = False
    json: Annotated[bool, Option("One JSON document on standard output, in SI units.")] = False
    out: Annotated[Path | None, Option(f"Folder for figures and data [default: {OUT}].", "DIR")] = None
    quiet: Annotated[bool, Option("No progress, no notes: the answer alone.")] = False
    jobs: Annotated[int | None, Option("Threads [default: one for each processor].", "N", most=1024)] = None
    cluster: Annotated[str | None, Option(CLUSTER, "ADDRESS")] = None


def beside(*names: str) -> Shown:
    """Return some of what commands take beside the options of their verbs."""
    known = shown_options(Beside)
    return {name: known[name] for name in names}


NAMED = {"DIR": "a folder", "ADDRESS": "a scheduler, or local:N"}
"""What an option names, by what stands for its value; another file names a file."""


def option_value(kind: str, text: Any, option: str, note: Option) -> Any:
    """Return the value of an option from its text; an empty name, as from an unset variable, is refused."""
    if kind == "files":
        return tuple(option_value("file", one, option, note) for one in text)
    if text is None:
        return None
    if kind == "number":
        try:
            found = int(text)
        except ValueError:
            cure = "Write it in digits, or leave it out."
            raise InputError(option, "must be a whole number", shown(text), cure) from None
        if note.most and not 1 <= found <= note.most:
            rule = f"must lie between 1 and {note.most}"
            raise InputError(option, rule, str(found), "Leave it out for the default.")
        return found
    if (kind == "file" or note.metavar in NAMED) and (not text.strip() or "\0" in text):
        cure = "The current one is ." if note.metavar == "DIR" else ""
        raise InputError(option, f"needs the name of {NAMED.get(note.metavar, 'a file')}", '""', cure)
    return Path(text) if kind == "file" else text


def flag_of(name: str, note: Option) -> str:
    """Return the name of an option on the command line."""
    return note.flag or f"--{name.replace('_', '-')}"


def asked_of(verb: Verb) -> Shown:
    """Return the options of a verb; where it moves a cage, the model too."""
    return shown_options(verb.options) | beside(*("model",) * verb.moves_a_cage)


def _parameter(name: str, hint: Any, note: Option, default: Any) -> click.Parameter:
    """Return an option as the command line takes it."""
    kind, flag = kind_of(hint), flag_of(name, note)
    is_many, own = kind.endswith("s"), note.metavar if note.is_argument else flag
    how: dict[str, Any] = {
        "help": note.help,
        "metavar": note.metavar or None,
        "callback": lambda _, __, given: option_value(kind, given, own, note),
    }
    if default is not MISSING and not is_many:
        how["default"] = default
    if note.is_argument:
        return click.Argument([name], nargs=-1 if is_many else 1, required=default is MISSING, **how)
    if kind == "flag":
        return click.Option([flag, name], is_flag=True, **how)
    return click.Option([flag, name], type=str, multiple=is_many, show_default=True, **how)


def command(
    name: str, run: Callable[[Given], int], takes: Shown, about: str, epilog: str | None = None
) -> click.Command:
    """Return a command that calls `run` with the values of what it takes, and returns the exit status."""
    parameters = [_parameter(option, *one) for option, one in takes.items()]
    callback: Callable[..., int] = lambda **given: run(given)  # noqa: E731
    return click.Command(name, callback=callback, params=parameters, help=about, epilog=epilog)


def options_of(asked: Tool, given: Given) -> Any:
    """Return the options of a verb or tool from the values of its command."""
    return asked.options(**{name: given[name] for name in shown_options(asked.options)})


# What a command does, from its question to its files.


def answered(asked: Tool, given: Given, compute: Callable[[], Document], to: Path | None) -> Document:
    """Compute a document, print it or its page, save it in `to`, tested before the work; return it."""
    from separatrix.present.blocks import Level
    from separatrix.present.text import text
    from separatrix.verbs.answer_files import page_of_document, save_answer

    json, quiet = given["json"], given.get("quiet", False)
    with contextlib.nullcontext() if to is None else writable_folder(to):
        made = compute()
        page = page_of_document(asked, made) if to is not None or not json else None
        if page is None or json:
            answer_json(made)
        else:
            shown = page.without_notes() if quiet else page
            answer(text(shown, Level.FULL if given.get("full") else Level.BRIEF))
        if page is None or to is None:
            return made
        with progress_bar("files", quiet=quiet):  # this takes as long again
            save_answer(to, asked, made, page=page)
        if not json and not quiet:
            whole = "Text, figures and data" if made.get("complete", True) else "Text and data"
            what = "Pictures of the tests" if asked.pictures else whole
            answer(f"\n{what} are in {to}/\n")
    return made


def run(verb: Verb, given: Given) -> int:
    """Answer one question to a study and return the exit status."""
    is_kept = verb.keeps_runs and not (given["json"] and given["out"] is None)
    with interruptible("runs that were finished are kept." if is_kept else "no file was written."):
        options = options_of(verb, given)
        study = asked_study(verb, given["study"], given.get("model"))
        to = given["out"] or (Path(study.name) if verb.writes_data and not given["json"] else None)
        made = answered(verb, given, partial(document_of, verb, study, given, to, options), to)
    if made.get("complete") is not False:
        return ANSWERED
    more = " Run the same command to resume." if verb.keeps_runs and to is not None else ""
    return interrupted(f"the answer has what was finished, and is marked complete: false.{more}")


def document_of(verb: Verb, study: Study, given: Given, folder: Path | None, options: Any = None) -> Document:
    """Compute the answer with a bar of progress; print how many runs an earlier call had kept."""
    from separatrix.verbs.answer_files import document

    how: dict[str, Any] = {"jobs": given["jobs"], "folder": folder, "cluster": given.get("cluster")}
    with progress_bar(f"{verb.name} {study.name}", quiet=given["quiet"]) as progress:
        found = breakable(partial(computed, verb, study, options, progress=progress, **how))
    if found.runs_taken and not given["quiet"]:
        from separatrix.verdict.long_jobs import NAME

        kept = f"{folder}/{NAME}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return document(verb, found)


def tool_command(tool: Tool, about: str) -> click.Command:
    """Return the command of a tool."""
    names = [*["out"] * bool(tool.folder), *["quiet"] * (tool.takes_time or bool(tool.folder))]
    takes = shown_options(tool.options) | beside("full", "json", *names, *["jobs"] * tool.takes_time)
    return command(tool.name.split()[-1], partial(run_tool, tool), takes, about, tool.epilog)


def run_tool(tool: Tool, given: Given) -> int:
    """Answer a tool's question and return the exit status; with a bar, if it takes time."""
    usual = Path(tool.folder) if tool.folder and not given["json"] else None
    with interruptible(tool.ended):
        options = options_of(tool, given)
        to = tool.pictures(options) if tool.pictures else given.get("out") or usual

        def compute() -> Document:
            with progress_bar(tool.name, quiet=given.get("quiet", False) or not tool.takes_time) as progress:
                how = (given["jobs"] or processors(), progress) if tool.takes_time else ()
                return breakable(partial(tool.compute, options, *how))

        answered(tool, given, compute, to)
    return ANSWERED


# The commands on files.


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
    place = given["place"]
    if not place.is_dir():
        raise InputError(str(place), "is not a folder", cure="Name the folder of your studies.")
    if lacking := [name for name in NEEDED if find_spec(name) is None]:
        cure = 'Install the extra: pip install "separatrix[app]".'
        raise InputError("separatrix app", f"needs {', '.join(lacking)}", cure=cure)
    from separatrix.front.page.server import Server

    server = Server(place.resolve(), port=given["port"] or 0)
    answer(f"The page of {place.resolve()} is at\n\n  {server.link}\n\nCtrl-C ends it.\n")
    if given["open"]:
        import webbrowser

        webbrowser.open(server.link)
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
        server.serve_until_ended()
    return ANSWERED


# The report.

REPORT_EPILOG = (
    "Of a folder: from the answers in it. Of a study: bearing, traction, simulate, "
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
    from separatrix.verbs.answer_files import read_folder
    from separatrix.verbs.report import report_of, report_of_study

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
        where = " and ".join(map(str, files))
        written = f"\nThe report is {where}\n" if where and not given["quiet"] else ""
        answer(f"{harmless(made.summary())}\n{written}")
    return ANSWERED


DEMO = "cryogenic-turbopump"
FIRST = f"""\
separatrix predicts whether the cage of a dry-lubricated ball bearing runs stably, and ranks cage materials.
Try it: separatrix demo (as `separatrix rank {DEMO}`), then: separatrix new my-bearing.toml
All commands: separatrix --help. The documentation begins in docs/index.md of the source.
"""
COMMANDS = {
    "demo": "Rank the seven cage materials of the shipped study.",
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
    if name in VERBS or name == "demo":
        known = {"study": DEMO, "cluster": None} if name == "demo" else {}
        verb = verb_named("rank" if known else name)
        after = beside("full", "json", "out", "quiet", "jobs", *["cluster"] * verb.keeps_runs)
        takes = {**beside("study"), **asked_of(verb), **after}
        open_ones = {option: one for option, one in takes.items() if option not in known}
        return command(name, lambda given: run(verb, {**known, **given}), open_ones, about, verb.epilog)
    match name:
        case "new":
            return command(name, _new, shown_options(NewOptions) | beside("json", "quiet"), about)
        case "report":
            takes = shown_options(ReportOptions) | beside("json", "quiet", "jobs")
            return command(name, _report, takes, about, REPORT_EPILOG)
        case "app":
            return command(name, _page, shown_options(PageOptions), about, PAGE_EPILOG)
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
        answer(FIRST)


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
