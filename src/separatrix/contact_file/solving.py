"""Solve the cases of one contact in their order; where forces are stated, find their creeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, root

from separatrix.chain.creep import Creep
from separatrix.chain.traction.exact.contact import (
    ContactSolution,
    RollingContact,
    rigid_slip,
    secant,
    solve,
)
from separatrix.chain.traction.exact.slope import traction_slope
from separatrix.chain.traction.exact.transient import shift, transient
from separatrix.chain.traction.exact.two_way import solve_two_way
from separatrix.contact_file.question import (
    ContactAnswer,
    ContactCase,
    ContactQuestion,
    ContactSetup,
    Motion,
    SolvedCase,
    mirrored,
)
from separatrix.errors import ConvergenceError, InputError
from separatrix.runner import Progress
from separatrix.units import Array

BALANCED = 1e-6  # of a wanted force, over the force of sliding
DOUBLINGS = 60
MOST_CELLS = 5_000_000  # of all cases: their fields take 60 bytes a cell
LARGEST_MISS = 1e-4  # of two wanted forces, over the force of sliding
FAILED_BEFORE = "the case before it, from which it starts, has no solution"


def solve_cases(question: ContactQuestion, progress: Progress | None = None) -> ContactAnswer:
    """Solve every case; one that does not converge is a row with its reason.

    Raises
    ------
    InputError
        A contact that cannot be set up, see `rolling_contact`, or more cells than the memory is made for.
    """
    cells = sum(case.setup.cell_count for case in question.cases)
    if cells > MOST_CELLS:
        rule, cure = f"must have at most {MOST_CELLS} cells together", "Split it, or use coarser grids."
        raise InputError(f"{question.name}: its {len(question.cases)} cases", rule, f"{cells}", cure)
    state = _State(question.name)
    solved = []
    for case in question.cases:
        solved.append(state.solved(case))
        if progress is not None:
            progress(len(solved), len(question.cases))
    answer = ContactAnswer(question=question, cases=tuple(solved))
    if question.slope:
        first = question.cases[0]
        try:
            slope = traction_slope(first.setup.problem, Creep(spin=first.spin, curvature=first.curvature))
            return replace(answer, slope=slope)
        except ConvergenceError as error:
            return replace(answer, slope_reason=str(error))
    return answer


class _State:
    """Data of the cases before, for the next one: the contact, its tractions, and two solutions near it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.setup: ContactSetup | None = None
        self.contact: RollingContact | None = None
        self.traction: Array | None = None
        self.known: list[tuple[Array, Array]] = []
        self.failed = False

    def solved(self, case: ContactCase) -> SolvedCase:
        """The case with its solution, or the reason why there is none."""
        if case.continues and self.failed:
            return SolvedCase(case=case, solution=None, reason=FAILED_BEFORE)
        start = self.traction if case.continues else None
        if start is not None and case.turned:
            start = mirrored(start)
        try:
            contact = self._contact(case.setup)
            if start is not None and start.shape[1:] != contact.grid.shape:
                where = f"{self.name}: case {case.number}"
                raise InputError(where, "cannot start from the tractions of a case on other cells")
            found, solution = self._attempt(contact, case.reversed() if case.turned else case, start)
        except ConvergenceError as error:
            self.traction, self.failed = None, True
            self.known.clear()
            return SolvedCase(case=case, solution=None, reason=str(error), residual=error.residual)
        if case.turned:
            found, solution = found.reversed(), _reversed(solution)
        self.traction, self.failed = solution.traction, False
        return SolvedCase(case=found, solution=solution, residual=solution.residual)

    def _contact(self, setup: ContactSetup) -> RollingContact:
        if self.contact is None or setup is not self.setup:
            self.known.clear()
            try:
                self.contact, self.setup = setup.contact(), setup
            except InputError as error:
                raise error.at(f"{self.name}: {error.path}") from None
        return self.contact

    def _attempt(
        self, contact: RollingContact, case: ContactCase, start: Array | None
    ) -> tuple[ContactCase, ContactSolution]:
        def at(one: ContactCase) -> ContactSolution:
            return self._moved(contact, one, start)

        if case.motion is Motion.TRANSIENT:  # in whole columns
            width = contact.grid.dx
            case = replace(case, distance=max(round(case.distance / width), 1) * width)
        if case.wanted != (None, None):
            case = _with_forces(contact, case, at)
        return case, at(case)

    def _moved(self, contact: RollingContact, case: ContactCase, start: Array | None) -> ContactSolution:
        grid, setup, shifts = contact.grid, case.setup, case.motion is Motion.SHIFT
        moves = {
            "longitudinal": case.longitudinal_shift if shifts else case.longitudinal_creep,
            "lateral": case.lateral_shift if shifts else case.lateral_creep,
            "spin": case.turn if shifts else case.spin,
            "curvature": 0.0 if shifts else case.curvature,
        }
        if setup.is_two_way and not shifts:
            return solve_two_way(setup.problem, columns=setup.columns, rows=setup.rows, **moves)[1]
        slip = rigid_slip(grid, **moves)
        slip = slip if case.extra is None else slip + case.extra.on(grid)
        if shifts:
            return shift(contact, slip, start=start)
        if case.motion is Motion.TRANSIENT:
            return transient(contact, [slip] * round(case.distance / grid.dx), start=start)[-1]
        solution = solve(contact, slip, start=secant(self.known, slip))
        self.known[:] = [*self.known[-1:], (slip, solution.traction)]
        return solution


