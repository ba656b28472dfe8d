"""Records, refusals, random starts and the rule of the verdict."""

import math
from dataclasses import replace

import numpy as np
import pytest

from separatrix.cage import (
    Ensemble,
    PlanarCage,
    RunOutcome,
    Verdict,
    follow,
    growth_probability,
    judge,
    run_ensemble,
    run_hard_ensemble,
    simulate,
    wilson_interval,
)
from separatrix.cage.run import random_start
from separatrix.errors import InputError
from separatrix.study import Guidance, StabilitySettings

CAGE = PlanarCage(
    mass=0.05,
    moment_of_inertia=0.05 * 0.0325**2,
    ball_count=11,
    pitch_radius=0.0325,
    cage_speed=0.0,
    inner_speed=1500.0,
    outer_speed=0.0,
    pocket_clearance=6e-4,
    ball_cage_stiffness=3e6,
    race_damping=2000.0,
    ball_cage_friction=0.1,
)
SETTINGS = StabilitySettings(kicks=(0.5,), runs=2, duration=0.01)


def ensemble(rows: list[list[RunOutcome]], kicks: tuple[float, ...] = (0.1, 0.5, 2.0)) -> Ensemble:
    """Ensemble with these outcomes in which balls were met, and no other evidence to speak of."""
    outcome = np.array(rows, dtype=np.int64)
    nothing = np.zeros(outcome.shape)
    return Ensemble(
        kicks=np.array(kicks[: len(rows)]),
        outcome=outcome,
        energy_growth=nothing,
        largest_offset=nothing,
        drift_rate=nothing,
        whirl_frequency=nothing,
        whirl_direction=np.zeros(outcome.shape, dtype=np.int64),
        largest_contact_force=np.ones(outcome.shape),
        energy_imbalance=nothing,
        duration=0.3,
    )


DIES, GROWS, DRIFT, STALLED = RunOutcome.DIES, RunOutcome.GROWS, RunOutcome.DRIFT, RunOutcome.STALLED


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("mass", 0.0),
        ("mass", math.nan),
        ("moment_of_inertia", -1.0),
        ("ball_count", 0),
        ("pitch_radius", 0.0),
        ("cage_speed", math.inf),
        ("pocket_clearance", -1e-6),
        ("ball_cage_stiffness", 0.0),
        ("race_damping", 0.0),
        ("race_damping", math.nan),
        ("ball_cage_friction", -0.1),
        ("land_restitution", 1.1),
        ("gravity", -9.8),
    ],
)
def test_a_cage_that_cannot_be_is_refused_by_name(field, value):
    """The message names the field."""
    with pytest.raises(InputError, match=field):
        replace(CAGE, **{field: value})


def test_a_guided_cage_needs_the_clearance_of_its_land():
    """Guidance without a clearance is refused, with the cure."""
    with pytest.raises(InputError, match=r"land_clearance is missing.*without a land"):
        replace(CAGE, guidance=Guidance.OUTER)


def test_races_that_grip_the_balls_have_infinite_damping():
    """Eta = 1 is a damping without bound, and its runs are numbers."""
    result = run_ensemble(replace(CAGE, race_damping=math.inf), SETTINGS)
    assert np.all(np.isfinite(result.energy_growth))
    assert np.all(result.energy_growth > 0.0)


@pytest.mark.parametrize("damping", [1e-9, 1e-3, 1e9])
def test_the_balls_yield_stably_at_any_damping(damping):
    """A ball that follows at once, or hardly ever, gives numbers; the first takes all the energy."""
    result = run_ensemble(replace(CAGE, race_damping=damping, ball_cage_friction=0.0), SETTINGS)
    assert np.all(np.isfinite(result.energy_imbalance))
    assert np.all(result.energy_growth < 1.0)


@pytest.mark.parametrize("kicks", [(), (0.0,), (-1.0,), (math.nan,)])
def test_an_ensemble_needs_kicks(kicks):
    """No kick, or one of no speed, is refused."""
    with pytest.raises(InputError, match="kicks"):
        run_ensemble(CAGE, SETTINGS, kicks=kicks)


def test_an_ensemble_needs_runs():
    """No run is refused."""
    with pytest.raises(InputError, match="runs must be at least 1"):
        run_ensemble(CAGE, SETTINGS, runs=0)


