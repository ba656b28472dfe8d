r"""Steady rolling of two layered bodies with partial slip: from the problem to tractions, slip and forces.

Body 1 is the ball, body 2 the race; tractions and forces act on the ball. Along rolling lies x, with
particles entering at the largest x, across the groove y. Per rolling speed the ball slips over the race by

    s = W - dU/dx,   W = (xi + s y + q y^2, eta - s x),

xi being the longitudinal creep ratio, eta the lateral one, s the spin and q Heathcote's curvature, as in
`Creep` (Kalker's spin is phi = -s). Where it sticks s = 0 and |tau| <= g, where it slips tau = -g s/|s|
(Kalker 1990). The half-space has no bending: the contact is small beside the radii.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np
import scipy
from numpy.typing import NDArray

from separatrix.chain.exact.grid import Grid, cell_counts, elliptic_grid, elliptic_pressure, pressed_grid
from separatrix.chain.exact.influence import Body, pair_images
from separatrix.chain.exact.operator import Operator, rolling_operator
from separatrix.chain.exact.pressure import film_strain, press, pressed_contact, pressure_slip
from separatrix.chain.exact.slip import (
    SLIP,
    TOLERANCE,
    FrictionLaw,
    Settled,
    over_cells,
    rough_compliance,
    settle,
)
from separatrix.chain.film_compliance import Profile
from separatrix.chain.hertz import ContactEllipse, ellipse_of_axes
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, Newton, NewtonMetre, Pascal, PerMetre, PerMetre2, Ratio

LARGEST_TOLERANCE = 0.1
LARGEST_CREEP = 1e3  # a creep ratio of 2 is sliding without rolling
LARGEST_STRAIN = 1.0
LARGEST_STEEPNESS = 0.3  # of the surfaces at the edge of the contact, for which bodies are half-spaces
THICKEST = 100.0  # layers over the semi-major axis; the sum of the images loses digits from 1000 on
DOUBTFUL_STRAIN = 0.1
SMALLEST_SIDE, LARGEST_SIDE = 4, 256  # cells along one side of a grid; the memory goes with the cube
BALANCED = 1e-6  # of a stated force, over the force of sliding


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactProblem:
    """What rolls on what."""

    ellipse: ContactEllipse  # Hertz contact of the bodies without films
    bodies: tuple[Body, Body]  # ball and race
    friction: FrictionLaw  # largest traction against the pressure
    film_compliance: float | Profile = 0.0  # h/G of a film in series, beside the layers of the bodies [m/Pa]
    roughness: Metre = 0.0  # length l of a rough interface: its tangential stiffness is p/l, p local pressure
    own_pressure: bool = False  # whether the pressure of the layered bodies replaces Hertz's
    coupled: bool = False  # whether pressure causes slip between unlike bodies

    def __post_init__(self) -> None:
        gap = ("curvature_rolling", "curvature_transverse") if self.own_pressure else ()
        for name in ("load", "semi_minor", "semi_major", "max_pressure", *gap):
            value = getattr(self.ellipse, name)
            if np.ndim(value) > 0 or not 0.0 < value < np.inf:
                rule = "must be one number, finite and > 0"
                raise InputError(f"ContactProblem.ellipse.{name}", rule, f"{value}")
        if not self.ellipse.max_pressure < self.ellipse.contact_modulus:
            rule = f"must be below the modulus of the pair, {self.ellipse.contact_modulus:.3g} Pa"
            raise InputError(
                "ContactProblem.ellipse.max_pressure", rule, f"{self.ellipse.max_pressure:.3g} Pa"
            )
        if not 0.0 <= self.roughness < np.inf:
            raise InputError("ContactProblem.roughness", "must be finite and >= 0 [m]", f"{self.roughness:g}")
        L = self.film_compliance
        if not isinstance(L, Profile) and not 0.0 <= L < np.inf:
            raise InputError("ContactProblem.film_compliance", "must be finite and >= 0 [m/Pa]", f"{L:g}")


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingContact:
    """A problem on its grid: pressure and bound, shape (row, column) [Pa]; what `solve` takes."""

    problem: ContactProblem
    grid: Grid
    pressure: Array
    bound: Array
    coupling: Array  # slip that the pressure causes, shape (2, row, column) [-]
    max_pressure: Pascal
    film_strain: Ratio
    operator: Operator = field(repr=False)

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the contact leaves the range of its model, a sentence each."""
        one, notes = self.problem.ellipse, []
        if self.film_strain > DOUBTFUL_STRAIN:
            holds = f"linear elasticity holds to about {DOUBTFUL_STRAIN:g}."
            notes.append(f"the film is compressed by {self.film_strain:.2g} of its thickness; {holds}")
        steepest = max(one.semi_minor * one.curvature_rolling, one.semi_major * one.curvature_transverse)
        if steepest > LARGEST_STEEPNESS:
            notes.append(
                f"a half axis of the contact is {steepest:.2g} of the radius of the gap there; half-spaces "
                f"describe the bodies to about {LARGEST_STEEPNESS:g}."
            )
        return tuple(notes)


