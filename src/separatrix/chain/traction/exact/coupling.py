r"""Slip that the pressure causes between unlike bodies, or where one of them is coated.

Pressure stretches the two surfaces differently: U_x = F^-1[(k_x/k) i (dc_rz/k) p], dc_rz being c_rz of the
ball less that of the race. It adds to the rigid slip

    W_c = -dU/dx = F^-1[(k_x, k_y) k_x/k^2 dc_rz p].

The pressure is known and smooth, and is transformed on a grid of its own: with pressures uniform over the
cells of the contact W_c would have spikes at their edges. In the plane W_c is 2 beta p/E* (Bentall & Johnson
1967). The effect of tractions on the pressure is neglected.
"""

from __future__ import annotations

import numpy as np
from scipy import fft, ndimage

from separatrix.chain.traction.exact.flexibility import Body, flexibility
from separatrix.chain.traction.exact.grid import Grid
from separatrix.ground.units import Array

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
    nx, ny = (fft.next_fast_len(int(min(n, LARGEST_COUNT)), real=True) for n in sides / contact * FINE)
    dx, dy = sides / (nx, ny)
    x, y = dx * (np.arange(nx) - 0.5 * nx) + grid.x.mean(), dy * (np.arange(ny) - 0.5 * ny) + grid.y.mean()
    p = _smooth_pressure(grid, pressure, x, y)
    kx, ky = 2.0 * np.pi * fft.rfftfreq(nx, dx), 2.0 * np.pi * fft.fftfreq(ny, dy)[:, None]
    k2 = kx * kx + ky * ky
    k2[0, 0] = 1.0
    waves = fft.rfft2(p, workers=1) * _difference(np.sqrt(k2), bodies) * kx / k2
    along, across = waves * kx, waves * ky
    along[0, 0] = 0.5 * p.sum() * far  # the mean of a dipole's field over a square around it
    places = np.meshgrid((grid.y - y[0]) / dy, (grid.x - x[0]) / dx, indexing="ij")
    fields = [fft.irfft2(wave, s=(ny, nx), workers=1) for wave in (along, across)]
    return np.array([ndimage.map_coordinates(f, places, order=1) for f in fields])


def _in_the_plane(grid: Grid, pressure: Array, bodies: tuple[Body, Body]) -> Array:
    """W_c = F^-1[dc_rz p] of a contact in the plane, shape (2, 1, column) [-]."""
    width = BOX * grid.dx * grid.x.size
    count = fft.next_fast_len(int(BOX * FINE[0]), real=True)
    x = width / count * (np.arange(count) - 0.5 * count) + grid.x.mean()
    places = np.append(np.append(grid.x[0] - grid.dx, grid.x), grid.x[-1] + grid.dx)
    p = np.sqrt(np.interp(x, places, np.pad(pressure[0] ** 2, 1)))
    k = 2.0 * np.pi * fft.rfftfreq(count, width / count)
    slip = fft.irfft(fft.rfft(p) * _difference(k, bodies), n=count)
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
    fine = np.sqrt(ndimage.map_coordinates(squared, places, order=1, mode="constant"))
    return np.asarray(fine * (pressure.sum() * grid.cell_area / (fine.sum() * (x[1] - x[0]) * (y[1] - y[0]))))
