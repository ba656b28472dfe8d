"""The records that an answer arranges otherwise than field by field, and the arrays of some of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import MovingCage
from separatrix.cage.closed_forms import axial_half_play, drift_rate_law
from separatrix.chain.ball_mobility import Mobility
from separatrix.chain.clearances import Clearances
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.shear import ShearField
from separatrix.chain.solution import Solution
from separatrix.chain.traction_curve import TractionCurve
from separatrix.ground.plain_data import (
    Group,
    Item,
    Leaf,
    Node,
    Table,
    absent,
    fields_of,
    node_of,
    plain,
    units_of,
)
from separatrix.ground.plain_data import shape as shape
from separatrix.ground.units import Rows
from separatrix.verbs.answer_records import (
    CheckAnswer,
    MapAnswer,
    MobilityAnswer,
    OfCage,
    RankingAnswer,
    RestitutionAnswer,
    SensitivityAnswer,
    SimulationAnswer,
    StabilityAnswer,
    TractionAnswer,
)
from separatrix.verdict.judgement import Judgement
from separatrix.verdict.map_records import MapAxis, StabilityMap
from separatrix.verdict.ranking_records import NotFinished, NotMeasured, Ranked
from separatrix.verdict.swept_cases import Sweep
from separatrix.verdict.uncertain_records import NotDrawn, UncertainMaterial

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


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
    node: Node = {
        "refusals": Table([fields_of(one) for one in found.refusals], Rows()),
        **fields_of(found, "speed_parameter", "cage"),
        "static": at_rest,
        "static_reason": Leaf(found.static_reason),
    }
    return node | _clearances(found.clearances) | {"clearances_reason": Leaf(found.clearances_reason)}


@shape.register
def _(found: TractionAnswer) -> Node:
    races: Node = {}
    for race in ("inner", "outer"):
        curve, others, shear = (getattr(found, f"{race}{part}") for part in ("", "_others", "_shear"))
        races[race] = Group(_curve(getattr(found.bearing, race), curve, others, shear))
    return {"race_friction": Leaf(found.race_friction, "-"), **races, "outside": Leaf(found.outside)}


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
    if found.lubrication is not None:
        return node | {"lubrication": Group(shape(found.lubrication))}
    return node | {
        "lubrication": Leaf(None),
        "lubrication_reason": Leaf("The study names no film material."),
    }


@shape.register
def _(found: Mobility) -> Node:
    """The small motion on the level of the mobility; the law with what it carries at most."""
    node = fields_of(found)
    del node["linear"], node["traction"]
    law: Node = fields_of(found.traction) | {"capacity": Leaf(found.traction.capacity, "N")}
    return shape(found.linear) | node | {"traction": Group(law)}


@shape.register
def _(found: MobilityAnswer) -> Node:
    return shape(found.mobility) | {"rigid": Group(shape(found.rigid))}


# The cage.


@shape.register
def _(found: MovingCage) -> Node:
    """What is infinite, as the damping of balls that their races grip, is None."""
    node: Node = {
        name: item._replace(value=None) if isinstance(item, Leaf) and item.value == inf else item
        for name, item in fields_of(found).items()
    }
    return node | {"axial_half_play": Leaf(axial_half_play(found) if found.is_in_space else None, "m")}


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
def _(found: StabilityMap) -> Node:
    """Places of points have the units of their axes."""
    node = fields_of(found)
    points = node["points"]
    for row in (points.records or []) if isinstance(points, Table) else []:
        row |= {"x": _in_unit(row["x"], found.x.unit), "y": _in_unit(row["y"], found.y.unit)}
    return node


def _in_unit(item: Item, unit: str | None) -> Item:
    return item._replace(unit=unit) if isinstance(item, Leaf) else item


@shape.register
def _(axis: MapAxis) -> Node:
    """The values, and that of the study, have the unit that the axis states."""
    return fields_of(axis) | {"values": Leaf(axis.values, axis.unit), "here": Leaf(axis.here, axis.unit)}


@shape.register
def _(found: MapAnswer) -> Node:
    return shape(found.map) | _cage(found)


@shape.register
def _(found: SimulationAnswer) -> Node:
    pace = found.history.whirl_frequency if found.whirls else None
    node: Node = {
        "kick": Leaf(found.kick, "m/s"),
        "run": Leaf(found.run),
        "given_restitution_factor": Leaf(found.given_restitution_factor, "-"),
        "outcome_sentence": Leaf(found.outcome_sentence),
        "force_limit": Leaf(found.force_limit, "N"),
        "force_exceeds_races": Leaf(found.force_exceeds_races),
        "drift_rate_law": Leaf(drift_rate_law(found.cage), "1/s"),
        "rubbing_power": Leaf(found.rubbing_power, "W"),
    }
    node |= shape(found.history) | shape(found.analysis) | {"whirl_frequency": Leaf(pace, "Hz")}
    if not found.whirls:
        node |= {"whirl_speed": Leaf(None, "m/s"), "whirl_direction": Leaf(0)}
    return node | _cage(found)


# Rankings. Every row has the keys of a ranked one, None where it has no value.


@shape.register(Ranked)
@shape.register(NotFinished)
@shape.register(NotMeasured)
def _(row: Ranked | NotFinished | NotMeasured) -> Node:
    """The evidence on the level of the row."""
    both = (getattr(row, name, None) for name in ("judgement", "over_inputs"))
    evidence, over = (absent(Judgement) if one is None else shape(one) for one in both)
    names = ("verdict", "probability_stable", "probability_low", "probability_high", "runs")
    node = evidence | absent(Ranked) | {"extrapolation": Leaf(())} | fields_of(row)
    del node["judgement"], node["over_inputs"]
    return node | {f"uncertain_{name}": over[name] for name in names}


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
    return shape(found.ranking) | _cage(found)


@shape.register
def _(found: SensitivityAnswer) -> Node:
    here = {
        "film_thickness_here": Leaf(found.film_thickness, "m"),
        "race_friction_here": Leaf(found.race_friction, "-"),
    }
    return shape(found.uncertain) | here | _cage(found)


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


def to_xarray(answer: object) -> xr.Dataset:
    """Return the labelled arrays of an answer, with their units, without the study behind it."""
    from separatrix.present.dataset import arrays_of

    node = Group(shape(answer))
    return arrays_of(node_of(plain(node, left_out=[]), units_of(node)))


def to_dataframe(answer: object, *dims: str) -> pd.DataFrame:
    """Return the arrays of an answer that have the same dimensions as a table, a row for each place.

    Parameters
    ----------
    answer : record
        What a verb computed.
    *dims : str
        Names of the dimensions; by default those of its main table: the balls of a bearing, the points of
        traction curves, of a stability curve and of a map, the samples of a run, the candidates in each
        environment, the cases of a sweep. ``("environment", "material", "sample")`` are the single bearings
        behind the probabilities of `sensitivity`.

    Returns
    -------
    pandas.DataFrame
        Values in SI units. A variable with one more dimension has a column for each place on it.
    """
    import xarray as xr

    data = to_xarray(answer)
    wanted = dims or next(one for one in MAIN if set(one) <= set(data.dims))
    columns: dict[str, xr.DataArray] = {}
    for name, variable in data.data_vars.items():
        if variable.dims == wanted:
            columns[str(name).removeprefix(f"{wanted[-1]}_")] = variable
        elif len(wanted) == 1 and variable.dims[:1] == wanted and variable.ndim == 2:
            columns |= {f"{name}_{i}": variable[:, i] for i in range(variable.shape[1])}
    return xr.Dataset(columns).reset_coords(drop=True).to_dataframe(dim_order=list(wanted))


MAIN = (
    *(("case",), ("y", "x"), ("time",), ("environment", "material"), ("restitution_factor",)),
    *(("race", "increment"), ("push",), ("ball",), ("race",)),
)
"""Dimensions of the main tables; an answer has that of the first that it has."""
