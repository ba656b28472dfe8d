"""Answers about a moving cage: their records, how these are arranged, and what each verb computes.

The answer of `sweep` is a `Sweep`.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from math import inf, isfinite
from typing import Any, TypeVar

from separatrix.cage import CourseAnalysis, History, MovingCage, analyse, moving_cage, settings_for
from separatrix.cage import simulate as follow
from separatrix.cage.closed_forms import axial_half_play, drift_rate_law
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.plain_data import Group, Leaf, Node, Table, absent, fields_of, shape
from separatrix.ground.units import MetrePerSecond, Newton, PerSecond, Ratio, Rows, Watt, parse
from separatrix.study.candidates import cage_candidate, reference_candidate, require_friction
from separatrix.study.study import BallModel, Study
from separatrix.verbs.chain_answers import chain_node, overdamped_notes
from separatrix.verbs.life import Options as LifeOptions
from separatrix.verbs.map import KICK, X, Y
from separatrix.verbs.map import Options as MapOptions
from separatrix.verbs.parts import cage_of_study as of
from separatrix.verbs.sensitivity import Options as SensitivityOptions
from separatrix.verbs.simulate import Options as SimulateOptions
from separatrix.verbs.sweep import Options as SweepOptions
from separatrix.verbs.verb import NoOptions
from separatrix.verdict.beyond_models import Moved, beyond_motion
from separatrix.verdict.crossing import cage_at
from separatrix.verdict.judgement import Judgement, transmitted_force
from separatrix.verdict.life_table import life
from separatrix.verdict.long_jobs import Runner, made_into
from separatrix.verdict.parameter_axes import MapAxis, asked_cases, checked_points, plain_number, read_axis
from separatrix.verdict.ranking import rank
from separatrix.verdict.ranking_records import NotFinished, NotMeasured, Ranked, Ranking
from separatrix.verdict.reasons import force_limit, outcome_sentence
from separatrix.verdict.rig_signs import SLOWER, Followed, RigSigns, lasts, rig_signs, slower
from separatrix.verdict.stability_curve import StabilityCurve, stability_curve
from separatrix.verdict.stability_map import MapQuestion, StabilityMap, stability_map, value_here
from separatrix.verdict.swept_cases import Sweep, sweep
from separatrix.verdict.uncertain_study import NotDrawn, UncertainMaterial, UncertainStudy, uncertain_study
from separatrix.verdict.wear_life import Life

Found = TypeVar("Found")
Kind = TypeVar("Kind", bound="OfCage")

MOST_SHOWN = 20_000
"""Samples of a simulated run, at most: every step of a short one."""

REVOLUTIONS = 1e3, 1e12
"""Least and most, up to which draws are followed."""

MOST_SPEED = 1e6


@dataclass(frozen=True, slots=True, kw_only=True)
class OfCage:
    """The chain, and the cage that an answer is for."""

    solution: Solution  # the chain
    cage: MovingCage  # the cage with its pockets, land and balls, as the runs use it
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityAnswer(OfCage):
    """Stability curve of the cage."""

    curve: StabilityCurve  # critical friction against the restitution factor


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAnswer(OfCage):
    """The map, and the cage of the study itself."""

    map: StabilityMap  # the two axes, the points and the boundary between them


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationAnswer(OfCage):
    """One run of the ensemble, from one kick.

    `force_limit` is the force of a pocket beyond which its ball has no meaning: None without one.
    """

    kick: MetrePerSecond
    run: int  # number of the run in the ensemble, from 0
    given_restitution_factor: Ratio | None  # to which the races are damped; null for that of the study
    outcome_sentence: str  # where the motion ends, in words
    force_limit: Newton | None  # its friction is all that the races hold of a ball; null without such a limit
    force_exceeds_races: bool  # whether the largest force is beyond what the races hold
    drift_rate_law: PerSecond  # growth rate of the offset by the linear law
    rubbing_power: Watt  # power that rubbing on the land turns to heat at the end of the run
    history: History  # the motion, sampled
    analysis: CourseAnalysis  # means, extremes, whirl and spectra
    signs: RigSigns | None  # what a test rig sees; null during a start-up


@dataclass(frozen=True, slots=True, kw_only=True)
class RankingAnswer(OfCage):
    """The ranking, and the cage of its reference candidate."""

    ranking: Ranking  # the candidates in each environment


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityAnswer(OfCage):
    """The uncertain study, and the cage of its reference candidate."""

    uncertain: UncertainStudy  # verdicts over the uncertain inputs, and what decides them


@dataclass(frozen=True, slots=True, kw_only=True)
class LifeAnswer(OfCage):
    """The life, and the cage that it is of."""

    life: Life  # when it becomes unstable, what ends it, and the table behind that


# How these records, and those in them, are arranged otherwise than field by field.


@shape.register
def _(found: MovingCage) -> Node:
    """What is infinite, as the damping of balls that their races grip, is None."""
    node: Node = {
        name: item._replace(value=None) if isinstance(item, Leaf) and item.value == inf else item
        for name, item in fields_of(found).items()
    }
    return node | {"axial_half_play": Leaf(axial_half_play(found) if found.is_in_space else None, "m")}


@shape.register
def _of_cage(found: OfCage) -> Node:
    """What was computed, its records on one level; the chain, with the leads of the balls, and the cage."""
    node: Node = {}
    own = [one.name for one in fields(found) if one.name not in OfCage.__slots__]
    for name, item in fields_of(found, *own).items():
        node |= item.fields if isinstance(item, Group) else {name: item}
    orbits: Node = {
        "half_play": Leaf(found.cage.half_play, "m"),
        "lead_amplitude": Leaf(found.cage.lead_amplitude, "m"),
        "orbital_share": Leaf(found.solution.orbital_waves.share, "-"),
    }
    return node | {"chain": Group(chain_node(found.solution) | orbits), "cage": Group(shape(found.cage))}


@shape.register
def _(found: SimulationAnswer) -> Node:
    """A motion that does not last has no whirl, a start-up no signs of a steady speed."""
    none = {"whirl_frequency": Leaf(None, "Hz"), "whirl_speed": Leaf(None, "m/s")}
    signs: Node = {} if found.signs else absent(RigSigns)
    whirl = {} if lasts(found.history) else {**none, "whirl_direction": Leaf(0)}
    return _of_cage(found) | signs | whirl


@shape.register
def _(found: StabilityMap) -> Node:
    """Places of points and of changes have the units of their axes."""
    node, x, y = fields_of(found), found.x.unit, found.y.unit
    units = {"x": x, **dict.fromkeys(("y", "y_low", "y_high", "margin"), y)}
    for table in (node["points"], node["changes"]):
        for row in table.records or () if isinstance(table, Table) else ():
            known = {name: one.value for name, one in row.items() if name in units and isinstance(one, Leaf)}
            row |= {name: Leaf(value, units[name]) for name, value in known.items()}
    return node


@shape.register
def _(axis: MapAxis) -> Node:
    """The values, and that of the study, have the unit that the axis states."""
    return fields_of(axis) | {"values": Leaf(axis.values, axis.unit), "here": Leaf(axis.here, axis.unit)}


@shape.register
def _(row: Ranked | NotFinished | NotMeasured | UncertainMaterial | NotDrawn) -> Node:
    """The evidence on the level of the row; a row that lacks something has the keys of a whole one."""
    is_ranked = not isinstance(row, UncertainMaterial | NotDrawn)
    judged = (getattr(row, name, None) for name in ("judgement", "over_inputs"))
    evidence, over = (absent(Judgement) if one is None else shape(one) for one in judged)
    whole = absent(Ranked if is_ranked else UncertainMaterial)
    node = evidence | whole | {"extrapolation": Leaf(())} | fields_of(row)
    del node["judgement"]
    if is_ranked:
        del node["over_inputs"]
        names = ("verdict", "probability_stable", "probability_low", "probability_high", "runs")
        node |= {f"uncertain_{name}": over[name] for name in names}
    return node


@shape.register
def _(found: Sweep) -> Node:
    """A row for each case, with its values under the names of the parameters."""
    named: list[Node] = [{"name": Leaf(one.name), "unit": Leaf(one.unit or "-")} for one in found.parameters]
    cases: list[Node] = []
    for one in found.cases:
        case = fields_of(one)
        given = zip(found.parameters, one.values, strict=True)
        values: Node = {at.name: Leaf(value, at.unit or "-") for at, value in given}
        del case["values"]
        cases.append({"case": case.pop("case")} | values | case)
    return fields_of(found) | {"parameters": Table(named, Rows()), "cases": Table(cases, Rows("case"))}


# What each verb computes.


def answer_of_cage(
    kind: type[Kind], name: str, solution: Solution, compute: Callable[[], Found], *notes: str
) -> Kind:
    """Return the answer about a cage whose field `name` a long job computes, also what an interrupt left.

    Its notes are those of the result, of chain and cage, and `notes`.
    """
    cage = of.cage_of(solution)

    def made(found: Any) -> Kind:
        every = (*found.notes, *solution.notes, *cage.notes, *notes)
        return kind(solution=solution, cage=cage, notes=every, **{name: found})

    return made_into(made, compute)


def stability_answer(study: Study, _: NoOptions, runner: Runner) -> StabilityAnswer:
    """Critical friction against restitution factor."""
    solution = solve(study)
    cage, notes = of.cage_of(solution), of.extrapolation_notes(solution)
    curve = partial(stability_curve, cage, study.stability, runner=runner)
    return answer_of_cage(StabilityAnswer, "curve", solution, curve, *notes)


def map_answer(study: Study, options: MapOptions, runner: Runner) -> MapAnswer:
    """Verdicts in the plane of two parameters of a study."""
    checked_points(options.points, "--points")
    of.refuse_outside("--runs", options.runs, 1, of.MOST_RUNS)
    axes = [read_axis(text, f"--{way}", options.points) for way, text in (("x", options.x), ("y", options.y))]
    names = [axis.parameter for axis in axes]
    if names[0] == names[1]:
        cure = f"Without --x it is {X}, without --y {Y}."
        raise InputError("--x and --y", "must be two parameters", got=f"{names[0]} twice", cure=cure)
    if options.kick is not None and KICK in names:
        raise InputError("--kick", "and an axis kick exclude each other", cure="Give one of the two.")
    solution = solve(study)
    usual = settings_for(study.stability, of.cage_of(solution)).middle_kick
    speed = usual if options.kick is None else of.kick_speed(options.kick)
    across, up = (replace(axis, here=value_here(solution, axis.parameter)) for axis in axes)
    asked = MapQuestion(study=study, x=across, y=up, kick=speed, runs=options.runs)
    notes = of.extrapolation_notes(solution)
    return answer_of_cage(MapAnswer, "map", solution, lambda: stability_map(asked, runner=runner), *notes)


def simulate_answer(study: Study, options: SimulateOptions) -> SimulationAnswer:
    """Follow one run of the ensemble, by default the first from the reference disturbance."""
    of.refuse_outside("--run", options.run, 0, of.MOST_RUNS)
    given, eta = None if options.kick is None else of.kick_speed(options.kick), None
    if options.restitution_factor is not None:
        eta = plain_number(str(options.restitution_factor).strip(), "--restitution-factor")
        of.refuse_outside("--restitution-factor", eta, 0.0, 1.0)
    solution = solve(study)
    require_friction(study)
    cage = of.cage_of(solution)
    settings = settings_for(study.stability, cage)
    cage = cage if eta is None else cage_at(cage, eta, cage.ball_cage_friction)
    speed = settings.middle_kick if given is None else given
    asked = {name: getattr(settings, name) for name in ("seed", "duration", "ball_scatter")}

    def followed(cage: MovingCage, kick: float, until: float | None = None) -> History:
        return follow(cage, kick=kick, run=options.run, samples=MOST_SHOWN, until=until, **asked)

    def grown(chain: Solution, cage: MovingCage, kick: float, found: History) -> Followed:
        if not lasts(found):
            return chain, cage, found
        if found.largest_contact_force > force_limit(cage, transmitted_force(chain)):
            cage = moving_cage(chain, cage.ball_cage_friction, BallModel.FREE)
        return chain, cage, followed(cage, kick, settings.duration)

    history, signs = followed(cage, speed), None
    if eta is None and not study.operation.ramp_time:
        other, less = slower(solution), SLOWER * speed
        its = of.cage_of(other)
        slow = grown(other, its, less, followed(its, less))
        signs = rig_signs(grown(solution, cage, speed, history), slow)
    found, made_of = force_limit(cage, transmitted_force(solution)), cage_candidate(study)
    limit = found if isfinite(found) else None
    heat = cage.land_friction * history.rubbing_force * history.rubbing_speed
    name = made_of.name if made_of else "The cage"
    moved = Moved(name, history.largest_contact_force, history.largest_offset)
    notes = *solution.notes, *cage.notes, *of.extrapolation_notes(solution), *beyond_motion(solution, [moved])
    return SimulationAnswer(
        solution=solution,
        cage=cage,
        kick=speed,
        run=options.run,
        given_restitution_factor=eta,
        outcome_sentence=outcome_sentence(history, limit=limit, rubbing_power=heat),
        force_limit=limit,
        force_exceeds_races=limit is not None and history.largest_contact_force > limit,
        drift_rate_law=drift_rate_law(cage),
        rubbing_power=heat,
        history=history,
        analysis=analyse(cage, history),
        signs=signs,
        notes=notes,
    )


def rank_answer(study: Study, _options: NoOptions, runner: Runner) -> RankingAnswer:
    """Verdict, margin, rank and reason of each candidate material."""
    solution = of.reference(study)
    notes = overdamped_notes(solution.restitution)
    return answer_of_cage(RankingAnswer, "ranking", solution, lambda: rank(study, runner=runner), *notes)


def sensitivity_answer(study: Study, options: SensitivityOptions, runner: Runner) -> SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate."""
    of.refuse_samples(options.samples)
    solution = of.reference(study)
    of.drawn_bearings(solution)  # refused before anything is timed
    drawn = partial(uncertain_study, study, options.samples, runner=runner)
    return answer_of_cage(SensitivityAnswer, "uncertain", solution, drawn)


