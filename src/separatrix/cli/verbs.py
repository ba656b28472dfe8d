"""The table of verbs, in the order of the chain. To add a verb, add an entry."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from separatrix.cli.mapping import MapOptions
from separatrix.cli.sensitivity import SensitivityOptions
from separatrix.cli.simulating import SimulateOptions
from separatrix.cli.sweeping import SweepOptions, write_tables

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
    """A question: its name, its line of help, and what computes its record.

    `needs` are the sections of a study that may be left out but not for this question. How the record is
    shown stands under the same name in `separatrix.results`, `separatrix.report` and `separatrix.figures`.
    `keeps_runs` is for an answer whose runs are kept in its folder as they are finished; `draw` is for
    moving pictures and tables beside the figures; `has_workbook` for an answer that is also written as a
    workbook.
    """

    name: str
    help: str
    compute: Callable[[Study, Runner], Any]
    needs: tuple[str, ...] = ()
    writes_files: bool = True
    keeps_runs: bool = False
    draw: Draw | None = None
    has_workbook: bool = False


def _of_chain(name: str) -> Callable[[Study, Runner], Any]:
    """What answers a verb that runs no cage; imported when it is asked."""

    def compute(study: Study, runner: Runner) -> Any:  # noqa: ARG001
        return getattr(importlib.import_module("separatrix.verbs"), name)(study)

    return compute


def _long(name: str) -> Callable[[Study, Runner], Any]:
    """What answers a verb of many runs; imported when it is asked."""

    def compute(study: Study, runner: Runner) -> Any:
        return getattr(importlib.import_module("separatrix.verbs"), name)(study, runner)

    return compute


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study; show what was understood and from where.",
        compute=_of_chain("check"),
        writes_files=False,
    ),
    Verb(
        name="bearing",
        help="Ball loads, contact angles, speeds and contacts.",
        compute=_of_chain("bearing"),
    ),
    Verb(
        name="traction",
        help="Traction curves of ball on race, and their slopes.",
        compute=_of_chain("traction"),
    ),
    Verb(
        name="restitution",
        help="Restitution factor of a ball/cage impact.",
        compute=_of_chain("restitution"),
        needs=("cage",),
    ),
    Verb(
        name="stability",
        help="Critical friction against restitution factor.",
        compute=_long("stability"),
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="map",
        help="Where the cage is stable in the plane of two parameters.",
        compute=MapOptions().compute,
        needs=("cage",),
        keeps_runs=True,
    ),
    Verb(
        name="simulate",
        help="Follow one run of the cage in the bearing plane.",
        compute=SimulateOptions().compute,
        needs=("cage",),
    ),
    Verb(
        name="rank",
        help="Rank the cage materials: verdict, margin, reason.",
        compute=_long("rank"),
        keeps_runs=True,
        has_workbook=True,
        needs=("cage", "ranking"),
    ),
    Verb(
        name="sensitivity",
        help="Verdicts over uncertain inputs, and what to test next.",
        compute=SensitivityOptions().compute,
        needs=("cage", "ranking"),
        keeps_runs=True,
    ),
    Verb(
        name="sweep",
        help="Chain and verdict of many cases: one table.",
        compute=SweepOptions().compute,
        keeps_runs=True,
        draw=write_tables,
    ),
)
