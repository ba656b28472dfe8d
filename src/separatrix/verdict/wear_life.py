r"""Slow time: films and cage wear until the cage becomes unstable.

The film on a track place balances wear and deposit, with the coverage that is left,

.. math:: h' = D - W (1 - e^{-h/h_c}), \qquad \theta = 1 - e^{-h/h_c}, \qquad f_{BT} = \theta f_{film} +
          (1 - \theta) f_{bare}

with :math:`W = K_f\, I\, n` of the passes and the deposit D of what the balls wear off the pockets (Archard,
:math:`K_c \sum N v`). In full sliding a pass takes :math:`K_f \int p\,|v|/V\,dx` of a place y across the
groove: p Hertz's pressure, v the slip of rigid bodies, V the rolling speed. Pockets and land open by what is
worn. Critical friction, and the work of pockets and land of a calm and of a whirling cage, are tabulated over
race friction and pocket clearance; every draw of the wear coefficients and frictions is led along that table.
docs/theory/life.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.special import expit

from separatrix.chain.contacts import BearingState
from separatrix.chain.hertz import deformed_radius, track_area
from separatrix.chain.slip_friction import chebyshev_nodes
from separatrix.ground.errors import InputError, together
from separatrix.ground.units import (
    Array,
    Hertz,
    Metre,
    PerSecond,
    RadianPerSecond,
    Ratio,
    Rows,
    Second,
    SquareMetre,
)
from separatrix.study.film import WearRate, library_rate
from separatrix.study.study import BallBearing, Candidate, Operation, Race, Study, WearRates

RATES = ("wear.film_wear", "wear.cage_wear")

TEST = (
    "Measure the wear of film and cage at the pressure and speed of the bearing and in its medium: worn "
    "volume over load and sliding distance. Then state film_wear, cage_wear and bare_friction."
)

STRIPS = 16
"""Strips across the contact: the largest work of one is 2 % less than with 512 (shipped bearing)."""

ALONG = 32
"""Places along rolling."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackWork:
    """What the passes of the most loaded ball do to the track of one race, by strips across it."""

    across: Annotated[Array, "-", ("strip",)]  # middle of the strip over the semi-axis of the contact
    share: Annotated[Array, "-", ("strip",)]  # of the load that the strip carries
    work: Annotated[Array, "N/m", ("strip",)]  # of a pass on an area, over friction: pressure times slid way
    passes: PerSecond  # balls that pass a place of the ring
    area: SquareMetre  # of the track


