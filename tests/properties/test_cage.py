"""Mirror image, relabelled balls, change of units, and friction-free cages, for cages we did not think of."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.cage import History, PlanarCage, follow, run_ensemble, wilson_interval
from separatrix.study import Guidance, StabilitySettings

few = settings(max_examples=15, deadline=None, derandomize=True)


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Finite floats, both ends included."""
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


@st.composite
def cages(draw: st.DrawFn) -> PlanarCage:
    """Cages of every guidance and rotation."""
    mass, radius = draw(numbers(0.01, 0.1)), 0.03
    return PlanarCage(
        mass=mass,
        moment_of_inertia=mass * radius**2 * draw(numbers(0.8, 1.5)),
        ball_count=draw(st.integers(3, 20)),
        pitch_radius=radius,
        cage_speed=draw(numbers(0.0, 1000.0)),
        inner_speed=draw(numbers(0.0, 2000.0)),
        outer_speed=draw(numbers(0.0, 2000.0)),
        pocket_clearance=draw(numbers(1e-4, 1e-3)),
        ball_cage_stiffness=draw(numbers(1e6, 8e6)),
        race_damping=draw(numbers(100.0, 10000.0)),
        ball_cage_friction=draw(numbers(0.0, 0.4)),
        guidance=draw(st.sampled_from(Guidance)),
        land_clearance=draw(numbers(1e-4, 1e-3)),
        land_friction=draw(numbers(0.0, 0.4)),
        unbalance=draw(st.sampled_from([0.0, 1e-6])),
    )


def short(cage: PlanarCage, direction: float, lead: np.ndarray) -> History:
    """Run of a few impacts, so that rounding has no time to grow."""
    return follow(cage, kick=1.0, direction=direction, ball_lead=lead, duration=2e-3, samples=2)


def leads(cage: PlanarCage, seed: int) -> np.ndarray:
    """Some leads within the play."""
    return np.random.default_rng(seed).uniform(-0.3, 0.3, cage.ball_count) * cage.half_play


@few
@given(cages(), numbers(0.0, 6.0), st.integers(0, 9))
def test_the_mirror_image_runs_mirrored(cage, direction, seed):
    """Rotation and direction mirrored: so is the orbit. 1e-6: rounding after a few impacts."""
    lead = leads(cage, seed)
    mirrored = replace(
        cage, cage_speed=-cage.cage_speed, inner_speed=-cage.inner_speed, outer_speed=-cage.outer_speed
    )
    one, other = short(cage, direction, lead), short(mirrored, -direction, -np.roll(lead[::-1], 1))
    np.testing.assert_allclose(other.velocity[-1], one.velocity[-1] * [1, -1], atol=1e-6)
    np.testing.assert_allclose(other.position[-1], one.position[-1] * [1, -1], atol=1e-9)
    np.testing.assert_allclose(other.rotation_rate[-1] * 0.03, -one.rotation_rate[-1] * 0.03, atol=1e-6)


@few
@given(cages(), numbers(0.0, 6.0), st.integers(0, 9), st.integers(1, 19))
def test_relabelling_the_balls_turns_the_picture(cage, direction, seed, shift):
    """Counting from another ball turns everything by its angle (unbalance would mark a direction)."""
    cage = replace(cage, unbalance=0.0)
    lead = leads(cage, seed)
    angle = 2 * np.pi * shift / cage.ball_count
    one, other = short(cage, direction, lead), short(cage, direction + angle, np.roll(lead, shift))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(other.velocity[-1], turn @ one.velocity[-1], atol=1e-6)
    np.testing.assert_allclose(other.position[-1], turn @ one.position[-1], atol=1e-9)


@few
@given(cages(), st.integers(-3, 3), st.integers(-3, 3), st.integers(-3, 3))
def test_other_units_change_nothing(cage, length, mass, time):
    """Units that differ by powers of four: the same runs to the last bit."""
    L, M, T = 4.0**length, 4.0**mass, 4.0**time
    scaled = replace(
        cage,
        mass=cage.mass * M,
        moment_of_inertia=cage.moment_of_inertia * M * L**2,
        pitch_radius=cage.pitch_radius * L,
        cage_speed=cage.cage_speed / T,
        inner_speed=cage.inner_speed / T,
        outer_speed=cage.outer_speed / T,
        pocket_clearance=cage.pocket_clearance * L,
        ball_cage_stiffness=cage.ball_cage_stiffness * M / T**2,
        race_damping=cage.race_damping * M / T,
        land_clearance=(cage.land_clearance or 0.0) * L,
        land_stiffness=cage.land_stiffness * M / T**2,
        unbalance=cage.unbalance * M * L,
    )
    runs = StabilitySettings(kicks=(0.5,), runs=3, duration=0.02)
    ours = run_ensemble(cage, runs)
    theirs = run_ensemble(scaled, replace(runs, duration=runs.duration * T), kicks=(0.5 * L / T,))
    assert np.array_equal(ours.outcome, theirs.outcome)
    assert np.array_equal(ours.energy_growth, theirs.energy_growth)
    assert np.array_equal(ours.largest_offset * L, theirs.largest_offset)
    assert np.array_equal(ours.whirl_frequency / T, theirs.whirl_frequency)


@few
@given(cages(), st.integers(0, 9))
def test_without_friction_a_landless_cage_at_rest_only_loses_energy(cage, seed):
    """No friction, no turning, no land: the energy at the end is below the kick's."""
    calm = replace(cage, ball_cage_friction=0.0, cage_speed=0.0, guidance=Guidance.BALL)
    runs = run_ensemble(calm, StabilitySettings(kicks=(1.0,), runs=2, duration=0.02, seed=seed))
    assert np.all(runs.energy_growth <= 1.0)


@few
@given(cages(), st.integers(0, 9))
def test_the_ledger_closes(cage, seed):
    """Sources and sinks explain the energy to 3 % of the work done, at the step chosen."""
    runs = run_ensemble(cage, StabilitySettings(kicks=(1.0,), runs=2, duration=0.02, seed=seed))
    assert runs.energy_imbalance.max() < 0.03


@few
@given(st.integers(0, 200), st.integers(1, 200))
def test_wilson_interval_holds_its_share(successes, count):
    """The interval lies in 0..1, holds the share, and mirrors with it."""
    successes = min(successes, count)
    low, high = wilson_interval(successes, count)
    assert 0.0 <= low <= successes / count <= high + 1e-15
    mirrored = wilson_interval(count - successes, count)
    np.testing.assert_allclose((low, high), (1 - mirrored[1], 1 - mirrored[0]), atol=1e-12)