Field = Annotated[Array, "Pa", ("row", "column")]
Vectors = Annotated[Array, "Pa", ("direction", "row", "column")]


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactSolution:
    """Tractions and slip of one contact, and what they sum to; forces act on the ball.

    Pressure and tractions of cells that the outline cuts are averaged over the whole cell.
    """

    along: Annotated[Array, "m", ("column",)]  # middle of each column
    across: Annotated[Array, "m", ("row",)]  # middle of each row
    fraction: Annotated[Array, "-", ("row", "column")]  # share of each cell inside the contact
    pressure: Field  # mean of a cell
    traction: Vectors  # on the ball, along and across rolling, mean of a cell
    slip: Annotated[Array, "-", ("direction", "row", "column")]
    """Along and across rolling, over the rolling speed."""
    stick: NDArray[np.bool_]  # whether a cell sticks
    load: Newton  # sum of the pressure
    force: Newton
    lateral_force: Newton
    spin_moment: NewtonMetre
    stick_share: Ratio  # of the area of the contact
    dissipation: Newton  # power over rolling speed
    max_pressure: Pascal  # largest of a cell
    film_strain: Ratio
    iterations: int  # steps of the solver for the tractions
    residual: Ratio  # error that the solver left in the tractions
    notes: tuple[str, ...]  # where the contact leaves the range of its model, a sentence each

    @property
    def traction_coefficient(self) -> Ratio:
        """Force of the ball on the race along rolling over the load; positive where the ball is faster."""
        return -self.force / self.load


def rolling_contact(
    problem: ContactProblem, *, columns: int | None = None, rows: int | None = None
) -> RollingContact:
    """Put a problem on a grid of `columns` along rolling and `rows` across.

    Left out, they are 40 each, and more columns than rows in contacts longer than wide (`cell_counts`).

    Raises
    ------
    InputError
        A film that the pressure would compress by more than itself, layers thicker than 100 semi-major axes,
        or a grid that is too coarse or too fine.
    """
    ellipse, bodies = problem.ellipse, problem.bodies
    b, a, p0 = ellipse.semi_minor, ellipse.semi_major, ellipse.max_pressure
    columns, rows = cell_counts(columns, rows, semi_minor=b, semi_major=a)
    for name, count in (("columns", columns), ("rows", rows)):
        if not SMALLEST_SIDE <= count <= LARGEST_SIDE or count != int(count):
            rule = f"must be a whole number and lie from {SMALLEST_SIDE} to {LARGEST_SIDE}"
            raise InputError(f"rolling_contact: {name}", rule, f"{count}")
    _check_layers(problem)
    if problem.own_pressure:
        grid, pressure, _ = pressed_contact(ellipse, bodies, columns=columns, rows=rows)
    else:
        grid = elliptic_grid(semi_minor=b, semi_major=a, columns=columns, rows=rows)
        pressure = elliptic_pressure(grid, semi_minor=b, semi_major=a, max_pressure=p0)
    return _contact_on(problem, grid, pressure)


def gap_contact(
    problem: ContactProblem, gap: Array, *, along: Array, across: Array, spacing: tuple[Metre, Metre]
) -> RollingContact:
    """Put bodies of any undeformed gap, a cell mean, shape (row, column) [m], on the cells of that gap.

    `spacing` is the width of a row and of a column [m]; a single row is a contact in the plane, of the row's
    width. The pressure is solved; of the ellipse of the problem only the load and the pair modulus count.

    Raises
    ------
    InputError
        A gap that is not finite or whose cells end inside the contact, or as of `rolling_contact`.
    ConvergenceError
        The pressure did not settle.
    """
    _check_layers(problem)
    pressing = press(gap, spacing, pair_images(*problem.bodies), problem.ellipse.load)
    p = pressing.pressure
    if p[:, [0, -1]].any() or (across.size > 1 and p[[0, -1]].any()):
        cure = "Give more cells around it."
        raise InputError("gap_contact: gap", "must reach beyond the contact on all sides", cure=cure)
    grid, pressure = pressed_grid(along, across, p, row_width=spacing[0])
    b, a = extent(grid)
    found = ellipse_of_axes(problem.ellipse.load, b, a, problem.ellipse.contact_modulus)
    found = replace(found, max_pressure=float(pressure.max()), approach=pressing.approach)
    return _contact_on(replace(problem, ellipse=found, own_pressure=True), grid, pressure)


