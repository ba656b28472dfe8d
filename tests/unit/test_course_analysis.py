"""What the analysis of a run says of motions whose answer is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from separatrix.cage import Cause, History, MovingCage, RunOutcome, analyse
from separatrix.cage.analysis import (
    amplitudes,
    ball_set,
    clock_histogram,
    histogram,
    phase_of,
    touches,
    whirl_speed,
)
from separatrix.cage.course import SOURCES
from separatrix.cage.numbers import look_time
from separatrix.study import Guidance, MotionModel

OMEGA, BALLS, RADIUS = 600.0, 5, 0.03
TIME = np.linspace(0.0, 0.2, 8001)


def cage(**changes) -> MovingCage:
    """A cage in space with an outer land whose balls go round at `OMEGA`."""
    values = {
        "mass": 0.02,
        "moment_of_inertia": 1.8e-5,
        "ball_count": BALLS,
        "pitch_radius": RADIUS,
        "cage_speed": OMEGA,
        "inner_speed": 1500.0,
        "outer_speed": 0.0,
        "motion": MotionModel.SPACE,
        "pocket_clearance": 6e-4,
        "ball_cage_stiffness": 1e6,
        "race_damping": 200.0,
        "ball_cage_friction": 0.2,
        "guidance": Guidance.OUTER,
        "land_clearance": 1e-3,
    }
    return MovingCage(**{**values, **changes})


def around(size: float, speed: float, phase: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A vector that turns evenly, and its rate, shape (time, 2)."""
    angle = speed * TIME + phase
    place = size * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return place, speed * place[:, ::-1] * [-1.0, 1.0]


TILTS = ("axial_place", "axial_speed", "lean", "lean_rate", "ball_axial")


def history(**changes) -> History:
    """A cage at rest in the middle of its balls, with these changes."""
    count, none = TIME.size, np.zeros(TIME.size)
    flat, of_balls = np.zeros((count, 2)), np.zeros((count, BALLS))
    values = {
        "time": TIME,
        **dict.fromkeys(("position", "velocity", "lean", "lean_rate"), flat),
        **dict.fromkeys(("rotation", "rotation_rate", "kinetic_energy", "stored_energy", "land_force"), none),
        **dict.fromkeys(("axial_place", "axial_speed"), none),
        **dict.fromkeys(
            ("ball_lead", "ball_speed", "ball_axial", "contact_force", "contact_angle"), of_balls
        ),
        "work": dict.fromkeys(SOURCES, none),
        "pocket_angle": 2.0 * np.pi * np.arange(BALLS) / BALLS,
        "half_play": np.full(BALLS, 3e-4),
        **dict.fromkeys(("pocket_impacts", "pocket_rubbing"), np.zeros(BALLS)),
        "outcome": RunOutcome.SETTLES,
        "cause": Cause.NONE,
        "judged_from": 0.1,
        "judged_until": 0.2,
        **dict.fromkeys(
            ("end_energy", "growth_rate", "drift_rate", "largest_offset", "whirl_frequency"), 0.0
        ),
        **dict.fromkeys(("pocket_power", "land_power", "rubbing_force", "rubbing_speed", "left_time"), 0.0),
        **dict.fromkeys(("largest_contact_force", "largest_land_force", "energy_imbalance"), 0.0),
        **dict.fromkeys(("whirl_direction", "land_impacts", "left_ball"), 0),
    }
    return History(**{**values, **changes})


def numbers_of(record: object) -> list[float]:
    """Every number in a record and the records in it."""
    names = getattr(record, "__slots__", ())
    if not names:
        is_number = isinstance(record, int | float | np.ndarray)
        if isinstance(record, tuple):
            return [one for item in record for one in numbers_of(item)]
        return np.ravel(record).astype(float).tolist() if is_number else []
    return [one for name in names for one in numbers_of(getattr(record, name))]