def _with_forces(
    contact: RollingContact, case: ContactCase, at: Callable[[ContactCase], ContactSolution]
) -> ContactCase:
    """The case with the creeps or shifts at which its forces are as wanted."""
    bound = contact.bound.max()
    sliding = float(contact.bound.sum()) * contact.grid.cell_area
    saturation = 2.0 * float(bound) / contact.problem.ellipse.contact_modulus  # of a bare plane contact
    scale = saturation * (contact.problem.ellipse.semi_minor if case.motion is Motion.SHIFT else 1.0)
    along, across = case.wanted
    given = case.lateral_shift if case.motion is Motion.SHIFT else case.lateral_creep
    if across is None:

        def excess(x: float) -> float:
            return at(case.moved(x, given)).force / sliding - (along or 0.0)

        return case.moved(_zero_of(excess, scale), given)

    def miss(x: Array) -> Array:
        one = at(case.moved(scale * x[0], scale * x[1]))
        return np.array([one.force, one.lateral_force]) / sliding - [along or 0.0, across]

    start = -0.5 * np.array([along or 0.0, across])
    found = root(miss, start, method="hybr", options={"factor": 1.0, "xtol": BALANCED, "eps": 1e-4})
    left = float(np.abs(found.fun).max())
    if left > LARGEST_MISS:
        message = f"The wanted forces were not found (off by {left:.2g})."
        raise ConvergenceError(message, int(found.nfev), left)
    return case.moved(*(scale * found.x).tolist())


def _zero_of(excess: Callable[[float], float], scale: float) -> float:
    """Creep at which the force is as wanted; the force falls as the creep rises."""
    here = excess(0.0)
    if abs(here) <= BALANCED:
        return 0.0
    inner, step = 0.0, scale if here > 0.0 else -scale
    for _ in range(DOUBLINGS):
        outer = inner + step
        there = excess(outer)
        if abs(there) <= BALANCED:
            return outer
        if (there > 0.0) != (here > 0.0):
            return float(brentq(excess, inner, outer, xtol=BALANCED * scale))
        inner, step = outer, 2.0 * step
    raise ConvergenceError("No creep gives the wanted force.", DOUBLINGS, abs(there))


def _reversed(found: ContactSolution) -> ContactSolution:
    """The same solution with x the other way."""
    return replace(
        found,
        along=-found.along[::-1],
        fraction=found.fraction[:, ::-1],
        pressure=found.pressure[:, ::-1],
        traction=mirrored(found.traction),
        slip=mirrored(found.slip),
        stick=found.stick[:, ::-1],
        force=0.0 - found.force,
        spin_moment=0.0 - found.spin_moment,
    )
