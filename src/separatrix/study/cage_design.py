"""The cage of a study, the schema of [cage], and the rules that it shares with `cage.moving_cage`.

A cage that is offset from its balls along the bearing axis meets them with another part of its pockets: in
a round one there is less clearance, and the contact leans towards the axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, ClassVar, Protocol, cast

from separatrix.friction.friction_file import FRICTION_LIMIT
from separatrix.ground.reader import Reading
from separatrix.ground.schema import (
    Fault,
    Faults,
    Only,
    Spelled,
    all_or_none,
    between,
    check,
    is_number,
    key,
    keys_of,
    not_negative,
    one_of,
    positive,
    record,
)
from separatrix.ground.toml import KeyPath, folded, text
from separatrix.ground.units import (
    Kilogram,
    KilogramMetre,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Radian,
    Ratio,
    format_quantity,
)
from separatrix.study.ball_bearing import Material
from separatrix.study.uncertain import helper_of, temperature_of


class PocketShape(Spelled):
    """Wall of a pocket, seen along the radius; a spherical one wraps its ball, and so guides the cage."""

    SQUARE = "square"
    CYLINDRICAL = "cylindrical"
    ELONGATED = "elongated"
    SPHERICAL = "spherical"


class Pocket(Protocol):
    """A record with the pocket of a cage: `CageDesign`, or `MovingCage`."""

    @property
    def pocket_shape(self) -> PocketShape:
        """Shape of the pocket's wall, seen along the radius."""

    @property
    def pocket_clearance(self) -> Metre:
        """Clearance along the circumference, stop to stop, of a cage that is level with its balls [m]."""

    @property
    def pocket_axial_clearance(self) -> Metre | None:
        """Play along the bearing axis, stop to stop; of an elongated pocket [m]."""

    @property
    def pocket_axial_offset(self) -> Metre:
        """Distance of the cage from the plane of the balls, along the bearing axis [m]."""


def end_half_play(pocket: Pocket) -> Metre:
    """Half the clearance along the axis, and around a pocket's round end [m]; inf if square."""
    if pocket.pocket_shape is PocketShape.SQUARE:
        return math.inf
    if pocket.pocket_shape is not PocketShape.ELONGATED:
        return pocket.pocket_clearance / 2.0
    return (pocket.pocket_axial_clearance or 0.0) / 2.0


def half_play(pocket: Pocket) -> Metre:
    r"""Half the clearance of a ball along the circumference, :math:`c_p`, after shape and axial offset [m].

    Square: :math:`c`. Bore or sphere: :math:`\sqrt{c^2 - z^2}`. Elongated, with round ends:
    :math:`c - c_a + \sqrt{c_a^2 - z^2}`.
    """
    c, z, c_a = pocket.pocket_clearance / 2.0, pocket.pocket_axial_offset, end_half_play(pocket)
    if z == 0.0 or math.isinf(c_a):
        return c
    return c - c_a + math.sqrt((c_a - z) * (c_a + z))


def tilt(pocket: Pocket) -> tuple[Ratio, Ratio]:
    r"""Cosine and sine of :math:`\psi`, the lean of the contact from the circumference to the axis [-]."""
    z, c_a = pocket.pocket_axial_offset, end_half_play(pocket)
    sine = z / c_a if z != 0.0 else 0.0
    return math.sqrt((1.0 - sine) * (1.0 + sine)), sine


def edge_level(radius: Metre, along: Metre) -> Metre:
    """Height over the axis of the cage of an edge at a radius, at a place along the orbit [m]."""
    return math.sqrt(max(0.0, (radius - along) * (radius + along)))


SIGMAS = 3.0
"""Standard deviations at which normal scatter is cut."""

_FULL_TURN = 2.0 * math.pi


class Guidance(Spelled):
    """What guides the cage; BALL means it has no land."""

    OUTER = "outer"
    INNER = "inner"
    BALL = "ball"


class ClearanceState(Spelled):
    """What the stated clearances are those of: the running bearing, or its parts at 293 K at rest."""

    RUNNING = "as running"
    AT_REST = "at rest, 293 K"


