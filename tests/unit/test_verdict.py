"""The rule of the verdict, its evidence and its reasons, on ensembles made for the purpose."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from separatrix.cage import (
    CageMotion,
    Cause,
    Ensemble,
    PlanarCage,
    RunOutcome,
    Verdict,
    judge,
    whirl_probability,
    wilson_interval,
)
from separatrix.cage.closed_forms import drifts, drive_energy, room
from separatrix.study import Guidance

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
GUIDED = replace(CAGE, cage_speed=670.0, guidance=Guidance.OUTER, land_clearance=4e-4)
NOTHING = (
    *("largest_offset", "mean_offset", "offset_spread", "orbit_speed", "drift_rate", "end_energy"),
    *("whirl_frequency", "largest_land_force", "energy_imbalance", "pocket_power", "land_power"),
    *("rubbing_force", "rubbing_speed"),
)
SETTLES, WHIRLS = RunOutcome.SETTLES, RunOutcome.WHIRLS
DRIFTS, UNRESOLVED = RunOutcome.DRIFTS, RunOutcome.UNRESOLVED


def ensemble(
    rows: list[list[RunOutcome]], kicks: tuple[float, ...] = (0.1, 0.5, 2.0), **evidence: object
) -> Ensemble:
    """Ensemble with these outcomes, in which balls were met; evidence is spread over all runs."""
    outcome = np.array(rows, dtype=np.int64)
    floats = dict.fromkeys(NOTHING, 0.0) | {
        "growth_rate": np.where(outcome == WHIRLS, 9.0, -25.0),
        "largest_contact_force": 1.0,
        "followed": 0.3,
        "judged_from": 0.24,
    }
    cause = np.where(outcome == UNRESOLVED, int(Cause.FALLING), int(Cause.NONE))
    whole = {"whirl_direction": 0, "land_impacts": 0, "cause": cause}
    changed = {name: evidence.pop(name) for name in list(evidence) if name in floats | whole}
    spread = {
        name: np.broadcast_to(np.asarray(value, dtype=float if name in floats else int), outcome.shape).copy()
        for name, value in (floats | whole | changed).items()
    }
    impacts = np.zeros((*outcome.shape, CAGE.ball_count), dtype=np.int64)
    given = {"kicks": np.array(kicks[: len(rows)]), "pocket_impacts": impacts, "duration": 0.3}
    return Ensemble(outcome=outcome, **{**spread, **given, **evidence})


def test_wilson_interval_of_nine_in_ten():
    """Wilson's score interval of 9 in 10 is 0.5958 to 0.9821, by his formula solved as a quadratic."""
    low, high = wilson_interval(9, 10)
    z = 1.959963984540054
    # (p - x)^2 = z^2 x (1 - x)/n has these two roots; rounding only
    roots = np.sort(np.roots([1 + z * z / 10, -(2 * 0.9 + z * z / 10), 0.81]).real)
    assert (low, high) == pytest.approx(tuple(roots), abs=1e-12)
    assert wilson_interval(0, 0) == (0.0, 1.0)


def test_a_cage_whose_every_run_settles_is_stable():
    """All runs of all kicks settle: STABLE, CENTRED, with the probability of all."""
    result = judge(CAGE, ensemble([[SETTLES] * 16] * 3))
    assert (result.verdict, result.cage_motion) == (Verdict.STABLE, CageMotion.CENTRED)
    assert result.probability_stable == 1.0
    assert result.reason == "All of the runs settle from the worst kick, 0.1 m/s."


def test_a_cage_whose_every_run_whirls_is_unstable():
    """All runs of all kicks whirl: UNSTABLE; the reason states pace and power of the friction that feeds."""
    fed = {"whirl_frequency": 1500.0, "pocket_power": 11.0, "land_power": -3.0}
    result = judge(CAGE, ensemble([[WHIRLS] * 16] * 3, **fed))
    assert (result.verdict, result.cage_motion) == (Verdict.UNSTABLE, CageMotion.WHIRLING)
    assert result.probability_stable == 0.0
    assert result.reason == (
        "All of the runs from 0.1 m/s whirl, at 1.5e+03 Hz; friction feeds the cage 11 W."
    )
    grown = judge(CAGE, ensemble([[WHIRLS] * 16], whirl_frequency=1500.0))
    assert grown.reason.endswith("; the energy passes 10 times that of kick and frame.")


