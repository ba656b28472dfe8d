"""Sheets of a ranking: one for all environments together, one for each, and one of the evidence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from separatrix.cage import Judgement
from separatrix.present.walk import field_units
from separatrix.ranking import Ranked
from separatrix.workbook_looks import Look, add_sheet, headings, put, widths

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

Row = Mapping[str, Any]

VERDICT_FILLS = {"STABLE": "CCE3F0", "UNSTABLE": "F7DFCC", "UNDECIDED": "FAECCC"}
"""Light tints of the colours that the figures give the verdicts."""


SIGNED = "+0.000;-0.000;0.000"
LOWEST = "probability_lowest_friction"


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One quantity of a candidate: its key in the document, its heading, and how it is shown."""

    key: str
    heading: str
    number_format: str = "0.000"
    factor: float = 1.0
    """From the SI unit of the document to that of the heading."""
    width: float = 11.0
    wrap: bool = False


COLUMNS = (
    Column(key="rank", heading="rank", number_format="0", width=6),
    Column(key="name", heading="material", width=24),
    Column(key="verdict", heading="verdict", width=13),
    Column(key="friction", heading="friction (-)"),
    Column(key="friction_error", heading="standard error of the friction (-)", width=13),
    Column(key="friction_scatter_assumed", heading="scatter of the friction assumed", width=13),
    Column(key=LOWEST, heading="probability of the lowest friction (-)", width=13),
    Column(key="restitution_threshold", heading="restitution threshold (-)", width=13),
    Column(key="restitution_threshold_low", heading="threshold, low end of 95 % (-)", width=13),
    Column(key="restitution_threshold_high", heading="threshold, high end of 95 % (-)", width=13),
    Column(key="margin", heading="margin (-)", number_format=SIGNED),
    Column(key="margin_low", heading="margin, low end of 95 % (-)", number_format=SIGNED, width=13),
    Column(key="margin_high", heading="margin, high end of 95 % (-)", number_format=SIGNED, width=13),
    Column(key="probability_stable", heading="probability of stable (-)", width=13),
    Column(key="probability_low", heading="probability, low end of 95 % (-)", width=13),
    Column(key="probability_high", heading="probability, high end of 95 % (-)", width=13),
    Column(key="restitution_factor", heading="restitution factor of the bearing (-)", width=13),
    Column(key="extrapolation", heading="friction extrapolated beyond the tests", width=50, wrap=True),
    Column(key="reason", heading="reason", width=90, wrap=True),
    Column(key="environment", heading="environment", width=28),
)
EVIDENCE = (
    Column(key="cage_motion", heading="motion of the cage centre", width=13),
    Column(key="growth_rate", heading="growth rate (1/s)", number_format="0.00"),
    Column(key="growth_rate_low", heading="growth rate, low end (1/s)", number_format="0.00"),
    Column(key="growth_rate_high", heading="growth rate, high end (1/s)", number_format="0.00"),
    Column(key="largest_offset", heading="largest offset (mm)", factor=1e3),
    Column(key="largest_contact_force", heading="largest pocket force (N)", number_format="0.0"),
    Column(key="largest_land_force", heading="largest land force (N)", number_format="0.0"),
    Column(key="whirl_frequency", heading="whirl (Hz)", number_format="0.00"),
    Column(key="whirl_ratio", heading="whirl ratio (-)"),
    Column(key="ball_cage_stiffness", heading="pocket stiffness (N/um)", number_format="0.00", factor=1e-6),
    Column(key="runs", heading="runs", number_format="0", width=7),
)
WHICH = (
    Column(key="environment", heading="environment", width=28),
    Column(key="name", heading="material", width=24),
)
OVERALL = "overall"
OWN_SHEETS = (OVERALL, "stability curve", "evidence", "inputs", "materials", "frictions", "about")
"""Names of sheets that no environment takes."""

