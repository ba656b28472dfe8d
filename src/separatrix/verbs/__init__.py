"""The verbs by name, each in its own file, and how a question to a study is answered. The only registry."""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from separatrix.ground.errors import InputError
from separatrix.ground.units import shown
from separatrix.verbs.verb import Tool, Verb

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from separatrix.study.study import Study
    from separatrix.verdict.long_jobs import Progress

VERBS = {
    "check": "Read a study; show what was understood and from where.",
    "bearing": "Ball loads, contact angles, speeds and contacts.",
    "traction": "Traction curves of ball on race, and their slopes.",
    "restitution": "Restitution factor of a ball/cage impact.",
    "mobility": "Resistance of the races to a ball that is pushed along its orbit.",
    "stability": "Critical friction against restitution factor.",
    "map": "Where the cage is stable in the plane of two parameters.",
    "simulate": "Follow one run of the cage, in the plane or in space.",
    "rank": "Rank the cage materials: verdict, margin, reason.",
    "sensitivity": "Verdicts over uncertain inputs, and which input decides them.",
    "sweep": "Chain and verdict of many cases: one table.",
    "life": "When the cage becomes unstable as film and pockets wear.",
}
"""Modules of this package, each a question to a study, in the order of the chain -> its line of help."""

TOOLS = {
    "tribometer": "Friction with its scatter from raw logs of tests.",
    "compare": "Two answers of one verb side by side: what differs, and by more than counting noise?",
    "reproduce": "Compute a saved answer again, and report whether it is the same.",
}
"""Modules, each a question without a study of its own -> its line of help."""


def verb_named(name: str) -> Verb:
    """Return a verb by its name; another name is refused."""
    if name not in VERBS:
        raise InputError("verb", "is not known", got=shown(name), cure=f"Choose one of {', '.join(VERBS)}.")
    found: Verb = importlib.import_module(f"separatrix.verbs.{name}").VERB
    return found


def tool_named(name: str) -> Tool:
    """Return a tool by its name."""
    found: Tool = importlib.import_module(f"separatrix.verbs.{name}").VERB
    return found


def refusals(study: Study) -> Iterator[tuple[str, str]]:
    """Yield what each verb would refuse of a study, with the verb."""
    for name in VERBS:
        verb = verb_named(name)
        missing = [f"[{section}]" for section in verb.needs if getattr(study, section) is None]
        lacks = f"The study has no {' and no '.join(missing)}."
        yield from ((name, sentence) for sentence in ([lacks] if missing else verb.refusals(study)))


def asked_study(verb: Verb, study: Study | str | Path, model: str | None = None) -> Study:
    """Return a study, that of a file or of a shipped name, with another model of its cage if one is named.

    Raises
    ------
    InputError
        The file is wrong, lacks a section that the verb needs, or cannot have this model.
    """
    from separatrix.study.reading import read_study, require

    found = read_study(study, model) if isinstance(study, str | Path) else study
    require(found, verb.name, *verb.needs)
    return found


@dataclass(frozen=True, slots=True, kw_only=True)
class Computed:
    """The record of an answer, whether it is complete, and the number of runs kept by an earlier call."""

    record: Any
    study: Study
    options: Any
    is_complete: bool
    runs_taken: int = 0

    @property
    def question(self) -> dict[str, object]:
        """The options as they were answered, for the provenance."""
        return {one.name: getattr(self.options, one.name) for one in fields(self.options)}


def computed(
    verb: Verb,
    study: Study,
    options: Any = None,
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
    options : verb.options, optional
        By default those of the verb.
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
    asked = verb.options() if options is None else options
    if not verb.keeps_runs:
        return Computed(record=verb.compute(study, asked), study=study, options=asked, is_complete=True)
    from separatrix.verdict.cluster import cluster as connected
    from separatrix.verdict.long_jobs import NAME, Interrupted, Ledger, Runner

    threads, is_complete = jobs or processors(), True
    ledger: Ledger | None = None
    executor: Executor | None = None
    with contextlib.ExitStack() as stack:
        if folder is not None:
            Path(folder).mkdir(parents=True, exist_ok=True)
            ledger = stack.enter_context(contextlib.closing(Ledger(Path(folder) / NAME)))
        if cluster is not None:
            executor, threads = stack.enter_context(connected(cluster))
        try:
            runner = Runner(jobs=threads, progress=progress, ledger=ledger, executor=executor)
            record = verb.compute(study, asked, runner)
        except Interrupted as stop:
            if stop.finished is None:
                raise
            record, is_complete = stop.finished, False
    taken = ledger.taken if ledger is not None and ledger.goes_on else 0  # else by this call, twice asked
    return Computed(record=record, study=study, options=asked, is_complete=is_complete, runs_taken=taken)


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
