"""The outcome of a run is where its motion ends: kicks, loads, land friction, states beyond all range."""

from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from sane_studies import sane_study

from separatrix import Judgement, StabilitySettings, Verdict, judge, read_study, solve
from separatrix.cage import Cause, Ensemble, MovingCage, RunOutcome, moving_cage, run_ensemble
from separatrix.cage import outcome as rules
from separatrix.cage.closed_forms import drive_energy
from separatrix.cage.disturbance import settings_for
from separatrix.cage.rows import LOOK_COLUMNS, of
from separatrix.verdict.critical_friction import cage_at
from separatrix.verdict.judgement import judge_solution
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.long_look import long_look, look_record, seen_for_longer
from separatrix.verdict.reasons import CageMotion, largest_room

RUNS, DURATION = 8, 0.1
KICKS = (0.1, 0.5, 2.0, 4.0)


@lru_cache
def shipped(name: str, radial_load: float = 0.0, friction: float = 0.08) -> MovingCage:
    """Cage of a shipped study with another radial load [N] and pocket friction [-]."""
    study = read_study(name, "paper")
    study = replace(study, operation=replace(study.operation, radial_load=radial_load))
    return moving_cage(solve(study), friction)


def wheel(friction: float) -> MovingCage:
    """Cage of the momentum wheel with the pocket stiffness of a cage of 3.5 GPa, whatever the candidate's."""
    return replace(shipped("momentum-wheel", friction=friction), ball_cage_stiffness=1.9e6)


def ends(cage: MovingCage, kicks: tuple[float, ...]) -> Ensemble:
    """A few runs from each kick."""
    return run_ensemble(cage, StabilitySettings(kicks=kicks, runs=RUNS, duration=DURATION))


def test_a_whirl_is_one_from_a_weak_kick_and_from_a_strong_one():
    """Dry phenolic, f 0.30: from 0.5 and from 4 m/s alike; the friction of the pockets feeds it."""
    runs = ends(wheel(0.30), KICKS)
    for kick in (0.5, 4.0):
        at = KICKS.index(kick)
        assert np.count_nonzero(runs.outcome[at] == RunOutcome.WHIRLS) >= RUNS - 1
        assert np.median(runs.end_energy[at]) > 1e-3  # J, against the 0.003 mJ that the frame can give
        fed = runs.pocket_power[at][runs.pocket_power[at] != 0.0]
        assert np.median(fed) > 1.0  # W, into 3.5 g
    levels = np.median(runs.end_energy, axis=1)
    # one whirl: its energy wanders by a third
    assert levels[KICKS.index(0.5)] == pytest.approx(levels[KICKS.index(4.0)], rel=0.5)


def test_a_run_is_not_settled_before_it_touches_anything():
    """A kick of 1 mm/s meets its first pocket after 0.15 s: a run of 0.1 s goes on until then."""
    found = ends(wheel(0.08), (1e-3,))
    assert np.all(found.outcome == RunOutcome.SETTLES)
    assert found.followed.min() > DURATION
    assert found.pocket_impacts.sum(axis=2).min() > 0


@lru_cache
def of_the_pump(radial_load: float) -> Judgement:
    """Verdict on the liquid oxygen turbopump from its default kicks."""
    cage = shipped("lox-turbopump", radial_load)
    return judge(cage, run_ensemble(cage, StabilitySettings(runs=4, duration=DURATION)))


@pytest.mark.parametrize("radial_load", [0.0, 500.0])
def test_a_fast_or_radially_loaded_bearing_is_decided(radial_load):
    """Liquid oxygen turbopump, 40 000 rpm, f 0.08, default kicks: STABLE with and without a radial load."""
    found = of_the_pump(radial_load)
    assert (found.verdict, found.probability_stable) == (Verdict.STABLE, 1.0), found.reason