ALWAYS = frozenset({"rank", "name", "verdict"})
ELSEWHERE = frozenset({"within_reach"})


def add(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add the sheets of a ranking."""
    _candidates(add_sheet(book, OVERALL), document[OVERALL], COLUMNS)
    for one in document["environments"]:
        rows = [{**row, "environment": one["name"]} for row in one["materials"]]
        _candidates(add_sheet(book, one["name"], OWN_SHEETS), rows, COLUMNS)


def add_evidence(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add the sheet of the evidence behind every verdict."""
    groups = [(OVERALL, document[OVERALL])]
    groups += [(one["name"], one["materials"]) for one in document["environments"]]
    rows = [{**row, "environment": name} for name, materials in groups for row in materials]
    rows = [row for row in rows if row.get("verdict") is not None]
    _candidates(add_sheet(book, "evidence"), rows, (*WHICH, *EVIDENCE, *_others(rows)))


def _candidates(sheet: Worksheet, rows: Sequence[Row], columns: Sequence[Column]) -> None:
    """Write one line for each candidate, and the columns in which any has a value."""
    rows = [{**row, **_margin_ends(row), **_alone(row)} for row in rows]
    given = [column for column in columns if column.key in ALWAYS or _is_given(rows, column.key)]
    headings(sheet, [column.heading for column in given], keep_columns=2)
    for number, row in enumerate(rows, 2):
        for place, column in enumerate(given, 1):
            _cell(sheet, number, place, row, column)
    widths(sheet, *(column.width for column in given))
    if given:
        sheet.auto_filter.ref = f"A1:{sheet.cell(len(rows) + 1, len(given)).coordinate}"


def _margin_ends(row: Row) -> Row:
    """Return the ends of the margin: those of the threshold, less the restitution factor of the bearing."""
    if row.get("margin") is None:
        return {}
    away = row["margin"] - row["restitution_threshold"]
    ends = {end: row[f"restitution_threshold_{end}"] for end in ("low", "high")}
    return {f"margin_{end}": value + away for end, value in ends.items() if value is not None}


def _alone(row: Row) -> Row:
    """Return the word for the probability of the lowest friction that one measured friction does not have."""
    known = row.get("friction") is None or row.get(LOWEST) is not None
    return {} if known else {LOWEST: "none: no other measured"}


def _cell(sheet: Worksheet, row: int, column: int, record: Row, shown: Column) -> None:
    value = record.get(shown.key)
    if shown.key == "verdict" and value is None:
        value = "not measured" if record.get("friction") is None else "not finished"
    if isinstance(value, list):
        value = "; ".join(map(str, value)) or None
    elif isinstance(value, float):
        value *= shown.factor
    fill = VERDICT_FILLS.get(str(value), "") if shown.key == "verdict" else ""
    number_format = shown.number_format if isinstance(value, int | float) else "General"
    look = Look(number_format=number_format, bold=shown.key == "name", fill=fill, wrap=shown.wrap)
    put(sheet, row, column, value, look)


def _is_given(rows: Sequence[Row], key: str) -> bool:
    return any(row.get(key) not in (None, []) for row in rows)


def _others(rows: Sequence[Row]) -> list[Column]:
    """Columns for what the document says of a candidate beyond the table above, in SI units."""
    known = {column.key for column in (*COLUMNS, *WHICH, *EVIDENCE)} | ELSEWHERE
    keys = dict.fromkeys(key for row in rows for key in row if key not in known)
    return [_other(key) for key in keys if any(_is_plain(row.get(key)) for row in rows)]


def _other(key: str) -> Column:
    unit = (field_units(Judgement) | field_units(Ranked)).get(key.removeprefix("uncertain_"))
    heading = key.replace("_", " ") + (f" ({unit})" if unit else "")
    return Column(key=key, heading=heading, number_format="0.000E+00" if unit != "-" else "0.000", width=14)


def _is_plain(value: object) -> bool:
    return isinstance(value, str | int | float)
