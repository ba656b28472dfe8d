"""The record of a creep."""

import dataclasses

import pytest

from separatrix.chain.creep import Creep, deformed_radius


def test_a_creep_cannot_be_changed():
    """Records are frozen."""
    with pytest.raises(dataclasses.FrozenInstanceError):
        Creep(spin=1.0, curvature=0.0).spin = 2.0


def test_the_pressed_surface_lies_between_ball_and_groove():
    """Conformity 0.5 fits the ball; a flat groove doubles its radius."""
    assert deformed_radius(0.01, 0.5) == pytest.approx(0.005, rel=1e-15)
    assert deformed_radius(0.01, 1e9) == pytest.approx(0.01, rel=1e-8)
