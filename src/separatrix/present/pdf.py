"""A page as PDF: its blocks go to typst as data, so that no text of a study is read as markup."""

from __future__ import annotations

import json
from importlib.resources import files
from types import ModuleType
from typing import Any

from separatrix.ground.errors import InputError
from separatrix.present import draw
from separatrix.present.blocks import (
    TONES,
    Block,
    Equation,
    Facts,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    Table,
    View,
    spans,
)
from separatrix.present.html import GREEK


def typesetter() -> ModuleType:
    """Return typst's module; without the extra `pdf` it is refused."""
    try:
        import typst
    except ImportError as error:
        cure = 'Install it: pip install "separatrix[pdf]". Without --pdf the report is HTML.'
        raise InputError("--pdf", "needs the extra pdf", cure=cure) from error
    return typst


def pdf(page: Page, level: Level = Level.REPORT) -> bytes:
    """Return a page as PDF."""
    blocks = [_block(one) for one in page.at(level).blocks if not isinstance(one, View)]
    data = json.dumps({"title": page.title, "subtitle": page.subtitle, "blocks": blocks})
    template = files("separatrix.present").joinpath("static", "page.typ").read_bytes()
    return bytes(typesetter().compile(template, sys_inputs={"page": data}, ignore_system_fonts=True))


def _block(block: Block) -> dict[str, Any]:
    """Return a block as plain data, under its kind."""
    match block:
        case Heading(text=text, depth=depth):
            return {"kind": "heading", "text": _spans(text), "depth": depth}
        case Facts(pairs=pairs):
            is_wide = any(len(label) > 40 for label, _ in pairs)
            written = [[_spans(label), _spans(cell.text)] for label, cell in pairs]
            return {"kind": "facts", "is-wide": is_wide, "pairs": written}
        case Table():
            return _table(block)
        case Note(text=text, kind=kind):
            return {"kind": "note", "text": _spans(text), "as": kind}
        case Equation(latex=latex, words=words):
            return {"kind": "equation", "alt": latex, "caption": _spans(words)} | _drawn(draw.formula(latex))
        case Picture():
            found = {"kind": "picture", "alt": block.caption, "caption": _spans(block.caption)}
            return found | _drawn(draw.save(block.figure()))
        case _:
            raise TypeError(type(block).__name__)


def _drawn(one: draw.Drawing) -> dict[str, Any]:
    return {"svg": one.svg, "width": one.width}


def _table(block: Table) -> dict[str, Any]:
    columns = block.shown
    rows = [
        [
            {
                "text": _spans(one.texts[place]),
                "tone": one.texts[place] if one.texts[place] in TONES else "",
                "length": len(one.texts[place]),
                "is-number": one.cells[place].is_number,
            }
            for one in columns
        ]
        for place in range(len(block.rows))
    ]
    return {
        "kind": "table",
        "heads": [_spans(one.title) for one in columns],
        "is-text": [one.is_text for one in columns],
        "rows": rows,
        "caption": _spans(block.caption),
    }


def _spans(text: str) -> list[list[str]]:
    """Return a text as parts, each with its kind; a symbol as its letter and index."""
    found = []
    for kind, part in spans(text):
        stem, _, index = part.partition("_") if kind == "symbol" else (part, "", "")
        letter = GREEK.get(stem, stem) if kind == "symbol" else stem
        found.append([kind, letter, GREEK.get(index, index)])
    return found
