"""The section on a sweep: the operating envelope with its worst case."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from separatrix.present.text.stability import DECIDES
from separatrix.reporting.kept import Kept
from separatrix.reporting.pictures import picture
from separatrix.reporting.record import Block, Facts, Paragraph, Section, Table
from separatrix.reporting.words import margin, probability, quantity, verdict

MOST_CASES = 40
TIMES = {
    "below_margin": "with a margin below 0",
    "stable": "STABLE",
    "unstable": "UNSTABLE",
    "undecided": "UNDECIDED",
    "refused": "without an answer",
}
Row = Mapping[str, Any]


def envelope(kept: Kept) -> Section:
    """Return the section of the answer of `sweep`."""
    return Section("Operating envelope", tuple(_envelope(kept)))


def _envelope(kept: Kept) -> Iterator[Block]:
    found = kept.document
    worst, cases = found["worst"], found["cases"]
    if worst is not None:
        case = next(row for row in cases if row["case"] == worst["case"])
        at = ", ".join(f"{name} {_value(case, one)}" for name, one in _parameters(found).items())
        words = f"Of {worst['compared']} cases the worst is number {worst['case']}: {at}. "
        yield Paragraph(f"{words}It has the {DECIDES[worst['quantity']]}: {worst['value']:.3g}.")
    if (duty := found["duty"]) is not None:
        known = {words: duty[key] for key, words in TIMES.items() if duty[key] is not None}
        yield Facts(tuple((f"Time {words}", f"{100 * share:.3g} %") for words, share in known.items()))
    for name in ("envelope", "sweep"):
        words = "Stability and frequencies over the cases; orders are those of shaft, cage and balls."
        shown = [*picture("sweep", kept.data, name, words, words)]
        if shown:
            yield from shown
            break
    yield _table(found, cases)


def _parameters(found: Row) -> dict[str, Row]:
    return {str(one["name"]).rpartition(".")[2].replace("_", " "): one for one in found["parameters"]}


def _value(case: Row, parameter: Row) -> str:
    return quantity(case[parameter["name"]], parameter["unit"] or "-")


def _table(found: Row, cases: list[Row]) -> Table:
    names = _parameters(found)
    head = ("case", *names, "eta", "margin", "P(stable)", "verdict or reason")
    rows = tuple(
        (
            str(case["case"]),
            *(_value(case, one) for one in names.values()),
            quantity(case["restitution_factor"], "-", 3),
            "-" if case["margin"] is None else margin(case),
            "-" if case["probability_stable"] is None else probability(case),
            verdict(case) if case["verdict"] else case["reason"] or "-",
        )
        for case in cases[:MOST_CASES]
    )
    more = len(cases) - MOST_CASES
    return Table(head, rows, f"The cases{f'; {more} more are in the answer' if more > 0 else ''}.")
