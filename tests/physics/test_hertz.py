"""Hertz contact against exact limits, Carlson's integrals and a quadrature without them; creep."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import BEARING, STEEL
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import elliprd, elliprf

from separatrix import InputError, Material, Race
from separatrix.chain.hertz import (
    Creep,
    contact_creep,
    contact_ellipse,
    contact_modulus,
    deformed_radius,
    ellipse_of_axes,
    ellipse_of_curvatures,
    ellipse_shape,
    elliptic_integrals,
    race_curvatures,
)

NITRIDE = Material(name="nitride", elastic_modulus=310e9, poisson_ratio=0.27, density=3210.0)
ROUNDING = 1e-12  # some thousand operations in double precision


@pytest.mark.parametrize("ratio", [1.0, 1.0 + 1e-12, 1.0001, 1.5, 30.0, 1e3, 1e6, 1e9])
def test_shape_solves_carlsons_equation(ratio: float) -> None:
    """R_y/R_x = R_D(0, 1, q)/R_D(0, q, 1) holds to rounding from circles to needles."""
    k = ellipse_shape(ratio, 0.0)[0]
    assert elliprd(0, 1, k * k) / elliprd(0, k * k, 1) == pytest.approx(ratio, rel=ROUNDING)


@pytest.mark.parametrize("k", [1.0, 0.999999, 0.5, 0.1, 1e-3, 1e-6])
def test_integrals_are_carlsons(k: float) -> None:
    """K, (K - E)/m and (E - q K)/m from the arithmetic-geometric mean equal Carlson's forms."""
    q = k * k
    expected = (elliprf(0, q, 1), elliprd(0, q, 1) / 3.0, q * elliprd(0, 1, q) / 3.0)
    assert elliptic_integrals(k) == pytest.approx(expected, rel=ROUNDING)


def test_circular_limit() -> None:
    """Equal curvatures give Hertz's sphere: a^3 = 3 Q R/(4 E*), approach = a^2/R, p0 = 3 Q/(2 pi a^2)."""
    Q, R, modulus = 100.0, 5e-3, 110e9
    ellipse = contact_ellipse(Q, 1.0 / R, 1.0 / R, modulus)
    a = (0.75 * Q * R / modulus) ** (1.0 / 3.0)
    assert ellipse.semi_major == pytest.approx(a, rel=ROUNDING)
    assert ellipse.semi_minor == ellipse.semi_major
    assert ellipse.approach == pytest.approx(a * a / R, rel=ROUNDING)
    assert ellipse.max_pressure == pytest.approx(1.5 * Q / (math.pi * a * a), rel=ROUNDING)


@pytest.mark.parametrize("ratio", [1.0, 3.0, 26.0, 400.0])
def test_approach_is_the_integral_of_boussinesq(ratio: float) -> None:
    """The central displacement by quadrature of the pressure over angle, without elliptic integrals."""
    ellipse = contact_ellipse(1000.0, 200.0, 200.0 / ratio, 110e9)
    a, b = ellipse.semi_major, ellipse.semi_minor

    def ray(t: float) -> float:
        return 0.25 * math.pi * ellipse.max_pressure / math.hypot(math.sin(t) / a, math.cos(t) / b)

    carried = 2.0 / 3.0 * math.pi * a * b * ellipse.max_pressure  # of a semi-ellipsoid of pressure
    # Along a ray at angle t the pressure integrates to pi p0 rho(t)/4 (the 1/r of Boussinesq cancels r).
    assert carried == pytest.approx(1000.0, rel=ROUNDING)
    displacement = 4.0 * quad(ray, 0.0, 0.5 * math.pi, epsrel=1e-12, limit=200)[0] / (math.pi * 110e9)
    assert displacement == pytest.approx(ellipse.approach, rel=1e-9)  # the quadrature's own error


