"""The rule of the verdict, its evidence and its reasons, on ensembles made for the purpose."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from separatrix.cage import (
    CageMotion,
    Ensemble,
    PlanarCage,
    RunOutcome,
    Verdict,
    growth_probability,
    judge,
    wilson_interval,
)
from separatrix.cage.drive import drifts, drive_energy, room
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
    *("largest_offset", "mean_offset", "offset_spread", "orbit_speed", "drift_rate"),
    *("whirl_frequency", "largest_land_force", "energy_imbalance"),
)
DIES, GROWS, DRIFT, STALLED = RunOutcome.DIES, RunOutcome.GROWS, RunOutcome.DRIFT, RunOutcome.STALLED


def ensemble(
    rows: list[list[RunOutcome]], kicks: tuple[float, ...] = (0.1, 0.5, 2.0), **evidence: object
) -> Ensemble:
    """Ensemble with these outcomes, in which balls were met; evidence is spread over all runs."""
    outcome = np.array(rows, dtype=np.int64)
    floats = dict.fromkeys(NOTHING, 0.0) | {
        "energy_growth": np.where(outcome == GROWS, 100.0, 1e-6),
        "growth_rate": np.where(outcome == GROWS, 9.0, -25.0),
        "largest_contact_force": 1.0,
    }
    whole = {"whirl_direction": 0, "land_impacts": 0}
    changed = {name: evidence.pop(name) for name in list(evidence) if name in floats | whole}
    spread = {
        name: np.broadcast_to(np.asarray(value, dtype=float if name in floats else int), outcome.shape).copy()
        for name, value in (floats | whole | changed).items()
    }
    impacts = np.zeros((*outcome.shape, CAGE.ball_count), dtype=np.int64)
    given = {"kicks": np.array(kicks[: len(rows)]), "pocket_impacts": impacts, "duration": 0.3}
    given["cut"] = np.zeros(outcome.shape, dtype=bool)
    return Ensemble(outcome=outcome, **{**spread, **given, **evidence})


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
    """All runs of all kicks grow: UNSTABLE, and so is the class of its motion."""
    result = judge(CAGE, ensemble([[GROWS] * 16] * 3))
    assert (result.verdict, result.cage_motion) == (Verdict.UNSTABLE, CageMotion.UNSTABLE)


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


def test_runs_in_which_nothing_touches_decide_nothing():
    """Neither ball nor land was met: no verdict, and the sentence says why; the land alone is enough."""
    flight = ensemble([[DIES] * 24], kicks=(0.5,), largest_contact_force=0.0)
    result = judge(CAGE, flight)
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason == (
        "Too short to decide, or too weak a kick: from 0.5 m/s nothing touches in any run (at most 0.3 s)."
    )
    assert judge(CAGE, replace(flight, largest_land_force=flight.kicks + 0 * flight.growth_rate)).verdict is (
        Verdict.STABLE
    )


def test_one_run_that_touches_is_enough_to_decide():
    """A kick between two balls may miss all of them; the next one does not."""
    met = ensemble([[DIES] * 24], kicks=(0.5,), largest_contact_force=[0.0] * 23 + [9.0])
    assert judge(CAGE, met).verdict is Verdict.STABLE


def test_runs_that_drift_are_not_stable():
    """A fifth of the runs left the play: UNDECIDED, and the centre's motion is not called stable for long."""
    result = judge(CAGE, ensemble([[DIES] * 16 + [DRIFT] * 4] * 3))
    assert result.verdict is Verdict.UNDECIDED
    assert "drifts" in result.reason
    assert "12 of 60 runs" in result.reason
    assert result.probability_stable == 48 / 60
    assert judge(CAGE, ensemble([[DIES] * 8 + [DRIFT] * 8] * 3)).cage_motion is CageMotion.UNSTABLE


