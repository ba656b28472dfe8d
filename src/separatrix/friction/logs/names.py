"""The published table: which names and units of columns mean what, in English, German and French."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from functools import cache

from separatrix.friction.logs.dialect import CLOCK, SHORT_CLOCKS
from separatrix.ground import units
from separatrix.ground.units import Array

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

NAMES: dict[str, tuple[str, ...]] = {
    "friction": (
        "cof; mu; friction coefficient; coefficient of friction; friction coeff; coeff of friction; "
        "coeff friction; fric coeff; friction coef; coef of friction; dynamic friction coefficient; "
        "kinetic friction coefficient; dynamic coefficient of friction; kinetic coefficient of friction; "
        "dynamic cof; kinetic cof; mu k; reibwert; reibungszahl; reibzahl; reibkoeffizient; "
        "reibungskoeffizient; coefficient de frottement; coeff frottement; coef frottement; coeff frott; "
        "coef frott; coeff de frottement; coef de frottement; c o f; mu kin; mu dyn; mu d; traction coeff; "
        "traction coefficient; coefficient of traction; friction",
    ),
    "tangential_force": (
        "ff; ft; friction force; tangential force; frictional force; friction; fric force; f f; f t; "
        "traction force; traction; reibkraft; reibungskraft; tangentialkraft; "
        "force de frottement; force tangentielle; ffriction; "
        "ftangential",
        "fx; lateral force; shear force; drag force",
    ),
    "normal_force": (
        "fn; f n; normal force; normal load; fnormal; normalkraft; force normale; charge normale",
        "load; down force; downforce; applied load; fz; last; anpresskraft; charge",
        "nominal load; nominal normal force; set load; load setpoint; sollkraft; ball load; pin load",
    ),
    "time": (
        "time; zeit; temps; t",
        "elapsed time; elapsed; test time; sliding time; total time; run time; running time; messzeit; "
        "prufzeit; laufzeit; versuchszeit; duree; temps ecoule; temps de test; timestamp; time stamp; "
        "time of the waveform; step time; time elapsed; relative time; test duration; uhrzeit; clock; "
        "clock time; date time; datetime; date and time; zeitstempel; heure; horodatage",
    ),
    "distance": (
        "distance; sliding distance; sliding dist; dist; track distance; gleitweg; weg; reibweg; "
        "distance de glissement; distance parcourue; total distance",
    ),
    "cycles": (
        "cycles; cycle; laps; lap; cycle count; cycle number; cycle no; number of cycles; no of cycles; "
        "total cycles; lap number; number of laps; revolutions; revolution; number of revolutions; revs; "
        "total revolutions; total laps; total turns; "
        "turns; number of turns; umdrehungen; anzahl umdrehungen; zyklen; zyklus; zyklenzahl; zyklusnummer; "
        "anzahl zyklen; runden; rundenzahl; lastwechsel; tours; nombre de cycles; nombre de tours; strokes; "
        "hube",
    ),
    "temperature": (
        "temperature; temp; temperatur; t; sample temperature; specimen temperature; probentemperatur; "
        "temperature echantillon",
    ),
    "wear_depth": (
        "penetration depth; wear depth; depth; z depth; linear wear; wear; verschleiss; verschleisstiefe; "
        "usure; profondeur d usure; profondeur de penetration; eindringtiefe",
    ),
    "slip_speed": (
        "sliding speed; slip speed; sliding velocity; linear speed; lin speed; gleitgeschwindigkeit; "
        "vitesse de glissement; vitesse lineaire",
        "speed; velocity; geschwindigkeit; vitesse; max linear speed; max lin speed; linear velocity; "
        "surface speed; surface velocity; lin velocity; disc speed; disk speed",
    ),
    "rotational_speed": (
        "rotational speed; rotation speed; spindle speed; rotary velocity; rpm; drehzahl; "
        "rotational velocity; angular velocity; angular speed; vitesse de rotation",
        "speed; velocity; geschwindigkeit; vitesse; disc speed; disk speed",
    ),
}
"""Names of each meaning; a name in an earlier entry is preferred to one in a later."""

ALIASES: dict[str, dict[str, str]] = {
    "s": {
        "1 s": "sec; secs; second; seconds; sek; sekunden; seconde; secondes",
        "1 ms": "msec; millisecond; milliseconds",
        "1 min": "mins; minute; minutes; minuten",
        "1 h": "hr; hrs; hour; hours; std; stunden; heure; heures",
    },
    "m": {
        "1 m": "meter; meters; metre; metres",
        "1000 m": "km",
        "1 mm": "millimeter; millimetre",
        "1 um": "micron; microns; micrometer; mum",
    },
    "N": {"1 N": "newton; newtons", "10 mN": "cN", "0.001 kgf": "gf", "1 kgf": "kgf; kp", "1e-6 N": "uN"},
    "K": {"1 K": "kelvin", "1 degC": "c; deg c; degc; celsius; grad c"},
    "m/s": {"1 m/s": "m/sec; m s-1", "1 mm/s": "mm/sec; mm s-1", "1 cm/s": "cm/sec", "1/60 m/s": "m/min"},
    "rad/s": {
        "1 rpm": "u/min; 1/min; min-1; min^-1; tr/min; r/min; rev/min; upm",
        "1 rev/s": "1/s; rps; u/s",
        "1 rad/s": "rad/sec",
    },
    "-": {},
}
"""Spellings in logs beyond those of study files, and the size of each."""

SYMBOLS = {
    "friction": ("mu",),
    "tangential_force": ("ff", "f f", "ft", "f t", "fr", "f r"),
    "normal_force": ("fn", "f n"),
    "time": ("t",),
    "distance": ("s", "l"),
    "slip_speed": ("v",),
}
"""Signs that may follow a name of their meaning: ``Reibkraft FR``, ``Reibwert µ``."""

TORQUES = {"Nm": 1.0, "mNm": 1e-3, "uNm": 1e-6, "kNm": 1e3, "Ncm": 1e-2, "Nmm": 1e-3, "mNmm": 1e-6}
"""Units of torque without the signs between their parts, and their size in N m."""

MASSES = {"g": "gf", "kg": "kgf"}
"""Units of mass in which programs write forces, and the force that each means."""

CLOCKS = frozenset({CLOCK, *SHORT_CLOCKS, "hh:mm:ss", "h:mm:ss", "h:m:s", "hms"})
"""Units of a column of times as text, which the reader converts to seconds."""

MANGLED = frozenset({"?", "??", "\ufffd", "\ufffd\ufffd"})
"""What a Greek letter becomes where a program could not write it; as a name most likely that of friction."""

FORCES = ("force", "kraft", "load", "newton", "torque", "moment")
"""Parts of names of what is not a ratio of forces."""

NONE = frozenset({"", "-", "--", "1", "none", "dimensionless", "n/n", "unitless", "ohne", "*", "/"})
_COUNTS = frozenset(
    {"cycle", "cycles", "lap", "laps", "rev", "revs", "revolution", "revolutions", "turn", "turns"}
    | {"u", "umdr", "tr", "tours", "#", "n", "count"}
)


_CAMEL = re.compile(r"(?<=[a-z]{3})(?=[A-Z][a-z])")  # where two words of a name meet without a blank
_UNIT_AT_END = (
    r"(.+)_([^_\s]+)",
    r"(.+?)\s*/\s*(\S+)",
    r"(.+?),\s*(\S.*)",
    r"(.+)\s+in\s+(\S+)",
    r"(.+)\s+(\S+)",
)


@dataclass(frozen=True, slots=True)
class Scale:
    """From the unit of a column to SI: value times `factor`, or over `divisor`, plus `offset`."""

    factor: float = 1.0
    divisor: float = 1.0
    offset: float = 0.0

    def of(self, column: Array) -> Array:
        """A column in SI units; what is in them already stays as it is, to the last bit."""
        if self.factor != 1.0:
            column = column * self.factor
        if self.divisor != 1.0:
            column = column / self.divisor
        return column + self.offset if self.offset != 0.0 else column


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
    si, spelling = MEANINGS[meaning], unit.strip()
    if meaning == "time" and spelling.casefold().partition(".")[0] in CLOCKS:
        return Scale()
    if si == "-":
        if meaning == "friction" and spelling == "%":
            return Scale(divisor=100.0)
        if meaning == "friction" and (plain(spelling) in SYMBOLS["friction"] or spelling in MANGLED):
            return Scale()
        fits = spelling.casefold() in NONE or (meaning == "cycles" and spelling.casefold() in _COUNTS)
        return Scale() if fits else None
    return scale_in(spelling, si)


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
        return Scale(divisor=float(number[2:]))
    offset = units.parse(f"0 {name}", si)
    factor = units.parse(size, si) - offset
    if si == "K":
        factor = round(factor, 12)
    inverse = round(1.0 / factor)
    if factor < 1.0 and abs(inverse * factor - 1.0) < 1e-12:
        return Scale(divisor=float(inverse), offset=offset)
    return Scale(factor=factor, offset=offset)


def torque_scale(unit: str) -> Scale | None:
    """How to bring a torque in that unit to N m; None where the unit is not one of torque."""
    text = re.sub(r"[\s.*\u00b7\u22c5-]+", "", unit.replace("\u00b5", "u").replace("\u03bc", "u"))
    size = TORQUES.get(text)
    return None if size is None else Scale(factor=size)


def looks_like_torque(header: str, unit: str = "") -> bool:
    """True for a column of torque, by its unit or by its name."""
    written = (unit, *(part for _, part in header_parts(header)))
    named = any(word == "couple" or word.endswith(("torque", "moment")) for word in plain(header).split())
    force = any(scale_in(one, "N") is not None for one in written if one)
    return any(torque_scale(one) is not None for one in written) or (named and not force)


def known_units(meaning: str) -> str:
    """Some units of a meaning, for a message."""
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
    ways = [(text, "")]
    patterns = (re.fullmatch(pattern, text) for pattern in _UNIT_AT_END)
    ways += [(found[1].strip(), found[2].strip()) for found in patterns if found and found[2] != "1"]
    return ways


def ranks(name: str) -> dict[str, int]:
    """Meanings that a name may have, each with its place in the list of names."""
    words = plain(name)
    found = {}
    for meaning, groups in NAMES.items():
        signs = (words.removesuffix(f" {sign}") for sign in SYMBOLS.get(meaning, ()))
        bare = next((rest for rest in signs if rest != words and len(rest) > 1), words)
        rank = next((rank for rank, group in enumerate(groups) if bare in group.split("; ")), None)
        if rank is not None:
            found[meaning] = rank
    return found


def looks_like_friction(header: str) -> bool:
    """True for a name that may be that of a coefficient of friction, for messages only; never for a force."""
    words = plain(header)
    parts = ("cof", "coef", "fric", "reib", "frott", "traction")
    named = any(part in words for part in parts) or "mu" in words.split()
    return (named or header.strip() in MANGLED) and not looks_like_force(header)


def looks_extreme(header: str) -> bool:
    """True for a name of an extreme or a scatter of what it names, and not of its mean."""
    words = set(plain(header).split())
    return bool(
        words & {"max", "min", "maximum", "minimum", "peak", "static", "std", "dev", "sd", "stdev", "error"}
    )


def looks_like_force(header: str) -> bool:
    """True for a name or a unit of a force: its column is not a coefficient."""
    words = plain(header)
    coefficient = any(part in words for part in ("coef", "cof", "beiwert"))
    units_of_force = any(scale_in(unit, "N") is not None for _, unit in header_parts(header) if unit)
    return not coefficient and (units_of_force or any(part in words for part in FORCES))