def test_a_settled_cage_that_rubs_its_land_says_how_hard():
    """Thrown out by the turning frame it rides on the land: its class, force, speed and heat are stated."""
    cage, found = shipped("lox-turbopump"), of_the_pump(0.0)
    assert found.cage_motion is CageMotion.ON_THE_LAND
    # judged as soon as its offset moves by less than 5 %, from where it still rebounds a little
    assert found.mean_offset == pytest.approx(cage.land_gap, rel=0.05)
    # M Omega^2 r presses a cage that turns with its balls; the pockets carry part of it
    pressed = cage.mass * cage.cage_speed**2 * cage.land_gap
    assert 0.3 * pressed < found.rubbing_force < 1.02 * pressed
    sliding = abs(cage.inner_speed - cage.cage_speed) * cage.pitch_radius
    assert found.rubbing_speed == pytest.approx(sliding, rel=0.05)  # the cage turns with its balls
    expected = cage.land_friction * found.rubbing_force * found.rubbing_speed
    assert found.rubbing_power == pytest.approx(expected, rel=0.02)  # products of medians, not the medians
    assert found.pocket_power < 1e-3 * found.rubbing_power
    assert "rubs on its land" in found.reason


def test_friction_on_the_land_may_only_drag():
    """Without pocket friction, at land friction 0.1; what it may drive, too: test_cage_clearance."""
    dragged = ends(replace(shipped("momentum-wheel", friction=0.0), land_friction=0.1), (0.1, 2.0))
    assert np.all(dragged.outcome == RunOutcome.SETTLES)
    assert np.all(dragged.cause == Cause.NONE)


def test_a_whirl_weaker_than_the_loads_rolls_whatever_the_duration():
    """Unevenly driven balls hold the cage; dead pockets whirl it, at a seventh of their energy."""
    cage = cage_at(shipped("lox-turbopump", 500.0), 0.0, 0.45)
    settings = StabilitySettings(duration=0.15)
    found = run_ensemble(cage, settings, kicks=(0.9,), runs=RUNS)
    rolls = found.outcome == RunOutcome.ROLLS
    # Pockets feed it, and no verdict calls it unstable: it rolls, from half to twice the usual duration.
    assert np.count_nonzero(rolls) > RUNS // 2
    assert np.all(found.end_energy[rolls] < 0.5 * drive_energy(cage))
    assert np.all(found.pocket_power[rolls] > 0.0)
    assert judge(cage, found).verdict is not Verdict.UNSTABLE
    longer = run_ensemble(cage, replace(settings, duration=0.6), kicks=(0.9,), runs=RUNS)
    # so near its threshold a whirl may end by chance
    assert np.count_nonzero(longer.outcome != found.outcome) <= 1


def seen_on_a_land(land_friction: float) -> tuple[Judgement, Judgement | None]:
    """Judgement and long look of a gyro's cage of 32 mg that rubs on its inner land."""
    with TemporaryDirectory() as folder:
        study = sane_study(1, Path(folder))
    state = solve(replace(study, cage=replace(study.cage, land_friction=land_friction)))
    settings = replace(settings_for(study.stability, moving_cage(state, 0.05)), runs=16, duration=0.1)
    judged = judge_solution(state, 0.05, partial(Runner().whole_ensemble, settings=settings))
    return judged, long_look(state, 0.05, settings, Runner(), 16)


