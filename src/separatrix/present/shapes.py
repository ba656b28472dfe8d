"""The records that an answer arranges otherwise than field by field, and the arrays of some of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isfinite
from typing import TypeVar

import numpy as np

from separatrix.answers import (
    CheckAnswer,
    MapAnswer,
    MobilityAnswer,
    OfCage,
    RankingAnswer,
    RestitutionAnswer,
    SensitivityAnswer,
    SimulationAnswer,
    SpaceSimulationAnswer,
    StabilityAnswer,
    TractionAnswer,
)
from separatrix.cage import History, Judgement, PlanarCage, SpaceHistory
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.cage.planar import OUTCOME_SENTENCES, Cause
from separatrix.cage.reason import CAUSES
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.mobility import Mobility
from separatrix.chain.solution import Solution
from separatrix.chain.traction import ShearField, TractionCurve
from separatrix.explore.records import NotDrawn, UncertainMaterial
from separatrix.explore.sweep import Sweep
from separatrix.present.nodes import Group, Leaf, Node, Table, absent, fields_of
from separatrix.present.nodes import shape as shape
from separatrix.ranking.records import NotFinished, NotMeasured, Ranked
from separatrix.units import Rows

Key = TypeVar("Key")
Record = TypeVar("Record")


# The chain.


@shape.register
def _(found: Equilibrium) -> Node:
    """A row for each ball."""
    node = fields_of(found)
    rows: list[Node] = [{"ball": Leaf(ball)} for ball in range(found.azimuth.size)]
    for name, item in [*node.items()]:
        if isinstance(item, Leaf) and item.axes and item.axes[0] == "ball":
            del node[name]
            for row, value in zip(rows, np.asarray(item.value), strict=True):
                row[name] = Leaf(value, item.unit, item.axes[1:])
    return {"balls": Table(rows, Rows("ball", label="ball")), "most_loaded": Leaf(found.most_loaded), **node}


@shape.register
def _(at: RaceContact) -> Node:
    """Ellipse and creep on the level of the contact."""
    node = fields_of(at)
    del node["ellipse"], node["creep"]
    creep = {f"creep_{name}": item for name, item in shape(at.creep).items()}
    return node | shape(at.ellipse) | creep


@shape.register
def _(found: BearingState) -> Node:
    return shape(found.equilibrium) | {"contacts": _contacts(found), **_clearances(found.clearances)}


def _clearances(found: Clearances | None) -> Node:
    return {"clearances": Leaf(None) if found is None else Group(shape(found))}


def _contacts(found: BearingState) -> Group:
    return Group({"inner": Group(shape(found.inner)), "outer": Group(shape(found.outer))}, "contact_")


@shape.register
def _(found: CheckAnswer) -> Node:
    at_rest = Leaf(None) if found.static is None else _contacts(found.static)
    node: Node = {"static": at_rest, "static_reason": Leaf(found.static_reason)}
    return node | _clearances(found.clearances) | {"clearances_reason": Leaf(found.clearances_reason)}


@shape.register
def _(found: TractionAnswer) -> Node:
    at, models = found.bearing, shape(found.comparison)
    races: Node = {}
    for race in ("inner", "outer"):
        curve, others, shear = (getattr(found, f"{race}{part}") for part in ("", "_others", "_shear"))
        node = _curve(getattr(at, race), curve, others, shear)
        for model in ("strips", "exact"):
            own: TractionCurve | None = getattr(found, f"{race}_{model}")
            coefficient = None if own is None else own.traction_coefficient
            node[f"{model}_traction_coefficient"] = Leaf(coefficient, "-", ("increment",))
        races[race] = Group(node | {"free_rolling": models[race]})
    ranges = {"models": models["models"], "outside": models["outside"]}
    return {"race_friction": Leaf(found.race_friction, "-"), **races, **ranges}


def _curve(at: RaceContact, curve: TractionCurve, others: Sequence[TractionCurve], shear: ShearField) -> Node:
    """One race; the curves at other ratios are at the same increments as its own."""
    names = ("spin_roll_ratio", "slope", "slope_error", "traction_coefficient")
    by_ratio = Table([fields_of(other, *names) for other in others], Rows("ratio", "ratio_"))
    return shape(at) | shape(curve) | {"by_spin_roll_ratio": by_ratio, "shear": Group(shape(shear))}


def _chain(found: Solution) -> Node:
    """Restitution and the contacts, which have the slopes of their traction curves."""
    node = shape(found.restitution) | {"stiffness_source": Leaf(found.stiffness_source)}
    node |= _clearances(found.clearances)
    contacts, curves = found.bearing, found.slopes
    for race, at, curve in (
        ("inner", contacts.inner, curves.inner),
        ("outer", contacts.outer, curves.outer),
    ):
        node[race] = Group(shape(at) | fields_of(curve, "slope", "slope_error", "free_rolling_offset"))
    return node


@shape.register
def _(found: RestitutionAnswer) -> Node:
    node = _chain(found.solution) | {"film_thickness_here": Leaf(found.film_thickness, "m")}
    if found.wear is not None:
        node["wear"] = Group(shape(found.wear) | {"here": Leaf(_worn_share(found.solution), "-")})
    if found.exact_films is not None:
        node["exact_films"] = Group(shape(found.exact_films))
    if found.lubrication is not None:
        return node | {"lubrication": Group(shape(found.lubrication))}
    return node | {
        "lubrication": Leaf(None),
        "lubrication_reason": Leaf("The study names no film material."),
    }


def _worn_share(found: Solution) -> float:
    """Width of the study's worn band over that of the wider contact."""
    wear, contacts = found.study.film.wear, (found.bearing.inner, found.bearing.outer)
    if wear is None or wear.width is None:
        return 0.0 if wear is None else wear.share or 0.0
    return min(1.0, 0.5 * wear.width / max(at.ellipse.semi_major for at in contacts))


