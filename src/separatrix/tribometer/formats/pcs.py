"""PCS Instruments (MTM and others): tab separated text.

``MTM311 Test Data File``, lines about the test; for each step ``Step 1 started at ...``, lines about the
step, one line of headers with units in parentheses and the rows. Step time and traction coefficient stand in
it twice.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout

_STEP = re.compile(r"\s*Step\s+(\d+)\s+started at", re.IGNORECASE)


def _table_name(lines: list[str]) -> str:
    steps = [found[1] for line in lines if (found := _STEP.match(line))]
    return f"step {steps[-1]}" if steps else ""


LAYOUT = Layout(
    name="PCS Instruments text",
    recognised=lambda head: "Test Data File" in head[:200],
    table_name=_table_name,
)
