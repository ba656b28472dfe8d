"""Commands made from descriptions of options: that of a verb, and that of a tool."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

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
from separatrix.ground.errors import InputError
from separatrix.ground.files import writable_folder
from separatrix.ground.units import shown
from separatrix.verbs import asked_study, computed, processors
from separatrix.verbs.verb import Option, Shown, kind_of, shown_options

if TYPE_CHECKING:
    from separatrix.ground.document import Document
    from separatrix.study.study import Study
    from separatrix.verbs.verb import Tool, Verb

Result = TypeVar("Result")
Given = Mapping[str, Any]

ANSWERED = 0


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
    """Return the value of an option of a kind from its text; flags and most texts are taken as they are.

    An empty name, as from an unset variable, is refused.
    """
    if kind == "files":
        return tuple(option_value("file", one, option, note) for one in text)
    if text is None:
        return None
    if kind == "number":
        return whole_number(text, option, note.most)
    if (kind == "file" or note.metavar in NAMED) and (not text.strip() or "\0" in text):
        cure = "The current one is ." if note.metavar == "DIR" else ""
        raise InputError(option, f"needs the name of {NAMED.get(note.metavar, 'a file')}", '""', cure)
    return Path(text) if kind == "file" else text


def whole_number(text: str, option: str, most: int) -> int:
    """Return the whole number that an option gives."""
    try:
        found = int(text)
    except ValueError:
        cure = "Write it in digits, or leave it out."
        raise InputError(option, "must be a whole number", shown(text), cure) from None
    if most and not 1 <= found <= most:
        raise InputError(option, f"must lie between 1 and {most}", str(found), "Or leave it out.")
    return found


def flag_of(name: str, note: Option) -> str:
    """Return the name of an option on the command line."""
    return note.flag or f"--{name.replace('_', '-')}"


def asked_of(verb: Verb) -> Shown:
    """Return the options of a verb; where it moves a cage, the model too."""
    return verb.shown_options() | beside(*("model",) * verb.moves_a_cage)


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
    return asked.options(**{name: given[name] for name in asked.shown_options()})


# What a command does, from its question to its files.


def answered(
    asked: Tool,
    given: Given,
    compute: Callable[[], Document],
    to: Path | None,
    *,
    only_pictures: bool = False,
) -> Document:
    """Compute a document, print it or its page, and save it in `to`, tested before the work; return it.

    With `--quiet` the page is without its notes.
    """
    from separatrix.present.blocks import Level
    from separatrix.present.text import text
    from separatrix.verbs.answer_files import page_of_document, save_answer, save_pictures

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
            save_pictures(to, page) if only_pictures else save_answer(to, asked, made, page=page)
        if not json and not quiet:
            what = "Pictures of the tests" if only_pictures else "Text, figures and data"
            answer(f"\n{what} are in {to}/\n")
    return made


def verb_command(verb: Verb, about: str) -> click.Command:
    """Return the command of a verb."""
    after = "full", "json", "out", "quiet", "jobs", *("cluster",) * verb.keeps_runs
    takes = beside("study") | asked_of(verb) | beside(*after)
    return command(verb.name, partial(run, verb), takes, about, verb.epilog)


def run(verb: Verb, given: Given) -> int:
    """Answer one question to a study and return the exit status."""
    is_kept = verb.keeps_runs and not (given["json"] and given["out"] is None)
    with interruptible("runs that were finished are kept." if is_kept else "no file was written."):
        options = options_of(verb, given)
        study = asked_study(verb, given["study"], given.get("model"))
        usual = Path(study.name) if verb.writes_data and not given["json"] else None
        to = given["out"] or usual
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
        from separatrix.verdict.ledger import NAME

        kept = f"{folder}/{NAME}"
        complain(f"{found.runs_taken} runs were taken from {kept}, where an earlier call had kept them.")
    return document(verb, found)


def tool_command(tool: Tool, about: str) -> click.Command:
    """Return the command of a tool."""
    names = [*["out"] * bool(tool.folder), *["quiet"] * (tool.takes_time or bool(tool.folder))]
    takes = tool.shown_options() | beside("full", "json", *names, *["jobs"] * tool.takes_time)
    return command(tool.name.split()[-1], partial(run_tool, tool), takes, about, tool.epilog)


def run_tool(tool: Tool, given: Given) -> int:
    """Answer a tool's question and return the exit status."""
    usual = Path(tool.folder) if tool.folder and not given["json"] else None
    with interruptible("no answer was given."):
        compute = partial(tool.compute, options_of(tool, given))
        answered(tool, given, partial(result_of, tool, compute, given), given.get("out") or usual)
    return ANSWERED


def result_of(tool: Tool, compute: Callable[..., Result], given: Given) -> Result:
    """Return what a tool computes; with a bar, if it takes threads and progress."""
    if not tool.takes_time:
        return breakable(compute)
    with progress_bar(tool.name, quiet=given["quiet"]) as progress:
        return breakable(partial(compute, given["jobs"] or processors(), progress))
