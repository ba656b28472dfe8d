"""A test that differs from the others: a wrong column or a failed film, most likely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from separatrix.friction.reduction.reduction import Reduction
from separatrix.units import format_number

FEWEST = 4
"""Tests from which an outlier can be told."""

FACTOR = 1.5
"""Friction over the median of the others, or the reverse, from which a test may be an outlier."""

FAR = 5.0
"""Distance from that median over the usual one, in standard deviations."""


def with_outliers(reductions: Sequence[Reduction]) -> list[Reduction]:
    """Return the reductions, with a flag on each test far from its siblings.

    These are the other tests of its material and environment, or of all materials of its environment where
    the call has too few of its own.
    """
    found = list(reductions)
    for i, one in enumerate(reductions):
        friction, others, whose = one.test.friction, _others(reductions, i, same_material=True), ""
        if len(others) + 1 < FEWEST:
            others, whose = _others(reductions, i, same_material=False), " of all materials"
        if flag := _flag(friction, others, whose):
            found[i] = replace(one, test=replace(one.test, flags=(*one.test.flags, flag)))
    return found


def _others(reductions: Sequence[Reduction], i: int, *, same_material: bool) -> list[float]:
    """Friction of the other tests in the same environment."""
    own = reductions[i].test.conditions
    tests = [one.test for k, one in enumerate(reductions) if k != i]
    return [
        test.friction
        for test in tests
        if test.conditions.environment == own.environment
        and (test.conditions.material == own.material or not same_material)
    ]


def _flag(friction: float, others: Sequence[float], whose: str) -> str:
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
        f"tests{whose}, {format_number(usual, 3)}: check its material, its column and its plot."
    )
