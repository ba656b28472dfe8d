"""Every view: no accessibility fault that matters, nothing wider than the screen, nothing under the jobs."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect

from conftest import PATIENCE, run

SIZES = {"light": {}, "dark": {"dark": True}, "tablet": {"width": 820, "height": 1180}}
GRAVE = ("serious", "critical")


@pytest.fixture(scope="module")
def views(folder, server, browser) -> list[str]:
    """Every view of a folder with all kinds of studies, one with answers."""
    studies = {
        "uncertain": 'extends = "small.toml"\ntitle = "<b>film</b>"\n[film]\nthickness = "0.5 um +- 20 %"\n',
        "refused": 'extends = "small.toml"\n[film]\nthickness = "0.5 kg"\n',
        "bare": "[bearing]\n",
        "own": 'extends = "cryogenic-turbopump"\n[[ranking.candidates]]\nname = "<b>mine</b>"\n'
        'material = { elastic_modulus = "5 GPa" }\nfriction = { air = 7, "lox, 440C" = 0.1 }\n',
        "tilting": 'extends = "small.toml"\n[cage]\nmotion = "space"\n',
    }
    for name, text in studies.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    page = browser.new_context().new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(server.link)
    page.goto(f"{server.address}/study/small.toml")
    run(page, "rank")
    run(page, "simulate")
    page.goto(f"{server.address}/study/tilting.toml")
    run(page, "simulate")
    page.goto(f"{server.address}/study/small.toml")
    run(page, "stability")
    page.context.close()
    own = ("study", "answer/rank", "answer/stability", "answer/simulate", "files")
    views = ["", *(f"{one}/small.toml" for one in own), *(f"study/{one}.toml" for one in studies)]
    return [*views, "answer/simulate/tilting.toml", "logs", "study/none.toml"]


@pytest.mark.parametrize("size", SIZES)
def test_no_view_has_a_grave_accessibility_fault(view, server, views, size):
    """Axe finds nothing serious or critical, and no view scrolls sideways as a whole."""
    page, axe, faults = view(**SIZES[size]), Axe(), {}
    for place in views:
        page.goto(f"{server.address}/{place}")
        page.wait_for_load_state("load")
        expect(page.locator("#jobs .job").first).to_be_attached()
        found = axe.run(page).response["violations"]
        grave = [f"{one['id']}: {one['nodes'][0]['html'][:150]}" for one in found if one["impact"] in GRAVE]
        wide = page.evaluate("document.documentElement.scrollWidth - innerWidth")
        if grave or wide > 0:
            faults[place] = (grave, wide)
    assert faults == {}


@pytest.mark.parametrize("size", ["light", "tablet"])
def test_jobs_hide_nothing(view, server, views, size):
    """The list of jobs is below the page, not over it: every button can be scrolled clear of it."""
    page = view(**SIZES[size])
    for place in views:
        page.goto(f"{server.address}/{place}")
        expect(page.locator("#jobs .job").first).to_be_attached()
        scroll, jobs = page.locator("#scroll").bounding_box(), page.locator("#jobs").bounding_box()
        assert scroll["y"] + scroll["height"] <= jobs["y"] + 1, place