def test_pair_modulus_of_different_materials() -> None:
    """Compliances add; two equal bodies give E/(2 (1 - nu^2)) = G/(1 - nu)."""
    G = STEEL.elastic_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    assert contact_modulus(STEEL, STEEL) == pytest.approx(G / (1.0 - STEEL.poisson_ratio), rel=ROUNDING)
    mixed = 1.0 / contact_modulus(STEEL, NITRIDE)
    halves = 0.5 / contact_modulus(STEEL, STEEL) + 0.5 / contact_modulus(NITRIDE, NITRIDE)
    assert mixed == pytest.approx(halves, rel=ROUNDING)


def test_race_curvatures_use_the_operating_angle() -> None:
    """1/R_x is (2/D)/(1 -+ D cos(alpha)/d_m): at 90 degrees both races are flat along rolling."""
    bearing = replace(BEARING, ball_diameter=0.01, pitch_diameter=0.05, ball_count=8)
    assert race_curvatures(bearing, Race.INNER, 0.0)[0] == pytest.approx(200.0 / 0.8, rel=ROUNDING)
    assert race_curvatures(bearing, Race.OUTER, 0.0)[0] == pytest.approx(200.0 / 1.2, rel=ROUNDING)
    for race in Race:
        assert race_curvatures(bearing, race, math.pi / 2)[0] == pytest.approx(200.0, rel=ROUNDING)
    transverse = race_curvatures(bearing, Race.OUTER, 0.3)[1]
    assert transverse == pytest.approx(1.0 / 0.005 - 1.0 / 0.0053, rel=ROUNDING)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ((-1.0, 200.0, 10.0, 1e11), "load must be finite and >= 0 [N]; got -1."),
        ((math.nan, 200.0, 10.0, 1e11), "load must be finite"),
        ((1.0, 200.0, 0.0, 1e11), "curvature_transverse must be finite and > 0 [1/m]; got 0. The groove"),
        ((1.0, 10.0, 200.0, 1e11), "Swap the two"),
        ((1.0, math.inf, 200.0, 1e11), "curvature_rolling must lie from 200 up [1/m]; got inf."),
        ((1.0, 200.0, 10.0, 0.0), "contact_modulus must be finite and > 0 [Pa]; got 0."),
    ],
)
def test_a_wrong_number_is_refused_with_rule_and_value(numbers, words) -> None:
    """One sentence: where, rule, unit, value, cure."""
    with pytest.raises(InputError) as caught:
        contact_ellipse(*numbers)
    assert words in str(caught.value)


def test_no_load_gives_an_ellipse_of_no_size() -> None:
    """A ball that does not touch has lengths, pressure and stiffness 0, and no NaN."""
    found = contact_ellipse(0.0, 200.0, 10.0, 1e11)
    for name in ("semi_major", "semi_minor", "max_pressure", "approach", "stiffness"):
        assert getattr(found, name) == 0.0, name


@pytest.mark.parametrize("curvatures", [(300.0, 10.0), (10.0, 300.0), (50.0, 50.0), (1000.0, 1.0)])
def test_axes_give_back_the_curvatures(curvatures):
    """From curvatures to half lengths and back, longer along or across rolling; to rounding."""
    found = ellipse_of_curvatures(200.0, *curvatures, 1.1e11)
    again = ellipse_of_axes(200.0, found.semi_minor, found.semi_major, 1.1e11)
    assert (again.curvature_rolling, again.curvature_transverse) == pytest.approx(curvatures, rel=1e-14)
    for name in ("max_pressure", "approach"):
        assert getattr(again, name) == pytest.approx(getattr(found, name), rel=1e-14)  # rounding
    assert (found.semi_minor < found.semi_major) == (curvatures[0] > curvatures[1])


