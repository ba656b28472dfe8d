"""Workbook files: judged before anything in them is expanded, written with the same bytes each time.

A workbook is a zip container, and a small one may declare, or hide, a huge content. One that passes
`refuse_unsafe` expands to no more than its directory declares, by ratios that no honest workbook exceeds.
Numbers are written as numbers, text never as a formula.
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
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

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
"""Expanded size over size on disk, of the whole and of each part longer than `REAL_SIZE`."""

MOST_PARTS = 10_000
REAL_SIZE = 1024**2
PIECE = 1024**2
_ENCRYPTED = 0x1 | 0x40
SAVE_AGAIN = "Open it in a spreadsheet program and save it again as .xlsx."
DAMAGED = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, SyntaxError, OSError, EOFError),
    *(zipfile.BadZipFile, zlib.error, NotImplementedError, RecursionError, AssertionError),
)
"""What openpyxl raises for a workbook that is damaged or makes no sense."""


def refuse_unsafe(path: Path, label: str | None = None) -> None:
    """Refuse a file that is not a workbook's zip file, is damaged or encrypted, or expands too far.

    That is beyond `MOST_BYTES`, `MOST_RATIO`, or the declared size. `label` names it in messages, by default
    its own name.
    """
    name = printable(path.name) if label is None else label
    size = size_of(path, name)
    try:
        with zipfile.ZipFile(path) as container, path.open("rb") as file:
            parts = container.infolist()
            _check_directory(parts, size, name)
            for part in parts:
                _check_content(file, part, name)
    except InputError:  # which is a ValueError, too
        raise
    except OSError as error:
        raise unreadable(name, error) from None
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, ValueError, struct.error) as error:
        rule = f"is not a readable workbook: {printable(str(error))}"
        raise InputError(name, rule, cure=SAVE_AGAIN) from None


def _check_directory(parts: Sequence[zipfile.ZipInfo], size: int, label: str) -> None:
    """Refuse a container whose directory alone is wrong."""
    if len(parts) > MOST_PARTS:
        raise InputError(label, f"must have at most {MOST_PARTS} parts", str(len(parts)))
    twice = [name for name, n in Counter(part.filename.casefold() for part in parts).items() if n > 1]
    if twice:
        raise InputError(label, "has two parts of the same name", f'"{printable(twice[0])}"', SAVE_AGAIN)
    total = sum(part.file_size for part in parts)
    if total > MOST_BYTES:
        got = f"{total / 1024**2:.0f} MB"
        raise InputError(label, f"must expand to at most {MOST_BYTES // 1024**2} MB", got)
    for expanded, packed in [(total, size), *((p.file_size, p.compress_size) for p in parts)]:
        if expanded > MOST_RATIO * max(packed, 1) and (expanded > REAL_SIZE or expanded is total):
            got = f"{expanded / max(packed, 1):.0f}:1"
            raise InputError(label, f"must expand by at most {MOST_RATIO}:1", got)
    for part in parts:
        if part.flag_bits & _ENCRYPTED:
            raise InputError(label, "is encrypted", cure="Save it without a password.")
        if part.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            rule = f"has a part of a compression that workbooks do not use: {printable(part.filename)}"
            raise InputError(label, rule, cure=SAVE_AGAIN)


def _check_content(file: BinaryIO, part: zipfile.ZipInfo, label: str) -> None:
    """Refuse a part whose content is not of the length and checksum that the directory declares."""
    file.seek(part.header_offset + 26)
    names = struct.unpack("<2H", file.read(4))  # lengths of the name and the extra field
    file.seek(sum(names), 1)
    inflate = zlib.decompressobj(-15)
    deflated = part.compress_type == zipfile.ZIP_DEFLATED
    packed, length, checksum, left = b"", 0, 0, part.compress_size
    while length <= part.file_size and (packed or left > 0):
        if not packed:
            packed = file.read(min(PIECE, left))
            left -= PIECE
        if deflated:
            piece, packed = inflate.decompress(packed, PIECE), inflate.unconsumed_tail
        else:
            piece, packed = packed, b""
        length, checksum = length + len(piece), zlib.crc32(piece, checksum)
    if length != part.file_size or checksum != part.CRC:
        rule = f"is damaged: {printable(part.filename)} is not of the length or checksum it declares"
        raise InputError(label, rule, cure=SAVE_AGAIN)


def by_sheet(path: Path, label: str, read: Callable[[str, Any, Any], Made | None]) -> dict[str, Made]:
    """What `read` makes of each sheet, from its name, its saved values and its formulas; None is left out.

    Sheets are read row by row, by their used cells; macros are never run, links to other files not followed.
    """
    import openpyxl
    from openpyxl.utils.exceptions import InvalidFileException

    refuse_unsafe(path, label)
    found: dict[str, Made] = {}
    try:
        with warnings.catch_warnings(), path.open("rb") as file:
            warnings.simplefilter("ignore")  # on parts of the workbook that are not read
            saved = openpyxl.load_workbook(file, read_only=True, data_only=True, keep_links=False)
            formulas = openpyxl.load_workbook(file, read_only=True, keep_links=False)
            for sheet in saved.worksheets:
                for one in (sheet, formulas[sheet.title]):  # what a file states of its size may be wrong
                    one.reset_dimensions()
                if (made := read(sheet.title, sheet, formulas[sheet.title])) is not None:
                    found[sheet.title] = made
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
        cell.value = text_for_cell(value)
        cell.data_type = "s"
        cell.quotePrefix = is_evaluated(value)
    elif isinstance(value, bool):
        cell.value = "yes" if value else "no"
    elif isinstance(value, int | float) and math.isfinite(value):
        cell.value = value


def is_evaluated(text: str) -> bool:
    """Whether a program may take a text, read from a text file, for a formula."""
    return text.lstrip(" \t\r\n")[:1] in tuple(EVALUATED) and re.search(r"\w", text) is not None


def text_for_cell(text: str) -> str:
    """Return a text as a cell may have it: control characters as codes, no beginning of a formula."""
    plain = _CODE.sub("_x005F_", printable(text, LONGEST_TEXT))  # else read as the code of a character
    return f"'{plain}" if is_evaluated(text) else plain


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


WORKBOOK_ENDINGS = (".xlsx", ".xlsm", ".xltx", ".xls", ".xlsb", ".ods")


def is_workbook(path: Path) -> bool:
    """Whether a file is a workbook by its name; of those only .xlsx is read."""
    return path.suffix.casefold() in WORKBOOK_ENDINGS
