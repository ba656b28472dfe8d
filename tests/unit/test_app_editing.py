"""A study in the page: text and form are one, drafts outlive the server, faults are beside their keys."""

import json
import re
import shutil
import tomllib
from pathlib import Path

import pytest
from commands import SMALL, root_of
from fastapi.testclient import TestClient

from separatrix import InputError, Study, shipped_studies, template
from separatrix.front.page import editing as draft
from separatrix.front.page.folder import Folder
from separatrix.front.page.server import application
from separatrix.front.page.worker import Job, answered
from separatrix.ground.schema import is_record, keys_of
from separatrix.verdict.long_jobs import NAME

COMMENTED = """# a study
title = "One"   # its name

[cage]
mass = "25 g"              # weighed
guidance = "outer"
"""


def version(text):
    """Version of the study that a form was drawn from."""
    return re.search('name="version" value="([0-9a-f]+)"', text)[1]


def edit(page, **fields):
    """Change a key of small.toml, as the form of a fresh page does."""
    fields = {"version": version(page.get("/study/small.toml").text), **fields}
    return page.post("/edit/small.toml", data=fields)


def text_of(page):
    """Text of small.toml, with its unsaved edits."""
    return draft.current(root_of(page) / "small.toml").read_text()


@pytest.mark.parametrize(
    ("section", "key", "value", "expected"),
    [
        ("cage", "mass", "30 g", 'mass = "30 g"              # weighed'),
        ("cage", "mass", "", None),
        ("cage", "land_friction", "0.2", "land_friction = 0.2"),
        ("cage", "pocket_angles", '["0 deg", "30 deg"]', 'pocket_angles = ["0 deg", "30 deg"]'),
        ("bearing", "ball_count", "13", "[bearing]\nball_count = 13"),
        ("film", "thickness", "0.5 um +- 20 %", 'thickness = "0.5 um +- 20 %"'),
        ("", "title", 'Two "quoted"', 'title = "Two \\"quoted\\""   # its name'),
    ],
)
def test_one_key_is_changed_and_the_rest_stays(section, key, value, expected):
    """Comments, order and all other lines are those of before."""
    text = draft.edited(COMMENTED, section, key, value)
    others = [line for line in COMMENTED.splitlines() if not line.startswith(f"{key} =")]
    assert [line for line in text.splitlines() if line in others][: len(others)] == others
    assert expected is None or expected in text
    assert (key in tomllib.loads(text).get(section, tomllib.loads(text))) == (expected is not None)


def test_text_that_is_not_toml_is_mended_as_text():
    """A form cannot change what it cannot read."""
    with pytest.raises(InputError, match="Mend it in the text first"):
        draft.edited("title = ", "cage", "mass", "1 g")


@pytest.mark.parametrize("study", ["template", *shipped_studies()])
def test_a_form_sent_back_unchanged_changes_no_value(study):
    """The text of every field makes the same study again."""
    text = template() if study == "template" else shipped_studies()[study].read_text()
    again = text
    for section in draft.form(draft.Checked(text=text)):
        for key in section.keys:
            if value := draft.as_typed(section.given.get(key.name)):
                again = draft.edited(again, section.name, key.name, value)
    assert tomllib.loads(again) == tomllib.loads(text)


def test_the_form_has_every_key_of_the_records():
    """What a study file may hold can be typed in; candidates of the user's own are written in the text."""
    drawn = draft.form(draft.Checked(text=""))
    shown = {f"{section.name}.{key.name}" for section in drawn for key in section.keys}
    forms = {name: one.key.form or one.hint for name, one in keys_of(Study).items()}
    known = {f"{name}.{key}" for name, form in forms.items() if is_record(form) for key in keys_of(form)}
    assert shown == (known | {".title", ".extends", ".library"}) - {"ranking.candidates"}


def test_a_fault_of_the_base_has_no_line_here(page):
    """Its message names the file; a fault of its own has its line."""
    (root_of(page) / "base.toml").write_text(COMMENTED.replace("25 g", "25 mm"))
    text = 'extends = "base.toml"\n[cage]\nguidance = "none of these"\n'
    (root_of(page) / "variant.toml").write_text(text)
    faults = draft.check(root_of(page) / "variant.toml", root_of(page)).faults
    found = {one.key: (one.line, one.section) for one in faults if one.section == "cage"}
    assert (found["mass"], found["guidance"]) == ((0, "cage"), (3, "cage"))


def test_an_older_tab_changes_nothing(page):
    """What another tab saved meanwhile is shown instead."""
    old = version(page.get("/study/small.toml").text)
    edit(page, field="cage.mass", value="26 g")
    found = page.post("/edit/small.toml", data={"version": old, "field": "cage.mass", "value": "99 g"}).text
    assert "Another tab changed this study" in found
    assert "99 g" not in text_of(page)


