"""Cases of a sweep: rows of a table, or all that ranges of parameters make together."""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections.abc import Sequence
from pathlib import Path

from separatrix.errors import InputError, together
from separatrix.explore.axes import find_parameter, plain_number, read_axis
from separatrix.explore.envelope import TIME_SHARE
from separatrix.explore.sweep import MOST_CASES, Case
from separatrix.limits.map_parameters import Parameter
from separatrix.toml_files import Kind, path_text, read_text
from separatrix.units import NUMBER, parse, shown

POINTS = 10
"""Values of an axis, unless it states a number."""

TABLE = Kind(noun="a table of cases", most_bytes=50_000_000, empty="Write parameters in its first row.")

NOTHING = "Give --vary PARAM=LOW..HIGH, or a table of cases: --cases FILE.csv."


def asked_cases(vary: Sequence[str], cases: Path | Sequence[Case] | None) -> list[Case]:
    """Every case: those of a table or a list, or all that the ranges make together.

    Parameters
    ----------
    vary : sequence of str
        Ranges, each ``PARAM=LOW..HIGH[unit][:N][:log]``.
    cases : Path, or sequence of mapping, or None
        A CSV file, or values by the names of a study file in SI units.

    Raises
    ------
    InputError
        Neither or both are given, or one of them is wrong.
    """
    if (cases is None) == (not vary):
        raise InputError("--vary", "and --cases exclude each other" if vary else "is missing", cure=NOTHING)
    if cases is not None:
        return read_cases(cases) if isinstance(cases, Path) else list(cases)
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


def read_cases(path: Path) -> list[Case]:
    """Cases of a table: parameters in its first row, then a case a row, each value with its unit.

    A column `time_share` has shares without a unit, or times.

    Raises
    ------
    InputError
        It cannot be read, or is not such a table: a line for each mistake.
    """
    text = read_text(path, TABLE)
    rows = [row for row in csv.reader(text.splitlines()) if any(cell.strip() for cell in row)]
    where = path_text(path)
    if len(rows) < 2:
        raise InputError(where, "needs a row of parameters and below it a row for each case")
    heads = [_head(cell.strip(), f"{where} row 1") for cell in rows[0]]
    if [head.name for head in heads] == [TIME_SHARE]:
        raise InputError(f"{where} row 1", "needs a parameter beside time_share")
    cases, wrong = [], []
    for number, row in enumerate(rows[1:], start=2):
        try:
            cases.append(_case(heads, row, f"{where} row {number}"))
        except InputError as error:
            wrong.append(error)
    if wrong:
        raise together(wrong)
    column = [head.name for head in heads].index(TIME_SHARE) if TIME_SHARE in cases[0] else None
    if column is not None and len({_is_plain(row[column]) for row in rows[1:]}) > 1:
        raise InputError(f"{where}, {TIME_SHARE}", "must be shares, or times with their unit, not both")
    return cases


def _head(name: str, where: str) -> Parameter:
    return Parameter(TIME_SHARE, "-") if name == TIME_SHARE else find_parameter(name, where)


def _is_plain(text: str) -> bool:
    return re.fullmatch(NUMBER, text.strip()) is not None


def _case(heads: Sequence[Parameter], row: Sequence[str], where: str) -> Case:
    """Values of one row."""
    if len(row) != len(heads):
        raise InputError(where, f"must have {len(heads)} cells", got=str(len(row)))
    cells = zip(heads, row, strict=True)
    return {head.name: _value(head, cell.strip(), f"{where}, {head.name}") for head, cell in cells}


def _value(parameter: Parameter, text: str, where: str) -> float:
    if parameter.name == TIME_SHARE:
        value = plain_number(text, where) if _is_plain(text) else parse(text, "s", where)
        if value < 0.0:
            raise InputError(where, "must be >= 0", got=shown(text))
        return value
    if parameter.unit not in ("-", ""):
        return parse(text, parameter.unit, where)
    value = plain_number(text, where)
    if parameter.is_whole and value != int(value):
        raise InputError(where, "takes whole numbers", got=shown(text))
    return value
