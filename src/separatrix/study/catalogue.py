"""A bearing by its designation: what the library states of it, under the keys that a study gives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from separatrix.ground.errors import InputError
from separatrix.ground.reader import Reading, Refused
from separatrix.ground.toml import KeyPath, text
from separatrix.ground.units import format_quantity
from separatrix.study.ball_bearing import GEOMETRY, BallBearing
from separatrix.study.library import UNITS
from separatrix.study.uncertain import helper_of

PLAY = {"contact_angle", "radial_clearance"}
"""Of these either follows from the other: a study that gives one takes neither from the library."""


def read_bearing(raw: Any, path: KeyPath, reading: Reading) -> BallBearing:
    """Bearing of the section; a designation fills the geometry that the section does not give."""
    if not isinstance(raw, dict) or "designation" not in raw:
        return reading.record(BallBearing, raw, path)
    helper = helper_of(reading)
    try:
        name = helper.known(text(raw["designation"], ""), "bearing")
    except InputError as error:
        reading.refuse((*path, "designation"), error)
        raise Refused from None
    record = helper.library.record("bearing", name)
    given = {*raw, *(PLAY if PLAY & set(raw) else ())}
    filled = {key: record.data[key][0] for key in GEOMETRY if key in record.data and key not in given}
    values = {key: _raw(key, datum.value) for key, datum in filled.items()}
    bearing = reading.record(BallBearing, {**raw, "designation": name, **values}, path)
    if not filled:
        reading.notes.append(
            f"[bearing] designation {name} has no effect: the study gives all that it fills."
        )
    guesses: dict[str, str] = {}
    for key, datum in filled.items():
        value = f"{key} {format_quantity(datum.value, UNITS[key])}"
        reading.places[(*path, key)] = f"{record.place}: {name}, {value}; {datum.confidence}: {datum.source}"
        if datum.confidence.startswith("guess"):
            guesses[value] = datum.source
    if guesses:
        be = "are guesses" if len(guesses) > 1 else "is a guess"
        known = "; ".join(dict.fromkeys(guesses.values()))
        reading.notes.append(f"[bearing] {', '.join(guesses)} of {name} {be} of the library: {known}.")
    return replace(bearing, record=record.plain())


def _raw(key: str, value: float) -> object:
    """A value of the library as a study file has it."""
    if UNITS[key] != "-":
        return f"{value!r} {UNITS[key]}"
    return int(value) if key == "ball_count" else value
