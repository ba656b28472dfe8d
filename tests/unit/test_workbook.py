"""Workbooks that are written: a template reads back as the study, results hold what `rank.json` does."""

import dataclasses
import json
import re
import time
import zipfile
from fractions import Fraction

import openpyxl
import pytest
from minimal_xlsx import Formula, Shown, workbook
from separatrix.study.reading.cells import COLUMNS, sheets_of
from separatrix.study.reading.document import SECTIONS, load
from separatrix.study.reading.templates import template_keys, template_workbook
from separatrix.study.reading.values import READERS

import separatrix
from separatrix.cli import main
from separatrix.ground.errors import ValidityWarning
from separatrix.ground.sheet import add_sheet, new_workbook, put, text_for_cell, workbook_bytes
from separatrix.ground.units import parse
from separatrix.saving import write_ranking
from separatrix.study.reading import read_study, shipped_studies

STUDY = """
title = "= A title that begins like a formula"
extends = "cryogenic-turbopump"

[film]
thickness = "0.5 um +- 20 %"
race_friction = { between = [0.08, 0.12] }

[cage]
mass = "25.0000000000000001 g"
pocket_clearance = { mean = "0.6 mm", standard_deviation = "20 um" }
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
friction = { "air" = "0.1 +- 30 %" }
material = "Armalon"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the study above."""
    place = tmp_path_factory.mktemp("workbooks")
    (place / "case.toml").write_text(STUDY)
    return place


@pytest.fixture(scope="module")
def answer(folder):
    """The document of a small ranking, as it is saved, and the folder of the answer."""
    small = STUDY.replace('thickness = "0.5 um +- 20 %"', 'thickness = "0.5 um"')
    small = small.replace("{ between = [0.08, 0.12] }", "0.1").replace('"0.1 +- 30 %"', "0.1")
    small = small.replace('{ mean = "0.6 mm", standard_deviation = "20 um" }', '"0.6 mm"')
    (folder / "small.toml").write_text(small)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("separatrix.figures.save_all", lambda *_: None)  # they take long
        assert main(["rank", str(folder / "small.toml"), "--out", str(folder / "out"), "--quiet"]) == 0
    return json.loads((folder / "out" / "rank.json").read_text())


def typed(key, value):
    """Yield the rows of a value as one types them: numbers with their unit, and uncertainty, beside them."""
    if isinstance(value, dict):
        for part, item in value.items():
            yield from typed(f"{key}.{part}", item)
    elif isinstance(value, list):
        yield key, "; ".join(map(str, value)), None, None
    else:
        found = re.fullmatch(r"([-0-9.]+) (\S+)(?: \+- (\d+ %))?", value) if isinstance(value, str) else None
        is_exact = found and Fraction(float(found[1])) == Fraction(found[1])
        yield (key, float(found[1]), found[3], found[2]) if is_exact else (key, value, None, None)


def in_workbook(path):
    """Return a study file as the workbook that somebody could have typed in its place."""
    document = load(path)
    sections = {"study": document.top, **{name: dict(document.sections.get(name, {})) for name in SECTIONS}}
    candidates = sections["ranking"].pop("candidates", [])
    sheets = {
        name: [list(COLUMNS), *(row for key, value in given.items() for row in typed(key, value))]
        for name, given in sections.items()
    }
    environments = dict.fromkeys(env for one in candidates for env in one["friction"])
    parts = ("mean", "standard_deviation", "count", "source")
    heads = [("", "name"), ("", "material"), ("GPa", "elastic_modulus"), ("", "poisson_ratio")]
    heads += [(env, part) for env in environments for part in parts]
    rows = []
    for one in candidates:
        friction = {e: f if isinstance(f, dict) else {"mean": f} for e, f in one["friction"].items()}
        own = one.get("material") if isinstance(one.get("material"), dict) else {}
        row = [
            one["name"],
            None if own else one.get("material"),
            *map(own.get, ("elastic_modulus", "poisson_ratio")),
        ]
        rows.append(row + [friction.get(env, {}).get(part) for env in environments for part in parts])
    return workbook(sheets | {"candidates": [list(head) for head in zip(*heads, strict=True)] + rows})


