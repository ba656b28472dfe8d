"""The table of verbs, in the order of the chain. To add a verb, add an entry."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from separatrix.cli.sweeping import write_tables

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from separatrix.runner import Runner
    from separatrix.study import Study


class Draw(Protocol):
    """Writes further files of a dataset into a folder."""

    def __call__(self, data: xr.Dataset, folder: Path, *, quiet: bool) -> None:
        """Write them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question: its name and its line of help.

    The function of that name in `separatrix.verbs` computes its record. `needs` are the sections of a study
    that may be left out but not for this question. `keeps_runs` is for an answer whose runs are kept in its
    folder as they are finished; `draw` is for moving pictures and tables beside the figures; `has_workbook`
    for an answer that is also written as a workbook.
    """

    name: str
    help: str
    needs: tuple[str, ...] = ()
    writes_files: bool = True
    keeps_runs: bool = False
    draw: Draw | None = None
    has_workbook: bool = False

    def compute(self, study: Study, runner: Runner, question: Mapping[str, Any]) -> Any:
        """Record of the answer; what computes it is imported when it is asked."""
        function = getattr(importlib.import_module("separatrix.verbs"), self.name)
        return function(study, runner, **question) if self.keeps_runs else function(study, **question)


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study; show what was understood and from where.",
        writes_files=False,
    ),
    Verb(
        name="bearing",
        help="Ball loads, contact angles, speeds and contacts.",
    ),
    Verb(
        name="traction",
        help="Traction curves of ball on race, and their slopes.",
    ),
    Verb(
        name="restitution",
        help="Restitution factor of a ball/cage impact.",
        needs=("cage",),
    ),
    Verb(
        name="stability",
        help="Critical friction against restitution factor.",
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="map",
        help="Where the cage is stable in the plane of two parameters.",
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="simulate",
        help="Follow one run of the cage in the bearing plane.",
        needs=("cage",),
    ),
    Verb(
        name="rank",
        help="Rank the cage materials: verdict, margin, reason.",
        keeps_runs=True,
        has_workbook=True,
        needs=("cage", "ranking"),
    ),
    Verb(
        name="sensitivity",
        help="Verdicts over uncertain inputs, and what to test next.",
        needs=("cage", "ranking"),
        keeps_runs=True,
    ),
    Verb(
        name="sweep",
        help="Chain and verdict of many cases: one table.",
        keeps_runs=True,
        draw=write_tables,
    ),
)
