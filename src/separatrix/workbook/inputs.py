"""Sheet of the resolved inputs: every value in SI, its unit, and where it was given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from separatrix.workbook_looks import BAND, WRAPPED, Look, add_sheet, headings, put, widths

if TYPE_CHECKING:
    from openpyxl import Workbook

HEADINGS = ("section", "quantity", "value", "unit", "origin")
SECTIONS = ("bearing", "operation", "kinematics", "film", "cage", "stability")


class Line(NamedTuple):
    """One input."""

    section: str
    quantity: str
    value: object
    unit: str
    origin: str


def add(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add the sheet."""
    sheet = add_sheet(book, "inputs")
    headings(sheet, HEADINGS)
    for number, line in enumerate(lines(document["study"]), 2):
        is_default = line.origin.startswith(("default", "not given"))
        for column, value in enumerate(line, 1):
            look = WRAPPED if column == len(line) else Look(fill=BAND if is_default else "")
            put(sheet, number, column, value, look)
    widths(sheet, 12, 28, 22, 9, 70)
    sheet.auto_filter.ref = f"A1:E{sheet.max_row}"


def lines(study: Mapping[str, Any]) -> Iterator[Line]:
    """Yield the inputs of a study, section by section; a material by its name."""
    for section in SECTIONS:
        for key, item in (study.get(section) or {}).items():
            yield _line(section, key, item)
    ranking = study.get("ranking")
    if ranking is not None:
        names = ", ".join(candidate["name"] for candidate in ranking["candidates"])
        yield Line("ranking", "candidates", names, "", ranking.get("origin") or "")
        yield _line("ranking", "friction_scatter", ranking["friction_scatter"])


def _line(section: str, key: str, item: object) -> Line:
    if not isinstance(item, Mapping):
        return Line(section, key, _one(item), "", "from the values above")
    value = item.get("value", item.get("name"))
    return Line(section, key, _one(value), item.get("unit") or "", item.get("origin") or "")


def _one(value: object) -> object:
    """Return a list as one text, in the spelling in which a study workbook takes it."""
    return "; ".join(map(str, value)) if isinstance(value, list) else value
