"""Text for a sweep: how many cases, between which values the answers lie, and some of the cases."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from separatrix.report.tables import facts, paragraph, quantity, section, significant, table

Document = Mapping[str, Any]
Row = Mapping[str, Any]

SHOWN = 15
"""Cases in the printed table."""

RANGES = {
    "Restitution factor": ("restitution_factor", "-"),
    "Race damping": ("race_damping", "N s/m"),
    "Pressure, inner race": ("max_pressure_inner", "Pa"),
    "Pressure, outer race": ("max_pressure_outer", "Pa"),
    "Spin/roll ratio, inner": ("spin_roll_ratio_inner", "-"),
    "Pocket friction": ("ball_cage_friction", "-"),
    "P(stable)": ("probability_stable", "-"),
    "Largest offset": ("largest_offset", "m"),
    "Force at a pocket": ("largest_contact_force", "N"),
}


def sweep(document: Document) -> list[str]:
    """Counts and ranges, then cases spread evenly over all."""
    cases = document["cases"]
    refused = [case for case in cases if case["reason"] and case["verdict"] is None]
    blocks = [
        section("Sweep", facts([*_counts(document, cases, refused), *_ranges(cases)])),
        section("Cases", _table(document, _some(cases)), *_which(cases)),
    ]
    if refused:
        blocks.append(paragraph(f"Case {refused[0]['case']}: {refused[0]['reason']}", first="  "))
    return blocks


def _counts(document: Document, cases: Sequence[Row], refused: Sequence[Row]) -> list[tuple[str, str]]:
    varied = ", ".join(one["name"] for one in document["parameters"])
    found = [("Varied", varied), ("Cases", f"{len(cases)}, of which {len(refused)} refused")]
    verdicts = Counter(case["verdict"] for case in cases if case["verdict"])
    counts = ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
    return [*found, ("Verdicts", counts)] if counts else found


def _ranges(cases: Sequence[Row]) -> list[tuple[str, str]]:
    """Least and largest value of what the cases have."""
    found = []
    for label, (key, unit) in RANGES.items():
        values = [case[key] for case in cases if case[key] is not None]
        if values:
            found.append((label, f"{quantity(min(values), unit)} to {quantity(max(values), unit)}"))
    return found


def _some(cases: Sequence[Row]) -> list[Row]:
    if len(cases) <= SHOWN:
        return list(cases)
    return [cases[round(i * (len(cases) - 1) / (SHOWN - 1))] for i in range(SHOWN)]


def _which(cases: Sequence[Row]) -> list[str]:
    if len(cases) <= SHOWN:
        return []
    return ["", paragraph(f"{SHOWN} of {len(cases)} cases; sweep.csv, sweep.xlsx and sweep.nc have all.")]


def _table(document: Document, cases: Sequence[Row]) -> str:
    parameters = document["parameters"]
    names = [one["name"].rpartition(".")[2] for one in parameters]
    headers = ["case", *names, "eta", "C_mu", "pressure"]
    headers += ["P(stable)", "verdict"] if document["verdicts"] else []
    rows = []
    for case in cases:
        given = [quantity(case[one["name"]], one["unit"]) for one in parameters]
        found = [significant(case["restitution_factor"]), quantity(case["race_damping"], "N s/m")]
        row = [str(case["case"]), *given, *found, quantity(case["max_pressure_inner"], "Pa")]
        if document["verdicts"]:
            row += [significant(case["probability_stable"], 3), case["verdict"] or "-"]
        rows.append(row)
    return table(headers, rows)