@given(
    load=st.floats(1e-3, 1e6),
    curvature=st.floats(1.0, 1e4),
    ratio=st.floats(1.0, 1e7),
    factor=st.floats(1e-3, 1e3),
)
def test_load_scaling(load: float, curvature: float, ratio: float, factor: float) -> None:
    """At fixed shape, lengths and pressure grow as Q^(1/3), approach as Q^(2/3), stiffness as Q^(1/3)."""
    one = contact_ellipse(load, curvature, curvature / ratio, 110e9)
    two = contact_ellipse(load * factor, curvature, curvature / ratio, 110e9)
    near = {"rel": 1e-11}  # cube roots and the root of the shape, both to about 1e-15, over many magnitudes
    third = factor ** (1.0 / 3.0)
    assert two.semi_major == pytest.approx(one.semi_major * third, **near)
    assert two.semi_minor == pytest.approx(one.semi_minor * third, **near)
    assert two.max_pressure == pytest.approx(one.max_pressure * third, **near)
    assert two.approach == pytest.approx(one.approach * third**2, **near)
    assert two.stiffness == pytest.approx(one.stiffness * third, **near)
    assert one.semi_minor <= one.semi_major


# Creep of a contact from its geometry: speeds of points of ball and race, worked out without the formula.

ANGLE = math.radians(30.0)


def creep_of_points(race, y):
    """Creep of surface points at y across a groove in rolling, from rigid-body speeds in the cage's frame.

    The pressed surface bends with the groove: its points lie y^2/(2 R_d) nearer to the ball's centre than the
    middle. Speeds count along the direction in which the surfaces run at the inner race; at the outer they
    run back.
    """
    D, reach = BEARING.ball_diameter, 0.5 * BEARING.pitch_diameter / math.cos(ANGLE)
    f, side = (BEARING.inner_conformity, -1.0) if race is Race.INNER else (BEARING.outer_conformity, 1.0)
    drop = y * y / (2.0 * deformed_radius(D, f))
    ball = -side * (0.5 * D - drop) / (0.5 * D)
    ring = -side * (reach + side * (0.5 * D - drop)) / (reach + side * 0.5 * D)
    return ball - ring


@pytest.mark.parametrize(("race", "sign"), [(Race.INNER, -1.0), (Race.OUTER, 1.0)])
def test_heathcote_bends_by_the_curvature(race, sign):
    """Off the middle the ball lags either race by y^2/(2 R_d R_x); at the outer that counts forwards."""
    y = np.array([-4e-4, 1e-4, 3e-4])
    creep = contact_creep(BEARING, race, ANGLE, 0.0)
    assert creep.spin == 0.0
    assert np.sign(creep.curvature) == sign
    assert creep.ratio(y) == pytest.approx(creep_of_points(race, y), rel=1e-9)  # rounding


def test_creep_adds_its_parts_and_that_of_spin_is_spin_over_rolling_speed():
    """Spin moves the surfaces apart by dw_spin y, they roll at dw_roll R_x. xi = delta + s y + q y^2."""
    D, gamma = BEARING.ball_diameter, BEARING.ball_diameter * math.cos(ANGLE) / BEARING.pitch_diameter
    inner = contact_creep(BEARING, Race.INNER, ANGLE, 0.3)
    outer = contact_creep(BEARING, Race.OUTER, ANGLE, -0.3)
    assert inner.spin == pytest.approx(0.3 * 2.0 / D / (1.0 - gamma), rel=1e-14)
    assert outer.spin == pytest.approx(-0.3 * 2.0 / D / (1.0 + gamma), rel=1e-14)
    creep = Creep(spin=2.0, curvature=-3.0)
    assert creep.ratio(np.array([0.0, 1.0, 2.0]), 0.5) == pytest.approx([0.5, -0.5, -7.5], abs=1e-15)


def test_the_pressed_surface_lies_between_ball_and_groove():
    """Conformity 0.5 fits the ball (1e-15: rounding); a flat groove all but doubles its radius."""
    assert deformed_radius(0.01, 0.5) == pytest.approx(0.005, rel=1e-15)
    assert deformed_radius(0.01, 1e9) == pytest.approx(0.01, rel=1e-8)
