"""Life of a sputtered film against pressure (ESTL, 44th Aerospace Mechanisms Symposium 2018, pp. 518-524).

Theirs: proportional to the mean Hertz pressure to the power -3.2 in rolling, -3.8 in sliding; of a bearing
good to a factor of ten either way. Ours has no such law: Archard's wear by the slip in the contacts. The
tolerance is their range of exponents.
"""

from dataclasses import replace

import numpy as np
import pytest

import separatrix
from separatrix.chain.contacts import bearing_state
from separatrix.study.study import KinematicModel, Race
from separatrix.verdict.wear_life import track_work


@pytest.mark.parametrize("race", Race)
def test_a_wheel_bearing_wears_its_film_as_the_published_power_of_pressure(race):
    """From 20 to 160 N on the bearing of `dry-reaction-wheel`: -3.6 at both races."""
    study = separatrix.read_study("dry-reaction-wheel")
    pressure, life = [], []
    for load in (20.0, 40.0, 80.0, 160.0):
        operation = replace(study.operation, axial_load=load)
        state = bearing_state(study.bearing, operation, KinematicModel.FREE, study.film.race_friction)
        ellipse = getattr(state, race.value).ellipse
        pressure.append(ellipse.load / (np.pi * ellipse.semi_major * ellipse.semi_minor))
        track = track_work(study.bearing, operation, state, race)
        life.append(1.0 / (track.work.max() * track.passes))
    exponent = np.polyfit(np.log(pressure), np.log(life), 1)[0]
    assert -3.8 < exponent < -3.2
