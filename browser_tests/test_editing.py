"""A study is opened, edited as form and as text, refused beside the field, and edited in two tabs."""

import json
import re
import time

import pytest
from playwright.sync_api import expect

from conftest import ended, opened

THICKNESS = "#f-film-thickness"


def _has(text: str) -> re.Pattern[str]:
    return re.compile(re.escape(text))


def test_a_new_study_is_made_and_opened(view, folder):
    """A name and a shipped example make a file beside the others."""
    page = view()
    page.get_by_label("Name").fill("mine")
    page.get_by_role("button", name="Make it").click()
    page.wait_for_url("**/study/mine.toml")
    assert (folder / "mine.toml").is_file()


def test_a_wrong_unit_is_refused_beside_its_field_and_the_text_follows(view, server):
    """Form to text and text to form; a comment in the file stays."""
    page = view()
    page.get_by_role("link", name="small.toml").click()
    page.fill(THICKNESS, "0.5 kg")
    page.keyboard.press("Tab")
    expect(page.locator("#f-film-thickness-more .bad")).to_contain_text("needs a unit of length")
    assert page.input_value(THICKNESS) == "0.5 kg"
    expect(page.locator(".over .wrong")).to_contain_text("needs a unit of length")
    page.fill(THICKNESS, "0.7 um")
    page.keyboard.press("Enter")
    expect(page.locator("#f-film-thickness-more .bad")).to_have_count(0)
    expect(page.locator("#text")).to_have_value(_has('thickness = "0.7 um" # ours'))
    page.fill("#text", page.input_value("#text").replace("0.7 um", "800 nm"))
    expect(page.locator(THICKNESS)).to_have_value("800 nm")
    page.get_by_role("button", name="Discard the edits").click()
    expect(page.locator(THICKNESS)).to_have_value("0.5 um")


def test_fields_filled_in_quickly_are_all_kept(view, server):
    """An edit that is sent while another one is under way is not lost, nor what is being typed."""
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    edits = {"cage-mass": "26 g", "cage-pocket_clearance": "0.5 mm", "film-race_friction": "0.2"}
    for field, value in edits.items():
        page.evaluate(
            "([id, value]) => { const one = document.getElementById(id); one.value = value;"
            " one.dispatchEvent(new Event('change', { bubbles: true })); }",
            [f"f-{field}", value],
        )
    page.fill("#f-cage-land_clearance", "0.9 mm")
    expect(page.locator("#text")).to_have_value(_has("race_friction = 0.2"))
    text = page.input_value("#text")
    assert 'mass = "26 g"' in text
    assert 'pocket_clearance = "0.5 mm"' in text
    assert page.input_value("#f-cage-land_clearance") == "0.9 mm"
    page.keyboard.press("Enter")
    expect(page.locator("#text")).to_have_value(_has('land_clearance = "0.9 mm"'))
    page.get_by_role("button", name="Discard the edits").click()
    expect(page.locator("#text")).not_to_have_value(_has("land_clearance"))


def test_the_second_of_two_tabs_learns_of_the_first(view, server):
    """Its edit is not taken over that of the other; both show the same text then."""
    one, two = view(), view()
    for page in (one, two):
        page.goto(f"{server.address}/study/small.toml")
    one.fill(THICKNESS, "0.6 um")
    one.keyboard.press("Enter")
    expect(one.locator("#text")).to_have_value(_has('"0.6 um"'))
    two.fill(THICKNESS, "0.9 um")
    two.keyboard.press("Enter")
    refused = two.get_by_role("alert").filter(has_text="Another tab changed this study")
    expect(refused).to_be_visible()
    two.wait_for_load_state(
        "networkidle"
    )  # Enter changes and submits: the second must not wipe out the words
    expect(refused).to_be_visible()
    expect(two.locator(THICKNESS)).to_have_value("0.6 um")
    two.get_by_role("button", name="Discard the edits").click()
    expect(two.locator(THICKNESS)).to_have_value("0.5 um")


@pytest.mark.parametrize("button", ["Run simulate", "Make the report"])
def test_what_is_computed_is_what_was_typed(view, server, folder, button):
    """Also by who clicks right after typing, while the edit is slow to arrive: the run waits for it."""
    (folder / "typed.toml").write_text((folder / "small.toml").read_text().partition("[ranking]")[0])
    page = view()
    page.goto(f"{server.address}/study/typed.toml")
    page.route("**/edit/**", lambda route: (time.sleep(0.5), route.continue_()))
    if button.startswith("Run"):
        opened(page, "simulate")
    page.fill(THICKNESS, "0.65 um")
    page.get_by_role("button", name=button, exact=True).click()
    ended(page, button.split()[-1])
    verb = "simulate" if button.startswith("Run") else "bearing"
    answer = json.loads((folder / "typed" / f"{verb}.json").read_text(encoding="utf-8"))
    assert answer["study"]["film"]["thickness"]["value"] == pytest.approx(0.65e-6, rel=1e-12)


def test_the_keyboard_reaches_fields_and_buttons(view, server):
    """Tab goes from the link that skips the header to buttons and fields, in the order of the page."""
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    seen = []
    for _ in range(60):
        page.keyboard.press("Tab")
        seen.append(page.evaluate("document.activeElement.id || document.activeElement.innerText.trim()"))
    wanted = ["Skip to the content", "bearing", "Make the report", "text", "f--title"]
    places = [seen.index(one) for one in wanted]
    assert places == sorted(places), seen
