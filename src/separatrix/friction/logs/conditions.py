"""Conditions of a test: what its column map states, what its columns show, and what follows from both."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from separatrix.friction.friction_file import Place, place
from separatrix.ground.errors import InputError
from separatrix.ground.schema import key, keys_of, positive, record
from separatrix.ground.units import (
    Array,
    Kelvin,
    Metre,
    MetrePerSecond,
    Newton,
    Pascal,
    RadianPerSecond,
    Second,
    SquareMetre,
    format_quantity,
)


@record
class Conditions:
    """Under which one test was run; None where that is not known."""

    material: str | None = key(default=None)
    """Of the sample."""

    counterface: str | None = key(default=None)
    """What the sample slides on."""

    medium: str | None = key(default=None)
    """In which it slides."""

    sample: str | None = key(default=None)
    """Name of the piece; tests of one piece share it."""

    test: str | None = key(default=None)
    """Name of the test."""

    temperature: Kelvin | None = key(positive(0.1, 3000.0), default=None)
    """Of the test."""

    slip_speed: MetrePerSecond | None = key(positive(1e-9, 1e3), default=None)
    """Of the test."""

    pressure: Pascal | None = key(positive(1e-3, 1e12), default=None)
    """Mean contact pressure."""

    normal_force: Newton | None = key(positive(1e-9, 1e7), default=None)
    """Of the test."""

    cycle_time: Second | None = key(positive(1e-6, 1e7), default=None)
    """Of one revolution or of one stroke there and back."""

    contact_area: SquareMetre | None = key(positive(1e-18, 1e3), default=None)
    """Of a flat pin."""

    pin_diameter: Metre | None = key(positive(1e-9, 1e2), default=None)
    """Of a flat round pin."""

    track_radius: Metre | None = key(positive(1e-9, 1e2), default=None)
    """Of the pin from the axis of the disk."""

    rotational_speed: RadianPerSecond | None = key(positive(1e-9, 1e6), default=None)
    """Of the disk."""

    run_in_end: Place | None = key(default=None, read=lambda raw, *_: place(raw, ""))
    """Where running-in ends."""

    @property
    def environment(self) -> str | None:
        """Medium and counterface as friction tables name them: ``"liquid nitrogen, 440C"``."""
        if self.medium is None or self.counterface is None:
            return None
        return f"{self.medium}, {self.counterface}"


QUANTITIES = {name: one.unit for name, one in keys_of(Conditions).items() if one.unit}
"""Conditions that are a number, and the SI unit of each."""

AGREE = 0.01
"""Share by which two values of one condition may differ: set points are written with two or three digits."""

MAP, MEDIAN = "column map", "median of its column"  # where a condition comes from
TURNED, OVER_AREA = "rotational speed times radius of the track", "normal force over the area of the pin"
Found = dict[str, tuple[object, str]]  # value of each condition, and where it comes from


def conditions_of(
    given: Mapping[str, object], columns: Mapping[str, Array], source: str
) -> tuple[Conditions, frozenset[str], tuple[str, ...]]:
    """Conditions of a log, which of them are measured, and a sentence on each that the map does not state.

    The slip speed is the rotational speed times the radius of the track, the time of a cycle that of one
    turn, and the pressure the normal force over the area of the pin, where these are known.
    """
    found: Found = {key: (value, MAP) for key, value in given.items()}
    for name, column in columns.items():  # the median, which a ramp at the start does not move
        if name in QUANTITIES and np.isfinite(column).any():
            middle = float(np.nanmedian(column if name == "temperature" else np.abs(column)))
            if middle > 0.0:
                found.setdefault(name, (middle, MEDIAN))
    _derive(found, source)
    sentences = tuple(
        f"{name.replace('_', ' ')} {format_quantity(value, QUANTITIES[name])}: {reason}"
        for name, (value, reason) in found.items()
        if reason != MAP and isinstance(value, float)
    )
    try:
        conditions = Conditions(**{key: value for key, (value, _) in found.items()})  # type: ignore[arg-type]
    except InputError as error:
        raise of_log(error, source) from None
    measured = {key for key, (_, reason) in found.items() if reason == MEDIAN}
    follows = (("slip_speed", "rotational_speed", TURNED), ("pressure", "normal_force", OVER_AREA))
    measured |= {key for key, base, way in follows if base in measured and found.get(key, ("", ""))[1] == way}
    return conditions, frozenset(measured), sentences


def of_log(error: InputError, source: str) -> InputError:
    """The first refusal of a record as one of its log: its field in words in place of its class."""
    first = (error.problems or (error,))[0]
    return first.at(f"{source}: {first.path.rpartition('.')[2].replace('_', ' ')}")


def _derive(found: Found, source: str) -> None:
    """Add what follows from other conditions; a given one must agree, unless it is measured."""
    at = {key: value for key, (value, _) in found.items() if isinstance(value, float)}
    rotation, radius, area, diameter = map(
        at.get, ("rotational_speed", "track_radius", "contact_area", "pin_diameter")
    )
    follows: list[tuple[str, float, str]] = []
    if rotation is not None:
        follows += [("slip_speed", rotation * radius, TURNED)] if radius is not None else []
        follows.append(("cycle_time", 2.0 * math.pi / rotation, "one turn"))
    elif radius is not None and "slip_speed" in at:
        time = 2.0 * math.pi * radius / at["slip_speed"]
        follows.append(("cycle_time", time, "2 pi radius / slip speed"))
    if area is not None and diameter is not None:
        rule = "cannot have both a contact_area and a pin_diameter"
        raise InputError(source, rule, cure="Give the one that is measured.")
    area = area if diameter is None else math.pi / 4.0 * diameter**2
    if area is not None and "normal_force" in at:
        follows.append(("pressure", at["normal_force"] / area, OVER_AREA))
    for name, value, reason in follows:
        there, why = at.get(name), found.setdefault(name, (value, reason))[1]
        if there is not None and why != MEDIAN and abs(there - value) > AGREE * abs(value):
            ways = ((there, why), (value, reason))
            got = " and ".join(f"{format_quantity(one, QUANTITIES[name])} ({way})" for one, way in ways)
            rule = f"has two values of {name.replace('_', ' ')} that differ"
            raise InputError(source, rule, got, "Leave out the wrong one.")
