"""Plain results as labelled arrays with units, and back from a netCDF file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from separatrix.results import maps, sensitivity, sweep
from separatrix.results.container import DAMAGE, check_container, damaged
from separatrix.results.labels import GROUPS, JOINED, LISTS, PROVENANCE, RACES, RENAMED, Group, unit_of

OWN: Mapping[str, Any] = {"map": maps, "sensitivity": sensitivity, "sweep": sweep}
"""Verbs that arrange arrays by themselves: `grid` does, from the keys `ITS_OWN`."""

Columns = dict[str, tuple[tuple[str, ...], Any]]
"""Name of a variable: its dimensions and its nested values."""


def dataset(document: Mapping[str, Any]) -> xr.Dataset:
    """Return the labelled arrays of a result, with units and provenance in their attributes.

    A missing number is the netCDF missing value, a missing text is empty; its reason stands in the
    variable `reason` beside it.

    Parameters
    ----------
    document : mapping
        What `results.document` returns, or a parsed ``--json`` answer.
    """
    own = OWN.get(document["verb"])
    apart = own.ITS_OWN if own is not None else ()
    body = {RENAMED.get(k, k): value for k, value in document.items() if k not in (*PROVENANCE, *apart)}
    variables = {name: _variable(name, dims, values) for name, (dims, values) in _flatten(body).items()}
    if own is not None:
        variables |= _arranged(own.grid(document))
    return xr.Dataset(variables, attrs=_provenance(document))


def _arranged(arrays: Mapping[str, tuple[tuple[str, ...], Any, dict[str, str]]]) -> dict[str, xr.Variable]:
    """Return the variables that a verb arranges by itself, with their own units."""
    found = {}
    for name, (dims, values, attributes) in arrays.items():
        found[name] = _variable(name, dims, values, attributes.get("units"))
        found[name].attrs |= attributes
    return found


def save(data: xr.Dataset, path: Path) -> None:
    """Write the dataset as netCDF; `load` reads it."""
    data.to_netcdf(path, engine="h5netcdf")


def load(path: Path | str) -> xr.Dataset:
    """Return a saved dataset, in memory.

    Raises
    ------
    InputError
        There is no such file, or it is not one of ours: see `container`.
    """
    path = Path(path)
    check_container(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            return data.load()
    except DAMAGE as error:
        raise damaged(str(path), error) from error


def _provenance(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes: text as it is, the rest as JSON."""
    attributes = {key: document[key] for key in PROVENANCE if document.get(key) is not None}
    return {k: v if type(v) in (str, int) else json.dumps(v) for k, v in attributes.items()}


def _variable(name: str, dims: tuple[str, ...], values: Any, unit: str | None = None) -> xr.Variable:
    unit = unit or unit_of(name)
    return xr.Variable(dims, _array(values, is_text=unit is None), attrs={"units": unit} if unit else {})


def _array(values: Any, *, is_text: bool) -> Any:
    """Return nested lists as an array; None becomes NaN among numbers and empty among texts.

    If nothing but None is there, `is_text` tells which of them it would have been.
    """
    found = list(_leaves(values))
    if any(isinstance(leaf, str) for leaf in found) or (is_text and all(leaf is None for leaf in found)):
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


def _whole(column: tuple[tuple[str, ...], Any], dims: tuple[str, ...], like: Any) -> Any:
    """Return the values of a column; one that is absent where others are a list is a list of nothing."""
    return column[1] if column[0] == dims else _blank(like)


def _blank(like: Any) -> Any:
    return [_blank(value) for value in like] if isinstance(like, list) else None


def _fill(values: Any, missing: Any) -> Any:
    if isinstance(values, list):
        return [_fill(value, missing) for value in values]
    return missing if values is None else values


def _flatten(node: Mapping[str, Any]) -> Columns:
    """Return each variable of a nested dictionary with its dimensions; lists of records become columns."""
    columns: Columns = {}
    rest = dict(node)
    if all(isinstance(rest.get(race), Mapping) for race in RACES):
        columns |= _stack(Group("race"), [rest.pop(race) for race in RACES])
        columns["race"] = (("race",), list(RACES))
    for key, value in rest.items():
        columns |= _flatten_one(key, value)
    return columns


def _flatten_one(key: str, value: Any) -> Columns:
    group = GROUPS.get(key, Group(prefix=f"{key}_"))
    if key in JOINED:
        return {key: ((), "; ".join(value))}
    if isinstance(value, Mapping):
        return _prefixed(group.prefix, _flatten(value))
    if isinstance(value, list) and value and isinstance(value[0], Mapping):
        return _prefixed(group.prefix, _stack(group, value))
    if isinstance(value, list):
        return {key: (LISTS.get(key, (key,)), value)}
    if value is None and group.dimension:
        return {}  # records that others have
    return {key: ((), value)}


def _prefixed(prefix: str, columns: Columns) -> Columns:
    """Put a prefix before every name that is not that of a dimension."""
    return {(name if (name,) == dims else prefix + name): (dims, v) for name, (dims, v) in columns.items()}


def _stack(group: Group, records: Sequence[Mapping[str, Any]]) -> Columns:
    """Return the columns of records that have the same keys, with one more dimension in front.

    Records with a name are sorted by it, so that those of one material stand in one place everywhere.
    """
    ordered = sorted(records, key=lambda r: str(r["name"])) if group.dimension == "material" else records
    bare = [{key: value for key, value in record.items() if key != group.label} for record in ordered]
    rows = [_flatten(record) for record in bare]
    columns: Columns = {}
    for name in dict.fromkeys(name for row in rows for name in row):
        dims, whole = max((row[name] for row in rows if name in row), key=lambda column: len(column[0]))
        is_label = (name,) == dims
        stacked = ((group.dimension, *dims), [_whole(row.get(name, ((), None)), dims, whole) for row in rows])
        columns[name] = (dims, whole) if is_label else stacked
    if group.label:
        columns[group.dimension] = ((group.dimension,), [record[group.label] for record in ordered])
    return columns
