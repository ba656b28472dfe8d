"""`materials list` and `materials show`: the records of the library, each number with its source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from separatrix.ground.document import Document, Part
from separatrix.ground.errors import InputError
from separatrix.ground.quantity import ABSENT, Quantity, alone
from separatrix.ground.units import Kelvin, parse, shown
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Heading,
    Level,
    Note,
    Page,
    Table,
    facts,
    grouped,
    text_column,
)
from separatrix.verbs.verb import Option, Tool

if TYPE_CHECKING:
    from separatrix.study.library import Library
    from separatrix.study.library.records import AnyRecord

KIND = "bearing material, cage material, film, fluid, friction table."
LIBRARY = "A library file or folder to read too; may be repeated."
EPILOG = (
    "Beside the shipped records those of materials.toml and of the folder materials in the current folder "
    "are read, as they are for a study there."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ListOptions:
    """What `materials list` takes."""

    kind: Annotated[str | None, Option(KIND, "KIND")] = None
    library: Annotated[tuple[str, ...], Option(LIBRARY, "PATH")] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowOptions:
    """What `materials show` takes."""

    name: Annotated[str, Option("A material, film, fluid or friction table.", "NAME", True)]
    kind: Annotated[str | None, Option(KIND, "KIND")] = None
    temperature: Annotated[str | None, Option('For instance "77 K": the data that serve there.', "T")] = None
    library: Annotated[tuple[str, ...], Option(LIBRARY, "PATH")] = ()


WORDS = {
    "poisson_ratio": "Poisson's ratio",
    "triple_temperature": "triple point",
    "boiling_temperature": "boiling point",
}
"""Properties whose key is not their name."""

POINTS = ("triple_temperature", "boiling_temperature", "critical_temperature", "critical_pressure")
"""Properties that do not depend on temperature."""

PROPERTY = Quantity(label="", digits=5)
LISTED = Quantity(label="", digits=4)
RATIO = Quantity(label="", form=".3f")
SCATTER = Quantity(label="", digits=2)


# --- the records --------------------------------------------------------------------------------
def read_library(libraries: Sequence[str | Path]) -> Library:
    """Return the library: the shipped records, those of the current folder, and those of `libraries`."""
    from separatrix.study.library import beside, library_files, with_files

    paths = beside(Path())
    for named in libraries:
        if not str(named) or not Path(named).exists():
            raise InputError("--library", "does not name a file or folder", f'"{named}"')
        paths += library_files(Path(named))
    return with_files(paths)


def records_of(library: Library, kind: str | None) -> list[AnyRecord]:
    """Return the records of a kind, in any spelling and in the plural too; without one all of them."""
    from separatrix.ground.toml import nearest
    from separatrix.study.library.records import KINDS

    kinds: tuple[str, ...] = KINDS
    if kind is not None:
        spelled = kind.strip().casefold().replace("_", " ")
        kinds = tuple(known for known in KINDS if spelled in (known, f"{known}s"))
        if not kinds:
            raise InputError("--kind", "is not a kind of record", shown(kind), nearest(kind, KINDS))
    return [one for each in kinds for one in library.records(each).values()]


def records_named(library: Library, records: Sequence[AnyRecord], name: str) -> list[AnyRecord]:
    """Return the records of a name, a fluid also by another name of it; refused if there is none."""
    from separatrix.ground.toml import nearest

    found = [one for one in records if one.name == name]
    fluid = library.fluid(name) if any(one.kind == "fluid" for one in records) else None
    if found or fluid is not None:
        return found or [fluid]  # type: ignore[list-item]
    kinds = {one.kind for one in records}
    rule = f"is not a {kinds.pop() if len(kinds) == 1 else 'record'} of the library"
    raise InputError("NAME", rule, shown(name), nearest(name, [one.name for one in records]))


def list_records(options: ListOptions) -> Document:
    """Every record of the library, or those of a kind."""
    library = read_library(options.library)
    records = [one.plain() for one in records_of(library, options.kind)]
    return _document("list", libraries=[file.plain() for file in library.files], materials=records)


def show_records(options: ShowOptions) -> Document:
    """Records of a name, whole; at a temperature with what serves there."""
    at = None if options.temperature is None else _temperature(options.temperature)
    library = read_library(options.library)
    found = records_named(library, records_of(library, options.kind), options.name)
    return _document("show", records=[_served(library, one, at) for one in found])


def _document(which: str, **content: object) -> Document:
    from separatrix import __version__

    return {"separatrix_version": __version__, "verb": f"materials {which}", **content}


def _temperature(text: str) -> Kelvin:
    value = parse(text, "K", "--temperature")
    if not 1e-3 <= value <= 5000.0:
        raise InputError("--temperature", "must lie between 0.001 K and 5000 K", shown(text))
    return value


def _served(library: Library, record: AnyRecord, at: Kelvin | None) -> Document:
    """Return a record; at a temperature with the place of the datum of each property that serves there."""
    from separatrix.study.library.records import contradictions

    whole = record.plain()
    if at is None or record.kind == "friction table":
        return whole
    if record.kind == "fluid":
        return whole | {"taken": {}, "taken_at": at, "cautions": [*contradictions(whole, at)]}
    material = library.material(record.kind, record.name, at)
    taken = dict((material.record or {}).get("taken", {}))
    return whole | {"taken": taken, "taken_at": at, "cautions": list(material.cautions)}


# --- the pages ----------------------------------------------------------------------------------
def list_page(answer: Part) -> Page:
    """Return the page of `materials list`: a table for each kind."""
    blocks: list[Block] = []
    for kind, records in grouped((one.kind, one) for one in answer.materials).items():
        blocks += [Heading(f"{kind.capitalize()}s"), Table(f"{kind}s", _columns(kind), tuple(records))]
    several = "Where a record has several data of one property the first is listed; `show NAME` has all."
    return Page("Library of materials", _subtitle(answer), (*blocks, Note(several)))


def _subtitle(answer: Part) -> str:
    return f"Library of separatrix {answer.separatrix_version}"


def _columns(kind: str) -> tuple[Column, ...]:
    """Return the columns of the records of a kind."""
    name, library = (
        text_column("name", lambda one: one.name),
        text_column("library", lambda one: one.library.file),
    )
    if kind == "friction table":
        return (
            name,
            text_column("materials", lambda one: str(len(one.friction.values))),
            text_column("environments", lambda one: str(len(one.environments))),
            text_column("confidence", lambda one: one.confidence.partition(";")[0]),
            library,
        )
    if kind == "fluid":
        return (
            name,
            text_column("also", lambda one: ", ".join(one.aliases or ()) or ABSENT),
            text_column("phase", lambda one: one.phase),
            _first("boils at", "boiling_temperature"),
            _first("critical", "critical_temperature"),
            library,
        )
    return (
        name,
        _first("E", "elastic_modulus", Quantity(label="")),
        _first("nu", "poisson_ratio", RATIO),
        _first("density", "density"),
        text_column("E at", lambda one: _at(_data(one, "elastic_modulus")[0]) or ABSENT),
        text_column(
            "confidence in E", lambda one: _data(one, "elastic_modulus")[0].confidence.partition(";")[0]
        ),
        library,
    )


def _data(record: Part, key: str) -> list[Part]:
    return record.data.get(key) or []


def _first(head: str, key: str, quantity: Quantity = LISTED) -> Column:
    """Return the first datum of a property of each record, with the number of its data if there are more."""

    def cell(record: Part) -> Cell:
        data = _data(record, key)
        mark = f" (first of {len(data)})" if data[1:] else ""
        return Cell(data[0].value, quantity, data[0].get("unit"), mark) if data else Cell(None)

    return Column(head, cell)


def _at(datum: Part) -> str:
    """Return the temperatures of a datum; empty if its source states none."""
    return "" if datum.temperature is None else _span(datum.temperature, "K")


def _span(bounds: Sequence[float], unit: str) -> str:
    low, high = (alone(bound, LISTED, unit) for bound in bounds)
    return low if low == high else f"{low} to {high}"


def show_page(answer: Part) -> Page:
    """Return the page of `materials show`: each record whole."""
    names = dict.fromkeys(f"{one.name} ({one.kind})" for one in answer.records)
    several = len(answer.records) > 1
    blocks: list[Block] = []
    for one in answer.records:
        blocks += [Heading(f"{one.name} ({one.kind})")] if several else []
        blocks += _whole(one)
    return Page(", ".join(names), _subtitle(answer), tuple(blocks))


def _whole(record: Part) -> Iterator[Block]:
    file, keys = (
        record.library,
        ("title", "composition", "substance", "phase", "remark", "source", "confidence"),
    )
    origin = "shipped" if file.shipped else "of the user"
    yield facts(
        *((key.capitalize(), record.get(key)) for key in keys),
        *_conditions(record),
        ("Also", ", ".join(record.get("aliases") or ())),
        ("Library", f"{file.file}, {origin}, sha256 {file.sha256[:12]}..."),
    )
    if record.kind == "friction table":
        yield Heading("Friction", depth=3)
        yield _frictions(record)
    else:
        yield Heading("Data", depth=3)
        yield from _properties(record)
    yield from (Note(one, "caveat") for one in record.get("cautions") or ())


def _conditions(record: Part) -> Iterator[tuple[str, str]]:
    for key in record.get("conditions").values if "conditions" in record else ():
        one = record.conditions.get(key)
        if one.value is not None:
            yield key.replace("_", " ").capitalize(), _span(one.value, one.get("unit"))


def _frictions(record: Part) -> Table:
    def friction(place: str) -> Any:
        def words(row: tuple[str, Any]) -> str:
            found = row[1].get(place)
            if found is None:
                return "not measured"
            spread = found.standard_deviation
            more = f" \N{PLUS-MINUS SIGN} {alone(spread, SCATTER, '-')}" if spread is not None else ""
            return alone(found.mean, RATIO, "-") + more

        return text_column(place, words)

    columns = text_column("material", lambda row: row[0]), *map(friction, record.environments)
    rows = tuple((name, record.friction.get(name)) for name in record.friction.values)
    return Table("friction", columns, rows, "Mean friction, with its standard deviation where it is known.")


def _properties(record: Part) -> Iterator[Block]:
    """Yield every datum: as lines, its source is long, and as a table; those that serve with a mark."""
    taken = record.get("taken").values if "taken" in record else {}
    rows = [
        (key, place, datum) for key in record.data.values for place, datum in enumerate(record.data.get(key))
    ]

    def words(row: tuple[str, int, Part]) -> str:
        mark = " *" if row[1] == taken.get(row[0]) else ""
        return WORDS.get(row[0], row[0].replace("_", " ")) + mark

    pairs = ((words(row), f"{', '.join(_stated(row))}; {row[2].confidence}: {row[2].source}") for row in rows)
    yield facts(*pairs, level=Level.PRINTED)
    columns = (
        text_column("property", words),
        Column("value", lambda row: Cell(row[2].value, PROPERTY, row[2].get("unit"))),
        text_column("range, conditions", lambda row: ", ".join(_stated(row)[1:]) or ABSENT),
        text_column("confidence", lambda row: row[2].confidence),
        text_column("source", lambda row: row[2].source),
    )
    yield Table(f"data of {record.name}", columns, tuple(rows), "", Level.REPORT | Level.SHEET)
    if taken:
        yield Note(f"*: serves at {alone(record.taken_at, LISTED, 'K')}.", "legend")


def _stated(row: tuple[str, int, Part]) -> list[str]:
    """Return value, range and conditions of a datum in words."""
    key, _, datum = row
    is_point = key in POINTS
    at = "" if is_point else "at no stated temperature"
    unit = datum.get("unit")
    value = alone(datum.value, PROPERTY, unit)
    found = [
        f"{value} ({_span(datum.range, unit)})" if datum.range is not None else value,
        at if datum.temperature is None else _at(datum),
        datum.medium,
        datum.form,
        None if datum.pressure is None else alone(datum.pressure, Quantity(label="", digits=6), "Pa"),
    ]
    return [one for one in found if one]


LIST = Tool(
    name="materials list",
    help="Every record: its numbers, how sure they are, and its library.",
    epilog=EPILOG,
    compute=list_records,
    page=list_page,
    options=ListOptions,
)
SHOW = Tool(
    name="materials show",
    help="One record whole: every number with source, conditions and confidence.",
    epilog=EPILOG,
    compute=show_records,
    page=show_page,
    options=ShowOptions,
)
