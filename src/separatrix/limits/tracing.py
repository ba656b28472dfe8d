"""Which restitution factors a curve is computed at: few where it is straight, more where it bends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from separatrix.units import Ratio

Point = TypeVar("Point")

COARSE: tuple[Ratio, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
FINEST: Ratio = 1.0 / 32.0
"""Restitution factors to begin with, and the least distance between two; halves, so exact in binary."""

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
            wanted += [(low, middle), (middle, high)]
    return wanted


def _threes(eta: Ratio) -> Iterator[tuple[Ratio, Ratio, Ratio]]:
    """Neighbours that `eta` completes: it is their middle, or one of the first five."""
    if eta in COARSE:
        for i in range(0, len(COARSE) - 2, 2):
            if eta in COARSE[i : i + 3]:
                yield COARSE[i], COARSE[i + 1], COARSE[i + 2]
        return
    gap = FINEST
    while eta % (2.0 * gap) == 0.0:
        gap *= 2.0
    yield eta - gap, eta, eta + gap
