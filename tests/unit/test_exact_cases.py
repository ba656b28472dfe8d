"""`exact_contact`: cases in their order, stated forces, what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import separatrix
from separatrix import ContactCase, ContactMotion, ContactQuestion, ContactSetup
from separatrix.chain.exact import cases as module
from separatrix.ground.errors import ConvergenceError, InputError

STEEL = separatrix.Body(base=separatrix.solid(200e9, 0.285))
MODULUS = 200e9 / (1.0 - 0.285**2) / 2.0
PROBLEM = separatrix.ContactProblem(
    ellipse=separatrix.ellipse_of_axes(300.0, 0.15e-3, 0.45e-3, MODULUS),
    bodies=(STEEL, STEEL),
    friction=separatrix.FrictionLaw(coefficient=0.1),
)
SETUP = ContactSetup(problem=PROBLEM, columns=12, rows=12)


def solved(*cases):
    """Solved cases of a question."""
    return separatrix.exact_contact(ContactQuestion(cases=cases)).cases


def rolled(**changed):
    """Solved case under a creep of 2e-4, with a change of the problem."""
    question = separatrix.rolling_cases(replace(PROBLEM, **changed), longitudinal=2e-4, columns=12, rows=12)
    return separatrix.exact_contact(question).cases[0].solution


def test_a_batch_of_creeps():
    """Creeps are broadcast; the answer has a case for each in its order, and progress is told of each."""
    asked = separatrix.rolling_cases(PROBLEM, longitudinal=[1e-4, 2e-4], spin=1.0, columns=10, rows=10)
    told = []
    first, second = separatrix.exact_contact(asked, progress=lambda *at: told.append(at)).cases
    assert told == [(1, 2), (2, 2)]
    assert (first.case.longitudinal_creep, first.case.spin, first.reason) == (1e-4, 1.0, "")
    assert second.solution.force < first.solution.force < 0.0 < first.solution.lateral_force  # phi = -s < 0
    assert first.case.setup is second.case.setup
    assert second.sliding_share[0] == pytest.approx(second.solution.force / 30.0, rel=1e-12)  # rounding


def test_a_force_of_zero_between_equal_bodies_needs_no_creep():
    """Free rolling; another force has the creep of its sign, along and across."""
    free, pulled = solved(case(wanted=(0.0, None)), case(wanted=(0.5, -0.5)))
    assert free.case.longitudinal_creep == 0.0
    assert pulled.sliding_share == pytest.approx((0.5, -0.5), abs=1e-4)  # how far it is searched
    assert pulled.case.longitudinal_creep < 0.0 < pulled.case.lateral_creep


def test_a_case_that_does_not_converge_is_a_row_with_its_reason(monkeypatch):
    """No solution, but residual and reason; a case that starts from it has none either."""
    usual, calls = module.solve, []

    def fails_second(*given, **options):
        calls.append(given)
        if len(calls) == 2:
            raise ConvergenceError("Tractions did not settle.", 60, 0.02)
        return usual(*given, **options)

    monkeypatch.setattr(module, "solve", fails_second)
    steady = case(longitudinal_creep=1e-4)
    further = replace(steady, **TRANSIENT, distance=0.05e-3, continues=True)
    found = solved(steady, steady, further, steady, further)
    assert [one.solution is None for one in found] == [False, True, True, False, False]
    assert (found[1].residual, found[1].reason) == (0.02, "Tractions did not settle.")
    assert found[2].reason == module.FAILED_BEFORE


def test_the_slope_is_that_of_the_curve():
    """Without spin it is a tangent: of a small creep the chord, to its error and that of 12 columns."""
    asked = separatrix.rolling_cases(PROBLEM, longitudinal=1e-6, columns=12, rows=16, slope=True)
    found = separatrix.exact_contact(asked)
    chord = -found.cases[0].solution.force / 300.0 / 1e-6
    slope = found.slope
    assert slope.slope == pytest.approx(chord, rel=0.3 / 12 + slope.slope_error / slope.slope)
    assert (slope.free_rolling_offset, found.slope_reason) == (0.0, "")


def test_a_shift_and_rolling_from_a_start():
    """A further shift has a larger force; rolling goes on from the tractions before, in whole columns."""
    shift = case(**SHIFT, longitudinal_shift=0.1e-6, turn=1e-4)
    near, far = solved(shift, replace(shift, longitudinal_shift=0.2e-6))
    assert far.solution.force < near.solution.force < 0.0
    start = case(**TRANSIENT, longitudinal_creep=0.001, distance=0.05e-3)
    begun, further = solved(start, replace(start, distance=0.151e-3, continues=True))
    assert further.solution.force < begun.solution.force < 0.0
    # columns of 2 x 0.15 mm/12
    assert [begun.case.distance, further.case.distance] == pytest.approx([0.05e-3, 0.15e-3])
    whole = solved(replace(start, distance=0.2e-3))[0].solution
    assert further.solution.force == pytest.approx(whole.force, rel=1e-4)  # the solver's tolerance


def test_rough_surfaces_and_the_pressure_under_tractions():
    """Roughness softens the contact; two ways move its pressure."""
    assert abs(rolled(roughness=1e-6).force) < 0.9 * abs(rolled().force)
    soft = separatrix.Body(base=separatrix.solid(100e9, 0.285))
    unlike = replace(PROBLEM, bodies=(soft, STEEL), own_pressure=True, coupled=True)
    one_way = ContactSetup(problem=unlike, columns=12, rows=12)
    ways = (case(setup=replace(one_way, is_two_way=way), longitudinal_creep=2e-4) for way in (False, True))
    one, two = (found.solution.max_pressure for found in solved(*ways))
    assert one != two
    assert two == pytest.approx(one, rel=0.02)  # of the order of beta mu


def test_surfaces_that_are_steep_at_the_edge_are_noted():
    """Half-spaces describe the bodies to about 0.3."""
    steep = separatrix.contact_ellipse(1e4, 1e3, 1e3, 110e9)
    (note,) = ContactSetup(problem=replace(PROBLEM, ellipse=steep)).notes
    assert "of the radius of the gap there; half-spaces describe" in note


def test_a_film_that_is_compressed_is_noted():
    """In the answer, once for all its cases."""
    film = separatrix.Layer(thickness=1e-6, solid=separatrix.solid(4e9, 0.38))
    coated = separatrix.Body(base=STEEL.base, layers=(film,))
    question = separatrix.rolling_cases(
        replace(PROBLEM, bodies=(STEEL, coated)), longitudinal=[1e-4, 2e-4], columns=12, rows=12
    )
    (note,) = separatrix.exact_contact(question).notes
    assert note.startswith("the film is compressed by")


def case(**changed):
    """A case of steady rolling with changes."""
    return ContactCase(**{"setup": SETUP} | changed)


def on(columns=40, rows=40, **changed):
    """A contact on these cells with changes of the problem."""
    return ContactSetup(problem=replace(PROBLEM, **changed), columns=columns, rows=rows)


def gap(**changed):
    """A parabolic gap on 6 x 5 cells with changes."""
    x, y = 1e-4 * np.arange(-2.5, 3.0), 1e-4 * np.arange(-2.0, 3.0)
    given = {"along": x, "across": y, "row_width": 1e-4, "column_width": 1e-4}
    return separatrix.Gap(**given | {"height": 50.0 * (x**2 + y[:, None] ** 2)} | changed)


TWO_WAY = ContactSetup(problem=PROBLEM, is_two_way=True)
LAYERED = replace(STEEL, layers=(separatrix.Layer(thickness=1e-7, solid=STEEL.base),) * 5)
SHIFT, TRANSIENT = ({"motion": one} for one in (ContactMotion.SHIFT, ContactMotion.TRANSIENT))
WRONG_CASES = [  # fields of a case, and what is said of ContactCase
    ({"longitudinal_creep": 1e9}, "longitudinal_creep must be finite and at most 1e+03"),
    ({"lateral_creep": math.nan}, "lateral_creep must be finite and at most 1e+03 [-]"),
    ({"spin": 1e9}, "spin must be finite and at most 2.22e+06 [1/m]; got 1e+09."),
    ({"curvature": math.inf}, "curvature must be finite and at most 4.94e+09 [1/m2]"),
    (SHIFT | {"lateral_shift": 1e4}, "lateral_shift must be finite and at most 1e+03 [m]; got 1e+04."),
    ({"turn": 0.1}, "turn must be 0: the motion is rolling; got 0.1."),
    (TRANSIENT, "distance must be > 0 in a transient [m]; got 0."),
    (TRANSIENT | {"distance": 1.0}, "distance must be finite and at most 0.00586 [m]; got 1."),
    ({"wanted": (0.8, 0.7)}, "wanted must be below the force of sliding, 1 [-]"),
    ({"wanted": (None, 0.7)}, "wanted must be below the force of sliding, 1 [-], and"),
    (SHIFT | {"setup": TWO_WAY}, "setup.is_two_way is for steady rolling, with cells over the ellipse."),
]
WRONG_CONTACTS = [  # fields of a problem, and what is said of ContactProblem
    ({"ellipse": separatrix.ellipse_of_axes(300.0, 0.15e-6, 0.45e-3, MODULUS)},
     "ellipse.max_pressure must be below the modulus of the pair, 1.09e+11 Pa; got"),
    ({"ellipse": replace(PROBLEM.ellipse, load=1e13)}, "ellipse.load must be at most 1e+12 in SI units;"),
    ({"friction": separatrix.FrictionLaw(coefficient=300.0)}, "friction.coefficient must be at most 100"),
    ({"bodies": (STEEL, LAYERED)}, "bodies: number of layers must be at most 4"),
    ({"roughness": 0.1}, "roughness must be at most 0.001"),
]  # fmt: skip
REFUSED = [
    *((lambda given=given: case(**given), f"ContactCase.{says}") for given, says in WRONG_CASES),
    *((lambda given=given: on(**given), f"ContactProblem.{says}") for given, says in WRONG_CONTACTS),
    (lambda: solved(case(setup=TWO_WAY)), "case 1: solve_two_way: problem must have own_pressure and"),
    (lambda: solved(), "ContactQuestion.cases needs at least one case."),
    (lambda: solved(case(continues=True)), "ContactQuestion.cases begins with a case that continues"),
    (lambda: solved(*[case(setup=on(256, 256))] * 500),
     "ContactQuestion.cases, here 500, must have at most 5000000 cells together; got 32768000."),
    (lambda: solved(case(), case(**TRANSIENT, setup=on(), distance=1e-4, continues=True)),
     "case 2: continues must not start from a case on other cells."),
    (lambda: solved(case(setup=on(2))),
     "case 1: rolling_contact: columns must be a whole number and lie from 4 to 256; got 2."),
    (lambda: gap(height=np.zeros((6, 5))), "Gap.height must have the shape (across, along), here (5, 6),"),
    (lambda: gap(row_width=0.0), "Gap: row_width, column_width must be > 0 [m]; got 0, 0.0001."),
    (lambda: separatrix.rolling_cases(PROBLEM, longitudinal=[1.0, 2.0], lateral=[1.0, 2.0, 3.0]),
     "rolling_cases needs creeps that can be broadcast to each other; got (2,), (3,), (1,), (1,)."),
    (lambda: separatrix.rolling_cases(PROBLEM, spin=np.nan),
     "ContactCase.spin must be finite and at most 2.22e+06 [1/m]; got nan."),
]  # fmt: skip


@pytest.mark.parametrize(("wrong", "says"), REFUSED, ids=map(str, range(len(REFUSED))))
def test_refused(wrong, says):
    """One line with place, rule and value."""
    with pytest.raises(InputError) as raised:
        wrong()
    message = str(raised.value)
    assert message.startswith(says)
    assert "\n" not in message