class PocketContact(Spelled):
    """How the force between ball and pocket grows: with the approach, or with its power 1.5."""

    LINEAR = "linear"
    HERTZ = "hertz"


class CageModel(Spelled):
    """Which model answers: the best estimate, "full", or that of the paper, "paper" (docs/theory/cage.md).

    Full: a ball of one state, and free balls before a cage is called UNSTABLE; in space unless the pockets
    are square. Paper: in the plane, among dampers that add up over both races (Eq. 18).
    """

    FULL = "full"
    PAPER = "paper"


class BallModel(Spelled):
    """What a ball does that its pocket pushes (docs/theory/cage.md).

    A damper as in the paper; one state, with inertia and saturating traction; free, with its three spins;
    or one state by itself where that is enough, and free balls before a cage is called UNSTABLE.
    """

    DAMPER = "damper"
    TRACTION = "traction"
    FREE = "free"
    AUTO = "auto"


class MotionModel(Spelled):
    """Where the cage moves: in the bearing plane as in the paper, or in space."""

    PLANE = "plane"
    SPACE = "space"


_SHAPE = "of the ring's shape"
SCALED = "2.5 x cage speed x half the pocket clearance, at least 0.05 m/s"
_PLAY = "0 is a pocket that grips its ball from both sides."
_GUESS = "a guess: give that of your cage"
_LAND = Only(
    "guidance",
    (Guidance.OUTER, Guidance.INNER),
    "without it the balls guide the cage",
    'Give guidance = "outer" or "inner", or leave it out.',
    ignored=True,
)
_ELONGATED = Only(
    "pocket_shape",
    (PocketShape.ELONGATED,),
    "has a meaning only for an elongated pocket",
    'Give pocket_shape = "elongated", or leave it out.',
)
_ROUND = Only(
    "pocket_shape",
    (PocketShape.ELONGATED, PocketShape.CYLINDRICAL, PocketShape.SPHERICAL),
    "changes nothing in a square pocket",
    'Give pocket_shape = "cylindrical", "elongated" or "spherical", or leave it out.',
)


def _read_material(raw: Any, path: KeyPath, reading: Reading) -> Material | None:
    """A material; of a name that of the candidate, else of the library; None if only a candidate has it."""
    helper, one = helper_of(reading), keys_of(CageDesign)["material"]
    if not isinstance(raw, str):
        return cast("Material", helper.named(raw, one, reading) or reading.record(Material, raw, path, one))
    ranking = reading.done.get("ranking")
    known = {folded(c.name): c for c in ranking.candidates} if ranking else {}
    candidate = known.get(folded(text(raw, "")))
    if candidate is not None and (candidate.material or not helper.library.named("cage material", raw)):
        return cast("Material | None", candidate.material)
    if (
        ranking is None
        and "ranking" in reading.document.data
        and not helper.library.named("cage material", raw)
    ):
        return None  # it may be that of a candidate which was refused
    more = f" Candidates are {', '.join(c.name for c in known.values())}." if known else ""
    name = helper.known(raw, "cage material", more)
    return helper.library.material("cage material", name, temperature_of(reading))


POCKET_AND_LAND: dict[str, Callable[..., Any]] = {
    "pocket_axial_clearance": partial(key, positive(1e-9, 10.0), default=None),
    "pocket_axial_offset": partial(key, between(-10.0, 10.0), default=0.0),
    "pocket_spacing_scatter": partial(
        key,
        between(0.0, 0.5, open_high=True),
        default=0.0,
        hint="Half a pitch would let neighbours change places.",
    ),
    "pocket_position_scatter": partial(key, not_negative(1.0), default=0.0),
    "ball_diameter_scatter": partial(key, not_negative(1.0), default=0.0),
    "land_restitution": partial(key, between(0.0, 1.0), default=0.5),
    "land_count": partial(key, between(1, 2), default=1, hint="One land, or one on each side of the balls."),
    "land_out_of_round": partial(key, not_negative(1.0), default=0.0),
    "land_lobes": partial(
        key, between(2, 100), default=2, hint="One lobe is an offset centre: give unbalance."
    ),
}
"""Fields that `CageDesign` and `MovingCage` have alike."""

_SAME = POCKET_AND_LAND


