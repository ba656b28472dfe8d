"""Workbooks that are written: a study reads back the same, results hold what `rank.json` does."""

import re
import tomllib
import zipfile
from dataclasses import replace
from fractions import Fraction

import openpyxl
import pytest
from minimal_xlsx import Formula, Shown, workbook
from rich_studies import PLANE, SPACE

from separatrix.front import main
from separatrix.ground.sheet import add_sheet, new_workbook, put, workbook_bytes
from separatrix.ground.units import parse
from separatrix.ground.workbook import COLUMNS, sheets_of
from separatrix.study.reading import read_study
from separatrix.study.study import ORDER, shipped_studies
from separatrix.study.template import study_keys, template, template_workbook

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
        for number, item in enumerate(value, 1):
            yield from typed(f"{key}.{number}", item)
    elif isinstance(value, list):
        yield key, "; ".join(map(str, value)), None, None
    else:
        found = re.fullmatch(r"([-0-9.]+) (\S+)(?: \+- (\d+ %))?", value) if isinstance(value, str) else None
        is_exact = found and Fraction(float(found[1])) == Fraction(found[1])
        yield (key, float(found[1]), found[3], found[2]) if is_exact else (key, value, None, None)


def candidates_sheet(candidates):
    """Return the sheet with a row for each candidate."""
    environments = dict.fromkeys(env for one in candidates for env in one["friction"])
    parts = ("mean", "standard_deviation", "count", "source")
    heads = [("", "name"), ("", "material"), ("GPa", "elastic_modulus"), ("", "poisson_ratio")]
    heads.append(("g/cm3", "density"))
    heads += [(env, part) for env in environments for part in parts]
    rows = []
    for one in candidates:
        friction = {e: f if isinstance(f, dict) else {"mean": f} for e, f in one["friction"].items()}
        own = one.get("material") if isinstance(one.get("material"), dict) else {}
        row = [one["name"], None if own else one.get("material"), *(own.get(part) for _, part in heads[2:5])]
        rows.append(row + [friction.get(env, {}).get(part) for env in environments for part in parts])
    return [list(head) for head in zip(*heads, strict=True)] + rows


def in_workbook(text, *, with_sheet=True):
    """Return a study as the workbook that somebody could have typed in its place."""
    data = tomllib.loads(text)
    sheets = {"study": {key: value for key, value in data.items() if not isinstance(value, dict)}, **data}
    candidates = data.get("ranking", {}).pop("candidates", []) if with_sheet else []
    found = {
        name: [[*COLUMNS], *([*row] for row in typed("", given))]
        for name, given in sheets.items()
        if isinstance(given, dict)
    }
    return workbook(found | ({"candidates": candidates_sheet(candidates)} if candidates else {}))


def read_from(folder, name, content):
    """Return the study of a file of this name and content."""
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_study(folder / name)


TEXTS = {name: path.read_text() for name, path in shipped_studies().items()}
TEXTS |= {"space": SPACE, "plane": PLANE, "variant": STUDY}


@pytest.mark.parametrize("with_sheet", [True, False], ids=["sheet", "dotted"])
@pytest.mark.parametrize("name", TEXTS)
def test_a_study_typed_into_a_workbook_is_the_same(name, with_sheet, tmp_path):
    """Every number to the last bit, every distribution, material and candidate, in either form."""
    expected = read_from(tmp_path, "a.toml", TEXTS[name])
    found = read_from(tmp_path, "a.xlsx", in_workbook(TEXTS[name], with_sheet=with_sheet))
    assert found == expected
    for key, one in expected.distributions.items():
        assert found.distributions[key].quantile(0.3) == one.quantile(0.3)


def test_the_template_is_what_the_verb_new_writes(tmp_path, capsys):
    """`new PATH.xlsx` writes the workbook, once; `check` reads it; no other kind of workbook is written."""
    path = tmp_path / "mine.xlsx"
    assert main(["new", str(path)]) == 0
    assert path.read_bytes() == template_workbook()
    assert main(["check", "--full", str(path)]) == 0
    assert "mine.xlsx, sheet cage, cell B2" in capsys.readouterr().out
    for name in ("mine.xlsx", "b.xls", "b.xlsm"):
        assert main(["new", str(tmp_path / name)]) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["mine.xlsx"]
    assert read_study(path) == read_from(tmp_path, "mine.toml", template())


@pytest.mark.parametrize("name", ["n.xlsx", "link.xlsx", "n.toml"])
def test_a_name_that_is_taken_is_refused_before_anything_is_built(tmp_path, monkeypatch, capsys, name):
    """A workbook takes a while to build; a link that leads nowhere is a name that is taken, too."""
    for taken in ("n.xlsx", "n.toml"):
        (tmp_path / taken).write_text("mine")
    (tmp_path / "link.xlsx").symlink_to("nowhere.xlsx")
    built = []
    monkeypatch.setattr("separatrix.study.template.template", lambda: built.append("text") or "")
    monkeypatch.setattr(
        "separatrix.study.template.template_workbook", lambda: built.append("workbook") or b""
    )
    path = tmp_path / name
    assert main(["new", str(path)]) == 2
    line = f"separatrix: {path} exists already. It was not touched; name a new file.\n"
    assert capsys.readouterr().err == line
    assert built == []
    assert (tmp_path / "n.xlsx").read_text() == (tmp_path / "n.toml").read_text() == "mine"
    assert not (tmp_path / "nowhere.xlsx").exists()


