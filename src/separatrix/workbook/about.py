"""Sheet of what made an answer: program, study, seed, runs, and what was said on the way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from separatrix.workbook_looks import WRAPPED, Look, add_sheet, headings, put, widths

if TYPE_CHECKING:
    from openpyxl import Workbook


def add(book: Workbook, document: Mapping[str, Any]) -> None:
    """Add the sheet."""
    sheet = add_sheet(book, "about")
    headings(sheet, ("about this answer", ""))
    for number, (name, value) in enumerate(_facts(document), 2):
        put(sheet, number, 1, name, Look(bold=True))
        put(sheet, number, 2, value, WRAPPED)
    widths(sheet, 44, 100)


def _facts(document: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
    yield "title", document["title"]
    yield "study", document["name"]
    yield "program", f"separatrix {document['separatrix_version']}, {document['verb']}"
    yield "seed", document["seed"]
    yield "runs of each candidate from each kick", document["runs"]
    yield "duration of a run (s)", document["duration"]
    yield "kicks (m/s)", "; ".join(map(str, document["kicks"]))
    yield "complete", document["complete"]
    yield "restitution factor of the bearing (-)", document["restitution_factor"]
    yield "the same with the ball's spin free (-)", document["restitution_factor_free_spin"]
    yield "pocket stiffness (N/um)", document["ball_cage_stiffness"] * 1e-6
    yield "stiffness", document["chain"].get("stiffness_source")
    pocket = document["pocket"]
    yield "sliding speed of ball on pocket (m/s)", pocket["slip_speed"]
    yield "mean pressure of ball on pocket (MPa)", pocket["pressure"] * 1e-6
    yield "paper", document["paper_statement"]
    yield from (("note", sentence) for sentence in document["warnings"])
    yield "units", "Units are in the headings; the sheet of inputs is in SI, angles in rad."
    yield "text", "A text that a spreadsheet program could take for a formula begins with an apostrophe."
