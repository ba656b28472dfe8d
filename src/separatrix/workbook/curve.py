"""Sheet of the stability curve, with a chart and the candidates on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from separatrix.workbook_looks import HEADING, SMALL, Look, add_sheet, headings, put, widths

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.chart import ScatterChart
    from openpyxl.worksheet.worksheet import Worksheet

CURVE = (
    ("restitution_factor", "restitution factor (-)"),
    ("critical_friction", "critical friction (-)"),
    ("scatter_low", "scatter of the runs, low (-)"),
    ("scatter_high", "scatter of the runs, high (-)"),
    ("critical_friction_low", "band of the kicks, low (-)"),
    ("critical_friction_high", "band of the kicks, high (-)"),
    ("linear", "linear limit (-)"),
    ("reason", "remark"),
)
CANDIDATES = 10
"""Column where the candidates begin."""

RATIO = Look(number_format="0.0000")
LINES = {2: "0072B2", 3: "56B4E9", 4: "56B4E9"}
"""Columns that the chart draws as lines, and their colours."""

POINT = "D55E00"


def add(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add the sheet, if the answer has a curve."""
    stability = document.get("stability")
    if not stability or not stability.get("curve"):
        return
    sheet = add_sheet(book, "stability curve")
    headings(sheet, [heading for _, heading in CURVE])
    rows = _rows(stability)
    for number, row in enumerate(rows, 2):
        for column, (key, _) in enumerate(CURVE, 1):
            value = row.get(key)
            put(sheet, number, column, value, SMALL if isinstance(value, str) else RATIO)
    candidates = _candidates(sheet, document)
    widths(sheet, *[13.0] * 7, 30, 3, 24, 13, 13)
    sheet.add_chart(_chart(sheet, len(rows), candidates), f"A{max(len(rows), candidates) + 4}")


def _rows(stability: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """Points of the curve with the linear limit at the same restitution factor."""
    linear = {
        point["restitution_factor"]: point["critical_friction"]
        for point in stability.get("linear_limit") or ()
    }
    return [{**point, "linear": linear.get(point["restitution_factor"])} for point in stability["curve"]]


def _candidates(sheet: Worksheet, document: Mapping[str, Any]) -> int:
    """Write the candidates overall, at the restitution factor of the bearing; return how many."""
    names = ("candidate, overall", "restitution factor of the bearing (-)", "friction (-)")
    for place, name in enumerate(names):
        put(sheet, 1, CANDIDATES + place, name, HEADING)
    rows = [row for row in document["overall"] if row.get("friction") is not None]
    for number, row in enumerate(rows, 2):
        eta = row.get("restitution_factor")
        values = (row["name"], document["restitution_factor"] if eta is None else eta, row["friction"])
        for place, value in enumerate(values):
            put(sheet, number, CANDIDATES + place, value, RATIO)
    return len(rows)


def _chart(sheet: Worksheet, points: int, candidates: int) -> ScatterChart:
    """Friction against restitution factor: the curve, its scatter, and the candidates."""
    from openpyxl.chart import Reference, ScatterChart, Series

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
    eta = Reference(sheet, min_col=1, min_row=2, max_row=points + 1)
    for column, colour in LINES.items():
        friction = Reference(sheet, min_col=column, min_row=1, max_row=points + 1)
        series = Series(friction, eta, title_from_data=True)
        series.graphicalProperties.line.solidFill = colour
        series.graphicalProperties.line.width = 22_000 if column == 2 else 9_000
        series.smooth = False
        chart.series.append(series)
    if candidates:
        chart.series.append(_points(sheet, candidates))
    return chart


def _points(sheet: Worksheet, count: int) -> Any:
    """Candidates as marks without a line."""
    from openpyxl.chart import Reference, Series

    at = Reference(sheet, min_col=CANDIDATES + 1, min_row=2, max_row=count + 1)
    friction = Reference(sheet, min_col=CANDIDATES + 2, min_row=2, max_row=count + 1)
    series = Series(friction, at, title="candidates, overall")
    series.marker.symbol, series.marker.size = "diamond", 8
    series.marker.graphicalProperties.solidFill = POINT
    series.graphicalProperties.line.noFill = True
    series.smooth = False
    return series