@record
class CageDesign:
    """The cage: inertia, pockets and guidance."""

    RULES: ClassVar = (
        one_of("pocket_angles", "pocket_spacing_scatter"),
        all_or_none("inner_diameter", "outer_diameter", "width"),
    )

    mass: Kilogram | None = key(
        positive(1e-9, 1e4), default=None, example='"25 g"', without="not given: that of the ring's shape"
    )
    """May be left out with the three sizes below and the density of its material."""

    inner_diameter: Metre | None = key(positive(1e-9, 100.0), default=None)
    """Of the ring, around the pitch circle; with all three sizes: mass and inertia."""

    outer_diameter: Metre | None = key(positive(1e-9, 100.0), default=None)
    width: Metre | None = key(positive(1e-9, 100.0), default=None)
    ball_cage_stiffness: NewtonPerMetre | None = key(
        positive(1.0, 1e12),
        default=None,
        example='"3e6 N/m"',
        without="Hertz, ball in pocket, at the impact speed",
    )
    material: Material | None = key(
        default=None, named="cage material", read=_read_material, example='"Armalon"'
    )
    """A candidate of that name gives the friction in the pockets."""

    material_name: str | None = None
    """Candidate of the ranking that the cage is made of; by default the one named like `material`."""

    impact_speed: MetrePerSecond | None = key(positive(1e-6, 1e3), default=None, without=SCALED)
    """Of that stiffness."""

    ball_cage_friction: Ratio | None = key(
        between(0.0, FRICTION_LIMIT), default=None, without="that of its material in [ranking] environment"
    )
    """For simulate and map."""

    pocket_clearance: Metre = key(not_negative(10.0), hint=_PLAY, example='"0.6 mm"')
    """Of a ball in its pocket along the circumference, stop to stop."""

    clearances: ClearanceState = key(default=ClearanceState.RUNNING)
    """What the stated clearances of pockets and land are."""

    pocket_shape: PocketShape = key(default=PocketShape.SQUARE)
    """Flat walls, "square"; a bore, "cylindrical"; a slot along the circumference, "elongated"; a wall that
    wraps its ball, "spherical", with the same clearance along the radius: such pockets guide the cage."""

    pocket_axial_clearance: Metre | None = _SAME["pocket_axial_clearance"](
        only=(_ELONGATED,), without="not given: that of the shape"
    )
    """Along the axis, stop to stop."""

    pocket_axial_offset: Metre = _SAME["pocket_axial_offset"](only=(_ROUND,))
    """Of the cage from the plane of the balls."""

    pocket_contact: PocketContact = key(default=PocketContact.LINEAR)
    """Force in proportion to the approach, "linear", or to its power 1.5, "hertz"."""

    pocket_angles: tuple[Radian, ...] = key(default=(), certain=True, without="evenly spaced")
    """One for each ball, rising."""

    pocket_spacing_scatter: Ratio = _SAME["pocket_spacing_scatter"]()
    """Pockets with their balls displaced by up to this share of a pitch."""

    pocket_position_scatter: Metre = _SAME["pocket_position_scatter"]()
    """Standard deviation of the pockets along the circumference."""

    ball_diameter_scatter: Metre = _SAME["ball_diameter_scatter"]()
    """Standard deviation, ball to ball."""

    balls_at_walls: bool = key(
        default=False, needs=("ball_diameter_scatter", "all balls run alike and none comes to a wall")
    )
    """Whether a run starts with each ball at the wall of its pocket to which its diameter makes it run."""

    guidance: Guidance = key(default=Guidance.BALL, example='"outer"')
    """The land that guides it; "ball" for none."""

    land_clearance: Metre | None = key(
        positive(1e-9, 1.0), default=None, only=(_LAND,), example='"1 mm"', without="not given: no land"
    )
    """Diametral, of the cage on its land."""

    land_friction: Ratio = key(
        between(0.0, FRICTION_LIMIT), default=0.1, only=(_LAND,), without=_GUESS, example="0.1"
    )
    land_stiffness: NewtonPerMetre = key(
        positive(1.0, 1e12), default=1e7, only=(_LAND,), without=_GUESS, example='"1e7 N/m"'
    )
    land_restitution: Ratio = _SAME["land_restitution"](only=(_LAND,), without=_GUESS, example="0.5")
    land_count: int = _SAME["land_count"](only=(_LAND,))
    """1, or 2: one on each side of the balls."""

    land_out_of_round: Metre = _SAME["land_out_of_round"](only=(_LAND,))
    """Amplitude: half of highest less lowest radius."""

    land_lobes: int = _SAME["land_lobes"](only=(_LAND,), needs=("land_out_of_round", "the land is round"))
    moment_of_inertia: KilogramMetre2 | None = key(
        positive(1e-18, 1e4), default=None, without=f"{_SHAPE}, or a thin ring at the pitch diameter"
    )
    """About the axis."""

    model: CageModel = key(default=CageModel.FULL)
    """The best estimate, "full", or that of the "paper"."""

    ball: BallModel | None = key(default=None, without='"auto" in the model "full", "damper" in "paper"')
    """Of a ball: "damper" as in the paper, "traction" with one state, "free" with three spins, or "auto"."""

    motion: MotionModel | None = key(
        default=None,
        without='"plane" in the model "paper" and with square pockets, else "space"',
    )
    """In the "plane" as in the paper, or in "space" with tilt and axial motion."""

    unbalance: KilogramMetre = key(not_negative(1e2), default=0.0)
    """Mass times eccentricity."""

    gravity: MetrePerSecond2 = key(not_negative(1e4), default=0.0)
    """Across the bearing axis."""

    transverse_inertia: KilogramMetre2 | None = key(
        positive(1e-18, 1e4), default=None, without=f"{_SHAPE}, or half that about the axis"
    )
    """About a diameter."""

    land_spacing: Metre | None = key(positive(1e-9, 10.0), default=None, only=(_LAND,))
    """Of two lands, middle to middle."""

    land_width: Metre = key(not_negative(10.0), default=0.0, only=(_LAND,))
    land_diameter: Metre | None = key(
        positive(1e-9, 100.0), default=None, only=(_LAND,), without=f"{_SHAPE}, or the pitch diameter"
    )
    """Where its friction acts."""

    dynamic_unbalance: Radian = key(between(0.0, 0.1), default=0.0)
    """Between the axis of the cage and its principal axis."""

    axial_gravity: MetrePerSecond2 = key(between(-1e4, 1e4), default=0.0)
    added_mass: Kilogram = key(not_negative(1e4), default=0.0)
    """Of the fluid that moves with the cage across its axis."""

    fluid_swirl: Ratio | None = key(
        between(-10.0, 10.0), default=None, needs=("added_mass", "no fluid moves with the cage"),
        without="halfway between the cage and the ring of its land, the outer one without a land",
    )  # fmt: skip
    """Mean speed of that fluid round the axis, over that of the cage."""

    fluid_damping: NewtonSecondPerMetre = key(
        not_negative(1e6), default=0.0, needs=("added_mass", "no fluid moves with the cage")
    )
    """Drag of that fluid on the cage across the axis, over their difference in speed."""

    @property
    def ball_model(self) -> BallModel:
        """Ball that is stated, else that of the model."""
        by_model = BallModel.AUTO if self.model is CageModel.FULL else BallModel.DAMPER
        return self.ball or by_model

    @property
    def motion_model(self) -> MotionModel:
        """Motion that is stated, else that of the model."""
        return self.motion or motion_of(self.model, self.pocket_shape)

    @property
    def is_of_paper(self) -> bool:
        """Whether ball and motion are those of the paper."""
        return (self.ball_model, self.motion_model) == (BallModel.DAMPER, MotionModel.PLANE)

    @property
    def has_shape(self) -> bool:
        """Whether the ring's diameters and width are given."""
        return None not in (self.inner_diameter, self.outer_diameter, self.width)


