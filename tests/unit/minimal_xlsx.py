"""Workbooks with what openpyxl does not write: saved values of formulas, parts that a test makes wrong."""

import io
import re
import zipfile
from dataclasses import dataclass

import openpyxl
from openpyxl.utils import get_column_letter


@dataclass(frozen=True)
class Formula:
    """A formula with the value saved with it, if there is one."""

    text: str
    value: float | str | None = None


@dataclass(frozen=True)
class Shown:
    """A number in a style: 1 a time of day, 2 a percentage."""

    value: float | None
    style: int


@dataclass(frozen=True)
class Fault:
    """A cell that shows an error."""

    text: str


def parts(sheets: dict[str, list[list[object]]]) -> dict[str, bytes]:
    """Return the parts of a workbook by their names."""
    book, formulas = openpyxl.Workbook(), []
    book.remove(book.active)
    for number, (name, rows) in enumerate(sheets.items(), 1):
        sheet = book.create_sheet(name)
        for r, row in enumerate(rows, 1):
            for c, value in enumerate(row, 1):
                cell = sheet.cell(r, c) if value is not None else None
                if isinstance(value, Shown):
                    cell.value, cell.number_format = value.value, ("", "hh:mm:ss.000", "0%")[value.style]
                elif isinstance(value, Formula):
                    cell.value = 0.0
                    formulas.append((f"xl/worksheets/sheet{number}.xml", f"{get_column_letter(c)}{r}", value))
                elif value is not None:
                    cell.value = value.text if isinstance(value, Fault) else value
                    cell.data_type = "s" if isinstance(value, str) else cell.data_type
    book.save(made := io.BytesIO())
    with zipfile.ZipFile(made) as source:
        found = {name: source.read(name) for name in source.namelist()}
    for part, at, one in formulas:
        kind = ' t="str"' if one.value == "" else ""
        saved = "" if one.value is None else f"<v>{one.value}</v>"
        new = f'<c r="{at}"{kind}><f>{one.text}</f>{saved}</c>'
        found[part] = re.sub(rf'<c r="{at}".*?</c>', new, found[part].decode()).encode()
    return found


def zipped(members: dict[str, str | bytes]) -> bytes:
    """Return a zip file of these members."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as target:
        for name, content in members.items():
            target.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return made.getvalue()


def workbook(sheets: dict[str, list[list[object]]]) -> bytes:
    """Return a workbook."""
    return zipped(parts(sheets))
