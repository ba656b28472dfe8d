"""Exact rolling contact against published numbers (validation).

Kalker: J.J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), Appendix E, with
Fx = C11 G ab xi, Fy = C22 G ab eta + C23 G (ab)^1.5 phi, Mz = C33 G (ab)^2 phi for equal bodies that stick.
The values beside the published three digits were computed by Galin polynomials without a grid.

CONTACT: public examples of that program (E. Vollebregt). It prints what its own grids make, whose first-order
stencil is 1 to 3 % off; the numbers here are its converged values.
"""

import math
from csv import DictReader
from pathlib import Path

import numpy as np
import pytest
from exact_cases import body, contact, kalker

from separatrix.chain.exact.rolling import ContactProblem, rolling_contact
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.hertz import ContactEllipse

TABLE = Path(__file__).parent / "sources" / "kalker_c11.csv"

GALIN = [  # b/a, nu, C11, C22, C23, C33
    (0.1, 0.25, 3.316, 2.527, 0.4714, 8.331),
    (0.125, 0.3, 3.552, 2.554, 0.544, 7.105),
    (0.2, 0.0, 2.5914, 2.5914, 0.4835, 3.471),
    (0.2, 0.25, 3.3750, 2.6326, 0.6027, 4.295),
    (0.2, 0.3, 3.5911, 2.6399, 0.6344, 4.514),
    (0.2, 0.5, 4.8192, 2.6636, 0.8063, 5.695),
    (0.5, 0.25, 3.6253, 3.0124, 0.9280, 1.9381),
    (1.0, 0.0, 3.3953, 3.3953, 1.3333, 1.2072),
    (1.0, 0.25, 4.1128, 3.6683, 1.4661, 1.1843),
    (1.0, 0.5, 5.2042, 3.9811, 1.6310, 1.1586),
    (2.0, 0.25, 5.1001, 4.9089, 2.6242, 0.8196),
    (5.0, 0.25, 7.8119, 8.1900, 6.6373, 0.6045),
]
PUBLISHED = {
    (0.1, 0.25): (3.31, 2.52, 0.473, 8.28),
    (0.2, 0.0): (2.59, 2.59, 0.483, 3.46),
    (0.2, 0.25): (3.37, 2.63, 0.603, 4.27),
    (0.2, 0.5): (4.81, 2.66, 0.809, 5.66),
    (0.5, 0.25): (3.62, 3.01, 0.929, 1.93),
    (1.0, 0.0): (3.40, 3.40, 1.33, 1.21),
    (1.0, 0.25): (4.12, 3.67, 1.47, 1.19),
    (1.0, 0.5): (5.20, 3.98, 1.63, 1.16),
}


def coefficients(b, nu, columns, rows):
    """C11, C22, C23 from the force, C23 from the moment, C33."""
    made, e = contact(b, nu, columns=columns, rows=rows, friction=1e6), 1e-6
    along, across, spun = (kalker(made, *creep, tolerance=1e-7) for creep in np.eye(3) * -e)
    return (
        np.array(
            [
                along.force / b,
                across.lateral_force / b,
                spun.lateral_force / b**1.5,
                -across.spin_moment / b**1.5,
                spun.spin_moment / b**2,
            ]
        )
        / e
    )


@pytest.mark.parametrize("row", GALIN, ids=lambda row: f"{row[0]:g}-{row[1]:g}")
def test_kalkers_coefficients(row):
    """The usual grid of 1600 cells: 0.3 %, as asked of them. Published, to three digits: 1.1 %.

    It is 40 x 40, 50 x 32 (2:1) or 68 x 24 (5:1). On 40 x 40 the long contacts are 0.10 (2:1) and 0.22 %
    (5:1) off; C33, a small difference of two moments, 0.54 and 2.45 %.
    """
    b, nu, *exact = row
    fine = coefficients(b, nu, None, None)
    assert fine[2] == pytest.approx(fine[3], rel=1e-5)  # C23 = -C32
    values = np.delete(fine, 3)
    assert values == pytest.approx(exact, rel=3e-3)
    if (b, nu) in PUBLISHED:
        assert values == pytest.approx(PUBLISHED[b, nu], rel=0.011)
    if b > 1.0:
        square = np.delete(coefficients(b, nu, 40, 40), 3)
        assert square[:3] == pytest.approx(exact[:3], rel=2.5e-3)
        assert square[3] == pytest.approx(exact[3], rel=6e-3 if b == 2.0 else 2.5e-2)


