# ruff: noqa: E501 - one case a line
"""Wrong workbooks of studies: each is refused in one line that says where and why."""

import commands
import pytest
from commands import refusal, refusal_line
from minimal_xlsx import Fault, Formula, Shown, parts, workbook, zipped

from separatrix.study.reading import read_study

HEAD = ["key", "value", "+-", "unit", "meaning"]
STUDY = {
    "bearing": [
        HEAD,
        ["ball_diameter", 11.1125, None, "mm"],
        ["pitch_diameter", 65.0, None, "mm"],
        ["ball_count", 13.0],
        ["contact_angle", 25.0, None, "deg"],
        ["inner_conformity", 0.52],
        ["outer_conformity", 0.52],
        ["ball_material", "440C"],
        ["ring_material", "440C"],
    ],
    "operation": [HEAD, ["inner_speed", 15000.0, None, "rpm"], ["axial_load", 300.0, None, "daN"]],
    "film": [
        HEAD,
        ["race_friction", 0.1],
        ["material", "PTFE transfer film"],
        ["thickness", 0.5, None, "um"],
    ],
    "cage": [HEAD, ["mass", 25.0, None, "g"], ["pocket_clearance", 0.6, None, "mm"]],
}
CANDIDATES = [
    [None, None, "GPa", None, "air, 440C", "air, 440C"],
    ["name", "material", "elastic_modulus", "poisson_ratio", "mean", "standard_deviation"],
    ["Mine", None, 5.0, 0.4, 0.12, 0.01],
]


def study(sheet, row, *cells):
    """Return the sheets of a study with one row, counted from 1, replaced or added."""
    rows = [list(one) for one in STUDY.get(sheet, [HEAD])]
    rows[row - 1 : row] = [list(cells)]
    return {**STUDY, sheet: rows}


def mass(*cells):
    """Return the study whose mass, in cage!A2:E2, is given like this."""
    return study("cage", 2, "mass", *cells)


def candidate(row, column, value):
    """Return the study with candidates in place, one cell of them changed."""
    rows = [[*one] for one in CANDIDATES]
    rows[row - 1][column - 1] = value
    return {**STUDY, "candidates": rows}


def linked(sheets):
    """Return a workbook that takes values from another one."""
    return zipped(parts(sheets) | {"xl/externalLinks/externalLink1.xml": "<externalLink/>"})


def replaced(part, old, new):
    """Return the study's workbook with a text in one of its parts replaced."""
    found = parts(STUDY)
    return zipped(found | {part: found[part].replace(old, new)})


LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE sst [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">'
    '<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;">]><sst>&c;</sst>'
)
SHEET_1 = "xl/worksheets/sheet1.xml"

