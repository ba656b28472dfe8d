"""Rules that the cage of a study and the cage in the plane share: `study` and `cage.planar` ask them."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

from separatrix import _check
from separatrix.errors import InputError
from separatrix.pocket_shape import Pocket, end_half_play, half_play
from separatrix.units import format_quantity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from separatrix.study import Guidance
    from separatrix.units import Metre, Radian, Ratio

SIGMAS = 3.0
"""Normal scatter is cut at so many standard deviations."""

_FULL_TURN = 2.0 * math.pi


class Cage(Pocket, Protocol):
    """A record with pockets and land: `CageDesign`, or `PlanarCage`."""

    @property
    def pocket_angles(self) -> tuple[Radian, ...]:
        """Angle of each pocket; empty where they stand evenly [rad]."""

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
        """Diametral play on the land [m]."""

    @property
    def land_out_of_round(self) -> Metre:
        """Amplitude of the land's departure from a circle [m]."""

    @property
    def land_lobes(self) -> int:
        """Lobes of that departure around the land."""


def pocket_fields(cage: Cage) -> Iterator[_check.Problems]:
    """Each number of the pockets by itself."""
    from separatrix.study import PocketShape

    yield _check.one_of(cage, "pocket_shape", PocketShape)
    yield _clearance(cage)
    yield _check.positive(cage, "pocket_axial_clearance", 1e-9, 10.0)
    yield _check.between(cage, "pocket_axial_offset", -10.0, 10.0)
    yield _angles(cage)
    half = "Half a pitch would let neighbours change places."
    yield _check.between(cage, "pocket_spacing_scatter", 0.0, 0.5, open_high=True, hint=half)
    yield _check.not_negative(cage, "pocket_position_scatter", 1.0)
    yield _check.not_negative(cage, "ball_diameter_scatter", 1.0)


def land_fields(cage: Cage) -> Iterator[_check.Problems]:
    """Each number of the land by itself that both records have alike."""
    from separatrix.study import Guidance

    yield _check.one_of(cage, "guidance", Guidance)
    yield _check.between(cage, "land_restitution", 0.0, 1.0)
    yield _check.whole(cage, "land_count", 1, 2, hint="One land, or one on each side of the balls.")
    yield _check.not_negative(cage, "land_out_of_round", 1.0)
    shift = "One lobe is no out-of-round but an unbalanced centre: give unbalance."
    yield _check.whole(cage, "land_lobes", 2, 100, hint=shift)


def together(cage: Cage, *, hertz: bool) -> Iterator[_check.Problems]:
    """What must hold between fields that are each right."""
    yield _axial_clearance(cage)
    yield _axial_offset(cage)
    yield _gripped_by_hertz(cage, hertz)
    yield _scatter_beyond_play(cage)
    yield _two_spacings(cage)
    yield _lobes_too_high(cage)


def _clearance(cage: Cage) -> _check.Problems:
    """No play grips the ball from both sides; play that no one could measure is a mistake of units."""
    if cage.pocket_clearance != 0.0:
        hint = "0 is a pocket that grips its ball from both sides."
        yield from _check.not_negative(cage, "pocket_clearance", 10.0, hint=hint)
        yield from _check.positive(cage, "pocket_clearance", 1e-9, 10.0, hint=hint)


def _angles(cage: Cage) -> _check.Problems:
    """Angles rise within one turn, so that pocket and ball j are the j-th along the circumference."""
    angles, where = cage.pocket_angles, f"{type(cage).__name__}.pocket_angles"
    wrong = [a for a in angles if not _check.is_number(a) or not -_FULL_TURN <= a <= _FULL_TURN]
    if wrong:
        yield InputError(where, "must each be a finite angle within one turn of 0", f"{wrong[0]!s:.40}")
        return
    falls = [(i, a, b) for i, (a, b) in enumerate(pairwise(angles)) if not a < b]
    if falls:
        i, a, b = falls[0]
        got = f"{_degrees(b)} after {_degrees(a)}"
        yield InputError(where, f"must be strictly increasing (items {i + 1} and {i + 2})", got)
    elif angles and angles[-1] - angles[0] >= _FULL_TURN:
        got = f"{_degrees(angles[0])} to {_degrees(angles[-1])}"
        yield InputError(where, "must lie within one turn: the last less than 360 deg after the first", got)


def angles_for(cage: Cage, ball_count: int) -> _check.Problems:
    """One angle for each ball, or none at all."""
    if cage.pocket_angles and len(cage.pocket_angles) != ball_count:
        where, got = f"{type(cage).__name__}.pocket_angles", str(len(cage.pocket_angles))
        cure = "Leave it out for pockets that stand evenly."
        yield InputError(where, f"must hold one angle for each of the {ball_count} balls", got, cure)


