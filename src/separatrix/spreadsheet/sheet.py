"""Rows of a sheet, built from the events of the XML parser."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from separatrix.errors import InputError
from separatrix.spreadsheet.cells import Cell, Row, column_number, decoded
from separatrix.spreadsheet.parts import SAVE, Attributes, local
from separatrix.units import printable

if TYPE_CHECKING:
    from separatrix.spreadsheet.workbook import Workbook

_REFERENCE = re.compile(r"([A-Z]{1,3})([1-9][0-9]{0,6})")


class TextReader:
    """Collects the runs of a text, without its phonetic hints."""

    def __init__(self) -> None:
        self._pieces: list[str] = []
        self._inside = False
        self._phonetic = False

    @property
    def joined(self) -> str:
        """The text so far."""
        return decoded("".join(self._pieces))

    def clear(self) -> None:
        """Begin a new text."""
        self._pieces.clear()

    def start(self, tag: str) -> None:
        """Note the beginning of an element."""
        self._phonetic = self._phonetic or tag == "rPh"
        self._inside = tag == "t" and not self._phonetic

    def end(self, tag: str) -> None:
        """Note the end of an element."""
        self._inside = False
        self._phonetic = self._phonetic and tag != "rPh"

    def text(self, text: str) -> None:
        """Take text if it stands in a run."""
        if self._inside:
            self._pieces.append(text)


class SheetReader:
    """Builds rows from the events of the parser."""

    def __init__(self, workbook: Workbook, sheet: str) -> None:
        self._workbook, self._sheet = workbook, sheet
        self._rows: list[Row] = []
        self._row, self._column = 0, 0
        self._cells: dict[int, Cell] = {}
        self._attributes: Attributes = {}
        self._value: list[str] = []
        self._formula: list[str] = []
        self._has_formula = False
        self._sink: list[str] | None = None
        self._inline = TextReader()

    def finished(self) -> list[Row]:
        """Return the rows that are complete, and forget them."""
        rows, self._rows = self._rows, []
        return rows

    def start(self, tag: str, attributes: Attributes) -> None:
        """Note the beginning of an element."""
        tag = local(tag)
        if tag == "c":
            self._begin_cell(attributes)
        elif tag == "v":
            self._sink = self._value
        elif tag == "f":
            self._sink, self._has_formula = self._formula, True
        elif tag == "row":
            self._row, self._column, self._cells = self._number(attributes), 0, {}
        elif self._attributes.get("t") == "inlineStr":
            self._inline.start(tag)

    def _begin_cell(self, attributes: Attributes) -> None:
        self._attributes = attributes
        self._column = self._column_of(attributes)
        self._value.clear()
        self._formula.clear()
        self._inline.clear()
        self._has_formula = False

    def text(self, text: str) -> None:
        """Take text where it belongs."""
        if self._sink is not None:
            self._sink.append(text)
        else:
            self._inline.text(text)

    def end(self, tag: str) -> None:
        """Note the end of an element."""
        tag = local(tag)
        self._sink = None
        if tag == "c":
            cell = self._cell()
            if cell is not None:
                self._cells[self._column] = cell
            self._attributes = {}
        elif tag == "row" and self._cells:
            self._rows.append((self._row, self._cells))
        else:
            self._inline.end(tag)

    def _number(self, attributes: Attributes) -> int:
        given = attributes.get("r")
        number = self._row + 1 if given is None else int(given) if re.fullmatch("[0-9]{1,7}", given) else 0
        if number <= self._row:
            raise self._damaged(f"row {printable(given or '')} is out of order")
        return number

    def _column_of(self, attributes: Attributes) -> int:
        given = attributes.get("r")
        if given is None:
            return self._column + 1
        match = _REFERENCE.fullmatch(given)
        if match is None or int(match[2]) != self._row or column_number(match[1]) <= self._column:
            raise self._damaged(f"cell {printable(given)} is out of order")
        return column_number(match[1])

    def _cell(self) -> Cell | None:
        kind, text = self._attributes.get("t", "n"), "".join(self._value)
        formula = "".join(self._formula) or ("(shared)" if self._has_formula else "")
        if kind == "inlineStr":
            return Cell(self._inline.joined, formula)
        if text == "" and kind != "str":
            return Cell(None, formula) if formula else None
        if kind == "e":
            return Cell(None, formula, error=text)
        if kind == "n":
            return Cell(self._float(text), formula, format=self._format())
        if kind == "s":
            return Cell(self._shared(text), formula)
        if kind == "b":
            return Cell(text == "1", formula)
        return Cell(decoded(text), formula)

    def _float(self, text: str) -> float:
        try:
            if text.isascii() and "_" not in text:
                return float(text)
        except ValueError:
            pass
        raise self._damaged(f'"{printable(text)}" is no number')

    def _shared(self, text: str) -> str:
        strings = self._workbook.strings
        if not text.isdecimal() or len(text) > 9 or int(text) >= len(strings):
            raise self._damaged(f"there is no text number {printable(text)}")
        return strings[int(text)]

    def _format(self) -> str:
        style = self._attributes.get("s", "")
        formats = self._workbook.formats if style else []
        known = style.isdecimal() and len(style) < 9 and int(style) < len(formats)
        return formats[int(style)] if known else ""

    def _damaged(self, why: str) -> InputError:
        sheet = printable(self._sheet)
        return InputError(f"{self._workbook.label}, sheet {sheet}", f"is damaged: {why}", cure=SAVE)
