"""Balls of unequal diameters: the orbital speed that a diameter makes, and runs among such balls."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import ON_A_LAND
from scipy.optimize import brentq

from separatrix import KinematicModel, StabilitySettings, read_study
from separatrix.cage.course import follow_start
from separatrix.cage.disturbance import Starts, random_starts
from separatrix.chain.equilibrium import equilibrium, orbit_by_diameter

STUDY = read_study("cryogenic-turbopump")
SLOWER = -2e4
"""Of a turbopump: -20 mm/s for 1 um, about what its chain has [1/s]."""


def test_a_slow_ball_rolls_round_by_its_diameter_alone():
    r"""Without inertia both contacts stay on one line, and :math:`m = \tfrac12 (1 - D \cos\alpha/d_m)`."""
    slow = replace(STUDY.operation, inner_speed=1.0)
    at = STUDY.bearing, slow, KinematicModel.OUTER_RACE_CONTROL, 0.1
    angle = float(equilibrium(*at).contact_angle_inner[0])
    # 1e-4: the centrifugal force, 2e-5 of it at 10 rpm; differences, 1e-10
    assert orbit_by_diameter(*at) == pytest.approx(-math.cos(angle) / 4.0, rel=1e-4)


@pytest.mark.parametrize("model", [KinematicModel.FREE, KinematicModel.OUTER_RACE_CONTROL])
def test_an_orbit_is_that_of_a_bearing_of_larger_balls_with_its_rings_there(model):
    """The same grooves and the same place of the rings, held by the load that balls all larger would need."""
    one, at = STUDY.bearing, STUDY.operation
    span = (one.inner_conformity + one.outer_conformity - 1.0) * one.ball_diameter

    def place(bearing, free_span, load):
        found = equilibrium(bearing, replace(at, axial_load=load), model, 0.1)
        return found, free_span * math.sin(bearing.contact_angle) + found.axial_displacement

    _, wanted = place(one, span, at.axial_load)
    speeds = []
    for ratio in (1.0 - 1e-5, 1.0 + 1e-5):
        conformities = one.inner_conformity / ratio, one.outer_conformity / ratio
        larger = (sum(conformities) - 1.0) * ratio * one.ball_diameter
        bearing = replace(
            one,
            ball_diameter=ratio * one.ball_diameter,
            inner_conformity=conformities[0],
            outer_conformity=conformities[1],
            contact_angle=math.acos(span * math.cos(one.contact_angle) / larger),
        )
        load = brentq(lambda F: place(bearing, larger, F)[1] - wanted, 2500.0, 3500.0, xtol=1e-6)  # noqa: B023
        speeds.append(place(bearing, larger, load)[0].orbital_speed[0] * one.pitch_diameter / 2.0)
    by_load = (speeds[1] - speeds[0]) / (2e-5 * one.ball_diameter)
    # both are differences over 2e-5: their curvature is alike, rounding of the search some 1e-5
    assert orbit_by_diameter(one, at, model, 0.1) == pytest.approx(by_load, rel=1e-3)


def test_a_larger_ball_falls_behind_at_its_speed():
    """In pockets that it cannot reach a ball runs by its own speed alone."""
    wide = replace(ON_A_LAND, pocket_clearance=5e-3, ball_diameter=11e-3, orbit_by_diameter=SLOWER)
    larger = 1e-6 * np.sin(1.0 + np.arange(wide.ball_count))
    angles, still = np.array([wide.ball_angles]), np.zeros((1, wide.ball_count))
    starts = Starts(np.zeros(1), np.zeros(1), np.ones(1), still, -0.5 * larger[None], angles)
    after = follow_start(wide, 1e-3, starts, 2e-3, 100, 2e-3, real=np.float64)
    np.testing.assert_allclose(after.ball_lead[-1], SLOWER * larger * after.time[-1], rtol=1e-12)


def test_balls_start_at_the_walls_to_which_their_orbits_bring_them():
    """On request: the larger ones behind; else between the walls."""
    uneven = replace(ON_A_LAND, ball_diameter=11e-3, ball_diameter_scatter=1e-6, orbit_by_diameter=SLOWER)
    found = random_starts(replace(uneven, balls_at_walls=True), StabilitySettings(), 0, 8)
    assert np.abs(found.lead) == pytest.approx(uneven.half_play + found.more, rel=1e-12)
    assert (np.sign(found.lead) == np.sign(found.more)).all()
    between = random_starts(uneven, StabilitySettings(), 0, 8)
    assert (np.abs(between.lead) < uneven.half_play + between.more).all()
