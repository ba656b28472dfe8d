"""Conditions of a test: from the column map, else from the metadata of the file, else from its columns."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np

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
"""Share by which two values of one condition may differ: set points are written with two or three digits."""

_VALUE = re.compile(
    r"([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)\s*[\[(]?\s*([^\d\s\[\]()][^\[\]()]*?)?\s*[\])]?"
)

MAP, MEDIAN = "column map", "median of its column"  # where a condition comes from


def conditions_of(
    given: Mapping[str, str | float],
    metadata: Mapping[str, str],
    columns: Mapping[str, Array],
    source: str,
) -> tuple[Conditions, tuple[str, ...]]:
    """Conditions of a log, and a sentence on each that the column map does not state.

    The slip speed is the rotational speed times the radius of the track, the time of a cycle that of one
    turn, and the pressure the normal force over the area of the pin, where these are known.

    Raises
    ------
    InputError
        Two ways to the same condition differ by more than `AGREE`.
    """
    found: dict[str, tuple[str | float, str]] = {key: (value, MAP) for key, value in given.items()}
    notes = [
        note
        for key, text in metadata.items()
        if text and (note := _from_metadata(key, text, found)) is not None
    ]
    for key, column in columns.items():  # the median, which a ramp at the start does not move
        if key in QUANTITIES and np.isfinite(column).any():
            middle = float(np.nanmedian(np.abs(column)))
            if middle > 0.0:
                found.setdefault(key, (middle, MEDIAN))
    _derive(found, source)
    known = {key: one for key, one in found.items() if key in Conditions.__dataclass_fields__}
    sentences = []
    for key, (value, reason) in known.items():
        text = printable(value, 200) if isinstance(value, str) else format_quantity(value, QUANTITIES[key])
        if reason != MAP:
            sentences.append(f"{key.replace('_', ' ')} {text}: {reason}")
    conditions = Conditions(**{key: value for key, (value, _) in known.items()})  # type: ignore[arg-type]
    return conditions, (*sentences, *notes)


def _from_metadata(key: str, text: str, found: dict[str, tuple[str | float, str]]) -> str | None:
    """Keep the first condition whose unit the value has; return a note on a value that is not used."""
    name, beside = header_parts(key)[0]
    conditions = [condition for condition, names in KEYS.items() if plain(name) in names.split("; ")]
    reason = f'"{printable(key)}" in the file'
    if not conditions:
        return None
    if conditions[0] in TEXTS:
        found.setdefault(conditions[0], (text, reason))
        return None
    match = _VALUE.fullmatch(text.strip())
    unit = (match[2] or beside).strip() if match else ""
    for condition in conditions:
        scale = scale_in(unit, QUANTITIES[condition])
        if match and scale is not None:
            size = float(match[1].replace(",", ".")) * scale.factor / scale.divisor + scale.offset
            if size > 0.0:
                found.setdefault(condition, (size, reason))
                return None
    if conditions[0] in found:
        return None
    shown = f"{printable(key)} {printable(text)}"
    number = match[1].lstrip("+-") if match and not unit else ""
    if not number:
        return f'{shown} is not understood; put {conditions[0]} = "..." with its unit under [test]'
    unit = "mm" if conditions[0] in ("track_radius", "pin_diameter") else "<unit>"
    return f'{shown} has no unit; put {conditions[0]} = "{number} {unit}" under [test]'


def _derive(found: dict[str, tuple[str | float, str]], source: str) -> None:
    """Add what follows from other conditions; a given one must agree, unless it is measured."""

    def number(key: str) -> float | None:
        value = found.get(key, (None, ""))[0]
        return value if isinstance(value, float) else None

    def settle(key: str, value: float, reason: str) -> None:
        there = number(key)
        if there is None:
            found[key] = (value, reason)
        elif found[key][1] != MEDIAN and abs(there - value) > AGREE * abs(value):
            ways = ((there, found[key][1]), (value, reason))
            got = " and ".join(f"{format_quantity(one, QUANTITIES[key])} ({way})" for one, way in ways)
            rule = f"has two values of {key.replace('_', ' ')} that differ"
            raise InputError(source, rule, got, "Leave out the wrong one.")

    rotation, radius = number("rotational_speed"), number("track_radius")
    if rotation is not None and radius is not None:
        settle("slip_speed", rotation * radius, "rotational speed times radius of the track")
    if rotation is None and radius is not None and (speed := number("slip_speed")) is not None:
        settle("cycle_time", 2.0 * math.pi * radius / speed, "2 pi radius / slip speed")
    if rotation is not None:
        settle("cycle_time", 2.0 * math.pi / rotation, "one turn")
    area, diameter, force = (number(key) for key in ("contact_area", "pin_diameter", "normal_force"))
    if area is not None and diameter is not None:
        rule = "cannot have both a contact_area and a pin_diameter"
        raise InputError(source, rule, cure="Give the one that is measured.")
    if diameter is not None:
        area = math.pi / 4.0 * diameter**2
    if area is not None and force is not None:
        settle("pressure", force / area, "normal force over the area of the pin")
