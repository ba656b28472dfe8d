"""Bruker (CETR) UMT: text exported by the data viewer.

``Created by CETR ...`` lines, ``Run # 1``, and for every step ``Step No. 1`` with ``key = value`` lines, one
line of short headers (Fx, Fz, Z, T, Ff, COF), one of their units, an empty line, and the rows. T is the time
in the step, so every step is a log of its own. A force in ``g`` is gram-force; compression counts negative.
A test of
strokes is a numbered data file for each stroke, or there and back; all share script, radius, velocity and set
force. The keys (Radius, Velocity, Set Force) carry no units and are therefore not taken as conditions.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout

_DATA = re.compile(r"^(.*?)[ _-]*\d+\.tst\s*$", re.IGNORECASE | re.MULTILINE)
_SCRIPT = re.compile(r"^Script file\s+(.*?)\s*$", re.IGNORECASE | re.MULTILINE)
_FORCES = ("normal_force", "tangential_force")
_RUN = re.compile(r"^\s*Run\s*(?:#|No\.?)\s*(\d+)", re.IGNORECASE)
_STEP = re.compile(r"^\s*Step\s*(?:#|No\.?)\s*(\d+)", re.IGNORECASE)


def _recognised(head: str) -> bool:
    return "CETR" in head or "UMT" in head[:2000] or "TriboLab" in head[:2000]


def _series(head: str) -> str:
    """Name of the numbered data file without its number, and the script that ran the test."""
    data, script = _DATA.search(head), _SCRIPT.search(head)
    return f"{data[1]} {script[1] if script else ''}" if data else ""


def _table_name(lines: list[str]) -> str:
    steps = [found[1] for line in lines if (found := _STEP.match(line))]
    runs = [found[1] for line in lines if (found := _RUN.match(line))]
    numbers = (("run", runs), ("step", steps))
    return ", ".join(f"{word} {found[-1]}" for word, found in numbers if found)


LAYOUT = Layout(
    name="Bruker UMT text",
    recognised=_recognised,
    spellings={(meaning, unit): f"{unit}f" for meaning in _FORCES for unit in ("g", "kg")},
    table_name=_table_name,
    series=_series,
    same=("Step Type Code", "Radius", "Velocity", "Set Force"),
)
