"""Wrong input of the verb `sensitivity`: one line on standard error, exit status 2, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest

from separatrix.front import main

VALID = """
extends = "cryogenic-turbopump"

[film]
thickness = "0.5 um +- 20 %"

[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "10 ms"
seed = 1

[[ranking.candidates]]
name = "A"
friction = { air = { mean = 0.1, standard_deviation = 0.02, count = 4 } }
"""

OPTIONS = {
    "no samples": (["--samples", "0"], "must be a power of two from 64"),
    "less than no samples": (["--samples", "-64"], "must be a power of two from 64"),
    "too few samples": (["--samples", "32"], "must be a power of two from 64"),
    "one short of a power": (["--samples", "4095"], "must be a power of two"),
    "a round number": (["--samples", "1000"], "Try 1024."),
    "too many samples": (["--samples", "131072"], "to 65536"),
    "far too many samples": (["--samples", "9" * 30], "to 65536"),
    "half a sample": (["--samples", "64.5"], "--samples"),
    "samples in words": (["--samples", "many"], "--samples"),
    "samples with an exponent": (["--samples", "1e3"], "--samples"),
    "samples not a number": (["--samples", "nan"], "--samples"),
    "samples left out": (["--samples"], "--samples"),
    "no thread": (["--jobs", "0"], "--jobs"),
    "threads in words": (["--jobs", "two"], "--jobs"),
    "too many threads": (["--jobs", "5000"], "must lie between 1 and 1024"),
    "an empty folder": (["--out", ""], "needs the name of a folder"),
    "a folder that is a file": (["--out", "study.toml"], "cannot be written"),
    "an unknown option": (["--seeds", "3"], "--seeds"),
    "an option of another verb": (["--kick", "1 m/s"], "--kick"),
    "two studies": (["study.toml"], "study.toml"),
}
STUDIES = {
    "a friction below zero": ("mean = 0.1", "mean = -0.1", "mean"),
    "a friction beyond all": ("mean = 0.1", "mean = 3", "mean"),
    "a friction not a number": ("mean = 0.1", "mean = nan", "finite"),
    "a scatter below zero": ("deviation = 0.02", "deviation = -0.02", "standard_deviation"),
    "a scatter that is infinite": ("deviation = 0.02", "deviation = inf", "standard_deviation"),
    "no count": ("count = 4", "count = 0", "count"),
    "half a count": ("count = 4", "count = 4.5", "count"),
    "an unknown key of a friction": ("count = 4", "counts = 4", "counts"),
    "a candidate without friction": ("friction = {", "# friction = {", "lacks: friction"),
    "a film between turned bounds": ('"0.5 um +- 20 %"', '{ between = ["1 um", "0.2 um"] }', "thickness"),
    "a film between one bound": ('"0.5 um +- 20 %"', '{ between = ["1 um"] }', "thickness"),
    "a film of no spread": ('"0.5 um +- 20 %"', '"0.5 um +- 0 %"', "thickness"),
    "a film that may be negative": ('"0.5 um +- 20 %"', '{ between = ["-1 um", "1 um"] }', "thickness"),
    "a spread of another unit": ('"0.5 um +- 20 %"', '"0.5 um +- 0.1 N"', "thickness"),
    "a spread without a unit": ('"0.5 um +- 20 %"', '"0.5 um +- 0.1"', "thickness"),
    "a load that is no number": ("[film]", '[operation]\naxial_load = "300 daN +- many"\n[film]', "load"),
    "an uncertain kick": ('kicks = ["0.5 m/s"]', 'kicks = ["0.5 m/s +- 10 %"]', "kicks"),
    "an uncertain seed": ("seed = 1", 'seed = "1 +- 1"', "seed"),
    "a negative default scatter": ("[[r", "[ranking]\nfriction_scatter = -0.1\n[[r", "friction_scatter"),
    "no default scatter": ("[[r", "[ranking]\nfriction_scatter = 0\n[[r", "friction_scatter"),
    "a cage without mass": ("[film]", '[cage]\nmass = "0 g"\n[film]', "mass"),
    "no such base": ('"cryogenic-turbopump"', '"cryogenic-turbopumps"', "cryogenic-turbopump"),
}  # fmt: skip


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    """Run in a folder with nothing but the study."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(VALID)


def refused(capsys, *arguments: str) -> str:
    """Return the one line with which it is refused; nothing is printed or written."""
    assert main(["sensitivity", "study.toml", *arguments]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n"), [path.name for path in Path().iterdir()]) == ("", 1, ["study.toml"])
    return err


@pytest.mark.parametrize("what", OPTIONS)
def test_a_wrong_option_is_refused(what, capsys):
    """Before anything is computed, with the rule and a cure."""
    options, said = OPTIONS[what]
    assert said in refused(capsys, *options)


@pytest.mark.parametrize("what", STUDIES)
def test_a_wrong_study_is_refused(what, capsys):
    """With its place, its rule and its value."""
    before, after, said = STUDIES[what]
    assert before in VALID
    Path("study.toml").write_text(VALID.replace(before, after, 1))
    assert said in refused(capsys)


BARE = """
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
"""
RANKING = """
[ranking]
friction = "pin-on-disk-77K"
"""
CAGE = """
[cage]
mass = "25 g"
ball_cage_stiffness = "3e6 N/m"
pocket_clearance = "0.6 mm"
"""


@pytest.mark.parametrize(
    ("text", "missing"), [(BARE + RANKING, "cage"), (BARE + CAGE, "ranking"), (BARE, "cage")]
)
def test_a_study_without_a_section_is_refused(text, missing, capsys):
    """A cage and candidates are what the question is about."""
    Path("study.toml").write_text(text)
    assert missing in refused(capsys)


def test_a_study_that_is_not_there_is_refused(capsys):
    """Also a folder."""
    assert main(["sensitivity", "no-such-study"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