def rewritten(path, folder):
    """Return a study read from the workbook that its own file is turned into."""
    there = folder / f"{path.stem}.xlsx"
    there.write_bytes(in_workbook(path))
    return read_study(there)


@pytest.mark.filterwarnings("ignore:Data of the library")  # at 90 K there are none
@pytest.mark.parametrize("path", shipped_studies().values(), ids=shipped_studies())
def test_a_study_typed_into_a_workbook_is_the_same(path, tmp_path):
    """Every number to the last bit, every material and every candidate."""
    assert rewritten(path, tmp_path) == read_study(path)


def test_every_way_to_write_a_value_has_cells(folder):
    """Distributions, lists with and without one unit, long numbers, tables, candidates in place."""
    expected = read_study(folder / "case.toml")
    found = rewritten(folder / "case.toml", folder)
    assert found == expected
    assert set(found.distributions) == {
        *("film.thickness", "film.race_friction", "cage.pocket_clearance", "ranking.@SUM(1).air"),
    }
    for key, one in expected.distributions.items():
        assert found.distributions[key].quantile(0.3) == one.quantile(0.3)


def test_the_template_is_what_the_verb_new_writes(tmp_path, capsys):
    """`new --excel` writes the workbook, once; `check` reads it; its name must be that of a workbook."""
    path = tmp_path / "mine.xlsx"
    assert main(["new", "--excel", str(path)]) == 0
    assert path.read_bytes() == template_workbook()
    assert main(["check", "--full", str(path)]) == 0
    assert "mine.xlsx, sheet cage, cell B2" in capsys.readouterr().out
    for options in (
        ["--excel", str(path)],
        ["--excel", str(tmp_path / "a.toml")],
        [str(tmp_path / "b.xlsx")],
        [str(tmp_path / "b.xls")],
        ["--excel", str(tmp_path / "b.xlsm")],
    ):
        assert main(["new", *options]) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["mine.xlsx"]


@pytest.mark.parametrize("name", ["n.xlsx", "link.xlsx", "n.toml"])
def test_a_name_that_is_taken_is_refused_before_anything_is_built(tmp_path, monkeypatch, capsys, name):
    """A workbook takes a while to build; a link that leads nowhere is a name that is taken, too."""
    for taken in ("n.xlsx", "n.toml"):
        (tmp_path / taken).write_text("mine")
    (tmp_path / "link.xlsx").symlink_to("nowhere.xlsx")
    built = []
    monkeypatch.setattr("separatrix.study.reading.template", lambda: built.append("text") or "")
    monkeypatch.setattr(
        "separatrix.study.reading.templates.template_workbook", lambda: built.append("workbook") or b""
    )
    path = tmp_path / name
    assert main(["new", *(["--excel"] if path.suffix == ".xlsx" else []), str(path)]) == 2
    line = f"separatrix: {path} exists already. It was not touched; name a new file.\n"
    assert capsys.readouterr().err == line
    assert built == []
    assert (tmp_path / "n.xlsx").read_text() == (tmp_path / "n.toml").read_text() == "mine"
    assert not (tmp_path / "nowhere.xlsx").exists()


def test_the_template_says_what_the_text_file_says(tmp_path):
    """Every key of the text is a row of its section's sheet, with a remark that is whole."""
    (tmp_path / "t.xlsx").write_bytes(template_workbook())
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    assert book.sheetnames == ["instructions", "study", *SECTIONS, "candidates", "lists"]
    for one in template_keys():
        assert not one.meaning.endswith((":", ",", " of"))
        if one.section in SECTIONS:
            keys = [cell.value.split(".")[0] for cell in book[one.section]["A"][1:] if cell.value]
            assert one.key in keys
    known = {f"{one.section}.{one.key}" for one in template_keys()}
    assert {"bearing.free_angle", "film.race_friction", "cage.pocket_clearance"} < {
        f"{one.section}.{one.key}" for one in template_keys() if one.is_required
    }
    assert known - {f"{s}.{k}" for s in READERS for k in READERS[s]} == {
        *(".title", ".extends", "ranking.candidates.name", "ranking.candidates.friction"),
        "ranking.candidates.material",
    }


