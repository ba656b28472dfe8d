"""Jobs and answers: progress, cancel and resume, figures to hover over, files."""

import json

import pytest
from playwright.sync_api import expect

from conftest import PATIENCE, ended, opened, run


@pytest.fixture(scope="module")
def ranked(folder, server, browser):
    """The small study with its ranking, as a person would make it."""
    page = browser.new_context().new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(server.link)
    page.goto(f"{server.address}/study/small.toml")
    run(page, "rank")
    page.context.close()
    return folder / "small"


def test_figures_show_numbers_under_the_pointer(view, server, ranked):
    """The tooltips have numbers; the tables those of the answer."""
    page = view()
    page.goto(f"{server.address}/answer/rank/small.toml")
    answer = json.loads((ranked / "rank.json").read_text(encoding="utf-8"))
    expect(page.locator("main")).to_contain_text(answer["overall"][0]["name"])
    figure = page.locator(".paper").first
    figure.scroll_into_view_if_needed()
    figure.locator("circle").last.hover(force=True)
    expect(page.locator("#tip")).to_contain_text("0.")


def test_a_click_in_a_map_simulates_the_cage_there(view, server, ranked, folder):
    """As a study of its own beside the first."""
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    card = opened(page, "map")
    card.get_by_label("x", exact=False).first.fill("film.thickness=0.4..0.8um:2")
    card.get_by_label("runs").fill("1")
    card.locator("input[name=points]").fill("2")
    run(page, "map")
    page.get_by_role("link", name="Show the answer").first.click()
    figure = page.locator(".paper").first
    figure.scroll_into_view_if_needed()
    figure.click(position={"x": 300, "y": 120})
    ended(page, "simulate")
    assert len([*folder.glob("small *.toml")]) == 1


def test_a_log_is_dropped_and_its_running_in_moved(view, server, tmp_path):
    """A click in its figure moves the end of running-in, and the page shows the new answer."""
    rows = "".join(f"{i / 10},{0.2 + 0.01 * (i % 7)}\n" for i in range(400))
    (tmp_path / "log.csv").write_text(f"time [s],friction [-]\n{rows}", encoding="utf-8")
    page = view()
    page.goto(f"{server.address}/logs")
    page.set_input_files("#pick", tmp_path / "log.csv")
    page.wait_for_url("**/log/log.csv")
    page.get_by_role("button", name="Reduce the log").click()
    figure = page.locator(".paper").first
    before = page.locator("article.answer").inner_text()
    figure.scroll_into_view_if_needed()
    figure.click(position={"x": 300, "y": 100})
    expect(page.locator("article.answer")).not_to_have_text(before)


def test_a_job_is_cancelled_and_resumed(view, folder, server):
    """Progress is shown; a cancel keeps what was finished, and the same run goes on from there."""
    text = (folder / "small.toml").read_text(encoding="utf-8").replace("runs = 4", "runs = 16")
    factors = str([round(0.2 + 0.0175 * i, 4) for i in range(41)])
    (folder / "long.toml").write_text(text.replace("[0.3, 0.6, 0.9]", factors), encoding="utf-8")
    page = view()
    page.goto(f"{server.address}/study/long.toml")
    opened(page, "stability").get_by_role("button", name="Run stability", exact=True).click()
    expect(page.locator(".job progress[value]")).to_be_attached(timeout=PATIENCE)
    expect(page.locator(".job progress")).not_to_have_attribute("value", "0.000", timeout=PATIENCE)
    page.get_by_role("button", name="Cancel stability").click()
    ended(page, "stability", "cancelled")
    assert (folder / "long" / "finished-runs.sqlite").stat().st_size > 0
    page.get_by_role("button", name="Resume stability").click()
    ended(page, "stability")
    expect(page.locator(".job .said").first).to_contain_text("runs were taken from an earlier job")
