"""Records as nodes, every value with the unit and the axes that its field states, and as plain data.

The document of an answer is plain data, whose parts are found by name, each value with its unit.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from math import isfinite
from types import NoneType
from typing import Any, NamedTuple, get_args, get_type_hints

import numpy as np

from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.schema import Spelled
from separatrix.ground.units import Rows

Document = dict[str, Any]
"""Plain data of an answer, of a study, or of a part of one: text, numbers, None, lists and dictionaries."""


class Part:
    """A part of a document with units: ``part.name`` is a value, a part or a list of parts.

    What a document of an earlier version lacks is refused under its place, `where`.
    """

    __slots__ = ("units", "values", "where")

    def __init__(
        self, values: Mapping[str, Any], units: Mapping[str, Any], where: str = "The answer"
    ) -> None:
        self.values, self.units, self.where = values, units, where

    def __getattr__(self, name: str) -> Any:
        """A value, a part or a list of parts by its name."""
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self.values:
            cure = "Compute this answer again with this version."
            raise InputError(self.where, f"lacks {name}", cure=cure)
        return self.get(name)

    def get(self, name: str) -> Any:
        """The same; None of a name that is not there."""
        value, units = self.values.get(name), self.units.get(name)
        known = units if isinstance(units, Mapping) else {}
        if isinstance(value, Mapping):
            return Part(value, known, f"{self.where}: {name}")
        if isinstance(value, list) and value and isinstance(value[0], Mapping):
            return [Part(one, known, f"{self.where}: {name}[{i}]") for i, one in enumerate(value)]
        return value

    def __contains__(self, name: str) -> bool:
        """Whether there is such a value, and it is not None."""
        return self.values.get(name) is not None

    def unit(self, name: str) -> str:
        """The unit of a value; a dash for a pure number."""
        found = self.units.get(name)
        found = found[0] if found and isinstance(found, list) else found
        return found if found and isinstance(found, str) else "-"


def part_of(document: Mapping[str, Any], where: str = "The answer") -> Part:
    """Return a whole document as a part."""
    return Part(document, document.get("units") or {}, where)


NOTES = "notes"
"""Field of a record that its node leaves out: an answer gathers them as its warnings."""


class Leaf(NamedTuple):
    """A number, text, array or None; `axes` are the names of its dimensions, None for its own name."""

    value: object
    unit: str | None = None
    axes: tuple[str, ...] | None = None

    @property
    def number(self) -> float | None:
        """The value, if it is a number."""
        return self.value if isinstance(self.value, float) else None


class Group(NamedTuple):
    """A record inside a record; `prefix` goes before its names in a dataset, None for its own name."""

    fields: Node
    prefix: str | None = None


class Table(NamedTuple):
    """Records in a list, and how they become arrays; None where there is none."""

    records: list[Node] | None
    rows: Rows


Item = Leaf | Group | Table
Node = dict[str, Item]


@functools.singledispatch
def shape(record: object) -> Node:
    """Return a record as a node, field by field; `shapes` has the few records that are arranged otherwise."""
    return fields_of(record)


def fields_of(record: object, *names: str) -> Node:
    """Return the fields of a record, or those named."""
    of: type = type(record)
    kinds = _kinds(of)
    return {name: _item(getattr(record, name), kinds[name]) for name in names or kinds}


def absent(record: type) -> Node:
    """Return the fields of a class of records without a record: only their units."""
    return {name: _item(None, kind) for name, kind in _kinds(record).items()}


def field_units(record: type) -> dict[str, str]:
    """Return the unit of each field of a record class that has one."""
    return {name: kind.unit for name, kind in _kinds(record).items() if kind.unit is not None}


def field_axes(record: type) -> dict[str, tuple[str, ...]]:
    """Return the names of the dimensions of each field of a record class that states them."""
    return {name: kind.axes for name, kind in _kinds(record).items() if kind.axes}


def units_of(item: Item) -> Any:
    """Return units and axes of an item as plain data, from which `node_of` makes it again from its values.

    A number has its unit, an array a list of its unit and its axes; a record, or the rows of a list of them,
    has those of its keys, and under "" the prefix of its names or the dimension, prefix and label of the rows
    in a dataset. What has none of these is left out.
    """
    if isinstance(item, Leaf):
        return [item.unit, *item.axes] if item.axes else item.unit
    found: dict[str, Any] = {}
    for one in [item.fields] if isinstance(item, Group) else item.records or ():
        new = {key: of for key, of in one.items() if key not in found or not isinstance(of, Leaf)}
        _add(found, {key: known for key, of in new.items() if (known := units_of(of))})
    if isinstance(item, Group):
        return found if item.prefix is None else found | {"": item.prefix}
    return found if item.rows == Rows() else found | {"": list(item.rows)}


def _add(found: dict[str, Any], more: Mapping[str, Any]) -> None:
    """Add the units of another row; a record may be missing in the first."""
    for key, known in more.items():
        if isinstance(known, dict) and isinstance(found.get(key), dict):
            _add(found[key], known)
        else:
            found.setdefault(key, known)


def node_of(value: Any, units: Any) -> Item:
    """Return a part of a document as a node, by the units and axes that `units_of` wrote."""
    known: Mapping[str, Any] = units if isinstance(units, Mapping) else {}
    rows = known.get("")
    if isinstance(value, Mapping):
        return Group(_known_fields(value, known), rows)
    if isinstance(rows, list) or (isinstance(value, list) and value and isinstance(value[0], Mapping)):
        records = None if value is None else [_known_fields(one, known) for one in value]
        return Table(records, Rows(*rows or ()))
    unit, *axes = units if isinstance(units, list) else (None if isinstance(units, Mapping) else units,)
    return Leaf(value, unit, tuple(axes) or None)


def _known_fields(record: Mapping[str, Any], units: Mapping[str, Any]) -> Node:
    return {key: node_of(one, units.get(key)) for key, one in record.items()}


class _Kind(NamedTuple):
    """What the type of a field states."""

    unit: str | None = None
    axes: tuple[str, ...] | None = None
    rows: Rows | None = None


SCALARS = frozenset({bool, int, float, str, NoneType})
"""Types of most fields, for which nothing else is looked at: a map has ten thousand points."""


def _item(value: object, kind: _Kind) -> Item:
    if kind.rows is None and type(value) in SCALARS:
        return Leaf(value, kind.unit, kind.axes)
    if is_dataclass(value) and not isinstance(value, type):
        return Group(shape(value), None if kind.rows is None else kind.rows.prefix)
    if isinstance(value, Mapping):
        prefix = None if kind.rows is None else kind.rows.prefix
        return Group({str(key): _item(one, kind) for key, one in value.items()}, prefix)
    if isinstance(value, tuple) and value and all(is_dataclass(one) for one in value):
        return Table([shape(one) for one in value], kind.rows or Rows())
    if kind.rows is not None and kind.rows.dimension:
        return Table(None if value is None else [], kind.rows)
    return Leaf(value, kind.unit, kind.axes)


@functools.cache
def _kinds(record: type) -> dict[str, _Kind]:
    hints = get_type_hints(record, include_extras=True)
    return {one.name: _kind(hints[one.name]) for one in fields(record) if one.name != NOTES}


def _kind(hint: object) -> _Kind:
    """Return what an annotation such as ``Annotated[Array, "N", ("ball",)]`` states, or one inside it."""
    metadata = getattr(hint, "__metadata__", ())
    unit = next((one for one in metadata if isinstance(one, str)), None)
    rows = next((one for one in metadata if isinstance(one, Rows)), None)
    axes = next((one for one in metadata if type(one) is tuple), None)
    if rows is None:
        inside = [_kind(argument) for argument in get_args(hint)]
        unit = unit or next((one.unit for one in inside if one.unit is not None), None)
        axes = axes or next((one.axes for one in inside if one.axes is not None), None)
    return _Kind(unit, axes, rows)


class NotFiniteError(SeparatrixError, ArithmeticError):
    """A record has a NaN or an infinity where a number is due."""


def plain(value: object, path: str = "result", left_out: list[str] | None = None) -> Any:
    """Return a record, a node or a container of them as what JSON can hold.

    Parameters
    ----------
    value : object
    path : str
        Its place, for messages.
    left_out : list of str, optional
        A number that is not finite becomes None, and is added to this list.

    Raises
    ------
    NotFiniteError
        A number is NaN or infinite, and there is no such list.
    """
    if isinstance(value, Leaf):
        value = value.value
    if type(value) in SCALARS and (not isinstance(value, float) or isfinite(value)):
        return value
    if isinstance(value, Table):
        records = value.records
        return None if records is None else [plain(Group(one), path, left_out) for one in records]
    if is_dataclass(value) and not isinstance(value, type):
        value = Group(shape(value))
    if isinstance(value, Group):
        value = value.fields
    if isinstance(value, Enum):
        return str(value.value) if isinstance(value, Spelled) else value.name
    if isinstance(value, np.ndarray | np.generic):
        is_plain = value.dtype.kind in "biu" or (value.dtype.kind == "f" and np.isfinite(value).all())
        return value.tolist() if is_plain else plain(value.tolist(), path, left_out)
    if isinstance(value, Mapping):
        named = ((_key(key), one) for key, one in value.items())
        return {key: plain(one, f"{path}.{key}", left_out) for key, one in named}
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [plain(one, f"{path}[{i}]", left_out) for i, one in enumerate(value)]
    if not isinstance(value, float):
        raise TypeError(f"{path}: a {type(value).__name__} has no plain form")
    if isfinite(value):
        return value
    if left_out is None:
        raise NotFiniteError(f"{path} is {value}")
    left_out.append(f"{path} is {value}")
    return None


def _key(key: object) -> str:
    return str(key.value) if isinstance(key, Enum) else str(key)