def test_a_run_that_nobody_could_wait_for_is_refused():
    """A stiffness that asks for more steps than can be taken is refused with the longest duration."""
    with pytest.raises(InputError, match=r"duration must be at most .* for this cage"):
        run_ensemble(replace(CAGE, ball_cage_stiffness=1e12), replace(SETTINGS, duration=1e4))


def test_samples_of_a_history_are_bounded():
    """One sample, or more than the memory is meant for, is refused."""
    with pytest.raises(InputError, match="samples"):
        simulate(CAGE, kick=0.5, samples=1)


def test_a_ball_cannot_start_outside_its_pocket():
    """A lead beyond the play is refused."""
    with pytest.raises(InputError, match="ball_lead"):
        follow(CAGE, kick=0.5, direction=0.0, ball_lead=np.full(11, 4e-4), duration=0.01)


@pytest.mark.parametrize(
    "change",
    [
        {"guidance": Guidance.OUTER, "land_clearance": 1e-3},
        {"gravity": 9.8},
        {"unbalance": 1e-6},
        {"pocket_clearance": 0.0},
    ],
)
def test_the_hard_form_refuses_what_it_leaves_out(change):
    """Lands, gravity, unbalance and pockets without play belong to the other form."""
    with pytest.raises(InputError, match="hard-impact form"):
        run_hard_ensemble(replace(CAGE, **change), SETTINGS)


def test_a_start_depends_on_seed_and_run_only():
    """Run 3 of seed 5 starts alike however many runs there are, and unlike its neighbours."""
    assert np.array_equal(random_start(5, 3, 11), random_start(5, 3, 11))
    assert np.array_equal(random_start(5, 3, 11), random_start(5, 3, 20)[:12])
    assert not np.array_equal(random_start(5, 3, 11), random_start(5, 4, 11))
    assert not np.array_equal(random_start(5, 3, 11), random_start(6, 3, 11))


def test_starts_are_uniform():
    """Directions fill the circle and leads the play: means of 2000 within four standard errors."""
    starts = np.array([random_start(1, run, 3) for run in range(2000)])
    assert abs(starts[:, 0].mean() - math.pi) < 4 * 2 * math.pi / math.sqrt(12 * 2000)
    assert np.all(np.abs(starts[:, 1:]) <= 1.0)
    assert abs(starts[:, 1:].mean()) < 4 * 2 / math.sqrt(12 * 6000)


def test_wilson_interval_of_nine_in_ten():
    """Wilson's score interval of 9 in 10 is 0.5958 to 0.9821, by his formula solved as a quadratic."""
    low, high = wilson_interval(9, 10)
    z = 1.959963984540054
    # (p - x)^2 = z^2 x (1 - x)/n has these two roots; rounding only
    roots = np.sort(np.roots([1 + z * z / 10, -(2 * 0.9 + z * z / 10), 0.81]).real)
    assert (low, high) == pytest.approx(tuple(roots), abs=1e-12)
    assert wilson_interval(0, 0) == (0.0, 1.0)


def test_a_cage_whose_every_run_dies_is_stable():
    """All runs of all kicks die: STABLE, with the probability of all."""
    result = judge(CAGE, ensemble([[DIES] * 16] * 3))
    assert result.verdict is Verdict.STABLE
    assert result.probability_stable == 1.0
    assert result.reason == "The motion dies in all of the runs at every kick."


def test_a_cage_whose_every_run_grows_is_unstable():
    """All runs of all kicks grow: UNSTABLE."""
    assert judge(CAGE, ensemble([[GROWS] * 16] * 3)).verdict is Verdict.UNSTABLE


def test_a_cage_that_mostly_grows_at_every_kick_is_unstable():
    """42 of 64 lie above one half beyond their scatter, 38 of 64 do not; dying needs nine in ten."""
    mostly, nearly = [GROWS] * 42 + [DIES] * 22, [GROWS] * 38 + [DIES] * 26
    assert judge(CAGE, ensemble([mostly] * 3)).verdict is Verdict.UNSTABLE
    assert judge(CAGE, ensemble([mostly, mostly, nearly])).verdict is Verdict.UNDECIDED
    assert judge(CAGE, ensemble([[DIES] * 57 + [GROWS] * 7] * 3)).verdict is Verdict.UNDECIDED
    assert judge(CAGE, ensemble([[DIES] * 58 + [GROWS] * 6] * 3)).verdict is Verdict.STABLE


