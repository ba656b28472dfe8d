"""The one runner of long jobs: threads or a cluster, progress, interrupts, kept runs, expected time."""

from __future__ import annotations

import contextlib
import hashlib
import io
import math
import signal
import sqlite3
import threading
import zlib
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple, NoReturn, Protocol, TypeVar

import numpy as np

import separatrix
from separatrix.cage.disturbance import settings_for
from separatrix.cage.ensemble import Ensemble, Runs, Stop, ensemble_of, pieces_of
from separatrix.cage.moving_cage import MovingCage, moving_cage, turned_forward
from separatrix.cage.numbers import numbers_of, step_length
from separatrix.cage.outcome import MOST
from separatrix.chain.solution import Solution
from separatrix.ground.compiling import COMPILING
from separatrix.ground.errors import InputError
from separatrix.ground.units import MetrePerSecond, Ratio, Second
from separatrix.study.study import StabilitySettings
from separatrix.verdict.side_by_side import Gathered, Turns, run_each

Place = TypeVar("Place", bound=Hashable)
Result = TypeVar("Result")
Answer = TypeVar("Answer")


class Progress(Protocol):
    """Is called with how far a long job is."""

    def __call__(self, done: float, total: float, /) -> None:
        """Take in how much work is done of all that is expected, in any unit; of infinite if not known."""


LOOK = 0.1  # time between two looks at whether the work was interrupted [s]
PART = 64  # runs from each kick that the ledger keeps together
GRACE = 1.0
"""Time that an interrupt waits for the work under way [s]: runs end within it, compilation is left behind."""

WAITING = 4
"""Threads for each that may work, most of which wait for their runs."""

NAMES = tuple(field.name for field in fields(Ensemble))

AT_WORK: list[Stop] = []
"""Flags of the jobs of this process that are at work."""

UNDER_WAY = 0.7
"""What a run of a place under way counts, beside one of a finished place: its first ones are short."""

LEAST_LEFT = 0.2
"""Share of its load that a place under way takes at least before it ends."""

FREE, FEWER = 3.5, 0.75
"""Time of a step among free balls over that among balls of one state: 3.1 to 5.6 (seven bearings); and how
many runs are made, over those of one state: a search begins where that ended."""

KNOWN = 0.1
"""Part of the load of one place that is made of each kind before the end is expected."""


def cost(cage: MovingCage, kick: MetrePerSecond) -> float:
    """Time of a run over that of a cage among balls of one state [-]: free balls need shorter steps."""
    if cage.free_ball is None:
        return 1.0
    return FREE * step_length(replace(cage, free_ball=None), kick) / step_length(cage, kick)


class Load(NamedTuple):
    """Work of a place as far as it is known before."""

    runs: float = 1.0  # of so many; or just one piece of work
    dear: float = 1.0  # time of a run beside that of others
    has_free: bool = False  # whether `runs` counts those among free balls, each for as many as it takes


