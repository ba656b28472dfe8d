"""One strip: Carter's solution, the film's limits, Coulomb's law, and the same traction by other roads."""

from math import atan, pi

import numpy as np
import pytest

from separatrix.chain.master_curve import film_tables, master_traction, matched_knots, nested_sticks
from separatrix.chain.strip import node_pressure, solve_strip, strip_influence


def toeplitz(nodes, lam):
    """The matrix of the stick equations, written out."""
    i = np.arange(nodes)
    return strip_influence(nodes, lam)[i[:, None] - i[None, :] + nodes - 1]


def table_value(creep, lam):
    """F and dF/dc of the default master table."""
    return master_traction(creep, lam, film_tables(200)[0])


def test_carter_is_met_with_the_first_power_of_the_elements():
    """0.64 at two-fifths of saturation: the difference form's own numbers; halved errors."""
    for nodes, traction, digit in ((50, 0.6445, 5e-5), (200, 0.64114, 5e-6), (800, 0.64028, 5e-6)):
        # half a unit of the last digit
        assert solve_strip(0.4, nodes=nodes).traction_ratio == pytest.approx(traction, abs=digit)
    errors = [solve_strip(0.4, nodes=n).traction_ratio - 0.64 for n in (50, 100, 200, 400)]
    orders = -np.diff(np.log(errors)) / np.log(2.0)
    assert orders == pytest.approx(1.0, abs=0.1)  # 10 % on the order
    assert 2.0 * errors[3] - errors[2] == pytest.approx(0.0, abs=5e-5)  # four digits: 0.6400


@pytest.mark.parametrize("creep", [0.1, 0.4, 0.8])
def test_carters_traction_along_the_strip(creep):
    """Stick from the leading edge over a share 1 - c of the strip, less an ellipse of that share."""
    strip = solve_strip(creep, nodes=400)
    share = 1.0 - creep
    inside = np.maximum(share**2 - (strip.along - creep) ** 2, 0.0)
    exact = np.sqrt(1.0 - strip.along**2) - np.sqrt(inside)
    # first order inside; at the stick edge the traction is steep, an element's width costs sqrt(2/nodes)
    assert np.abs(strip.shear - exact).mean() < 1.0 / 400
    assert np.abs(strip.shear - exact).max() < np.sqrt(2.0 / 400)
    assert np.count_nonzero(strip.slip) / 400 == pytest.approx(creep, abs=2.0 / 400)


@pytest.mark.parametrize(("lam", "ratio"), [(0.1, 0.9115), (1.0, 0.5538), (10.0, 0.1129)])
def test_full_stick_with_film(lam, ratio):
    """Small creep with film, over the bare strip's 2 c: 0.9115, 0.5538, 0.1129 for lam = 0.1, 1, 10."""
    knots = matched_knots(strip_influence(400, lam), strip_influence(800, lam))[0]
    assert 0.5 * knots[2][0] == pytest.approx(ratio, abs=5e-5)  # the digits given
    assert 0.5 * table_value(0.0, lam)[1] == pytest.approx(ratio, abs=5e-4)  # 200 and 400 elements: 3e-4


@pytest.mark.parametrize("k", [0.05, 0.5, 1.0, 3.0])
def test_a_soft_film_alone(k):
    """Rigid bodies: shear grows linearly up to its bound, T/(mu P) = (2/pi)[k/(1+k^2) + atan k]."""
    lam = 1e7
    exact = 2.0 / pi * (k / (1.0 + k * k) + atan(k))
    value, slope = table_value(0.5 * k * lam, lam)
    assert value == pytest.approx(exact, rel=5e-4)  # measured 3e-4 at 200, 400
    assert slope * 0.5 * lam == pytest.approx(4 / pi / (1 + k * k) ** 2, rel=1e-3)


@pytest.mark.parametrize("lam", [0.0, 0.03, 1.0, 30.0])
def test_levinsons_recursion_is_the_active_set(lam):
    """The master curve's knots are not near the direct solutions but equal to them."""
    p = node_pressure(100)
    c, F, _ = nested_sticks(strip_influence(100, lam), p, toeplitz(100, lam) @ p)
    for m in (20, 40, 60, 95):  # near saturation the first elements, bare, do not stick in order
        below = c[m] * (1.0 - 1e-9)  # a knot's last element is neither in nor out
        strip = solve_strip(below, lam, nodes=100)
        assert strip.traction_ratio == pytest.approx(F[m], abs=1e-8)
        assert np.count_nonzero(strip.slip == 0) == m + 1


@pytest.mark.parametrize("lam", [0.0, 0.004, 0.1, 1.0, 20.0])
@pytest.mark.parametrize("creep", [0.02, 0.3, 0.7, 0.95, 1.3])
def test_the_master_table_stays_by_the_converged_strip(lam, creep):
    """Table against direct strips of 400 and 800 elements extrapolated: 0.1 % of the bound."""
    strips = [solve_strip(creep, lam, nodes=n).traction_ratio for n in (400, 800)]
    # where an unfinished stick zone of the coarse strip still counts, the reference itself is good to 5e-4
    assert table_value(creep, lam)[0] == pytest.approx(2 * strips[1] - strips[0], abs=1e-3)
