"""Logs in workbooks become the numbers, names and units written; a wrong one is refused."""

import io
import struct
import tracemalloc

import numpy as np
import openpyxl
import pytest
from commands import column_map, refusal_line
from minimal_xlsx import Fault, Formula, Shown, parts, workbook, zipped

from separatrix.friction.logs import read_log
from separatrix.ground.sheet import MOST_BYTES, new_workbook, put, workbook_bytes

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
    found = [(log.source, log.rows) for log in logs(tmp_path, sheets)]
    assert found == [("log.xlsx, b", 40), ("log.xlsx, a", 5)]


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
MARKS = (None, "x", " NaN ", "#DIV/0!", Fault("#DIV/0!"), Formula("A5/10"))
MARKS += (Formula('IF(A1,"",1)', ""), Shown(None, 2))
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
        assert [found.time.tolist(), found.friction.tolist()] == [[row[i] for row in left] for i in (0, 1)]
    else:
        gap = "openpyxl" in what
        assert found.time.tolist() == ([0.0, 1.0, 3.0, 4.0] if gap else [0.0, 1.0, 2.0, 3.0, 4.0])
        assert found.friction.tolist() == [0.1] * found.rows
    assert found.missing == (1 if what.startswith("a missing") else 0)
    assert found.format.startswith("plain table (Excel workbook")


SHEETS = {"a": [["Time [s]", "COF"], *([float(i), 0.1 + 0.01 * (i % 3)] for i in range(9))]}
PARTS, GOOD = parts(SHEETS), workbook(SHEETS)
FIRST = next(iter(PARTS))


def patched(name, offset, value, content=GOOD):
    """Return a zip with bytes of a member's entry in the directory replaced."""
    at = content.rfind(b"PK\x01\x02", 0, content.rfind(name.encode()))
    changed = bytearray(content)
    changed[at + offset : at + offset + len(value)] = value
    return bytes(changed)


SIZE, FLAGS = 24, 8
"""Offsets in an entry of the directory (APPNOTE 6.3, 4.3.12)."""

LAUGHS = '<?xml version="1.0"?><!DOCTYPE sst [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;">]><sst>&b;</sst>'
SHEET_1 = "xl/worksheets/sheet1.xml"
WRONG = {
    "a truth value": (changed(4, 1, True), 'sheet a: row 7, column "COF" must be a number; got "True"'),
    "no names": ({"a": NUMBERS}, "has 2 open questions, the first: which column is the friction"),
    "no table": ({"a": HEAD}, "has no sheet with rows of numbers under a row of names"),
    "bomb": (zipped(PARTS | {"xl/media/a.bin": bytes(9_000_000)}), "must expand by at most 100:1"),
    "huge": (patched(FIRST, SIZE, struct.pack("<I", MOST_BYTES)), "must expand to at most 512 MB"),
    "longer than declared": (patched(SHEET_1, SIZE, b"\x5a\0\0\0"), "is damaged: xl/worksheets/sheet1.xml"),
    "encrypted": (patched(FIRST, FLAGS, b"\x01\x00"), "is encrypted"),
    "strong encryption": (patched(FIRST, FLAGS, b"\x40\x00"), "strong encryption"),
    "cut short": (GOOD[:-30], "is not a readable workbook"),
    "a row too many": (
        zipped(PARTS | {SHEET_1: PARTS[SHEET_1].replace(b'row r="10"', b'row r="1048577"')}),
        "log.xlsx has a row beyond 1048576, the last that a sheet can have. Open it",
    ),
    "no workbook": (zipped({"a.txt": "x"}), "is not a readable workbook"),
    "entities in a sheet": (zipped(PARTS | {SHEET_1: LAUGHS}), "log.xlsx"),
    "cut XML": (zipped(PARTS | {SHEET_1: PARTS[SHEET_1][:-9]}), "is not a readable workbook"),
}  # fmt: skip


@pytest.mark.parametrize(("content", "words"), WRONG.values(), ids=WRONG)
def test_a_wrong_workbook_is_refused_in_one_line(tmp_path, content, words):
    """By sheet and row; before it is read by what its directory declares, and that its parts keep to it."""
    assert logs(tmp_path, GOOD)[0].rows == 9
    assert words in refusal_line(content, lambda one: logs(tmp_path, one))


def test_a_number_of_400_digits_is_missing(tmp_path):
    """As in text, where it is not finite either."""
    sheet = PARTS[SHEET_1].replace(b">0.11<", b">" + b"9" * 400 + b"<", 1)
    (found,) = logs(tmp_path, zipped(PARTS | {SHEET_1: sheet}))
    assert (found.rows, found.missing) == (8, 1)


def test_a_hidden_bomb_is_not_expanded(tmp_path):
    """40 MB behind a declared size of 1 kB."""
    content = zipped(PARTS | {"xl/bomb.xml": bytes(40_000_000)})
    content = patched("xl/bomb.xml", SIZE, struct.pack("<I", 1_000), content)
    tracemalloc.start()
    assert "is damaged: xl/bomb.xml" in refusal_line(content, lambda one: logs(tmp_path, one))
    assert tracemalloc.get_traced_memory()[1] < 8_000_000
    tracemalloc.stop()


def test_a_fault_of_ours_is_not_one_of_the_workbook(tmp_path, monkeypatch):
    """A TypeError in our own code is raised; the same from inside of a damaged workbook is a refusal."""
    monkeypatch.setattr("separatrix.friction.logs.tables.MOST_ROWS", None)
    with pytest.raises(TypeError):
        logs(tmp_path, GOOD)


def test_text_is_written_as_text(tmp_path):
    """Never as a formula, nor as the code of a character."""
    book = new_workbook()
    sheet = book.create_sheet("a")
    for column, value in enumerate((1.5, -3, "-", "=x", True, None, "_x003D_1"), 1):
        put(sheet, 1, column, value)
    (tmp_path / "a.xlsx").write_bytes(workbook_bytes(book))
    (row,) = openpyxl.load_workbook(tmp_path / "a.xlsx")["a"].values
    assert row == (1.5, -3, "-", "'=x", "yes", None, "_x005F_x003D_1")
