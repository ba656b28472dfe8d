"""A page as HTML: a part of the local page, or one file that needs no other file and no network."""

from __future__ import annotations

import base64
import json
import logging
from collections.abc import Callable, Mapping
from html import escape
from pathlib import Path
from typing import Any

from separatrix.ground.errors import harmless
from separatrix.present import draw
from separatrix.present.blocks import (
    TONES,
    Block,
    Cell,
    Equation,
    Facts,
    Heading,
    Level,
    Note,
    Page,
    Picture,
    ShownColumn,
    Table,
    View,
    spans,
)
from separatrix.present.view import script_json, static

GREEK = {"eta": "\N{GREEK SMALL LETTER ETA}", "mu": "\N{GREEK SMALL LETTER MU}"}
GREEK |= {"zeta": "\N{GREEK SMALL LETTER ZETA}", "alpha": "\N{GREEK SMALL LETTER ALPHA}"}
GREEK |= {"xi": "\N{GREEK SMALL LETTER XI}", "dxi": "\N{GREEK SMALL LETTER DELTA}\N{GREEK SMALL LETTER XI}"}

LONG = 24
"""Letters of a text from which it may be broken into lines."""


PictureHtml = Callable[[Picture], str]


def html(
    page: Page,
    documents: Mapping[str, Any] | None = None,
    level: Level = Level.REPORT,
    picture: PictureHtml | None = None,
) -> str:
    """Return a page as one file; its pictures can run nothing.

    `documents` are the answers behind it by their verbs: they go into the file as JSON. `picture` shows a
    picture otherwise than as SVG that is drawn for it.
    """
    shown = page.at(level)
    heads = [one for one in shown.blocks if isinstance(one, Heading) and one.depth == 2]
    contents = "".join(f'<li><a href="#{_id(one.text)}">{inline(one.text)}</a></li>' for one in heads)
    answers = script_json(documents or {})
    title, subtitle = escape(page.title), escape(page.subtitle)
    style = static("page.css").replace("@TITLE@", _css(page.title))
    style = style.replace("@SUBTITLE@", _css(page.subtitle))
    behind = (
        f'<script type="application/json" id="separatrix-answers">{answers}</script>' if documents else ""
    )
    kept = f"Answers in this file, as JSON: {', '.join(documents)}." if documents else ""
    return harmless(f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<header>
<h1>{title}</h1>
<p class="subtitle">{subtitle}</p>
</header>
{f'<nav aria-label="Contents"><ol>{contents}</ol></nav>' if heads[2:] else ""}
<main>
{body(shown, level, picture)}
</main>
<footer><p>{subtitle}. {kept}</p></footer>
<div id="tip" role="status" hidden></div>
{behind}
<script>
{static("page.js")}</script>
</body>
</html>
""")


def write_drawn(page: Page, folder: Path, name: str = "") -> None:
    """Write the pictures and views of a page, each drawn once, and with a name the page with them."""
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # its remarks on fonts
    pictures: dict[str, str] = {}
    for one in page.blocks:
        if isinstance(one, View):
            (folder / f"{one.name}.html").write_text(one.html(), encoding="utf-8")
        elif isinstance(one, Picture):
            drawing = draw.save(one.figure(), *(folder / f"{one.name}{end}" for end in (".png", ".svg")))
            pictures[one.name] = picture_html(one, drawing)
    if name:
        text = html(page, level=Level.REPORT | Level.FULL, picture=lambda one: pictures[one.name])
        (folder / f"{name}.html").write_text(text, encoding="utf-8")


def body(
    page: Page,
    level: Level = Level.REPORT,
    picture: PictureHtml | None = None,
    view: Callable[[View], str] | None = None,
) -> str:
    """Return the blocks of a page; `picture` shows a picture otherwise than as SVG, `view` a view."""
    return "\n".join(_block(one, picture or drawn, view or _view) for one in page.at(level).blocks)


def _css(text: str) -> str:
    """Return a text that is safe between quotes in a style sheet: letters, digits and escapes."""
    return "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text)


def _block(block: Block, picture: PictureHtml, view: Callable[[View], str]) -> str:
    match block:
        case Heading(text=text, depth=depth):
            return f'<h{depth} id="{_id(text)}">{inline(text)}</h{depth}>'
        case Facts(pairs=pairs):
            rows = (
                f"<div><dt>{inline(label)}</dt><dd>{_meant(cell, cell.text)}</dd></div>"
                for label, cell in pairs
            )
            return f"<dl>{''.join(rows)}</dl>"
        case Table():
            return _table(block)
        case Note(text=text, kind=kind):
            return f'<p class="{kind}">{inline(text)}</p>'
        case Equation(latex=latex, words=words):
            image = _image(draw.formula(latex), latex)
            return f'<div class="equation">{image}<p>{inline(words)}</p></div>'
        case Picture():
            return picture(block)
        case View():
            return view(block)


def _table(table: Table) -> str:
    columns = table.shown
    heads = "".join(f'<th scope="col" class="{_side(one)}">{inline(one.title)}</th>' for one in columns)
    rows = "".join(
        f"<tr>{''.join(_cell(one, place, is_first=one is columns[0]) for one in columns)}</tr>"
        for place in range(len(table.rows))
    )
    caption = f"<caption>{inline(table.caption)}</caption>" if table.caption else ""
    kinds = "wide whole" if len(table.rows) <= 16 else "wide"
    label = escape(table.caption or table.name)
    inside = f"{caption}<thead><tr>{heads}</tr></thead><tbody>{rows}</tbody>"
    return (
        f'<div class="{kinds}" role="region" aria-label="{label}" tabindex="0"><table>{inside}</table></div>'
    )


def _cell(column: ShownColumn, place: int, *, is_first: bool) -> str:
    text = column.texts[place]
    tone = text if text in TONES else ""
    short = "short" if len(text) <= LONG else ""
    kinds = " ".join(filter(None, [_side(column), tone, short]))
    if is_first:
        return f'<th scope="row" class="{kinds}">{inline(text)}</th>'
    return f'<td class="{kinds}">{_meant(column.cells[place], text)}</td>'


def _side(one: ShownColumn) -> str:
    return "" if one.is_text else "n"


def _meant(cell: Cell, text: str) -> str:
    """Return a text; the pointer shows what it means."""
    meaning = cell.quantity.meaning if cell.quantity else ""
    return f'<span title="{escape(meaning)}">{inline(text)}</span>' if meaning else inline(text)


def drawn(one: Picture) -> str:
    """Return a picture as SVG that is drawn for it."""
    return picture_html(one, draw.save(one.figure()))


def picture_html(one: Picture, drawing: draw.Drawing) -> str:
    """Return a picture as it was drawn, with the places that a reader can point at."""
    circles = "".join(
        f'<circle cx="{x}" cy="{y}" r="4" tabindex="{0 if place == 0 else -1}" role="img" '
        f'aria-label="{escape(text)}"></circle>'
        for place, (x, y, text) in enumerate(drawing.targets)
    )
    over = (
        f'<svg viewBox="0 0 {drawing.width} {drawing.height}" role="group" '
        f'aria-label="Points of the figure: arrow keys move from one to the next">{circles}</svg>'
    )
    hint = ' <span class="screen">Point at a mark for its numbers.</span>' if circles else ""
    image = _image(drawing, one.caption)
    caption = f"<figcaption>{inline(one.caption)}{hint}</figcaption>"
    paper = f'<div class="paper" data-ways="{json.dumps(drawing.ways)}">'
    return f"<figure>{paper}{image}{over if circles else ''}</div>{caption}</figure>"


def _view(one: View) -> str:
    inside = f'title="{escape(one.caption)}" srcdoc="{escape(one.html())}"'
    frame = f'<iframe sandbox="allow-scripts" {inside}></iframe>'
    return f"<figure>{frame}<figcaption>{inline(one.caption)}</figcaption></figure>"


def _image(one: draw.Drawing, alt: str) -> str:
    source = base64.b64encode(one.svg.encode()).decode()
    size = f'width="{one.width * 4 / 3:.1f}" height="{one.height * 4 / 3:.1f}"'
    return f'<img src="data:image/svg+xml;base64,{source}" alt="{escape(alt)}" {size}>'


def inline(text: str, *, has_code: bool = True) -> str:
    """Return a text, escaped, with its code and symbols marked."""
    parts = []
    for kind, part in spans(text):
        if kind == "symbol":
            stem, _, index = part.partition("_")
            below = f"<sub>{escape(GREEK.get(index, index))}</sub>" if index else ""
            parts.append(f"<i>{escape(GREEK.get(stem, stem))}</i>{below}")
        else:
            parts.append(f"<code>{escape(part)}</code>" if kind == "code" and has_code else escape(part))
    return "".join(parts)


def _id(text: str) -> str:
    return "-".join("".join(c if c.isalnum() else " " for c in text.lower()).split())
