r"""One contact without a bearing: its cases in their order, and the creeps of stated forces.

Signs are those of `separatrix.chain.exact.rolling`: forces act on body 1, spin s adds s y to the
longitudinal creep (Kalker's spin is phi = -s), and a body 1 that is the faster has a force < 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, root

from separatrix.chain.creep import Creep
from separatrix.chain.exact.grid import CELLS, cell_counts
from separatrix.chain.exact.rolling import (
    LARGEST_CREEP,
    LARGEST_SIDE,
    ContactProblem,
    ContactSolution,
    RollingContact,
    gap_contact,
    rigid_slip,
    rolling_contact,
    secant,
    solve,
)
from separatrix.chain.exact.slope import RaceSlope, traction_slope
from separatrix.chain.exact.transient import shift, transient
from separatrix.chain.exact.two_way import solve_two_way
from separatrix.chain.film_compliance import Profile
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, PerMetre, PerMetre2, Radian, Ratio, unit_of

MOST_CELLS = 5_000_000  # of all cases: their fields take 60 bytes a cell
LARGEST_STEPS = 5000  # columns rolled in a transient
LARGEST_SHIFT = 1e3  # [m], of a turn [rad]
LARGEST_STEEPNESS = 0.3  # of the surfaces at the edge of the contact, for which bodies are half-spaces
BALANCED = 1e-6  # of a wanted force, over the force of sliding
LARGEST_MISS = 1e-4  # of two wanted forces, over the force of sliding
DOUBLINGS = 60
FAILED_BEFORE = "the case before it, from which it starts, has no solution"


class ContactMotion(Enum):
    """Motion of the bodies: steady rolling, a shift without rolling, or rolling from a start."""

    ROLLING = "rolling"
    SHIFT = "shift"
    TRANSIENT = "transient"


CREEPS = ("longitudinal_creep", "lateral_creep", "spin", "curvature")
MOVES = {
    ContactMotion.ROLLING: CREEPS,
    ContactMotion.SHIFT: ("longitudinal_shift", "lateral_shift", "turn"),
    ContactMotion.TRANSIENT: (*CREEPS, "distance"),
}
"""What a case is given by its motion."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Gap:
    """Undeformed gap on given cells: centres and widths [m], cell means of shape (row, column) [m]."""

    along: Annotated[Array, "m", ("column",)]
    across: Annotated[Array, "m", ("row",)]
    row_width: Metre
    column_width: Metre
    height: Annotated[Array, "m", ("row", "column")]

    def __post_init__(self) -> None:
        shape = self.across.size, self.along.size
        if self.height.shape != shape or not max(shape) <= LARGEST_SIDE:
            rule = f"must have the shape (across, along), here {shape}, with at most {LARGEST_SIDE} a side"
            raise InputError("Gap.height", rule, f"{self.height.shape}")
        if not (self.row_width > 0.0 and self.column_width > 0.0):
            got = f"{self.row_width:g}, {self.column_width:g}"
            raise InputError("Gap: row_width, column_width", "must be > 0 [m]", got)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactSetup:
    """A contact and its grid: cells over the Hertz ellipse, or those of a gap.

    `is_two_way`: pressure and tractions are solved each under the other, in steady rolling.
    """

    problem: ContactProblem
    columns: int = CELLS
    rows: int = CELLS
    gap: Gap | None = None
    is_two_way: bool = False

    def __post_init__(self) -> None:
        _refuse_unreal(self.problem)
        ellipse = self.problem.ellipse
        if self.gap is not None:  # of the ellipse only load and modulus count
            return
        if not ellipse.max_pressure < ellipse.contact_modulus:
            rule = f"must be below the modulus of the pair, {ellipse.contact_modulus:.3g} Pa"
            raise InputError("ContactProblem.ellipse.max_pressure", rule, f"{ellipse.max_pressure:.3g} Pa")

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence where the bodies are too steep at the edge of the contact."""
        one = self.problem.ellipse
        steepest = max(one.semi_minor * one.curvature_rolling, one.semi_major * one.curvature_transverse)
        if self.gap is not None or not steepest > LARGEST_STEEPNESS:
            return ()
        said = f"a half axis of the contact is {steepest:.2g} of the radius of the gap there; "
        return (f"{said}half-spaces describe the bodies to about {LARGEST_STEEPNESS:g}.",)

    @property
    def cell_count(self) -> int:
        """Cells of the grid."""
        return self.columns * self.rows if self.gap is None else self.gap.height.size

    @property
    def half_lengths(self) -> tuple[Metre, Metre]:
        """Half lengths along rolling and across, of the ellipse or of all cells."""
        ellipse, gap = self.problem.ellipse, self.gap
        if gap is None:
            return ellipse.semi_minor, ellipse.semi_major
        return 0.5 * gap.along.size * gap.column_width, 0.5 * gap.across.size * gap.row_width

    def contact(self) -> RollingContact:
        """Pressure and operator; raises as `rolling_contact` and `gap_contact`."""
        gap = self.gap
        if gap is None:
            return rolling_contact(self.problem, columns=self.columns, rows=self.rows)
        widths = gap.row_width, gap.column_width
        return gap_contact(self.problem, gap.height, along=gap.along, across=gap.across, spacing=widths)


def _refuse_unreal(problem: ContactProblem) -> None:
    """Refuse sizes that no contact has: most are a wrong unit."""
    ellipse, mu = problem.ellipse, problem.friction.coefficient
    layers = [layer for body in problem.bodies for layer in body.layers]
    solids = [body.base for body in problem.bodies] + [layer.solid for layer in layers]
    for name, value, largest in (
        ("ellipse.load", ellipse.load, 1e12),
        ("ellipse: half lengths", max(ellipse.semi_minor, ellipse.semi_major), 1e3),
        ("bodies: number of layers", max(len(body.layers) for body in problem.bodies), 4),
        ("bodies: shear_modulus", max(one.shear_modulus for one in solids), 1e13),
        ("friction.coefficient", max(mu.values) if isinstance(mu, Profile) else mu, 100.0),
        ("friction.cohesion", problem.friction.cohesion, 1e13),
        ("roughness", problem.roughness, 1e-3),
    ):
        if value > largest:
            rule = f"must be at most {largest:g} in SI units"
            raise InputError(f"ContactProblem.{name}", rule, f"{value:g}")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactCase:
    """One motion of one contact.

    The creeps are of rolling, the shifts of a shift; `distance` is rolled in a transient, in whole columns,
    at least one. `continues`: it starts from the tractions of the case before, not from none. `wanted` are
    forces along and across over that of sliding; where one is given, its creep or shift is found.
    """

    setup: ContactSetup
    motion: ContactMotion = ContactMotion.ROLLING
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

    def __post_init__(self) -> None:
        reach = max(self.setup.half_lengths)
        largest = {
            "longitudinal_creep": LARGEST_CREEP,
            "lateral_creep": LARGEST_CREEP,
            "spin": LARGEST_CREEP / reach,
            "curvature": LARGEST_CREEP / reach**2,
            **dict.fromkeys(MOVES[ContactMotion.SHIFT], LARGEST_SHIFT),
            "distance": LARGEST_STEPS * 2.0 * self.setup.half_lengths[0] / LARGEST_SIDE,
        }
        for name, most in largest.items():
            value, where = getattr(self, name), f"ContactCase.{name}"
            if value != 0.0 and name not in MOVES[self.motion]:
                raise InputError(where, f"must be 0: the motion is {self.motion.value}", f"{value:g}")
            if not abs(value) <= most:
                rule = f"must be finite and at most {most:.3g} [{unit_of(ContactCase, name)}]"
                raise InputError(where, rule, f"{value:.3g}")
        if self.motion is ContactMotion.TRANSIENT and not self.distance > 0.0:
            raise InputError("ContactCase.distance", "must be > 0 in a transient [m]", f"{self.distance:g}")
        along, across = self.wanted
        if (along is None and across is not None) or not np.hypot(along or 0.0, across or 0.0) < 1.0:
            rule = "must be below the force of sliding, 1 [-], and have none across without one along"
            raise InputError("ContactCase.wanted", rule, f"{self.wanted}")
        if self.setup.is_two_way and (self.setup.gap or self.motion is not ContactMotion.ROLLING):
            rule = "is for steady rolling, with cells over the ellipse"
            raise InputError("ContactCase.setup.is_two_way", rule)

    def moved(self, longitudinal: float, lateral: float) -> ContactCase:
        """The case with other creeps, or other shifts."""
        if self.motion is ContactMotion.SHIFT:
            return replace(self, longitudinal_shift=longitudinal, lateral_shift=lateral)
        return replace(self, longitudinal_creep=longitudinal, lateral_creep=lateral)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactQuestion:
    """Cases in their order.

    `slope`: also the slope of the traction curve at free rolling, under the spin and curvature of the first
    case. Cases of one contact share their setup, the same object: then it is prepared once.
    """

    cases: tuple[ContactCase, ...]
    slope: bool = False

    def __post_init__(self) -> None:
        if not self.cases:
            raise InputError("ContactQuestion.cases", "needs at least one case")
        if self.cases[0].continues:
            raise InputError("ContactQuestion.cases", "begins with a case that continues another one")
        if (cells := sum(case.setup.cell_count for case in self.cases)) > MOST_CELLS:
            rule, cure = f"must have at most {MOST_CELLS} cells together", "Split them, or use coarser grids."
            raise InputError(f"ContactQuestion.cases, here {len(self.cases)},", rule, f"{cells}", cure)


@dataclass(frozen=True, slots=True, kw_only=True)
class SolvedCase:
    """A case with its solution, or the reason for none; a creep or shift that was found is in the case."""

    case: ContactCase
    solution: ContactSolution | None
    reason: str = ""
    residual: Ratio | None = None

    @property
    def sliding_share(self) -> tuple[Ratio, Ratio] | None:
        """Forces along and across over the friction coefficient times the load, if it is one number > 0."""
        mu = self.case.setup.problem.friction.coefficient
        if self.solution is None or isinstance(mu, Profile) or mu == 0.0:
            return None
        sliding = mu * self.solution.load
        return self.solution.force / sliding, self.solution.lateral_force / sliding


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactAnswer:
    """The cases in their order, solved; the slope if the question has it, or the reason for none."""

    cases: tuple[SolvedCase, ...]
    slope: RaceSlope | None = None
    slope_reason: str = ""

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the contacts leave the range of their model, a sentence each."""
        notes = [note for one in self.cases for note in one.case.setup.notes]
        notes += [note for one in self.cases if one.solution for note in one.solution.notes]
        return tuple(dict.fromkeys([*notes, *(self.slope.notes if self.slope else ())]))


