"""Commands on small studies: where their files are, threads, a new study, and the screen of `check`."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import pytest
from commands import SMALL

from separatrix.front import main
from separatrix.study.reading import read_study

ENVIRONMENTS = (
    "gaseous nitrogen, Chromex 40",
    "gaseous nitrogen, 440C",
    "liquid nitrogen, Chromex 40",
    "liquid nitrogen, 440C",
)


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder, to see what is written."""
    monkeypatch.chdir(tmp_path)


def test_the_default_folder_is_named_after_the_study(capsys):
    """Without `--out` the files are in a folder beside, with the study's name."""
    assert main(["bearing", "le7"]) == 0
    assert (Path("le7") / "bearing.html").exists()
    assert "Text, figures and data are in le7/" in capsys.readouterr().out


def test_jobs_do_not_change_the_answer(capsys):
    """The same numbers on one thread and on three."""
    Path("small.toml").write_text(SMALL)
    texts = []
    for jobs in ("1", "3"):
        assert main(["stability", "small.toml", "--json", "--jobs", jobs]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]


def test_environments_of_the_shipped_study():
    """Named as scripts expect them."""
    assert read_study("cryogenic-turbopump").ranking.environments == ENVIRONMENTS


def test_what_new_writes_is_a_study(capsys):
    """`new` writes a study that `check` accepts."""
    assert main(["new", "mine.toml"]) == 0
    assert "separatrix check mine.toml" in capsys.readouterr().out
    assert main(["check", "mine.toml"]) == 0


def test_a_check_fits_a_screen_and_full_shows_the_rest(capsys):
    """Seven materials without a datum at 90 K are one note; what matters and what is assumed comes first."""
    shipped = resources.files("separatrix") / "examples" / "cryogenic-turbopump.toml"
    bare = shipped.read_text(encoding="utf-8")
    lines = [line for line in bare.splitlines() if "ball_cage_stiffness" not in line]
    Path("cold.toml").write_text("\n".join(lines).replace('"77 K"', '"90 K"'))
    assert main(["check", "cold.toml"]) == 0
    said = capsys.readouterr().out
    assert len(said.splitlines()) <= 57
    assert max(map(len, said.splitlines())) <= 96
    assert said.count("not stated at 90 K") <= 3
    assert said.count("Note: ") == 1
    assert main(["check", "cold.toml", "--full"]) == 0
    assert "cold.toml, line" in capsys.readouterr().out


def test_the_speed_parameter_and_the_static_pressure_are_those_of_the_bearing(capsys):
    """DN is bore times speed; the pressure at rest is that of `bearing` at 0 rpm."""
    Path("still.toml").write_text('extends = "cryogenic-turbopump"\n[operation]\ninner_speed = "0 rpm"\n')
    assert main(["check", "cryogenic-turbopump", "--json"]) == 0
    checked = json.loads(capsys.readouterr().out)
    assert main(["bearing", "still.toml", "--json"]) == 0
    still = json.loads(capsys.readouterr().out)["contacts"]
    for race in ("inner", "outer"):
        assert checked["static"][race]["max_pressure"] == still[race]["max_pressure"]
