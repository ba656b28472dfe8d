"""Running clearances: their limits, the rotating ring by another road, and what closes or is not known."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import with_distributions
from scipy.integrate import solve_bvp
from scipy.linalg import solve_banded

from separatrix import InputError, moving_cage, read_study, solve
from separatrix.chain.clearances import TurningRing, mean_expansion, running_clearances
from separatrix.chain.heat_balance import annulus_mass, decay_rate, land_fluid
from separatrix.study.ball_bearing import Expansion
from separatrix.study.keys import with_values
from separatrix.study.study import ClearanceState, Guidance, Material, PocketShape
from separatrix.study.uncertain import uniform
from separatrix.verdict.beyond_models import MOVED, WIDE, effects_on, pocket_of
from separatrix.verdict.draws import sample

STUDY = read_study("cryogenic-turbopump")
BEARING = STUDY.bearing
RUNNING = replace(STUDY, cage=replace(STUDY.cage, clearances=ClearanceState.AT_REST))
"""The shipped study with clearances at rest."""

STEEL = replace(BEARING.ring_material, expansions=(), thermal_expansion=10e-6)
PLASTIC = Material(
    name="plastic", elastic_modulus=5e9, poisson_ratio=0.35, density=1500.0, thermal_expansion=40e-6
)

SHAPE = {"inner_diameter": 58e-3, "outer_diameter": 72e-3, "width": 14e-3}


def running(temperature=90.0, cage_speed=0.0, material=PLASTIC, steel=STEEL, **design):
    """Clearances of a cage of the shipped bearing, of these materials."""
    bearing = replace(BEARING, ball_material=steel, ring_material=steel)
    speed = 1000.0 if cage_speed else 0.0
    operation = replace(STUDY.operation, temperature=temperature, inner_speed=speed)
    cage = replace(STUDY.cage, clearances=ClearanceState.AT_REST, material=None, **design)
    return running_clearances(bearing, operation, cage, material, cage_mass=0.01, cage_speed=cage_speed)


def test_at_293_k_at_rest_nothing_changes():
    """To the last bit, without any datum; and a cage that states its running clearances keeps them."""
    bare = replace(PLASTIC, thermal_expansion=None)
    found = running(293.0, material=bare, steel=replace(STEEL, thermal_expansion=None), **SHAPE)
    assert (found.pocket, found.land) == (STUDY.cage.pocket_clearance, STUDY.cage.land_clearance)
    assert found.pitch_radius_growth == 0.0
    assert solve(STUDY).design is STUDY.cage


def test_equal_materials_scale_every_clearance():
    """Everything shrinks alike: 203 K times 10e-6."""
    found = running(material=replace(PLASTIC, thermal_expansion=10e-6), **SHAPE)
    for runs, rest in ((found.pocket, found.pocket_at_rest), (found.land, found.land_at_rest)):
        assert runs == pytest.approx(rest * (1.0 - 203.0 * 10e-6), rel=1e-12)


def test_pocket_and_land_by_hand():
    """A cage inside its outer land and one outside its inner land move opposite ways."""
    cage, steel, D = 203.0 * 40e-6, 203.0 * 10e-6, BEARING.ball_diameter
    pocket = STUDY.cage.pocket_clearance
    found = running(**SHAPE)
    assert found.pocket == pytest.approx((D + pocket) * (1.0 - cage) - D * (1.0 - steel), rel=1e-12)
    assert found.land == pytest.approx((72e-3 + 1e-3) * (1.0 - steel) - 72e-3 * (1.0 - cage), rel=1e-9)
    inner = running(**SHAPE, guidance=Guidance.INNER)
    assert inner.land == pytest.approx(58e-3 * (1.0 - cage) - (58e-3 - 1e-3) * (1.0 - steel), rel=1e-9)
    assert found.guesses == ()


def test_spherical_pockets_move_off_their_balls():
    """By the growth of the cage beyond that of the rings, which takes of their clearance."""
    sphere = {"pocket_shape": PocketShape.SPHERICAL, "pocket_clearance": 2.1e-3}
    moved = running(**SHAPE, **sphere).pocket_radial_offset
    assert moved == pytest.approx(-BEARING.pitch_diameter / 2.0 * 203.0 * 30e-6, rel=1e-12)  # rounding
    assert running(**SHAPE).pocket_radial_offset == 0.0
    cage = replace(RUNNING.cage, **sphere)
    bearing = replace(BEARING, ball_material=STEEL, ring_material=STEEL)
    there = solve(replace(RUNNING, bearing=bearing, cage=replace(cage, material=PLASTIC)))
    moves = moving_cage(there, 0.1)
    assert moves.pocket_radial_offset == there.clearances.pocket_radial_offset < 0.0
    left = math.sqrt((moves.pocket_clearance / 2.0) ** 2 - moves.pocket_radial_offset**2)
    assert moves.half_play == pytest.approx(left, rel=1e-12)  # rounding


def test_thick_ring_solves_its_differential_equation():
    """R u'' + u' - u/r = -(1 - nu^2) rho w^2 r^2 / E with free edges, by collocation."""
    E, nu, rho, w = PLASTIC.elastic_modulus, PLASTIC.poisson_ratio, PLASTIC.density, 2000.0
    ring = TurningRing(inner=0.02, outer=0.03, material=PLASTIC, density=rho, speed=w)
    a, b = ring.inner, ring.outer
    scale = rho * w**2 * b**3 / E

    def slope(r, y):
        return np.vstack([y[1], -(1.0 - nu**2) * rho * w**2 * r / E / scale - y[1] / r + y[0] / r**2])

    def free(at_a, at_b):
        return np.array([at_a[1] + nu * at_a[0] / a, at_b[1] + nu * at_b[0] / b])

    r = np.linspace(a, b, 21)
    solved = solve_bvp(slope, free, r, np.ones((2, r.size)), tol=1e-9)
    found = [ring.growth(x) / scale for x in r]
    assert solved.sol(r)[0] == pytest.approx(found, rel=1e-7)


