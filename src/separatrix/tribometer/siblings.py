"""A test that differs from the others of the same material: a wrong column or a failed film, most likely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from separatrix.tribometer.reduction import Reduction
from separatrix.units import format_number

FEWEST = 4
"""Tests from which an outlier can be told."""

FACTOR = 1.5
"""Friction over the median of the others, or the reverse, from which a test may be an outlier."""

FAR = 5.0
"""Distance from that median over the usual one, in standard deviations."""


def with_outliers(reductions: Sequence[Reduction]) -> list[Reduction]:
    """Return the reductions, with a flag on each test far from the others of its material and environment."""
    groups: dict[tuple[str | None, str | None], list[int]] = {}
    for i, one in enumerate(reductions):
        known = one.test.conditions
        groups.setdefault((known.material, known.environment), []).append(i)
    found = list(reductions)
    for places in groups.values():
        for i in places:
            others = [reductions[k].test.friction for k in places if k != i]
            if flag := _flag(reductions[i].test.friction, others):
                test = reductions[i].test
                found[i] = replace(found[i], test=replace(test, flags=(*test.flags, flag)))
    return found


def _flag(friction: float, others: Sequence[float]) -> str:
    """Return a sentence on a friction far from the others; empty for one among them."""
    if len(others) + 1 < FEWEST or friction <= 0.0 or min(others) <= 0.0:
        return ""
    logs = np.log(others)
    middle = float(np.median(logs))
    scatter = 1.4826 * float(np.median(np.abs(logs - middle)))
    distance = abs(float(np.log(friction)) - middle)
    if distance <= max(np.log(FACTOR), FAR * scatter):
        return ""
    usual = float(np.exp(middle))
    times = format_number(friction / usual, 2)
    return (
        f"Friction {format_number(friction, 3)} is {times} times the median of the other {len(others)} "
        f"tests, {format_number(usual, 3)}: check its material, its column and its plot."
    )
