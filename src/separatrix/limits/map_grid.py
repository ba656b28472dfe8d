"""In which order the points of a grid are computed, and which lie near a change of the answer."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping

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