def test_rotation_opens_the_pocket_and_closes_an_outer_land():
    """The cage grows with the square of its speed."""
    slow, fast = (running(293.0, cage_speed=w, **SHAPE) for w in (1000.0, 2000.0))
    assert fast.hoop_strain == pytest.approx(4.0 * slow.hoop_strain, rel=1e-12)
    assert fast.pocket > slow.pocket > slow.pocket_at_rest
    assert fast.land < slow.land < slow.land_at_rest
    assert fast.land_at_rest - fast.land == pytest.approx(2.0 * fast.cage_land_growth, rel=1e-9)


@pytest.mark.parametrize(
    ("temperature", "mean", "why"),
    [(90.0, 10e-6, "a guess"), (190.0, 15e-6, "a guess"), (300.0, 20e-6, ""), (60.0, 10e-6, "that at 80 K")],
)
def test_expansion_between_and_beyond_data(temperature, mean, why):
    """Linear between data, the nearest beyond them; a guess of the library stays one."""
    data = (Expansion(80.0, 100.0, 10e-6, "guess"), Expansion(280.0, 320.0, 20e-6, "handbook"))
    known = replace(PLASTIC, thermal_expansion=None, expansions=data)
    found, reason = mean_expansion(known, temperature)
    assert found == pytest.approx(mean, rel=1e-12)
    assert reason.startswith(why)
    assert mean_expansion(replace(known, thermal_expansion=3e-6), temperature) == (3e-6, "")


def test_published_contractions():
    """440C shrinks by 0.177 % to 80 K and 0.182 % to 60 K (GNIRS design note SDN0013.02)."""
    for temperature, contraction in ((80.0, 0.177e-2), (60.0, 0.182e-2)):
        alpha, why = mean_expansion(BEARING.ring_material, temperature)
        assert (alpha * (293.0 - temperature), why) == (pytest.approx(contraction, rel=2e-3), "")