def rolling_cases(
    problem: ContactProblem,
    *,
    longitudinal: ArrayLike = 0.0,
    lateral: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    curvature: ArrayLike = 0.0,
    columns: int | None = None,
    rows: int | None = None,
    slope: bool = False,
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
        Cells along rolling and across; left out, as of `rolling_contact`.
    slope : bool
        Also the slope of the traction curve at free rolling, under the spin and curvature of the first case.

    Raises
    ------
    InputError
        Creeps that cannot be broadcast, that are not finite, or a ratio above 1e3.
    """
    given = (longitudinal, lateral, spin, curvature)
    arrays = [np.atleast_1d(np.asarray(values, dtype=float)) for values in given]
    try:
        together = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(str(values.shape) for values in arrays)
        rule = "needs creeps that can be broadcast to each other"
        raise InputError("rolling_cases", rule, shapes) from None
    b, a = problem.ellipse.semi_minor, problem.ellipse.semi_major
    columns, rows = cell_counts(columns, rows, semi_minor=b, semi_major=a)
    setup = ContactSetup(problem=problem, columns=columns, rows=rows)
    each = zip(*(values.ravel().tolist() for values in together), strict=True)
    cases = tuple(ContactCase(setup=setup, **dict(zip(CREEPS, moves, strict=True))) for moves in each)
    return ContactQuestion(cases=cases, slope=slope)


def exact_contact(
    question: ContactQuestion, *, progress: Callable[[int, int], None] | None = None
) -> ContactAnswer:
    """Tractions, slip and forces of one contact without a bearing, case by case.

    Parameters
    ----------
    question : ContactQuestion
        Made by hand, or by `rolling_cases`.
    progress : callable, optional
        Called with (done, total) cases.

    Returns
    -------
    ContactAnswer
        A case that does not converge is among the cases with its reason.

    Raises
    ------
    InputError
        A contact that cannot be set up, see `rolling_contact`, or a start from other cells.
    """
    state, solved = _State(), list[SolvedCase]()
    for number, case in enumerate(question.cases, 1):
        try:
            solved.append(state.solved(case))
        except InputError as error:
            raise error.at(f"case {number}: {error.path}") from None
        if progress is not None:
            progress(number, len(question.cases))
    slope, reason, first = None, "", question.cases[0]
    if question.slope:
        try:
            slope = traction_slope(first.setup.problem, Creep(spin=first.spin, curvature=first.curvature))
        except ConvergenceError as error:
            reason = str(error)
    return ContactAnswer(cases=tuple(solved), slope=slope, slope_reason=reason)


class _State:
    """Data of the cases before, for the next one: the contact, its tractions, and two solutions near it."""

    def __init__(self) -> None:
        self.setup: ContactSetup | None = None
        self.contact: RollingContact | None = None
        self.traction: Array | None = None
        self.known: list[tuple[Array, Array]] = []

    def solved(self, case: ContactCase) -> SolvedCase:
        """The case with its solution, or the reason why there is none."""
        if case.continues and self.traction is None:
            return SolvedCase(case=case, solution=None, reason=FAILED_BEFORE)
        start = self.traction if case.continues else None
        try:
            if self.contact is None or case.setup is not self.setup:
                self.known.clear()
                self.contact, self.setup = case.setup.contact(), case.setup
            if start is not None and start.shape[1:] != self.contact.grid.shape:
                raise InputError("continues", "must not start from a case on other cells")
            at = partial(self._moved, self.contact, start)
            if case.motion is ContactMotion.TRANSIENT:  # in whole columns
                width = self.contact.grid.dx
                case = replace(case, distance=max(round(case.distance / width), 1) * width)
            if case.wanted != (None, None):
                case = _with_forces(self.contact, case, at)
            solution = at(case)
        except ConvergenceError as error:
            self.traction = None
            self.known.clear()
            return SolvedCase(case=case, solution=None, reason=str(error), residual=error.residual)
        self.traction = solution.traction
        return SolvedCase(case=case, solution=solution, residual=solution.residual)

    def _moved(self, contact: RollingContact, start: Array | None, case: ContactCase) -> ContactSolution:
        grid, setup, names = contact.grid, case.setup, ("longitudinal", "lateral", "spin", "curvature")
        moves = {
            name: float(getattr(case, key)) for name, key in zip(names, MOVES[case.motion], strict=False)
        }
        if setup.is_two_way:
            return solve_two_way(setup.problem, columns=setup.columns, rows=setup.rows, **moves)[1]
        slip = rigid_slip(grid, **moves)
        if case.motion is ContactMotion.SHIFT:
            return shift(contact, slip, start=start)
        if case.motion is ContactMotion.TRANSIENT:
            return transient(contact, [slip] * round(case.distance / grid.dx), start=start)[-1]
        solution = solve(contact, slip, start=secant(self.known, slip))
        self.known[:] = [*self.known[-1:], (slip, solution.traction)]
        return solution


def _with_forces(
    contact: RollingContact, case: ContactCase, at: Callable[[ContactCase], ContactSolution]
) -> ContactCase:
    """The case with the creeps or shifts at which its forces are as wanted."""
    sliding = float(contact.bound.sum()) * contact.grid.cell_area
    ellipse = contact.problem.ellipse
    saturation = 2.0 * float(contact.bound.max()) / ellipse.contact_modulus  # of a bare plane contact
    scale = saturation * (ellipse.semi_minor if case.motion is ContactMotion.SHIFT else 1.0)
    along, across = case.wanted
    given = case.lateral_shift if case.motion is ContactMotion.SHIFT else case.lateral_creep
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
