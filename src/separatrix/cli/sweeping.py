"""The verb `sweep`: its options, its table of cases, and its answer as a table."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.cli.axes import find_parameter, plain_number, read_axis
from separatrix.errors import InputError, together
from separatrix.toml_text import Kind, path_text, read_text
from separatrix.units import parse, shown

if TYPE_CHECKING:
    import xarray as xr

    from separatrix.explore.sweep import Case, Sweep
    from separatrix.runner import Runner
    from separatrix.stability.map_parameters import Parameter
    from separatrix.study import Study

POINTS = 10
"""Values of an axis, unless it states a number."""

TABLE = Kind(noun="a table of cases", most_bytes=50_000_000, empty="Write parameters in its first row.")

NOTHING = "Give --vary PARAM=LOW..HIGH, or a table of cases: --cases FILE.csv."


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepOptions:
    """What follows `sweep STUDY`, as text."""

    vary: tuple[str, ...] = ()
    cases: Path | None = None
    verdicts: bool = False

    def compute(self, study: Study, runner: Runner) -> Sweep:
        """Answer the verb.

        Raises
        ------
        InputError
            An option or the table of cases is wrong.
        """
        from separatrix.explore.sweep import sweep

        return sweep(study, self.asked(), verdicts=self.verdicts, runner=runner)

    def asked(self) -> list[Case]:
        """Return every case: the rows of the table, or all that the ranges give together.

        Raises
        ------
        InputError
            Neither or both are given, or one of them is wrong.
        """
        from separatrix.explore.sweep import MOST_CASES

        if (self.cases is None) == (not self.vary):
            rule = "and --cases exclude each other" if self.vary else "is missing"
            raise InputError("--vary", rule, cure=NOTHING)
        if self.cases is not None:
            return read_cases(self.cases)
        axes = [read_axis(text, "--vary", POINTS) for text in self.vary]
        names = [axis.parameter for axis in axes]
        for name in names:
            if names.count(name) > 1:
                raise InputError("--vary", "must name each parameter once", got=name)
        cases = math.prod(len(axis.values) for axis in axes)
        if cases > MOST_CASES:
            raise InputError("A sweep", f"must have at most {MOST_CASES} cases", got=str(cases))
        values = itertools.product(*(axis.values for axis in axes))
        return [dict(zip(names, case, strict=True)) for case in values]


def read_cases(path: Path) -> list[Case]:
    """Cases of a table: parameters in its first row, then a case a row, each value with its unit.

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
    heads = [find_parameter(cell.strip(), f"{where} row 1") for cell in rows[0]]
    cases, wrong = [], []
    for number, row in enumerate(rows[1:], start=2):
        try:
            cases.append(_case(heads, row, f"{where} row {number}"))
        except InputError as error:
            wrong.append(error)
    if wrong:
        raise together(wrong)
    return cases


def _case(heads: Sequence[Parameter], row: Sequence[str], where: str) -> Case:
    """Values of one row."""
    if len(row) != len(heads):
        raise InputError(where, f"must have {len(heads)} cells", got=str(len(row)))
    cells = zip(heads, row, strict=True)
    return {head.name: _value(head, cell.strip(), f"{where}, {head.name}") for head, cell in cells}


def _value(parameter: Parameter, text: str, where: str) -> float:
    if parameter.unit not in ("-", ""):
        return parse(text, parameter.unit, where)
    value = plain_number(text, where)
    if parameter.is_whole and value != int(value):
        raise InputError(where, "takes whole numbers", got=shown(text))
    return value


def write_tables(data: xr.Dataset, folder: Path, *, quiet: bool) -> None:  # noqa: ARG001
    """Write the table of a sweep for spreadsheets and other programs: sweep.csv and sweep.xlsx."""
    from separatrix.spreadsheet.writing import (
        add_sheet,
        headings,
        new_workbook,
        put,
        text_for_cell,
        workbook_bytes,
    )

    names = [str(name) for name in data.variables if data[name].dims == ("case",)]
    heads = [f"{name} [{unit}]" if (unit := data[name].attrs.get("units")) else name for name in names]
    rows = [
        [_cell(v) for v in row] for row in zip(*(data[name].values.tolist() for name in names), strict=True)
    ]
    with (folder / "sweep.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(heads)
        writer.writerows([text_for_cell(v) if isinstance(v, str) else v for v in row] for row in rows)
    book = new_workbook()
    sheet = add_sheet(book, "Sweep")
    headings(sheet, heads, keep_columns=1)
    for place, row in enumerate(rows, start=2):
        for column, value in enumerate(row, start=1):
            put(sheet, place, column, value)
    (folder / "sweep.xlsx").write_bytes(workbook_bytes(book))


def _cell(value: Any) -> Any:
    """Number or text; None where nothing is known."""
    return None if value == "" or (isinstance(value, float) and math.isnan(value)) else value
