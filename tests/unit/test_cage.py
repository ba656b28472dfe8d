"""Records, refusals and random starts."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST as CAGE
from cages import followed

from separatrix.cage import run_ensemble, run_hard_ensemble, simulate
from separatrix.cage.closed_forms import drifts, drive_energy, time_unit
from separatrix.cage.ending import PLACE, run_limits
from separatrix.cage.ensemble import random_starts
from separatrix.cage.run import random_start
from separatrix.errors import InputError
from separatrix.study import Guidance, StabilitySettings

SETTINGS = StabilitySettings(kicks=(0.5,), runs=2, duration=0.01)


@pytest.mark.parametrize("damping", [0.1, 1.0, 1e9, math.inf])
def test_the_balls_yield_stably_at_any_damping(damping):
    """A ball that follows at once, hardly ever or, gripped by its races, never: numbers, and no energy."""
    result = run_ensemble(replace(CAGE, race_damping=damping, ball_cage_friction=0.0), SETTINGS)
    assert np.all(np.isfinite(result.energy_imbalance))
    assert np.all(result.end_energy > 0.0)
    assert np.all(result.end_energy < 0.5 * CAGE.mass * 0.5**2 * (1.0 + 1e-12))  # rounding where none is lost


def ensemble(change=None, **how):
    """An ensemble of the cage, or of one that differs from it."""
    return run_ensemble(replace(CAGE, **(change or {})), replace(SETTINGS, **how.pop("settings", {})), **how)


def hard(**change):
    """The same in the hard-impact form."""
    return run_hard_ensemble(replace(CAGE, **change), SETTINGS)


LAND = {"guidance": Guidance.OUTER, "land_clearance": 4e-4}
REFUSED = {
    "no kick": (lambda: ensemble(kicks=()), "kicks"),
    "kick of zero": (lambda: ensemble(kicks=(0.0,)), "kicks"),
    "backward kick": (lambda: ensemble(kicks=(-1.0,)), "kicks"),
    "lost kick": (lambda: simulate(CAGE, kick=1e-300), r"kicks must each be a finite number > 1e-09"),
    "no number": (lambda: ensemble(kicks=(math.nan,)), "kicks"),
    "no run": (lambda: ensemble(runs=0), "runs must be at least 1"),
    "too many steps": (
        lambda: ensemble({"ball_cage_stiffness": 1e12}, settings={"duration": 1e4}),
        r"duration must be at most .* for this cage",
    ),
    "one sample": (lambda: simulate(CAGE, kick=0.5, samples=1), "samples"),
    "ball outside its pocket": (lambda: followed(CAGE, 0.01, lead=np.full(11, 4e-4)), "ball_lead"),
    "hard land": (lambda: hard(**LAND), "hard-impact form"),
    "hard gravity": (lambda: hard(gravity=9.8), "hard-impact form"),
    "hard unbalance": (lambda: hard(unbalance=1e-6), "hard-impact form"),
    "hard grip": (lambda: hard(pocket_clearance=0.0), "hard-impact form"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_run_that_cannot_be_is_refused(case):
    """By the name of the argument; the hard form has no land, gravity, unbalance or pockets without play."""
    run, words = REFUSED[case]
    with pytest.raises(InputError, match=words):
        run()


def test_a_start_depends_on_seed_and_run_only():
    """Run 3 of seed 5 starts alike however many runs there are, and unlike its neighbours."""
    assert np.array_equal(random_start(5, 3, 11), random_start(5, 3, 11))
    assert np.array_equal(random_start(5, 3, 11)[:2], random_start(5, 3, 20)[:2, :11])
    assert not np.array_equal(random_start(5, 3, 11), random_start(5, 4, 11))
    assert not np.array_equal(random_start(5, 3, 11), random_start(6, 3, 11))


def test_starts_are_uniform():
    """Directions fill the circle and leads the play: means of 2000 within four standard errors."""
    starts = np.array([random_start(1, run, 3) for run in range(2000)])
    assert abs(starts[:, 0, 0].mean() - math.pi) < 4 * 2 * math.pi / math.sqrt(12 * 2000)
    for row in (1, 4):
        assert np.all(np.abs(starts[:, row]) <= 1.0)
        assert abs(starts[:, row].mean()) < 4 * 2 / math.sqrt(12 * 6000)
    for row in (2, 3):  # normal, cut at 3: a standard deviation of 0.986
        assert np.all(np.abs(starts[:, row]) <= 3.0)
        assert abs(starts[:, row].std() - 0.986) < 4 / math.sqrt(2 * 6000)


def test_starts_scatter_as_cage_and_settings_say():
    """Play by half a ball's diameter, lead by the pocket's place and a share of the play, angle by the pitch.

    Standard deviations and largest of 22 000 draws: 4 / sqrt(2 * 22 000) = 2 %.
    """
    scatter = {"ball_diameter_scatter": 2e-5, "pocket_position_scatter": 3e-5, "pocket_spacing_scatter": 0.2}
    still = replace(SETTINGS, ball_scatter=0.0)
    starts = random_starts(replace(CAGE, **scatter), still, 0, 2000)[:, 1:].reshape(2000, 3, 11)
    lead, play, angle = starts.transpose(1, 0, 2)
    pitch = 2 * math.pi / 11
    assert lead.std() == pytest.approx(0.986 * 3e-5, rel=0.02)  # cut at 3 standard deviations
    assert play.std() == pytest.approx(0.986 * 1e-5, rel=0.02)
    assert play.mean() == pytest.approx(3e-4, rel=0.002)
    assert np.abs(angle - pitch * np.arange(11)).max() == pytest.approx(0.2 * pitch, rel=0.02)
    loose = random_starts(CAGE, replace(SETTINGS, ball_scatter=0.7), 0, 2000)[:, 1:12]
    assert np.abs(loose).max() == pytest.approx(0.7 * 3e-4, rel=0.02)


def test_only_a_centre_that_nothing_holds_can_drift():
    """Turning or weight without a land; in a held cage the mean offset shows whether it is in its place."""
    turning = replace(CAGE, cage_speed=670.0)
    held = replace(turning, **LAND)
    cages = (turning, replace(CAGE, gravity=9.81), CAGE, held, replace(held, gravity=9.81))
    assert [drifts(cage) for cage in cages] == [True, True, False, False, False]
    loose, _, _, guided, _ = limits = [run_limits(cage, 0.5, 0.3) for cage in cages]
    assert [one.drifts for one in limits] == [drifts(cage) for cage in cages]
    assert loose.place < 0.0
    assert guided.place == pytest.approx(PLACE * 2e-4, rel=1e-12)  # rounding


@pytest.mark.parametrize(
    "change",
    [{"cage_speed": 670.0, **LAND}, {"gravity": 9.81, **LAND}, {"gravity": 9.81}],
)
def test_what_the_drive_gives_is_no_early_end(change):
    """However weak the kick: no growth is known from the drive's energy, and rest is no early end."""
    cage = replace(CAGE, **change)
    joules = cage.mass / time_unit(cage) ** 2
    limits = run_limits(cage, 1e-3, 0.3)
    assert limits.drive * joules == pytest.approx(drive_energy(cage), rel=1e-12)  # rounding
    assert min(limits.grown, limits.grows_on, limits.grows_at_once) > limits.drive
    assert limits.still < 0.0


