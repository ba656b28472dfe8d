"""The ellipse of strips against its closed forms, and against strips solved one by one."""

from math import acos, atan, pi, sqrt

import numpy as np
import pytest

from separatrix.chain.creep import Creep
from separatrix.chain.hertz import contact_ellipse
from separatrix.chain.master_curve import film_tables
from separatrix.chain.strip import solve_strip
from separatrix.chain.traction_curve import (
    GAUSS_NODES,
    GAUSS_WEIGHTS,
    LEVELS,
    panel_edges,
    reach,
    shear_field,
    traction_curve,
    traction_slope,
)

ELLIPSE = contact_ellipse(500.0, 200.0, 20.0, 113e9)
A, B, P0, E, N = ELLIPSE.semi_major, ELLIPSE.semi_minor, ELLIPSE.max_pressure, ELLIPSE.contact_modulus, 500.0
MU = 0.1
XI_S = 2.0 * MU * P0 / E
NO_CREEP = Creep(spin=0.0, curvature=0.0)


def slope(spin=0.0, curvature=0.0, compliance=0.0, friction=MU, **more):
    """Slope and error of the test ellipse."""
    creep = Creep(spin=spin, curvature=curvature)
    return traction_slope(ELLIPSE, creep, race_friction=friction, film_compliance=compliance, **more)


def curve(spin=0.0, curvature=0.0, *, increments=None, friction=MU, compliance=0.0, **more):
    """Traction curve of the test ellipse."""
    creep, at = Creep(spin=spin, curvature=curvature), None if increments is None else np.array(increments)
    given = {"race_friction": friction, "film_compliance": compliance}
    return traction_curve(ELLIPSE, creep, creep_increments=at, **given, **more)


def film_slope(spin, compliance):
    """Film only: (8/3)(b^2 a/L) * (3/4)[1/k^2 + (1 - 1/k^2) atan(k)/k]/N, k = phi a b/(L mu p0)."""
    k = spin * A * B / (compliance * MU * P0)
    bracket = 1.0 / k**2 + (1.0 - 1.0 / k**2) * atan(k) / k
    return 8.0 / 3.0 * B**2 * A / compliance * 0.75 * bracket / N


def test_slope_without_spin():
    """Bare, no spin: 3 pi E*/(8 p0), at any friction above 0."""
    for friction in (1e-6, 0.1, 2.0):
        value, error = slope(friction=friction)
        exact = 3.0 * pi * E / (8.0 * P0)
        assert value == pytest.approx(exact, rel=1e-5)  # Richardson of 200 and 400 elements; measured 1e-8
        assert abs(value - exact) <= error <= 0.005 * exact


@pytest.mark.parametrize("sigma", [0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 20.0, 200.0, 1e6])
def test_slope_with_spin(sigma):
    """Bare, spin: (pi/2) E* a b arctan(1/sigma)/N; strips crowd at the zero-creep line."""
    value, error = slope(spin=sigma * XI_S / A)
    exact = pi / 2.0 * E * A * B * atan(1.0 / sigma) / N
    assert value == pytest.approx(exact, rel=3e-4)  # interpolation of the table; measured 3e-5
    assert abs(value - exact) <= error <= 0.005 * exact


@pytest.mark.parametrize("lam", [0.0, 0.1, 1.0, 10.0])
def test_little_friction_with_spin(lam):
    """At sigma = 1e5, any film: C_T's slope is 1.5 mu/(phi a)."""
    phi = 1e5 * XI_S / A
    value, error = slope(spin=phi, compliance=lam * B / E)
    assert value == pytest.approx(1.5 * MU / (phi * A), rel=3e-4)  # the limit is met to 1e-10; interpolation
    assert error <= 0.005 * value


@pytest.mark.parametrize("sigma", [1.0, 1e4, 1e5, 1e6, 1e7])
def test_slope_of_a_film_alone(sigma):
    """A film so soft that the bodies are rigid (lam = 1e5): the closed form for k from 2e-5 to 200."""
    phi, compliance = sigma * XI_S / A, 1e5 * B / E
    value, error = slope(spin=phi, compliance=compliance)
    # below k = 1e-3 the closed form cancels in double precision; its series is 1 - k^2/... = 1 there
    exact = film_slope(phi, compliance) if sigma > 100.0 else 8.0 / 3.0 * B**2 * A / compliance / N
    assert value == pytest.approx(exact, rel=6e-4)  # 200 and 400 elements; measured 2e-4
    assert abs(value - exact) <= error


def test_whole_curve_in_pure_creep():
    """Bare, no spin: C_T/mu = 1 + 1.5 [s acos s - e + e^3/3], s = xi/xi_s, e = sqrt(1 - s^2)."""
    increments = XI_S * np.array([0.02, 0.1, 0.3, 0.6, 0.9, 0.99, 1.0, 2.0])
    found = curve(increments=increments)
    s = np.minimum(increments / XI_S, 1.0)
    exact = [1.0 + 1.5 * (x * acos(x) - sqrt(1 - x * x) + sqrt(1 - x * x) ** 3 / 3.0) for x in s]
    assert found.traction_coefficient / MU == pytest.approx(exact, abs=1e-4)  # interpolation; measured 4e-5


def test_heathcote_alone_with_little_friction():
    """Slip changes sign at y = 0.347296 a; the slope there is 3.798 mu/(q a^2)."""
    q, friction, zero = 1000.0, 1e-9, -1000.0 * (0.347296 * A) ** 2
    found = curve(curvature=q, friction=friction)
    assert found.free_rolling_offset == pytest.approx(zero, rel=3e-6)  # six digits, squared
    assert found.slope == pytest.approx(3.798 * friction / (q * A * A), rel=3e-4)  # four digits
    none = curve(curvature=q, friction=0.0, compliance=1e-15)  # the limit of little friction
    assert none.free_rolling_offset == pytest.approx(zero, rel=3e-6)
    assert (none.slope, none.slope_error, none.traction_coefficient.any()) == (0.0, 0.0, False)


