"""CONTACT's public examples of steady rolling (validation).

Source: eve70a/CONTACT (E. Vollebregt), examples/*.inp and *.ref_out. That program prints what its grid and
its first-order stencil make, 1 to 3 % off in steady rolling; the numbers below are closed forms or converged
values, as in test_exact_contact.py. Its units are N, mm and rad; forces act on body 1; its spin is Kalker's,
with the opposite sign to ours. Bodies that roll towards -x are solved as their mirror image.
"""

from dataclasses import replace

import numpy as np
import pytest

from separatrix import (
    Body,
    ContactProblem,
    FrictionLaw,
    Solid,
    creep_of_force,
    ellipse_of_axes,
    ellipse_of_curvatures,
    gap_contact,
    rigid_slip,
    rolling_contact,
    solve_each,
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
    """Contact on cells [mm] from `start` on, with the gap bend x^2 [mm]; each along and across."""
    x, y = (at + d * (np.arange(n) + 0.5) for at, d, n in zip(start, size, count, strict=True))
    gap = np.broadcast_to(bend * (x * x + size[0] ** 2 / 12.0), (y.size, x.size))
    sides = (n * d * MM for n, d in zip(count, size, strict=True))  # only its load and modulus count
    one = problem(ellipse_of_axes(load, *sides, modulus(bodies)), bodies, friction)
    return gap_contact(one, gap * MM, along=x * MM, across=y * MM, spacing=(size[1] * MM, size[0] * MM))


def solved(made, **creep):
    """Solution under creeps."""
    (one,) = solve_each(made, [rigid_slip(made.grid, **creep)])
    return one


def test_the_load_of_an_approach():
    """An approach a^2/R of 0.02 mm has the load 9.1954 N, to half a digit; CONTACT's 15 cells: 1.998e-2."""
    by_axes = ellipse_of_axes(1.0, MM, MM, modulus(POLYMER))
    by_curvatures = ellipse_of_curvatures(1.0, 0.02 / MM, 0.02 / MM, modulus(POLYMER))
    assert 0.02 * MM / by_axes.approach == pytest.approx(9.1954, abs=5e-5)
    assert (0.02 * MM / by_curvatures.approach) ** 1.5 == pytest.approx(9.1954, abs=5e-5)


def test_carter():
    """0.64 mu N exactly at this creep; 50 columns and a length of 200 half widths: 0.5 %."""
    made = on_cells(35780.0, STEEL, 0.3, (55, 1), (-1.07, -100.0), (0.04, 200.0), 0.001)
    one = solved(made, longitudinal=-0.00024)
    # 50 columns of a length of 200 half widths
    assert one.force / (0.3 * one.load) == pytest.approx(0.64, rel=5e-3)
    assert one.stick_share == pytest.approx(0.6, abs=1 / 50)  # to half a cell at either end


def test_bentall():
    """Free rolling of unlike rollers: 0.91476 (2 beta p0/E*) = 5.259e-4 with little friction; CONTACT: 5.260.

    The bodies roll towards -x: here its creeps and forces have the other sign. The line without slip,
    x0 = 0.404 a, is in one of 200 cells; over a cell the creep changes by x0 dx/(a^2 - x0^2) = 0.5 %. At
    mu = 0.05 CONTACT iterates pressure and traction; its first pass, which neglects the effect of tractions
    on the pressure as we do, prints 4.281e-4.
    """
    bodies = (0.31, 23000.0), (0.28, 82000.0)
    place = (216, 1), (-0.108, -500.0), (0.001, 1000.0), 0.02
    slippery, rough = (on_cells(16201.9, bodies, mu, *place) for mu in (0.0001, 0.05))
    assert solved(slippery, longitudinal=-0.00052).force < 0.0  # 5.2e-4 is less than free rolling
    free, _ = creep_of_force(slippery, 0.0)
    pulled, more, braked = (creep_of_force(rough, force)[0] for force in (-0.75, 0.0, 0.75))
    # change of the creep over the cell that has the line without slip
    assert free == pytest.approx(-5.259e-4, rel=5e-3)
    assert more == pytest.approx(-4.281e-4, rel=5e-3)
    assert pulled > more > braked


def test_traction_curve():
    """Converged: 243.8 N at 1e-5, 0.255 ... 0.774 mu N, with a film 63.6 N. 44 x 40 cells: 0.5 %."""
    shape = ellipse_of_axes(1.0, 0.5, 1.0, 1.0)
    curvatures = 2.0 * 0.0008 / MM * np.array([1.0, shape.curvature_transverse / shape.curvature_rolling])
    bare = problem(ellipse_of_curvatures(106700.0, *curvatures, modulus(STEEL)), STEEL, 0.33)
    film = replace(bare, film_compliance=1.25 * MM / (8200.0 * MPA))
    made, coated = (rolling_contact(one, columns=44, rows=40) for one in (bare, film))
    slips = [rigid_slip(made.grid, longitudinal=xi) for xi in (1e-5, 4e-4, 8e-4, 1.2e-3, 1.6e-3)]
    first, *curve = (one.force for one in solve_each(made, slips))
    # 44 x 40 cells against converged values
    assert [first, solved(coated, longitudinal=1e-5).force] == pytest.approx([-243.8, -63.6], rel=5e-3)
    assert np.array(curve) / (0.33 * 106700.0) == pytest.approx([-0.255, -0.468, -0.640, -0.774], rel=5e-3)


def test_fastsim():
    """Fy -0.625 +- 0.001 mu N, Mz -47 440 N mm, extrapolated from 30 and 60 cells."""
    one = problem(ellipse_of_axes(82000.0, 8.0 * MM, 4.0 * MM, modulus(STEEL)), STEEL, 0.3)
    found = []
    for cells in (30, 60):
        at = solved(rolling_contact(one, columns=cells, rows=cells), lateral=-0.000625, spin=-0.625)
        found.append(np.array([at.lateral_force / (0.3 * 82000.0), 1e3 * at.spin_moment]))
    force, moment = 2.0 * found[1] - found[0]
    # Half the step between the two, 0.002 mu N and 0.2 %, and the reference's own: 0.003 and 0.4 %.
    assert force == pytest.approx(-0.625, abs=3e-3)
    assert moment == pytest.approx(-47440.0, rel=4e-3)
