"""Pockets, land, scatter and start-up in a study: every key with its unit, every rule with its one line."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from cages import AT_REST
from commands import refusal_line, rows_of, written

from separatrix import BallTraction, CageDesign, Guidance, InputError, MotionModel, PocketShape, read_study
from separatrix.study.cage_body import cage_inertia, ring_body
from separatrix.study.cage_design import half_play, tilt
from separatrix.study.study import StabilitySettings
from separatrix.verbs.check import _cage as checked

EVEN = ", ".join(f'"{360 / 13 * j:.6f} deg"' for j in range(13))

BASE = 'extends = "cryogenic-turbopump"\n[operation]\n{operation}\n[cage]\n{cage}\n'


@pytest.fixture
def read(tmp_path):
    """Read the shipped study with some keys of [cage] and [operation] more."""

    def read_text(cage="", operation="", read=read_study):
        return read(written(tmp_path, BASE.format(cage=cage, operation=operation), "case.toml"))

    return read_text


def design(**changes):
    """A landless cage of 20 g with 0.6 mm of play, with some fields changed."""
    return CageDesign(**{"mass": 0.02, "pocket_clearance": 6e-4} | changes)


WRONG = r"""
pocket_clearance = "1e-12 m" :: pocket_clearance must be >= 1 nm; got
SLOT\npocket_axial_clearance = "0.7 mm"
    :: at most pocket_clearance, 600 um: the slot lies along the circumference; got "0.7 mm". A slot along
BORE\npocket_axial_offset = "0.3 mm"
    :: pocket_axial_offset must be smaller than half the clearance along the axis, 300 um; got "0.3 mm"
SLOT\npocket_axial_clearance = "0.4 mm"\npocket_axial_offset = "-0.25 mm"
    :: pocket_axial_offset must be smaller than half the clearance along the axis, 200 um; got "-0.25 mm"
pocket_clearance = "0 mm"\npocket_contact = "hertz" :: pocket_clearance must be > 0 with Hertz contact
pocket_position_scatter = "0.1 mm" :: pocket_position_scatter leaves no clearance: 3 standard deviations
ball_diameter_scatter = "0.2 mm"
    :: half the diameter together, 300 um, must be smaller than half the clearance
pocket_clearance = "0 mm"\nball_diameter_scatter = "1 um" :: ball_diameter_scatter leaves no clearance
BORE\npocket_axial_offset = "0.28 mm"\npocket_position_scatter = "50 um"
    :: 150 um, must be smaller than half the clearance, 107.7 um
ANGLES 27.692308 90 :: pocket_angles must be strictly increasing (items 2 and 3); got 55.38 deg after 90 deg
ANGLES 332.307692 401 :: pocket_angles must each be a finite angle within one turn of 0
ANGLES 0.000000 -30 :: pocket_angles must lie within one turn
ANGLES 27.692308 9.0
    :: leave no bar between pockets 1 and 2: must be more than 20.76 deg apart; got 9 deg
ANGLES 332.307692 350 :: leave no bar between pockets 13 and 1
pocket_angles = ["0 deg", "30 deg"]
    :: line 5: [cage] pocket_angles must hold one angle for each of the 13 balls; got 2
pocket_spacing_scatter = 0.01\nANGLES 0 0 :: pocket_spacing_scatter and pocket_angles exclude each other
pocket_spacing_scatter = 0.126 :: [cage] pocket_spacing_scatter must be < 0.1251, where two neighbours
LAND\nland_out_of_round = "1 um"\nland_lobes = 1
    :: land_lobes must be a whole number from 2 to 100; got 1. One lobe is an offset
LAND\nland_out_of_round = "0.1 mm"
    :: the square of land_lobes, 100 um: beyond it a lobe touches
LAND\nland_out_of_round = "50 um"\nland_lobes = 3
    :: half the land's clearance over the square of land_lobes, 44.44 um: beyond it
