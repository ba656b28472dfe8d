"""Rtec multi-function tribometers: CSV of the data logger.

A line of metadata names and one of their values; one line of headers such as ``Step, Timestamp, RecipeStep,
DAQ.Fz (N),DAQ.Fx (N),DAQ.COF (),Rotary.Velocity (rpm),XYZ.Z Depth (mm),`` that ends, like every row, with a
comma; the rows; and ``TotalTime`` with its value at the end. The timestamp is in seconds and begins anew with
each step, so every step is a log of its own.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout

_HEADER = re.compile(
    r'^(?:[\s"]*Step[\s"]*[,;\t])?[\s"]*Timestamp[\s"]*[,;\t](?:.*[,;\t])?[\s"]*DAQ\.',
    re.IGNORECASE | re.MULTILINE,
)


def _header(header: str) -> str:
    name = re.sub(r"^\s*(?:DAQ|XYZ|Rotary|Linear|Lateral|Reciprocating|Temperature)\.", "", header).strip()
    coefficient = re.fullmatch(r"COF\s*(?:\([^)]*\))?", name)
    if coefficient:
        return "COF"
    return f"Rotary {name}" if header.strip().startswith("Rotary.Velocity") else name


LAYOUT = Layout(
    name="Rtec CSV",
    recognised=lambda head: _HEADER.search(head) is not None,
    header=_header,
    units={"Timestamp": "s"},
    keys_above=True,
    split_by=("Step", "RecipeStep"),
)
