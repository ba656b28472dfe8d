# ruff: noqa: E501 - one case a line
"""A study in a workbook reads as its text does; a wrong workbook is refused by its cell, or as a file."""

import re
import tomllib
from dataclasses import replace
from fractions import Fraction

import commands
import openpyxl
import pytest
from commands import refusal, refusal_line
from minimal_xlsx import Fault, Formula, Shown, parts, workbook, zipped
from rich_studies import PLANE, SPACE

from separatrix.front import main
from separatrix.ground.sheet import new_workbook, put, workbook_bytes
from separatrix.ground.units import parse
from separatrix.ground.workbook import COLUMNS
from separatrix.study.reading import read_study
from separatrix.study.study import ORDER, shipped_studies
from separatrix.study.template import study_keys, template

STUDY = """
title = "= A title that begins like a formula"
extends = "cryogenic-turbopump"

[film]
thickness = "0.5 um"

[cage]
mass = "25.0000000000000001 g"
pocket_position_scatter = "10.123456789012 um"

[stability]
kicks = ["0.1 m/s", "50 cm/s", "2 m/s"]
runs = 4
duration = "4 ms"
restitution_factors = [0.3, 0.6, 0.9]

[[ranking.candidates]]
name = "=cmd|' /C calc'!A0"
friction."liquid nitrogen, 440C" = { mean = 0.12, standard_deviation = 0.02, count = 8, source = "-2+3" }
friction."air" = 0.2
material = { elastic_modulus = "5 GPa", poisson_ratio = 0.4 }

[[ranking.candidates]]
name = "@SUM(1)"
friction = { "air" = 0.1 }
material = "Armalon"
"""


def typed(key, value):
    """Yield the rows of a value as one types them: numbers with their unit, and uncertainty, beside them."""
    if isinstance(value, dict):
        for part, item in value.items():
            name = part if re.fullmatch(r"\w+", part) else f'"{part}"'
            yield from typed(f"{key}.{name}" if key else name, item)
    elif isinstance(value, list) and isinstance(value[0], dict):
        for item in value:
            yield f"[[{key}]]", None, None, None
            yield from typed("", item)
    elif isinstance(value, list):
        yield key, "; ".join(map(str, value)) + ";", None, None
    else:
        found = re.fullmatch(r"([-0-9.]+) (\S+)(?: \+- (\d+ %))?", value) if isinstance(value, str) else None
        is_exact = found and Fraction(float(found[1])) == Fraction(found[1])
        yield (key, float(found[1]), found[3], found[2]) if is_exact else (key, value, None, None)


def in_workbook(text):
    """Return a study as the workbook that somebody could have typed in its place."""
    data = tomllib.loads(text)
    sheets = {"study": {key: value for key, value in data.items() if not isinstance(value, dict)}, **data}
    found = {name: given for name, given in sheets.items() if isinstance(given, dict)}
    return workbook({name: [[*COLUMNS], *map(list, typed("", given))] for name, given in found.items()})


def read_from(folder, name, content):
    """Return the study of a file of this name and content."""
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_study(folder / name)


TEXTS = {name: path.read_text() for name, path in shipped_studies().items()}
TEXTS |= {"space": SPACE, "plane": PLANE, "variant": STUDY}


@pytest.mark.parametrize("name", TEXTS)
def test_a_study_typed_into_a_workbook_is_the_same(name, tmp_path):
    """Every number to the last bit, every distribution, material and candidate."""
    expected = read_from(tmp_path, "a.toml", TEXTS[name])
    found = read_from(tmp_path, "a.xlsx", in_workbook(TEXTS[name]))
    assert found == expected
    for key, one in expected.distributions.items():
        assert found.distributions[key].quantile(0.3) == one.quantile(0.3)


def test_the_verb_new_writes_a_workbook_to_fill_in(tmp_path, capsys):
    """Once, under the name of a workbook; it has every key of the text file, and is the same study."""
    path = tmp_path / "mine.xlsx"
    assert main(["new", str(path)]) == 0
    assert main(["check", "--full", str(path)]) == 0
    assert "mine.xlsx, sheet cage, cell B2" in capsys.readouterr().out
    for name in ("mine.xlsx", "b.xls", "b.xlsm"):
        assert main(["new", str(tmp_path / name)]) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["mine.xlsx"]
    assert read_study(path) == read_from(tmp_path, "mine.toml", template())
    book = openpyxl.load_workbook(path)
    for section in ORDER:
        names = dict.fromkeys(cell.value.split(".")[0] for cell in book[section]["A"][1:])
        assert list(names) == [one.name for one in study_keys(section)]