pocket_spacing_scatter = 0.5 :: pocket_spacing_scatter must be >= 0 and < 0.5
land_lobes = 3 :: [cage] land_lobes needs land_out_of_round: without it the land is round
unbalance = "813 g mm" :: [cage] unbalance must be smaller than mass times pitch radius, 812.5 g mm
guidance = "outer"\nland_clearance = "11.2 mm"
    :: [cage] land_clearance must be smaller than a ball, 11.11 mm; got
"""
"""Keys of the cage and words of their refusal."""
SHORT = {
    "SLOT": 'pocket_shape = "elongated"',
    "BORE": 'pocket_shape = "cylindrical"',
    "LAND": 'guidance = "outer"\nland_clearance = "0.8 mm"',
}


@pytest.mark.parametrize(("keys", "words"), rows_of(WRONG))
def test_a_cage_that_cannot_be_is_refused_in_one_line(keys, words, read):
    """Place in the file, field, rule, value; what to do where it is not plain."""
    for name, text in SHORT.items():
        keys = keys.replace(name, text)
    keys, is_uneven, angles = keys.partition("ANGLES ")
    if is_uneven:
        keys += f"pocket_angles = [{EVEN.replace(*angles.split(), 1)}]"
    message = read(keys, read=refusal_line)
    assert words[0] in message
    assert message.startswith("case.toml")


def test_uneven_pockets_fit_up_to_their_bars(read):
    """Just inside the limit of the refusals: neighbours 20.76 deg apart, a scatter of 0.1251 pitches."""
    assert read(cage="pocket_spacing_scatter = 0.125").cage.pocket_spacing_scatter == 0.125
    near = EVEN.replace("27.692308", "20.77")
    assert read(cage=f"pocket_angles = [{near}]").cage.pocket_angles[1] < 0.363


def test_a_land_tighter_than_the_pockets_is_a_land_guided_cage(read):
    """No fault: its pockets touch by turning, and as balls lead and lag; the report says what is met."""
    tight = read(cage='guidance = "outer"\nland_clearance = "0.3 mm"\nland_out_of_round = "10 um"')
    assert checked(tight).land_gap == pytest.approx(140e-6, rel=1e-12)
    wide = checked(read(cage='guidance = "outer"\nland_clearance = "1 mm"'))
    assert wide.land_gap == pytest.approx(500e-6, rel=1e-12)
    assert checked(read(cage='guidance = "ball"')).land_gap is None


SHAPES = [
    (PocketShape.SQUARE, {}, 3e-4, 0.0),
    (PocketShape.CYLINDRICAL, {}, 3e-4, 0.0),
    (PocketShape.CYLINDRICAL, {"pocket_axial_offset": 1.8e-4}, 2.4e-4, 0.6),  # 3, 4, 5
    (PocketShape.CYLINDRICAL, {"pocket_axial_offset": -1.8e-4}, 2.4e-4, -0.6),
    (PocketShape.ELONGATED, {"pocket_axial_clearance": 4e-4}, 3e-4, 0.0),
    (PocketShape.ELONGATED, {"pocket_axial_clearance": 6e-4, "pocket_axial_offset": 1.8e-4}, 2.4e-4, 0.6),
    (PocketShape.ELONGATED, {"pocket_axial_clearance": 4e-4, "pocket_axial_offset": 1.2e-4}, 2.6e-4, 0.6),
]


@pytest.mark.parametrize(("shape", "sizes", "play", "sine"), SHAPES)
def test_a_round_pocket_has_less_play_off_its_middle(shape, sizes, play, sine):
    """sqrt(c^2 - z^2) in a bore, c - c_a + sqrt(c_a^2 - z^2) in a slot; sin psi = z over the round's play."""
    cage = design(pocket_shape=shape, **sizes)
    assert half_play(cage) == pytest.approx(play, rel=1e-12)  # rounding
    assert tilt(cage) == pytest.approx((math.sqrt(1 - sine**2), sine), rel=1e-12)  # rounding


