"""CONTACT's public examples, read from its input files (validation).

Source: eve70a/CONTACT (E. Vollebregt), examples/*.inp and *.ref_out. That program prints what its grid and
its first-order stencil make, 1 to 3 % off in steady rolling; the numbers below are closed forms or converged
values, as in test_exact_contact.py. Its units are N, mm and rad; forces act on body 1; spin is Kalker's.
"""

import math

import numpy as np
import pytest
from contact_inp import solved_inp as solved
from contact_inputs import (
    BENTALL,
    CARTER,
    CATTANEO,
    TRACTION_CURVE,
    fastsim,
    from_cattaneo_to_carter,
)


def test_cattaneo():
    """Sphere shifted by 7/8 of sliding: 8.156e-3 mm converged, CONTACT prints 8.155e-3; stick radius 1/2.

    15 cells a side: 0.1 %, as the fine and the converged number differ. Stick: to half a cell of its radius.
    """
    normal, shifted = solved(CATTANEO)
    assert (normal["force"], normal["slip_cells"]) == (0.0, 0)
    p0 = 1.5 * 9.1954 / math.pi * 1e6  # of a = 1 mm, which the load gives to its five digits
    assert normal["max_pressure"] == pytest.approx(p0, rel=1e-4)
    assert shifted["longitudinal_shift"] == pytest.approx(8.156e-6, rel=1e-3)
    assert shifted["force_share"] == pytest.approx(-0.875, abs=1e-5)  # as far as it was searched
    assert shifted["stick_share"] == pytest.approx(0.25, abs=2 * 0.5 / 15)
    assert (shifted["stick_cells"], shifted["slip_cells"]) == (45, 132)  # as CONTACT prints


@pytest.mark.parametrize("area", ["-3\n19 19 1. 1. 1.26667", "-1\n19 19 0.01 0.01 1.26667"])
def test_an_approach_in_place_of_the_load(area):
    """An approach a^2/R of 0.02 mm has the load 9.1954 N, to half a digit; CONTACT's 15 cells: 1.998e-2."""
    text = CATTANEO.partition(" 3 MODULE\n201120")[0] + " 0 MODULE\n"
    text = text.replace("200100", "200000").replace("9.1954", "0.02").replace("-3\n19 19 1. 1. 1.26667", area)
    (one,) = solved(text)
    assert one["load"] == pytest.approx(9.1954, abs=5e-5)


def test_carter():
    """0.64 mu N exactly at this creep; 50 columns and a length of 200 half widths: 0.5 %."""
    (one,) = solved(CARTER)
    assert one["force_share"] == pytest.approx(0.64, rel=5e-3)
    assert one["stick_share"] == pytest.approx(0.6, abs=1 / 50)  # to half a cell at either end


def test_bentall():
    """Free rolling of unlike rollers: 0.91476 (2 beta p0/E*) = 5.259e-4 with little friction; CONTACT: 5.260.

    The line without slip, x0 = 0.404 a, is in one of 200 cells; over a cell the creep changes by
    x0 dx/(a^2 - x0^2) = 0.5 %. At mu = 0.05 CONTACT iterates pressure and traction; its first pass, which
    neglects the effect of tractions on the pressure as we do, prints 4.281e-4.
    """
    given, free, more, pulled, braked = solved(BENTALL)
    assert given["force_share"] > 0.0  # 5.2e-4 is less than free rolling, and the bodies roll towards -x
    assert free["longitudinal_creep"] == pytest.approx(5.259e-4, rel=5e-3)
    assert more["longitudinal_creep"] == pytest.approx(4.281e-4, rel=5e-3)
    assert pulled["force_share"] == pytest.approx(0.75, abs=1e-5)  # as far as it was searched
    assert pulled["longitudinal_creep"] < more["longitudinal_creep"] < braked["longitudinal_creep"]


def test_traction_curve():
    """Converged: 243.8 N at 1e-5, 0.255 ... 0.774 mu N, with a film 63.6 N. 44 x 40 cells: 0.5 %."""
    rows = solved(TRACTION_CURVE)
    assert [rows[0]["force"], rows[-1]["force"]] == pytest.approx([-243.8, -63.6], rel=5e-3)
    shares = [row["force_share"] for row in rows[1:-1]]
    assert shares == pytest.approx([-0.255, -0.468, -0.640, -0.774], rel=5e-3)


def test_fastsim():
    """Fy -0.625 +- 0.001 mu N, Mz -47 440 N mm, extrapolated from 30 and 60 cells.

    Half the step between the two, 0.002 mu N and 0.2 %, and the reference's own: 0.003 and 0.4 %.
    """
    rough, fine = (
        np.array([row["lateral_force_share"], 1e3 * row["spin_moment"]])
        for row in (solved(fastsim(cells))[0] for cells in (33, 66))
    )
    force, moment = 2.0 * fine - rough
    assert force == pytest.approx(-0.625, abs=3e-3)
    assert moment == pytest.approx(-47440.0, rel=4e-3)


def test_from_cattaneo_to_carter():
    """The onset of rolling under a constant force, against what CONTACT prints; the last case is steady.

    In transient rolling both have the same cells and the same stencil, and differ by the cut cells at the
    outline: the creeps agree to 0.5 %, the elements of the shift exactly.
    """
    rows = solved(from_cattaneo_to_carter(56))
    assert (rows[0]["stick_cells"], rows[0]["slip_cells"]) == (305, 316)
    assert rows[0]["longitudinal_shift"] == pytest.approx(1.774e-5, rel=5e-3)
    printed = [1.824e-3, 1.882e-3, 1.955e-3, 2.050e-3, 2.140e-3, 2.221e-3, 2.334e-3, 3.101e-3]
    creeps = [row["longitudinal_creep"] for row in rows[1:8] + rows[-1:]]
    assert creeps == pytest.approx(printed, rel=5e-3)
    assert [row["force_share"] for row in rows] == pytest.approx([-0.657] * 57, abs=1e-5)  # the search


def test_rolling_the_other_way_is_the_mirror_image():
    """CHI = 180 degrees and the opposite force: the opposite creep; it is searched to 1e-6 of saturation."""
    ahead, behind = (solved(from_cattaneo_to_carter(3, turned=turned))[1:] for turned in (False, True))
    creeps = [row["longitudinal_creep"] for row in ahead]
    assert [-row["longitudinal_creep"] for row in behind] == pytest.approx(creeps, rel=1e-5)
