"""First links of the chain: the bearing's equilibrium, the contacts of its most loaded ball, their traction.

Each, and each pair, is dear to solve, and is remembered by the value of the records that it depends on. Where
the contacts leave what races bear and what the model holds, sentences say so.

Two equal bearings may press each other by a preload (docs/theory/equilibrium.md): the external load of the
shaft presses the bearing of the study and relieves the other one. Rigid rings keep their distance, so that
the displacements of both bearings have the same sum at any load and speed; a spring keeps its force on the
other bearing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import NamedTuple, TypeVar

import numpy as np

from separatrix.chain.clearances import Clearances
from separatrix.chain.equilibrium import Equilibrium, contact, equilibrium
from separatrix.chain.grooved_ball import LEAST_SHARE
from separatrix.chain.heat_balance import HeatBalance
from separatrix.chain.hertz import ContactEllipse, Creep, contact_creep
from separatrix.chain.race_traction import SLOPE_ALONE, RaceTrack, contact_traction
from separatrix.chain.traction_curve import TractionCurve
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Array,
    Metre,
    MetrePerSecond,
    Newton,
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
    PreloadKind,
    Race,
    Study,
    TractionSettings,
)

REMEMBERED = 256
"""Pairs that are kept, by the records they are made of."""

FAINT = 1e-6
"""Load over the preload at which a bearing is taken as unloaded: its balls still have a place."""

STRIDE, LEAST_STRIDE = 16.0, 1.001
"""Factor between loads that are tried, and the one at which balls that leave their grooves end the search."""

GAPPED = (
    "The preloaded pair gaps: under this axial_load the other bearing carries nothing, and its balls and "
    "cage are loose. The study is of the bearing that carries the load."
)
GAPS_AT_REST = (
    "At rest this axial_load gaps the preloaded pair: the limit is {}. At speed only the centrifugal force "
    "of its balls loads the other bearing."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PairLoads:
    """Axial loads of a preloaded pair, and the external load that it bears without a gap."""

    preload_kind: PreloadKind  # what keeps the preload
    own_axial_load: Newton  # of the bearing of the study, which the external load presses
    other_axial_load: Newton  # of the other bearing of the pair; 0 if the pair gaps
    ring_offset: Metre
    """Axial displacement of the inner ring of each bearing by the preload at rest."""

    gap_load: Newton | None
    """External axial load at rest at which the other bearing carries nothing; null for a spring, which keeps
    it loaded, and for a pair whose balls leave their grooves first."""

    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@lru_cache(maxsize=REMEMBERED)
def pair_loads(
    bearing: BallBearing, operation: Operation, kinematics: KinematicModel, race_friction: Ratio
) -> PairLoads:
    """Axial loads of both bearings of a pair at speed; the preload is that at rest.

    Raises
    ------
    InputError
        The balls leave their grooves, or the pair loses its preload at speed.
    ConvergenceError
        An equilibrium did not converge.
    """
    preload, external = operation.preload or 0.0, operation.axial_load or 0.0
    turning = with_axial_load(operation, preload)
    still = replace(turning, inner_speed=0.0, outer_speed=0.0)

    def displacement(load: Newton, at: Operation = turning) -> Metre:
        found = equilibrium(bearing, replace(at, axial_load=load), kinematics, race_friction)
        return found.axial_displacement

    offset = displacement(preload, still)
    kind = operation.preload_kind or PreloadKind.RIGID
    other, gap = preload, None
    if kind is PreloadKind.RIGID:
        other = _root(
            lambda load: displacement(load) + displacement(load + external) - 2.0 * offset, FAINT * preload
        )
        with suppress(InputError):
            gap = _root(lambda load: displacement(load, still) - 2.0 * offset, preload)
    if other + external == 0.0:
        rule = "is lost at this speed: the balls press the outer races alone"
        raise InputError("[operation] preload", rule, cure="Raise the preload or lower the speed.")
    notes = [GAPPED] if other == 0.0 else []
    if other > 0.0 and gap is not None and external >= gap:
        notes = [GAPS_AT_REST.format(format_quantity(gap, "N", 3))]
    return PairLoads(
        preload_kind=kind,
        own_axial_load=other + external,
        other_axial_load=other,
        ring_offset=offset,
        gap_load=gap,
        notes=tuple(notes),
    )


def with_axial_load(operation: Operation, load: Newton) -> Operation:
    """The operation of one bearing under this axial load, whatever presses it."""
    return replace(operation, axial_load=load, preload=None, arrangement=None, preload_kind=None)


def _root(excess: Callable[[Newton], float], least: Newton) -> Newton:
    """Load at which a rising function is 0; 0 if it is not below 0 at `least`.

    It is searched upward from there: loads that press balls out of their grooves are refused.
    """
    from scipy.optimize import brentq  # half of the start of a verb that has no pair

    low, stride = least, STRIDE
    if excess(low) >= 0.0:
        return 0.0
    while True:
        try:
            is_above = excess(stride * low) >= 0.0
        except InputError:
            if stride < LEAST_STRIDE:
                raise
            stride = math.sqrt(stride)
            continue
        if is_above:
            return float(brentq(excess, low, stride * low, xtol=1e-3 * least, rtol=1e-12))
        low *= stride


STAGES_REMEMBERED = 1024
"""Solutions of a stage that are kept, by the records it takes."""

Solved = TypeVar("Solved", Equilibrium, TractionCurve)
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceContact:
    """Contact of a ball, the most loaded one if nothing else is said, with one race."""

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

    heat: HeatBalance | None = None
    """With the fluid; only in the answer of `bearing`, without the friction of the cage."""

    pair: PairLoads | None = None
    """Loads of a preloaded pair; only in the answer of `bearing`."""

    @property
    def cage_speed(self) -> RadianPerSecond:
        """Mean orbital speed of the balls [rad/s]."""
        return float(np.mean(self.equilibrium.orbital_speed))


@dataclass(frozen=True, slots=True, kw_only=True)
class RaceTraction:
    """Traction curves of the most loaded ball's contacts."""

    inner: TractionCurve
    outer: TractionCurve

    @property
    def notes(self) -> tuple[str, ...]:
        """Where the contacts leave the range of their model, a sentence each."""
        return (*self.inner.notes, *self.outer.notes)


