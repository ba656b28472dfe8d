"""What the analysis of a run says of motions whose answer is known."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from cages import ON_A_LAND

from separatrix import Cause, History, MotionModel, MovingCage, RunOutcome, analyse
from separatrix.cage.course import SOURCES, ball_set_speed, phase_of
from separatrix.cage.numbers import look_time

OMEGA, BALLS, RADIUS = 600.0, 5, 0.03
TIME = np.linspace(0.0, 0.2, 8001)


def cage(**changes) -> MovingCage:
    """A cage in space with an outer land whose balls go round at `OMEGA`."""
    turning = {"ball_count": BALLS, "cage_speed": OMEGA, "inner_speed": 1500.0, "motion": MotionModel.SPACE}
    return replace(ON_A_LAND, pitch_radius=RADIUS, ball_cage_friction=0.2, **turning | changes)


def around(size: float, speed: float, phase: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A vector that turns evenly, and its rate, shape (time, 2)."""
    angle = speed * TIME + phase
    place = size * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return place, speed * place[:, ::-1] * [-1.0, 1.0]


TILTS = ("axial_place", "axial_speed", "lean", "lean_rate", "ball_axial")


def history(**changes) -> History:
    """A cage at rest in the middle of its balls, with these changes."""
    none, flat, of_balls = (np.zeros((TIME.size, *shape)) for shape in ((), (2,), (BALLS,)))
    numbers = ["rotation", "rotation_rate", "kinetic_energy", "stored_energy", "land_force", *TILTS[:2]]
    balls = ["ball_lead", "ball_speed", "ball_axial", "contact_force", "contact_angle"]
    values = dict.fromkeys((one.name for one in fields(History)), 0.0)
    values |= dict.fromkeys(numbers, none) | dict.fromkeys(balls, of_balls)
    values |= dict.fromkeys(("position", "velocity", "lean", "lean_rate"), flat)
    values |= dict.fromkeys(("pocket_impacts", "pocket_rubbing"), np.zeros(BALLS))
    values |= {"time": TIME, "work": dict.fromkeys(SOURCES, none), "half_play": np.full(BALLS, 3e-4)}
    values |= {"pocket_angle": 2.0 * np.pi * np.arange(BALLS) / BALLS, "judged_from": 0.1, "followed": 0.2}
    values |= {"outcome": RunOutcome.SETTLES, "cause": Cause.NONE}
    return History(**values | changes)


@pytest.mark.parametrize("speed", [900.0, -600.0, -1500.0])
def test_a_circular_whirl_has_its_speed_and_a_slow_cage_its_slip(speed):
    """The centre moves at radius times speed; a cage 6 rad/s slower than its balls slips 1 %."""
    centre, velocity = around(2e-4, speed)
    slow = np.full(TIME.size, -6.0)
    found = analyse(cage(), history(position=centre, velocity=velocity, rotation_rate=slow))
    assert found.cage_slip == pytest.approx(0.01, rel=1e-12)
    assert found.whirl_speed == pytest.approx(2e-4 * abs(speed), rel=1e-12)


@pytest.mark.parametrize("phase", [0.0, 0.7, -2.5])
def test_a_cone_has_the_phase_of_its_lean(phase):
    """Axis and centre that turn together keep their angle: coherence 1; at other speeds it is lost."""
    centre, _ = around(2e-4, 700.0)
    lean, _ = around(3e-3, 700.0, phase)
    found = analyse(cage(), history(position=centre, lean=lean))
    assert found.tilt_phase == pytest.approx(phase, abs=1e-9)
    assert found.tilt_coherence == pytest.approx(1.0, abs=1e-12)
    lost, _ = around(3e-3, -700.0)
    assert analyse(cage(), history(position=centre, lean=lost)).tilt_coherence < 0.02


def test_what_does_not_exist_is_none():
    """A centred cage has no phase and no impulse, a ball set at rest no slip and no turns."""
    found = analyse(cage(), history())
    assert (found.tilt_phase, found.tilt_coherence, found.front_share) == (None, None, None)
    assert found.cage_slip == 0.0
    still = analyse(cage(cage_speed=0.0, inner_speed=0.0), history())
    assert (still.cage_slip, still.impacts_per_turn) == (None, None)
    assert phase_of(np.zeros((3, 2)), np.ones((3, 2)), np.arange(3.0)) == (None, None)
    flat = analyse(cage(motion=MotionModel.PLANE), history(**dict.fromkeys(TILTS)))
    assert (flat.tilt_phase, flat.tilt_coherence) == (None, None)


