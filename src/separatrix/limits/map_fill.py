"""Finds the points of a map, from a coarse grid to the full one: all of them, or those near a change."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from separatrix.cage import Verdict
from separatrix.limits.map_records import MapPoint, MapQuestion
from separatrix.runner import Interrupted, Runner

Place = tuple[int, int]
Lattice = tuple[list[int], list[int]]
"""Places of the columns and rows of a coarse grid."""

STRIDES = (8, 4, 2, 1)


def lattice(columns: int, rows: int, stride: int) -> Lattice:
    """Every `stride`-th column and row, and the last ones."""
    return _every(columns, stride), _every(rows, stride)


def _every(count: int, stride: int) -> list[int]:
    return sorted({*range(0, count, stride), count - 1})


def rounds(columns: int, rows: int) -> Iterator[tuple[Lattice | None, list[Place]]]:
    """Each finer grid's new places, and the coarser grid between whose places they lie."""
    seen: set[Place] = set()
    coarser: Lattice | None = None
    for stride in STRIDES:
        finer = lattice(columns, rows, stride)
        places = [(i, j) for i in finer[0] for j in finer[1] if (i, j) not in seen]
        seen.update(places)
        yield coarser, places
        coarser = finer


def around(place: Place, coarser: Lattice) -> list[Place]:
    """Corners of the coarse cell that a place lies in, and of the cells next to it."""
    near = [_around(at, marks) for at, marks in zip(place, coarser, strict=True)]
    return [(i, j) for i in near[0] for j in near[1]]


def near_a_change(place: Place, coarser: Lattice, answers: Mapping[Place, object]) -> bool:
    """Whether the answers of the coarser grid around a place differ."""
    found = [answers[corner] for corner in around(place, coarser)]
    return any(answer != found[0] for answer in found)


def _around(at: int, marks: list[int]) -> list[int]:
    """Marks on either side of a place, and one further each way."""
    after = bisect_left(marks, at)
    before = after if after < len(marks) and marks[after] == at else after - 1
    return marks[max(0, before - 1) : after + 2]


CHECK_EVERY = 20
"""Of the points that an adaptive map does not want, one in this number is run nevertheless, as a check."""

At = tuple[float, float]


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


def fill(question: MapQuestion, finder: Callable[[At], MapPoint], runner: Runner) -> Filled:
    """Find the points that the question wants.

    Parameters
    ----------
    question, finder
        What is asked, and what answers it at one point.
    runner : Runner
        Threads, progress, interrupts.

    Raises
    ------
    Interrupted
        With the points that were found, if any was.
    """
    filling = _Filling(question, finder, runner)
    try:
        filling.by_rounds()
        filling.by_checks()
    except Interrupted:
        filling.filled.complete = False
        raise Interrupted(filling.filled if filling.filled.found else None) from None
    return filling.filled


class _Filling:
    def __init__(self, question: MapQuestion, finder: Callable[[At], MapPoint], runner: Runner) -> None:
        self.shape = len(question.x.values), len(question.y.values)
        self.grid = {
            (i, j): (x, y) for i, x in enumerate(question.x.values) for j, y in enumerate(question.y.values)
        }
        self.adaptive, self.finder, self.runner = question.adaptive, finder, runner
        self.filled = Filled()

    def by_rounds(self) -> None:
        """Find the wanted points of each finer grid."""
        for coarser, places in rounds(*self.shape):
            self._find(self._near_changes(places, coarser) if self.adaptive and coarser else places)

    def by_checks(self) -> None:
        """Run a sample of the inferred points."""
        inferred = self.filled.inferred
        sample = sorted(inferred)[CHECK_EVERY // 2 :: CHECK_EVERY]
        self._find(sample)
        self.filled.checked = {place: inferred.pop(place) for place in sample if place in self.filled.found}

    def _near_changes(self, places: list[Place], coarser: Lattice) -> list[Place]:
        """Places near a change of the decision; the others are inferred."""
        decisions = {place: point.decision for place, point in self.filled.found.items()}
        decisions |= self.filled.inferred
        wanted = [place for place in places if near_a_change(place, coarser, decisions)]
        others = set(places).difference(wanted)
        self.filled.inferred |= {place: decisions[around(place, coarser)[0]] for place in others}
        return wanted

    def _find(self, wanted: Iterable[Place]) -> None:
        before, tell = len(self.filled.found), self.runner.progress

        def so_far(done: int, _: int) -> None:
            found = before + done
            if tell is not None:
                tell(found, max(found, len(self.grid) - len(self.filled.inferred)))

        self.runner.work_out(
            lambda place: self.finder(self.grid[place]),
            wanted,
            into=self.filled.found.update,
            progress=so_far,
        )
