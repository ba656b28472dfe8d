"""What a cage in space refuses, as the body itself, as the cage that has it, and as the key of a study."""

import math
from dataclasses import replace

import pytest
from cages import ON_A_LAND, TURNING
from space_cages import IN_PLANE, ROUND, in_space

from separatrix.cage_body import cage_inertia
from separatrix.cage_design import CageDesign, ClearanceState, MotionModel, PocketContact
from separatrix.chain.solution import solve
from separatrix.errors import InputError, ValidityWarning
from separatrix.pocket_shape import PocketShape
from separatrix.present import plain
from separatrix.study import Guidance
from separatrix.study_file import read_study

BODY = [
    ({"transverse_inertia": 0.0}, "transverse_inertia must be > 0"),
    ({"ball_diameter": math.nan}, "ball_diameter must be"),
    ({"groove_stiffness": -1.0}, "groove_stiffness must lie between 0 and"),
    ({"pivot_speed": -1.0}, "pivot_speed must lie between 0 and"),
    ({"land_width": -1e-3}, "land_width must lie between 0 and"),
    ({"added_mass": -1e-3}, "added_mass must lie between 0 and"),
    ({"axial_kick": -1.0}, "axial_kick must lie between 0 and"),
    ({"tilt_kick": math.inf}, "tilt_kick must be"),
    ({"axial_gravity": math.nan}, "axial_gravity must be"),
    ({"dynamic_unbalance": 0.2}, "dynamic_unbalance must lie between 0 and 5.73 deg"),
    *[({"groove_damping": value}, "groove_damping must be > 0") for value in (0.0, math.nan)],
    *[({"axial_play": value}, "axial_play must be >= 0") for value in (-1e-4, math.nan)],
    ({"friction_lever": -1e-3}, "friction_lever must lie between 0 and"),
    ({"land_radius": 0.0}, "land_radius must be > 0"),
    ({"outer_radius": 0.0}, "outer_radius must be > 0"),
    ({"inner_radius": math.nan}, "inner_radius must be"),
    ({"inner_radius": 0.03, "outer_radius": 0.03}, "outer_radius must be larger than inner_radius"),
    ({"ball_spin": (1.0, math.nan, 2.0)}, "ball_spin must each be a finite number [rad/s]; got nan"),
    ({"land_heights": (math.inf,)}, "land_heights must each be a finite number [m]; got inf"),
    ({"ball_spin": (1.0, 2.0)}, "ball_spin must be three numbers [rad/s]; got 2"),
    ({"land_heights": (0.0, 1e-3, 2e-3)}, "land_heights must be one or two [m]; got 3"),
]


@pytest.mark.parametrize(("changes", "words"), BODY)
def test_a_body_that_cannot_be_is_refused(changes, words):
    """One line, with the field's name."""
    with pytest.raises(InputError) as caught:
        replace(ROUND.space, **changes)
    assert f"SpaceBody.{words}" in str(caught.value)
    assert "\n" not in str(caught.value)


CAGES = [
    ({"moment_of_inertia": 1e-3}, "SpaceBody.transverse_inertia must be at least half that about the axis"),
    ({"hertz_coefficient": 1e9}, "PlanarCage.hertz_coefficient has no meaning for a cage in space"),
    ({"land_out_of_round": 1e-5}, "PlanarCage.land_out_of_round has no meaning for a cage in space"),
    (
        {"pocket_clearance": 0.0, "pocket_shape": PocketShape.CYLINDRICAL},
        "PlanarCage.pocket_clearance must be > 0 for round pockets in space",
    ),
    ({"land_count": 2}, "SpaceBody.land_heights must be 2, as land_count says; got 1"),
]
EDGES = [
    ("SQUARE", 6e-4, {"outer_radius": 27.5e-3}, "SpaceBody.outer_radius must be > 0.02757 [m]; got 27.5 mm"),
    ("SQUARE", 6e-4, {"inner_radius": 38.1e-3}, "SpaceBody.inner_radius must be < 0.03806 [m]; got 38.1 mm"),
    ("SQUARE", 0.0, {"outer_radius": 32.2e-3}, "PlanarCage.pocket_clearance must be > 0 mm where the wall"),
    (
        "CYLINDRICAL",
        4e-4,
        {"outer_radius": 32.2e-3},
        "pocket_clearance must be > 479.2 um where the",
    ),
    ("CYLINDRICAL", 4e-4, {"inner_radius": 33.8e-3}, "must be > 622.2 um where the"),
]


@pytest.mark.parametrize(("shape", "clearance", "radii", "words"), EDGES)
def test_a_ring_that_cannot_hold_its_balls_is_refused(shape, clearance, radii, words):
    """Too short a wall for any ball; and pockets so tight that their edge has two nearest points."""
    cage = replace(
        ON_A_LAND, land_clearance=1e-3, pocket_shape=PocketShape[shape], pocket_clearance=clearance
    )
    with pytest.raises(InputError) as caught:
        in_space(cage, **radii)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    in_space(replace(cage, pocket_clearance=8e-4), outer_radius=32.2e-3)