def test_a_landless_turning_cage_is_never_stable():
    """Its offset grows at any friction; the reason gives the e-fold time, and the law's and measured rate."""
    turning = replace(CAGE, cage_speed=670.0)
    result = judge(turning, ensemble([[DIES] * 16] * 3, drift_rate=2.1))
    assert result.verdict is Verdict.UNDECIDED
    # Z C/(2 M Omega^2) = 11 * 2000/(2 * 0.05 * 670^2) = 0.490 s
    assert "e-fold every 0.49 s (rate 2.04 1/s; measured 2.1 1/s)" in result.reason
    assert result.drift_rate_law == pytest.approx(2 * 0.05 * 670.0**2 / (11 * 2000.0), rel=1e-12)  # rounding
    held = judge(GUIDED, ensemble([[DIES] * 16] * 3))
    assert (held.verdict, held.drift_rate_law) == (Verdict.STABLE, 0.0)


def test_runs_that_were_cut_count_as_those_that_were_followed():
    """Of three that die one was followed, and it circles: so do all three of four."""
    runs = ensemble([[GROWS, DIES, DIES, DIES]], cut=np.array([[False, False, True, True]]))
    assert runs.share(np.array([[False, True, False, False]])).tolist() == [0.75]


def test_a_tenth_that_circles_is_counted_up_where_runs_were_cut():
    """One in eight that were followed is 2.5 of 20: three, and 17 of 20 are less than nine in ten."""
    followed, cut = np.arange(20) < 8, np.arange(20) >= 8
    orbit = {"mean_offset": np.where(followed & (np.arange(20) < 1), 1.9e-4, 0.0), "orbit_speed": -2010.0}
    runs = ensemble([[DIES] * 20], kicks=(0.5,), energy_growth=0.5, cut=cut[np.newaxis], **orbit)
    assert judge(GUIDED, runs).verdict is Verdict.UNDECIDED


def test_the_end_of_a_run_that_was_cut_is_no_evidence():
    """Medians are those of the three that were followed, also where more were cut."""
    ends = {
        "mean_offset": [1e-5, 2e-5, 4e-5] + [9e-5] * 7,
        "offset_spread": [2e-6, 2e-6, 2e-6] + [9e-5] * 7,
        "energy_growth": [1e-6, 2e-6, 9e-6] + [1e-3] * 7,
        "drift_rate": [1.0, 2.0, 4.0] + [0.0] * 7,
        "whirl_frequency": [100.0, 200.0, 400.0] + [900.0] * 7,
    }
    result = judge(GUIDED, ensemble([[DIES] * 10], cut=np.array([[False] * 3 + [True] * 7]), **ends))
    assert (result.mean_offset, result.energy_growth, result.drift_rate) == (2e-5, 2e-6, 2.0)
    assert (result.orbit_evenness, result.whirl_frequency) == (
        pytest.approx(0.1, rel=1e-12),
        200.0,
    )  # rounding


def test_the_drift_is_that_of_the_runs_that_do_not_grow():
    """Their median; 0 where all grow."""
    rates = [[1.0, 2.0, 3.0, 90.0, 80.0, 70.0, 60.0]]
    mostly = ensemble([[DIES] * 3 + [GROWS] * 4], drift_rate=rates)
    assert judge(CAGE, mostly).drift_rate == 2.0
    assert judge(CAGE, ensemble([[GROWS] * 7], drift_rate=rates)).drift_rate == 0.0


def test_turning_or_weight_moves_a_cage_that_nothing_holds():
    """Without a land; one at rest in orbit stays."""
    moved = (replace(CAGE, cage_speed=670.0), replace(CAGE, gravity=9.81))
    assert [drifts(cage) for cage in (*moved, CAGE)] == [True, True, False]
    assert not drifts(replace(GUIDED, gravity=9.81))


def test_stalled_runs_are_undecided():
    """A run that was ended is no evidence of stability."""
    result = judge(CAGE, ensemble([[DIES] * 15 + [STALLED]] * 3))
    assert result.verdict is Verdict.UNDECIDED
    assert result.reason == "3 of 48 runs met too many impacts in no time and were ended."


