"""Work in batches with a few threads, for which every finished batch is handed over at once."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def work_in_batches(
    compute: Callable[[Item], Result],
    items: Sequence[Item],
    take: Callable[[list[Result]], None],
    *,
    size: int,
    jobs: int = 1,
) -> bool:
    """Hand over the results of `compute` in batches, as they are finished; False after an interrupt.

    Parameters
    ----------
    compute : callable
        Called once with each item; must not depend on the others.
    items : sequence
        What to compute.
    take : callable
        Called in this thread with the results of some items; after an interrupt with those that are left.
    size : int
        Items of a batch.
    jobs : int
        Threads.
    """
    stopped = threading.Event()

    def work(batch: Sequence[Item]) -> list[Result]:
        return [compute(item) for item in batch if not stopped.is_set()]

    pool = ThreadPoolExecutor(max_workers=jobs)
    left: set[Future[list[Result]]] = set()
    try:
        left.update(pool.submit(work, items[i : i + size]) for i in range(0, len(items), size))
        for future in as_completed(tuple(left)):
            take(future.result())
            left.discard(future)
    except KeyboardInterrupt:
        stopped.set()
        pool.shutdown(wait=True, cancel_futures=True)
        _take_finished(left, take)
        return False
    finally:
        stopped.set()
        pool.shutdown(wait=True, cancel_futures=True)
    return True


def _take_finished(left: set[Future[list[Result]]], take: Callable[[list[Result]], None]) -> None:
    """Hand over what was finished while the interrupt came."""
    for future in left:
        if not future.cancelled() and future.exception() is None and (results := future.result()):
            take(results)
