"""Documents as labelled arrays with units, and as tables of pandas."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from separatrix.ground.plain_data import Group, Item, Leaf, Node, Table, node_of, plain
from separatrix.ground.units import Rows

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

RACES = ("inner", "outer")
Columns = dict[str, Leaf]
"""Variables by name; every leaf has its axes."""


HEAD = ("separatrix_version", "verb", "name", "title", "study", "seed", "warnings", "provenance", "units")
"""Keys of a document that are not results."""


def dataset(found: Mapping[str, Any]) -> xr.Dataset:
    """Return the labelled arrays of a document, with units and provenance in their attributes.

    A missing number is the netCDF missing value, a missing text is empty; its reason is in the variable
    `reason` beside it.
    """
    body = {key: value for key, value in found.items() if key not in HEAD}
    data = arrays_of(node_of(body, found["units"]))
    for key in HEAD:
        if key in found and key != "units":
            data.attrs[key] = found[key] if isinstance(found[key], str | int) else json.dumps(found[key])
    return data


def main_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the arrays of an answer that have the dimensions of its main table, in SI units.

    A row is a ball of a bearing, a point of traction curves, of a stability curve or of a map, a sample of a
    run, a candidate in an environment, a case of a sweep. An array with one more dimension has a column for
    each place on it.
    """
    wanted = next(one for one in MAIN if set(one) <= set(data.dims))
    columns: dict[str, xr.DataArray] = {}
    for name, found in data.data_vars.items():
        if found.dims == wanted:
            columns[str(name).removeprefix(f"{wanted[-1]}_")] = found
        elif len(wanted) == 1 and found.dims[:1] == wanted and found.ndim == 2:
            columns |= {f"{name}_{i}": found[:, i] for i in range(found.shape[1])}
    return xr.Dataset(columns).reset_coords(drop=True).to_dataframe(dim_order=list(wanted))


MAIN = (
    *(("case",), ("y", "x"), ("time",), ("environment", "material"), ("restitution_factor",)),
    *(("race", "increment"), ("push",), ("ball",), ("race",)),
)
"""Dimensions of the main tables; an answer has that of the first that it has."""


def arrays_of(item: Item) -> xr.Dataset:
    """Return the node of a document as labelled arrays."""
    node = item.fields if isinstance(item, Group) else {}
    complete = {"complete": json.dumps(plain(node.pop("complete")))} if "complete" in node else {}
    eta = node.get("restitution_factor")
    if isinstance(eta, Leaf) and eta.axes is None:  # a single number with the name of a dimension
        node["chain_restitution_factor"] = node.pop("restitution_factor")
    return xr.Dataset({name: variable(leaf) for name, leaf in _flat(node).items()}, attrs=complete)


def _flat(node: Node, prefix: str = "") -> Columns:
    """Return each variable of a node; records in a list become columns, both races one more dimension.

    `prefix` is what goes before its names: an array that is its own dimension has that of its whole name.
    """
    rest, columns = dict(node), Columns()
    races = [rest.get(race) for race in RACES]
    if all(isinstance(one, Group) for one in races):
        records = [one.fields for one in races if isinstance(one, Group)]
        columns |= _stacked(Table(records, Rows("race")))
        columns["race"] = Leaf(list(RACES), None, ("race",))
        rest = {key: item for key, item in rest.items() if key not in RACES}
    for key, item in rest.items():
        if isinstance(item, Group):
            before = f"{key}_" if item.prefix is None else item.prefix
            columns |= _prefixed(before, _flat(item.fields, prefix + before))
        elif isinstance(item, Table):
            if item.rows.dimension:  # other lists of records are in the document alone
                columns |= _prefixed(item.rows.prefix, _stacked(item))
        else:
            columns[key] = _with_axes(prefix + key, item)
    return columns


def _with_axes(name: str, leaf: Leaf) -> Leaf:
    """Return a leaf with its axes: its own name if the type states none. Texts are joined to one."""
    value = leaf.value
    if not isinstance(value, list):
        return leaf._replace(axes=())
    if leaf.axes is None and leaf.unit is None and all(isinstance(one, str) for one in value):
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
        axes = like.axes or ()
        values = [one[name].value if name in one and one[name].axes == axes else None for one in flat]
        sizes = _sizes([one for one in values if one is not None], len(axes))
        columns[name] = like._replace(value=[_filled(one, sizes) for one in values], axes=(dimension, *axes))
    if label and records:
        places = [one[label] for one in records]
        unit = next((one.unit for one in places if isinstance(one, Leaf)), None)
        columns[dimension] = Leaf([plain(one) for one in places], unit, (dimension,))
    return columns


def variable(leaf: Leaf) -> xr.Variable:
    """Return a leaf with its axes as a variable with its unit."""
    attrs = {"units": leaf.unit} if leaf.unit else {}
    return xr.Variable(leaf.axes or (), _array(leaf.value, is_text=leaf.unit is None), attrs=attrs)


def _array(value: object, *, is_text: bool) -> NDArray[np.generic]:
    """Return a value as an array; None becomes NaN among numbers and empty among texts.

    If nothing but None is there, `is_text` decides which of them it would have been.
    """
    with contextlib.suppress(ValueError):  # some rows are shorter than others
        if (array := np.array(value)).dtype.kind in "biuf":
            return np.where(np.isfinite(array), array, np.nan) if array.dtype.kind == "f" else array
    found = np.array(value, dtype=object)
    is_absent = np.asarray(np.frompyfunc(lambda one: one is None, 1, 1)(found), dtype=bool)
    if any(isinstance(one, str) for one in found.flat) or (is_text and is_absent.all()):
        found[is_absent] = ""
        return found
    found[is_absent] = np.nan
    return found.astype(float)


def _sizes(values: list[Any], axes: int) -> list[int]:
    """Return the sizes of the array that has room for each of these."""
    sizes = []
    for _ in range(axes):
        sizes.append(max(map(len, values), default=0))
        values = [inside for one in values for inside in one]
    return sizes


def _filled(value: Any, sizes: Sequence[int]) -> Any:
    """Return an array of these sizes, None where it has no value."""
    if not sizes:
        return value
    rows = value or ()
    return [_filled(rows[i] if i < len(rows) else None, sizes[1:]) for i in range(sizes[0])]
