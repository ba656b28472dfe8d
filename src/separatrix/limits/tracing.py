"""Which restitution factors a curve is computed at: few where it is straight, more where it bends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from separatrix.units import Ratio

Point = TypeVar("Point")

COARSE: tuple[Ratio, ...] = (0.0, 0.25, 0.5, 0.75, 0.875, 1.0)
"""Restitution factors to begin with: closer before 1, where balls gripped by their races damp nothing, the
critical friction falls to zero and a line from 0.75 would be taken for straight."""

FIRST_THREES = ((0.0, 0.25, 0.5), (0.5, 0.75, 1.0), (0.75, 0.875, 1.0))
FINEST: Ratio = 1.0 / 32.0
"""The least distance between two; all are halves of halves, so exact in binary."""

Bends = Callable[[Point, Point, Point], bool]
"""Whether the middle one of three points lies off the line between the others."""


def finer(eta: Ratio, found: Mapping[Ratio, Point], bends: Bends[Point]) -> list[tuple[Ratio, Ratio]]:
    """Neighbours half way between which a point is wanted once the point at `eta` is known.

    A middle that lies off the line between its neighbours has both its sides halved. What is answered for
    three points depends on these three only, so the points of a curve do not depend on their order.
    """
    wanted: list[tuple[Ratio, Ratio]] = []
    for low, middle, high in _threes(eta):
        known = [found[at] for at in (low, middle, high) if at in found]
        if high - middle >= 2.0 * FINEST and len(known) == 3 and bends(*known):
            halves = (low, middle), (middle, high)
            wanted += [half for half in halves if 0.5 * sum(half) not in COARSE]
    return wanted


def _threes(eta: Ratio) -> Iterator[tuple[Ratio, Ratio, Ratio]]:
    """Neighbours that `eta` completes: it is their middle, or one of the first."""
    if eta in COARSE:
        yield from (three for three in FIRST_THREES if eta in three)
        return
    gap = FINEST
    while eta % (2.0 * gap) == 0.0:
        gap *= 2.0
    yield eta - gap, eta, eta + gap
