"""Text for a sweep: how many cases, between which values the answers lie, and some of the cases."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from separatrix.explore.sweep import Sweep, SweptCase
from separatrix.present.text.tables import facts, paragraph, quantity, section, significant, stated, table
from separatrix.present.walk import field_units

if TYPE_CHECKING:
    from separatrix.study import Study

SHOWN = 15
"""Cases in the printed table."""

RANGES = {
    "restitution_factor": "Restitution factor",
    "race_damping": "Race damping",
    "max_pressure_inner": "Pressure, inner race",
    "max_pressure_outer": "Pressure, outer race",
    "spin_roll_ratio_inner": "Spin/roll ratio, inner",
    "ball_cage_friction": "Pocket friction",
    "probability_stable": "P(stable)",
    "largest_offset": "Largest offset",
    "largest_contact_force": "Force at a pocket",
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
        counted = (f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
        lines.append(("Verdicts", ", ".join(counted)))
    units = field_units(SweptCase)
    for key, words in RANGES.items():
        values = [value for case in cases if (value := getattr(case, key)) is not None]
        if values:
            ends = (quantity(end, units[key]) for end in (min(values), max(values)))
            lines.append((words, " to ".join(ends)))
    which = []
    if (total := len(cases)) > SHOWN:
        cases = tuple(cases[round(i * (total - 1) / (SHOWN - 1))] for i in range(SHOWN))
        which = ["", paragraph(f"{SHOWN} of {total} cases; sweep.csv, sweep.xlsx and sweep.nc have all.")]
    names = [one.name.rpartition(".")[2] for one in found.parameters]
    headers = ["case", *names, "eta", "C_mu", "pressure", *(["P(stable)", "verdict"] * found.verdicts)]
    rows = []
    for case in cases:
        given = zip(found.parameters, case.values, strict=True)
        row = [str(case.case), *(quantity(value, one.unit or "-") for one, value in given)]
        row += [significant(case.restitution_factor), stated(case, "race_damping")]
        row += [stated(case, "max_pressure_inner")]
        if found.verdicts:
            row += [significant(case.probability_stable, 3), case.verdict or "-"]
        rows.append(row)
    blocks = [section("Sweep", facts(lines)), section("Cases", table(headers, rows), *which)]
    if refused:
        blocks.append(paragraph(f"Case {refused[0].case}: {refused[0].reason}", first="  "))
    return blocks
