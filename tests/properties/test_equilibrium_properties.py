"""Equilibria that nobody chose: balances, relabelling and units hold for all of them."""

import dataclasses
import math

import numpy as np
import pytest
from cages import STEEL
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.chain.equilibrium import Equilibrium, equilibrium
from separatrix.study.study import BallBearing, KinematicModel, Operation

bearings = st.builds(
    BallBearing,
    ball_diameter=st.floats(8e-3, 12e-3),
    pitch_diameter=st.floats(60e-3, 70e-3),
    ball_count=st.integers(6, 13),
    contact_angle=st.floats(0.0, math.radians(45.0)),
    inner_conformity=st.floats(0.51, 0.55),
    outer_conformity=st.floats(0.515, 0.53),
    ball_material=st.just(STEEL),
    ring_material=st.just(STEEL),
)
operations = st.builds(
    Operation,
    inner_speed=st.floats(-1500.0, 1500.0),
    outer_speed=st.sampled_from([0.0, 0.0, -300.0, 400.0]),
    axial_load=st.floats(1500.0, 20_000.0),
    radial_load=st.sampled_from([0.0, 0.0, 300.0]),
)
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
