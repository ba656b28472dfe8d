"""Equilibria that nobody chose: balances, relabelling and units hold for all of them; how many are solved."""

import dataclasses
import math
from collections import Counter

import numpy as np
import pytest
from cages import STEEL
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix import BallBearing, ConvergenceError, InputError, KinematicModel, Material, Operation
from separatrix.chain.equilibrium import Equilibrium, equilibrium

bearings = st.builds(
    BallBearing, ball_diameter=st.floats(8e-3, 12e-3), pitch_diameter=st.floats(60e-3, 70e-3),
    ball_count=st.integers(6, 13), contact_angle=st.floats(0.0, math.radians(45.0)),
    inner_conformity=st.floats(0.51, 0.55), outer_conformity=st.floats(0.515, 0.53),
    ball_material=st.just(STEEL), ring_material=st.just(STEEL),
)  # fmt: skip
operations = st.builds(
    Operation,
    inner_speed=st.floats(-1500.0, 1500.0),
    outer_speed=st.sampled_from([0.0, 0.0, -300.0, 400.0]),
    axial_load=st.floats(1500.0, 20_000.0),
    radial_load=st.sampled_from([0.0, 0.0, 300.0]),
)
speeds, radials = st.just(0.0) | st.floats(100.0, 5000.0), st.floats(100.0, 5000.0)
any_load = st.one_of(
    st.builds(
        Operation,
        inner_speed=speeds,
        axial_load=st.just(axial),
        radial_load=radials,
        moment=st.sampled_from(moments),
    )
    for axial, moments in ((0.0, [None, 0.0]), (2000.0, [None, 0.0, 5.0, 20.0]))
)
"""With balls that carry nothing, rings held or free to tilt, a moment beside a preload; to 2.5e6 mm rpm."""

models = st.sampled_from(list(KinematicModel))
some = settings(max_examples=25)


def numbers(result: Equilibrium) -> dict[str, np.ndarray]:
    """All arrays of a result."""
    fields = [field.name for field in dataclasses.fields(result)]
    return {name: getattr(result, name) for name in fields if isinstance(getattr(result, name), np.ndarray)}


@some
@given(bearing=bearings, operation=operations, model=models, friction=st.floats(0.02, 0.4))
def test_the_ring_is_carried_and_nothing_is_nan(bearing, operation, model, friction):
    """Axial load: sum of Q sin(alpha), but for friction across the grooves, at most mu Q a ball."""
    result = equilibrium(bearing, operation, model, friction)
    assert all(np.isfinite(values).all() for values in numbers(result).values())
    carried = np.sum(result.load_inner * np.sin(result.contact_angle_inner))
    across = np.sum(2.0 * result.gyroscopic_moment / bearing.ball_diameter)
    if model is KinematicModel.FREE:
        across = friction * result.load_inner.sum()
    assert abs(carried - operation.axial_load) <= across + 1e-5 * operation.axial_load
    assert result.residual <= 1e-6 * operation.axial_load


@some
@given(bearing=bearings, operation=any_load, friction=st.floats(0.02, 0.2))
def test_under_any_load_balls_are_solved(bearing, operation, friction):
    """Without race control, whichever of them leave a race."""
    result = equilibrium(bearing, operation, KinematicModel.FREE, friction)
    angles = np.concatenate((result.contact_angle_inner, result.contact_angle_outer))
    assert np.abs(angles).max() < 0.5 * math.pi


@some
@given(bearing=bearings, operation=operations, model=models, length=st.sampled_from([1e-2, 1e2]))
def test_similar_bearings_are_solved_alike(bearing, operation, model, length):
    """Lengths by L, loads by L^2, speeds by 1/L: same angles and ratios, so no unit hides in the solver."""
    sizes = {name: getattr(bearing, name) * length for name in ("ball_diameter", "pitch_diameter")}
    large = dataclasses.replace(bearing, **sizes)
    scaled = Operation(
        inner_speed=operation.inner_speed / length,
        outer_speed=operation.outer_speed / length,
        axial_load=operation.axial_load * length**2,
        radial_load=operation.radial_load * length**2,
    )
    one, two = equilibrium(bearing, operation, model, 0.15), equilibrium(large, scaled, model, 0.15)
    near = {"rel": 1e-5, "abs": 1e-6}  # two Newton runs, each to 1e-6 of the load
    assert two.contact_angle_inner == pytest.approx(one.contact_angle_inner, **near)
    assert two.load_outer == pytest.approx(one.load_outer * length**2, rel=1e-5, abs=1e-5 * length**2)
    assert two.pitch_angle == pytest.approx(one.pitch_angle, **near)


@some
@given(bearing=bearings, operation=operations, model=st.sampled_from(list(KinematicModel)[1:]))
def test_balls_left_and_right_of_the_load_are_alike(bearing, operation, model):
    """Relabelling: under race control ball j and ball Z - j mirror each other."""
    result = equilibrium(bearing, operation, model, 0.15)
    for name in ("load_inner", "load_outer", "contact_angle_inner", "orbital_speed"):
        values = getattr(result, name)
        assert values[1:] == pytest.approx(values[:0:-1], rel=1e-5, abs=1e-6)


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
        ball_diameter=ball, pitch_diameter=pitch, ball_count=count, contact_angle=math.radians(angle),
        inner_conformity=0.5 + spread(5e-4, 0.1), outer_conformity=0.5 + spread(5e-4, 0.1),
        ball_material=material, ring_material=material,
    )  # fmt: skip
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
