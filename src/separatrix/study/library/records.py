"""Records of the library: every number with its source, conditions and confidence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple, TypedDict

from separatrix.ground.units import Kelvin, format_quantity
from separatrix.study.study import Friction

KINDS = ("bearing material", "cage material", "film", "fluid", "friction table")
"""Kinds of records; in a file the section is the same word with an underscore."""

CONFIDENCES = ("measured", "maker", "literature", "handbook", "guess")
"""Kinds of source: an own test, a maker's data sheet, a publication, several public tables, a guess."""

NEAR: Kelvin = 10.0
"""A datum with one temperature serves this far to either side of it."""


class Property(NamedTuple):
    """A number of a record: its SI unit, its words, and the range of real values."""

    unit: str
    words: str
    low: float
    high: float


PROPERTIES = {
    "elastic_modulus": Property("Pa", "modulus", 1e5, 5e12),
    "poisson_ratio": Property("-", "Poisson's ratio", 0.001, 0.499),
    "density": Property("kg/m3", "density", 1e-6, 1e5),
    "compressive_strength": Property("Pa", "compressive strength", 1e4, 1e11),
    "thermal_expansion": Property("m/m/K", "thermal expansion", -1e-4, 1e-3),
    "viscosity": Property("Pa s", "viscosity", 1e-8, 1e3),
    "heat_capacity": Property("J/kg/K", "heat capacity", 1.0, 1e6),
    "triple_temperature": Property("K", "triple point", 0.1, 5000.0),
    "boiling_temperature": Property("K", "boiling point at 1 atm", 0.1, 5000.0),
    "critical_temperature": Property("K", "critical temperature", 0.1, 5000.0),
    "critical_pressure": Property("Pa", "critical pressure", 1.0, 1e9),
}
"""Every number that a record may have."""

ELASTIC = ("elastic_modulus", "poisson_ratio")
SOLID_ONLY = (*ELASTIC, "compressive_strength", "thermal_expansion")
SOLID = {key: PROPERTIES[key] for key in SOLID_ONLY} | {"density": PROPERTIES["density"]._replace(low=1.0)}
"""Numbers of a solid; its density is not that of a gas."""

FLUID = {key: known for key, known in PROPERTIES.items() if key not in SOLID_ONLY}
"""Numbers of a fluid."""

CONDITIONS = {
    "temperature": ("K", 1e-3, 5000.0),
    "slip_speed": ("m/s", 1e-9, 1e4),
    "normal_force": ("N", 1e-9, 1e9),
    "pressure": ("Pa", 1e-3, 1e12),
}
"""Conditions of a friction table: SI unit and range of each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Datum:
    """One number with its source and its conditions; what is not known is None."""

    value: float
    unit: str
    range: tuple[float, float] | None = None
    """Where the true value is expected."""

    temperature: tuple[Kelvin, Kelvin] | None = None
    """Lowest and highest temperature of the source; both are the same where it states one."""

    pressure: float | None = None
    medium: str | None = None
    form: str | None = None
    source: str
    confidence: str

    def serves_at(self, temperature: Kelvin) -> bool:
        """Whether its stated temperatures include this one."""
        if self.temperature is None:
            return False
        low, high = self.temperature
        margin = NEAR if low == high else 0.0
        return low - margin <= temperature <= high + margin

    def plain(self) -> dict[str, object]:
        """Return it as plain data with every condition, None where it is not known."""
        values = ((f.name, getattr(self, f.name)) for f in fields(self))
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values}


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryFile:
    """The file that a record was read from."""

    label: str
    checksum: str
    """SHA-256 of the file."""

    shipped: bool

    def plain(self) -> dict[str, object]:
        """Return it as plain data."""
        return {"file": self.label, "sha256": self.checksum, "shipped": self.shipped}


class Facts(TypedDict, total=False):
    """Other names of a material or a fluid; substance and phase of a fluid."""

    substance: str
    phase: str
    coolprop: str | None
    aliases: list[str] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A material or a fluid of a library file."""

    kind: str
    name: str
    file: LibraryFile
    line: int | None
    remark: str | None = None
    composition: str | None = None
    replaces: bool = False
    data: Mapping[str, tuple[Datum, ...]]
    facts: Facts

    def plain(self) -> dict[str, object]:
        """Return the whole record as plain data."""
        words = {key: getattr(self, key) for key in ("kind", "name", "remark", "composition")}
        data = {key: [datum.plain() for datum in data] for key, data in self.data.items()}
        return {**words, **self.facts, "library": self.file.plain(), "data": data}


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionTable:
    """Measured ball/cage friction of several materials in several environments; None where not measured."""

    kind: str = "friction table"
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

    def plain(self) -> dict[str, object]:
        """Return the whole table as plain data."""
        keys = ("mean", "standard_deviation", "count")
        words = ("kind", "name", "title", "remark", "source", "confidence")
        return {
            **{key: getattr(self, key) for key in words},
            "conditions": {
                key: {"value": list(self.conditions[key]) if key in self.conditions else None, "unit": unit}
                for key, (unit, _, _) in CONDITIONS.items()
            },
            "environments": list(self.environments),
            "library": self.file.plain(),
            "friction": {
                material: {env: f and {key: getattr(f, key) for key in keys} for env, f in row.items()}
                for material, row in self.friction.items()
            },
        }


