"""What reads the values of a study that have a form of their own: uncertain numbers, names of the library."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

from separatrix.ground.errors import InputError
from separatrix.ground.reader import Reading
from separatrix.ground.schema import Described
from separatrix.ground.toml import cut_list, nearest, whole
from separatrix.ground.units import Kelvin, shown
from separatrix.study import uncertain
from separatrix.study.distribution import Distribution
from separatrix.study.library import Library


@dataclass(frozen=True, slots=True)
class StudyHelper:
    """Reader of uncertain numbers, and of names of a library."""

    library: Library

    def number(self, raw: object, unit: str, one: Described) -> tuple[float, Distribution | None]:
        """Number of a key or, with an empty unit, whole one; and its distribution, None if it is certain."""
        if one.key.certain:
            uncertain.refuse_distribution(raw)
        if not unit:
            return (whole(raw, ""), None) if one.key.certain else uncertain.count(raw)
        return uncertain.number(raw, unit)

    def named(self, raw: object, one: Described, reading: Reading) -> Any:
        """Material of a name; None if the value is not a name."""
        if isinstance(raw, dict):
            return None
        kind = one.key.named
        if not isinstance(raw, str):
            rule = f"must be the name of a {kind}, or its properties elastic_modulus and poisson_ratio"
            raise InputError("", rule, shown(raw), f'Write it like "{self.library.names(kind)[0]}".')
        return self.library.material(kind, self.known(raw, kind), temperature_of(reading))

    def known(self, name: str, kind: str, more: str = "") -> str:
        """Exact name in the library of one in any spelling, or a refusal that lists the names."""
        found = self.library.named(kind, name)
        if found is not None:
            return found
        names = self.library.names(kind)
        listed, near = cut_list(f"The library has {', '.join(names)}."), nearest(name, names)
        cure = f"{near} {listed}{more}" if near.startswith("Did") else f"{listed}{more}"
        raise InputError("", f"is not a {kind} of the library", shown(name), cure)


def helper_of(reading: Reading) -> StudyHelper:
    """Helper of the reading of a study."""
    return cast("StudyHelper", reading.helper)


def temperature_of(reading: Reading) -> Kelvin | None:
    """Temperature of the study, by which data of the library are chosen; None where it states none."""
    operation = reading.done.get("operation")
    return None if operation is None else operation.temperature
