"""The models of a ball and of the cage's motion: keys, options, and what is refused."""

import math
import re
from dataclasses import fields, replace

import numpy as np
import pytest
from commands import document, refused

from separatrix.cage import MovingCage, RunOutcome, moving_cage, run_ensemble, settings_for
from separatrix.chain.ball_traction import BallTraction
from separatrix.chain.solution import solve
from separatrix.ground.document import part_of
from separatrix.ground.errors import InputError
from separatrix.study.cage_body import cage_inertia, ring_body
from separatrix.study.reading import read_study
from separatrix.study.study import (
    BallModel,
    CageModel,
    MotionModel,
    PocketContact,
    PocketShape,
    StabilitySettings,
)
from separatrix.verbs.parts.answer_page import command
from separatrix.verdict.crossing import cage_at
from separatrix.verdict.ledger import Ledger
from separatrix.verdict.long_jobs import Runner

QUICK = StabilitySettings(kicks=(0.5,), runs=8, duration=0.02, restitution_factors=(0.3, 0.6), seed=1)
SHAPE = {"inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.014}


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
    material = replace(shipped().cage.material, density=1500.0)
    study = shipped(mass=None, material=material, **SHAPE)
    found = cage_inertia(study.cage, study.bearing)
    whole = math.pi * (36e-3**2 - 29e-3**2) * 14e-3
    assert 0.3 * whole < found.mass / 1500.0 < 0.6 * whole  # square pockets take about half
    given = cage_inertia(replace(study.cage, mass=0.5 * found.mass), study.bearing)
    assert given.moment_of_inertia == pytest.approx(0.5 * found.moment_of_inertia)
    assert found.moment_of_inertia < 2.0 * found.transverse_inertia


WRONG = [
    ({"mass": None}, "mass is missing"),
    ({"transverse_inertia": 1e-6}, "half that about the axis"),
    ({"inner_diameter": 0.058}, "outer_diameter is missing"),
    (SHAPE | {"inner_diameter": 0.04}, "bottom of the inner groove"),
    (SHAPE | {"outer_diameter": 0.08}, "bottom of the outer groove"),
    (SHAPE | {"inner_diameter": 0.066}, "pitch diameter, 65 mm; got 66 mm"),
    (SHAPE | {"motion": MotionModel.SPACE, "outer_diameter": 0.066},
     "must lie between the least at which a pocket's wall reaches the ball, 66.05 mm and the bottom"),
    (SHAPE | {"width": 0.01}, "larger than a pocket"),
    ({"land_spacing": 0.01}, "no meaning for one land"),
    ({"motion": MotionModel.SPACE, "land_count": 2}, "land_spacing is missing"),
    (SHAPE | {"land_count": 2, "land_spacing": 0.012, "land_width": 0.004}, "must stay on the cage"),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "said"), WRONG)
def test_a_cage_that_cannot_be_is_refused(keys, said):
    """Sizes that leave no cage, lands beside it, an inertia that no body has: a line each."""
    with pytest.raises(InputError, match=re.escape(said)):
        shipped(**keys)


EVERYWHERE = [
    {"pocket_contact": PocketContact.HERTZ, "pocket_shape": PocketShape.CYLINDRICAL},
    {"pocket_clearance": 0.0, "pocket_shape": PocketShape.CYLINDRICAL},
    {"land_out_of_round": 1e-5, "land_lobes": 3},
    {"land_count": 2, "land_spacing": 0.012, "land_width": 0.002, "land_diameter": 0.072},
    {"added_mass": 0.005, "axial_gravity": 9.81, "dynamic_unbalance": 1e-4, "transverse_inertia": 1.4e-5},
]