def test_a_land_that_takes_over_a_calm_cage_keeps_it_from_stable():
    """At a land friction of 0.4, 15 of 16 runs settle within 0.1 s, and most whirl within 1 s."""
    judged, look = seen_on_a_land(0.4)
    assert (judged.verdict, look.worst.runs) == (Verdict.STABLE, 16)
    assert look.longest_run == pytest.approx(1.0, rel=0.01)  # to the end of a look, of 2 ms
    assert look.worst.whirls == look.worst.whirls_by_land > 8  # 12
    kept = look_record(look, 0.05)
    assert (kept.duration, kept.count, kept.takes_over) == (look.longest_run, look.worst, True)
    assert 0.5 < look.largest_land_force < 5.0  # N, 1.6; the weight is 0.3 mN
    assert (open_end := seen_for_longer(judged, look, None)).verdict is Verdict.UNDECIDED
    assert f"{look.worst.whirls} of 16 runs end whirling round the land" in open_end.reason
    longer = seen_for_longer(replace(judged, force_exceeds_races=True, largest_offset=1.0), look, look)
    assert (open_end.driven_by_land, longer.force_exceeds_races, longer.largest_offset) == (True, True, 1.0)
    assert (longer.verdict, longer.is_by_land, longer.worst) == (Verdict.UNSTABLE, True, look.worst)
    assert longer.probability_stable == look.worst.probability_stable < 0.5
    assert (longer.cage_motion, longer.rubbing_power) == (CageMotion.WHIRLING, look.rubbing_power)
    assert (longer.duration, longer.longest_run) == (judged.duration, look.longest_run)  # asked, and run
    counts = (replace(look.worst, settles=16 - n, whirls=n, whirls_by_land=n) for n in (1, 2))
    few, some = (replace(look, by_kick=(one,)) for one in counts)
    assert seen_for_longer(judged, few, look) == judged  # less than a tenth
    assert seen_for_longer(judged, look, some).verdict is Verdict.UNDECIDED
    calm = seen_for_longer(judged, look, few)
    assert (calm.verdict, calm.worst.whirls) == (Verdict.STABLE, 1)
    assert calm.reason.endswith(look.reason)
    assert seen_for_longer(unstable := replace(judged, verdict=Verdict.UNSTABLE), look, look) == unstable
    # at 0.05 none whirls; without friction, as without a land, nothing could drive it
    judged, look = seen_on_a_land(0.05)
    assert look.worst.whirls == 0
    assert seen_on_a_land(0.0)[1] is None


def test_a_state_that_leaves_the_range_of_numbers_is_not_settled():
    """NaN once counted as a motion that dies."""
    looks = np.full((1, of(LOOK_COLUMNS)), np.nan, np.float32)
    end = rules.end_of_motion.py_func(looks, 0, True, False, np.zeros(rules.LIMITS))
    assert end == (RunOutcome.UNRESOLVED, Cause.NOT_FINITE)
    cage = shipped("cryogenic-turbopump")
    found = ends(cage, (0.1,))
    assert judge(cage, found).verdict is Verdict.STABLE
    outcome, cause = found.outcome.copy(), found.cause.copy()
    outcome[0, 0], cause[0, 0] = end
    assert judge(cage, replace(found, outcome=outcome, cause=cause)).verdict is Verdict.UNDECIDED


def test_a_cage_that_leaves_its_room_is_not_stable():
    """A land of 1 nm and a kick of 1000 m/s: the numbers hold, and say that it was 24 mm off centre."""
    cage = replace(shipped("cryogenic-turbopump"), land_clearance=1e-9)
    found = run_ensemble(cage, StabilitySettings(kicks=(1000.0,), runs=8, duration=5e-3))
    assert np.isfinite(found.end_energy).all()
    assert found.largest_offset.min() > max(1e-3, largest_room(cage))
    assert judge(cage, found).verdict is not Verdict.STABLE


@pytest.mark.parametrize(
    ("first", "last", "looks", "fed", "end"),
    [
        *((20.0, 20.0, 10, 50.0, (1, 5)), (40.0, 11.0, 10, 50.0, (-1, 0))),  # plain only if it does not fall
        *((2.0, 2.0, 50, 50.0, (1, 5)), (3.6, 1.2, 50, 50.0, (0, 0)), (0.9, 0.9, 50, 50.0, (0, 0))),
        *((2.0, 2.0, 50, 0.21, (1, 5)), (2.0, 2.0, 50, 0.19, (0, 0))),  # ten looks have to turn it over
    ],
)
def test_what_friction_on_the_land_sustains_whirls(first, last, looks, fed, end):
    """Above the drive energy and not falling: plain, or by the last fifth; below, the cage rubs."""
    seen, limits = np.zeros((looks, 64)), np.zeros(rules.LIMITS)
    seen[:, rules.ENERGY] = np.linspace(first, last, looks)
    seen[:, rules.LAND] = fed
    limits[[rules.DRIVE, rules.MOST]] = 1.0, 40.0
    assert rules.end_of_motion.py_func(seen, looks - 1, True, False, limits) == end
