"""What a cage has in space beyond what it has in the bearing plane."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from separatrix import _check
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape, edge_level, too_tight_for_edges
from separatrix.study import Guidance
from separatrix.units import (
    Kilogram,
    KilogramMetre2,
    Metre,
    MetrePerSecond,
    MetrePerSecond2,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Radian,
    RadianPerSecond,
    Ratio,
)

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceBody:
    """What a cage has beyond the plane when it moves in space: `PlanarCage.space`.

    The axes are those of the bearing plane, and z along the bearing axis; tilts are small.

    Parameters
    ----------
    transverse_inertia : float
        J_t about a diameter through the centre of mass [kg m2]; a thin ring has half the moment of inertia
        about its axis.
    ball_spin : tuple of float
        Spin of a ball relative to its orbit: along the axis, outward, and along the orbit [rad/s].
    ball_diameter : float
        A pocket touches its ball at half of it from the ball's centre [m].
    friction_lever : float or None
        Distance of the pocket's friction from the pocket's centre [m]; None: half the ball's diameter.
    axial_play : float
        Half the clearance of a pocket along the axis [m]; that of a bore follows from its diameter.
    groove_damping, groove_stiffness : float
        Of a ball that is pushed along its grooves: c_g [N s/m] and k_g [N/m]. An infinite damping holds it.
    pivot_speed : float
        Sliding speed below which pivoting lowers the friction of pockets and of the land [m/s].
    land_heights : tuple of float
        Middle of each land over the plane of the pockets [m].
    land_width : float
        Width of each land [m]; 0 is a line.
    land_radius : float or None
        Where the friction of the land acts [m]; None: the pitch radius, as in the plane.
    inner_radius, outer_radius : float or None
        Of the cage, between which its pockets have walls: their edges may touch the balls [m]. None: no edge.
    axial_gravity : float
        Acceleration along the axis [m/s2].
    dynamic_unbalance : float
        Angle between the axis of the cage and its principal axis [rad], in the plane of the static unbalance.
    added_mass : float
        Of the fluid that moves with the cage across the axis [kg].
    axial_kick, tilt_kick : float
        Share of a run's kick that its start has along the axis, and at the rim by tilting [-].
    is_tilt_held, is_axially_held : bool
        The cage may not tilt, or not move along the axis.

    Raises
    ------
    InputError
        A size is not finite or has the wrong sign.
    """

    transverse_inertia: KilogramMetre2
    ball_spin: Annotated[tuple[RadianPerSecond, ...], ("axis",)]
    ball_diameter: Metre
    friction_lever: Metre | None = None
    axial_play: Metre = math.inf
    groove_damping: NewtonSecondPerMetre = math.inf
    groove_stiffness: NewtonPerMetre = 0.0
    pivot_speed: MetrePerSecond = 0.0
    land_heights: Annotated[tuple[Metre, ...], ("land",)] = (0.0,)
    land_width: Metre = 0.0
    land_radius: Metre | None = None
    inner_radius: Metre | None = None
    outer_radius: Metre | None = None
    axial_gravity: MetrePerSecond2 = 0.0
    dynamic_unbalance: Radian = 0.0
    added_mass: Kilogram = 0.0
    axial_kick: Ratio = 0.0
    tilt_kick: Ratio = 0.0
    is_tilt_held: bool = False
    is_axially_held: bool = False

    def __post_init__(self) -> None:
        _check.settle(
            *(_check.positive(self, name, 1e-18, 1e12) for name in ("transverse_inertia", "ball_diameter")),
            *(_check.between(self, name, 0.0, 1e12) for name in _NOT_NEGATIVE),
            _check.between(self, "axial_gravity", -1e6, 1e6),
            _check.between(self, "dynamic_unbalance", 0.0, 0.1),
            _refused_lengths(self),
            _refused_limits(self),
        )

    @property
    def lever(self) -> Metre:
        """Distance of the pocket's friction from the pocket's centre [m]."""
        return self.ball_diameter / 2.0 if self.friction_lever is None else self.friction_lever

    @property
    def edges(self) -> tuple[Metre, Metre]:
        """Radii between which the pockets have walls; 0 and inf where no edge is [m]."""
        outer = math.inf if self.outer_radius is None else self.outer_radius
        return self.inner_radius or 0.0, outer


_NOT_NEGATIVE = ("groove_stiffness", "pivot_speed", "land_width", "added_mass", "axial_kick", "tilt_kick")


def _refused_lengths(body: SpaceBody) -> Iterator[InputError]:
    """A spin has three parts, and a cage one land or two."""
    if len(body.ball_spin) != 3:
        yield InputError("SpaceBody.ball_spin", "must be three numbers [rad/s]", str(len(body.ball_spin)))
    if len(body.land_heights) not in (1, 2):
        yield InputError("SpaceBody.land_heights", "must be one or two [m]", str(len(body.land_heights)))


def _refused_limits(body: SpaceBody) -> Iterator[InputError]:
    """An infinite damping holds a ball in its groove; flats at an infinite play are none."""
    if not body.groove_damping > 0.0:
        yield _check.problem(body, "groove_damping", "must be > 0")
    if not body.axial_play >= 0.0:
        yield _check.problem(body, "axial_play", "must be >= 0")
    if body.friction_lever is not None:
        yield from _check.between(body, "friction_lever", 0.0, 1e3)
    for name in ("land_radius", "inner_radius", "outer_radius"):
        yield from _check.positive(body, name, 1e-9, 1e3)
    if body.edges[0] >= body.edges[1]:
        yield _check.problem(body, "outer_radius", "must be larger than inner_radius")
    for name, unit in (("ball_spin", "rad/s"), ("land_heights", "m")):
        wrong = [value for value in getattr(body, name) if not math.isfinite(value)]
        if wrong:
            yield InputError(f"SpaceBody.{name}", f"must each be a finite number [{unit}]", str(wrong[0]))


def pocket_plays(cage: PlanarCage, body: SpaceBody) -> tuple[Metre, Metre, Metre]:
    """Play of the round part of a pocket, or of its flats along the orbit; offset; play of flats across [m].

    A bore is round, with flats nowhere; a square pocket has flats only.
    """
    half = cage.pocket_clearance / 2.0
    if cage.pocket_shape is PocketShape.CYLINDRICAL:
        return half, 0.0, math.inf
    if cage.pocket_shape is PocketShape.ELONGATED:
        around = (cage.pocket_axial_clearance or 0.0) / 2.0
        return around, half - around, around
    return half, 0.0, body.axial_play


def wall_margin(cage: PlanarCage, body: SpaceBody) -> Metre:
    """Offset of the cage from which on a ball may touch an edge of its pocket; negative if at rest [m].

    A wall touches a ball at its equator, at the height of the ball's centre, up to half the length of the
    pocket along the orbit.
    """
    half = pocket_half_length(cage, body) + 1.5 * cage.ball_diameter_scatter
    inside = cage.pitch_radius - body.inner_radius if body.inner_radius else math.inf
    return min(edge_level(body.edges[1], half) - cage.pitch_radius, inside)


def pocket_half_length(cage: PlanarCage, body: SpaceBody) -> Metre:
    """Half the length of a pocket along the orbit [m]."""
    return (body.ball_diameter + cage.pocket_clearance) / 2.0


def refused_in_space(cage: PlanarCage) -> Iterator[InputError]:
    """What the motion in space leaves out, and an inertia that no body can have."""
    body = cage.space
    if body is None:
        return
    if cage.moment_of_inertia > 2.0 * body.transverse_inertia * (1.0 + 1e-9):
        rule = f"must be at least half that about the axis, {cage.moment_of_inertia / 2.0:.4g} [kg m2]"
        cure = "A flat ring has half of it, a long one more; no body has less."
        yield _check.problem(body, "transverse_inertia", rule, cure)
    plane_only = 'Give motion = "plane".'
    if cage.hertz_coefficient is not None:
        yield _check.problem(cage, "hertz_coefficient", "has no meaning for a cage in space", plane_only)
    if cage.land_out_of_round != 0.0:
        yield _check.problem(cage, "land_out_of_round", "has no meaning for a cage in space", plane_only)
    if cage.half_play == 0.0 and cage.pocket_shape is not PocketShape.SQUARE:
        cure = "Pockets that grip their balls are square."
        yield _check.problem(cage, "pocket_clearance", "must be > 0 for round pockets in space", cure)
    yield from _refused_edges(cage, body)
    if cage.guidance is not Guidance.BALL and len(body.land_heights) != cage.land_count:
        got = str(len(body.land_heights))
        yield InputError("SpaceBody.land_heights", f"must be {cage.land_count}, as land_count says", got)


def _refused_edges(cage: PlanarCage, body: SpaceBody) -> Iterator[InputError]:
    """A ring that does not hold its balls, and pockets so tight that their edges are not single points."""
    R, h = cage.pitch_radius, body.ball_diameter / 2.0
    least, lost = math.hypot(R - h, pocket_half_length(cage, body)), "A ball would pass its pocket's edge."
    inner, outer = body.edges
    if not outer > least:
        yield _check.problem(body, "outer_radius", f"must be > {least:.4g} [m]", lost)
        return
    if not inner < R + h:
        yield _check.problem(body, "inner_radius", f"must be < {R + h:.4g} [m]", lost)
        return
    yield from too_tight_for_edges(
        cage,
        ball_diameter=body.ball_diameter,
        pitch_radius=R,
        edges=body.edges,
        way=cage.land_gap if cage.guidance is not Guidance.BALL else cage.half_play,
        axial_play=body.axial_play,
    )
