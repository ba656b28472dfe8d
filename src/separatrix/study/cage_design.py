"""The cage of a study, and the rules that it shares with the moving cage (`cage.moving_cage`)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from typing import Protocol

from separatrix.friction.prediction import FRICTION_LIMIT
from separatrix.ground import bounds as _check
from separatrix.ground.bounds import between, must, not_negative, one_of, positive, whole
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    Radian,
    Ratio,
    format_quantity,
)
from separatrix.study.ball_bearing import Material
from separatrix.study.pocket_shape import Pocket, PocketShape, end_half_play, half_play

SIGMAS = 3.0
"""Standard deviations at which normal scatter is cut."""

LANDLESS = "has no meaning for a cage guided by its balls"
_FULL_TURN = 2.0 * math.pi


class Guidance(Enum):
    """What guides the cage; BALL means it has no land."""

    OUTER = "outer"
    INNER = "inner"
    BALL = "ball"


class ClearanceState(Enum):
    """What the stated clearances are those of: the running bearing, or its parts at 293 K at rest."""

    RUNNING = "as running"
    AT_REST = "at rest, 293 K"


class PocketContact(Enum):
    """How the force between ball and pocket grows: with the approach, or with its power 1.5."""

    LINEAR = "linear"
    HERTZ = "hertz"


class BallModel(Enum):
    """What a ball does that its pocket pushes (docs/theory/cage.md).

    A damper as in the paper; one state, with inertia and saturating traction; free, with its three spins;
    or one state by itself where that is enough, and free balls before a cage is called UNSTABLE.
    """

    DAMPER = "damper"
    TRACTION = "traction"
    FREE = "free"
    AUTO = "auto"


class MotionModel(Enum):
    """Where the cage moves: in the bearing plane as in the paper, or in space."""

    PLANE = "plane"
    SPACE = "space"


class Cage(Pocket, Protocol):
    """A record with pockets and land: `CageDesign`, or `MovingCage`."""

    @property
    def pocket_angles(self) -> tuple[Radian, ...]:
        """Angle of each pocket; empty where they are evenly spaced [rad]."""

    @property
    def pocket_spacing_scatter(self) -> Ratio:
        """Largest random displacement of a pocket with its ball, as a share of the pitch [-]."""

    @property
    def pocket_position_scatter(self) -> Metre:
        """Standard deviation of a pocket's place along the circumference [m]."""

    @property
    def ball_diameter_scatter(self) -> Metre:
        """Standard deviation of the balls' diameters [m]."""

    @property
    def guidance(self) -> Guidance:
        """What guides the cage."""

    @property
    def land_clearance(self) -> Metre | None:
        """Diametral clearance of the land [m]."""

    @property
    def land_out_of_round(self) -> Metre:
        """Amplitude of the land's departure from a circle [m]."""

    @property
    def land_lobes(self) -> int:
        """Lobes of that departure around the land."""


def clearance(record: object, name: str) -> _check.Problems:
    """Zero clearance grips the ball from both sides; one that nobody could measure is a mistake of units."""
    if getattr(record, name) != 0.0:
        hint = "0 is a pocket that grips its ball from both sides."
        yield from not_negative(record, name, 10.0, hint=hint)
        yield from positive(record, name, 1e-9, 10.0, hint=hint)


def rising_angles(record: object, name: str) -> _check.Problems:
    """Angles rise within one turn, so that pocket and ball j are the j-th along the circumference."""
    angles, where = getattr(record, name), f"{type(record).__name__}.{name}"
    wrong = [a for a in angles if not _check.is_number(a) or not -_FULL_TURN <= a <= _FULL_TURN]
    if wrong:
        yield InputError(where, "must each be a finite angle within one turn of 0", f"{wrong[0]!s:.40}")
        return
    falls = [(i, a, b) for i, (a, b) in enumerate(pairwise(angles)) if not a < b]
    if falls:
        i, a, b = falls[0]
        got = f"{format_quantity(b, 'rad')} after {format_quantity(a, 'rad')}"
        yield InputError(where, f"must be strictly increasing (items {i + 1} and {i + 2})", got)
    elif angles and angles[-1] - angles[0] >= _FULL_TURN:
        got = f"{format_quantity(angles[0], 'rad')} to {format_quantity(angles[-1], 'rad')}"
        yield InputError(where, "must lie within one turn: the last less than 360 deg after the first", got)