def track_work(bearing: BallBearing, operation: Operation, state: BearingState, race: Race) -> TrackWork:
    """Work of the most loaded ball on the track of a race; 0 of a ring that the balls do not pass."""
    inner, found = race is Race.INNER, state.equilibrium
    at = state.inner if inner else state.outer
    D, d_m, a, b = bearing.ball_diameter, bearing.pitch_diameter, at.ellipse.semi_major, at.ellipse.semi_minor
    ring = operation.inner_speed if inner else operation.outer_speed
    orbit, (axial, outward, along) = found.orbital_speed[at.ball], found.ball_spin[at.ball]
    side = -1.0 if inner else 1.0
    n_x, n_r = side * math.sin(at.contact_angle), side * math.cos(at.contact_angle)
    spin = axial - (ring - orbit), outward
    pivoting, rolling = spin[0] * n_x + spin[1] * n_r, spin[0] * n_r - spin[1] * n_x
    edges = np.linspace(-1.0, 1.0, STRIPS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    y, chord = a * middle, b * np.sqrt(1.0 - middle**2)
    conformity = bearing.inner_conformity if inner else bearing.outer_conformity
    radius = deformed_radius(D, conformity)
    height = 0.5 * D - radius + np.sqrt(radius**2 - y**2)
    nodes, weights = chebyshev_nodes(ALONG)  # of a semi-ellipse whose mean is 1
    x = chord[:, None] * nodes
    forward = pivoting * y + rolling * height - 0.5 * (ring - orbit) * d_m
    sideways = along * height[:, None] - pivoting * x
    slip = np.hypot(forward[:, None], sideways) @ weights
    # Hertz's pressure on a line along rolling has the integral p_0 b (1 - y^2/a^2) pi/2
    line = 0.5 * math.pi * at.ellipse.max_pressure * b * (1.0 - middle**2)
    shares = np.diff(0.75 * (edges - edges**3 / 3.0))
    speed = at.rolling_speed
    return TrackWork(
        across=middle,
        share=shares,
        work=line * slip / speed if speed > 0.0 else 0.0 * line,
        passes=bearing.ball_count * abs(ring - orbit) / (2.0 * math.pi),
        area=track_area(bearing, at.ellipse, at.contact_angle, side),
    )


THICKEST: Metre = 3e-6
"""Of a film by transfer: PTFE films of 1 to 3 um, discontinuous (ESTL, 44th AMS 2018, pp. 518-524)."""

STEPS_A_DECADE = 16
"""Of slow time: a step is 15 % of the time before it, far less than the scatter of any wear coefficient."""

HALF: Ratio = 0.5
"""Probability of a whirl from which a cage counts as unstable."""

IN_POCKETS, ON_LANDS = ("calm_sliding", "whirl_sliding"), ("calm_land_sliding", "whirl_land_sliding")
"""Works of the table; those on lands may be none at all, and are taken linearly between its places."""

LEAST: Ratio = 1e-9
LEAST_WEAR = 1e-300


@dataclass(frozen=True, slots=True, kw_only=True)
class LifeTable:
    """Critical friction of the cage, and the work of its pockets, over what wear moves.

    Arrays have shape (race_friction, pocket_clearance). Where no friction that was searched is enough the
    critical friction is the highest that was searched.
    """

    race_friction: Annotated[Array, "-", ("race_friction",)]  # places of the table, rising
    pocket_clearance: Annotated[Array, "m", ("pocket_clearance",)]  # the same, as the study states it
    critical_friction: Annotated[Array, "-", ("race_friction", "pocket_clearance")]  # worst disturbance
    steepness: Annotated[Array, "-", ("race_friction", "pocket_clearance")]
    """Slope of the logit of P(whirl) against the logarithm of friction."""
    calm_sliding: Annotated[Array, "W", ("race_friction", "pocket_clearance")]
    """Force times sliding speed of all pockets of a cage that settles."""
    whirl_sliding: Annotated[Array, "W", ("race_friction", "pocket_clearance")]  # the same of one that whirls
    calm_land_sliding: Annotated[Array, "W", ("race_friction", "pocket_clearance")]
    """Force times sliding speed on the lands of a cage that settles."""
    whirl_land_sliding: Annotated[Array, "W", ("race_friction", "pocket_clearance")]  # of one that whirls
    land_exponent: Ratio  # of the land's clearance, to whose power the critical friction goes
    land_widening: Ratio  # of the land up to which that was computed; 1 where its wear is not followed

    def at(self, race_friction: Array, clearance: Array, widening: Array | float = 1.0) -> dict[str, Array]:
        """What the table holds at these places, linear in logarithms between its own; held at its ends.

        `widening` is the clearance of the land over that of a new one.
        """
        ends = self.pocket_clearance[[0, -1]]
        place = np.stack(
            (
                np.log(np.clip(race_friction, self.race_friction[0], self.race_friction[-1])),
                np.log(np.clip(clearance, *ends)),
            ),
            axis=-1,
        )
        axes = np.log(self.race_friction), np.log(self.pocket_clearance)
        names = ("critical_friction", "steepness", *IN_POCKETS)
        known = [np.log(np.maximum(getattr(self, name), LEAST)) for name in names]
        known += [getattr(self, name) for name in ON_LANDS]
        found = np.moveaxis(RegularGridInterpolator(axes, np.stack(known, axis=-1))(place), -1, 0)
        found[: len(names)] = np.exp(found[: len(names)])
        values = dict(zip((*names, *ON_LANDS), found, strict=True))
        values["critical_friction"] *= np.minimum(widening, self.land_widening) ** self.land_exponent
        return values


class Worn(NamedTuple):
    """Draws of what wear depends on, each of shape (draw,)."""

    film_wear: Array  # K of the film [m3/(N m)]
    cage_wear: Array  # K of the pockets and of the land
    transferred: Array  # share of what is worn off the pockets that stays on tracks and balls
    thickness: Array  # of the film at the start [m]
    coverage: Array  # thickness at which the film covers 63 % [m]
    film_friction: Array  # of ball on a whole film
    bare_friction: Array  # of ball on bare races
    pocket_friction: Array  # at the start
    worn_friction: Array  # of a pocket that is worn deep
    worn_depth: Array  # by which its friction has gone 63 % of the way
    reservoir: Array  # volume worn off the pockets from which on nothing stays, infinite without one [m3]


def wear_rates(study: Study, wear: WearRates, candidate: Candidate | None) -> dict[str, WearRate]:
    """Wear coefficients of film and cage by their keys: those of the study, else of the library.

    Raises
    ------
    InputError
        Neither has one, or the races are bare.
    """
    if study.film.thickness is None:
        raise InputError("[film] thickness", "is missing: bare races have no film that wears")
    own = (candidate and candidate.material) or (study.cage and study.cage.material) or None
    cage = candidate.name if candidate else "the cage"
    asked = (wear.film_wear, study.film.material, "the film"), (wear.cage_wear, own, cage)
    found, problems = dict[str, WearRate](), list[InputError]()
    for key, (given, material, what) in zip(RATES, asked, strict=True):
        rate = library_rate(material) if given is None else WearRate(given)
        if rate is None:
            name = material.name if material is not None and material.record else what
            rule = f"is missing, and the library has no wear coefficient of {name}"
            problems.append(InputError(f"[wear] {key.removeprefix('wear.')}", rule, cure=TEST))
        else:
            found[key] = rate
    if problems:
        raise together(problems)
    return found


class Land(NamedTuple):
    """What wears on the lands of a cage."""

    area: SquareMetre  # of all lands, all around: a worn cage has turned on its ring
    clearance: Metre  # of a new one, diametral


@dataclass(frozen=True, slots=True, kw_only=True)
class BearingWear:
    """What of a bearing wears: its tracks with their loads, its pockets, its land."""

    tracks: tuple[TrackWork, TrackWork]  # of the inner and of the outer race
    loads: tuple[float, float]  # of the most loaded ball on them
    ball_diameter: Metre
    ball_count: int
    clearance: Metre  # of a new pocket
    ball_gap: Metre  # between balls: pockets that have opened to it have no bar between them
    land: Land | None = None  # None without one, or without its width

    @property
    def area(self) -> SquareMetre:
        """Area on which debris of the cage is spread: both tracks and half of every ball."""
        balls = 0.5 * self.ball_count * math.pi * self.ball_diameter**2
        return self.tracks[0].area + self.tracks[1].area + balls


@dataclass(frozen=True, slots=True, kw_only=True)
class Phase:
    """A part of the time that a bearing runs at one speed and load."""

    share: Ratio  # of the time
    bearing: BearingWear
    table: LifeTable


def film_after(thickness: Array, wear: Array, deposit: Array, coverage: Array, time: Second) -> Array:
    """Thickness of films after a time of constant wear (of a whole film) and deposit [m/s]: exact.

    exp(h/h_c) = q + (exp(h_0/h_c) - q) exp(-(W - D) t/h_c) with q = W/(W - D); at W = D it grows by W t/h_c.
    """
    apart = wear - deposit
    is_even = np.abs(apart) <= LEAST * np.maximum(wear, deposit)
    apart = np.where(is_even, 1.0, apart)
    start, q, run = np.exp(np.minimum(thickness / coverage, 700.0)), wear / apart, apart * time / coverage
    # of a film that grows, its growth is taken out of the logarithm
    fall, rise = np.exp(-np.abs(run)), np.maximum(-run, 0.0)
    inside = np.where(apart > 0.0, q + (start - q) * fall, (start - q) + q * fall)
    even = np.log(start + wear * time / coverage)
    found = coverage * np.where(is_even, even, rise + np.log(np.maximum(inside, 1.0)))
    return np.minimum(np.maximum(found, 0.0), np.maximum(THICKEST, thickness))


def worn_depth(volume: Array, ball_diameter: Metre) -> Array:
    """Depth to which a ball has worn its own cap of this volume into a flat wall [m]: V = pi R w^2."""
    return np.sqrt(volume / (math.pi * 0.5 * ball_diameter))


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """States of all draws in slow time; arrays have shape (time, draw)."""

    time: Array  # shape (time,) [s]
    probability_unstable: Array
    race_friction: Array
    pocket_friction: Array
    clearance: Array
    films: tuple[Array, Array]  # mean thickness on the inner and the outer track
    land_clearance: Array  # 0 where its wear is not followed [m]
    volume: Array  # worn off the pockets [m3]
    kept: Array  # deposit over the wear of a whole film, of the track that wears faster [-]
    phase: Array  # which is the most unstable one


def work_done(phases: Sequence[Phase]) -> list[Array]:
    """Work of all passes on an area of a track in a second, mean of the phases, shape (strip,) [W/m2]."""
    parts = [[one.share * at.work * at.passes for at in one.bearing.tracks] for one in phases]
    return [np.sum(each, axis=0) for each in zip(*parts, strict=True)]


def course(phases: Sequence[Phase], worn: Worn, horizon: Second) -> Course:
    """Lead every draw along the tables up to a time, from 0 in steps of equal ratios.

    All phases wear the same places of the tracks, each for its share of every step; a cage is unstable where
    it is in any phase.
    """
    first = min(1.0, 1e-3 * horizon)
    later = np.geomspace(first, horizon, math.ceil(STEPS_A_DECADE * math.log10(horizon / first)) + 1)
    time = np.concatenate(([0.0], later))
    draws, work = worn.film_wear.size, work_done(phases)
    films = [np.repeat(worn.thickness[:, None], each.size, axis=1) for each in work]
    volume, land_volume = np.zeros(draws), np.zeros(draws)
    area = min(one.bearing.area for one in phases)
    hold = worn.coverage[:, None]
    rows: list[list[Array]] = []
    before = 0.0
    for now in time:
        *_, sliding, on_land = _state(phases, worn, films, volume, land_volume)
        step = now - before
        debris = worn.cage_wear * sliding
        deposit = (worn.transferred * debris * (volume < worn.reservoir) / area)[:, None]
        fastest = np.zeros(draws)
        for i, passed in enumerate(work):
            wear = worn.film_wear[:, None] * passed
            films[i] = film_after(films[i], wear, deposit, hold, step)
            fastest = np.maximum(fastest, wear.max(axis=1))
        volume = volume + debris * step
        land_volume = land_volume + worn.cage_wear * on_land * step
        state = _state(phases, worn, films, volume, land_volume)
        kept = np.divide(deposit[:, 0], fastest, out=np.full(draws, math.inf), where=fastest > 0.0)
        rows.append([*state[:5], *(film.mean(axis=1) for film in films), volume, kept, state[5]])
        before = now
    found = [np.stack(each) for each in zip(*rows, strict=True)]
    return Course(
        time=time,
        probability_unstable=found[0],
        race_friction=found[1],
        pocket_friction=found[2],
        clearance=found[3],
        land_clearance=found[4],
        films=(found[5], found[6]),
        volume=found[7],
        kept=found[8],
        phase=found[9].astype(int),
    )


def _state(
    phases: Sequence[Phase], worn: Worn, films: Sequence[Array], volume: Array, land_volume: Array
) -> list[Array]:
    """P(unstable), frictions of race and pocket, both clearances, worst phase, sliding in pocket and land."""
    bearing = phases[0].bearing
    depth = worn_depth(volume / (2.0 * bearing.ball_count), bearing.ball_diameter)
    gone = -np.expm1(-depth / worn.worn_depth)
    pocket = worn.pocket_friction + gone * (worn.worn_friction - worn.pocket_friction)
    clearance = np.minimum(bearing.clearance + 2.0 * depth, bearing.ball_gap)
    land = np.zeros(volume.size)
    if bearing.land:
        land = bearing.land.clearance + 2.0 * land_volume / bearing.land.area
    races, unstable = list[Array](), list[Array]()
    sliding, on_land = np.zeros(volume.size), np.zeros(volume.size)
    for one in phases:
        loads = one.bearing.loads
        race = np.zeros(volume.size)
        for load, track, film in zip(loads, one.bearing.tracks, films, strict=True):
            covered = (-np.expm1(-film / worn.coverage[:, None])) @ track.share
            mixed = covered * worn.film_friction + (1.0 - covered) * worn.bare_friction
            race += load / sum(loads) * mixed
        known = one.table.at(race, clearance, _widening(bearing, land))
        chance = expit(known["steepness"] * np.log(np.maximum(pocket, LEAST) / known["critical_friction"]))
        calm, whirl, calm_land, whirl_land = (known[name] for name in (*IN_POCKETS, *ON_LANDS))
        sliding += one.share * ((1.0 - chance) * calm + chance * whirl)
        on_land += one.share * ((1.0 - chance) * calm_land + chance * whirl_land)
        races.append(race)
        unstable.append(np.where(clearance < bearing.ball_gap, chance, 1.0))
    worst = np.argmax(unstable, axis=0)
    each = np.arange(volume.size)
    chances, frictions = np.array(unstable)[worst, each], np.array(races)[worst, each]
    return [chances, frictions, pocket, clearance, land, worst, sliding, on_land]


def _widening(bearing: BearingWear, land: Array) -> Array:
    return land / bearing.land.clearance if bearing.land else np.ones(land.size)


def steady_coverage(phases: Sequence[Phase], worn: Worn) -> tuple[Array, Array]:
    """Coverage at which deposit balances wear on the faster track, of a calm and of a whirling cage, by draw.

    The fixed points of a film: 1 where it grows instead. Work of the pockets is that of a new bearing.
    """
    wear = worn.film_wear * max(done.max() for done in work_done(phases))
    area = min(one.bearing.area for one in phases)
    place = worn.film_friction, np.full(wear.size, phases[0].bearing.clearance)
    found = []
    for name in ("calm_sliding", "whirl_sliding"):
        sliding = sum((one.share * one.table.at(*place)[name] for one in phases), np.zeros(wear.size))
        deposit = worn.transferred * worn.cage_wear * sliding / area
        found.append(np.where(deposit < wear, deposit / np.maximum(wear, LEAST_WEAR), 1.0))
    return found[0], found[1]


def lives(found: Course) -> Array:
    """Time at which each draw becomes unstable, shape (draw,) [s]: 0 from the start, infinite never."""
    unstable = np.maximum.accumulate(found.probability_unstable, axis=0) >= HALF
    first = unstable.argmax(axis=0)
    between = np.sqrt(found.time[1:] * found.time[:-1])
    time = np.concatenate(([0.0, 0.5 * found.time[1]], between[1:]))
    return np.where(unstable.any(axis=0), time[first], math.inf)


class Cause(NamedTuple):
    """What of the way to instability each change took, in logarithms of the safety factor, shape (draw,)."""

    film_worn: Array
    pocket_opened: Array
    land_opened: Array
    friction_risen: Array


def causes(found: Course, phases: Sequence[Phase], worn: Worn, life: Array) -> Cause:
    """Why each draw that becomes unstable does; 0 of the others."""
    ends = np.isfinite(life)
    at = np.searchsorted(found.time, np.where(ends, life, found.time[-1])).clip(max=found.time.size - 1)
    each = np.arange(life.size)
    moved_by = found.race_friction, found.pocket_friction, found.clearance, found.land_clearance
    race, pocket, wide, land = (one[at, each] for one in moved_by)
    whole, opened = worn.film_friction, _widening(phases[0].bearing, land)
    new = np.full(life.size, phases[0].bearing.clearance)
    places = ((whole, new, 1.0), (race, new, 1.0), (race, wide, 1.0), (race, wide, opened))
    criticals = np.log([[one.table.at(*at)["critical_friction"] for at in places] for one in phases])
    start, worn_film, both, all_worn = criticals[found.phase[at, each], :, each].T
    moved = Cause(
        start - worn_film,
        np.where(wide < phases[0].bearing.ball_gap, worn_film - both, math.inf),
        both - all_worn,
        np.log(np.maximum(pocket, LEAST) / np.maximum(worn.pocket_friction, LEAST)),
    )
    return Cause(*(np.where(ends, np.maximum(one, 0.0), 0.0) for one in moved))


@dataclass(frozen=True, slots=True, kw_only=True)
class Driver:
    """How strongly the life follows an input."""

    name: str  # of the input
    correlation: Ratio  # Spearman's, of the input and the life


def driven_by(inputs: Mapping[str, Array], life: Array) -> tuple[Driver, ...]:
    """Rank correlation of each drawn input with the life, the strongest first."""
    from scipy.stats import rankdata

    ranks = rankdata(life)
    if ranks.min() == ranks.max():
        return ()
    found = [
        Driver(name=name, correlation=float(np.corrcoef(rankdata(values), ranks)[0, 1]))
        for name, values in inputs.items()
        if values.min() < values.max()
    ]
    return tuple(sorted(found, key=lambda one: -abs(one.correlation)))


@dataclass(frozen=True, slots=True, kw_only=True)
class LifeRow:
    """The draws at one time; films and frictions are medians."""

    time: Second  # from the start
    revolutions: Ratio  # of one ring against the other
    probability_stable: Ratio  # mean over the draws
    first_decile: Ratio  # of P(stable): below it lies a tenth of the draws
    last_decile: Ratio  # above it lies a tenth of the draws
    film_inner: Metre  # mean over the track of the inner race
    film_outer: Metre  # the same of the outer race
    race_friction: Ratio  # mean of both tracks by the load that they carry
    pocket_friction: Ratio  # of ball on cage
    pocket_clearance: Metre  # stop to stop, with what is worn off
    land_clearance: Metre | None  # diametral, with what is worn off; null where its wear is not followed


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceleratedTest:
    """What a test at another speed says about the life, as both begin."""

    inner_speed: RadianPerSecond  # of the test
    critical_friction: Ratio  # of the new cage at that speed
    probability_stable: Ratio  # of a new cage there, over the draws of its friction
    film_time: Ratio  # hours of the mission that an hour of the test wears the films for; of the lesser track
    pocket_time: Ratio  # the same of the pockets of a calm cage


@dataclass(frozen=True, slots=True, kw_only=True)
class Life:
    """When a cage becomes unstable, over the draws of what wears it."""

    candidate: str  # whose cage it is
    draws: int  # bearings that were drawn
    revolutions_10: Ratio | None  # until a tenth of the cages are unstable; null beyond the horizon
    revolutions_50: Ratio | None  # the same of a half
    revolutions_90: Ratio | None  # the same of nine in ten
    unstable_at_start: Ratio  # share of the draws
    never_unstable: Ratio  # share of the draws, up to the horizon
    horizon: Ratio  # revolutions up to which the draws were followed
    revolutions_per_second: Hertz  # of ring against ring, mean over the phases
    film_worn: Ratio  # share of the draws that become unstable, mostly because the film is worn
    pocket_opened: Ratio  # mostly because the pockets have opened
    land_opened: Ratio  # mostly because the land has opened
    friction_risen: Ratio  # mostly because the friction of worn pockets has risen
    reservoir_empty: Ratio  # share of all draws whose reservoir is empty at the horizon
    coverage_calm: Ratio  # of the faster track, at which deposit by a calm cage balances wear; median
    coverage_whirling: Ratio  # the same by a cage that whirls; 1 where the film grows
    film_sustained: Ratio  # share of the draws in which deposit keeps up at least half of the coverage
    course: Annotated[tuple[LifeRow, ...], Rows("time", "course_")]  # the draws in the course of time
    drivers: tuple[Driver, ...]  # inputs that the life follows, the strongest first
    table: LifeTable  # of critical frictions, along which they are led; of the first phase
    phases: int  # of the duty cycle; 1 without one
    accelerated: AcceleratedTest | None  # null where none was asked for
    complete: bool  # always: without its whole table there is no life
    notes: tuple[str, ...] = ()  # where the draws leave the table or a model its range, a sentence each
