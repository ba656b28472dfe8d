"""What a map or a sweep varies: parameters, axes ``PARAM=LOW..HIGH[unit][:N][:log]``, and cases."""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.schema import keys_of
from separatrix.ground.toml import Kind, nearest, path_text, read_text
from separatrix.ground.units import NUMBER, parse, shown
from separatrix.study.keys import SECTIONS, SETTINGS, WHOLE, numbers_of, with_values
from separatrix.study.study import Film, Study, Wear

FEWEST, MOST = 2, 1000  # points of an axis
POINTS = 10  # points of an axis of a sweep, unless it states a number
MOST_CASES = 100_000
TIME_SHARE = "time_share"  # beside the parameters of a case: how long it lasts
DEFAULT_X, DEFAULT_Y = "restitution_factor=0..1", "ball_cage_friction=0..0.5"
HIGHEST = {"restitution_factor": 1.0, "ball_cage_friction": 2.0}
EXAMPLE = 'Write it like "cage.pocket_clearance=0.1..1mm" or "film.thickness=0.05..5um:40:log".'
NOTHING = "Give --vary PARAM=LOW..HIGH, or a table of cases: --cases FILE.csv."
TABLE = Kind(noun="a table of cases", most_bytes=50_000_000, empty="Write parameters in its first row.")

# Values of some numbers of a study, by their names in a study file, in SI units.
Case = Mapping[str, float]
_NUMBER = re.compile(NUMBER)


