"""Answers about a moving cage: their records, and how these are arranged.

The answer of `sweep` is a `Sweep`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import inf

from separatrix.cage import CourseAnalysis, History, MovingCage
from separatrix.cage.closed_forms import axial_half_play
from separatrix.chain.solution import Solution
from separatrix.ground.plain_data import Group, Leaf, Node, Table, absent, fields_of, shape
from separatrix.ground.units import MetrePerSecond, Newton, PerSecond, Ratio, Rows, Watt
from separatrix.verbs.chain_answers import chain_node
from separatrix.verdict.judgement import Judgement
from separatrix.verdict.parameter_axes import MapAxis
from separatrix.verdict.ranking_records import NotFinished, NotMeasured, Ranked, Ranking
from separatrix.verdict.rig_signs import RigSigns, lasts
from separatrix.verdict.stability_curve import StabilityCurve
from separatrix.verdict.stability_map import StabilityMap
from separatrix.verdict.swept_cases import Sweep
from separatrix.verdict.uncertain_study import NotDrawn, UncertainMaterial, UncertainStudy
from separatrix.verdict.wear_life import Life


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
    speeds = dict.fromkeys(("whirl_speed", "grown_speed"), Leaf(None, "m/s"))
    none = {"whirl_frequency": Leaf(None, "Hz"), **speeds}
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
