"""Wrong input: a line on standard error for each mistake, exit status 2, nothing written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from separatrix.front import main

VALID = """
[bearing]
ball_diameter = "11.1125 mm"
pitch_diameter = "65 mm"
ball_count = 13
contact_angle = "25 deg"
inner_conformity = 0.52
outer_conformity = 0.52
ball_material = "440C"
ring_material = "440C"

[operation]
inner_speed = "15000 rpm"
axial_load = "300 daN"

[film]
race_friction = 0.1
material = "PTFE transfer film"
thickness = "0.5 um"

[cage]
mass = "25 g"
ball_cage_stiffness = "3e6 N/m"
pocket_clearance = "0.6 mm"

[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "10 ms"

[ranking]
friction = "pin-on-disk-77K"
"""

WRONG_STUDIES = {  # one for each step of reading; every rule is in test_study_refusals
    "broken TOML": ("[bearing]", "[bearing", "line"),
    "deeply nested": ("ball_count = 13", "ball_count = " + "[" * 3000 + "]" * 3000, ""),
    "duplicate key": ("ball_count = 13", "ball_count = 13\nball_count = 13", "line"),
    "unknown key": ("ball_count = 13", "ball_cuont = 13", "ball_count"),
    "missing section": ("[operation]", "[operations]", "operation"),
    "nan": ('"300 daN"', '"nan N"', "axial_load"),
    "unknown material": ('ball_material = "440C"', 'ball_material = "440D"', "440C"),
    "more balls than fit": ("ball_count = 13", "ball_count = 30", "ball"),
    "conformity of a radius": ("outer_conformity = 0.52", "outer_conformity = 5.88", "outer_conformity"),
}


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def refused(capsys, *arguments: str) -> str:
    """Run a command that must be refused; return its lines, one for each mistake."""
    before = sorted(Path().rglob("*"))
    status = main(list(arguments))
    out, err = capsys.readouterr()
    assert status == 2, err
    assert out == ""
    assert all(line.startswith("separatrix: ") and len(line) < 1200 for line in err.splitlines()), err
    assert err.endswith("\n")
    assert "Traceback" not in err
    assert sorted(Path().rglob("*")) == before
    return err


@pytest.mark.parametrize("case", WRONG_STUDIES)
def test_a_wrong_study_is_refused_in_a_line(case, capsys):
    """Each wrong study: exit status 2, a line with what it is about, nothing written."""
    old, new, said = WRONG_STUDIES[case]
    assert old in VALID
    Path("study.toml").write_text(VALID.replace(old, new))
    assert said in refused(capsys, "rank", "study.toml")


@pytest.mark.parametrize("verb", ["check", "rank"])
def test_eight_mistakes_are_eight_lines(verb, capsys):
    """Every verb names all of them, each on a line of its own, in the order of the file."""
    mistakes = {
        'ball_material = "440C"': 'ball_material = "silicon carbide"',
        'ring_material = "440C"': 'ring_material = "404c"',
        '"15000 rpm"': '"40,000 rpm"',
        '"300 daN"': '"300"',
        '"PTFE transfer film"': '"PTFE transfer"',
        '"25 g"': '"25"',
        "runs = 4": "runs = 0",
        '"pin-on-disk-77K"': '"pin-on-disk"',
    }
    text = VALID
    for right, wrong in mistakes.items():
        text = text.replace(right, wrong)
    Path("study.toml").write_text(text)
    lines = refused(capsys, verb, "study.toml").splitlines()
    steels, cage = ("ball_material", "ring_material"), ("mass", "runs", "friction")
    keys = (*steels, "inner_speed", "axial_load", "material", *cage)
    assert len(lines) == len(keys)
    assert all(f"] {key} " in line for key, line in zip(keys, lines, strict=True))


USAGE = {
    "no verb": ([], "is missing; choose one of new, check"),
    "unknown verb": (["rnak", "le7"], "rnak"),
    "no study": (["bearing"], "STUDY"),
    "two studies": (["bearing", "le7", "le7"], "le7"),
    "unknown option": (["bearing", "le7", "--jsn"], "--jsn"),
    "no jobs": (["bearing", "le7", "--jobs", "0"], "--jobs"),
    "too many jobs": (["bearing", "le7", "--jobs", "1000000"], "--jobs"),
    "out without a folder": (["bearing", "le7", "--out"], "--out"),
    "new without a path": (["new"], "PATH"),
    "study with control characters": (["bearing", "a\x1b[31m\nb"], ""),
    "a folder for a study": (["check", "folder.toml"], "folder"),
    "the nearest shipped study": (["rank", "cryogenic-turbopmp"], "cryogenic-turbopump"),
    "out that is a file": (["rank", "cryogenic-turbopump", "--out", "taken.toml"], "--out"),
    "out below a file": (["rank", "cryogenic-turbopump", "--out", "taken.toml/below"], "--out"),
    "default folder that is a file": (["bearing", "study.toml"], "--out"),
    "out from an unset variable": (["bearing", "le7", "--out", ""], "--out"),
    "out longer than a file system takes": (["check", "le7", "--out", "a" * 300], "--out"),
    "a wrong study, before its folder is made": (["bearing", "empty.toml", "--out", "deep/folder"], "empty"),
    "new over a file": (["new", "taken.toml"], "exists"),
    "new over a folder": (["new", "folder.toml"], "folder"),
    "new without its folder": (["new", "nowhere/mine.toml"], "nowhere"),
}


@pytest.mark.parametrize("case", USAGE)
def test_wrong_usage_is_refused_in_one_line(case, capsys):
    """Each misuse of the command line itself; what is there stays as it was."""
    Path("folder.toml").mkdir()
    Path("study.toml").write_text(VALID)
    Path("empty.toml").write_text("")
    for taken in ("taken.toml", "study"):
        Path(taken).write_text("mine")
    arguments, said = USAGE[case]
    assert said in refused(capsys, *arguments)
    assert Path("taken.toml").read_text() == Path("study").read_text() == "mine"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["chek"], "No such command 'chek'. Did you mean 'check'?"),
        (["materials", "lst"], "No such command 'lst'. Did you mean 'list'?"),
        (["xyzzy"], "No such command 'xyzzy'."),
    ],
)
def test_an_unknown_verb_is_answered_in_whole_sentences(arguments, said, capsys):
    """A question ends with its own mark, all else with a full stop."""
    assert refused(capsys, *arguments) == f'separatrix: {said} Try "separatrix --help".\n'


@pytest.mark.parametrize(
    ("verb", "option"), [("check", "--jobs"), ("map", "--points"), ("simulate", "--run")]
)
@pytest.mark.parametrize("value", ["two", "1.5", "", "9" * 5000])
def test_an_option_that_is_no_whole_number_is_refused_in_our_words(verb, option, value, capsys):
    """Where, rule, value and cure, whichever option takes the number."""
    line = refused(capsys, verb, "le7", option, value)
    shown = value if len(value) < 60 else "9" * 57 + "..."
    cure = "Write it in digits, or leave it out."
    assert line == f'separatrix: {option} must be a whole number; got "{shown}". {cure}\n'


def test_a_study_named_by_dots_alone_does_not_write_above(capsys):
    """The file `...toml` has the stem `..`: its default folder must not be the one above."""
    Path("below").mkdir()
    os.chdir("below")
    Path("...toml").write_text(VALID)
    assert "--out" in refused(capsys, "bearing", "...toml")
    assert [path.name for path in Path("..").iterdir()] == ["below"]


@pytest.mark.parametrize("verb", ["restitution", "stability", "map", "simulate", "rank"])
def test_a_verb_that_needs_a_missing_section_says_so(verb, capsys):
    """The cage verbs refuse a study without [cage]; `rank` one without [ranking]."""
    start = "[ranking]" if verb == "rank" else "[cage]"
    Path("study.toml").write_text(VALID[: VALID.index(start)])
    assert start in refused(capsys, verb, "study.toml")
