"""Records as labelled arrays with units, as tables of pandas, and back from a netCDF file."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import xarray as xr

from separatrix.answers import MapAnswer, SensitivityAnswer
from separatrix.explore.records import AllowedFilm, Share, UncertainStudy
from separatrix.explore.sweep import Sweep
from separatrix.ground.units import Rows
from separatrix.present.container import DAMAGE, check_container, damaged
from separatrix.present.nodes import Group, Leaf, Node, Table, plain
from separatrix.present.shapes import all_notes, shape

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from separatrix.study.study import Study

RACES = ("inner", "outer")
Columns = dict[str, Leaf]
"""Variables by name; every leaf has its axes."""


def dataset(verb: str, answer: object, study: Study, notes: Sequence[str]) -> xr.Dataset:
    """Return the labelled arrays of an answer, with units and provenance in their attributes.

    A missing number is the netCDF missing value, a missing text is empty; its reason is in the variable
    `reason` beside it.
    """
    from separatrix import __version__
    from separatrix.study.sources import resolved

    data = to_xarray(answer)
    data.attrs |= {
        "separatrix_version": __version__,
        "verb": verb,
        "title": study.title,
        "name": study.name,
        "study": json.dumps(plain(resolved(study), "study")),
        "seed": study.stability.seed,
        "warnings": json.dumps(all_notes(answer, notes)),
    }
    return data


def to_xarray(answer: object) -> xr.Dataset:
    """Return the labelled arrays of an answer, with their units, without the study behind it."""
    node = arranged(answer)
    complete = {"complete": json.dumps(plain(node.pop("complete")))} if "complete" in node else {}
    eta = node.get("restitution_factor")
    if isinstance(eta, Leaf) and eta.axes is None:  # a single number with the name of a dimension
        node["chain_restitution_factor"] = node.pop("restitution_factor")
    return xr.Dataset({name: variable(leaf) for name, leaf in _flat(node).items()}, attrs=complete)


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


def save(data: xr.Dataset, path: Path) -> None:
    """Write the dataset as netCDF; `load` reads it."""
    data.to_netcdf(path, engine="h5netcdf")


def load(path: Path | str) -> xr.Dataset:
    """Return a saved dataset, in memory; a file that is not one of ours is refused: see `container`."""
    path = Path(path)
    check_container(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            return data.load()
    except DAMAGE as error:
        raise damaged(str(path), error) from error


def _flat(node: Node) -> Columns:
    """Return each variable of a node; records in a list become columns, both races one more dimension."""
    rest, columns = dict(node), Columns()
    races = [rest.get(race) for race in RACES]
    if all(isinstance(one, Group) for one in races):
        records = [one.fields for one in races if isinstance(one, Group)]
        columns |= _stacked(Table(records, Rows("race")))
        columns["race"] = Leaf(list(RACES), None, ("race",))
        rest = {key: item for key, item in rest.items() if key not in RACES}
    for key, item in rest.items():
        if isinstance(item, Group):
            columns |= _prefixed(f"{key}_" if item.prefix is None else item.prefix, _flat(item.fields))
        elif isinstance(item, Table):
            columns |= _prefixed(item.rows.prefix, _stacked(item))
        else:
            columns[key] = _with_axes(key, item)
    return columns


def _with_axes(name: str, leaf: Leaf) -> Leaf:
    """Return a leaf with its axes: its own name if the type states none. Texts are joined to one."""
    value = leaf.value
    if not isinstance(value, list | tuple | np.ndarray):
        return leaf._replace(axes=())
    if isinstance(value, tuple) and leaf.axes is None and all(isinstance(one, str) for one in value):
        return leaf._replace(value="; ".join(value), axes=())
    return leaf if leaf.axes is not None else leaf._replace(axes=(name,))


def _prefixed(prefix: str, columns: Columns) -> Columns:
    """Put a prefix before every name that is not that of a dimension."""
    return {name if (name,) == leaf.axes else prefix + name: leaf for name, leaf in columns.items()}


def _stacked(table: Table) -> Columns:
    """Return the columns of records that have the same keys, with one more dimension in front.

    Materials are sorted by name, so that each has the same place everywhere.
    """
    dimension, _, label = table.rows
    records = table.records or []
    if dimension == "material":
        records = sorted(records, key=lambda one: str(plain(one[label])))
    flat = [_flat({key: item for key, item in one.items() if key != label}) for one in records]
    columns: Columns = {}
    for name in dict.fromkeys(name for one in flat for name in one):
        like = max((one[name] for one in flat if name in one), key=lambda leaf: len(leaf.axes or ()))
        if (name,) == like.axes:  # the places on a dimension inside
            columns[name] = like
            continue
        blank = _blank(plain(like.value, left_out=[])) if like.axes else None
        found = [one[name] if name in one else Leaf(None, None, ()) for one in flat]
        values = [one.value if one.axes == like.axes else blank for one in found]
        columns[name] = like._replace(value=values, axes=(dimension, *(like.axes or ())))
    if label and records:
        places = [one[label] for one in records]
        unit = next((one.unit for one in places if isinstance(one, Leaf)), None)
        columns[dimension] = Leaf([plain(one) for one in places], unit, (dimension,))
    return columns


def variable(leaf: Leaf) -> xr.Variable:
    """Return a leaf with its axes as a variable with its unit."""
    attributes = {"units": leaf.unit, "long_name": leaf.long_name}
    attrs = {name: value for name, value in attributes.items() if value}
    return xr.Variable(leaf.axes or (), _array(leaf.value, is_text=leaf.unit is None), attrs=attrs)


def _array(value: object, *, is_text: bool) -> NDArray[np.generic]:
    """Return a value as an array; None becomes NaN among numbers and empty among texts.

    If nothing but None is there, `is_text` decides which of them it would have been.
    """
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        return np.where(np.isfinite(value), value, np.nan) if value.dtype.kind == "f" else value
    values = plain(value, left_out=[])
    found = list(_leaves(values))
    if any(isinstance(one, str) for one in found) or (is_text and all(one is None for one in found)):
        return np.array(_filled(values, ""), dtype=object)
    if any(one is None for one in found):
        return np.array(_filled(values, np.nan), dtype=float)
    return np.array(values)


def _leaves(values: object) -> Iterator[object]:
    if not isinstance(values, list):
        yield values
        return
    for value in values:
        yield from _leaves(value)


def _filled(values: object, missing: object) -> object:
    if isinstance(values, list):
        return [_filled(value, missing) for value in values]
    return missing if values is None else values


def _blank(like: object) -> object:
    return [_blank(one) for one in like] if isinstance(like, list) else None


Key = TypeVar("Key")


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
