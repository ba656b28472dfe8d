r"""Cases of one rolling contact, and their solutions.

Signs are those of `separatrix.chain.traction.exact`: forces act on body 1, spin s adds s y to the
longitudinal creep (Kalker's spin is phi = -s), and a body 1 that is the faster has a force < 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from separatrix.chain.traction.exact.contact import (
    LARGEST_CREEP,
    LARGEST_SIDE,
    ContactProblem,
    ContactSolution,
    RollingContact,
    gap_contact,
    rolling_contact,
)
from separatrix.chain.traction.exact.grid import CELLS, Grid, cell_counts
from separatrix.chain.traction.exact.normal import film_strain
from separatrix.chain.traction.exact.slope import RaceSlope
from separatrix.errors import InputError
from separatrix.units import Array, Metre, PerMetre, PerMetre2, Radian, Ratio

LARGEST_STEPS = 5000  # columns rolled in a transient


class Motion(Enum):
    """Motion of the bodies: steady rolling, a shift without rolling, or rolling from a start."""

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
class ExtraSlip:
    """Rigid slip that is added to that of the creeps, at places of its own: [-], in a shift [m]."""

    along: Annotated[Array, "m", ("column",)]
    across: Annotated[Array, "m", ("row",)]
    slip: Annotated[Array, "-", ("direction", "row", "column")]

    def on(self, grid: Grid) -> Array:
        """Linear between its places and constant beyond them, shape (2, row, column)."""
        x = np.clip(grid.x, self.along[0], self.along[-1])
        y = np.clip(grid.y, self.across[0], self.across[-1])
        across = np.array([[np.interp(y, self.across, column) for column in part.T] for part in self.slip])
        return np.array([[np.interp(x, self.along, row) for row in part.T] for part in across])

    def reversed(self) -> ExtraSlip:
        """The same with x the other way."""
        return ExtraSlip(along=-self.along[::-1], across=self.across, slip=mirrored(self.slip))


def mirrored(vectors: Array) -> Array:
    """A field of vectors, shape (2, row, column), with x the other way."""
    return np.array([-1.0, 1.0])[:, None, None] * vectors[:, :, ::-1]


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

    @property
    def cell_count(self) -> int:
        """Cells of the grid."""
        return self.columns * self.rows if self.gap is None else self.gap.height.size

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

    The creeps are of rolling, the shifts of a shift; `distance` is rolled in a transient, in whole columns,
    at least one. `continues`: it starts from the tractions of the case before, not from none. `wanted` are
    forces along and across over that of sliding; where one is given, its creep or shift is found. `turned`:
    the bodies roll towards -x, and the gap of the setup has x reversed.
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
    extra: ExtraSlip | None = None

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
            extra=None if self.extra is None else self.extra.reversed(),
            wanted=(None if along is None else 0.0 - along, across),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactQuestion:
    """Cases in the order of their file.

    `slope`: also the slope of the traction curve at free rolling, under the spin of the first case;
    `of_contact`: the answer is printed in the units and signs of CONTACT's users.
    """

    name: str
    title: str
    cases: tuple[ContactCase, ...]
    slope: bool = False
    of_contact: bool = False


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
    """The solved cases of a contact file; the slope if the question has it, or the reason for none."""

    question: ContactQuestion
    cases: tuple[SolvedCase, ...]
    slope: RaceSlope | None = None
    slope_reason: str = ""


def refuse_extremes(problem: ContactProblem, moves: Mapping[str, tuple[float, ...]]) -> None:
    """Refuse too large a spin, too long a rolling distance, and films that are crushed."""
    ellipse = problem.ellipse
    reach = max(ellipse.semi_minor, ellipse.semi_major)
    for key, power in (("spin", 1), ("curvature", 2)):
        largest = max((abs(one) for one in moves.get(key, ())), default=0.0) * reach**power
        if largest > LARGEST_CREEP:
            rule = f"must make a creep of at most {LARGEST_CREEP:g} at the edge of the contact [-]"
            raise InputError(f"[motion] {key}", rule, f"{largest:.3g}")
    longest = max(moves.get("distance", (0.0,)))
    if longest > LARGEST_STEPS * 2.0 * ellipse.semi_minor / LARGEST_SIDE:
        most = f"{LARGEST_STEPS * 2e3 * ellipse.semi_minor / LARGEST_SIDE:.3g} mm"
        cure = "Beyond a few lengths of the contact rolling is steady."
        raise InputError("[motion] distance", f"must not exceed {most}", f"{1e3 * longest:.3g} mm", cure)
    strain = film_strain(problem.bodies, ellipse.max_pressure)
    if strain > 1.0 and not problem.own_pressure:
        cure = "Set own = true in [pressure] for the lower pressure of the coated bodies, or use less load."
        raise InputError("[contact] load", "compresses a layer by more than itself", f"{strain:.2g}", cure)


def cases_of(
    setup: ContactSetup, kind: Motion, moves: Mapping[str, tuple[float, ...]]
) -> tuple[ContactCase, ...]:
    """Cases of one contact: longitudinal, lateral, spin, curvature, distance, each one value or several."""
    count = max(map(len, moves.values()))
    each = {key: value * count if len(value) == 1 else value for key, value in moves.items()}
    names = {"longitudinal": "longitudinal_creep", "lateral": "lateral_creep"}
    if kind is Motion.SHIFT:
        names = {"longitudinal": "longitudinal_shift", "lateral": "lateral_shift", "spin": "turn"}
    rolled = each.pop("distance", ())
    cases = []
    for i in range(count):
        given: dict[str, Any] = {names.get(key, key): value[i] for key, value in each.items()}
        if rolled:
            before = rolled[i - 1] if i > 0 else 0.0
            given |= {"distance": rolled[i] - before, "continues": i > 0}
        cases.append(ContactCase(number=i + 1, setup=setup, motion=kind, **given))
    return tuple(cases)


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
        Cells along rolling and across; left out, 40 each, and more columns than rows in contacts longer than
        wide.
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
        rule = "needs creeps that can be broadcast to each other"
        raise InputError("rolling_cases", rule, shapes) from None
    b, a = problem.ellipse.semi_minor, problem.ellipse.semi_major
    columns, rows = cell_counts(columns, rows, semi_minor=b, semi_major=a)
    setup = ContactSetup(problem=problem, columns=columns, rows=rows)
    moves = {name: tuple(one.ravel().tolist()) for name, one in zip(given, together, strict=True)}
    cases = cases_of(setup, Motion.ROLLING, moves)
    return ContactQuestion(name=title, title=title, cases=cases, slope=slope)
