"""An answer in the page says when its study was changed after it, and what differs."""

import hashlib
import json
import time

import pytest
from fastapi.testclient import TestClient
from test_cli_answers import SMALL

from separatrix.app import outdated, server
from separatrix.app.worker import Task, _answered
from separatrix.study_file import read_study

CURVE = {"cage.mass": 0.05}
MARK = hashlib.sha256(json.dumps(CURVE).encode()).hexdigest()[:12]
FRICTIONS = """[[test]]
material = "PEEK"
counterface = "440C"
medium = "air"
friction = 0.2
standard_deviation = 0.02
"""


def silent(*_, **__):
    """Stand for what reports to the page, or reads for it."""


def answer(root, verb, place="", values=None, **question):
    """Answer a verb as the worker does, without its pictures."""
    given = {"question": question, "values": values or {}}
    folder = root / "small" / place
    task = Task(number=1, verb=verb, study=root / "small.toml", folder=folder, root=root, **given)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("separatrix.figures.save_all", lambda *_: None)
        assert _answered(task, silent)[0] == "finished"


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    """A folder with a study, its curve, and the curve of a heavier cage, all up to date."""
    root = tmp_path_factory.mktemp("studies")
    (root / "small.toml").write_text(SMALL)
    answer(root, "bearing")
    answer(root, "stability", motion="plane")
    answer(root, "stability", f"explored/{MARK}", CURVE)
    return root


@pytest.fixture
def page(answered):
    """The page of that folder; the study is afterwards as it was."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(server, "made_ready", silent)  # it reads every dataset, which each test would wait for
        with TestClient(server.application(answered)) as client:
            yield client
    (answered / "small.toml").write_text(SMALL)


def save(page, text):
    """Save another text of the study."""
    (page.app.state.root / "small.toml").write_text(text)


@pytest.mark.parametrize("place", ["/", "/answer/bearing/small.toml", "/answer/stability/small.toml"])
def test_an_answer_is_marked_after_its_study_was_changed(page, place):
    """It names what differs and the cure; a comment, a title or another unit of a number is not a change."""
    assert "outdated" not in page.get(place).text
    save(page, "# a comment\n" + SMALL.replace("A small", "The small").replace('"4 ms"', '"0.004 s"'))
    assert "outdated" not in page.get(place).text
    save(page, SMALL.replace("[cage]", '[cage]\nmass = "26 g"'))
    words = "The study was changed after this answer: cage.mass. Run it again."
    found = page.get(place).text
    assert ("outdated" in found, words in found) == (True, True)
    save(page, SMALL)
    assert "outdated" not in page.get(place).text


def test_every_view_of_an_outdated_answer_says_so(page):
    """Beside "Last answer", at the moving cage, between compared studies, and at the report."""
    root = page.app.state.root
    answer(root, "simulate", motion="plane")
    (root / "small" / "report.html").write_text("written after its answers")
    views = ("/study/small.toml", "/cage/small.toml", "/report/small.toml")
    views = (*views, "/compare?first=small.toml&second=small.toml&verb=stability")
    words = ("outdated", "Run it again", "Make the report again", "The study was changed")
    for view in views:
        found = page.get(view)
        assert (view, found.status_code, [w for w in words if w in found.text]) == (view, 200, [])
    save(page, SMALL.replace("[cage]", '[cage]\nmass = "26 g"'))
    assert page.get(views[0]).text.count(">outdated<") == 3
    for view in views[1:]:
        assert "The study was changed after this answer: cage.mass. Run it again." in page.get(view).text
    save(page, SMALL)
    answer(root, "bearing")
    assert "Newer than this report: bearing. Make the report again." in page.get("/report/small.toml").text
    (root / "small" / "report.html").unlink()


def test_a_change_in_a_file_that_the_study_names_is_seen(page):
    """Also one of which no single number is compared: the section is named then."""
    root = page.app.state.root
    (root / "tests.toml").write_text(FRICTIONS)
    text = SMALL.partition("[ranking]")[0] + '[ranking]\nfriction = "tests.toml"\n'
    save(page, text)
    answer(root, "bearing")
    assert page.app.state.page.outdated("small.toml", root / "small", "bearing") == ""
    (root / "tests.toml").write_text(FRICTIONS.replace("0.02", "0.03"))
    assert "[ranking]" in page.app.state.page.outdated("small.toml", root / "small", "bearing")
    save(page, SMALL)
    answer(root, "bearing")


def test_sliders_do_not_claim_an_outdated_curve(page):
    """Neither the study's own nor a refined one; without a moved slider none is to be computed."""
    fresh = page.get("/explored/small.toml").json()
    assert (fresh["is_refined"], fresh["is_outdated"], fresh["is_to_refine"]) == (True, False, False)
    fresh = page.get("/explored/small.toml", params=CURVE).json()
    assert (fresh["is_refined"], fresh["is_outdated"], fresh["is_to_refine"]) == (True, False, False)
    save(page, SMALL.replace("[cage]", '[cage]\nland_clearance = "0.5 mm"'))
    found = page.get("/explored/small.toml").json()
    assert (found["is_refined"], found["is_outdated"], found["is_to_refine"]) == (False, True, False)
    assert "cage.land_clearance" in found["outdated"]
    found = page.get("/explored/small.toml", params=CURVE).json()
    assert (found["is_refined"], found["is_outdated"], found["is_to_refine"]) == (False, True, True)


@pytest.mark.parametrize("text", [SMALL + "title =", SMALL.replace("[cage]", '[cage]\nmass = "25 mm"')])
@pytest.mark.parametrize("place", ["/", "/answer/bearing/small.toml"])
def test_a_study_that_cannot_be_read_breaks_no_page(page, place, text):
    """The answer is shown, with what is wrong with its study."""
    save(page, text)
    found = page.get(place)
    assert (found.status_code, "The study cannot be read" in found.text) == (200, True)
    assert "may be outdated: small.toml" in found.text
    assert page.get("/explore/small.toml").status_code == 422
    assert page.get("/explored/small.toml").status_code == 422


def test_an_answer_of_another_version_or_program_is_marked(page):
    """The version is named; what is not a document of separatrix differs in everything."""
    path = page.app.state.root / "small" / "bearing.json"
    kept = path.read_text()
    try:
        path.write_text(json.dumps(json.loads(kept) | {"separatrix_version": "0.0.1"}))
        assert "is of separatrix 0.0.1, not" in page.get("/answer/bearing/small.toml").text
        path.write_text(json.dumps({"title": "T", "study": 3, "provenance": [], "warnings": []}))
        assert "was changed after" in page.get("/answer/bearing/small.toml").text
        path.write_text("{")
        assert page.get("/").status_code == 200
    finally:
        path.write_text(kept)


def test_a_study_is_read_once_for_each_state(page, monkeypatch):
    """A second view stays fast."""
    page.get("/")
    time.sleep(0.02)
    monkeypatch.setattr(outdated, "read_study", lambda *_: 1 / 0)
    assert page.get("/").status_code == 200
    save(page, SMALL + "\n")
    with pytest.raises(ZeroDivisionError):
        page.get("/")
    monkeypatch.setattr(outdated, "read_study", read_study)


def test_the_page_ends_after_what_it_reads(answered, monkeypatch):
    """A thread that the interpreter ends while it reads a dataset would keep the lock of HDF5 for ever."""
    read = []

    def slow(_):
        time.sleep(0.5)  # longer than the page is open
        read.append(True)

    monkeypatch.setattr(server, "made_ready", slow)
    with TestClient(server.application(answered)):
        pass
    assert read == [True]
