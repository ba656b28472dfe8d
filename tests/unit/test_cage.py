"""Records, refusals and random starts."""

import math
from dataclasses import replace

import numpy as np
import pytest

from separatrix.cage import (
    PlanarCage,
    follow,
    run_ensemble,
    run_hard_ensemble,
    simulate,
)
from separatrix.cage.closed_forms import drive_energy, time_unit
from separatrix.cage.ending import PLACE, run_limits
from separatrix.cage.ensemble import random_starts
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
    assert np.all(np.isfinite(result.end_energy))
    assert np.all(result.end_energy > 0.0)


@pytest.mark.parametrize("damping", [0.1, 1.0, 1e9])
def test_the_balls_yield_stably_at_any_damping(damping):
    """A ball that follows at once, or hardly ever, gives numbers, and no energy."""
    result = run_ensemble(replace(CAGE, race_damping=damping, ball_cage_friction=0.0), SETTINGS)
    assert np.all(np.isfinite(result.energy_imbalance))
    assert np.all(result.end_energy < 0.5 * CAGE.mass * 0.5**2)


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
    held = replace(turning, guidance=Guidance.OUTER, land_clearance=4e-4)
    loose, still, guided = (run_limits(cage, 0.5, 0.3) for cage in (turning, CAGE, held))
    assert [limits.drifts for limits in (loose, still, guided)] == [True, False, False]
    assert loose.place < 0.0
    assert guided.place == pytest.approx(PLACE * 2e-4, rel=1e-12)  # rounding


@pytest.mark.parametrize(
    "change",
    [
        {"cage_speed": 670.0, "guidance": Guidance.OUTER, "land_clearance": 4e-4},
        {"gravity": 9.81, "guidance": Guidance.OUTER, "land_clearance": 4e-4},
        {"gravity": 9.81},
    ],
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


@pytest.mark.parametrize("land", [{}, {"guidance": Guidance.OUTER, "land_clearance": 4e-4}])
def test_a_cage_that_turns_the_other_way_has_the_same_ensemble(land):
    """The mirror image is the same motion: every number agrees, whirl being forward or backward."""
    cage = replace(CAGE, cage_speed=650.0, gravity=9.81, **land)
    mirrored = replace(cage, cage_speed=-650.0, inner_speed=-1500.0)
    there, back = (run_ensemble(one, SETTINGS) for one in (cage, mirrored))
    for name in ("outcome", "end_energy", "largest_offset", "whirl_frequency", "whirl_direction"):
        np.testing.assert_array_equal(getattr(there, name), getattr(back, name))


def test_a_run_of_a_cage_that_turns_the_other_way_is_the_mirror_image():
    """Followed from its own start, play and angles it is the same run; 1e-6: rounding after a few impacts."""
    scatter = {"ball_diameter_scatter": 2e-5, "pocket_spacing_scatter": 0.1}
    mirrored = replace(CAGE, cage_speed=-650.0, inner_speed=-1500.0, **scatter)
    seen = simulate(mirrored, kick=0.5, duration=0.005)
    again = follow(
        mirrored,
        kick=0.5,
        direction=float(np.arctan2(seen.velocity[0, 1], seen.velocity[0, 0])),
        ball_lead=seen.ball_lead[0],
        half_play=seen.half_play,
        pocket_angle=seen.pocket_angle,
        duration=0.005,
    )
    rows = min(len(seen.time), len(again.time))
    assert np.abs(again.contact_force).max() > 10.0
    for name, least in (
        ("position", 1e-12),
        ("rotation", 1e-12),
        ("ball_lead", 1e-12),
        ("contact_force", 1e-4),
    ):
        ours, theirs = (getattr(one, name)[:rows] for one in (seen, again))
        np.testing.assert_allclose(ours, theirs, rtol=1e-6, atol=least, err_msg=name)
