"""Which run `simulate` follows, its animation, and two of them side by side."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import document, refused

from separatrix import figures, present
from separatrix.cli import main
from separatrix.figures.animation import animate

SMALL = """
extends = "cryogenic-turbopump"
title = "A small run"

[cage]
ball_cage_friction = 0.1

[stability]
kicks = ["0.5 m/s"]
duration = "4 ms"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with two simulations of studies that differ in the cage's mass."""
    place = tmp_path_factory.mktemp("runs")
    (place / "small.toml").write_text(SMALL)
    heavy = SMALL.replace("A small run", "A heavy cage").replace("[cage]", '[cage]\nmass = "50 g"')
    (place / "heavy.toml").write_text(heavy)
    for name in ("small", "heavy"):
        options = ["--out", str(place / name), "--quiet"]
        assert main(["simulate", str(place / f"{name}.toml"), *options]) == 0
    return place


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def simulated(folder: Path, capsys, *options: str) -> dict:
    """Return the document of one run of the small study."""
    return document(capsys, "simulate", str(folder / "small.toml"), *options)


def test_kick_and_run_are_those_asked_for(folder, capsys):
    """By default the first run from the middle kick; another kick and run give another motion."""
    usual = simulated(folder, capsys)
    assert (usual["kick"], usual["run"]) == (0.502, 0)
    other = simulated(folder, capsys, "--run", "3")
    assert (other["kick"], other["run"]) == (0.502, 3)
    assert other["velocity"][0] != usual["velocity"][0]
    harder = simulated(folder, capsys, "--kick", "200 cm/s")
    assert harder["kick"] == 2.0
    # the same direction: energy goes as the square of the kick, to rounding
    expected = (2.0 / 0.502) ** 2 * usual["kinetic_energy"][0]
    assert harder["kinetic_energy"][0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--kick", "2"], "needs a unit of speed"),
        (["--kick", "0 m/s"], "must be >"),
        (["--kick", "-1 m/s"], "must be >"),
        (["--run", "-1"], "--run must lie between"),
        (["--animate", "avi"], "must be gif or mp4"),
        (["--animate", "gif", "--json"], "--out DIR"),
    ],
)
def test_wrong_options_are_refused_in_one_line(options, said, capsys):
    """One line, status 2, nothing written."""
    assert said in refused(capsys, "simulate", "cryogenic-turbopump", *options)