POCKET_AND_LAND = {
    "pocket_shape": must(one_of, PocketShape),
    "pocket_clearance": must(clearance),
    "pocket_axial_clearance": must(positive, 1e-9, 10.0),
    "pocket_axial_offset": must(between, -10.0, 10.0),
    "pocket_angles": must(rising_angles),
    "pocket_spacing_scatter": must(
        between, 0.0, 0.5, open_high=True, hint="Half a pitch would let neighbours change places."
    ),
    "pocket_position_scatter": must(not_negative, 1.0),
    "ball_diameter_scatter": must(not_negative, 1.0),
    "guidance": must(one_of, Guidance),
    "land_restitution": must(between, 0.0, 1.0),
    "land_count": must(whole, 1, 2, hint="One land, or one on each side of the balls."),
    "land_out_of_round": must(not_negative, 1.0),
    "land_lobes": must(whole, 2, 100, hint="One lobe is an offset centre: give unbalance."),
}
"""Checks of the fields that `CageDesign` and `MovingCage` have alike."""

_SAME = POCKET_AND_LAND


@dataclass(frozen=True, slots=True, kw_only=True)
class CageDesign:
    """The cage: inertia, pockets and guidance."""

    mass: Kilogram | None = field(default=None, metadata=must(positive, 1e-9, 1e4))
    """None: that of its shape, with the density of its material."""

    ball: BallModel = field(default=BallModel.DAMPER, metadata=must(one_of, BallModel))
    motion: MotionModel = field(default=MotionModel.PLANE, metadata=must(one_of, MotionModel))
    inner_diameter: Metre | None = field(default=None, metadata=must(positive, 1e-9, 100.0))
    outer_diameter: Metre | None = field(default=None, metadata=must(positive, 1e-9, 100.0))
    width: Metre | None = field(default=None, metadata=must(positive, 1e-9, 100.0))
    pocket_clearance: Metre = field(metadata=_SAME["pocket_clearance"])
    clearances: ClearanceState = field(default=ClearanceState.RUNNING, metadata=must(one_of, ClearanceState))
    material: Material | None = None
    material_name: str | None = None
    """Candidate of the ranking that the cage is made of; by default the one named like `material`."""

    ball_cage_stiffness: NewtonPerMetre | None = field(default=None, metadata=must(positive, 1.0, 1e12))
    impact_speed: MetrePerSecond | None = field(default=None, metadata=must(positive, 1e-6, 1e3))
    """Speed at which a Hertz pocket's stiffness is taken; by default 2.5 times the pocket speed."""

    ball_cage_friction: Ratio | None = field(default=None, metadata=must(between, 0.0, FRICTION_LIMIT))
    pocket_shape: PocketShape = field(default=PocketShape.SQUARE, metadata=_SAME["pocket_shape"])
    pocket_axial_clearance: Metre | None = field(default=None, metadata=_SAME["pocket_axial_clearance"])
    pocket_axial_offset: Metre = field(default=0.0, metadata=_SAME["pocket_axial_offset"])
    pocket_contact: PocketContact = field(default=PocketContact.LINEAR, metadata=must(one_of, PocketContact))
    pocket_angles: tuple[Radian, ...] = field(default=(), metadata=_SAME["pocket_angles"])
    pocket_spacing_scatter: Ratio = field(default=0.0, metadata=_SAME["pocket_spacing_scatter"])
    pocket_position_scatter: Metre = field(default=0.0, metadata=_SAME["pocket_position_scatter"])
    ball_diameter_scatter: Metre = field(default=0.0, metadata=_SAME["ball_diameter_scatter"])
    guidance: Guidance = field(default=Guidance.BALL, metadata=_SAME["guidance"])
    land_clearance: Metre | None = field(default=None, metadata=must(positive, 1e-9, 1.0))
    land_friction: Ratio = field(default=0.1, metadata=must(between, 0.0, FRICTION_LIMIT))
    land_stiffness: NewtonPerMetre = field(default=1e7, metadata=must(positive, 1.0, 1e12))
    land_restitution: Ratio = field(default=0.5, metadata=_SAME["land_restitution"])
    land_count: int = field(default=1, metadata=_SAME["land_count"])
    land_out_of_round: Metre = field(default=0.0, metadata=_SAME["land_out_of_round"])
    land_lobes: int = field(default=2, metadata=_SAME["land_lobes"])
    moment_of_inertia: KilogramMetre2 | None = field(default=None, metadata=must(positive, 1e-18, 1e4))
    transverse_inertia: KilogramMetre2 | None = field(default=None, metadata=must(positive, 1e-18, 1e4))
    """About a diameter; None: of its shape, or of a thin ring."""

    land_spacing: Metre | None = field(default=None, metadata=must(positive, 1e-9, 10.0))
    """From the middle of one land to that of the other."""

    land_width: Metre = field(default=0.0, metadata=must(not_negative, 10.0))
    land_diameter: Metre | None = field(default=None, metadata=must(positive, 1e-9, 100.0))
    """Where the land's friction acts; None: of its shape, or the pitch diameter."""

    unbalance: KilogramMetre = field(default=0.0, metadata=must(not_negative, 1e2))
    dynamic_unbalance: Radian = field(default=0.0, metadata=must(between, 0.0, 0.1))
    gravity: MetrePerSecond2 = field(default=0.0, metadata=must(not_negative, 1e4))
    axial_gravity: MetrePerSecond2 = field(default=0.0, metadata=must(between, -1e4, 1e4))
    added_mass: Kilogram = field(default=0.0, metadata=must(not_negative, 1e4))
    """Of the fluid that moves with the cage across its axis."""

    def __post_init__(self) -> None:
        _check.settle(_check.each_field(self))
        hertz = self.pocket_contact is PocketContact.HERTZ
        _check.settle(_shape(self), _land(self), _lands(self), *together(self, hertz=hertz))

    @property
    def has_shape(self) -> bool:
        """Whether the ring's diameters and width are given."""
        return None not in (self.inner_diameter, self.outer_diameter, self.width)