class Rolling(NamedTuple):
    """What the traction of a bearing depends on; it is remembered by the value of these records."""

    bearing: BallBearing
    operation: Operation
    kinematics: KinematicModel
    film: Film
    settings: TractionSettings
    ball: int | None = None  # whose contacts; None: the most loaded

    @property
    def state(self) -> BearingState:
        """Equilibrium and contacts."""
        return bearing_state(
            self.bearing, self.operation, self.kinematics, self.film.race_friction, self.ball
        )

    @property
    def tracks(self) -> tuple[RaceTrack, RaceTrack]:
        """What rolls on what at the inner and at the outer race."""
        return race_tracks(self.bearing, self.film, self.state)


@lru_cache(maxsize=STAGES_REMEMBERED)
def bearing_state(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    race_friction: Ratio,
    ball: int | None = None,
) -> BearingState:
    """Equilibrium of a bearing and contacts of a ball, by default of the most loaded one.

    Remembered by the value of these records.
    """
    if ball is None:
        found = _unchangeable(equilibrium(bearing, operation, kinematics, race_friction))
        ball = found.most_loaded
    else:
        found = bearing_state(bearing, operation, kinematics, race_friction).equilibrium
    inner, outer = (_race_contact(bearing, found, race, ball) for race in Race)
    turns = operation.inner_speed != 0.0 or operation.outer_speed != 0.0
    notes = tuple(beyond_contacts(bearing, found, (inner, outer), turns=turns))
    return BearingState(equilibrium=found, inner=inner, outer=outer, notes=notes)


def _race_contact(bearing: BallBearing, found: Equilibrium, race: Race, ball: int) -> RaceContact:
    angle, load, ratio, speed = (
        float(getattr(found, f"{name}_{race.value}")[ball])
        for name in ("contact_angle", "load", "spin_roll_ratio", "rolling_speed")
    )
    return RaceContact(
        ball=ball,
        contact_angle=angle,
        load=load,
        ellipse=contact(found, bearing, race, ball),
        creep=contact_creep(bearing, race, angle, ratio),
        spin_roll_ratio=ratio,
        rolling_speed=speed,
    )


@lru_cache(maxsize=STAGES_REMEMBERED)
def race_traction(asked: Rolling, *, whole: bool = True) -> RaceTraction:
    """Traction of both races: curves, or the slopes alone, for which the exact contact needs no curve."""
    increments = None if whole else SLOPE_ALONE
    inner, outer = of_both_races(
        lambda track: contact_traction(track, asked.settings, increments), asked.tracks
    )
    return RaceTraction(inner=_unchangeable(inner), outer=_unchangeable(outer))


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


