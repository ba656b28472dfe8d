"""The verb `report`: one document from the answers of a study or of a folder, as HTML and as PDF."""

from __future__ import annotations

import base64
import contextlib
import io
import json
import re
import shutil
import sys
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import pytest
from commands import document, refused
from pypdf import PdfReader

from separatrix.front import api, main
from separatrix.ground.errors import InputError
from separatrix.reporting.content import answers, read_document
from separatrix.reporting.record import Kept
from separatrix.study.reading import read_study

HOSTILE = "<script>alert(1)</script> $x$ #strong[x]"
CANDIDATE = '</td><img src="http://x.y"> $x$ #emph[a]'
STUDY = f"""
title = "{HOSTILE}"

[bearing]
ball_diameter = "5 mm"
pitch_diameter = "20 mm"
ball_count = 8
contact_angle = "15 deg"
inner_conformity = 0.53
outer_conformity = 0.53
ball_material = "440C"
ring_material = "440C"

[operation]
inner_speed = "6000 rpm"
axial_load = "50 N"

[film]
race_friction = 0.1
"""
CAGE = f"""
[cage]
mass = "2 g"
ball_cage_stiffness = "1e6 N/m"
pocket_clearance = "0.2 mm"
guidance = "outer"
land_clearance = "0.3 mm"
land_friction = 0.1
land_stiffness = "1e6 N/m"
land_restitution = 0.5

[stability]
kicks = ["0.2 m/s"]
runs = 4
duration = "4 ms"
restitution_factors = {{ from = 0.3, to = 0.9, count = 3 }}

[[ranking.candidates]]
name = '{CANDIDATE}'
friction = {{ vacuum = {{ mean = 0.1, standard_deviation = 0.02, count = 4, source = "own tests" }} }}

[[ranking.candidates]]
name = "Other"
friction = {{ vacuum = {{ mean = 0.3 }} }}
"""
SECTIONS = [
    "Answer",
    "Bearing, cage and operating point",
    "The chain, stage by stage",
    "Evidence of the verdicts",
    "Uncertainty and the next test",
    "Outside its range",
    "Inputs and their sources",
    "Provenance",
]
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?![\w.])")

pytestmark = pytest.mark.usefixtures("elsewhere")


class Page(HTMLParser):
    """What is in a page: its elements with their attributes, and the text of each kind of element."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self._open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        """Note an element."""
        self.elements.append((tag, dict(attrs)))
        if tag not in ("meta", "img", "link", "br"):
            self._open.append(tag)

    def handle_endtag(self, tag):
        """Close an element."""
        assert self._open.pop() == tag

    def handle_data(self, data):
        """Note a text with the element that has it."""
        if self._open and data.strip():
            self.texts.append((self._open[-1], data.strip()))

    def of(self, tag: str) -> list[dict[str, str | None]]:
        """Return the attributes of the elements of a kind."""
        return [attrs for name, attrs in self.elements if name == tag]

    def text_of(self, *tags: str) -> list[str]:
        """Return the texts of the elements of some kinds."""
        return [text for name, text in self.texts if name in tags]


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Run the test in an empty folder."""
    place = tmp_path / "here"
    place.mkdir()
    monkeypatch.chdir(place)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A study beside a folder with the answers to it, as documents."""
    place = tmp_path_factory.mktemp("report")
    (place / "hostile.toml").write_text(STUDY + CAGE)
    out = place / "answers"
    out.mkdir()
    for verb in (api.bearing, api.traction, api.restitution, api.rank):
        found = verb(place / "hostile.toml")
        (out / f"{found.verb}.json").write_text(json.dumps(found.document()))
    return out


def never(*_: object, **__: object) -> None:
    """Stand in for a verb that must not be computed."""
    raise RuntimeError("computed")


@pytest.fixture(scope="module")
def found(folder):
    """The document of the study's report, written into the folder where its answers are: none is computed."""
    out = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(out):
        for verb in ("bearing", "traction", "restitution", "rank"):
            patch.setattr(f"separatrix.verbs.{verb}.compute", never)
        study = str(folder.parent / "hostile.toml")
        assert main(["report", study, "--json", "--pdf", "--quiet", "--out", str(folder)]) == 0
    return json.loads(out.getvalue())


@pytest.fixture(scope="module")
def page(found, folder):
    """The HTML of that report."""
    return Page((folder / "report.html").read_text(encoding="utf-8"))


def images(page: Page) -> list[str]:
    """Return the pictures of a page as SVG."""
    head = "data:image/svg+xml;base64,"
    assert all((one["src"] or "").startswith(head) and one["alt"] for one in page.of("img"))
    return [base64.b64decode((one["src"] or "").removeprefix(head)).decode() for one in page.of("img")]


def test_it_has_its_sections_in_order_and_answers_first(page):
    """The verdict is in the first section, the caption of its table names the environment."""
    assert page.text_of("h2") == SECTIONS
    assert any(text.startswith("Candidates in vacuum") for text in page.text_of("caption"))
    assert {"UNSTABLE", "UNDECIDED", "STABLE"} & set(page.text_of("td"))
    assert page.text_of("h3")[:2] == ["Ball equilibrium", "Contacts"]


