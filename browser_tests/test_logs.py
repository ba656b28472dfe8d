"""Logs of a tribometer: dropped, read, the cut of running-in moved, a friction file written."""

from __future__ import annotations

import numpy as np
import raw_logs
from playwright.sync_api import expect


def _log() -> bytes:
    time = np.linspace(0.0, 4000.0, 2000)
    scatter = np.random.default_rng(1).normal(0.0, 0.01, time.size)
    return raw_logs.anton_paar(0.12 + 0.15 * np.exp(-time / 300.0) + scatter, time)


DROP = """([name, bytes]) => {
  const carried = new DataTransfer(), place = document.getElementById("drop");
  carried.items.add(new File([new Uint8Array(bytes)], name));
  place.dispatchEvent(new DragEvent("drop", { dataTransfer: carried, bubbles: true, cancelable: true }));
}"""


def test_a_log_is_dropped_and_its_cut_moved(view, server, folder):
    """What was read is shown; a click in the figure and a text move the end of running-in."""
    page = view()
    page.get_by_role("link", name="Tribometer logs").click()
    page.evaluate(DROP, ["first.txt", list(_log())])
    expect(page.locator("#log pre.answer")).to_contain_text("first.txt")
    assert (folder / "logs" / "first.txt").read_bytes() == _log()
    found = page.locator(".test p").first
    before = found.inner_text()
    plot = page.locator(".test .canvas .nsewdrag").first
    plot.wait_for(state="attached")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    page.wait_for_timeout(300)
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    expect(found).not_to_have_text(before)
    expect(page.locator("#run-in")).not_to_have_value("")
    page.fill("#run-in", "100 m")
    page.keyboard.press("Enter")
    expect(page.locator(".test p").first).to_contain_text("ends at 100")
    page.fill("#run-in", "100 kg")
    page.keyboard.press("Enter")
    expect(page.locator("#message .refusal")).to_contain_text("100 kg")


AT_ONCE = """document.body.addEventListener("htmx:afterSwap", () => {
  const form = document.querySelector("#log form");
  form.elements.run_in.value = "100 m";
  form.requestSubmit();
}, { once: true })"""


def test_a_form_that_is_sent_as_soon_as_it_is_there_does_not_leave_the_page(view, server):
    """Before htmx has taken it up, which it does a moment after it has put it into the page."""
    page = view()
    page.goto(f"{server.address}/logs")
    page.evaluate(DROP, ["first.txt", list(_log())])
    expect(page.locator("#log pre.answer")).to_contain_text("first.txt")
    page.evaluate(AT_ONCE)
    page.get_by_role("button", name="first.txt").click()
    expect(page.locator(".test p").first).to_contain_text("ends at 100")
    assert page.url == f"{server.address}/logs"


def test_a_friction_file_is_written_or_refused(view, server, folder):
    """Logs that do not state their materials are refused with the cure; no file is written."""
    page = view()
    page.goto(f"{server.address}/logs")
    page.evaluate(DROP, ["first.txt", list(_log())])
    page.get_by_role("button", name="Write").click()
    expect(page.locator("#message")).to_contain_text("first.txt does not state: material")
    assert not (folder / "friction.toml").exists()
    for label, value in (("material", "PEEK"), ("counterface", "440C"), ("medium", "liquid nitrogen")):
        page.get_by_label(label, exact=True).fill(value)
    page.get_by_role("button", name="Write").click()
    expect(page.locator("#message .good")).to_contain_text("friction.toml is written")
    assert "PEEK" in (folder / "friction.toml").read_text(encoding="utf-8")
