"""CONTACT's public examples (validation).

Source: eve70a/CONTACT (E. Vollebregt), examples/*.inp and *.ref_out. That program prints what its grid and
its first-order stencil make, 1 to 3 % off in steady rolling; the numbers below are closed forms or converged
values, as in test_exact_contact.py. Its units are N, mm and rad; forces act on body 1; its spin is Kalker's,
with the opposite sign to ours. Bodies that roll towards -x are solved as their mirror image.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from separatrix import (
    Body,
    ContactCase,
    ContactMotion,
    ContactProblem,
    ContactQuestion,
    ContactSetup,
    FrictionLaw,
    Gap,
    Solid,
    ellipse_of_axes,
    ellipse_of_curvatures,
    exact_contact,
)

MM, MPA = 1e-3, 1e6
STEEL = (0.28, 82000.0), (0.28, 82000.0)
"""Poisson's ratio and shear modulus [MPa] of both bodies in most examples."""
POLYMER = (0.42, 200.0), (0.42, 200.0)


def modulus(bodies):
    """E* of a pair [Pa]."""
    return MPA / sum((1.0 - nu) / (2.0 * G) for nu, G in bodies)


def problem(ellipse, bodies, friction, **given):
    """Contact of bodies of these Poisson's ratios and moduli."""
    pair = tuple(Body(base=Solid(shear_modulus=G * MPA, poisson_ratio=nu)) for nu, G in bodies)
    law = FrictionLaw(coefficient=friction)
    return ContactProblem(ellipse=ellipse, bodies=pair, friction=law, coupled=pair[0] != pair[1], **given)


def on_cells(load, bodies, friction, count, start, size, bend):
    """Contact on cells [mm] from `start` on, with the gap bend x^2 + bend y^2 [mm]; each along and across."""
    x, y = (at + d * (np.arange(n) + 0.5) for at, d, n in zip(start, size, count, strict=True))
    (dx, dy), (bx, by) = size, bend
    height = bx * (x * x + dx * dx / 12.0) + by * (y * y + dy * dy / 12.0)[:, None]
    gap = Gap(along=x * MM, across=y * MM, row_width=dy * MM, column_width=dx * MM, height=height * MM)
    sides = (n * d * MM for n, d in zip(count, size, strict=True))  # only its load and modulus count
    ellipse = ellipse_of_axes(load, *sides, modulus(bodies))
    return ContactSetup(problem=problem(ellipse, bodies, friction), gap=gap)


def solved(*cases):
    """Solved cases in their order."""
    return exact_contact(ContactQuestion(cases=cases)).cases


def elements(one):
    """Cells that stick, those that the outline cuts counted as whole, and that slip."""
    stick = int(one.solution.stick.sum())
    return stick, int((one.solution.pressure > 0.0).sum()) - stick


def test_cattaneo():
    """Sphere shifted by 7/8 of sliding: 8.156e-3 mm converged, CONTACT prints 8.155e-3; stick radius 1/2.

    15 cells a side: 0.1 %, as the fine and the converged number differ. Stick: to half a cell of its radius.
    """
    sphere = ellipse_of_axes(9.1954, MM, MM, modulus(POLYMER))
    plain = ContactSetup(problem=problem(sphere, POLYMER, 0.4), columns=15, rows=15)
    cells = on_cells(9.1954, POLYMER, 0.4, (19, 19), (-1.26667,) * 2, (0.13333,) * 2, (0.01, 0.01))
    normal, shifted = solved(
        ContactCase(setup=plain, motion=ContactMotion.SHIFT),
        ContactCase(setup=cells, motion=ContactMotion.SHIFT, wanted=(-0.875, 0.0)),
    )
    assert (normal.solution.force, elements(normal)[1]) == (0.0, 0)
    p0 = 1.5 * 9.1954 / math.pi * 1e6  # of a = 1 mm, which the load gives to its five digits
    assert normal.solution.max_pressure == pytest.approx(p0, rel=1e-4)
    assert shifted.case.longitudinal_shift == pytest.approx(8.156e-6, rel=1e-3)
    assert shifted.sliding_share[0] == pytest.approx(-0.875, abs=1e-5)  # as far as it was searched
    assert shifted.solution.stick_share == pytest.approx(0.25, abs=2 * 0.5 / 15)
    assert elements(shifted) == (45, 132)  # as CONTACT prints


def test_the_load_of_an_approach():
    """An approach a^2/R of 0.02 mm has the load 9.1954 N, to half a digit; CONTACT's 15 cells: 1.998e-2."""
    by_axes = ellipse_of_axes(1.0, MM, MM, modulus(POLYMER))
    by_curvatures = ellipse_of_curvatures(1.0, 0.02 / MM, 0.02 / MM, modulus(POLYMER))
    assert 0.02 * MM / by_axes.approach == pytest.approx(9.1954, abs=5e-5)
    assert (0.02 * MM / by_curvatures.approach) ** 1.5 == pytest.approx(9.1954, abs=5e-5)


def test_carter():
    """0.64 mu N exactly at this creep; 50 columns and a length of 200 half widths: 0.5 %."""
    setup = on_cells(35780.0, STEEL, 0.3, (55, 1), (-1.07, -100.0), (0.04, 200.0), (0.001, 0.0))
    (one,) = solved(ContactCase(setup=setup, longitudinal_creep=-0.00024))
    assert one.sliding_share[0] == pytest.approx(0.64, rel=5e-3)
    assert one.solution.stick_share == pytest.approx(0.6, abs=1 / 50)  # to half a cell at either end


