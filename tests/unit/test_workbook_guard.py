"""A workbook is judged before it is read: what its directory declares, and that its parts keep to it."""

import struct
import tracemalloc

import openpyxl
import pytest
from commands import refusal_line
from minimal_xlsx import parts, workbook, zipped

from separatrix.friction.logs import read_log
from separatrix.ground.sheet import MOST_BYTES, new_workbook, put, workbook_bytes

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
    "bomb": (zipped(PARTS | {"xl/media/a.bin": bytes(9_000_000)}), "must expand by at most 100:1"),
    "huge": (patched(FIRST, SIZE, struct.pack("<I", MOST_BYTES)), "must expand to at most 512 MB"),
    "longer than declared": (patched(SHEET_1, SIZE, b"\x5a\0\0\0"), "is damaged: xl/worksheets/sheet1.xml"),
    "encrypted": (patched(FIRST, FLAGS, b"\x01\x00"), "is encrypted"),
    "strong encryption": (patched(FIRST, FLAGS, b"\x40\x00"), "strong encryption"),
    "cut short": (GOOD[:-30], "is not a readable workbook"),
    "no workbook": (zipped({"a.txt": "x"}), "is not a readable workbook"),
    "entities in a sheet": (zipped(PARTS | {SHEET_1: LAUGHS}), "log.xlsx"),
    "cut XML": (zipped(PARTS | {SHEET_1: PARTS[SHEET_1][:-9]}), "is not a readable workbook"),
}  # fmt: skip


def read(folder, content):
    """Return the logs of a workbook with this content."""
    (folder / "log.xlsx").write_bytes(content)
    return read_log(folder / "log.xlsx")


@pytest.mark.parametrize(("content", "words"), WRONG.values(), ids=WRONG)
def test_a_wrong_archive_is_refused_in_one_line(tmp_path, content, words):
    """Each breaks one rule; the refusal says which, with the name of the file."""
    assert read(tmp_path, GOOD)[0].rows == 9
    assert words in refusal_line(content, lambda one: read(tmp_path, one))


def test_a_hidden_bomb_is_not_expanded(tmp_path):
    """40 MB behind a declared size of 1 kB."""
    content = zipped(PARTS | {"xl/bomb.xml": bytes(40_000_000)})
    content = patched("xl/bomb.xml", SIZE, struct.pack("<I", 1_000), content)
    tracemalloc.start()
    assert "is damaged: xl/bomb.xml" in refusal_line(content, lambda one: read(tmp_path, one))
    assert tracemalloc.get_traced_memory()[1] < 8_000_000
    tracemalloc.stop()


def test_a_fault_of_ours_is_not_one_of_the_workbook(tmp_path, monkeypatch):
    """A TypeError in our own code is raised; the same from inside of a damaged workbook is a refusal."""
    monkeypatch.setattr("separatrix.friction.logs.tables.MOST_ROWS", None)
    with pytest.raises(TypeError):
        read(tmp_path, GOOD)


def test_text_is_written_as_text(tmp_path):
    """Never as a formula, nor as the code of a character."""
    book = new_workbook()
    sheet = book.create_sheet("a")
    for column, value in enumerate((1.5, -3, "-", "=x", True, None, "_x003D_1"), 1):
        put(sheet, 1, column, value)
    (tmp_path / "a.xlsx").write_bytes(workbook_bytes(book))
    (row,) = openpyxl.load_workbook(tmp_path / "a.xlsx")["a"].values
    assert row == (1.5, -3, "-", "'=x", "yes", None, "_x005F_x003D_1")
