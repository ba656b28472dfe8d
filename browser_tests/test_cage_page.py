"""The moving cage: its page moving-cage.html, opened without a server, and the local page play it alike."""

import subprocess
import sys

import pytest
from playwright.sync_api import expect

from conftest import STUDY, opened, run

MOTIONS = ("plane", "space")


@pytest.fixture(scope="module", params=MOTIONS)
def written(request, tmp_path_factory):
    """The page of a short run."""
    place = tmp_path_factory.mktemp(request.param)
    moved = STUDY.replace("[cage]", f'[cage]\nmotion = "{request.param}"')
    (place / "small.toml").write_text(moved, encoding="utf-8")
    command = [sys.executable, "-m", "separatrix", "simulate", str(place / "small.toml")]
    subprocess.run([*command, "--out", str(place / "out"), "--quiet"], check=True)
    return place / "out" / "moving-cage.html"


def plays(page) -> None:
    """Play, turn, scrub, enlarge and zoom by buttons, keys and wheel: the picture follows each."""
    drawn, seen = "document.getElementById('scene').toDataURL()", []

    def changed() -> None:
        seen.append(page.evaluate(drawn))
        assert len(seen) < 2 or seen[-1] != seen[-2]

    expect(page.locator("#grown")).not_to_be_empty()
    changed()
    page.click("#play")
    expect(page.locator("#play")).to_have_text("Pause")
    expect(page.locator("#time")).not_to_have_value("0")
    page.click("#play")
    expect(page.locator("#play")).to_have_text("Play")
    changed()
    for key in ("ArrowLeft", "ArrowDown", "+", "-", ".", "0", ","):
        page.focus("#scene")
        page.keyboard.press(key)
        changed()
    page.focus("#time")
    page.keyboard.press("End")
    assert "ms" in page.get_attribute("#time", "aria-valuetext")
    changed()
    page.focus("#grow")
    page.keyboard.press("Home")
    changed()
    page.check("#fixed")
    page.hover("#scene")
    page.mouse.wheel(0, 200)
    page.mouse.down()
    page.mouse.move(400, 300)
    page.mouse.up()
    changed()
    page.focus("#scene")
    page.keyboard.press(" ")
    expect(page.locator("#play")).to_have_text("Pause")
    in_space = page.locator("#lean").is_visible()
    assert page.locator("#readings tr").count() == 5 + 2 * in_space


def test_its_own_page_plays_without_a_server(written, browser):
    """From the file, and without an error."""
    page, faults = browser.new_page(), []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda one: faults.append(one.text) if one.type == "error" else None)
    page.goto(written.as_uri())
    plays(page)
    assert page.inner_text("#title") == "A small ensemble"
    assert faults == []
    page.close()


@pytest.mark.parametrize("motion", MOTIONS)
def test_the_local_page_plays_it(view, server, motion):
    """From the answer of a run whose model was chosen in the form; no inline script is needed."""
    moved = f'extends = "small.toml"\n[cage]\nmotion = "{motion}"\n'
    (server.folder / f"{motion}.toml").write_text(moved, encoding="utf-8")
    page = view()
    page.goto(f"{server.address}/study/{motion}.toml")
    opened(page, "simulate").get_by_label("model").select_option("paper")
    run(page, "simulate")
    page.get_by_role("link", name="Show the answer").first.click()  # of the newest job
    page.get_by_role("link", name="The moving cage").click()
    plays(page)
