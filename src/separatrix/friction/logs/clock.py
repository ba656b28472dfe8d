"""Times and dates that a log writes as text, as seconds since its first row."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date

import numpy as np

from separatrix.units import Array

DAY = 86_400.0

CLOCK = "clock"  # unit of a column of times as text
SHORT_CLOCKS = ("hh:mm", "h:min", "mm:ss", "min:s", "m:s")
"""Units that state what the two numbers of a time are."""

_MONTHS = {
    "jan": 1,
    "feb": 2,
    "mar": 3,
    "apr": 4,
    "may": 5,
    "jun": 6,
    "jul": 7,
    "aug": 8,
    "sep": 9,
    "oct": 10,
    "nov": 11,
    "dec": 12,
}
_DATE = r"(?P<a>\d{1,4})(?P<sign>[-/. ])(?P<b>\d{1,2}|[A-Za-z]{3})[a-z]*(?P=sign)(?P<c>\d{1,4})"
_TIME = r"(?P<h>\d{1,4}):(?P<m>\d{1,2})(?::(?P<s>\d{1,2}(?:[.,:]\d+)?))?\s*(?P<half>[AaPp]\.?[Mm]\.?)?"
_ZONE = r"\s*(?:Z|[+-]\d{2}:?\d{2})?"
_MOMENT = re.compile(rf"(?:{_DATE}[\sT,_]\s*)?{_TIME}{_ZONE}")


def is_clock(field: str) -> bool:
    """Return whether a field holds a time of day or a duration, with or without a date before it.

    Examples
    --------
    >>> is_clock("19:54:11"), is_clock("2026-02-01T10:00:00.25Z"), is_clock("2026-02-01"), is_clock("3.5")
    (True, True, False, False)
    """
    return _MOMENT.fullmatch(field) is not None


def seconds(fields: Sequence[str], *, of_minutes: bool = False) -> Array:
    """Return seconds since the first field, shape (row,); NaN for an empty one.

    A time of day that falls back by more than half a day has passed midnight.

    Parameters
    ----------
    fields : sequence of str
        Each a time, perhaps behind a date.
    of_minutes : bool
        Whether two numbers are minutes and seconds, and not hours and minutes.

    Examples
    --------
    >>> seconds(["23:59:58", "23:59:59.5", "00:00:01"]).tolist()
    [0.0, 1.5, 3.0]
    """
    found = [_MOMENT.fullmatch(field) for field in fields]
    times = np.array([np.nan if one is None else _time(one, of_minutes=of_minutes) for one in found])
    if any(one is not None and one["a"] for one in found):
        times += DAY * _days(found)
    else:
        there = np.flatnonzero(np.isfinite(times))
        back = np.diff(times[there]) < -DAY / 2.0
        times[there[1:]] += DAY * np.cumsum(back)
    first = times[np.isfinite(times)][:1]
    return np.round(times - (first if first.size else 0.0), 9)


def _time(found: re.Match[str], *, of_minutes: bool) -> float:
    """Return the time of a field in seconds."""
    first, second, third = int(found["h"]), int(found["m"]), found["s"]
    if third is None and of_minutes:
        return 60.0 * first + second
    if found["half"]:
        first = first % 12 + (12 if found["half"][0] in "pP" else 0)
    rest = 0.0 if third is None else float(re.sub("[,:]", ".", third))
    return 3600.0 * first + 60.0 * second + rest


def _days(found: Sequence[re.Match[str] | None]) -> Array:
    """Return the days of dates; of ambiguous day and month the order with the shortest test."""
    orders = [
        np.array([np.nan if one is None else _day(one, swap=swap) for one in found]) for swap in (False, True)
    ]
    lengths = [np.inf if np.isinf(days).any() else np.nanmax(days) - np.nanmin(days) for days in orders]
    return orders[int(np.argmin(lengths))]


def _day(found: re.Match[str], *, swap: bool) -> float:
    """Return the number of a day; infinite where the order does not fit."""
    a, b, c = found["a"], found["b"], found["c"]
    if a is None:
        return float("nan")
    year, month, day = (a, b, c) if len(a) == 4 else (c, b, a)
    if swap and month.isdigit():
        month, day = day, month
    number = int(month) if month.isdigit() else _MONTHS.get(month.casefold(), 0)
    full = int(year) + (2000 if len(year) <= 2 else 0)
    try:
        return float(date(full, number, int(day)).toordinal())
    except ValueError:
        return float("inf")
