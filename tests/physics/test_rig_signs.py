"""What a test rig sees of a cage: torque by the balance of powers, its exponent, the line of a whirl."""

import math
from dataclasses import replace

import numpy as np
import pytest

import separatrix
from separatrix.cage import moving_cage, simulate
from separatrix.cage.closed_forms import linear_whirl_frequency
from separatrix.cage.outcome import RunOutcome
from separatrix.chain.solution import solve
from separatrix.verdict.rig_signs import SLOWER, housing_line, rig_signs, slower

WHEEL = solve(separatrix.read_study("momentum-wheel"))


def signs(friction, **changes):
    """Signs of a run of the wheel with this pocket friction, and the run."""
    both = []
    for chain, kick in ((WHEEL, 0.1), (slower(WHEEL), 0.1 * SLOWER)):
        cage = replace(moving_cage(chain, friction), **changes)
        both.append((chain, cage, simulate(cage, kick=kick, samples=20_000)))
    return rig_signs(*both), both[0]


@pytest.fixture(scope="module")
def whirling():
    """Return signs and run of a wheel whose cage whirls."""
    return signs(0.6)


def test_a_cage_without_friction_leaves_the_torque_to_the_races():
    """No heat of pockets and land: the torque is that of the races, and so is its exponent."""
    found, (chain, *_) = signs(0.0, land_friction=0.0)
    assert found.bearing_torque == chain.bearing.equilibrium.friction_torque
    assert found.torque_exponent == found.race_exponent
    assert found.pocket_share == found.cage_torque == 0.0
    assert found.housing_frequency is None


def test_a_whirl_gives_its_power_to_the_torque(whirling):
    """The share of the pockets and the torque of the cage are those of one balance; nearly all is theirs."""
    found, (chain, cage, history) = whirling
    assert history.outcome is RunOutcome.WHIRLS
    speed = abs(chain.study.operation.inner_speed)
    land = cage.land_friction * history.rubbing_force * history.rubbing_speed
    assert found.cage_torque * speed == pytest.approx(found.pocket_heat + land, rel=1e-12)
    assert found.pocket_share > 0.9
    assert 1.0 < found.torque_exponent < 2.5  # published: "may go as speed squared"
    assert found.race_exponent < 0.7


@pytest.mark.parametrize("whirl", [-1500.0, 900.0])
def test_line_of_a_whirl_in_the_housing(whirling, whirl):
    """A circle of known frequency against the balls, 5 ms: its line is that and their turning."""
    _, (_, cage, history) = whirling
    time = np.linspace(0.0, 5e-3, 2000)
    turn = 2j * math.pi * whirl
    place = 1e-4 * np.exp(turn * time)
    circle = replace(
        history,
        time=time,
        position=np.stack((place.real, place.imag), axis=1),
        velocity=np.stack(((turn * place).real, (turn * place).imag), axis=1),
        judged_from=0.0,
        followed=time[-1],
    )
    seen = abs(whirl + cage.cage_speed / (2.0 * math.pi))
    assert housing_line(cage, circle) == pytest.approx(seen, abs=101.0)  # half a line of 5 ms


def test_a_whirl_has_its_line(whirling):
    """Within the frequencies that the pockets' springs and clearances allow."""
    found, (_, cage, _) = whirling
    assert cage.cage_speed / (2.0 * math.pi) < found.housing_frequency < linear_whirl_frequency(cage)
