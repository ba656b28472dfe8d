"""`materials list` and `materials show`: the records of the library, each number with its source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from separatrix import __version__
from separatrix.ground.errors import InputError
from separatrix.ground.plain_data import Document, Part
from separatrix.ground.quantity import Quantity, alone
from separatrix.ground.toml import nearest
from separatrix.ground.units import shown
from separatrix.present.blocks import (
    Block,
    Cell,
    Column,
    Heading,
    Note,
    Page,
    Table,
    facts,
    grouped,
    text_column,
)
from separatrix.present.quantity_text import known_columns
from separatrix.verbs.parts.answer_page import friction_columns
from separatrix.verbs.verb import Option, Tool

if TYPE_CHECKING:
    from separatrix.study.library import Library, Record

EPILOG = "Records of materials.toml in the current folder are read too, as they are for a study there."


@dataclass(frozen=True, slots=True, kw_only=True)
class ListOptions:
    """What `materials list` takes."""

    kind: Annotated[
        str | None, Option("bearing material, cage material, film, fluid, friction table, bearing.", "KIND")
    ] = None
    library: Annotated[tuple[str, ...], Option("A library file to read too; may be repeated.", "PATH")] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowOptions(ListOptions):
    """What `materials show` takes."""

    name: Annotated[str, Option("A material, film, fluid, friction table or bearing.", "NAME", True)]


WORDS = {
    "poisson_ratio": "Poisson's ratio",
    "triple_temperature": "triple point",
    "boiling_temperature": "boiling point",
}
"""Properties whose key is not their name."""

POINTS = ("triple_temperature", "boiling_temperature", "critical_temperature", "critical_pressure")
"""Properties that do not depend on temperature."""

PROPERTY, LISTED = Quantity(label="", digits=5), Quantity(label="", digits=4)
MODULUS, RATIO = Quantity(label="", form=".3g"), Quantity(label="", form=".3f")


# --- the records --------------------------------------------------------------------------------
def records_of(options: ListOptions) -> tuple[Library, list[Record]]:
    """Return the library, and its records of the kind that is asked for; without one all of them.

    It has the shipped records, those of the current folder, and those of the files that are named.
    """
    from separatrix.study.library import BESIDE, KINDS, with_files

    paths = [Path(BESIDE)] if Path(BESIDE).is_file() else []
    for named in options.library:
        if not str(named) or not Path(named).exists():
            raise InputError("--library", "does not name a file", f'"{named}"')
        paths.append(Path(named))
    library, kind = with_files(paths), options.kind
    if kind not in (None, *KINDS):
        raise InputError("--kind", "is not a kind of record", shown(kind), nearest(str(kind), KINDS))
    kinds = KINDS if kind is None else (kind,)
    return library, [one for each in kinds for one in library.records(each).values()]


def records_named(library: Library, records: Sequence[Record], name: str) -> list[Record]:
    """Return the records of a name, fluids and bearings also by other names; refused if there is none."""
    spelled = [one for one in records if one.kind in ("fluid", "bearing")]
    found = [one for one in records if one.name == name]
    if found := found or [one for one in spelled if library.named(one.kind, name) == one.name]:
        return found
    kinds = {one.kind for one in records}
    rule = f"is not a {kinds.pop() if len(kinds) == 1 else 'record'} of the library"
    raise InputError("NAME", rule, shown(name), nearest(name, [one.name for one in records]))


def list_records(options: ListOptions) -> Document:
    """Every record of the library, or those of a kind."""
    library, records = records_of(options)
    files = [asdict(file) for file in library.files]
    return _document("list", libraries=files, materials=[one.plain() for one in records])


def show_records(options: ShowOptions) -> Document:
    """Records of a name, whole."""
    found = records_named(*records_of(options), options.name)
    return _document("show", records=[one.plain() for one in found])


def _document(which: str, **content: object) -> Document:
    return {"separatrix_version": __version__, "verb": f"materials {which}", **content}


SEVERAL = "Of several data the first is listed: `show NAME` has all. Confidence is that in E or D."


# --- the pages ----------------------------------------------------------------------------------
def list_page(answer: Part) -> Page:
    """Return the page of `materials list`: a table for each kind, of what its records have."""
    blocks: list[Block] = []
    for kind, rows in grouped((one.kind, one) for one in answer.materials).items():
        known = known_columns(COLUMNS, rows)
        blocks += [Heading(f"{kind.capitalize()}s"), Table(f"{kind}s", known, tuple(rows))]
    return Page("Library of materials", _subtitle(answer), (*blocks, Note(SEVERAL)))


def _subtitle(answer: Part) -> str:
    return f"Library of separatrix {answer.separatrix_version}"


def _first(head: str, key: str, quantity: Quantity = LISTED) -> Column:
    """Return the first datum of a property of each record, with the number of its data if there are more."""

    def cell(record: Part) -> Cell:
        data = _data(record, key)
        mark = f" (first of {len(data)})" if data[1:] else ""
        return Cell(data[0].value, quantity, data[0].get("unit"), mark) if data else Cell(None)

    return Column(head, cell)


def _data(record: Part, key: str = "elastic_modulus") -> list[Part]:
    return (record.data.get(key) or []) if "data" in record else []


def _sure(record: Part) -> str:
    """Return how sure a friction table, an elastic modulus or a ball diameter is."""
    data = _data(record) or _data(record, "ball_diameter")
    known = [one.confidence for one in data] or [record.get("confidence") or ""]
    return str(known[0]).partition(";")[0]


COLUMNS = (
    text_column("name", lambda one: one.name),
    text_column("also", lambda one: ", ".join(one.get("aliases") or ())),
    _first("E", "elastic_modulus", MODULUS),
    _first("nu", "poisson_ratio", RATIO),
    _first("boils at", "boiling_temperature"),
    _first("bore", "bore", Quantity(label="", form=".4g")),
    _first("balls", "ball_count", Quantity(label="", form=".0f")),
    _first("D", "ball_diameter", Quantity(label="", form=".4g")),
    _first("d_m", "pitch_diameter", Quantity(label="", form=".5g")),
    _first("angle", "contact_angle", Quantity(label="", form=".3g")),
    _first("wear", "wear_coefficient", Quantity(label="", form=".2g")),
    text_column("E at", lambda one: "".join(_span(at.temperature, "K") for at in _data(one)[:1])),
    text_column("confidence", _sure),
    text_column("library", lambda one: one.library.file),
)


def _span(bounds: Sequence[float] | None, unit: str) -> str:
    """Return a range in words; empty if there is none."""
    return " to ".join(dict.fromkeys(alone(bound, LISTED, unit) for bound in bounds or ()))


def show_page(answer: Part) -> Page:
    """Return the page of `materials show`: each record whole."""
    names = [f"{one.name} ({one.kind})" for one in answer.records]
    blocks: list[Block] = []
    for name, one in zip(names, answer.records, strict=True):
        blocks += [Heading(name), *_whole(one)] if names[1:] else _whole(one)
    return Page(", ".join(dict.fromkeys(names)), _subtitle(answer), tuple(blocks))


def _whole(record: Part) -> Iterator[Block]:
    file, known = record.library, record.values.get("conditions") or {}
    origin = "shipped" if file.shipped else "of the user"
    keys = ("title", "composition", "substance", "phase", "remark", "source", "confidence")
    yield facts(
        *((_named(key), record.get(key)) for key in keys),
        *((_named(key), _span(one["value"], one.get("unit"))) for key, one in known.items()),
        ("Also", ", ".join(record.get("aliases") or ())),
        ("Library", f"{file.file}, {origin}, sha256 {file.sha256[:12]}..."),
    )
    if record.kind == "friction table":
        columns = friction_columns(record.environments, itemgetter(1))
        caption = "Mean friction, with its standard deviation where it is known."
        rows = tuple(record.values["friction"].items())
        yield Table("friction", (text_column("material", itemgetter(0)), *columns), rows, caption)
    else:
        yield Heading("Data", depth=3)
        yield facts(*_properties(record))


def _named(key: str) -> str:
    return key.replace("_", " ").capitalize()


def _properties(record: Part) -> Iterator[tuple[str, str]]:
    """Yield every datum with its range, conditions, confidence and source."""
    for key in record.data.values:
        for datum in _data(record, key):
            lasts = record.kind == "bearing" or key in POINTS
            words = ", ".join(filter(None, _stated(datum, lasts=lasts)))
            yield WORDS.get(key, key.replace("_", " ")), f"{words}; {datum.confidence}: {datum.source}"


def _stated(datum: Part, *, lasts: bool) -> Iterator[str | None]:
    """Yield value, range and conditions of a datum in words; no temperature of one that has none."""
    unit = datum.get("unit")
    span = f" ({_span(datum.range, unit)})" if datum.range else ""
    yield alone(datum.value, PROPERTY, unit) + span
    yield _span(datum.temperature, "K") or ("" if lasts else "at no stated temperature")
    yield from (datum.medium, datum.form)
    yield None if datum.pressure is None else alone(datum.pressure, Quantity(label="", digits=6), "Pa")


LIST = Tool(
    name="materials list",
    compute=list_records,
    page=list_page,
    help="Every record: its numbers, how sure they are, and its library.",
    epilog=EPILOG,
    options=ListOptions,
    rows="materials",
)
SHOW = Tool(
    name="materials show",
    compute=show_records,
    page=show_page,
    help="One record whole: every number with source, conditions and confidence.",
    epilog=EPILOG,
    options=ShowOptions,
    rows="records",
)
