"""The table of verbs, in the order of the chain. To add a verb, add an entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from separatrix.cli import answers, mapping, sensitivity, sweeping

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

    from separatrix.study import Study


class Draw(Protocol):
    """Writes further files of a dataset into a folder."""

    def __call__(self, data: xr.Dataset, folder: Path, *, quiet: bool) -> None:
        """Write them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question: its name, its line of help, and what computes its record.

    `needs` are the sections of a study that may be left out but not for this question. How the record is
    shown is in `separatrix.present` and, under the same name, in `separatrix.figures`.
    `keeps_runs` is for an answer whose runs are kept in its folder as they are finished; `draw` is for
    moving pictures and tables beside the figures; `has_workbook` for an answer that is also written as a
    workbook; `has_more` for one that is longer than a screen, and has an option for all of it.
    """

    name: str
    help: str
    compute: Callable[[Study, answers.Work], Any]
    needs: tuple[str, ...] = ()
    writes_files: bool = True
    keeps_runs: bool = False
    draw: Draw | None = None
    has_workbook: bool = False
    has_more: bool = False


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study; show what was understood and from where.",
        compute=answers.check,
        writes_files=False,
        has_more=True,
    ),
    Verb(
        name="bearing",
        help="Ball loads, contact angles, speeds and contacts.",
        compute=answers.bearing,
    ),
    Verb(
        name="traction",
        help="Traction curves of ball on race, and their slopes.",
        compute=answers.traction,
    ),
    Verb(
        name="restitution",
        help="Restitution factor of a ball/cage impact.",
        compute=answers.restitution,
        needs=("cage",),
    ),
    Verb(
        name="stability",
        help="Critical friction against restitution factor.",
        compute=answers.stability,
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="map",
        help="Where the cage is stable in the plane of two parameters.",
        compute=mapping.whole_map,
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="simulate",
        help="Follow one run of the cage in the bearing plane.",
        compute=answers.simulate,
        needs=("cage",),
    ),
    Verb(
        name="rank",
        help="Rank the cage materials: verdict, margin, reason.",
        compute=answers.rank,
        keeps_runs=True,
        has_workbook=True,
        has_more=True,
        needs=("cage", "ranking"),
    ),
    Verb(
        name="sensitivity",
        help="Verdicts over uncertain inputs, and what to test next.",
        compute=sensitivity.sensitivity,
        needs=("cage", "ranking"),
        keeps_runs=True,
    ),
    Verb(
        name="sweep",
        help="Chain and verdict of many cases: one table.",
        compute=sweeping.SweepOptions().compute,
        keeps_runs=True,
        draw=sweeping.write_tables,
    ),
)