def motion_of(model: CageModel, pocket_shape: PocketShape) -> MotionModel:
    """Motion of a model: in the plane where the pockets are square, for there space has the same answer."""
    is_flat = model is CageModel.PAPER or pocket_shape is PocketShape.SQUARE
    return MotionModel.PLANE if is_flat else MotionModel.SPACE


def least_step(angles: Sequence[Radian]) -> tuple[Radian, int]:
    """Smallest angle from a pocket to the next around the cage, and the number of that pocket."""
    around = [*angles, angles[0] + _FULL_TURN]
    return min((b - a, i) for i, (a, b) in enumerate(pairwise(around)))


# ---- rules of pockets and lands; those of `SHARED` are also those of a moving cage


def clearance_can_be(pocket_clearance: Metre) -> Faults:
    """Zero clearance grips the ball from both sides; one that nobody could measure is a mistake of units."""
    rule = positive(1e-9, 10.0).rule(pocket_clearance, "m")
    if pocket_clearance != 0.0 and rule:
        yield Fault("pocket_clearance", rule, _PLAY)


def angles_rise(pocket_angles: tuple[Radian, ...]) -> Faults:
    """Angles rise within one turn, so that pocket and ball j are the j-th along the circumference."""
    name, angles = "pocket_angles", pocket_angles
    wrong = [a for a in angles if not is_number(a) or not -_FULL_TURN <= a <= _FULL_TURN]
    if wrong:
        yield Fault(name, "must each be a finite angle within one turn of 0", got=f"{wrong[0]!s:.40}")
        return
    ends = [format_quantity(angle, "rad") for angle in angles]
    if falls := [i for i, (a, b) in enumerate(pairwise(angles)) if not a < b]:
        i = falls[0]
        rule = f"must be strictly increasing (items {i + 1} and {i + 2})"
        yield Fault(name, rule, got=f"{ends[i + 1]} after {ends[i]}")
    elif angles and angles[-1] - angles[0] >= _FULL_TURN:
        rule = "must lie within one turn: the last less than 360 deg after the first"
        yield Fault(name, rule, got=f"{ends[0]} to {ends[-1]}")


