"""Logs in workbooks become the numbers, names and units written."""

import io

import numpy as np
import openpyxl
import pytest
from commands import column_map, refusal_line
from minimal_xlsx import Fault, Formula, Shown, workbook, zipped

from separatrix.friction.logs import read_log

HEAD = [["Time", "COF", "Wear"], ["s", "-", "um"]]
NUMBERS = [[round(0.1 * i, 3), round(0.1 + 0.001 * (i % 7), 3), float(i)] for i in range(40)]


def logs(tmp_path, sheets, columns=None):
    """Return the logs of a workbook with these sheets, or with these bytes."""
    path = tmp_path / "log.xlsx"
    path.write_bytes(sheets if isinstance(sheets, bytes) else workbook(sheets))
    return read_log(path, column_map(columns or {}))


def changed(row, column, value):
    """Return the sheets of a log with one cell of its rows changed."""
    rows = [list(one) for one in NUMBERS]
    rows[row][column] = value
    return {"a": HEAD + rows}


def test_a_sheet_comes_with_its_units(tmp_path):
    """Rows above the names do not count; numbers are those written, to the last bit."""
    above = [["Sample:", "Armalon 3"], ["Load", 10.0, "N"], []]
    (found,) = logs(tmp_path, {"run 1": above + HEAD + NUMBERS})
    assert found.source == "log.xlsx, run 1"
    assert [(c.header, c.unit) for c in found.columns] == [("Time", "s"), ("COF", "-"), ("Wear", "um")]
    assert [found.time.tolist(), found.friction.tolist()] == [[row[i] for row in NUMBERS] for i in (0, 1)]


def test_each_sheet_with_a_table_is_a_log(tmp_path):
    """A sheet of remarks and an empty one are passed over; the others come in the workbook's order."""
    remarks = [["made by", "A. N."], ["date", 3.0]]
    other = [[*row[:1], 2.0 * row[1]] for row in NUMBERS[:5]]
    sheets = {"b": HEAD + NUMBERS, "remarks": remarks, "none": [], "a": [["Time [s]", "COF"], *other]}
    assert [(log.source, log.rows) for log in logs(tmp_path, sheets)] == [
        ("log.xlsx, b", 40),
        ("log.xlsx, a", 5),
    ]


def test_times_of_day_and_dates_become_seconds(tmp_path):
    """A cell formatted as time holds days: 1/86400 of one is a second; dates count from the first."""
    for start in (0.5, 46_000.4):
        rows = [[Shown(start + i / 86_400, 1), 0.1 + 0.01 * i] for i in range(5)]
        (found,) = logs(tmp_path, {"a": [["Time", "COF"], *rows]})
        # times of day are read to the microsecond, and rounded at both ends
        assert found.time == pytest.approx(np.arange(5.0), abs=2e-6)


def saved(rows, code=None):
    """Bytes of a workbook as a usual writer makes them: shared texts, styles, a gap, a format of column B."""
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.active["A1"].font = openpyxl.styles.Font(bold=True)
    for cell in book.active["B"][1:] if code else ():
        cell.number_format = code
    book.save(content := io.BytesIO())
    return content.getvalue()


def five(friction, *names):
    """Sheets of five rows of this friction, below these names."""
    return {"a": [list(names or ("Time [s]", "COF")), *([float(i), friction] for i in range(5))]}


FAULTS = [[float(i), 0.1, Fault("#REF!"), None, Fault("#N/A")] for i in range(5)]
MARKS = (
    None,
    "x",
    " NaN ",
    "#DIV/0!",
    Fault("#DIV/0!"),
    Formula("A5/10"),
    Formula('IF(A1,"",1)', ""),
    Shown(None, 2),
)
SAVED = [["Zeit", "Reibzahl"], ["s", "-"], *([float(i), 0.1] for i in (0, 1, 3, 4)), ["end of test"]]
READ = {
    **{f"a missing value, {mark}": changed(5, 1, mark) for mark in MARKS},
    "faults where nothing is read": {"a": [[None, Fault("#NAME?")], ["Time [s]", "COF", "Remark"], *FAULTS]},
    "a percentage holds a fraction": five(Shown(0.1, 2)),
    "a percentage among plain numbers": {
        "a": [["Time [s]", "COF"], *([float(i), Shown(0.1, 2) if i == 3 else 0.1] for i in range(5))]
    },
    "a percentage below a name in percent": five(Shown(0.1, 2), "Time [s]", "COF [%]"),
    **{
        f"a sign of percent that is only text, {code}": saved(five(10.0, "Time [s]", "COF [%]")["a"], code)
        for code in ('0.0"%"', "0\\%")
    },
    "the saved value of a formula": five(Formula("D1/10", 0.1)),
    "what openpyxl writes": saved(SAVED),
}


@pytest.mark.parametrize("what", READ)
def test_a_workbook_is_read_as_it_is_meant(tmp_path, what):
    """Friction 0.1 at five times, or at four with the one left out counted, whatever the cells hold."""
    (found,) = logs(tmp_path, READ[what])
    if what.startswith("a missing"):
        left = [row for i, row in enumerate(NUMBERS) if i != 5]
        assert (found.time.tolist(), found.friction.tolist()) == tuple(
            map(list, list(zip(*left, strict=True))[:2])
        )
    else:
        gap = "openpyxl" in what
        assert found.time.tolist() == ([0.0, 1.0, 3.0, 4.0] if gap else [0.0, 1.0, 2.0, 3.0, 4.0])
        assert found.friction.tolist() == [0.1] * found.rows
    assert found.missing == (1 if what.startswith("a missing") else 0)


IN_B7 = 'log.xlsx, sheet a: row 7, column "COF" '
AT_B7 = IN_B7 + "must be a number; got "
WRONG = {
    "a truth value": (changed(4, 1, True), AT_B7 + '"True"'),
    "no names": (
        {"a": NUMBERS},
        "has 2 open questions, the first: which column is the friction",
    ),
    "no table": ({"a": HEAD}, "has no sheet with rows of numbers under a row of names"),
    "not a workbook": (zipped({"a.txt": "x"}), "is not a readable workbook"),
    "a zip bomb": (zipped({"xl/media/a.bin": bytes(9_000_000)}), "must expand by at most 100:1"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_workbook_is_refused_by_sheet_and_row(tmp_path, name):
    """What is neither a number nor missing is never left out in silence."""
    content, words = WRONG[name]
    assert words in refusal_line(content, lambda sheets: logs(tmp_path, sheets))
