"""The cage in the bearing plane: what it is made of, and how a run or an ensemble of it can end."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Annotated

from separatrix import _check, cage_design, pocket_shape
from separatrix.ball_traction import BallTraction
from separatrix.cage.space_body import SpaceBody, refused_in_space
from separatrix.errors import InputError
from separatrix.study import Guidance, PocketShape
from separatrix.units import (
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonPerMetre1_5,
    NewtonSecondPerMetre,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
)

if TYPE_CHECKING:
    from collections.abc import Iterator


class RunOutcome(IntEnum):
    """Where the motion of one run ends."""

    SETTLES = 0
    WHIRLS = 1
    DRIFTS = 2
    UNRESOLVED = 3


OUTCOME_SENTENCES = {
    RunOutcome.SETTLES: "The cage comes to rest relative to the ball set, but for what its loads maintain.",
    RunOutcome.WHIRLS: "Friction in the pockets sustains the motion, or makes it grow.",
    RunOutcome.DRIFTS: "The cage has no land, and nothing holds its centre.",
    RunOutcome.UNRESOLVED: "The run does not show where the motion ends.",
}


class Cause(IntEnum):
    """Why a run is unresolved; `LAND_FRICTION`: what keeps one moving that counts as settled."""

    NONE = 0
    IMPACTS = 1
    NO_CONTACT = 2
    FALLING = 3
    NOT_FINITE = 4
    LAND_FRICTION = 5


class Verdict(Enum):
    """What an ensemble of runs says of the cage."""

    STABLE = "The cage is stable."
    UNSTABLE = "The cage is unstable."
    UNDECIDED = "The runs do not decide."


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarCage:
    """A cage that moves in the bearing plane, or with a `space` in space, among balls that the races guide.

    Parameters
    ----------
    mass, moment_of_inertia : float
        M_C [kg] and J about the bearing axis [kg m2]; a thin ring has J = M R^2.
    ball_count : int
        Z; ball j is at 2 pi j/Z unless `pocket_angles` are given.
    pitch_radius : float
        R, where balls and pockets meet; the land's friction acts at this radius too [m].
    cage_speed, inner_speed, outer_speed : float
        Omega of the ball set and speeds of the rings [rad/s].
    pocket_clearance : float
        Clearance of a ball in its pocket along the circumference, stop to stop, 2 c_p [m];
        0 means a pocket that grips its ball from both sides.
    ball_cage_stiffness, race_damping : float
        k_BC [N/m] and C_mu [N s/m], in series; an infinite C_mu is a ball gripped by its races.
    ball_cage_friction : float
        f_BC [-].
    guidance, land_clearance, land_friction, land_stiffness, land_restitution
        The land: diametral clearance [m], friction [-], stiffness [N/m], restitution [-].
    unbalance, gravity : float
        Mass times eccentricity [kg m], and acceleration across the bearing axis, along azimuth 0, fixed in
        space [m/s2].
    pocket_shape, pocket_axial_clearance, pocket_axial_offset
        Shape of the pockets; clearance along the axis, stop to stop, of an elongated one [m]; distance
        of the cage from the plane of the balls, along the bearing axis [m].
    hertz_coefficient : float or None
        K of N = K approach^1.5 [N/m^1.5]; None is linear contact with `ball_cage_stiffness`.
    pocket_angles : tuple of float
        Angle of each ball with its pocket, rising within one turn [rad]; empty is even.
    pocket_spacing_scatter : float
        Each pocket with its ball is displaced by up to this share of the pitch, uniform, run by run [-].
    ball_diameter_scatter, pocket_position_scatter : float
        Standard deviations, normal, cut at 3, run by run [m]; of the position: along the circumference.
    land_count, land_out_of_round, land_lobes
        One land or two with `land_stiffness` each; amplitude [m] and number of lobes of the land of the cage.
    orbital_cosines, orbital_sines : tuple of float
        A_h and B_h, h = 1, 2, ..: a ball at azimuth p runs faster than the ball set by the sum of
        A_h cos h p + B_h sin h p [m/s]; azimuth is fixed in space, 0 along the radial load.
    ramp_time, ramp_start : float
        All speeds rise in proportion to time from this share [-] of their value to it in this time [s]; 0 is
        no ramp.
    traction : BallTraction or None
        Inertia of a ball along its orbit and the traction of its races, in place of `race_damping`; None is
        the paper's ball without mass on a damper.
    space : SpaceBody or None
        What it has beyond the plane when it moves in space; None moves in the plane.

    Raises
    ------
    InputError
        A size is not finite or has the wrong sign, or sizes contradict each other.
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
    pocket_shape: PocketShape = PocketShape.SQUARE
    pocket_axial_clearance: Metre | None = None
    pocket_axial_offset: Metre = 0.0
    hertz_coefficient: NewtonPerMetre1_5 | None = None
    pocket_angles: Annotated[tuple[Radian, ...], ("pocket",)] = ()
    pocket_spacing_scatter: Ratio = 0.0
    ball_diameter_scatter: Metre = 0.0
    pocket_position_scatter: Metre = 0.0
    land_count: int = 1
    land_out_of_round: Metre = 0.0
    land_lobes: int = 2
    orbital_cosines: Annotated[tuple[MetrePerSecond, ...], ("harmonic",)] = ()
    orbital_sines: Annotated[tuple[MetrePerSecond, ...], ("harmonic",)] = ()
    ramp_time: Second = 0.0
    ramp_start: Ratio = 0.1
    traction: BallTraction | None = None
    space: SpaceBody | None = None

    def __post_init__(self) -> None:
        _check.settle(
            *(_check.positive(self, name, 1e-30, 1e12) for name in _POSITIVE),
            *(_check.between(self, name, 0.0, 1e6) for name in _NOT_NEGATIVE),
            *(_check.between(self, name, -1e7, 1e7) for name in ("cage_speed", "inner_speed", "outer_speed")),
            _check.whole(self, "ball_count", 1, 1000),
            _check.positive(self, "hertz_coefficient", 1e-3, 1e18),
            _check.not_negative(self, "ramp_time", 1e4),
            _check.between(self, "ramp_start", 0.0, 1.0, open_low=True),
            *cage_design.pocket_and_land_fields(self),
            _refused_damping(self),
            *(_refused_speeds(self, name) for name in ("orbital_cosines", "orbital_sines")),
        )
        _check.settle(
            _refused_land(self),
            _refused_orbits(self),
            cage_design.angles_for(self, self.ball_count),
            *cage_design.together(self, hertz=self.hertz_coefficient is not None),
            refused_in_space(self),
        )

    @property
    def half_play(self) -> Metre:
        """c_p, half the clearance of a ball along the circumference, after shape and offset [m]."""
        return pocket_shape.half_play(self)

    @property
    def slow_damping(self) -> NewtonSecondPerMetre:
        """Damping of a ball that is pushed slowly: C_mu, or the slope of its law of traction [N s/m]."""
        return self.race_damping if self.traction is None else self.traction.slope

    @property
    def pocket_tilt(self) -> tuple[Ratio, Ratio]:
        """Cosine and sine of psi, the lean of a contact from the circumference to the axis [-]."""
        return pocket_shape.tilt(self)

    @property
    def ball_angles(self) -> tuple[Radian, ...]:
        """Angle of each ball with its pocket, before any scatter [rad]."""
        even = (2.0 * math.pi * j / self.ball_count for j in range(self.ball_count))
        return self.pocket_angles or tuple(even)

    @property
    def lead_amplitude(self) -> Metre:
        """Largest lead or lag of a free ball, from its uneven orbital speed [m]."""
        waves = enumerate(zip(self.orbital_cosines, self.orbital_sines, strict=True), 1)
        parts = [(h, a / (h * self.cage_speed), b / (h * self.cage_speed)) for h, (a, b) in waves]
        turn = (2.0 * math.pi * i / _AROUND for i in range(_AROUND))
        return max(abs(sum(a * math.sin(h * p) - b * math.cos(h * p) for h, a, b in parts)) for p in turn)

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
    that turns the other way is run as its mirror image: azimuth 0 stays where it is, ball j becomes ball -j
    (counted around), and what runs faster at an azimuth runs slower, backward, at the opposite one.
    """
    if cage.rotation_sense > 0:
        return cage
    return replace(
        cage,
        cage_speed=0.0 - cage.cage_speed,
        inner_speed=0.0 - cage.inner_speed,
        outer_speed=0.0 - cage.outer_speed,
        pocket_angles=_mirrored_angles(cage.pocket_angles),
        orbital_cosines=tuple(0.0 - value for value in cage.orbital_cosines),
    )


def _mirrored_angles(angles: tuple[Radian, ...]) -> tuple[Radian, ...]:
    """Ball j of the mirror image is ball -j, counted around: angles change sign, and rise again."""
    return tuple(0.0 - a for a in angles[:1]) + tuple(2.0 * math.pi - a for a in angles[:0:-1])


_POSITIVE = ("mass", "moment_of_inertia", "pitch_radius", "ball_cage_stiffness", "land_stiffness")
_NOT_NEGATIVE = ("ball_cage_friction", "land_friction", "unbalance", "gravity")

_AROUND = 360


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


def _refused_speeds(cage: PlanarCage, field: str) -> Iterator[InputError]:
    """Each orbital speed is a number."""
    wrong = [v for v in getattr(cage, field) if not _check.is_number(v) or not -1e6 <= v <= 1e6]
    if wrong:
        yield InputError(f"PlanarCage.{field}", "must each be a finite number [m/s]", f"{wrong[0]!s:.40}")


def _refused_orbits(cage: PlanarCage) -> Iterator[InputError]:
    """Cosines and sines come in pairs, and only a set that turns brings its balls back to where they were."""
    if len(cage.orbital_cosines) != len(cage.orbital_sines):
        rule = f"must be as many as orbital_cosines, {len(cage.orbital_cosines)}"
        yield InputError("PlanarCage.orbital_sines", rule, str(len(cage.orbital_sines)))
    elif cage.orbital_cosines and cage.cage_speed == 0.0:
        rule = "must be empty for a ball set at rest: its balls would run apart"
        got = str(len(cage.orbital_cosines))
        yield InputError("PlanarCage.orbital_cosines", rule, got, "Give the cage's speed.")


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)
