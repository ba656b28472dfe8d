r"""Ellipse of strips: their placement and resultant (paper, 4.3.1 and Eq. 15).

In units of the contact: y = a sin(theta); creep X = xi/xi_s with xi_s = 2 mu p0/E*, X = d + sigma sin + eta
sin^2; the strip at theta has c = X/(m cos(theta)) and lam = lam0/cos(theta), and carries (3/4) m cos^3(theta)
d(theta) of mu N, mu being the largest friction and m that of the strip over it. A worn track is made of
pieces in which lam0 and m change linearly with y; any other is one piece. Strips are Gauss points of panels
that end where |X| passes 0 and a geometric series of levels, so that they crowd at the zero-creep lines
however strong the spin.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.master_curve import master_traction
from separatrix.ground.compiled import kernel, part
from separatrix.ground.units import Array

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)
SECTORS = np.pi * np.array([-0.5, -0.4, -0.25, 0.0, 0.25, 0.4, 0.5])
LEVELS = np.array([0.0, 0.6, 1.5, 4.0, 16.0, 100.0])
Table = tuple[Array, Array, tuple[float, float, float, float, float]]


Y_LOW, Y_HIGH, LAM_LOW, LAM_HIGH, M_LOW, M_HIGH, REACH = range(7)
"""Columns of a piece: its edges y/a, lam0 and m at them, and its reach: the creep over xi_s at which the
tangent at the origin would saturate the middle strip; 0 without a film."""


@part
def creep_at(theta: float, d: float, sigma: float, eta: float) -> float:
    """Creep X = d + sigma y + eta y^2 at y = sin(theta) [-]."""
    y = math.sin(theta)
    return d + (sigma + eta * y) * y


@part
def _roots(d: float, sigma: float, eta: float) -> tuple[float, float]:
    """Places y where d + sigma y + eta y^2 = 0; 2 where there is none."""
    if eta == 0.0:
        return (-d / sigma if sigma != 0.0 else 2.0), 2.0
    discriminant = sigma * sigma - 4.0 * eta * d
    if discriminant < 0.0:
        return 2.0, 2.0
    q = -0.5 * (sigma + math.copysign(math.sqrt(discriminant), sigma))
    return q / eta, (d / q if q != 0.0 else 2.0)


@kernel
def panel_edges(d: float, sigma: float, eta: float, levels: Array, splits: int) -> Array:
    """Edges in theta of the panels, in order, shape (edge,) [rad]."""
    edges = np.empty(4 * levels.size + SECTORS.size + 1)
    for k in range(SECTORS.size):
        edges[k] = SECTORS[k]
    count = SECTORS.size
    if eta != 0.0 and abs(sigma) < 2.0 * abs(eta):
        edges[count] = math.asin(-0.5 * sigma / eta)
        count += 1
    for k in range(levels.size):
        for side in (-1.0, 1.0):
            for y in _roots(d + side * levels[k], sigma, eta):
                if abs(y) < 1.0:
                    edges[count] = math.asin(y)
                    count += 1
    for k in range(SECTORS.size, count):  # put each in its place; the library's sort takes seconds to compile
        while k > 0 and edges[k] < edges[k - 1]:
            edges[k - 1], edges[k] = edges[k], edges[k - 1]
            k -= 1
    return _split(_with_saturation(edges[:count], d, sigma, eta), splits)


@part
def _with_saturation(edges: Array, d: float, sigma: float, eta: float) -> Array:
    """Edges, and between them the places where a bare strip starts to slip throughout: |X| = cos(theta)."""
    refined = np.empty(2 * edges.size)
    refined[0], count = edges[0], 1
    for k in range(edges.size - 1):
        low, high = edges[k], edges[k + 1]
        slips = abs(creep_at(low, d, sigma, eta)) > math.cos(low)
        if slips != (abs(creep_at(high, d, sigma, eta)) > math.cos(high)):
            for _ in range(45):
                middle = 0.5 * (low + high)
                if slips == (abs(creep_at(middle, d, sigma, eta)) > math.cos(middle)):
                    low = middle
                else:
                    high = middle
            refined[count] = 0.5 * (low + high)
            count += 1
        refined[count] = edges[k + 1]
        count += 1
    return refined[:count]


@part
def _split(edges: Array, splits: int) -> Array:
    """Edges with every panel cut into `splits` equal parts."""
    fine = np.empty((edges.size - 1) * splits + 1)
    for k in range(edges.size - 1):
        for i in range(splits):
            fine[k * splits + i] = edges[k] + (edges[k + 1] - edges[k]) * i / splits
    fine[-1] = edges[-1]
    return fine


@kernel
def resultant(
    d: float, sigma: float, eta: float, pieces: Array, splits: int, gauss: tuple[Array, Array], table: Table
) -> tuple[float, float]:
    """Traction over mu N and its derivative with d, of the ellipse of strips [-]."""
    values, log_scale, axis = table
    nodes, weights = gauss
    force, slope = 0.0, 0.0
    for j in range(pieces.shape[0]):
        piece = pieces[j]
        low, width = piece[Y_LOW], piece[Y_HIGH] - piece[Y_LOW]
        middle = 0.5 * (piece[M_LOW] + piece[M_HIGH])
        first, last = math.asin(low), math.asin(piece[Y_HIGH])
        levels = np.empty(LEVELS.size if piece[REACH] > 0.0 else 2)
        for k in range(levels.size):
            levels[k] = LEVELS[k] * (piece[REACH] if piece[REACH] > 0.0 else 1.0)
        edges = panel_edges(d / middle, sigma / middle, eta / middle, levels, splits)
        for k in range(edges.size):
            edges[k] = min(max(edges[k], first), last)
        for k in range(edges.size - 1):
            half = 0.5 * (edges[k + 1] - edges[k])
            if half <= 0.0:
                continue
            for i in range(nodes.size):
                theta = edges[k] + half * (1.0 + nodes[i])
                cosine, along = math.cos(theta), (math.sin(theta) - low) / width
                lam = piece[LAM_LOW] + (piece[LAM_HIGH] - piece[LAM_LOW]) * along
                m = piece[M_LOW] + (piece[M_HIGH] - piece[M_LOW]) * along
                c = creep_at(theta, d, sigma, eta) / (m * cosine)
                F, dF = master_traction(c, lam / cosine, values, log_scale, axis)
                share = 0.75 * cosine * cosine * half * weights[i]
                force += share * cosine * m * F
                slope += share * dF
    return min(max(force, -1.0), 1.0), slope  # the shares of the strips sum to 1 but for 1e-9


@part
def highest(sigma: float, eta: float) -> float:
    """Largest value of sigma y + eta y^2 on the ellipse, |y| <= 1 [-]."""
    return -0.25 * sigma * sigma / eta if abs(sigma) < -2.0 * eta else abs(sigma) + eta


@kernel
def free_rolling(
    sigma: float, eta: float, pieces: Array, splits: int, gauss: tuple[Array, Array], table: Table
) -> float:
    """Offset d without net traction: Newton's steps inside a shrinking bracket [-]."""
    if eta == 0.0:
        return 0.0  # spin alone is odd in y
    low, high = -highest(sigma, eta), highest(sigma, -eta)
    d = 0.5 * (low + high)
    for _ in range(80):
        force, slope = resultant(d, sigma, eta, pieces, splits, gauss, table)
        if force > 0.0:
            high = d
        else:
            low = d
        step = force / slope if slope > 0.0 else math.inf
        trial = d - step
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if abs(trial - d) <= 1e-13 * (abs(sigma) + abs(eta)) or high - low <= 1e-14 * (abs(sigma) + abs(eta)):
            return trial
        d = trial
    return d
