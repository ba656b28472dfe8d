"""Parts of a workbook: XML without entities, sent event by event to who reads it."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterator
from xml.parsers import expat

from separatrix.archive import Archive
from separatrix.errors import InputError
from separatrix.units import printable

SAVE = "Save it as .xlsx."
Attributes = dict[str, str]
_ENCODING = re.compile(rb"""^<\?xml[^>]*encoding=["'](?!utf-8["']|us-ascii["'])""", re.IGNORECASE)


def parse(
    archive: Archive,
    part: str,
    start: Callable[[str, Attributes], None],
    end: Callable[[str], None] | None = None,
    text: Callable[[str], None] | None = None,
) -> None:
    """Send the events of a whole part to its readers."""
    parser = parser_of(start, end, text)
    guard = Guard(archive.label, part)
    for piece in guard(archive.pieces(part)):
        feed(parser, piece, guard, last=False)
    feed(parser, b"", guard, last=True)


def relations(archive: Archive, part: str) -> dict[str, tuple[str, str]]:
    """Kind and target of each relation of a part, by its id; those to the outside are left out."""
    folder, name = posixpath.split(part)
    found: dict[str, tuple[str, str]] = {}

    def start(tag: str, attributes: Attributes) -> None:
        if local(tag) == "Relationship" and attributes.get("TargetMode") != "External":
            target = attributes.get("Target", "")
            inside = target[1:] if target.startswith("/") else posixpath.join(folder, target)
            kind = attributes.get("Type", "").rpartition("/")[2]
            found[attributes.get("Id", "")] = (kind, posixpath.normpath(inside))

    parse(archive, posixpath.join(folder, "_rels", f"{name}.rels"), start)
    return found


class Guard:
    """Passes a part on if it is UTF-8 without declarations that could expand or lead elsewhere."""

    def __init__(self, label: str, part: str) -> None:
        self.label, self.part = label, printable(part)

    def __call__(self, pieces: Iterator[bytes]) -> Iterator[bytes]:
        """Yield the pieces of a part, looked through."""
        before = b""
        for piece in pieces:
            if not before and (b"\0" in piece[:200] or _ENCODING.match(piece.lstrip(b"\xef\xbb\xbf"))):
                raise InputError(self.label, f"has a part that is not UTF-8: {self.part}", cure=SAVE)
            if b"<!DOCTYPE" in (seam := before + piece) or b"<!ENTITY" in seam:
                rule = f"has a part that declares entities: {self.part}"
                raise InputError(self.label, rule, cure="No workbook needs them; it was not read.")
            before = piece[-16:]
            yield piece


def parser_of(
    start: Callable[[str, Attributes], None],
    end: Callable[[str], None] | None = None,
    text: Callable[[str], None] | None = None,
) -> expat.XMLParserType:
    """Return a parser that sends its events to these readers."""
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = text
    return parser


def feed(parser: expat.XMLParserType, piece: bytes, guard: Guard, *, last: bool) -> None:
    """Give a parser the next piece; what is no XML is refused."""
    try:
        parser.Parse(piece, last)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code)
        raise InputError(guard.label, f"has a damaged part, {guard.part}: {why}", cure=SAVE) from None


def local(tag: str) -> str:
    """Return the name of an element without the prefix of its namespace."""
    return tag.rpartition(":")[2]
