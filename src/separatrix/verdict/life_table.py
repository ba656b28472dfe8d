"""The question of a life: the table of critical frictions by ensembles, the draws, and the answer."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy.special import expit, ndtri

from separatrix.cage.disturbance import settings_for
from separatrix.cage.ensemble import Ensemble
from separatrix.cage.moving_cage import moving_cage
from separatrix.cage.outcome import Cause, RunOutcome
from separatrix.cage.rows import LANES
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Hertz, Metre, RadianPerSecond, Ratio, Watt, format_quantity
from separatrix.study.candidates import reference_candidate
from separatrix.study.film import WearRate
from separatrix.study.study import BallModel, Candidate, Race, StabilitySettings, Study, WearRates
from separatrix.verdict.critical_friction import SEARCHED_FRICTION, cage_limit
from separatrix.verdict.draws import (
    Case,
    frictions_to_draw,
    own_environment,
    sobol_points,
    uncertain_inputs,
)
from separatrix.verdict.judgement import Judgement, is_calm, is_taken_by_land, kick_counts
from separatrix.verdict.long_jobs import Interrupted, Load, Runner
from separatrix.verdict.long_look import has_land_friction, is_left_alone, long_look
from separatrix.verdict.parameter_axes import TIME_SHARE, varied
from separatrix.verdict.stability_curve import expected_load
from separatrix.verdict.swept_cases import time_shares
from separatrix.verdict.wear_life import (
    LEAST,
    TEST,
    THICKEST,
    AcceleratedTest,
    BearingWear,
    Course,
    Land,
    Life,
    LifeRow,
    LifeTable,
    Phase,
    Worn,
    causes,
    course,
    driven_by,
    lives,
    steady_coverage,
    track_work,
    wear_rates,
    work_done,
)

RUNS = 32
"""Runs of the table from each disturbance, at most: its critical frictions are good to a tenth."""

FRICTIONS, WIDENINGS = 6, (1.0, 1.5, 2.5)
"""Race frictions of the table, and its pocket clearances over that of a new pocket."""

LAND_AT = 1
"""Race friction of the table, by its place, at which the land is widened for its exponent."""

NO_WIDTH = "The wear of the land is not followed: [cage] land_width is not given."
NO_EXPONENT = (
    "The land opens, but its critical friction is beyond what was searched, or the land drives the cage: it "
    "stays that of a new land."
)

LEAST_CRITICAL: Ratio = 1e-3
"""Of the table, for the logarithm of one that is 0."""

FREELY = (
    "At places of the table the cage whirls without friction in its pockets, or friction on the land drives "
    "it: the table counts it there as unstable at every friction, although more may calm it."
)

NARROWER = (1.0, 0.5, 0.2, 0.05)
"""Parts of that widening, the first that the gap between the balls allows."""

LEAST_FRICTION, APART = 1e-3, 1.1
"""Of a race in the table, and the least ratio of its ends."""

MOST_COVERS = 700.0
"""Thickness of a film over that at which it covers 63 %: the exponential of more overflows."""

STEEP = 10.0
"""Steepness where no searched friction is enough: P(unstable) is next to 0 or 1 there by any."""

CALM, WHIRLING = 0.6, 1.5
"""Pocket frictions over the critical one at which the work of calm and of whirling cages is taken."""

WORK_RUNS = 16
DECADE: Ratio = 10.0
"""Factor either way, 95 %, by which a wear coefficient scatters that is stated without a range: bearings
agree with tests to a factor of ten (ESTL, 44th AMS 2018, pp. 518-524)."""

SPEED = "operation.inner_speed"
PHASE_KEYS = (SPEED, "operation.outer_speed", "operation.axial_load", "operation.radial_load")
"""What the phases of a duty cycle may differ in."""

MOST_PHASES = 12
STREAM = 0x11FE
"""Separates the draws of a life from others with a study's seed."""


class Node(NamedTuple):
    """A place of the table."""

    critical: Ratio
    steepness: float
    pockets: tuple[Watt, Watt]  # work of a calm and of a whirling cage
    lands: tuple[Watt, Watt]
    notes: tuple[str, ...] = ()


class Duty(NamedTuple):
    """A part of the time, with the chain at its speed and load, and how its runs are made."""

    share: Ratio
    solution: Solution
    settings: StabilitySettings


