"""A report as one HTML file that needs nothing else: no network, no other file."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from separatrix.messages import harmless
from separatrix.reporting.record import Picture, Report, Table

SHORT = 24
"""Letters of a name that stays on one line."""

ANSWERS = "separatrix-answers"
"""Identifier of the element that has the documents of the answers: {verb: document}."""


@cache
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("separatrix.reporting"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["embedded"] = embedded
    environment.filters["written"] = written
    environment.filters["css_text"] = css_text
    environment.filters["short"] = short
    environment.filters["kind"] = lambda block: type(block).__name__
    return environment.get_template("report.html")


def html(report: Report) -> str:
    """Return a report as HTML; every text in it is escaped, and its pictures can run nothing."""
    return harmless(
        _template().render(report=report, answers=script_data(report.documents), answers_id=ANSWERS)
    )


def written(text: str) -> Markup:
    """Return a text with what is between backticks as code; all of it is escaped."""
    parts = text.split("`")
    return Markup("").join(
        Markup("<code>{}</code>").format(one) if place % 2 else one for place, one in enumerate(parts)
    )


def css_text(text: str) -> str:
    """Return a text as it may stand between quotes in a style sheet: letters, digits and escapes."""
    return "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text)


def short(table: Table) -> bool:
    """Whether the texts at the left of a table need no second line."""
    return all(len(text) <= SHORT for row in table.rows for text in row[: table.left])


def embedded(picture: Picture) -> str:
    """Return a picture as the address of an image that holds it."""
    return "data:image/svg+xml;base64," + base64.b64encode(picture.svg.encode()).decode()


def script_data(documents: Mapping[str, Mapping[str, Any]]) -> str:
    """Return documents as JSON that cannot end the script element around it."""
    text = json.dumps(documents, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