def test_a_variant_drops_what_its_pocket_does_not_have(tmp_path):
    """Shape and spacing replace those of the base; a cage guided by its balls has no lobes."""
    sizes = 'pocket_shape = "elongated"\npocket_axial_clearance = "0.4 mm"\npocket_axial_offset = "0.1 mm"\n'
    land = 'land_out_of_round = "20 um"\nland_lobes = 3\nland_count = 2\nland_spacing = "8 mm"\n'
    land += "pocket_spacing_scatter = 0.1\n"
    written(tmp_path, f'extends = "cryogenic-turbopump"\n[cage]\n{sizes}{land}', "base.toml")

    def variant(text):
        return read_study(written(tmp_path, f'extends = "base.toml"\n[cage]\n{text}\n')).cage

    assert variant('pocket_shape = "square"').pocket_axial_offset == 0.0
    bore = variant('pocket_shape = "cylindrical"')
    assert (bore.pocket_axial_clearance, bore.pocket_axial_offset) == (None, 1e-4)
    assert variant(f"pocket_angles = [{EVEN}]").pocket_spacing_scatter == 0.0
    landless = variant('guidance = "ball"')
    assert (landless.land_count, landless.land_out_of_round) == (1, 0.0)


def test_a_contact_that_leans_steeply_draws_a_note(read):
    """Beyond 30 deg the cage would be pushed along its axis."""
    bore = 'model = "paper"\npocket_shape = "cylindrical"\n'
    (note,) = read(cage=f'{bore}pocket_axial_offset = "0.16 mm"').notes
    assert "lean by more than 30 deg" in note
    assert read(cage=f'{bore}pocket_axial_offset = "0.14 mm"').notes == ()


# The models of a ball and of the cage's motion: keys, options, and what is refused.

QUICK = StabilitySettings(kicks=(0.5,), runs=8, duration=0.02, restitution_factors=(0.3, 0.6), seed=1)
SHAPE = {"inner_diameter": 0.058, "outer_diameter": 0.072, "width": 0.014}


def shipped(**cage):
    """The shipped study with an ensemble of no weight, and other keys of its cage."""
    study = read_study("cryogenic-turbopump")
    return replace(study, stability=QUICK, cage=replace(study.cage, **cage))


def test_ring_without_pockets():
    """36/29/14 mm and 25 g: J_p 2.671250e-5, J_t 1.376458e-5 kg m2 (dynamics3d E4)."""
    ring = ring_body(inner_radius=29e-3, outer_radius=36e-3, width=14e-3)
    assert ring.volume == pytest.approx(math.pi * (36e-3**2 - 29e-3**2) * 14e-3, rel=1e-14)
    assert ring.inertia(0.025) == pytest.approx((2.671250e-5, 1.376458e-5), rel=1e-6)


@pytest.mark.parametrize("shape", list(PocketShape))
def test_ring_with_pockets_against_points_at_random(shape):
    """Volume and inertia by four million random points of the ring, to their scatter."""
    r_i, r_o, w, along, across, count = 29e-3, 36e-3, 14e-3, 11.7e-3, 10.9e-3, 13
    across = along if shape is PocketShape.CYLINDRICAL else across
    ring = ring_body(
        inner_radius=r_i, outer_radius=r_o, width=w, pocket_count=count, pocket_along=along,
        pocket_across=across, pocket_shape=shape,
    )  # fmt: skip
    rng = np.random.default_rng(1)
    r = np.sqrt(rng.uniform(r_i**2, r_o**2, 4_000_000))
    phi, z = rng.uniform(-math.pi / count, math.pi / count, r.size), rng.uniform(-w / 2, w / 2, r.size)
    x, t = r * np.cos(phi), r * np.sin(phi)
    flat = 0.0 if shape is PocketShape.CYLINDRICAL else 0.5 * (along - across)
    beyond = np.maximum(np.abs(t) - flat, 0.0)
    hole = np.hypot(beyond, z) < 0.5 * across
    if shape is PocketShape.SQUARE:
        hole = (np.abs(t) < 0.5 * along) & (np.abs(z) < 0.5 * across)
    whole, kept = math.pi * (r_o**2 - r_i**2) * w, ~hole
    assert ring.volume == pytest.approx(whole * kept.mean(), rel=2e-3)
    assert ring.axial == pytest.approx(whole * np.mean(kept * (x * x + t * t)), rel=2e-3)
    assert ring.transverse == pytest.approx(whole * np.mean(kept * (0.5 * (x * x + t * t) + z * z)), rel=2e-3)