Place = tuple[int, int, int]
"""Phase, race friction and pocket clearance of a node; -1 for a new pocket on a wider land."""

LONG_LOOK: Place = (-1, 0, 0)
"""Of the long look at a new cage, in its fastest phase."""

LEFT_OUT = " The life does not include that: its runs are shorter."


def life(
    study: Study,
    *,
    revolutions: float,
    draws: int,
    cases: Sequence[Mapping[str, float]] = (),
    accelerated: RadianPerSecond | None = None,
    runner: Runner | None = None,
) -> Life:
    """When the cage of a study becomes unstable, over draws of what wears it.

    `revolutions` of one ring against the other is how far they are followed. `cases` are a duty cycle: other
    values of [operation], with their ``time_share``. `accelerated` is the speed of the inner ring in a test.
    The numbers do not depend on the runner.

    Raises
    ------
    InputError
        The study has no [wear], no film, no cage, no friction or wear coefficient of them; or the duty cycle
        is none.
    Interrupted
        Before the table was finished; its runs are kept.
    """
    if study.wear is None:
        raise InputError(study.name, "lacks the section [wear]", cure=TEST)
    candidate = reference_candidate(study, study.ranking) if study.ranking else None
    solution, runner = solve(study, candidate), runner or Runner()
    rates = wear_rates(study, study.wear, candidate)
    assumed = [name for name, one in rates.items() if one.range is None and name not in study.distributions]
    worn, inputs, fixed = _drawn(solution, study.wear, rates, candidate, draws)
    if max(worn.thickness.max(), THICKEST) > MOST_COVERS * worn.coverage.min():
        rule = f"must be above a {MOST_COVERS:g}th of any film, {format_quantity(THICKEST, 'm')} by transfer"
        raise InputError("[wear] coverage_thickness", rule, format_quantity(float(worn.coverage.min()), "m"))
    every = np.concatenate((worn.film_friction, worn.bare_friction))
    low = max(float(every.min()), LEAST_FRICTION)
    frictions = np.geomspace(low, max(float(every.max()), APART * low), FRICTIONS)
    clearances = _clearances(study, "cage.pocket_clearance", solution.stated_design.pocket_clearance)
    land = solution.stated_design.land_clearance or 0.0
    lands = _clearances(study, "cage.land_clearance", land) if _land(solution) else [land]
    if clearances[0] < land < clearances[-1]:  # where pockets leave the cage to it the limit changes its law
        clearances = sorted({*clearances, land})
    parts = [(share, varied(study, one)) for share, one in _shared(cases)]
    phases = [_duty(one, candidate, share) for share, one in parts if _turns(one)]  # nothing wears at rest
    if not phases:
        raise InputError("--cases", "needs a phase in which the rings turn against each other")
    if accelerated is not None and accelerated == study.operation.outer_speed:
        raise InputError("--accelerated", "must differ from the speed of the outer ring")
    test = accelerated and _duty(varied(study, {SPEED: accelerated}), candidate, 1.0)
    duties = [*phases, test] if test else phases

    def node(place: Place) -> Node | Judgement | None:
        if place == LONG_LOOK:
            return long_look(fastest.solution, pocket_friction, fastest.settings, runner, LANES)
        phase, i, j = place
        at = duties[phase]
        if at is test:
            return _node(at.solution, at.settings, runner)
        values = {"film.race_friction": float(frictions[i]), "cage.pocket_clearance": clearances[max(j, 0)]}
        values |= {"cage.land_clearance": lands[1]} if j < 0 else {}
        return _node(solve(varied(at.solution.study, values), candidate), at.settings, runner)

    def answer(every: Mapping[Place, Any]) -> Life:
        if len(every) < len(places):
            raise Interrupted
        look, found = every.get(LONG_LOOK), {at: one for at, one in every.items() if at != LONG_LOOK}
        notes = [*_notes(found, fixed, assumed), *_tests(rates, solution), *solution.notes]
        notes += [*_thin(worn), *([NO_WIDTH] if land and not lands[1:] else [])]
        each = [
            Phase(
                share=one.share,
                bearing=_bearing_wear(one.solution),
                table=_table(found, place, frictions, np.array(clearances), np.array(lands)),
            )
            for place, one in enumerate(phases)
        ]
        tested = _accelerated(test.solution, found[places[-1]], each, worn) if test else None
        speed = sum(one.share * _turns(one.solution.study) for one in phases)
        made_of = candidate or (study.cage and study.cage.material)
        name = (made_of and made_of.name) or study.name
        lived = _life(name, each, worn, inputs, speed, revolutions, tested, notes)
        if look is None or is_left_alone(look) or lived.unstable_at_start > 0.5:
            return lived
        return replace(lived, notes=(look.reason + LEFT_OUT, *lived.notes))

    fastest = max(phases, key=lambda one: abs(one.solution.bearing.cage_speed))
    pocket_friction = fastest.solution.friction.mean if fastest.solution.friction else 0.0
    asks_look = not solution.design.is_of_paper and has_land_friction(moving_cage(solution, 0.0))
    places = [LONG_LOOK] if asks_look else []
    places += itertools.product(range(len(phases)), range(FRICTIONS), range(len(clearances)))
    places += [(phase, LAND_AT, -1) for phase in range(len(phases)) if lands[1:]]
    places += [(len(phases), 0, 0)] if test else []
    return runner.work_out(
        node,
        places,
        into=answer,
        load=lambda at: Load(LANES, dear=20.0) if at == LONG_LOOK else _load(duties[at[0]].settings),
    )