class Work:
    """How far a job is, by the time that its places took and the runs that they made for it.

    What is left goes on at the pace of what was made of its kind, places of one type and as many runs; of a
    kind of which little was made, at that of all. A place under way takes at least a fifth of its load more.
    Places whose runs were kept by an earlier job say nothing of the others.
    """

    def __init__(self) -> None:
        self._lock, self.loads = threading.Lock(), dict[Hashable, Load]()
        self._kept, self._finished = set[Hashable](), set[Hashable]()
        self._spent: dict[Hashable, tuple[Second, float]] = {}

    def ask(self, place: Hashable, runs: float, dear: float) -> None:
        """Note that a place asks for runs; the first dear ones, among free balls, say that many will be."""
        with self._lock:
            if place in self.loads:
                load, (_, made) = self.loads[place], self._spent.get(place, (0.0, 0.0))
                if dear > 1.0 and not load.has_free:
                    runs = max(runs, dear * FEWER * load.runs)
                is_free = load.has_free or dear > 1.0
                self.loads[place] = load._replace(runs=max(load.runs, made + runs), has_free=is_free)

    def spend(self, place: Hashable, spent: Second, runs: float) -> None:
        """Add time that a thread worked for runs of a place."""
        with self._lock:
            before, made = self._spent.get(place, (0.0, 0.0))
            self._spent[place] = before + spent, made + runs

    def keep(self, place: Hashable) -> None:
        """Note that runs of a place were kept before."""
        with self._lock:
            self._kept.add(place)

    def end(self, place: Hashable, whole: Second) -> None:
        """Note that a place took that time in all, which counts if it made no runs."""
        with self._lock:
            self._spent.setdefault(place, (whole, self.loads[place].runs))

    def finish(self, place: Hashable) -> None:
        """Note that a place is finished."""
        with self._lock:
            self._finished.add(place)

    def so_far(self, threads: int, under_way: Second = 0.0) -> tuple[Second, Second]:
        """Work done and all that is expected [s], of these threads; a place keeps one busy, no more.

        `under_way` is what was worked for runs that have not ended: of what is left, as much as it can be.
        """
        with self._lock:
            done = sum(spent for spent, _ in self._spent.values())
            kinds = {place: (type(place), load.runs) for place, load in self.loads.items()}
            made, took, parts = (defaultdict[tuple[type, float], float](float) for _ in range(3))
            for place, load in self.loads.items():
                kind, (spent, runs) = kinds[place], self._spent.get(place, (0.0, 0.0))
                if place not in self._kept:
                    whole = load.runs if place in self._finished else UNDER_WAY * min(runs, load.runs)
                    made[kind] += load.dear * whole
                    took[kind] += spent
                    parts[kind] += whole / load.runs
            many = Counter(kinds.values())
            left_over = {kinds[place] for place in self.loads.keys() - self._finished}
            if not any(made.values()) or any(parts[kind] < KNOWN for kind in left_over if many[kind] > 1):
                return done, math.inf  # little is known of a kind that is left
            pace, left = sum(took.values()) / sum(made.values()), [0.0]
            for place, load in self.loads.items():
                if place not in self._finished:
                    kind, (_, runs) = kinds[place], self._spent.get(place, (0.0, 0.0))
                    of_kind = (took[kind] + pace * load.runs) / (made[kind] + load.runs)
                    left.append(of_kind * load.dear * max(load.runs - runs, LEAST_LEFT * load.runs))
            rest = max(sum(left), threads * max(left))
            rest *= rest / (rest + under_way) if rest > 0.0 else 0.0
            return done + under_way, done + under_way + rest


def scattered(places: Iterable[Place]) -> list[Place]:
    """Places in an order whose every part resembles the whole: neighbours take alike time."""
    known = list(places)
    order = sorted(range(len(known)), key=lambda i: i * GOLDEN % 1.0)
    return [known[i] for i in order]


