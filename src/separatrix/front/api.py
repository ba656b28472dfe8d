"""The verbs as Python functions: each takes a study and returns an `Answer`, as the command line gives it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar, Unpack

from separatrix.ground.plain_data import Document
from separatrix.ground.units import MetrePerSecond, Ratio
from separatrix.present.blocks import Level, Page
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.study.study import Study
from separatrix.verbs import asked_study, computed, tool_named, verb_named
from separatrix.verbs import tribometer as logs
from separatrix.verbs.answer_files import (
    document,
    notes_of,
    page_of_document,
    read_answer,
    read_answers,
    refusing_damage,
)
from separatrix.verbs.compare import compared
from separatrix.verbs.materials import LIST, SHOW
from separatrix.verbs.report import Report, report_of_study
from separatrix.verdict.long_jobs import Interrupted, Progress
from separatrix.verdict.parameter_axes import DEFAULT_X, DEFAULT_Y, Case

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from separatrix.chain.contacts import BearingState
    from separatrix.friction.logs.column_map import ColumnMap
    from separatrix.verbs import cage_answers as of_cage
    from separatrix.verbs import chain_answers as of_chain
    from separatrix.verbs.verb import Tool, Verb
    from separatrix.verdict.swept_cases import Sweep

Record = TypeVar("Record")

# A study, the path of its file, or the name of a shipped one.
Asked = Study | str | Path


class Runs(TypedDict, total=False):
    """How a verb makes its many runs; `stability` explains them."""

    jobs: int | None
    folder: str | Path | None
    cluster: str | None
    progress: Progress | None


@dataclass(frozen=True, kw_only=True)
class ToolAnswer(Generic[Record]):
    """What a tool answers; the names of its record are its own, too, or those of its document without one."""

    asked: Verb | Tool = field(repr=False)
    record: Record = field(repr=False)
    made: Callable[[], Document] = field(repr=False)

    @cached_property
    def _document(self) -> Document:
        return self.made()

    def document(self) -> Document:
        """Plain data, as ``--json`` prints it: SI units, None where something is absent."""
        return self._document

    def page(self) -> Page:
        """Page of blocks: what text, report, workbook and local page show."""
        return page_of_document(self.asked, self.document())

    def summary(self, *, full: bool = False) -> str:
        """Text, as the command line prints it; `full` is all of it where that is longer than a screen."""
        return text(self.page(), Level.FULL if full else Level.BRIEF)

    def _repr_html_(self) -> str:
        """The page, as a notebook shows it."""
        from separatrix.present.html import html

        return html(self.page())

    def plot(self, name: str | None = None) -> Figure:
        """Return the first figure of the answer, or the one whose file has this name."""
        from separatrix.present.draw import plot

        return plot(self.page(), name)

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each test, record or result."""
        import pandas as pd

        return pd.json_normalize(self.document()[self.asked.rows])

    def __getattr__(self, name: str) -> Any:
        """Name of the record; of an answer without one, of its document."""
        if name.startswith("_") or (self.record is None and name not in self.document()):
            raise AttributeError(name)
        return self.document()[name] if self.record is None else getattr(self.record, name)


@dataclass(frozen=True, kw_only=True)
class Answer(ToolAnswer[Record]):
    """What a verb answers to a study; the names of its record are its own, too.

    `record` was computed for `study`; `notes` are about where a model leaves its range.
    """

    study: Study

    @property
    def verb(self) -> str:
        """Name of the verb."""
        return self.asked.name

    def __repr__(self) -> str:
        """Verb and study; `summary` has the answer."""
        return f"<{self.verb} of {self.study.name}: summary(), to_dataframe(), to_xarray(), plot()>"

    @property
    def notes(self) -> tuple[str, ...]:
        """Where a model leaves its range, a sentence each."""
        return notes_of(self.record, self.study)

    def to_xarray(self) -> xr.Dataset:
        """Labelled arrays with their units, as they are saved in netCDF files."""
        from separatrix.present.dataset import dataset

        return dataset(self.document())

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each ball, point, material or case."""
        from separatrix.present.dataset import main_table

        return main_table(self.to_xarray())


def _answer(name: str, study: Asked, options: dict[str, Any] | None = None, **how: Any) -> Answer[Any]:
    """Answer of a verb; `how` is as for `computed`."""
    verb = verb_named(name)
    asked = asked_study(verb, study)
    found = computed(verb, asked, verb.options(**(options or {})), **how)
    answer = Answer(asked=verb, record=found.record, study=asked, made=partial(document, verb, found))
    if not found.is_complete:
        raise Interrupted(answer)
    return answer


def check(study: Asked) -> Answer[of_chain.CheckAnswer]:
    """Inputs of a study with their sources, and the bearing at standstill."""
    return _answer("check", study)


def bearing(study: Asked) -> Answer[BearingState]:
    """Ball equilibrium, and the contacts of the most loaded ball."""
    return _answer("bearing", study)


def traction(study: Asked) -> Answer[of_chain.TractionAnswer]:
    """Traction curves of ball on race, and their slopes."""
    return _answer("traction", study)


def restitution(study: Asked) -> Answer[of_chain.RestitutionAnswer]:
    """Restitution factor of an impact of ball and cage."""
    return _answer("restitution", study)


def mobility(study: Asked) -> Answer[of_chain.MobilityAnswer]:
    """How the races let a ball be pushed along its orbit, and what the cage's impacts return."""
    return _answer("mobility", study)


