"""The document of an answer as plain data, and its parts by name, each value with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from separatrix.ground.errors import InputError

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