def test_growth_probability_is_the_share_at_each_kick():
    """One of four, and four of four."""
    runs = ensemble([[GROWS, DIES, DIES, DRIFT], [GROWS] * 4])
    assert growth_probability(runs).tolist() == [0.25, 1.0]


def test_the_growth_rate_is_the_mean_at_the_fastest_kick_with_students_interval():
    """The kick with the largest mean, not the one with the largest run; scipy's interval; rounding only."""
    rates = np.array([[-9.0, -7.0, -8.0, -4.0], [-30.0, -30.0, -30.0, 50.0], [-20.0, -21.0, -22.0, -23.0]])
    result = judge(CAGE, ensemble([[DIES] * 4] * 3, growth_rate=rates))
    assert (result.growth_kick, result.growth_rate) == (0.1, -7.0)
    expected = stats.ttest_1samp(rates[0], 0.0).confidence_interval(0.95)
    assert (result.growth_rate_low, result.growth_rate_high) == pytest.approx(tuple(expected), rel=1e-9)


def test_one_run_has_no_interval():
    """There is no scatter to see in one run: absent, not a number that looks like one."""
    result = judge(CAGE, ensemble([[DIES]]))
    assert (result.growth_rate_low, result.growth_rate_high) == (None, None)


def test_the_whirl_ratio_is_the_orbits_speed_over_the_ball_sets():
    """Median of the runs that grow, here three times backward; a ball set at rest has none."""
    runs = ensemble([[GROWS] * 7 + [DIES] * 9], orbit_speed=[-2010.0] * 7 + [670.0] * 9)
    assert judge(GUIDED, runs).whirl_ratio == pytest.approx(-3.0, rel=1e-12)  # rounding
    assert judge(CAGE, runs).whirl_ratio is None
    backward = replace(GUIDED, cage_speed=-670.0, inner_speed=-1500.0)  # run as its mirror image
    assert judge(backward, runs).whirl_ratio == judge(GUIDED, runs).whirl_ratio


def test_impacts_are_shared_out_among_pockets_and_land():
    """Pocket 3 takes three of four impacts of pockets, the land one of five of all; no impact, no share."""
    runs = ensemble([[DIES] * 8], land_impacts=1)
    runs.pocket_impacts[..., 3], runs.pocket_impacts[..., 7] = 3, 1
    result = judge(CAGE, runs)
    assert result.pocket_impact_shares.tolist() == [0, 0, 0, 0.75, 0, 0, 0, 0.25, 0, 0, 0]
    assert result.land_impact_share == 0.2
    nothing = judge(CAGE, ensemble([[DIES] * 8]))
    assert (nothing.pocket_impact_shares.sum(), nothing.land_impact_share) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("mean", "spread", "speed", "motion"),
    [
        (1.9e-4, 1e-6, 670.0, CageMotion.CIRCLING),  # on the land, round with the balls
        (1.9e-4, 1e-6, -2000.0, CageMotion.CIRCLING),  # backward on the land
        (1.1e-4, 1e-6, 670.0, CageMotion.CIRCLING),  # just beyond half the room to the land
        (1.9e-4, 0.6e-4, 670.0, CageMotion.STABLE),  # no even distance
        (0.9e-4, 1e-6, 670.0, CageMotion.STABLE),  # near the axis
        (1.9e-4, 1e-6, 90.0, CageMotion.STABLE),  # rests: less than a turn in 0.06 s
        (6.1e-4, 1e-6, 670.0, CageMotion.UNSTABLE),  # beyond twice the half play
        (0.0, 0.0, 0.0, CageMotion.STABLE),
    ],
)
def test_the_class_of_motion_is_read_from_the_orbit(mean, spread, speed, motion):
    """Room 0.2 mm, half play 0.3 mm, last window 0.06 s."""
    runs = ensemble([[DIES] * 16] * 3, mean_offset=mean, offset_spread=spread, orbit_speed=speed)
    assert judge(GUIDED, runs).cage_motion is motion


