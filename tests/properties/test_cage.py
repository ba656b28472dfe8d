"""Mirror image, relabelled balls, units, order of the runs, energy: for cages we did not think of."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from cages import followed
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.cage import Ensemble, History, PlanarCage, ensemble, run_ensemble, simulate, wilson_interval
from separatrix.cage.run import Books, books_for
from separatrix.study import Guidance, PocketShape, StabilitySettings

few = settings(max_examples=15, deadline=None, derandomize=True)


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Finite floats, both ends included."""
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


@st.composite
def cages(draw: st.DrawFn) -> PlanarCage:
    """Cages of every guidance, rotation, pocket, excitation and spacing; nothing drawn run by run."""
    mass, radius, count = draw(numbers(0.01, 0.1)), 0.03, draw(st.integers(3, 20))
    speed = draw(numbers(1.0, 1000.0) | st.just(0.0))
    guidance, gap, lobes = draw(st.sampled_from(Guidance)), draw(numbers(5e-5, 5e-4)), draw(st.integers(2, 4))
    waves = draw(st.sampled_from([(), (2e-5,), (1e-5, -2e-5)])) if speed else ()
    return PlanarCage(
        mass=mass,
        moment_of_inertia=mass * radius**2 * draw(numbers(0.8, 1.5)),
        ball_count=count,
        pitch_radius=radius,
        cage_speed=speed,
        inner_speed=draw(numbers(0.0, 2000.0)),
        outer_speed=draw(numbers(0.0, 2000.0)),
        ball_cage_stiffness=draw(numbers(1e6, 8e6)),
        race_damping=draw(numbers(100.0, 10000.0)),
        ball_cage_friction=draw(numbers(0.0, 0.4)),
        guidance=guidance,
        land_clearance=2 * gap,
        land_friction=draw(numbers(0.0, 0.4)),
        land_restitution=draw(numbers(0.2, 1.0)),
        land_count=draw(st.integers(1, 2)),
        land_out_of_round=draw(st.sampled_from([0.0, 0.5])) * gap / lobes**2,
        land_lobes=lobes,
        unbalance=draw(st.sampled_from([0.0, 1e-6])),
        gravity=draw(st.sampled_from([0.0, 9.81])),
        pocket_angles=draw(st.sampled_from([(), uneven(count)])),
        orbital_cosines=tuple(speed * a for a in waves),
        orbital_sines=tuple(speed * 1e-5 for _ in waves),
        ramp_time=draw(st.sampled_from([0.0, 1.5e-3])),
        ramp_start=draw(numbers(0.1, 1.0)),
        **draw(pockets()),
    )


@st.composite
def pockets(draw: st.DrawFn) -> dict[str, object]:
    """Fields of a pocket: play, shape, offset along the axis, and law of contact."""
    shape, play = draw(st.sampled_from(PocketShape)), draw(numbers(1e-4, 1e-3))
    ends = {PocketShape.CYLINDRICAL: play, PocketShape.ELONGATED: play * draw(numbers(0.3, 1.0))}
    end = ends.get(shape, 0.0)
    return {
        "pocket_shape": shape,
        "pocket_clearance": play,
        "pocket_axial_clearance": end if shape is PocketShape.ELONGATED else None,
        "pocket_axial_offset": end / 2 * draw(numbers(-0.8, 0.8)) if end else 0.0,
        "hertz_coefficient": draw(st.none() | numbers(1e8, 1e9)),
    }


def uneven(count: int) -> tuple[float, ...]:
    """Angles of pockets that stand up to 15 % of the pitch off their even places."""
    return tuple(2 * math.pi * (j + 0.15 * math.sin(5.0 * j)) / count for j in range(count))


@st.composite
def drawn_cages(draw: st.DrawFn) -> PlanarCage:
    """The same, some with balls and pockets that every run draws anew."""
    cage = draw(cages())
    loose = draw(st.sampled_from([0.0, 0.1])) * cage.half_play
    spacing = 0.0 if cage.pocket_angles else draw(st.sampled_from([0.0, 0.2]))
    return replace(
        cage,
        pocket_spacing_scatter=spacing,
        ball_diameter_scatter=loose,
        pocket_position_scatter=loose / 2,
    )


def short(cage: PlanarCage, direction: float, lead: np.ndarray) -> History:
    """Run of a few impacts, so that rounding has no time to grow."""
    return followed(cage, 2e-3, kick=1.0, direction=direction, lead=lead, samples=2)


