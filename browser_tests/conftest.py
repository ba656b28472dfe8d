"""A browser on the page of a folder: a real server, a real Chromium, and what must hold of every view."""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from commands import SMALL
from playwright import sync_api as playwright_api

CHROMIUM = next((found for name in ("chromium", "chromium-browser") if (found := shutil.which(name))), None)
QUIET = ("background-networking", "component-update", "gpu", "quic", "sync")
ARGUMENTS = ["--no-sandbox", "--no-first-run", *(f"--disable-{name}" for name in QUIET)]
PATIENCE = 200_000
"""For what computes [ms]: a loaded machine is slow, and a new one may have to compile a kernel first."""

playwright_api.expect.set_options(timeout=60_000)  # what is expected comes at once where the machine is idle

STUDY = SMALL.replace("[cage]", '[film]\nthickness = "0.5 um" # ours\n\n[cage]')


class Server:
    """The real command on a folder; `link` opens its page."""

    def __init__(self, folder: Path) -> None:
        command = [sys.executable, "-m", "separatrix", "app", str(folder)]
        self.folder = folder
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
        lines = iter(self.process.stdout.readline, "")
        self.link = next(found[0] for line in lines if (found := re.search(r"http://\S+", line)))
        self.address = self.link.partition("/?")[0]

    def close(self) -> None:
        """End it as Ctrl-C does; with its process where that takes too long."""
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.stdout.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """A folder with one small study."""
    made = tmp_path_factory.mktemp("studies")
    (made / "small.toml").write_text(STUDY, encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def server(folder) -> Iterator[Server]:
    """The page of that folder."""
    made = Server(folder)
    yield made
    made.close()


@pytest.fixture(scope="session")
def browser():
    """Chromium of the system."""
    if CHROMIUM is None:
        pytest.fail("Chromium is not installed: apt-get install chromium")
    with playwright_api.sync_playwright() as tool:
        made = tool.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield made
        made.close()


@pytest.fixture
def view(browser, server):
    """Return a function that makes a tab; no request of it leaves the machine, and nothing is refused."""
    contexts, faults = [], list[str]()

    def tab(*, width: int = 1280, height: int = 800, dark: bool = False, link: str = server.link):
        size, scheme = {"width": width, "height": height}, "dark" if dark else "light"
        contexts.append(browser.new_context(viewport=size, color_scheme=scheme))
        made = contexts[-1].new_page()
        made.set_default_timeout(PATIENCE)
        made.on("request", lambda one: _note_host(one.url, faults))
        made.on("dialog", lambda one: one.accept())
        made.on("pageerror", lambda error: faults.append(str(error)))
        made.on("console", lambda one: _note_console(one, faults))
        made.goto(link)
        return made

    yield tab
    for context in contexts:
        context.close()
    assert faults == []


def _note_host(address: str, faults: list[str]) -> None:
    parts = urlsplit(address)
    if parts.scheme not in ("data", "blob") and parts.hostname != "127.0.0.1":
        faults.append(address)


def _note_console(one, faults: list[str]) -> None:
    if one.type == "error" and "422" not in one.text:  # a refusal of ours is an answer
        faults.append(one.text)


def run(page, verb: str) -> None:
    """Run a verb of the study that is open, and wait for its end."""
    opened(page, verb).get_by_role("button", name=f"Run {verb}", exact=True).click()
    ended(page, verb)


def opened(page, verb: str):
    """Open a verb of the study, and return its card."""
    card = page.locator(".verb", has=page.locator("summary", has_text=re.compile(rf"^{verb}\b")))
    if card.get_attribute("open") is None:
        card.locator("summary").click()
    return card


def ended(page, title: str, state: str = "finished") -> None:
    """Wait for the end of the newest job of a title."""
    job = page.locator(".job", has=page.get_by_role("heading", name=title)).first
    playwright_api.expect(job.locator(".tag")).to_have_text(state, timeout=PATIENCE)
