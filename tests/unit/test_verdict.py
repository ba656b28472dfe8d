"""The rule of the verdict, its evidence and its reasons, on ensembles made for the purpose."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST as CAGE
from cages import ensemble
from scipy import stats

from separatrix.cage import (
    CageMotion,
    Cause,
    RunOutcome,
    Verdict,
    judge,
    wilson_interval,
)
from separatrix.cage.closed_forms import axial_drive_energy, drive_energy, room
from separatrix.cage.ending import run_limits
from separatrix.cage.space_body import SpaceBody
from separatrix.study import Guidance, PocketShape

GUIDED = replace(CAGE, cage_speed=670.0, guidance=Guidance.OUTER, land_clearance=4e-4)
SETTLES, WHIRLS = RunOutcome.SETTLES, RunOutcome.WHIRLS
DRIFTS, UNRESOLVED = RunOutcome.DRIFTS, RunOutcome.UNRESOLVED


STABLE, UNSTABLE, UNDECIDED = Verdict.STABLE, Verdict.UNSTABLE, Verdict.UNDECIDED
CENTRED, WHIRLING, ON_THE_LAND = CageMotion.CENTRED, CageMotion.WHIRLING, CageMotion.ON_THE_LAND
WIDE = replace(GUIDED, land_clearance=8e-3)


def many(settles=0, whirls=0, drifts=0, unresolved=0):
    """Outcomes of the runs from each of three kicks."""
    return [[SETTLES] * settles + [WHIRLS] * whirls + [DRIFTS] * drifts + [UNRESOLVED] * unresolved] * 3


def once(most, other):
    """A number of 3 by 16 runs that differs in one run from the second kick."""
    values = np.full((3, 16), most)
    values[1, 5] = other
    return values


ALL_SETTLE = "All of the runs settle from the worst kick, 0.1 m/s"
ALL_WHIRL = "All of the runs from 0.1 m/s whirl, at 1500 Hz"
TOO_FEW = "Too few runs for a verdict: 3 at each kick; set [stability] runs to 4 or more."
OFF = "The motion settles, but the cage centre"
FED = {"whirl_frequency": 1500.0, "pocket_power": 11.0, "land_power": -3.0}
RUBS = {"rubbing_force": 4.0, "rubbing_speed": 3.0}
JUDGED = [
    (CAGE, many(16), {}, "STABLE CENTRED", f"{ALL_SETTLE}."),
    (CAGE, many(0, 16), FED, "UNSTABLE WHIRLING", f"{ALL_WHIRL}; friction feeds the cage 11 W."),
    (
        *(CAGE, many(0, 16), {"whirl_frequency": 1500.0}, "UNSTABLE WHIRLING"),
        f"{ALL_WHIRL}; the energy passes 10 times that of kick and frame.",
    ),
    # 42 of 64 lie above one half beyond their scatter, 38 do not; settling needs nine in ten
    (CAGE, many(22, 42), {}, "UNSTABLE WHIRLING", "66 % of the runs from 0.1 m/s whirl"),
    (CAGE, many(26, 38), {}, "UNDECIDED WHIRLING", "No clear answer from 0.1 m/s"),
    (CAGE, many(57, 7), {}, "UNDECIDED CENTRED", "No clear answer from 0.1 m/s"),
    (CAGE, many(58, 6), {}, "STABLE CENTRED", "91 % of the runs settle"),
    (
        CAGE,
        many(8, 8),
        {},
        "UNDECIDED WHIRLING",
        "No clear answer from 0.1 m/s: of 16 runs 8 settle, 8 whirl.",
    ),
    (CAGE, many(3), {}, "UNDECIDED CENTRED", TOO_FEW),
    (CAGE, many(0, 3), {}, "UNDECIDED WHIRLING", TOO_FEW),
    (CAGE, many(4), {}, "STABLE CENTRED", ALL_SETTLE),
    (CAGE, many(0, 4), {}, "UNSTABLE WHIRLING", "All of the runs from 0.1 m/s whirl"),
    # one run beyond the range of numbers keeps a cage from STABLE: nothing is known of how far it went
    (
        *(CAGE, [*many(16)[:2], many(15, 0, 0, 1)[0]], {"cause": int(Cause.NOT_FINITE)}, "UNDECIDED CENTRED"),
        "In 1 of 48 runs the motion leaves the range of numbers; lower",
    ),
    # a few other unresolved runs do not hide the others
    (CAGE, many(15, 0, 0, 1), {}, "STABLE CENTRED", "94 % of the runs settle"),
    (CAGE, many(13, 0, 0, 3), {}, "UNDECIDED CENTRED", "Of 16 runs from 0.1 m/s 13 settle, 3 are unresolved"),
    (
        *(CAGE, many(16, 0, 4), {"largest_offset": [[1e-4] * 16 + [7e-4] * 4] * 3}, "UNDECIDED CENTRED"),
        "The cage has no land and drifts: its offset passed 0.6 mm, the pocket clearance, in 12 of 60 runs",
    ),
    (CAGE, many(7, 0, 9), {}, "UNDECIDED DRIFTING", "The cage has no land and drifts"),
    (
        *(GUIDED, many(8), RUBS, "STABLE ON_THE_LAND"),
        f"{ALL_SETTLE}; the cage then rubs on its land with 4 N at 3 m/s (1.2 W).",
    ),
    # a land of 8 mm holds the cage, but 4 mm off in pockets of 0.6 mm nobody calls it stable
    (
        WIDE,
        many(16),
        {"mean_offset": 4e-3},
        "UNDECIDED CENTRED",
        f"{OFF} ends up to 4 mm off in 48 of 48 runs",
    ),
    (
        *(WIDE, many(16), {"mean_offset": [[0.0] * 16, [0.0] * 13 + [4e-3] * 3, [0.0] * 16]}),
        *("UNDECIDED CENTRED", f"{OFF} ends up to 4 mm off in 3 of 48 runs"),
    ),
    # twice the half play of 0.3 mm, or twice the land's gap if that is larger, in one run of any kick
    (
        *(GUIDED, many(16), {"largest_offset": once(3e-4, 6.1e-4)}, "UNDECIDED CENTRED"),
        f"{OFF} reached 0.61 mm, more than 0.6 mm (clearance 0.2 mm)",
    ),
    (GUIDED, many(16), {"largest_offset": once(3e-4, 5.9e-4)}, "STABLE CENTRED", ALL_SETTLE),
]


@pytest.mark.parametrize(("cage", "rows", "evidence", "found", "reason"), JUDGED, ids=range(len(JUDGED)))
def test_a_cage_is_judged_by_its_runs_with_a_reason(cage, rows, evidence, found, reason):
    """Verdict, class of motion and probability of the ensemble; what the reason begins with."""
    result = judge(cage, ensemble(rows, **evidence))
    assert f"{result.verdict.name} {result.cage_motion.name}" == found
    assert result.probability_stable == rows[-1].count(SETTLES) / len(rows[-1])
    assert result.reason.startswith(reason), result.reason


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
    result = judge(CAGE, ensemble(many(0, 0, 0, 16), cause=int(cause)))
    assert (result.verdict, result.cage_motion, result.probability_stable) == (UNDECIDED, None, 0.0)
    assert result.reason.startswith(f"Of 16 runs from 0.1 m/s 16 are unresolved: {words}")
    assert result.reason.endswith("(followed for 0.3 s).")


def test_verdict_and_probability_are_those_of_the_worst_kick():
    """One kick from which the cage whirls is enough, wherever it stands in the list; every kick is shown."""
    for worst in range(3):
        rows = [[SETTLES] * 16 for _ in range(3)]
        rows[worst] = [WHIRLS] * 15 + [SETTLES]
        result = judge(CAGE, ensemble(rows))
        assert (result.verdict, result.worst_kick) == (UNSTABLE, (0.1, 0.5, 2.0)[worst])
        assert result.probability_stable == 1 / 16
        assert (result.probability_low, result.probability_high) == wilson_interval(1, 16)
        assert result.reason.startswith(f"94 % of the runs from {result.worst_kick:g} m/s whirl")
        assert [count.settles for count in result.by_kick] == [1 if i == worst else 16 for i in range(3)]
        assert [count.whirls for count in result.by_kick] == [15 if i == worst else 0 for i in range(3)]


def test_a_whirl_that_is_sure_comes_before_one_that_is_not():
    """A kick from which fewer settle, but less than half whirl for sure, is not the worst."""
    mixed = [WHIRLS] * 8 + [UNRESOLVED] * 8
    result = judge(CAGE, ensemble([mixed, [WHIRLS] * 13 + [SETTLES] * 3]))
    assert (result.verdict, result.worst_kick) == (UNSTABLE, 0.5)


def test_a_landless_turning_cage_is_never_stable():
    """Its offset grows at any friction; the reason gives the e-fold time, and the law's and measured rate."""
    turning = replace(CAGE, cage_speed=670.0)
    result = judge(turning, ensemble([[DRIFTS] * 16] * 3, drift_rate=2.1))
    assert (result.verdict, result.cage_motion) == (UNDECIDED, CageMotion.DRIFTING)
    # Z C/(2 M Omega^2) = 11 * 2000/(2 * 0.05 * 670^2) = 0.490 s
    assert "e-fold every 0.49 s (2.04 1/s; measured 2.1 1/s)" in result.reason
    assert result.drift_rate_law == pytest.approx(2 * 0.05 * 670.0**2 / (11 * 2000.0), rel=1e-12)  # rounding
    assert judge(turning, ensemble([[SETTLES] * 16] * 3)).verdict is UNDECIDED
    held = judge(GUIDED, ensemble([[SETTLES] * 16] * 3))
    assert (held.verdict, held.drift_rate_law) == (STABLE, 0.0)