HEAD = ["key", "value", "+-", "unit"]


def variant(path, *rows, **sheets):
    """Return the study of a workbook that changes the film of the shipped study."""
    path.write_bytes(
        workbook({"study": [HEAD, ["extends", "cryogenic-turbopump"]], "film": [HEAD, *rows], **sheets})
    )
    return read_study(path)


def test_the_width_beside_a_value_is_what_stands_behind_it_in_text(tmp_path):
    """A percentage as number or text, and a width in the value's unit: two deviations, as behind ``+-``."""
    for width in (Shown(0.2, 2), "20 %", 0.1, "0.1", "100 nm", "+-20 %", "± 0.1"):
        found = variant(tmp_path / "a.xlsx", ["thickness", 0.5, width, "um"])
        assert found.distributions["film.thickness"].standard_deviation == pytest.approx(5e-8, rel=1e-12)
    found = variant(tmp_path / "a.xlsx", ["race_friction", 0.1, Shown(0.2, 2)])
    assert found.distributions["film.race_friction"].standard_deviation == pytest.approx(0.01, rel=1e-12)


@pytest.mark.parametrize("steel", [52100.0, "52100"])
def test_what_stands_in_cells_is_meant(tmp_path, steel):
    """No digit of a number is lost, one may be the name of a steel, and a value in quotes is its text.

    The saved value of a formula counts, and a note names its cell. A sheet of calculations, with formulas
    and all, or a key without a value changes nothing; headings may stand in any order.
    """
    film = ["thickness", Formula("1/2", 0.123456789012), None, "um"]
    cage = [
        ["meaning", "unit", "value", "±", "key"],
        ["", "g0", None, None, "gravity"],
        ["", None, '"26 g"', "", "mass"],
    ]
    sheets = {"my sums": [["a", Formula("1+1")], ["b", 2.0]], "bearing": [HEAD, ["ball_material", steel]]}
    found = variant(tmp_path / "a.xlsx", film, cage=cage, **sheets)
    assert found.film.thickness == parse("0.123456789012 um", "m")
    assert found.cage == replace(read_study("cryogenic-turbopump").cage, mass=0.026)
    assert found.bearing.ball_material.name == "52100"
    assert any("nothing is recomputed: film!B2." in note for note in found.notes)


def test_a_text_file_may_extend_a_workbook(tmp_path):
    """And a workbook a text file, which in turn extends a shipped study."""
    base = read_from(tmp_path, "base.xlsx", in_workbook(STUDY))
    thin = read_from(tmp_path, "thin.toml", 'extends = "base.xlsx"\n[film]\nthickness = "0.1 um"\n')
    assert (thin.film.thickness, thin.cage) == (1e-7, base.cage)
    content = workbook({"study": [HEAD, ["extends", "thin.toml"]], "cage": [HEAD, ["mass", 26.0, None, "g"]]})
    over = read_from(tmp_path, "over.xlsx", content)
    assert (over.film.thickness, over.cage.mass, over.ranking) == (1e-7, 0.026, base.ranking)


def test_text_is_written_as_text(tmp_path):
    """Never as a formula, nor as the code of a character."""
    book = new_workbook()
    sheet = book.create_sheet("a")
    for column, value in enumerate((1.5, -3, "-", "=x", True, None, "_x003D_1"), 1):
        put(sheet, 1, column, value)
    (tmp_path / "a.xlsx").write_bytes(workbook_bytes(book))
    (row,) = openpyxl.load_workbook(tmp_path / "a.xlsx")["a"].values
    assert row == (1.5, -3, "-", "'=x", "yes", None, "_x005F_x003D_1")


