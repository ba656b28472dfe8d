"""Records as plain data: dictionaries, lists, numbers and text, in SI units, without NaN."""

from __future__ import annotations

import contextlib
import functools
import typing
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import fields, is_dataclass
from enum import Enum
from math import isfinite
from typing import Any, get_type_hints

import numpy as np

from separatrix.errors import SeparatrixError
from separatrix.study import Guidance, KinematicModel, PocketContact, PocketShape, Race

SPELLED = (Guidance, KinematicModel, PocketContact, PocketShape, Race)


_left_out: ContextVar[list[str] | None] = ContextVar("left_out", default=None)


class NotFiniteError(SeparatrixError, ArithmeticError):
    """A record holds a NaN or an infinity where a number is due."""


@contextlib.contextmanager
def null_if_not_finite() -> Iterator[list[str]]:
    """Within it `plain` gives None for a number that is not finite; yield where that was so."""
    found: list[str] = []
    token = _left_out.set(found)
    try:
        yield found
    finally:
        _left_out.reset(token)


def plain(value: object, path: str = "result") -> Any:
    """Return a record, however nested, as what JSON can hold.

    Dataclasses become dictionaries, arrays nested lists, enumerations their name; those that a study file
    spells keep that spelling.

    Parameters
    ----------
    value : object
        A record, array, number, text, None, or a container of them.
    path : str
        Where it stands, for the message.

    Raises
    ------
    NotFiniteError
        A number is NaN or infinite, and that is not inside `null_if_not_finite`.
    TypeError
        Something that has no plain form.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return plain_record(value, path)
    if isinstance(value, Enum):
        return value.value if type(value) in SPELLED else value.name
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), path)
    if isinstance(value, Mapping):
        return {_key(k): plain(v, f"{path}.{_key(k)}") for k, v in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [plain(v, f"{path}[{i}]") for i, v in enumerate(value)]
    return _scalar(value, path)


def plain_record(record: Any, path: str = "result") -> dict[str, Any]:
    """Return the fields of a record as plain data."""
    return {f.name: plain(getattr(record, f.name), f"{path}.{f.name}") for f in fields(record)}


def _scalar(value: object, path: str) -> object:
    if value is None or isinstance(value, bool | int | str):
        return value
    if not isinstance(value, float):
        raise TypeError(f"{path}: a {type(value).__name__} has no plain form")
    if isfinite(value):
        return value
    left_out = _left_out.get()
    if left_out is None:
        raise NotFiniteError(f"{path} is {value}")
    left_out.append(f"{path} is {value}")
    return None


def _key(key: object) -> str:
    return str(key.value) if isinstance(key, Enum) else str(key)


@functools.cache
def field_units(record: type) -> dict[str, str]:
    """Return the unit of each field of a record class that has one, read from its annotations."""
    hints = get_type_hints(record, include_extras=True)
    units = {name: _unit(hint) for name, hint in hints.items()}
    return {name: unit for name, unit in units.items() if unit is not None}


def _unit(hint: object) -> str | None:
    """Return the unit inside an annotation such as ``Annotated[float, "N"]``, also in a union or tuple."""
    metadata = getattr(hint, "__metadata__", ())
    for item in metadata:
        if isinstance(item, str):
            return item
    inner = (_unit(argument) for argument in typing.get_args(hint))
    return next((unit for unit in inner if unit is not None), None)
