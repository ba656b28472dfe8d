"""The lines above a table: names and units of its columns, metadata, and the instrument that wrote them.

The table itself is read the same way for all instruments, which docs/reference/tribometer-logs.md describes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from separatrix.friction.logs.column_map import TextFormat
from separatrix.friction.logs.dialect import Dialect, is_number
from separatrix.friction.logs.names import ALIASES, NONE, TORQUES, ranks
from separatrix.ground import units
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable

_OTHER_UNITS = (
    "% %rh v mv a ma w kw hz khz deg \u00b0 rad g kg nm mm2 mm3 um3 um2 bar mbar pa kpa mpa l/min ml/min "
    "ohm ohms db"
)
_UNIT_WORDS = frozenset(
    [spelling.casefold() for table in units.UNITS.values() for spelling in table]
    + [word for table in ALIASES.values() for group in table.values() for word in group.split("; ")]
    + [unit.casefold() for unit in TORQUES]
    + [*_OTHER_UNITS.split(), "n m", "n mm", "n\u00b7m", "n\u00b7mm", *NONE]
    + ["n.a.", "cycles", "laps", "rev", "revs", "u", "\u00b5m", "\u03bcm"]
)


_REMARKS = frozenset(
    {"comment", "comments", "remark", "remarks", "note", "notes", "kommentar", "bemerkung", "commentaire"}
)
"""Names of a last column that the rows leave out."""

_PAIR = re.compile(r"[\s#%]*([^:=\t;,]{1,60}?)\s*(?:[:=\t;,]\s*)+(\S.*?)[\s;,]*$")
_NUMBERED = re.compile(r"\s*(Run|Step)\s*(?:#|No\.?)\s*(\d+)\s*$", re.IGNORECASE)
MOST = 400  # pairs kept of one table


@dataclass(frozen=True, slots=True)
class Header:
    """Names and units of the columns, and which of the lines before the table they are."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    lines: tuple[str, ...] = ()


def find_header(before: Sequence[str], count: int, dialect: Dialect) -> Header | None:
    """Header of a table of `count` columns among the lines before it: the last that fits.

    The line below the names is that of the units if all its fields are units or in brackets.
    """
    matching: list[tuple[str, list[str]]] = []
    filled = [
        line for line in before if any(f.casefold() not in dialect.missing for f in dialect.fields(line))
    ]
    for line in reversed(filled[-8:]):
        row = _row(line, count, dialect)
        if row is not None and _is_words(row, dialect):
            matching.append((line, row))
    if not matching:
        return None
    if len(matching) > 1 and is_units(matching[0][1]):
        (units_line, units_row), (line, names) = matching[:2]
        return Header(tuple(names), tuple(bare_unit(unit) for unit in units_row), (line, units_line))
    line, names = matching[0]
    if len(matching) > 1:  # of cells merged over two rows the text is in the upper one
        names = [name or above for name, above in zip(names, matching[1][1], strict=True)]
    return Header(tuple(names), ("",) * count, (line,))


def header_at(
    line: Callable[[int], str], form: TextFormat, count: int, source: str, dialect: Dialect
) -> Header:
    """Header in the lines that the column map names."""
    rows, lines = [], []
    for key, number in (("header_line", form.header_line), ("units_line", form.units_line)):
        row = [""] * count if number is None else _row(line(number - 1), count, dialect)
        if row is None:
            where, shown = f"{source}: {key} = {number}", f'"{printable(line((number or 1) - 1))}"'
            raise InputError(where, f"must be a line of {count} fields", shown)
        rows.append(row)
        lines += [] if number is None else [line(number - 1)]
    return Header(tuple(rows[0]), tuple(bare_unit(unit) for unit in rows[1]), tuple(lines))


def is_names(line: str, dialect: Dialect) -> bool:
    """True for a line of names or units; a row of the table is not one."""
    row = dialect.fields(line)
    filled = [field for field in row if field.casefold() not in dialect.missing]
    return bool(filled) and not dialect.is_data(line) and _is_words(row, dialect)


def _is_words(row: Sequence[str], dialect: Dialect) -> bool:
    """True where more fields are words than numbers; a mark for a missing value is neither."""
    filled = [field for field in row if field.casefold() not in dialect.missing]
    numbers = sum(is_number(field) for field in filled)
    return len(filled) > 2 * numbers or is_units(row)


