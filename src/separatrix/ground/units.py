"""Units: the types that carry them, and the strict reading of text such as ``"300 daN"``.

A quantity is one ASCII number and one unit from a short table (`UNITS`), nothing else. The number is
converted in exact arithmetic and rounded once, so that the same quantity written in two units is the same
float to the last bit.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Annotated, NamedTuple, get_type_hints

from separatrix.ground.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
else:

    def __getattr__(name: str) -> object:
        """Build `Array` when first asked for, so that reading a study does not import numpy."""
        if name != "Array":
            raise AttributeError(name)
        import numpy as np
        from numpy.typing import NDArray

        globals()["Array"] = NDArray[np.float64]
        return globals()["Array"]


Ratio = Annotated[float, "-"]
Metre = Annotated[float, "m"]
PerSecond = Annotated[float, "1/s"]
PerMetre = Annotated[float, "1/m"]
PerMetre2 = Annotated[float, "1/m2"]
SquareMetre = Annotated[float, "m2"]
Second = Annotated[float, "s"]
Hertz = Annotated[float, "Hz"]
Radian = Annotated[float, "rad"]
RadianPerSecond = Annotated[float, "rad/s"]
MetreRadianPerSecond = Annotated[float, "m rad/s"]
Kilogram = Annotated[float, "kg"]
KilogramMetre = Annotated[float, "kg m"]
KilogramMetre2 = Annotated[float, "kg m2"]
KilogramPerMetre3 = Annotated[float, "kg/m3"]
MetrePerSecond = Annotated[float, "m/s"]
MetrePerSecond2 = Annotated[float, "m/s2"]
Newton = Annotated[float, "N"]
NewtonMetre = Annotated[float, "N m"]
NewtonPerMetre = Annotated[float, "N/m"]
NewtonPerMetre1_5 = Annotated[float, "N/m1.5"]
NewtonSecondPerMetre = Annotated[float, "N s/m"]
Pascal = Annotated[float, "Pa"]
Kelvin = Annotated[float, "K"]
PerKelvin = Annotated[float, "m/m/K"]
Joule = Annotated[float, "J"]
CubicMetre = Annotated[float, "m3"]
SpecificWear = Annotated[float, "m3/(N m)"]
Watt = Annotated[float, "W"]
WattPerKelvin = Annotated[float, "W/K"]
WattPerMetre2 = Annotated[float, "W/m2"]
WattPerMetreKelvin = Annotated[float, "W/(m K)"]
JoulePerKilogramKelvin = Annotated[float, "J/kg/K"]
KilogramPerSecond = Annotated[float, "kg/s"]
PascalSecond = Annotated[float, "Pa s"]


class Rows(NamedTuple):
    """In the type of a field with records: how these become labelled arrays.

    They lie along `dimension`, and `label` is the field that names the places on it; a single record has
    neither. `prefix` goes before the names of their fields. A field with an array has its unit and its axes
    there: ``Annotated[Array, "Pa", ("strip", "node")]``.
    """

    dimension: str = ""
    prefix: str = ""
    label: str = ""


QUANTITIES = {
    "m": "length",
    "s": "time",
    "rad": "angle",
    "rad/s": "rotational speed",
    "Hz": "frequency",
    "kg": "mass",
    "N": "force",
    "m2": "area",
    "N m": "moment",
    "N/m": "stiffness",
    "N s/m": "damping",
    "Pa": "pressure or modulus",
    "kg/m3": "density",
    "m/s": "speed",
    "m/s2": "acceleration",
    "K": "temperature",
    "m/m/K": "thermal expansion",
    "Pa s": "viscosity",
    "J/kg/K": "heat capacity",
    "kg m": "unbalance",
    "kg m2": "moment of inertia",
    "m3": "volume",
    "m3/(N m)": "wear coefficient",
    "W/K": "thermal conductance",
    "W/(m K)": "thermal conductivity",
    "kg/s": "mass flow",
    "J/kg": "latent heat",
}
"""What each SI unit measures, in a user's words."""

