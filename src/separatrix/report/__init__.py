"""Answers as text that an engineer reads in a terminal of 80 to 100 columns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from separatrix.report.cage import simulate, stability
from separatrix.report.chain import bearing, restitution, traction
from separatrix.report.map import stability_map
from separatrix.report.ranking import only_table, rank
from separatrix.report.ranking_full import every_environment
from separatrix.report.sensitivity import sensitivity
from separatrix.report.study import at_their_means, check, every_input
from separatrix.report.sweep import sweep
from separatrix.report.tables import heading, paragraph

Parts = Callable[[Mapping[str, Any]], list[str]]

REPORTS: Mapping[str, Parts] = {
    "check": check,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "stability": stability,
    "map": stability_map,
    "simulate": simulate,
    "rank": rank,
    "sensitivity": sensitivity,
    "sweep": sweep,
}

FULL: Mapping[str, Callable[[Mapping[str, Any]], list[str]]] = {
    "check": every_input,
    "rank": every_environment,
}
"""Of verbs whose answer has more than a screen takes: all of it."""

QUIET: Mapping[str, Parts] = {"rank": only_table}
"""Of verbs whose answer can be put shorter: what `--quiet` leaves."""

DRAWS = ("check", "rank", "sensitivity")
"""Verbs that show uncertain inputs as what they are."""


def report(verb: str, document: Mapping[str, Any], *, full: bool = False, quiet: bool = False) -> str:
    """Return the answer as text, ASCII but for what the study says.

    Parameters
    ----------
    verb : str
        The question.
    document : mapping
        What `results.document` returns.
    full : bool
        Everything, where the answer has more than a screen takes.
    quiet : bool
        The answer alone, without notes, where it can be put so.
    """
    if quiet and not full and verb in QUIET:
        return "\n\n".join(QUIET[verb](document)) + "\n"
    parts = FULL.get(verb, REPORTS[verb]) if full else REPORTS[verb]
    blocks = [heading(document["title"]), *parts(document)]
    notes = [*_means(verb, document), *document["warnings"]]
    if notes:
        blocks.append("\n".join(paragraph(note, first="Note: ", indent="      ") for note in notes))
    return "\n\n".join(blocks) + "\n"


def _means(verb: str, document: Mapping[str, Any]) -> list[str]:
    """Return that uncertain inputs stand at their means, for a verb that does not draw them."""
    uncertain = document.get("study", {}).get("uncertain_inputs")
    return [at_their_means(uncertain)] if uncertain and verb not in DRAWS else []


def whereabouts(verb: str, document: Mapping[str, Any], folder: str) -> str:
    """Return where the files are, and for a ranking which picture to open first."""
    if verb == "check":
        return f"This text and the document are in {folder}/\n"
    first = verb == "rank" and document["complete"]
    return f"Figures and data are in {folder}/" + (" (begin with rank-overview.png)" if first else "") + "\n"
