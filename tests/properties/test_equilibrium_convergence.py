"""How many bearings that nobody chose are solved: all sane ones, and most at the edge of what is accepted."""

import math
from collections import Counter
from pathlib import Path

import numpy as np
from sane_studies import bearing_study

from separatrix.chain.equilibrium import equilibrium
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.study.study import BallBearing, KinematicModel, Material, Operation


def test_every_sane_bearing_is_solved(tmp_path: Path) -> None:
    """Axial, radial, combined loads and moments, rings held or free to tilt, 0 to 60 krpm, 3 classes."""
    for seed in range(100):
        study = bearing_study(seed, tmp_path)
        friction = study.film.race_friction
        result = equilibrium(study.bearing, study.operation, KinematicModel.FREE, friction)
        angles = np.concatenate((result.contact_angle_inner, result.contact_angle_outer))
        assert np.abs(angles).max() < 0.5 * math.pi, seed


def extreme(seed: int) -> tuple[BallBearing, Operation, float]:
    """A bearing, an operation and a race friction at the edge of what is accepted, log-uniform throughout.

    Grooves may hug the balls to 0.05 %, contact angles reach 89 deg, loads go from those that do not dent a
    ball to those that crush it.
    """
    rng = np.random.default_rng((23, seed))

    def spread(low: float, high: float) -> float:
        return float(math.exp(rng.uniform(math.log(low), math.log(high))))

    modulus, density, ball = spread(1e9, 1e12), spread(500.0, 20_000.0), spread(1e-4, 0.3)
    material = Material(name="any", elastic_modulus=modulus, poisson_ratio=0.3, density=density)
    count = int(rng.choice([3, 4, 7, 12, 20, 40, 80]))
    closest = ball / math.sin(math.pi / count) * 1.001
    pitch = max(count * ball / (math.pi * rng.uniform(0.1, 0.97)), closest)
    angle = float(rng.choice([0.0, rng.uniform(0.0, 5.0), rng.uniform(5.0, 45.0), rng.uniform(45.0, 89.0)]))
    bearing = BallBearing(
        ball_diameter=ball,
        pitch_diameter=pitch,
        ball_count=count,
        contact_angle=math.radians(angle),
        inner_conformity=0.5 + spread(5e-4, 0.1),
        outer_conformity=0.5 + spread(5e-4, 0.1),
        ball_material=material,
        ring_material=material,
    )
    kind, load = int(rng.integers(4)), spread(1e-6, 1.0) * 1e-3 * modulus * ball**2 * count
    radial = load * spread(1e-3, 10.0) if kind in (1, 2) else 0.0
    moment = load * pitch * spread(1e-3, 3.0) * (1.0 if rng.random() < 0.5 else -1.0) if kind == 3 else None
    mass = density * math.pi / 6.0 * ball**3
    speed = min(1e5, spread(1e-3, 3.0) * math.sqrt(load / count / (mass * pitch)))
    speed *= float(rng.choice([0.0, 1.0, -1.0], p=[0.05, 0.7, 0.25]))
    operation = Operation(
        inner_speed=speed,
        outer_speed=speed * float(rng.choice([0.0, 0.0, -1.0, 0.5, 1.5])),
        axial_load=load if kind != 1 else 0.0,
        radial_load=radial,
        moment=moment if kind == 3 else 0.0 if rng.random() < 0.5 else None,
    )
    return bearing, operation, spread(1e-3, 2.0)


def outcome(seed: int) -> str:
    """How an extreme bearing ends: solved, refused by physics, or not converged."""
    bearing, operation, friction = extreme(seed)
    try:
        equilibrium(bearing, operation, KinematicModel.FREE, friction)
    except InputError as refusal:
        return "refused" if "of their grooves" in str(refusal) else "refused for another reason"
    except ConvergenceError:
        return "failed"
    return "solved"


def test_extreme_bearings_are_solved_or_refused_by_physics() -> None:
    """A quarter of such a set failed with full circles for grooves; now some 3 in 100 do."""
    counts = Counter(map(outcome, range(100)))
    assert set(counts) <= {"solved", "refused", "failed"}
    assert counts["failed"] <= 6