@pytest.mark.parametrize("speed", [900.0, -600.0, -1500.0])
def test_circular_whirl_has_the_ratio_of_its_speed(speed):
    """An orbit at w in the turning frame goes round at w + Omega in the fixed one; over the cage's speed."""
    centre, velocity = around(2e-4, speed)
    slow = np.full(TIME.size, -6.0)
    found = analyse(cage(), history(position=centre, velocity=velocity, rotation_rate=slow))
    assert found.whirl.cage_speed == pytest.approx(OMEGA - 6.0, rel=1e-12)
    assert found.whirl.offset_ratio == pytest.approx((speed + OMEGA) / (OMEGA - 6.0), abs=1e-12)
    assert np.allclose(found.whirl.window_offset_ratio, found.whirl.offset_ratio, atol=1e-12)
    assert found.cage_slip == pytest.approx(0.01, rel=1e-12)
    assert found.mean_offset == pytest.approx(2e-4, rel=1e-12)
    assert found.offset_spread == pytest.approx(0.0, abs=1e-16)
    assert found.whirl_speed == pytest.approx(2e-4 * abs(speed), rel=1e-12)


@pytest.mark.parametrize("phase", [0.0, 0.7, -2.5])
def test_a_cone_has_the_phase_of_its_lean(phase):
    """Axis and centre that turn together keep their angle: coherence 1; at other speeds it is lost."""
    centre, velocity = around(2e-4, 700.0)
    lean, rate = around(3e-3, 700.0, phase)
    found = analyse(cage(), history(position=centre, velocity=velocity, lean=lean, lean_rate=rate))
    assert found.whirl.tilt_phase == pytest.approx(phase, abs=1e-9)
    assert found.whirl.tilt_coherence == pytest.approx(1.0, abs=1e-12)
    assert found.whirl.tilt_ratio == pytest.approx(1300.0 / OMEGA, rel=1e-12)
    assert found.largest_tilt == pytest.approx(3e-3, rel=1e-12)
    lost, rate = around(3e-3, -700.0)
    found = analyse(cage(), history(position=centre, velocity=velocity, lean=lost, lean_rate=rate))
    assert found.whirl.tilt_ratio == pytest.approx(-100.0 / OMEGA, rel=1e-9)
    assert found.whirl.tilt_coherence < 0.02


def test_an_ellipse_turns_by_its_area():
    """Ellipse of half axes a and b: area swept over mean square, 2ab/(a^2 + b^2) times its speed."""
    time, a, b, w = np.linspace(0.0, 1.0, 10001), 3.0, 1.0, 2.0 * np.pi * 8.0
    place = np.stack([a * np.cos(w * time), b * np.sin(w * time)], axis=1)
    rate = w * np.stack([-a * np.sin(w * time), b * np.cos(w * time)], axis=1)
    found = whirl_speed(time, place, rate, np.zeros(time.size))
    assert found == pytest.approx(2.0 * a * b / (a * a + b * b) * w, rel=1e-9)


def test_a_cage_at_rest_has_no_whirl_and_no_nan():
    """What does not exist is None; a ball set at rest has no slip."""
    found = analyse(cage(), history())
    whirl = found.whirl
    assert (whirl.offset_ratio, whirl.tilt_ratio, whirl.tilt_phase, whirl.tilt_coherence) == (None,) * 4
    assert found.cage_slip == 0.0
    assert found.impacts.front_share is None
    assert np.all(np.isfinite(numbers_of(found)))
    still = analyse(cage(cage_speed=0.0, inner_speed=0.0), history())
    assert still.cage_slip is None
    assert still.impacts.rate_per_turn is None
    assert phase_of(np.zeros((3, 2)), np.ones((3, 2)), np.arange(3.0)) == (None, None)


def test_few_judged_samples_take_the_whole_run():
    """A judged part between two samples leaves the statistics of the whole run."""
    found = analyse(cage(), history(judged_from=0.1, judged_until=0.1))
    assert found.whole_run
    assert not analyse(cage(), history()).whole_run