GOLDEN = 0.5 * (5.0**0.5 - 1.0)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C or SIGTERM ended a long job.

    `finished` is the answer made of what was finished, a record that names what it lacks; None if nothing
    was.
    """

    def __init__(self, finished: object = None) -> None:
        super().__init__("interrupted")
        self.finished = finished


class Runner:
    """How a long job runs; its numbers do not depend on it.

    An interrupt (Ctrl-C or SIGTERM) ends the runs under way at their next look and starts no others; work
    that does not end within `GRACE`, or before a second interrupt, is left behind.

    Parameters
    ----------
    jobs : int
        Threads.
    progress : callable, optional
        Called with (done, total so far) after each point.
    ledger : Ledger, optional
        Keeps finished runs, for a later job.
    executor : Executor, optional
        Computes the pieces elsewhere, as `verdict.cluster` does; by default the threads compute them.
    """

    def __init__(
        self,
        *,
        jobs: int = 1,
        progress: Progress | None = None,
        ledger: Ledger | None = None,
        executor: Executor | None = None,
    ) -> None:
        self.jobs, self.progress, self.ledger, self.executor = jobs, progress, ledger, executor
        self.stop = Stop()
        self._gathered: Gathered | None = None  # while `work_out` is at work
        self._work, self._here = Work(), threading.local()

    def ensemble(
        self,
        cage: MovingCage,
        settings: StabilitySettings,
        *,
        kicks: Sequence[MetrePerSecond],
        runs: int,
        first_run: int = 0,
    ) -> Ensemble:
        """Run a cage as `run_ensemble` does, unless the ledger has these runs; or raise `Interrupted`."""
        return self.ensemble_of([Runs(cage, settings, first_run, runs)], kicks)

    def ensemble_of(self, asked: Sequence[Runs], kicks: Sequence[MetrePerSecond]) -> Ensemble:
        """Run several cages of as many balls, as `run_each` does, unless the ledger has these runs."""
        if self.ledger is None:
            return self._followed(asked, kicks)
        key = key_of([(one.cage, _of_runs(one.settings), *one[2:]) for one in asked], tuple(kicks))
        kept = self.ledger.get(key)
        if kept is None:
            found = self._followed(asked, kicks)
            self.ledger.put(key, _packed(found))
            return found
        found = _unpacked(kept)
        self.ledger.taken += found.outcome.size
        self._work.keep(self._place)
        return found

    @property
    def _place(self) -> Hashable:
        """Place for which this thread works."""
        return getattr(self._here, "place", None)

    def _followed(self, asked: Sequence[Runs], kicks: Sequence[MetrePerSecond]) -> Ensemble:
        """Follow runs elsewhere, or here with those of other places; an interrupt ends them."""
        if self.stop.is_set:
            raise Interrupted
        begun = COMPILING.clock()
        cage, count = asked[0].cage, len(kicks) * sum(one.runs for one in asked)
        dear = cost(cage, kicks[0])
        runs = dear * count
        self._work.ask(self._place, runs, dear)
        if self.executor is not None:
            found = self._elsewhere(self.executor.submit(run_each, asked, kicks))
            self._work.spend(self._place, COMPILING.clock() - begun, runs)
            return found
        if self._gathered is None:
            found = run_each(asked, kicks, stop=self.stop)
        else:
            evidence, spent = self._gathered.follow(pieces_of(asked, kicks))
            found = ensemble_of(asked, kicks, evidence)
            self._work.spend(self._place, spent, runs)
        if self.stop.is_set:  # it may have ended these runs
            raise Interrupted
        return found

    def _elsewhere(self, future: Future[Result]) -> Result:
        """Result of the executor, unless an interrupt comes first."""
        while not self.stop.is_set:
            with contextlib.suppress(TimeoutError):
                return future.result(timeout=LOOK)
        future.cancel()
        raise Interrupted

    def whole_ensemble(self, cage: MovingCage, settings: StabilitySettings) -> Ensemble:
        """Every run of the settings from every kick."""
        kicks, runs = settings_for(settings, cage).kicks, settings.runs
        parts = ((first, min(PART, runs - first)) for first in range(0, runs, PART))
        return joined(
            [self.ensemble(cage, settings, kicks=kicks, runs=n, first_run=first) for first, n in parts]
        )

    def work_out(
        self,
        compute: Callable[[Place], Result],
        places: Iterable[Place],
        *,
        into: Callable[[dict[Place, Result]], Answer],
        more: Callable[[Place, Mapping[Place, Result]], Iterable[Place]] | None = None,
        load: Callable[[Place], Load] = lambda _: Load(),
        progress: Progress | None = None,
    ) -> Answer:
        """Answer made of the results of `compute` at each place, and at the places that follow from them.

        Threads, because the kernels below release the interpreter's lock. `Interrupted` has the answer made
        of the places that were finished, if any was.

        Parameters
        ----------
        compute : callable
            Called once with each place; must not depend on when it is called, so that `jobs` changes nothing.
        places : iterable
            Where to begin; put the longest first.
        into : callable
            Makes the answer of the results by their places; after an interrupt some are missing.
        more : callable, optional
            Given a place just finished and all results so far: which places it makes wanted, whatever the
            order. None is computed twice.
        load : callable, optional
            How much work a place is; by default all are alike.
        progress : callable, optional
            Called with the numbers of places done and known, instead of the runner's own with the work.
        """
        work = self._work = Work()
        results: dict[Place, Result] = {}
        done: SimpleQueue[tuple[Place, Future[Result]]] = SimpleQueue()
        wanted: dict[Place, Future[Result]] = {}
        # threads that wait for their runs let others work, so that many runs go side by side
        turns, waiting = Turns(self.jobs), 1 if self.executor is not None else WAITING
        pool = ThreadPoolExecutor(max_workers=waiting * self.jobs)
        self._gathered = Gathered(turns, self.jobs, self.stop, pool)

        def in_turn(place: Place) -> Result:
            with turns:
                if self.stop.is_set:
                    raise Interrupted
                self._here.place, begun = place, COMPILING.clock()
                found = compute(place)
                work.end(place, COMPILING.clock() - begun)
                return found

        def submit(new: Iterable[Place]) -> None:
            for place in new:
                if place not in wanted:
                    work.loads[place] = load(place)
                    wanted[place] = pool.submit(in_turn, place)
                    wanted[place].add_done_callback(lambda finished, at=place: done.put((at, finished)))  # type: ignore[misc]

        def report() -> None:
            if progress is not None:
                progress(len(results), len(wanted))
            elif self.progress is not None:
                self.progress(*work.so_far(self.jobs, self._gathered.under_way if self._gathered else 0.0))

        with _noticed(self.stop):
            try:
                report()
                submit(() if self.stop.is_set else places)
                while len(results) < len(wanted) and not self.stop.is_set:
                    with contextlib.suppress(Empty, Interrupted):
                        place, future = done.get(timeout=LOOK)
                        results[place] = future.result()
                        submit(more(place, results) if more is not None else ())
                        work.finish(place)
                    report()
            except KeyboardInterrupt:
                self.stop.set()
            finally:
                pool.shutdown(wait=not self.stop.is_set, cancel_futures=True)
                if self.stop.is_set:
                    under_way = [future for future in wanted.values() if not future.cancelled()]
                    wait(under_way, timeout=GRACE)
                self._gathered = None
            while self.stop.is_set and not done.empty():
                place, future = done.get()
                if not future.cancelled() and future.exception() is None:
                    results[place] = future.result()
        if not self.stop.is_set:
            return into(results)
        raise Interrupted(into(results) if results else None)


def made_into(make: Callable[[Result], Answer], compute: Callable[[], Result]) -> Answer:
    """Make the result of a long job into another record, also the part that an interrupt carries."""
    try:
        return make(compute())
    except Interrupted as stop:
        raise Interrupted(None if stop.finished is None else make(stop.finished)) from None  # type: ignore[arg-type]


@contextlib.contextmanager
def _noticed(stop: Stop) -> Iterator[None]:
    """Let an interrupt set an event instead of breaking in anywhere; the second one breaks in.

    In another thread than the main one, what hears of interrupts finds the flag in `AT_WORK`.
    """

    def note(number: int, frame: object) -> None:  # noqa: ARG001 - as signals call it
        if stop.is_set:
            raise KeyboardInterrupt
        stop.set()

    is_main = threading.current_thread() is threading.main_thread()
    signals = (signal.SIGINT, signal.SIGTERM) if is_main else ()
    before = [(number, signal.signal(number, note)) for number in signals]
    AT_WORK.append(stop)
    try:
        yield
    finally:
        AT_WORK.remove(stop)
        for number, handler in before:
            signal.signal(number, handler or signal.SIG_DFL)


def joined(parts: Sequence[Ensemble]) -> Ensemble:
    """One ensemble of the runs of several, from the same kicks."""

    def column(name: str) -> Any:
        values = [getattr(part, name) for part in parts]
        return np.concatenate(values, axis=1) if np.ndim(values[0]) > 1 else values[0]

    return Ensemble(**{name: column(name) for name in NAMES})


def _of_runs(settings: StabilitySettings) -> tuple[int, Second, Ratio]:
    """What a run takes of the settings, besides disturbance and number."""
    return settings.seed, settings.duration, settings.ball_scatter


def _packed(found: Ensemble) -> bytes:
    """Arrays of an ensemble as one record, compressed; those of space are None in the plane."""
    arrays = {name: np.asarray(value) for name in NAMES if (value := getattr(found, name)) is not None}
    record = np.empty((), [(name, one.dtype, one.shape) for name, one in arrays.items()])
    for name, one in arrays.items():
        record[name] = one
    whole = io.BytesIO()
    np.save(whole, record)
    return zlib.compress(whole.getvalue(), 1)


def _unpacked(kept: bytes) -> Ensemble:
    """The ensemble of these bytes."""
    record = np.load(io.BytesIO(zlib.decompress(kept)))
    values: dict[str, Any] = {name: record[name] for name in record.dtype.names}
    return Ensemble(**values | {"duration": float(values["duration"])})


NAME = "finished-runs.sqlite"
"""The file in the folder of the answers."""

DECIDE = ("cage", "chain", "friction", "ground", "study")
"""Rooms of the package whose sources decide what a run is: not what judges or tells it."""

_TABLE = "CREATE TABLE IF NOT EXISTS piece (key BLOB PRIMARY KEY, found BLOB) WITHOUT ROWID"


class Ledger:
    """Pieces by their key, a checksum of all that they depend on: many jobs may share a file.

    The file is made when the first piece is written; a file of another kind is refused. A piece is written at
    once, so that a kill loses only those under way, and with a checksum that binds it to its key: one that
    was changed, or stands at another key, counts as absent.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.goes_on = path, path.exists()
        self.taken = 0
        """Runs that were read here instead of being computed."""
        self._lock = threading.Lock()
        self._connection: sqlite3.Connection | None = None
        if self.goes_on:
            self._execute("SELECT 1 FROM piece LIMIT 1")

    def get(self, key: bytes) -> bytes | None:
        """Return the piece of a key; None if there is none that is whole."""
        with self._lock:
            if self._connection is None:
                return None
            row = self._execute("SELECT found FROM piece WHERE key = ?", (key,)).fetchone()
        if row is None or not isinstance(row[0], bytes):
            return None
        seal, found = row[0][:SEAL], row[0][SEAL:]
        return found if seal == _seal(key, found) else None

    def put(self, key: bytes, found: bytes) -> None:
        """Keep a piece."""
        with self._lock:
            self._execute("INSERT OR REPLACE INTO piece VALUES (?, ?)", (key, _seal(key, found) + found))

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            if self._connection is not None:
                self._connection.close()

    def _execute(self, command: str, values: tuple[bytes, ...] = ()) -> sqlite3.Cursor:
        try:
            if self._connection is None:
                self._connection = sqlite3.connect(
                    self.path, timeout=30.0, check_same_thread=False, isolation_level=None
                )
                self._connection.execute("PRAGMA journal_mode = WAL")
                self._connection.execute("PRAGMA synchronous = NORMAL")
                self._connection.execute(_TABLE)
            return self._connection.execute(command, values)
        except sqlite3.Error as error:
            cure = "Remove it, or name another folder: --out DIR."
            raise InputError(str(self.path), f"cannot be used to keep runs ({error})", cure=cure) from error


