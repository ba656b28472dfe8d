"""The models of a ball and of the cage's motion: keys, options, second verdicts, and what is refused."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from commands import document, refused

from separatrix.ball_traction import BallTraction
from separatrix.cage import RunOutcome, SpaceEnsemble, run_ensemble
from separatrix.cage_body import cage_inertia, ring_body
from separatrix.chain.solution import solve
from separatrix.errors import InputError
from separatrix.limits.response import cage_at
from separatrix.ranking.rank import rank
from separatrix.ranking.reason import NOTICED, second_verdict
from separatrix.runner import Runner
from separatrix.study import BallModel, MotionModel, PocketShape, StabilitySettings, with_models
from separatrix.study_file import read_study

QUICK = StabilitySettings(kicks=(0.5,), runs=8, duration=0.02, restitution_factors=(0.3, 0.6), seed=1)


def shipped(**cage):
    """The shipped study with an ensemble of no weight, and other keys of its cage."""
    study = read_study("cryogenic-turbopump")
    return replace(study, stability=QUICK, cage=replace(study.cage, **cage))


def test_ring_without_pockets():
    """36/29/14 mm and 25 g: J_p 2.671250e-5, J_t 1.376458e-5 kg m2 (dynamics3d E4)."""
    ring = ring_body(inner_radius=29e-3, outer_radius=36e-3, width=14e-3)
    assert ring.volume == pytest.approx(math.pi * (36e-3**2 - 29e-3**2) * 14e-3, rel=1e-14)
    assert ring.inertia(0.025) == pytest.approx((2.671250e-5, 1.376458e-5), rel=1e-6)


@pytest.mark.parametrize("shape", list(PocketShape))
def test_ring_with_pockets_against_points_at_random(shape):
    """Volume and inertia by four million random points of the ring, to their scatter."""
    r_i, r_o, w, along, across, count = 29e-3, 36e-3, 14e-3, 11.7e-3, 10.9e-3, 13
    across = along if shape is PocketShape.CYLINDRICAL else across
    ring = ring_body(
        inner_radius=r_i, outer_radius=r_o, width=w, pocket_count=count, pocket_along=along,
        pocket_across=across, pocket_shape=shape,
    )  # fmt: skip
    rng = np.random.default_rng(1)
    r = np.sqrt(rng.uniform(r_i**2, r_o**2, 4_000_000))
    phi, z = rng.uniform(-math.pi / count, math.pi / count, r.size), rng.uniform(-w / 2, w / 2, r.size)
    x, t = r * np.cos(phi), r * np.sin(phi)
    flat = 0.0 if shape is PocketShape.CYLINDRICAL else 0.5 * (along - across)
    beyond = np.maximum(np.abs(t) - flat, 0.0)
    hole = np.hypot(beyond, z) < 0.5 * across
    if shape is PocketShape.SQUARE:
        hole = (np.abs(t) < 0.5 * along) & (np.abs(z) < 0.5 * across)
    whole, kept = math.pi * (r_o**2 - r_i**2) * w, ~hole
    assert ring.volume == pytest.approx(whole * kept.mean(), rel=2e-3)
    assert ring.axial == pytest.approx(whole * np.mean(kept * (x * x + t * t)), rel=2e-3)
    assert ring.transverse == pytest.approx(whole * np.mean(kept * (0.5 * (x * x + t * t) + z * z)), rel=2e-3)


def test_shape_gives_mass_and_inertia():
    """Without a mass: that of the ring of its material; with one, the inertia is scaled to it."""
    sizes = {"inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.014}
    material = replace(shipped().cage.material, density=1500.0)
    study = shipped(mass=None, material=material, **sizes)
    found = cage_inertia(study.cage, study.bearing)
    whole = math.pi * (36e-3**2 - 29e-3**2) * 14e-3
    assert 0.3 * whole < found.mass / 1500.0 < 0.6 * whole  # square pockets take about half
    given = cage_inertia(replace(study.cage, mass=0.5 * found.mass), study.bearing)
    assert given.moment_of_inertia == pytest.approx(0.5 * found.moment_of_inertia)
    assert found.moment_of_inertia < 2.0 * found.transverse_inertia


WRONG = [
    ({"mass": None}, "mass is missing"),
    ({"inner_diameter": 0.058}, "outer_diameter is missing"),
    ({"inner_diameter": 0.04, "outer_diameter": 0.072, "width": 0.014}, "bottom of the inner groove"),
    ({"inner_diameter": 0.058, "outer_diameter": 0.08, "width": 0.014}, "bottom of the outer groove"),
    ({"inner_diameter": 0.066, "outer_diameter": 0.072, "width": 0.014}, "pitch diameter, 65 mm; got 66 mm"),
    (
        {"motion": MotionModel.SPACE, "inner_diameter": 0.054, "outer_diameter": 0.055, "width": 0.014},
        "must lie between the least that holds a ball, 55.15 mm and the bottom",
    ),
    ({"inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.01}, "larger than a pocket"),
    ({"land_width": 1e-3}, "no meaning for a cage in the plane"),
    ({"motion": MotionModel.SPACE, "land_spacing": 0.01}, "no meaning for one land"),
    ({"motion": MotionModel.SPACE, "land_count": 2}, "land_spacing is missing"),
    ({"motion": MotionModel.SPACE, "land_out_of_round": 1e-5}, "no meaning for a cage in space"),
    (
        {
            "motion": MotionModel.SPACE, "land_count": 2, "land_spacing": 0.012, "land_width": 0.004,
            "inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.014,
        },
        "must stay on the cage",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "said"), WRONG)
def test_a_cage_that_cannot_be_is_refused(keys, said):
    """Sizes that leave no cage, lands beside it, and keys of the other motion: a line each."""
    with pytest.raises(InputError) as refusal:
        shipped(**keys)
    assert said in str(refusal.value)


def test_an_inertia_that_no_body_has_is_refused():
    """About a diameter it is at least half that about the axis."""
    with pytest.raises(InputError, match="half that about the axis"):
        shipped(motion=MotionModel.SPACE, transverse_inertia=1e-6)


def test_models_are_asked_for_on_the_command_line():
    """--motion and --ball set the keys of the cage, with themselves as the origin."""
    study = with_models(shipped(), {"motion": "space", "ball": "traction"})
    assert (study.cage.motion, study.cage.ball) == (MotionModel.SPACE, BallModel.TRACTION)
    assert study.origins["cage.motion"] == "--motion space"
    cage = solve(study).cage_with(0.1)
    assert cage.space is not None
    assert cage.traction == solve(study).mobility.traction


SHORT_WALLS = """
extends = "cryogenic-turbopump"