_NOWHERE = (1e9, 2e9)
"""Temperatures of a datum whose source states none: it serves last."""


class Choice(NamedTuple):
    """The datum that serves at a temperature, and the caution about it; None if there is none."""

    datum: Datum
    caution: str | None


def choose(data: Sequence[Datum], temperature: Kelvin | None, words: str) -> Choice:
    """Datum for a temperature: that with the narrowest stated range around it.

    None is interpolated or extrapolated. Where no range includes the temperature, the nearest datum serves
    and the caution states it; without a temperature the first one serves.
    """
    if temperature is None:
        return Choice(data[0], None)
    spans = [(datum, *(datum.temperature or _NOWHERE)) for datum in data]
    if fitting := [one for one in spans if one[0].serves_at(temperature)]:
        return Choice(min(fitting, key=lambda one: one[2] - one[1])[0], None)
    nearest, low, high = min(spans, key=lambda one: max(one[1] - temperature, temperature - one[2], 0.0))
    at = format_quantity(temperature, "K")
    if nearest.temperature is None:
        return Choice(nearest, f"{words}: its source states no temperature, taken at {at}")
    first, last = format_quantity(low, "K"), format_quantity(high, "K")
    stated = first if first == last else f"{first} to {last}"
    return Choice(nearest, f"{words}: not stated at {at}, the value at {stated} is used")


def contradictions(record: Mapping[str, Any], temperature: Kelvin) -> Iterator[str]:
    """Sentences on a fluid whose temperature rules out the phase in its name at any pressure.

    A liquid exists between the triple and the critical temperature. A gas exists at any temperature, but
    below the triple point only as thin vapour over the solid. Between, the pressure decides, which a study
    does not state.
    """
    name, phase, at = record["name"], record["phase"], format_quantity(temperature, "K")
    data = record["data"]
    critical, triple = (
        data[key][0]["value"] if data.get(key) else None
        for key in ("critical_temperature", "triple_temperature")
    )
    cure = "Correct the fluid or the temperature."
    if phase == "liquid" and critical is not None and temperature > critical:
        limit = f"the critical temperature is {format_quantity(critical, 'K')}"
        yield f"{name}: at {at} there is no liquid at any pressure, {limit}. {cure}"
    if triple is not None and temperature < triple:
        limit = f"the triple point is {format_quantity(triple, 'K')}"
        yield f"{name}: at {at} it is solid, or a thin vapour; {limit}. {cure}"
