"""The command of each verb and tool, made from its options: read, compute, print, write."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, Union, get_args, get_origin

import typer

from separatrix.front.console import (
    answer,
    answer_json,
    breakable,
    complain,
    interrupted,
    interruptible,
    progress_bar,
)
from separatrix.ground.errors import InputError
from separatrix.ground.files import writable_folder
from separatrix.ground.units import shown
from separatrix.verbs import asked_study, computed, processors
from separatrix.verbs.verb import REQUIRED, Option

if TYPE_CHECKING:
    from separatrix.ground.document import Document
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study
    from separatrix.verbs import Computed
    from separatrix.verbs.verb import Tool, Verb

ANSWERED = 0
MOST_JOBS = 1024

Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no notes: the answer alone.")]
Full = Annotated[bool, typer.Option("--full", help="The whole answer, not only what fits a screen.")]
OUT_HELP = "Folder for figures and data [default: named after the study; none with --json, or of check]."
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
MODEL_HELP = "The best estimate or the paper's method [default: that of the study]."
MOTION_HELP = "Where the cage moves [default: as in the study, or in the plane]."
BALL_HELP = "Model of the ball that a pocket pushes [default: that of the study]."
STUDY_HELP = "A study file or workbook, or the name of a shipped study."


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

BESIDE: dict[str, tuple[Any, Any]] = {
    "study": (Annotated[str, typer.Argument(metavar="STUDY", help=STUDY_HELP)], inspect.Parameter.empty),
    "model": (Annotated[str | None, typer.Option(metavar="full|paper", help=MODEL_HELP)], None),
    "motion": (Annotated[str | None, typer.Option(metavar="plane|space", help=MOTION_HELP)], None),
    "ball": (Annotated[str | None, typer.Option(metavar="damper|traction|free|auto", help=BALL_HELP)], None),
    "full": (Full, False),
    "json": (Json, False),
    "out": (Annotated[str | None, typer.Option(metavar="DIR", help=OUT_HELP)], None),
    "quiet": (Quiet, False),
    "jobs": (Jobs, None),
    "cluster": (Annotated[str | None, typer.Option(metavar="ADDRESS", help=CLUSTER_HELP)], None),
}
"""What commands take beside the options of their verbs: type with its help, and default."""


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


# Options of a verb as those of its command.


def signature(
    options: Mapping[str, tuple[Any, Option, Any]],
    *beside: str,
    more: Mapping[str, tuple[Any, Any]] | None = None,
) -> inspect.Signature:
    """Return the signature of a command: the options of a verb, those `beside` them, and `more`."""
    kinds = {name: _typed(name, *one) for name, one in options.items()}
    before = {"study": BESIDE["study"]} if "study" in beside else {}
    after = dict(more or {}) | {name: BESIDE[name] for name in beside if name != "study"}
    return inspect.Signature(
        [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=kind, default=default)
            for name, (kind, default) in (before | kinds | after).items()
        ]
    )


def _typed(name: str, kind: Any, note: Option, default: Any) -> tuple[Any, Any]:
    """Return the type of an option with its help as typer takes it, and its default."""
    base, is_many = _base(kind)
    default = inspect.Parameter.empty if default is REQUIRED else default
    text: Any = bool if base is bool else str
    if is_many:
        text, default = list[str] if note.is_argument else list[str] | None, default or None
    elif default is None:
        text = text | None
    if base is int:
        return Annotated[int | None if default is None else int, whole_number(note.help)], default
    flag = note.flag or f"--{name.replace('_', '-')}"
    if note.is_argument:
        return Annotated[
            text, typer.Argument(metavar=note.metavar, help=note.help, show_default=False)
        ], default
    look: dict[str, Any] = {"help": note.help} | ({"metavar": note.metavar} if note.metavar else {})
    return Annotated[text, typer.Option(flag, **look)], default


def _base(kind: Any) -> tuple[Any, bool]:
    """Return the type of a value without None, and whether there are several."""
    if get_origin(kind) in (Union, UnionType):
        kinds = [one for one in get_args(kind) if one is not NoneType]
        kind = next((one for one in kinds if one in (str, Path)), kinds[0])
    if get_origin(kind) is tuple:
        return get_args(kind)[0], True
    return kind, False


def options_of(asked: Verb | Tool, given: Mapping[str, Any]) -> Any:
    """Return the options of a verb or tool from the values of its command."""
    values = {}
    for name, (kind, note, _) in asked.shown_options().items():
        base, is_many = _base(kind)
        value = given[name]
        if base is Path:
            flag = note.flag or f"--{name.replace('_', '-')}"
            each = [named(one, flag, "a file") for one in (value or () if is_many else (value,))]
            value = each if is_many else each[0]
        values[name] = tuple(value or ()) if is_many else value
    return asked.options(**values)


# The command of a verb.


def command_of(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of a verb."""

    def command(**given: Any) -> int:
        return run(verb, given)

    beside = ["study", *("model", "motion", "ball") * verb.moves_a_cage, *("full",) * verb.has_full]
    beside += ["json", "out", "quiet", "jobs", *("cluster",) * verb.keeps_runs]
    command.__signature__ = signature(verb.shown_options(), *beside)  # type: ignore[attr-defined]
    return command


