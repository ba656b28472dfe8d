"""A report as one HTML file that needs no other file and no network, as PDF, and as plain data."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from dataclasses import asdict
from importlib.resources import files
from pathlib import Path
from types import ModuleType

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from separatrix.ground.errors import InputError, harmless
from separatrix.ground.files import staged
from separatrix.reporting.record import Block, Equation, Facts, Paragraph, Picture, Report, Table

SHORT = 24
"""Letters of a name that stays on one line."""

ANSWERS = "separatrix-answers"
"""Identifier of the element that has the documents of the answers: {verb: document}."""


def _written(text: str) -> Markup:
    """Return a text with what is between backticks as code; all of it is escaped."""
    parts = text.split("`")
    return Markup("").join(
        Markup("<code>{}</code>").format(one) if place % 2 else one for place, one in enumerate(parts)
    )


def _css_text(text: str) -> str:
    """Return a text that is safe between quotes in a style sheet: letters, digits and escapes."""
    return "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text)


def _is_short(table: Table) -> bool:
    return all(len(text) <= SHORT for row in table.rows for text in row[: table.left])


def _embedded(picture: Picture | Equation) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(picture.svg.encode()).decode()


_TEMPLATES = Environment(
    loader=PackageLoader("separatrix.reporting"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_TEMPLATES.filters |= {"embedded": _embedded, "written": _written, "css_text": _css_text, "short": _is_short}
_TEMPLATES.filters["kind"] = lambda block: type(block).__name__


def html(report: Report) -> str:
    """Return a report as HTML; every text in it is escaped, and its pictures can run nothing."""
    answers = json.dumps(report.documents, allow_nan=False, separators=(",", ":"))
    for mark in "&<>":  # so that no text ends the script element around the documents
        answers = answers.replace(mark, f"\\u{ord(mark):04x}")
    template = _TEMPLATES.get_template("report.html")
    return harmless(template.render(report=report, answers=answers, answers_id=ANSWERS))


def typesetter() -> ModuleType:
    """Return typst's module; without the extra `pdf` it is refused."""
    try:
        import typst
    except ImportError as error:
        cure = 'Install it: pip install "separatrix[pdf]". Without --pdf the report is HTML.'
        raise InputError("--pdf", "needs the extra pdf", cure=cure) from error
    return typst


def pdf(report: Report) -> bytes:
    """Return a report as PDF; its texts go to typst as data, none is read as markup."""

    def with_pictures(block: Block) -> dict[str, object]:
        plain = {**asdict(block), "block": type(block).__name__}
        plain.pop("hover", None)
        return plain

    template = files("separatrix.reporting").joinpath("templates", "report.typ").read_bytes()
    inputs = {"report": json.dumps(as_data(report, with_pictures))}
    return bytes(typesetter().compile(template, sys_inputs=inputs, ignore_system_fonts=True))


def write(report: Report, folder: Path, *, with_pdf: bool) -> list[Path]:
    """Write report.html, and report.pdf too, into a folder, both or none; return their paths."""
    contents = {"report.html": report.html().encode()} | ({"report.pdf": report.pdf()} if with_pdf else {})
    with staged(folder) as stage:
        for name, content in contents.items():
            (stage / name).write_bytes(content)
    return [folder / name for name in contents]


def _text_of(block: Block) -> dict[str, object]:
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


def as_data(report: Report, block: Callable[[Block], dict[str, object]] = _text_of) -> dict[str, object]:
    """Return a report as plain data without its documents; of its pictures only the texts."""
    return {
        "title": report.title,
        "subtitle": report.subtitle,
        "sections": [
            {"title": one.title, "level": one.level, "blocks": [block(each) for each in one.blocks]}
            for one in report.sections
        ],
    }
