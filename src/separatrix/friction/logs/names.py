"""The published table, `names.toml`: which names and units of columns mean what."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from separatrix.ground import units

MEANINGS = {
    "friction": "-",
    "tangential_force": "N",
    "normal_force": "N",
    "time": "s",
    "distance": "m",
    "cycles": "-",
    "temperature": "K",
    "wear_depth": "m",
    "slip_speed": "m/s",
    "rotational_speed": "rad/s",
}
"""What a column may mean, and the SI unit it is kept in. A rotational speed serves the conditions only."""

ABSCISSAE = ("time", "distance", "cycles")  # the columns of which a log has at least one
SHAPES = ("motion", "position", "stroke")
"""Columns in any unit that show which rows slide: speed, position, force with the sign of the stroke."""

_TABLE = tomllib.loads(files(__package__).joinpath("names.toml").read_text("utf-8"))
NAMES: dict[str, list[frozenset[str]]] = {
    key: [frozenset(group.split("; ")) for group in groups] for key, groups in _TABLE["columns"].items()
}
"""Names of each meaning; a name in an earlier entry is preferred to one in a later."""

ALIASES: dict[str, dict[str, str]] = _TABLE["units"]  # spellings beyond study files, by the size of each
SYMBOLS: dict[str, list[str]] = _TABLE["symbols"]  # they may follow a name of their meaning
_WORDS = {key: frozenset(words.split()) for key, words in _TABLE["words"].items()}
MISSING = _WORDS["missing"] | {""}  # how files write a missing value
REMARKS = _WORDS["remarks"]  # names of a last column that rows leave out
CLOCKS = {
    "clock": ("clock", "hh:mm:ss", "h:mm:ss", "h:m:s", "hms"),
    "iso": ("iso",),
    "hh:mm": ("hh:mm", "h:min"),
    "mm:ss": ("mm:ss", "min:s", "m:s"),
}
"""Units of times written as text, with the spellings of each; a format of a date is another: "%d.%m.%Y"."""

DATE_PARTS = frozenset("aAbBdfHIjmMpSyYz")
"""Letters of a format of dates, each once: those of Python but for weeks and what depends on the locale."""

_NONE = frozenset({"", "-", "--", "1", "none", "dimensionless", "n/n", "unitless", "ohne", "*", "/"})
UNIT_WORDS = frozenset(
    [spelling.casefold() for table in units.UNITS.values() for spelling in table]
    + [word for table in ALIASES.values() for group in table.values() for word in group.split("; ")]
    + [*_WORDS["torques"], *_WORDS["other_units"], *_WORDS["counts"], *_NONE]
    + ["gf", "kgf", "n.a.", "n m", "n mm", "n\u00b7m", "n\u00b7mm", "\u00b5m", "\u03bcm"]
)
"""What may be in a row of units, in small letters."""

_CAMEL = re.compile(r"(?<=[a-z]{3})(?=[A-Z][a-z])")  # where two words of a name meet without a blank
_UNIT_AT_END = (
    r"(.+)_([^_\s]+)",
    r"(.+?)\s*/\s*(\S+)",
    r"(.+?),\s*(\S.*)",
    r"(.+)\s+in\s+(\S+)",
    r"(.+)\s+(\S+)",
)


class Scale(NamedTuple):
    """From the unit of a column to SI: value times `factor`, plus `offset`."""

    factor: float = 1.0
    offset: float = 0.0


def plain(name: str) -> str:
    """A name for comparison: small letters, no accents or signs, "mu" for the Greek letter.

    Examples
    --------
    >>> plain("FrictionForce"), plain("CoF"), plain("\u00b5 [-]")
    ('friction force', 'cof', 'mu')
    """
    whole = re.sub(r"\u00c2\u00b5|\u00ce\u00bc|[\u00b5\u03bc\u039c]", "mu", _CAMEL.sub(" ", name))
    folded = unicodedata.normalize("NFKD", whole.casefold())
    letters = "".join(c for c in folded if not unicodedata.combining(c)).replace("\u00df", "ss")
    return " ".join(re.sub(r"[^0-9a-z%#]+", " ", letters).split())


def scale_of(unit: str, meaning: str) -> Scale | None:
    """How to bring a column of that meaning to SI; None where the unit is not one of its quantity."""
    spelling = unit.strip()
    if meaning in SHAPES or (meaning == "time" and time_form(spelling)):
        return Scale()
    if MEANINGS[meaning] != "-":
        return scale_in(spelling, MEANINGS[meaning])
    if meaning == "friction" and spelling == "%":
        return Scale(0.01)
    is_symbol = meaning == "friction" and plain(spelling) in SYMBOLS["friction"]
    known = _NONE | _WORDS["counts"] if meaning == "cycles" else _NONE
    return Scale() if is_symbol or spelling.casefold() in known else None


@cache
def scale_in(unit: str, si: str) -> Scale | None:
    """How to bring a value in that unit to the SI unit; None where the unit is not one of its quantity."""
    text = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u").replace("\u00ba", "\u00b0").rstrip(".")
    text = text.replace("\u00b2", "2").replace("\u207b\u00b9", "-1").replace("\u22c5", " ").strip()
    sizes = {spelling: f"1 {spelling}" for spelling in units.UNITS[si]}
    for one, spellings in ALIASES.get(si, {}).items():
        sizes |= dict.fromkeys(spellings.split("; "), one)
    size = sizes.get(text) or sizes.get(text.casefold())
    if size is None:
        return None
    number, name = size.split(" ", 1)
    if number.startswith("1/"):
        return Scale(1.0 / float(number[2:]))
    offset = units.parse(f"0 {name}", si)
    factor = units.parse(size, si) - offset
    return Scale(round(factor, 12) if si == "K" else factor, offset)


def time_form(unit: str) -> str:
    """How times are written as text: a key of `CLOCKS`, or a format of dates; empty for a usual unit."""
    parts = re.findall("%(.?)", unit)
    if parts and len(set(parts) & DATE_PARTS) == len(parts):
        return unit
    spelling = unit.strip().casefold().partition(".")[0]
    return next((form for form, spellings in CLOCKS.items() if spelling in spellings), "")


def is_torque(unit: str) -> bool:
    """True for a unit of torque: a column of it is not a force."""
    return re.sub(r"[\s.*\u00b7\u22c5-]+", "", plain(unit)) in _WORDS["torques"]


def known_units(meaning: str) -> str:
    """Some units of a meaning, for a message."""
    if meaning in SHAPES:
        return "mm, deg"
    return units.spellings(MEANINGS[meaning]) if MEANINGS[meaning] != "-" else "-, %"


def header_parts(header: str) -> list[tuple[str, str]]:
    """Every way to read a header as a name and a unit, the likelier first.

    Examples
    --------
    >>> header_parts("Fz [N]")[0], header_parts("Time_s")[1], header_parts("COF")[0]
    (('Fz', 'N'), ('Time', 's'), ('COF', ''))
    """
    text = header.strip().strip('"').strip()
    bracket = re.fullmatch(r"(.*?)\s*[\[(<{]\s*([^\[\](){}<>]*?)\s*[\])>}]\s*", text)
    if bracket:
        return [(bracket[1].strip(), bracket[2])]
    patterns = (re.fullmatch(pattern, text) for pattern in _UNIT_AT_END)
    return [(text, "")] + [(one[1].strip(), one[2].strip()) for one in patterns if one and one[2] != "1"]


def ranks(name: str) -> dict[str, int]:
    """Meanings that a name may have, each with its place in the list of names."""
    words = plain(name)
    found: dict[str, int] = {}
    for meaning, groups in NAMES.items():
        signs = (words.removesuffix(f" {sign}") for sign in SYMBOLS.get(meaning, ()))
        bare = next((rest for rest in signs if rest != words and len(rest) > 1), words)
        rank = next((rank for rank, group in enumerate(groups) if bare in group), None)
        found |= {} if rank is None else {meaning: rank}
    return found


# --- what a name looks like, for a draft ----------------------------------------------------------
def looks_extreme(header: str) -> bool:
    """True for a name of an extreme or a scatter of what it names, and not of its mean."""
    return not _WORDS["extremes"].isdisjoint(plain(header).split())


def looks_like_force(header: str) -> bool:
    """True for a name or a unit of a force: its column is not a coefficient."""
    words = plain(header)
    coefficient = any(part in words for part in ("coef", "cof", "beiwert"))
    units_of_force = any(scale_in(unit, "N") is not None for _, unit in header_parts(header) if unit)
    return not coefficient and (units_of_force or any(part in words for part in _WORDS["forces"]))
