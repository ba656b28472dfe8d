"""Balls that creep with the force on them, against the same balls stepped with their inertia; and the ledger.

Tolerances: the speed of a creeping ball is early by m_e/C, so that places differ by about the share
sqrt(k m_e)/C of its way, at most 3e-9 m of 1e-4 m here; 1e-9 of the work done.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from space_cages import ROUND, course
from test_cage_space_balance import drawn

from separatrix.ball_traction import BallTraction
from separatrix.cage.space import inputs
from separatrix.study import Guidance

MASS, STIFFNESS = 6e-3, ROUND.ball_cage_stiffness
PLANE = replace(ROUND, pocket_clearance=2e-4, guidance=Guidance.OUTER, land_clearance=5e-4)


def stiff(share, capacity, sharpness=4):
    """Law of races that stop a ball in this share of the time in which its pocket's spring swings it."""
    slope = math.sqrt(STIFFNESS * MASS) / share
    return BallTraction(mass=MASS, slopes=(slope,), speeds=(capacity / slope,), sharpness=sharpness)


def both(monkeypatch, law, **plane):
    """The same run with balls that may creep, and with balls that always have inertia."""
    cage, lead = replace(PLANE, traction=law, **plane), 0.9e-4 * np.sin(np.arange(13.0))
    creeping = course(cage, 1e-3, lead=lead)
    with monkeypatch.context() as patch:
        patch.setattr(inputs, "STIFF", 0.0)
        return creeping, course(cage, 1e-3, lead=lead)


@pytest.mark.parametrize("capacity", [5.0, 60.0, 1e4])
@pytest.mark.parametrize("ramp", [{}, {"ramp_time": 5e-4, "ramp_start": 0.4}])
def test_a_creeping_ball_moves_as_one_with_inertia(ramp, capacity, monkeypatch):
    """Pressed far beyond the capacity, about it, far below: the difference is small and falls with m_e/C."""
    apart = []
    for share in (1.9e-3, 0.475e-3):
        here, there = both(monkeypatch, stiff(share, capacity), **ramp)
        assert here.hits == there.hits > 3
        assert max(here.imbalance, there.imbalance) < 1e-9
        assert here.steps < there.steps
        apart.append(np.abs(here.motion - there.motion).max())
    assert apart[0] < 3e-9
    assert apart[1] < 0.5 * apart[0]


@pytest.mark.parametrize("sharpness", [2, 4])
def test_the_creep_is_that_of_the_law(sharpness, monkeypatch):
    """A ball that a pocket presses has F(u) = N, to the rounding of the law."""
    law = stiff(1e-3, 40.0, sharpness)
    here, _ = both(monkeypatch, law)
    parts, ball = here.parts, here.parts.ball[:, 0]
    pressed = (parts.creeping == 1) & (np.abs(ball[:, 4]) > 0.0)
    assert pressed.any()
    mass = PLANE.mass
    force = ball[pressed, 4] * mass / here.unit**2
    found = law.force(ball[pressed, 1] / here.unit)
    # the state after a step, whose series end at 2^-34 of its speeds; the force rises with a power of speed
    assert found == pytest.approx(force, rel=1e-8)


def test_only_stiff_races_let_a_ball_creep():
    """Not in a turbopump, nor a law of two elements."""
    two = BallTraction(mass=MASS, slopes=(1e5, 1e5), speeds=(1e-4, 1e-3), sharpness=4)
    soft = BallTraction(mass=MASS, slopes=(206.0,), speeds=(0.35,), sharpness=4)
    assert [inputs.slides_from(replace(PLANE, traction=law)) for law in (None, two, soft)] == [0.0] * 3
    assert inputs.slides_from(replace(PLANE, traction=stiff(1e-3, 40.0))) == pytest.approx(36.0)


def test_the_ledger_of_cages_with_creeping_balls_closes():
    """60 random cages with stiff races: no stall, every number finite."""
    rng, slid = np.random.default_rng(60608), 0
    for _ in range(60):
        cage, start = drawn(rng)
        law = stiff(10.0 ** rng.uniform(-4.5, -2.8), 10.0 ** rng.uniform(0.0, 3.0), int(rng.choice([2, 4])))
        there = course(replace(cage, traction=law), 2e-3, samples=3, **start)
        assert there.filled == 3, cage
        assert np.isfinite(there.motion).all(), cage
        assert there.imbalance < 1e-9, (there.imbalance, cage)
        slid += int((there.parts.creeping == 0).sum())
    assert slid > 0