def pocket_and_land_fields(cage: Cage) -> Iterator[_check.Problems]:
    """Check each number of the pockets and the land by itself."""
    return (must_pass["check"](cage, name) for name, must_pass in POCKET_AND_LAND.items())


def together(cage: Cage, *, hertz: bool) -> Iterator[_check.Problems]:
    """Check what must be true between fields that are each right."""
    yield _axial_clearance(cage)
    yield _axial_offset(cage)
    if hertz and cage.pocket_clearance == 0.0:
        rule = "must be > 0 with Hertz contact, whose stiffness begins at zero at the first touch"
        cure = "Give the clearance, or linear contact."
        yield iter([_check.problem(cage, "pocket_clearance", rule, cure)])
    yield _scatter_beyond_clearance(cage)
    if cage.pocket_angles and cage.pocket_spacing_scatter != 0.0:
        rule = "and pocket_angles exclude each other"
        yield iter([_check.problem(cage, "pocket_spacing_scatter", rule, "Give one of the two.")])
    yield _lobes_too_high(cage)


def angles_for(cage: Cage, ball_count: int) -> _check.Problems:
    """One angle for each ball, or none at all."""
    if cage.pocket_angles and len(cage.pocket_angles) != ball_count:
        where, got = f"{type(cage).__name__}.pocket_angles", str(len(cage.pocket_angles))
        cure = "Leave it out for evenly spaced pockets."
        yield InputError(where, f"must hold one angle for each of the {ball_count} balls", got, cure)


def least_step(angles: Sequence[Radian]) -> tuple[Radian, int]:
    """Smallest angle from a pocket to the next around the cage, and the number of that pocket."""
    around = [*angles, angles[0] + _FULL_TURN]
    return min((b - a, i) for i, (a, b) in enumerate(pairwise(around)))


def _shape(cage: CageDesign) -> _check.Problems:
    """The shape of the ring is whole or not given; without it the mass is given."""
    sizes = {name: getattr(cage, name) for name in ("inner_diameter", "outer_diameter", "width")}
    missing = [name for name, size in sizes.items() if size is None]
    if 0 < len(missing) < 3:
        yield _check.problem(cage, missing[0], "is missing", f"Give all of {', '.join(sizes)}, or none.")
    if cage.mass is None and missing:
        cure = "Give it, or inner_diameter, outer_diameter and width and a material with its density."
        yield _check.problem(cage, "mass", "is missing", cure)
    if not missing and not (cage.inner_diameter or 0.0) < (cage.outer_diameter or 0.0):
        rule = f"must be larger than inner_diameter, {format_quantity(cage.inner_diameter or 0.0, 'm')}"
        yield _check.problem(cage, "outer_diameter", rule)


def _lands(cage: CageDesign) -> _check.Problems:
    """Two lands in space have a distance, and lands are on the cage."""
    is_guided, spacing = cage.guidance is not Guidance.BALL, cage.land_spacing
    if is_guided and cage.land_count == 1 and spacing is not None:
        rule = "has no meaning for one land"
        yield _check.problem(cage, "land_spacing", rule, "Give it with land_count = 2.")
    if is_guided and cage.land_count == 2 and spacing is None and cage.motion is MotionModel.SPACE:
        yield _check.problem(cage, "land_spacing", "is missing: two lands of a cage in space have a distance")
    if cage.land_count == 2 and spacing is not None and spacing < cage.land_width:
        rule = f"must be at least a land's width, {format_quantity(cage.land_width, 'm')}"
        yield _check.problem(cage, "land_spacing", rule, "It is the distance of the lands' middles.")
    reach = (spacing or 0.0) + cage.land_width
    if cage.width is not None and reach > cage.width:
        rule = f"and the lands' distance, {format_quantity(reach, 'm')} together, must stay on the cage"
        got = f"width {format_quantity(cage.width, 'm')}"
        yield InputError("CageDesign.land_width", rule, got)