[cage]
motion = "plane"
inner_diameter = "66 mm"
outer_diameter = "72 mm"
width = "14 mm"

[stability]
duration = "2 ms"
"""


def test_the_option_counts_before_the_study_is_checked(capsys, tmp_path, monkeypatch):
    """Walls that end short of the ball's equator are right in space and refused in the plane."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "short.toml").write_text(SHORT_WALLS)
    said = refused(capsys, "simulate", "short.toml", "--ball", "traction")
    assert "pitch diameter, 65 mm" in said
    answer = document(capsys, "simulate", "short.toml", "--motion", "space")
    assert answer["provenance"]["command"]["models"] == {"motion": "space"}
    assert answer["provenance"]["reason"] is None
    (tmp_path / "simulation.json").write_text(json.dumps(answer))
    assert document(capsys, "reproduce", "simulation.json")["same"] is True
    assert refused(capsys, "simulate", "short.toml", "--motion", "plane") == said


@pytest.mark.parametrize("verb", ["simulate", "sweep"])
def test_a_model_of_a_cage_that_is_not_there_is_refused(verb, capsys, tmp_path, monkeypatch):
    """A study without a cage has no motion of it."""
    monkeypatch.chdir(tmp_path)
    assert "[cage] is missing; `--motion` needs it" in refused(capsys, verb, "le7", "--motion", "space")


@pytest.mark.parametrize(("option", "known"), [("--motion", "plane, space"), ("--ball", "damper, traction")])
def test_an_unknown_model_is_refused(option, known, capsys, tmp_path, monkeypatch):
    """One line names the models there are."""
    monkeypatch.chdir(tmp_path)
    assert known in refused(capsys, "rank", "cryogenic-turbopump", option, "cube")


def test_eta_of_balls_with_traction_scales_their_slopes():
    """At another eta the slopes have the ratio of the dampings, the capacity stays; at 1 races grip."""
    cage = solve(shipped(ball=BallModel.TRACTION)).cage_with(0.1)
    other = cage_at(cage, 0.6, 0.2)
    ratio = other.race_damping / cage.race_damping
    assert other.traction.slope == pytest.approx(ratio * cage.traction.slope)
    assert other.traction.capacity == pytest.approx(cage.traction.capacity)
    assert cage_at(cage, 1.0, 0.2).traction is None


def test_forces_of_a_law():
    """Slope at rest, the capacity far out, and the knee by its definition."""
    law = BallTraction(mass=1e-3, slopes=(200.0,), speeds=(0.4,), sharpness=4)
    u = np.array([1e-6, 0.4, 1e6])
    assert law.force(u) == pytest.approx([2e-4, 80.0 / 2**0.25, 80.0])
    assert law.force(-u) == pytest.approx(-law.force(u))


def test_a_ranking_has_both_verdicts_where_forces_are_large():
    """Beyond a tenth of the capacity each candidate has a second verdict, that of the cage by itself."""
    study = shipped()
    found = rank(study)
    assert found.ball_model is BallModel.DAMPER
    assert found.capacity == pytest.approx(95.7, rel=1e-3)
    rows = next(one.materials for one in found.environments if one.name == found.environment)
    for row in rows:
        assert row.judgement.largest_contact_force > NOTICED * found.capacity
        second = second_verdict(solve(study), row.friction, solve(study).stability, Runner())
        assert row.other_ball.by_kick == second.by_kick
        assert row.other_ball.largest_contact_force < row.judgement.largest_contact_force


def test_runs_in_space_are_kept_and_joined(tmp_path):
    """An ensemble in space goes through the ledger unchanged."""
    from separatrix.ledger import Ledger

    solution = solve(shipped(motion=MotionModel.SPACE))
    cage, settings = solution.cage_with(0.1), solution.stability
    ledger = Ledger(tmp_path / "runs.sqlite")
    first = Runner(ledger=ledger).ensemble(cage, settings, kicks=(0.5,), runs=3)
    again = Runner(ledger=ledger).ensemble(cage, settings, kicks=(0.5,), runs=3)
    ledger.close()
    whole = run_ensemble(cage, settings, kicks=(0.5,), runs=3)
    for found in (first, again):
        assert isinstance(found, SpaceEnsemble)
        assert found.largest_tilt.tolist() == whole.largest_tilt.tolist()
        assert found.pocket_rubbing.tolist() == whole.pocket_rubbing.tolist()
    assert whole.largest_tilt.max() > 0.0
    assert whole.count(RunOutcome.SETTLES).tolist() == [3]


def test_the_answer_names_its_models(capsys, tmp_path, monkeypatch):
    """The origin of a model that is asked for on the command line is the option."""
    monkeypatch.chdir(tmp_path)
    found = document(capsys, "simulate", "cryogenic-turbopump", "--ball", "traction")
    assert found["study"]["cage"]["ball"] == {"value": "traction", "origin": "--ball traction"}
