"""A link out of the page's folder is answered like a missing file; nothing is written through it."""

import json
import shutil

import pytest
from commands import SMALL, root_of

from separatrix.front.page.folder import Folder
from separatrix.front.page.worker import Job, answered
from separatrix.ground.errors import InputError
from separatrix.verdict.ledger import NAME

NEIGHBOUR = "the study of a neighbour"
ANSWER = {
    "title": NEIGHBOUR,
    "warnings": [],
    "overall": [{"rank": 1, "name": NEIGHBOUR, "verdict": "STABLE"}],
}


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


@pytest.mark.parametrize("how", ["folder", "files"])
@pytest.mark.parametrize(
    "place",
    [
        "/",
        "/study/small.toml",
        "/answer/rank/small.toml",
        "/files/small.toml",
        "/file/small/rank.json",
        "/zip/small.toml",
        "/figure/rank/stability-curve/small.toml",
    ],
)
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
    version = found.partition('name="version" value="')[2][:16]
    page.post("/edit/small.toml", data={"version": version, "text": SMALL + "# mine\n"})
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