@pytest.mark.parametrize("frequency", [400.0, -400.0, 1000.0])
def test_a_complex_tone_has_its_amplitude_and_its_sign(frequency):
    """Forward is positive; the amplitude is that of the tone where its frequency is one of the spectrum."""
    n, step = 4096 * 2, 1.0 / 25600.0
    signal = 3e-5 * np.exp(2j * np.pi * frequency * step * np.arange(n))
    at, found = amplitudes(signal + (1.0 + 2.0j), step)
    assert at[found.argmax()] == pytest.approx(frequency, abs=1e-9)
    assert found.max() == pytest.approx(3e-5, rel=1e-6)
    assert np.all(np.diff(at) > 0.0)


def test_a_real_tone_has_its_amplitude_and_one_between_loses_little():
    """Peak amplitude, not root mean square; Hann's window loses 15 % half way between two frequencies."""
    n, step = 8192, 1.0 / 20480.0
    place = np.arange(n)
    at, found = amplitudes(2.0 * np.cos(2.0 * np.pi * 500.0 * step * place + 0.3), step)
    assert at[found.argmax()] == pytest.approx(500.0, abs=1e-9)
    assert found.max() == pytest.approx(2.0, rel=1e-6)
    between = 500.0 + 0.5 * float(at[1])
    _, lower = amplitudes(2.0 * np.cos(2.0 * np.pi * between * step * place), step)
    assert 0.84 * 2.0 < lower.max() < 0.86 * 2.0


def test_spectra_are_of_the_fixed_frame():
    """A centre that stands still among the balls turns with them: its line is at their speed."""
    centre = np.tile([1e-4, 0.0], (TIME.size, 1))
    found = analyse(cage(), history(position=centre)).spectra
    step = found.frequency[1] - found.frequency[0]
    assert found.frequency[found.offset.argmax()] == pytest.approx(OMEGA / (2.0 * np.pi), abs=step)
    assert 0.84e-4 < found.offset.max() < 1.01e-4


def test_touches_have_peak_impulse_and_place():
    """Half sines of known force: impulse 2/pi F T, peak F; a touch that lasts to the end counts."""
    time = np.linspace(0.0, 1e-2, 20001)
    force, angle = np.zeros((time.size, 3)), np.zeros((time.size, 3))
    for ball, start, length, peak, at in ((1, 2e-3, 1e-3, 50.0, 0.4), (1, 5e-3, 5e-4, 20.0, np.pi)):
        inside = (time > start) & (time < start + length)
        force[inside, ball] = peak * np.sin(np.pi * (time[inside] - start) / length)
        angle[inside, ball] = at
    force[time > 9e-3, 2] = 7.0
    found = touches(time, force, angle)
    assert found.ball.tolist() == [1, 1, 2]
    assert found.peak_force == pytest.approx([50.0, 20.0, 7.0], rel=1e-5)
    assert found.impulse == pytest.approx([2 / np.pi * 0.05, 2 / np.pi * 0.01, 7e-3], rel=2e-3)
    assert found.angle == pytest.approx([0.4, np.pi, 0.0])
    assert touches(time, 0.0 * force, angle).impulse.size == 0


def test_histograms_lose_nothing():
    """Every value is in a bin, the smallest in the first; the poles are in the middles of theirs."""
    edges, count = histogram(np.array([1e-9, 0.5, 3.0, 3.0]))
    assert (count.sum(), count[0], count[-1], edges[-1]) == (4.0, 1.0, 2.0, 3.0)
    assert histogram(np.zeros(0))[1].sum() == 0.0
    poles = np.array([0.0, 0.5 * np.pi, np.pi, -np.pi, -0.5 * np.pi, -1e-3])
    edges, weight = clock_histogram(poles, np.full(6, 0.5))
    assert weight[[0, 6, 12, 18]].tolist() == [1.0, 0.5, 1.0, 0.5]
    assert weight.sum() == 3.0
    assert edges[[0, 1]] == pytest.approx([-np.pi / 24, np.pi / 24])


