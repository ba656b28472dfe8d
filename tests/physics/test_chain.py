"""Directions of the whole chain, and that looking at a bearing from its other side changes nothing."""

import math
from dataclasses import replace

import numpy as np
import pytest
from cages import ON_A_LAND
from scipy.optimize import brentq

from separatrix import KinematicModel, Kinematics, StabilitySettings, lubrication_curve, read_study, solve
from separatrix.cage.course import follow_start
from separatrix.cage.disturbance import Starts, random_starts
from separatrix.cage.moving_cage import moving_cage, turned_forward
from separatrix.cage.numbers import waves_of
from separatrix.chain.contacts import waves_around
from separatrix.chain.equilibrium import equilibrium, orbit_by_diameter

SHIPPED = read_study("cryogenic-turbopump")
CONTROLLED = Kinematics(model=KinematicModel.OUTER_RACE_CONTROL)
STUDY = replace(SHIPPED, kinematics=CONTROLLED)  # quick, and free of the race friction


def eta(study):
    """Restitution factor of a study."""
    return solve(study).restitution.restitution_factor


def operation(**changes):
    """The study at another operating point."""
    return replace(STUDY, operation=replace(STUDY.operation, **changes))


def test_more_load_returns_more_and_more_speed_less():
    """C_mu is alpha N / V: load up, eta up; rolling speed up, eta down."""
    assert eta(operation(axial_load=6000.0)) > eta(STUDY) > eta(operation(axial_load=1500.0))
    slow, fast = STUDY.operation.inner_speed / 2, STUDY.operation.inner_speed * 1.5
    assert eta(operation(inner_speed=slow)) > eta(STUDY) > eta(operation(inner_speed=fast))


def test_the_lubrication_curve_goes_through_the_study():
    """At the study's own film and friction it has the study's restitution factor; rounding."""
    state, film = solve(SHIPPED), SHIPPED.film
    own = {"film_thicknesses": (0.0, film.thickness), "race_frictions": (film.race_friction,)}
    own |= {name: getattr(state.restitution, name) for name in ("ball_cage_stiffness", "cage_mass")}
    curve = lubrication_curve(state.bearing.inner, state.bearing.outer, film.body, **own)
    assert curve.restitution_factor[0, 1] == pytest.approx(state.restitution.restitution_factor, rel=1e-9)


def test_a_thick_soft_film_lowers_the_restitution_factor():
    """From bare to thick at any race friction; the paper's Fig. 8 in words (section 2.1.1)."""
    curve = solve(SHIPPED).lubrication
    eta = curve.restitution_factor
    gripping = curve.race_friction >= 0.1
    assert np.all(eta[gripping, -1] < eta[gripping, 0])
    assert np.all(np.diff(eta, axis=0) >= -1e-12)  # more friction, more speed back; rounding
    assert np.all((eta >= 0.0) & (eta < 1.0))


def waves_at(cosines, sines, azimuth):
    """Sum of harmonics at these azimuths."""
    harmonics = enumerate(zip(cosines, sines, strict=True), 1)
    return sum(a * np.cos(h * azimuth) + b * np.sin(h * azimuth) for h, (a, b) in harmonics)


def test_an_axial_load_runs_its_balls_alike():
    """No radial load, moment or tilt: no harmonics, whatever the kinematics."""
    for study in (STUDY, SHIPPED):
        state = solve(study)
        cage = moving_cage(state, 0.0)
        assert (cage.orbital_cosines, cage.orbital_sines) == ((), ())
        assert state.orbital_waves.share is None


@pytest.mark.parametrize("study", [STUDY, SHIPPED], ids=["controlled", "free"])
@pytest.mark.parametrize("change", [{"radial_load": 400.0}, {"moment": 5.0}])
def test_harmonics_reproduce_the_orbital_speeds_of_a_combined_load(study, change):
    """R times each ball's speed beyond the mean; the first harmonics leave less than 1e-4 of its variance."""
    state = solve(replace(study, operation=replace(study.operation, **change)))
    found = state.bearing.equilibrium
    cage = moving_cage(state, 0.0)
    beyond = cage.pitch_radius * (found.orbital_speed - cage.cage_speed)
    left = waves_at(cage.orbital_cosines, cage.orbital_sines, found.azimuth) - beyond
    assert np.abs(beyond).max() > 0.01
    assert np.linalg.norm(left) < 1e-2 * np.linalg.norm(beyond)  # sqrt of the variance that is left
    share = 1.0 - np.linalg.norm(left) ** 2 / np.linalg.norm(beyond) ** 2
    assert state.orbital_waves.share == pytest.approx(share, abs=1e-9)  # rounding


