"""The axes of a map or a sweep on the command line: ``PARAM=LOW..HIGH[unit][:N][:log]``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from separatrix.errors import InputError
from separatrix.units import parse, shown

if TYPE_CHECKING:
    from separatrix.limits.map_parameters import Parameter
    from separatrix.limits.map_records import MapAxis

FEWEST, MOST = 2, 1000
"""Points of an axis."""

EXAMPLE = 'Write it like "cage.pocket_clearance=0.1..1mm" or "film.thickness=0.05..5um:40:log".'
DEFAULT_X, DEFAULT_Y = "restitution_factor=0..1", "ball_cage_friction=0..0.5"

HIGHEST = {"restitution_factor": 1.0, "ball_cage_friction": 2.0}

_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_COUNT = re.compile(r"[0-9]{1,6}")


def read_axis(text: str, option: str, points: int) -> MapAxis:
    """Axis of a map from its text.

    Parameters
    ----------
    text : str
        For instance ``cage.pocket_clearance=0.1..1mm:50:log``: a parameter, its lowest and highest value with
        their unit, how many values, and whether they are spaced by equal ratios.
    option : str
        Names the text in a refusal.
    points : int
        How many values where the text does not say.

    Raises
    ------
    InputError
        Not such a text, no such parameter, or no rising range in its unit.
    """
    from separatrix.limits.map_records import MapAxis

    name, found, rest = text.partition("=")
    if not found:
        raise InputError(option, "needs a parameter, = and a range", got=shown(text), cure=EXAMPLE)
    parameter = find_parameter(name.strip(), option)
    span, *extras = rest.split(":")
    where = f"{option} {parameter.name}"
    count, is_log = _extras(extras, where, points)
    low, high = _range(span, parameter, where)
    values = _whole(low, high, count, where) if parameter.is_whole else _spaced(low, high, count)
    if is_log:
        values = _by_ratio(low, high, count, parameter, where)
    return MapAxis(parameter=parameter.name, unit=parameter.unit or "-", values=values)


def find_parameter(name: str, option: str) -> Parameter:
    """Parameter of a name, or a refusal with the nearest one.

    Raises
    ------
    InputError
        There is none, or it is no number.
    """
    from separatrix.limits.map_parameters import SHORT, other_keys, parameters
    from separatrix.toml_files import nearest

    known = parameters()
    name = SHORT.get(name, name)
    if name in known:
        return known[name]
    if name in other_keys():
        raise InputError(f"{option} {name}", "is no number that a map can vary")
    ends = [full for full in known if full.endswith(f".{name}")]
    cure = f"Did you mean {ends[0]}?" if ends else nearest(name, known)
    raise InputError(option, "names no parameter of a study", got=shown(name), cure=cure)


def _extras(extras: list[str], where: str, points: int) -> tuple[int, bool]:
    """Number of values, and whether they are spaced by ratios."""
    is_log = extras[-1:] == ["log"]
    counts = extras[: len(extras) - is_log]
    if len(counts) > 1 or not all(_COUNT.fullmatch(count) for count in counts):
        rule = "takes after its range at most a number of points and log"
        raise InputError(where, rule, got=shown(":" + ":".join(extras)), cure=EXAMPLE)
    return checked_points(int(counts[0]) if counts else points, where), is_log


def checked_points(count: int, where: str) -> int:
    """Return the number of points of an axis.

    Raises
    ------
    InputError
        It is too small or too large.
    """
    if not FEWEST <= count <= MOST:
        raise InputError(where, f"must have between {FEWEST} and {MOST} points", got=str(count))
    return count


def _range(text: str, parameter: Parameter, where: str) -> tuple[float, float]:
    """Lowest and highest value; the unit of the highest holds for both, unless the lowest has its own."""
    low, found, high = (part.strip() for part in text.partition(".."))
    if not found or not low or not high or high.startswith("."):
        raise InputError(where, "needs a range LOW..HIGH", got=shown(text), cure=EXAMPLE)
    if parameter.unit in ("-", ""):
        ends = plain_number(low, where), plain_number(high, where)
    else:
        unit = _NUMBER.sub("", high, count=1).strip()
        own = f"{low} {unit}" if _NUMBER.fullmatch(low) else low
        top = parse(high, parameter.unit, where)
        ends = parse(own, parameter.unit, where), top
    if not ends[0] < ends[1]:
        raise InputError(where, "must rise from LOW to HIGH", got=shown(text))
    _refuse_no_share(parameter, ends, text, where)
    return ends


def _refuse_no_share(parameter: Parameter, ends: tuple[float, float], text: str, where: str) -> None:
    top = HIGHEST.get(parameter.name)
    if top is not None and not 0.0 <= ends[0] < ends[1] <= top:
        raise InputError(where, f"must lie between 0 and {top:g} [-]", shown(text))


def plain_number(text: str, where: str) -> float:
    """Value of a plain number, without a unit.

    Raises
    ------
    InputError
        It is none.
    """
    if _NUMBER.fullmatch(text) is None:
        cure = "Write a decimal point." if "," in text else ""
        raise InputError(where, "takes plain numbers, without a unit", got=shown(text), cure=cure)
    return float(text)


def _spaced(low: float, high: float, count: int) -> tuple[float, ...]:
    """Equal steps, the ends exact and 12 digits between, so that 0.15 is 0.15."""
    steps = count - 1
    inside = (float(f"{(low * (steps - i) + high * i) / steps:.12g}") for i in range(1, steps))
    return (low, *inside, high)


def _by_ratio(low: float, high: float, count: int, parameter: Parameter, where: str) -> tuple[float, ...]:
    """Equal ratios, the ends exact."""
    if parameter.is_whole:
        raise InputError(where, "takes whole numbers, which have no log spacing")
    if low <= 0.0:
        raise InputError(where, "must be > 0 for log spacing", got=f"{low:g}")
    steps = count - 1
    inside = (float(f"{low * (high / low) ** (i / steps):.12g}") for i in range(1, steps))
    return (low, *inside, high)


def _whole(low: float, high: float, count: int, where: str) -> tuple[int, ...]:
    """Whole numbers only: all of the range, or as many as asked for."""
    if low != int(low) or high != int(high):
        raise InputError(where, "takes whole numbers", got=f"{low:g}..{high:g}")
    if high - low > 1e6:
        raise InputError(where, "has too wide a range", got=f"{low:g}..{high:g}")
    steps = min(count, int(high - low) + 1) - 1
    return tuple(round(low + (high - low) * i / steps) for i in range(steps + 1))
