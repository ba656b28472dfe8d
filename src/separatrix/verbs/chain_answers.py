"""Answers of the chain: their records, with what belongs beside them, and how these are arranged.

The answer of `bearing` is a `BearingState`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from separatrix.chain.ball_mobility import LinearMobility, Mobility
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.impact_restitution import LubricationCurve
from separatrix.chain.solution import Solution
from separatrix.chain.traction_curve import ShearField, TractionCurve
from separatrix.ground.plain_data import Group, Leaf, Node, Table, fields_of, shape
from separatrix.ground.units import (
    Kilogram,
    Metre,
    MetrePerSecond,
    MetreRadianPerSecond,
    Radian,
    Ratio,
    Rows,
    Second,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Refusal:
    """What a verb would refuse of a study."""

    verb: str  # that refuses the study
    sentence: str  # why, and what to do


@dataclass(frozen=True, slots=True, kw_only=True)
class LongVerb:
    """A verb that takes more than a minute of one core."""

    verb: str  # that takes long
    one_core_time: Second  # expected of one core, within a factor of 3


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedCage:
    """What follows of a cage from its study: its mass, and how far it may move at rest."""

    mass: Kilogram  # as stated, of its shape, or of a thin ring
    half_play: Metre  # of a ball in its pocket, each way along the circumference
    lean: Radian  # of the contact of ball and pocket, towards the bearing axis
    land_gap: Metre | None  # least radial gap of the land; null without a land


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckAnswer:
    """The bearing at standstill, and the running clearances of the cage; None with the reason if refused.

    The clearances are also None, without a reason, for a study that states the running ones.
    """

    refusals: tuple[Refusal, ...]  # what each verb would refuse of the study
    long_verbs: tuple[LongVerb, ...]  # of `stability` and `rank`, those that take long
    speed_parameter: MetreRadianPerSecond  # bore, or pitch diameter where no bore is known, times speed
    cage: CheckedCage | None  # null without a cage
    static: BearingState | None  # contacts of the most loaded ball at standstill; null if refused
    static_reason: str  # why there are no contacts at standstill; empty if there are
    clearances: Clearances | None  # running clearances; null if refused, or if the study states them
    clearances_reason: str  # why the running clearances were refused; empty if they were not
    notes: tuple[str, ...]  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class TractionAnswer:
    """Traction curves by the study's model, by strips at other spin-to-roll ratios, and the shear."""

    race_friction: Ratio  # f_BT, of ball on race
    bearing: BearingState  # equilibrium and contacts
    inner: TractionCurve  # curve of the inner race by the study's model
    outer: TractionCurve  # curve of the outer race by the study's model
    inner_others: tuple[TractionCurve, ...]  # inner race at other spin-to-roll ratios
    outer_others: tuple[TractionCurve, ...]  # outer race at other spin-to-roll ratios
    inner_shear: ShearField  # shear of strips in free rolling, inner race
    outer_shear: ShearField  # shear of strips in free rolling, outer race
    outside: tuple[str, ...]  # where the strips leave their range, a sentence each
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionAnswer:
    """Restitution factor, and what it would be with other films; None without a film material."""

    solution: Solution  # the chain
    impact_speed: MetrePerSecond  # of the reference disturbance
    effective_restitution_factor: Ratio
    """What an impact at that speed returns, with a ball of one state and the mass that it feels."""
    film_thickness_here: Metre  # of the study's own film
    lubrication: LubricationCurve | None  # restitution factor against the thickness of other films
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


@dataclass(frozen=True, slots=True, kw_only=True)
class MobilityAnswer:
    """Mobility of the most loaded ball, and its small motion between rigid bodies."""

    mobility: Mobility  # by the slip fields of the study's contacts
    rigid: LinearMobility  # small motion of the same ball between rigid bodies
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


# How these records, and those in them, are arranged otherwise than field by field.


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
    more = fields_of(found, "clearances", "heat", "pair")
    return shape(found.equilibrium) | {"contacts": _contacts(found)} | more


def _contacts(found: BearingState) -> Group:
    return Group(fields_of(found, "inner", "outer"), "contact_")


@shape.register
def _(found: CheckAnswer) -> Node:
    """At standstill the contacts alone."""
    return fields_of(found) | ({"static": _contacts(found.static)} if found.static else {})


@shape.register
def _(found: TractionAnswer) -> Node:
    """Each race with its contact; the curves at other ratios are at the same increments as its own."""
    races: Node = {}
    names = ("spin_roll_ratio", "slope", "slope_error", "traction_coefficient")
    for race in ("inner", "outer"):
        at = getattr(found.bearing, race)
        curve, others, shear = (getattr(found, f"{race}{part}") for part in ("", "_others", "_shear"))
        by_ratio = Table([fields_of(other, *names) for other in others], Rows("ratio", "ratio_"))
        more: Node = {"by_spin_roll_ratio": by_ratio, "shear": Group(shape(shear))}
        races[race] = Group(shape(at) | shape(curve) | more)
    return fields_of(found, "race_friction") | races | fields_of(found, "outside")


def chain_node(found: Solution) -> Node:
    """Restitution and the contacts, which have the slopes of their traction curves."""
    clearances = Leaf(None) if found.clearances is None else Group(shape(found.clearances))
    more: Node = {"stiffness_source": Leaf(found.stiffness_source), "clearances": clearances}
    more["restitution_factor_hertz"] = Leaf(found.restitution.restitution_factor_hertz, "-")
    for race in ("inner", "outer"):
        at, curve = (getattr(part, race) for part in (found.bearing, found.slopes))
        more[race] = Group(shape(at) | fields_of(curve, "slope", "slope_error", "free_rolling_offset"))
    return shape(found.restitution) | more


@shape.register
def _(found: RestitutionAnswer) -> Node:
    own = ("impact_speed", "effective_restitution_factor", "film_thickness_here", "lubrication")
    node = chain_node(found.solution) | fields_of(found, *own)
    reason = Leaf("The study names no film material.")
    return node if found.lubrication else node | {"lubrication_reason": reason}


@shape.register
def _(found: Mobility) -> Node:
    """The small motion on the level of the mobility; the law with what it carries at most."""
    node = fields_of(found)
    del node["linear"], node["traction"]
    law: Node = fields_of(found.traction) | {"capacity": Leaf(found.traction.capacity, "N")}
    return shape(found.linear) | node | {"traction": Group(law)}


@shape.register
def _(found: MobilityAnswer) -> Node:
    return shape(found.mobility) | fields_of(found, "rigid")