def run(verb: Verb, given: Mapping[str, Any]) -> int:
    """Answer one question and return the exit status."""
    json, quiet, cluster = given["json"], given["quiet"], given.get("cluster")
    named(cluster, "--cluster", "a scheduler, or local:N")
    place, count = folder(given["out"]), threads(given["jobs"])
    models = {name: given[name] for name in ("model", "motion", "ball") if given.get(name) is not None}
    is_kept = verb.keeps_runs and not (json and place is None)

    if given.get("animate") is not None and json and place is None:
        raise InputError("--animate", "needs a folder with --json", cure="Give --out DIR.")

    @interruptible("runs that were finished are kept." if is_kept else "no file was written.")
    def work() -> int:
        options = options_of(verb, given)
        with contextlib.ExitStack() as stack:
            asked = asked_study(verb, given["study"], models)
            to = Path(asked.name) if place is None and verb.writes_data and not json else place
            if to is not None:
                stack.enter_context(writable_folder(to))
            found = computed_with_progress(
                verb, asked, options, quiet=quiet, jobs=count, folder=to, cluster=cluster
            )
            _deliver(verb, found, to, json=json, quiet=quiet, full=given.get("full", False))
        if found.is_complete:
            return ANSWERED
        more = " Run the same command to resume." if verb.keeps_runs and to is not None else ""
        return interrupted(f"the answer has what was finished, and is marked complete: false.{more}")

    return work()


def computed_with_progress(
    verb: Verb,
    study: Study,
    options: Any,
    *,
    quiet: bool,
    jobs: int,
    folder: Path | None,
    cluster: str | None = None,
) -> Computed:
    """Compute the answer with a bar of progress; print how many runs an earlier call had kept."""
    with progress_bar(f"{verb.name} {study.name}", quiet=quiet) as progress:
        how = partial(computed, jobs=jobs, folder=folder, cluster=cluster, progress=progress)
        found = breakable(partial(how, verb, study, options))
    if found.runs_taken and not quiet:
        from separatrix.verdict.ledger import NAME

        kept = f"{folder}/{NAME}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return found


def _deliver(
    verb: Verb, found: Computed, folder: Path | None, *, json: bool, quiet: bool, full: bool
) -> None:
    """Print the answer, then write the files, which take as long again, and print where they are."""
    from separatrix.verbs.answer_files import document, page_of_document, save_answer

    made = document(verb, found)
    if json:
        answer_json(made)
    else:
        print_page(page_of_document(verb, made), full=full, quiet=quiet)
    if folder is None:
        return
    with progress_bar("files", quiet=quiet) as progress:
        save_answer(folder, verb, made, options=found.options, progress=progress)
    if not json and not quiet:
        answer(f"\nText, figures and data are in {folder}/\n")


def print_page(page: Page, *, full: bool = False, quiet: bool = False) -> None:
    """Print a page; `quiet` without its notes."""
    from separatrix.present.blocks import Level
    from separatrix.present.text import text

    answer(text(page.without_notes() if quiet else page, Level.FULL if full else Level.BRIEF))


# The command of a tool.


def tool_command(tool: Tool) -> Callable[..., int]:
    """Return the function behind the command of a tool that prints its page and writes no file."""

    def command(**given: Any) -> int:
        return run_tool(tool, given)

    beside = [*("full",) * tool.has_full, "json", *("quiet", "jobs") * tool.takes_time]
    command.__signature__ = signature(tool.shown_options(), *beside)  # type: ignore[attr-defined]
    return command


def run_tool(tool: Tool, given: Mapping[str, Any]) -> int:
    """Answer a tool's question and return the exit status."""

    @interruptible("no answer was given.")
    def work() -> int:
        deliver_tool(tool, compute_tool(tool, given), given)
        return ANSWERED

    return work()


def compute_tool(tool: Tool, given: Mapping[str, Any]) -> Document:
    """Compute the document of a tool, with a bar of progress where that takes time."""
    options = options_of(tool, given)
    if not tool.takes_time:
        return breakable(partial(tool.compute, options))
    count = threads(given["jobs"])
    with progress_bar(tool.name, quiet=given["quiet"]) as progress:
        return breakable(partial(tool.compute, options, count, progress))


def deliver_tool(tool: Tool, found: Document, given: Mapping[str, Any]) -> None:
    """Print the document of a tool, or its page."""
    from separatrix.ground.document import part_of

    if given["json"]:
        answer_json(found)
    else:
        print_page(tool.page(part_of(found)), full=given.get("full", False))


def save_tool(folder: Path, tool: Tool, found: Document, *, pictures_only: bool = False) -> None:
    """Write the document of a tool, its page as text, HTML and workbook, and its pictures; all or none."""
    from separatrix.ground.document import part_of
    from separatrix.verbs.answer_files import save_page

    save_page(folder, tool.name, tool.page(part_of(found)), None if pictures_only else found)
