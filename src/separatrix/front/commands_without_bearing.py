"""The commands without a bearing: `tribometer`, and those below `materials`."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from separatrix.front.console import answer, answer_json, interruptible, progress_bar
from separatrix.front.verb_commands import Jobs, Json, Quiet, named, threads
from separatrix.ground.errors import InputError
from separatrix.ground.files import refuse_existing, staged, writable_folder
from separatrix.ground.units import parse, printable, shown

if TYPE_CHECKING:
    from separatrix.friction.log_series import ReducedLogs
    from separatrix.friction.logs import UnmappedError
    from separatrix.told.materials import Shown

TRIBOMETER = "Friction with its scatter from raw logs of tests."
TRIBOMETER_EPILOG = (
    "What is read is shown before it is trusted: without --out nothing is written. A file that exists is "
    "never overwritten."
)
FILES_HELP = "Raw tribometer logs, or folders of them; the format is recognised."
FRICTION_HELP = "Friction file to write, such as friction.toml [default: none]."
MAP_HELP = "Column map (TOML) for what the logs do not state."
PLOTS_HELP = "Folder of a page for each test [default: beside the friction file]."
RUN_IN_HELP = 'Where running-in ends, for instance "200 m" [default: found].'
JOIN_HELP = "The logs of one folder are strokes or parts of one test."


@interruptible("no friction file was written.")
def tribometer(
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
    """Read and reduce logs, show what was read, write the files; return the exit status."""
    to, pages = named(out, "--out", "a file"), named(plots, "--plots", "a folder")
    count = threads(jobs)
    if to is not None:
        _refuse_out(to)
        pages = pages or to.with_name(f"{to.stem}-plots")
    from separatrix.friction.friction_file import place

    if run_in is not None:
        place(run_in, "--run-in")
    with contextlib.ExitStack() as folders:
        for one in (to and to.parent, pages):
            if one is not None:
                folders.enter_context(writable_folder(one))
        from separatrix.friction.log_series import tribometer as reduced  # before the work is timed
        from separatrix.friction.logs import UnmappedError

        with progress_bar("tribometer", quiet=quiet) as progress:
            try:
                found = reduced(
                    files,
                    column_map=column_map,
                    run_in=run_in,
                    join=join,
                    complete=to is not None,
                    jobs=count,
                    progress=progress,
                )
            except UnmappedError as error:
                raise _with_draft_written(error) from None
        if pages is not None:
            _draw_pages(found, pages, quiet=quiet)
        if to is not None and found.friction_tests is not None:
            from separatrix.friction.friction_file import friction_text

            with staged(to.parent) as stage:
                (stage / to.name).write_text(friction_text(found.friction_tests), encoding="utf-8")
                refuse_existing(to)  # it may have been made since the first check
        from separatrix.present.tribometer import document, in_words

        written = None if to is None else str(to)
        if json:
            answer_json(document(found, written=written))
        else:
            answer(in_words(found, written=written, plots=None if pages is None else str(pages)))
    return 0


def _with_draft_written(error: UnmappedError) -> InputError:
    """The refusal, its draft written beside the log and named in its cure; a file there is kept."""
    name = printable(error.place.name, 150)
    others = error.cure.partition("beside the log.")[2]
    cure = f"Look at the draft {name} beside the log, and add: --map {name}."
    try:
        with error.place.open("x", encoding="utf-8") as file:
            file.write(error.draft)
    except FileExistsError:
        cure = (
            f"There is a file {name}: look at it, and add: --map {name}. Without it, a new draft is written."
        )
    except OSError as fault:
        cure = f"A draft of a column map could not be written beside the log: {fault.strerror}."
    return error.at(error.path, cure=f"{cure}{others}")


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


def _draw_pages(found: ReducedLogs, pages: Path, *, quiet: bool) -> None:
    """Write a page of plots for each test, and the data that it is drawn from."""
    from separatrix import figures
    from separatrix.figures.tribometer import page
    from separatrix.present.dataset_arrays import save
    from separatrix.present.tribometer import page_data

    names: dict[str, int] = {}
    with staged(pages) as stage, progress_bar("pages of plots", quiet=quiet) as progress:
        for done, one in enumerate(found.reductions, 1):
            name = file_name(one.log.source)
            names[name] = number = names.get(name, 0) + 1
            path = stage / (name if number == 1 else f"{name}-{number}")
            data = page_data(one)
            save(data, path.with_name(f"{path.name}.nc"))
            figures.save(page(data), path.with_name(f"{path.name}.png"))
            progress(done, len(found.reductions))


def file_name(source: str) -> str:
    """Name of a test as the name of a file: letters, digits, dots and dashes."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in source)
    return "-".join(part for part in plain.split("-") if part).strip(".-")[:100] or "test"


KIND_HELP = "bearing material, cage material, film, fluid, friction table."
Kind = Annotated[str | None, typer.Option("--kind", metavar="KIND", help=KIND_HELP)]
LIBRARY_HELP = "A library file or folder to read too; may be repeated."
Libraries = Annotated[list[str] | None, typer.Option("--library", metavar="PATH", help=LIBRARY_HELP)]
AT_HELP = 'For instance "77 K": the data that serve there.'
MATERIALS = "The library of materials."
MATERIALS_EPILOG = (
    "Beside the shipped records those of materials.toml and of the folder materials in the current folder "
    "are read, as they are for a study there."
)
LIST = "Every record: its numbers, how sure they are, and its library."
SHOW = "One record whole: every number with source, conditions and confidence."


def materials_application() -> typer.Typer:
    """Return the verbs below `materials`."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    app.command("list", help=LIST, epilog=MATERIALS_EPILOG)(_list)
    app.command("show", help=SHOW, epilog=MATERIALS_EPILOG)(_show)
    return app


def _list(kind: Kind = None, library: Libraries = None, json: Json = False) -> None:
    from separatrix.verbs.without_bearing import materials

    found = materials(kind, libraries=library or ())
    _deliver("list", found.document(), None if json else found.summary())


def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A material, film, fluid or friction table.")],
    kind: Kind = None,
    temperature: Annotated[str | None, typer.Option(metavar="T", help=AT_HELP)] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    from separatrix.told.materials import shown as in_words
    from separatrix.verbs.without_bearing import materials

    at = None if temperature is None else _temperature(temperature)
    views = materials(kind, libraries=library or ()).show(name, temperature=at)
    _deliver("show", {"records": [_plain(one) for one in views]}, None if json else in_words(views))


def _deliver(verb: str, document: Mapping[str, object], text: str | None) -> None:
    from separatrix import __version__

    if text is None:
        answer_json({"separatrix_version": __version__, "verb": f"materials {verb}", **document})
    else:
        answer(text)


def _temperature(text: str) -> float:
    value = parse(text, "K", "--temperature")
    if not 1e-3 <= value <= 5000.0:
        raise InputError("--temperature", "must lie between 0.001 K and 5000 K", shown(text))
    return value


def _plain(one: Shown) -> dict[str, object]:
    whole = one.record.plain()
    if one.taken_at is not None:
        return whole | {"taken": dict(one.taken), "taken_at": one.taken_at, "cautions": list(one.cautions)}
    return whole
