"""Jobs and answers: progress, cancel and resume, figures to hover over, files."""

from __future__ import annotations

import json

import pytest
from conftest import PATIENCE, Server, ended, opened, run
from playwright.sync_api import expect


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


def test_a_duty_cycle_is_run(view, server, ranked, folder):
    """The table is named, beside the study."""
    rows = ("operation.inner_speed,time_share", "9000 rpm,1 h", "12000 rpm,2 h", "15000 rpm,1 h")
    (folder / "duty.csv").write_text("\n".join(rows), encoding="utf-8")
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    card = opened(page, "sweep")
    card.get_by_label("cases").fill("duty.csv")
    card.get_by_label("margins").check()
    card.get_by_label("verdicts").check()
    run(page, "sweep")
    page.get_by_role("link", name="Show the answer").first.click()
    page.locator(".paper circle").first.wait_for(state="attached")


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


def test_a_file_is_downloaded(view, server, ranked):
    """A file of an answer comes as it is on the disk."""
    page = view()
    page.goto(f"{server.address}/files/small.toml")
    with page.expect_download() as waiting:
        page.get_by_role("link", name="rank.xlsx").click()
    assert waiting.value.path().read_bytes() == (ranked / "rank.xlsx").read_bytes()


def test_a_job_is_cancelled_resumed_and_outlives_a_killed_server(view, folder, request):
    """Progress is shown; a cancel keeps what was finished; after a kill the same run goes on."""
    place = folder / "killed"
    place.mkdir()
    text = (folder / "small.toml").read_text(encoding="utf-8")
    text = text.replace("runs = 4", "runs = 16").replace(
        "[0.3, 0.6, 0.9]", str([round(0.2 + 0.0175 * i, 4) for i in range(41)])
    )
    (place / "long.toml").write_text(text, encoding="utf-8")
    first = Server(place)
    request.addfinalizer(first.kill)
    page = view(link=first.link)
    page.goto(f"{first.address}/study/long.toml")
    opened(page, "stability").get_by_role("button", name="Run stability", exact=True).click()
    expect(page.locator(".job progress[value]")).to_be_attached(timeout=PATIENCE)
    expect(page.locator(".job progress")).not_to_have_attribute("value", "0.000", timeout=PATIENCE)
    page.get_by_role("button", name="Cancel stability").click()
    ended(page, "stability", "cancelled")
    page.get_by_role("button", name="Resume stability").click()
    bar = page.locator(".job.running progress[value]")
    expect(bar).to_be_attached(timeout=PATIENCE)
    expect(bar).not_to_have_attribute("value", "0.000", timeout=PATIENCE)
    page.close()
    first.kill()
    kept = (place / "long" / "finished-runs.sqlite").stat().st_size
    assert kept > 0
    second = Server(place)
    try:
        page = view(link=second.link)
        page.goto(f"{second.address}/study/long.toml")
        run(page, "stability")
        expect(page.locator(".job .said")).to_contain_text("runs were taken from an earlier job")
    finally:
        second.close()