def simulate(
    study: Asked,
    *,
    kick: str | MetrePerSecond | None = None,
    run: int = 0,
    restitution_factor: str | Ratio | None = None,
) -> Answer[of_cage.SimulationAnswer]:
    """One run of the cage, from an initial disturbance in text with a unit or [m/s]."""
    question = {"kick": kick, "run": run, "restitution_factor": restitution_factor}
    return _answer("simulate", study, question)


def stability(study: Asked, **how: Unpack[Runs]) -> Answer[of_cage.StabilityAnswer]:
    """Critical friction against restitution factor.

    Parameters
    ----------
    study : Study, str or Path
        A study, the path of its file, or the name of a shipped one.
    **how
        `jobs`, threads, by default one for each processor; the numbers do not depend on it. `folder`, where
        finished runs are kept: a later call takes them from there. `cluster`, address of a Dask scheduler,
        or ``"local:N"`` for N processes here. `progress`, called with (done, total) points.

    Raises
    ------
    InputError
        The study, or one of these arguments, is wrong.
    Interrupted
        With the answer made of what was finished.
    """
    return _answer("stability", study, **how)


def map(
    study: Asked,
    x: str = DEFAULT_X,
    y: str = DEFAULT_Y,
    *,
    points: int = 100,
    runs: int = 16,
    kick: str | MetrePerSecond | None = None,
    **how: Unpack[Runs],
) -> Answer[of_cage.MapAnswer]:
    """Where the cage is stable in the plane of two parameters: see `stability` for the rest."""
    question = {"x": x, "y": y, "points": points, "runs": runs, "kick": kick}
    return _answer("map", study, question, **how)


def rank(study: Asked, **how: Unpack[Runs]) -> Answer[of_cage.RankingAnswer]:
    """Verdict, margin, rank and reason of each candidate material; parameters as of `stability`."""
    return _answer("rank", study, **how)


def sensitivity(
    study: Asked, *, samples: int = 512, **how: Unpack[Runs]
) -> Answer[of_cage.SensitivityAnswer]:
    """Verdicts over the uncertain inputs, with `samples` bearings drawn; the rest as in `stability`."""
    return _answer("sensitivity", study, {"samples": samples}, **how)


def sweep(
    study: Asked,
    vary: str | Sequence[str] = (),
    *,
    cases: Path | Sequence[Case] | None = None,
    verdicts: bool = False,
    margins: bool = False,
    **how: Unpack[Runs],
) -> Answer[Sweep]:
    """Chain and verdict of many cases: see `stability` for the other parameters."""
    ranges = (vary,) if isinstance(vary, str) else tuple(vary)
    question = {"vary": ranges, "cases": cases, "verdicts": verdicts, "margins": margins}
    return _answer("sweep", study, question, **how)


def life(
    study: Asked,
    *,
    revolutions: float = 1e9,
    samples: int = 4096,
    cases: Path | Sequence[Case] | None = None,
    accelerated: str | float | None = None,
    **how: Unpack[Runs],
) -> Answer[of_cage.LifeAnswer]:
    """When the cage becomes unstable, of `samples` bearings up to `revolutions`; the rest as `stability`.

    `cases` are a duty cycle, as those of `sweep`; `accelerated` is the speed of the inner ring in a test.
    """
    asked = {"revolutions": revolutions, "samples": samples, "accelerated": accelerated}
    return _answer("life", study, {**asked, "cases": cases}, **how)


