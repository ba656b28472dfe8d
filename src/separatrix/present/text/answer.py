"""The text of each verb, and where its files are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from separatrix.present.shapes import all_notes
from separatrix.present.text.cage import simulate
from separatrix.present.text.chain import bearing, mobility, restitution, traction
from separatrix.present.text.ranking import every_environment, only_table, rank
from separatrix.present.text.sensitivity import sensitivity
from separatrix.present.text.stability import stability, stability_map, sweep
from separatrix.present.text.study import at_their_means, check, every_input
from separatrix.present.text.tables import heading, paragraph

if TYPE_CHECKING:
    from separatrix.study import Study


Parts = Callable[..., list[str]]
"""Blocks of text of an answer, whose type belongs to the verb, to a study."""

REPORTS: Mapping[str, Parts] = {
    "check": check,
    "bearing": bearing,
    "traction": traction,
    "restitution": restitution,
    "mobility": mobility,
    "stability": stability,
    "map": stability_map,
    "simulate": simulate,
    "rank": rank,
    "sensitivity": sensitivity,
    "sweep": sweep,
}

FULL: Mapping[str, Parts] = {"check": every_input, "rank": every_environment}
"""Of verbs whose answer is longer than a screen: all of it."""

QUIET: Mapping[str, Parts] = {"rank": only_table}
"""Of verbs whose answer can be shorter: what `--quiet` leaves."""

DRAWS = ("check", "rank", "sensitivity")
"""Verbs that show uncertain inputs as what they are."""


def in_words(
    verb: str, answer: object, study: Study, notes: Sequence[str], *, full: bool = False, quiet: bool = False
) -> str:
    """Return the answer as text, ASCII but for names in the study.

    Parameters
    ----------
    verb, answer, study, notes
        As for `document`.
    full : bool
        Everything, where the answer is longer than a screen.
    quiet : bool
        The answer alone, without notes, where it can be shorter.
    """
    if quiet and not full and verb in QUIET:
        return "\n\n".join(QUIET[verb](answer, study)) + "\n"
    parts = FULL.get(verb, REPORTS[verb]) if full else REPORTS[verb]
    blocks = [heading(study.title), *parts(answer, study)]
    means = [at_their_means([*study.distributions])] if study.distributions and verb not in DRAWS else []
    lines = [paragraph(note, first="Note: ", indent="      ") for note in (*means, *all_notes(answer, notes))]
    return "\n\n".join([*blocks, *(["\n".join(lines)] if lines else [])]) + "\n"


def whereabouts(verb: str, folder: str, *, overview: bool = False) -> str:
    """Return where the files are, and for a finished ranking which picture to open first."""
    if verb == "check":
        return f"This text and the document are in {folder}/\n"
    return (
        f"Figures and data are in {folder}/" + (" (begin with rank-overview.png)" if overview else "") + "\n"
    )
