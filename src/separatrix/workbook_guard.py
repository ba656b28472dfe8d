"""A workbook is a zip container; this judges it before anything in it is expanded into memory.

A small file may declare, or hide, a huge content. One that passes expands to no more than its directory
declares, by ratios that no honest workbook exceeds.
"""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

from separatrix.errors import InputError
from separatrix.input_files import size_of, unreadable
from separatrix.units import printable

MOST_BYTES = 512 * 1024**2
"""Expanded size of the whole workbook."""

MOST_RATIO = 100
"""Expanded size over size on disk, of the whole and of each part longer than `REAL_SIZE`."""

MOST_PARTS = 10_000
REAL_SIZE = 1024**2
PIECE = 1024**2
_ENCRYPTED = 0x1 | 0x40
SAVE_AGAIN = "Open it in a spreadsheet program and save it again as .xlsx."


def refuse_unsafe(path: Path, label: str | None = None) -> None:
    """Refuse what is not a workbook's zip file, is damaged or encrypted, or expands too far.

    Parameters
    ----------
    path : Path
        The file.
    label : str, optional
        Its name in messages; the file's own name if omitted.

    Raises
    ------
    InputError
        It cannot be read, is not a zip file, has parts of one name, encrypted parts or a compression that
        workbooks do not use, or would expand beyond `MOST_BYTES` or `MOST_RATIO`, or beyond what it declares.
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
    """Refuse what the directory alone shows."""
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
        piece, packed = (
            (inflate.decompress(packed, PIECE), inflate.unconsumed_tail) if deflated else (packed, b"")
        )
        length, checksum = length + len(piece), zlib.crc32(piece, checksum)
    if length != part.file_size or checksum != part.CRC:
        rule = f"is damaged: {printable(part.filename)} is not of the length or checksum it declares"
        raise InputError(label, rule, cure=SAVE_AGAIN)
