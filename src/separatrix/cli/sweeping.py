"""The answer of the verb `sweep` as a table for spreadsheets and other programs."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr


def write_tables(data: xr.Dataset, folder: Path, *, quiet: bool) -> None:  # noqa: ARG001
    """Write the table of a sweep for spreadsheets and other programs: sweep.csv and sweep.xlsx."""
    from separatrix.workbook_looks import (
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
