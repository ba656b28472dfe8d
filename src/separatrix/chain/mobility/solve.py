"""Mobility of the most loaded ball of a bearing, and restitution of the cage's impacts on it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from separatrix.chain.ball_traction import BallTraction
from separatrix.chain.contacts import bearing_state
from separatrix.chain.mobility.closure import REMEMBERED, held_ball
from separatrix.chain.mobility.field import (
    HeldBall,
    friction_slopes,
    groove,
    pitch_angle,
    pocket_friction_effect,
)
from separatrix.chain.mobility.impact import TOLERANCE, follow_impact, law_returns, linear_return
from separatrix.chain.mobility.law import fitted_law
from separatrix.chain.mobility.modes import Modes, mobility_at, modes, step_damping
from separatrix.chain.mobility.push import CURVE, pushed
from separatrix.chain.mobility.record import Impacts, LinearMobility, Mobility, SlipLaw
from separatrix.chain.restitution import damping_ratio, restitution_factor
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, Kilogram, MetrePerSecond, NewtonPerMetre, NewtonSecondPerMetre
from separatrix.study.study import BallBearing, Film, KinematicModel, Operation, TractionSettings

GENTLE, HARD, IMPACTS = 0.03, 8.0, 12
"""Speeds of impacts: from 0.03 to 8 times that at which a held ball would be pushed with its capacity."""

INSTANTS, FREQUENCIES = 61, 61


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
    instant = np.geomspace(0.5 / abs(found.rates[-1]), 10.0 / abs(found.rates[0]), INSTANTS)
    frequency = np.geomspace(0.02 * abs(found.rates[0]), abs(found.rates[-1]), FREQUENCIES) / (2.0 * np.pi)
    response = mobility_at(found, frequency)
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
        instant=instant,
        step_damping=step_damping(found, instant),
        frequency=frequency,
        mobility=np.abs(response),
        damping_at_frequency=1.0 / response.real,
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


def impacts(
    ball: HeldBall,
    law: BallTraction,
    *,
    felt_mass: Kilogram,
    cage_mass: Kilogram,
    ball_cage_stiffness: NewtonPerMetre,
    race_damping: NewtonSecondPerMetre,
    speeds: Array | None = None,
) -> Impacts:
    """Restitution of impacts of the cage on a held ball against their speed.

    Parameters
    ----------
    ball : HeldBall
        From `held_ball`.
    law : BallTraction
        Its law of traction, for `restitution_law`.
    felt_mass, cage_mass : float
        Mass that an impact feels, and the whole mass, of which the paper's factor is made [kg].
    ball_cage_stiffness : float
        Spring of the pocket [N/m].
    race_damping : float
        C_mu of the paper's factor [N s/m].
    speeds : array, optional
        Speeds of the impacts, shape (impact,) [m/s].
    """
    k, m = ball_cage_stiffness, felt_mass
    if speeds is None:
        speeds = ball.capacity / np.sqrt(k * m) * np.geomspace(GENTLE, HARD, IMPACTS)
    rows = np.array([[_one(ball, m, k, float(v), sense) for v in speeds] for sense in (1.0, -1.0)])
    found = modes(friction_slopes(ball), ball.masses)
    return Impacts(
        felt_mass=m,
        ball_cage_stiffness=k,
        nominal_restitution_factor=restitution_factor(damping_ratio(k, cage_mass, race_damping)),
        restitution_summed=restitution_factor(damping_ratio(k, m, race_damping)),
        restitution_linear=linear_return(found, m, k),
        speed=speeds,
        # subtracted, not negated: a cage that stays has 0.0, not -0.0
        restitution_forward=0.0 - rows[0, :, 0] / speeds,
        restitution_backward=0.0 - rows[1, :, 0] / speeds,
        restitution_law=law_returns(law, m, k, speeds),
        peak_force=rows[:, :, 1].max(axis=0),
        duration=rows[:, :, 2].mean(axis=0),
    )


def _one(
    ball: HeldBall, mass: Kilogram, stiffness: NewtonPerMetre, speed: MetrePerSecond, sense: float
) -> tuple[float, float, float]:
    """Speed of the cage after one impact, peak force and duration."""
    end, peak, duration, steps = follow_impact(
        ball.problem,
        ball.rings,
        ball.state,
        ball.slips,
        ball.cells,
        ball.nodes,
        float(mass),
        float(stiffness),
        speed,
        sense,
        TOLERANCE,
    )
    if steps < 0:
        raise ConvergenceError(f"Mobility: an impact at {speed:.3g} m/s does not end.", -steps, duration)
    return end, peak, duration
