"""With clearance: thresholds of the sub-critical instability, and what kick, turning and land do to them.

The targets 0.078, 0.115, 0.165 were computed beforehand by other programs (100 seeds each). What weaker and
stronger kicks do: test_chi_law.
"""

from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST, damping_of, whirl_probability

from separatrix.cage import Cause, PlanarCage, RunOutcome, Verdict, judge, run_ensemble
from separatrix.study import Guidance, StabilitySettings

KICK = 0.5 * AT_REST.mass * 0.5**2
"""Energy of a kick of 0.5 m/s [J]."""

SETTINGS = StabilitySettings(kicks=(0.5,), runs=64, duration=0.3, ball_scatter=0.3)


def cage_at(eta: float, friction: float, **change: object) -> PlanarCage:
    """The case with clearance: c_p 0.3 mm, thin ring free to turn, no land, ball set at rest."""
    cage = replace(AT_REST, race_damping=damping_of(eta), ball_cage_friction=friction)
    return replace(cage, **change)


@pytest.mark.parametrize(("eta", "friction"), [(0.9, 0.078), (0.8, 0.115), (0.6, 0.165)])
def test_one_half_of_the_runs_whirl_at_the_known_friction(eta, friction):
    """By a line through the shares at nine frictions, whirls counted by our outcome and as others count.

    The other programs count runs whose last fifth has more than the kick's energy. Whirls with less count
    here, and not there: our one half lies 9, 9 and 4 % lower, and 192 runs know it to 1 or 2 %.
    """
    frictions = friction * np.linspace(0.75, 1.25, 9)
    found = [run_ensemble(cage_at(eta, f), replace(SETTINGS, runs=192), jobs=2) for f in frictions]
    for shares in (
        [whirl_probability(one)[0] for one in found],
        [np.mean(one.end_energy[:, :64] > KICK) for one in found],  # 64 runs know it to 4 %, twice
    ):
        slope, offset = np.polyfit(frictions, shares, 1)
        # what the published check allows: 9 % by what is counted, 1 % by the scatter
        assert (0.5 - offset) / slope == pytest.approx(friction, rel=0.10)


def test_sub_critical_motion_is_that_of_its_worst_kick():
    """A cage that settles from 0.1 m/s and whirls from 2 m/s is unstable, and both kicks are shown."""
    settings = StabilitySettings(kicks=(0.1, 2.0), runs=24, duration=0.3)
    cage = cage_at(0.6, 0.165)
    result = judge(cage, run_ensemble(cage, settings, jobs=2))
    assert (result.verdict, result.worst_kick) == (Verdict.UNSTABLE, 2.0)
    assert result.by_kick[0].settles > 12
    assert result.by_kick[1].whirls >= 22
    assert result.whirl_direction == 1


def test_a_landless_turning_cage_drifts_out_of_its_pockets():
    """The offset passes 2 c_p on hardly any energy: DRIFTS, UNDECIDED."""
    cage = cage_at(0.2, 0.02, cage_speed=650.0)
    runs = run_ensemble(cage, replace(SETTINGS, runs=16), jobs=2)
    assert np.all(runs.outcome == RunOutcome.DRIFTS)
    assert np.all(runs.end_energy < 0.1 * KICK)
    assert np.all(runs.largest_offset > 6e-4)
    result = judge(cage, runs)
    assert result.verdict is Verdict.UNDECIDED
    assert "drifts" in result.reason


@pytest.mark.parametrize("guidance", [Guidance.OUTER, Guidance.INNER])
def test_a_land_holds_the_same_cage(guidance):
    """On a land of 1.6 mm it goes out to the gap of 0.8 mm and stays, beyond 2 c_p: that is not STABLE."""
    cage = cage_at(0.2, 0.02, cage_speed=650.0, guidance=guidance, land_clearance=1.6e-3)
    runs = run_ensemble(cage, replace(SETTINGS, runs=16), jobs=2)
    # Centrifugal force on the land's spring: M Omega^2 r/K = 1.7 um; rebounds some more
    assert np.all(runs.largest_offset > 7e-4)
    assert np.all(runs.largest_offset < 8.2e-4)
    result = judge(cage, runs)
    assert result.probability_stable == 1.0
    assert result.verdict is Verdict.UNDECIDED, result.reason
    assert "mm" in result.reason


def test_turning_moves_the_threshold():
    """With the ball set turning the balls bunch, and the same friction grows more often (not derived)."""
    settings = replace(SETTINGS, runs=96)
    rest, turning = (
        whirl_probability(run_ensemble(cage_at(0.6, 0.14, cage_speed=speed), settings, jobs=2))[0]
        for speed in (0.0, 650.0)
    )
    assert turning > rest + 0.1


@pytest.mark.parametrize(
    ("change", "sense"),
    [
        ({"guidance": Guidance.INNER}, -1),
        ({"guidance": Guidance.OUTER, "cage_speed": 650.0}, -1),
        ({"guidance": Guidance.OUTER, "inner_speed": 0.0, "outer_speed": 1500.0}, 1),
    ],
    ids=["inner land", "outer land at rest", "outer land turning"],
)
def test_a_land_can_whirl_a_cage_without_pocket_friction(change, sense):
    """Friction on the land alone drives a whirl: against the ring's passing inside, along with it outside.

    It is no whirl of the pockets, and no verdict comes from it.
    """
    cage = cage_at(0.9, 0.0, land_clearance=1e-4, land_friction=0.3, land_restitution=0.8, **change)
    settings = replace(SETTINGS, runs=16, duration=0.1)
    driven = run_ensemble(cage, settings, jobs=2)
    assert np.all(driven.outcome == RunOutcome.SETTLES)
    assert np.all(driven.cause == Cause.LAND_FRICTION)
    assert np.all(driven.whirl_direction == sense)
    assert np.median(driven.land_power) > 0.0
    assert np.all(driven.pocket_power == 0.0)
    found = judge(cage, driven)
    assert (found.verdict, found.by_kick[0].kept_by_land) == (Verdict.UNDECIDED, 16)
    assert "land_friction" in found.reason
    smooth = run_ensemble(replace(cage, land_friction=0.0), settings)
    assert np.all(smooth.outcome == RunOutcome.SETTLES)
    assert np.all(smooth.cause == Cause.NONE)
