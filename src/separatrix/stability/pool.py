"""Work on many points with a few threads: results in order, progress, and an interrupt keeps what is done."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from threading import Event
from typing import TypeVar

Item = TypeVar("Item")
Place = TypeVar("Place", bound=Hashable)
Result = TypeVar("Result")
Progress = Callable[[int, int], None]


class Stopped(Exception):  # noqa: N818 - not an error: an interrupt on its way out of a thread
    """The work was interrupted while a thread was inside a point."""


def work_through(
    compute: Callable[[Item], Result],
    items: Sequence[Item],
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> list[Result | None]:
    """Results of `compute` for each item, in the order of the items; None for what an interrupt left out.

    Parameters
    ----------
    compute : callable
        Called once with each item; must not depend on the others, so that `jobs` changes nothing.
    items : sequence
        What to compute; put the longest first.
    jobs, progress, stop
        As in `work_out`.
    """
    places = range(len(items))
    found = work_out(lambda place: compute(items[place]), places, jobs=jobs, progress=progress, stop=stop)
    return [found.get(place) for place in places]


def work_out(
    compute: Callable[[Place], Result],
    places: Iterable[Place],
    *,
    more: Callable[[Place, Mapping[Place, Result]], Iterable[Place]] | None = None,
    jobs: int = 1,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> dict[Place, Result]:
    """Results of `compute` at each place, and at the places that follow from them.

    Threads, because the kernels below release the interpreter's lock. An interrupt (Ctrl-C) starts no other
    place and leaves out those that were not finished.

    Parameters
    ----------
    compute : callable
        Called once with each place; must not depend on when it is called, so that `jobs` changes nothing.
    places : iterable
        Where to begin; put the longest first.
    more : callable, optional
        Given a place just finished and all results so far: which places it makes wanted. Those that are
        known or under way are not computed again. What it answers must not depend on the order.
    jobs : int
        Threads.
    progress : callable, optional
        Called with (done, total so far) after each place.
    stop : Event, optional
        Set on an interrupt, so that a long computation can look and raise `Stopped`.
    """
    results: dict[Place, Result] = {}
    pool = ThreadPoolExecutor(max_workers=jobs)
    pending: dict[Future[Result], Place] = {}
    try:
        pending |= {pool.submit(compute, place): place for place in places}
        while pending:
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                place = pending[future]
                results[place] = future.result()
                del pending[future]
                wanted = more(place, results) if more is not None else ()
                new = [p for p in wanted if p not in results and p not in pending.values()]
                pending |= {pool.submit(compute, place): place for place in new}
                if progress is not None:
                    progress(len(results), len(results) + len(pending))
    except KeyboardInterrupt:
        if stop is not None:
            stop.set()
        _collect(pending, results)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    return results


def _collect(pending: Mapping[Future[Result], Place], results: dict[Place, Result]) -> None:
    """Keep what was finished while the interrupt came."""
    for future, place in pending.items():
        if not future.cancel() and future.done() and future.exception() is None:
            results[place] = future.result()