def test_an_mp4_without_its_extra_is_refused_before_the_run(capsys, monkeypatch):
    """One line that says what to install; the run is not made and nothing is written."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr("separatrix.verbs.simulate", lambda *_, **__: pytest.fail("it was made"))
    line = refused(capsys, "simulate", "cryogenic-turbopump", "--animate", "mp4")
    assert "pip install 'separatrix[animation]'" in line


def test_ctrl_c_in_an_animation_writes_nothing(folder, capsys, monkeypatch):
    """Files of an answer come all or none, its film among them."""

    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("separatrix.figures.scene.Scene.bars", stop)
    assert main(["simulate", str(folder / "small.toml"), "--animate", "gif", "--out", "cut"]) == 130
    assert "no file was written" in capsys.readouterr().err
    assert not list(Path().iterdir())


def test_an_animation_is_written_beside_the_figures(folder, capsys, monkeypatch):
    """`--animate gif`: a moving picture of more than one frame, and nothing half-written."""
    from PIL import Image

    monkeypatch.setattr("separatrix.figures.animation.frame_moments", lambda _: np.arange(3))
    options = ["--animate", "gif", "--out", "moving", "--quiet"]
    assert main(["simulate", str(folder / "small.toml"), *options]) == 0
    names = {path.name for path in Path("moving").iterdir()}
    assert {"simulate.json", "simulate.nc", "simulation.gif", "simulation.png"} <= names
    assert not [name for name in names if name.startswith(".")]
    with Image.open("moving/simulation.gif") as film:
        assert film.n_frames > 1
    animate(present.load("moving/simulate.nc"), Path("again.gif"))  # from what was saved, to the byte
    assert Path("again.gif").read_bytes() == Path("moving/simulation.gif").read_bytes()


def test_two_runs_are_compared(folder, capsys):
    """The numbers of both, the inputs that differ, and a figure."""
    pair = [str(folder / "small"), str(folder / "heavy" / "simulate.nc")]
    assert main(["compare", *pair, "--out", "both"]) == 0
    text = capsys.readouterr().out
    assert "cage.mass" in text
    found = json.loads(Path("both/compare.json").read_text())
    assert [run["title"] for run in found["answers"]] == ["A small run", "A heavy cage"]
    mass = {"key": "cage.mass", "first": 0.025, "second": 0.05, "unit": "kg"}
    assert found["differences"] == [mass]
    saved = [present.load(folder / name / "simulate.nc") for name in ("small", "heavy")]
    offset = next(row for row in found["rows"] if row["name"] == "largest_offset")
    sides = [offset[side]["value"] for side in ("first", "second")]
    assert sides == [float(one["largest_offset"]) for one in saved]
    names = {path.name for path in Path("both").iterdir()}
    assert names == {"compare.json", "compare.txt", "comparison.png", "comparison.svg"}
    assert text.partition("Results")[0] in Path("both/compare.txt").read_text(encoding="ascii")
    ((_, figure),) = figures.draw("compare", *saved)
    figures.save(figure, Path("again.svg"))
    assert Path("again.svg").read_bytes() == Path("both/comparison.svg").read_bytes()


def test_options_and_frictions_that_differ_are_inputs_that_differ(folder, capsys):
    """Two kicks and seeds of one study, another friction; no key that a study file does not know."""
    other = SMALL.replace("= 0.1", "= 0.2").replace("[stability]", "[stability]\nseed = 2")
    (folder / "other.toml").write_text(other)
    options = ["--kick", "1 m/s", "--run", "1", "--out", str(folder / "other"), "--quiet"]
    assert main(["simulate", str(folder / "other.toml"), *options]) == 0
    capsys.readouterr()
    found = document(capsys, "compare", str(folder / "small"), str(folder / "other"))
    small = present.load(folder / "small" / "simulate.nc")
    assert {one["key"]: (one["first"], one["second"]) for one in found["differences"]} == {
        "cage.ball_cage_friction": (0.1, 0.2),
        "stability.seed": (1, 2),
        "--kick": (float(small["kick"]), 1.0),
        "--run": (0, 1),
    }


def test_the_friction_that_a_candidate_gives_is_compared(folder, capsys):
    """One run takes it from the first candidate, the other from the study; the table's range is no input."""
    own = SMALL.replace("ball_cage_friction = 0.1", "")
    (folder / "candidate.toml").write_text(own)
    assert main(["simulate", str(folder / "candidate.toml"), "--out", str(folder / "own"), "--quiet"]) == 0
    capsys.readouterr()
    found = document(capsys, "compare", str(folder / "small"), str(folder / "own"))["differences"]
    taken = float(present.load(folder / "own" / "simulate.nc")["cage_ball_cage_friction"])
    assert found == [{"key": "cage.ball_cage_friction", "first": 0.1, "second": taken, "unit": "-"}]


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e300])
def test_a_saved_run_of_numbers_that_cannot_be_drawn_is_refused(value, folder, capsys, tmp_path):
    """One line, not a traceback of the plotting library."""
    data = present.load(folder / "small" / "simulate.nc")
    data["position"][:] = value
    present.save(data, tmp_path / "odd.nc")
    assert main(["compare", str(tmp_path / "odd.nc"), str(folder / "small")]) == 2
    assert "must have finite numbers below 1e+30 in position" in capsys.readouterr().err


def test_a_comparison_as_a_document_writes_nothing(folder, capsys):
    """`--json` without `--out`: the document alone."""
    assert document(capsys, "compare", str(folder / "small"), str(folder / "small"))["differences"] == []
    assert list(Path().iterdir()) == []


def test_what_is_no_simulation_is_not_compared(folder, capsys):
    """Nothing there, another verb's answer, a file that is no dataset."""
    small, toml = str(folder / "small"), str(folder / "small.toml")
    assert main(["bearing", toml, "--out", str(folder / "bearing")]) == 0
    capsys.readouterr()
    for other, said in (
        ("nowhere", "cannot be read: no such file"),
        (str(folder / "bearing" / "bearing.nc"), "must be an answer of bearing, as"),
        (toml, "is not the document of an answer"),
    ):
        assert said in refused(capsys, "compare", other, small)


@pytest.mark.parametrize("motion", ["plane", "space"])
def test_balls_that_their_races_grip_have_an_infinite_damping(folder, capsys, motion):
    """A restitution factor of 1, the end of a map's axis: null in the document, in words in the text."""
    asked = ["simulate", str(folder / "small.toml"), "--restitution-factor", "1", "--motion", motion]
    assert main([*asked, "--out", "gripped", "--quiet"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    found = json.loads(Path("gripped/simulate.json").read_text())
    assert found["cage"]["race_damping"] is None
    assert found["chain"]["race_damping"] > 0.0
    assert not [one for one in found["warnings"] if "not finite" in one]
    assert "infinite, for a restitution factor of 1 in place of the study's" in text
