"""Runs of many cages side by side: what several threads ask for goes through the engine together.

The engine advances sixteen runs at once, and a run's bits do not depend on its neighbours: so many short
questions of a few runs each cost as little as one long one.
"""

from __future__ import annotations

import contextlib
import math
import threading
from collections import deque
from collections.abc import Sequence
from concurrent.futures import Executor, Future, wait

import numpy as np

from separatrix.cage.ensemble import Ensemble, Piece, Runs, Stop, ensemble_of, follow, follow_alike, pieces_of
from separatrix.ground.compiling import COMPILING
from separatrix.ground.units import Array, MetrePerSecond, Second

TOGETHER = 256
"""Runs that are followed together, about: a second or two of work, of which an interrupt leaves nothing."""

Evidence = dict[str, Array]  # by name, of a piece: each array has shape (run, ...)
Followed = tuple[Evidence, Second]  # with the time that a thread took for it


def run_each(asked: Sequence[Runs], kicks: Sequence[MetrePerSecond], *, stop: Stop | None = None) -> Ensemble:
    """Run every cage from every kick."""
    return ensemble_of(asked, kicks, follow(pieces_of(asked, kicks), stop=stop))


class Turns:
    """So many threads work at a time, in the order in which they ask; used as ``with turns:``."""

    def __init__(self, count: int) -> None:
        self._free, self._lock = count, threading.Lock()
        self._waiting: deque[threading.Event] = deque()

    def take(self) -> None:
        """Wait for a turn."""
        with self._lock:
            if self._free > 0:
                self._free -= 1
                return
            mine = threading.Event()
            self._waiting.append(mine)
        mine.wait()

    def give(self) -> None:
        """Let the next one work."""
        with self._lock:
            if self._waiting:
                self._waiting.popleft().set()
            else:
                self._free += 1

    def __enter__(self) -> None:
        self.take()

    def __exit__(self, *_: object) -> None:
        self.give()


class Gathered:
    """Runs that threads ask for, followed together; a thread that waits for its own lets others work.

    Threads of the pool that have nothing else to do follow runs of those that have.
    """

    def __init__(self, turns: Turns, jobs: int, stop: Stop, pool: Executor) -> None:
        self._turns, self._jobs, self._stop, self._pool = turns, jobs, stop, pool
        self._lock = threading.Lock()
        self._waiting: list[tuple[Piece, Future[Followed]]] = []
        self._begun: dict[int, Second] = {}  # by thread that follows runs

    @property
    def under_way(self) -> Second:
        """Time that threads worked for runs that have not ended."""
        now = COMPILING.clock()
        return sum(now - begun for begun in self._begun.copy().values())

    def follow(self, pieces: Sequence[Piece]) -> Followed:
        """Evidence of pieces, one after the other, for a thread that has a turn; and their time."""
        mine = [(piece, Future[Followed]()) for piece in pieces]
        futures = [future for _, future in mine]
        with self._lock:
            self._waiting += mine
        for _ in range(self._jobs - 1):
            with contextlib.suppress(RuntimeError):  # a pool that an interrupt has shut
                self._pool.submit(self._help)
        while not all(future.done() for future in futures):
            self._turns.give()
            self._turns.take()
            if not self._follow_some():
                self._turns.give()
                wait(futures)
                self._turns.take()
        found = [future.result() for future in futures]
        evidence = {name: np.concatenate([one[name] for one, _ in found]) for name in found[0][0]}
        return evidence, sum(spent for _, spent in found)

    def _help(self) -> None:
        """Follow runs of other threads as long as some wait."""
        with self._turns:
            while not self._stop.is_set and self._follow_some():
                pass

    def _follow_some(self) -> bool:
        """Follow pieces that wait, alike as the engine needs them; False if none does."""
        with self._lock:
            if not self._waiting:
                return False
            kind, count = self._waiting[0][0].numbers.kind, 0
            alike = [one for one in self._waiting if one[0].numbers.kind == kind]
            most = min(TOGETHER, math.ceil(sum(len(piece.states) for piece, _ in alike) / self._jobs))
            batch: list[tuple[Piece, Future[Followed]]] = []
            while count < most:
                batch.append(alike[len(batch)])
                count += len(batch[-1][0].states)
            taken = set(map(id, batch))
            self._waiting = [one for one in self._waiting if id(one) not in taken]
        begun = self._begun[threading.get_ident()] = COMPILING.clock()
        try:
            found = follow_alike(kind, [piece for piece, _ in batch], self._stop)
        except BaseException as error:  # those that wait for these runs must not wait on
            for _, future in batch:
                future.set_exception(error)
            raise
        finally:
            del self._begun[threading.get_ident()]
        at, spent = 0, (COMPILING.clock() - begun) / count
        for piece, future in batch:
            last = at + len(piece.states)
            evidence = {name: values[at:last] for name, values in found.items()}
            future.set_result((evidence, spent * len(piece.states)))
            at = last
        return True
