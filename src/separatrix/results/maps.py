"""A stability map as plain data, and its points as a grid of labelled arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.results.plain import plain_record

Document = dict[str, Any]

Arrays = dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]
"""Name of an array: its dimensions, nested values and attributes."""

ITS_OWN = ("x", "y", "points", "changes")
"""Keys of a map's document that `grid` turns into arrays."""


def stability_map(record: Any, cage: Document) -> Document:
    """Return axes, points, bands and counts, with the chain and the cage of the study itself."""
    return plain_record(record, "map") | cage


def grid(document: Mapping[str, Any]) -> Arrays:
    """Return the arrays of a map: name to dimensions, nested values and attributes.

    Points stand on the dimensions (y, x), bands on `change`.
    """
    axes = {name: document[name] for name in ("x", "y")}
    columns, rows = (len(axes[name]["values"]) for name in ("x", "y"))
    arrays: Arrays = {}
    for name, axis in axes.items():
        arrays[name] = ((name,), axis["values"], _attributes(axis))
        arrays[f"{name}_here"] = ((), axis["here"], {"units": axis["unit"]})
        arrays[f"{name}_parameter"] = ((), axis["parameter"], {})
    for key in (key for key in document["points"][0] if key not in ("x", "y")):
        values = [point[key] for point in document["points"]]
        table = [[values[i * rows + j] for i in range(columns)] for j in range(rows)]
        arrays[key] = (("y", "x"), table, {"units": axes["y"]["unit"]} if key == "margin" else {})
    return arrays | _changes(document["changes"], axes)


def _changes(changes: Sequence[Document], axes: Mapping[str, Document]) -> Arrays:
    """Return the columns of the bands; nothing if the map has none."""
    if not changes:
        return {}
    units = {"x": axes["x"]["unit"], "y_low": axes["y"]["unit"], "y_high": axes["y"]["unit"]}
    return {
        f"change_{key}": (
            ("change",),
            [at[key] for at in changes],
            _unit(units.get(key)),
        )
        for key in changes[0]
    }


def _unit(unit: str | None) -> dict[str, str]:
    return {} if unit is None else {"units": unit}


def _attributes(axis: Mapping[str, Any]) -> dict[str, str]:
    return {"units": axis["unit"], "long_name": axis["parameter"]}
