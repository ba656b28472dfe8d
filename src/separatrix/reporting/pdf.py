"""A report as PDF, set by typst from the same record as the HTML."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib.resources import files
from typing import Any

from separatrix.errors import InputError
from separatrix.reporting.record import Block, Picture, Report


def typesetter() -> Any:
    """Return typst's module; without the extra `pdf` it is refused."""
    try:
        import typst
    except ImportError as error:
        cure = 'Install it: pip install "separatrix[pdf]". Without --pdf the report is HTML.'
        raise InputError("--pdf", "needs the extra pdf", cure=cure) from error
    return typst


def pdf(report: Report) -> bytes:
    """Return a report as PDF; its texts go to typst as data, none is read as markup."""
    sections = [
        {"title": one.title, "level": one.level, "blocks": [_block(block) for block in one.blocks]}
        for one in report.sections
    ]
    content = {"title": report.title, "subtitle": report.subtitle, "sections": sections}
    template = files("separatrix.reporting").joinpath("templates", "report.typ").read_bytes()
    made = typesetter().compile(
        template, sys_inputs={"report": json.dumps(content)}, ignore_system_fonts=True
    )
    return bytes(made)


def _block(block: Block) -> dict[str, Any]:
    plain = {**asdict(block), "block": type(block).__name__}
    if isinstance(block, Picture):
        del plain["hover"]
    return plain
