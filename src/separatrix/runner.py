"""The one runner of long jobs: threads or a cluster, progress, interrupts, and the runs finished before."""

from __future__ import annotations

import contextlib
import signal
import threading
import time
import zlib
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import fields
from functools import partial
from queue import Empty, SimpleQueue
from typing import Any, Protocol, TypeVar, runtime_checkable

import numpy as np

from separatrix.cage import Ensemble, PlanarCage, SpaceEnsemble, run_ensemble
from separatrix.ledger import Ledger, key_of
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, Second

Place = TypeVar("Place", bound=Hashable)
Result = TypeVar("Result")
Answer = TypeVar("Answer")


class Progress(Protocol):
    """Is called with how far a long job is."""

    def __call__(self, done: int, total: int, /) -> None:
        """Take in how many points of those known so far are done."""


@runtime_checkable
class Expecting(Progress, Protocol):
    """Is called beforehand with what a long job will take, too."""

    def expect(self, estimate: Callable[[], Second], *, at_most: bool = False) -> None:
        """Take in an estimate, which costs something to make."""


LOOK = 0.1  # time between two looks at whether the work was interrupted [s]
PART = 16  # runs from each kick that the ledger keeps together
SOON = 1.0  # time of the runs between two looks at whether to stop, if one run does not take longer [s]
BY_BALL = ("pocket_impacts", "pocket_rubbing")
WHOLE_NUMBERS = ("outcome", "cause", "whirl_direction", "pocket_impacts", "land_impacts")


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

    An interrupt (Ctrl-C or SIGTERM) lets the runs under way end and starts no others; a second one does not
    wait for them.

    Parameters
    ----------
    jobs : int
        Threads.
    progress : callable, optional
        Called with (done, total so far) after each point.
    ledger : Ledger, optional
        Keeps finished runs, for a later job.
    executor : Executor, optional
        Computes the pieces elsewhere, as `separatrix.cluster` does; by default the threads compute them.
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
        self.stop = threading.Event()

    def expect(self, estimate: Callable[[], Second], *, at_most: bool = False) -> None:
        """Report what the work will take; at most that where an earlier call has kept runs."""
        if isinstance(self.progress, Expecting):
            resumed = self.ledger is not None and self.ledger.goes_on
            self.progress.expect(estimate, at_most=at_most or resumed)

    def ensemble(
        self,
        cage: PlanarCage,
        settings: StabilitySettings,
        *,
        kicks: Sequence[MetrePerSecond],
        runs: int,
        first_run: int = 0,
    ) -> Ensemble:
        """Run a cage as `run_ensemble` does, unless the ledger has these runs; or raise `Interrupted`."""
        piece = cage, settings, tuple(kicks), runs, first_run
        if self.ledger is None:
            return self._followed(*piece)
        key = key_of(cage, (settings.seed, settings.duration, settings.ball_scatter), *piece[2:])
        kind = Ensemble if cage.space is None else SpaceEnsemble
        known = _unpacked(kind, self.ledger.get(key), (len(kicks), runs, cage.ball_count))
        if known is not None:
            self.ledger.taken += len(kicks) * runs
            return known
        found = self._followed(*piece)
        arrays = (np.asarray(getattr(found, field.name)) for field in fields(found))
        self.ledger.put(key, zlib.compress(b"".join(array.tobytes() for array in arrays), 1))
        return found

    def _followed(
        self,
        cage: PlanarCage,
        settings: StabilitySettings,
        kicks: Sequence[MetrePerSecond],
        runs: int,
        first_run: int,
    ) -> Ensemble:
        """Follow runs: here as many at a time as end soon, so that an interrupt waits for no more."""
        run = partial(run_ensemble, cage, settings, kicks=kicks)
        if self.executor is not None and not self.stop.is_set():
            return self._elsewhere(self.executor.submit(run, runs=runs, first_run=first_run))
        parts: list[Ensemble] = []
        begun, size = 0, 1
        while begun < runs:
            if self.stop.is_set():
                raise Interrupted
            start, size = time.perf_counter(), min(size, runs - begun)
            parts.append(run(runs=size, first_run=first_run + begun))
            begun += size
            size = max(1, int(size * SOON / max(time.perf_counter() - start, 1e-3)))
        return joined(parts)

    def _elsewhere(self, future: Future[Result]) -> Result:
        """Result of the executor, unless an interrupt comes first."""
        while not self.stop.is_set():
            with contextlib.suppress(TimeoutError):
                return future.result(timeout=LOOK)
        future.cancel()
        raise Interrupted

    def whole_ensemble(self, cage: PlanarCage, settings: StabilitySettings) -> Ensemble:
        """Every run of the settings, whose kicks are numbers, from every kick."""
        kicks, runs = settings.kicks, settings.runs
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
        progress : callable, optional
            Called instead of the runner's own.
        """
        report = progress or self.progress
        results: dict[Place, Result] = {}
        done: SimpleQueue[tuple[Place, Future[Result]]] = SimpleQueue()
        wanted: set[Place] = set()

        def submit(new: Iterable[Place]) -> None:
            for place in new:
                if place not in wanted:
                    wanted.add(place)
                    future = pool.submit(compute, place)
                    future.add_done_callback(lambda finished, at=place: done.put((at, finished)))  # type: ignore[misc]

        with _noticed(self.stop), ThreadPoolExecutor(max_workers=self.jobs) as pool:
            try:
                submit(() if self.stop.is_set() else places)
                while len(results) < len(wanted) and not self.stop.is_set():
                    with contextlib.suppress(Empty, Interrupted):
                        place, future = done.get(timeout=LOOK)
                        results[place] = future.result()
                        submit(more(place, results) if more is not None else ())
                        if report is not None:
                            report(len(results), len(wanted))
            except KeyboardInterrupt:
                self.stop.set()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)
            while self.stop.is_set() and not done.empty():
                place, future = done.get()
                if not future.cancelled() and future.exception() is None:
                    results[place] = future.result()
        if not self.stop.is_set():
            return into(results)
        raise Interrupted(into(results) if results else None)


def made_into(make: Callable[[Result], Answer], compute: Callable[[], Result]) -> Answer:
    """Make the result of a long job into another record, also the part that an interrupt carries."""
    try:
        return make(compute())
    except Interrupted as stop:
        raise Interrupted(None if stop.finished is None else make(stop.finished)) from None  # type: ignore[arg-type]


@contextlib.contextmanager
def _noticed(stop: threading.Event) -> Iterator[None]:
    """Let an interrupt set an event instead of breaking in anywhere; the second one breaks in."""

    def note(number: int, frame: object) -> None:  # noqa: ARG001 - as signals call it
        if stop.is_set():
            raise KeyboardInterrupt
        stop.set()

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = [(number, signal.signal(number, note)) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        yield
    finally:
        for number, handler in before:
            signal.signal(number, handler or signal.SIG_DFL)


def joined(parts: Sequence[Ensemble]) -> Ensemble:
    """One ensemble of the runs of several, from the same kicks."""

    def column(name: str) -> Any:
        values = [getattr(part, name) for part in parts]
        return np.concatenate(values, axis=1) if np.ndim(values[0]) > 1 else values[0]

    kind = type(parts[0])
    return kind(**{field.name: column(field.name) for field in fields(kind)})


def _unpacked(kind: type[Ensemble], known: bytes | None, shape: tuple[int, int, int]) -> Ensemble | None:
    """Ensemble of this kind and shape (kicks, runs, balls) from its bytes; None if they are of no use."""
    names = [field.name for field in fields(kind)]
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(names, shape[:2])
    by_ball = {name: shape for name in BY_BALL if name in names}
    shapes |= {"kicks": shape[:1], "duration": (), **by_ball}
    sizes = {name: int(np.prod(size)) for name, size in shapes.items()}
    whole, data = 8 * sum(sizes.values()), b""
    with contextlib.suppress(zlib.error):
        data = b"" if known is None else zlib.decompressobj().decompress(known, whole + 1)
    if len(data) != whole:
        return None
    at = 0
    values: dict[str, Any] = {}
    for name, size in sizes.items():
        number = np.int64 if name in WHOLE_NUMBERS else np.float64
        values[name] = np.frombuffer(data, number, size, at).reshape(shapes[name])
        at += 8 * size
    return kind(**values | {"duration": float(values["duration"])})
