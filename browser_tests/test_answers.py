"""Jobs and answers: progress, cancel and resume, figures to hover over, files."""

from __future__ import annotations

import json

import pytest
from conftest import PATIENCE, Server, ended, run
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
    """The tooltips of curve and candidates have the numbers of the answer."""
    page = view()
    page.goto(f"{server.address}/answer/rank/small.toml")
    answer = json.loads((ranked / "rank.json").read_text(encoding="utf-8"))
    expect(page.locator("table")).to_contain_text(answer["overall"][0]["name"])
    curve, candidates = page.locator(".plot .canvas").nth(0), page.locator(".plot .canvas").nth(1)
    for figure, words in ((curve, "Armalon"), (candidates, "Armalon")):
        figure.locator(".points path.point").first.wait_for(state="attached")
        figure.scroll_into_view_if_needed()
        figure.locator(".points path.point").last.hover(force=True)
        expect(figure.locator(".hoverlayer")).to_contain_text(words)
        assert any(sign.isdigit() for sign in figure.locator(".hoverlayer").text_content())


def test_a_duty_cycle_is_run_and_its_envelope_pointed_at(view, server, ranked, folder):
    """The table is picked from those beside the study; a case of each panel shows its numbers."""
    rows = ("operation.inner_speed,time_share", "9000 rpm,1 h", "12000 rpm,2 h", "15000 rpm,1 h")
    (folder / "duty.csv").write_text("\n".join(rows), encoding="utf-8")
    page = view()
    page.goto(f"{server.address}/study/small.toml")
    page.get_by_text("More computations").click()
    card = page.locator(".verb", has=page.get_by_role("heading", name="sweep", exact=True))
    card.get_by_text("Options").click()
    card.get_by_label("cases").select_option("duty.csv")
    card.get_by_label("margins").check()
    card.get_by_label("verdicts").check()
    run(page, "sweep")
    page.get_by_role("link", name="Show the answer").first.click()
    figure = page.locator(".plot.tall .canvas")
    figure.locator(".points path.point").first.wait_for(state="attached")
    assert "lowest margin" in figure.locator(".gtitle").text_content()
    figure.locator(".scatterlayer .points path.point").first.hover(force=True)
    expect(figure.locator(".hoverlayer")).to_contain_text("P(stable)")
    figure.locator(".barlayer path").nth(1).hover(force=True)
    expect(figure.locator(".hoverlayer")).to_contain_text("inner speed 12000 rpm: 50 % of the time")


def test_a_file_is_downloaded(view, server, ranked):
    """A file of an answer comes as it is on the disk."""
    page = view()
    page.goto(f"{server.address}/answer/rank/small.toml")
    with page.expect_download() as waiting:
        page.get_by_role("link", name="rank.xlsx").click()
    assert waiting.value.path().read_bytes() == (ranked / "rank.xlsx").read_bytes()


def test_a_job_is_cancelled_resumed_and_outlives_a_killed_server(view, folder, request):
    """Progress is shown; a cancel keeps what was finished; after a kill the same run goes on."""
    place = folder / "killed"
    place.mkdir()
    text = (folder / "small.toml").read_text(encoding="utf-8")
    text = text.replace("runs = 4", "runs = 16").replace(
        "[0.3, 0.6, 0.9]", "{ from = 0.2, to = 0.9, count = 40 }"
    )
    (place / "long.toml").write_text(text, encoding="utf-8")
    first = Server(place)
    request.addfinalizer(first.kill)
    page = view(link=first.link)
    page.goto(f"{first.address}/study/long.toml")
    page.get_by_role("button", name="Run stability", exact=True).click()
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
