"""Whether two numbers with intervals differ by more than the scatter of what they were counted from.

Newcombe's hybrid score interval of the difference of two independent shares takes, at each end, the distances
of both shares to the ends of their Wilson intervals and adds them as squares (R. G. Newcombe, Interval
estimation for the difference between independent proportions, Statistics in Medicine 17, 1998, method 10).
The same with any two 95 % intervals is the method of variance estimates recovery (Zou and Donner, 2008).
"""

from __future__ import annotations

import math


def difference_interval(
    first: tuple[float, float, float], second: tuple[float, float, float]
) -> tuple[float, float]:
    """95 % interval of the second value less the first; each is (value, low, high) with its 95 % interval.

    For Wilson's intervals of two shares this is Newcombe's. It takes the two as independent: where both
    answers draw the same runs, it is too wide if at all.
    """
    (a, a_low, a_high), (b, b_low, b_high) = first, second
    change = b - a
    return change - math.hypot(b - b_low, a_high - a), change + math.hypot(b_high - b, a - a_low)
