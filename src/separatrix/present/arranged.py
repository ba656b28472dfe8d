"""Answers as nodes of their datasets, where their arrays are not those of their records one by one."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

import numpy as np

from separatrix.answers import MapAnswer, SensitivityAnswer, TractionAnswer
from separatrix.explore.records import AllowedFilm, Share, UncertainStudy
from separatrix.explore.sweep import Sweep
from separatrix.present.contact import padded
from separatrix.present.shapes import shape
from separatrix.present.walk import Group, Leaf, Node, Table

Key = TypeVar("Key")

AREA = {
    "along": ("m", ("column",)),
    "across": ("m", ("row",)),
    "fraction": ("-", ("row", "column")),
    "pressure": ("Pa", ("row", "column")),
    "traction": ("Pa", ("direction", "row", "column")),
    "slip": ("-", ("direction", "row", "column")),
    "stick": ("-", ("row", "column")),
    "stick_line": ("m", ("row",)),
}
"""Fields of an exact contact with their units and axes."""


@functools.singledispatch
def arranged(answer: object) -> Node:
    """Return the node of an answer as its dataset has it."""
    return shape(answer)


@arranged.register
def _(found: TractionAnswer) -> Node:
    """With the fields of the exact contacts; where their grids differ the smaller one ends in NaN."""
    node, areas = shape(found), (found.inner_area, found.outer_area)
    solutions = [area.solution for area in areas if area is not None]
    if len(solutions) < len(areas):
        return node
    size = {"row": max(x.across.size for x in solutions), "column": max(x.along.size for x in solutions)}
    for race, area in zip(("inner", "outer"), areas, strict=True):
        group = node[race]
        if area is None or not isinstance(group, Group):
            continue
        for name, (unit, axes) in AREA.items():
            value = area.stick_line if name == "stick_line" else getattr(area.solution, name)
            shown = padded(value, tuple(size.get(axis, 2) for axis in axes))
            group.fields[f"area_{name}"] = Leaf(shown, unit, axes)
    return node


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