def test_a_draft_outlives_the_server_and_is_saved_or_discarded(page):
    """It is a hidden file beside the study."""
    edit(page, field="cage.mass", value="26 g")
    with TestClient(application(root_of(page))) as other:
        assert "mass = &#34;26 g&#34;" in other.get("/study/small.toml").text
        assert "unsaved edits" in other.get("/").text
        other.post("/discard/small.toml")
    assert (root_of(page) / "small.toml").read_text() == SMALL
    edit(page, field="cage.mass", value="27 g")
    page.post("/save/small.toml")
    assert 'mass = "27 g"' in (root_of(page) / "small.toml").read_text()
    assert not draft.draft_path(root_of(page) / "small.toml").exists()


def test_a_server_that_is_killed_while_it_writes_leaves_the_draft_before(tmp_path, monkeypatch):
    """A draft takes its place when it is whole."""
    study = tmp_path / "small.toml"
    study.write_text(SMALL)
    draft.keep(study, f"{SMALL}# first\n")

    def half(path, text, **options):
        path.write_bytes(text.encode()[:20])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_text", half)
    with pytest.raises(KeyboardInterrupt):
        draft.keep(study, f"{SMALL}# second\n")
    assert draft.current(study).read_text() == f"{SMALL}# first\n"
    assert {one.name for one in tmp_path.iterdir()} == {"small.toml", ".small.toml.draft"}


def test_a_study_with_a_fault_is_not_run(page):
    """Nor is its fault written into the file."""
    edit(page, field="cage.mass", value="25 mm")
    found = page.post("/run/small.toml", data={"verb": "rank"}, headers={"HX-Request": "true"})
    assert (found.status_code, "is not run" in found.text) == (422, True)
    assert (root_of(page) / "small.toml").read_text() == SMALL


def test_each_fault_has_its_line(page):
    """Above the text, where the script finds it, and beside its field."""
    text = SMALL.replace("runs = 4", "runs = -4").replace("[cage]", "[cage]\ncolour = 3")
    lines = text.splitlines()
    found = edit(page, text=text).text
    at = dict(re.findall(r'<li class="bad" data-line="(\d+)" data-short="([^"]*)"', found))
    assert set(at) == {str(lines.index(one) + 1) for one in ("runs = -4", "colour = 3")}
    assert "must be a whole number from 1 to 1000000; got -4." in at.values()
    assert 'data-line="2"' in edit(page, text='title = "a"\n[film\n').text


def test_inherited_values_are_shown(page):
    """A study that extends another shows the other's values, and what a verb lacks."""
    assert "Inherited: 11.1125 mm" in page.get("/study/small.toml").text
    (root_of(page) / "cageless.toml").write_text('extends = "ball-218"\n')
    assert "Needs the section [cage], which this study lacks." in page.get("/study/cageless.toml").text


def test_a_list_with_comments_is_changed_in_the_text():
    """The form would lose them; a list without any is replaced, and the comment behind it stays."""
    text = '[ranking]\nmaterials = [\n  "A", # a\n  "B",\n] # both\n'
    with pytest.raises(InputError, match="has comments in its list"):
        draft.edited(text, "ranking", "materials", '["B", "C"]')
    assert draft.edited(text, "ranking", "materials", '["A", "B"]') == text
    found = draft.edited(text.replace(" # a", ""), "ranking", "materials", '["B", "C"]')
    assert found == '[ranking]\nmaterials = ["B", "C"] # both\n'
    # a comment is about what follows it: a new key is above that of the next section
    found = draft.edited('[cage]\nmass = "1 g"\n\n# worn\n[film]\n', "cage", "land_friction", "0.2")
    assert found == '[cage]\nmass = "1 g"\nland_friction = 0.2\n\n# worn\n[film]\n'


OWN = """[ranking]
environment = "air"
[[ranking.candidates]]
name = "Two"
friction = { air = 7 }
"""


def test_a_fault_of_a_candidate_is_above_the_fields_of_its_section(page):
    """A candidate has no field: it is written in the text. Its section is open."""
    found = edit(page, text=f'extends = "cryogenic-turbopump"\n{OWN}').text
    head = r'<details class="section" open>\s*<summary>ranking <'
    section = re.search(f"{head}.*?</details>", found, re.DOTALL)[0]
    assert section.count("must lie between 0 and 2") == 1


def test_a_text_that_the_form_cannot_change_stays(page):
    """One with a table of a candidate behind another section."""
    text = OWN.replace("friction = { air = 7 }", "[cage]\n[ranking.candidates.friction]\nair = 0.1")
    edit(page, text=text)
    found = edit(page, field="ranking.environment", value="vacuum").text
    assert "Mend it in the text first" in found
    assert text_of(page) == text


