"""One run of a cage in space by the verb: document, text, dataset, pictures, film and page."""

from __future__ import annotations

import html
import json
import re

import numpy as np
import pytest
from commands import document
from PIL import Image

import separatrix
from separatrix import figures, present
from separatrix.cage import run_ensemble
from separatrix.cli import main
from separatrix.figures.animation import animate
from separatrix.figures.scene import space_scene
from separatrix.figures.space import in_plane, is_in_space, land_forces
from separatrix.figures.space_film import page, view, write_page

TITLE = 'A cage in space & <b>"two lands"</b> </script> $1$'

SPACE = """
extends = "cryogenic-turbopump"
title = 'A cage in space & <b>"two lands"</b> </script> $1$'

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
duration = "10 ms"
"""

PICTURES = ("simulation", "simulation-whirl", "simulation-forces", "simulation-energy")

# runs the page's script with a document that is not there, presses keys and moves sliders


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a study and its answer."""
    place = tmp_path_factory.mktemp("space")
    (place / "space.toml").write_text(SPACE)
    options = ["--out", str(place / "out"), "--quiet", "--animate", "gif"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("separatrix.figures.animation.frame_moments", lambda _: np.arange(3))
        assert main(["simulate", str(place / "space.toml"), *options]) == 0
    return place


@pytest.fixture(scope="module")
def data(folder):
    """The saved dataset."""
    return separatrix.load(folder / "out" / "simulate.nc")


def test_all_files_of_the_answer_are_written(folder):
    """Text, document, dataset, pictures in both formats, film and page; nothing half-written."""
    names = {path.name for path in (folder / "out").iterdir()}
    pictures = {f"{name}.{ending}" for name in PICTURES for ending in ("png", "svg")}
    others = {"simulate.json", "simulate.nc", "simulate.txt", "simulation.gif", "simulation.html"}
    assert names == pictures | others
    with Image.open(folder / "out" / "simulation.gif") as film:
        assert film.n_frames > 1


def test_the_document_has_the_motion_in_space(folder, capsys):
    """Keys that scripts rely on; the run is that of the Python function, to the digit."""
    found = document(capsys, "simulate", str(folder / "space.toml"))
    count = len(found["time"])
    assert [len(found["position"]), len(found["position"][0])] == [count, 3]
    assert [len(found["land_force"][0]), len(found["contact_angle"][0])] == [2, 13]
    parts = found["analysis"]
    assert {"offset", "axial", "tilt", "slip_angle", "whirl", "spectra", "impacts", "rubbing"} <= parts.keys()
    largest = max(np.hypot(*np.array(found["lean"]).T))
    assert found["largest_tilt"] == pytest.approx(largest, rel=1e-12)
    assert found["largest_axial"] > 0.0
    assert 0.0 < parts["force_share"] < 10.0
    assert sum(parts["impacts"][f"{side}_share"] for side in ("front", "rear", "axial")) == pytest.approx(1.0)
    assert found["energy_imbalance"] < 1e-8
    answer = separatrix.simulate(folder / "space.toml")
    assert answer.document()["analysis"]["whirl"] == parts["whirl"]


def test_peaks_of_the_samples_are_near_those_of_the_engine(data):
    """The engine sees it within its steps; 20 samples in the shortest impact come within 2 % of a peak."""
    sampled, counted = float(data["contact_force"].max()), float(data["largest_contact_force"])
    assert 0.98 * counted < sampled <= counted * (1.0 + 1e-9)
    strips = np.trapezoid(data["land_force"].sum("strip"), data["time"])
    assert float(strips) == pytest.approx(float(data["land_impulse"]), rel=0.02)


def test_whirl_of_the_samples_is_that_of_the_engine(folder):
    """Whirl ratios, tilt and axial place of the judged part, by integrals of the engine within its steps.

    The steps differ, so that motions part slowly: 1 % after two turns of the cage.
    """
    answer = separatrix.simulate(folder / "space.toml")
    settings = answer.solution.stability
    engine = run_ensemble(answer.cage, settings, kicks=[answer.kick], runs=1)
    found, turn = answer.analysis, answer.cage.cage_speed
    whirl = found.whirl
    assert whirl.offset_ratio * whirl.cage_speed == pytest.approx(engine.orbit_speed[0, 0], abs=0.01 * turn)
    assert whirl.tilt_ratio * whirl.cage_speed == pytest.approx(engine.cone_speed[0, 0], abs=0.01 * turn)
    assert found.tilt.mean == pytest.approx(engine.mean_tilt[0, 0], rel=0.01)
    assert found.offset.mean == pytest.approx(engine.mean_offset[0, 0], rel=0.01)
    assert found.axial.mean == pytest.approx(engine.axial_place[0, 0], abs=1e-6)


def test_work_and_energy_balance_in_the_samples(data):
    """Energy at each sample is that of the start and the work since then."""
    energy = data["kinetic_energy"].values + data["stored_energy"].values
    work = sum(data[name].values for name in data.data_vars if str(name).startswith("work_"))
    assert energy - energy[0] == pytest.approx(work - work[0], abs=1e-8 * float(energy.max()))


def test_the_text_has_the_outcome_first_and_fits_a_screen(folder):
    """Outcome, motion, forces; plain ASCII, at most 50 lines."""
    text = (folder / "out" / "simulate.txt").read_text(encoding="ascii")
    lines = text.splitlines()
    assert "Outcome" in lines[5]
    for word in (
        "Tilt",
        "Axial place",
        "Whirl ratio",
        "Cage slip",
        "Pocket, largest",
        "Rubbing",
        "Drift rate",
    ):
        assert word in text
    assert len(lines) < 50
    assert max(map(len, lines)) <= 96


def test_every_picture_is_drawn_again_from_the_saved_dataset(folder, data, tmp_path):
    """To the byte."""
    for name, figure in figures.draw("simulate", data):
        figures.save(figure, tmp_path / f"{name}.svg")
        assert (tmp_path / f"{name}.svg").read_bytes() == (folder / "out" / f"{name}.svg").read_bytes()
    write_page(data, tmp_path / "again.html")
    saved = (folder / "out" / "simulation.html").read_text(encoding="utf-8")
    assert len(saved) > 10_000  # made with three frames
    assert is_in_space(data)
    assert [name for name, _ in land_forces(data)] == ["land at \N{MINUS SIGN}", "land at +"]


def test_axes_have_units(data):
    """Every axis with a label says its unit, or counts."""
    counts = ("pocket", "land", "touches", "frequency [Hz]; backward < 0 < forward")
    for _, figure in figures.draw("simulate", data):
        for axes in figure.axes:
            for label in (axes.get_xlabel(), axes.get_ylabel()):
                assert not label or "[" in label or label in counts


def test_a_film_fixed_in_space_is_another_film(data, tmp_path, monkeypatch):
    """The view that turns with the balls, and the one that does not."""
    monkeypatch.setattr("separatrix.figures.animation.frame_moments", lambda _: np.array([0, 40, 80]))
    animate(data, tmp_path / "turning.gif")
    animate(data, tmp_path / "fixed.gif", fixed=True)
    assert (tmp_path / "turning.gif").read_bytes() != (tmp_path / "fixed.gif").read_bytes()


def test_walls_meet_balls_when_they_touch(data):
    """In the picture, enlarged: the distance between wall and ball in the film is the enlarged true one."""
    moment = int(data["contact_force"].values.max(axis=1).argmax())
    at = space_scene(data, np.array([moment]))
    ball = int(data["contact_force"].values[moment].argmax())
    centre = np.array([*(at.radius * f(at.angles[ball]) for f in (np.cos, np.sin)), 0.0])
    away = at.moved(centre, 0) - at.ball_places(0)[ball]
    along = float(away[:2] @ [-np.sin(at.angles[ball]), np.cos(at.angles[ball])])
    beyond = max(abs(along) / at.enlarged - at.plays[ball], abs(away[2]) / at.enlarged - at.axial_play)
    pressed = float(data["contact_force"][moment, ball] / data["cage_ball_cage_stiffness"])
    # to second order in the movements, which the picture draws as first order
    assert beyond == pytest.approx(pressed, abs=3e-6)


def test_the_page_needs_no_network_and_its_words_are_escaped(data):
    """No address in it; the title of the study cannot end its script; under 1 MB."""
    text = page(data)
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
    words = re.search('class="about">(.*?)</p>', view(data), re.DOTALL)[1]
    assert "inner ring" in words
    for title in ("", "A long title of a study. " * 9):
        assert (
            re.search('class="about">(.*?)</p>', view(data.assign_attrs(title=title)), re.DOTALL)[1] == words
        )


def test_runs_in_space_are_compared(folder, tmp_path, capsys):
    """With each other: offsets, forces and energies of both."""
    pair = [str(folder / "out"), str(folder / "out" / "simulate.nc")]
    assert main(["compare", *pair, "--out", str(tmp_path / "both")]) == 0
    found = json.loads((tmp_path / "both" / "compare.json").read_text())
    assert found["rows"] == []
    assert found["unchanged"] > 100
    assert (tmp_path / "both" / "comparison.png").exists()
    assert "largest" in capsys.readouterr().out.lower()


def test_a_bearing_that_turns_backward_says_that_it_is_mirrored(folder, capsys):
    """It is run as its mirror image: the same numbers, with a line that says so."""
    turned = SPACE.replace("[cage]", '[operation]\ninner_speed = "-15000 rpm"\n\n[cage]')
    (folder / "backward.toml").write_text(turned)
    usual = document(capsys, "simulate", str(folder / "space.toml"))
    found = document(capsys, "simulate", str(folder / "backward.toml"))
    assert found["largest_tilt"] == pytest.approx(usual["largest_tilt"], rel=1e-6)
    text = separatrix.simulate(folder / "backward.toml").summary()
    assert "mirror image" in text


def test_a_run_that_grows_has_all_its_samples_before_its_end(folder):
    """It ends after some milliseconds; its course is drawn from as many samples as that of a long run."""
    text = SPACE.replace("ball_cage_friction = 0.2", 'ball_cage_friction = 0.6\npocket_shape = "cylindrical"')
    for key in ("guidance", "land_clearance", "land_count", "land_spacing"):
        text = re.sub(rf"{key} = .*\n", "", text)
    text = text.replace("tilt_kick = 1.0\naxial_kick = 0.5", "tilt_kick = 0.3").replace('"10 ms"', '"50 ms"')
    (folder / "grows.toml").write_text(text)
    with pytest.warns(separatrix.errors.ValidityWarning):  # of forces, which grow too
        found = separatrix.simulate(folder / "grows.toml", kick=2.0).record.history
    assert found.outcome.name == "WHIRLS"
    assert found.time[-1] < 0.04
    assert found.time.size >= 4000


def test_a_ball_guided_cage_has_no_land(folder):
    """No strip, no land in pictures and film; the dataset is saved and read all the same."""
    text = SPACE.replace('guidance = "inner"', 'guidance = "ball"')
    for key in ("land_clearance", "land_count", "land_spacing"):
        text = re.sub(rf"{key} = .*\n", "", text)
    (folder / "ball.toml").write_text(text.replace('land_clearance = "0.5 mm"', ""))
    answer = separatrix.simulate(folder / "ball.toml")
    present.save(answer.to_xarray(), folder / "ball.nc")
    saved = separatrix.load(folder / "ball.nc")
    assert saved.sizes["strip"] == 0
    assert land_forces(saved) == []
    assert float(in_plane(saved)["land_force"].max()) == 0.0
    for _, figure in figures.draw("simulate", saved):
        assert figure.axes
    assert "no land" in answer.summary()
    assert json.loads(re.findall(r'id="run">(.*?)</script>', page(saved), re.DOTALL)[0])["heights"] == []