@pytest.mark.parametrize("keys", EVERYWHERE)
@pytest.mark.parametrize("motion", list(MotionModel))
def test_every_option_is_there_in_plane_and_space(motion, keys):
    """The study has the key, and the moving cage its number."""
    study = shipped(motion=motion, **keys)
    cage = moving_cage(solve(study), 0.1)
    for name in keys.keys() & {field.name for field in fields(MovingCage)}:
        assert getattr(cage, name) == keys[name]
    assert (cage.hertz_coefficient is not None) == ("pocket_contact" in keys)


@pytest.mark.parametrize("model", list(CageModel))
def test_a_model_is_asked_for_on_the_command_line(model):
    """--model sets the key of the cage, with itself as the origin."""
    study = read_study("cryogenic-turbopump", model.value)
    assert study.origins["cage.model"] == f"--model {model.value}"
    study = replace(study, cage=replace(study.cage, pocket_shape=PocketShape.CYLINDRICAL))
    cage = moving_cage(solve(study), 0.1)
    is_full = model is CageModel.FULL
    assert (cage.is_in_space, cage.traction == solve(study).mobility.traction) == (is_full, is_full)


ASKED = [
    (("simulate", "le7", "--model", "full"), "[cage] is missing; `--model` needs it"),
    (("sweep", "le7", "--model", "paper"), "[cage] is missing; `--model` needs it"),
    (("rank", "cryogenic-turbopump", "--model", "cube"), "full, paper"),
]


@pytest.mark.parametrize(("arguments", "said"), ASKED)
def test_a_model_that_cannot_be_is_refused(arguments, said, capsys, tmp_path, monkeypatch):
    """A study without a cage has no model of it; one line names the models there are."""
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, *arguments)


def test_eta_of_balls_of_one_state_scales_their_slope():
    """At another eta the slope has the ratio of the dampings, the capacity stays; at 1 races grip."""
    cage = moving_cage(solve(shipped(ball=BallModel.TRACTION)), 0.1)
    other = cage_at(cage, 0.6, 0.2)
    ratio = other.race_damping / cage.race_damping
    assert other.traction.slope == pytest.approx(ratio * cage.traction.slope)
    assert other.traction.capacity == pytest.approx(cage.traction.capacity)
    assert cage_at(cage, 1.0, 0.2).traction is None


def test_forces_of_a_law():
    """Slope at rest, the capacity far out, and the knee by its definition."""
    law = BallTraction(mass=1e-3, slope=200.0, speed=0.4)
    u = np.array([1e-6, 0.4, 1e6])
    assert law.force(u) == pytest.approx([2e-4, 80.0 / 2**0.25, 80.0])
    assert law.force(-u) == pytest.approx(-law.force(u))


def test_runs_in_space_are_kept_and_joined(tmp_path):
    """An ensemble in space goes through the ledger unchanged."""
    solution = solve(shipped(motion=MotionModel.SPACE))
    cage = moving_cage(solution, 0.1)
    settings = settings_for(solution.study.stability, cage)
    ledger = Ledger(tmp_path / "runs.sqlite")
    one = {"kicks": (0.5,), "runs": 3}
    kept = [Runner(ledger=ledger).ensemble(cage, settings, **one) for _ in range(2)]
    ledger.close()
    whole = run_ensemble(cage, settings, **one)
    for found in kept:
        assert found.largest_tilt.tolist() == whole.largest_tilt.tolist()
        assert found.pocket_rubbing.tolist() == whole.pocket_rubbing.tolist()
    assert whole.largest_tilt.max() > 0.0
    assert whole.count(RunOutcome.UNRESOLVED).tolist() == [0]


def test_the_answer_names_its_models(capsys, tmp_path, monkeypatch):
    """The origin of a model that is asked for on the command line is the option."""
    monkeypatch.chdir(tmp_path)
    found = document(capsys, "simulate", "cryogenic-turbopump", "--model", "paper")
    assert found["study"]["cage"]["model"] == {"value": "paper", "origin": "--model paper"}
    assert "separatrix simulate cryogenic-turbopump --model paper" in command(part_of(found))
