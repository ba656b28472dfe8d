"""The verb `tribometer`: raw logs to friction with its scatter, a friction file and pages of plots."""

from __future__ import annotations

import contextlib
import json
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from separatrix.cli.console import answer, progress_bar
from separatrix.cli.files import staged, writable_folder
from separatrix.errors import InputError, together
from separatrix.units import printable, shown

if TYPE_CHECKING:
    from separatrix.friction.fit import FrictionTest
    from separatrix.friction.fit.fit import FrictionFit
    from separatrix.friction.logs.column_map import ColumnMap
    from separatrix.friction.logs.log import RawLog
    from separatrix.friction.reduction.options import ReductionOptions
    from separatrix.friction.reduction.reduction import Reduction

_T = TypeVar("_T")

SUFFIX = ".toml"
OTHERS = frozenset(
    {".toml", ".md", ".json", ".nc", ".png", ".jpg", ".jpeg", ".pdf", ".py", ".svg", ".gif", ".docx"}
)
"""Ends of names of files in a folder that are no logs."""

MOST_FILES = 10_000


@dataclass(frozen=True, slots=True, kw_only=True)
class TribometerOptions:
    """What follows the files on the command line."""

    out: Path | None
    map: Path | None
    plots: Path | None
    run_in: str | None
    join: bool
    json: bool
    quiet: bool
    jobs: int

    @property
    def plots_folder(self) -> Path | None:
        """Folder of the pages: as asked for, or beside the friction file."""
        beside = None if self.out is None else self.out.with_name(f"{self.out.stem}-plots")
        return beside if self.plots is None else self.plots


def tribometer(paths: Sequence[Path], options: TribometerOptions) -> int:
    """Read and reduce logs, show what was read, write what was asked for; return the exit status.

    Parameters
    ----------
    paths : sequence of Path
        The logs, each of one or several tests.
    options : TribometerOptions
        Where the answer goes.

    Raises
    ------
    InputError
        An option or a file is wrong: the first one, and how many others are; nothing is written.
    """
    paths = _files(paths)
    _refuse(paths, options)
    chosen = _column_map(options.map)
    idle = [] if chosen is None else chosen.unused(paths)
    if idle and options.out is not None:
        raise together(idle)
    with contextlib.ExitStack() as folders:
        if options.out is not None:
            folders.enter_context(writable_folder(options.out.parent))
        if options.plots_folder is not None:
            folders.enter_context(writable_folder(options.plots_folder))
        reductions = _reductions(paths, chosen, _reduction_options(options), options)
        tests = _tests(reductions, required=options.out is not None)
        _deliver(reductions, tests, options, [f"{one} With --out this is refused." for one in idle])
    return 0


def _refuse(paths: Sequence[Path], options: TribometerOptions) -> None:
    """Refuse what is wrong with the command line itself, before any file is read."""
    if len(paths) > MOST_FILES:
        raise InputError("FILES", f"must be at most {MOST_FILES}", str(len(paths)))
    known: dict[Path, Path] = {}
    for path in paths:
        if path.resolve() in known:
            raise InputError(printable(str(path), 200), "is named twice", cure="A test counts once.")
        known[path.resolve()] = path
    if options.out is not None:
        _refuse_out(options.out)


def _refuse_out(out: Path) -> None:
    """Refuse a friction file that has another name, or that exists."""
    try:
        folder, exists = out.is_dir(), out.exists() or out.is_symlink()
    except OSError as error:
        where = f"--out {printable(str(out), 200)}"
        raise InputError(where, "cannot be written", error.strerror or type(error).__name__) from None
    if out.suffix != SUFFIX or folder:
        cure = 'Name a file like "friction.toml".'
        raise InputError("--out", f"must name a file that ends in {SUFFIX}", shown(str(out)), cure)
    if exists:
        from separatrix.friction.file.refusal import exists_already

        raise exists_already(out)


def _column_map(path: Path | None) -> ColumnMap | None:
    from separatrix.friction.logs.column_map import read_column_map

    return None if path is None else read_column_map(path)


def _reduction_options(options: TribometerOptions) -> ReductionOptions:
    from separatrix.friction.reduction.options import ReductionOptions

    try:
        return ReductionOptions(run_in_end=options.run_in)
    except InputError as error:
        raise error.at("--run-in") from None


