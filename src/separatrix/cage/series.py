"""Power series in time, as columns of coefficients: products, values, and when one first falls to zero."""

from __future__ import annotations

import numpy as np

from separatrix.cage.slots import BODY
from separatrix.compiled import kernel

ORDER = 20
"""Terms of a series beyond the first. The step is chosen so that the last ones are below rounding."""

POWERS = ORDER + 3
NEVER = 2.0
"""Time of what does not happen within a step; a step lasts from 0 to 1."""

ROUNDING = 4.0 * 2.0**-52
MOST_MARCHES = 500
MOST_ZEROS = 3


@kernel
def product(w, a, b, n):  # type: ignore[no-untyped-def]
    """Coefficient n of the product of columns a and b."""
    total = 0.0
    for i in range(n + 1):
        total += w[i, a] * w[n - i, b]
    return total


@kernel
def value(w, column, t):  # type: ignore[no-untyped-def]
    """Value of a column at a time."""
    total = w[ORDER, column]
    for n in range(ORDER - 1, -1, -1):
        total = total * t + w[n, column]
    return total


@kernel
def slope(w, column, t):  # type: ignore[no-untyped-def]
    """Derivative of a column at a time."""
    total = ORDER * w[ORDER, column]
    for n in range(ORDER - 1, 0, -1):
        total = total * t + n * w[n, column]
    return total


@kernel
def body_values(w, t, out):  # type: ignore[no-untyped-def]
    """Values of the first columns at a time, into `out`."""
    for k in range(BODY):
        out[k] = w[ORDER, k]
    for n in range(ORDER - 1, -1, -1):
        for k in range(BODY):
            out[k] = out[k] * t + w[n, k]


@kernel
def stretch(w, first, last, factor):  # type: ignore[no-untyped-def]
    """Change the unit of time of some columns: one new unit is `factor` old ones."""
    power = factor
    for n in range(1, ORDER + 1):
        for k in range(first, last):
            w[n, k] *= power
        power *= factor


@kernel
def travel(w, column):  # type: ignore[no-untyped-def]
    """Bound on how far a column moves from its start within the step."""
    total = 0.0
    for n in range(1, ORDER + 1):
        total += abs(w[n, column])
    return total


@kernel
def first_zero(c, start, sign, end, noise):  # type: ignore[no-untyped-def]
    r"""First time up to `end` at which :math:`g = start + sign \sum_{n \ge 1} c_n t^n` has fallen to zero.

    From any time, :math:`g` lies above the parabola with its value, its slope and minus a bound of its
    curvature over the whole step. The zero of that parabola is a time up to which there is no zero of g; from
    there the next parabola starts. So the march converges to the first zero from below, quadratically, and
    cannot pass over it, however short the touch. A zero at the start (a contact that has just changed) is
    divided out; the first coefficient that is more than rounding then says which way g goes.

    Parameters
    ----------
    c : ndarray
        The series, shape (power,).
    start, sign : float
        As above; `start` is the first coefficient, computed without cancellation.
    end : float
        Time after which a zero is of no interest.
    noise : float
        Size of the numbers whose difference the series is: their rounding is no zero.

    Returns
    -------
    float
        The time, or `NEVER`.
    """
    scale = abs(start) + noise
    for n in range(1, ORDER + 1):
        scale += abs(c[n])
    tiny = ROUNDING * scale
    out = 0
    lead = start
    while lead <= tiny:
        if out > 0 and lead < -tiny:
            return 0.0
        out += 1
        if out > MOST_ZEROS:
            return NEVER
        lead = sign * c[out]
    bend = 0.0
    for n in range(out + 2, ORDER + 1):
        bend += (n - out) * (n - out - 1) * abs(c[n])
    t = 0.0
    for _ in range(MOST_MARCHES):
        g = d = 0.0
        for n in range(ORDER, out, -1):
            d = d * t + g
            g = g * t + c[n]
        d = sign * (d * t + g)
        g = lead + sign * g * t
        if g <= tiny:
            return t
        reach = np.sqrt(d * d + 2.0 * bend * g) - d
        if reach <= 0.0:
            return NEVER
        t += 2.0 * g / reach
        if t > end:
            return NEVER
    return t


@kernel
def copy_column(w, column, c):  # type: ignore[no-untyped-def]
    """Copy a column into one series."""
    for n in range(ORDER + 1):
        c[n] = w[n, column]


@kernel
def peak(c, sign, end):  # type: ignore[no-untyped-def]
    """Largest value of a series times `sign` up to a time: at its ends, or where it turns once between."""
    last, last_slope = c[ORDER], 0.0
    for n in range(ORDER - 1, -1, -1):
        last_slope = last_slope * end + last
        last = last * end + c[n]
    largest = max(sign * c[0], sign * last)
    if sign * c[1] <= 0.0 or sign * last_slope >= 0.0:
        return largest
    low, high = 0.0, end
    g = 0.0
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        g, d = c[ORDER], 0.0
        for n in range(ORDER - 1, -1, -1):
            d = d * middle + g
            g = g * middle + c[n]
        if sign * d > 0.0:
            low = middle
        else:
            high = middle
    return max(largest, sign * g)
