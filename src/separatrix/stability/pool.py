"""Work on many points with a few threads: results in order, progress, and an interrupt keeps what is done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")
Progress = Callable[[int, int], None]


def work_through(
    compute: Callable[[Item], Result],
    items: Sequence[Item],
    *,
    jobs: int = 1,
    progress: Progress | None = None,
) -> list[Result | None]:
    """Results of `compute` for each item, in the order of the items.

    Threads, because the kernels below release the interpreter's lock. An interrupt (Ctrl-C) leaves None
    for the items that were not finished, and does not start them.

    Parameters
    ----------
    compute : callable
        Called once with each item; must not depend on the others, so that `jobs` changes nothing.
    items : sequence
        What to compute; put the longest first.
    jobs : int
        Threads.
    progress : callable, optional
        Called with (done, total) after each item.
    """
    results: dict[int, Result] = {}
    pool = ThreadPoolExecutor(max_workers=jobs)
    try:
        places = {pool.submit(compute, item): place for place, item in enumerate(items)}
        for done, future in enumerate(as_completed(places), start=1):
            results[places[future]] = future.result()
            if progress is not None:
                progress(done, len(items))
    except KeyboardInterrupt:
        _collect(places, results)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    return [results.get(place) for place in range(len(items))]


def _collect(places: dict[Future[Result], int], results: dict[int, Result]) -> None:
    """Keep what was finished while the interrupt came."""
    for future, place in places.items():
        if not future.cancel() and future.done() and future.exception() is None:
            results[place] = future.result()
