"""The records that an answer arranges otherwise than field by field, and the arrays of some of them."""

from __future__ import annotations

from dataclasses import fields
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import MovingCage
from separatrix.cage.closed_forms import axial_half_play
from separatrix.chain.ball_mobility import Mobility
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.solution import Solution
from separatrix.ground.plain_data import (
    Group,
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
    MobilityAnswer,
    OfCage,
    RestitutionAnswer,
    SimulationAnswer,
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
    return shape(found.equilibrium) | {"contacts": _contacts(found)} | fields_of(found, "clearances")


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


def _chain(found: Solution) -> Node:
    """Restitution and the contacts, which have the slopes of their traction curves."""
    clearances = Leaf(None) if found.clearances is None else Group(shape(found.clearances))
    hertz = Leaf(found.restitution.restitution_factor_hertz, "-")
    more: Node = {"stiffness_source": Leaf(found.stiffness_source), "clearances": clearances}
    more["restitution_factor_hertz"] = hertz
    for race in ("inner", "outer"):
        at, curve = (getattr(part, race) for part in (found.bearing, found.slopes))
        more[race] = Group(shape(at) | fields_of(curve, "slope", "slope_error", "free_rolling_offset"))
    return shape(found.restitution) | more


RETURNED = ("impact_speed", "effective_restitution_factor")


@shape.register
def _(found: RestitutionAnswer) -> Node:
    node = _chain(found.solution) | fields_of(found, *RETURNED, "film_thickness_here", "lubrication")
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
    return node | {"chain": Group(_chain(found.solution) | orbits), "cage": Group(shape(found.cage))}


@shape.register
def _(found: SimulationAnswer) -> Node:
    """A motion that does not last has no whirl."""
    none = {"whirl_frequency": Leaf(None, "Hz"), "whirl_speed": Leaf(None, "m/s")}
    return _of_cage(found) | ({} if found.whirls else {**none, "whirl_direction": Leaf(0)})


@shape.register
def _(found: StabilityMap) -> Node:
    """Places of points have the units of their axes."""
    node = fields_of(found)
    points = node["points"]
    for row, at in zip(points.records or () if isinstance(points, Table) else (), found.points, strict=True):
        row |= {"x": Leaf(at.x, found.x.unit), "y": Leaf(at.y, found.y.unit)}
    return node


@shape.register
def _(axis: MapAxis) -> Node:
    """The values, and that of the study, have the unit that the axis states."""
    return fields_of(axis) | {"values": Leaf(axis.values, axis.unit), "here": Leaf(axis.here, axis.unit)}


@shape.register
def _(row: Ranked | NotFinished | NotMeasured | UncertainMaterial | NotDrawn) -> Node:
    """The evidence on the level of the row; a row that lacks something has the keys of a whole one."""
    is_ranked = not isinstance(row, UncertainMaterial | NotDrawn)
    evidence, over = (_evidence(getattr(row, name, None)) for name in ("judgement", "over_inputs"))
    whole = absent(Ranked if is_ranked else UncertainMaterial)
    node = evidence | whole | {"extrapolation": Leaf(())} | fields_of(row)
    del node["judgement"]
    if is_ranked:
        del node["over_inputs"]
        names = ("verdict", "probability_stable", "probability_low", "probability_high", "runs")
        node |= {f"uncertain_{name}": over[name] for name in names}
    return node


def _evidence(found: Judgement | None) -> Node:
    return absent(Judgement) if found is None else shape(found)


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