def test_the_drift_is_that_of_the_runs_that_do_not_whirl():
    """Their median; 0 where all whirl."""
    rates = [[1.0, 2.0, 3.0, 90.0, 80.0, 70.0, 60.0]]
    mostly = ensemble([[SETTLES] * 3 + [WHIRLS] * 4], drift_rate=rates)
    assert judge(CAGE, mostly).drift_rate == 2.0
    assert judge(CAGE, ensemble([[WHIRLS] * 7], drift_rate=rates)).drift_rate == 0.0


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
    """Median of the runs that whirl, as most do, three times backward; a ball set at rest has none."""
    runs = ensemble([[WHIRLS] * 9 + [SETTLES] * 7], orbit_speed=[-2010.0] * 9 + [670.0] * 7)
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
    """Settled runs count together, ON THE LAND if most of them rub; whirl and drift come first if alike."""
    rubbing = {"rubbing_force": [[5.0] * 16, [5.0] * 10 + [0.0] * 6]}
    rows = [[SETTLES] * 16, [SETTLES] * 10 + [SETTLES] * 6]
    assert judge(GUIDED, ensemble(rows, **rubbing)).cage_motion is ON_THE_LAND
    mixed = ensemble([[SETTLES] * 9 + [WHIRLS] * 7], rubbing_force=[[5.0] * 4 + [0.0] * 5 + [5.0] * 7])
    assert judge(GUIDED, mixed).cage_motion is CENTRED  # 7 whirl, 4 rub, 5 are centred
    assert judge(GUIDED, ensemble([[SETTLES] * 8 + [WHIRLS] * 8])).cage_motion is WHIRLING
    rest = ensemble([[SETTLES] * 9 + [WHIRLS] * 7], rubbing_force=[[5.0] * 9 + [0.0] * 7])
    assert judge(GUIDED, rest).cage_motion is ON_THE_LAND


