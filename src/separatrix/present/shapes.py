"""The records that an answer arranges otherwise than field by field, and the arrays of some of them."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

import numpy as np

from separatrix.answers import (
    CheckAnswer,
    MapAnswer,
    OfCage,
    RankingAnswer,
    RestitutionAnswer,
    SensitivityAnswer,
    SimulationAnswer,
    StabilityAnswer,
    TractionAnswer,
)
from separatrix.cage import History, Judgement
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.cage.planar import OUTCOME_SENTENCES
from separatrix.cage.reason import CAUSES
from separatrix.chain.contacts import BearingState, RaceContact
from separatrix.chain.equilibrium import Equilibrium
from separatrix.chain.solution import Solution
from separatrix.chain.traction import ShearField, TractionCurve
from separatrix.explore.records import AllowedFilm, NotDrawn, Share, UncertainMaterial, UncertainStudy
from separatrix.explore.sweep import Sweep
from separatrix.present.walk import Group, Leaf, Node, Table, absent, fields_of
from separatrix.present.walk import shape as shape
from separatrix.ranking import NotFinished, NotMeasured, Ranked
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
    return shape(found.equilibrium) | {"contacts": _contacts(found)}


def _contacts(found: BearingState) -> Group:
    return Group({"inner": Group(shape(found.inner)), "outer": Group(shape(found.outer))}, "contact_")


@shape.register
def _(found: CheckAnswer) -> Node:
    at_rest = Leaf(None) if found.static is None else _contacts(found.static)
    return {"static": at_rest, "static_reason": Leaf(found.static_reason)}


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
    contacts, curves = found.bearing, found.traction
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


# The cage.


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


def outcome_sentence(history: History) -> str:
    """Return in words where the motion of a run ends."""
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


# Rankings. Every row has the keys of a ranked one, None where it has no value.


@shape.register(Ranked)
@shape.register(NotFinished)
@shape.register(NotMeasured)
def _(row: Ranked | NotFinished | NotMeasured) -> Node:
    """The evidence on the level of the row."""
    judged, drawn = (getattr(row, name, None) for name in ("judgement", "over_inputs"))
    evidence, over = (absent(Judgement) if one is None else shape(one) for one in (judged, drawn))
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
    rest: Node = {"verdicts": Leaf(found.verdicts), "complete": Leaf(found.complete)}
    return {"parameters": Table(named, Rows()), "cases": Table(cases, Rows("case")), **rest}


def all_notes(answer: object, notes: Iterable[str]) -> list[str]:
    """Return warnings with those that an answer has itself, each once."""
    own: tuple[str, ...] = ()
    if isinstance(answer, RankingAnswer):
        own = answer.ranking.notes
    elif isinstance(answer, SensitivityAnswer):
        own = answer.uncertain.notes
    return list(dict.fromkeys([*notes, *own]))


# Datasets of answers whose arrays are not those of their records one by one.


@functools.singledispatch
def arranged(answer: object) -> Node:
    """Return the node of an answer as its dataset has it."""
    return shape(answer)


@arranged.register
def _(found: Sweep) -> Node:
    node = shape(found)
    return node | {"parameters": Group({"parameter": Leaf([one.name for one in found.parameters])}, "")}


@arranged.register
def _(found: MapAnswer) -> Node:
    """Points on the dimensions (y, x); bands along `change`."""
    node, record = shape(found), found.map
    size = len(record.x.values), len(record.y.values)
    for name, axis in (("x", record.x), ("y", record.y)):
        node[name] = Leaf(axis.values, axis.unit, (name,), axis.parameter)
        node[f"{name}_here"] = Leaf(axis.here, axis.unit)
        node[f"{name}_parameter"] = Leaf(axis.parameter)
    points, changes = node.pop("points"), node["changes"]
    rows = (points.records if isinstance(points, Table) else None) or [{}]
    for name in [key for key in rows[0] if key not in ("x", "y")]:
        column = [row[name] for row in rows]
        values = [one.value if isinstance(one, Leaf) else None for one in column]
        unit = next((one.unit for one in column if isinstance(one, Leaf)), None)
        table = [[values[i * size[1] + j] for i in range(size[0])] for j in range(size[1])]
        node[name] = Leaf(table, record.y.unit if name == "margin" else unit, ("y", "x"))
    units = {"x": record.x.unit, "y_low": record.y.unit, "y_high": record.y.unit}
    bands: list[Node] = (changes.records if isinstance(changes, Table) else None) or []
    for band in bands:
        band |= {name: Leaf(getattr(band[name], "value", None), unit) for name, unit in units.items()}
    return node


DOCUMENT_ONLY = ("undecided", "next_tests", "notes", "allowed_friction", "allowed_films")
CASES = ("environment", "material")


@arranged.register
def _(found: SensitivityAnswer) -> Node:
    """Convergence, clouds, drivers and films as arrays over environments and materials."""
    node, record = shape(found), found.uncertain
    for name in (*DOCUMENT_ONLY, "convergence", "clouds", "drivers", "shares"):
        del node[name]
    places = [one.name for one in record.environments]
    materials = sorted(row.name for row in record.overall)
    sizes = sorted({size for one in record.convergence for size in one.size})
    node |= {"size": Leaf(sizes, None, ("size",)), "place": Leaf([*places, ""], None, ("place",))}
    for key in ("probability_stable", "probability_low", "probability_high"):
        values = {
            (one.environment, one.name): dict(zip(one.size, getattr(one, key), strict=True))
            for one in record.convergence
        }
        grid = _grid(values, [*places, ""], materials, sizes)
        node[f"convergence_{key}"] = Leaf(grid, "-", ("place", "material", "size"))
    samples = range(max((len(one.friction) for one in record.clouds), default=0))
    for key in ("restitution_factor", "friction", "settles"):
        clouds = {(one.environment, one.name): dict(enumerate(getattr(one, key))) for one in record.clouds}
        node[f"cloud_{key}"] = Leaf(_grid(clouds, places, materials, samples), "-", (*CASES, "sample"))
    return node | _drivers(record, places, materials) | _smooth(record) | _films(found, materials)


def _grid(
    values: Mapping[tuple[str, str], Mapping[Key, float]],
    places: Iterable[str],
    materials: Sequence[str],
    labels: Sequence[Key],
) -> list[list[list[float | None]]]:
    """Return the values of each case by place, material and label; None where there is none."""
    return [[[values.get((p, m), {}).get(one) for one in labels] for m in materials] for p in places]


def _shares(shares: Iterable[Share], end: str) -> dict[str, float]:
    return {one.name: getattr(one, f"share{end}") for one in shares}


def _drivers(record: UncertainStudy, places: Sequence[str], materials: Sequence[str]) -> Node:
    """Shares by input, chance last, and the calibration; nothing where no case has any."""
    known = {(one.environment, one.name): one for one in record.drivers if one.shares}
    if not known:
        return {}
    chance = next(iter(known.values())).shares[-1].name
    names = dict.fromkeys(one.name for case in known.values() for one in case.shares if one.name != chance)
    drivers = [*names, chance]
    node: Node = {"driver": Leaf(drivers, None, ("driver",))}
    for end in ("", "_low", "_high"):
        grid = _grid({c: _shares(one.shares, end) for c, one in known.items()}, places, materials, drivers)
        node[f"driver_share{end}"] = Leaf(grid, "-", (*CASES, "driver"))
    bins = range(max(len(one.predicted) for one in known.values()))
    for key in ("predicted", "counted"):
        values = {case: dict(enumerate(getattr(one, key))) for case, one in known.items()}
        node[f"calibration_{key}"] = Leaf(_grid(values, places, materials, bins), "-", (*CASES, "bin"))
    return node


def _smooth(record: UncertainStudy) -> Node:
    if not record.shares:
        return {}
    names = [one.name for one in record.shares[0].total]
    node: Node = {
        "quantity": Leaf([one.quantity for one in record.shares], None, ("quantity",)),
        "chain_input": Leaf(names, None, ("chain_input",)),
    }
    for kind in ("first", "total"):
        for end in ("", "_low", "_high"):
            rows = [_shares(getattr(one, kind), end) for one in record.shares]
            table = [[row[name] for name in names] for row in rows]
            node[f"sobol_{kind}{end}"] = Leaf(table, "-", ("quantity", "chain_input"))
    return node


def _films(found: SensitivityAnswer, materials: Sequence[str]) -> Node:
    """Which films keep each candidate stable, and the film of the study."""
    films = {one.name: one for one in found.uncertain.allowed_films}
    first = next(iter(films.values()), None)
    if first is None or not first.film_thickness.size:
        return {}
    none = np.full_like(first.film_restitution_factor, np.nan)
    factors = [films[name].film_restitution_factor if name in films else none for name in materials]
    limits = [_limit(films[name]) if name in films else None for name in materials]
    return {
        "race_friction": Leaf(first.race_friction, "-", ("race_friction",)),
        "film_thickness": Leaf(first.film_thickness, "m", ("film_thickness",)),
        "film_restitution_factor": Leaf(
            np.array(factors), "-", ("material", "race_friction", "film_thickness")
        ),
        "film_limit": Leaf(limits, "-", ("material",)),
        "film_probability": Leaf(first.probability, "-"),
        "film_thickness_here": Leaf(found.film_thickness, "m"),
        "race_friction_here": Leaf(found.race_friction, "-"),
    }


def _limit(film: AllowedFilm) -> float:
    """Return the largest restitution factor allowed: 1 where every one is, -1 where none is."""
    if film.restitution_factor is not None:
        return film.restitution_factor
    return 1.0 if film.reason.startswith("more") else -1.0
