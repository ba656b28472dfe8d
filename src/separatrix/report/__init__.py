"""Answers as text that an engineer reads in a terminal of 80 to 100 columns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from separatrix.report.cage import simulate, stability
from separatrix.report.chain import bearing, restitution, traction
from separatrix.report.map import stability_map
from separatrix.report.ranking import rank
from separatrix.report.study import check
from separatrix.report.tables import heading, paragraph

REPORTS: Mapping[str, Callable[[Mapping[str, Any]], list[str]]] = {
    "check": check,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "stability": stability,
    "map": stability_map,
    "simulate": simulate,
    "rank": rank,
}


def report(verb: str, document: Mapping[str, Any], *, where: str | None) -> str:
    """Return the answer as text, ASCII but for what the study says.

    Parameters
    ----------
    verb : str
        The question.
    document : mapping
        What `results.document` returns.
    where : str or None
        Folder of the figures and the dataset, if they are written.
    """
    blocks = [heading(document["title"]), *REPORTS[verb](document)]
    blocks += [paragraph(note, first="Note: ", indent="      ") for note in document["warnings"]]
    if where is not None:
        blocks.append(_where(verb, document, where))
    return "\n\n".join(blocks) + "\n"


def _where(verb: str, document: Mapping[str, Any], folder: str) -> str:
    """Return where the files are, and for a ranking which picture to open first."""
    if verb == "check":
        return f"This text and the document are in {folder}/"
    first = verb == "rank" and document["complete"]
    return f"Figures and data are in {folder}/" + (" (begin with rank-overview.png)" if first else "")