def test_the_limits_of_a_verdict_are_a_half_and_nine_in_ten():
    """42 of 64 lie above one half beyond their scatter, 38 of 64 do not; settling needs nine in ten."""
    rows = {n: [WHIRLS] * n + [SETTLES] * (64 - n) for n in (42, 38, 7, 6)}
    assert judge(CAGE, ensemble([rows[42]] * 3)).verdict is Verdict.UNSTABLE
    assert judge(CAGE, ensemble([rows[38]] * 3)).verdict is Verdict.UNDECIDED
    assert judge(CAGE, ensemble([rows[7]] * 3)).verdict is Verdict.UNDECIDED
    assert judge(CAGE, ensemble([rows[6]] * 3)).verdict is Verdict.STABLE


def test_verdict_and_probability_are_those_of_the_worst_kick():
    """One kick from which the cage whirls is enough, wherever it stands in the list; every kick is shown."""
    for worst in range(3):
        rows = [[SETTLES] * 16 for _ in range(3)]
        rows[worst] = [WHIRLS] * 15 + [SETTLES]
        result = judge(CAGE, ensemble(rows))
        assert (result.verdict, result.worst_kick) == (Verdict.UNSTABLE, (0.1, 0.5, 2.0)[worst])
        assert result.probability_stable == 1 / 16
        assert (result.probability_low, result.probability_high) == wilson_interval(1, 16)
        assert result.reason.startswith(f"94 % of the runs from {result.worst_kick:g} m/s whirl")
        assert [count.settles for count in result.by_kick] == [1 if i == worst else 16 for i in range(3)]
        assert [count.whirls for count in result.by_kick] == [15 if i == worst else 0 for i in range(3)]


def test_a_whirl_that_is_sure_comes_before_one_that_is_not():
    """A kick from which fewer settle, but less than half whirl for sure, is not the worst."""
    mixed = [WHIRLS] * 8 + [UNRESOLVED] * 8
    result = judge(CAGE, ensemble([mixed, [WHIRLS] * 13 + [SETTLES] * 3]))
    assert (result.verdict, result.worst_kick) == (Verdict.UNSTABLE, 0.5)


def test_an_ensemble_without_a_clear_answer_says_how_many():
    """Half and half: UNDECIDED."""
    result = judge(CAGE, ensemble([[SETTLES, WHIRLS] * 8]))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason == "No clear answer from 0.1 m/s: of 16 runs 8 settle, 8 whirl."


def test_three_runs_are_too_few():
    """Three runs that settle leave an interval down to below one half: UNDECIDED, and four are enough."""
    for outcome in (SETTLES, WHIRLS):
        result = judge(CAGE, ensemble([[outcome] * 3] * 3))
        assert result.verdict is Verdict.UNDECIDED
        assert result.reason == (
            "Too few runs for a verdict: 3 at each kick; set [stability] runs to 4 or more."
        )
    assert judge(CAGE, ensemble([[SETTLES] * 4] * 3)).verdict is Verdict.STABLE
    assert judge(CAGE, ensemble([[WHIRLS] * 4] * 3)).verdict is Verdict.UNSTABLE


@pytest.mark.parametrize(
    ("cause", "words"),
    [
        (Cause.IMPACTS, "impacts accumulate without limit; raise [cage] land_restitution"),
        (Cause.NO_CONTACT, "nothing touches; raise [stability] duration or kicks"),
        (Cause.FALLING, "the motion still loses energy at the end; raise [stability] duration"),
        (Cause.NOT_FINITE, "the motion leaves the range of numbers; lower [stability] kicks"),
    ],
)
def test_unresolved_runs_decide_nothing_and_say_why(cause, words):
    """A run without a plain end is no evidence of stability; the reason names the cause and the key."""
    result = judge(CAGE, ensemble([[UNRESOLVED] * 16] * 3, cause=int(cause)))
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, None)
    assert result.probability_stable == 0.0
    assert result.reason.startswith(f"Of 16 runs from 0.1 m/s 16 are unresolved: {words}")
    assert result.reason.endswith("(followed for 0.3 s).")


def test_a_run_that_leaves_the_range_of_numbers_keeps_a_cage_from_stable():
    """One of 48 would be outvoted, but nothing is known of how far it went: its offset is none."""
    cause = np.zeros((3, 16), dtype=int)
    cause[1, 3] = Cause.NOT_FINITE
    rows = [[UNRESOLVED if c else SETTLES for c in each] for each in cause]
    result = judge(CAGE, ensemble(rows, cause=cause))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason.startswith("In 1 of 48 runs the motion leaves the range of numbers; lower")


