"""Answers as Python functions give them, and as the command line writes and shows them."""

import copy
import html
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest
from commands import SMALL, document, written

import separatrix
from separatrix.front import api, main
from separatrix.ground.errors import InputError


@pytest.fixture
def small(tmp_path):
    """A study with an ensemble of no weight."""
    return written(tmp_path, SMALL)


def test_an_answer_has_the_names_of_its_record(small):
    """So `answer.ranking` is `answer.record.ranking`; an unknown one is an AttributeError; copies work."""
    answer = api.restitution(small)
    assert answer.solution is answer.record.solution
    with pytest.raises(AttributeError):
        _ = answer.no_such_name
    assert copy.deepcopy(answer).document() == answer.document()


def test_a_figure_by_its_name(small):
    """The first one, or the one asked for; another name is refused."""
    answer = api.mobility(small)
    assert answer.plot().axes
    assert answer.plot("mobility").axes
    with pytest.raises(InputError, match="no picture nothing"):
        answer.plot("nothing")


def test_notes_are_in_the_answer_and_its_document(tmp_path):
    """MoS2 on the races: eta is 0; and what the reading of the study notes, if it was read before, too."""
    slippery = '[film]\nrace_friction = 0.02\n[operation]\ntemperature = "120 K"\n'
    answer = api.restitution(separatrix.read_study(written(tmp_path, SMALL + slippery)))
    eta, read = answer.notes
    assert "not stated at 120 K" in read
    assert eta.startswith("eta = 0")
    assert answer.document()["warnings"] == [eta, read]
    assert eta[:70] in " ".join(answer.summary().split())


def test_a_report_of_a_study_is_a_document(small):
    """What the verbs answer, in one page; a progress that is asked for is told."""
    told = []
    bare = separatrix.read_study(small)
    bare = replace(bare, ranking=None)
    found = separatrix.report(bare, jobs=1, progress=lambda done, total: told.append((done, total)))
    assert [*found.documents] == ["stability", "bearing", "traction", "restitution", "simulate"]
    assert told
    assert found.documents["bearing"]["balls"] == separatrix.bearing(bare).document()["balls"]
    assert found.summary().splitlines() == list(found.page.lead)
    assert found.page.lead[0] in html.unescape(found.html())
    assert found.pdf().startswith(b"%PDF-")


def test_a_check_fits_a_screen_and_full_shows_the_rest(elsewhere, capsys):
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


def test_the_speed_parameter_and_the_static_pressure_are_those_of_the_bearing(elsewhere, capsys):
    """DN is bore times speed; the pressure at rest is that of `bearing` at 0 rpm."""
    Path("still.toml").write_text('extends = "cryogenic-turbopump"\n[operation]\ninner_speed = "0 rpm"\n')
    checked = document(capsys, "check", "cryogenic-turbopump")
    still = document(capsys, "bearing", "still.toml")["contacts"]
    for race in ("inner", "outer"):
        assert checked["static"][race]["max_pressure"] == still[race]["max_pressure"]