@shape.register
def _(found: Mobility) -> Node:
    """The small motion on the level of the mobility; the law with what it carries at most."""
    node = fields_of(found)
    del node["linear"], node["traction"]
    law: Node = fields_of(found.traction) | {"capacity": Leaf(found.traction.capacity, "N")}
    return shape(found.linear) | node | {"traction": Group(law)}


@shape.register
def _(found: MobilityAnswer) -> Node:
    rigid = shape(found.rigid)
    node = shape(found.mobility) | {"rigid": Group(rigid)}
    impacts = Leaf(None) if found.impacts is None else Group(shape(found.impacts))
    return node | {"impacts": impacts, "impacts_reason": Leaf(found.impacts_reason)}


# The cage.


@shape.register
def _(found: PlanarCage) -> Node:
    """The race damping of balls that their races grip, which is infinite, is None."""
    node = fields_of(found)
    return node if isfinite(found.race_damping) else node | {"race_damping": Leaf(None, "N s/m")}


@shape.register
def _cage(found: OfCage) -> Node:
    """The cage and the chain before it, with the leads of the balls beside their clearance."""
    orbits: Node = {
        "half_play": Leaf(found.cage.half_play, "m"),
        "lead_amplitude": Leaf(found.cage.lead_amplitude, "m"),
        "orbital_share": Leaf(found.solution.orbital_share, "-"),
    }
    return {"chain": Group(_chain(found.solution) | orbits), "cage": Group(shape(found.cage))}


@shape.register
def _(found: StabilityAnswer) -> Node:
    return shape(found.curve) | _cage(found)


@shape.register
def _(found: MapAnswer) -> Node:
    return shape(found.map) | _cage(found)


