"""Work on many items with a few threads, for which what is finished is handed over a few times a second."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from threading import Event
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

AT_LEAST_EVERY = 0.25
"""Time after which a thread hands over what it has finished, and goes on [s]."""


def work_in_batches(
    compute: Callable[[Item], Result],
    items: Iterable[Item],
    take: Callable[[list[Result]], None],
    *,
    jobs: int = 1,
) -> bool:
    """Hand over the results of `compute` in batches, as they are finished; False after an interrupt.

    Parameters
    ----------
    compute : callable
        Called once with each item; must not depend on the others, so that `jobs` changes nothing.
    items : iterable
        What to compute.
    take : callable
        Called in this thread with the results of some items; after an interrupt with those that are left.
    jobs : int
        Threads.
    """
    waiting, stopped = deque(items), Event()

    def work() -> list[Result]:
        return _batch(compute, waiting, stopped)

    pool = ThreadPoolExecutor(max_workers=jobs)
    running: set[Future[list[Result]]] = set()
    try:
        running |= {pool.submit(work) for _ in range(jobs)}
        while running:
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                take(future.result())
                running.discard(future)
                if waiting:
                    running.add(pool.submit(work))
    except KeyboardInterrupt:
        stopped.set()
        pool.shutdown(wait=True, cancel_futures=True)
        _take_finished(running, take)
        return False
    finally:
        stopped.set()
        pool.shutdown(wait=True, cancel_futures=True)
    return True


def _batch(compute: Callable[[Item], Result], waiting: deque[Item], stopped: Event) -> list[Result]:
    """Results of the next items, for as long as a batch may take; at least one."""
    results: list[Result] = []
    end = time.monotonic() + AT_LEAST_EVERY
    while not stopped.is_set() and (not results or time.monotonic() < end):
        try:
            item = waiting.popleft()
        except IndexError:  # another thread took the last one
            break
        results.append(compute(item))
    return results


def _take_finished(running: set[Future[list[Result]]], take: Callable[[list[Result]], None]) -> None:
    """Hand over what was finished while the interrupt came."""
    for future in running:
        if not future.cancelled() and future.exception() is None and (results := future.result()):
            take(results)