def leads(cage: PlanarCage, seed: int) -> np.ndarray:
    """Some leads within the play."""
    return np.random.default_rng(seed).uniform(-0.3, 0.3, cage.ball_count) * cage.half_play


def mirror(cage: PlanarCage) -> PlanarCage:
    """The cage seen from the other side: ball j at angle a is there ball -j at -a."""
    return replace(
        cage,
        cage_speed=-cage.cage_speed,
        inner_speed=-cage.inner_speed,
        outer_speed=-cage.outer_speed,
        pocket_angles=(*cage.pocket_angles[:1], *(2 * math.pi - a for a in cage.pocket_angles[:0:-1])),
        orbital_cosines=tuple(-a for a in cage.orbital_cosines),
    )


def without_direction(cage: PlanarCage) -> PlanarCage:
    """The cage without what marks a direction in it or in space."""
    marks = {"unbalance": 0.0, "gravity": 0.0, "land_out_of_round": 0.0}
    return replace(cage, **marks, orbital_cosines=(), orbital_sines=())


def counted_from(cage: PlanarCage, shift: int) -> PlanarCage:
    """The cage turned by whole pitches, its balls counted from the same direction in space."""
    if not cage.pocket_angles:
        return cage
    turned = np.roll(np.array(cage.pocket_angles) + 2 * np.pi * shift / cage.ball_count, shift)
    turned[:shift] -= 2 * np.pi
    return replace(cage, pocket_angles=tuple(turned))


def in_units(cage: PlanarCage, L: float, M: float, T: float) -> PlanarCage:
    """The same cage measured in units of length, mass and time that are so much smaller."""
    sizes = [
        (M, ("mass",)),
        (M * L, ("unbalance",)),
        (M * L**2, ("moment_of_inertia",)),
        (M / T, ("race_damping",)),
        (M / T**2, ("ball_cage_stiffness", "land_stiffness")),
        (M / T**2 / L**0.5, ("hertz_coefficient",)),
        (L / T**2, ("gravity",)),
        (L / T, ("orbital_cosines", "orbital_sines")),
        (T, ("ramp_time",)),
        (1 / T, ("cage_speed", "inner_speed", "outer_speed")),
        (L, ("pitch_radius", "pocket_clearance", "pocket_axial_clearance", "pocket_axial_offset")),
        (L, ("land_clearance", "land_out_of_round", "ball_diameter_scatter", "pocket_position_scatter")),
    ]
    scaled = {name: times(getattr(cage, name), size) for size, names in sizes for name in names}
    return replace(cage, **scaled)


def times(value: object, size: float) -> object:
    """A number, or each of several, in units so much smaller; what is absent stays so."""
    if isinstance(value, tuple):
        return tuple(size * part for part in value)
    return None if value is None else size * value


def same(one: Ensemble, other: Ensemble) -> None:
    """Hold every number of two ensembles to be the same to the last bit."""
    for field in fields(Ensemble):
        assert np.array_equal(getattr(one, field.name), getattr(other, field.name)), field.name


@few
@given(cages(), numbers(0.0, 6.0), st.integers(0, 9))
def test_the_mirror_image_runs_mirrored(cage, direction, seed):
    """Rotation and direction mirrored: so is the orbit. 1e-6: rounding after a few impacts."""
    lead = leads(cage, seed)
    one = short(cage, direction, lead)
    other = short(mirror(cage), -direction, -np.roll(lead[::-1], 1))
    np.testing.assert_allclose(other.velocity[-1], one.velocity[-1] * [1, -1], atol=1e-6)
    np.testing.assert_allclose(other.position[-1], one.position[-1] * [1, -1], atol=1e-9)
    np.testing.assert_allclose(other.rotation_rate[-1] * 0.03, -one.rotation_rate[-1] * 0.03, atol=1e-6)


@few
@given(cages(), numbers(0.0, 6.0), st.integers(0, 9), st.integers(1, 19))
def test_relabelling_the_balls_turns_the_picture(cage, direction, seed, shift):
    """Counting from another ball turns everything by its angle, if nothing else marks a direction."""
    cage, shift = without_direction(cage), shift % cage.ball_count
    lead = leads(cage, seed)
    angle = 2 * np.pi * shift / cage.ball_count
    one = short(cage, direction, lead)
    other = short(counted_from(cage, shift), direction + angle, np.roll(lead, shift))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(other.velocity[-1], turn @ one.velocity[-1], atol=1e-6)
    np.testing.assert_allclose(other.position[-1], turn @ one.position[-1], atol=1e-9)
    np.testing.assert_allclose(other.ball_lead[-1], np.roll(one.ball_lead[-1], shift), atol=1e-9)


