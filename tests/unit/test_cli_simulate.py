"""One run by the verb: its document, text, dataset, pictures, GIF and page; two of them side by side."""

from __future__ import annotations

import html
import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest
from commands import document, refused

import separatrix
from separatrix import figures
from separatrix.cage import run_ensemble, settings_for
from separatrix.figures.animation import animate
from separatrix.figures.view import page, view
from separatrix.front import main

SMALL = """
extends = "cryogenic-turbopump"
title = "A small run"

[cage]
ball_cage_friction = 0.1

[stability]
kicks = ["0.5 m/s"]
duration = "4 ms"
"""

TITLE = 'A cage in space & <b>"two lands"</b> </script> $1$'

SPACE = f"""
extends = "cryogenic-turbopump"
title = '{TITLE}'

[cage]
motion = "space"
ball_cage_friction = 0.2
guidance = "inner"
land_clearance = "0.5 mm"
land_count = 2
land_spacing = "10 mm"
inner_diameter = "60 mm"
outer_diameter = "70 mm"
width = "14 mm"

[stability]
kicks = ["0.5 m/s"]
tilt_kick = 1.0
axial_kick = 0.5
duration = "3 ms"
"""

PICTURES = ("simulation",)
CONTRACT = ("outcome", "largest_offset", "whirl_frequency", "whirl_speed", "pocket_power")
"""Keys that scripts rely on."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with two simulations of studies that differ in the cage's mass, and one in space."""
    place = tmp_path_factory.mktemp("runs")
    heavy = SMALL.replace("A small run", "A heavy cage").replace("[cage]", '[cage]\nmass = "50 g"')
    with pytest.MonkeyPatch.context() as patch:
        for name, text in (("small", SMALL), ("space", SPACE), ("heavy", heavy)):
            (place / f"{name}.toml").write_text(text)
            if name == "heavy":  # its pictures are looked at by no test
                patch.setattr("separatrix.figures.save_all", lambda *_: None)
            assert main(["simulate", str(place / f"{name}.toml"), "--out", str(place / name), "--quiet"]) == 0
    return place


@pytest.fixture(scope="module", params=["small", "space"])
def answered(request, folder):
    """Folder of an answer in the plane, and of one in space."""
    return folder / request.param


@pytest.fixture(scope="module")
def data(answered):
    """The arrays of the saved answer."""
    return separatrix.load(answered / "simulate.json")


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def simulated(folder: Path, capsys, *options: str) -> dict:
    """Return the document of one run of the small study."""
    return document(capsys, "simulate", str(folder / "small.toml"), *options)


def words(text: str) -> str:
    """Return a text on one line."""
    return " ".join(text.split())


def test_kick_and_run_are_those_asked_for(folder, capsys):
    """By default the first run from the reference kick; another kick and run give another motion."""
    usual = simulated(folder, capsys)
    assert (usual["kick"], usual["run"]) == (0.502, 0)
    other = simulated(folder, capsys, "--run", "3")
    assert (other["kick"], other["run"]) == (0.502, 3)
    assert other["velocity"][0] != usual["velocity"][0]
    harder = simulated(folder, capsys, "--kick", "200 cm/s")
    assert harder["kick"] == 2.0
    # the same direction: energy goes as the square of the kick, in single precision
    expected = (2.0 / 0.502) ** 2 * usual["kinetic_energy"][0]
    assert harder["kinetic_energy"][0] == pytest.approx(expected, rel=1e-6)


def test_all_files_of_the_answer_are_written(answered):
    """Text, document, dataset, pictures in both formats and page; nothing half-written."""
    pictures = {f"{name}.{ending}" for name in PICTURES for ending in ("png", "svg")}
    others = {"simulate.json", "simulate.nc", "simulate.txt", "simulation.html"}
    assert {path.name for path in answered.iterdir()} == pictures | others