def _contact_on(problem: ContactProblem, grid: Grid, pressure: Array) -> RollingContact:
    """A problem on a known grid under a known pressure, shape (row, column) [Pa]."""
    bodies, film, rough = problem.bodies, problem.film_compliance, problem.roughness
    largest = float(pressure.max()) if problem.own_pressure else problem.ellipse.max_pressure
    strain = film_strain(bodies, largest)
    if strain > LARGEST_STRAIN:
        cure = "A linear elastic film cannot carry this pressure."
        raise InputError(
            "rolling_contact: film strain p0/M_c", "must not exceed 1 [-]", f"{strain:.2g}", cure
        )
    compliance = over_cells(film, grid) + rough_compliance(grid, pressure, rough)
    return RollingContact(
        problem=problem,
        grid=grid,
        pressure=pressure,
        bound=problem.friction.bound(grid, pressure),
        coupling=pressure_slip(grid, pressure, bodies) if problem.coupled else np.zeros((2, *grid.shape)),
        max_pressure=largest,
        film_strain=strain,
        operator=rolling_operator(grid, bodies, compliance),
    )


def _check_layers(problem: ContactProblem) -> None:
    thickest = max(sum(layer.thickness for layer in body.layers) for body in problem.bodies)
    largest = THICKEST * problem.ellipse.semi_major
    if thickest > largest:
        rule = f"must be at most {largest:g} m thick together, {THICKEST:g} semi-major axes of the contact"
        raise InputError("Body.layers", rule, f"{thickest:g} m", "Take the outermost one as the base.")


def rigid_slip(
    grid: Grid,
    *,
    longitudinal: Ratio = 0.0,
    lateral: Ratio = 0.0,
    spin: PerMetre = 0.0,
    curvature: PerMetre2 = 0.0,
) -> Array:
    """W = (xi + s y + q y^2, eta - s x) at the cell centres, shape (2, row, column) [-]."""
    x, y = grid.x, grid.y[:, None]
    along = longitudinal + spin * y + curvature * (y * y + grid.dy**2 / 12.0)  # mean over the row
    return np.stack([np.broadcast_to(along, grid.shape), np.broadcast_to(lateral - spin * x, grid.shape)])


def solve(
    contact: RollingContact, slip: Array, *, start: Array | None = None, tolerance: Ratio = TOLERANCE
) -> ContactSolution:
    """Tractions under one rigid slip field, shape (2, row, column) [-]; `start` are tractions near them [Pa].

    Raises
    ------
    InputError
        A slip that is not finite, of another shape or above 1e3.
    ConvergenceError
        The tractions did not settle; carries passes and residual.
    """
    return solution_of(contact, settled(contact, slip, start=start, tolerance=tolerance))


def settled(
    contact: RollingContact, slip: Array, *, start: Array | None = None, tolerance: Ratio = TOLERANCE
) -> Settled:
    """As `solve`: only the tractions and their stick and slip cells."""
    for name, field_ in (("slip", slip), ("start", start)):
        if field_ is not None and field_.shape != (2, *contact.grid.shape):
            rows, columns = contact.grid.shape
            raise InputError(
                f"solve: {name}", f"must have the shape (2, {rows}, {columns})", f"{field_.shape}"
            )
    largest = float(np.abs(slip).max())
    if not largest <= LARGEST_CREEP:
        raise InputError("solve: slip", f"must be finite and at most {LARGEST_CREEP:g} [-]", f"{largest:g}")
    if start is not None and not np.isfinite(start).all():
        raise InputError("solve: start", "must be finite [Pa]", f"{start[~np.isfinite(start)][0]:g}")
    if not 0.0 < tolerance <= LARGEST_TOLERANCE:
        raise InputError(
            "solve: tolerance", f"must be > 0 and at most {LARGEST_TOLERANCE:g} [-]", f"{tolerance:g}"
        )
    driving = (slip + contact.coupling) * contact.grid.dx
    return settle(contact.operator, contact.bound, driving, start=start, tolerance=tolerance)


