"""What rubs where a ball touches its pocket: sliding speed, pressure, and the friction of tests there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from math import acos, acosh, exp, pi, sqrt

import numpy as np

from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.impact_restitution import hertz_coefficient_for
from separatrix.friction.friction_law import Friction
from separatrix.ground.units import (
    Array,
    Kilogram,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    NewtonPerMetre1_5,
    Pascal,
    RadianPerSecond,
    Ratio,
)
from separatrix.study.study import Operation, Study

REFERENCE: Ratio = 2.5
"""Reference disturbance over the pocket speed [-]."""

LEAST_POCKET_SPEED: MetrePerSecond = 0.02
"""Pocket speed of a ball set at rest or a pocket without clearance: the reference is then 0.05 m/s."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PocketConditions:
    """Conditions of the rubbing contact of ball and pocket.

    `slip_speed` is the mean over the balls, between `slip_speed_low` and `slip_speed_high`. The pressures are
    those of the strongest moment of an impact of the whole cage at the impact speed; `pressure` is the mean
    over the contact, two thirds of `max_pressure`.
    """

    slip_speed: MetrePerSecond  # sliding speed of ball on pocket, mean over the balls
    slip_speed_low: MetrePerSecond  # of the slowest ball
    slip_speed_high: MetrePerSecond  # of the fastest ball
    impact_force: Newton  # largest force of the impact
    pressure: Pascal  # mean over the contact at the largest force
    max_pressure: Pascal  # in the middle of the contact at the largest force
    contact_radius: Metre  # at the largest force


def pocket_conditions(
    equilibrium: Equilibrium,
    *,
    ball_diameter: Metre,
    ball_cage_stiffness: NewtonPerMetre,
    cage_mass: Kilogram,
    felt_mass: Kilogram,
    damping_ratio: Ratio,
    impact_speed: MetrePerSecond,
) -> PocketConditions:
    """Sliding speed and pressure of ball on pocket.

    Hertz's contact behind the linear stiffness of the pocket gives the pressure. Stiffness and damping ratio
    belong to the mass of the cage; `felt_mass` is what an impact feels of it where the cage may turn [kg].

    Notes
    -----
    The sliding of the whirl itself is left out: it points across the ball's sliding and changes it little.
    """
    speeds = sliding_speed(equilibrium.ball_spin, ball_diameter)
    K = hertz_coefficient_for(ball_cage_stiffness, cage_mass, impact_speed)
    felt_ratio = damping_ratio * sqrt(felt_mass / cage_mass)
    force = impact_force(felt_mass, ball_cage_stiffness, felt_ratio, impact_speed)
    radius = contact_radius(force, K, ball_diameter)
    mean = force / (pi * radius**2)
    return PocketConditions(
        slip_speed=float(speeds.mean()),
        slip_speed_low=float(speeds.min()),
        slip_speed_high=float(speeds.max()),
        impact_force=force,
        pressure=mean,
        max_pressure=1.5 * mean,
        contact_radius=radius,
    )


def sliding_speed(ball_spin: Array, ball_diameter: Metre) -> Array:
    """Speed of each ball's surface over the pocket at its front and rear pole, shape (ball,) [m/s].

    In the frame that turns with the orbit the cage rests. The pocket is met at D/2 along the orbit, so the
    spin about that direction moves nothing there: v = (D/2) sqrt(Omega_x^2 + Omega_r^2), of spins along the
    bearing axis, outward and along the orbit, shape (ball, 3) [rad/s].
    """
    speed: Array = 0.5 * ball_diameter * np.hypot(ball_spin[:, 0], ball_spin[:, 1])
    return speed


def impact_force(
    mass: Kilogram, stiffness: NewtonPerMetre, damping_ratio: Ratio, speed: MetrePerSecond
) -> Newton:
    r"""Largest force of a mass that runs into a spring and a damper in series.

    The force obeys :math:`F'' + 2 \zeta \omega F' + \omega^2 F = 0`, :math:`F(0) = 0`,
    :math:`F'(0) = k v`, with :math:`\omega^2 = k/M`, :math:`\zeta = \sqrt{kM}/(2C)`. Its first maximum is
    :math:`v \sqrt{kM} \exp(-\zeta \arccos\zeta / \sqrt{1-\zeta^2})`; arcosh and
    :math:`\sqrt{\zeta^2-1}` above 1 (docs/theory/friction.md).
    """
    zeta = damping_ratio
    decay = 1.0
    if abs(zeta - 1.0) >= 1e-6:
        decay = zeta * (acos(zeta) if zeta < 1.0 else acosh(zeta)) / sqrt(abs(1.0 - zeta**2))
    return speed * sqrt(stiffness * mass) * exp(-decay)


def contact_radius(force: Newton, hertz_coefficient: NewtonPerMetre1_5, ball_diameter: Metre) -> Metre:
    r"""Radius of a ball's contact with a flat wall: :math:`a^2 = R \delta`, :math:`F = K \delta^{3/2}`.

    Hertz; Johnson, Contact Mechanics (1985), Eqs 4.22 and 4.23. The mean pressure is :math:`F/(\pi a^2)`.
    """
    approach: float = (force / hertz_coefficient) ** (2.0 / 3.0)
    return sqrt(0.5 * ball_diameter * approach)


def names_of_fluid(study: Study) -> tuple[str, ...]:
    """The fluid as the study writes it, and its other names in the library: tests may have any of them."""
    record = study.fluid
    known = (record["name"], *(record["aliases"] or ())) if record is not None else ()
    return tuple(filter(None, (study.operation.fluid, *known)))


def friction_in_pocket(
    friction: Friction,
    pocket: PocketConditions | None,
    operation: Operation,
    scatter: Ratio,
    media: Sequence[str] = (),
) -> Friction:
    """Friction at the conditions of a pocket, the temperature and the fluid, which may have several names.

    A friction without a law needs no pocket. `scatter` is the standard deviation over mean of an unrepeated
    test [-].
    """
    if friction.law is None or pocket is None:
        return with_scatter(friction, scatter)
    found = friction.law.at(
        slip_speed=pocket.slip_speed or None,
        pressure=pocket.pressure,
        temperature=operation.temperature,
        medium=media or operation.fluid,
    )
    return replace(friction, **asdict(found))


def with_scatter(friction: Friction, scatter: Ratio) -> Friction:
    """Return a friction with the scatter that it states; without any, with that of an unrepeated test."""
    error, deviation = standard_error(friction), friction.standard_deviation
    if error is not None:
        deviation = error if deviation is None else deviation
        return replace(friction, standard_error=error, standard_deviation=deviation)
    assumed = scatter * friction.mean
    return replace(friction, standard_error=assumed, standard_deviation=assumed, assumed_scatter=True)


def standard_error(friction: Friction) -> Ratio | None:
    """Of the mean under the conditions tested; without a count the scatter is taken as it is."""
    error, deviation = friction.standard_error, friction.standard_deviation
    return deviation / sqrt(friction.count or 1) if error is None and deviation is not None else error


def pocket_speed(cage_speed: RadianPerSecond, pocket_clearance: Metre) -> MetrePerSecond:
    """Cage speed times half the pocket clearance, but not below `LEAST_POCKET_SPEED`.

    The cage centre has this speed in space where it is half a pocket clearance off the axis.
    """
    return max(abs(cage_speed) * 0.5 * pocket_clearance, LEAST_POCKET_SPEED)
