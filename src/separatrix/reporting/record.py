"""What a report holds: titled sections of paragraphs, tables, pictures and equations, all of it text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal


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
    documents: Mapping[str, Mapping[str, Any]] = field(repr=False)

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
        from separatrix.reporting.html import html

        return html(self)

    def pdf(self) -> bytes:
        """The same as PDF; needs the extra ``pdf``."""
        from separatrix.reporting.pdf import pdf

        return pdf(self)


def as_data(report: Report) -> dict[str, Any]:
    """Return a report as plain data: text, tables and captions, without its pictures and documents."""
    return {
        "title": report.title,
        "subtitle": report.subtitle,
        "sections": [
            {"title": one.title, "level": one.level, "blocks": [_block(block) for block in one.blocks]}
            for one in report.sections
        ],
    }


def _block(block: Block) -> dict[str, Any]:
    match block:
        case Paragraph():
            return {"paragraph": block.text, "kind": block.kind}
        case Facts():
            return {"facts": [list(pair) for pair in block.pairs]}
        case Table():
            rows = [list(row) for row in block.rows]
            return {"table": block.caption, "head": list(block.head), "rows": rows}
        case Picture():
            points = [target.text for target in block.hover]
            return {"picture": block.name, "caption": block.caption, "alt": block.alt, "points": points}
        case Equation():
            return {"equation": block.latex, "words": block.words}
