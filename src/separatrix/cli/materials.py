"""`separatrix materials`: what the library holds, and adding to a library of one's own."""

from __future__ import annotations

import json as plain_json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from separatrix.cli.console import answer
from separatrix.errors import InputError

if TYPE_CHECKING:
    from separatrix.library import Content, FrictionTable, Library, Record

ANSWERED = 0
Json = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, in SI units.")]
Kind = Annotated[
    str | None,
    typer.Option(
        "--kind", metavar="KIND", help="bearing material, cage material, film, fluid, friction table."
    ),
]
Libraries = Annotated[
    list[str] | None,
    typer.Option("--library", metavar="PATH", help="A library file or folder to read too; may be repeated."),
]
HELP = "The library of materials; check one of your own, add to it."
EPILOG = (
    "Beside the shipped records those of materials.toml and of the folder materials in the current folder "
    "are read, as they are for a study there."
)


def application() -> typer.Typer:
    """Return the verbs below `materials`."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    verbs: dict[str, tuple[Callable[..., int], str]] = {
        "list": (_list, "Every record: its numbers, how sure they are, and its library."),
        "show": (_show, "One record whole: every number with source, conditions and confidence."),
        "check": (_check, "Read a library file; say what it holds."),
        "add": (_add, "Add the records of a file to a library of your own."),
    }
    for name, (function, text) in verbs.items():
        app.command(name, help=text, epilog=EPILOG if name in ("list", "show") else None)(function)
    return app


def _list(kind: Kind = None, library: Libraries = None, json: Json = False) -> int:
    known = _library(library)
    kinds = [_known_kind(kind)] if kind is not None else _kinds()
    records = [record for name in kinds for record in known.records(name).values()]
    document = _head("list") | {
        "libraries": [file.plain() for file in known.files],
        "materials": [record.plain() for record in records],
    }
    return _deliver(document, "listed", as_json=json)


def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A material, film, fluid or friction table.")],
    kind: Kind = None,
    temperature: Annotated[
        str | None, typer.Option(metavar="T", help='For instance "77 K": the data that serve there.')
    ] = None,
    pressure: Annotated[
        str | None, typer.Option(metavar="P", help='State of a fluid there [default: "101325 Pa"].')
    ] = None,
    library: Libraries = None,
    json: Json = False,
) -> int:
    found = _found(_library(library), name, kind)
    at = None if temperature is None else _quantity(temperature, "K", "--temperature", 1e-3, 5000.0)
    under = None if pressure is None else _quantity(pressure, "Pa", "--pressure", 1e-3, 1e11)
    if under is not None and (at is None or all(record.kind != "fluid" for record in found)):
        raise InputError("--pressure", "is for a fluid, together with --temperature")
    document = _head("show") | {"records": [_whole(record, at, under) for record in found]}
    return _deliver(document, "shown", as_json=json)


def _check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A library file.")], json: Json = False
) -> int:
    from separatrix.library import joined, read_library

    content = read_library(file)
    joined([content])
    return _deliver(_head("check") | _summary(content), "checked", as_json=json)


def _add(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A library file with the new records.")],
    to: Annotated[
        str | None, typer.Option("--to", metavar="LIBRARY", help="The library file to add to.")
    ] = None,
    json: Json = False,
) -> int:
    from separatrix.library import add_records

    if not to:
        cure = "For instance: --to materials.toml."
        raise InputError("--to", "is missing: the library file to add to", cure=cure)
    added = add_records(file, Path(to))
    return _deliver(_head("add") | _summary(added) | {"library": to}, "added", as_json=json)


def _head(verb: str) -> dict[str, Any]:
    from separatrix import __version__

    return {"separatrix_version": __version__, "verb": f"materials {verb}"}


def _deliver(document: dict[str, Any], report: str, *, as_json: bool) -> int:
    """Answer with the document, or with the text of it that `text.materials` makes under this name."""
    if as_json:
        answer(plain_json.dumps(document, indent=1, allow_nan=False) + "\n")
        return ANSWERED
    from separatrix.present.text import materials

    answer(getattr(materials, report)(document))
    return ANSWERED


def _library(named: list[str] | None) -> Library:
    """The shipped library with those of the current folder and those named."""
    from separatrix.library import beside, library_files, with_files

    paths = beside(Path())
    for name in named or ():
        if not name or not Path(name).exists():
            raise InputError("--library", "does not name a file or folder", f'"{name}"')
        paths += library_files(Path(name))
    return with_files(paths)


def _kinds() -> list[str]:
    from separatrix.library import KINDS

    return list(KINDS)


def _known_kind(kind: str) -> str:
    from separatrix.toml_values import nearest
    from separatrix.units import shown

    spelled = kind.strip().casefold().replace("_", " ")
    for known in _kinds():
        if spelled in (known, f"{known}s"):
            return known
    raise InputError("--kind", "is not a kind of record", shown(kind), nearest(kind, _kinds()))


def _found(library: Library, name: str, kind: str | None) -> list[Record | FrictionTable]:
    """Records of that name, of every kind or of one; a fluid also by another name of it."""
    from separatrix.toml_values import nearest
    from separatrix.units import shown

    kinds = _kinds() if kind is None else [_known_kind(kind)]
    found = [records[name] for records in map(library.records, kinds) if name in records]
    fluid = library.fluid(name) if "fluid" in kinds and not found else None
    if fluid is not None:
        return [fluid]
    if not found:
        names = [known for each in kinds for known in library.names(each)]
        raise InputError(
            "NAME", f"is not a {kind or 'record'} of the library", shown(name), nearest(name, names)
        )
    return found


def _quantity(text: str, unit: str, option: str, low: float, high: float) -> float:
    from separatrix.units import format_quantity, parse, shown

    value = parse(text, unit, option)
    if not low <= value <= high:
        rule = f"must lie between {format_quantity(low, unit)} and {format_quantity(high, unit)}"
        raise InputError(option, rule, shown(text))
    return value


def _whole(
    record: Record | FrictionTable, temperature: float | None, pressure: float | None
) -> dict[str, Any]:
    """The record as plain data; at a temperature with what serves there, or with the state of a fluid."""
    from separatrix.library import Record, as_material
    from separatrix.library.fluids import ATMOSPHERE, contradictions, fluid_state, other_phase

    whole = record.plain()
    if temperature is None or not isinstance(record, Record):
        return whole
    if record.kind != "fluid":
        material = as_material(record, temperature)
        taken = {} if material.record is None else dict(material.record["taken"])
        return whole | {"taken": taken, "taken_at": temperature, "cautions": list(material.cautions)}
    state = fluid_state(record, temperature, ATMOSPHERE if pressure is None else pressure)
    cautions = [*contradictions(whole, temperature), *other_phase(record, state)]
    return whole | {"state": state.plain(), "cautions": cautions}


def _summary(content: Content) -> dict[str, Any]:
    """What a library file holds: its records, and how many of their numbers are guesses."""
    return {**content.file.plain(), "records": [_counts(record) for record in content.records]}


def _counts(record: Record | FrictionTable) -> dict[str, Any]:
    from separatrix.library import Record

    data = [d for several in record.data.values() for d in several] if isinstance(record, Record) else []
    return {
        "kind": record.kind,
        "name": record.name,
        "line": record.line,
        "replaces": record.replaces,
        "numbers": len(data) if isinstance(record, Record) else _measured(record),
        "guesses": sum(d.confidence.startswith("guess") for d in data),
        "without_temperature": sum(d.temperature is None for d in data),
    }


def _measured(table: FrictionTable) -> int:
    return sum(value is not None for row in table.friction.values() for value in row.values())
