r"""Pressure between two layered bodies: constrained conjugate gradients of Polonsky & Keer (1999).

The gap u_z + h - approach is 0 under pressure and positive elsewhere, the pressures sum to the load. Products
with K_zz are zero-padded FFTs (Liu & Wang 2000). Normal and tangential tractions are taken as uncoupled.

Slip that the pressure causes between unlike bodies, or where one of them is coated.

Pressure stretches the two surfaces differently: U_x = F^-1[(k_x/k) i (dc_rz/k) p], dc_rz being c_rz of the
ball less that of the race. It adds to the rigid slip

    W_c = -dU/dx = F^-1[(k_x, k_y) k_x/k^2 dc_rz p].

The pressure is known and smooth, and is transformed on a grid of its own: with pressures uniform over the
cells of the contact W_c would have spikes at their edges. In the plane W_c is 2 beta p/E* (Bentall & Johnson
1967). The effect of tractions on the pressure is neglected.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from separatrix.chain.exact.grid import Grid, pressed_grid
from separatrix.chain.exact.influence import Body, Images, flexibility, influence, pair_images
from separatrix.chain.exact.operator import DISPLACEMENT, spectrum
from separatrix.chain.hertz import ContactEllipse
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, Newton, Ratio

TOLERANCE = 1e-8  # change of the pressures in one iteration over the load
LARGEST_ITERATIONS = 1000
REFINED = 3  # cells of the pressure along each side of a cell of the tractions
LARGEST_BOX = 100.0  # half lengths of the ellipse; a film that spreads the contact so far carries 1e-4 of p0
SEARCH_CELLS = 24  # cells along each side of the box in which the size of the contact is looked for


@dataclass(frozen=True, slots=True, kw_only=True)
class Pressing:
    """Pressure on whole cells, shape (row, column) [Pa], and the approach of the bodies [m]."""

    pressure: Array
    approach: Metre


def press(gap: Array, spacing: tuple[Metre, Metre], images: Images, load: Newton) -> Pressing:
    """Pressure under a load between bodies with this undeformed gap, a cell mean, shape (row, column) [m].

    `spacing` is the width of a row and of a column [m].

    Raises
    ------
    InputError
        A gap that is not finite.
    ConvergenceError
        The pressures still change by more than 1e-8 of the load after 1000 iterations.
    """
    if not np.isfinite(gap).all():
        raise InputError("press: gap", "must be finite [m]", "nan or inf")
    rows, columns = gap.shape
    padded = scipy.fft.next_fast_len(2 * rows - 1), scipy.fft.next_fast_len(2 * columns - 1, real=True)
    waves = spectrum(influence(gap.shape, spacing, images, DISPLACEMENT)[3:4], padded)[0]

    def displacement(p: Array) -> Array:
        product = scipy.fft.irfft2(scipy.fft.rfft2(p, s=padded, workers=1) * waves, s=padded, workers=1)
        return np.asarray(product[:rows, :columns])

    total = load / (spacing[0] * spacing[1])
    p = np.full(gap.shape, total / gap.size)
    direction, G_old, conjugate, change = np.zeros_like(gap), 1.0, 0.0, np.inf
    for _ in range(LARGEST_ITERATIONS):
        touching = p > 0.0
        g = displacement(p) + gap
        approach = float(g[touching].mean())
        g -= approach
        G = float((g[touching] ** 2).sum())
        if change <= TOLERANCE or G == 0.0:
            return Pressing(pressure=p, approach=approach)
        direction = np.where(touching, g + conjugate * (G / G_old) * direction, 0.0)
        r = displacement(direction)
        r -= r[touching].mean()
        tau = float((g * direction)[touching].sum() / (r * direction)[touching].sum())
        p_old, p = p, np.maximum(p - tau * direction, 0.0)
        overlap = (p == 0.0) & (g < 0.0)
        conjugate = 0.0 if overlap.any() else 1.0
        p[overlap] -= tau * g[overlap]
        p *= total / p.sum()
        change, G_old = float(np.abs(p - p_old).sum()) / total, G
    message = f"Pressure of a contact did not settle in {LARGEST_ITERATIONS} iterations"
    raise ConvergenceError(f"{message} (change {change:.2g}).", LARGEST_ITERATIONS, change)


def pressed_contact(
    ellipse: ContactEllipse, bodies: tuple[Body, Body], *, columns: int, rows: int
) -> tuple[Grid, Array, Metre]:
    """Grid, pressure, shape (row, column) [Pa], and approach [m] of layered bodies.

    `ellipse` has the load and the curvatures of the gap; `columns` and `rows` lie over a box some cells wider
    than the contact, whose size is found on a coarser grid first. The pressure is solved on finer cells.

    Raises
    ------
    InputError
        A contact that reaches beyond 100 half lengths of its ellipse.
    ConvergenceError
        The pressures did not settle.
    """
    x, y, pressing = pressed_box(ellipse, pair_images(*bodies), columns=columns, rows=rows)
    return *pressed_grid(x, y, pressing.pressure, REFINED), pressing.approach


def pressed_box(
    ellipse: ContactEllipse, images: Images, *, columns: int, rows: int
) -> tuple[Array, Array, Pressing]:
    """Centres of the fine cells along x and y, and the pressure on them."""
    half = 1.5 * np.array([ellipse.semi_minor, ellipse.semi_major])
    fine = REFINED * columns, REFINED * rows
    for count, wider in (((SEARCH_CELLS, SEARCH_CELLS), 1.5), (fine, 1.1)):
        x, y, found = _press_in_box(ellipse, images, half, count)
        while found.pressure[[0, -1]].any() or found.pressure[:, [0, -1]].any():  # touches the edge
            if half[1] > LARGEST_BOX * ellipse.semi_major:
                rule = f"must not reach beyond {LARGEST_BOX:g} half lengths of its ellipse"
                cure = "Check the curvatures of the ellipse and the thickness of the films."
                raise InputError("ContactProblem: contact under its own pressure", rule, "a wider one", cure)
            half *= wider
            x, y, found = _press_in_box(ellipse, images, half, count)
        pressed = found.pressure > 0.0
        cells = np.array([pressed.any(axis=0).sum(), pressed.any(axis=1).sum()])
        half *= (cells + 1.0) / SEARCH_CELLS  # of the finer box
    return x, y, found


def _press_in_box(
    ellipse: ContactEllipse, images: Images, half: Array, count: tuple[int, int]
) -> tuple[Array, Array, Pressing]:
    """Centres of the cells in a box of these half lengths, and the pressure on them."""
    dx, dy = (float(2.0 * h / n) for h, n in zip(half, count, strict=True))
    x, y = (d * np.arange(0.5 - 0.5 * n, 0.5 * n) for d, n in zip((dx, dy), count, strict=True))
    along = 0.5 * ellipse.curvature_rolling * (x * x + dx * dx / 12.0)  # cell means
    across = 0.5 * ellipse.curvature_transverse * (y * y + dy * dy / 12.0)
    return x, y, press(along + across[:, None], (dy, dx), images, ellipse.load)


def film_strain(bodies: tuple[Body, Body], max_pressure: float) -> Ratio:
    """Largest pressure over the compression modulus of the softest layer [-].

    Above about 0.1 a linear elastic film is not a description of it.
    """
    moduli = [layer.solid.compression_modulus for body in bodies for layer in body.layers]
    return max_pressure / min(moduli) if moduli else 0.0


BOX = 4.0  # sides of the periodic box over those of the contact
FINE = 500, 128  # points of it over the contact along rolling and across
LARGEST_COUNT = 4096  # of points along a side


def pressure_slip(grid: Grid, pressure: Array, bodies: tuple[Body, Body]) -> Array:
    """W_c at the cell centres, shape (2, row, column) [-]."""
    if grid.y.size == 1:
        return _in_the_plane(grid, pressure, bodies)
    contact = np.array([grid.dx * grid.x.size, grid.dy * grid.y.size])
    far = float(_difference(np.zeros(1), bodies)[0])
    # between unlike bases the field of a dipole reaches far: a square box, else one of the contact's shape
    sides = BOX * (np.full(2, contact.max()) if far != 0.0 else contact)
    nx, ny = (scipy.fft.next_fast_len(int(min(n, LARGEST_COUNT)), real=True) for n in sides / contact * FINE)
    dx, dy = sides / (nx, ny)
    x, y = dx * (np.arange(nx) - 0.5 * nx) + grid.x.mean(), dy * (np.arange(ny) - 0.5 * ny) + grid.y.mean()
    p = _smooth_pressure(grid, pressure, x, y)
    kx, ky = 2.0 * np.pi * scipy.fft.rfftfreq(nx, dx), 2.0 * np.pi * scipy.fft.fftfreq(ny, dy)[:, None]
    k2 = kx * kx + ky * ky
    k2[0, 0] = 1.0
    waves = scipy.fft.rfft2(p, workers=1) * _difference(np.sqrt(k2), bodies) * kx / k2
    along, across = waves * kx, waves * ky
    along[0, 0] = 0.5 * p.sum() * far  # the mean of a dipole's field over a square around it
    places = np.meshgrid((grid.y - y[0]) / dy, (grid.x - x[0]) / dx, indexing="ij")
    fields = [scipy.fft.irfft2(wave, s=(ny, nx), workers=1) for wave in (along, across)]
    return np.array([scipy.ndimage.map_coordinates(f, places, order=1) for f in fields])


def _in_the_plane(grid: Grid, pressure: Array, bodies: tuple[Body, Body]) -> Array:
    """W_c = F^-1[dc_rz p] of a contact in the plane, shape (2, 1, column) [-]."""
    width = BOX * grid.dx * grid.x.size
    count = scipy.fft.next_fast_len(int(BOX * FINE[0]), real=True)
    x = width / count * (np.arange(count) - 0.5 * count) + grid.x.mean()
    places = np.append(np.append(grid.x[0] - grid.dx, grid.x), grid.x[-1] + grid.dx)
    p = np.sqrt(np.interp(x, places, np.pad(pressure[0] ** 2, 1)))
    k = 2.0 * np.pi * scipy.fft.rfftfreq(count, width / count)
    slip = scipy.fft.irfft(scipy.fft.rfft(p) * _difference(k, bodies), n=count)
    return np.stack([np.interp(grid.x, x, slip)[None], np.zeros((1, grid.x.size))])


def _difference(k: Array, bodies: tuple[Body, Body]) -> Array:
    """c_rz of the ball less that of the race, shape of k [1/Pa]."""
    sampled = np.geomspace(max(k[k > 0.0].min(initial=1.0), 1e-300), max(k.max(), 1.0), 2000)
    first, second = (flexibility(body, np.append(0.0, sampled))[2] for body in bodies)
    return np.asarray(np.interp(k, np.append(0.0, sampled), first - second))


def _smooth_pressure(grid: Grid, pressure: Array, x: Array, y: Array) -> Array:
    """Pressure at other places: p^2, which has no vertical slope at the edge, is interpolated linearly."""
    squared = np.pad(pressure * pressure, 1)
    places = np.meshgrid((y - grid.y[0]) / grid.dy + 1.0, (x - grid.x[0]) / grid.dx + 1.0, indexing="ij")
    fine = np.sqrt(scipy.ndimage.map_coordinates(squared, places, order=1, mode="constant"))
    return np.asarray(fine * (pressure.sum() * grid.cell_area / (fine.sum() * (x[1] - x[0]) * (y[1] - y[0]))))
