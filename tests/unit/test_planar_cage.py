"""The cage in the plane: what it refuses, what follows from its fields, and its mirror image."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import SMALL

from separatrix.cage.planar import turned_forward
from separatrix.errors import InputError
from separatrix.study import Guidance, PocketShape

CAGE = replace(SMALL, ball_count=5, cage_speed=400.0, race_damping=800.0)
ANGLES = (0.2, 1.4, 2.5, 4.0, 5.0)

WRONG = [
    ({"pocket_angles": (0.0, 1.0)}, "pocket_angles must hold one angle for each of the 5 balls; got 2"),
    (
        {"pocket_angles": (0.0, 1.0, 1.0, 2.0, 3.0)},
        "pocket_angles must be strictly increasing (items 2 and 3)",
    ),
    ({"pocket_clearance": 0.0, "hertz_coefficient": 1e9}, "pocket_clearance must be > 0 with Hertz contact"),
    ({"hertz_coefficient": 0.0}, "hertz_coefficient must be > 0; got 0 N/m1.5"),
    ({"pocket_axial_offset": 1e-5}, "pocket_axial_offset changes nothing in a square pocket"),
    ({"pocket_position_scatter": 1e-4}, "pocket_position_scatter leaves no clearance"),
    ({"pocket_spacing_scatter": -0.1}, "pocket_spacing_scatter must be >= 0 and < 0.5"),
    ({"orbital_cosines": (1.0,)}, "orbital_sines must be as many as orbital_cosines, 1; got 0"),
    ({"orbital_cosines": (1.0,), "orbital_sines": (math.nan,)}, "orbital_sines must each be a finite number"),
    (
        {"orbital_cosines": (1.0,), "orbital_sines": (0.0,), "cage_speed": 0.0},
        "orbital_cosines must be empty for a ball set at rest: its balls would run apart",
    ),
    ({"ramp_time": math.inf}, "ramp_time must be a finite number >= 0"),
    ({"ramp_start": 0.0}, "ramp_start must be > 0 and <= 1"),
    ({"land_count": 0}, "land_count must be a whole number from 1 to 2"),
    (
        {"guidance": Guidance.INNER, "land_clearance": 4e-4, "land_out_of_round": 6e-5},
        "land_out_of_round must be smaller than half the land's clearance over the square of",
    ),
    (
        {"guidance": Guidance.INNER},
        'land_clearance is missing. Give the diametral clearance, or guidance = "ball"',
    ),
    *[({"mass": value}, "mass") for value in (0.0, math.nan)],
    *[({"race_damping": value}, "race_damping") for value in (0.0, math.nan)],
    *[({name: -1e-6}, name) for name in ("moment_of_inertia", "pocket_clearance", "ball_cage_friction")],
    *[({name: 0}, name) for name in ("ball_count", "pitch_radius", "ball_cage_stiffness")],
    *[({"cage_speed": math.inf}, "cage_speed"), ({"land_restitution": 1.1}, "land_restitution")],
    ({"gravity": -9.8}, "gravity"),
]


@pytest.mark.parametrize(("changes", "words"), WRONG)
def test_a_cage_that_cannot_be_is_refused(changes, words):
    """One line, with the field's name."""
    with pytest.raises(InputError) as caught:
        replace(CAGE, **changes)
    assert f"PlanarCage.{words}" in str(caught.value)


def test_the_half_play_is_that_of_shape_and_offset():
    """What the kernels use: 0.3, 0.4, 0.5 triangle in a bore of 0.5 mm half play; without play, no tilt."""
    bore = replace(CAGE, pocket_clearance=1e-3, pocket_shape=PocketShape.CYLINDRICAL)
    offset = replace(bore, pocket_axial_offset=3e-4)
    assert offset.half_play == pytest.approx(4e-4, rel=1e-12)  # rounding
    assert offset.pocket_tilt == pytest.approx((0.8, 0.6), rel=1e-12)  # rounding
    assert (CAGE.half_play, CAGE.pocket_tilt) == (3e-4, (1.0, 0.0))
    gripped = replace(bore, pocket_clearance=0.0)
    assert (gripped.half_play, gripped.pocket_tilt) == (0.0, (1.0, 0.0))