def _thin(worn: Worn) -> Iterator[str]:
    """A sentence on a new film that does not cover its tracks: by a tenth, as good as the table is."""
    bare, whole = np.exp(-worn.thickness / worn.coverage), float(np.median(worn.film_friction))
    begin = float(np.median(worn.film_friction + bare * (worn.bare_friction - worn.film_friction)))
    if begin > 1.1 * whole:
        yield (
            f"A new film covers {100.0 * (1.0 - np.median(bare)):.0f} % of its tracks by [wear] "
            f"coverage_thickness: life begins at a race friction of {begin:.3g}, not {whole:.3g} (medians)."
        )


def _tests(rates: Mapping[str, WearRate], solution: Solution) -> Iterator[str]:
    """Sentences on wear coefficients of the library: conditions of their tests, and of the bearing."""
    at, state = solution.study.operation, solution.bearing
    pressure = max(one.ellipse.max_pressure for one in (state.inner, state.outer))
    temperature = "" if at.temperature is None else format_quantity(at.temperature, "K")
    for key, rate in rates.items():
        film = f"{format_quantity(pressure, 'Pa')} on the races" if key == "wear.film_wear" else ""
        here = ", ".join(filter(None, [temperature, film, at.fluid])) or "no stated temperature or medium"
        if rate.test:
            yield f"[wear] {key.removeprefix('wear.')}: {rate.test}; this bearing: {here}."


def _load(settings: StabilitySettings) -> Load:
    return Load(len(settings.kicks) * expected_load(settings, band=False).runs)


def _shared(cases: Sequence[Mapping[str, float]]) -> list[tuple[Ratio, Mapping[str, float]]]:
    """Share and values of each phase; one of the study's own without a duty cycle."""
    if not cases:
        return [(1.0, {})]
    if len(cases) > MOST_PHASES:
        raise InputError("--cases", f"must be at most {MOST_PHASES} of a duty cycle", str(len(cases)))
    shares = time_shares(cases)
    if not shares:
        raise InputError("--cases", "needs a column time_share: how long each case lasts")
    for name in {name for one in cases for name in one} - {TIME_SHARE}:
        if name not in PHASE_KEYS:
            raise InputError("--cases", f"must vary {' and '.join(PHASE_KEYS)} alone", got=name)
    return [
        (share, {name: value for name, value in one.items() if name != TIME_SHARE})
        for share, one in zip(shares, cases, strict=True)
        if share > 0.0
    ]


def _duty(study: Study, candidate: Candidate | None, share: Ratio) -> Duty:
    solution = solve(study, candidate)
    settings = settings_for(study.stability, moving_cage(solution, 0.0))
    return Duty(share, solution, replace(settings, runs=min(RUNS, settings.runs)))


def _turns(study: Study) -> Hertz:
    """Revolutions of ring against ring in a second."""
    return abs(study.operation.inner_speed - study.operation.outer_speed) / (2.0 * math.pi)