def test_a_few_unresolved_runs_do_not_hide_the_others():
    """One of 16 leaves nine in ten that settle, three do not."""
    assert judge(CAGE, ensemble([[SETTLES] * 15 + [UNRESOLVED]] * 3)).verdict is Verdict.STABLE
    few = judge(CAGE, ensemble([[SETTLES] * 13 + [UNRESOLVED] * 3] * 3))
    assert (few.verdict, few.cage_motion) == (Verdict.UNDECIDED, CageMotion.CENTRED)
    assert few.reason.startswith("Of 16 runs from 0.1 m/s 13 settle, 3 are unresolved")


def test_runs_that_drift_are_not_stable():
    """A fifth of the runs left the pockets: UNDECIDED; half of them, and the cage is DRIFTING."""
    fifth = ensemble([[SETTLES] * 16 + [DRIFTS] * 4] * 3, largest_offset=[[1e-4] * 16 + [7e-4] * 4] * 3)
    result = judge(CAGE, fifth)
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, CageMotion.CENTRED)
    assert "passed 0.6 mm, the pocket clearance, in 12 of 60 runs" in result.reason
    assert result.probability_stable == 16 / 20
    most = judge(CAGE, ensemble([[SETTLES] * 7 + [DRIFTS] * 9] * 3))
    assert most.cage_motion is CageMotion.DRIFTING


def test_a_landless_turning_cage_is_never_stable():
    """Its offset grows at any friction; the reason gives the e-fold time, and the law's and measured rate."""
    turning = replace(CAGE, cage_speed=670.0)
    result = judge(turning, ensemble([[DRIFTS] * 16] * 3, drift_rate=2.1))
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, CageMotion.DRIFTING)
    # Z C/(2 M Omega^2) = 11 * 2000/(2 * 0.05 * 670^2) = 0.490 s
    assert "e-fold every 0.49 s (2.04 1/s; measured 2.1 1/s)" in result.reason
    assert result.drift_rate_law == pytest.approx(2 * 0.05 * 670.0**2 / (11 * 2000.0), rel=1e-12)  # rounding
    assert judge(turning, ensemble([[SETTLES] * 16] * 3)).verdict is Verdict.UNDECIDED
    held = judge(GUIDED, ensemble([[SETTLES] * 16] * 3))
    assert (held.verdict, held.drift_rate_law) == (Verdict.STABLE, 0.0)


def test_the_drift_is_that_of_the_runs_that_do_not_whirl():
    """Their median; 0 where all whirl."""
    rates = [[1.0, 2.0, 3.0, 90.0, 80.0, 70.0, 60.0]]
    mostly = ensemble([[SETTLES] * 3 + [WHIRLS] * 4], drift_rate=rates)
    assert judge(CAGE, mostly).drift_rate == 2.0
    assert judge(CAGE, ensemble([[WHIRLS] * 7], drift_rate=rates)).drift_rate == 0.0


def test_turning_or_weight_moves_a_cage_that_nothing_holds():
    """Without a land; one at rest in orbit stays."""
    moved = (replace(CAGE, cage_speed=670.0), replace(CAGE, gravity=9.81))
    assert [drifts(cage) for cage in (*moved, CAGE)] == [True, True, False]
    assert not drifts(replace(GUIDED, gravity=9.81))


def test_whirl_probability_is_the_share_at_each_kick():
    """One of four, and four of four."""
    runs = ensemble([[WHIRLS, SETTLES, UNRESOLVED, DRIFTS], [WHIRLS] * 4])
    assert whirl_probability(runs).tolist() == [0.25, 1.0]


def test_the_growth_rate_is_the_mean_at_the_worst_kick_with_students_interval():
    """The kick from which fewest settle, not that of the fastest run; scipy's interval; rounding only."""
    rates = np.array([[-9.0, -7.0, -8.0, -4.0], [-30.0, -30.0, -30.0, 50.0], [-20.0, -21.0, -22.0, -23.0]])
    rows = [[SETTLES] * 4, [SETTLES] * 4, [SETTLES] * 3 + [WHIRLS]]
    result = judge(CAGE, ensemble(rows, growth_rate=rates))
    assert (result.worst_kick, result.growth_rate) == (2.0, -21.5)
    expected = stats.ttest_1samp(rates[2], 0.0).confidence_interval(0.95)
    assert (result.growth_rate_low, result.growth_rate_high) == pytest.approx(tuple(expected), rel=1e-9)


