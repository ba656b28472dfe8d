"""Files of results, judged before anything in them is used: a file may come from somebody else.

HDF5, the container of netCDF, can make a reader open other files, follow links in circles and expand a
kilobyte to terabytes. Our own files need none of that: they hold plain arrays of numbers and texts, as long
as they are. So everything else is refused, and nothing is read that is larger than the file itself.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.input_files import size_of
from separatrix.ground.units import printable

MOST_BYTES = 512 * 1024**2
"""Size of a file of results; the longest simulations have some 10 MB."""

MOST_VARIABLES = 5000
MOST_ATTRIBUTES = 100
"""Of the file, and of one variable."""

DAMAGE = (OSError, ValueError, RuntimeError, KeyError, TypeError, AttributeError, IndexError, MemoryError)
"""What the libraries below raise at a damaged file."""

_HEAP = b"GCOL\x01\0\0\0"
_PIECE = struct.Struct("<HHIQ")
_ENTRY = np.dtype([("length", "<u4"), ("place", "V12")])

_AXES = ("DIMENSION_LIST", "REFERENCE_LIST")
"""Attributes of netCDF that point from a variable to its dimensions and back."""

_NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable"
_SAVE_AGAIN = "Only files that separatrix wrote are read; compute this one again."


def check_container(path: Path) -> None:
    """Refuse a file of results that is not a plain one.

    It is not HDF5, is larger than `MOST_BYTES`, has links, groups, external, virtual or compressed data, data
    of a type that no result has, or more data than bytes.
    """
    where = str(path)
    size = size_of(path, where)
    if size > MOST_BYTES:
        rule = f"is larger than a file of results can be, {MOST_BYTES // 1024**2} MB"
        raise InputError(where, rule, f"{size / 1024**2:.0f} MB")
    _check_heaps(path, where)
    try:
        with h5py.File(path, "r") as file:
            _check(file, path, size)
    except InputError:  # which is a ValueError, too
        raise
    except DAMAGE as error:
        raise damaged(where, error) from None


def _check_heaps(path: Path, where: str) -> None:
    """Refuse heaps of texts whose pieces do not fill them: at one without length the library never ends.

    HDF5 file format specification, version 3.0, III.E: a collection begins with its mark and its size; each
    piece in it with number, references, and length; piece 0 is the free rest, its own header included.
    """
    raw = path.read_bytes()
    at = raw.find(_HEAP)
    while at >= 0:
        size = int.from_bytes(raw[at + 8 : at + 16], "little")
        place, end = at + 16, at + size
        while place + 16 <= end:
            number, _, _, length = _PIECE.unpack_from(raw[place : place + 16].ljust(16, b"\0"))
            place += length if number == 0 else 16 + -(-length // 8) * 8
            if end > len(raw) or place > end or (number == 0 and place != end):
                raise damaged(where, ValueError("a heap of texts is not filled by its pieces"))
        at = raw.find(_HEAP, at + 16)


def damaged(where: str, error: Exception) -> InputError:
    """Refusal of a file that the libraries cannot read."""
    return InputError(where, "is not a readable netCDF result", cure=printable(str(error), 200))


def _check(file: h5py.File, path: Path, size: int) -> None:
    where = str(path)
    left = size - sum(_attribute_sizes(file, where))
    if len(file) > MOST_VARIABLES:
        raise _refusal(where, f"has more than {MOST_VARIABLES} variables", str(len(file)))
    for name in file:
        at = f'{where}, variable "{printable(name)}"'
        variable = _variable(file, name, at)
        left -= sum(_attribute_sizes(variable, at))
        if not bytes(variable.attrs.get("NAME", b"")).startswith(_NO_VARIABLE):
            left -= math.prod(variable.shape) * variable.id.get_type().get_size()
            left -= _text_bytes(variable, path, at) if left >= 0 else 0
        if left < 0:
            raise _refusal(at, "declares more data than the file has bytes")


def _refusal(where: str, rule: str, value: str = "") -> InputError:
    return InputError(where, rule, value, _SAVE_AGAIN)


def _variable(file: h5py.File, name: str, at: str) -> h5py.Dataset:
    """One variable of a file: a plain array, in the file itself."""
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise _refusal(at, "is a link")
    found = file[name]
    if not isinstance(found, h5py.Dataset):
        raise _refusal(at, "is not an array")
    if found.external or found.is_virtual:
        raise _refusal(at, "has its data in another file or variable")
    if found.chunks is not None and found.size > 0:
        raise _refusal(at, "is stored in pieces, as compressed data is")
    if not _is_plain(found.dtype):
        raise _refusal(at, "must hold numbers or text", printable(str(found.dtype)))
    return found


def _is_plain(dtype: np.dtype[np.generic]) -> bool:
    is_text = h5py.check_string_dtype(dtype) is not None
    is_number = dtype.kind in "iuf" and h5py.check_enum_dtype(dtype) is None and dtype.shape == ()
    return is_text or is_number


def _attribute_sizes(owner: h5py.File | h5py.Dataset, where: str) -> Iterator[int]:
    """Bytes of each attribute of a file or a variable; others than numbers and texts are refused."""
    if len(owner.attrs) > MOST_ATTRIBUTES:
        raise _refusal(where, f"has more than {MOST_ATTRIBUTES} attributes", str(len(owner.attrs)))
    for name in owner.attrs:
        kind = owner.attrs.get_id(name)
        count = math.prod(kind.shape)
        yield count * kind.dtype.itemsize
        if name in _AXES:
            continue
        if not _is_plain(kind.dtype) or (kind.dtype.kind == "O" and count != 1):
            raise _refusal(where, f'has an attribute "{printable(name)}" that is not a text or numbers')
        if kind.dtype.kind == "O":
            yield len(str(owner.attrs[name]))


def _text_bytes(variable: h5py.Dataset, path: Path, at: str) -> int:
    """Length of all texts of a variable, as their entries state: they may share one long text, or be wrong.

    HDF5 file format specification, version 3.0, IV.B: an entry is the length, then where the text is.
    """
    if variable.dtype.kind != "O" or variable.size == 0:
        return 0
    offset, count = variable.id.get_offset(), math.prod(variable.shape)
    if offset is None:
        raise _refusal(at, "has no texts in the file")
    with path.open("rb") as file:
        file.seek(offset)
        entries = np.frombuffer(file.read(_ENTRY.itemsize * count), dtype=_ENTRY)
    return int(entries["length"].sum(dtype=np.int64))
