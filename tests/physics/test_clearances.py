"""Running clearances: their limits, the rotating ring by another road, and what closes or is not known."""

from dataclasses import replace

import numpy as np
import pytest
from cages import with_distributions
from scipy.integrate import solve_bvp

from separatrix import InputError, moving_cage, read_study, solve
from separatrix.chain.clearances import TurningRing, mean_expansion, running_clearances
from separatrix.study.ball_bearing import Expansion
from separatrix.study.distribution import uniform
from separatrix.study.keys import with_values
from separatrix.study.study import ClearanceState, Guidance, Material
from separatrix.verdict.beyond_models import pocket_of
from separatrix.verdict.draws import sample

STUDY = read_study("cryogenic-turbopump")
BEARING = STUDY.bearing
RUNNING = replace(STUDY, cage=replace(STUDY.cage, clearances=ClearanceState.AT_REST))
"""The shipped study with clearances at rest."""

STEEL = replace(BEARING.ring_material, expansions=(), thermal_expansion=10e-6)
PLASTIC = Material(
    name="plastic", elastic_modulus=5e9, poisson_ratio=0.35, density=1500.0, thermal_expansion=40e-6
)
RING = {"density": 1500.0, "elastic_modulus": 5e9, "poisson_ratio": 0.35, "speed": 2000.0}


def ring_growth(radius, *, inner, outer, density, elastic_modulus, poisson_ratio, speed):
    """Growth of a ring of a material of these numbers."""
    material = Material(name="ring", elastic_modulus=elastic_modulus, poisson_ratio=poisson_ratio)
    ring = TurningRing(inner=inner, outer=outer, material=material, density=density, speed=speed)
    return ring.growth(radius)


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


def test_thick_ring_solves_its_differential_equation():
    """R u'' + u' - u/r = -(1 - nu^2) rho w^2 r^2 / E with free edges, by collocation."""
    (rho, E, nu, w), a, b = RING.values(), 0.02, 0.03
    scale = rho * w**2 * b**3 / E

    def slope(r, y):
        return np.vstack([y[1], -(1.0 - nu**2) * rho * w**2 * r / E / scale - y[1] / r + y[0] / r**2])

    def free(at_a, at_b):
        return np.array([at_a[1] + nu * at_a[0] / a, at_b[1] + nu * at_b[0] / b])

    r = np.linspace(a, b, 21)
    solved = solve_bvp(slope, free, r, np.ones((2, r.size)), tol=1e-9)
    found = [ring_growth(x, inner=a, outer=b, **RING) / scale for x in r]
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
