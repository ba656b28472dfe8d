"""Speed of the exact contact: map of 41 creeps and 5 spins on 40 x 40 cells, slopes, own pressure."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from separatrix.chain.exact.influence import Body, Layer, solid
from separatrix.chain.exact.pressure import pressed_contact
from separatrix.chain.exact.rolling import ContactProblem, rigid_slip, rolling_contact, solve_each
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import traction_slope
from separatrix.chain.hertz import Creep, contact_ellipse

STEEL = solid(200e9, 0.25)
BARE = Body(base=STEEL)
COATED = Body(base=STEEL, layers=(Layer(thickness=1e-6, solid=solid(4e9, 0.38)),))
MODULUS = STEEL.shear_modulus / 0.75
MU = 0.1
ELLIPSE = contact_ellipse(200.0, 180.0, 15.2, MODULUS)  # b/a = 0.2, 1.2 GPa
CREEPS = np.append(0.0, np.geomspace(2e-5, 4.0, 40))  # over xi_s
SPINS = (0.0, 2.0, 4.0, 8.0, 15.0)


def problem(film):
    """Bare, with a film in series, or with a true layer."""
    L = 1e-6 / COATED.surface.shear_modulus if film == "series" else 0.0
    race = COATED if film == "layer" else BARE
    law = FrictionLaw(coefficient=MU)
    return ContactProblem(ellipse=ELLIPSE, bodies=(BARE, race), friction=law, film_compliance=L)


def traction_map(film, threads=2):
    """Forces at 205 points, preparation of the contact included."""
    made = rolling_contact(problem(film), columns=40, rows=40)
    xi_s = 2.0 * MU * ELLIPSE.max_pressure / MODULUS

    def curve(spin):
        s = spin * xi_s / ELLIPSE.semi_major
        return [
            one.force
            for one in solve_each(
                made, (rigid_slip(made.grid, longitudinal=c * xi_s, spin=s) for c in CREEPS)
            )
        ]

    with ThreadPoolExecutor(threads) as pool:
        return np.array(list(pool.map(curve, SPINS)))


@pytest.mark.parametrize("film", ["bare", "series", "layer"])
@pytest.mark.parametrize("threads", [1, 2])
def test_map_of_205_points(benchmark, film, threads):
    """Under 1 s on two quiet cores."""
    forces = benchmark(traction_map, film, threads)
    assert forces.shape == (5, 41)
    assert -forces.min() <= MU * ELLIPSE.load * 1.000001


@pytest.mark.parametrize("film", ["bare", "layer"])
def test_slope_of_a_race(benchmark, film):
    """With its error, free rolling included: under 0.5 s."""
    creep = Creep(spin=-12.0, curvature=1.4e4)
    found = benchmark(traction_slope, problem(film), creep)
    assert math.isfinite(found.slope)


def test_pressure_of_a_coated_contact(benchmark):
    """28 x 64 cells of tractions, three times as fine each way."""
    grid, _, _ = benchmark(pressed_contact, ELLIPSE, (BARE, COATED), columns=28, rows=64)
    assert grid.fraction.max() == 1.0
