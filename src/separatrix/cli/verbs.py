"""The table of verbs, in the order of the chain. To add a verb, add an entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from separatrix.study import Study


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """How the computing is to be done: threads, and whom to tell how far it is."""

    jobs: int
    progress: Callable[[int, int], None] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question: its name, its line of help, and what computes its record.

    `compute` imports what it needs when it is called, so that the help is quick. A name in
    `separatrix.results`, `separatrix.report` and `separatrix.figures` tells how the record is shown.
    """

    name: str
    help: str
    compute: Callable[[Study, Work], Any]
    writes_files: bool = True


def _check(study: Study, work: Work) -> Any:  # noqa: ARG001 - every verb has this signature
    return {}


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study and show what was understood, with the source of each number.",
        compute=_check,
        writes_files=False,
    ),
)