def test_one_run_has_no_interval():
    """There is no scatter to see in one run: absent, not a number that looks like one."""
    result = judge(CAGE, ensemble([[SETTLES]]))
    assert (result.growth_rate_low, result.growth_rate_high) == (None, None)


def test_the_whirl_ratio_is_the_orbits_speed_over_the_ball_sets():
    """Median of the runs that whirl, here three times backward; a ball set at rest has none."""
    runs = ensemble([[WHIRLS] * 7 + [SETTLES] * 9], orbit_speed=[-2010.0] * 7 + [670.0] * 9)
    assert judge(GUIDED, runs).whirl_ratio == pytest.approx(-3.0, rel=1e-12)  # rounding
    assert judge(CAGE, runs).whirl_ratio is None
    backward = replace(GUIDED, cage_speed=-670.0, inner_speed=-1500.0)  # run as its mirror image
    assert judge(backward, runs).whirl_ratio == judge(GUIDED, runs).whirl_ratio


def test_impacts_are_shared_out_among_pockets_and_land():
    """Pocket 3 takes three of four impacts of pockets, the land one of five of all; no impact, no share."""
    runs = ensemble([[SETTLES] * 8], land_impacts=1)
    runs.pocket_impacts[..., 3], runs.pocket_impacts[..., 7] = 3, 1
    result = judge(CAGE, runs)
    assert result.pocket_impact_shares == (0, 0, 0, 0.75, 0, 0, 0, 0.25, 0, 0, 0)
    assert result.land_impact_share == 0.2
    nothing = judge(CAGE, ensemble([[SETTLES] * 8]))
    assert (sum(nothing.pocket_impact_shares), nothing.land_impact_share) == (0.0, 0.0)


def test_the_class_of_motion_is_that_of_most_runs_from_the_worst_kick():
    """Settled runs that rub are ON THE LAND, others CENTRED; whirl and drift come before either if alike."""
    rubbing = {"rubbing_force": [[5.0] * 16, [5.0] * 10 + [0.0] * 6]}
    rows = [[SETTLES] * 16, [SETTLES] * 10 + [SETTLES] * 6]
    assert judge(GUIDED, ensemble(rows, **rubbing)).cage_motion is CageMotion.ON_THE_LAND
    mixed = ensemble([[SETTLES] * 9 + [WHIRLS] * 7], rubbing_force=[[5.0] * 4 + [0.0] * 5 + [5.0] * 7])
    assert judge(GUIDED, mixed).cage_motion is CageMotion.WHIRLING  # 7 whirl, 4 rub, 5 are centred
    rest = ensemble([[SETTLES] * 9 + [WHIRLS] * 7], rubbing_force=[[5.0] * 9 + [0.0] * 7])
    assert judge(GUIDED, rest).cage_motion is CageMotion.ON_THE_LAND


def test_a_settled_cage_that_rubs_states_force_speed_and_power():
    """Medians over the settled runs; the power is that of the friction: 0.1 times force times speed."""
    rubbing = {"rubbing_force": [[2.0, 4.0, 6.0, 4.0, 90.0]], "rubbing_speed": [[3.0, 3.0, 3.0, 3.0, 9.0]]}
    result = judge(GUIDED, ensemble([[SETTLES] * 4 + [WHIRLS]], **rubbing))
    assert (result.rubbing_force, result.rubbing_speed) == (4.0, 3.0)
    assert result.rubbing_power == pytest.approx(0.1 * 4.0 * 3.0, rel=1e-12)  # rounding
    stable = judge(GUIDED, ensemble([[SETTLES] * 8], rubbing_force=4.0, rubbing_speed=3.0))
    assert stable.reason == (
        "All of the runs settle from the worst kick, 0.1 m/s; the cage then rubs on its land with 4 N at "
        "3 m/s (1.2 W)."
    )


def test_a_centre_far_outside_its_pockets_is_not_stable():
    """A land as wide as 4 mm holds the cage, but 4 mm off in pockets of 0.6 mm nobody calls it stable."""
    wide = replace(GUIDED, land_clearance=8e-3)
    result = judge(wide, ensemble([[SETTLES] * 16] * 3, mean_offset=4e-3, largest_offset=4.1e-3))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason.startswith(
        "The motion settles, but the cage centre ends up to 4 mm off in 48 of 48 runs"
    )
    harmless = ensemble([[SETTLES] * 16] * 2, mean_offset=[[0.0] * 16, [0.0] * 13 + [4e-3] * 3])
    assert judge(wide, harmless).verdict is Verdict.UNDECIDED  # three of 16 from any kick are too many


