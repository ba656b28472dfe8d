"""Records as nested nodes: every value with the unit and the axes that the type of its field states."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import NamedTuple, get_args, get_type_hints

from separatrix.units import Rows


class Leaf(NamedTuple):
    """A number, text, array or None; `axes` are the names of its dimensions, None for its own name."""

    value: object
    unit: str | None = None
    axes: tuple[str, ...] | None = None
    long_name: str = ""

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
    """Return the fields of a class of records as they are where there is none: nothing but their units."""
    return {name: _item(None, kind) for name, kind in _kinds(record).items()}


def field_units(record: type) -> dict[str, str]:
    """Return the unit of each field of a record class that has one."""
    return {name: kind.unit for name, kind in _kinds(record).items() if kind.unit is not None}


def field_axes(record: type) -> dict[str, tuple[str, ...]]:
    """Return the names of the dimensions of each field of a record class that states them."""
    return {name: kind.axes for name, kind in _kinds(record).items() if kind.axes}


class _Kind(NamedTuple):
    """What the type of a field states."""

    unit: str | None = None
    axes: tuple[str, ...] | None = None
    rows: Rows | None = None


def _item(value: object, kind: _Kind) -> Item:
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
    return {field.name: _kind(hints[field.name]) for field in fields(record)}


def _kind(hint: object) -> _Kind:
    """Return what an annotation such as ``Annotated[Array, "N", ("ball",)]`` states, or one inside it."""
    metadata = getattr(hint, "__metadata__", ())
    unit = next((one for one in metadata if isinstance(one, str)), None)
    rows = next((one for one in metadata if isinstance(one, Rows)), None)
    axes = next((one for one in metadata if type(one) is tuple), None)
    if unit is None and rows is None:
        inside = (_kind(argument).unit for argument in get_args(hint))
        unit = next((one for one in inside if one is not None), None)
    return _Kind(unit, axes, rows)