def test_names_of_the_user_are_text_in_the_page_and_in_its_pictures(page):
    """Neither a script nor a tag nor a formula comes out of a title or of a material's name."""
    assert HOSTILE in page.text_of("h1")
    assert CANDIDATE in page.text_of("td")
    assert [one.get("type") for one in page.of("script")] == ["application/json", None]
    for svg in images(page):
        assert "<script" not in svg
        assert "http://x.y" not in svg


def test_the_page_loads_nothing(folder, page):
    """Every address is inside the file, in its pictures as well."""
    for _, attrs in page.elements:
        for name in ("src", "href", "srcset", "action", "data"):
            assert (attrs.get(name) or "#").startswith(("#", "data:"))
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert "@import" not in text
    assert not re.search(r"url\((?!#)", text)
    for svg in images(page):
        assert not re.search(r'href="(?!#|data:)', svg)


def test_html_and_pdf_say_the_same_numbers(folder, page):
    """Every number of a table of the page is in the PDF, as often, and so are the user's names as text."""
    written = "\n".join(one.extract_text() for one in PdfReader(folder / "report.pdf").pages)
    ours = Counter(n for text in page.text_of("td", "th") for n in NUMBER.findall(text))
    missing = ours - Counter(NUMBER.findall(written.replace("\N{MINUS SIGN}", "-")))
    assert ours.total() > 150
    assert not missing
    assert HOSTILE in written.replace("\n", " ")
    assert "#emph[a]" in written


def test_marks_can_be_pointed_at_and_reached_by_keyboard(page):
    """Each overlay has one stop of the tab key; every mark has its numbers as title, and lies inside."""
    overlays, stops, titles = page.of("svg"), page.of("circle"), page.text_of("title")[1:]
    assert sum(one["tabindex"] == "0" for one in stops) == len(overlays) == 3
    assert [one["aria-label"] for one in stops] == titles
    assert any(text.startswith(f"{CANDIDATE}: ") and "margin" in text for text in titles)
    assert all(0 < float(one["cx"]) < 504.1 and float(one["cy"]) > 0 for one in stops)


def test_the_answers_are_in_the_page(folder, page):
    """The documents behind the report are in it, whole, by verb."""
    text = (folder / "report.html").read_text(encoding="utf-8")
    found = re.search(r'id="separatrix-answers">(.*?)</script>', text, re.DOTALL)
    kept = {verb: json.loads((folder / f"{verb}.json").read_text()) for verb in json.loads(found[1])}
    assert [*kept] == ["bearing", "traction", "restitution", "rank"]
    assert json.loads(found[1]) == kept
    assert not set(found[1]) & set("<>&")


@pytest.mark.parametrize(("old", "new", "taken"), [("x", "x", True), ("50 N", "60 N", False)])
def test_only_complete_answers_to_the_same_inputs_are_taken(folder, old, new, taken):
    """Another load, and a ranking that was interrupted, are computed again."""
    Path("hostile.toml").write_text((folder.parent / "hostile.toml").read_text().replace(old, new))
    study, rank = read_study("hostile.toml"), read_document(folder / "rank.json", "rank")
    assert answers(Kept(rank), study) is taken
    assert not answers(Kept(rank | {"complete": False}), study)


def test_json_is_one_document_with_the_verdicts_of_rank(folder, found):
    """The report as plain data, with the verdicts under the names of `rank`, and where its files are."""
    rank = json.loads((folder / "rank.json").read_text())
    assert (found["verb"], found["environment"]) == ("report", "vacuum")
    assert found["files"] == [str(folder / "report.html"), str(folder / "report.pdf")]
    assert [one["verdict"] for one in found["materials"]] == [
        one["verdict"] for one in rank["environments"][0]["materials"]
    ]
    assert [one["title"] for one in found["report"]["sections"] if one["level"] == 2] == SECTIONS


def test_a_folder_that_lacks_answers_says_how_to_get_them(folder, tmp_path, capsys):
    """What is missing is named with its command; without a dataset there is no picture of it."""
    (tmp_path / "d").mkdir()
    kept = json.loads((folder / "bearing.json").read_text())
    del kept["provenance"]
    (tmp_path / "d" / "bearing.json").write_text(json.dumps(kept))
    found = document(capsys, "report", str(tmp_path / "d"))
    text = json.dumps(found)
    assert (found["materials"], found["files"], [*Path().iterdir()]) == ([], [], [])
    assert "run `separatrix traction hostile` into it" in text
    assert "neither `rank` nor `stability` was computed" in text


def test_an_edited_answer_is_refused(folder, capsys):
    """A document that lacks what a section shows is refused in one line."""
    Path("d").mkdir()
    rank = json.loads((folder / "rank.json").read_text())
    del rank["pocket"]["slip_speed"], rank["provenance"]
    Path("d", "rank.json").write_text(json.dumps(rank))
    assert "contains an incomplete answer; got KeyError('slip_speed')" in refused(capsys, "report", "d")