def _axial_clearance(cage: Cage) -> _check.Problems:
    """An elongated pocket has a play of its own along the axis, smaller than that along the circumference."""
    elongated = cage.pocket_shape.value == "elongated"
    if not elongated and cage.pocket_axial_clearance is not None:
        rule = f"has no meaning for a {cage.pocket_shape.value} pocket"
        cure = 'Give pocket_shape = "elongated", or leave it out.'
        yield _check.problem(cage, "pocket_axial_clearance", rule, cure)
    if elongated and cage.pocket_axial_clearance is None:
        where = f"{type(cage).__name__}.pocket_axial_clearance"
        cure = "Give the play along the bearing axis, stop to stop."
        yield InputError(where, "is missing: an elongated pocket needs it", cure=cure)
    if elongated and (cage.pocket_axial_clearance or 0.0) > cage.pocket_clearance:
        most = format_quantity(cage.pocket_clearance, "m")
        rule = f"must be at most pocket_clearance, {most}: the slot lies along the circumference"
        cure = 'A slot along the axis meets its balls on flat walls: pocket_shape = "square".'
        yield _check.problem(cage, "pocket_axial_clearance", rule, cure)


def _axial_offset(cage: Cage) -> _check.Problems:
    """A cage stands off its balls by less than its pockets allow; a square pocket does not notice."""
    if cage.pocket_axial_offset == 0.0:
        return
    if cage.pocket_shape.value == "square":
        cure = 'Give pocket_shape = "cylindrical" or "elongated", or leave it out.'
        yield _check.problem(cage, "pocket_axial_offset", "changes nothing in a square pocket", cure)
    elif abs(cage.pocket_axial_offset) >= end_half_play(cage):
        rule = (
            f"must be smaller than half the play along the axis, {format_quantity(end_half_play(cage), 'm')}"
        )
        cure = "Farther out the pockets would carry the cage by their ends."
        yield _check.problem(cage, "pocket_axial_offset", rule, cure)


def _gripped_by_hertz(cage: Cage, hertz: bool) -> _check.Problems:
    """Hertz's law needs a first touch: without play its stiffness there would be zero."""
    if hertz and cage.pocket_clearance == 0.0:
        rule = "must be > 0 with Hertz contact, whose stiffness begins at zero at the first touch"
        yield _check.problem(cage, "pocket_clearance", rule, "Give the play, or linear contact.")


def _scatter_beyond_play(cage: Cage) -> _check.Problems:
    """The thickest ball in the most displaced pocket still has play."""
    taken = SIGMAS * (cage.ball_diameter_scatter / 2.0 + cage.pocket_position_scatter)
    if taken == 0.0 or not _play_is_known(cage) or taken < half_play(cage):
        return
    larger = cage.pocket_position_scatter >= cage.ball_diameter_scatter / 2.0
    field = "pocket_position_scatter" if larger else "ball_diameter_scatter"
    most = format_quantity(half_play(cage), "m")
    rule = (
        f"leaves no play: {SIGMAS:g} standard deviations of position and of half the diameter together, "
        f"{format_quantity(taken, 'm')}, must be smaller than half the play, {most}"
    )
    yield _check.problem(cage, field, rule)


def _play_is_known(cage: Cage) -> bool:
    """Whether the rules on shape and offset hold, so that `half_play` exists."""
    return not any(True for rule in (_axial_clearance, _axial_offset) for _ in rule(cage))


def _two_spacings(cage: Cage) -> _check.Problems:
    """Pockets stand where they are said to stand, or are scattered about even places."""
    if cage.pocket_angles and cage.pocket_spacing_scatter != 0.0:
        rule = "and pocket_angles exclude each other"
        yield _check.problem(cage, "pocket_spacing_scatter", rule, "Give one of the two.")


def _lobes_too_high(cage: Cage) -> _check.Problems:
    """Beyond n^2 a = c_g the touching point is no longer where the first order in a/c_g puts it."""
    if cage.land_clearance is None or cage.guidance.value == "ball":
        return
    most = cage.land_clearance / 2.0 / cage.land_lobes**2
    if cage.land_out_of_round >= most:
        rule = (
            f"must be smaller than half the land's clearance over the square of land_lobes, "
            f"{format_quantity(most, 'm')}: beyond it a lobe touches elsewhere than this model puts it"
        )
        yield _check.problem(cage, "land_out_of_round", rule, "It is an amplitude: half of high less low.")


def least_step(angles: Sequence[Radian]) -> tuple[Radian, int]:
    """Smallest angle from a pocket to the next around the cage, and the number of that pocket."""
    around = [*angles, angles[0] + _FULL_TURN]
    return min((b - a, i) for i, (a, b) in enumerate(pairwise(around)))


def _degrees(angle: Radian) -> str:
    return format_quantity(angle, "rad")