def _files(paths: Sequence[Path]) -> list[Path]:
    """The files named, and those in the folders named, in the order of their names and numbers.

    Raises
    ------
    InputError
        A folder holds no file that may be a log.
    """
    from separatrix.friction.logs.joining import in_order

    found: list[Path] = []
    for path in paths:
        if not _is_folder(path):
            found.append(path)
            continue
        inside = [one for one in path.iterdir() if one.is_file() and not one.name.startswith(".")]
        logs = [one for one in inside if one.suffix.lower() not in OTHERS]
        if not logs:
            raise InputError(printable(str(path), 200), "is a folder without a log", cure="Name another.")
        found += sorted(logs, key=lambda one: in_order(one.name))
    return found


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:
        return False  # who reads it says why


def _reductions(
    paths: Sequence[Path], chosen: ColumnMap | None, how: ReductionOptions, options: TribometerOptions
) -> list[Reduction]:
    """Every test of every file, in their order; or the refusal of the first that is wrong."""
    from separatrix.friction.reduction.siblings import with_outliers

    with progress_bar("tribometer", quiet=options.quiet) as progress, _threads(options.jobs) as pool:

        def each(jobs: Sequence[Future[_T]], start: float) -> list[_T]:
            found: list[_T] = []
            wrong: list[InputError] = []
            for done, job in enumerate(jobs, 1):
                try:
                    found.append(job.result())
                except InputError as error:
                    wrong.append(error)
                if progress is not None:
                    progress(round(start + 500 * done / len(jobs)), 1000)
            if wrong:
                raise _with_others(wrong)
            return found

        read = each([pool.submit(_read, path, chosen) for path in paths], 0)
        _refuse_copies(paths, read)
        tests = _tests_of(list(zip(paths, read, strict=True)), options)
        reduced = each([pool.submit(_reduced, path, log, chosen, how) for path, log in tests], 500)
    return with_outliers(reduced)


def _read(path: Path, chosen: ColumnMap | None) -> tuple[RawLog, ...]:
    from separatrix.friction.logs.reading import read_log

    return read_log(path, chosen)


def _tests_of(
    files: Sequence[tuple[Path, Sequence[RawLog]]], options: TribometerOptions
) -> list[tuple[Path, RawLog]]:
    """Logs of tests, each with its first file: parts joined as asked, or as their headers say."""
    from separatrix.friction.logs.joining import by_series, joined

    home = {log.source: path for path, logs in files for log in logs}
    every = [log for _, logs in files for log in logs]
    if options.join:
        folders: dict[Path, list[RawLog]] = {}
        for path, logs in files:
            folders.setdefault(path.absolute().parent, []).extend(logs)
        groups = list(folders.values())
    else:
        groups = by_series(every)
    tests = [joined(parts) for parts in groups]
    if not options.join:
        tests = _with_strokes_told(tests, options)
    return [(home[parts[0].source], log) for parts, log in zip(groups, tests, strict=True)]


def _with_strokes_told(logs: Sequence[RawLog], options: TribometerOptions) -> list[RawLog]:
    """The logs; where several are parts of one test by their header, a note, or a refusal with --out."""
    counts = Counter(log.series for log in logs if log.series)
    found = []
    for log in logs:
        count = counts[log.series]
        if count > 1 and options.out is not None:
            rule = f"is one of {count} strokes or parts of one test by the header"
            raise InputError(log.source, rule, cure="Add --join: a test counts once.")
        note = f"one of {count} parts of one test by the header: --join counts them as one"
        found.append(replace(log, notes=(*log.notes, note)) if count > 1 else log)
    return found


@contextlib.contextmanager
def _threads(jobs: int) -> Iterator[ThreadPoolExecutor]:
    """Threads that begin nothing new once the work is interrupted."""
    pool = ThreadPoolExecutor(jobs)
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _reduced(path: Path, log: RawLog, chosen: ColumnMap | None, how: ReductionOptions) -> Reduction:
    from separatrix.friction.reduction.reduction import reduction

    said = None if chosen is None else chosen.run_in_end(path)
    key = "--run-in" if how.run_in_end is not None else "run_in_end"
    try:
        return reduction(log, how if how.run_in_end is not None else replace(how, run_in_end=said))
    except InputError as error:
        if not error.path.startswith("ReductionOptions."):
            raise
        where = f"{printable(path.name, 150)}: {key}"
        raise error.at(where) from None