def test_no_zero_creep_line_is_full_slip():
    """An increment beyond every creep leaves no zero line: C_T = mu at each end."""
    found = curve(5.0, -2e4, friction=0.01, increments=[-1.0, 1.0])
    assert found.traction_coefficient == pytest.approx([-0.01, 0.01], rel=1e-9)  # six Gauss points a panel


@pytest.mark.parametrize(
    ("friction", "lam", "spin", "curvature", "shift"),
    [(0.1, 0.0, 5.0, -2e4, 0.3), (0.05, 0.3, -20.0, 3e4, -0.5), (0.2, 5.0, 1.0, -1e5, 0.1)],
)
def test_strips_solved_one_by_one_agree(friction, lam, spin, curvature, shift):
    """Master curve against direct active sets of 100 and 200 elements, extrapolated: traction, slope."""
    saturation = 2.0 * friction * P0 / E
    delta = shift * saturation
    found = curve(spin, curvature, friction=friction, compliance=lam * B / E, increments=[0.0, delta])
    sigma, eta = spin * A / saturation, curvature * A * A / saturation
    levels = LEVELS * reach(lam, film_tables(200)[0])

    def directly(nodes):
        tractions, slope = [], 0.0
        for xi in (found.free_rolling_offset, found.free_rolling_offset + delta):
            d = xi / saturation
            edges = panel_edges(d, sigma, eta, levels, 1)
            half = 0.5 * np.diff(edges)[:, None]
            theta = (edges[:-1, None] + half * (1.0 + GAUSS_NODES)).ravel()
            share = 0.75 * np.cos(theta) ** 3 * (half * GAUSS_WEIGHTS).ravel()
            y, half = np.sin(theta), np.cos(theta)
            each = list(zip((d + (sigma + eta * y) * y) / half, lam / half, strict=True))
            ratios = np.array([solve_strip(creep, film, nodes=nodes).traction_ratio for creep, film in each])
            if not tractions:  # at free rolling, where the slope is
                moved = [solve_strip(one + 1e-7, film, nodes=nodes).traction_ratio for one, film in each]
                slope = 0.5 * E / P0 * (share / half) @ (moved - ratios) / 1e-7
            tractions.append(friction * share @ ratios)
        return np.array([*tractions, slope])

    *direct, tangent = 2.0 * directly(200) - directly(100)
    assert found.traction_coefficient == pytest.approx(direct, abs=3e-4 * friction)  # measured 1e-4
    # the direct tangent jumps as elements change sides: 1/200 of it is the direct road's own noise
    assert found.slope == pytest.approx(tangent, rel=5e-3)


@pytest.mark.parametrize("lam", [0.001, 0.02, 0.5, 5.0])
def test_the_error_bounds_the_next_refinement(lam):
    """Four times finer strips move the slope by less than the stated error."""
    creep = {"spin": 8.0, "curvature": -2e4, "compliance": lam * B / E}
    coarse, error = slope(**creep, tolerance=1.0)
    fine, finer_error = slope(**creep, tolerance=1e-9)
    assert abs(coarse - fine) <= error
    assert finer_error < error


def test_no_friction_or_no_load_transmits_nothing():
    """At f_BT = 0 slope and error are exactly 0, just above it linear; no load has no slope."""
    assert slope(spin=3.0, friction=0.0) == (0.0, 0.0)
    assert slope(spin=3.0, friction=1e-7)[0] == pytest.approx(1.5e-7 / (3.0 * A), rel=1e-3)
    empty = contact_ellipse(0.0, 200.0, 20.0, 113e9)
    found = traction_curve(empty, NO_CREEP, race_friction=MU, film_compliance=1e-15)
    assert found.slope == 0.0
    assert not found.traction_coefficient.any()


def test_the_default_curve_spans_saturation():
    """41 increments, the middle one 0, whose ends carry more than 99 % of mu, bare, filmed or spinning."""
    for creep in ((0.0, 0.0), (30.0, -2e4)):
        for lam in (0.0, 1.0, 30.0):
            found = curve(*creep, compliance=lam * B / E)
            assert (found.creep_increment.size, found.creep_increment[20]) == (41, 0.0)
            assert found.traction_coefficient[-1] > 0.99 * MU
            assert found.traction_coefficient[0] < -0.99 * MU


def test_the_field_adds_up_to_the_curve():
    """Shear over the ellipse, summed over elements and strips, is the curve's C_T."""
    delta, case = (
        0.2 * XI_S,
        {"race_friction": MU, "film_compliance": 0.3 * B / E, "strips": 81, "nodes": 200},
    )
    expected = curve(3.0, -2e4, compliance=0.3 * B / E, increments=[delta]).traction_coefficient[0]
    field = shear_field(ELLIPSE, Creep(spin=3.0, curvature=-2e4), creep_increment=delta, **case)
    areas = np.abs(np.diff(field.along, axis=1))[:, :1] * (2.0 * A / 81)
    # strips of equal width: 1/81^1.5 at the ends of the ellipse; elements: half a percent at 200
    assert (field.pressure * areas).sum() / N == pytest.approx(1.0, abs=2e-3)
    assert (field.shear * areas).sum() / N == pytest.approx(expected, rel=1e-2)
    assert np.all(np.abs(field.shear) <= MU * field.pressure * (1.0 + 1e-9))  # rounding
    stuck = field.slip == 0.0
    assert 0 < np.count_nonzero(stuck) < stuck.size
    assert np.all(np.abs(field.shear_without_slip[~stuck]).max() > MU * field.pressure[~stuck].max())