def test_shares_of_the_pocket_add_up():
    """Impulse in front, behind and at the axial poles is all of it."""
    force, angle = np.zeros((TIME.size, BALLS)), np.zeros((TIME.size, BALLS))
    for ball, at in enumerate((0.1, np.pi, 0.5 * np.pi, -0.5 * np.pi)):
        force[100 + 50 * ball : 120 + 50 * ball, ball], angle[:, ball] = 10.0, at
    found = analyse(cage(), history(contact_force=force, contact_angle=angle)).impacts
    assert found.force_count.sum() == 4
    assert (found.front_share, found.rear_share) == (pytest.approx(0.25), pytest.approx(0.25))
    assert found.axial_share == pytest.approx(0.5)


def test_rates_and_rubbing_are_those_that_the_engine_counts():
    """Impacts over time (whole looks) and over turns; friction times sliding work over time."""
    counted, body = np.arange(1.0, BALLS + 1.0), cage()
    looked = math.ceil(0.2 / look_time(body)) * look_time(body)
    moved = history(pocket_impacts=counted, pocket_rubbing=counted, rubbing_force=8.0, rubbing_speed=5.0)
    found = analyse(body, moved)
    assert found.impacts.rate == pytest.approx(counted / looked)
    assert found.impacts.rate_per_turn == pytest.approx(counted / (OMEGA * 0.2 / (2.0 * math.pi)))
    assert found.rubbing.pocket_power == pytest.approx(0.2 * counted / looked)
    assert found.rubbing.land_power == pytest.approx(0.1 * 8.0 * 5.0)


def test_a_ramp_turns_the_ball_set_by_its_integral():
    """The angle is the integral of the speed, which rises evenly from its share at the start."""
    angle, speed = ball_set(cage(ramp_time=0.08, ramp_start=0.25), TIME)
    assert (speed[0], speed[-1]) == (0.25 * OMEGA, OMEGA)
    assert np.gradient(angle, TIME)[1:-1] == pytest.approx(speed[1:-1], rel=1e-3)
    assert np.allclose(ball_set(cage(), TIME), (OMEGA * TIME, OMEGA + 0.0 * TIME), rtol=1e-15)


def test_a_bearing_that_turns_backward_has_the_numbers_of_its_mirror_image():
    """Ratios, phases and spectra are in the sense of the rotation."""
    flip = np.array([1.0, -1.0])
    (centre, velocity), (lean, rate) = around(2e-4, 300.0), around(1e-3, 300.0, 0.7)
    force, angle = np.zeros((TIME.size, BALLS)), np.full((TIME.size, BALLS), 0.2)
    force[100:120, 1] = 5.0
    moved = {"position": centre, "velocity": velocity, "lean": lean, "lean_rate": rate}
    forward = analyse(cage(), history(**moved, contact_force=force, contact_angle=angle))
    seen = {name: flip * one for name, one in moved.items()}
    mirrored = history(**seen, contact_force=force, contact_angle=math.pi - angle)
    backward = analyse(cage(cage_speed=-OMEGA, inner_speed=-1500.0), mirrored)
    assert backward.whirl.offset_ratio == pytest.approx(forward.whirl.offset_ratio, rel=1e-12)
    assert backward.whirl.offset_ratio == pytest.approx(1.5)
    assert backward.whirl.tilt_phase == pytest.approx(0.7)
    assert np.allclose(backward.spectra.offset, forward.spectra.offset, rtol=1e-9, atol=1e-15)
    assert (backward.impacts.front_share, forward.impacts.front_share) == (1.0, 1.0)


def test_in_the_plane_there_is_neither_tilt_nor_axial_motion():
    """None, and the rest as in space."""
    centre, velocity = around(2e-4, 300.0)
    moved = history(position=centre, velocity=velocity, **dict.fromkeys(TILTS))
    found = analyse(cage(motion=MotionModel.PLANE), moved)
    assert {found.largest_tilt, found.mean_tilt, found.largest_axial, found.axial_low, found.axial_high} == {
        None
    }
    assert {found.spectra.lean, found.spectra.axial, found.whirl.tilt_ratio, found.whirl.tilt_phase} == {None}
    assert found.whirl.offset_ratio == pytest.approx(1.5)
    assert np.all(np.isfinite(numbers_of(found)))
