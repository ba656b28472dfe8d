"""The characters of a log file, decided by rules and never by luck."""

from __future__ import annotations

import codecs

from separatrix.errors import InputError

ENCODINGS = ("utf-8", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1", "cp1250", "cp932", "gbk")
"""What `[format] encoding` of a column map may be."""

_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
_OTHERS = {
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook", "Save it as .xlsx or as CSV."),
    b"\x1f\x8b": ("compressed (gzip)", "Unpack it first."),
    b"7z\xbc\xaf": ("compressed (7-Zip)", "Unpack it first."),
    b"%PDF": ("a PDF", "Export the log as text."),
    b"\x89PNG": ("a picture", "Export the log as text."),
    b"\x89HDF": ("an HDF5 file", "Export the log as text."),
    b"MATLAB 5": ("a MATLAB file", "Export the log as text."),
}
_ASCII_BELOW = ("utf-8", "cp1252", "latin-1", "cp1250")
_END_OF_FILE = b"\x1a"
"""What DOS programs write behind the last line."""

_MINUS = "\u2212".encode()
_CONTROLS = bytes(c for c in range(32) if c not in b"\t\n\r\f")


def text_of(raw: bytes, source: str, encoding: str | None = None) -> tuple[bytes, str]:
    """The file as UTF-8 with line feeds only, and the encoding it had.

    A byte order mark decides; without one, UTF-16 is known by the NUL bytes that its Latin letters have in
    every second place, UTF-8 by being valid, and what is left is Windows-1252 if no byte is undefined in it.

    Raises
    ------
    InputError
        Not a text file, or none of these encodings.
    """
    for magic, (what, cure) in _OTHERS.items() if encoding is None else ():
        if raw.startswith(magic):
            raise InputError(source, f"is {what}, not text", cure=cure)
    mark = next((mark for mark in _MARKS if raw.startswith(mark)), b"")
    body = raw.removeprefix(mark)
    chosen = encoding or (_MARKS[mark] if mark else _by_rule(body, source))
    text = _in_utf8(body, chosen, source).rstrip(_END_OF_FILE)
    if not text.isascii():
        text = text.replace(_MINUS, b"-")
    if text[:65536].translate(None, _CONTROLS) != text[:65536]:
        raise _binary(source)
    returns = text.count(b"\r")
    if returns == text.count(b"\r\n"):
        return (text.translate(None, b"\r") if returns else text), chosen
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n"), chosen


def _by_rule(raw: bytes, source: str) -> str:
    if b"\0" not in raw:
        try:
            raw.decode("utf-8")
        except UnicodeDecodeError:
            return "cp1252"
        return "utf-8"
    # UTF-16, little or big endian by the side of the NUL bytes, if they are on one side and in most letters
    head = raw[: min(len(raw), 65536) // 2 * 2]
    low, high = head[0::2].count(0), head[1::2].count(0)
    most = 0.8 * len(head) / 2
    if low == 0 and high > most:
        return "utf-16-le"
    if high == 0 and low > most:
        return "utf-16-be"
    raise _binary(source)


def _in_utf8(raw: bytes, encoding: str, source: str) -> bytes:
    """Only the lines before the plain ASCII of the rows are recoded, where the encoding allows."""
    if encoding not in _ASCII_BELOW:
        return _recoded(raw, encoding, source)
    cut = raw.find(b"\n", 16384) + 1
    if cut == 0 or not raw[cut:].isascii():
        return _recoded(raw, encoding, source)
    return _recoded(raw[:cut], encoding, source) + raw[cut:]


def _recoded(raw: bytes, encoding: str, source: str) -> bytes:
    try:
        return raw.decode(encoding).encode("utf-8")
    except UnicodeError as problem:
        place = getattr(problem, "start", 0)
        line = raw.count(b"\n", 0, place) + 1
        rule = f"cannot be read as {encoding} text"
        cure = f'Add to the column map, below [format]: encoding = "..." (one of {", ".join(ENCODINGS)}).'
        raise InputError(f"{source}: line {line}", rule, f"byte {raw[place]:#04x}", cure) from None


def _binary(source: str) -> InputError:
    cure = "Export the log as text from the tribometer's program."
    return InputError(source, "is not a text file (it has NUL or control characters)", cure=cure)