UNKNOWN = [
    ({"pocket_clearance": 20e-6}, r"^[^\n]*pocket_clearance closes to -.* at 90 K .*20 um at 293 K[^\n]*$"),
    ({"material": replace(PLASTIC, thermal_expansion=None)}, r"thermal expansion from 293 K to 90 K.*um/m/K"),
    ({"pocket_shape": PocketShape.SPHERICAL, "pocket_clearance": 4e-4}, "pocket_clearance closes to -"),
    ({"temperature": None}, "temperature is missing"),
    ({"material": None}, "material is missing"),
]


@pytest.mark.parametrize(("given", "said"), UNKNOWN)
def test_what_closes_or_is_not_known_is_refused(given, said):
    """One line with the numbers, or what is missing with its cure."""
    with pytest.raises(InputError, match=said):
        running(**given)


def test_draws_and_sweeps_go_through_it():
    """Each study that is drawn has its own running clearance; the study keeps those at rest."""
    cold = solve(RUNNING)
    warm = solve(with_values(RUNNING, {"operation.temperature": 200.0}))
    fast = solve(with_values(RUNNING, {"operation.inner_speed": 2000.0}))
    assert cold.clearances.pocket < warm.clearances.pocket < RUNNING.cage.pocket_clearance
    assert fast.clearances.hoop_strain > cold.clearances.hoop_strain
    assert moving_cage(cold, 0.1).pocket_clearance == cold.clearances.pocket
    assert cold.study.cage.pocket_clearance == RUNNING.cage.pocket_clearance
    drawn = with_distributions(RUNNING, {"operation.temperature": uniform(low=70.0, high=200.0)})
    each = sample(drawn, 4)
    found = [solve(each.setter()(row)).clearances.pocket for row in each.values]
    assert len(set(found)) == 4


def test_each_candidate_has_its_own_pocket():
    """With one stiffness for all; the second verdict, by the other ball, has the same clearances."""
    solved = [solve(RUNNING, one) for one in RUNNING.ranking.candidates]
    pockets = {pocket_of(one) for one in solved}
    assert len({pocket.stiffness for pocket in pockets}) == 1
    expansions = {one.cage_material.expansions for one in solved}
    assert len({pocket.clearance for pocket in pockets}) == len(expansions)
    assert {one.design.clearances for one in solved} == {ClearanceState.RUNNING}


# Fluid in the gap of a land: its added mass by another method and in both limits, its decay, its inputs.
# And what else moves a critical friction: what of it the inputs of a study allow to put in or leave out.

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
    assert annulus_mass(rho, radius, length, gap) == pytest.approx(mass, rel=5e-7)


def test_added_mass_of_short_and_long_annuli():
    """The short one has rho pi R L^3/(12 c), the long one rho pi R^3 L/c less its ends."""
    rho, R, c = 806.0, 0.0325, 5e-4
    short, long = 1e-5, 10.0
    # 2/5 (L/2R)^2 = 9.5e-9 is the next term
    assert annulus_mass(rho, R, short, c) == pytest.approx(rho * math.pi * R * short**3 / (12 * c), rel=1e-8)
    whole = rho * math.pi * R**3 * long / c
    # rounding: what decays from the ends is exp(-L/R)
    assert annulus_mass(rho, R, long, c) == pytest.approx(whole * (1.0 - 2.0 * R / long), rel=1e-12)
    near = 2.0 * 1e-2 * R  # where the series takes over: its next term, 17/105 x^4 = 1.6e-9; of L^3, 6e-9
    below, above = (annulus_mass(rho, R, near * (1.0 + e), c) for e in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=1e-8)


def test_walls_hold_a_flow_by_hirs_or_laminar():
    """0.066 Re^-1/4 U/c from Re 2.7e4; 12 nu/c^2 of a flow at rest. findings3.md has 100 to 180 1/s here."""
    rho, mu, c = 806.08, 160.66e-6, 5e-4
    speed = 2.73e4 * mu / (rho * c)
    # both are rounding
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
