"""Slip speed, load and temperature of the steady part of a test, and whether they change in it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from separatrix.friction.logs.log import Conditions, RawLog, of_log
from separatrix.friction.logs.names import MEANINGS
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, format_quantity

WATCHED = ("slip_speed", "normal_force", "temperature")  # columns that are conditions
PARTS = 12  # parts of the steady part whose medians are compared
FEWEST_ROWS = 20  # rows of a part, at least, but for two parts
CHANGE = 0.1  # share of the median by which a condition may change
WARMER = 20.0  # K by which the temperature may change
NOISE = 4.0  # standard errors of a median by which noise alone may make two of them differ


def steady_conditions(log: RawLog, rows: slice) -> Conditions:
    """Conditions of a log; those that a column shows are its median over these rows."""
    found: dict[str, Any] = {}
    for name in WATCHED:
        values = _measured(log, name, rows)
        if name in log.measured and values.size:
            found[name] = float(np.median(values))
    before, pressure = log.conditions.normal_force, log.conditions.pressure
    if "pressure" in log.measured and "normal_force" in found and before and pressure:
        found["pressure"] = pressure * found["normal_force"] / before
    try:
        return replace(log.conditions, **found)
    except InputError as error:
        raise of_log(error, log.source) from None


def changes(log: RawLog, rows: slice) -> Iterator[str]:
    """Yield a sentence on each condition that changes within these rows by more than noise and its limit.

    The medians of equal parts are compared, which the speed within a stroke or a single row does not move.
    """
    for name in WATCHED:
        values = _measured(log, name, rows)
        count = int(np.clip(values.size // FEWEST_ROWS, 2, PARTS))
        if values.size < 2 * count:
            continue
        parts = np.array_split(values, count)
        middles = np.array([np.median(part) for part in parts])
        scatter = np.median([np.median(np.abs(part - np.median(part))) for part in parts])
        error = 1.25 * 1.4826 * scatter / np.sqrt(values.size / count)
        low, high, usual = float(middles.min()), float(middles.max()), float(np.median(values))
        limit = WARMER if name == "temperature" else CHANGE * usual
        if high - low > limit + NOISE * error:
            words, unit = name.replace("_", " "), MEANINGS[name]
            texts = [format_quantity(value, unit, 3) for value in (low, high, usual)]
            yield (
                f"The {words} changes between {texts[0]} and {texts[1]} within the steady part: its friction "
                f"is a mean over both, and {texts[2]} is their median. Split the log where the {words} "
                "changes, or set run_in_end behind it."
            )


def _measured(log: RawLog, name: str, rows: slice) -> Array:
    """Finite values of a column in these rows; forces and speeds as magnitudes."""
    column = getattr(log, name)
    if column is None:
        return np.empty(0)
    values = column[rows] if name == "temperature" else np.abs(column[rows])
    return np.asarray(values[np.isfinite(values)])