def test_a_settled_cage_that_rubs_states_force_speed_and_power():
    """Medians over the settled runs; the power is that of the friction: 0.1 times force times speed."""
    rubbing = {"rubbing_force": [[2.0, 4.0, 6.0, 4.0, 90.0]], "rubbing_speed": [[3.0, 3.0, 3.0, 3.0, 9.0]]}
    result = judge(GUIDED, ensemble([[SETTLES] * 4 + [WHIRLS]], **rubbing))
    assert (result.rubbing_force, result.rubbing_speed) == (4.0, 3.0)
    assert result.rubbing_power == pytest.approx(0.1 * 4.0 * 3.0, rel=1e-12)  # rounding


def test_gravity_unbalance_and_leading_balls_drive_too():
    """(M/2)(Omega w)^2, 2 w (M g + U Omega^2) over the room w = 0.2 mm, (M + J/R^2)(2 V)^2/2, V = 5 cm/s."""
    assert drive_energy(GUIDED) == pytest.approx(0.5 * 0.05 * (670.0 * 2e-4) ** 2, rel=1e-12)  # rounding
    loads = {"gravity": 9.81, "unbalance": 1e-6, "orbital_cosines": (0.03,), "orbital_sines": (0.04,)}
    extra = drive_energy(replace(GUIDED, **loads)) - drive_energy(GUIDED)
    expected = 4e-4 * (0.05 * 9.81 + 1e-6 * 670.0**2) + 0.5 * 0.1 * (2 * 0.05) ** 2
    assert extra == pytest.approx(expected, rel=1e-12)