def test_choices_have_lists_of_what_may_be_chosen(tmp_path):
    """The guidance, the units of a length and the materials of balls can be chosen from lists."""
    (tmp_path / "t.xlsx").write_bytes(template_workbook())
    book = openpyxl.load_workbook(tmp_path / "t.xlsx")
    listed = {}
    for sheet, key in (("cage", "guidance"), ("bearing", "ball_material"), ("bearing", "ball_diameter")):
        row = next(cell.row for cell in book[sheet]["A"] if cell.value == key)
        rules = {str(rule.sqref): rule.formula1 for rule in book[sheet].data_validations.dataValidation}
        cells = (
            rules[f"{'D' if key == 'ball_diameter' else 'B'}{row}"].removeprefix("=lists!").replace("$", "")
        )
        listed[key] = [cell.value for (cell,) in book["lists"][cells]]
    assert listed["guidance"] == ["outer", "inner", "ball"]
    assert "Si3N4" in listed["ball_material"]
    assert listed["ball_diameter"][:3] == ["m", "cm", "mm"]


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
    with pytest.warns(ValidityWarning, match=r"a\.xlsx: the cell has a formula \(film!B2\)"):
        found = variant(tmp_path / "a.xlsx", ["thickness", Formula("1/2", 0.5), None, "um"])
    assert found.film.thickness == 5e-7


def test_sheets_of_ones_own_and_rows_without_value_are_passed_over(tmp_path):
    """A sheet of calculations, with formulas and all, and a key without a value change nothing."""
    sheets = {"my sums": [["a", Formula("1+1")], ["b", 2.0]], "cage": [HEAD, ["mass", None, None, "g"]]}
    found = variant(tmp_path / "a.xlsx", ["thickness", 0.25, None, "um"], **sheets)
    assert found.film.thickness == 2.5e-7
    assert found.cage == read_study("cryogenic-turbopump").cage


def test_a_number_in_a_cell_loses_no_digit(tmp_path):
    """The number of the cell and its unit give what the same digits give as text."""
    assert variant(tmp_path / "a.xlsx", ["thickness", 0.123456789012, None, "um"]).film.thickness == parse(
        "0.123456789012 um", "m"
    )


def test_headings_may_stand_in_any_order(tmp_path):
    """Columns are found by their headings; units and widths may be absent when values bring them."""
    film = [["meaning", "value", "±", "key"], ["thin", "0.25 um", "20 %", "thickness"]]
    top = [["key", "value"], ["extends", "cryogenic-turbopump"]]
    (tmp_path / "a.xlsx").write_bytes(workbook({"study": top, "film": film}))
    found = read_study(tmp_path / "a.xlsx")
    assert found.film.thickness == 2.5e-7
    assert set(found.distributions) == {"film.thickness"}


def test_data_of_other_programs_are_left_alone(tmp_path):
    """Power Query keeps its queries in UTF-16 inside the workbook; nothing of them is read."""
    query = '<?xml version="1.0" encoding="utf-16"?><DataMashup/>'.encode("utf-16")
    top, film = [HEAD, ["extends", "le7"]], [HEAD, ["race_friction", 0.07]]
    (tmp_path / "a.xlsx").write_bytes(workbook({"study": top, "film": film}, customXml__item1_dot_xml=query))
    assert read_study(tmp_path / "a.xlsx").film.race_friction == 0.07


# Results