def outcome_sentence(history: History | SpaceHistory) -> str:
    """Return in words where the motion of a run ends."""
    if history.cause is Cause.LAND_FRICTION:
        return "The motion lasts: friction on the land, not in the pockets, keeps the cage moving."
    cause = CAUSES.get(history.cause)
    return OUTCOME_SENTENCES[history.outcome] + (f" Cause: {cause}." if cause else "")


@shape.register
def _(found: SimulationAnswer) -> Node:
    history, cage = found.history, found.cage
    rubbing = cage.land_friction * history.rubbing_force * history.rubbing_speed
    node: Node = {
        "kick": Leaf(found.kick, "m/s"),
        "run": Leaf(found.run),
        "outcome_sentence": Leaf(outcome_sentence(history)),
        "largest_offset": Leaf(np.hypot(*history.position.T).max(), "m"),
        "largest_contact_force": Leaf(np.abs(history.contact_force).max(), "N"),
        "drift_rate_law": Leaf(drift_rate_law(cage), "1/s"),
        "rubbing_power": Leaf(rubbing, "W"),
    }
    return node | shape(history) | _cage(found)


@shape.register
def _(found: SpaceSimulationAnswer) -> Node:
    history, analysis = shape(found.history), shape(found.analysis)
    node: Node = {
        "kick": Leaf(found.kick, "m/s"),
        "run": Leaf(found.run),
        "outcome_sentence": Leaf(outcome_sentence(found.history)),
    }
    largest = {name: analysis.pop(name) for name in ("largest_offset", "largest_axial", "largest_tilt")}
    return node | largest | history | {"analysis": Group(analysis)} | _cage(found)


# Rankings. Every row has the keys of a ranked one, None where it has no value.


@shape.register(Ranked)
@shape.register(NotFinished)
@shape.register(NotMeasured)
def _(row: Ranked | NotFinished | NotMeasured) -> Node:
    """The evidence on the level of the row."""
    all_three = (getattr(row, name, None) for name in ("judgement", "over_inputs", "other_ball"))
    evidence, over, other = (absent(Judgement) if one is None else shape(one) for one in all_three)
    names = ("verdict", "probability_stable", "probability_low", "probability_high", "runs")
    node = evidence | absent(Ranked) | {"extrapolation": Leaf(())} | fields_of(row)
    del node["judgement"], node["over_inputs"], node["other_ball"]
    more = {f"other_ball_{name}": other[name] for name in (*names, "largest_contact_force")}
    return node | {f"uncertain_{name}": over[name] for name in names} | more


@shape.register(UncertainMaterial)
@shape.register(NotDrawn)
def _(row: UncertainMaterial | NotDrawn) -> Node:
    """The evidence on the level of the row."""
    judged = getattr(row, "judgement", None)
    evidence = absent(Judgement) if judged is None else shape(judged)
    node = evidence | absent(UncertainMaterial) | {"extrapolation": Leaf(())} | fields_of(row)
    del node["judgement"]
    return node


@shape.register
def _(found: RankingAnswer) -> Node:
    node = shape(found.ranking)
    del node["notes"]
    return node | _cage(found)


@shape.register
def _(found: SensitivityAnswer) -> Node:
    return shape(found.uncertain) | _cage(found)


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
    rest: Node = {"verdicts": Leaf(found.verdicts), "margins": Leaf(found.margins)}
    for name, part in (("worst", found.worst), ("duty", found.duty)):
        rest[name] = Leaf(None) if part is None else Group(shape(part))
    rest["complete"] = Leaf(found.complete)
    return {"parameters": Table(named, Rows()), "cases": Table(cases, Rows("case")), **rest}


def all_notes(answer: object, notes: Iterable[str]) -> list[str]:
    """Return warnings with those that an answer has itself, each once."""
    own: tuple[str, ...] = ()
    if isinstance(answer, RankingAnswer):
        own = answer.ranking.notes
    elif isinstance(answer, SensitivityAnswer):
        own = answer.uncertain.notes
    return list(dict.fromkeys([*notes, *own]))