@few
@given(drawn_cages(), st.integers(-2, 2), st.integers(-2, 2), st.integers(-2, 2))
def test_other_units_change_nothing(cage, length, mass, time):
    """Units that differ by powers of four: the same runs to the last bit, with linear contacts."""
    cage = replace(cage, hertz_coefficient=None)
    L, M, T = 4.0**length, 4.0**mass, 4.0**time
    runs = StabilitySettings(kicks=(0.5,), runs=3, duration=0.02)
    ours = run_ensemble(cage, runs)
    scaled = in_units(cage, L, M, T)
    theirs = run_ensemble(scaled, replace(runs, duration=runs.duration * T), kicks=(0.5 * L / T,))
    assert np.array_equal(ours.outcome, theirs.outcome)
    assert np.array_equal(ours.end_energy * M * L**2 / T**2, theirs.end_energy)
    assert np.array_equal(ours.largest_offset * L, theirs.largest_offset)
    assert np.array_equal(ours.whirl_frequency / T, theirs.whirl_frequency)


@few
@given(cages(), numbers(1e8, 1e9), st.integers(-2, 2), st.integers(-2, 2), st.integers(-2, 2))
def test_other_units_change_nothing_of_hertz_contacts(cage, coefficient, length, mass, time):
    """The same with Hertz contacts, whose power is rounded: to 1e-6 after a few impacts."""
    cage = replace(cage, hertz_coefficient=coefficient)
    L, M, T = 4.0**length, 4.0**mass, 4.0**time
    lead = leads(cage, 1)
    one = short(cage, 0.4, lead)
    scaled = {"kick": L / T, "direction": 0.4, "lead": lead * L, "samples": 2}
    other = followed(in_units(cage, L, M, T), 2e-3 * T, **scaled)
    np.testing.assert_allclose(other.velocity[-1] * T / L, one.velocity[-1], atol=1e-6)
    np.testing.assert_allclose(other.position[-1] / L, one.position[-1], atol=1e-9)


@few
@given(drawn_cages(), st.permutations([0.2, 0.5, 1.0]), st.integers(1, 5))
def test_workers_and_order_of_runs_change_no_bit(cage, kicks, split):
    """Three workers, kicks in any order, runs in two parts: every number of every run is the same."""
    how = StabilitySettings(kicks=tuple(sorted(kicks)), runs=6, duration=5e-3)
    whole = run_ensemble(cage, how)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ensemble, "CHUNK_RADIANS", 500.0)  # a run or a few at a time
        same(run_ensemble(cage, how, jobs=3), whole)
    parts = (0, split), (split, 6 - split)
    parts = [run_ensemble(cage, how, runs=n, first_run=first) for first, n in parts]
    shuffled = run_ensemble(cage, how, kicks=kicks)
    for field in fields(Ensemble):
        value = getattr(whole, field.name)
        if np.ndim(value) >= 2:
            joined = np.concatenate([getattr(part, field.name) for part in parts], axis=1)
            assert np.array_equal(joined, value), field.name
            again = getattr(shuffled, field.name)[np.argsort(kicks)]
            assert np.array_equal(again, value), field.name


@few
@given(drawn_cages())
def test_nothing_is_read_that_a_run_did_not_write(cage):
    """Series that hold NaN from before change no number: no run can know of another."""
    how = StabilitySettings(kicks=(0.5,), runs=3, duration=5e-3)
    clean = run_ensemble(cage, how)

    def used(*sizes: int) -> Books:
        books = books_for(*sizes)
        for name in books.series.dtype.names:
            books.series[name] = np.nan
        books.room.lobes[:] = np.nan
        return books

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ensemble, "books_for", used)
        same(run_ensemble(cage, how), clean)


@few
@given(drawn_cages(), st.integers(0, 3), st.integers(2, 99))
def test_a_history_is_the_run_of_the_ensemble(cage, run, samples):
    """However it is sampled, and whatever the run draws: the same outcome and end to the last bit."""
    how = StabilitySettings(kicks=(0.5,), runs=4, duration=5e-3)
    whole = run_ensemble(cage, how)
    history = simulate(cage, kick=0.5, run=run, seed=how.seed, duration=how.duration, samples=samples)
    assert history.outcome == whole.outcome[0, run]
    assert history.cause == whole.cause[0, run]
    for name in ("end_energy", "growth_rate", "rubbing_force", "rubbing_speed", "judged_from"):
        assert getattr(history, name) == getattr(whole, name)[0, run], name
    assert history.judged_until == whole.followed[0, run]