@pytest.mark.parametrize("name", ["../up", "a/b", ".hidden", "", "small", "x" * 200, "a\0b"])
def test_a_new_study_has_a_plain_name_that_is_free(page, name):
    """Nothing is written for another one."""
    before = sorted(root_of(page).iterdir())
    assert page.post("/new", data={"name": name}).status_code == 422
    assert sorted(root_of(page).iterdir()) == before


def test_a_new_study_is_a_copy_or_the_template(page):
    """And is open at once."""
    found = page.post("/new", data={"name": "mine", "base": "cryogenic-turbopump"})
    assert (found.status_code, found.url.path) == (200, "/study/mine.toml")
    page.post("/new", data={"name": "other"})
    assert (root_of(page) / "other.toml").read_text() == template()


ADDRESSES = {"GET /nowhere": 404, "GET /static/nothing.js": 404, "GET /edit/small.toml": 405}


@pytest.mark.parametrize(("asked", "status"), (ADDRESSES | {"POST /jobs/x/cancel": 404}).items())
def test_a_wrong_address_is_answered_with_a_page(page, asked, status):
    """A person reads a sentence and finds the way back."""
    found = page.request(*asked.split())
    assert (found.status_code, f"{asked} is not an address of this page." in found.text) == (status, True)
    assert "Back to the studies" in found.text


# A link out of the page's folder is answered like a missing file; nothing is written through it.

NEIGHBOUR = "the study of a neighbour"
ROW = {"rank": 1, "name": NEIGHBOUR, "verdict": "STABLE"}
ANSWER = {"title": NEIGHBOUR, "warnings": [], "overall": [ROW]}


@pytest.fixture
def outside(tmp_path):
    """A folder beside that of the page, with files as the page has them."""
    place = tmp_path / "outside"
    (place / "small").mkdir(parents=True)
    (place / "small" / "rank.json").write_text(json.dumps(ANSWER))
    for name in ("rank.txt", "report.html", "log.csv", "draft.toml"):
        (place / "small" / name).write_text(f"# {NEIGHBOUR}\n")
    return place / "small"


def before(folder):
    """Return the content of each file of a folder."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def linked(page, outside, how):
    """Make the answers a link, or each file in them."""
    place = root_of(page) / "small"
    if how == "folder":
        place.symlink_to(outside)
        return
    place.mkdir()
    for path in outside.iterdir():
        (place / path.name).symlink_to(path)


OF_THE_STUDY = ("study", "answer/rank", "files", "zip", "figure/rank/stability-curve")
PLACES = ("/", "/file/small/rank.json", *(f"/{one}/small.toml" for one in OF_THE_STUDY))


@pytest.mark.parametrize("how", ["folder", "files"])
@pytest.mark.parametrize("place", PLACES)
def test_answers_outside_are_not_shown(page, outside, how, place):
    """Neither in the list, nor in a page of their own; and the list does not fail over them."""
    missing = page.get(place)
    linked(page, outside, how)
    found = page.get(place)
    assert (found.status_code, found.content) == (missing.status_code, missing.content)


def test_a_study_beside_a_way_back_in_is_not_reached(page, outside):
    """A link outside that leads to a study inside has its draft and answers outside."""
    (outside / "back.toml").symlink_to(root_of(page) / "small.toml")
    (root_of(page) / "linked").symlink_to(outside)
    assert page.get("/study/linked/back.toml").status_code == 422


def test_a_draft_outside_is_neither_shown_nor_written(page, outside):
    """An edit takes the place of the link."""
    draft, kept = root_of(page) / ".small.toml.draft", before(outside)
    draft.symlink_to(outside / "draft.toml")
    found = page.get("/study/small.toml").text
    assert NEIGHBOUR not in found
    assert "unsaved edits" not in page.get("/").text
    page.post("/edit/small.toml", data={"version": version(found), "text": SMALL + "# mine\n"})
    assert before(outside) == kept
    assert "# mine" in draft.read_text()


@pytest.mark.parametrize("inside", ["", NAME])
def test_nothing_is_written_through_a_link(page, outside, inside):
    """Whether the folder of the answers or a file in it leads out: the job is refused first."""
    root, kept = root_of(page), before(outside)
    place = root / "small"
    if inside:
        place.mkdir()
    (place / inside).symlink_to(outside / "new" if inside else outside)
    job = Job(number=1, verb="bearing", name="small.toml")
    with pytest.raises(InputError, match="leads out of the folder of the studies"):
        answered(job, Folder(root=root), lambda **_: None)
    assert before(outside) == kept


def test_a_link_to_answers_inside_is_followed(page, outside):
    """Only what leads out is missing."""
    shutil.copytree(outside, root_of(page) / "other")
    (root_of(page) / "small").symlink_to(root_of(page) / "other")
    assert '/answer/rank/small.toml"' in page.get("/").text