UNITS: dict[str, dict[str, str]] = {
    "m": {"m": "1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "nm": "1e-9", "in": "0.0254"},
    "m2": {"m2": "1", "cm2": "1e-4", "mm2": "1e-6"},
    "m3": {"m3": "1", "cm3": "1e-6", "mm3": "1e-9"},
    "m3/(N m)": {"m3/(N m)": "1", "mm3/(N m)": "1e-9", "m2/N": "1"},
    "s": {"s": "1", "ms": "1e-3", "us": "1e-6", "min": "60", "h": "3600"},
    # The scales of angles and rotational speeds are in turns of pi wherever the text ends in "pi".
    "rad": {"rad": "1", "mrad": "1e-3", "deg": "1/180 pi", "°": "1/180 pi", "arcmin": "1/10800 pi"},
    "rad/s": {
        "rad/s": "1",
        "rpm": "1/30 pi",
        "rev/min": "1/30 pi",
        "rev/s": "2 pi",
        "Hz": "2 pi",
        "kHz": "2000 pi",
        "deg/s": "1/180 pi",
    },
    "Hz": {"Hz": "1", "kHz": "1e3"},
    "kg": {"kg": "1", "g": "1e-3", "mg": "1e-6", "t": "1e3", "lb": "0.45359237"},
    "N": {
        "N": "1",
        "mN": "1e-3",
        "daN": "10",
        "kN": "1e3",
        "MN": "1e6",
        "lbf": "4.4482216152605",
        "kgf": "9.80665",
        "uN": "1e-6",
    },
    "N m": {
        "N m": "1",
        "N mm": "1e-3",
        "mN m": "1e-3",
        "kN m": "1e3",
        "daN m": "10",
        "lbf in": "0.1129848290276167",
    },
    "N/m": {
        "mN/m": "1e-3",
        "N/m": "1",
        "N/mm": "1e3",
        "N/um": "1e6",
        "kN/m": "1e3",
        "kN/mm": "1e6",
        "MN/m": "1e6",
        "lbf/in": "44482216152605/254000000000",
    },
    "N s/m": {"N s/m": "1", "N s/mm": "1e3", "kN s/m": "1e3"},
    "Pa": {
        "Pa": "1",
        "kPa": "1e3",
        "MPa": "1e6",
        "GPa": "1e9",
        "N/mm2": "1e6",
        "bar": "1e5",
        "psi": "44482216152605/6451600000",
        "ksi": "44482216152605/6451600",
    },
    "kg/m3": {"kg/m3": "1", "g/cm3": "1e3", "kg/dm3": "1e3"},
    "m/s": {"m/s": "1", "cm/s": "1e-2", "mm/s": "1e-3", "km/h": "5/18"},
    "m/s2": {"m/s2": "1", "mm/s2": "1e-3", "g0": "9.80665"},
    "K": {"K": "1", "degC": "1 + 273.15", "°C": "1 + 273.15", "degF": "5/9 + 459.67"},
    "m/m/K": {"m/m/K": "1", "um/m/K": "1e-6", "ppm/K": "1e-6"},
    "Pa s": {"Pa s": "1", "mPa s": "1e-3", "uPa s": "1e-6"},
    "J/kg/K": {"J/kg/K": "1", "kJ/kg/K": "1e3"},
    "J/kg": {"J/kg": "1", "kJ/kg": "1e3"},
    "W/K": {"W/K": "1", "mW/K": "1e-3"},
    "W/(m K)": {"W/(m K)": "1", "mW/(m K)": "1e-3"},
    "kg/s": {"kg/s": "1", "g/s": "1e-3", "kg/min": "1/60", "kg/h": "1/3600"},
    "kg m": {"kg m": "1", "kg mm": "1e-3", "g m": "1e-3", "g cm": "1e-5", "g mm": "1e-6", "mg mm": "1e-9"},
    "kg m2": {
        "kg m2": "1",
        "kg cm2": "1e-4",
        "kg mm2": "1e-6",
        "g m2": "1e-3",
        "g cm2": "1e-7",
        "g mm2": "1e-9",
    },
}
"""Spelling of each accepted unit and its size, an exact ratio, under the SI unit of its quantity."""

LONGEST = 60
"""Characters a quantity may have."""

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
"""Pattern of a plain number."""

_QUANTITY = re.compile(rf"({NUMBER}) ?([A-Za-z\u00b5\u03bc\u00b0].*)?")
_GROUPS = re.compile(r"(?<![0-9.])[0-9]{1,3}(?:['\u2019][0-9]{3})+(?![0-9'\u2019])")
"""Digits in groups of three, with apostrophes between: 40'000."""

_SPELLINGS = str.maketrans(
    {"\u00b5": "u", "\u03bc": "u", "\u00b2": "2", "\u00b3": "3", "\u00b7": " ", "*": " ", "^": None}
)


def parse(text: str, unit: str, where: str = "The quantity") -> float:
    """Value of `text`, one number and one unit, in the SI unit `unit`.

    Parameters
    ----------
    text : str
        For instance ``"11.1125 mm"``.
    unit : str
        The SI unit wanted, a key of `UNITS`.
    where : str
        Names the quantity in a refusal.

    Raises
    ------
    InputError
        Not one number and one unit, or a unit of something else.

    Examples
    --------
    >>> parse("300 daN", "N")
    3000.0
    >>> parse("77 K", "K"), round(parse("-196.15 degC", "K"), 9)
    (77.0, 77.0)
    """
    if not isinstance(text, str):
        raise missing_unit(text, unit, where)
    stripped = _GROUPS.sub(lambda groups: re.sub("[^0-9]", "", groups[0]), text.strip(" "), count=1)
    match = _QUANTITY.fullmatch(stripped) if len(stripped) <= LONGEST else None
    if match is None:
        raise _refusal(text, unit, where)
    number, spelling = match.groups()
    if spelling is None:
        raise missing_unit(number, unit, where)
    scale = UNITS[unit].get(spelling.translate(_SPELLINGS))
    if scale is None:
        raise _wrong_unit(text, spelling, unit, where)
    return _scaled(number, scale, text, where)


@cache
def _hints(record: type) -> dict[str, object]:
    return get_type_hints(record, include_extras=True)


def unit_of(record: type, field: str) -> str:
    """SI unit in the type of a record's field; ``"-"`` for a ratio, empty for what is not a quantity."""
    hint = str(_hints(record)[field])
    found = re.search(r"Annotated\[float, '([^']+)'\]", hint)
    return found.group(1) if found else ""


def spellings(unit: str) -> str:
    """Four of the accepted units of a quantity, for a message: ``"m, cm, mm, um, ..."``."""
    known = list(UNITS[unit])
    return ", ".join(known[:4]) + (", ..." if len(known) > 4 else "")


def shown(value: object) -> str:
    """Text of a wrong value for a message: one line, quoted if it was text, cut if it is long."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, (list, tuple)):
        return "a list"
    if isinstance(value, int) and abs(value) >= 10**LONGEST:
        return "a whole number of more than 60 digits"
    return f'"{printable(value)}"' if isinstance(value, str) else printable(str(value))


def printable(text: str, longest: int = LONGEST) -> str:
    """The text on one line: control and invisible characters as their codes, cut if it is long."""
    plain = "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text[: longest + 1])
    return plain if len(plain) <= longest else plain[: longest - 3] + "..."


def _scaled(number: str, scale: str, text: str, where: str) -> float:
    factor, _, offset = scale.removesuffix(" pi").partition(" + ")
    exact = (Fraction(number) + Fraction(offset or 0)) * Fraction(factor)
    try:
        value = float(exact) * (math.pi if scale.endswith(" pi") else 1.0)  # rounded once
    except OverflowError:
        value = math.inf
    if math.isinf(value) or (value == 0.0 and exact != 0):
        raise InputError(where, "must be a number that a computer can hold", shown(text))
    return value


def missing_unit(value: object, unit: str, where: str) -> InputError:
    """Refusal of a number without a unit."""
    cure = f'Write "{value if _is_number(value) else "1.5"} {HABITS[unit]}".'
    return InputError(where, f"needs a unit of {QUANTITIES[unit]}", shown(value), cure)


def _is_number(value: object) -> bool:
    if isinstance(value, str):
        return re.fullmatch(r"[-+.0-9eE]+", value) is not None
    return isinstance(value, (int, float)) and not isinstance(value, bool) and -1e300 < value < 1e300


def _refusal(text: str, unit: str, where: str) -> InputError:
    value = shown(text)
    if len(text) > LONGEST:
        return InputError(where, f"must be one number and one unit in at most {LONGEST} characters", value)
    if comma := re.match(r"\s*([+-]?[0-9]+),([0-9]+)(.*)", text):
        whole, part, rest = comma.groups()
        cure = f'Write "{printable(f"{whole}.{part}{rest}")}".'
        if len(part) == 3 and whole.strip("+-0"):  # perhaps thousands
            cure = f'Write "{printable(whole + part + rest)}" or "{printable(f"{whole}.{part}{rest}")}".'
        return InputError(where, "needs a decimal point, not a comma", value, cure)
    if re.match(r"\s*[+-]?(nan|inf)", text, re.IGNORECASE):
        return InputError(where, "must be a finite number with a unit", value)
    rule = f"must be one number and one unit of {QUANTITIES[unit]} ({spellings(unit)})"
    return InputError(where, rule, value, f'Write it like "1.5 {HABITS[unit]}".')


def _wrong_unit(text: str, spelling: str, unit: str, where: str) -> InputError:
    plain = spelling.translate(_SPELLINGS)
    rule = f"needs a unit of {QUANTITIES[unit]} ({spellings(unit)})"
    others = [QUANTITIES[other] for other, known in UNITS.items() if plain in known]
    if others:
        return InputError(where, rule, f"{shown(text)}, which is a {others[0]}")
    from difflib import get_close_matches

    known = {name.casefold(): name for name in UNITS[unit]}
    found = get_close_matches(plain.casefold(), known, 1, 0.5)
    return InputError(where, rule, shown(text), f'Did you mean "{known[found[0]]}"?' if found else "")


HABITS = {unit: unit for unit in QUANTITIES} | {
    "m": "mm",
    "rad": "deg",
    "rad/s": "rpm",
    "kg": "g",
    "Pa": "GPa",
    "m/m/K": "um/m/K",
    "Pa s": "uPa s",
    "kg m": "g mm",
    "kg m2": "kg mm2",
    "m3/(N m)": "mm3/(N m)",
}
"""The unit that an engineer would write."""

_READABLE: dict[str, tuple[tuple[float, str], ...]] = {
    "m": ((1e-9, "nm"), (1e-6, "um"), (1e-3, "mm"), (1.0, "m")),
    "s": ((1e-6, "us"), (1e-3, "ms"), (1.0, "s")),
    "rad": ((math.pi / 180, "deg"),),
    "rad/s": ((math.pi / 30, "rpm"),),
    "m rad/s": ((1e3 * math.pi / 30, "million mm rpm"),),
    "Hz": ((1.0, "Hz"), (1e3, "kHz")),
    "kg": ((1e-6, "mg"), (1e-3, "g"), (1.0, "kg")),
    "N": ((1e-6, "uN"), (1e-3, "mN"), (1.0, "N"), (1e4, "kN")),
    "N m": ((1e-3, "mN m"), (1.0, "N m")),
    "N/m": ((1.0, "N/m"), (1e3, "kN/m"), (1e6, "MN/m")),
    "Pa": ((1.0, "Pa"), (1e3, "kPa"), (1e6, "MPa"), (1e9, "GPa")),
    "m/m/K": ((1e-6, "um/m/K"),),
    "Pa s": ((1e-6, "uPa s"), (1e-3, "mPa s"), (1.0, "Pa s")),
    "kg m": ((1e-6, "g mm"),),
    "kg m2": ((1e-6, "kg mm2"),),
    "J": ((1e-9, "nJ"), (1e-6, "uJ"), (1e-3, "mJ"), (1.0, "J")),
    "W": ((1e-6, "uW"), (1e-3, "mW"), (1.0, "W"), (1e3, "kW")),
    "m3/(N m)": ((1e-9, "mm3/(N m)"),),
    "W/m2": ((1.0, "W/m2"), (1e3, "kW/m2")),
}
_SIZES = {"kN": 1e3}


def format_quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Readable text of an SI value, in the unit an engineer would choose.

    Examples
    --------
    >>> format_quantity(1.23e-5, "m"), format_quantity(1570.7963, "rad/s"), format_quantity(1.5e9, "Pa")
    ('12.3 um', '15000 rpm', '1.5 GPa')
    >>> format_quantity(0.09, "-"), format_quantity(None, "m")
    ('0.09', 'none')
    """
    if value is None:
        return "none"
    if unit == "-":
        return format_number(value, digits)
    size, symbol = readable(abs(value), unit)
    return f"{format_number(value / size, digits)} {symbol}"


def format_number(value: float, digits: int = 4) -> str:
    """A number to some significant digits, without an exponent where that is readable."""
    rounded = float(f"{value:.{digits}g}") + 0.0  # never "-0"
    if rounded == 0.0 or 1e-4 <= abs(rounded) < 1e7:
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded)))) if rounded else 0
        text = f"{rounded:.{decimals}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return f"{rounded:.{digits}g}"


def readable(size: float, unit: str, wanted: str = "") -> tuple[float, str]:
    """Return the unit that suits a number of this size [SI], or the wanted one: its size and its symbol."""
    if wanted:
        return parse(f"1 {wanted}", unit), wanted
    choices = _READABLE.get(unit, ((1.0, unit),))
    if size == 0.0:
        return next((c for c in choices if c[1] == HABITS.get(unit)), choices[0])
    best = choices[0]
    for threshold, symbol in choices:
        if size >= threshold * (1 - 1e-9):
            best = (_SIZES.get(symbol, threshold), symbol)
    return best
