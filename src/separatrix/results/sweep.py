"""A sweep as plain data, a row for each case, and its columns as labelled arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.results.labels import unit_of
from separatrix.results.maps import Arrays
from separatrix.results.plain import plain

Document = dict[str, Any]

ITS_OWN = ("parameters", "cases")
"""Keys of a sweep's document that `grid` turns into arrays."""


def sweep(record: Any) -> Document:
    """Return the parameters with their units, and a row for each case."""
    named = [{"name": one.name, "unit": one.unit or "-"} for one in record.parameters]
    rest = {"verdicts": record.verdicts, "complete": record.complete}
    return {"parameters": named, "cases": plain(record.rows(), "sweep"), **rest}


def grid(document: Mapping[str, Any]) -> Arrays:
    """Return a column for each key of the cases, on the dimension `case`."""
    units = {one["name"]: one["unit"] for one in document["parameters"]}
    cases = document["cases"]
    arrays: Arrays = {"parameter": (("parameter",), list(units), {})}
    for key in cases[0] if cases else ():
        unit = units.get(key) or unit_of(key)
        arrays[key] = (("case",), [case[key] for case in cases], {"units": unit} if unit else {})
    return arrays