def test_few_judged_samples_take_the_whole_run():
    """A judged part between two samples leaves the statistics of the whole run."""
    velocity = np.stack([np.where(TIME < 0.1, 2.0, 1.0), 0.0 * TIME], axis=1)
    judged = analyse(cage(), history(velocity=velocity)).whirl_speed
    whole = analyse(cage(), history(velocity=velocity, judged_from=0.15, followed=0.15)).whirl_speed
    assert (judged, whole) == (pytest.approx(1.0), pytest.approx(math.sqrt(2.5), rel=1e-3))


def test_a_whirl_that_is_judged_early_has_the_speed_it_grows_to():
    """Judged before it grows, from 1 to 3 m/s; the last fifth of the run shows the larger speed."""
    velocity = np.stack([np.where(0.5 * TIME[-1] > TIME, 1.0, 3.0), 0.0 * TIME], axis=1)
    found = analyse(cage(), history(velocity=velocity, judged_from=0.0, followed=0.3 * TIME[-1]))
    assert (found.whirl_speed, found.grown_speed) == (pytest.approx(1.0), pytest.approx(3.0))


def test_shares_of_the_pocket_add_up():
    """Impulse in front, behind and at the axial poles is all of it."""
    force, angle = np.zeros((TIME.size, BALLS)), np.zeros((TIME.size, BALLS))
    for ball, at in enumerate((0.1, np.pi, 0.5 * np.pi, -0.5 * np.pi)):
        force[100 + 50 * ball : 120 + 50 * ball, ball], angle[:, ball] = 10.0, at
    found = analyse(cage(), history(contact_force=force, contact_angle=angle))
    assert (found.front_share, found.rear_share) == (pytest.approx(0.25), pytest.approx(0.25))
    assert found.axial_share == pytest.approx(0.5)


def test_rates_and_rubbing_are_those_that_the_engine_counts():
    """Impacts over time (whole looks) and over turns; friction times sliding work over time."""
    counted, body = np.arange(1.0, BALLS + 1.0), cage()
    looked = math.ceil(0.2 / look_time(body)) * look_time(body)
    found = analyse(body, history(pocket_impacts=counted, pocket_rubbing=counted))
    assert found.impact_rate == pytest.approx(counted / looked)
    assert found.impacts_per_turn == pytest.approx(counted / (OMEGA * 0.2 / (2.0 * math.pi)))
    assert found.pocket_rubbing_power == pytest.approx(0.2 * counted / looked)


def test_in_a_ramp_the_ball_set_is_slower():
    """Its speed rises evenly from its share at the start, and stays."""
    speed = ball_set_speed(cage(ramp_time=0.08, ramp_start=0.25), TIME)
    assert (speed[0], speed[-1]) == (0.25 * OMEGA, OMEGA)
    assert speed[TIME == 0.04] == pytest.approx(0.625 * OMEGA, rel=1e-12)
    assert np.all(ball_set_speed(cage(), TIME) == OMEGA)


def test_a_bearing_that_turns_backward_has_the_numbers_of_its_mirror_image():
    """Phases and shares are in the sense of the rotation."""
    flip = np.array([1.0, -1.0])
    (centre, _), (lean, _) = around(2e-4, 300.0), around(1e-3, 300.0, 0.7)
    force, angle = np.zeros((TIME.size, BALLS)), np.full((TIME.size, BALLS), 0.2)
    force[100:120, 1] = 5.0
    forward = analyse(cage(), history(position=centre, lean=lean, contact_force=force, contact_angle=angle))
    mirrored = history(
        position=flip * centre, lean=flip * lean, contact_force=force, contact_angle=math.pi - angle
    )
    backward = analyse(cage(cage_speed=-OMEGA, inner_speed=-1500.0), mirrored)
    assert backward.tilt_phase == pytest.approx(0.7)
    assert (backward.front_share, forward.front_share) == (1.0, 1.0)