@pytest.mark.parametrize(("changes", "words"), CAGES)
def test_a_cage_in_space_that_cannot_be_is_refused(changes, words):
    """One line, with the record and the field; the same cage without a body in space is taken."""
    cage = in_space(ON_A_LAND)
    with pytest.raises(InputError) as caught:
        replace(cage, **changes)
    assert words in str(caught.value)
    replace(cage, **changes, space=None)


FLAT = CageDesign(pocket_clearance=6e-4, mass=0.025, guidance=Guidance.OUTER, land_clearance=1e-3)
SPACE = replace(FLAT, motion=MotionModel.SPACE)
DESIGNS = [
    (FLAT, {"land_spacing": 1e-2}, "land_spacing has no meaning for a cage in the plane"),
    (FLAT, {"transverse_inertia": 1e-5}, "transverse_inertia has no meaning for a cage in the plane"),
    (FLAT, {"axial_gravity": 9.81}, "axial_gravity has no meaning for a cage in the plane"),
    (FLAT, {"added_mass": 1e-3}, "added_mass has no meaning for a cage in the plane"),
    (SPACE, {"pocket_contact": PocketContact.HERTZ}, "pocket_contact must be linear for a cage in space"),
    (SPACE, {"land_out_of_round": 1e-5}, "land_out_of_round has no meaning for a cage in space"),
    (
        SPACE,
        {"pocket_clearance": 0.0, "pocket_shape": PocketShape.CYLINDRICAL},
        "pocket_clearance must be > 0 for round pockets in space",
    ),
    (SPACE, {"land_count": 2}, "land_spacing is missing: two lands have a distance"),
    (SPACE, {"land_spacing": 1e-2}, "land_spacing has no meaning for one land"),
    (
        SPACE,
        {"land_width": 2e-2, "inner_diameter": 5.8e-2, "outer_diameter": 7.2e-2, "width": 1.4e-2},
        "land_width and the lands' distance, 20 mm together, must stay on the cage; got width 14 mm",
    ),
    (SPACE, {"inner_diameter": 5.8e-2}, "outer_diameter is missing"),
    (
        SPACE,
        {"land_count": 2, "land_spacing": 1e-3, "land_width": 3e-3},
        "land_spacing must be at least a land's width, 3 mm; got 1 mm",
    ),
]


@pytest.mark.parametrize(("cage", "changes", "words"), DESIGNS)
def test_a_study_of_a_cage_in_space_that_cannot_be_is_refused(cage, changes, words):
    """One line, with the key."""
    with pytest.raises(InputError) as caught:
        replace(cage, **changes)
    assert f"CageDesign.{words}" in str(caught.value)


IN_THE_BEARING = [
    ({"land_diameter": 3e-3}, "land_diameter must lie between the bottoms of the grooves, 53.89 mm and"),
    ({"land_diameter": 33.0}, "land_diameter must lie between the bottoms of the grooves, 53.89 mm and"),
    ({"land_width": 0.2}, "land_width must leave all lands within 4 balls, 44.45 mm"),
    ({"land_count": 2, "land_spacing": 0.5}, "land_spacing must leave all lands within 4 balls, 44.45 mm"),
    ({"added_mass": 5.0}, "added_mass must be at most 100 times that of the cage, 25 g"),
    ({"transverse_inertia": 1e-4}, "transverse_inertia must lie between 13.2 kg mm2, half"),
    ({"transverse_inertia": 1e-6}, "transverse_inertia must lie between 13.2 kg mm2, half"),
]


@pytest.mark.parametrize(("changes", "words"), IN_THE_BEARING)
def test_a_body_in_space_that_the_bearing_cannot_hold_is_refused(changes, words):
    """In the shipped bearing, of 25 g on 65 mm; a body that fits is taken."""
    study = read_study("cryogenic-turbopump")
    with pytest.raises(InputError) as caught:
        replace(study, cage=replace(study.cage, motion=MotionModel.SPACE, **changes))
    assert f"CageDesign.{words}" in str(caught.value)
    lands = {"land_count": 2, "land_spacing": 12e-3, "land_width": 3e-3, "land_diameter": 66e-3}
    held = {"added_mass": 0.2, "transverse_inertia": 1.4e-5}
    replace(study, cage=replace(study.cage, motion=MotionModel.SPACE, **lands, **held))


