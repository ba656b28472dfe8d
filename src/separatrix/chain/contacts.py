"""First links of the chain: the bearing's equilibrium, the contacts of its most loaded ball, their traction.

Each is dear to solve, and is remembered by the value of the records that it depends on. Where the contacts
leave what races bear and what the model holds, sentences say so.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import TypeVar

import numpy as np

from separatrix.chain.clearances import Clearances
from separatrix.chain.creep import Creep, contact_creep
from separatrix.chain.equilibrium import Equilibrium, contact, equilibrium
from separatrix.chain.exact import RaceSlope
from separatrix.chain.grooved_ball import LEAST_SHARE
from separatrix.chain.hertz import ContactEllipse
from separatrix.chain.impact_restitution import contact_damping
from separatrix.chain.orbit import mean_speed
from separatrix.chain.race_curve import RaceTrack, race_curve, race_slope
from separatrix.chain.traction_curve import TractionCurve
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    MetrePerSecond,
    Newton,
    NewtonSecondPerMetre,
    Pascal,
    Radian,
    RadianPerSecond,
    Ratio,
    format_quantity,
)
from separatrix.study.study import (
    BallBearing,
    Film,
    KinematicModel,
    Operation,
    Race,
    Study,
    TractionModel,
    TractionSettings,
)

REMEMBERED = 1024
"""Solutions of a stage that are kept, by the records it takes."""

Solved = TypeVar("Solved", Equilibrium, TractionCurve)
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceContact:
    """Contact of the most loaded ball with one race."""

    ball: int  # number of the ball, from 0
    contact_angle: Radian  # under load
    load: Newton  # normal to the contact
    ellipse: ContactEllipse  # by Hertz, without films
    creep: Creep  # what the kinematics fix of it
    spin_roll_ratio: Ratio  # pivoting over rolling speed of ball relative to race, signed
    rolling_speed: MetrePerSecond  # mean speed of both surfaces through the contact


@dataclass(frozen=True, slots=True, kw_only=True)
class BearingState:
    """Equilibrium of the bearing, the contacts of its most loaded ball, and where they leave their model."""

    equilibrium: Equilibrium  # loads, angles and speeds of every ball
    inner: RaceContact  # the most loaded ball on the inner race
    outer: RaceContact  # the most loaded ball on the outer race
    notes: tuple[str, ...] = ()  # where a contact leaves the range of its model, a sentence each
    clearances: Clearances | None = None
    """Of the cage as it runs; only in the answer of `bearing`."""

    @property
    def cage_speed(self) -> RadianPerSecond:
        """Mean orbital speed of the balls [rad/s]."""
        return mean_speed(self.equilibrium.orbital_speed)

    def dampings(
        self, inner_slope: Ratio, outer_slope: Ratio
    ) -> tuple[NewtonSecondPerMetre, NewtonSecondPerMetre]:
        """Shares of the inner and the outer race in C_mu, from the slopes of their traction curves."""
        inner, outer = self.inner, self.outer
        return (
            contact_damping(inner_slope, inner.load, inner.rolling_speed),
            contact_damping(outer_slope, outer.load, outer.rolling_speed),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceTraction:
    """Traction curves of the most loaded ball's contacts."""

    inner: TractionCurve
    outer: TractionCurve

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the contacts leave the range of their model, a sentence each."""
        return (*self.inner.notes, *self.outer.notes)


@lru_cache(maxsize=REMEMBERED)
def bearing_state(
    bearing: BallBearing, operation: Operation, kinematics: KinematicModel, race_friction: Ratio
) -> BearingState:
    """Equilibrium and contacts of a bearing, remembered by the value of these records."""
    found = _unchangeable(equilibrium(bearing, operation, kinematics, race_friction))
    inner, outer = (_race_contact(bearing, found, race) for race in Race)
    ellipses = {Race.INNER: inner.ellipse, Race.OUTER: outer.ellipse}
    turns = operation.inner_speed != 0.0 or operation.outer_speed != 0.0
    notes = tuple(beyond_contacts(bearing, found, ellipses, turns=turns))
    return BearingState(equilibrium=found, inner=inner, outer=outer, notes=notes)


def _race_contact(bearing: BallBearing, found: Equilibrium, race: Race) -> RaceContact:
    ball = found.most_loaded

    def of_ball(quantity: str) -> float:
        return float(getattr(found, f"{quantity}_{race.value}")[ball])

    angle, ratio = of_ball("contact_angle"), of_ball("spin_roll_ratio")
    return RaceContact(
        ball=ball,
        contact_angle=angle,
        load=of_ball("load"),
        ellipse=contact(found, bearing, race, ball),
        creep=contact_creep(bearing, race, angle, ratio),
        spin_roll_ratio=ratio,
        rolling_speed=of_ball("rolling_speed"),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceSlopes:
    """Slopes of the traction curves at free rolling, with their errors and offsets."""

    inner: TractionCurve | RaceSlope
    outer: TractionCurve | RaceSlope

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the contacts leave the range of their model, a sentence each."""
        return (*self.inner.notes, *self.outer.notes)


@lru_cache(maxsize=REMEMBERED)
def race_traction(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
) -> RaceTraction:
    """Traction curves of both races, remembered by the value of these records."""
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    inner, outer = of_both_races(lambda track: race_curve(track, settings), race_tracks(bearing, film, state))
    return RaceTraction(inner=_unchangeable(inner), outer=_unchangeable(outer))


