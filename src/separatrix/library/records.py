"""Records of the library: every number with its source, its conditions and how sure it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from separatrix.study import Friction
from separatrix.units import Kelvin, format_quantity

KINDS = ("bearing material", "cage material", "film", "fluid", "friction table")
"""What a record may be of; in a file the section is the same word with an underscore."""

CONFIDENCES = ("measured", "maker", "literature", "handbook", "guess")
"""How sure a number is: an own test, a maker's data sheet, a publication, several public tables, a guess."""

NEAR: Kelvin = 10.0
"""A datum with one temperature serves this far to either side of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Property:
    """What a number of a record is: its SI unit, its words, and where real values lie."""

    unit: str
    words: str
    low: float
    high: float


PROPERTIES = {
    "elastic_modulus": Property(unit="Pa", words="modulus", low=1e5, high=5e12),
    "poisson_ratio": Property(unit="-", words="Poisson's ratio", low=0.001, high=0.499),
    "density": Property(unit="kg/m3", words="density", low=1e-6, high=1e5),
    "compressive_strength": Property(unit="Pa", words="compressive strength", low=1e4, high=1e11),
    "viscosity": Property(unit="Pa s", words="viscosity", low=1e-8, high=1e3),
    "heat_capacity": Property(unit="J/kg/K", words="heat capacity", low=1.0, high=1e6),
    "triple_temperature": Property(unit="K", words="triple point", low=0.1, high=5000.0),
    "boiling_temperature": Property(unit="K", words="boiling point at 1 atm", low=0.1, high=5000.0),
    "critical_temperature": Property(unit="K", words="critical temperature", low=0.1, high=5000.0),
    "critical_pressure": Property(unit="Pa", words="critical pressure", low=1.0, high=1e9),
}
"""Every number that a record may hold."""

ELASTIC = ("elastic_modulus", "poisson_ratio")
SOLID = {key: PROPERTIES[key] for key in (*ELASTIC, "compressive_strength")} | {
    "density": replace(PROPERTIES["density"], low=1.0)
}
"""Numbers of a solid; its density is no gas's."""

FLUID = {key: known for key, known in PROPERTIES.items() if key not in (*ELASTIC, "compressive_strength")}
"""Numbers of a fluid."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Datum:
    """One number with where it comes from and what it holds for; what is not known is None."""

    value: float
    unit: str
    source: str
    confidence: str
    range: tuple[float, float] | None = None
    """Where the true value is expected."""

    temperature: tuple[Kelvin, Kelvin] | None = None
    """Temperatures it holds for; both are the same where the source states one."""

    pressure: float | None = None
    medium: str | None = None
    form: str | None = None

    def holds_at(self, temperature: Kelvin) -> bool:
        """Whether its source lets it serve at this temperature."""
        if self.temperature is None:
            return False
        low, high = self.temperature
        margin = NEAR if low == high else 0.0
        return low - margin <= temperature <= high + margin

    def plain(self) -> dict[str, Any]:
        """Return it as plain data with every condition, None where it is not known."""
        return {
            "value": self.value,
            "unit": self.unit,
            "range": None if self.range is None else list(self.range),
            "temperature": None if self.temperature is None else list(self.temperature),
            "pressure": self.pressure,
            "medium": self.medium,
            "form": self.form,
            "source": self.source,
            "confidence": self.confidence,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryFile:
    """The file that a record was read from."""

    label: str
    checksum: str
    """SHA-256 of the file."""

    shipped: bool

    def plain(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {"file": self.label, "sha256": self.checksum, "shipped": self.shipped}


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A material or a fluid as a library file gives it."""

    kind: str
    name: str
    file: LibraryFile
    line: int | None
    remark: str | None = None
    composition: str | None = None
    replaces: bool = False
    data: Mapping[str, tuple[Datum, ...]]
    facts: Mapping[str, Any] = field(default_factory=dict)
    """Other names, aliases; what a fluid is: substance, phase, coolprop."""

    def plain(self) -> dict[str, Any]:
        """Return the whole record as plain data."""
        return {
            "kind": self.kind,
            "name": self.name,
            "remark": self.remark,
            "composition": self.composition,
            **self.facts,
            "library": self.file.plain(),
            "data": {key: [datum.plain() for datum in data] for key, data in self.data.items()},
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTable:
    """Measured ball/cage friction of several materials in several environments; None where not measured."""

    name: str
    title: str
    source: str
    confidence: str
    environments: tuple[str, ...]
    friction: Mapping[str, Mapping[str, Friction | None]]
    file: LibraryFile
    line: int | None = None
    remark: str | None = None
    replaces: bool = False
    conditions: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Lowest and highest temperature, slip_speed, normal_force and pressure, in SI, where they are known."""

    kind: str = "friction table"

    def plain(self) -> dict[str, Any]:
        """Return the whole table as plain data."""
        friction = {
            material: {env: None if f is None else _friction(f) for env, f in row.items()}
            for material, row in self.friction.items()
        }
        return {
            "kind": self.kind,
            "name": self.name,
            "title": self.title,
            "remark": self.remark,
            "source": self.source,
            "confidence": self.confidence,
            "conditions": {
                key: {"value": list(self.conditions[key]) if key in self.conditions else None, "unit": unit}
                for key, unit in CONDITION_UNITS.items()
            },
            "environments": list(self.environments),
            "library": self.file.plain(),
            "friction": friction,
        }


CONDITION_UNITS = {"temperature": "K", "slip_speed": "m/s", "normal_force": "N", "pressure": "Pa"}
"""Conditions of a friction table, and their SI units."""


def _friction(friction: Friction) -> dict[str, Any]:
    return {key: getattr(friction, key) for key in ("mean", "standard_deviation", "count")}


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """The datum that serves at a temperature, and what must be said of it; None if nothing."""

    datum: Datum
    caution: str | None


def choose(data: Sequence[Datum], temperature: Kelvin | None, words: str) -> Choice:
    """Datum for a temperature: the one whose stated range is narrowest around it.

    None is interpolated or extrapolated. Where no range holds the temperature, the nearest datum serves and
    the caution says so; without a temperature the first one serves.
    """
    if temperature is None:
        return Choice(datum=data[0], caution=None)
    if fitting := [datum for datum in data if datum.holds_at(temperature)]:
        return Choice(datum=min(fitting, key=_width), caution=None)
    nearest = min(data, key=lambda datum: _distance(datum, temperature))
    at = format_quantity(temperature, "K")
    if nearest.temperature is None:
        return Choice(datum=nearest, caution=f"{words}: its source states no temperature, taken at {at}")
    stated = temperature_text(nearest.temperature)
    return Choice(datum=nearest, caution=f"{words}: not stated at {at}, the value at {stated} is used")


def temperature_text(temperature: tuple[float, float]) -> str:
    """Return one temperature or a range in words."""
    low, high = (format_quantity(bound, "K") for bound in temperature)
    return low if low == high else f"{low} to {high}"


def _width(datum: Datum) -> float:
    low, high = datum.temperature or (0.0, 1e9)
    return high - low


def _distance(datum: Datum, temperature: float) -> float:
    if datum.temperature is None:
        return 1e9
    low, high = datum.temperature
    return max(low - temperature, temperature - high, 0.0)