def test_the_document_has_the_keys_that_scripts_rely_on(answered, capsys):
    """In the plane and in space the same keys; what only space has is null in the plane."""
    found = json.loads((answered / "simulate.json").read_text(), parse_constant=pytest.fail)
    assert set(CONTRACT) <= found.keys()
    is_flat, whirls = answered.name == "small", found["outcome"] in ("WHIRLS", "ROLLS")
    assert {(found[name] is None) for name in ("lean", "axial_place", "ball_axial", "largest_tilt")} == {
        is_flat
    }
    assert {(found[name] is not None) for name in ("whirl_frequency", "whirl_speed")} == {whirls}
    assert (len(found["position"]), len(found["position"][0])) == (len(found["time"]), 2)
    assert found["energy_imbalance"] < 3e-3
    assert sum(found[f"{side}_share"] for side in ("front", "rear", "axial")) == pytest.approx(1.0)
    answer = separatrix.simulate(answered.with_suffix(".toml"))
    assert answer.document()["position"] == found["position"]
    capsys.readouterr()


def test_peaks_of_the_samples_are_near_those_of_the_engine(data):
    """Of a short run every other step is a sample, or each."""
    for sampled, counted in (
        ("contact_force", "largest_contact_force"),
        ("land_force", "largest_land_force"),
    ):
        most = float(data[counted])
        assert 0.98 * most <= float(data[sampled].max()) <= most * (1.0 + 1e-6)
    offset = float(np.hypot(*data["position"].values.T).max())
    assert offset == pytest.approx(float(data["largest_offset"]), rel=1e-3)


def swept(time, place, rate):
    """Mean angular speed of a vector, weighted with its square: the area that it sweeps over its square."""
    turned = place[:, 0] * rate[:, 1] - place[:, 1] * rate[:, 0]
    return np.trapezoid(turned, time) / np.trapezoid(np.sum(place**2, axis=1), time)


def test_whirl_of_the_samples_is_that_of_the_engine(answered):
    """Orbit, cone and offset of the judged part, which the engine sums up step by step.

    Trapezoids over samples of two steps are off by 1.7e-5, 8e-5 and 4e-7 as measured: three times that.
    """
    answer = separatrix.simulate(answered.with_suffix(".toml"))
    settings = settings_for(answer.study.stability, answer.cage)
    engine = run_ensemble(answer.cage, settings, kicks=[answer.kick], runs=1)
    run, turn = answer.history, answer.cage.cage_speed
    part = (run.time >= run.judged_from) & (run.time <= run.followed)
    orbit = swept(run.time[part], run.position[part], run.velocity[part])
    assert run.orbit_speed == engine.orbit_speed[0, 0]
    assert run.orbit_speed == pytest.approx(orbit + turn, abs=5e-5 * turn)
    assert run.mean_offset == pytest.approx(np.hypot(*run.position[part].T).mean(), rel=1e-6)
    if answer.cage.is_in_space:
        cone = swept(run.time[part], run.lean[part], run.lean_rate[part])
        assert run.cone_speed == pytest.approx(cone + turn, abs=2.5e-4 * turn)


def test_work_and_energy_balance_in_the_samples(data):
    """Energy at each sample is that of the start and the work since then, to the error of a step."""
    energy = data["kinetic_energy"].values + data["stored_energy"].values
    work = sum(data[name].values for name in data.data_vars if str(name).startswith("work_"))
    assert energy - energy[0] == pytest.approx(work - work[0], abs=3e-3 * float(energy.max()))


def test_the_text_has_the_outcome_first_and_fits_a_screen(answered):
    """Outcome, motion, forces; plain ASCII, at most 50 lines."""
    text = (answered / "simulate.txt").read_text(encoding="ascii")
    lines = text.splitlines()
    assert "Outcome" in lines[5]
    for word in ("Orbit", "Cage slip", "Pocket, largest", "Rubbing", "Drift rate", "Work on the cage"):
        assert word in text
    assert ("Tilt" in text, "Axial place" in text) == (answered.name == "space",) * 2
    assert len(lines) < 50
    assert max(map(len, lines)) <= 96