RING = {"inner_diameter": 58e-3, "outer_diameter": 72e-3, "width": 18e-3}
FROM_SHAPE = {**RING, "mass": None}
IMPOSSIBLE = [
    ({"moment_of_inertia": 1e-3}, "moment_of_inertia must lie between 18.15 kg mm2 and 36.21 kg mm2; got"),
    ({"moment_of_inertia": 1e-9}, "moment_of_inertia must lie between 18.15 kg mm2 and 36.21 kg mm2; got"),
    ({**RING, "moment_of_inertia": 4e-5}, "moment_of_inertia must lie between 18.15 kg mm2 and 36.21 kg mm2"),
    ({**RING, "transverse_inertia": 1e-3}, "transverse_inertia must lie between 13."),
    ({**FROM_SHAPE, "transverse_inertia": 1e-7}, "transverse_inertia must lie between"),
    ({**FROM_SHAPE, "unbalance": 1e-2}, "unbalance must be smaller than mass times pitch radius"),
    ({**FROM_SHAPE, "added_mass": 50.0}, "added_mass must be at most 100 times that of the cage"),
    ({**RING, "pocket_clearance": 4e-3}, "inner_diameter must be > 63.15 mm, where bars are left"),
    ({**RING, "land_diameter": 80e-3}, "land_diameter must lie between the surfaces of the cage, 58 mm and"),
    ({**RING, "land_clearance": 5e-3}, "land_clearance must be smaller than what is left to the bottom of"),
    ({**RING, "outer_diameter": 80e-3}, "outer_diameter must lie between the least that holds a ball"),
]


@pytest.mark.parametrize(("changes", "words"), IMPOSSIBLE)
def test_a_body_that_no_cage_of_this_size_has_is_refused(changes, words):
    """Whether the mass is stated or that of the ring; the ring is taken, with its inertia or another."""
    study = read_study("cryogenic-turbopump")
    known = replace(
        study.cage, motion=MotionModel.SPACE, material=replace(study.cage.material, density=1.8e3)
    )
    with pytest.raises(InputError) as caught:
        replace(study, cage=replace(known, **changes))
    assert f"CageDesign.{words}" in str(caught.value)
    assert "\n" not in str(caught.value)
    taken = [replace(study, cage=replace(known, **FROM_SHAPE, moment_of_inertia=J)) for J in (None, 2.2e-5)]
    ring, light = (cage_inertia(one.cage, one.bearing) for one in taken)
    along = ring.transverse_inertia - ring.moment_of_inertia / 2.0  # what the mass has along the axis
    assert light.transverse_inertia == pytest.approx(1.1e-5 + along, rel=1e-12)  # rounding


def test_bars_between_uneven_pockets_are_those_at_the_bore():
    """A scatter of 10 % leaves bars at the pitch diameter, not at a bore of 58 mm (12.5, 7.9 % by hand)."""
    study = read_study("cryogenic-turbopump")
    uneven = replace(study.cage, pocket_spacing_scatter=0.1)
    replace(study, cage=uneven)
    with pytest.raises(InputError, match=r"CageDesign.pocket_spacing_scatter must be < 0.07929,"):
        replace(study, cage=replace(uneven, **RING))


EDGED = {
    "motion": MotionModel.SPACE,
    "pocket_shape": PocketShape.CYLINDRICAL,
    "inner_diameter": 60e-3,
    "outer_diameter": 64.6e-3,
    "width": 18e-3,
}


def test_pockets_too_tight_for_their_edges_are_refused_by_their_key():
    """With the study, where its clearances are as it runs; else by the chain, with the same key."""
    study = read_study("cryogenic-turbopump")
    with pytest.raises(InputError) as caught:
        replace(study, cage=replace(study.cage, **EDGED, pocket_clearance=1e-4))
    assert str(caught.value).startswith("CageDesign.pocket_clearance must be > 419.5 um where the wall")
    at_rest = replace(study.cage, **EDGED, pocket_clearance=3e-4, clearances=ClearanceState.AT_REST)
    with pytest.warns(ValidityWarning, match="rest on guesses"), pytest.raises(InputError) as caught:
        solve(replace(study, cage=at_rest)).cage_with(0.1)
    assert str(caught.value).startswith("[cage] pocket_clearance must be > 479.3 um where the wall")
    assert "It is that of the running cage." in str(caught.value)
    solve(replace(study, cage=replace(study.cage, **EDGED, pocket_clearance=6e-4))).cage_with(0.1)


def test_the_lever_of_friction_is_the_radius_of_the_ball_unless_it_is_given():
    """Half the ball's diameter, or the given one."""
    assert ROUND.space.lever == pytest.approx(11.1125e-3 / 2.0, rel=1e-15)
    assert in_space(TURNING, **IN_PLANE).space.lever == 0.0


@pytest.mark.parametrize(
    ("shape", "along", "play"),
    [("SQUARE", None, 3e-4), ("CYLINDRICAL", None, 3e-4), ("ELONGATED", 2e-4, 1e-4)],
)
def test_the_cage_of_a_study_in_space_has_finite_numbers_only(shape, along, play):
    """Whatever its pockets: a number that is not finite would be null in the answer."""
    study = read_study("cryogenic-turbopump")
    pockets = {"pocket_shape": PocketShape[shape], "pocket_axial_clearance": along, "pocket_clearance": 6e-4}
    design = replace(study.cage, motion=MotionModel.SPACE, **pockets)
    body = solve(replace(study, cage=design)).cage_with(0.1).space
    assert body.axial_play == pytest.approx(play)
    assert plain(body, "body")["axial_play"] == body.axial_play  # plain refuses what is not finite
