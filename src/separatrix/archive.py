"""Zip containers, such as workbooks: judged by their directory before anything in them is expanded.

A small file may declare, or hide, a huge content. What is read here has passed the directory's rules (a
ratio and a total that no honest measurement needs to exceed), and each member is expanded piece by piece
and never beyond what the directory declared.
"""

from __future__ import annotations

import os
import re
import struct
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from separatrix.errors import InputError
from separatrix.regular_file import size_of, unreadable
from separatrix.units import printable

ZIP_MAGIC = b"PK\x03\x04"
MOST_RATIO = 100
"""Expanded size over size on disk."""

MOST_BYTES = 512 * 1024**2
MOST_MEMBERS = 10_000
REAL_SIZE = 1024**2
"""Expanded size from which a member by itself must keep the ratio; short ones may exceed it honestly."""

PIECE = 1024**2
_END = struct.Struct("<4s4H2LH")
_LOCAL = struct.Struct("<4s5H3L2H")
_ENCRYPTED = 0x1 | 0x40
_SAVE_AGAIN = "Open it in a spreadsheet program and save it again as .xlsx."
_NESTED = (
    *(".zip", ".gz", ".bz2", ".xz", ".7z", ".rar", ".tar", ".jar", ".cab"),
    *(".xlsx", ".xlsm", ".xlsb", ".docx", ".docm", ".pptx", ".pptm", ".ods", ".odt"),
)


@dataclass(frozen=True, slots=True)
class Archive:
    """A zip container that `open_archive` has judged safe to read."""

    path: Path
    label: str
    """Name of the file in messages."""
    members: dict[str, zipfile.ZipInfo]

    def pieces(self, name: str) -> Iterator[bytes]:
        """Yield the expanded content of a member, a piece at a time, no more than it declares.

        Raises
        ------
        InputError
            There is no such member, it is damaged, or its content is longer than declared.
        """
        info = self.members.get(name)
        if info is None:
            raise InputError(self.label, f"lacks its part {printable(name)}", cure=_SAVE_AGAIN)
        length, crc = 0, 0
        for piece in _expanded(self.path, self.label, info):
            length += len(piece)
            if length > info.file_size:
                raise _lies(self.label, info)
            crc = zlib.crc32(piece, crc)
            yield piece
        if length < info.file_size:
            raise _lies(self.label, info)
        if crc != info.CRC:
            raise _damaged(self.label, f"the checksum of {printable(name)} does not match")

    def read(self, name: str) -> bytes:
        """Return the whole content of a member, as `pieces` gives it."""
        return b"".join(self.pieces(name))


def open_archive(path: Path, label: str | None = None) -> Archive:
    """Return a zip container whose directory keeps every rule; nothing is expanded.

    Raises
    ------
    InputError
        It is not a zip file, or would expand by more than `MOST_RATIO` or beyond `MOST_BYTES`, holds
        encrypted or nested members, two of one name, or a name that leads out of the container.
    """
    name = printable(path.name) if label is None else label
    size = size_of(path, name)
    try:
        with path.open("rb") as file:
            _check_ends(file.read(4), _tail(file, size), name)
        with zipfile.ZipFile(path) as container:
            infos = container.infolist()
    except InputError:  # which is a ValueError, too
        raise
    except OSError as error:
        raise unreadable(name, error) from None
    except (zipfile.BadZipFile, NotImplementedError, ValueError, struct.error) as error:
        raise _damaged(name, printable(str(error))) from None
    _check_directory(infos, size, name)
    return Archive(path, name, {info.filename: info for info in infos})


def _tail(file: BinaryIO, size: int) -> bytes:
    """End of a file, where the directory's own record stands."""
    length = min(size, 65_557)
    file.seek(size - length)
    return file.read(length)


def _check_ends(magic: bytes, tail: bytes, label: str) -> None:
    """Refuse what is no zip, or whose directory is too long to read at all."""
    if magic != ZIP_MAGIC:
        raise InputError(label, "is not a zip file, which a workbook is", cure=_SAVE_AGAIN)
    at = tail.rfind(b"PK\x05\x06")
    if at < 0 or len(tail) < at + _END.size:
        raise _damaged(label, "its directory is missing")
    _, _, _, _, count, length, offset, _ = _END.unpack_from(tail, at)
    if count == 0xFFFF or 0xFFFFFFFF in (length, offset):
        raise InputError(label, "is a zip file of the kind for more than 4 GB", cure=_SAVE_AGAIN)
    if count > MOST_MEMBERS or length > 1024 * MOST_MEMBERS:
        raise InputError(label, f"has more than {MOST_MEMBERS} parts", str(count))


