"""The answer of a ranking as a workbook, made from the saved document alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from separatrix.present.nodes import field_units
from separatrix.present.text.sentences import verdict
from separatrix.ranking.records import Ranked
from separatrix.study_file import inputs_of
from separatrix.verdict.judgement import Judgement
from separatrix.workbook_files import (
    BAND,
    HEADING,
    SMALL,
    WRAPPED,
    Cell,
    Look,
    add_table,
    new_workbook,
    put,
    widths,
    workbook_bytes,
)

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.chart import ScatterChart
    from openpyxl.worksheet.worksheet import Worksheet

Document = Mapping[str, Any]

VERDICT_FILLS = {"STABLE": "CCE3F0", "UNSTABLE": "F7DFCC", "UNDECIDED": "FAECCC"}
"""Light tints of the colours of the verdicts in the figures."""

SIGNED = "+0.000;-0.000;0.000"
LOWEST = "probability_lowest_friction"


class Column(NamedTuple):
    """One quantity of a candidate: its key in the document, its heading, and how it is shown."""

    key: str
    heading: str
    number_format: str = "0.000"
    width: float = 13.0
    factor: float = 1.0
    """From the SI unit of the document to that of the heading."""


NAME = Column("name", "material", width=24)
ENVIRONMENT = Column("environment", "environment", width=28)
COLUMNS = (
    Column("rank", "rank", "0", width=6),
    NAME,
    Column("verdict", "verdict"),
    Column("friction", "friction (-)", width=11),
    Column("friction_error", "standard error of the friction (-)"),
    Column("friction_scatter_assumed", "scatter of the friction assumed"),
    Column(LOWEST, "probability of the lowest friction (-)"),
    Column("restitution_threshold", "restitution threshold (-)"),
    Column("restitution_threshold_low", "threshold, low end of 95 % (-)"),
    Column("restitution_threshold_high", "threshold, high end of 95 % (-)"),
    Column("margin", "margin (-)", SIGNED, width=11),
    Column("margin_low", "margin, low end of 95 % (-)", SIGNED),
    Column("margin_high", "margin, high end of 95 % (-)", SIGNED),
    Column("probability_stable", "probability of stable (-)"),
    Column("probability_low", "probability, low end of 95 % (-)"),
    Column("probability_high", "probability, high end of 95 % (-)"),
    Column("restitution_factor", "restitution factor of the bearing (-)"),
    Column("extrapolation", "friction extrapolated beyond the tests", width=50),
    Column("reason", "reason", width=90),
    ENVIRONMENT,
)
EVIDENCE = (
    ENVIRONMENT,
    NAME,
    Column("cage_motion", "motion of the cage centre"),
    Column("growth_rate", "growth rate (1/s)", "0.00", 11),
    Column("growth_rate_low", "growth rate, low end (1/s)", "0.00", 11),
    Column("growth_rate_high", "growth rate, high end (1/s)", "0.00", 11),
    Column("largest_offset", "largest offset (mm)", width=11, factor=1e3),
    Column("largest_contact_force", "largest pocket force (N)", "0.0", 11),
    Column("force_limit", "pocket force that the races hold (N)", "0.0", 11),
    Column("largest_land_force", "largest land force (N)", "0.0", 11),
    Column("whirl_frequency", "whirl (Hz)", "0.00", 11),
    Column("whirl_ratio", "whirl ratio (-)", width=11),
    Column("ball_cage_stiffness", "pocket stiffness (N/um)", "0.00", 11, 1e-6),
    Column("ball", "ball", width=11),
    Column("runs", "runs", "0", 7),
)
ALWAYS, WRAPS = ("rank", "name", "verdict"), ("extrapolation", "reason")
OVERALL = "overall"
OWN_SHEETS = (OVERALL, "stability curve", "evidence", "inputs", "materials", "frictions", "about")
"""Names of sheets that are not available to an environment."""


def results_workbook(document: Document, path: Path) -> None:
    """Write a ranking, as `rank.json` holds it, as a workbook.

    One sheet for all environments and one for each, the stability curve, the evidence of the verdicts, the
    inputs with their origins, the materials and frictions with their sources, and the settings of the answer.
    The same document makes the same bytes.
    """
    book, study = new_workbook(), document["study"]
    _candidates(book, OVERALL, document[OVERALL], COLUMNS)
    judged = [{**row, "environment": OVERALL} for row in document[OVERALL]]
    for one in document["environments"]:
        rows = [{**row, "environment": one["name"]} for row in one["materials"]]
        _candidates(book, one["name"], rows, COLUMNS, OWN_SHEETS)
        judged += rows
    if (document.get("stability") or {}).get("curve"):
        _curve(book, document)
    judged = [row for row in judged if row.get("verdict") is not None]
    _candidates(book, "evidence", judged, (*EVIDENCE, *_others(judged)))
    heads: tuple[str, ...] = ("section", "quantity", "value", "unit", "origin")
    sheet = add_table(book, "inputs", heads, _inputs(study), sizes=(12, 28, 22, 9, 70))
    sheet.auto_filter.ref = f"A1:E{sheet.max_row}"
    looks = (
        *(Look(number_format=f) for f in ("General", "General", "0.###", "0.###", "0.####")),
        WRAPPED,
        WRAPPED,
    )
    sizes = (20, 30, 13, 13, 13, 30, 90)
    numbers = ("modulus (GPa)", "Poisson's ratio (-)", "density (kg/m3)")
    heads = ("used for", "name", *numbers, "confidence", "source")
    add_table(book, "materials", heads, _materials(study), looks=looks, sizes=sizes)
    numbers = ("mean (-)", "standard deviation (-)", "tests")
    heads = ("material", "environment", *numbers, "confidence", "source")
    add_table(book, "frictions", heads, _frictions(study), looks=looks, sizes=sizes)
    looks = (Look(bold=True), WRAPPED)
    add_table(book, "about", ("about this answer", ""), _about(document), looks=looks, sizes=(44, 100))
    path.write_bytes(workbook_bytes(book))


def _candidates(
    book: Workbook, name: str, rows: Sequence[Document], columns: Sequence[Column], taken: Sequence[str] = ()
) -> None:
    """Write one line for each candidate, and the columns in which any has a value."""
    rows = [_completed(row) for row in rows]
    given = [c for c in columns if c.key in ALWAYS or any(row.get(c.key) not in (None, []) for row in rows)]
    cells = [[_cell(row.get(column.key), column) for column in given] for row in rows]
    heads, sizes = [column.heading for column in given], [column.width for column in given]
    sheet = add_table(book, name, heads, cells, sizes=sizes, keep_columns=2, taken=taken)
    if given:
        sheet.auto_filter.ref = f"A1:{sheet.cell(len(rows) + 1, len(given)).coordinate}"


def _completed(row: Document) -> Document:
    """Return a candidate with the ends of its margin, and with words in place of absent numbers.

    The margin is the threshold less the restitution factor of the bearing, and so are its ends.
    """
    found = dict(row)
    if row.get("margin") is not None:
        away = row["margin"] - row["restitution_threshold"]
        for end in ("low", "high"):
            if (value := row[f"restitution_threshold_{end}"]) is not None:
                found[f"margin_{end}"] = value + away
    if row.get("friction") is not None and row.get(LOWEST) is None:
        found[LOWEST] = "none: no other measured"
    return found | {"verdict": verdict(row)}


def _cell(value: object, column: Column) -> Cell:
    if isinstance(value, list):
        value = "; ".join(map(str, value)) or None
    elif isinstance(value, float):
        value *= column.factor
    return Cell(
        value,
        Look(
            number_format=column.number_format if isinstance(value, int | float) else "General",
            bold=column.key == "name",
            fill=VERDICT_FILLS.get(str(value), "") if column.key == "verdict" else "",
            wrap=column.key in WRAPS,
        ),
    )


def _others(rows: Sequence[Document]) -> Iterator[Column]:
    """Yield columns for quantities of a candidate that are not in the tables above, in SI units."""
    known = {column.key for column in (*COLUMNS, *EVIDENCE)} | {"within_reach"}
    units = field_units(Judgement) | field_units(Ranked)
    for key in dict.fromkeys(key for row in rows for key in row if key not in known):
        if any(isinstance(row.get(key), str | int | float) for row in rows):
            unit = units.get(key.removeprefix("uncertain_"))
            heading = key.replace("_", " ") + (f" ({unit})" if unit else "")
            yield Column(key, heading, "0.000E+00" if unit != "-" else "0.000", 14)


# The stability curve, with a chart and the candidates on it.

CURVE = {
    "restitution_factor": "restitution factor (-)",
    "critical_friction": "critical friction (-)",
    "scatter_low": "scatter of the runs, low (-)",
    "scatter_high": "scatter of the runs, high (-)",
    "critical_friction_low": "band of the kicks, low (-)",
    "critical_friction_high": "band of the kicks, high (-)",
    "linear": "linear limit (-)",
    "reason": "remark",
}
ON_IT = ("candidate, overall", "restitution factor of the bearing (-)", "friction (-)")
CANDIDATES = 10
"""Column where the candidates begin."""

RATIO = Look(number_format="0.0000")
LINES = {2: "0072B2", 3: "56B4E9", 4: "56B4E9"}
"""Columns that the chart draws as lines, and their colours."""


def _curve(book: Workbook, document: Document) -> None:
    found = document["stability"]
    linear = {one["restitution_factor"]: one["critical_friction"] for one in found.get("linear_limit") or ()}
    points = [{**one, "linear": linear.get(one["restitution_factor"])} for one in found["curve"]]
    rows = [
        [Cell(value, SMALL if isinstance(value, str) else RATIO) for value in map(point.get, CURVE)]
        for point in points
    ]
    sheet = add_table(book, "stability curve", [*CURVE.values()], rows)
    for place, name in enumerate(ON_IT):
        put(sheet, 1, CANDIDATES + place, name, HEADING)
    candidates = [row for row in document[OVERALL] if row.get("friction") is not None]
    for number, row in enumerate(candidates, 2):
        eta = row.get("restitution_factor")
        on_it = (row["name"], document["restitution_factor"] if eta is None else eta, row["friction"])
        for place, value in enumerate(on_it):
            put(sheet, number, CANDIDATES + place, value, RATIO)
    widths(sheet, *[13.0] * 7, 30, 3, 24, 13, 13)
    chart = _chart(sheet, len(rows), len(candidates))
    sheet.add_chart(chart, f"A{max(len(rows), len(candidates)) + 4}")


def _chart(sheet: Worksheet, points: int, candidates: int) -> ScatterChart:
    """Friction against restitution factor: the curve, its scatter, and the candidates as marks."""
    from openpyxl.chart import Reference, ScatterChart, Series

    def column(place: int, last: int, first: int = 2) -> Reference:
        return Reference(sheet, min_col=place, min_row=first, max_row=last + 1)

    chart = ScatterChart(scatterStyle="lineMarker")
    chart.title = "Stable below the curve"
    chart.x_axis.title, chart.y_axis.title = "restitution factor (-)", "friction of ball on cage (-)"
    chart.width, chart.height = 22, 12
    for axis in (chart.x_axis, chart.y_axis):
        axis.delete = False
        axis.scaling.min = 0.0
        axis.number_format = "0.0#"
        axis.majorGridlines = None
    chart.x_axis.scaling.max = 1.0
    for place, colour in LINES.items():
        series = Series(column(place, points, 1), column(1, points), title_from_data=True)
        series.graphicalProperties.line.solidFill = colour
        series.graphicalProperties.line.width = 22_000 if place == 2 else 9_000
        series.smooth = False
        chart.series.append(series)
    if candidates:
        at, friction = (column(CANDIDATES + place, candidates) for place in (1, 2))
        series = Series(friction, at, title="candidates, overall")
        series.marker.symbol, series.marker.size = "diamond", 8
        series.marker.graphicalProperties.solidFill = "D55E00"
        series.graphicalProperties.line.noFill = True
        series.smooth = False
        chart.series.append(series)
    return chart


# Inputs with their origins, materials and frictions with their sources, and the settings.

ROLES = {
    ("bearing", "ball_material"): "balls",
    ("bearing", "ring_material"): "rings",
    ("film", "material"): "film",
    ("cage", "material"): "cage",
}


def _inputs(study: Document) -> Iterator[list[Cell]]:
    """Yield the inputs of a study in SI, section by section; a material by its name."""
    given = [*inputs_of(study)]
    if (ranking := study.get("ranking")) is not None:
        names = ", ".join(candidate["name"] for candidate in ranking["candidates"])
        given.append(("ranking", "candidates", {"value": names, "origin": ranking.get("origin")}))
    for section, key, item in given:
        value, origin = item.get("value", item.get("name")), item.get("origin") or ""
        if isinstance(value, list):  # as one text, in the spelling in which a study workbook takes it
            value = "; ".join(map(str, value))
        look = Look(fill=BAND if origin.startswith(("default", "not given")) else "")
        values = (section, key, value, item.get("unit") or "")
        yield [*(Cell(one, look) for one in values), Cell(origin, WRAPPED)]


def _materials(study: Document) -> Iterator[tuple[object, ...]]:
    used = [(role, (study.get(section) or {}).get(key)) for (section, key), role in ROLES.items()]
    candidates = (study.get("ranking") or {}).get("candidates", ())
    used += [(f"candidate {one['name']}", one.get("material")) for one in candidates]
    for role, one in used:
        if not one or one.get("name") is None:
            continue
        modulus = one["elastic_modulus"]["value"]
        numbers = one["poisson_ratio"]["value"], one["density"]["value"]
        words = one.get("confidence"), one.get("source")
        yield role, one["name"], None if modulus is None else modulus / 1e9, *numbers, *words


def _frictions(study: Document) -> Iterator[tuple[object, ...]]:
    keys = ("mean", "standard_deviation", "count", "confidence", "source")
    for candidate in (study.get("ranking") or {}).get("candidates", ()):
        for environment, friction in candidate["friction"].items():
            known = ("not measured",) if friction is None else map(friction.get, keys)
            yield candidate["name"], environment, *known


def _about(document: Document) -> Iterator[tuple[str, object]]:
    pocket = document["pocket"]
    yield "title", document["title"]
    yield "study", document["name"]
    yield "program", f"separatrix {document['separatrix_version']}, {document['verb']}"
    yield "seed", document["seed"]
    yield "runs of each candidate from each kick", document["runs"]
    yield "duration of a run (s)", document["duration"]
    yield "kicks (m/s)", "; ".join(map(str, document["kicks"]))
    yield "complete", document["complete"]
    yield "restitution factor of the bearing (-)", document["restitution_factor"]
    yield "the same with the ball's spin free (-)", document["restitution_factor_free_spin"]
    yield "pocket stiffness (N/um)", document["ball_cage_stiffness"] * 1e-6
    yield "stiffness", document["chain"].get("stiffness_source")
    yield "sliding speed of ball on pocket (m/s)", pocket["slip_speed"]
    yield "mean pressure of ball on pocket (MPa)", pocket["pressure"] * 1e-6
    yield "paper", document["paper_statement"]
    yield from (("note", sentence) for sentence in document["warnings"])
    yield "units", "Units are in the headings; the sheet of inputs is in SI, angles in rad."
    yield "text", "A text that a spreadsheet program could take for a formula begins with an apostrophe."
