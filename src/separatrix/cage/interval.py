"""95 % intervals of what an ensemble says: of a share (Wilson) and of a mean (Student)."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import stdtrit

from separatrix.units import Array, Ratio

NORMAL_95 = 1.959963984540054


def wilson_interval(successes: int, count: int, normal: float = NORMAL_95) -> tuple[Ratio, Ratio]:
    """Wilson's interval of a share, 95 % or that of another normal quantile [-]; 0 to 1 without a trial."""
    if count == 0:
        return 0.0, 1.0
    p, z2 = successes / count, normal**2
    middle = (p + z2 / (2 * count)) / (1 + z2 / count)
    half = normal / (1 + z2 / count) * math.sqrt(p * (1 - p) / count + z2 / (4 * count * count))
    low, high = max(0.0, middle - half), min(1.0, middle + half)
    return min(low, p), max(high, p)  # rounding would leave none and all just outside


def mean_half_width(values: Array) -> float | None:
    """Half the width of Student's 95 % interval of the mean; None where fewer than two values tell none."""
    count = values.size
    if count < 2:
        return None
    return float(stdtrit(count - 1, 0.975) * np.std(values, ddof=1) / math.sqrt(count))
