"""Text for a sweep: how many cases, between which values the answers lie, and some of the cases."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from separatrix.present.text.tables import facts, paragraph, quantity, section, significant, table

if TYPE_CHECKING:
    from separatrix.explore.sweep import Sweep
    from separatrix.study import Study

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


def sweep(found: Sweep, study: Study) -> list[str]:  # noqa: ARG001
    """Counts and ranges, then cases spread evenly over all."""
    cases = found.cases
    refused = [case for case in cases if case.reason and case.verdict is None]
    lines = [
        ("Varied", ", ".join(one.name for one in found.parameters)),
        ("Cases", f"{len(cases)}, of which {len(refused)} refused"),
    ]
    verdicts = Counter(case.verdict for case in cases if case.verdict)
    if verdicts:
        lines.append(
            ("Verdicts", ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items())))
        )
    for label, (key, unit) in RANGES.items():
        values = [value for case in cases if (value := getattr(case, key)) is not None]
        if values:
            lines.append((label, f"{quantity(min(values), unit)} to {quantity(max(values), unit)}"))
    some = f"{SHOWN} of {len(cases)} cases; sweep.csv, sweep.xlsx and sweep.nc have all."
    which = ["", paragraph(some)] if len(cases) > SHOWN else []
    blocks = [section("Sweep", facts(lines)), section("Cases", _table(found), *which)]
    if refused:
        blocks.append(paragraph(f"Case {refused[0].case}: {refused[0].reason}", first="  "))
    return blocks


def _table(found: Sweep) -> str:
    cases = found.cases
    if len(cases) > SHOWN:
        cases = tuple(cases[round(i * (len(cases) - 1) / (SHOWN - 1))] for i in range(SHOWN))
    names = [one.name.rpartition(".")[2] for one in found.parameters]
    headers = ["case", *names, "eta", "C_mu", "pressure", *(["P(stable)", "verdict"] * found.verdicts)]
    rows = []
    for case in cases:
        given = zip(found.parameters, case.values, strict=True)
        row = [str(case.case), *(quantity(value, one.unit or "-") for one, value in given)]
        row += [significant(case.restitution_factor), quantity(case.race_damping, "N s/m")]
        row += [quantity(case.max_pressure_inner, "Pa")]
        if found.verdicts:
            row += [significant(case.probability_stable, 3), case.verdict or "-"]
        rows.append(row)
    return table(headers, rows)