def solve_each(
    contact: RollingContact, slips: Iterable[Array], *, tolerance: Ratio = TOLERANCE
) -> list[ContactSolution | ConvergenceError]:
    """Solutions along a curve of rigid slips; neighbours start each other by the secant of the last two.

    A case that does not settle is its error, with passes and residual.
    """
    solutions: list[ContactSolution | ConvergenceError] = []
    known: list[tuple[Array, Array]] = []
    for slip in slips:
        try:
            found = solve(contact, slip, start=secant(known, slip), tolerance=tolerance)
        except ConvergenceError as error:
            solutions.append(error)
            known.clear()
            continue
        known = [*known[-1:], (slip, found.traction)]
        solutions.append(found)
    return solutions


def secant(known: list[tuple[Array, Array]], slip: Array) -> Array | None:
    """Tractions expected at a slip from those at the last two, shape (2, row, column) [Pa]."""
    if len(known) < 2:
        return known[0][1] if known else None
    (W0, p0), (W1, p1) = known
    way = W1 - W0
    length = float((way * way).sum())
    ahead = float(((slip - W1) * way).sum()) / length if length > 0.0 else 0.0
    return np.asarray(p1 + min(max(ahead, 0.0), 3.0) * (p1 - p0))


def creep_of_force(
    contact: RollingContact,
    force: Ratio,
    *,
    lateral: Ratio = 0.0,
    spin: PerMetre = 0.0,
    curvature: PerMetre2 = 0.0,
) -> tuple[Ratio, ContactSolution]:
    """Longitudinal creep whose force along rolling is this share of that of sliding, and the solution there.

    The force falls as the creep rises. It is met to 1e-6 of the force of sliding.

    Raises
    ------
    InputError
        A share that is not below 1 in size.
    ConvergenceError
        No creep gives this force, or the tractions did not settle.
    """
    if not abs(force) < 1.0:
        raise InputError("creep_of_force: force", "must be below that of sliding, 1 [-]", f"{force:g}")
    sliding = float(contact.bound.sum()) * contact.grid.cell_area
    if sliding == 0.0:
        raise InputError("creep_of_force: contact", "must have friction")
    scale = 2.0 * float(contact.bound.max()) / contact.problem.ellipse.contact_modulus  # of a bare strip
    known: list[tuple[Array, Array]] = []

    def at(creep: Ratio) -> ContactSolution:
        creeps = {"longitudinal": creep, "lateral": lateral, "spin": spin, "curvature": curvature}
        slip = rigid_slip(contact.grid, **creeps)
        found = solve(contact, slip, start=secant(known, slip))
        known[:] = [*known[-1:], (slip, found.traction)]
        return found

    def excess(creep: Ratio) -> float:
        return at(creep).force / sliding - force

    here = excess(0.0)
    if abs(here) <= BALANCED:
        return 0.0, at(0.0)
    inner, outer = 0.0, math.copysign(scale, here)
    while abs(outer) <= LARGEST_CREEP:
        if excess(outer) * here <= 0.0:
            creep = float(scipy.optimize.brentq(excess, inner, outer, xtol=BALANCED * scale))
            return creep, at(creep)
        inner, outer = outer, 3.0 * outer
    raise ConvergenceError("No creep gives the stated force.", len(known), abs(here))


def solution_of(contact: RollingContact, found: Settled) -> ContactSolution:
    """Forces, moment, shares and dissipation of settled tractions."""
    grid, p, dA = contact.grid, found.traction, contact.grid.cell_area
    fraction = grid.fraction
    slips = (found.sets.state == SLIP) | ((contact.bound == 0.0) & (fraction > 0.0))
    slip = np.where(slips, found.slip_step / grid.dx, 0.0)
    return ContactSolution(
        along=grid.x,
        across=grid.y,
        fraction=fraction,
        pressure=contact.pressure,
        traction=p,
        slip=slip,
        stick=~slips & (fraction > 0.0),
        load=float(contact.pressure.sum() * dA),
        force=float(p[0].sum() * dA),
        lateral_force=float(p[1].sum() * dA),
        spin_moment=float((grid.x * p[1] - grid.y[:, None] * p[0]).sum() * dA),
        stick_share=float(fraction[~slips].sum() / fraction.sum()),
        dissipation=float(-(p * slip).sum() * dA) + 0.0,  # not -0
        max_pressure=contact.max_pressure,
        film_strain=contact.film_strain,
        iterations=found.passes,
        residual=found.residual,
        notes=contact.notes,
    )


def extent(grid: Grid) -> tuple[Metre, Metre]:
    """Half lengths of a grid's box along rolling and across [m]."""
    return 0.5 * grid.dx * grid.x.size, 0.5 * grid.dy * grid.y.size
