"""How soon the local page answers what needs no new run, in Chromium: a view, a figure.

Needs the extra `browser` and Chromium, as `make browser-test` does.
"""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
playwright_api = pytest.importorskip("playwright.sync_api", reason='needs the extra "browser"')

from browser_tests.conftest import ARGUMENTS, CHROMIUM, STUDY, Server  # noqa: E402

from separatrix.front import main  # noqa: E402

VERBS = (["rank"], ["map", "--points", "4", "--runs", "2"], ["simulate"])


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The page of a folder with a ranked, mapped and simulated study."""
    folder = tmp_path_factory.mktemp("studies")
    (folder / "small.toml").write_text(STUDY, encoding="utf-8")
    for verb, *options in VERBS:
        place = str(folder / "small")
        assert main([verb, str(folder / "small.toml"), "--out", place, "--quiet", *options]) == 0
    made = Server(folder)
    yield made
    made.close()


@pytest.fixture(scope="module")
def page(server):
    """A tab that has seen each figure once."""
    with playwright_api.sync_playwright() as tool:
        browser = tool.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        made = browser.new_page()
        made.goto(server.link)
        yield made
        browser.close()


def test_first_view(benchmark, page, server):
    """The list of studies, drawn."""
    benchmark(page.goto, server.address)


@pytest.mark.parametrize(
    "place",
    [
        *("study/small.toml", "answer/rank/small.toml", "view/simulate/moving-cage/small.toml"),
        *("figure/rank/rank-overview/small.toml", "figure/map/stability-map/small.toml"),
    ],
)
def test_what_needs_no_run(benchmark, page, server, place):
    """From request to answer."""
    assert benchmark(page.request.get, f"{server.address}/{place}").ok