def test_a_run_is_at_most_four_times_its_duration():
    """One to two hundred looks in the duration, fewer where one would be shorter than a beat."""
    limits = run_limits(CAGE, 0.5, 1.0)
    assert 100 <= limits.looks <= 200
    assert (limits.most, limits.least) == (4 * limits.looks, 0)
    assert run_limits(CAGE, 0.5, 1.0, least=True).least == limits.looks  # a history goes on to its duration
    length = limits.looks * limits.beats * limits.beat * time_unit(CAGE)
    assert 1.0 <= length < 1.0 + 1.0 / (limits.looks - 1)
    short = run_limits(CAGE, 0.5, 1e-4)
    assert (short.looks, short.most) == (5, 20)


@pytest.mark.parametrize(
    "change", [{"cage_speed": 650.0}, {"cage_speed": 650.0, **LAND}, {"cage_speed": 0.0}]
)
def test_a_cage_that_turns_the_other_way_has_the_same_ensemble(change):
    """The mirror image is the same motion: every number agrees, whirl being forward or backward."""
    cage = replace(CAGE, gravity=9.81, **change)
    mirrored = replace(cage, cage_speed=-cage.cage_speed, inner_speed=-1500.0)
    there, back = (run_ensemble(one, SETTINGS) for one in (cage, mirrored))
    for name in ("outcome", "end_energy", "largest_offset", "whirl_frequency", "whirl_direction"):
        np.testing.assert_array_equal(getattr(there, name), getattr(back, name))
