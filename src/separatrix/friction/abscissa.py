"""What a test runs along: time, distance or cycles; and places along it as text."""

from __future__ import annotations

import re
from typing import Any

from separatrix import units
from separatrix.errors import InputError
from separatrix.units import format_number, format_quantity

UNITS = {"time": "s", "distance": "m", "cycles": "cycles"}
"""The abscissae, of which a log has at least one, and the unit in which a friction file writes each."""

_CYCLES = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]{1,2})?)\s*cycles?\s*")


def place(value: Any, where: str) -> tuple[str, float]:
    """Read abscissa and place from a text such as ``"200 m"``, ``"10 min"`` or ``"500 cycles"``.

    Raises
    ------
    InputError
        It is none of these.

    Examples
    --------
    >>> place("10 min", ""), place("200 m", ""), place("500 cycles", "")
    (('time', 600.0), ('distance', 200.0), ('cycles', 500.0))
    """
    text = value if isinstance(value, str) and len(value) <= units.LONGEST else ""
    if found := _CYCLES.fullmatch(text):
        return "cycles", float(found.group(1))
    spelling = re.sub(r"^[^A-Za-z]*(?:[eE][-+]?[0-9]+)? ?", "", text.strip())
    axis = next((axis for axis in ("time", "distance") if spelling in units.UNITS[UNITS[axis]]), None)
    if axis is None:
        rule = "must be a time, a distance or a number of cycles with its unit"
        raise InputError(where, rule, units.shown(value), 'Write it like "10 min", "200 m" or "500 cycles".')
    found_place = units.parse(text, UNITS[axis], where)
    if found_place < 0.0:
        raise InputError(where, "must not be negative", units.shown(value))
    return axis, found_place


def in_words(value: float, axis: str) -> str:
    """Return a place along an abscissa as text: ``"12.5 min"``, ``"1.2 km"``, ``"500 cycles"``."""
    if axis == "cycles":
        return f"{format_number(value)} cycles"
    if axis == "distance":
        return f"{format_number(value / 1e3)} km" if value >= 1e4 else format_quantity(value, "m")
    for size, name in ((3600.0, "h"), (60.0, "min")):
        if value >= 3.0 * size:
            return f"{format_number(value / size)} {name}"
    return format_quantity(value, "s")