def _bearing_wear(solution: Solution) -> BearingWear:
    study, state = solution.study, solution.bearing
    inner, outer = (track_work(study.bearing, study.operation, state, race) for race in Race)
    return BearingWear(
        tracks=(inner, outer),
        loads=(state.inner.load, state.outer.load),
        ball_diameter=study.bearing.ball_diameter,
        ball_count=study.bearing.ball_count,
        clearance=solution.stated_design.pocket_clearance,
        ball_gap=study.bearing.ball_gap,
        land=_land(solution),
    )


def _land(solution: Solution) -> Land | None:
    """What wears on the lands; None without one, or without its width."""
    design, cage = solution.stated_design, moving_cage(solution, 0.0)
    if not (cage.land_gap and cage.land_width and design.land_clearance):
        return None
    around = 2.0 * math.pi * (cage.land_radius or cage.pitch_radius)
    return Land(around * cage.land_width * cage.land_count, design.land_clearance)


def _accelerated(solution: Solution, node: Node, phases: Sequence[Phase], worn: Worn) -> AcceleratedTest:
    """What a test at another speed says about the mission, as both begin."""
    tested = _bearing_wear(solution)
    begin = worn.film_friction, np.full(worn.film_friction.size, tested.clearance)
    calm = sum(one.share * one.table.at(*begin)["calm_sliding"].mean() for one in phases)
    films = [
        float(done.max() / (track.work * track.passes).max())
        for done, track in zip(work_done(phases), tested.tracks, strict=True)
    ]
    chance = expit(node.steepness * np.log(np.maximum(worn.pocket_friction, LEAST) / node.critical))
    return AcceleratedTest(
        inner_speed=solution.study.operation.inner_speed,
        critical_friction=node.critical if node.critical > LEAST_CRITICAL else 0.0,
        probability_stable=float(1.0 - chance.mean()),
        film_time=float(1.0 / max(films)),
        pocket_time=float(node.pockets[0] / calm),
    )


def _clearances(study: Study, key: str, new: Metre) -> list[Metre]:
    """Clearances of the table: as wide as `WIDENINGS`, or as the study takes."""
    if new == 0.0:
        raise InputError("[cage] pocket_clearance", "must be > 0 for a pocket that opens by wear")
    for part in NARROWER:
        found = [new * (1.0 + part * (factor - 1.0)) for factor in WIDENINGS]
        with contextlib.suppress(InputError):
            varied(study, {key: found[-1]})
            break
    return found


def _node(solution: Solution, settings: StabilitySettings, runner: Runner) -> Node:
    """Critical friction at a place, and the work of the pockets below and above it.

    Where friction on the land drives it below, or at its own friction, it is that of one that always whirls.
    """
    limit = cage_limit(solution, settings, runner)
    at = limit.own_critical_friction
    critical = SEARCHED_FRICTION if at is None else max(at, LEAST_CRITICAL)
    ball = BallModel.FREE if limit.critical_ball == "free" else None

    def followed(friction: Ratio) -> Ensemble:
        cage = moving_cage(solution, min(friction, SEARCHED_FRICTION), ball)
        return runner.ensemble(cage, settings, kicks=(limit.critical_kick,), runs=WORK_RUNS)

    below, above = followed(CALM * critical), followed(WHIRLING * critical)
    calm, whirl = _mean(below, whirls=False), _mean(above, whirls=True)
    whirl = whirl if whirl[0] else calm
    pockets, lands = (calm[0], whirl[0]), (calm[1], whirl[1])
    own = solution.friction.mean if solution.friction else math.inf
    if own < CALM * critical and has_land_friction(moving_cage(solution, 0.0)):
        below = followed(own)
    is_taken = is_taken_by_land(kick_counts(below)[0])
    steepness = limit.steepness or STEEP
    return Node(LEAST_CRITICAL if is_taken else critical, steepness, pockets, lands, limit.notes)


def _mean(found: Ensemble, *, whirls: bool) -> tuple[Watt, Watt]:
    """Mean work of pockets and of lands in the runs that whirl, or do not; in all where none does.

    A whirl that the land drives is none of the pockets, whose critical friction decides here.
    """
    is_whirl = (found.outcome == RunOutcome.WHIRLS) & (found.cause != Cause.LAND_FRICTION)
    kind = is_whirl if whirls else is_calm(found.outcome) | (found.cause == Cause.LAND_FRICTION)
    each = kind if kind.any() else np.ones_like(kind)
    works = found.pocket_sliding, found.rubbing_force * found.rubbing_speed
    return float(works[0][each].mean()), float(works[1][each].mean())


