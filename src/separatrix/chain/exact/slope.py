r"""Free rolling of a contact and the slope of its traction curve there.

With spin the discrete curve is a stair: a row changes from slip one way to slip the other as the line of zero
creep passes it, and a tangent depends on where the rows are. A chord over e = dy |d xi/dy| at that line moves
the pattern by one row, so that the sampling error cancels: [T(+e) - T(-e)]/(2 e), and with Heathcote's
curvature (4 chord(e) - chord(2 e))/3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from separatrix.chain.exact.operator import unresolved_film
from separatrix.chain.exact.rolling import (
    ContactProblem,
    ContactSolution,
    RollingContact,
    extent,
    rigid_slip,
    rolling_contact,
    secant,
    settled,
    solution_of,
)
from separatrix.chain.exact.slip import Settled, equations, solve_step
from separatrix.chain.film_compliance import Profile
from separatrix.chain.hertz import Creep
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Newton, Ratio

TOLERANCE = 1e-6  # of the tractions
LINEAR = 1e-4  # relative tolerance of a tangent
COLUMNS = (20, 28)
ROWS = 64
SHORTEST_CHORD = 2e-3  # of the creep that saturates a tangent; below it the tangent itself is taken
BALANCED = 1e-5  # force of free rolling over the force of sliding
LARGEST_STEPS = 40
SAMPLING = 1e-3  # relative error of a chord by the places of rows and columns (measured in the tests)
PRESSED = 5e-3  # relative error by the row ends of a solved pressure (measured in the tests)
UNRESOLVED = 5e-3  # largest relative error by films that the columns do not resolve (measured in the tests)
HARDEST = 0.15  # their thickness over the width of a column where it is largest


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceSlope:
    """Slope alpha = dC_T/d xi at free rolling and a bound of its numerical error [-].

    `free_rolling_offset` is the longitudinal creep on the centre line at which no net force acts; `solution`
    is the contact there.
    """

    slope: Ratio
    slope_error: Ratio
    free_rolling_offset: Ratio
    solution: ContactSolution


def traction_slope(
    problem: ContactProblem, creep: Creep, *, columns: tuple[int, int] = COLUMNS, rows: int = ROWS
) -> RaceSlope:
    """Slope of the traction curve at free rolling on two numbers of columns, of the finer one.

    The error falls with the first power of the columns. A tangent of bare bodies is extrapolated to none; a
    chord, in which stick and slip change cell by cell, is not. `slope_error` adds that step, what the
    extrapolation of the chord changed, and the errors of sampling, of thin films and of the row ends of a
    solved pressure.

    Raises
    ------
    InputError
        A creep that is not finite, columns that do not increase.
    ConvergenceError
        Free rolling or the tractions did not settle.
    """
    for name, value in (("spin", creep.spin), ("curvature", creep.curvature)):
        if not math.isfinite(value):
            raise InputError(f"traction_slope: creep.{name}", "must be finite", f"{value:g}")
    if not columns[0] < columns[1]:
        raise InputError("traction_slope: columns", "must be strictly increasing", f"{columns}")
    rows = _aligned(problem, rows)
    coarse, fine = (rolling_contact(problem, columns=n, rows=rows) for n in columns)
    curve = Curve(fine, creep)
    offset = curve.free_rolling()
    slope, chord_error, smooth = curve.slope(offset)
    rough, _, _ = Curve(coarse, creep).slope(offset)
    step = (slope - rough) * columns[0] / (columns[1] - columns[0])
    film, ends = _film_error(fine), PRESSED if problem.own_pressure else 0.0
    return RaceSlope(
        slope=slope + step if smooth and film == 0.0 else slope,
        slope_error=chord_error + abs(step) + (SAMPLING + film + ends) * slope,
        free_rolling_offset=offset,
        solution=solution_of(fine, curve.at(offset)),
    )


def _film_error(contact: RollingContact) -> Ratio:
    """Relative error of films that are neither much thinner than a cell nor resolved."""
    own, error = float(contact.operator.diagonal[0][contact.grid.fraction > 0.0].min()), 0.0
    for body in contact.problem.bodies:
        thickness = sum(layer.thickness for layer in body.layers)
        x = thickness / (HARDEST * contact.grid.dx)
        compliance, _ = unresolved_film(body, contact.grid.dx)
        error += UNRESOLVED * min(compliance / own, 1.0) * 2.0 * x / (1.0 + x * x)
    return error


def _aligned(problem: ContactProblem, rows: int) -> int:
    """Number of rows, at most a quarter more, whose edges are nearest to the steps of the profiles."""
    profiles = (problem.friction.coefficient, problem.film_compliance)
    across = {y for profile in profiles if isinstance(profile, Profile) for y in profile.across}
    places = np.array(sorted(across)) / problem.ellipse.semi_major
    inside = places[np.abs(places) < 1.0]
    if inside.size == 0:
        return rows
    edges = {n: 0.5 * n * (1.0 + inside) for n in range(rows, rows + rows // 4 + 1)}
    return min(edges, key=lambda n: float(np.abs(edges[n] - np.round(edges[n])).max()))


@dataclass(frozen=True, slots=True)
class Curve:
    """Traction curve of one contact; keeps the last two solutions, from which the next one starts."""

    contact: RollingContact
    creep: Creep
    known: list[tuple[Array, Array]] = field(default_factory=list, repr=False)

    @property
    def load(self) -> Newton:
        """Sum of the pressure."""
        return float(self.contact.pressure.sum()) * self.contact.grid.cell_area

    @property
    def sliding(self) -> Ratio:
        """Traction coefficient in full sliding."""
        return float(self.contact.bound.sum() / self.contact.pressure.sum())

    def at(self, offset: Ratio) -> Settled:
        """Solution at an offset of the longitudinal creep."""
        creep, grid = self.creep, self.contact.grid
        slip = rigid_slip(grid, longitudinal=offset, spin=creep.spin, curvature=creep.curvature)
        found = settled(self.contact, slip, start=secant(self.known, slip), tolerance=TOLERANCE)
        self.known[:] = [*self.known[-1:], (slip, found.traction)]
        return found

    def traction(self, found: Settled) -> Ratio:
        """Traction coefficient C_T of a solution [-]."""
        return -float(found.traction[0].sum()) * self.contact.grid.cell_area / self.load

    def tangent(self, found: Settled) -> Ratio:
        """Derivative of C_T to the longitudinal creep, with stick and slip cells held [-]."""
        sets, unit, none = found.sets, np.zeros_like(found.traction), np.zeros_like(found.traction)
        unit[0] = self.contact.grid.dx
        right = -equations(unit, none, sets.state, sets.normal, sets.turn)
        v = solve_step(self.contact.operator, sets, right, LINEAR)
        return -float(v[0].sum()) * self.contact.grid.cell_area / self.load

    def free_rolling(self) -> Ratio:
        """Offset without net traction: Newton's steps inside a bracket [-]."""
        if self.creep.curvature == 0.0 and not self.contact.coupling.any():
            return 0.0  # spin alone is odd in y
        low, high = -math.inf, math.inf
        offset = -0.2 * self.creep.curvature * extent(self.contact.grid)[1] ** 2
        for _ in range(LARGEST_STEPS):
            found = self.at(offset)
            C_T = self.traction(found)
            if abs(C_T) <= BALANCED * self.sliding:
                return offset
            low, high = (low, offset) if C_T > 0.0 else (offset, high)
            trial = offset - C_T / max(self.tangent(found), 1e-300)
            offset = trial if low < trial < high else 0.5 * (low + high)
        raise ConvergenceError(
            f"Free rolling was not found in {LARGEST_STEPS} steps (traction coefficient {C_T:.2g}).",
            LARGEST_STEPS,
            abs(C_T),
        )

    def slope(self, offset: Ratio) -> tuple[Ratio, Ratio, bool]:
        """Slope at an offset and what its extrapolation changed [-]; whether it is a tangent."""
        middle = self.at(offset)
        tangent = self.tangent(middle)
        e = self._row_pitch(offset)
        if e * tangent <= SHORTEST_CHORD * self.sliding:
            return tangent, 0.0, True
        chord = self._chord(offset, e)
        if self.creep.curvature == 0.0:
            return chord, 0.0, False
        better = (4.0 * chord - self._chord(offset, 2.0 * e)) / 3.0
        return better, abs(better - chord), False

    def _chord(self, offset: Ratio, e: Ratio) -> Ratio:
        ahead, behind = (self.traction(self.at(offset + side * e)) for side in (1.0, -1.0))
        return (ahead - behind) / (2.0 * e)

    def _row_pitch(self, offset: Ratio) -> Ratio:
        """Change of creep over one row at the lines of zero creep, their mean; 0 without such a line [-]."""
        s, q = self.creep.spin, self.creep.curvature
        half = extent(self.contact.grid)[1]
        roots = np.roots([q, s, offset]) if q != 0.0 else np.roots([s, offset])
        lines = [float(y.real) for y in np.atleast_1d(roots) if abs(y.imag) == 0.0 and abs(y.real) < half]
        slopes = [abs(s + 2.0 * q * y) for y in lines]
        return self.contact.grid.dy * sum(slopes) / len(slopes) if slopes else 0.0
