"""Parts of one test in one log: strokes that an instrument writes one by one, or a test in several files."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from separatrix.errors import InputError
from separatrix.friction.logs.log import ABSCISSAE, MEANINGS, Conditions, RawLog
from separatrix.units import format_number, format_quantity, printable, unit_of

ALIKE = 0.1
"""Share by which measured conditions of parts may differ; beyond it they are of different tests."""

LISTED = 12
"""Parts whose friction is listed."""


def in_order(name: str) -> list[tuple[int, str]]:
    """Key that sorts ``part 2`` before ``part 10``."""
    return [(int(part or 0), "") if part.isdigit() else (0, part) for part in re.split(r"(\d+)", name)]


def by_series(logs: Sequence[RawLog]) -> list[list[RawLog]]:
    """Return the logs, those of one series in several files together, at the place of the first of them."""
    groups: dict[tuple[str, int], list[RawLog]] = {}
    for i, log in enumerate(logs):
        groups.setdefault((log.series, 0 if log.series else i), []).append(log)
    found: list[list[RawLog]] = []
    for parts in groups.values():
        found += [parts] if len({part.checksum for part in parts}) > 1 else [[part] for part in parts]
    return found


def joined(parts: Sequence[RawLog]) -> RawLog:
    """Return one log of the parts of a test, one after the other; time goes on from one to the next.

    Raises
    ------
    InputError
        The parts have no abscissa in common, or were run under different conditions.
    """
    if len(parts) == 1:
        return parts[0]
    parts = sorted(parts, key=lambda part: in_order(part.source))
    source = f"{parts[0].source} and {len(parts) - 1} more"
    columns: dict[str, Any] = {}
    for name in (f.name for f in fields(RawLog) if f.name in MEANINGS):
        pieces = [getattr(part, name) for part in parts]
        if any(piece is None for piece in pieces):
            columns[name] = None
            continue
        for i in range(1, len(pieces) if name in ABSCISSAE else 0):  # one that begins anew goes on
            last, piece = pieces[i - 1][-1], pieces[i]
            if piece[0] < last:
                pieces[i] = piece + (last - piece[0] + float(np.median(np.diff(piece))))
        columns[name] = np.concatenate(pieces)
    if all(columns[name] is None for name in ABSCISSAE):
        raise InputError(source, "have no column of time, distance or cycles in common to be joined by")
    if len({part.series for part in parts}) == 1 and parts[0].series and columns["cycles"] is None:
        # a cycle is a stroke there and the one back
        strokes = [(k + np.arange(part.rows) / part.rows) / 2.0 for k, part in enumerate(parts)]
        columns["cycles"] = np.concatenate(strokes)
    means = [format_number(float(part.friction.mean()), 3) for part in parts]
    more = "" if len(means) <= LISTED else f" and {len(means) - LISTED} more"
    note = (
        f"{len(parts)} parts of one test are joined, {parts[0].source} to {parts[-1].source}; "
        f"their frictions: {', '.join(means[:LISTED])}{more}"
    )
    return replace(
        parts[0],
        source=source,
        checksum=hashlib.sha256("".join(part.checksum for part in parts).encode()).hexdigest(),
        missing=sum(part.missing for part in parts),
        conditions=_conditions(parts, source),
        notes=(note, *parts[0].notes),
        series="",
        **columns,
    )


def _conditions(parts: Sequence[RawLog], source: str) -> Conditions:
    """Conditions of all parts: words that agree, and the middle of measured values that are alike."""
    found: dict[str, object] = {}
    for f in fields(Conditions):
        values = [value for part in parts if (value := getattr(part.conditions, f.name)) is not None]
        numbers = [value for value in values if isinstance(value, float)]
        if numbers:
            found[f.name] = float(np.median(numbers))
            differs = max(numbers) - min(numbers) > ALIKE * float(np.median(numbers))
        else:
            found[f.name] = values[0] if values else None
            differs = len(set(values)) > 1
        if differs:
            unit = unit_of(Conditions, f.name)
            ends = (min(values), max(values))
            texts = [format_quantity(v, unit) if unit else printable(str(v)) for v in ends]
            rule = f"cannot be one test: their {f.name.replace('_', ' ')} differs"
            raise InputError(source, rule, " and ".join(texts), "Name the parts of one test only.")
    return Conditions(**found)  # type: ignore[arg-type]