def test_the_template_says_what_the_text_file_says(tmp_path):
    """Every key of the text is a row of its section's sheet; a word has the list of those it may be."""
    (tmp_path / "t.xlsx").write_bytes(template_workbook())
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    assert book.sheetnames == ["instructions", "study", *ORDER, "candidates"]
    for section in ORDER:
        rows = {cell.value.split(".")[0]: cell for cell in book[section]["A"][1:]}
        assert list(rows) == [one.name for one in study_keys(section)]
        assert {name for name, cell in rows.items() if cell.font.bold} >= {
            one.name for one in study_keys(section) if one.one.is_required
        }
    lists = {str(rule.sqref): rule.formula1 for rule in book["cage"].data_validations.dataValidation}
    row = next(cell.row for cell in book["cage"]["A"] if cell.value == "guidance")
    assert lists[f"B{row}"] == '"outer,inner,ball"'


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


def test_a_formula_counts_with_its_saved_value_and_is_named(tmp_path):
    """The value is taken and the study says that it came from a formula, and from which cell."""
    found = variant(tmp_path / "a.xlsx", ["thickness", Formula("1/2", 0.5), None, "um"])
    assert any("a.xlsx: the cell has a formula (film!B2)" in note for note in found.notes)
    assert found.film.thickness == 5e-7


@pytest.mark.parametrize("steel", [52100.0, "52100"])
def test_what_stands_in_cells_is_meant(tmp_path, steel):
    """No digit of a number is lost, one may be the name of a steel, and a value in quotes is its text.

    Nothing is changed by a sheet of calculations, with formulas and all, or a key without a value.
    """
    film = ["thickness", 0.123456789012, None, "um"]
    cage = [HEAD, ["gravity", None, None, "g0"], ["mass", '"26 g"']]
    sheets = {"my sums": [["a", Formula("1+1")], ["b", 2.0]], "bearing": [HEAD, ["ball_material", steel]]}
    found = variant(tmp_path / "a.xlsx", film, cage=cage, **sheets)
    assert found.film.thickness == parse("0.123456789012 um", "m")
    assert found.cage == replace(read_study("cryogenic-turbopump").cage, mass=0.026)
    assert found.bearing.ball_material.name == "52100"


def test_headings_may_stand_in_any_order(tmp_path):
    """Columns are found by their headings; units and widths may be absent when values bring them."""
    film = [["meaning", "value", "±", "key"], ["thin", "0.25 um", "20 %", "thickness"]]
    top = [["key", "value"], ["extends", "cryogenic-turbopump"]]
    found = read_from(tmp_path, "a.xlsx", workbook({"study": top, "film": film}))
    assert found.film.thickness == 2.5e-7
    assert set(found.distributions) == {"film.thickness"}


def test_data_of_other_programs_are_left_alone(tmp_path):
    """Power Query keeps its queries in UTF-16 inside the workbook; nothing of them is read."""
    query = '<?xml version="1.0" encoding="utf-16"?><DataMashup/>'.encode("utf-16")
    top, film = [HEAD, ["extends", "le7"]], [HEAD, ["race_friction", 0.07]]
    content = workbook({"study": top, "film": film}, customXml__item1_dot_xml=query)
    assert read_from(tmp_path, "a.xlsx", content).film.race_friction == 0.07


def test_a_text_file_may_extend_a_workbook(tmp_path):
    """And a workbook a text file, which in turn extends a shipped study."""
    base = read_from(tmp_path, "base.xlsx", in_workbook(STUDY))
    thin = read_from(tmp_path, "thin.toml", 'extends = "base.xlsx"\n[film]\nthickness = "0.1 um"\n')
    assert (thin.film.thickness, thin.cage) == (1e-7, base.cage)
    content = workbook({"study": [HEAD, ["extends", "thin.toml"]], "cage": [HEAD, ["mass", 26.0, None, "g"]]})
    over = read_from(tmp_path, "over.xlsx", content)
    assert (over.film.thickness, over.cage.mass, over.ranking) == (1e-7, 0.026, base.ranking)


def test_what_we_write_we_read(tmp_path):
    """Numbers and texts put into cells come back through our own reader."""
    book = new_workbook()
    sheet = add_sheet(book, "a")
    for column, value in enumerate((1.5, -3, "-", "=x", True, None, "_x003D_1"), 1):
        put(sheet, 1, column, value)
    (tmp_path / "a.xlsx").write_bytes(workbook_bytes(book))
    (found,) = sheets_of(tmp_path / "a.xlsx", "a.xlsx", lambda _: True)
    written = (1.5, -3, "-", "'=x", "yes", None, "_x003D_1")
    assert tuple(found.cells[1, n].value if (1, n) in found.cells else None for n in range(1, 8)) == written
    with zipfile.ZipFile(tmp_path / "a.xlsx") as archive:
        assert b"_x005F_x003D_1<" in archive.read("xl/worksheets/sheet1.xml")  # else shown and exported as =1