def test_balls_stand_evenly_unless_their_angles_are_given():
    """2 pi j / Z, or the given ones."""
    assert CAGE.ball_angles == pytest.approx([2 * math.pi * j / 5 for j in range(5)], rel=1e-15)
    assert replace(CAGE, pocket_angles=ANGLES).ball_angles == ANGLES


def test_the_lead_of_one_wave_is_its_speed_over_its_rate():
    """A cos(h p) of 0.8 m/s, h = 2, at 400 rad/s: 1 mm; both waves of one harmonic add as a hypotenuse."""
    one = replace(CAGE, orbital_cosines=(0.0, 0.8), orbital_sines=(0.0, 0.0))
    both = replace(CAGE, orbital_cosines=(0.3,), orbital_sines=(-0.4,))
    assert one.lead_amplitude == pytest.approx(1e-3, rel=1e-3)  # sampled every degree
    assert both.lead_amplitude == pytest.approx(0.5 / 400, rel=1e-4)  # sampled every degree
    assert CAGE.lead_amplitude == 0.0


BACKWARD = replace(
    CAGE,
    cage_speed=-400.0,
    inner_speed=-1000.0,
    pocket_angles=ANGLES,
    orbital_cosines=(0.3, -0.1),
    orbital_sines=(0.2, 0.05),
    gravity=9.81,
    unbalance=1e-6,
)


def test_ball_j_of_the_mirror_image_is_ball_minus_j():
    """Angles change sign, modulo a turn; counted around, ball 0 stays ball 0."""
    mirror = turned_forward(BACKWARD)
    turn = 2 * math.pi
    for j, angle in enumerate(mirror.pocket_angles):
        away = (angle + ANGLES[-j % 5]) % turn
        assert min(away, turn - away) < 1e-14  # rounding
    assert (mirror.gravity, mirror.unbalance) == (BACKWARD.gravity, BACKWARD.unbalance)
    assert (mirror.cage_speed, mirror.inner_speed, mirror.outer_speed) == (400.0, 1000.0, 0.0)


def test_the_mirror_image_runs_forward_where_its_original_runs_backward():
    """Orbital speed beyond the mean, seen from the other side: V'(p) = -V(-p) at every azimuth."""

    def speed(cage, azimuth):
        waves = enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), 1)
        return sum(a * np.cos(h * azimuth) + b * np.sin(h * azimuth) for h, (a, b) in waves)

    azimuth = np.linspace(-3.0, 3.0, 11)
    mirror = turned_forward(BACKWARD)
    assert speed(mirror, azimuth) == pytest.approx(-speed(BACKWARD, -azimuth), rel=1e-14)  # rounding


def test_the_mirror_image_of_the_mirror_image_is_the_cage():
    """Twice across azimuth 0; angles to rounding."""
    mirror = turned_forward(BACKWARD)
    assert turned_forward(mirror) is mirror
    again = turned_forward(
        replace(mirror, cage_speed=-400.0, inner_speed=-1000.0, orbital_cosines=BACKWARD.orbital_cosines)
    )
    assert again.pocket_angles == pytest.approx(ANGLES, rel=1e-14)  # 2 pi - (2 pi - a)
    assert again.orbital_cosines == mirror.orbital_cosines


@pytest.mark.parametrize(
    ("cage", "inner", "outer", "sense"),
    [
        (-1.0, 9.0, 9.0, -1),
        (0.0, 3.0, -5.0, -1),
        (0.0, 5.0, -3.0, 1),
        (0.0, -4.0, 4.0, -1),
        (0.0, 0.0, 0.0, 1),
    ],
)
def test_a_bearing_turns_as_its_ball_set_does(cage, inner, outer, sense):
    """At rest, as its rings do in the mean, or as the inner one; what is run always turns forward."""
    found = replace(CAGE, cage_speed=cage, inner_speed=inner, outer_speed=outer)
    assert found.rotation_sense == sense
    assert turned_forward(found).rotation_sense == 1