def test_shape_gives_mass_and_inertia():
    """Without a mass: that of the ring of its material; with one, the inertia is scaled to it."""
    material = replace(shipped().cage.material, density=1500.0)
    study = shipped(mass=None, material=material, **SHAPE)
    found = cage_inertia(study.cage, study.bearing)
    whole = math.pi * (36e-3**2 - 29e-3**2) * 14e-3
    assert 0.3 * whole < found.mass / 1500.0 < 0.6 * whole  # square pockets take about half
    given = cage_inertia(replace(study.cage, mass=0.5 * found.mass), study.bearing)
    assert given.moment_of_inertia == pytest.approx(0.5 * found.moment_of_inertia)
    assert found.moment_of_inertia < 2.0 * found.transverse_inertia


IMPOSSIBLE = [
    ({"mass": None}, "mass is missing"),
    ({"transverse_inertia": 1e-6}, "half that about the axis"),
    ({"inner_diameter": 0.058}, "outer_diameter is missing"),
    (SHAPE | {"inner_diameter": 0.04}, "bottom of the inner groove"),
    (SHAPE | {"outer_diameter": 0.08}, "bottom of the outer groove"),
    (SHAPE | {"inner_diameter": 0.066}, "pitch diameter, 65 mm; got 66 mm"),
    (SHAPE | {"motion": MotionModel.SPACE, "outer_diameter": 0.066},
     "must lie between the least at which a pocket's wall reaches the ball, 66.05 mm and the bottom"),
    (SHAPE | {"width": 0.01}, "larger than a pocket"),
    ({"land_spacing": 0.01}, "no meaning for one land"),
    ({"motion": MotionModel.SPACE, "land_count": 2}, "land_spacing is missing"),
    (SHAPE | {"land_count": 2, "land_spacing": 0.012, "land_width": 0.004}, "must stay on the cage"),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "said"), IMPOSSIBLE)
def test_a_cage_that_cannot_be_is_refused(keys, said):
    """Sizes that leave no cage, lands beside it, an inertia that no body has: a line each."""
    with pytest.raises(InputError, match=re.escape(said)):
        shipped(**keys)


def test_forces_of_a_law():
    """Slope at rest, the capacity far out, and the knee by its definition."""
    law = BallTraction(mass=1e-3, slope=200.0, speed=0.4)
    u = np.array([1e-6, 0.4, 1e6])
    assert law.force(u) == pytest.approx([2e-4, 80.0 / 2**0.25, 80.0])
    assert law.force(-u) == pytest.approx(-law.force(u))


# What a moving cage refuses, by the words of the message; rules of a `CageDesign` too: above.

CAGE = replace(AT_REST, cage_speed=670.0, guidance=Guidance.OUTER, land_clearance=1e-3)
SLOT = {"pocket_shape": PocketShape.ELONGATED}

POSITIVE = (
    *("mass", "moment_of_inertia", "pitch_radius", "ball_cage_stiffness", "land_stiffness"),
    *("race_damping", "groove_damping", "transverse_inertia", "hertz_coefficient", "land_clearance"),
    *("land_radius", "inner_radius", "outer_radius"),
)
NOT_NEGATIVE = (
    *("ball_cage_friction", "land_friction", "unbalance", "gravity", "ball_diameter", "land_width"),
    *("added_mass", "groove_stiffness", "pivot_speed", "axial_kick", "tilt_kick"),
)

