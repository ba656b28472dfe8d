"""What else moves a critical friction: what of it the inputs of a study allow to put in or leave out."""

from dataclasses import replace

import pytest

import separatrix
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.land_fluid import annulus_mass
from separatrix.verdict.effects import MOVED, WIDE, effects_on

SHIPPED = separatrix.read_study("cryogenic-turbopump")


def found(radial_load=0.0, **cage):
    """Cage and effects of the shipped study with other inputs."""
    operation = replace(SHIPPED.operation, radial_load=radial_load)
    solution = separatrix.solve(
        replace(SHIPPED, operation=operation, cage=replace(SHIPPED.cage, land_width=0.0, **cage))
    )
    moving = moving_cage(solution, 0.1)
    return moving, effects_on(solution, moving)


def test_what_a_study_does_not_state_is_no_effect():
    """The pockets of the shipped cage stop it, its balls are alike, and its lands have no width."""
    assert found()[1] == {}


def test_the_land_of_a_cage_that_it_stops_is_widened():
    """To 1.6 times the clearance of the pocket."""
    cage, effects = found(land_clearance=1e-4)
    assert effects["wide_land"].values == {"land_clearance": WIDE * cage.pocket_clearance}


@pytest.mark.parametrize(("width", "count"), [(14e-3, 1), (2e-3, 0)])
def test_the_fluid_of_a_land_is_put_in_where_it_counts(width, count):
    """A long annulus of liquid nitrogen weighs as the cage does; a short one less than a twentieth of it."""
    solution = separatrix.solve(replace(SHIPPED, cage=replace(SHIPPED.cage, land_width=width)))
    cage = moving_cage(solution, 0.1)
    effects = effects_on(solution, cage)
    assert len(effects) == count
    radius = cage.land_radius or cage.pitch_radius
    mass = cage.land_count * annulus_mass(808.0, radius, width, 0.5 * cage.land_clearance)
    assert (mass > MOVED * cage.mass) == bool(count)
    if count:
        fluid = effects["fluid"].values
        # 808 kg/m3 for the density of the library at the nearest temperature that it has
        assert fluid["added_mass"] == pytest.approx(mass, rel=1e-2)
        assert fluid["fluid_speed"] == 0.5 * cage.cage_speed  # halfway to an outer ring at rest


def test_what_a_study_states_is_left_out():
    """Fluid that moves with the cage, unequal balls, and their lead and lag under a radial load."""
    effects = found(added_mass=0.02, ball_diameter_scatter=1e-7, radial_load=500.0)[1]
    assert [*effects] == ["fluid", "equal_balls", "even_orbits"]
    assert effects["fluid"].values["added_mass"] == 0.0
    assert effects["even_orbits"].values["orbital_cosines"] == ()