STUDIES = [
    ("list without unit", study("stability", 2, "kicks", "0.1"), 'cell B2: [stability] kicks[1] needs a unit of speed; got 0.1. Write "0.1 m/s".'),
    ("distribution without unit", {**STUDY, "cage": [*STUDY["cage"][::2], ["mass.mean", 25.0], ["mass.standard_deviation", 1.0]]}, '[cage] mass.mean needs a unit of mass; got 25'),
    ("unit twice", mass("25 g", None, "g"), 'cell D2 is a unit beside a value that brings its own; got "25 g". Clear this cell.'),
    ("error", mass(Fault("#REF!"), None, "g"), "cell B2 shows an error instead of a value; got #REF!"),
    ("date", mass(Shown(46_000.0, 1), None, "g"), "cell B2 has a date or a time of day"),
    ("percentage with unit", mass(Shown(0.2, 2), None, "g"), "cell B2 is a percentage with a unit"),
    ("formula unsaved", mass(Formula("20+5"), None, "g"), 'formula without a saved value; got "=20+5"'),
    ("number as unit", mass(25.0, None, 3.0), "cell D2 must be text; got 3"),
    ("width without value", mass(None, 0.2, "g"), "cell C2 is a width without a value"),
    ("width that is no width", mass(25.0, "some", "g"), "cell B2: [cage] mass, after +-, must be one number and one unit of mass"),
    ("width beside a list", study("stability", 2, "kicks", "0.1; 2", 0.1, "m/s"), "cell C2 is a width beside a list. Clear one of them."),
    ("value without key", study("cage", 4, None, 3.0), "cell B4 is a value without a key"),
    ("key twice", study("cage", 4, "mass", 30.0, None, "g"), "cell A4: mass is given a second time. It is in A2"),
    ("key of odd signs", study("cage", 4, "mass (kg)", 1.0), 'cell A4 must be the name of a key; got "mass (kg)"'),
    ("name and parts", study("bearing", 10, "ball_material.density", 7.0, None, "kg/m3"), "cell A10: ball_material.density is given as a value of its own, too"),
    ("parts and name", study("bearing", 8, "ring_material.density", 7.0, None, "kg/m3"), "cell A9: ring_material is given by rows of its parts, too"),
    ("item without key", {**STUDY, "ranking": [HEAD, ["candidates.1", 0.1]]}, "cell A2: candidates.1 must name a key of the item"),
    ("text for a ratio", study("film", 2, "race_friction", "0.1"), "cell B2: [film] race_friction must be a plain number, without a unit; got \"0.1\". Write 0.1 as a number, not as text."),
    ("external link", linked(mass(Formula("[1]Sheet1!A1", 25.0), None, "g")), "cell B2 is a formula in a workbook that takes values from other files"),
    ("key of a section on the first sheet", {**STUDY, "study": [HEAD, ["mass", 3.0, None, "g"]]}, "cell B2: mass is not a key of a study. It belongs in [cage]."),
    ("extends itself", {**STUDY, "study": [HEAD, ["extends", "case.xlsx"]]}, "cell B2: extends leads back to a file"),
    ("missing key", study("cage", 2, "gravity", 1.0, None, "g0"), "sheet cage: [cage] mass is missing"),
    ("no headings", {**STUDY, "cage": [["mass", 25.0, None, "g"]]}, "sheet cage has no headings key and value"),
    ("column twice", {**STUDY, "cage": [["key", "value", "value"], ["mass", "25 g"]]}, 'is a second column of that heading; got "value"'),
    ("sheet misspelt", {**STUDY, "cagge": STUDY["cage"]}, "sheet cagge is not a section of a study. Did you mean cage?"),
    ("two sheets of a name", {**STUDY, "Cage ": [HEAD, ["mass", 30.0, None, "g"]]}, 'sheet Cage  is a second sheet of that name; got "cage"'),
    ("row too far down", {**STUDY, "cage": [*STUDY["cage"], *[[None]] * 2000, ["gravity", 1.0, None, "g0"]]}, "sheet cage, cell A2004 is beyond row 2000 or column KN"),
    ("column too far right", {**STUDY, "cage": [*STUDY["cage"], [*[None] * 300, "note"]]}, "sheet cage, cell KO4 is beyond row 2000"),
    ("nothing in it", {"Sheet1": [["a", 1.0]]}, "has no sheet of a study with a value. `separatrix new PATH.xlsx"),
    ("candidate: friction", candidate(3, 5, 7.0), "sheet candidates, cell E3: [ranking] candidates[1].friction.\"air, 440C\".mean"),
    ("candidate: no name", candidate(3, 1, None), "sheet candidates, row 3: [ranking] candidates[1] lacks: name"),
    ("candidate: text", candidate(3, 5, "x"), 'sheet candidates, cell E3 must be a number; got "x". Leave the cell empty if it was not measured.'),
    ("candidate: heading", candidate(2, 5, "average"), 'cell E2 is not a heading of candidates; got "average"'),
    ("candidate: environment", {**STUDY, "candidates": [[], ["name", "mean"], ["Mine", 0.1]]}, "cell B1 must name the environment"),
    ("candidate: twice", candidate(2, 6, "mean"), "cell F2 is a second column of that heading"),
    ("candidate: named and given", candidate(3, 2, "Armalon"), "cell C3: material.elastic_modulus is given as a value of its own, too"),
    ("candidate: on two sheets", {**candidate(3, 5, 0.1), "ranking": [HEAD, ["candidates", "a"]]}, "candidates"),
    ("candidate: unheaded", candidate(2, 6, None), "cell F2 must name what the column holds"),
]  # fmt: skip

