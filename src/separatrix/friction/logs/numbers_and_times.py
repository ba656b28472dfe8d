"""Numbers and times as a log writes them, with what is neither: nothing is repaired."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from separatrix.friction.logs.log_tables import PERCENT, is_clock
from separatrix.friction.logs.names import MISSING
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, printable

FLOAT = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][+-]?[0-9]{1,3})?")
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:[.,][0-9]{3})+")
_PLAIN = frozenset("0123456789+-.eE\n")
_ZONE = re.compile(r"[T ]\d{1,2}:.*(?:Z|[+-]\d{2}:?\d{2})$")
_TIME = re.compile(r"(\d{1,4}):(\d{1,2})(?::(\d{1,2}(?:[.,:]\d+)?))?\s*([AaPp])?\.?[Mm]?\.?")
DAY = 86_400.0


class UnfitError(InputError):
    """A table that its map does not fit: it lacks a column, or states another unit."""


def decimal_of(cells: Sequence[Sequence[str]], separator: str, source: str) -> str:
    """The decimal sign of the numbers; empty where none has one. Marks between thousands are refused."""
    if separator == "," and not any("," in cell for column in cells for cell in column):
        return "."
    found: dict[str, str] = {}
    certain = False
    for column in cells:
        text = "\n".join(column)
        marks = [mark for mark in ",." if mark in text]
        is_plain = len(marks) == 1 and not re.search(rf"[{marks[0]}].*[{marks[0]}]", text)
        for cell in column if marks else ():
            here = [mark for mark in marks if mark in cell]
            if not here or is_clock(cell) or cell.casefold() in MISSING or not cell[-1:].isdigit():
                continue
            found |= dict.fromkeys(here, cell)
            certain = certain or not _GROUPED.fullmatch(cell)
            if len(found) > 1 or sum(map(cell.count, marks)) > 1:
                cure = "Export it without marks between thousands, or write below [format]: decimal = ..."
                got = " and ".join(f'"{printable(one)}"' for one in dict.fromkeys(found.values()))
                raise UnfitError(source, "has points and commas in its numbers", got, cure)
            if certain and is_plain:  # the others are alike
                break
    if found and not certain:
        mark, one = next(iter(found.items()))
        rule = "does not show whether its marks are decimal signs or between thousands"
        cure = f'Add to the column map, below [format]: decimal = "{mark}".'
        raise UnfitError(source, rule, f'"{printable(one)}"', cure)
    return next(iter(found), "")


def numbers(cells: Sequence[str], decimal: str, missing: frozenset[str]) -> tuple[Array, list[int]]:
    """Numbers of a column, NaN for what is missing, and the rows of what is neither."""
    text = "\n".join(cells)
    if decimal == "," and "." not in text:
        text = text.replace(",", ".")
    if text and set(text) <= _PLAIN:
        try:
            return np.array(text.split("\n"), dtype=float), []
        except ValueError:  # an empty cell, or `1-2`
            pass
    found, wrong = np.full(len(cells), np.nan), []
    for i, cell in enumerate(cells):
        one = cell.rstrip(PERCENT)
        plain_number = one.replace(",", ".") if decimal == "," and "." not in one else one
        if FLOAT.fullmatch(plain_number):
            found[i] = float(plain_number.replace("d", "e").replace("D", "e"))
        elif one.casefold() not in missing:
            wrong.append(i)
    return np.where(np.isfinite(found), found, np.nan), wrong


def seconds(cells: Sequence[str], form: str, missing: frozenset[str] = MISSING) -> tuple[Array, list[int]]:
    """Seconds since the first time, NaN for what is missing, and the rows of what is not a time.

    A clock that falls back by more than half a day has passed midnight. Zones of dates count; where
    only some dates have one, the others are wrong.
    """
    texts = ["" if cell.casefold() in missing else cell for cell in cells]
    there = np.array([bool(text) for text in texts])
    found = np.full(len(texts), np.nan)
    if form == "iso" or "%" in form:
        import pandas as pd

        zones = np.array([bool(_ZONE.search(text)) for text in texts])
        if zones.any() and not zones[there].all():
            return found, np.flatnonzero(there & ~zones).tolist()
        dates = pd.Series([text.replace(",", ".") for text in texts], dtype="str")
        moments = pd.to_datetime(
            dates, format="ISO8601" if form == "iso" else form, errors="coerce", utc=True
        )
        fits = moments.notna().to_numpy()
        if fits.any():
            found[fits] = (moments[fits] - moments[fits].iloc[0]).dt.total_seconds()
    else:
        for i in np.flatnonzero(there):
            found[i] = _time(texts[i], form)
        fit = np.flatnonzero(np.isfinite(found))
        found[fit[1:]] += DAY * np.cumsum(np.diff(found[fit]) < -DAY / 2.0)
        found -= found[fit[0]] if fit.size else 0.0
    return np.round(found, 9), np.flatnonzero(there & ~np.isfinite(found)).tolist()


def _time(text: str, form: str) -> float:
    """Seconds of a time of day; NaN where it is not one of that form."""
    match = _TIME.fullmatch(text)
    if match is None or (match[3] is None and form == "clock"):
        return float("nan")
    first, second = float(match[1]), float(match[2])
    if match[3] is None and form == "mm:ss":
        return 60.0 * first + second
    if match[4]:
        first = first % 12.0 + (12.0 if match[4] in "pP" else 0.0)
    return 3600.0 * first + 60.0 * second + float(re.sub("[,:]", ".", match[3] or "0"))
