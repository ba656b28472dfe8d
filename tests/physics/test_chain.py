"""Directions of the whole chain, and that looking at a bearing from its other side changes nothing."""

from dataclasses import replace

import numpy as np
import pytest

from separatrix.chain import cage_state, lubrication, restitution_state
from separatrix.lubrication import lubrication_curve
from separatrix.study import Film, KinematicModel
from separatrix.study_file import read_study

SHIPPED = read_study("cryogenic-turbopump")
STUDY = replace(SHIPPED, kinematics=KinematicModel.OUTER_RACE_CONTROL)  # quick, and free of the race friction


def eta(study):
    """Restitution factor of a study."""
    return restitution_state(study).restitution.restitution_factor


def film(**changes):
    """The study with another film."""
    return replace(STUDY, film=replace(STUDY.film, **changes))


def operation(**changes):
    """The study at another operating point."""
    return replace(STUDY, operation=replace(STUDY.operation, **changes))


def test_more_race_friction_returns_more():
    """The paper's net claim (4.4 with Eqs 17-18): races that grip the ball harder give more speed back."""
    values = [eta(film(race_friction=f)) for f in (0.05, 0.1, 0.2, 0.4)]
    assert values == sorted(values)
    assert values[0] < values[-1]


def test_a_stiffer_film_returns_more():
    """E_film/h up, eta up; where spin saturates the contact, C_mu may fall by up to 3 % instead."""
    soft, stiff = (
        restitution_state(film(material=replace(STUDY.film.material, elastic_modulus=E))).restitution
        for E in (1e7, 1e10)
    )
    assert stiff.race_damping > 0.97 * soft.race_damping
    bare = restitution_state(replace(STUDY, film=Film(race_friction=0.1))).restitution
    assert bare.race_damping > 0.97 * soft.race_damping


def test_more_load_returns_more():
    """C_mu is alpha N / V: load up, eta up."""
    assert eta(operation(axial_load=6000.0)) > eta(STUDY) > eta(operation(axial_load=1500.0))


def test_more_speed_returns_less():
    """C_mu is alpha N / V: rolling speed up, eta down."""
    slow, fast = STUDY.operation.inner_speed / 2, STUDY.operation.inner_speed * 1.5
    assert eta(operation(inner_speed=slow)) > eta(STUDY) > eta(operation(inner_speed=fast))


def test_turning_the_bearing_the_other_way_changes_nothing():
    """The sign of the speed is a matter of the side one looks from; tolerance: the equilibrium's residual."""
    there, back = cage_state(STUDY), cage_state(operation(inner_speed=-STUDY.operation.inner_speed))
    assert back.cage.cage_speed == pytest.approx(-there.cage.cage_speed, rel=1e-6)
    assert back.cage.race_damping == pytest.approx(there.cage.race_damping, rel=1e-6)


def test_free_spin_damps_less_than_the_sum():
    """4 C_I C_E/(C_I + C_E) against C_I + C_E, with the numbers of a real bearing."""
    found = restitution_state(SHIPPED).restitution
    assert found.restitution_factor_free_spin < found.restitution_factor


def test_the_lubrication_curve_goes_through_the_study():
    """At the study's own film and friction it has the study's restitution factor; rounding."""
    state = restitution_state(SHIPPED)
    contacts = state.traction.bearing
    curve = lubrication_curve(
        contacts.inner,
        contacts.outer,
        SHIPPED.film.material,
        ball_cage_stiffness=state.restitution.ball_cage_stiffness,
        cage_mass=state.restitution.cage_mass,
        film_thicknesses=(0.0, SHIPPED.film.thickness),
        race_frictions=(SHIPPED.film.race_friction,),
    )
    assert curve.restitution_factor[0, 1] == pytest.approx(state.restitution.restitution_factor, rel=1e-9)


def test_a_thick_soft_film_lowers_the_restitution_factor():
    """From bare to thick at any race friction; the paper's Fig. 8 in words (section 2.1.1)."""
    curve = lubrication(SHIPPED, restitution_state(SHIPPED))
    eta = curve.restitution_factor
    gripping = curve.race_friction >= 0.1
    assert np.all(eta[gripping, -1] < eta[gripping, 0])
    assert np.all(np.diff(eta, axis=0) >= -1e-12)  # more friction, more speed back; rounding
    assert np.all((eta >= 0.0) & (eta < 1.0))
