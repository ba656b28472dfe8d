"""What the mobility of a ball is made of: its linear motion, its law of traction."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from separatrix.chain.ball_traction import BallTraction
from separatrix.ground.units import (
    Array,
    Kilogram,
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Radian,
    Ratio,
)


class SlipLaw(Enum):
    """Which slip speed rounds the corner of Coulomb's law in a contact."""

    ELASTIC = "elastic creep"
    """The slip at which elastic creep alone, without spin, would transmit all friction."""

    RIGID = "rigid"
    """A ten-thousandth of a quarter of the speed difference times d_m: rigid bodies, no film."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearMobility:
    """Small motion of the most loaded ball about its steady rolling.

    Modes by rising rate, arrays of shape (mode,): `rates` are those at which they decay, `oscillations` their
    angular frequencies (0 of an overdamped one), `shares` what each adds to the speed of a slow push.
    `damping` holds the slowest mode, the attitude of the spin axis; `damping_relaxed` lets it follow too;
    `damping_locked` holds all spin. `effective_mass` is `damping` over the next rate. A pocket that rubs with
    friction f on the ball it pushes changes the speed by 1 - `pocket_friction_effect` f behind the ball,
    and 1 + in front of it. The groove values are those of the ball centre across its orbit.
    """

    slip_law: SlipLaw  # which slip speed rounds the corner of Coulomb's law
    slip_speed_inner: MetrePerSecond
    slip_speed_outer: MetrePerSecond
    pitch_angle: Radian
    rates: Annotated[Array, "1/s", ("mode",)]
    oscillations: Annotated[Array, "rad/s", ("mode",)]
    shares: Annotated[Array, "-", ("mode",)]
    damping: NewtonSecondPerMetre
    damping_relaxed: NewtonSecondPerMetre  # C_eff, the attitude of the spin axis following too
    damping_locked: NewtonSecondPerMetre  # all spin held
    effective_mass: Kilogram
    pocket_friction_effect: Ratio
    groove_damping: NewtonSecondPerMetre
    groove_stiffness: NewtonPerMetre


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mobility:
    """How the races let the most loaded ball be pushed along its orbit.

    `capacity` is race friction times both loads. F(u) at speeds beyond the free orbit, shape (push,), is
    forward and backward that of the slip fields, the slowest mode held; `force_law` is that of `traction`.
    `law_error` is the largest difference of the law from their mean, `asymmetry` half their largest
    difference, both over the capacity.
    """

    ball: int  # number of the most loaded ball, from 0
    linear: LinearMobility  # small motion about steady rolling
    capacity: Newton
    traction: BallTraction  # law of traction fitted to the forces
    law_error: Ratio
    asymmetry: Ratio
    speed: Annotated[Array, "m/s", ("push",)]  # of the push, beyond the free orbit
    force_forward: Annotated[Array, "N", ("push",)]
    force_backward: Annotated[Array, "N", ("push",)]
    force_law: Annotated[Array, "N", ("push",)]
