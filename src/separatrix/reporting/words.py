"""Numbers of documents as text: each is formatted here, once, for every form of the report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from separatrix.present.text import tables
from separatrix.present.text.tables import ABSENT, interval
from separatrix.reporting.record import Facts

Row = Mapping[str, Any]

MICRO = ("um", "uJ", "uW", "us", "uN")
"""Units that the program writes in ASCII."""


def quantity(value: float | None, unit: str, digits: int | None = None) -> str:
    """Return a value in a unit a reader likes, with the micro sign; a dash if it is absent."""
    number, space, symbol = tables.quantity(value, unit, digits).partition(" ")
    return number + space + (symbol.replace("u", "\N{MICRO SIGN}", 1) if symbol in MICRO else symbol)


def probability(row: Row) -> str:
    """Return P(stable) with its interval, or a dash."""
    if row.get("probability_stable") is None:
        return ABSENT
    return interval(row["probability_stable"], row["probability_low"], row["probability_high"])


def threshold(row: Row) -> str:
    """Return the restitution threshold with its interval, or a dash."""
    if row.get("restitution_threshold") is None:
        return ABSENT
    ends = row["restitution_threshold_low"], row["restitution_threshold_high"]
    return interval(row["restitution_threshold"], *ends)


def margin(row: Row) -> str:
    """Return the margin with its sign, or a dash."""
    return ABSENT if row.get("margin") is None else f"{row['margin']:+.2f}"


def verdict(row: Row) -> str:
    """Return the verdict, or why there is none."""
    if row.get("verdict"):
        return str(row["verdict"])
    return "not measured" if row.get("friction") is None else "not finished"


def own_rows(rank: Row) -> list[Row]:
    """Return the rows of the bearing's own environment."""
    found = [one["materials"] for one in rank["environments"] if one["name"] == rank["environment"]]
    return list(found[0]) if found else []


def places(rows: Iterable[Row]) -> list[str]:
    """Return the ranks, = after a shared one, a dash for none."""
    ranks = [row.get("rank") for row in rows]
    return [ABSENT if rank is None else f"{rank}{'=' * (ranks.count(rank) > 1)}" for rank in ranks]


def entry(item: Mapping[str, Any], digits: int | None = None) -> str:
    """Return a value of a resolved study with its unit; a dash without one."""
    value, unit = item.get("value"), item.get("unit")
    if value is None:
        return ABSENT
    if isinstance(value, list):
        return ", ".join(entry({"value": one, "unit": unit}, digits) for one in value) or ABSENT
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    return quantity(value, unit, digits) if unit else f"{value:g}"


def both(inner: Row, outer: Row, names: Mapping[str, tuple[str, str]]) -> tuple[tuple[str, ...], ...]:
    """Return rows of a table of both races; `names` has words and unit of each key."""
    return tuple(
        (words, *(quantity(one.get(key), unit, 4) for one in (inner, outer)))
        for key, (words, unit) in names.items()
    )


def facts(*pairs: tuple[str, str]) -> Facts:
    """Return labels with their values, without those that have none."""
    return Facts(tuple((label, value) for label, value in pairs if value and value != ABSENT))