def _with_others(wrong: Sequence[InputError]) -> InputError:
    """The first refusal, and how many other files are refused."""
    first, others = wrong[0], len(wrong) - 1
    if not others:
        return first
    more = f"{others} other file{'s are' if others > 1 else ' is'} refused too."
    return first.at(first.path, cure=f"{first.cure} {more}".strip())


def _refuse_copies(paths: Sequence[Path], found: Sequence[Sequence[RawLog]]) -> None:
    """Refuse the same content in two files: it would count as a repeated test."""
    first: dict[str, Path] = {}
    for path, (one, *_) in zip(paths, found, strict=True):
        if one.checksum in first:
            same = printable(str(first[one.checksum]), 200)
            cure = "A test counts once; leave one of them out."
            raise InputError(printable(str(path), 200), f"has the same content as {same}", cure=cure)
        first[one.checksum] = path


def _tests(reductions: Sequence[Reduction], *, required: bool) -> list[FrictionTest] | None:
    """Tests as a friction file keeps them; None where some do not say what slid on what.

    Raises
    ------
    InputError
        A friction file is asked for, and a test cannot stand in it.
    """
    from separatrix import __version__
    from separatrix.friction.file.reduced import friction_test

    found: list[FrictionTest] = []
    wrong: list[InputError] = []
    for one in reductions:
        try:
            found.append(friction_test(one.test, __version__))
        except InputError as error:
            wrong.append(error)
    if wrong and required:
        raise _with_others(wrong)
    return None if wrong else found


def _deliver(
    reductions: Sequence[Reduction],
    tests: list[FrictionTest] | None,
    options: TribometerOptions,
    notes: Sequence[str],
) -> None:
    """Write the files, then the answer."""
    from separatrix.friction.fit import fit_friction
    from separatrix.report.tribometer import tribometer as in_words
    from separatrix.results.tribometer import tribometer as document

    fit: FrictionFit | None = None if tests is None else fit_friction(tests)
    written = None if options.out is None else str(options.out)
    logs, reduced = [r.log for r in reductions], [r.test for r in reductions]
    found = document(logs, reduced, fit, written=written, notes=notes)
    if options.plots_folder is not None:
        _draw(reductions, options, options.plots_folder)
    if options.out is not None and tests is not None:
        _write(tests, options.out)
    plots = None if options.plots_folder is None else str(options.plots_folder)
    text = (
        json.dumps(found, indent=1, allow_nan=False) + "\n" if options.json else in_words(found, plots=plots)
    )
    answer(text)


def _write(tests: Sequence[FrictionTest], out: Path) -> None:
    """Write the friction file aside, then rename it into place; a file that came meanwhile stays."""
    from separatrix.friction.file import friction_text
    from separatrix.friction.file.refusal import exists_already

    with staged(out.parent) as stage:
        (stage / out.name).write_text(friction_text(tests), encoding="utf-8")
        if out.exists():
            raise exists_already(out)


def _draw(reductions: Sequence[Reduction], options: TribometerOptions, folder: Path) -> None:
    """Write a page of plots for each test, and the data that it is drawn from."""
    from separatrix import results
    from separatrix.figures import save
    from separatrix.figures.tribometer import page
    from separatrix.results.friction_tests import page_data

    names: dict[str, int] = {}
    with staged(folder) as stage, progress_bar("pages of plots", quiet=options.quiet) as progress:
        for done, one in enumerate(reductions, 1):
            name = file_name(one.log.source)
            names[name] = number = names.get(name, 0) + 1
            path = stage / (name if number == 1 else f"{name}-{number}")
            data = page_data(one)
            results.save(data, path.with_name(f"{path.name}.nc"))
            save(page(data), path.with_name(f"{path.name}.png"))
            if progress is not None:
                progress(done, len(reductions))


def file_name(source: str) -> str:
    """Name of a test as the name of a file: letters, digits, dots and dashes."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._-") else "-" for c in source)
    return "-".join(part for part in plain.split("-") if part).strip(".-")[:100] or "test"
