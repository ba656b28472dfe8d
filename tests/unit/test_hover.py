"""The hover figure of a spec: every number of it, in the unit that its axis shows, and its texts."""

import json

import pytest

from separatrix.present.figure import Across, Axis, Band, Cells, Figure, Label, Panel, Trace, Words, sign
from separatrix.present.hover import plotly

MICRO = 1e-6
LINE = Trace(
    x=(1e-6, 1e-5, None), y=(0.1, None, 0.3), low=(0.05, None, 0.2), high=(0.2, None, 0.4), name="$eta$ & <b>"
)
MARKS = (
    LINE,
    Band(x=(1e-6, 1e-5), low=(0.1, 0.1), high=(0.2, 0.2), name="band"),
    Across(at=0.15, axis="y", name="limit"),
    Cells(x=(1e-6, 1e-5), y=(0.1, 0.2), values=((0, 1), (None, 0.5)), label="share"),
    Words(x=1e-5, y=0.2, text="here"),
)
PANEL = Panel(
    title="a  Panel",
    x=Axis(label="thickness $h$ [um]", size=MICRO, is_log=True),
    y=Axis(label="factor [-]", low=0.0, high=0.5),
    marks=MARKS,
    labels=(Label(y=0.3, text="last"), Label(y=0.3, text="too")),
)


def test_marks_are_in_the_unit_of_their_axis_and_named_once():
    """Gaps stay gaps; an interval is the distance to its ends; a name in two panels is one of the legend."""
    found = plotly(Figure(rows=((PANEL, PANEL),), alt="", legend=(sign("o", "#000000", "band"),)))
    line = found["data"][0]
    assert line["x"] == [pytest.approx(1.0), pytest.approx(10.0), None]
    assert line["y"] == [0.1, None, 0.3]
    assert line["error_y"]["array"] == [pytest.approx(0.1), None, pytest.approx(0.1)]
    assert line["name"] == "<i>\N{GREEK SMALL LETTER ETA}</i> &amp; &lt;b&gt;"
    named = [one["name"] for one in (*found["data"], *found["layout"]["shapes"]) if one.get("showlegend")]
    assert sorted(named) == sorted({line["name"], "band", "limit"})
    assert found["layout"]["meta"] == [[MICRO, 1.0]] * 2
    assert {one["xaxis"] for one in found["data"]} == {"x", "x2"}
    json.dumps(found, allow_nan=False)


def test_panels_and_labels_do_not_overlap():
    """Rows are below each other, panels beside, labels apart; a text on a logarithmic axis is at its log."""
    layout = plotly(Figure(rows=((PANEL, PANEL), (PANEL,)), alt=""))["layout"]
    assert layout["yaxis"]["domain"][0] > layout["yaxis3"]["domain"][1]
    assert layout["xaxis"]["domain"][1] < layout["xaxis2"]["domain"][0]
    texts = {one["text"]: one for one in layout["annotations"]}
    assert abs(texts["last"]["y"] - texts["too"]["y"]) > 0.07
    assert texts["here"]["x"] == pytest.approx(1.0)