def _check_directory(infos: list[zipfile.ZipInfo], size: int, label: str) -> None:
    _check_names(infos, label)
    total = sum(info.file_size for info in infos)
    if total > MOST_BYTES:
        rule = f"would expand to more than {MOST_BYTES // 1024**2} MB"
        raise InputError(label, rule, f"{total / 1024**2:.0f} MB", "Nothing was expanded.")
    for info in infos:
        _check_member(info, label)
    _check_ratio(total, size, label)
    _check_overlap(infos, label)


def _check_names(infos: list[zipfile.ZipInfo], label: str) -> None:
    for info in infos:
        if not _stays_inside(info.orig_filename):
            rule = "has a part whose name leads out of it"
            raise InputError(label, rule, f'"{printable(info.orig_filename)}"', "It was not opened.")
    twice = [name for name, n in Counter(info.filename.casefold() for info in infos).items() if n > 1]
    if twice:
        raise InputError(label, "has two parts of the same name", f'"{printable(twice[0])}"', _SAVE_AGAIN)


def _stays_inside(name: str) -> bool:
    parts = re.split(r"[/\\]", name)
    rooted = not name or parts[0] == "" or ":" in parts[0] or "\\" in name
    return not rooted and ".." not in parts and name.isprintable()


def _check_member(info: zipfile.ZipInfo, label: str) -> None:
    name = printable(info.filename)
    if info.flag_bits & _ENCRYPTED:
        cure = "Save it without a password."
        raise InputError(label, f"is encrypted: its part {name} cannot be read", cure=cure)
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputError(label, f"has a part of a compression that no workbook has: {name}", cure=_SAVE_AGAIN)
    if info.filename.casefold().endswith(_NESTED):
        cure = "Remove embedded documents and save it again."
        raise InputError(label, f"holds another archive or document: {name}", cure=cure)
    if info.file_size > REAL_SIZE:
        _check_ratio(info.file_size, info.compress_size, label, f" in its part {name}")


def _check_ratio(expanded: int, packed: int, label: str, part: str = "") -> None:
    if expanded > MOST_RATIO * max(packed, 1):
        ratio = expanded / max(packed, 1)
        rule = f"would expand by more than {MOST_RATIO}:1{part}"
        raise InputError(label, rule, f"{ratio:.0f}:1", "Nothing was expanded.")


def _check_overlap(infos: Iterable[zipfile.ZipInfo], label: str) -> None:
    """Refuse members that share bytes: one content counted many times."""
    end = 0
    for info in sorted(infos, key=lambda one: one.header_offset):
        if info.header_offset < end:
            raise _damaged(label, f"its parts overlap at {printable(info.filename)}")
        end = info.header_offset + _LOCAL.size + info.compress_size


def _expanded(path: Path, label: str, info: zipfile.ZipInfo) -> Iterator[bytes]:
    """Expand a member, at most a piece at a time whatever its ratio."""
    decompress = _Inflate() if info.compress_type == zipfile.ZIP_DEFLATED else _Stored()
    try:
        with path.open("rb") as file:
            file.seek(info.header_offset)
            header = _LOCAL.unpack(file.read(_LOCAL.size))
            if header[0] != ZIP_MAGIC:
                raise _damaged(label, f"{printable(info.filename)} is not where its directory says")
            file.seek(header[-2] + header[-1], os.SEEK_CUR)
            left = info.compress_size
            while left > 0 and (packed := file.read(min(PIECE, left))):
                left -= len(packed)
                yield from decompress(packed)
    except (zlib.error, struct.error):
        raise _damaged(label, f"{printable(info.filename)} cannot be expanded") from None


class _Inflate:
    """Deflated bytes, expanded in pieces of bounded size."""

    def __init__(self) -> None:
        self._engine = zlib.decompressobj(-15)

    def __call__(self, packed: bytes) -> Iterator[bytes]:
        while packed and not self._engine.eof:
            yield self._engine.decompress(packed, PIECE)
            packed = self._engine.unconsumed_tail


class _Stored:
    """Bytes as they are."""

    def __call__(self, packed: bytes) -> Iterator[bytes]:
        yield packed


def _lies(label: str, info: zipfile.ZipInfo) -> InputError:
    name, size = printable(info.filename), info.file_size
    return InputError(label, f"is damaged: {name} is not of the {size} bytes it declares", cure=_SAVE_AGAIN)


def _damaged(label: str, why: str) -> InputError:
    return InputError(label, f"is a damaged zip file: {why}", cure=_SAVE_AGAIN)