def cells(path):
    """Return every cell of a workbook that holds something, with its sheet."""
    return [
        (s.title, c) for s in openpyxl.load_workbook(path) for row in s for c in row if c.value is not None
    ]


@pytest.fixture(scope="module")
def data(folder, answer):
    """The dataset of the small ranking, for its units."""
    return separatrix.load(folder / "out" / "rank.json")


def test_numbers_are_those_of_the_document(folder, answer):
    """Each table has a sheet: its rows in their order, the field's name with its unit, values in SI."""
    book = openpyxl.load_workbook(folder / "out" / "rank.xlsx")
    assert book.sheetnames == ["candidates", "overall", "stability curve", "linear limit", "answer", "inputs"]
    places = [{"environment": e["name"]} | row for e in answer["environments"] for row in e["materials"]]
    stability = answer["stability"]
    curves = {"stability curve": stability["curve"], "linear limit": stability["linear_limit"]}
    for name, records in {"candidates": places, "overall": answer["overall"], **curves}.items():
        head, *rows = book[name].values
        assert len(rows) == len(records)
        for row, record in zip(rows, records, strict=True):
            shown = dict(zip([one.partition(" [")[0] for one in head], row, strict=True))
            numbers = {key: record[key] for key in shown if isinstance(record[key], float)}
            assert {key: shown[key] for key in numbers} == pytest.approx(numbers, rel=1e-15)  # its digits
            if "verdict" in shown:
                assert (shown["rank"], shown["verdict"]) == (record["rank"], record["verdict"])
    assert next(iter(book["candidates"].values))[:4] == ("environment", "name", "rank", "verdict")
    assert {"friction [-]", "largest_offset [m]"} <= {cell.value for cell in book["overall"][1]}
    assert book["overall"].freeze_panes == "C2"


def test_inputs_and_sources_are_there(folder, answer):
    """Each input has its unit and origin, each friction its scatter and source; version and seed."""
    book = openpyxl.load_workbook(folder / "out" / "rank.xlsx")
    lines = {row[0]: row[1:] for row in book["inputs"].values}
    assert lines["film.thickness"] == (5e-7, "m", 'small.toml, line 6: "0.5 um"')
    assert lines["cage.gravity"] == (0, "m/s2", "default")
    assert lines["film.material.name"][0] == "PTFE transfer film"
    assert lines["bearing.ball_material.elastic_modulus"][:2] == (2e11, "Pa")
    assert lines["ranking.candidates[2].material.confidence"][0].startswith("modulus: guess")
    friction = "ranking.candidates[1].friction.liquid nitrogen, 440C"
    parts = ("mean", "standard_deviation", "count", "source")
    assert [lines[f"{friction}.{part}"][0] for part in parts] == [0.12, 0.02, 8, "'-2+3"]
    single = {row[0]: row[1:] for row in book["answer"].values}
    assert single["separatrix_version"][0] == answer["separatrix_version"]
    assert (single["seed"][0], single["kicks"]) == (1, ("0.1; 0.5; 2.0", "m/s"))
    assert single["pocket.slip_speed"] == (pytest.approx(answer["pocket"]["slip_speed"]), "m/s")


EVIL = ["=cmd|' /C calc'!A0", "@SUM(1)", "+1+1", "-2+3", "\t=1+1", "\r=1", " =1+1", "＝1+1", "\x07bell"]


def with_text_everywhere(value, text):
    """Return a document with every text in it replaced, except units."""
    if isinstance(value, dict):
        return {k: v if k == "unit" else with_text_everywhere(v, text) for k, v in value.items()}
    if isinstance(value, list):
        return [with_text_everywhere(item, text) for item in value]
    return text if isinstance(value, str) else value


