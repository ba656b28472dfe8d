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
    from separatrix.library import Content, FrictionTable, Library, Record
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
    from separatrix.present.text.materials import listed

    known = _library(library)
    records = [record for name in _kinds(kind) for record in known.records(name).values()]
    _deliver(
        "list",
        {
            "libraries": [file.plain() for file in known.files],
            "materials": [record.plain() for record in records],
        },
        None if json else listed(records),
    )


def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A material, film, fluid or friction table.")],
    kind: Kind = None,
    temperature: Annotated[str | None, typer.Option(metavar="T", help=AT_HELP)] = None,
    pressure: Annotated[str | None, typer.Option(metavar="P", help=UNDER_HELP)] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    from separatrix.present.text.materials import shown

    found = _found(_library(library), name, kind)
    at = None if temperature is None else _quantity(temperature, "K", "--temperature", 1e-3, 5000.0)
    under = None if pressure is None else _quantity(pressure, "Pa", "--pressure", 1e-3, 1e11)
    if under is not None and (at is None or all(record.kind != "fluid" for record in found)):
        raise InputError("--pressure", "is for a fluid, together with --temperature")
    views = [_shown(record, at, under) for record in found]
    _deliver("show", {"records": [_plain(one) for one in views]}, None if json else shown(views))


def _check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A library file.")], json: Json = False
) -> None:
    from separatrix.library import joined, read_library

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


def _library(named: list[str] | None) -> Library:
    """The shipped library with those of the current folder and those named."""
    from separatrix.library import beside, library_files, with_files

    paths = beside(Path())
    for name in named or ():
        if not name or not Path(name).exists():
            raise InputError("--library", "does not name a file or folder", f'"{name}"')
        paths += library_files(Path(name))
    return with_files(paths)


def _kinds(kind: str | None) -> tuple[str, ...]:
    from separatrix.library import KINDS
    from separatrix.toml_values import nearest
    from separatrix.units import shown

    if kind is None:
        return KINDS
    spelled = kind.strip().casefold().replace("_", " ")
    found = tuple(known for known in KINDS if spelled in (known, f"{known}s"))
    if not found:
        raise InputError("--kind", "is not a kind of record", shown(kind), nearest(kind, KINDS))
    return found


def _found(library: Library, name: str, kind: str | None) -> list[Record | FrictionTable]:
    """Records of that name, of every kind or of one; a fluid also by another name of it."""
    from separatrix.toml_values import nearest
    from separatrix.units import shown

    kinds = _kinds(kind)
    found = [records[name] for records in map(library.records, kinds) if name in records]
    fluid = library.fluid(name) if "fluid" in kinds and not found else None
    if fluid is not None:
        return [fluid]
    if not found:
        rule = f"is not a {kind or 'record'} of the library"
        names = [known for each in kinds for known in library.names(each)]
        raise InputError("NAME", rule, shown(name), nearest(name, names))
    return found


def _quantity(text: str, unit: str, option: str, low: float, high: float) -> float:
    from separatrix.units import format_quantity, parse, shown

    value = parse(text, unit, option)
    if not low <= value <= high:
        rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
        raise InputError(option, rule, shown(text))
    return value


def _shown(record: Record | FrictionTable, temperature: float | None, pressure: float | None) -> Shown:
    """The record; at a temperature with what serves there, or with the state of a fluid."""
    from separatrix.library import Record, as_material
    from separatrix.library.fluids import ATMOSPHERE, contradictions, fluid_state, other_phase
    from separatrix.present.text.materials import Shown

    if temperature is None or not isinstance(record, Record):
        return Shown(record=record)
    if record.kind != "fluid":
        material = as_material(record, temperature)
        taken = (material.record or {}).get("taken", {})
        return Shown(record=record, taken_at=temperature, taken=taken, cautions=material.cautions)
    state = fluid_state(record, temperature, ATMOSPHERE if pressure is None else pressure)
    cautions = [*contradictions(record.plain(), temperature), *other_phase(record, state)]
    return Shown(record=record, state=state, cautions=cautions)


def _plain(one: Shown) -> dict[str, Any]:
    whole = one.record.plain()
    if one.state is not None:
        return whole | {"state": one.state.plain(), "cautions": list(one.cautions)}
    if one.taken_at is not None:
        return whole | {"taken": dict(one.taken), "taken_at": one.taken_at, "cautions": list(one.cautions)}
    return whole
