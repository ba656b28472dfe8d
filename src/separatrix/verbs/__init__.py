"""The table of verbs, in the order of the chain, and how one is answered. To add a verb, add an entry."""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from separatrix.ground.errors import InputError
from separatrix.ground.units import shown

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class Verb:
    """A question: its name and its line of help.

    The function of that name in `separatrix.verbs` computes its record from the options in `question`.
    `needs` are the sections of a study that may be left out but not for this question. `keeps_runs` is for
    an answer whose runs are kept in its folder as they are finished, and may be made on a cluster.
    `moves_a_cage` is for one whose models of motion and ball may be chosen.
    """

    name: str
    help: str
    needs: tuple[str, ...] = ()
    epilog: str | None = None
    question: tuple[str, ...] = ()
    moves_a_cage: bool = False
    has_full: bool = False
    writes_files: bool = True
    keeps_runs: bool = False

    @property
    def options(self) -> tuple[str, ...]:
        """Names of what its command takes, in order."""
        full, cluster = ("full",) * self.has_full, ("cluster",) * self.keeps_runs
        models = ("motion", "ball") * self.moves_a_cage
        return ("study", *self.question, *models, *full, "json", "out", "quiet", "jobs", *cluster)


VERBS: tuple[Verb, ...] = (
    Verb(
        name="check",
        help="Read a study; show what was understood and from where.",
        has_full=True,
        writes_files=False,
    ),
    Verb(name="bearing", help="Ball loads, contact angles, speeds and contacts."),
    Verb(name="traction", help="Traction curves of ball on race, and their slopes."),
    Verb(name="restitution", help="Restitution factor of a ball/cage impact.", needs=("cage",)),
    Verb(
        name="mobility",
        help="Resistance of the races to a ball that is pushed along its orbit.",
        epilog="Rates, dampings and effective mass of the most loaded ball, its law of traction F(u) with "
        "the capacity of the races.",
    ),
    Verb(
        name="stability",
        help="Critical friction against restitution factor.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="Beside the curve: its sub-critical band, each kick's own curve, the linear limit, and the "
        "critical friction at the bearing's own restitution factor.",
        keeps_runs=True,
    ),
    Verb(
        name="map",
        help="Where the cage is stable in the plane of two parameters.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="An axis is a numeric key of the study file with its section, or restitution_factor, "
        "ball_cage_friction, kick: --x cage.pocket_clearance=0.1..1mm --y film.race_friction="
        "0.02..0.3:40:log. Finished runs are kept in the folder of the answer: after Ctrl-C run the same "
        "command to resume. With --json and no --out nothing is kept.",
        question=("x", "y", "points", "runs", "kick", "adaptive"),
        keeps_runs=True,
    ),
    Verb(
        name="simulate",
        help="Follow one run of the cage, in the plane or in space.",
        needs=("cage",),
        moves_a_cage=True,
        epilog="An unresolved run states its reason.",
        question=("kick", "run", "restitution_factor", "animate"),
    ),
    Verb(
        name="rank",
        help="Rank the cage materials: verdict, margin, reason.",
        needs=("cage", "ranking"),
        moves_a_cage=True,
        has_full=True,
        keeps_runs=True,
    ),
    Verb(
        name="sensitivity",
        help="Verdicts over uncertain inputs, and what to test next.",
        needs=("cage", "ranking"),
        moves_a_cage=True,
        epilog="Every number that the study writes with a distribution is drawn, and the frictions with "
        "their scatter: 9 % of the mean where none was measured, a guess.",
        question=("samples",),
        keeps_runs=True,
    ),
    Verb(
        name="sweep",
        help="Chain and verdict of many cases: one table.",
        moves_a_cage=True,
        epilog="Every value of one --vary goes with every value of the others. A case that is refused is a "
        "row with its reason. The table is sweep.csv, sweep.xlsx and sweep.nc in the folder of the answer: "
        '--vary "film.thickness=0.2..2um:10:log" --vary bearing.contact_angle=15..25deg:11.',
        question=("vary", "cases", "verdicts", "margins"),
        keeps_runs=True,
    ),
)


def verb_named(name: str) -> Verb:
    """Return a verb of the table; another name is refused."""
    found = next((verb for verb in VERBS if verb.name == name), None)
    if found is None:
        raise InputError("verb", "is not known", got=shown(name))
    return found


def asked_study(verb: Verb, study: str | Path, models: Mapping[str, str]) -> Study:
    """Return the study of a file or a shipped name, with other models of its cage if there are any.

    Raises
    ------
    InputError
        The file is wrong, lacks a section that the verb needs, or cannot have these models.
    """
    from separatrix.study.reading import read_study, require

    found = read_study(study, models)
    require(found, verb.name, *verb.needs)
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Computed:
    """The record of an answer, whether it is complete, and the number of runs kept by an earlier call.

    `question` has the options as they were answered, for the provenance.
    """

    record: Any
    study: Study
    question: Mapping[str, object]
    is_complete: bool
    runs_taken: int = 0


def computed(
    verb: Verb,
    study: Study,
    question: Mapping[str, object],
    *,
    jobs: int | None = None,
    folder: str | Path | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> Computed:
    """Answer a verb, or return the part that was finished before an interrupt.

    Parameters
    ----------
    verb, study : Verb, Study
        What is asked, of which study.
    question : mapping
        Options of the verb alone, by the names of its function in `separatrix.verbs`.
    jobs, folder, cluster, progress
        Of a verb that keeps runs: threads, by default one for each processor; where finished runs are kept;
        address of a Dask scheduler, or ``local:N``, that makes them; called with (done, total).

    Raises
    ------
    SeparatrixError
        Wrong input.
    Interrupted
        Before anything was finished.
    """
    from separatrix.verdict.cluster import cluster as connected
    from separatrix.verdict.ledger import NAME, Ledger
    from separatrix.verdict.long_jobs import Interrupted, Runner
    from separatrix.verdict.parameter_axes import asked_cases

    module, threads, is_complete = (
        importlib.import_module(f"separatrix.verbs.{verb.name}"),
        jobs or processors(),
        True,
    )
    function = module.compute
    if hasattr(module, "VERB"):  # its options are a record

        def function(study: Study, *runner: Runner, **options: Any) -> Any:
            return module.compute(study, module.VERB.options(**options), *runner)

    if isinstance(table := question.get("cases"), Path):
        question = {
            **question,
            "cases": asked_cases(cast("Sequence[str]", question.get("vary") or ()), table),
        }
    ledger: Ledger | None = None
    executor: Executor | None = None
    with contextlib.ExitStack() as stack:
        if not verb.keeps_runs:
            record = function(study, **question)
        else:
            if folder is not None:
                Path(folder).mkdir(parents=True, exist_ok=True)
                ledger = stack.enter_context(contextlib.closing(Ledger(Path(folder) / NAME)))
            if cluster is not None:
                executor, threads = stack.enter_context(connected(cluster))
            try:
                runner = Runner(jobs=threads, progress=progress, ledger=ledger, executor=executor)
                record = function(study, runner, **question)
            except Interrupted as stop:
                if stop.finished is None:
                    raise
                record, is_complete = stop.finished, False
    taken = 0 if ledger is None else ledger.taken
    return Computed(record=record, study=study, question=question, is_complete=is_complete, runs_taken=taken)


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