@pytest.mark.parametrize("text", EVIL)
def test_no_text_is_ever_a_formula(answer, data, tmp_path, text):
    """Whatever a user writes, in every place of the document: text cells, no formula, no beginning of one."""
    write_ranking(with_text_everywhere(answer, text), data, tmp_path / "evil.xlsx")
    found = cells(tmp_path / "evil.xlsx")
    assert {cell.data_type for _, cell in found} <= {"s", "n"}
    texts = [cell for _, cell in found if isinstance(cell.value, str)]
    assert not [cell.value for cell in texts if cell.value.lstrip()[:1] in "=+@＝\t\r"]
    assert not [cell.value for cell in texts if cell.value.startswith("-") and cell.value != "-"]
    written = [cell for cell in texts if cell.value == text_for_cell(text)]
    assert len(written) > 50
    assert all(cell.quotePrefix for cell in written) == (text_for_cell(text)[0] == "'")
    with zipfile.ZipFile(tmp_path / "evil.xlsx") as archive:
        sheets = [archive.read(n) for n in archive.namelist() if n.startswith("xl/worksheets/")]
    assert not [part for part in sheets if b"<f" in part]


def test_the_same_content_gives_the_same_bytes(answer, data, tmp_path, monkeypatch):
    """Neither date nor time nor the order of making shows in the file."""
    write_ranking(answer, data, tmp_path / "now.xlsx")
    now = time.time()
    monkeypatch.setattr(time, "time", lambda: now + 1e7)
    monkeypatch.setattr(time, "localtime", lambda *_: time.gmtime(now + 1e7))
    write_ranking(answer, data, tmp_path / "later.xlsx")
    assert (tmp_path / "now.xlsx").read_bytes() == (tmp_path / "later.xlsx").read_bytes()
    with zipfile.ZipFile(tmp_path / "now.xlsx") as archive:
        core = archive.read("docProps/core.xml")
    assert core.count(b"2000-01-01T00:00:00Z<") == 2


def test_a_table_that_an_answer_lacks_has_no_sheet(answer, data, tmp_path):
    """A ranking without a curve."""
    write_ranking(answer | {"stability": None}, data, tmp_path / "bare.xlsx")
    book = openpyxl.load_workbook(tmp_path / "bare.xlsx")
    assert book.sheetnames == ["candidates", "overall", "answer", "inputs"]


def test_what_we_write_we_read(tmp_path):
    """Numbers and texts put into cells come back through our own reader."""
    book = new_workbook()
    sheet = add_sheet(book, "a")
    for column, value in enumerate((1.5, -3, "-", "=x", True, None, "_x003D_1"), 1):
        put(sheet, 1, column, value)
    (tmp_path / "a.xlsx").write_bytes(workbook_bytes(book))
    (found,) = sheets_of(tmp_path / "a.xlsx", "a.xlsx", lambda _: True)
    assert [found.cells[1, n].value if (1, n) in found.cells else None for n in range(1, 8)] == [
        1.5,
        -3,
        "-",
        "'=x",
        "yes",
        None,
        "_x003D_1",
    ]
    with zipfile.ZipFile(tmp_path / "a.xlsx") as archive:
        assert b"_x005F_x003D_1<" in archive.read("xl/worksheets/sheet1.xml")  # else shown and exported as =1


def test_a_study_in_a_workbook_is_ranked(folder, answer, capsys):
    """Every verb takes a workbook: its ranking is that of the same study as text."""
    (folder / "small.xlsx").write_bytes(in_workbook(folder / "small.toml"))
    capsys.readouterr()
    assert main(["rank", str(folder / "small.xlsx"), "--json", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["overall"] == answer["overall"]


def test_variants_of_a_workbook(folder):
    """A text file may extend a workbook, and a workbook may be extended by one."""
    (folder / "base.xlsx").write_bytes(in_workbook(folder / "case.toml"))
    (folder / "thin.toml").write_text('extends = "base.xlsx"\n[film]\nthickness = "0.1 um"\n')
    found, base = read_study(folder / "thin.toml"), read_study(folder / "base.xlsx")
    assert found.film.thickness == 1e-7
    assert dataclasses.replace(found.cage) == base.cage
