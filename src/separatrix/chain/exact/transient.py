r"""Shifts and transient rolling: tractions that depend on those before (Kalker 1990).

While the bodies roll by ds the ball's surface slides over the race's by

    S = W ds + U_t(x) - U_(t-1)(x + ds),

particles being at x + ds before. ds is the width of a cell; in a shift it is 0 and W ds the displacement.
Films take the rules of steady rolling at the row ends, as their particles entered less than ds ago.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from separatrix.chain.exact.influence import influence, pair_images
from separatrix.chain.exact.operator import (
    Operator,
    displacement,
    product,
    rolling_film,
    shift_operator,
    spectrum,
)
from separatrix.chain.exact.rolling import ContactSolution, RollingContact, check_fields, solution_of
from separatrix.chain.exact.slip import TOLERANCE, settle
from separatrix.ground.units import Array, Ratio


def shift(
    contact: RollingContact, way: Array, *, start: Array | None = None, tolerance: Ratio = TOLERANCE
) -> ContactSolution:
    """Contact after a displacement without rolling, shape (2, row, column) [m], from `start` or none.

    The slip of the solution is a distance [m], its dissipation an energy [J].

    Raises
    ------
    InputError
        A displacement or start that is not finite or has another shape.
    ConvergenceError
        The tractions did not settle.
    """
    check_fields(contact, way, start, tolerance)
    op = shift_operator(contact.grid, contact.problem.bodies, contact.compliance)
    driving = way if start is None else way - product(op, start)
    found = settle(op, contact.bound, driving, start=start, tolerance=tolerance)
    return solution_of(contact, found, distance=1.0)


def transient(
    contact: RollingContact,
    slips: Iterable[Array],
    *,
    start: Array | None = None,
    tolerance: Ratio = TOLERANCE,
) -> list[ContactSolution]:
    """Contact after each step of rolling by one column, under the rigid slip W of the step [-].

    `start` are the tractions before the first step, or none. The error is of first order in the columns.

    Raises
    ------
    InputError
        A slip or start that is not finite or has another shape.
    ConvergenceError
        The tractions of a step did not settle.
    """
    grid = contact.grid
    op, passed = _step_operator(contact)
    earlier = influence(grid.shape, (grid.dy, grid.dx), pair_images(*contact.problem.bodies), ((2, 1.0),))
    waves = spectrum(earlier[:3], op.padded)
    p = np.zeros((2, *grid.shape)) if start is None else start
    solutions = []
    for slip in slips:
        check_fields(contact, slip, p, tolerance)
        U = displacement(waves, op.padded, p)
        U[:, :, :-1] += passed[:, :, :-1] * p[:, :, 1:]
        driving = (slip + contact.coupling) * grid.dx - U
        found = settle(op, contact.bound, driving, start=p, tolerance=tolerance)
        p = found.traction
        solutions.append(solution_of(contact, found))
    return solutions


def _step_operator(contact: RollingContact) -> tuple[Operator, Array]:
    """Operator of U_t, and what U_(t-1) takes from the next cell upstream beside the convolution [m/Pa]."""
    grid, bodies = contact.grid, contact.problem.bodies
    L = np.zeros(grid.shape) if contact.compliance is None else contact.compliance
    op = shift_operator(grid, bodies, L)
    plain = shift_operator(grid, bodies).local
    film, upstream = rolling_film(grid.fraction, L, 0.0)
    passed = np.zeros_like(plain)
    passed[:, :, :-1] = plain[:, :, 1:]
    added = plain + film - op.local
    return replace(op, local=plain + film, diagonal=op.diagonal + added), passed - upstream
