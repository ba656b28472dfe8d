"""Records and documents as labelled arrays with units, and as tables of pandas."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import xarray as xr

from separatrix.ground.plain_data import Group, Item, Leaf, Node, Table, node_of, plain
from separatrix.ground.units import Rows

if TYPE_CHECKING:
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


def arrays_of(item: Item) -> xr.Dataset:
    """Return the node of a document as labelled arrays."""
    node = item.fields if isinstance(item, Group) else {}
    for key, arranged in ARRANGED.items():
        if key in node:
            node = arranged(node)
    complete = {"complete": json.dumps(plain(node.pop("complete")))} if "complete" in node else {}
    eta = node.get("restitution_factor")
    if isinstance(eta, Leaf) and eta.axes is None:  # a single number with the name of a dimension
        node["chain_restitution_factor"] = node.pop("restitution_factor")
    return xr.Dataset({name: variable(leaf) for name, leaf in _flat(node).items()}, attrs=complete)


def save(data: xr.Dataset, path: Path) -> None:
    """Write the dataset as netCDF, for other programs."""
    data.to_netcdf(path, engine="h5netcdf")


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
    attributes = {"units": leaf.unit, "long_name": leaf.long_name}
    attrs = {name: value for name, value in attributes.items() if value}
    return xr.Variable(leaf.axes or (), _array(leaf.value, is_text=leaf.unit is None), attrs=attrs)


def _array(value: object, *, is_text: bool) -> NDArray[np.generic]:
    """Return a value as an array; None becomes NaN among numbers and empty among texts.

    If nothing but None is there, `is_text` decides which of them it would have been.
    """
    with contextlib.suppress(ValueError):  # some rows are shorter than others
        if (array := np.array(value)).dtype.kind in "biuf":
            return np.where(np.isfinite(array), array, np.nan) if array.dtype.kind == "f" else array
    found = list(_leaves(value))
    if any(isinstance(one, str) for one in found) or (is_text and all(one is None for one in found)):
        return np.array(_without_none(value, ""), dtype=object)
    if any(one is None for one in found):
        return np.array(_without_none(value, np.nan), dtype=float)
    return np.array(value)


def _leaves(values: object) -> Iterator[object]:
    if not isinstance(values, list):
        yield values
        return
    for value in values:
        yield from _leaves(value)


def _without_none(values: object, missing: object) -> object:
    if isinstance(values, list):
        return [_without_none(value, missing) for value in values]
    return missing if values is None else values


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


Key = TypeVar("Key")
Record = Mapping[str, Any]


def _swept(node: Node) -> Node:
    names = [one["name"] for one in plain(node["parameters"])]
    return node | {"parameters": Group({"parameter": Leaf(names, None, ("parameter",))}, "")}


def _mapped(node: Node) -> Node:
    """Points on the dimensions (y, x); bands along `change`."""
    x, y = plain(node["x"]), plain(node["y"])
    for name, axis in (("x", x), ("y", y)):
        node[name] = Leaf(axis["values"], axis["unit"], (name,), axis["parameter"])
        node[f"{name}_here"] = Leaf(axis["here"], axis["unit"])
        node[f"{name}_parameter"] = Leaf(axis["parameter"])
    tables = (node.pop("points"), node["changes"])
    rows, bands = ((one.records if isinstance(one, Table) else None) or [] for one in tables)
    size = len(x["values"]), len(y["values"])
    for name in [key for key in (rows or [{}])[0] if key not in ("x", "y")]:
        column = [row[name] for row in rows]
        values = [one.value if isinstance(one, Leaf) else None for one in column]
        unit = next((one.unit for one in column if isinstance(one, Leaf)), None)
        table = [[values[i * size[1] + j] for i in range(size[0])] for j in range(size[1])]
        node[name] = Leaf(table, y["unit"] if name == "margin" else unit, ("y", "x"))
    units = {"x": x["unit"], "y_low": y["unit"], "y_high": y["unit"]}
    for band in bands:
        band |= {name: Leaf(getattr(band[name], "value", None), unit) for name, unit in units.items()}
    return node


DOCUMENT_ONLY = ("undecided", "next_tests", "allowed_friction", "allowed_films")
CASES = ("environment", "material")


def _uncertain(node: Node) -> Node:
    """Convergence, clouds, drivers and films as arrays over environments and materials."""
    found = {name: plain(node.pop(name)) for name in (*DOCUMENT_ONLY, *BY_CASE, "shares")}
    places = [one["name"] for one in plain(node["environments"])]
    materials = sorted(row["name"] for row in plain(node["overall"]))
    sizes = sorted({size for one in found["convergence"] for size in one["size"]})
    node |= {"size": Leaf(sizes, None, ("size",)), "place": Leaf([*places, ""], None, ("place",))}
    for key in ("probability_stable", "probability_low", "probability_high"):
        values = {
            (one["environment"], one["name"]): dict(zip(one["size"], one[key], strict=True))
            for one in found["convergence"]
        }
        grid = _grid(values, [*places, ""], materials, sizes)
        node[f"convergence_{key}"] = Leaf(grid, "-", ("place", "material", "size"))
    samples = range(max((len(one["friction"]) for one in found["clouds"]), default=0))
    for key in ("restitution_factor", "friction", "settles"):
        clouds = {(one["environment"], one["name"]): dict(enumerate(one[key])) for one in found["clouds"]}
        node[f"cloud_{key}"] = Leaf(_grid(clouds, places, materials, samples), "-", (*CASES, "sample"))
    node |= _drivers(found["drivers"], places, materials) | _smooth(found["shares"])
    return node | _films(found["allowed_films"], materials)


BY_CASE = ("convergence", "clouds", "drivers")
ARRANGED = {"cases": _swept, "points": _mapped, "clouds": _uncertain}
"""Key that the document of one verb has -> how its arrays are arranged otherwise."""


def _grid(
    values: Mapping[tuple[str, str], Mapping[Key, float]],
    places: Iterable[str],
    materials: Sequence[str],
    labels: Sequence[Key],
) -> list[list[list[float | None]]]:
    """Return the values of each case by place, material and label; None where there is none."""
    return [[[values.get((p, m), {}).get(one) for one in labels] for m in materials] for p in places]


def _shares(shares: Iterable[Record], end: str) -> dict[str, float]:
    return {one["name"]: one[f"share{end}"] for one in shares}


def _drivers(found: Sequence[Record], places: Sequence[str], materials: Sequence[str]) -> Node:
    """Shares by input, chance last, and the calibration; nothing where no case has any."""
    known = {(one["environment"], one["name"]): one for one in found if one["shares"]}
    if not known:
        return {}
    chance = next(iter(known.values()))["shares"][-1]["name"]
    names = dict.fromkeys(one["name"] for case in known.values() for one in case["shares"])
    drivers = [*(name for name in names if name != chance), chance]
    node: Node = {"driver": Leaf(drivers, None, ("driver",))}
    for end in ("", "_low", "_high"):
        grid = _grid({c: _shares(one["shares"], end) for c, one in known.items()}, places, materials, drivers)
        node[f"driver_share{end}"] = Leaf(grid, "-", (*CASES, "driver"))
    bins = range(max(len(one["predicted"]) for one in known.values()))
    for key in ("predicted", "counted"):
        values = {case: dict(enumerate(one[key])) for case, one in known.items()}
        node[f"calibration_{key}"] = Leaf(_grid(values, places, materials, bins), "-", (*CASES, "bin"))
    return node


def _smooth(found: Sequence[Record]) -> Node:
    if not found:
        return {}
    names = [one["name"] for one in found[0]["total"]]
    node: Node = {
        "quantity": Leaf([one["quantity"] for one in found], None, ("quantity",)),
        "chain_input": Leaf(names, None, ("chain_input",)),
    }
    for kind in ("first", "total"):
        for end in ("", "_low", "_high"):
            rows = [_shares(one[kind], end) for one in found]
            table = [[row[name] for name in names] for row in rows]
            node[f"sobol_{kind}{end}"] = Leaf(table, "-", ("quantity", "chain_input"))
    return node


def _films(found: Sequence[Record], materials: Sequence[str]) -> Node:
    films = {one["name"]: one for one in found}
    first = next(iter(films.values()), None)
    if first is None or not first["film_thickness"]:
        return {}
    none = [[None for _ in row] for row in first["film_restitution_factor"]]
    factors = [films[name]["film_restitution_factor"] if name in films else none for name in materials]
    limits = [_limit(films[name]) if name in films else None for name in materials]
    return {
        "race_friction": Leaf(first["race_friction"], "-", ("race_friction",)),
        "film_thickness": Leaf(first["film_thickness"], "m", ("film_thickness",)),
        "film_restitution_factor": Leaf(factors, "-", ("material", "race_friction", "film_thickness")),
        "film_limit": Leaf(limits, "-", ("material",)),
        "film_probability": Leaf(first["probability"], "-"),
    }


def _limit(film: Record) -> float:
    """Return the largest restitution factor allowed: 1 where every one is, -1 where none is."""
    if film["restitution_factor"] is not None:
        return float(film["restitution_factor"])
    return 1.0 if film["is_any_allowed"] else -1.0
