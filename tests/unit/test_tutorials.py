"""The tutorials, followed as a reader would: what the program prints is what the page shows."""

import re
import runpy
import shlex
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from separatrix.front import main

FOLDER = Path(__file__).parents[2] / "docs" / "tutorials"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
QUICK = {"new", "check", "map", "simulate", "tribometer"}
"""Verbs that are run here, a few seconds each; rankings and verdicts of many cases take longer."""

NUMBER = re.compile(r"-?\b\d+(?:\.\d+)?\b")
STEP = {"map": 0.0401}
"""A step of the friction in the map of a tutorial, to rounding: at a boundary the last bits of a processor's
own functions decide which way the counted runs fall. What the other verbs print is compared as it is."""

SHOWN = {"design": 2, "first-ranking": 1, "tribometer": 2, "uncertainty": 0}
"""Page: blocks of output that are compared."""


@pytest.fixture(autouse=True)
def _elsewhere(elsewhere, monkeypatch):
    monkeypatch.setattr(plt, "show", lambda: None)


def blocks(page: str) -> Iterator[tuple[str, str]]:
    """Yield the language and the text of each block of a page."""
    yield from BLOCK.findall((FOLDER / f"{page}.md").read_text(encoding="utf-8"))


def run(command: str, capsys) -> str:
    """Return what a command of a page prints; patterns are replaced as a shell does."""
    words = shlex.split(command)[1:]
    expanded = [
        name for word in words for name in (sorted(map(str, Path().glob(word))) if "*" in word else [word])
    ]
    capsys.readouterr()
    assert main(expanded) == 0, command
    return capsys.readouterr().out


def alike(shown: str, printed: str, step: float) -> bool:
    """Whether a printed line has the words of the page, and its numbers but for a step."""
    if NUMBER.sub("", shown).split() != NUMBER.sub("", printed).split():
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(abs(float(a) - float(b)) <= step for a, b in pairs)


def followed(code: str) -> None:
    """Run a script of a page."""
    Path("script.py").write_text(code, encoding="utf-8")
    runpy.run_path("script.py")


@pytest.mark.parametrize("page", SHOWN)
def test_a_command_of_a_tutorial_prints_what_the_page_shows(page, capsys):
    """The files of the page are written, its commands run in order; each line shown is printed, in order."""
    command, printed, compared = "", "", 0
    for language, text in blocks(page):
        name = re.match(r"# (\S+\.toml)", text)
        if language == "python":
            followed(text)
        elif language == "toml" and name:
            Path(name[1]).write_text(text, encoding="utf-8")
        elif text.startswith("separatrix "):
            command, printed = text.splitlines()[-1], ""
            if command.startswith("separatrix new"):
                run(command, capsys)
        elif language == "text" and command.split()[1:2] and command.split()[1] in QUICK:
            printed = printed or run(command, capsys)
            lines = iter(printed.splitlines())
            step = STEP.get(command.split()[1], 0.0)
            missed = [row for row in text.splitlines() if not any(alike(row, one, step) for one in lines)]
            assert missed == []
            compared += 1
    assert compared == SHOWN[page]


def test_every_tutorial_is_followed():
    """Those of the command line, and that of Python."""
    assert {path.stem for path in FOLDER.glob("*.md")} == {*SHOWN, "python"}


def test_the_tutorial_of_python_prints_what_the_page_says(capsys):
    """Its blocks run in one session, but for the ranking; the numbers are those of the text between them."""
    text = (FOLDER / "python.md").read_text(encoding="utf-8")
    codes = [code for language, code in blocks("python") if language == "python"]
    followed("\n".join(code for code in codes if "separatrix.rank" not in code))
    printed = capsys.readouterr().out.splitlines()
    factors = re.findall(r"prints (0\.\d+)\.\.\.", text)
    assert len(factors) == 2
    assert [number[:6] for number in printed[:2]] == factors
    (outcome,) = re.findall(r"prints ([A-Z]+) and", text)
    assert printed[-1] == outcome