SEAL = hashlib.sha256().digest_size


def _seal(key: bytes, found: bytes) -> bytes:
    """Checksum that binds a piece to its key."""
    return hashlib.sha256(key + found).digest()


def key_of(*parts: object) -> bytes:
    """Checksum of the inputs of a piece, by their exact text, and of the sources that decide it."""
    text = "\n".join(map(repr, parts))
    return hashlib.sha256(program() + text.encode()).digest()


@cache
def program() -> bytes:
    """Checksum of the sources of the rooms that decide what a run is."""
    package = Path(separatrix.__file__).parent
    sources = (path for room in DECIDE for path in sorted((package / room).rglob("*.py")))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).digest()


PACE, UNEVEN_SHARE = 1e8, 0.22
"""Steps of a ball that one core computes in a second, and the part of them that it does among uneven orbits,
where a verdict also asks for two frictions.

From 0.55e8 in space to 1.7e8 of balls that are dampers, on a server of 2026.
"""


class Foreseen(Exception):  # noqa: N818 - an answer, not an error
    """The number of runs that a job would make."""

    def __init__(self, runs: float) -> None:
        super().__init__(runs)
        self.runs = runs


class Counting(Runner):
    """Runs nothing: a job ends with what it would make, in `Foreseen`."""

    def work_out(  # type: ignore[override]
        self, _compute: object, places: Iterable[Any], *, load: Callable[[Any], Load], **_: object
    ) -> NoReturn:
        """Count the runs of these places."""
        raise Foreseen(sum(load(place).runs for place in places))


def time_of_runs(solution: Solution, runs: float) -> Second:
    """Time that one core takes for runs of a cage, within a factor of 3.

    A motion that the balls damp little is followed through more of its longest time. With even orbits
    the time of `rank` was 0.7 to 1.9 times the true one, of 15 to 180 s; with uneven ones 0.4 to 3.2 times,
    of 15 to 375 s (six bearings).
    """
    cage = turned_forward(moving_cage(solution, 0.0))
    settings = settings_for(solution.study.stability, cage)
    kind, *_, limits = numbers_of(cage, settings.middle_kick, settings.duration)
    share = 0.06 / (1.2 - solution.restitution.restitution_factor)
    pace = PACE * (UNEVEN_SHARE if kind.harmonics else 1.0)
    return float(runs * share * limits[MOST] * kind.steps * kind.balls / pace)