def test_the_class_is_that_of_the_worst_kick():
    """Half of the runs of one kick are enough to name it, less are not."""
    circles = {"mean_offset": [[0.0] * 8 + [1.9e-4] * 8, [0.0] * 16], "orbit_speed": 670.0}
    assert judge(GUIDED, ensemble([[DIES] * 16] * 2, **circles)).cage_motion is CageMotion.CIRCLING
    fewer = {"mean_offset": [[0.0] * 9 + [1.9e-4] * 7, [0.0] * 16], "orbit_speed": 670.0}
    assert judge(GUIDED, ensemble([[DIES] * 16] * 2, **fewer)).cage_motion is CageMotion.STABLE
    grown = ensemble([[GROWS] * 4 + [DIES] * 12] * 2, **circles)
    grown.mean_offset[0, 12:] = 0.0  # four grow, four circle, eight rest
    assert judge(GUIDED, grown).cage_motion is CageMotion.CIRCLING


def test_a_centre_far_outside_its_pockets_is_not_stable():
    """A land as wide as 4 mm holds the cage, but 4 mm off in pockets of 0.6 mm nobody calls it stable."""
    wide = replace(GUIDED, land_clearance=8e-3)
    result = judge(wide, ensemble([[DIES] * 16] * 3, mean_offset=4e-3, largest_offset=4.1e-3))
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, CageMotion.UNSTABLE)
    assert result.reason.startswith(
        "The motion dies, but the cage centre ends up to 4 mm off in 48 of 48 runs"
    )


def test_a_kick_weaker_than_the_turning_frame_is_not_instability():
    """0.1 m/s is 0.25 mJ, the frame gives 0.45 mJ over 0.2 mm: 1.7 times the kick's energy is no growth."""
    assert drive_energy(GUIDED) == pytest.approx(0.5 * 0.05 * (670.0 * 2e-4) ** 2, rel=1e-12)  # rounding
    growth = np.array([[1.7] * 16, [0.07] * 16, [0.004] * 16])
    runs = ensemble([[GROWS] * 16, [DIES] * 16, [DIES] * 16], energy_growth=growth)
    result = judge(GUIDED, runs)
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, CageMotion.STABLE)
    assert result.reason == (
        "Too weak a kick to decide: from 0.1 m/s (0.25 mJ) 100 % of the runs end with more energy than the "
        "kick, but with no more than the turning frame can give without it (0.449 mJ, as a kick of "
        "0.134 m/s)."
    )


def test_growth_beyond_what_drives_the_cage_is_instability():
    """Twice the frame's energy at every kick: UNSTABLE; short of it at one kick: undecided."""
    growth = np.array([[3.6] * 16, [9.0] * 16, [9.0] * 16])
    assert judge(GUIDED, ensemble([[GROWS] * 16] * 3, energy_growth=growth)).verdict is Verdict.UNSTABLE
    growth[0] = 1.7
    assert judge(GUIDED, ensemble([[GROWS] * 16] * 3, energy_growth=growth)).verdict is Verdict.UNDECIDED


def test_a_kick_that_its_drive_outgrows_does_not_count_as_wild():
    """From 0.1 m/s the drive alone, from 0.5 m/s all die, from 2 m/s all grow: sub-critical in between."""
    growth = np.array([[1.7] * 16, [0.01] * 16, [9.0] * 16])
    rows = [[GROWS] * 16, [DIES] * 16, [GROWS] * 16]
    result = judge(GUIDED, ensemble(rows, energy_growth=growth))
    assert result.reason == "Sub-critical: the motion dies from 0.5 m/s and grows from 2 m/s."
    rows[2] = [GROWS] * 4 + [DIES] * 12
    assert judge(GUIDED, ensemble(rows, energy_growth=growth)).reason == (
        "No clear answer: the motion grows in 100 % from 0.1 m/s (by the cage's drive alone: 100 %), "
        "0 % from 0.5 m/s, 25 % from 2 m/s."
    )


