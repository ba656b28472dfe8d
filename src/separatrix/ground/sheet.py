"""Workbook files: judged before anything in them is expanded, written with the same bytes each time.

A workbook is a zip container, and a small one may declare, or hide, a huge content. Numbers are written as
numbers, text never as a formula.
"""

from __future__ import annotations

import io
import math
import re
import struct
import traceback
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.units import printable

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

Made = TypeVar("Made")

MOST_BYTES = 512 * 1024**2
"""Expanded size of the whole workbook."""

MOST_RATIO = 100
"""Expanded size of the whole over its size on disk."""

SAVE_AGAIN = "Open it in a spreadsheet program and save it again as .xlsx, without a password."
DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, SyntaxError, OSError, EOFError),
    *(zipfile.BadZipFile, zlib.error, NotImplementedError, RecursionError, AssertionError),
)
"""What openpyxl raises for a workbook that is damaged or makes no sense."""


def refuse_unsafe(path: Path, label: str) -> None:
    """Refuse a file that is not a whole and open zip file, or that declares too large a content.

    Each part is expanded once, in pieces, up to the length that is declared; one that is longer, or other
    than its checksum, is damaged. `label` names the file in messages.
    """
    size = size_of(path, label)
    try:
        with zipfile.ZipFile(path) as container:
            total = sum(part.file_size for part in container.infolist())
            if total > MOST_BYTES:
                rule = f"must expand to at most {MOST_BYTES // 1024**2} MB"
                raise InputError(label, rule, f"{total / 1024**2:.0f} MB")
            if total > MOST_RATIO * max(size, 1):
                rule = f"must expand by at most {MOST_RATIO}:1"
                raise InputError(label, rule, f"{total / max(size, 1):.0f}:1")
            if damaged := container.testzip():
                rule = f"is damaged: {printable(damaged)} is not of the length or checksum it declares"
                raise InputError(label, rule, cure=SAVE_AGAIN)
    except InputError:  # which is a ValueError, too
        raise
    except OSError as error:
        raise unreadable(label, error) from None
    except (zipfile.BadZipFile, zlib.error, RuntimeError, ValueError, EOFError, struct.error) as error:
        rule = f"is not a readable workbook: {printable(str(error), 100)}"
        raise InputError(label, rule, cure=SAVE_AGAIN) from None


def by_sheet(path: Path, label: str, read: Callable[[Any], Made]) -> dict[str, Made]:
    """What `read` makes of each sheet with its saved values, by the names of the sheets.

    Sheets are read row by row, by their used cells; macros are never run, links to other files not followed.
    """
    import openpyxl
    from openpyxl.utils.exceptions import InvalidFileException

    refuse_unsafe(path, label)
    found: dict[str, Made] = {}
    try:
        with warnings.catch_warnings(), path.open("rb") as file:
            warnings.simplefilter("ignore")  # on parts of the workbook that are not read
            book = openpyxl.load_workbook(file, read_only=True, data_only=True, keep_links=False)
            for sheet in book.worksheets:
                sheet.reset_dimensions()  # what a file states of its size may be wrong
                found[sheet.title] = read(sheet)
    except InputError:  # which is a ValueError, too
        raise
    except (*DAMAGED, InvalidFileException) as error:
        *_, (at, _) = traceback.walk_tb(error.__traceback__)
        if at.f_globals.get("__name__", "").startswith("separatrix."):  # cells are read while `read` works
            raise  # a fault of ours, not of the workbook
        rule = f"is not a readable workbook: {printable(str(error), 100)}"
        raise InputError(label, rule, cure=SAVE_AGAIN) from None
    return found


LONGEST_TEXT = 32_000
"""Characters of the longest text of a cell, with room to spare."""

EVALUATED = "=+-@＝＋－＠"
"""Beginnings of a text that spreadsheet programs take for a formula."""

_STAMP = re.compile(rb"(<dcterms:(created|modified)[^>]*>)[^<]*(</dcterms:)")
_FIXED = b"2000-01-01T00:00:00Z"
_CODE = re.compile("_(?=x[0-9A-Fa-f]{4}_)")
_EARLIEST = (1980, 1, 1, 0, 0, 0)


def new_workbook() -> Workbook:
    """Return a workbook without sheets."""
    from openpyxl import Workbook

    book = Workbook()
    for sheet in book.worksheets:
        book.remove(sheet)
    book.properties.creator = "separatrix"
    return book


def put(sheet: Worksheet, row: int, column: int, value: object) -> None:
    """Write a value into a cell; nothing if it is None.

    A text is never a formula: its cell has the type of texts (quotePrefix). A text that a program would
    evaluate in a text file made from the workbook begins with an apostrophe.
    """
    cell: Any = sheet.cell(row, column)
    if isinstance(value, str):
        is_formula = value.lstrip(" \t\r\n")[:1] in tuple(EVALUATED) and re.search(r"\w", value) is not None
        text = _CODE.sub("_x005F_", printable(value, LONGEST_TEXT))  # else read as the code of a character
        cell.value, cell.data_type = f"'{text}" if is_formula else text, "s"
        cell.quotePrefix = is_formula
    elif isinstance(value, bool):
        cell.value = "yes" if value else "no"
    elif isinstance(value, int | float) and math.isfinite(value):
        cell.value = value


def add_table(
    book: Workbook,
    name: str,
    heads: Sequence[str],
    rows: Iterable[Iterable[object]],
    *,
    keep_columns: int = 0,
    widths: Sequence[float] = (),
) -> None:
    """Add a sheet of headings, which stay in view, and rows; `widths` are those of columns, in characters."""
    from openpyxl.styles import Alignment, Font
    from openpyxl.utils import get_column_letter

    sheet: Worksheet = book.create_sheet(name)
    for number, row in enumerate((heads, *rows), 1):
        for column, one in enumerate(row, 1):
            put(sheet, number, column, one)
    for cell in sheet[1]:
        cell.font, cell.alignment = Font(bold=True), Alignment(wrap_text=True, vertical="top")
    sheet.freeze_panes = sheet.cell(2, keep_columns + 1).coordinate
    for column, width in enumerate(widths, 1):
        sheet.column_dimensions[get_column_letter(column)].width = width


def workbook_bytes(book: Workbook) -> bytes:
    """Return the file of a workbook; the same content has the same bytes at any time and date."""
    made = io.BytesIO()
    book.save(made)
    fixed = io.BytesIO()
    with zipfile.ZipFile(made) as source, zipfile.ZipFile(fixed, "w", zipfile.ZIP_DEFLATED) as target:
        for name in source.namelist():
            content = _STAMP.sub(rb"\g<1>" + _FIXED + rb"\g<3>", source.read(name))
            target.writestr(zipfile.ZipInfo(name, _EARLIEST), content, zipfile.ZIP_DEFLATED)
    return fixed.getvalue()
