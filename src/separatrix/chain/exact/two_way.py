r"""Rolling of unlike bodies with the effect of the tractions on the pressure (Panagiotopoulos 1975).

Tractions lift or lower the surfaces: the gap widens by

    w = F^-1[-i (dc_rz/k^2) (k_x tau_x + k_y tau_y)] = -(K_xz tau_x + K_yz tau_y),

dc_rz being c_rz of the ball less that of the race. In turn the pressure is solved under w, then the tractions
under that pressure and its slip. A pass changes the pressure by about beta mu of what the last one did, beta
being Dundurs' constant.
"""

from __future__ import annotations

import numpy as np
import scipy

from separatrix.chain.exact.grid import Grid, cell_counts, pressed_grid
from separatrix.chain.exact.influence import Images, influence, pair_images
from separatrix.chain.exact.operator import SHIFT, Complex, spectrum
from separatrix.chain.exact.pressure import REFINED, press_in_box, pressed_box, touches_edge
from separatrix.chain.exact.rolling import (
    ContactProblem,
    ContactSolution,
    RollingContact,
    contact_on,
    rigid_slip,
    solve,
)
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, PerMetre, PerMetre2, Ratio

LARGEST_PASSES = 8
SETTLED = 1e-4  # change of the pressure in a pass, over the load
ROOM = 1.1  # of the box, for the contact to move in


def solve_two_way(
    problem: ContactProblem,
    *,
    longitudinal: Ratio = 0.0,
    lateral: Ratio = 0.0,
    spin: PerMetre = 0.0,
    curvature: PerMetre2 = 0.0,
    columns: int | None = None,
    rows: int | None = None,
) -> tuple[RollingContact, ContactSolution]:
    """Contact and solution under creeps, pressure and tractions each under the other.

    The problem needs `own_pressure` and `coupled`.

    Raises
    ------
    InputError
        A problem without its own pressure or coupling, and what `rolling_contact` and `solve` refuse.
    ConvergenceError
        The pressure still changes by more than 1e-4 of the load after 8 passes, or leaves its box.
    """
    if not (problem.own_pressure and problem.coupled):
        got = f"own_pressure = {problem.own_pressure}, coupled = {problem.coupled}"
        raise InputError("solve_two_way: problem", "must have own_pressure and coupled", got)
    creeps = {"longitudinal": longitudinal, "lateral": lateral, "spin": spin, "curvature": curvature}
    images = pair_images(*problem.bodies)
    b, a = problem.ellipse.semi_minor, problem.ellipse.semi_major
    columns, rows = cell_counts(columns, rows, semi_minor=b, semi_major=a)
    x, y, pressing = pressed_box(problem.ellipse, images, columns=columns, rows=rows, room=ROOM)
    waves, change = None, np.inf
    for passes in range(1, LARGEST_PASSES + 1):
        contact = contact_on(problem, *pressed_grid(x, y, pressing.pressure, REFINED))
        found = solve(contact, rigid_slip(contact.grid, **creeps))
        if change <= SETTLED:
            return contact, found
        if waves is None:
            waves = _lift_waves(images, x, y)
        before = pressing.pressure
        pressing = press_in_box(
            problem.ellipse, images, x, y, _lift(waves, _on_fine_cells(contact.grid, found.traction, x, y))
        )
        change = float(np.abs(pressing.pressure - before).sum() / before.sum())
        if touches_edge(pressing.pressure):
            raise ConvergenceError(
                "Contact left its box while tractions and pressure settled.", passes, change
            )
    raise ConvergenceError(
        f"Pressure and tractions did not settle in {LARGEST_PASSES} passes (change {change:.2g}, limit "
        f"{SETTLED:g}).",
        LARGEST_PASSES,
        change,
    )


def _lift_waves(images: Images, x: Array, y: Array) -> Complex:
    """Transforms of K_xz and K_yz on the fine cells, shape (2, row, column)."""
    shape, spacing = (y.size, x.size), (float(y[1] - y[0]), float(x[1] - x[0]))
    padded = scipy.fft.next_fast_len(2 * y.size - 1), scipy.fft.next_fast_len(2 * x.size - 1, real=True)
    table = influence(shape, spacing, images, SHIFT)
    return spectrum(table[[4, 4, 5]], padded)[[0, 2]]  # the last of three is odd across


def _lift(waves: Complex, traction: Array) -> Array:
    """Widening of the gap by tractions on the fine cells, shape (row, column) [m]."""
    _, rows, columns = traction.shape
    padded = scipy.fft.next_fast_len(2 * rows - 1), scipy.fft.next_fast_len(2 * columns - 1, real=True)
    both = scipy.fft.rfft2(traction, s=padded, workers=1) * waves
    return -np.asarray(scipy.fft.irfft2(both.sum(axis=0), s=padded, workers=1)[:rows, :columns])


def _on_fine_cells(grid: Grid, traction: Array, x: Array, y: Array) -> Array:
    """Tractions of the cells of a grid on the fine cells of its box, shape (2, row, column) [Pa]."""
    whole = np.zeros((2, y.size // REFINED, x.size // REFINED))
    first = [
        int(np.argmin(np.abs(fine.reshape(-1, REFINED).mean(axis=1) - own[0])))
        for fine, own in ((y, grid.y), (x, grid.x))
    ]
    rows, columns = grid.shape
    whole[:, first[0] : first[0] + rows, first[1] : first[1] + columns] = traction
    return whole.repeat(REFINED, axis=1).repeat(REFINED, axis=2)
