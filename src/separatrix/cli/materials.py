"""`separatrix materials`: what the library holds, and adding to a library of one's own."""

from __future__ import annotations

import json as plain_json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from separatrix.cli.console import answer
from separatrix.cli.verbs import Json
from separatrix.errors import InputError

if TYPE_CHECKING:
    from separatrix.library.reading import Content
    from separatrix.present.text.materials import Shown

KIND_HELP = "bearing material, cage material, film, fluid, friction table."
Kind = Annotated[str | None, typer.Option("--kind", metavar="KIND", help=KIND_HELP)]
LIBRARY_HELP = "A library file or folder to read too; may be repeated."
Libraries = Annotated[list[str] | None, typer.Option("--library", metavar="PATH", help=LIBRARY_HELP)]
AT_HELP = 'For instance "77 K": the data that serve there.'
UNDER_HELP = 'State of a fluid there [default: "101325 Pa"].'
HELP = "The library of materials; check one of your own, add to it."
EPILOG = (
    "Beside the shipped records those of materials.toml and of the folder materials in the current folder "
    "are read, as they are for a study there."
)


def application() -> typer.Typer:
    """Return the verbs below `materials`."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    verbs: dict[str, tuple[Callable[..., None], str]] = {
        "list": (_list, "Every record: its numbers, how sure they are, and its library."),
        "show": (_show, "One record whole: every number with source, conditions and confidence."),
        "check": (_check, "Read a library file; say what it holds."),
        "add": (_add, "Add the records of a file to a library of your own."),
    }
    for name, (function, text) in verbs.items():
        app.command(name, help=text, epilog=EPILOG if name in ("list", "show") else None)(function)
    return app


def _list(kind: Kind = None, library: Libraries = None, json: Json = False) -> None:
    from separatrix.data_answers import materials

    found = materials(kind, libraries=library or ())
    _deliver("list", found.document(), None if json else found.summary())


def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A material, film, fluid or friction table.")],
    kind: Kind = None,
    temperature: Annotated[str | None, typer.Option(metavar="T", help=AT_HELP)] = None,
    pressure: Annotated[str | None, typer.Option(metavar="P", help=UNDER_HELP)] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    from separatrix.data_answers import materials
    from separatrix.present.text.materials import shown

    views = materials(kind, libraries=library or ()).show(
        name,
        temperature=None
        if temperature is None
        else _quantity(temperature, "K", "--temperature", 1e-3, 5000.0),
        pressure=None if pressure is None else _quantity(pressure, "Pa", "--pressure", 1e-3, 1e11),
    )
    _deliver("show", {"records": [_plain(one) for one in views]}, None if json else shown(views))


def _check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A library file.")], json: Json = False
) -> None:
    from separatrix.library import joined
    from separatrix.library.reading import read_library

    content = read_library(file)
    joined([content])
    _summary("check", content, None, as_json=json)


def _add(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A library file with the new records.")],
    to: Annotated[
        str | None, typer.Option("--to", metavar="LIBRARY", help="The library file to add to.")
    ] = None,
    json: Json = False,
) -> None:
    from separatrix.library import add_records

    if not to:
        cure = "For instance: --to materials.toml."
        raise InputError("--to", "is missing: the library file to add to", cure=cure)
    _summary("add", add_records(file, Path(to)), to, as_json=json)


def _deliver(verb: str, document: dict[str, Any], text: str | None) -> None:
    from separatrix import __version__

    if text is None:
        document = {"separatrix_version": __version__, "verb": f"materials {verb}", **document}
        text = plain_json.dumps(document, indent=1, allow_nan=False) + "\n"
    answer(text)


def _summary(verb: str, content: Content, library: str | None, *, as_json: bool) -> None:
    """Answer with what a library file holds: its records, and how many of their numbers are guesses."""
    from dataclasses import asdict

    from separatrix.present.text.materials import added, checked, counts

    records = [counts(record) for record in content.records]
    document = {**content.file.plain(), "records": [asdict(one) for one in records]}
    if library is not None:
        document["library"] = library
    text = checked(content.file, records) if library is None else added(library, records)
    _deliver(verb, document, None if as_json else text)


def _quantity(text: str, unit: str, option: str, low: float, high: float) -> float:
    from separatrix.units import format_quantity, parse, shown

    value = parse(text, unit, option)
    if not low <= value <= high:
        rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
        raise InputError(option, rule, shown(text))
    return value


def _plain(one: Shown) -> dict[str, Any]:
    whole = one.record.plain()
    if one.state is not None:
        return whole | {"state": one.state.plain(), "cautions": list(one.cautions)}
    if one.taken_at is not None:
        return whole | {"taken": dict(one.taken), "taken_at": one.taken_at, "cautions": list(one.cautions)}
    return whole