ONE_VALUE = [
    *((field, 0.0, "must be > 0") for field in POSITIVE),
    *((field, -1e-3, "must lie between 0 and ") for field in NOT_NEGATIVE),
    *((field, math.inf, "must be a finite number") for field in ("cage_speed", "inner_speed", "outer_speed")),
    ("ball_count", 11.0, "must be a whole number from 1 to 1000"),
    ("ramp_time", -1.0, "must be >= 0"),
    ("ramp_start", 0.0, "must be > 0 and <= 1"),
    ("axial_gravity", 2e6, "must lie between"),
    ("dynamic_unbalance", 0.2, "must lie between 0 and"),
    ("land_restitution", 1.1, "must lie between 0 and 1"),
    ("land_clearance", None, "is missing"),
    ("guidance", "outer", "must be one of"),
    ("pocket_shape", "square", "must be one of"),
    ("pocket_clearance", -1e-6, "must be >= 0"),
    ("pocket_axial_clearance", 1e-4, "has no meaning for a square pocket"),
    ("pocket_axial_offset", 1e-5, "changes nothing in a square pocket"),
    ("pocket_radial_offset", 1e-5, "has a meaning only for a spherical pocket"),
    ("pocket_position_scatter", 2e-4, "leaves no clearance"),
    ("pocket_angles", (0.0, 1.0), "must hold one angle for each of the 11 balls"),
    ("orbital_cosines", (math.nan,), "must be a finite number; got nan"),
    ("orbital_sines", (0.1,), "must be as many as orbital_cosines, 0"),
    ("ball_spin", (1.0, math.inf, 0.0), "must be a finite number; got inf"),
    ("ball_spin", (1.0, 2.0), "must have 3 items; got 2 of them"),
    ("transverse_inertia", 0.02 * 0.0325**2, "must be at least half that about the axis"),
    ("inner_radius", 0.033, "The walls of its pockets do not reach the balls."),
    ("outer_radius", 0.032, "The walls of its pockets do not reach the balls."),
]
"""A field, its value, and the rule that it breaks."""

TOGETHER = [
    ("pocket_axial_clearance", "must be > 0", SLOT | {"pocket_axial_clearance": 0.0}),
    ("outer_radius", "must be larger than inner_radius", {"inner_radius": 0.03, "outer_radius": 0.029}),
    ("pocket_axial_clearance", "is missing: an elongated pocket needs it", SLOT),
    ("pocket_radial_offset", "must be smaller than half the clearance, 300 um",
     {"pocket_shape": PocketShape.SPHERICAL, "pocket_radial_offset": -3e-4}),
    ("pocket_clearance", "must be > 0 with Hertz contact",
     {"pocket_clearance": 0.0, "hertz_coefficient": 3e8}),
    ("pocket_spacing_scatter", "and pocket_angles exclude each other",
     {"pocket_spacing_scatter": 0.1, "pocket_angles": tuple(0.5 * j for j in range(11))}),
    ("orbital_cosines", "must be empty for a ball set at rest",
     {"cage_speed": 0.0, "orbital_cosines": (0.1,), "orbital_sines": (0.1,)}),
]  # fmt: skip
"""The field that is refused, the rule, and values of which each is right by itself."""

REFUSED = [*((field, rule, {field: value}) for field, value, rule in ONE_VALUE), *TOGETHER]


@pytest.mark.parametrize(("field", "rule", "changes"), REFUSED)
def test_a_field_is_refused_in_words(field, rule, changes):
    """Each rule of one field or of several."""
    with pytest.raises(InputError, match=rf"MovingCage.{field}(\[\d\])? .*{re.escape(rule)}"):
        replace(CAGE, **changes)