RESTITUTION, FRICTION, KICK = "restitution_factor", "ball_cage_friction", "kick"
RACE_FRICTION = "film.race_friction"
THICKNESS = "film.thickness"  # of a film; a map may begin at 0, where the races are bare
SHORT = {"cage.ball_cage_friction": FRICTION}  # so that one parameter has one name
LONG = {name: key for key, name in SHORT.items()}
_OF_FILM = ("film.elastic_modulus", "film.poisson_ratio")


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that a map varies: its name in a study file, and the SI unit it is written in."""

    name: str  # as in a study file
    unit: str  # in which values are written, SI

    @property
    def is_whole(self) -> bool:
        """Whether it takes whole numbers only."""
        return self.unit == WHOLE


NOT_OF_A_VERDICT = ("wear.", "cooling.")
"""Sections of slow time and of heat: no case of a map or sweep depends on them."""


def parameters() -> dict[str, Parameter]:
    """Every parameter a map can vary, by name."""
    names = {RESTITUTION: "-", FRICTION: "-", KICK: "m/s"}
    for section, record in SECTIONS.items():
        names |= {f"{section}.{key}": unit for key, unit in numbers_of(record).items()}
    names |= {f"film.wear.{key}": unit for key, unit in numbers_of(Wear).items()}
    left = {
        name: unit
        for name, unit in names.items()
        if name not in (*SETTINGS, *SHORT) and not name.startswith(NOT_OF_A_VERDICT)
    }
    return {name: Parameter(name, unit) for name, unit in left.items()}


def varied(study: Study, values: Mapping[str, float]) -> Study:
    """Return the study with other values of some parameters, all at once; `InputError` if it is refused.

    Restitution factor and kick are not keys of a study; the map gives them to the cage and to its runs. A
    film of zero thickness is bare races.
    """
    keys = {LONG.get(name, name): value for name, value in values.items() if name not in (RESTITUTION, KICK)}
    for key in keys:
        section = key.partition(".")[0]
        if key in _OF_FILM and study.film.body is None:
            raise InputError("[film]", "has no material whose properties could vary")
        if key.startswith("film.wear.") and study.film.wear is None:
            raise InputError("[film]", "has no wear that could vary")
        if getattr(study, section, study) is None:
            raise InputError(f"[{section}]", "is missing")
    if keys.get(THICKNESS) == 0.0:
        keys = {
            key: value for key, value in keys.items() if not key.startswith("film.") or key == RACE_FRICTION
        }
        study = replace(study, film=Film(race_friction=study.film.race_friction))
    return with_values(study, keys) if keys else study


def value_in(study: Study, name: str) -> float | None:
    """Value of a key in the study; None where it has none, or is not one of its keys."""
    value: object = study
    for step in name.split("."):
        value = getattr(value, step, None)
    return value if isinstance(value, int | float) else None


@dataclass(frozen=True, slots=True, kw_only=True)
class MapAxis:
    """One parameter of a map: its name and SI unit, its rising values, and its value in the study."""

    parameter: str  # its name in a study file
    unit: str  # of the values, SI
    values: tuple[float, ...]  # rising
    here: float | None = None  # its value in the study; null if there is none


def read_axis(text: str, option: str, points: int) -> MapAxis:
    """Axis of a map from its text, for instance ``cage.pocket_clearance=0.1..1mm:50:log``.

    That is a parameter, its lowest and highest value with their unit, how many values (`points` if not
    stated), and whether they are spaced by equal ratios. `option` names the text in a refusal.

    Raises
    ------
    InputError
        Not such a text, no such parameter, or no rising range in its unit.
    """
    name, found, rest = text.partition("=")
    if not found:
        raise InputError(option, "needs a parameter, = and a range", got=shown(text), cure=EXAMPLE)
    parameter = find_parameter(name.strip(), option)
    span, *extras = rest.split(":")
    where = f"{option} {parameter.name}"
    is_log = extras[-1:] == ["log"]
    counts = extras[: len(extras) - is_log]
    if len(counts) > 1 or not all(re.fullmatch("[0-9]{1,6}", count) for count in counts):
        rule = "takes after its range at most a number of points and log"
        raise InputError(where, rule, got=shown(":" + ":".join(extras)), cure=EXAMPLE)
    count = checked_points(int(counts[0]) if counts else points, where)
    low, high = _range(span, parameter, where)
    values = _whole(low, high, count, where) if parameter.is_whole else _spaced(low, high, count)
    if is_log:
        if parameter.is_whole:
            raise InputError(where, "takes whole numbers, which have no log spacing")
        if low <= 0.0:
            raise InputError(where, "must be > 0 for log spacing", got=f"{low:g}")
        values = _spaced(low, high, count, is_log=True)
    return MapAxis(parameter=parameter.name, unit=parameter.unit or "-", values=values)


def find_parameter(name: str, option: str) -> Parameter:
    """Parameter of a name; `InputError` with the nearest one if there is none or it is not a number."""
    known = parameters()
    name = SHORT.get(name, name)
    if name in known:
        return known[name]
    section, _, key = name.partition(".")
    if section in SECTIONS and key in keys_of(SECTIONS[section]):
        raise InputError(f"{option} {name}", "is not a number that a map can vary")
    ends = [full for full in known if full.endswith(f".{name}")]
    cure = f"Did you mean {ends[0]}?" if ends else nearest(name, known)
    raise InputError(option, "names no parameter of a study", got=shown(name), cure=cure)


def checked_points(count: int, where: str) -> int:
    """Return the number of points of an axis; `InputError` if it is too small or too large."""
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
    highest = HIGHEST.get(parameter.name)
    if highest is not None and not 0.0 <= ends[0] < ends[1] <= highest:
        raise InputError(where, f"must lie between 0 and {highest:g} [-]", shown(text))
    return ends


def plain_number(text: str, where: str) -> float:
    """Value of a number without a unit."""
    if _NUMBER.fullmatch(text) is None:
        cure = "Write a decimal point." if "," in text else ""
        raise InputError(where, "takes plain numbers, without a unit", got=shown(text), cure=cure)
    return float(text)


def _spaced(low: float, high: float, count: int, *, is_log: bool = False) -> tuple[float, ...]:
    """Equal steps or ratios, the ends exact and 12 digits between, so that 0.15 is 0.15."""
    steps = count - 1
    inside = (
        low * (high / low) ** (i / steps) if is_log else (low * (steps - i) + high * i) / steps
        for i in range(1, steps)
    )
    return (low, *(float(f"{value:.12g}") for value in inside), high)


def _whole(low: float, high: float, count: int, where: str) -> tuple[int, ...]:
    """All whole numbers of the range, or as many as wanted."""
    if low != int(low) or high != int(high):
        raise InputError(where, "takes whole numbers", got=f"{low:g}..{high:g}")
    if high - low > 1e6:
        raise InputError(where, "has too wide a range", got=f"{low:g}..{high:g}")
    steps = min(count, int(high - low) + 1) - 1
    return tuple(round(low + (high - low) * i / steps) for i in range(steps + 1))


def asked_cases(vary: Sequence[str], cases: Path | Sequence[Case] | None) -> list[Case]:
    """Every case: those of a table or a list, or all that the ranges make together.

    A range is ``PARAM=LOW..HIGH[unit][:N][:log]``; a list has values by the names of a study file in SI
    units.

    Raises
    ------
    InputError
        Neither or both are given, or one of them is wrong.
    """
    if (cases is None) == (not vary):
        raise InputError("--vary", "and --cases exclude each other" if vary else "is missing", cure=NOTHING)
    if cases is not None:
        return _read_cases(cases) if isinstance(cases, Path) else list(cases)
    axes = [read_axis(text, "--vary", POINTS) for text in vary]
    names = [axis.parameter for axis in axes]
    for name in names:
        if names.count(name) > 1:
            raise InputError("--vary", "must name each parameter once", got=name)
    total = math.prod(len(axis.values) for axis in axes)
    if total > MOST_CASES:
        raise InputError("A sweep", f"must have at most {MOST_CASES} cases", got=str(total))
    values = itertools.product(*(axis.values for axis in axes))
    return [dict(zip(names, case, strict=True)) for case in values]


def _read_cases(path: Path) -> list[Case]:
    """Cases of a table: parameters in its first row, then a case a row, each value with its unit.

    A column `time_share` has shares without a unit, or times. `InputError` has a line for each mistake.
    """
    text = read_text(path, TABLE)
    rows = [row for row in csv.reader(text.splitlines()) if any(cell.strip() for cell in row)]
    where = path_text(path)
    if len(rows) < 2:
        raise InputError(where, "needs a row of parameters and below it a row for each case")
    names = [cell.strip() for cell in rows[0]]
    heads = _heads(names, f"{where} row 1")
    wrong: list[InputError] = []
    cases = [_case(heads, row, f"{where} row {i}", wrong) for i, row in enumerate(rows[1:], start=2)]
    if wrong:
        raise together(wrong)
    if None in heads and len({_is_plain(row[heads.index(None)]) for row in rows[1:]}) > 1:
        raise InputError(f"{where}, {TIME_SHARE}", "must be shares, or times with their unit, not both")
    return cases


def _heads(names: Sequence[str], where: str) -> list[Parameter | None]:
    """Parameter of each column, None for the share of time; `InputError` has a line for each mistake."""
    heads: list[Parameter | None] = []
    wrong: list[InputError] = []
    for name in names:
        with noted(wrong):
            heads.append(None if name == TIME_SHARE else find_parameter(name, where))
    for head in (one for one, count in Counter(heads).items() if count > 1):
        name = TIME_SHARE if head is None else head.name
        wrong.append(InputError(where, "must name each parameter once", got=name))
    if wrong:
        raise together(wrong)
    if heads == [None]:
        raise InputError(where, "needs a parameter beside time_share")
    return heads


def _is_plain(text: str) -> bool:
    return _NUMBER.fullmatch(text.strip()) is not None


def _case(heads: Sequence[Parameter | None], row: Sequence[str], where: str, wrong: list[InputError]) -> Case:
    """Values of one row; each mistake goes into `wrong`."""
    if len(row) != len(heads):
        wrong.append(InputError(where, f"must have {len(heads)} cells", got=str(len(row))))
        return {}
    found = {}
    for head, cell in zip(heads, map(str.strip, row), strict=True):
        name = TIME_SHARE if head is None else head.name
        with noted(wrong):
            found[name] = _value(head, cell, f"{where}, {name}")
    return found


def _value(head: Parameter | None, cell: str, place: str) -> float:
    """Value of a cell; the head of a share of time is None."""
    unit = "s" if head is None else head.unit
    is_plain = _is_plain(cell) if head is None else unit in ("-", "")
    value = plain_number(cell, place) if is_plain else parse(cell, unit, place)
    if head is None and value < 0.0:
        raise InputError(place, "must be >= 0", got=shown(cell))
    if head is not None and head.is_whole and value != int(value):
        raise InputError(place, "takes whole numbers", got=shown(cell))
    return value