def slot_lies_along_the_circumference(
    pocket_shape: PocketShape, pocket_clearance: Metre, pocket_axial_clearance: Metre | None
) -> Faults:
    """An elongated pocket has a clearance of its own along the axis, smaller than the circumferential one."""
    name = "pocket_axial_clearance"
    if pocket_shape is not PocketShape.ELONGATED:
        if pocket_axial_clearance is not None:
            yield Fault(name, f"has no meaning for a {pocket_shape.value} pocket", _ELONGATED.cure)
    elif pocket_axial_clearance is None:
        cure = "Give the clearance along the bearing axis, stop to stop."
        yield Fault(name, "is missing: an elongated pocket needs it", cure, "")
    elif pocket_axial_clearance > pocket_clearance:
        most = format_quantity(pocket_clearance, "m")
        rule = f"must be at most pocket_clearance, {most}: the slot lies along the circumference"
        cure = 'A slot along the axis meets its balls on flat walls: pocket_shape = "square".'
        yield Fault(name, rule, cure)


def offset_stays_in_the_pocket(pocket_axial_offset: Metre, pocket_shape: PocketShape, cage: Pocket) -> Faults:
    """The offset is less than the pockets allow; a square pocket does not notice it."""
    if pocket_axial_offset == 0.0:
        return
    if pocket_shape is PocketShape.SQUARE:
        yield Fault("pocket_axial_offset", _ROUND.reason, _ROUND.cure)
    elif abs(pocket_axial_offset) >= (play := end_half_play(cage)):
        rule = f"must be smaller than half the clearance along the axis, {format_quantity(play, 'm')}"
        yield Fault(
            "pocket_axial_offset", rule, "Farther out the pockets would carry the cage by their ends."
        )


def scatter_stays_in_the_clearance(
    pocket_position_scatter: Metre, ball_diameter_scatter: Metre, cage: Pocket
) -> Faults:
    """The thickest ball in the most displaced pocket still has clearance."""
    position, radius = pocket_position_scatter, ball_diameter_scatter / 2.0
    taken, play = SIGMAS * (radius + position), half_play(cage)
    if taken > 0.0 and not taken < play:
        rule = (
            f"leaves no clearance: {SIGMAS:g} standard deviations of position and of half the diameter "
            f"together, {format_quantity(taken, 'm')}, must be smaller than half the clearance, "
            f"{format_quantity(play, 'm')}"
        )
        yield Fault("pocket_position_scatter" if position >= radius else "ball_diameter_scatter", rule)


