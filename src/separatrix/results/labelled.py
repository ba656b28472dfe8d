"""Plain results as labelled arrays with units, and back from a netCDF file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from separatrix.errors import InputError
from separatrix.results.labels import COORDINATES, LISTS, PROVENANCE, RACES, RECORDS, unit_of

type_ = tuple[tuple[str, ...], Any]


def dataset(document: Mapping[str, Any]) -> xr.Dataset:
    """Return the labelled arrays of a result, with units and provenance in their attributes.

    A missing number is the netCDF missing value, a missing text is empty; its reason stands in the
    variable `reason` beside it.

    Parameters
    ----------
    document : mapping
        What `results.document` returns, or a parsed ``--json`` answer.
    """
    body = {key: value for key, value in document.items() if key not in PROVENANCE}
    variables = {name: _variable(name, dims, values) for name, (dims, values) in _flatten(body).items()}
    coordinates = {name: variables.pop(name) for name in COORDINATES if name in variables}
    if any("race" in variable.dims for variable in variables.values()):
        coordinates["race"] = xr.Variable(("race",), np.array(RACES, dtype=object))
    return xr.Dataset(variables, coordinates, attrs=_provenance(document))


def save(data: xr.Dataset, path: Path) -> None:
    """Write the dataset as netCDF; `load` reads it."""
    data.to_netcdf(path, engine="h5netcdf")


def load(path: Path | str) -> xr.Dataset:
    """Return a saved dataset, in memory.

    Raises
    ------
    InputError
        There is no such file, or it is not one of ours.
    """
    try:
        with xr.open_dataset(path, engine="h5netcdf") as data:
            return data.load()
    except (OSError, ValueError) as error:
        raise InputError(str(path), "is not a readable netCDF result", cure=str(error)) from error


def _provenance(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes: text as it is, the rest as JSON."""
    attributes = {key: document[key] for key in PROVENANCE if document.get(key) is not None}
    return {k: v if isinstance(v, str | int) else json.dumps(v) for k, v in attributes.items()}


def _variable(name: str, dims: tuple[str, ...], values: Any) -> xr.Variable:
    unit = unit_of(name)
    return xr.Variable(dims, _array(values), attrs={"units": unit} if unit else {})


def _array(values: Any) -> Any:
    """Return nested lists as an array; None becomes NaN among numbers and empty among texts."""
    found = list(_leaves(values))
    if any(isinstance(leaf, str) for leaf in found):
        return np.array(_fill(values, ""), dtype=object)
    if any(leaf is None for leaf in found):
        return np.array(_fill(values, np.nan), dtype=float)
    return np.array(values)


def _leaves(values: Any) -> Iterator[Any]:
    if isinstance(values, list):
        for value in values:
            yield from _leaves(value)
    else:
        yield values


def _fill(values: Any, missing: Any) -> Any:
    if isinstance(values, list):
        return [_fill(value, missing) for value in values]
    return missing if values is None else values


def _flatten(node: Mapping[str, Any]) -> dict[str, type_]:
    """Return each variable of a nested dictionary with its dimensions; lists of records become columns."""
    columns: dict[str, type_] = {}
    node = dict(node)
    if all(isinstance(node.get(race), Mapping) for race in RACES):
        columns |= _stack("race", [node.pop(race) for race in RACES])
    for key, value in node.items():
        columns |= _flatten_one(key, value)
    return columns


def _flatten_one(key: str, value: Any) -> dict[str, type_]:
    if isinstance(value, Mapping):
        prefix = RECORDS.get(key, ("", f"{key}_"))[1]
        return _prefixed(prefix, _flatten(value))
    if isinstance(value, list) and value and isinstance(value[0], Mapping):
        dimension, prefix = RECORDS[key]
        return _prefixed(prefix, _stack(dimension, value))
    if isinstance(value, list):
        return {key: (LISTS.get(key, (key,)), value)}
    return {key: ((), value)}


def _prefixed(prefix: str, columns: dict[str, type_]) -> dict[str, type_]:
    return {(name if name in COORDINATES else prefix + name): column for name, column in columns.items()}


def _stack(dimension: str, records: list[Mapping[str, Any]]) -> dict[str, type_]:
    """Return the columns of records that have the same keys, with one more dimension in front."""
    rows = [_flatten(record) for record in records]
    columns: dict[str, type_] = {}
    for name, (dims, first) in rows[0].items():
        if name in COORDINATES:
            columns[name] = (dims, first)
        elif name == "name":
            columns[dimension] = ((dimension,), [row[name][1] for row in rows])
        elif name == dimension:
            columns[name] = ((dimension,), [row[name][1] for row in rows])
        else:
            columns[name] = ((dimension, *dims), [row[name][1] for row in rows])
    return columns
