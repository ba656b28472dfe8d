"""The page of a run in space, simulation.html: opened from its file, without a server."""

from __future__ import annotations

import subprocess
import sys

import pytest
from conftest import STUDY


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The page of a short run."""
    place = tmp_path_factory.mktemp("space")
    (place / "small.toml").write_text(STUDY, encoding="utf-8")
    command = [sys.executable, "-m", "separatrix", "simulate", str(place / "small.toml")]
    subprocess.run([*command, "--motion", "space", "--out", str(place / "out"), "--quiet"], check=True)
    return place / "out" / "simulation.html"


def test_it_plays_by_buttons_keys_and_wheel(written, browser):
    """Without an error: time goes on, the views change, and the scene is drawn."""
    page, faults = browser.new_page(), []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda one: faults.append(one.text) if one.type == "error" else None)
    page.goto(written.as_uri())
    drawn = "document.getElementById('scene').toDataURL()"
    before = page.evaluate(drawn)
    page.click("#play")
    page.wait_for_function("Number(document.getElementById('time').value) > 0")
    page.click("#play")
    assert page.evaluate(drawn) != before
    page.focus("#scene")
    for key in ("ArrowLeft", "ArrowUp", "+", "-", ".", ",", " ", "0"):
        page.keyboard.press(key)
    page.check("#fixed")
    page.hover("#scene")
    page.mouse.wheel(0, 200)
    assert page.inner_text("#title") == "A small ensemble"
    assert page.locator("#numbers tr").count() > 3
    assert faults == []
    page.close()