def _table(
    found: Mapping[Place, Node], phase: int, frictions: Array, clearances: Array, lands: Array
) -> LifeTable:
    def each(name: str) -> Array:
        return np.array(
            [
                [getattr(found[phase, i, j], name) for j in range(clearances.size)]
                for i in range(frictions.size)
            ]
        )

    pockets, on_land = each("pockets"), each("lands")
    exponent, widening = 0.0, 1.0
    wider, new = found.get((phase, LAND_AT, -1)), found[phase, LAND_AT, 0]
    if wider and all(LEAST_CRITICAL < one.critical < SEARCHED_FRICTION for one in (wider, new)):
        widening = float(lands[1] / lands[0])
        exponent = math.log(wider.critical / new.critical) / math.log(widening)
    return LifeTable(
        race_friction=frictions,
        pocket_clearance=clearances,
        critical_friction=each("critical"),
        steepness=each("steepness"),
        calm_sliding=pockets[..., 0],
        whirl_sliding=pockets[..., 1],
        calm_land_sliding=on_land[..., 0],
        whirl_land_sliding=on_land[..., 1],
        land_exponent=exponent,
        land_widening=widening,
    )


def _drawn(
    solution: Solution,
    wear: WearRates,
    rates: Mapping[str, WearRate],
    candidate: Candidate | None,
    draws: int,
) -> tuple[Worn, dict[str, Array], list[str]]:
    """Draws of what wear depends on, those that are uncertain by name, and uncertain inputs that stay."""
    study = solution.study
    frictions = frictions_to_draw(study) if study.ranking else {}
    known = {one.key: one.distribution for one in uncertain_inputs(study, frictions)}
    own = f"ranking.{candidate.name}.{own_environment(study)}" if candidate else ""
    own = own if own in known else ""
    friction = solution.friction
    if friction is None:
        cure = "Give [cage] ball_cage_friction, or rank a measured material."
        raise InputError("[cage] ball_cage_friction", "is not known", cure=cure)
    mean = frictions[Case(candidate.name)].mean if candidate and own else friction.mean
    values = {
        **{name: rate.value for name, rate in rates.items()},
        "wear.transferred": wear.transferred,
        "film.thickness": study.film.thickness or 0.0,  # bare races are refused
        "wear.coverage_thickness": wear.coverage_thickness,
        "film.race_friction": study.film.race_friction,
        "wear.bare_friction": wear.bare_friction,
        own or "pocket friction": mean,
        "wear.worn_pocket_friction": mean if wear.worn_pocket_friction is None else wear.worn_pocket_friction,
        "wear.worn_pocket_depth": math.inf if wear.worn_pocket_depth is None else wear.worn_pocket_depth,
        "wear.reservoir": math.inf if wear.reservoir is None else wear.reservoir,
    }
    points = sobol_points(draws, len(values), STREAM, study.stability.seed)
    columns, inputs = list[Array](), dict[str, Array]()
    for place, (name, value) in enumerate(values.items()):
        if name in known:
            column = known[name].quantile(points[:, place])
        elif name in rates:
            low, high = rates[name].range or (value / DECADE, value * DECADE)
            column = math.sqrt(low * high) * (high / low) ** (0.5 / 1.96 * ndtri(points[:, place]))
        else:
            column = np.full(draws, value)
        columns.append(column)
        if column.min() < column.max():
            inputs[name] = column
    if wear.worn_pocket_friction is None:  # it stays that of each draw
        columns[8] = columns[7]
    fixed = [name for name in study.distributions if name not in values and not name.startswith("ranking.")]
    return Worn(*columns), inputs, fixed


def _notes(found: Mapping[Place, Node], fixed: list[str], assumed: list[str]) -> list[str]:
    is_free = any(one.critical <= LEAST_CRITICAL for one in found.values())
    notes = [FREELY] * is_free + [note for one in found.values() for note in one.notes]
    if assumed:
        words = ", ".join(name.removeprefix("wear.") for name in assumed)
        notes.append(f"Stated without a distribution, a factor of {DECADE:g} either way is assumed: {words}.")
    if fixed:
        notes.append(f"Uncertain inputs at their means: {', '.join(fixed)}.")
    return list(dict.fromkeys(notes))