WRONG = {
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
"""A study without a mistake, to which each case adds one."""


def study(sheet, row, *cells):
    """Return the sheets of a study with one row, counted from 1, replaced or added."""
    rows = [list(one) for one in WRONG.get(sheet, [HEAD])]
    rows[row - 1 : row] = [list(cells)]
    return {**WRONG, sheet: rows}


def mass(*cells):
    """Return the study whose mass, in cage!A2:D2, is given like this."""
    return study("cage", 2, "mass", *cells)


STUDIES = {
    "list without unit": (study("stability", 2, "kicks", "0.1;"), 'cell B2: [stability] kicks[1] needs a unit of speed; got 0.1. Write "0.1 m/s".'),
    "unit twice": (mass("25 g", None, "g"), 'cell B2: [cage] mass needs a unit of mass (kg, g, mg, t, ...); got "25 g g"'),
    "error": (mass(Fault("#REF!"), None, "g"), "cell B2 shows an error instead of a value; got #REF!"),
    "date": (mass(Shown(46_000.0, 1), None, "g"), "cell B2 has a date or a time of day"),
    "percentage with unit": (mass(Shown(0.2, 2), None, "g"), "cell B2 is a percentage with a unit"),
    "formula unsaved": (mass(Formula("20+5"), None, "g"), 'formula without a saved value; got "=20+5"'),
    "width without value": (mass(None, 0.2, "g"), "cell C2 is a width without a value"),
    "width that is no width": (mass(25.0, "some", "g"), "cell B2: [cage] mass, after +-, must be one number and one unit of mass"),
    "width beside a list": (study("stability", 2, "kicks", "0.1; 2", 0.1, "m/s"), "cell C2 is a width beside a list. Clear one of them."),
    "value without key": (study("cage", 4, None, 3.0), "cell B4 is a value without a key"),
    "key twice": (study("cage", 4, "mass", 30.0, None, "g"), "cell B4 has mass a second time."),
    "key of odd signs": (study("cage", 4, "mass (kg)", 1.0), 'cell A4 must be the name of a key; got "mass (kg)"'),
    "name and parts": (study("bearing", 10, "ball_material.density", 7.0, None, "kg/m3"), "cell B10 has ball_material.density a second time."),
    "items without their heading": ({**WRONG, "ranking": [HEAD, ["candidates.name", "a"]]}, "cell B2: [ranking] candidates must be a list in [brackets]"),
    "brackets that do not close": (study("cage", 4, "gravity", "{ between = [1, 2"), "cell B4 is not valid TOML: it ends inside"),
    "no headings": ({**WRONG, "cage": [["mass", 25.0, None, "g"]]}, "sheet cage has no headings key and value"),
    "column twice": ({**WRONG, "cage": [["key", "value", "value"], ["mass", "25 g"]]}, 'has two columns of one heading; got "value"'),
    "sheet misspelt": ({**WRONG, "cagge": WRONG["cage"]}, "sheet cagge is not a section of a study. Did you mean cage?"),
    "two sheets of a name": ({**WRONG, "Cage ": [HEAD, ["mass", 30.0, None, "g"]]}, 'sheet Cage  has "[cage]" a second time.'),
    "nothing in it": ({"Sheet1": [["a", 1.0]]}, "has no sheet of a study with a value. `separatrix new PATH.xlsx`"),
}  # fmt: skip

LAUGHS = '<?xml version="1.0"?><!DOCTYPE sst [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;">]><sst>&b;</sst>'
SHEET_1 = "xl/worksheets/sheet1.xml"
FILES = {
    "entities in a sheet": (zipped(parts(WRONG) | {SHEET_1: LAUGHS}), "case.xlsx"),
    "cut XML": (zipped(parts(WRONG) | {SHEET_1: parts(WRONG)[SHEET_1][:-9]}), "is not a readable workbook"),
    "no workbook": (zipped({"a.txt": "x"}), "is not a readable workbook"),
    "OpenDocument": (zipped({"mimetype": "application/vnd.oasis.opendocument.spreadsheet", "content.xml": "<x/>"}), "is not a readable workbook"),
    "old kind or password": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "is not a readable workbook"),
    "empty": (b"", "is not a readable workbook"),
    "bomb": (zipped(parts(WRONG) | {"xl/media/a.bin": bytes(9_000_000)}), "must expand by at most 100:1"),
}  # fmt: skip


def written(tmp_path, content):
    """Return the path of a workbook with these sheets, or of a file with these bytes."""
    content = content if isinstance(content, bytes) else workbook(content)
    return commands.written(tmp_path, content, "case.xlsx")


@pytest.mark.parametrize("what", STUDIES | FILES)
def test_a_wrong_workbook_is_refused_in_one_line(tmp_path, what):
    """One mistake in a workbook that is otherwise right: sheet, cell, rule, value and cure."""
    content, words = (STUDIES | FILES)[what]
    assert words in refusal_line(written(tmp_path, content))


def test_all_wrong_cells_are_named_at_once(tmp_path):
    """Each in its line, in the order of the sheets; without the mistakes the study is read."""
    assert read_study(written(tmp_path, WRONG)).bearing.ball_count == 13
    sheets = {**mass(Fault("#REF!"), None, "g"), "film": [HEAD, ["race_friction", 0.1, "20 %"], [None, 3.0]]}
    lines = refusal(written(tmp_path, sheets)).split("\n")
    assert [one.partition(", cell ")[2][:2] for one in lines] == ["B3", "B2"]