def compare(first: Answer[Any] | str | Path, second: Answer[Any] | str | Path) -> ToolAnswer[Any]:
    """Two answers of one verb: what differs, and whether by more than counting noise.

    Parameters
    ----------
    first, second : Answer, str or Path
        An answer, or the folder or file of a saved one.

    Raises
    ------
    InputError
        One of them is not an answer, or they are of different verbs.
    """
    sides = [
        {one.verb: one.document()} if isinstance(one, Answer) else read_answers(Path(one))
        for one in (first, second)
    ]
    names = [one.study.name if isinstance(one, Answer) else str(one) for one in (first, second)]
    return _of_tool(tool_named("compare"), compared(*sides, names=(names[0], names[1])))


def _of_tool(tool: Tool, found: Document, record: Any = None) -> ToolAnswer[Any]:
    return ToolAnswer(asked=tool, record=record, made=partial(dict, found))


def load(path: str | Path) -> xr.Dataset:
    """Return a saved answer, the .json of a verb, as labelled arrays: those of `Answer.to_xarray`.

    Raises
    ------
    InputError
        The file is not an answer of separatrix, or is damaged.
    """
    from separatrix.present.dataset import dataset

    with refusing_damage(str(path)):
        return dataset(read_answer(Path(path)))


def tribometer(
    paths: str | Path | Sequence[str | Path],
    *,
    column_map: ColumnMap | str | Path | None = None,
    run_in: str | None = None,
    join: bool = False,
    complete: bool = False,
    jobs: int = 1,
    progress: Progress | None = None,
) -> ToolAnswer[Any]:
    """Read logs of tribometers and reduce each test to its steady friction.

    Parameters
    ----------
    paths : path or sequence of paths
        Logs, each of one or several tests, or folders of them.
    column_map : ColumnMap or path, optional
        What the files do not state themselves.
    run_in : str, optional
        Where running-in ends in all of them, such as ``"10 min"``; else as in the map, else as detected.
    join : bool
        Whether all logs of a folder are parts of one test.
    complete : bool
        Whether a test that a friction file cannot keep is refused.
    jobs : int
        Threads. The answer does not depend on it.
    progress : callable, optional
        Called with the steps done and their total.

    Raises
    ------
    InputError
        A file is wrong: the first one, and how many others are.
    """
    given: Any = Path(column_map) if isinstance(column_map, str) else column_map
    asked = tuple(Path(one) for one in ((paths,) if isinstance(paths, str | Path) else paths))
    options = logs.Options(files=asked, column_map=given, run_in=run_in, join=join)
    found = logs.reduced(options, jobs, progress, complete=complete)
    return _of_tool(logs.VERB, logs.document(found), found)


def materials(kind: str | None = None, *, libraries: Sequence[str | Path] = ()) -> ToolAnswer[Any]:
    """Records of the library: the shipped ones, those of the current folder, and those of `libraries`.

    Parameters
    ----------
    kind : str, optional
        Only ``"bearing material"``, ``"cage material"``, ``"film"``, ``"fluid"`` or ``"friction table"``.
    libraries : sequence of paths
        Library files, or folders of them, besides ``materials.toml`` and the folder ``materials``.

    Raises
    ------
    InputError
        A file is wrong or not there, or the kind is not one of these.
    """
    options = LIST.options(kind=kind, library=tuple(str(one) for one in libraries))
    return _of_tool(LIST, LIST.compute(options))


def material(name: str, *, kind: str | None = None, libraries: Sequence[str | Path] = ()) -> ToolAnswer[Any]:
    """Records of a name, whole."""
    options = SHOW.options(name=name, kind=kind, library=tuple(str(one) for one in libraries))
    return _of_tool(SHOW, SHOW.compute(options))


def report(study: Asked, **how: Unpack[Runs]) -> Report:
    """Everything on a study as one document; parameters are those of `stability`.

    Bearing, traction, restitution, simulate and rank (without [ranking]: stability) are computed for it.
    """
    asked = study if isinstance(study, Study) else read_study(study)
    found = report_of_study(asked, lambda verb: _answer(verb.name, asked, **how).document())
    if found is None:  # `_answer` has raised it with what was finished
        raise Interrupted
    return found
