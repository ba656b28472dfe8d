"""The cage in the bearing plane: what it is made of, and how a run or an ensemble of it can end."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum, IntEnum
from typing import TYPE_CHECKING

from separatrix import _check
from separatrix.study import Guidance
from separatrix.units import (
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    Metre,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    RadianPerSecond,
    Ratio,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from separatrix.errors import InputError


class RunOutcome(IntEnum):
    """How one run ended."""

    DIES = 0
    GROWS = 1
    DRIFT = 2
    STALLED = 3


OUTCOME_SENTENCES = {
    RunOutcome.DIES: "The motion that the kick started has lost energy.",
    RunOutcome.GROWS: "The motion has more energy than the kick gave it.",
    RunOutcome.DRIFT: "The cage centre left its pockets' play although the energy did not grow.",
    RunOutcome.STALLED: "Too many impacts in no time: the run was ended undecided.",
}


class Verdict(Enum):
    """What an ensemble of runs says of the cage."""

    STABLE = "The cage is stable."
    UNSTABLE = "The cage is unstable."
    UNDECIDED = "The runs do not decide."


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarCage:
    """A cage that moves in the bearing plane among balls which the races hold.

    Parameters
    ----------
    mass, moment_of_inertia : float
        M_C [kg] and J about the bearing axis [kg m2]; a thin ring has J = M R^2.
    ball_count : int
        Z, evenly spaced.
    pitch_radius : float
        R, where balls and pockets meet; the land's friction acts at this radius too [m].
    cage_speed, inner_speed, outer_speed : float
        Omega of the ball set and speeds of the rings [rad/s].
    pocket_clearance : float
        Play of a ball in its pocket along the circumference, stop to stop, 2 c_p [m];
        0 means a pocket that grips its ball from both sides.
    ball_cage_stiffness, race_damping : float
        k_BC [N/m] and C_mu [N s/m], in series; an infinite C_mu is a ball gripped by its races.
    ball_cage_friction : float
        f_BC [-].
    guidance, land_clearance, land_friction, land_stiffness, land_restitution
        The land: diametral clearance [m], friction [-], stiffness [N/m], restitution [-].
    unbalance, gravity : float
        Mass times eccentricity [kg m], and acceleration across the bearing axis, fixed in space [m/s2].

    Raises
    ------
    InputError
        A size is not finite, has the wrong sign, or the land's clearance is missing.
    """

    mass: Kilogram
    moment_of_inertia: KilogramMetre2
    ball_count: int
    pitch_radius: Metre
    cage_speed: RadianPerSecond
    inner_speed: RadianPerSecond
    outer_speed: RadianPerSecond
    pocket_clearance: Metre
    ball_cage_stiffness: NewtonPerMetre
    race_damping: NewtonSecondPerMetre
    ball_cage_friction: Ratio
    guidance: Guidance = Guidance.BALL
    land_clearance: Metre | None = None
    land_friction: Ratio = 0.1
    land_stiffness: NewtonPerMetre = 1e7
    land_restitution: Ratio = 0.5
    unbalance: KilogramMetre = 0.0
    gravity: MetrePerSecond2 = 0.0

    def __post_init__(self) -> None:
        _check.settle(
            *(_check.positive(self, name, 1e-30, 1e12) for name in _POSITIVE),
            *(_check.between(self, name, 0.0, 1e6) for name in _NOT_NEGATIVE),
            *(_check.between(self, name, -1e7, 1e7) for name in ("cage_speed", "inner_speed", "outer_speed")),
            _check.whole(self, "ball_count", 1, 1000),
            _check.between(self, "land_restitution", 0.0, 1.0),
            _refused_damping(self),
            _refused_land(self),
        )

    @property
    def half_play(self) -> Metre:
        """c_p, half the play of a ball in its pocket [m]."""
        return self.pocket_clearance / 2

    @property
    def land_gap(self) -> Metre:
        """Offset of the cage centre at which it touches its land [m]; infinite without a land."""
        if self.guidance is Guidance.BALL or self.land_clearance is None:
            return math.inf
        return self.land_clearance / 2

    @property
    def friction_sense(self) -> int:
        """Sigma of the friction: 1 for inner-race rotation, -1 for outer, 0 if the balls do not spin."""
        return _sign(self.inner_speed - self.outer_speed)

    @property
    def rotation_sense(self) -> int:
        """Sense in which the ball set turns; at rest, of the rings' mean, or of the inner ring."""
        return (
            _sign(self.cage_speed) or _sign(self.inner_speed + self.outer_speed) or self.friction_sense or 1
        )

    @property
    def guiding_ring_speed(self) -> RadianPerSecond:
        """Speed of the ring that carries the land [rad/s]; the cage's own without a land."""
        speeds = {Guidance.INNER: self.inner_speed, Guidance.OUTER: self.outer_speed}
        return speeds.get(self.guidance, self.cage_speed)


def turned_forward(cage: PlanarCage) -> PlanarCage:
    """Return the cage, or its mirror image where its ball set turns backward.

    Motion is chaotic: only runs of the same cage from the same starts agree to the last bit, so a bearing
    that turns the other way is run as its mirror image.
    """
    if cage.rotation_sense > 0:
        return cage
    speeds = ("cage_speed", "inner_speed", "outer_speed")
    return replace(cage, **{name: 0.0 - getattr(cage, name) for name in speeds})


_POSITIVE = ("mass", "moment_of_inertia", "pitch_radius", "ball_cage_stiffness", "land_stiffness")
_NOT_NEGATIVE = ("pocket_clearance", "ball_cage_friction", "land_friction", "unbalance", "gravity")


def _refused_damping(cage: PlanarCage) -> Iterator[InputError]:
    """C_mu must be above zero; it may be infinite, where the races grip the balls (eta = 1)."""
    if cage.race_damping != math.inf:
        yield from _check.positive(cage, "race_damping", 1e-12, 1e12)


def _refused_land(cage: PlanarCage) -> Iterator[InputError]:
    """A guided cage needs a clearance on its land."""
    if cage.guidance is Guidance.BALL:
        return
    cure = 'Give the diametral clearance, or guidance = "ball" for a cage without a land.'
    if cage.land_clearance is None:
        yield _check.problem(cage, "land_clearance", "is missing", cure)
    else:
        yield from _check.positive(cage, "land_clearance", 1e-9, 10.0, hint=cure)


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)
