"""Conditions of a test: from the column map, else from the metadata of the file, else from its columns."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from separatrix.errors import InputError
from separatrix.friction.logs.column_map import QUANTITIES, TEXTS
from separatrix.friction.logs.log import Conditions
from separatrix.friction.logs.names import header_parts, plain, scale_in
from separatrix.units import Array, format_quantity, printable

KEYS: dict[str, str] = {
    "normal_force": "normal load; normal force; load; set force; applied load; normalkraft; last; "
    "charge normale; force normale",
    "slip_speed": "lin speed; linear speed; sliding speed; max lin speed; max linear speed; speed; velocity; "
    "gleitgeschwindigkeit; geschwindigkeit; lin geschw; vitesse; vit lin; vitesse lineaire; "
    "vitesse de glissement",
    "rotational_speed": "rotational speed; rotation speed; spindle speed; speed; velocity; drehzahl; "
    "vitesse de rotation",
    "track_radius": "radius; track radius; wear track radius; spurradius; radius der spur; rayon; "
    "rayon de piste; rayon de la piste",
    "pressure": "mean contact pressure; nominal contact pressure; mittlere flachenpressung; flachenpressung; "
    "pression moyenne de contact",
    "pin_diameter": "pin diameter; stiftdurchmesser; diametre du pion",
    "temperature": "temperature; temp; test temperature; temperatur; versuchstemperatur; temperature d essai",
    "material": "material; pin material; cage material; pin; werkstoff; stiftwerkstoff; materiau; "
    "materiau du pion",
    "counterface": "counterface; counter body; counterbody; disk material; disc material; disk; disc; "
    "gegenkorper; scheibe; contre piece; antagoniste; disque",
    "medium": "medium; atmosphere; environment; atmosphare; umgebungsmedium; milieu",
    "sample": "sample; sample name; sample id; specimen; specimen id; probe; probenname; echantillon",
    "test": "test; test name; test id; test no; versuch; essai",
}
"""Keys of metadata that are conditions, in English, German and French."""

AGREE = 0.01
"""How far two ways to one condition may lie apart: set points are written with two or three digits."""

_VALUE = re.compile(
    r"([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)\s*[\[(]?\s*([^\d\s\[\]()][^\[\]()]*?)?\s*[\])]?"
)


@dataclass(slots=True)
class Found:
    """Conditions gathered so far, in SI units, and where each came from."""

    values: dict[str, str | float] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def add(self, key: str, value: str | float, reason: str) -> None:
        """Keep the value unless there is one already."""
        if key not in self.values:
            self.values[key], self.reasons[key] = value, reason

    def number(self, key: str) -> float | None:
        """The value of a quantity."""
        value = self.values.get(key)
        return value if isinstance(value, float) else None


def conditions_of(
    given: Mapping[str, str | float],
    metadata: Mapping[str, str],
    columns: Mapping[str, Array],
    source: str,
) -> tuple[Conditions, tuple[str, ...]]:
    """Conditions of a log, and a sentence on each that the column map does not give.

    The slip speed is the rotational speed times the radius of the track, the time of a cycle that of one
    turn, and the pressure the normal force over the area of the pin, where these are known.

    Raises
    ------
    InputError
        Two ways to the same condition differ by more than `AGREE`.
    """
    found = Found()
    for key, value in given.items():
        found.add(key, value, "column map")
    for key, text in metadata.items():
        _from_metadata(key, text, found)
    for key, column in columns.items():
        _from_column(key, column, found)
    _derive(found, source)
    values = {key: value for key, value in found.values.items() if key in _FIELDS}
    sentences = [_sentence(key, found) for key in values if found.reasons[key] != "column map"]
    return Conditions(**values), (*sentences, *found.notes)  # type: ignore[arg-type]


_FIELDS = frozenset(Conditions.__dataclass_fields__)


def _from_metadata(key: str, text: str, found: Found) -> None:
    name, beside = header_parts(key)[0]
    conditions = [c for c, names in KEYS.items() if plain(name) in names.split("; ")]
    if not text or not conditions:
        return
    if conditions[0] in TEXTS:
        found.add(conditions[0], text, f'"{printable(key)}" in the file')
    else:
        _number_from_metadata(key, text, beside, conditions, found)


def _number_from_metadata(key: str, text: str, beside: str, conditions: list[str], found: Found) -> None:
    """Keep the first condition whose unit the value has; else say that it is not used."""
    match = _VALUE.fullmatch(text.strip())
    unit = (match[2] or beside).strip() if match else ""
    for condition in conditions:
        scale = scale_in(unit, QUANTITIES[condition])
        if match and scale is not None:
            size = float(match[1].replace(",", ".")) * scale.factor / scale.divisor + scale.offset
            if size > 0.0:
                found.add(condition, size, f'"{printable(key)}" in the file')
                return
    if conditions[0] not in found.values:
        found.notes.append(
            _unused(key, text, match[1].lstrip("+-") if match and not unit else "", conditions[0])
        )


def _unused(key: str, text: str, number: str, condition: str) -> str:
    """A sentence on a value that is not used, with the line that gives it; a number without unit keeps it."""
    shown = f"{printable(key)} {printable(text)}"
    if not number:
        return f'{shown} is not understood; put {condition} = "..." with its unit under [test]'
    unit = "mm" if condition in ("track_radius", "pin_diameter") else "<unit>"
    return f'{shown} has no unit; put {condition} = "{number} {unit}" under [test]'


def _from_column(key: str, column: Array, found: Found) -> None:
    """The median of a measured column, which a ramp at the start does not move."""
    import numpy as np

    if key in QUANTITIES and np.isfinite(column).any():
        middle = float(np.nanmedian(np.abs(column)))
        if middle > 0.0:
            found.add(key, middle, "median of its column")


def _derive(found: Found, source: str) -> None:
    rotation, radius = found.number("rotational_speed"), found.number("track_radius")
    if rotation is not None and radius is not None:
        _settle("slip_speed", rotation * radius, "rotational speed times radius of the track", found, source)
    if rotation is None and radius is not None and (speed := found.number("slip_speed")) is not None:
        _settle("cycle_time", 2.0 * math.pi * radius / speed, "2 pi radius / slip speed", found, source)
    if rotation is not None:
        _settle("cycle_time", 2.0 * math.pi / rotation, "one turn", found, source)
    area, force = _area(found, source), found.number("normal_force")
    if area is not None and force is not None:
        _settle("pressure", force / area, "normal force over the area of the pin", found, source)


def _area(found: Found, source: str) -> float | None:
    area, diameter = found.number("contact_area"), found.number("pin_diameter")
    if area is not None and diameter is not None:
        rule = "cannot have both a contact_area and a pin_diameter"
        raise InputError(source, rule, cure="Give the one that is measured.")
    return area if diameter is None else math.pi / 4.0 * diameter**2


def _settle(key: str, value: float, reason: str, found: Found, source: str) -> None:
    """Keep a derived value; one that is there already must agree, unless it is measured."""
    there = found.number(key)
    if there is None:
        found.add(key, value, reason)
        return
    if found.reasons[key] != "median of its column" and abs(there - value) > AGREE * abs(value):
        unit = QUANTITIES[key]
        shown = f"{format_quantity(there, unit)} ({found.reasons[key]}) and {format_quantity(value, unit)}"
        rule = f"has two values of {key.replace('_', ' ')} that differ"
        raise InputError(source, rule, f"{shown} ({reason})", "Leave out the wrong one.")


def _sentence(key: str, found: Found) -> str:
    value, reason = found.values[key], found.reasons[key]
    text = printable(value, 200) if isinstance(value, str) else format_quantity(value, QUANTITIES[key])
    return f"{key.replace('_', ' ')} {text}: {reason}"