FILES = [
    ("macros", zipped(parts(STUDY) | {"xl/vbaProject.bin": b"x"}), "has macros, which are never run"),
    ("old macro sheet", zipped(parts(STUDY) | {"xl/macrosheets/sheet1.xml": "<x/>"}), "has macros"),
    ("entities in a sheet", zipped(parts(STUDY) | {SHEET_1: LAUGHS}), "sheet bearing"),
    ("another encoding", replaced(SHEET_1, "<worksheet", '<?xml version="1.0" encoding="utf-7"?><worksheet'), "is not a readable workbook"),
    ("cut XML", replaced(SHEET_1, "</worksheet>", ""), "is not a readable workbook: no element found"),
    ("number that is none", replaced(SHEET_1, "<v>13.0</v>", "<v>13.0.0</v>"), "could not convert string to float: '13.0.0'"),
    ("number that is not finite", replaced(SHEET_1, "<v>13.0</v>", "<v>nan</v>"), "is not a readable workbook"),
    ("rows out of order", replaced(SHEET_1, '<row r="3">', '<row r="9">'), "sheet bearing is damaged: its rows and cells are not in order (A3)"),
    ("cells out of order", replaced(SHEET_1, '<c r="A2"', '<c r="D2"'), "sheet bearing is damaged: its rows and cells are not in order (B2)"),
    ("missing sheet", zipped({k: v for k, v in parts(STUDY).items() if k != SHEET_1}), "has a sheet without content; got \"bearing\""),
    ("no workbook", zipped({"a.txt": "x"}), "is a zip file, but not a workbook"),
    ("OpenDocument", zipped({"mimetype": "application/vnd.oasis.opendocument.spreadsheet", "content.xml": "<x/>"}), "is an OpenDocument file"),
    ("binary workbook", zipped(parts(STUDY) | {"xl/workbook.bin": b"x"}), "is a binary workbook, .xlsb"),
    ("old kind or password", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "is an .xls workbook of the old kind, or has a password"),
    ("empty", b"", "is empty"),
    ("bomb", zipped(parts(STUDY) | {"xl/media/a.bin": bytes(9_000_000)}), "must expand by at most 100:1"),
]  # fmt: skip


def written(tmp_path, content):
    """Return the path of a workbook with these sheets, or of a file with these bytes."""
    return commands.written(
        tmp_path, content if isinstance(content, bytes) else workbook(content), "case.xlsx"
    )


def cases(table):
    """Return a table's cases, named by what is wrong in each."""
    return pytest.mark.parametrize(
        ("content", "words"), [case[1:] for case in table], ids=[case[0] for case in table]
    )


def test_what_the_cases_begin_with_is_right(tmp_path):
    """Without the mistakes the study and its candidates are read."""
    found = read_study(written(tmp_path, {**STUDY, "candidates": CANDIDATES}))
    assert (found.cage.mass, found.ranking.candidates[0].friction["air, 440C"].mean) == (0.025, 0.12)


@cases(STUDIES)
def test_a_wrong_study_is_refused_by_the_cell(tmp_path, content, words):
    """One mistake in a workbook that is otherwise right: sheet, cell, rule, value and cure."""
    assert words in refusal_line(written(tmp_path, content))


def test_all_wrong_cells_are_named_at_once(tmp_path):
    """Each in its line, in the order of the sheets."""
    sheets = {**mass(Fault("#REF!"), None, "g"), "film": [HEAD, ["race_friction", 0.1, "20 %"], [None, 3.0]]}
    lines = refusal(written(tmp_path, sheets)).split("\n")
    assert [one.partition(", cell ")[2][:2] for one in lines] == ["B3", "B2"]


@cases(FILES)
def test_a_wrong_file_is_refused(tmp_path, content, words):
    """What is wrong with the file itself."""
    assert words in refusal_line(written(tmp_path, content))
