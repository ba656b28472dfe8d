"""Text formats of instruments: how each is recognised, and what its files do not state themselves.

The table in a file is read the same way for all. docs/reference/tribometer-logs.md describes the formats.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

_LINES = re.IGNORECASE | re.MULTILINE


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Facts of one format that its files do not state themselves."""

    name: str
    recognised: Callable[[str], object]
    """From the first 20 000 characters of the file."""
    rename: Callable[[str], str] = str.strip
    """A header in the words of the published table of names."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Unit of a header, as `rename` returns it, where the file writes none."""
    spellings: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """Unit that a spelling means in a column of some meaning: ``{("normal_force", "g"): "gf"}``."""
    interruption: re.Pattern[str] | None = None
    """Lines that may appear between rows of the table and are not part of it."""
    heading: re.Pattern[bytes] | None = None
    """Blocks of lines that are never rows, however many numbers they hold."""
    keys_above: bool = False
    """A line of keys is above one of values, even if there are only two of them."""
    numbered: Mapping[str, re.Pattern[str]] = field(default_factory=dict)
    """Lines before a table that number it, by the word for its name: ``run 1, step 2``."""
    series: Callable[[str], str] = lambda _: ""
    """What the head of a file states about the test that it is a part of."""
    same: tuple[str, ...] = ()
    """Keys of metadata whose values, but for the sign, all parts of a test share."""
    split_by: tuple[str, ...] = ()
    """Headers, as the file writes them, whose change begins a new table; the first that exists counts."""

    def table_name(self, lines: Sequence[str]) -> str:
        """Name of a table from the lines before it; empty where they do not number it."""
        found = {
            word: [match[1] for line in lines if (match := pattern.match(line))]
            for word, pattern in self.numbered.items()
        }
        return ", ".join(f"{word} {numbers[-1]}" for word, numbers in found.items() if numbers)


# Anton Paar (CSM) TRB, THT and Nano: `key : value [unit]` lines, then headers with units in brackets
_ANTON_PAAR_HEADER = re.compile(r"^Time \[s\]\s.*(?:\u00b5|\u03bc|\blaps\b)", _LINES)
_ANTON_PAAR = re.compile(r"\tsequence id|Anton Paar|CSM Instruments|TRB|TRN|THT|TriboX|Nano Tribometer", re.I)

# Rtec: CSV whose timestamp, in seconds, begins anew with each step; every row ends with a comma
_RTEC_HEADER = re.compile(
    r'^(?:[\s"]*Step[\s"]*[,;\t])?[\s"]*Timestamp[\s"]*[,;\t](?:.*[,;\t])?[\s"]*DAQ\.', _LINES
)

# Bruker (CETR) UMT: a table for each step; forces in gram-force, compression negative. A test of strokes is a
# numbered data file for each stroke, or there and back; all share script, radius, velocity and set force.
# Radius, Velocity and Set Force carry no units and are therefore not conditions.
_UMT_DATA = re.compile(r"^(.*?)[ _-]*\d+\.tst\s*$", _LINES)
_UMT_SCRIPT = re.compile(r"^Script file\s+(.*?)\s*$", _LINES)
_UMT_FORCES = ("normal_force", "tangential_force")


def _rtec_name(header: str) -> str:
    name = re.sub(r"^\s*(?:DAQ|XYZ|Rotary|Linear|Lateral|Reciprocating|Temperature)\.", "", header).strip()
    if re.fullmatch(r"COF\s*(?:\([^)]*\))?", name):
        return "COF"
    return f"Rotary {name}" if header.strip().startswith("Rotary.Velocity") else name


def _umt_series(head: str) -> str:
    """Name of the numbered data file without its number, and the script that ran the test."""
    data, script = _UMT_DATA.search(head), _UMT_SCRIPT.search(head)
    return f"{data[1]} {script[1] if script else ''}" if data else ""


PLAIN = Layout(name="plain text", recognised=lambda _: True)  # A table in text of no known instrument
LAYOUTS = (
    Layout(  # .lvm: a head and segments, each with a block of keys and its own table; X_Value is the time
        name="LabVIEW text",
        recognised=lambda head: head.startswith("LabVIEW Measurement"),
        rename=lambda header: "Time" if header.strip() == "X_Value" else header,
        units={"Time": "s"},
        heading=re.compile(
            rb"^(?:LabVIEW Measurement|Channels[\t;,])(?:.*\n)*?\*\*\*End_of_Header\*\*\*.*\n", re.MULTILINE
        ),
    ),
    Layout(  # MTM and others: `Step 1 started at ...`, lines about the step, headers with units, rows
        name="PCS Instruments text",
        recognised=lambda head: "Test Data File" in head[:200],
        numbered={"step": re.compile(r"\s*Step\s+(\d+)\s+started at", re.IGNORECASE)},
    ),
    Layout(
        name="Anton Paar text",
        recognised=lambda head: _ANTON_PAAR_HEADER.search(head) and _ANTON_PAAR.search(head),
    ),
    Layout(
        name="Rtec CSV",
        recognised=_RTEC_HEADER.search,
        rename=_rtec_name,
        units={"Timestamp": "s"},
        keys_above=True,
        split_by=("Step", "RecipeStep"),
    ),
    Layout(
        name="Bruker UMT text",
        recognised=lambda head: "CETR" in head or "UMT" in head[:2000] or "TriboLab" in head[:2000],
        spellings={(meaning, unit): f"{unit}f" for meaning in _UMT_FORCES for unit in ("g", "kg")},
        numbered={
            word: re.compile(rf"^\s*{word}\s*(?:#|No\.?)\s*(\d+)", re.IGNORECASE) for word in ("run", "step")
        },
        series=_umt_series,
        same=("Step Type Code", "Radius", "Velocity", "Set Force"),
    ),
    Layout(  # among the rows, lines that name a file of fast data, which is a log of its own
        name="Phoenix Compend text",
        recognised=re.compile(r"^\s*Test started at", _LINES).search,
        interruption=re.compile(
            r"\s*(?:Fast data in|High speed data|Step \d+|Test paused|Test resumed)", re.IGNORECASE
        ),
    ),
    PLAIN,
)
"""In the order in which they are tried."""


def layout_of(head: str) -> Layout:
    """The first layout that recognises the beginning of a file."""
    return next(layout for layout in LAYOUTS if layout.recognised(head))