def test_a_small_kick_that_dies_and_a_large_one_that_grows_is_sub_critical():
    """The kick decides: UNDECIDED, and the reason names the kicks."""
    result = judge(CAGE, ensemble([[DIES] * 16, [DIES] * 16, [GROWS] * 16]))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason == "Sub-critical: the motion dies from 0.5 m/s and grows from 2 m/s."


def test_an_ensemble_without_a_clear_answer_says_the_shares():
    """Half and half: UNDECIDED."""
    result = judge(CAGE, ensemble([[DIES, GROWS] * 8]))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason == "No clear answer: the motion grows in 50 % from 0.1 m/s."


def test_three_runs_are_too_few():
    """Three runs that die leave an interval down to below one half: UNDECIDED."""
    result = judge(CAGE, ensemble([[DIES] * 3] * 3))
    assert result.verdict is Verdict.UNDECIDED
    assert "Too few runs" in result.reason


def test_runs_that_drift_are_not_stable():
    """A fifth of the runs left the play: UNDECIDED."""
    result = judge(CAGE, ensemble([[DIES] * 16 + [DRIFT] * 4] * 3))
    assert result.verdict is Verdict.UNDECIDED
    assert "drifts" in result.reason
    assert "12 of 60 runs" in result.reason


def test_a_landless_turning_cage_is_never_stable():
    """Its offset grows at any friction; the reason gives the time in which it grows e-fold."""
    turning = replace(CAGE, cage_speed=670.0)
    result = judge(turning, ensemble([[DIES] * 16] * 3))
    assert result.verdict is Verdict.UNDECIDED
    # Z C/(2 M Omega^2) = 11 * 2000/(2 * 0.05 * 670^2) = 0.490 s
    assert "e-fold every 0.49 s" in result.reason
    guided = replace(turning, guidance=Guidance.OUTER, land_clearance=1e-3)
    assert judge(guided, ensemble([[DIES] * 16] * 3)).verdict is Verdict.STABLE


def test_stalled_runs_are_undecided():
    """A run that was ended is no evidence of stability."""
    result = judge(CAGE, ensemble([[DIES] * 15 + [STALLED]] * 3))
    assert result.verdict is Verdict.UNDECIDED
    assert "no time" in result.reason


def test_growth_probability_is_the_share_at_each_kick():
    """One of four, and four of four."""
    runs = ensemble([[GROWS, DIES, DIES, DRIFT], [GROWS] * 4])
    assert growth_probability(runs).tolist() == [0.25, 1.0]


@pytest.mark.parametrize("land", [{}, {"guidance": Guidance.OUTER, "land_clearance": 4e-4}])
def test_a_cage_that_turns_the_other_way_has_the_same_ensemble(land):
    """The mirror image is the same motion: every number agrees, whirl being forward or backward."""
    cage = replace(CAGE, cage_speed=650.0, gravity=9.81, **land)
    mirrored = replace(cage, cage_speed=-650.0, inner_speed=-1500.0)
    there, back = (run_ensemble(one, SETTINGS) for one in (cage, mirrored))
    for name in ("outcome", "energy_growth", "largest_offset", "whirl_frequency", "whirl_direction"):
        np.testing.assert_array_equal(getattr(there, name), getattr(back, name))


def test_a_run_of_a_cage_that_turns_the_other_way_is_the_mirror_image():
    """Followed from its own start it is the same run; 1e-6: rounding after a few impacts."""
    mirrored = replace(CAGE, cage_speed=-650.0, inner_speed=-1500.0)
    seen = simulate(mirrored, kick=0.5, duration=0.005)
    again = follow(
        mirrored,
        kick=0.5,
        direction=float(np.arctan2(seen.velocity[0, 1], seen.velocity[0, 0])),
        ball_lead=seen.ball_lead[0],
        duration=0.005,
    )
    rows = min(len(seen.time), len(again.time))
    np.testing.assert_allclose(seen.position[:rows], again.position[:rows], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(seen.rotation[:rows], again.rotation[:rows], rtol=1e-6, atol=1e-12)


def test_runs_in_which_nothing_touches_decide_nothing():
    """In a microsecond the cage flies half a micrometre: no verdict, and the sentence says why."""
    ensemble = run_ensemble(replace(CAGE, cage_speed=650.0), replace(SETTINGS, runs=24, duration=1e-6))
    judgement = judge(CAGE, ensemble)
    assert judgement.verdict is Verdict.UNDECIDED
    assert judgement.reason == "Too short to decide: from 0.5 m/s nothing touches within 1e-06 s."
