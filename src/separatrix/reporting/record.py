"""A report: titled sections of paragraphs, tables, pictures and equations; and numbers as its text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from separatrix.comparing.saved import arrays
from separatrix.told import tables
from separatrix.told.sentences import Row as Row
from separatrix.told.tables import ABSENT

if TYPE_CHECKING:
    import xarray as xr

MICRO = ("um", "uJ", "uW", "us", "uN")
"""Units that the program writes in ASCII."""


@dataclass(frozen=True)
class Kept:
    """One answer."""

    document: Row

    @cached_property
    def data(self) -> xr.Dataset | None:
        """Its labelled arrays; None of an interrupted one."""
        return arrays(self.document, f"{self.document.get('verb')}.json")


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Text; a lead is the answer, a caveat is a warning."""

    text: str
    kind: Literal["text", "lead", "caveat"] = "text"


@dataclass(frozen=True, slots=True)
class Facts:
    """Labels with their values."""

    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Table:
    """Rows under a head; the first `left` columns are text, the others numbers."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str
    left: int = 1


@dataclass(frozen=True, slots=True)
class Target:
    """A place in a picture that a reader can point at: centre and radius [points], and its text."""

    x: float
    y: float
    radius: float
    text: str


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure as SVG, `width` by `height` points."""

    name: str
    caption: str
    alt: str
    svg: str = field(repr=False)
    width: float
    height: float
    hover: tuple[Target, ...] = field(default=(), repr=False)


@dataclass(frozen=True, slots=True)
class Equation:
    """A formula: its source in LaTeX, drawn once as SVG, and what it is."""

    latex: str
    words: str
    svg: str = field(repr=False)
    width: float
    height: float


Block = Paragraph | Facts | Table | Picture | Equation


@dataclass(frozen=True, slots=True)
class Section:
    """Blocks under a title."""

    title: str
    blocks: tuple[Block, ...]
    level: Literal[2, 3] = 2


@dataclass(frozen=True, slots=True)
class Report:
    """A report, and the documents of the answers that it was made from, by verb."""

    title: str
    subtitle: str
    sections: tuple[Section, ...]
    documents: Mapping[str, Row] = field(repr=False)

    @property
    def lead(self) -> tuple[str, ...]:
        """The answer in a few sentences."""
        blocks = self.sections[0].blocks
        return tuple(one.text for one in blocks if isinstance(one, Paragraph) and one.kind == "lead")

    def summary(self) -> str:
        """The answer, a sentence a line."""
        return "\n".join(self.lead)

    def html(self) -> str:
        """One HTML file, as text, that needs no other file and no network."""
        from separatrix.reporting.formats import html

        return html(self)

    def pdf(self) -> bytes:
        """The same as PDF; needs the extra ``pdf``."""
        from separatrix.reporting.formats import pdf

        return pdf(self)


def quantity(value: float | None, unit: str, digits: int | None = None) -> str:
    """Return a value in a unit a reader likes, with the micro sign; a dash if it is absent."""
    number, space, symbol = tables.quantity(value, unit, digits).partition(" ")
    return number + space + (symbol.replace("u", "\N{MICRO SIGN}", 1) if symbol in MICRO else symbol)


def own_rows(rank: Row) -> list[Row]:
    """Return the rows of the bearing's own environment."""
    found = [one["materials"] for one in rank["environments"] if one["name"] == rank["environment"]]
    return list(found[0]) if found else []


def entry(item: Row, digits: int | None = None) -> str:
    """Return a value of a resolved study with its unit; a dash without one."""
    value, unit = item.get("value"), item.get("unit")
    if value is None:
        return ABSENT
    if isinstance(value, list):
        return ", ".join(entry({"value": one, "unit": unit}, digits) for one in value) or ABSENT
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    return quantity(value, unit, digits) if unit else f"{value:g}"


def facts(*pairs: tuple[str, str]) -> Facts:
    """Return labels with their values, without those that have none."""
    return Facts(tuple((label, value) for label, value in pairs if value and value != ABSENT))