@lru_cache(maxsize=REMEMBERED)
def race_slopes(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
) -> RaceSlopes:
    """Slopes of both races, remembered by the value of these records; the exact contact needs no curve."""
    if settings.model is TractionModel.STRIPS:
        curves = race_traction(bearing, operation, kinematics, film, settings)
        return RaceSlopes(inner=curves.inner, outer=curves.outer)
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    inner, outer = of_both_races(lambda track: race_slope(track, settings), race_tracks(bearing, film, state))
    return RaceSlopes(inner=inner, outer=outer)


def race_tracks(bearing: BallBearing, film: Film, state: BearingState) -> tuple[RaceTrack, RaceTrack]:
    """What rolls on what at the inner and at the outer race."""
    ball, ring = bearing.ball_material, bearing.ring_material
    inner, outer = (
        RaceTrack(ellipse=at.ellipse, creep=at.creep, race=race, ball=ball, ring=ring, film=film)
        for race, at in ((Race.INNER, state.inner), (Race.OUTER, state.outer))
    )
    return inner, outer


def of_both_races(
    compute: Callable[[RaceTrack], Result], tracks: tuple[RaceTrack, RaceTrack]
) -> tuple[Result, Result]:
    """Compute something of the inner and of the outer race, side by side."""
    with ThreadPoolExecutor(2) as pool:
        inner, outer = pool.map(compute, tracks)
    return inner, outer


def _unchangeable(solved: Solved) -> Solved:
    """The same record, into whose arrays nobody can write: the next caller gets it, too."""
    for value in (getattr(solved, field.name) for field in fields(solved)):
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
    return solved


def require_rolling(study: Study) -> None:
    """Refuse a bearing that does not roll: traction and restitution have no meaning there."""
    if study.operation.inner_speed == study.operation.outer_speed:
        cure = "Without rolling only the verb bearing has an answer."
        raise InputError("[operation] inner_speed", "must differ from outer_speed for traction", cure=cure)
    if study.film.race_friction <= 0.0:
        raise InputError(
            "[film] race_friction",
            "must be > 0 for traction [-]",
            f"{study.film.race_friction:g}",
            "Without friction the races hold no ball.",
        )


STATIC_PRESSURE: Pascal = 4.2e9
"""ISO 76:2006, static load rating of ball bearings: dents of about 1e-4 of a ball diameter."""

SHOULDER: Ratio = 0.2
"""Height of a race's shoulder over the ball diameter: assumed, for a study does not state it."""


def beyond_contacts(
    bearing: BallBearing, found: Equilibrium, ellipses: dict[Race, ContactEllipse], *, turns: bool
) -> Iterator[str]:
    """Sentences, from the equilibrium and the ellipses of the most loaded ball."""
    race, most = max(((r, e.max_pressure) for r, e in ellipses.items()), key=lambda pair: pair[1])
    if most > STATIC_PRESSURE:
        yield (
            f"The contact pressure of {format_quantity(most, 'Pa', 3)} at the {race.value} race exceeds "
            f"{format_quantity(STATIC_PRESSURE, 'Pa', 2)}, the static limit of ISO 76: the races take "
            "permanent dents."
        )
    yield from _over_the_shoulder(bearing, found, ellipses)
    if turns:
        yield from _skidding(found)


def shoulder_angle(bearing: BallBearing, race: Race) -> Radian:
    """Angle from the bottom of a groove to its shoulder of assumed height."""
    inner = race is Race.INNER
    conformity = bearing.inner_conformity if inner else bearing.outer_conformity
    return math.acos(1.0 - SHOULDER / conformity)


def _over_the_shoulder(
    bearing: BallBearing, found: Equilibrium, ellipses: dict[Race, ContactEllipse]
) -> Iterator[str]:
    """The far end of the most loaded ball's ellipse, as an angle on the ball, against the shoulder."""
    ends = {}
    for race, ellipse in ellipses.items():
        angle = abs(float(getattr(found, f"contact_angle_{race.value}")[found.most_loaded]))
        ends[race] = angle + math.asin(min(2.0 * ellipse.semi_major / bearing.ball_diameter, 1.0))
    race = max(ends, key=lambda r: ends[r] - shoulder_angle(bearing, r))
    limit = shoulder_angle(bearing, race)
    if ends[race] > limit:
        yield (
            f"The contact at the {race.value} race ends {math.degrees(ends[race]):.0f} deg from the bottom "
            f"of its groove, beyond a shoulder at {math.degrees(limit):.0f} deg (assumed height: "
            f"{SHOULDER:g} of the ball diameter): the edge raises the pressure above the computed one."
        )


def _skidding(found: Equilibrium) -> Iterator[str]:
    """Balls that the inner race hardly touches; without race control it turns them as if it did."""
    hardly = found.load_inner < LEAST_SHARE * found.load_outer
    if not hardly.any():
        return
    share, limit = (
        100.0 * float(np.min(found.load_inner[hardly] / found.load_outer[hardly])),
        100 * LEAST_SHARE,
    )
    free = found.model is KinematicModel.FREE
    taken = f"for {limit:g} % of it" if free else "as at the first touch"
    yield (
        f"{hardly.sum()} of {hardly.size} balls are almost unloaded: the inner race carries as little as "
        f"{share:.2g} % of the outer load, below the limit of {limit:g} %. Such balls skid; their speeds are "
        f"computed {taken}."
    )