def test_bentall():
    """Free rolling of unlike rollers: 0.91476 (2 beta p0/E*) = 5.259e-4 with little friction; CONTACT: 5.260.

    The bodies roll towards -x: here its creeps and forces have the other sign. The line without slip,
    x0 = 0.404 a, is in one of 200 cells; over a cell the creep changes by x0 dx/(a^2 - x0^2) = 0.5 %. At
    mu = 0.05 CONTACT iterates pressure and traction; its first pass, which neglects the effect of tractions
    on the pressure as we do, prints 4.281e-4.
    """
    bodies = (0.31, 23000.0), (0.28, 82000.0)
    place = (216, 1), (-0.108, -500.0), (0.001, 1000.0), (0.02, 0.0)
    slippery, rough = (on_cells(16201.9, bodies, mu, *place) for mu in (0.0001, 0.05))
    given, free, more, pulled, braked = solved(
        ContactCase(setup=slippery, longitudinal_creep=-0.00052),
        ContactCase(setup=slippery, wanted=(0.0, None)),
        *(ContactCase(setup=rough, wanted=(force, None)) for force in (0.0, -0.75, 0.75)),
    )
    assert given.sliding_share[0] < 0.0  # 5.2e-4 is less than free rolling
    assert free.case.longitudinal_creep == pytest.approx(-5.259e-4, rel=5e-3)
    assert more.case.longitudinal_creep == pytest.approx(-4.281e-4, rel=5e-3)
    assert pulled.sliding_share[0] == pytest.approx(-0.75, abs=1e-5)  # as far as it was searched
    creeps = [one.case.longitudinal_creep for one in (pulled, more, braked)]
    assert creeps == sorted(creeps, reverse=True)


def test_traction_curve():
    """Converged: 243.8 N at 1e-5, 0.255 ... 0.774 mu N, with a film 63.6 N. 44 x 40 cells: 0.5 %."""
    shape = ellipse_of_axes(1.0, 0.5, 1.0, 1.0)
    curvatures = 2.0 * 0.0008 / MM * np.array([1.0, shape.curvature_transverse / shape.curvature_rolling])
    bare = problem(ellipse_of_curvatures(106700.0, *curvatures, modulus(STEEL)), STEEL, 0.33)
    film = replace(bare, film_compliance=1.25 * MM / (8200.0 * MPA))
    setup, coated = (ContactSetup(problem=one, columns=44, rows=40) for one in (bare, film))
    first, *curve = (
        ContactCase(setup=setup, longitudinal_creep=xi) for xi in (1e-5, 4e-4, 8e-4, 1.2e-3, 1.6e-3)
    )
    found = solved(first, *curve, replace(first, setup=coated))
    assert [found[0].solution.force, found[-1].solution.force] == pytest.approx([-243.8, -63.6], rel=5e-3)
    shares = [one.sliding_share[0] for one in found[1:-1]]
    assert shares == pytest.approx([-0.255, -0.468, -0.640, -0.774], rel=5e-3)


def test_fastsim():
    """Fy -0.625 +- 0.001 mu N, Mz -47 440 N mm, extrapolated from 30 and 60 cells.

    Half the step between the two, 0.002 mu N and 0.2 %, and the reference's own: 0.003 and 0.4 %.
    """
    one = problem(ellipse_of_axes(82000.0, 8.0 * MM, 4.0 * MM, modulus(STEEL)), STEEL, 0.3)
    setups = [ContactSetup(problem=one, columns=n, rows=n) for n in (30, 60)]
    found = solved(*(ContactCase(setup=at, lateral_creep=-0.000625, spin=-0.625) for at in setups))
    rough, fine = (np.array([one.sliding_share[1], 1e3 * one.solution.spin_moment]) for one in found)
    force, moment = 2.0 * fine - rough
    assert force == pytest.approx(-0.625, abs=3e-3)
    assert moment == pytest.approx(-47440.0, rel=4e-3)


def test_from_cattaneo_to_carter():
    """The onset of rolling under a constant force, against what CONTACT prints; the last case is steady.

    In transient rolling both have the same cells and the same stencil, and differ by the cut cells at the
    outline: the creeps agree to 0.5 %, the elements of the shift exactly.
    """
    soft = (0.28, 1.0), (0.28, 1.0)
    setup = on_cells(0.4705, soft, 0.4013, (34, 33), (-4.125, -4.125), (0.25, 0.25), (0.002963, 0.002963))
    shift = ContactCase(setup=setup, motion=ContactMotion.SHIFT, wanted=(-0.657, None))
    roll = replace(shift, motion=ContactMotion.TRANSIENT, distance=0.25 * MM, continues=True)
    found = solved(shift, *[roll] * 56)
    assert elements(found[0]) == (305, 316)
    assert found[0].case.longitudinal_shift == pytest.approx(1.774e-5, rel=5e-3)
    printed = [1.824e-3, 1.882e-3, 1.955e-3, 2.050e-3, 2.140e-3, 2.221e-3, 2.334e-3, 3.101e-3]
    creeps = [one.case.longitudinal_creep for one in (*found[1:8], found[-1])]
    assert creeps == pytest.approx(printed, rel=5e-3)
    assert [one.sliding_share[0] for one in found] == pytest.approx([-0.657] * 57, abs=1e-5)  # the search
