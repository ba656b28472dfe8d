"""Mobility of the most loaded ball of a bearing."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from separatrix.chain.contacts import bearing_state
from separatrix.chain.mobility.closure import REMEMBERED, held_ball
from separatrix.chain.mobility.field import (
    HeldBall,
    friction_slopes,
    groove,
    pitch_angle,
    pocket_friction_effect,
)
from separatrix.chain.mobility.law import fitted_law
from separatrix.chain.mobility.modes import Modes, modes
from separatrix.chain.mobility.push import CURVE, pushed
from separatrix.chain.mobility.record import LinearMobility, Mobility, SlipLaw
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, MetrePerSecond
from separatrix.study.study import BallBearing, Film, KinematicModel, Operation, TractionSettings


@lru_cache(maxsize=REMEMBERED)
def mobility(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw = SlipLaw.ELASTIC,
) -> Mobility:
    """Mobility of the most loaded ball along its orbit, remembered by the value of these records.

    Raises
    ------
    InputError
        The ball does not touch both races.
    ConvergenceError
        The friction of both races does not balance at rest or in a push.

    Notes
    -----
    docs/theory/mobility.md. Whole slip fields of both contacts, quasi-steady; contact planes slaved.
    """
    ball = held_ball(bearing, operation, kinematics, film, settings, slip_law)
    found = modes(friction_slopes(ball), ball.masses)
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    speed, forward, backward = _push_curve(ball, found, state.inner.rolling_speed)
    mean = 0.5 * (forward + backward)
    law = fitted_law(speed, mean, slope=found.held, mass=found.mass)
    return Mobility(
        ball=state.inner.ball,
        linear=_linear(ball, found, slip_law),
        capacity=ball.capacity,
        traction=law,
        law_error=float(np.abs(law.force(speed) - mean).max()) / ball.capacity,
        asymmetry=0.5 * float(np.abs(forward - backward).max()) / ball.capacity,
        speed=speed,
        force_forward=forward,
        force_backward=backward,
        force_law=law.force(speed),
    )


def linear_mobility(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw,
) -> LinearMobility:
    """Small motion of the most loaded ball alone."""
    ball = held_ball(bearing, operation, kinematics, film, settings, slip_law)
    return _linear(ball, modes(friction_slopes(ball), ball.masses), slip_law)


def _linear(ball: HeldBall, found: Modes, slip_law: SlipLaw) -> LinearMobility:
    damping, stiffness = groove(ball)
    speed = abs(ball.problem.speed)
    return LinearMobility(
        slip_law=slip_law,
        slip_speed_inner=ball.slips[0] * speed,
        slip_speed_outer=ball.slips[1] * speed,
        pitch_angle=pitch_angle(ball),
        rates=found.rates.real,
        oscillations=np.abs(found.rates.imag),
        shares=found.shares.real * found.relaxed,
        damping=found.held,
        damping_relaxed=found.relaxed,
        damping_locked=found.locked,
        effective_mass=found.mass,
        pocket_friction_effect=pocket_friction_effect(ball),
        groove_damping=damping,
        groove_stiffness=stiffness,
    )


def _push_curve(ball: HeldBall, found: Modes, rolling_speed: MetrePerSecond) -> tuple[Array, Array, Array]:
    """Speeds, forces forward and backward; the curve ends where a push finds no balance beyond the knee."""
    knee = ball.capacity / found.held
    last = min(CURVE.last * knee, CURVE.most * abs(rolling_speed))
    speed = np.geomspace(min(CURVE.first * knee, 0.5 * last), last, CURVE.points)
    forward, backward = pushed(ball, found, speed), -pushed(ball, found, -speed)
    count = min(forward.size, backward.size)
    if speed[count - 1] < min(knee, 0.5 * last):
        message = f"Mobility: a push at {speed[count]:.3g} m/s finds no balance of friction."
        raise ConvergenceError(message, count, speed[count])
    return speed[:count], forward[:count], backward[:count]