def test_a_centre_that_was_beyond_its_room_is_not_stable():
    """Twice the half play of 0.3 mm, or twice the land's gap if that is larger, in one run of any kick."""
    offsets = np.full((3, 16), 3e-4)
    offsets[1, 5] = 6.1e-4
    result = judge(GUIDED, ensemble([[SETTLES] * 16] * 3, largest_offset=offsets))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason.startswith(
        "The motion settles, but the cage centre reached 0.61 mm, more than 0.6 mm (clearance 0.2 mm)"
    )
    offsets[1, 5] = 5.9e-4
    assert judge(GUIDED, ensemble([[SETTLES] * 16] * 3, largest_offset=offsets)).verdict is Verdict.STABLE


def test_gravity_unbalance_and_leading_balls_drive_too():
    """(M/2)(Omega w)^2, 2 w (M g + U Omega^2) over the room w = 0.2 mm, (M + J/R^2)(2 V)^2/2, V = 5 cm/s."""
    assert drive_energy(GUIDED) == pytest.approx(0.5 * 0.05 * (670.0 * 2e-4) ** 2, rel=1e-12)  # rounding
    loads = {"gravity": 9.81, "unbalance": 1e-6, "orbital_cosines": (0.03,), "orbital_sines": (0.04,)}
    extra = drive_energy(replace(GUIDED, **loads)) - drive_energy(GUIDED)
    expected = 4e-4 * (0.05 * 9.81 + 1e-6 * 670.0**2) + 0.5 * 0.1 * (2 * 0.05) ** 2
    assert extra == pytest.approx(expected, rel=1e-12)


def test_the_room_is_the_land_or_the_pockets():
    """0.2 mm to the land; 0.3 mm of half play without one."""
    assert (room(GUIDED), room(CAGE)) == (2e-4, 3e-4)
    assert math.isinf(CAGE.land_gap)


def test_evidence_is_the_worst_of_forces_and_offsets_and_the_median_of_the_rest():
    """Largest of the largest over all kicks, among them what a ledger leaves open; medians at the worst."""
    result = judge(
        GUIDED,
        ensemble(
            [[SETTLES] * 3, [SETTLES, SETTLES, WHIRLS]],
            largest_offset=[[1e-4, 3e-4, 2e-4], [1e-4] * 3],
            mean_offset=[[9e-4] * 3, [1e-4, 2e-4, 3e-4]],
            offset_spread=[[9e-4] * 3, [5e-5, 2e-5, 3e-5]],
            largest_land_force=[[5.0, 70.0, 6.0], [1.0] * 3],
            largest_contact_force=[[50.0, 7.0, 6.0], [1.0] * 3],
            energy_imbalance=[[1e-12, 0.0, 1e-3], [0.0] * 3],
            end_energy=[[9.0] * 3, [1e-6, 4e-3, 2e-6]],
            pocket_power=[[9.0] * 3, [-1.0, -1.0, 4.0]],
            land_power=[[9.0] * 3, [-1.0, -1.0, 0.5]],
            rubbing_force=[[9.0] * 3, [2.0, 4.0, 70.0]],
            rubbing_speed=[[9.0] * 3, [1.0, 2.0, 50.0]],
            followed=[[0.1, 0.2, 1.2], [0.3] * 3],
        ),
    )
    assert (result.energy_imbalance, result.longest_run) == (1e-3, 1.2)
    assert (result.largest_land_force, result.largest_contact_force) == (70.0, 50.0)
    assert result.largest_offset == 3e-4
    # of the run that whirls from the worst kick
    assert (result.mean_offset, result.end_energy) == (3e-4, 2e-6)
    assert (result.pocket_power, result.land_power) == (4.0, 0.5)
    # of those that settle from the worst kick: 2 N at 1 m/s and 4 N at 2 m/s
    assert (result.rubbing_force, result.rubbing_speed) == (3.0, 1.5)
    assert result.rubbing_power == GUIDED.land_friction * 5.0
    assert result.orbit_evenness == pytest.approx(0.1, rel=1e-12)  # median of 0.5, 0.1, 0.1; rounding
