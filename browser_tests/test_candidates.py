"""A candidate of the user's own is added, refused beside its field, mended and removed, in the form alone."""

from __future__ import annotations

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect

OWN = """\
extends = "cryogenic-turbopump"

[ranking] # ours
environment = "liquid nitrogen, 440C"

# the black one
[[ranking.candidates]]
name = "First" # of March
friction = { "liquid nitrogen, 440C" = 0.1, "air, 440C" = 0.2 }

# the film
[film]
thickness = "0.5 um" # measured
"""
SECOND = "#f-candidates-1"


@pytest.fixture
def page(view, server, folder):
    """The page of a study with one candidate, without unsaved edits."""
    (folder / "own.toml").write_text(OWN, encoding="utf-8")
    (folder / ".own.toml.draft").unlink(missing_ok=True)
    page = view()
    page.goto(f"{server.address}/study/own.toml")
    return page


def text_has(page, text: str) -> None:
    """Wait until the text beside the form has a text."""
    expect(page.locator("#text")).to_have_value(re.compile(re.escape(text)))


def focused(page) -> str:
    """Id of what has the focus."""
    return page.evaluate("document.activeElement.id")


def test_a_candidate_is_added_refused_mended_and_removed(page):
    """By the keyboard; the focus follows, the text follows, every comment stays."""
    page.focus("#new-candidate")
    page.keyboard.type("My compound")
    page.keyboard.press("Enter")
    expect(page.get_by_role("group", name="Candidate 2: My compound")).to_contain_text("lacks: friction")
    assert (focused(page), page.input_value("#new-candidate")) == (f"{SECOND[1:]}-name", "")
    text_has(page, '[[ranking.candidates]]\nname = "My compound"\n\n# the film\n')
    group = page.get_by_role("group", name="Candidate 2: My compound")
    friction = group.get_by_role("group", name="liquid nitrogen, 440C").get_by_label("friction")
    friction.fill("7")
    page.keyboard.press("Tab")
    expect(page.locator(f"{SECOND}-friction-0-mean-more .bad")).to_contain_text("must lie between 0 and 2")
    assert friction.get_attribute("aria-invalid") == "true"
    assert focused(page) == f"{SECOND[1:]}-friction-0-standard_deviation"
    friction.fill("0.15")
    page.keyboard.press("Tab")
    page.keyboard.type("10 %")
    page.keyboard.press("Enter")
    expect(page.get_by_role("status").first).to_have_text("Every value is accepted.")
    text_has(page, 'friction = {"liquid nitrogen, 440C" = {mean = 0.15, standard_deviation = "10 %"}}\n')
    page.keyboard.press("Tab")
    for _ in range(40):
        if page.evaluate("document.activeElement.innerText") == "Remove this candidate":
            break
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.locator("#candidate-1")).to_have_count(0)
    expect(page.locator("#text")).to_have_value(OWN)
    assert focused(page) == "new-candidate"


def test_a_material_has_properties_with_units_or_a_name(page):
    """The one hides the other; another unit keeps the number."""
    page.get_by_text("Properties of a material").click()
    modulus = page.locator("#f-candidates-0-material-elastic_modulus")
    modulus.fill("5")
    page.keyboard.press("Tab")
    expect(page.locator("#candidate-0-properties")).to_contain_text("lacks: poisson_ratio")
    expect(page.locator("#f-candidates-0-material")).to_have_count(0)
    page.locator("#f-candidates-0-material-poisson_ratio").fill("0.4")
    page.keyboard.press("Tab")
    text_has(page, 'material = {elastic_modulus = "5 GPa", poisson_ratio = 0.4}\n\n# the film\n')
    page.locator("#candidate-0").get_by_label("unit of elastic modulus").select_option("MPa")
    text_has(page, '"5 MPa"')
    for one in ("elastic_modulus", "poisson_ratio"):
        page.locator(f"#f-candidates-0-material-{one}").fill("")
        page.keyboard.press("Enter")
    expect(page.locator("#text")).to_have_value(OWN)
    page.locator("#f-candidates-0-material").fill("Armalon")
    page.keyboard.press("Enter")
    text_has(page, 'material = "Armalon"')
    expect(page.locator("#candidate-0-properties")).to_have_count(0)


def test_an_environment_is_added_to_every_candidate(page):
    """With the friction of one of them; both are needed."""
    group = page.get_by_role("group", name="Candidate 1: First")
    group.get_by_label("another environment").fill("lox, 440C")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.matches(':invalid')")
    group.get_by_label("friction in it").fill("0.3")
    page.keyboard.press("Enter")
    text_has(page, '"lox, 440C" = 0.3 }')
    page.fill("#new-candidate", "Second")
    page.get_by_role("button", name="Add it").click()
    expect(page.locator(f"{SECOND}-friction-2-mean")).to_have_value("")


def test_a_candidate_has_no_accessibility_fault(page):
    """With a refused friction, and the properties of its material open."""
    page.get_by_text("Properties of a material").click()
    page.fill("#f-candidates-0-friction-0-mean", "7")
    page.keyboard.press("Enter")
    expect(page.locator("#f-candidates-0-friction-0-mean-more .bad")).to_have_count(1)
    assert Axe().run(page).response["violations"] == []


def test_the_second_of_two_tabs_does_not_add(page, view, server):
    """Its candidate is not added to a text that it has not seen."""
    other = view()
    other.goto(f"{server.address}/study/own.toml")
    page.fill("#new-candidate", "Second")
    page.keyboard.press("Enter")
    text_has(page, '"Second"')
    other.fill("#new-candidate", "Third")
    other.keyboard.press("Enter")
    expect(other.locator("#editor").get_by_role("alert")).to_contain_text("Another tab changed this study")
    text_has(other, '"Second"')
    assert '"Third"' not in other.input_value("#text")


def test_materials_of_a_friction_table_are_ticked(view, server):
    """A tick is in the text at once, and two quick ones both are."""
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    boxes = page.get_by_role("group", name="materials")
    boxes.get_by_label("Meldin HTC 100").uncheck()
    boxes.get_by_label("Vespel SP 211").check()
    text_has(page, 'materials = ["Armalon", "Vespel SP 211"]')
    expect(boxes.get_by_label("Vespel SP 211")).to_be_checked()
    page.get_by_role("button", name="Discard the edits").click()
    expect(boxes.get_by_label("Meldin HTC 100")).to_be_checked()
    expect(boxes.get_by_label("Vespel SP 211")).not_to_be_checked()