def life_answer(study: Study, options: LifeOptions, runner: Runner) -> LifeAnswer:
    """When the cage becomes unstable, over draws of what wears film and pockets."""
    revolutions = plain_number(str(options.revolutions), "--revolutions")
    of.refuse_outside("--revolutions", revolutions, *REVOLUTIONS)
    of.refuse_samples(options.samples)
    speed = options.accelerated
    speed = parse(speed, "rad/s", "--accelerated") if isinstance(speed, str) else speed
    if speed is not None and not 0.0 < abs(speed) < MOST_SPEED:
        raise InputError("--accelerated", "must be above 0 and below 1e6 [rad/s]", f"{speed:g}")
    found = life(
        study,
        revolutions=revolutions,
        draws=options.samples,
        cases=asked_cases((), options.cases) if options.cases else (),
        accelerated=speed,
        runner=runner,
    )
    solution = solve(study, reference_candidate(study, study.ranking) if study.ranking else None)
    notes = (*found.notes, *of.extrapolation_notes(solution))
    return LifeAnswer(solution=solution, cage=of.cage_of(solution), life=found, notes=notes)


def sweep_answer(study: Study, options: SweepOptions, runner: Runner) -> Sweep:
    """Chain and, if asked, verdict of many cases of a study."""
    solution = solve(study)
    with contextlib.suppress(SeparatrixError):
        _ = solution.clearances  # for their notes
    cases = asked_cases(options.vary, options.cases)
    how: Any = {"runner": runner, "verdicts": options.verdicts, "margins": options.margins}
    return made_into(lambda found: replace(found, notes=solution.notes), lambda: sweep(study, cases, **how))
