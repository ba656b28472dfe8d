"""A workbook as a whole: is it one, has it macros, which sheets has it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from separatrix.archive import Archive, open_archive
from separatrix.errors import InputError
from separatrix.regular_file import size_of, unreadable
from separatrix.spreadsheet.cells import Row, format_kind
from separatrix.spreadsheet.parts import SAVE, Attributes, Guard, feed, local, parse, parser_of, relations
from separatrix.spreadsheet.sheet import SheetReader, TextReader
from separatrix.units import printable

MOST_SHEETS = 500
FED = 32 * 1024
"""Bytes parsed at a time: who wants only the first rows waits for no more."""

_OLE_MAGIC = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_NOT_NOW = ("xl/worksheets/sheet", "xl/sharedStrings", "customXml/")
"""Parts that are looked through when they are read, or, as the data of other programs, never are."""
_BUILT_IN = dict.fromkeys((*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)), "date")
_BUILT_IN |= {9: "percent", 10: "percent"}
"""Number formats that have a number instead of a code (ECMA-376, part 1, 18.8.30)."""


@dataclass
class Workbook:
    """A workbook whose sheets can be read one by one."""

    archive: Archive
    sheets: dict[str, str]
    """Part of each worksheet by its name, in the workbook's order."""
    parts: dict[str, str] = field(default_factory=dict)
    """Part of each kind that the workbook refers to once: ``sharedStrings``, ``styles``."""

    @property
    def label(self) -> str:
        """Name of the file in messages."""
        return self.archive.label

    @property
    def has_links(self) -> bool:
        """Whether it takes values from other files."""
        return any("/externallinks/" in f"/{name.casefold()}" for name in self.archive.members)

    @cached_property
    def strings(self) -> list[str]:
        """Texts that cells share."""
        return _shared_strings(self) if "sharedStrings" in self.parts else []

    @cached_property
    def formats(self) -> list[str]:
        """What each style of cells shows a number as, in the words of `Cell`."""
        return _formats(self) if "styles" in self.parts else []

    def rows(self, sheet: str) -> Iterator[Row]:
        """Yield the rows of a sheet that have any cell, from the top.

        Raises
        ------
        InputError
            The sheet is damaged.
        """
        reader = SheetReader(self, sheet)
        yield from self._fed(reader, self.sheets[sheet])

    def _fed(self, reader: SheetReader, part: str) -> Iterator[Row]:
        parser = parser_of(reader.start, reader.end, reader.text)
        guard = Guard(self.label, part)
        for piece in guard(self.archive.pieces(part)):
            for start in range(0, len(piece), FED):
                feed(parser, piece[start : start + FED], guard, last=False)
                yield from reader.finished()
        feed(parser, b"", guard, last=True)
        yield from reader.finished()


def open_workbook(path: Path) -> Workbook:
    """Return the workbook of a file, its sheets not yet read.

    Raises
    ------
    InputError
        It is not an .xlsx workbook, breaks a rule of `open_archive`, or has macros.
    """
    label = printable(path.name)
    _refuse_other_kinds(path, label)
    archive = open_archive(path, label)
    _refuse_macros(archive)
    _refuse_entities(archive)
    main = _main_part(archive)
    targets = relations(archive, main)
    sheets: dict[str, str] = {}

    def start(tag: str, attributes: Attributes) -> None:
        if local(tag) == "sheet":
            kind, part = targets.get(_relation_id(attributes), ("", ""))
            if kind == "worksheet":
                sheets[attributes.get("name", "")] = part

    parse(archive, main, start)
    if not 0 < len(sheets) <= MOST_SHEETS:
        raise InputError(label, f"must have 1 to {MOST_SHEETS} sheets", str(len(sheets)))
    return Workbook(archive, sheets, dict(targets.values()))


def _refuse_other_kinds(path: Path, label: str) -> None:
    size_of(path, label)
    try:
        with path.open("rb") as file:
            start = file.read(8)
    except OSError as error:
        raise unreadable(label, error) from None
    if start == _OLE_MAGIC:
        rule = "is an .xls workbook of the old kind, or has a password"
        raise InputError(label, rule, cure="Save it as .xlsx without a password.")
    if not start:
        raise InputError(label, "is empty")


def _refuse_macros(archive: Archive) -> None:
    names = {name.casefold() for name in archive.members}
    if "mimetype" in names and "content.xml" in names:
        raise InputError(archive.label, "is an OpenDocument file, which is not read", cure=SAVE)
    if any(name.endswith("workbook.bin") for name in names):
        raise InputError(archive.label, "is a binary workbook, .xlsb, which is not read", cure=SAVE)
    macro = next((n for n in names if n.endswith("vbaproject.bin") or "/macrosheets/" in f"/{n}"), None)
    types = archive.read("[Content_Types].xml") if "[content_types].xml" in names else b""
    if macro is not None or b"macroEnabled" in types:
        cure = "Save it as .xlsx, which keeps no macros."
        raise InputError(archive.label, "has macros; they are never run, and it is not read", cure=cure)


def _refuse_entities(archive: Archive) -> None:
    """Look through the parts, read or not, but for those that are looked through when they are read."""
    for name in archive.members:
        if name.endswith((".xml", ".rels", ".vml")) and not name.startswith(_NOT_NOW):
            for _ in Guard(archive.label, name)(archive.pieces(name)):
                pass


def _main_part(archive: Archive) -> str:
    if "_rels/.rels" not in archive.members:
        raise InputError(archive.label, "is a zip file but no workbook", cure=SAVE)
    found = [part for kind, part in relations(archive, "").values() if kind == "officeDocument"]
    if len(found) != 1 or not found[0].startswith("xl/"):
        raise InputError(archive.label, "is a document but no workbook", cure=SAVE)
    return found[0]


def _relation_id(attributes: Attributes) -> str:
    return next((value for key, value in attributes.items() if local(key) == "id" and ":" in key), "")


def _shared_strings(workbook: Workbook) -> list[str]:
    found: list[str] = []
    reader = TextReader()

    def start(tag: str, attributes: Attributes) -> None:
        del attributes
        if local(tag) == "si":
            reader.clear()
        reader.start(local(tag))

    def end(tag: str) -> None:
        reader.end(local(tag))
        if local(tag) == "si":
            found.append(reader.joined)

    parse(workbook.archive, workbook.parts["sharedStrings"], start, end, reader.text)
    return found


def _formats(workbook: Workbook) -> list[str]:
    codes: dict[int, str] = {}
    found: list[str] = []
    inside = False

    def start(tag: str, attributes: Attributes) -> None:
        nonlocal inside
        name = local(tag)
        inside = name == "cellXfs" or (inside and name not in ("cellStyles", "dxfs"))
        number = attributes.get("numFmtId", "0")
        identity = int(number) if number.isdecimal() and len(number) < 9 else 0
        if name == "numFmt":
            codes[identity] = attributes.get("formatCode", "")
        elif name == "xf" and inside:
            found.append(_BUILT_IN.get(identity, format_kind(codes.get(identity, ""))))

    parse(workbook.archive, workbook.parts["styles"], start)
    return found