def _life(
    name: str,
    phases: Sequence[Phase],
    worn: Worn,
    inputs: Mapping[str, Array],
    speed: Hertz,
    revolutions: float,
    tested: AcceleratedTest | None,
    notes: list[str],
) -> Life:
    """Lead the draws along the tables, and say what comes of them."""
    found = course(phases, worn, revolutions / speed)
    life = lives(found)
    calm, whirling = steady_coverage(phases, worn)
    ends = np.isfinite(life)
    moved = np.stack(causes(found, phases, worn, life))
    most = np.where(ends & (moved.max(axis=0) > 0.0), moved.argmax(axis=0), -1)
    known = max(1, int(np.count_nonzero(ends & (life > 0.0))))
    shares = [float(np.count_nonzero((most == i) & (life > 0.0)) / known) for i in range(len(moved))]
    at_10, at_50, at_90 = (_quantile(life, share, speed) for share in (0.1, 0.5, 0.9))
    table, land = phases[0].table, phases[0].bearing.land
    beyond = [*_meet(float(np.mean(found.clearance[-1] >= phases[0].bearing.ball_gap)))]
    beyond += _beyond(found.clearance[-1], float(table.pocket_clearance[-1]), "the pockets open")
    notes += [NO_EXPONENT] if land and table.land_widening == 1.0 else []
    if land and table.land_widening > 1.0:
        beyond += _beyond(found.land_clearance[-1], table.land_widening * land.clearance, "the land opens")
    return Life(
        candidate=name,
        draws=life.size,
        revolutions_10=at_10,
        revolutions_50=at_50,
        revolutions_90=at_90,
        unstable_at_start=float(np.mean(life == 0.0)),
        never_unstable=float(np.mean(~ends)),
        horizon=revolutions,
        revolutions_per_second=speed,
        film_worn=shares[0],
        pocket_opened=shares[1],
        land_opened=shares[2],
        friction_risen=shares[3],
        reservoir_empty=float(np.mean(found.volume[-1] >= worn.reservoir)),
        coverage_calm=float(np.median(calm)),
        coverage_whirling=float(np.median(whirling)),
        film_sustained=float(np.mean(found.kept[-1] >= 0.5)),
        course=tuple(_rows(found, speed)),
        drivers=driven_by(inputs, np.minimum(life, 10.0 * revolutions / speed)),
        table=table,
        phases=len(phases),
        accelerated=tested,
        complete=True,
        notes=tuple(dict.fromkeys([*beyond, *notes])),
    )


def _meet(share: Ratio) -> Iterator[str]:
    """A sentence on draws whose pockets have worn into one another."""
    if share >= 0.005:
        yield (
            f"In {100.0 * share:.0f} % of the draws the pockets open to the gap between the balls by the "
            "end: no bar is left between them, and the cage counts as unstable."
        )


def _beyond(found: Array, widest: Metre, what: str) -> Iterator[str]:
    """A sentence on draws that wear beyond the table."""
    share = float(np.mean(found > widest))
    if share >= 0.005:
        yield (
            f"In {100.0 * share:.0f} % of the draws {what} beyond {format_quantity(widest, 'm', 3)} by the "
            "end: from there on the table's last clearance holds."
        )


def _quantile(life: Array, share: Ratio, speed: float) -> float | None:
    """Revolutions at which a share of the draws have become unstable; None beyond the horizon."""
    at = float(np.sort(life)[min(life.size - 1, math.ceil(share * life.size) - 1)])
    return at * speed if math.isfinite(at) else None


def _rows(found: Course, speed: float) -> list[LifeRow]:
    def median(values: Array, place: int) -> Metre:
        return float(np.median(values[place]))

    rows = []
    for place, time in enumerate(found.time[1:], start=1):
        stable = 1.0 - found.probability_unstable[place]
        low, high = np.quantile(stable, (0.1, 0.9))
        rows.append(
            LifeRow(
                time=float(time),
                revolutions=float(time * speed),
                probability_stable=float(stable.mean()),
                first_decile=float(low),
                last_decile=float(high),
                film_inner=median(found.films[0], place),
                film_outer=median(found.films[1], place),
                race_friction=median(found.race_friction, place),
                pocket_friction=median(found.pocket_friction, place),
                pocket_clearance=median(found.clearance, place),
                land_clearance=median(found.land_clearance, place) or None,
            )
        )
    return rows
