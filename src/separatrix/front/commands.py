"""The command of each verb and tool, made from its options: read, compute, print, write."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Mapping
from dataclasses import MISSING
from functools import cache, partial
from pathlib import Path
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, Union, get_args, get_origin

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
from separatrix.verbs.verb import Option

if TYPE_CHECKING:
    from separatrix.ground.document import Document
    from separatrix.present.blocks import Page
    from separatrix.study.study import Study
    from separatrix.verbs import Computed
    from separatrix.verbs.verb import Tool, Verb

Result = TypeVar("Result")

ANSWERED = 0
MOST_JOBS = 1024

Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no notes: the answer alone.")]
Full = Annotated[bool, typer.Option("--full", help="The whole answer, not only what fits a screen.")]
OUT_HELP = "Folder for figures and data [default: named after the study; none with --json, or of check]."
CLUSTER_HELP = "Make the runs on the Dask scheduler at this address, or in N processes here: local:N."
MODEL_HELP = "The best estimate or the paper's method [default: that of the study]."
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
    return named(out, "--out", "a folder", cure="The current one is .")


def named(text: str | None, option: str, what: str, cure: str = "") -> Path | None:
    """Return the path or address that an option gives; an empty one is refused."""
    if text is not None and (not text.strip() or "\0" in text):
        raise InputError(option, f"needs the name of {what}", got='""', cure=cure)
    return None if text is None else Path(text)


# Options of a verb as those of its command.


def command(
    run: Callable[[Any, Mapping[str, Any]], int],
    asked: Tool,
    *beside: str,
    more: Mapping[str, tuple[Any, Any]] | None = None,
) -> Callable[..., int]:
    """Return the function that runs a verb or tool with its options, those `beside` them, and `more`."""

    def found(**given: Any) -> int:
        return run(asked, given)

    own = {name: _typed(name, *one) for name, one in asked.shown_options().items()}
    before = {"study": BESIDE["study"]} if "study" in beside else {}
    after = dict(more or {}) | {name: BESIDE[name] for name in beside if name != "study"}
    kinds = (before | own | after).items()
    found.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=kind, default=default)
            for name, (kind, default) in kinds
        ]
    )
    return found


def _typed(name: str, kind: Any, note: Option, default: Any) -> tuple[Any, Any]:
    """Return the type of an option with its help as typer takes it, and its default."""
    base, is_many = _base(kind)
    default = inspect.Parameter.empty if default is MISSING else default
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


def options_of(asked: Tool, given: Mapping[str, Any]) -> Any:
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


def verb_command(verb: Verb) -> Callable[..., int]:
    """Return the function behind the command of a verb."""
    beside = ["study", *("model",) * verb.moves_a_cage, *("full",) * verb.has_full]
    return command(run, verb, *beside, "json", "out", "quiet", "jobs", *("cluster",) * verb.keeps_runs)


def run(verb: Verb, given: Mapping[str, Any]) -> int:
    """Answer one question and return the exit status."""
    from separatrix.verbs.answer_files import document, page_of_document, save_answer

    json, cluster, quiet = given["json"], given.get("cluster"), given["quiet"]
    named(cluster, "--cluster", "a scheduler, or local:N")
    place, jobs = folder(given["out"]), threads(given["jobs"])
    is_kept = verb.keeps_runs and not (json and place is None)
    ended = "runs that were finished are kept." if is_kept else "no file was written."
    with interruptible(ended), contextlib.ExitStack() as stack:
        options = options_of(verb, given)
        study = asked_study(verb, given["study"], given.get("model"))
        to = Path(study.name) if place is None and verb.writes_data and not json else place
        if to is not None:
            stack.enter_context(writable_folder(to))
        how = {"quiet": quiet, "jobs": jobs, "folder": to, "cluster": cluster}
        found = computed_with_progress(verb, study, options, **how)
        made = document(verb, found)
        page = cache(partial(page_of_document, verb, made))
        deliver(made, page, given)
        if to is not None:  # this takes as long again
            with progress_bar("files", quiet=quiet):
                save_answer(to, verb, made, page=page())
            print_place("Text, figures and data", to, given)
    if found.is_complete:
        return ANSWERED
    more = " Run the same command to resume." if verb.keeps_runs and to is not None else ""
    return interrupted(f"the answer has what was finished, and is marked complete: false.{more}")


def computed_with_progress(
    verb: Verb,
    study: Study,
    options: Any = None,
    *,
    quiet: bool,
    jobs: int,
    folder: Path | None,
    cluster: str | None = None,
) -> Computed:
    """Compute the answer with a bar of progress; print how many runs an earlier call had kept."""
    how: dict[str, Any] = {"jobs": jobs, "folder": folder, "cluster": cluster}
    with progress_bar(f"{verb.name} {study.name}", quiet=quiet) as progress:
        found = breakable(partial(computed, verb, study, options, progress=progress, **how))
    if found.runs_taken and not quiet:
        from separatrix.verdict.ledger import NAME

        kept = f"{folder}/{NAME}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return found


def deliver(made: Document, page: Callable[[], Page], given: Mapping[str, Any]) -> None:
    """Print a document, or its page; with `--quiet` without its notes."""
    from separatrix.present.blocks import Level
    from separatrix.present.text import text

    if given["json"]:
        answer_json(made)
        return
    shown = page().without_notes() if given.get("quiet") else page()
    answer(text(shown, Level.FULL if given.get("full") else Level.BRIEF))


def print_place(what: str, folder: Path, given: Mapping[str, Any]) -> None:
    """Print where files are."""
    if not given["json"] and not given["quiet"]:
        answer(f"\n{what} are in {folder}/\n")


# The command of a tool.


def tool_command(tool: Tool) -> Callable[..., int]:
    """Return the function behind the command of a tool."""
    out = ("out",) * bool(tool.folder)
    quiet = ("quiet",) * bool(tool.takes_time or tool.folder)
    return command(
        run_tool, tool, *("full",) * tool.has_full, "json", *out, *quiet, *("jobs",) * tool.takes_time
    )


def run_tool(tool: Tool, given: Mapping[str, Any]) -> int:
    """Answer a tool's question and return the exit status."""
    from separatrix.ground.document import part_of
    from separatrix.verbs.answer_files import save_answer

    usual = Path(tool.folder) if tool.folder and not given["json"] else None
    to = folder(given.get("out")) or usual
    place = contextlib.nullcontext() if to is None else writable_folder(to)
    with interruptible("no answer was given."), place:
        compute = partial(tool.compute, options_of(tool, given))
        found = with_progress(tool, compute, given) if tool.takes_time else breakable(compute)
        page = tool.page(part_of(found))
        if to is not None:
            save_answer(to, tool, found, page=page)
        deliver(found, lambda: page, given)
        if to is not None:
            print_place("Text, data and figures", to, given)
    return ANSWERED


def with_progress(tool: Tool, compute: Callable[..., Result], given: Mapping[str, Any]) -> Result:
    """Return what takes threads and progress, with a bar."""
    count = threads(given["jobs"])
    with progress_bar(tool.name, quiet=given["quiet"]) as progress:
        return breakable(partial(compute, count, progress))
