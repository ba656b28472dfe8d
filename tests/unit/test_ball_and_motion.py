"""The models of a ball and of the cage's motion: keys, options, and what is refused."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from commands import refused

from separatrix.chain.ball_traction import BallTraction
from separatrix.ground.errors import InputError
from separatrix.study.cage_body import cage_inertia, ring_body
from separatrix.study.reading import read_study
from separatrix.study.study import (
    MotionModel,
    PocketShape,
    StabilitySettings,
)

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


ASKED = [
    (("simulate", "le7", "--model", "full"), "[cage] is missing; `--model` needs it"),
    (("sweep", "le7", "--model", "paper"), "[cage] is missing; `--model` needs it"),
    (("rank", "cryogenic-turbopump", "--model", "cube"), "full, paper"),
]


@pytest.mark.parametrize(("arguments", "said"), ASKED)
def test_a_model_that_cannot_be_is_refused(arguments, said, capsys, elsewhere):
    """A study without a cage has no model of it; one line names the models there are."""
    assert said in refused(capsys, *arguments)


def test_forces_of_a_law():
    """Slope at rest, the capacity far out, and the knee by its definition."""
    law = BallTraction(mass=1e-3, slope=200.0, speed=0.4)
    u = np.array([1e-6, 0.4, 1e6])
    assert law.force(u) == pytest.approx([2e-4, 80.0 / 2**0.25, 80.0])
    assert law.force(-u) == pytest.approx(-law.force(u))
