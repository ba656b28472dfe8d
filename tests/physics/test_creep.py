"""Creep of a contact from its geometry: speeds of points of ball and race, worked out without the formula."""

from math import cos, radians

import numpy as np
import pytest
from cages import BEARING

from separatrix.chain.creep import Creep, contact_creep, deformed_radius
from separatrix.study.study import Race

ANGLE = radians(30.0)


def creep_of_points(race, y):
    """Creep of surface points at y across a groove in rolling, from rigid-body speeds in the cage's frame.

    The pressed surface bends with the groove: its points lie y^2/(2 R_d) nearer to the ball's centre than the
    middle. Speeds count along the direction in which the surfaces run at the inner race; at the outer they
    run back.
    """
    D, reach = BEARING.ball_diameter, 0.5 * BEARING.pitch_diameter / cos(ANGLE)
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


def test_spin_creep_is_spin_speed_over_rolling_speed():
    """At y, spin moves the surfaces apart by dw_spin y; they roll at about dw_roll R_x: s = ratio/R_x."""
    D, gamma = BEARING.ball_diameter, BEARING.ball_diameter * cos(ANGLE) / BEARING.pitch_diameter
    inner = contact_creep(BEARING, Race.INNER, ANGLE, 0.3)
    outer = contact_creep(BEARING, Race.OUTER, ANGLE, -0.3)
    assert inner.spin == pytest.approx(0.3 * 2.0 / D / (1.0 - gamma), rel=1e-14)
    assert outer.spin == pytest.approx(-0.3 * 2.0 / D / (1.0 + gamma), rel=1e-14)


def test_creep_adds_its_parts():
    """xi(y) = delta + s y + q y^2."""
    creep = Creep(spin=2.0, curvature=-3.0)
    assert creep.ratio(np.array([0.0, 1.0, 2.0]), 0.5) == pytest.approx([0.5, -0.5, -7.5], abs=1e-15)


def test_the_pressed_surface_lies_between_ball_and_groove():
    """Conformity 0.5 fits the ball (1e-15: rounding); a flat groove all but doubles its radius."""
    assert deformed_radius(0.01, 0.5) == pytest.approx(0.005, rel=1e-15)
    assert deformed_radius(0.01, 1e9) == pytest.approx(0.01, rel=1e-8)
