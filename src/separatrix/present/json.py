"""Records as plain data: dictionaries, lists, numbers and text, in SI units, without NaN."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import is_dataclass
from enum import Enum
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from separatrix.cage import CageMotion
from separatrix.chain.mobility import SlipLaw
from separatrix.errors import SeparatrixError
from separatrix.present.walk import Group, Leaf, Table, shape
from separatrix.study import (
    ClearanceState,
    ContactPressure,
    Guidance,
    KinematicModel,
    PocketContact,
    PocketShape,
    PressureSlip,
    Race,
    TractionModel,
    Worn,
)

if TYPE_CHECKING:
    from separatrix.study import ContactPressure, PressureSlip, Study, TractionModel, Worn

Document = dict[str, Any]

SPELLED = (
    *(CageMotion, ClearanceState, ContactPressure, Guidance, KinematicModel, PocketContact, PocketShape),
    *(PressureSlip, Race, SlipLaw, TractionModel, Worn),
)
"""Enumerations whose values are shown; of the others the names."""

_left_out: ContextVar[list[str] | None] = ContextVar("left_out", default=None)


class NotFiniteError(SeparatrixError, ArithmeticError):
    """A record has a NaN or an infinity where a number is due."""


def document(verb: str, answer: object, study: Study, notes: Sequence[str]) -> Document:
    """Return an answer as plain data: SI units, no NaN, None where something is absent.

    The resolved inputs of the study go into it with their sources; the notes and those of the answer are its
    warnings.
    """
    from separatrix import __version__
    from separatrix.present.shapes import all_notes, shape
    from separatrix.study_file import provenance_of, resolved

    with null_if_not_finite() as left_out:
        body = plain(Group(shape(answer)), verb)
    warnings = all_notes(answer, notes)
    if left_out:
        more = f" and {len(left_out) - 1} more" if left_out[1:] else ""
        warnings.append(
            f"A number is not finite and is left out: {left_out[0]}{more}. The inputs are far from those of "
            "a bearing, or this is a fault of separatrix."
        )
    return {
        "separatrix_version": __version__,
        "verb": verb,
        "name": study.name,
        "title": study.title,
        "study": plain(resolved(study), "study"),
        "seed": study.stability.seed,
        **body,
        "warnings": warnings,
        "provenance": plain(provenance_of(study, verb), "provenance"),
    }


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
    """Return a record, a node or a container of them as what JSON can hold; `path` is its place in messages.

    Raises
    ------
    NotFiniteError
        A number is NaN or infinite, and that is not inside `document`.
    """
    if isinstance(value, Leaf):
        return plain(value.value, path)
    if isinstance(value, Table):
        return None if value.records is None else [plain(Group(one), path) for one in value.records]
    if is_dataclass(value) and not isinstance(value, type):
        value = Group(shape(value))
    if isinstance(value, Group):
        value = value.fields
    if isinstance(value, Enum):
        return str(value.value) if type(value) in SPELLED else value.name
    if isinstance(value, np.ndarray | np.generic):
        is_plain = value.dtype.kind in "biu" or (value.dtype.kind == "f" and np.isfinite(value).all())
        return value.tolist() if is_plain else plain(value.tolist(), path)
    if isinstance(value, Mapping):
        return {_key(key): plain(one, f"{path}.{_key(key)}") for key, one in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        return [plain(one, f"{path}[{i}]") for i, one in enumerate(value)]
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
