"""Logs of tribometers to friction tests and the fit to them: the verb `tribometer`."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from separatrix.friction.friction_file import CONDITIONS, FRICTION_LIMIT, NAMES, FrictionTest, Place, place
from separatrix.friction.friction_fit import FrictionFit, fit_friction
from separatrix.friction.logs import read_log
from separatrix.friction.logs.column_map import ColumnMap, Conditions, of_log, read_column_map
from separatrix.friction.logs.log import RawLog
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS
from separatrix.friction.reduction import RUN_IN_END, Reduction, TestFriction, reduction, with_outliers
from separatrix.ground.errors import InputError, together
from separatrix.ground.units import format_number, format_quantity, printable, unit_of

_T = TypeVar("_T")
_S = TypeVar("_S")
Progress = Callable[[int, int], None]  # called with the number of steps done and their total

OTHERS = frozenset(
    {".toml", ".md", ".json", ".nc", ".png", ".jpg", ".jpeg", ".pdf", ".py", ".svg", ".gif", ".docx"}
)
"""Suffixes of files in a folder that are not logs."""

MOST_FILES = 10_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReducedLogs:
    """What logs of tribometers show: each test, and the friction of each material from all of them."""

    reductions: tuple[Reduction, ...]
    """One for each test, with its log, its friction and the series behind it."""
    friction_tests: tuple[FrictionTest, ...] | None
    """The tests as a friction file keeps them; None where some do not state what slid on what."""
    fit: FrictionFit | None  # friction of each material over the conditions; None as above
    notes: tuple[str, ...] = ()  # what concerns all of them together

    @property
    def logs(self) -> list[RawLog]:
        """The log of each test."""
        return [one.log for one in self.reductions]

    @property
    def tests(self) -> list[TestFriction]:
        """Friction of each test."""
        return [one.test for one in self.reductions]


def tribometer(
    paths: Sequence[Path],
    *,
    column_map: ColumnMap | Path | None = None,
    run_in: str | None = None,
    join: bool = False,
    complete: bool = False,
    jobs: int = 1,
    progress: Progress | None = None,
) -> ReducedLogs:
    """Read logs of tribometers and reduce each test to its steady friction, as `separatrix.tribometer`."""
    files = _files(paths)
    chosen = read_column_map(column_map) if isinstance(column_map, Path) else column_map or ColumnMap()
    idle = chosen.unused(files)
    if idle and complete:
        raise together(idle)
    cut = None if run_in is None else place(run_in, RUN_IN_END)
    pool = ThreadPoolExecutor(jobs)
    try:
        logs = _each(pool, lambda path: read_log(path, chosen), files, progress, 0)
        tests = _tests_of(list(zip(files, logs, strict=True)), join=join)
        reduced = _each(pool, lambda test: _reduced(*test, chosen, cut), tests, progress, 500)
    finally:  # nothing new is begun once the work is interrupted
        pool.shutdown(wait=True, cancel_futures=True)
    reductions = with_outliers(reduced)
    friction_tests: list[FrictionTest] = []
    wrong: list[InputError] = []
    for one in reductions:
        try:
            friction_tests.append(friction_test(one.test))
        except InputError as error:
            wrong.append(error)
    if wrong and complete:
        raise _with_others(wrong)
    return ReducedLogs(
        reductions=tuple(reductions),
        friction_tests=None if wrong else tuple(friction_tests),
        fit=None if wrong else fit_friction(friction_tests),
        notes=tuple(f"{one} A friction file is not written with it." for one in idle),
    )


def _files(paths: Sequence[Path]) -> list[Path]:
    """The files named, and those in the folders named, in the order of their names and numbers."""
    found: list[Path] = []
    for path in paths:
        try:
            is_folder = path.is_dir()
        except OSError:
            is_folder = False  # `read_log` reports why
        if not is_folder:
            found.append(path)
            continue
        inside = [one for one in path.iterdir() if one.is_file() and not one.name.startswith(".")]
        logs = [one for one in inside if one.suffix.lower() not in OTHERS]
        if not logs:
            raise InputError(printable(str(path), 200), "is a folder without a log", cure="Name another.")
        found += sorted(logs, key=lambda one: in_order(one.name))
    if len(found) > MOST_FILES:
        raise InputError("FILES", f"must be at most {MOST_FILES}", str(len(found)))
    known: set[Path] = set()
    for path in found:
        if path.resolve() in known:
            raise InputError(printable(str(path), 200), "is named twice", cure="A test counts once.")
        known.add(path.resolve())
    return found


def _each(
    pool: ThreadPoolExecutor,
    work: Callable[[_S], _T],
    items: Sequence[_S],
    progress: Progress | None,
    start: float,
) -> list[_T]:
    """What the work returns for each item, in their order, or the refusal of the first that is wrong."""
    found: list[_T] = []
    wrong: list[InputError] = []
    for done, job in enumerate([pool.submit(work, item) for item in items], 1):
        try:
            found.append(job.result())
        except InputError as error:
            wrong.append(error)
        if progress is not None:
            progress(round(start + 500 * done / len(items)), 1000)
    if wrong:
        raise _with_others(wrong)
    return found


def _with_others(wrong: Sequence[InputError]) -> InputError:
    """The first refusal, and how many other files are refused."""
    first, others = wrong[0], len(wrong) - 1
    if others:
        first.cure += f" {others} other file{'s are' if others > 1 else ' is'} refused too."
    return first


def _tests_of(files: Sequence[tuple[Path, Sequence[RawLog]]], *, join: bool) -> list[tuple[Path, RawLog]]:
    """Logs of tests, each with its first file: parts joined as their headers state, or all of a folder.

    The same content in two files is refused: it would count as a repeated test.
    """
    first: dict[str, Path] = {}
    for path, (log, *_) in files:
        if log.checksum in first:
            rule = f"has the same content as {printable(str(first[log.checksum]), 200)}"
            cure = "A test counts once; leave one of them out."
            raise InputError(printable(str(path), 200), rule, cure=cure)
        first[log.checksum] = path
    tests: dict[object, list[tuple[Path, RawLog]]] = {}
    for path, log in ((path, log) for path, logs in files for log in logs):
        key = path.absolute().parent if join else log.series or (path, log.source)
        tests.setdefault(key, []).append((path, log))
    return [(parts[0][0], joined([log for _, log in parts])) for parts in tests.values()]


def _reduced(path: Path, log: RawLog, chosen: ColumnMap, cut: Place | None) -> Reduction:
    try:
        return reduction(log, cut or chosen.conditions(path).get("run_in_end"))
    except InputError as error:
        if error.path != RUN_IN_END:
            raise
        raise error.at(f"{printable(path.name, 150)}: the end of running-in") from None


def friction_test(test: TestFriction) -> FrictionTest:
    """Test of a reduced log as a friction file keeps it.

    Raises
    ------
    InputError
        The log and its column map do not state what slid on what, or the friction is not above zero.
    """
    from separatrix import __version__

    known = test.conditions
    if missing := [name for name in NAMES if getattr(known, name) is None]:
        cure = "Give it under [test] of a column map: --map map.toml."
        raise InputError(test.source, f"does not state: {', '.join(missing)}", cure=cure)
    own = {f.name for f in fields(FrictionTest)}
    given = {f.name: getattr(one, f.name) for one in (known, test) for f in fields(one) if f.name in own}
    given |= {name: (given[name], given[name]) for name in CONDITIONS if given[name] is not None}
    given["run_in_end"] = Place(test.run_in_axis, test.run_in_end)
    try:
        return FrictionTest(reduced_by=f"separatrix {__version__}", **given)
    except InputError as error:
        refused = of_log(error, test.source)
        if test.friction <= 0.0:
            refused.cure = "Its friction is zero in every row used: check its column, or leave the log out."
        elif test.friction > FRICTION_LIMIT:
            where = "below [columns] of a column map"
            refused.cure = f"If a force was read as friction, map it as tangential_force {where}."
        raise refused from None


# --- parts of one test ---------------------------------------------------------------------------
ALIKE = 0.1  # share by which measured conditions of parts may differ; beyond it they are of different tests
LISTED = 12  # parts whose friction is listed


def in_order(name: str) -> list[tuple[int, str]]:
    """Key that sorts ``part 2`` before ``part 10``."""
    return [(int(part or 0), "") if part.isdigit() else (0, part) for part in re.split(r"(\d+)", name)]


def joined(parts: Sequence[RawLog]) -> RawLog:
    """Return one log of the parts of a test, one after the other; time goes on from one to the next."""
    if len(parts) == 1:
        return parts[0]
    parts = sorted(parts, key=lambda part: in_order(part.source))
    source = f"{parts[0].source} and {len(parts) - 1} more"
    columns: dict[str, Any] = {}
    for name in (f.name for f in fields(RawLog) if f.name in MEANINGS):
        pieces = [getattr(part, name) for part in parts]
        if any(piece is None for piece in pieces):
            columns[name] = None
            continue
        for i in range(1, len(pieces) if name in ABSCISSAE else 0):  # one that begins anew goes on
            last, piece = pieces[i - 1][-1], pieces[i]
            if piece[0] < last:
                pieces[i] = piece + (last - piece[0] + float(np.median(np.diff(piece))))
        columns[name] = np.concatenate(pieces)
    if all(columns[name] is None for name in ABSCISSAE):
        raise InputError(source, "have no column of time, distance or cycles in common to be joined by")
    if len({part.series for part in parts}) == 1 and parts[0].series and columns["cycles"] is None:
        # a cycle is a stroke there and the one back
        strokes = [(k + np.arange(part.rows) / part.rows) / 2.0 for k, part in enumerate(parts)]
        columns["cycles"] = np.concatenate(strokes)
    means = [format_number(float(part.friction.mean()), 3) for part in parts]
    more = "" if len(means) <= LISTED else f" and {len(means) - LISTED} more"
    note = (
        f"{len(parts)} parts of one test are joined, {parts[0].source} to {parts[-1].source}; "
        f"their frictions: {', '.join(means[:LISTED])}{more}"
    )
    return replace(
        parts[0],
        source=source,
        checksum=hashlib.sha256("".join(part.checksum for part in parts).encode()).hexdigest(),
        missing=sum(part.missing for part in parts),
        conditions=_common_conditions(parts, source),
        measured=frozenset.intersection(*(part.measured for part in parts)),
        notes=(note, *parts[0].notes),
        series="",
        **columns,
    )


def _common_conditions(parts: Sequence[RawLog], source: str) -> Conditions:
    """Conditions of all parts: words that agree, and the middle of measured values that are alike."""
    found: dict[str, Any] = {}
    for f in fields(Conditions):
        values = [value for part in parts if (value := getattr(part.conditions, f.name)) is not None]
        numbers = [value for value in values if isinstance(value, float)]
        if numbers:
            found[f.name] = float(np.median(numbers))
            differs = max(numbers) - min(numbers) > ALIKE * found[f.name]
        else:
            found[f.name] = values[0] if values else None
            differs = len(set(values)) > 1
        if differs:
            unit = unit_of(Conditions, f.name)
            ends = (min(values), max(values))
            texts = [format_quantity(v, unit) if unit else printable(str(v)) for v in ends]
            rule = f"cannot be one test: their {f.name.replace('_', ' ')} differs"
            raise InputError(source, rule, " and ".join(texts), "Name the parts of one test only.")
    return Conditions(**found)
