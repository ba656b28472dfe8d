"""How workbooks are written: numbers as numbers, text never as a formula, the same bytes each time."""

from __future__ import annotations

import io
import math
import re
import textwrap
import zipfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from separatrix.units import printable

if TYPE_CHECKING:
    from openpyxl import Workbook
    from openpyxl.worksheet.worksheet import Worksheet

LONGEST_TEXT = 32_000
"""Characters that a cell may hold, with room to spare."""

LONGEST_TITLE = 31
EVALUATED = "=+-@＝＋－＠"
"""Beginnings of a text that spreadsheet programs take for a formula."""

HEADER = "1F3864"
BAND = "F2F2F2"
INPUT = "FFF9E5"
LINE_HEIGHT = 15.0
"""Points."""

_STAMP = re.compile(rb"(<dcterms:(created|modified)[^>]*>)[^<]*(</dcterms:)")
_FIXED = b"2000-01-01T00:00:00Z"
_CODE = re.compile("_(?=x[0-9A-Fa-f]{4}_)")
_EARLIEST = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """How a cell looks."""

    number_format: str = "General"
    bold: bool = False
    italic: bool = False
    colour: str = ""
    """Of the text, as RRGGBB; empty for black."""
    fill: str = ""
    wrap: bool = False


class Cell(NamedTuple):
    """A value with a look of its own."""

    value: object
    look: Look


PLAIN = Look()
HEADING = Look(bold=True, colour="FFFFFF", fill=HEADER, wrap=True)
WRAPPED = Look(wrap=True)
SMALL = Look(italic=True, colour="595959", wrap=True)


def new_workbook() -> Workbook:
    """Return a workbook without sheets."""
    from openpyxl import Workbook

    book = Workbook()
    for sheet in book.worksheets:
        book.remove(sheet)
    book.properties.creator = "separatrix"
    return book


def sheet_title(name: str, taken: Sequence[str]) -> str:
    """Return a name that a sheet may have and no other has, as near to the wanted one as can be."""
    plain = re.sub(r"[\[\]:*?/\\]", "-", printable(name, 200)).strip(" '") or "sheet"
    known = {title.casefold() for title in taken}
    title, number = plain[:LONGEST_TITLE], 1
    while title.casefold() in known:
        number += 1
        title = f"{plain[: LONGEST_TITLE - len(f' ({number})')]} ({number})"
    return title


def add_sheet(book: Workbook, name: str, taken: Sequence[str] = ()) -> Worksheet:
    """Add a sheet at the end, its name none of those taken; it prints across, as wide as the page."""
    from openpyxl.worksheet.properties import PageSetupProperties

    sheet: Worksheet = book.create_sheet(sheet_title(name, [*book.sheetnames, *taken]))
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.fitToHeight = 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    sheet.print_title_rows = "1:1"
    return sheet


def put(
    sheet: Worksheet, row: int, column: int, value: object, look: Look = PLAIN, *, exact: bool = False
) -> None:
    """Write a value into a cell; nothing if it is None.

    A text is never a formula: its cell is of the type of texts and says so (quotePrefix). What a program
    would evaluate in a text file made from the workbook gets an apostrophe, unless `exact` is asked for.
    """
    from openpyxl.styles import Alignment, Font, PatternFill

    cell: Any = sheet.cell(row, column)
    if isinstance(value, str):
        cell.value = text_for_cell(value, exact=exact)
        cell.data_type = "s"
        cell.quotePrefix = is_evaluated(value)
    elif isinstance(value, bool):
        cell.value = "yes" if value else "no"
    elif isinstance(value, int | float) and math.isfinite(value):
        cell.value = value
    cell.number_format = look.number_format
    if look.bold or look.italic or look.colour:
        colour = look.colour or "000000"
        cell.font = Font(name="Calibri", size=11, bold=look.bold, italic=look.italic, color=colour)
    if look.fill:
        cell.fill = PatternFill("solid", fgColor=look.fill)
    cell.alignment = Alignment(wrap_text=look.wrap, vertical="top")


def is_evaluated(text: str) -> bool:
    """Whether a program that reads the text from a file of text may take it for a formula."""
    return text.lstrip(" \t\r\n")[:1] in tuple(EVALUATED) and re.search(r"\w", text) is not None


def text_for_cell(text: str, *, exact: bool = False) -> str:
    """Return a text as a cell may hold it: control characters as codes, no beginning of a formula."""
    plain = _CODE.sub("_x005F_", printable(text, LONGEST_TEXT))  # else read as the code of a character
    return f"'{plain}" if is_evaluated(text) and not exact else plain


def headings(sheet: Worksheet, names: Sequence[str], *, keep_columns: int = 0) -> None:
    """Write a row of headings, which stays in view."""
    for column, name in enumerate(names, 1):
        put(sheet, 1, column, name, HEADING)
    sheet.freeze_panes = sheet.cell(2, keep_columns + 1).coordinate


def widths(sheet: Worksheet, *sizes: float) -> None:
    """Give the columns their widths, in characters, and the rows the height that their wrapped texts need."""
    from openpyxl.utils import get_column_letter

    for column, size in enumerate(sizes, 1):
        sheet.column_dimensions[get_column_letter(column)].width = size
    for number, row in enumerate(sheet.iter_rows(max_col=len(sizes)), 1):
        lines = 1
        for cell, size in zip(row, sizes, strict=True):
            if isinstance(cell.value, str) and cell.alignment.wrap_text:
                width = max(int(size * (0.85 if cell.font.bold else 1.0)), 1)
                lines = max(lines, len(textwrap.wrap(cell.value, width)))
        if lines > 1:
            sheet.row_dimensions[number].height = LINE_HEIGHT * lines


def add_table(
    book: Workbook,
    name: str,
    heads: Sequence[str],
    rows: Iterable[Iterable[object]],
    *,
    looks: Sequence[Look] = (),
    sizes: Sequence[float] = (),
    keep_columns: int = 0,
    taken: Sequence[str] = (),
) -> Worksheet:
    """Add a sheet of headings and rows; a value that is no `Cell` has the look of its column."""
    sheet = add_sheet(book, name, taken)
    headings(sheet, heads, keep_columns=keep_columns)
    for number, row in enumerate(rows, 2):
        for column, one in enumerate(row, 1):
            own = one if isinstance(one, Cell) else Cell(one, looks[column - 1] if looks else PLAIN)
            put(sheet, number, column, own.value, own.look)
    if sizes:
        widths(sheet, *sizes)
    return sheet


def workbook_bytes(book: Workbook) -> bytes:
    """Return the file of a workbook; the same content gives the same bytes, whatever the time and date."""
    made = io.BytesIO()
    book.save(made)
    fixed = io.BytesIO()
    with zipfile.ZipFile(made) as source, zipfile.ZipFile(fixed, "w", zipfile.ZIP_DEFLATED) as target:
        for name in source.namelist():
            content = _STAMP.sub(rb"\g<1>" + _FIXED + rb"\g<3>", source.read(name))
            target.writestr(zipfile.ZipInfo(name, _EARLIEST), content, zipfile.ZIP_DEFLATED)
    return fixed.getvalue()