@few
@given(drawn_cages(), st.integers(0, 9))
def test_without_friction_a_landless_cage_at_rest_only_loses_energy(cage, seed):
    """No friction, no turning, no land, no weight: springs and dampers in series only take."""
    calm = replace(without_direction(cage), ball_cage_friction=0.0, cage_speed=0.0, guidance=Guidance.BALL)
    for run in range(2):
        seen = simulate(calm, kick=1.0, run=run, seed=seed, duration=0.02, until=0.02, samples=4000)
        energy = seen.kinetic_energy + seen.spring_energy
        # rounding; with Hertz contacts, whose force is a series, what the ledger is asked to close to
        assert np.diff(energy).max() < (1e-12 if calm.hertz_coefficient is None else 1e-9) * energy[0]
        assert energy[-1] < energy[0]


@few
@given(drawn_cages(), st.integers(0, 9))
def test_the_ledger_closes(cage, seed):
    """Every source and sink is entered: what is left of the work done is rounding and quadrature."""
    runs = run_ensemble(cage, StabilitySettings(kicks=(1.0,), runs=2, duration=0.02, seed=seed))
    assert runs.energy_imbalance.max() < 1e-9  # what is asked of it; 220 other cages: 3e-10


SLOW = PlanarCage(
    mass=0.0203, moment_of_inertia=5.91e-6, ball_count=7, pitch_radius=0.0166, cage_speed=138.0,
    inner_speed=330.0, outer_speed=0.0, pocket_clearance=5.2e-4, ball_cage_stiffness=1.81e7,
    race_damping=238.0, ball_cage_friction=0.15, guidance=Guidance.BALL, unbalance=3.5e-7, gravity=9.81,
    pocket_position_scatter=2.5e-5,
)  # fmt: skip
BALANCED = PlanarCage(
    mass=0.031, moment_of_inertia=3.5e-5, ball_count=5, pitch_radius=0.0357, cage_speed=600.0,
    inner_speed=1434.0, outer_speed=0.0, pocket_clearance=1.25e-4, ball_cage_stiffness=1.84e7,
    race_damping=100.0, ball_cage_friction=0.38, guidance=Guidance.OUTER, land_clearance=3e-4,
    land_friction=0.17, land_stiffness=2.6e7, land_restitution=0.12, land_count=2, land_out_of_round=8.5e-6,
    land_lobes=3, pocket_position_scatter=5.6e-6,
)  # fmt: skip
OVAL = PlanarCage(
    mass=0.018, moment_of_inertia=6.4e-5, ball_count=24, pitch_radius=0.072, cage_speed=1079.0,
    inner_speed=2589.0, outer_speed=0.0, pocket_clearance=2.4e-4, ball_cage_stiffness=1.3e7,
    race_damping=15000.0, ball_cage_friction=0.23, guidance=Guidance.INNER, gravity=9.81,
    land_clearance=1.7e-4, land_friction=0.28, land_stiffness=5.6e6, land_restitution=0.36, land_count=2,
    land_out_of_round=7.3e-6,
)  # fmt: skip


@pytest.mark.parametrize("kick", [0.07, 0.2])
@pytest.mark.parametrize(
    "cage",
    [SLOW, BALANCED, OVAL, replace(OVAL, hertz_coefficient=1.7e8)],
    ids=["pockets yield as the cage creeps", "forces of four pockets balance", "far way to an oval land",
         "Hertz pockets"],
)  # fmt: skip
def test_the_ledger_closes_where_steps_are_long(cage, kick):
    """Motion so slow that its own series would allow steps in which pockets relax, or the land is passed."""
    runs = run_ensemble(cage, StabilitySettings(kicks=(kick,), runs=8, duration=0.1, seed=3), jobs=2)
    assert runs.energy_imbalance.max() < 1e-9  # seen: 3e-11; without a bound on the step up to 8e-4


@few
@given(st.integers(0, 200), st.integers(1, 200))
def test_wilson_interval_holds_its_share(successes, count):
    """Its ends are the roots of Wilson's quadratic in 0..1, (p - x)^2 = z^2 x (1 - x)/n, about the share."""
    successes = min(successes, count)
    low, high = wilson_interval(successes, count)
    assert 0.0 <= low <= successes / count <= high + 1e-15
    p, z = successes / count, 1.959963984540054
    for x in (low, high):
        assert (p - x) ** 2 == pytest.approx(z * z * x * (1.0 - x) / count, rel=1e-9, abs=1e-12)  # rounding
    assert wilson_interval(0, 0) == (0.0, 1.0)
