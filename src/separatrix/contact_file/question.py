r"""Cases of rolling contact, their solutions in order, and the creeps at which forces are as wanted.

Signs are those of `separatrix.chain.traction.exact`: forces act on body 1, spin s adds s y to the
longitudinal creep (Kalker's spin is phi = -s), and body 1 that is faster is pulled back: force < 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, root

from separatrix.chain.creep import Creep
from separatrix.chain.traction.exact.contact import (
    ContactProblem,
    ContactSolution,
    RollingContact,
    gap_contact,
    rigid_slip,
    rolling_contact,
    secant,
    solve,
)
from separatrix.chain.traction.exact.slope import RaceSlope, traction_slope
from separatrix.chain.traction.exact.transient import shift, transient
from separatrix.errors import ConvergenceError, InputError
from separatrix.units import Array, Metre, PerMetre, PerMetre2, Radian, Ratio

BALANCED = 1e-6  # of a wanted force, over the force of sliding
DOUBLINGS = 60
FAILED_BEFORE = "the case before it, from which it starts, has no solution"


class Motion(Enum):
    """What the bodies do: roll steadily, shift without rolling, or roll from a start."""

    ROLLING = "rolling"
    SHIFT = "shift"
    TRANSIENT = "transient"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Gap:
    """Undeformed gap on given cells: centres and widths [m], cell means of shape (row, column) [m]."""

    along: Annotated[Array, "m", ("column",)]
    across: Annotated[Array, "m", ("row",)]
    row_width: Metre
    column_width: Metre
    height: Annotated[Array, "m", ("row", "column")]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactSetup:
    """What touches what on which grid: cells over the Hertz ellipse, or those of a gap."""

    problem: ContactProblem
    columns: int = 40
    rows: int = 40
    gap: Gap | None = None

    def contact(self) -> RollingContact:
        """Pressure and operator; raises as `rolling_contact` and `gap_contact`."""
        gap = self.gap
        if gap is None:
            return rolling_contact(self.problem, columns=self.columns, rows=self.rows)
        widths = gap.row_width, gap.column_width
        return gap_contact(self.problem, gap.height, along=gap.along, across=gap.across, spacing=widths)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactCase:
    """One motion of one contact.

    The creeps are of rolling, the shifts of a shift; `distance` is rolled in a transient, to the next whole
    column. `continues`: it starts from the tractions of the case before, not from none. `wanted` are forces
    along and across over that of sliding; where one is given, its creep or shift is found. `turned`: the
    bodies roll towards -x, and the gap of the setup has x reversed.
    """

    number: int
    setup: ContactSetup
    motion: Motion
    longitudinal_creep: Ratio = 0.0
    lateral_creep: Ratio = 0.0
    spin: PerMetre = 0.0
    curvature: PerMetre2 = 0.0
    longitudinal_shift: Metre = 0.0
    lateral_shift: Metre = 0.0
    turn: Radian = 0.0
    distance: Metre = 0.0
    continues: bool = False
    wanted: tuple[Ratio | None, Ratio | None] = (None, None)
    turned: bool = False

    def moved(self, longitudinal: float, lateral: float) -> ContactCase:
        """The case with other creeps, or other shifts."""
        if self.motion is Motion.SHIFT:
            return replace(self, longitudinal_shift=longitudinal, lateral_shift=lateral)
        return replace(self, longitudinal_creep=longitudinal, lateral_creep=lateral)

    def reversed(self) -> ContactCase:
        """The same case with x the other way."""
        along, across = self.wanted
        return replace(
            self,
            longitudinal_creep=0.0 - self.longitudinal_creep,
            spin=0.0 - self.spin,
            curvature=0.0 - self.curvature,
            wanted=(None if along is None else 0.0 - along, across),
        )


def rolling_cases(
    problem: ContactProblem,
    *,
    longitudinal: ArrayLike = 0.0,
    lateral: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    curvature: ArrayLike = 0.0,
    columns: int = 40,
    rows: int = 40,
    slope: bool = False,
    title: str = "contact",
) -> ContactQuestion:
    """Steady rolling of one contact under a batch of creeps, which are broadcast to each other.

    Parameters
    ----------
    problem : ContactProblem
        Ellipse, bodies with their layers, friction; its ellipse from `contact_ellipse`, or from
        `ellipse_of_axes` where the half lengths are known.
    longitudinal, lateral : array_like
        Creep ratios [-].
    spin, curvature : array_like
        Coefficients of y and y^2 in the longitudinal creep [1/m, 1/m2]; Kalker's spin is -spin.
    columns, rows : int
        Cells along rolling and across.
    slope : bool
        Also the slope of the traction curve at free rolling, under the spin and curvature of the first case.
    title : str
        Heading of the text and the figures.

    Raises
    ------
    InputError
        Creeps that cannot be broadcast, that are not finite, or a ratio above 1e3.
    """
    given = {"longitudinal": longitudinal, "lateral": lateral, "spin": spin, "curvature": curvature}
    arrays = {name: np.atleast_1d(np.asarray(value, dtype=float)) for name, value in given.items()}
    for name, values in arrays.items():
        if not np.isfinite(values).all():
            raise InputError(f"rolling_cases: {name}", "must be finite", "nan or inf")
    try:
        together = np.broadcast_arrays(*arrays.values())
    except ValueError:
        shapes = ", ".join(str(values.shape) for values in arrays.values())
        raise InputError(
            "rolling_cases", "needs creeps that can be broadcast to each other", shapes
        ) from None
    setup = ContactSetup(problem=problem, columns=columns, rows=rows)
    cases = tuple(
        ContactCase(
            number=number,
            setup=setup,
            motion=Motion.ROLLING,
            longitudinal_creep=xi,
            lateral_creep=eta,
            spin=s,
            curvature=q,
        )
        for number, (xi, eta, s, q) in enumerate(
            zip(*(one.ravel().tolist() for one in together), strict=True), 1
        )
    )
    return ContactQuestion(name=title, title=title, cases=cases, slope=slope)


def _mirrored(vectors: Array) -> Array:
    """A field of vectors, shape (2, row, column), with x the other way."""
    return np.array([-1.0, 1.0])[:, None, None] * vectors[:, :, ::-1]


def _reversed(found: ContactSolution) -> ContactSolution:
    """The same solution with x the other way."""
    return replace(
        found,
        along=-found.along[::-1],
        fraction=found.fraction[:, ::-1],
        pressure=found.pressure[:, ::-1],
        traction=_mirrored(found.traction),
        slip=_mirrored(found.slip),
        stick=found.stick[:, ::-1],
        force=0.0 - found.force,
        spin_moment=0.0 - found.spin_moment,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactQuestion:
    """Cases in the order of their file.

    `slope` asks for the slope of the traction curve at free rolling, under the spin of the first case;
    `of_contact`: the answer is printed in the units and signs of CONTACT's users.
    """

    name: str
    title: str
    cases: tuple[ContactCase, ...]
    slope: bool = False
    of_contact: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SolvedCase:
    """A case with its solution, or why it has none; a creep or shift that was found is in the case."""

    case: ContactCase
    solution: ContactSolution | None
    reason: str = ""
    residual: Ratio | None = None

    @property
    def sliding_share(self) -> tuple[Ratio, Ratio] | None:
        """Forces along and across over the friction coefficient times the load, if it is one number > 0."""
        mu = self.case.setup.problem.friction.coefficient
        if self.solution is None or not isinstance(mu, float) or mu == 0.0:
            return None
        sliding = mu * self.solution.load
        return self.solution.force / sliding, self.solution.lateral_force / sliding

    @property
    def cells(self) -> tuple[int, int] | None:
        """Cells that stick and cells that slip; those that the outline cuts count as whole."""
        if self.solution is None:
            return None
        stick = int(self.solution.stick.sum())
        return stick, int((self.solution.pressure > 0.0).sum()) - stick


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactAnswer:
    """The solved cases of a contact file; the slope if it was wanted, or why there is none."""

    question: ContactQuestion
    cases: tuple[SolvedCase, ...]
    slope: RaceSlope | None = None
    slope_reason: str = ""


Progress = Callable[[int, int], None]


def solve_cases(question: ContactQuestion, progress: Progress | None = None) -> ContactAnswer:
    """Solve every case; one that does not converge is a row with its reason.

    Raises
    ------
    InputError
        A contact that cannot be set up; see `rolling_contact`.
    """
    state = _State(question.name)
    solved = []
    for case in question.cases:
        solved.append(state.solved(case))
        if progress is not None:
            progress(len(solved), len(question.cases))
    slope, reason = _slope(question.cases[0]) if question.slope else (None, "")
    return ContactAnswer(question=question, cases=tuple(solved), slope=slope, slope_reason=reason)


def _slope(case: ContactCase) -> tuple[RaceSlope | None, str]:
    try:
        return traction_slope(case.setup.problem, Creep(spin=case.spin, curvature=case.curvature)), ""
    except ConvergenceError as error:
        return None, str(error)


class _State:
    """What a case takes over from those before: the contact, its tractions, and two solutions near it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.setup: ContactSetup | None = None
        self.contact: RollingContact | None = None
        self.traction: Array | None = None
        self.known: list[tuple[Array, Array]] = []
        self.failed = False

    def solved(self, case: ContactCase) -> SolvedCase:
        if case.continues and self.failed:
            return SolvedCase(case=case, solution=None, reason=FAILED_BEFORE)
        start = self.traction if case.continues else None
        if start is not None and case.turned:
            start = _mirrored(start)
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

        if case.wanted != (None, None):
            case = _with_forces(contact, case, at)
        return case, at(case)

    def _moved(self, contact: RollingContact, case: ContactCase, start: Array | None) -> ContactSolution:
        grid = contact.grid
        if case.motion is Motion.SHIFT:
            way = rigid_slip(
                grid, longitudinal=case.longitudinal_shift, lateral=case.lateral_shift, spin=case.turn
            )
            return shift(contact, way, start=start)
        slip = rigid_slip(
            grid,
            longitudinal=case.longitudinal_creep,
            lateral=case.lateral_creep,
            spin=case.spin,
            curvature=case.curvature,
        )
        if case.motion is Motion.TRANSIENT:
            steps = max(round(case.distance / grid.dx), 1)
            return transient(contact, [slip] * steps, start=start)[-1]
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

        low, high = _bracket(excess, scale)
        return case.moved(float(brentq(excess, low, high, xtol=BALANCED * scale)), given)

    def miss(x: Array) -> Array:
        one = at(case.moved(scale * x[0], scale * x[1]))
        return np.array([one.force, one.lateral_force]) / sliding - [along or 0.0, across]

    start = -0.5 * np.array([along or 0.0, across])
    found = root(miss, start, method="hybr", options={"factor": 1.0, "xtol": BALANCED, "eps": 1e-4})
    left = float(np.abs(found.fun).max())
    if left > 1e-4:
        raise ConvergenceError(
            f"The wanted forces were not found (off by {left:.2g}).", int(found.nfev), left
        )
    return case.moved(*(scale * found.x).tolist())


def _bracket(excess: Callable[[float], float], scale: float) -> tuple[float, float]:
    """Creeps on either side of the wanted force; the force falls as the creep rises."""
    for sign in (1.0, -1.0):
        if sign * excess(0.0) <= 0.0:
            continue
        inner, step = 0.0, scale
        for _ in range(DOUBLINGS):
            outer = inner + sign * step
            if sign * excess(outer) <= 0.0:
                return min(inner, outer), max(inner, outer)
            inner, step = outer, 2.0 * step
        raise ConvergenceError("No creep gives the wanted force.", DOUBLINGS, abs(excess(inner)))
    return -BALANCED * scale, BALANCED * scale
