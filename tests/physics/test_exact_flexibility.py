"""Flexibility of layered half-spaces and their influence coefficients."""

import numpy as np
import pytest
from exact_cases import body
from scipy.integrate import dblquad

from separatrix.chain.exact.influence import (
    UNCOUPLED,
    Images,
    body_images,
    flexibility,
    half_space_flexibility,
    influence,
    solid,
)

SOFT = body(0.3, (0.01, 0.46, 0.1))
PLAIN = ((0, 1.0),)


@pytest.mark.parametrize(
    ("layers", "k", "expected"),
    [
        ([(0.01, 0.46, 0.1)], 1.0, (10.5656, 1.42796, -0.177863, 10.95588)),
        ([(0.05, 0.4, 0.2)], 2.0, (7.21634, 2.03505, -0.387248, 8.43867)),
        ([(0.02, 0.4, 0.1), (3.0, 0.25, 0.5)], 1.0, (5.27743, 1.40019, 0.083163, 5.46173)),
        ([(0.02, 0.4, 0.1), (3.0, 0.25, 0.5)], 3.0, (13.76786, 2.93256, -0.803633, 14.88560)),
    ],
)
def test_flexibility_of_layers(layers, k, expected):
    """c_rr, c_zz, c_rz and c_tt, computed before by two methods; the tolerance is their last digit."""
    c_rr, c_zz, c_rz, c_tt = flexibility(body(0.3, *layers), np.array([k]))[:, 0]
    assert (c_rr, c_zz, c_rz, c_tt) == pytest.approx(expected, rel=6e-6)


def test_limits_of_wavenumber():
    """At k -> 0 is the base, k -> infinity the film, and nothing overflows between; exact up to rounding."""
    c = flexibility(SOFT, np.array([0.0, 1e-3, 2e4, 1e12]))
    assert c[:, 0] == pytest.approx(half_space_flexibility(SOFT.base), rel=1e-12)
    assert c[:, 2] == pytest.approx(half_space_flexibility(SOFT.surface), rel=1e-12)
    assert c[:, 3] == pytest.approx(half_space_flexibility(SOFT.surface), rel=1e-12)
    # first order of a thin film: c_rr = base + kh/G, c_zz = base + kh/M_c
    thin = (c[:, 1] - c[:, 0]) / (1e-3 * 0.1)
    assert thin[0] == pytest.approx(1.0 / 0.01, rel=0.02)
    assert thin[1] == pytest.approx(1.0 / SOFT.surface.compression_modulus, rel=0.2)


def test_a_film_in_series_holds_to_half_a_percent_but_not_a_stiff_one():
    """c_rr of the race and of the bare ball against half-planes plus kh/G, up to kh = 0.03: docs' claims.

    Dense MoS2 (136 GPa) stiffens the race against stretching: 1.2 % at kh = 0.03.
    """
    kh, steel = np.array([0.003, 0.01, 0.03]), solid(205e9, 0.285)
    bare = half_space_flexibility(steel)[0]

    def gap(modulus, poisson):
        film = solid(modulus, poisson)
        coated = body(0.285, (film.shear_modulus, poisson, 1e-6), G=steel.shear_modulus)
        return (2.0 * bare + kh / film.shear_modulus) / (flexibility(coated, kh / 1e-6)[0] + bare) - 1.0

    for modulus in (0.5e9, 1.5e9, 4e9, 20e9):
        assert np.abs(gap(modulus, 0.38)).max() < 5e-3  # the claim itself
    assert gap(136e9, 0.3)[-1] == pytest.approx(0.0116, abs=5e-4)  # measured


@pytest.mark.parametrize(
    ("layers", "limit"),
    [
        ([(0.01, 0.46, 0.1)], 2e-6),
        ([(0.0025, 0.46, 0.1)], 2e-6),
        ([(3.0, 0.25, 0.5)], 5e-6),
        ([(0.02, 0.4, 0.1), (0.5, 0.25, 0.15)], 2e-6),
        ([(0.02, 0.4, 0.1), (3.0, 0.25, 0.5)], 1e-4),
    ],
)
def test_error_of_the_fit(layers, limit):
    """The error is found at other wavenumbers too; 1e-6 of the span, 1e-4 for unlike layers."""
    coated = body(0.3, *layers)
    found = body_images(coated)
    k = np.geomspace(0.01, 300.0, 997)
    c = flexibility(coated, k)[UNCOUPLED]
    error = np.abs(found.weights @ np.exp(-np.outer(found.depths, k)) - c).max(axis=1) / np.ptp(c, axis=1)
    assert error.max() < 1.2 * found.error
    assert found.error < limit


def _point_source(x, y, d, c_rr, c_zz, c_tt):
    """Displacements of a point load in closed form: xx, yy, xy, zz."""
    R = np.sqrt(x * x + y * y + d * d)
    cos2, sin2 = 1.0 / (R + d) - np.array([x * x, y * y]) / (R * (R + d) ** 2)
    both = -x * y / (R * (R + d) ** 2)
    along, across = c_rr * cos2 + c_tt * sin2, c_rr * sin2 + c_tt * cos2
    return np.array([along, across, (c_rr - c_tt) * both, c_zz / R]) / (2.0 * np.pi)


@pytest.mark.parametrize(("j", "i"), [(0, 0), (1, -1), (2, 1)])
def test_four_corner_functions_against_quadrature(j, i):
    """Rectangle integrals of a buried source; 1e-8 is what dblquad gives."""
    w, d, dy, dx = np.array([1.3, 0.7, 2.1]), 0.3, 0.8, 0.5
    table = influence((3, 3), (dy, dx), Images(np.array([d]), w[:, None], 0.0), PLAIN)[:, j, i + 2]
    for n in range(4):
        cell = (i - 0.5) * dx, (i + 0.5) * dx, (j - 0.5) * dy, (j + 0.5) * dy
        value, _ = dblquad(lambda y, x, n=n: _point_source(x, y, d, *w)[n], *cell, epsabs=1e-10)
        assert table[n] == pytest.approx(value, abs=1e-8)
