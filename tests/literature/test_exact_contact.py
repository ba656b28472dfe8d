"""Exact rolling contact against published numbers (validation).

Kalker: J.J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), Appendix E, with
Fx = C11 G ab xi, Fy = C22 G ab eta + C23 G (ab)^1.5 phi, Mz = C33 G (ab)^2 phi for equal bodies that stick.
The values beside the published three digits were computed by Galin polynomials without a grid.
"""

from csv import DictReader
from pathlib import Path

import numpy as np
import pytest
from exact_cases import contact, kalker

TABLE = Path(__file__).parent / "sources" / "kalker_c11.csv"

GALIN = [  # b/a, nu, C11, C22, C23, C33
    (0.1, 0.25, 3.316, 2.527, 0.4714, 8.331), (0.125, 0.3, 3.552, 2.554, 0.544, 7.105),
    (0.2, 0.0, 2.5914, 2.5914, 0.4835, 3.471), (0.2, 0.25, 3.3750, 2.6326, 0.6027, 4.295),
    (0.2, 0.3, 3.5911, 2.6399, 0.6344, 4.514), (0.2, 0.5, 4.8192, 2.6636, 0.8063, 5.695),
    (0.5, 0.25, 3.6253, 3.0124, 0.9280, 1.9381), (1.0, 0.0, 3.3953, 3.3953, 1.3333, 1.2072),
    (1.0, 0.25, 4.1128, 3.6683, 1.4661, 1.1843), (1.0, 0.5, 5.2042, 3.9811, 1.6310, 1.1586),
    (2.0, 0.25, 5.1001, 4.9089, 2.6242, 0.8196), (5.0, 0.25, 7.8119, 8.1900, 6.6373, 0.6045),
]  # fmt: skip
PUBLISHED = {
    (0.1, 0.25): (3.31, 2.52, 0.473, 8.28), (0.2, 0.0): (2.59, 2.59, 0.483, 3.46),
    (0.2, 0.25): (3.37, 2.63, 0.603, 4.27), (0.2, 0.5): (4.81, 2.66, 0.809, 5.66),
    (0.5, 0.25): (3.62, 3.01, 0.929, 1.93), (1.0, 0.0): (3.40, 3.40, 1.33, 1.21),
    (1.0, 0.25): (4.12, 3.67, 1.47, 1.19), (1.0, 0.5): (5.20, 3.98, 1.63, 1.16),
}  # fmt: skip


def coefficients(b, nu, columns, rows):
    """C11, C22, C23 from the force, C23 from the moment, C33."""
    made, e = contact(b, nu, columns=columns, rows=rows, friction=1e6), 1e-6
    along, across, spun = (kalker(made, *creep, tolerance=1e-7) for creep in np.eye(3) * -e)
    forces = along.force, across.lateral_force, spun.lateral_force, -across.spin_moment, spun.spin_moment
    return np.array(forces) / b ** np.array([1.0, 1.0, 1.5, 1.5, 2.0]) / e


@pytest.mark.parametrize("row", GALIN, ids=lambda row: f"{row[0]:g}-{row[1]:g}")
def test_kalkers_coefficients(row):
    """The usual grid of 1600 cells: 0.3 %, as asked of them. Published, to three digits: 1.1 %."""
    b, nu, *exact = row
    fine = coefficients(b, nu, None, None)
    # It is 40 x 40, 50 x 32 (2:1) or 68 x 24 (5:1). On 40 x 40 the long contacts are 0.10 (2:1) and 0.22 %
    # (5:1) off; C33, a small difference of two moments, 0.54 and 2.45 %.
    assert fine[2] == pytest.approx(fine[3], rel=1e-5)  # C23 = -C32
    values = np.delete(fine, 3)
    assert values == pytest.approx(exact, rel=3e-3)
    if (b, nu) in PUBLISHED:
        assert values == pytest.approx(PUBLISHED[b, nu], rel=0.011)
    if b > 1.0:
        square = np.delete(coefficients(b, nu, 40, 40), 3)
        assert square[:3] == pytest.approx(exact[:3], rel=2.5e-3)
        assert square[3] == pytest.approx(exact[3], rel=6e-3 if b == 2.0 else 2.5e-2)


EXTRAPOLATED = [(row, 40 if row[0] < 0.5 else 48) for row in GALIN]


@pytest.mark.parametrize(("row", "cells"), EXTRAPOLATED, ids=lambda x: f"{x}"[:12])
def test_kalkers_coefficients_extrapolated(row, cells):
    """All four to 0.1 % as asked, from 40 and 80 cells; b/a from a half on from 48 and 96, 0.076 % at most.

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
            found = -kalker(contact(b, nu, columns=28, rows=20, friction=1e6), 1e-6).force / 1e-6 / b
            assert found == pytest.approx(float(row[f"c11_nu_{nu:g}"]), rel=0.011)