HIGHEST = 4
ENOUGH: Ratio = 0.9999
"""Share of the variance of those waves at which the others are left out: speeds to 1 % of their spread."""

ALIKE = 1e-9
"""Quantities that differ by less than this share of their mean do not differ: an axial load."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Waves:
    """A quantity of a ball at azimuth p: its mean, and the sum of A_h cos h p + B_h sin h p, h = 1, 2, ...

    Under a radial load or a moment the balls differ in load and contact angle, and so in orbital speed and in
    how the races hold them. Each ball passes every azimuth.
    """

    mean: float
    cosines: tuple[float, ...] = ()  # A_h; none where all balls are alike
    sines: tuple[float, ...] = ()  # B_h
    share: Ratio | None = None  # of the variance between the balls that these harmonics hold, if there is any


def waves_around(values: Array, azimuth: Array) -> Waves:
    """Discrete Fourier transform of a quantity of every ball, at even azimuths, shape (ball,).

    Harmonics up to 4, and below half the balls: what Z balls tell; of these the first ones that hold
    `ENOUGH` of their variance. `share` says how much of the whole is kept.
    """
    mean = float(np.mean(values))
    beyond = values - mean
    if np.max(np.abs(beyond)) <= ALIKE * abs(mean):
        return Waves(mean=mean)
    angles = np.outer(np.arange(1, min(HIGHEST, (azimuth.size - 1) // 2) + 1), azimuth)
    cosines, sines = (2.0 / azimuth.size * (wave(angles) @ beyond) for wave in (np.cos, np.sin))
    power = np.cumsum(cosines**2 + sines**2)
    kept = 1 + int(np.searchsorted(power, ENOUGH * power[-1]))
    share = min(1.0, 0.5 * float(power[kept - 1]) / float(np.mean(beyond**2)))
    return Waves(
        mean=mean, cosines=tuple(cosines[:kept].tolist()), sines=tuple(sines[:kept].tolist()), share=share
    )


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
    bearing: BallBearing, found: Equilibrium, contacts: tuple[RaceContact, RaceContact], *, turns: bool
) -> Iterator[str]:
    """Sentences, from the equilibrium and the contacts of the most loaded ball."""
    races = list(zip(Race, contacts, (bearing.inner_conformity, bearing.outer_conformity), strict=True))
    race, most = max(((race, at.ellipse.max_pressure) for race, at, _ in races), key=lambda pair: pair[1])
    if most > STATIC_PRESSURE:
        yield (
            f"The contact pressure of {format_quantity(most, 'Pa', 3)} at the {race.value} race exceeds "
            f"{format_quantity(STATIC_PRESSURE, 'Pa', 2)}, the static limit of ISO 76: the races take "
            "permanent dents."
        )
    # the far end of the ellipse, as an angle on the ball, against the shoulder
    ends = []
    for race, at, f in races:
        reach = math.asin(min(2.0 * at.ellipse.semi_major / bearing.ball_diameter, 1.0))
        ends.append((race, abs(at.contact_angle) + reach, math.acos(1.0 - SHOULDER / f)))
    race, end, shoulder = max(ends, key=lambda one: one[1] - one[2])
    if end > shoulder:
        yield (
            f"The contact at the {race.value} race ends {math.degrees(end):.3g} deg from the bottom of its "
            f"groove, beyond a shoulder at {math.degrees(shoulder):.3g} deg (assumed height: {SHOULDER:g} of "
            "the ball diameter): the edge raises the pressure above the computed one."
        )
    # balls that the inner race hardly touches; without race control it turns them as if it did
    hardly = found.load_inner < LEAST_SHARE * found.load_outer
    if turns and hardly.any():
        share, limit = 100.0 * np.min(found.load_inner[hardly] / found.load_outer[hardly]), 100 * LEAST_SHARE
        taken = f"for {limit:g} % of it" if found.model is KinematicModel.FREE else "as at the first touch"
        yield (
            f"{hardly.sum()} of {hardly.size} balls are almost unloaded: the inner race carries as little as "
            f"{share:.2g} % of the outer load, below the limit of {limit:g} %. Such balls skid; their speeds "
            f"are computed {taken}."
        )
    free = found.load_inner < found.centrifugal_force
    if found.model is KinematicModel.INNER_RACE_CONTROL and free.any():
        yield (
            f"{free.sum()} of {free.size} balls press the inner race with less than their centrifugal force: "
            "it does not control them alone, and part of the control is computed as of the outer race."
        )
