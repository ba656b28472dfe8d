"""Pockets, land, scatter and start-up in a study: every key with its unit, every rule with its one line."""

import math

import pytest
from commands import refusal_line, rows_of, written

from separatrix import CageDesign, PocketShape, read_study
from separatrix.study.pocket_shape import half_play, tilt
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