def test_a_whirl_is_followed_for_fifty_turns_and_its_force_means_nothing_beyond_the_races(folder):
    """Its frequency and speed in the document and in the text; no digits of a force that no ball can take."""
    (folder / "whirl.toml").write_text(SMALL.replace("= 0.1", "= 0.6"))
    answer = separatrix.simulate(folder / "whirl.toml", kick=2.0)
    assert answer.notes
    found, text = answer.document(), words(answer.summary())
    assert found["outcome"] == "WHIRLS"
    assert found["time"][-1] * found["whirl_frequency"] > 49.0
    assert 0.1 < found["whirl_speed"] < 100.0
    assert re.search(r"Whirl \d\S* k?Hz (forward|backward), seen from the balls; the centre moves at", text)
    assert found["force_exceeds_races"] is (found["largest_contact_force"] > found["force_limit"])
    assert found["force_limit"] == pytest.approx(95.7 / 0.6, rel=0.01)
    assert "Pocket, largest above what the races hold, 159.5 N" in text or "160 N" in text


def test_a_cage_on_its_land_is_told_to_rub_there(folder):
    """Not only that it comes to rest: where, with which force and power."""
    (folder / "tight.toml").write_text(SMALL.replace("[cage]", '[cage]\nland_clearance = "0.4 mm"'))
    found = separatrix.simulate(folder / "tight.toml")
    assert found.history.outcome.name == "SETTLES"
    said = r"Its centre is \d+ um from the axis on average, and it rubs on its land with \S+ \S*N, \S+ \S*W\."
    assert re.search(said, words(found.summary()))


def test_a_ball_that_leaves_its_pocket_is_named_with_its_time(folder):
    """A wall that ends 0.2 mm from the balls' equator, and a strong kick: the run decides nothing."""
    walls = '[cage]\ninner_diameter = "64.6 mm"\nouter_diameter = "75 mm"\nwidth = "14 mm"'
    (folder / "edge.toml").write_text(SMALL.replace("[cage]", walls))
    found = separatrix.simulate(folder / "edge.toml", kick=2.0)
    assert (found.history.outcome.name, found.history.cause.name) == ("UNRESOLVED", "LEFT_POCKET")
    assert 1 <= found.history.left_ball <= 13
    said = f"Ball {found.history.left_ball} reaches the edge of its pocket's wall at "
    assert said in words(found.summary())


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(("ball", "said"), [("free", "free"), ("auto", "one state"), ("damper", "damper")])
def test_the_text_says_which_ball_it_has(ball, said, folder, capsys):
    """`--ball` forces one; auto is one state."""
    assert main(["simulate", str(folder / "small.toml"), "--ball", ball, "--out", "one", "--quiet"]) == 0
    assert f"Pocket friction; ball 0.100; {said} " in words(capsys.readouterr().out)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--kick", "2"], "needs a unit of speed"),
        (["--kick", "0 m/s"], "must be >"),
        (["--kick", "-1 m/s"], "must be >"),
        (["--run", "-1"], "--run must lie between"),
        (["--animate", "mp4"], "must be gif"),
        (["--animate", "gif", "--json"], "--out DIR"),
    ],
)
def test_wrong_options_are_refused_in_one_line(options, said, capsys):
    """One line, status 2, nothing written."""
    assert said in refused(capsys, "simulate", "cryogenic-turbopump", *options)


@pytest.mark.usefixtures("undrawn")
def test_ctrl_c_in_an_animation_writes_nothing(folder, capsys, monkeypatch):
    """Files of an answer come all or none, its GIF among them."""

    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("separatrix.figures.animation.draw_cage", stop)
    assert main(["simulate", str(folder / "small.toml"), "--animate", "gif", "--out", "cut"]) == 130
    assert "no file was written" in capsys.readouterr().err
    assert not list(Path().iterdir())