def is_units(row: Sequence[str]) -> bool:
    """True for a row of units: at least two of them, and nothing that could be a name."""
    bare = [bare_unit(field) for field in row]
    known = [unit for unit in bare if unit.casefold() in _UNIT_WORDS]
    filled = [unit for unit in known if unit]
    brackets = all(not field or field[0] in "[(" for field in row)
    if brackets:
        return len(bare) > 1
    names = [field for field in bare if ranks(field) and field.casefold() not in _UNIT_WORDS]
    return not names and len(filled) >= 1 and len(known) >= 0.7 * len(bare)


def bare_unit(unit: str) -> str:
    """A unit without the brackets around it."""
    return re.sub(r"^\s*[\[(]\s*(.*?)\s*[\])]\s*$", r"\1", unit).strip()


def _row(line: str, count: int, dialect: Dialect) -> list[str] | None:
    """Fields of a line of names if there are `count`, not counting an empty one that a last separator makes.

    Blanks may divide names in several ways. The mark of a remark before the names is left out.
    """
    bare = re.sub(r"^\s*[#%]+\s*", "", line)
    ways = [dialect.fields(bare)]
    if dialect.separator == " ":
        ways = []
        for text in dict.fromkeys((bare, line)):
            bound = re.sub(r"\s+(?=[\[(])", "\x00", text)
            ways.append([part.strip() for part in re.split(r"\t| {2,}", text.strip())])
            ways += [[part.replace("\x00", " ") for part in bound.split()], text.split()]
    for row in ways:
        if len(row) == count:
            return row
        if len(row) == count + 1 and (not row[-1] or row[-1].casefold() in _REMARKS):
            return row[:-1]
        if 2 <= len(row) == count - 1 and dialect.separator != " ":
            return [*row, ""]
    return None


def metadata_of(
    lines: Sequence[str], header: Sequence[str] = (), *, keys_above: bool = False
) -> dict[str, str]:
    """Pairs in the lines: ``key: value``, ``key = value``, or a row of keys over one of values.

    Two lines of two fields each are taken as two pairs, unless the format is known for its row of keys.
    """
    kept = [line for line in lines if line not in header]
    pairs: dict[str, str] = {}
    skip = False
    for line, below in zip(kept, [*kept, ""][1:], strict=True):
        if skip:
            skip = False
        elif rows := _keys_over_values(line, below, 1 if keys_above else 2):
            pairs |= rows
            skip = True
        elif found := _NUMBERED.match(line) or _PAIR.match(line):
            pairs[_clean(found[1])] = _clean(found[2])
    return {key[:100]: value[:200] for key, value in list(pairs.items())[:MOST]}


def _keys_over_values(line: str, below: str, least: int) -> dict[str, str]:
    """Two rows of as many commas, semicolons or tabs, the upper of words alone."""
    for separator in "\t;,":
        count = line.count(separator)
        named = line.rstrip(separator).count(separator)  # every row of a sheet is as long as the longest
        if named >= least and below.count(separator) == count:
            keys, values = line.split(separator), below.split(separator)
            if not any(re.match(r"\s*[+-]?\d", key) for key in keys):
                return {
                    _clean(key): _clean(value)
                    for key, value in zip(keys, values, strict=True)
                    if key.strip() and value.strip()
                }
    return {}


def _clean(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text).strip().strip('"').strip()


_LINES = re.IGNORECASE | re.MULTILINE


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Facts of one format that its files do not state themselves."""

    name: str
    recognised: Callable[[str], object]  # from the first 20 000 characters of the file
    rename: Callable[[str], str] = str.strip  # A header in the words of the published table of names
    units: Mapping[str, str] = field(default_factory=dict)
    """Unit of a header, as `rename` returns it, where the file writes none."""
    spellings: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """Unit that a spelling means in a column of some meaning: ``{("normal_force", "g"): "gf"}``."""
    interruption: re.Pattern[str] | None = None
    """Lines that may appear between rows of the table and are not part of it."""
    heading: re.Pattern[bytes] | None = None
    """Blocks of lines that are never rows, however many numbers are in them."""
    keys_above: bool = False  # A line of keys is above one of values, even if there are only two of them
    numbered: Mapping[str, re.Pattern[str]] = field(default_factory=dict)
    """Lines before a table that number it, by the word for its name: ``run 1, step 2``."""
    series: Callable[[str], str] = lambda _: ""
    """What the head of a file states about the test that it is a part of."""
    same: tuple[str, ...] = ()  # keys of metadata whose values, but for the sign, all parts of a test share
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


PLAIN = Layout(name="plain text", recognised=lambda _: True)  # a table of an unknown instrument
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