def test_the_chain_that_a_folder_lacks_is_computed(folder, monkeypatch, capsys):
    """The study is read again from the files of an answer; one verb is refused here, one computed."""

    def refuse(study):
        raise InputError("[film]", f"of {study.name} is too thin")

    Path("d").mkdir()
    shutil.copy(folder / "bearing.json", "d")
    monkeypatch.setattr("separatrix.verbs.traction.compute", refuse)
    found = document(capsys, "report", "d")
    assert found["answers"] == ["bearing", "restitution"]
    assert "`traction` was not computed: [film] of hostile is too thin" in json.dumps(found)
    assert [one.name for one in Path("d").iterdir()] == ["bearing.json"]


def test_answers_of_other_inputs_are_named(folder, tmp_path, capsys):
    """An answer that was computed from another study is marked on the first page."""
    for verb in ("bearing", "rank"):
        shutil.copy(folder / f"{verb}.json", tmp_path)
    changed = json.loads((tmp_path / "bearing.json").read_text())
    changed["study"]["operation"]["axial_load"]["value"] = 60.0
    (tmp_path / "bearing.json").write_text(json.dumps(changed))
    first = document(capsys, "report", str(tmp_path))["report"]["sections"][0]["blocks"]
    caveats = [one["paragraph"] for one in first if one.get("kind") == "caveat"]
    assert caveats[0] == (
        "`bearing` was computed from other inputs than `rank`: operation.axial_load differ."
    )


def test_a_study_without_a_cage_has_what_could_be_computed(monkeypatch, capsys):
    """No verdict, and why; a verb that is refused is a caveat; sections on the cage are left out."""

    def refuse(study):
        raise InputError("[film]", "is too thin")

    monkeypatch.setattr("separatrix.verbs.traction.compute", refuse)
    Path("bare.toml").write_text(STUDY)
    found = document(capsys, "report", "bare.toml")
    assert found["answers"] == ["bearing"]
    assert found["summary"][0] == "The study has no [cage]: there is no verdict on its stability."
    assert "`traction` was not computed: [film] is too thin" in json.dumps(found)
    titles = [one["title"] for one in found["report"]["sections"]]
    assert "Evidence of the verdicts" not in titles
    assert "Restitution" not in titles


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("rank.json", "{", "is not the document of an answer: no valid JSON"),
        ("rank.json", '{"verb": "bearing", "study": {}}', "is not a document of `rank`"),
        ("rank.json", '{"verb": "rank", "study": {"bearing": {}}}', "lacks separatrix_version"),
        ("notes.txt", "", "contains no answer of separatrix"),
    ],
)
def test_a_folder_of_something_else_is_refused(name, text, words, capsys):
    """One line, and nothing is written."""
    Path("d").mkdir()
    Path("d", name).write_text(text)
    assert words in refused(capsys, "report", "d")
    assert [one.name for one in Path("d").iterdir()] == [name]


def test_a_pdf_needs_its_extra_and_a_folder(monkeypatch, capsys):
    """Refused before anything is computed."""
    assert "needs a folder with --json" in refused(capsys, "report", "le7", "--pdf", "--json")
    monkeypatch.setitem(sys.modules, "typst", None)
    assert 'pip install "separatrix[pdf]"' in refused(capsys, "report", "le7", "--pdf")


def test_two_designs_are_reported_side_by_side(folder, tmp_path, capsys):
    """The input and the verdict that were changed come first; HTML and PDF are written, names are text."""
    other = tmp_path / "other"
    shutil.copytree(folder, other)
    changed = json.loads((other / "rank.json").read_text())
    changed["study"]["cage"]["mass"]["value"] *= 2.0
    changed["overall"][0]["verdict"] = "CHANGED"
    (other / "rank.json").write_text(json.dumps(changed))
    found = document(capsys, "report", str(folder), str(other), "--pdf", "--out", "two", "--quiet")
    assert found["summary"][:2] == ["1 input differs.", "1 verdict changed, of 8 that both have."]
    tables = {
        block["table"]: block["rows"]
        for one in found["report"]["sections"]
        for block in one["blocks"]
        if "table" in block
    }
    assert tables["Keys of the study, then options."] == [["cage.mass", "2 g", "4 g"]]
    assert {path.name for path in Path("two").iterdir()} == {"report.html", "report.pdf"}
    page = Page(Path("two/report.html").read_text())
    assert not [one for one in page.of("img") if (one["src"] or "").startswith("http")]
    assert any(CANDIDATE in text for text in page.text_of("td", "th"))


def test_answers_of_different_verbs_are_not_reported_together(folder, tmp_path, capsys):
    """Nothing is written."""
    shutil.copy(folder / "bearing.json", tmp_path / "bearing.json")
    shutil.copy(folder / "rank.json", tmp_path / "rank.json")
    assert "must be an answer of" in refused(
        capsys, "report", str(tmp_path / "bearing.json"), str(tmp_path / "rank.json")
    )