def test_an_animation_is_written_beside_the_figures(folder, capsys, monkeypatch):
    """`--animate gif`: a moving picture of more than one frame, and nothing half-written."""
    from PIL import Image

    monkeypatch.setattr("separatrix.figures.animation.frame_moments", lambda _: np.arange(3))
    all_of_them = figures.FIGURES["simulate"]
    monkeypatch.setitem(figures.FIGURES, "simulate", lambda data: itertools.islice(all_of_them(data), 1))
    options = ["--animate", "gif", "--out", "moving", "--quiet"]
    assert main(["simulate", str(folder / "small.toml"), *options]) == 0
    names = {path.name for path in Path("moving").iterdir()}
    assert {"simulate.json", "simulate.nc", "simulation.gif", "simulation.png"} <= names
    assert not [name for name in names if name.startswith(".")]
    with Image.open("moving/simulation.gif") as found:
        assert found.n_frames > 1
    animate(separatrix.load("moving/simulate.json"), Path("again.gif"))  # from what was saved, to the byte
    assert Path("again.gif").read_bytes() == Path("moving/simulation.gif").read_bytes()


def test_two_runs_are_compared(folder, capsys):
    """The numbers of both, the inputs that differ, and a figure."""
    pair = [str(folder / "small"), str(folder / "heavy" / "simulate.json")]
    assert main(["compare", *pair, "--out", "both"]) == 0
    text = capsys.readouterr().out
    assert "cage.mass" in text
    found = json.loads(Path("both/compare.json").read_text())
    assert [run["title"] for run in found["answers"]] == ["A small run", "A heavy cage"]
    mass = {"key": "cage.mass", "first": 0.025, "second": 0.05, "unit": "kg"}
    assert found["differences"] == [mass]
    saved = [separatrix.load(folder / name / "simulate.json") for name in ("small", "heavy")]
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
    other = document(capsys, "simulate", str(folder / "other.toml"), "--kick", "1 m/s", "--run", "1")
    (folder / "other.json").write_text(json.dumps(other))
    pair = folder / "small" / "simulate.json", folder / "other.json"
    found = document(capsys, "compare", *map(str, pair))
    small = json.loads(pair[0].read_text())
    assert {one["key"]: (one["first"], one["second"]) for one in found["differences"]} == {
        "cage.ball_cage_friction": (0.1, 0.2),
        "stability.seed": (1, 2),
        "--kick": (small["kick"], 1.0),
        "--run": (0, 1),
    }


def test_the_friction_that_a_candidate_gives_is_compared(folder, capsys):
    """One run takes it from the first candidate, the other from the study; the table's range is no input."""
    own = SMALL.replace("ball_cage_friction = 0.1", "")
    (folder / "candidate.toml").write_text(own)
    run = document(capsys, "simulate", str(folder / "candidate.toml"))
    (folder / "own.json").write_text(json.dumps(run))
    pair = folder / "small" / "simulate.json", folder / "own.json"
    found = document(capsys, "compare", *map(str, pair))["differences"]
    taken = run["cage"]["ball_cage_friction"]
    assert found == [{"key": "cage.ball_cage_friction", "first": 0.1, "second": taken, "unit": "-"}]


def test_a_saved_run_of_numbers_that_cannot_be_drawn_is_refused(folder, capsys, tmp_path):
    """One line, not a traceback of the plotting library."""
    usual = folder / "small" / "simulate.json"
    found = json.loads(usual.read_text())
    said = "must have finite numbers below 1e+30 in position"
    for value in (1e300, None):
        found["position"][0] = [value, 0.0]
        (tmp_path / "odd.json").write_text(json.dumps(found))
        assert main(["compare", str(tmp_path / "odd.json"), str(usual)]) == 2
        assert said in capsys.readouterr().err


def test_a_comparison_as_a_document_writes_nothing(folder, capsys):
    """`--json` without `--out`: the document alone."""
    same = [str(folder / "small" / "simulate.json")] * 2
    assert document(capsys, "compare", *same)["differences"] == []
    assert list(Path().iterdir()) == []