def _land(cage: CageDesign) -> _check.Problems:
    """A land needs its clearance, and a cage guided by its balls has no land."""
    if cage.guidance is not Guidance.BALL:
        if cage.land_clearance is None:
            rule = f"is missing: a cage with {cage.guidance.value} guidance needs its diametral clearance"
            yield InputError("CageDesign.land_clearance", rule)
        return
    cures = {"land_clearance": 'Give guidance = "outer" or "inner", or leave the land out.'}
    for name, without in (("land_clearance", None), ("land_out_of_round", 0.0), ("land_count", 1)):
        if getattr(cage, name) != without:
            yield _check.problem(cage, name, LANDLESS, cures.get(name, ""))


def _axial_clearance(cage: Cage) -> _check.Problems:
    """An elongated pocket has a clearance of its own along the axis, smaller than the circumferential one."""
    elongated, name = cage.pocket_shape is PocketShape.ELONGATED, "pocket_axial_clearance"
    if not elongated and cage.pocket_axial_clearance is not None:
        rule = f"has no meaning for a {cage.pocket_shape.value} pocket"
        yield _check.problem(cage, name, rule, 'Give pocket_shape = "elongated", or leave it out.')
    if elongated and cage.pocket_axial_clearance is None:
        rule, cure = (
            "is missing: an elongated pocket needs it",
            "Give the clearance along the bearing axis, stop to stop.",
        )
        yield InputError(f"{type(cage).__name__}.{name}", rule, cure=cure)
    if elongated and (cage.pocket_axial_clearance or 0.0) > cage.pocket_clearance:
        most = format_quantity(cage.pocket_clearance, "m")
        rule = f"must be at most pocket_clearance, {most}: the slot lies along the circumference"
        cure = 'A slot along the axis meets its balls on flat walls: pocket_shape = "square".'
        yield _check.problem(cage, name, rule, cure)


def _axial_offset(cage: Cage) -> _check.Problems:
    """The offset is less than the pockets allow; a square pocket does not notice it."""
    if cage.pocket_axial_offset == 0.0:
        return
    if cage.pocket_shape is PocketShape.SQUARE:
        cure = 'Give pocket_shape = "cylindrical" or "elongated", or leave it out.'
        yield _check.problem(cage, "pocket_axial_offset", "changes nothing in a square pocket", cure)
    elif abs(cage.pocket_axial_offset) >= (play := end_half_play(cage)):
        rule = f"must be smaller than half the clearance along the axis, {format_quantity(play, 'm')}"
        cure = "Farther out the pockets would carry the cage by their ends."
        yield _check.problem(cage, "pocket_axial_offset", rule, cure)


def _scatter_beyond_clearance(cage: Cage) -> _check.Problems:
    """The thickest ball in the most displaced pocket still has clearance."""
    position, radius = cage.pocket_position_scatter, cage.ball_diameter_scatter / 2.0
    taken = SIGMAS * (radius + position)
    if taken == 0.0 or [*_axial_clearance(cage), *_axial_offset(cage)] or taken < half_play(cage):
        return
    rule = (
        f"leaves no clearance: {SIGMAS:g} standard deviations of position and of half the diameter together, "
        f"{format_quantity(taken, 'm')}, must be smaller than half the clearance, "
        f"{format_quantity(half_play(cage), 'm')}"
    )
    name = "pocket_position_scatter" if position >= radius else "ball_diameter_scatter"
    yield _check.problem(cage, name, rule)


def _lobes_too_high(cage: Cage) -> _check.Problems:
    """Beyond n^2 a = c_g the touching point is no longer where the first order in a/c_g puts it."""
    if cage.land_clearance is None or cage.guidance is Guidance.BALL:
        return
    most = cage.land_clearance / 2.0 / cage.land_lobes**2
    if cage.land_out_of_round >= most:
        rule = (
            f"must be smaller than half the land's clearance over the square of land_lobes, "
            f"{format_quantity(most, 'm')}: beyond it a lobe touches elsewhere than this model puts it"
        )
        yield _check.problem(cage, "land_out_of_round", rule, "It is an amplitude: half of high less low.")