def test_free_balls_lead_by_the_integral_of_their_speed_and_a_loaded_one_is_slower():
    """Omega times the slope of the lead over the azimuth is the speed beyond the mean; to its difference."""
    waves = (0.3, 0.1), (-0.1, 0.2)
    cage = replace(moving_cage(solve(STUDY), 0.0), orbital_cosines=waves[0], orbital_sines=waves[1])
    azimuth, step = np.linspace(0.0, 6.0, 7), 1e-5
    slope = (cage.free_leads(azimuth + step) - cage.free_leads(azimuth - step)) / (2.0 * step)
    error = 2e-10  # step^2/6 of the third slope, below 1 m/s, 2e-11; rounding of a lead over the step, 2e-11
    assert cage.cage_speed * slope == pytest.approx(waves_at(*waves, azimuth), rel=0.0, abs=error)
    # the loaded ball is slower: its groove is deeper, the contact angle smaller, gamma = D cos/d_m larger
    assert moving_cage(solve(operation(radial_load=400.0)), 0.0).orbital_cosines[0] < 0.0


@pytest.mark.parametrize("count", [3, 4, 5, 9, 20])
def test_as_many_harmonics_as_the_balls_can_tell(count):
    """Below half the balls, at most four; a wave among them is found to rounding."""
    azimuth = 2.0 * np.pi * np.arange(count) / count
    highest = min(4, (count - 1) // 2)
    speeds = 500.0 + 3.0 * np.cos(highest * azimuth) - 2.0 * np.sin(highest * azimuth)
    waves = waves_around(0.1 * speeds, azimuth)
    assert len(waves.cosines) == len(waves.sines) == highest
    # 1e-11: rounding of the speeds, of which the waves are 3 out of 500
    assert (waves.cosines[-1], waves.sines[-1]) == pytest.approx((0.3, -0.2), rel=1e-11)
    assert waves.share == pytest.approx(1.0, rel=1e-11)  # as above


def test_waves_beyond_those_that_hold_nearly_all_are_left_out():
    """A third wave of 1e-5 of the variance goes, one of 1e-3 stays; a fifth always goes. Shares say so."""
    azimuth = 2.0 * np.pi * np.arange(13) / 13
    for power, kept in ((1e-5, 1), (1e-3, 3)):
        speeds = 500.0 + np.cos(azimuth) + np.sqrt(power) * np.cos(3.0 * azimuth)
        waves = waves_around(0.1 * speeds, azimuth)
        assert len(waves.cosines) == kept
        # 1e-11: rounding of the speeds, of which the waves are 1 out of 500
        assert waves.share == pytest.approx(1.0 if kept == 3 else 1.0 / (1.0 + power), rel=1e-11)
    fifth = waves_around(500.0 + np.cos(2.0 * azimuth) + np.sin(5.0 * azimuth), azimuth)
    assert fifth.share == pytest.approx(0.5, rel=1e-11)  # of two waves of equal variance; as above


def test_a_bearing_that_turns_backward_is_the_mirror_image_of_one_that_turns_forward():
    """Orbital waves and gravity included; tolerance: the residual of the equilibrium."""
    loaded = replace(SHIPPED.operation, radial_load=400.0)
    turned = replace(loaded, inner_speed=-SHIPPED.operation.inner_speed)
    there, back = (moving_cage(solve(replace(SHIPPED, operation=one)), 0.0) for one in (loaded, turned))
    mirror = turned_forward(back)
    assert back.cage_speed == pytest.approx(-there.cage_speed, rel=1e-6)
    assert back.race_damping == pytest.approx(there.race_damping, rel=1e-6)
    assert mirror.cage_speed == pytest.approx(there.cage_speed, rel=1e-9)
    assert mirror.orbital_cosines == pytest.approx(there.orbital_cosines, abs=1e-7)
    assert mirror.orbital_sines == pytest.approx(there.orbital_sines, abs=1e-7)
    assert mirror.capacity_waves == pytest.approx(there.capacity_waves, abs=1e-6)
    assert mirror.slope_waves == pytest.approx(there.slope_waves, abs=1e-6)


@pytest.mark.parametrize("change", [{"radial_load": 1000.0}, {"moment": 5.0}])
def test_every_ball_is_held_by_its_own_loads(change):
    """Capacity f_BT (Q_i + Q_o) of each; the slope as in an axial bearing whose balls have its inner load."""
    study = replace(SHIPPED, operation=replace(SHIPPED.operation, **change))
    state = solve(study)
    found, cage = state.bearing.equilibrium, moving_cage(state, 0.0)
    loads = found.load_inner + found.load_outer
    capacity, slope = (
        mean + waves_at(*waves_of(cage)[:, n : n + 2].T, found.azimuth)
        for n, mean in ((2, cage.capacity_waves[0]), (4, cage.slope_waves[0]))
    )
    # harmonics leave 1e-4 of the variance
    np.testing.assert_allclose(capacity, loads / loads.max(), atol=5e-3)
    least = int(np.argmin(loads))
    load = 13.0 * found.load_inner[least] * np.sin(found.contact_angle_inner[least])
    alone = solve(replace(SHIPPED, operation=replace(SHIPPED.operation, axial_load=load))).mobility
    # 6 and 8 % measured, from contact angles a degree apart
    assert slope[least] * state.mobility.traction.slope == pytest.approx(alone.traction.slope, rel=0.1)
    assert change != {"radial_load": 1000.0} or min(slope) < 0.45


def test_balls_that_the_inner_race_hardly_touches_are_held_alike():
    """All of them: their motion is that for a hundredth of the outer load, which is the same for each."""
    light = {"axial_load": 10.0, "radial_load": 2.0, "inner_speed": 2094.4}
    state = solve(replace(SHIPPED, operation=replace(SHIPPED.operation, **light)))
    found, cage = state.bearing.equilibrium, moving_cage(state, 0.0)
    assert (found.load_inner < 0.01 * found.load_outer).all()
    # 3 % between the least and the most loaded ball, from their contact angles
    assert cage.slope_waves[0] == pytest.approx(1.0, abs=0.03)


# Balls of unequal diameters: the orbital speed that a diameter makes, and runs among such balls.

SLOWER = -2e4
"""Of a turbopump: -20 mm/s for 1 um, about what its chain has [1/s]."""


def test_a_slow_ball_rolls_round_by_its_diameter_alone():
    r"""Without inertia both contacts stay on one line, and :math:`m = \tfrac12 (1 - D \cos\alpha/d_m)`."""
    slow = replace(SHIPPED.operation, inner_speed=1.0)
    at = SHIPPED.bearing, slow, KinematicModel.OUTER_RACE_CONTROL, 0.1
    angle = float(equilibrium(*at).contact_angle_inner[0])
    # the centrifugal force, 2e-5 of it at 10 rpm; differences, 1e-10
    assert orbit_by_diameter(*at) == pytest.approx(-math.cos(angle) / 4.0, rel=2e-5)


@pytest.mark.parametrize("model", [KinematicModel.FREE, KinematicModel.OUTER_RACE_CONTROL])
def test_an_orbit_is_that_of_a_bearing_of_larger_balls_with_its_rings_there(model):
    """The same grooves and the same place of the rings, held by the load that balls all larger would need."""
    one, at = SHIPPED.bearing, SHIPPED.operation
    span = (one.inner_conformity + one.outer_conformity - 1.0) * one.ball_diameter

    def place(bearing, free_span, load):
        found = equilibrium(bearing, replace(at, axial_load=load), model, 0.1)
        return found, free_span * math.sin(bearing.contact_angle) + found.axial_displacement

    _, wanted = place(one, span, at.axial_load)
    speeds = []
    for ratio in (1.0 - 1e-5, 1.0 + 1e-5):
        grooves = {name: getattr(one, name) / ratio for name in ("inner_conformity", "outer_conformity")}
        larger = (sum(grooves.values()) - 1.0) * ratio * one.ball_diameter
        angle = math.acos(span * math.cos(one.contact_angle) / larger)
        bearing = replace(one, ball_diameter=ratio * one.ball_diameter, contact_angle=angle, **grooves)
        load = brentq(lambda F: place(bearing, larger, F)[1] - wanted, 2500.0, 3500.0, xtol=1e-6)  # noqa: B023
        speeds.append(place(bearing, larger, load)[0].orbital_speed[0] * one.pitch_diameter / 2.0)
    by_load = (speeds[1] - speeds[0]) / (2e-5 * one.ball_diameter)
    # both are differences over 2e-5: their curvature is alike, rounding of the search some 1e-5
    assert orbit_by_diameter(one, at, model, 0.1) == pytest.approx(by_load, rel=1e-5)


def test_a_larger_ball_falls_behind_at_its_speed():
    """In pockets that it cannot reach a ball runs by its own speed alone."""
    wide = replace(ON_A_LAND, pocket_clearance=5e-3, ball_diameter=11e-3, orbit_by_diameter=SLOWER)
    larger = 1e-6 * np.sin(1.0 + np.arange(wide.ball_count))
    angles, still = np.array([wide.ball_angles]), np.zeros((1, wide.ball_count))
    starts = Starts(np.zeros(1), np.zeros(1), np.ones(1), still, -0.5 * larger[None], angles)
    after = follow_start(wide, 1e-3, starts, 2e-3, 100, 2e-3, real=np.float64)
    # rounding of some thousand steps
    np.testing.assert_allclose(after.ball_lead[-1], SLOWER * larger * after.time[-1], rtol=1e-12)


def test_balls_start_at_the_walls_to_which_their_orbits_bring_them():
    """On request: the larger ones behind; else between the walls."""
    uneven = replace(ON_A_LAND, ball_diameter=11e-3, ball_diameter_scatter=1e-6, orbit_by_diameter=SLOWER)
    found = random_starts(replace(uneven, balls_at_walls=True), StabilitySettings(), 0, 8)
    assert np.abs(found.lead) == pytest.approx(uneven.half_play + found.more, rel=1e-12)  # rounding
    assert (np.sign(found.lead) == np.sign(found.more)).all()
    between = random_starts(uneven, StabilitySettings(), 0, 8)
    assert (np.abs(between.lead) < uneven.half_play + between.more).all()
