"""Pressure and tractions of unlike bodies, each under the other."""

from dataclasses import replace

import pytest
from exact_cases import body, kalker

from separatrix.chain.exact import ContactProblem, FrictionLaw, rolling_contact, solve_two_way
from separatrix.chain.exact import two_way as module
from separatrix.chain.exact.influence import half_space_flexibility
from separatrix.chain.hertz import contact_ellipse
from separatrix.ground.errors import ConvergenceError, InputError

BALL, TRACK = body(0.1), body(0.1, G=20.0)
SUM = (half_space_flexibility(BALL.base) + half_space_flexibility(TRACK.base))[1]  # 2/E*
BETA = (half_space_flexibility(BALL.base) - half_space_flexibility(TRACK.base))[2] / SUM  # 0.402
LOAD = 1e-3


def problem(friction=0.1, bodies=(BALL, TRACK), transverse=0.05, **changed):
    """Unlike bodies of gap curvature 1 along rolling."""
    given = {"own_pressure": True, "coupled": True} | changed
    ellipse = contact_ellipse(LOAD, 1.0, transverse, 2.0 / SUM)
    law = FrictionLaw(coefficient=friction)
    return ContactProblem(ellipse=ellipse, bodies=bodies, friction=law, **given)


def centre(contact):
    """Place of the pressure's resultant along rolling."""
    return (contact.grid.x * contact.pressure).sum() / contact.pressure.sum()


@pytest.mark.parametrize("creep", [1.0, -1.0])
def test_sliding_moves_the_pressure(creep):
    """Slender ellipse in full sliding: by 0.75 beta mu b to first order in beta mu; 1.5 %.

    Plane identity: (1/pi) int p/(x - s) + beta mu p = E* x/(2 R) times p, integrated, moves the resultant of
    a strip by (8/3 pi) beta mu b(y); weighted with the strips' loads 0.75 beta mu b. The ellipse's stretch
    takes the part b/a of it.
    """
    case = problem(0.1, transverse=0.004)
    contact, found = solve_two_way(case, longitudinal=creep, columns=24, rows=24)
    ratio = case.ellipse.semi_minor / case.ellipse.semi_major
    expected = 0.75 * BETA * 0.1 * case.ellipse.semi_minor / (1.0 + ratio)
    assert centre(contact) == pytest.approx(creep * expected, rel=0.015)
    assert found.force == pytest.approx(-creep * 0.1 * LOAD, rel=1e-5)


def test_the_effect_is_of_order_beta_mu():
    """Displacement over mu at friction 0.05 and 0.2: the same to 0.5 %, the second order."""
    moved = [
        centre(solve_two_way(problem(mu), longitudinal=1.0, columns=20, rows=20)[0]) / mu
        for mu in (0.05, 0.2)
    ]
    assert moved[0] == pytest.approx(moved[1], rel=5e-3)


def test_works_of_both_are_equal():
    """Betti: N times the displacement of the resultant over R is -int tau.W_c, in partial slip with spin.

    W_c comes of another method (a periodic grid); 2 % are its interpolation and the cut cells.
    """
    creeps = {"longitudinal": 0.006, "lateral": -0.003, "spin": 0.02}
    contact, found = solve_two_way(problem(0.3), **creeps, columns=28, rows=28)
    assert 0.0 < found.stick_share < 1.0
    work = -(found.traction * contact.coupling).sum() * contact.grid.cell_area
    assert LOAD * centre(contact) == pytest.approx(work, rel=0.02)


def test_equal_bodies_are_not_coupled():
    """As with their own pressure alone: 0.5 % is another grid."""
    same = problem(0.2, bodies=(BALL, BALL))
    contact, found = solve_two_way(same, longitudinal=0.01, columns=20, rows=20)
    alone = kalker(rolling_contact(same, columns=20, rows=20), xi=0.01)
    assert found.force == pytest.approx(alone.force, rel=5e-3)
    assert centre(contact) == pytest.approx(0.0, abs=1e-6 * same.ellipse.semi_minor)


def test_what_does_not_settle_is_an_error(monkeypatch):
    """Friction at which the contact leaves its box; a number of passes that is too small."""
    with pytest.raises(ConvergenceError, match="left its box"):
        solve_two_way(problem(3.0), longitudinal=1.0, columns=16, rows=16)
    monkeypatch.setattr(module, "LARGEST_PASSES", 1)
    with pytest.raises(ConvergenceError, match="did not settle in 1 passes") as raised:
        solve_two_way(problem(0.2), longitudinal=1.0, columns=16, rows=16)
    assert raised.value.iterations == 1
    assert raised.value.residual > module.SETTLED


@pytest.mark.parametrize("missing", ["own_pressure", "coupled"])
def test_both_are_needed(missing):
    """Refused in one line."""
    with pytest.raises(InputError, match=r"solve_two_way: problem must have own_pressure and coupled; got"):
        solve_two_way(replace(problem(), **{missing: False}))