def test_a_leaning_axis_and_gravity_along_it_drive_in_space():
    """2 w_z (M g_z + |J_p - J_t| Omega^2 delta / R), w_z = 0.3 mm in bores; the fluid's mass turns too.

    Neither presses the cage on its land, and a cage whose axial motion nothing limits falls for ever.
    """
    body = SpaceBody(transverse_inertia=4e-5, ball_spin=(1.0, 0.0, 0.0), ball_diameter=0.011)
    plain = replace(GUIDED, pocket_shape=PocketShape.CYLINDRICAL, space=body)
    loads = {"axial_gravity": -9.81, "dynamic_unbalance": 1e-3}
    loaded = replace(plain, space=replace(body, **loads))
    tilting = abs(plain.moment_of_inertia - 4e-5) * 670.0**2 * 1e-3 / plain.pitch_radius
    assert drive_energy(plain) == drive_energy(GUIDED)
    extra = drive_energy(loaded) - drive_energy(plain)
    assert extra == pytest.approx(6e-4 * (0.05 * 9.81 + tilting), rel=1e-9)
    held = replace(body, **loads, is_tilt_held=True, is_axially_held=True)
    assert axial_drive_energy(replace(plain, space=held)) == 0.0
    assert axial_drive_energy(replace(loaded, pocket_shape=PocketShape.SQUARE)) == 0.0
    wet = replace(plain, space=replace(body, added_mass=0.03))
    assert drive_energy(wet) == pytest.approx(0.08 / 0.05 * drive_energy(plain), rel=1e-12)
    # over the mass that moves, as the kernels count
    assert run_limits(wet, 0.5, 0.3).drive == pytest.approx(
        run_limits(plain, 0.5, 0.3).drive, rel=1e-12, abs=0.0
    )
    still = replace(loaded, cage_speed=0.0, inner_speed=0.0)
    assert (run_limits(still, 0.5, 0.3).reach, run_limits(loaded, 0.5, 0.3).reach > 0.0) == (0.0, True)


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
    # of those from the worst kick that settle, as most do; they rub with 2 N at 1 m/s and 4 N at 2 m/s
    assert result.mean_offset == pytest.approx(1.5e-4, rel=1e-12)  # rounding of a mean of two
    assert result.end_energy == pytest.approx(2.0005e-3, rel=1e-12)  # rounding of a mean of two
    assert (result.pocket_power, result.land_power) == (-1.0, -1.0)
    assert (result.rubbing_force, result.rubbing_speed) == (3.0, 1.5)
    assert result.rubbing_power == GUIDED.land_friction * 5.0
    assert result.orbit_evenness == pytest.approx(0.3, rel=1e-12)  # rounding of the mean of 0.5 and 0.1