def test_gravity_unbalance_and_leading_balls_drive_too():
    """2 w (M g + U Omega^2) over the room w = 0.2 mm, and (M + J/R^2)(2 V)^2/2 with V = 5 cm/s; rounding."""
    loads = {"gravity": 9.81, "unbalance": 1e-6, "orbital_cosines": (0.03,), "orbital_sines": (0.04,)}
    extra = drive_energy(replace(GUIDED, **loads)) - drive_energy(GUIDED)
    expected = 4e-4 * (0.05 * 9.81 + 1e-6 * 670.0**2) + 0.5 * 0.1 * (2 * 0.05) ** 2
    assert extra == pytest.approx(expected, rel=1e-12)
    weak = ensemble([[GROWS] * 16], kicks=(0.1,), energy_growth=2.0)
    assert "than the turning frame, gravity, unbalance and the lead and lag of the balls can give" in (
        judge(replace(GUIDED, **loads), weak).reason
    )


def test_the_room_is_the_land_or_the_pockets():
    """0.2 mm to the land; 0.3 mm of half play without one."""
    assert (room(GUIDED), room(CAGE)) == (2e-4, 3e-4)
    assert math.isinf(CAGE.land_gap)


def test_a_run_that_keeps_circling_neither_dies_nor_grows():
    """Half the kick's energy, on an even orbit, more than the frame gives: no verdict; pace and radius."""
    orbit = {"mean_offset": 1.9e-4, "offset_spread": 1e-6, "orbit_speed": -2010.0}
    result = judge(GUIDED, ensemble([[DIES] * 16], kicks=(0.5,), energy_growth=0.5, **orbit))
    assert (result.verdict, result.cage_motion) == (Verdict.UNDECIDED, CageMotion.CIRCLING)
    assert result.reason == (
        "The motion neither dies nor grows in 100 % of the runs from 0.5 m/s: the centre keeps circling "
        "0.19 mm off the axis, 3 times as fast as the ball set turns, backward, on 50 % of the kick's energy."
    )


@pytest.mark.parametrize(("kick", "energy_growth"), [(0.5, 0.09), (0.2, 0.4)])
def test_a_circle_that_costs_no_energy_is_stable(kick, energy_growth):
    """Less than a tenth of the kick, or 0.4 mJ of the 0.449 mJ that the frame gives: STABLE."""
    orbit = {"mean_offset": 1.9e-4, "offset_spread": 1e-6, "orbit_speed": 670.0}
    result = judge(GUIDED, ensemble([[DIES] * 16], kicks=(kick,), energy_growth=energy_growth, **orbit))
    assert (result.verdict, result.cage_motion) == (Verdict.STABLE, CageMotion.CIRCLING)


def test_evidence_is_the_worst_of_forces_and_offsets_and_the_median_of_the_rest():
    """Largest of the largest, among them what a ledger leaves open; medians of energy, offset and spread."""
    result = judge(
        GUIDED,
        ensemble(
            [[DIES] * 3],
            largest_offset=[1e-4, 3e-4, 2e-4],
            mean_offset=[1e-4, 2e-4, 2e-4],
            offset_spread=[5e-5, 2e-5, 1e-5],
            largest_land_force=[5.0, 70.0, 6.0],
            largest_contact_force=[50.0, 7.0, 6.0],
            energy_imbalance=[1e-12, 0.0, 1e-3],
            energy_growth=[1e-6, 4e-3, 2e-6],
        ),
    )
    assert (result.energy_imbalance, result.energy_growth) == (1e-3, 2e-6)
    assert (result.largest_offset, result.mean_offset) == (3e-4, 2e-4)
    assert result.orbit_evenness == pytest.approx(0.1, rel=1e-12)  # rounding
    assert (result.largest_land_force, result.largest_contact_force) == (70.0, 50.0)