@pytest.mark.usefixtures("undrawn")
def test_what_is_no_simulation_is_not_compared(folder, capsys):
    """Nothing there, another verb's answer, a file that is no document."""
    small, toml = str(folder / "small"), str(folder / "small.toml")
    assert main(["bearing", toml, "--out", str(folder / "bearing")]) == 0
    capsys.readouterr()
    for other, said in (
        ("nowhere", "cannot be read: no such file"),
        (str(folder / "bearing" / "bearing.json"), "must be an answer of bearing, as"),
        (toml, "is not the document of an answer"),
    ):
        assert said in refused(capsys, "compare", other, small)


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("motion", ["plane", "space"])
def test_balls_that_their_races_grip_have_an_infinite_damping(folder, capsys, motion):
    """A restitution factor of 1, the end of a map's axis: null in the document, in words in the text."""
    asked = ["simulate", str(folder / "small.toml"), "--restitution-factor", "1", "--motion", motion]
    assert main([*asked, "--out", "gripped", "--quiet"]) == 0
    text = words(capsys.readouterr().out)
    found = json.loads(Path("gripped/simulate.json").read_text())
    assert found["cage"]["race_damping"] is None
    assert found["chain"]["race_damping"] > 0.0
    assert not [one for one in found["warnings"] if "not finite" in one]
    assert "infinite, for a restitution factor of 1 in place of the study's" in text


def test_every_picture_is_drawn_again_from_the_saved_answer(answered, data, tmp_path):
    """To the byte."""
    drawn, again = set(), tmp_path / "again.svg"
    for name, figure in figures.draw("simulate", data):
        figures.save(figure, again)
        assert again.read_bytes() == (answered / f"{name}.svg").read_bytes()
        drawn.add(name)
    assert drawn == set(PICTURES)
    assert page(data) == (answered / "simulation.html").read_text(encoding="utf-8")


def test_the_page_needs_no_network_and_its_words_are_escaped(folder):
    """No address in it; the title of the study cannot end its script; under 1 MB."""
    text = page(separatrix.load(folder / "space" / "simulate.json"))
    assert len(text.encode()) < 1_000_000
    assert not re.search(r"https?:|//[a-z]|src=|href=|@import|url\(|fetch|XMLHttp|import\s*\(", text)
    assert "default-src 'none'" in text
    assert text.count("</script>") == 2
    assert "<b>" not in text
    (found,) = re.findall(r'id="run">(.*?)</script>', text, re.DOTALL)
    assert f'<h1 id="title">{html.escape(TITLE)}</h1>' in text
    assert len(json.loads(found)["time"]) > 2
    assert "NaN" not in found


def test_a_long_title_or_none_leaves_the_operating_point_to_the_view(data):
    """The words under the title are those of the run, however many lines the title would take."""
    about = re.search('class="about">(.*?)</p>', view(data), re.DOTALL)[1]
    assert "inner ring" in about
    for title in ("", "A long title of a study. " * 9):
        other = view(data.assign_attrs(title=title))
        assert re.search('class="about">(.*?)</p>', other, re.DOTALL)[1] == about


def test_a_bearing_that_turns_backward_is_its_mirror_image(folder, capsys):
    """The same sizes; what is across the axis has another sign."""
    turned = SPACE.replace("[cage]", '[operation]\ninner_speed = "-15000 rpm"\n\n[cage]')
    (folder / "backward.toml").write_text(turned)
    usual = document(capsys, "simulate", str(folder / "space.toml"))
    found = document(capsys, "simulate", str(folder / "backward.toml"))
    assert found["largest_tilt"] == pytest.approx(usual["largest_tilt"], rel=1e-6)
    assert np.allclose(found["position"], np.array(usual["position"]) * [1.0, -1.0], rtol=1e-6)
    assert found["orbit_speed"] == pytest.approx(usual["orbit_speed"], rel=1e-6)


def test_a_ball_guided_cage_has_no_land(folder):
    """No land in the text and the pictures."""
    text = SPACE.replace('guidance = "inner"', 'guidance = "ball"')
    for key in ("land_clearance", "land_count", "land_spacing"):
        text = re.sub(rf"{key} = .*\n", "", text)
    (folder / "ball.toml").write_text(text)
    answer = separatrix.simulate(folder / "ball.toml")
    data = answer.to_xarray()
    assert float(data["land_force"].max()) == 0.0
    for _, figure in figures.draw("simulate", data):
        assert figure.axes
    assert "no land" in answer.summary()