EXTRAPOLATED = [(row, 40 if row[0] < 0.5 else 80) for row in GALIN]


@pytest.mark.parametrize(("row", "cells"), EXTRAPOLATED, ids=lambda x: f"{x}"[:12])
def test_kalkers_coefficients_extrapolated(row, cells):
    """All four to 0.1 % as asked, from 40 and 80 cells; b/a from a half on from 80 and 160.

    The stencil is of second order, and so is the extrapolation. The first order leaves 0.2 % of C33 at 5:1,
    whose error falls by 3.8 from 40 to 80 cells.
    """
    b, nu, *exact = row
    best = (4.0 * coefficients(b, nu, 2 * cells, 2 * cells) - coefficients(b, nu, cells, cells)) / 3.0
    assert np.delete(best, 3) == pytest.approx(exact, rel=1e-3)


def test_published_c11():
    """Every C11 of the source file to 1.1 %: its steps beside nu = 0.5, ratio 0.5 are uneven by 0.04."""
    with TABLE.open() as file:
        rows = list(DictReader(line for line in file if not line.startswith("#")))
    for row in rows:
        b = float(row["ratio_rolling_to_transverse"])
        for nu in (0.0, 0.25, 0.5):
            made = contact(b, nu, columns=28, rows=20, friction=1e6)
            assert -kalker(made, 1e-6).force / 1e-6 / b == pytest.approx(
                float(row[f"c11_nu_{nu:g}"]), rel=0.011
            )


def given(a, b, load, G, nu, mu, cells=40, **options):
    """Equal bodies on an ellipse of half lengths a along rolling and b across (CONTACT's), N and mm."""
    ellipse = ContactEllipse(
        load=load,
        semi_major=b,
        semi_minor=a,
        max_pressure=1.5 * load / (math.pi * a * b),
        approach=0.0,
        curvature_rolling=1.0,
        curvature_transverse=1.0,
        contact_modulus=G / (1.0 - nu),
    )
    both = body(nu, G=G), body(nu, G=G)
    problem = ContactProblem(ellipse=ellipse, bodies=both, friction=FrictionLaw(coefficient=mu), **options)
    return rolling_contact(problem, columns=cells, rows=cells)


def test_traction_curve_of_contact():
    """Its example tractcurv: 243.8 N at a creep of 1e-5, 0.255 ... 0.774 mu N at 4e-4 ... 1.6e-3; 0.5 %."""
    made = given(6.3035, 12.6076, 106700.0, 82000.0, 0.28, 0.33)
    assert -kalker(made, 1e-5).force == pytest.approx(243.8, rel=5e-3)
    found = [-kalker(made, xi).force / (0.33 * 106700.0) for xi in (4e-4, 8e-4, 1.2e-3, 1.6e-3)]
    assert found == pytest.approx([0.255, 0.468, 0.640, 0.774], rel=5e-3)
    coated = given(6.3035, 12.6076, 106700.0, 82000.0, 0.28, 0.33, film_compliance=1.25 / 8200.0)
    assert -kalker(coated, 1e-5).force == pytest.approx(63.6, rel=5e-3)


def test_spin_and_lateral_creep_of_contact():
    """Its example fastsim: -0.625 +- 0.001 mu N across, -47 440 N mm, extrapolated from 30 and 60 cells.

    0.003 and 0.5 %. At 60 cells the force is still 0.5 % low.
    """
    found = []
    for cells in (30, 60):
        made = given(8.0, 4.0, 82000.0, 82000.0, 0.28, 0.3, cells=cells)
        one = kalker(made, eta=-6.25e-4, phi=6.25e-4)
        found.append(np.array([abs(one.lateral_force) / (0.3 * 82000.0), abs(one.spin_moment)]))
    force, moment = 2.0 * found[1] - found[0]
    assert force == pytest.approx(0.625, abs=0.003)
    assert moment == pytest.approx(47440.0, rel=5e-3)
