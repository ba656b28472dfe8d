"""Finds the points of a map, from a coarse grid to the full one: all of them, or those near a change."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from separatrix.cage import Verdict
from separatrix.stability.map_grid import Lattice, Place, around, near_a_change, rounds
from separatrix.stability.map_pool import work_in_batches
from separatrix.stability.map_records import MapPoint, MapQuestion
from separatrix.stability.pool import Progress

CHECK_EVERY = 20
"""One in so many of the points that an adaptive map does not want is run nevertheless, as a check."""

At = tuple[float, float]
Known = Mapping[At, MapPoint]
Keep = Callable[[list[MapPoint]], None]


@dataclass(slots=True, kw_only=True)
class Filled:
    """Points by their place in the grid.

    Attributes
    ----------
    found : dict
        Points that were run or refused.
    inferred : dict
        Decision of the points around one that was not run.
    checked : dict
        The same of points that were run as a check; they are among `found`, too.
    complete : bool
        False if an interrupt left points out.
    """

    found: dict[Place, MapPoint] = field(default_factory=dict)
    inferred: dict[Place, Verdict | None] = field(default_factory=dict)
    checked: dict[Place, Verdict | None] = field(default_factory=dict)
    complete: bool = True


def fill(
    question: MapQuestion,
    finder: Callable[[At], MapPoint],
    *,
    jobs: int,
    progress: Progress | None,
    known: Known,
    keep: Keep | None,
) -> Filled:
    """Find the points that the question wants; which these are does not depend on what is known.

    Parameters
    ----------
    question, finder
        What is asked, and what answers it at one point.
    jobs, progress, known, keep
        As in `stability_map`.
    """
    filling = _Filling(question, finder, jobs, progress, known, keep)
    filling.filled.complete = filling.by_rounds() and filling.by_checks()
    if not filling.filled.complete:
        filling.take_known(filling.grid)
    return filling.filled


class _Filling:
    def __init__(
        self,
        question: MapQuestion,
        finder: Callable[[At], MapPoint],
        jobs: int,
        progress: Progress | None,
        known: Known,
        keep: Keep | None,
    ) -> None:
        self.shape = len(question.x.values), len(question.y.values)
        self.grid = {
            (i, j): (x, y) for i, x in enumerate(question.x.values) for j, y in enumerate(question.y.values)
        }
        self.adaptive, self.finder, self.jobs = question.adaptive, finder, jobs
        self.progress, self.known, self.keep = progress, known, keep
        self.filled = Filled()

    def by_rounds(self) -> bool:
        """Find the wanted points of each finer grid; False after an interrupt."""
        for coarser, places in rounds(*self.shape):
            wanted = self._near_changes(places, coarser) if self.adaptive and coarser else places
            if not self._find(wanted):
                return False
        return True

    def by_checks(self) -> bool:
        """Run a sample of the inferred points; False after an interrupt."""
        inferred = self.filled.inferred
        sample = sorted(inferred)[CHECK_EVERY // 2 :: CHECK_EVERY]
        complete = self._find(sample)
        self.filled.checked = {place: inferred.pop(place) for place in sample if place in self.filled.found}
        return complete

    def take_known(self, places: Iterable[Place]) -> list[Place]:
        """Take the points that were finished before; return the places of the others."""
        others = []
        for place in places:
            if self.grid[place] in self.known:
                self.filled.found[place] = self.known[self.grid[place]]
            else:
                others.append(place)
        return others

    def _near_changes(self, places: list[Place], coarser: Lattice) -> list[Place]:
        """Places near a change of the decision; the others are inferred."""
        decisions = {place: point.decision for place, point in self.filled.found.items()}
        decisions |= self.filled.inferred
        wanted = [place for place in places if near_a_change(place, coarser, decisions)]
        others = set(places).difference(wanted)
        self.filled.inferred |= {place: decisions[around(place, coarser)[0]] for place in others}
        return wanted

    def _find(self, wanted: Iterable[Place]) -> bool:
        return work_in_batches(self._compute, self.take_known(wanted), self._take, jobs=self.jobs)

    def _compute(self, place: Place) -> tuple[Place, MapPoint]:
        return place, self.finder(self.grid[place])

    def _take(self, batch: list[tuple[Place, MapPoint]]) -> None:
        self.filled.found.update(batch)
        if self.keep is not None:
            self.keep([point for _, point in batch])
        if self.progress is not None:
            found, inferred = len(self.filled.found), len(self.filled.inferred)
            self.progress(found, max(found, len(self.grid) - inferred))
