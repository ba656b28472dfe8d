"""Fluid in the gap of a land: its added mass by another method and in both limits, its decay, its inputs.

And what else moves a critical friction: what of it the inputs of a study allow to put in or leave out.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_banded

from separatrix import moving_cage, read_study, solve
from separatrix.chain.land_fluid import annulus_mass, decay_rate, land_fluid
from separatrix.verdict.effects import MOVED, WIDE, effects_on

STUDY = read_study("cryogenic-turbopump")
WIDE_LAND = replace(STUDY.cage, land_width=0.004)


@pytest.mark.parametrize("length", [1e-4, 4e-3, 0.02, 0.3])
def test_added_mass_of_an_annulus(length):
    """Pressure of unit acceleration by finite differences: P'' - P/R^2 = rho/c, P = 0 at both ends."""
    rho, radius, gap, cells = 806.0, 0.0325, 5e-4, 4000
    h = length / cells
    beside = np.full(cells - 1, 1.0 / h**2)
    bands = np.vstack([beside, -2.0 * beside - 1.0 / radius**2, beside])
    pressure = solve_banded((1, 1), bands, np.full(cells - 1, rho / gap))
    mass = -math.pi * radius * float(pressure.sum()) * h
    # second order in cells of a pressure that bends within R: (h/R)^2/12 = 5e-7 at 0.3 m
    assert annulus_mass(rho, radius, length, gap) == pytest.approx(mass, rel=3e-6)


def test_added_mass_of_short_and_long_annuli():
    """The short one has rho pi R L^3/(12 c), the long one rho pi R^3 L/c less its ends."""
    rho, R, c = 806.0, 0.0325, 5e-4
    short, long = 1e-5, 10.0
    assert annulus_mass(rho, R, short, c) == pytest.approx(rho * math.pi * R * short**3 / (12 * c), rel=1e-6)
    whole = rho * math.pi * R**3 * long / c
    assert annulus_mass(rho, R, long, c) == pytest.approx(whole * (1.0 - 2.0 * R / long), rel=1e-12)
    near = 2.0 * 1e-2 * R  # where the series takes over: its next term, 17/105 x^4
    below, above = (annulus_mass(rho, R, near * (1.0 + e), c) for e in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=1e-8)


def test_walls_hold_a_flow_by_hirs_or_laminar():
    """0.066 Re^-1/4 U/c from Re 2.7e4; 12 nu/c^2 of a flow at rest. findings3.md has 100 to 180 1/s here."""
    rho, mu, c = 806.08, 160.66e-6, 5e-4
    speed = 2.73e4 * mu / (rho * c)
    assert decay_rate(mu, rho, speed, c) == pytest.approx(0.066 * 2.73e4**-0.25 * speed / c, rel=1e-12)
    assert decay_rate(mu, rho, 0.0, c) == pytest.approx(12.0 * mu / (rho * c**2), rel=1e-12)
    found = land_fluid(STUDY, WIDE_LAND, 670.0)
    assert 90.0 < found.damping / found.added_mass < 180.0


def test_a_fluid_needs_a_land_of_some_width_and_a_fluid_near_its_temperature():
    """Else nothing is said of it; two lands have twice as much."""
    assert land_fluid(STUDY, STUDY.cage, 670.0) is None
    for change in ({"temperature": 110.0}, {"temperature": None}):
        warm = replace(STUDY, operation=replace(STUDY.operation, **change))
        assert land_fluid(warm, WIDE_LAND, 670.0) is None
    assert land_fluid(read_study("momentum-wheel"), WIDE_LAND, 670.0) is None
    both = replace(WIDE_LAND, land_count=2, land_spacing=0.01)
    assert land_fluid(STUDY, both, 670.0).added_mass == 2.0 * land_fluid(STUDY, WIDE_LAND, 670.0).added_mass


def found(radial_load=0.0, **cage):
    """Cage and effects of the shipped study with other inputs."""
    operation = replace(STUDY.operation, radial_load=radial_load)
    solution = solve(replace(STUDY, operation=operation, cage=replace(STUDY.cage, land_width=0.0, **cage)))
    moving = moving_cage(solution, 0.1)
    return moving, dict(effects_on(solution, moving))


def test_what_a_study_states_is_left_out_and_a_land_that_stops_its_cage_widened():
    """Fluid that moves with the cage, unequal balls, and their lead and lag under a radial load."""
    # the pockets of the shipped cage stop it, its balls are alike, and its lands have no width
    assert found()[1] == {}
    cage, effects = found(land_clearance=1e-4)
    assert effects["wide_land"].values == {"land_clearance": WIDE * cage.pocket_clearance}
    effects = found(added_mass=0.02, ball_diameter_scatter=1e-7, radial_load=500.0)[1]
    assert [*effects] == ["fluid", "equal_balls", "even_orbits"]
    assert effects["fluid"].values["added_mass"] == 0.0
    assert effects["even_orbits"].values["orbital_cosines"] == ()


@pytest.mark.parametrize(("width", "count"), [(14e-3, 1), (2e-3, 0)])
def test_the_fluid_of_a_land_is_put_in_where_it_counts(width, count):
    """A long annulus of liquid nitrogen weighs as the cage does; a short one less than a twentieth of it."""
    solution = solve(replace(STUDY, cage=replace(STUDY.cage, land_width=width)))
    cage = moving_cage(solution, 0.1)
    effects = dict(effects_on(solution, cage))
    assert len(effects) == count
    radius = cage.land_radius or cage.pitch_radius
    mass = cage.land_count * annulus_mass(808.0, radius, width, 0.5 * cage.land_clearance)
    assert (mass > MOVED * cage.mass) == bool(count)
    if count:
        fluid = effects["fluid"].values
        # 808 kg/m3 for the density of the library at the nearest temperature that it has
        assert fluid["added_mass"] == pytest.approx(mass, rel=1e-2)
        assert fluid["fluid_speed"] == 0.5 * cage.cage_speed  # halfway to an outer ring at rest
