"""Records as labelled arrays with units, as tables of pandas, and back from a netCDF file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from separatrix.present.arranged import arranged
from separatrix.present.container import DAMAGE, check_container, damaged
from separatrix.present.json import null_if_not_finite, plain
from separatrix.present.shapes import all_notes
from separatrix.present.walk import Group, Leaf, Node, Table
from separatrix.units import Rows

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from separatrix.study import Study

RACES = ("inner", "outer")
Columns = dict[str, Leaf]
"""Variables by name; every leaf has its axes."""


def dataset(verb: str, answer: object, study: Study, notes: Sequence[str]) -> xr.Dataset:
    """Return the labelled arrays of an answer, with units and provenance in their attributes.

    A missing number is the netCDF missing value, a missing text is empty; its reason is in the variable
    `reason` beside it.
    """
    from separatrix import __version__
    from separatrix.study_file import provenance_of, resolved

    data = to_xarray(answer)
    data.attrs |= {
        "separatrix_version": __version__,
        "verb": verb,
        "title": study.title,
        "name": study.name,
        "study": json.dumps(plain(resolved(study), "study")),
        "seed": study.stability.seed,
        "warnings": json.dumps(all_notes(answer, notes)),
        "provenance": json.dumps(plain(provenance_of(study, verb), "provenance")),
    }
    return data


def to_xarray(answer: object) -> xr.Dataset:
    """Return the labelled arrays of an answer, with their units, without the study behind it."""
    node = arranged(answer)
    complete = {"complete": json.dumps(plain(node.pop("complete")))} if "complete" in node else {}
    eta = node.get("restitution_factor")
    if isinstance(eta, Leaf) and eta.axes is None:  # a single number with the name of a dimension
        node["chain_restitution_factor"] = node.pop("restitution_factor")
    with null_if_not_finite():
        variables = {name: variable(leaf) for name, leaf in _flat(node).items()}
    return xr.Dataset(variables, attrs=complete)


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
        blank = _blank(plain(like.value)) if like.axes else None
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
    values = plain(value)
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