def lobes_touch_where_they_are(
    guidance: Guidance, land_clearance: Metre, land_lobes: int, land_out_of_round: Metre
) -> Faults:
    """Beyond n^2 a = c_g the touching point is no longer where the first order in a/c_g puts it."""
    most = land_clearance / 2.0 / land_lobes**2
    if guidance is not Guidance.BALL and land_out_of_round >= most:
        rule = (
            f"must be smaller than half the land's clearance over the square of land_lobes, "
            f"{format_quantity(most, 'm')}: beyond it a lobe touches elsewhere than this model puts it"
        )
        yield Fault("land_out_of_round", rule, "It is an amplitude: half of high less low.")


def share_rules(owner: type) -> None:
    """Give a record the rules that cages have alike."""
    check(owner)(clearance_can_be)
    check(owner)(angles_rise)
    check(owner)(slot_lies_along_the_circumference)
    check(owner, after=(slot_lies_along_the_circumference,))(offset_stays_in_the_pocket)
    before = (slot_lies_along_the_circumference, offset_stays_in_the_pocket)
    check(owner, after=before)(scatter_stays_in_the_clearance)
    check(owner)(lobes_touch_where_they_are)


share_rules(CageDesign)


@check(CageDesign)
def _hertz_needs_a_clearance(pocket_contact: PocketContact, pocket_clearance: Metre) -> Faults:
    if pocket_contact is PocketContact.HERTZ and pocket_clearance == 0.0:
        rule = "must be > 0 with Hertz contact, whose stiffness begins at zero at the first touch"
        yield Fault("pocket_clearance", rule, "Give the clearance, or linear contact.")


@check(CageDesign)
def _mass_or_shape(
    mass: Kilogram | None, inner_diameter: Metre | None, outer_diameter: Metre | None, width: Metre | None
) -> Faults:
    if mass is None and None in (inner_diameter, outer_diameter, width):
        cure = "Give it, or inner_diameter, outer_diameter and width and a material with its density."
        yield Fault("mass", "is missing", cure, "")


@check(CageDesign)
def _ring_has_a_wall(inner_diameter: Metre, outer_diameter: Metre) -> Faults:
    if not inner_diameter < outer_diameter:
        rule = f"must be larger than inner_diameter, {format_quantity(inner_diameter, 'm')}"
        yield Fault("outer_diameter", rule)


@check(CageDesign)
def _land_has_a_clearance(guidance: Guidance, land_clearance: Metre | None) -> Faults:
    if guidance is not Guidance.BALL and land_clearance is None:
        rule = f"is missing: a cage with {guidance.value} guidance needs its diametral clearance"
        yield Fault("land_clearance", rule, got="")


@check(CageDesign)
def _lands_have_a_distance(
    model: CageModel,
    motion: MotionModel | None,
    pocket_shape: PocketShape,
    guidance: Guidance,
    land_count: int,
    land_spacing: Metre | None,
    land_width: Metre,
) -> Faults:
    name, is_guided = "land_spacing", guidance is not Guidance.BALL
    moves_in = motion or motion_of(model, pocket_shape)
    if is_guided and land_count == 1 and land_spacing is not None:
        yield Fault(name, "has no meaning for one land", "Give it with land_count = 2.")
    if is_guided and land_count == 2 and land_spacing is None and moves_in is MotionModel.SPACE:
        yield Fault(name, "is missing: two lands of a cage in space have a distance", got="")
    if land_count == 2 and land_spacing is not None and land_spacing < land_width:
        rule = f"must be at least a land's width, {format_quantity(land_width, 'm')}"
        yield Fault(name, rule, "It is the distance of the lands' middles.")


@check(CageDesign)
def _lands_on_the_cage(land_spacing: Metre | None, land_width: Metre, width: Metre) -> Faults:
    reach = (land_spacing or 0.0) + land_width
    if reach > width:
        rule = f"and the lands' distance, {format_quantity(reach, 'm')} together, must stay on the cage"
        yield Fault("land_width", rule, got=f"width {format_quantity(width, 'm')}")
