"""Power series in time: products, values, and when one first falls to zero.

A series is the array of its coefficients, shape (power,); a step lasts from 0 to 1.
"""

from __future__ import annotations

import numpy as np

from separatrix.cage.features import harmonics, has_unbalance
from separatrix.cage.records import ORDER, POWERS, Balls, Coefficients, Series
from separatrix.compiled import inlined_kernel, inner_kernel
from separatrix.units import Array

NEVER = 2.0
"""Time of what does not happen within a step."""

ROUNDING = 4.0 * 2.0**-52
MOST_MARCHES = 500
NEAR = 1e-8
"""Last step of Newton's method, in steps: the error left is of its square."""

LAST_TURN = 1e-2
"""Last step towards a peak, in steps: the error of its height is of the cube."""

MOST_ZEROS = 3

STAYS, FALLS, MAY_FALL = range(3)
"""Above zero between two knots; falls through zero once; or undetermined."""

THIRD = 1.0 / 3.0
SLOPE_OFF = np.sqrt(3.0) / 216.0
AFTER = 1.0 / np.arange(1.0, POWERS + 1.0)
"""1 / (n + 1)."""

_POWER = np.arange(ORDER + 1.0)
_FOURTH = _POWER * (_POWER - 1.0) * (_POWER - 2.0) * (_POWER - 3.0)
HALVES, HALF_SLOPES = 0.5**_POWER, _POWER * 0.5**_POWER
EARLY, LATE = _FOURTH * 0.5**_POWER, _FOURTH * 0.5**4

Knots = tuple[float, float, float, float, float, float]
"""Value and slope of a series at the start, in the middle and at the end of a step.

Slopes are times half the step.
"""

Place = tuple[float, float, float, float, float, float, float]
"""Centre (x, y), slip s, and E_x, E_y, E_s and e of the pockets in touch."""

Motion = tuple[float, float, float, float, float, float]
"""Centre of mass (x, y), its velocity, slip of rotation and its rate."""


@inner_kernel
def product(a: Array, b: Array, n: int) -> float:
    r"""Coefficient n of the product of two series."""
    # (a b)_n = sum_i a_i b_(n-i)
    total = 0.0
    for i in range(n + 1):
        total += a[i] * b[n - i]
    return total


@inlined_kernel
def value(c: Array, t: float) -> float:
    """Value of a series at a time."""
    total: float = c[ORDER]
    for n in range(ORDER - 1, -1, -1):
        total = total * t + c[n]
    return total


@inner_kernel
def slope(c: Array, t: float) -> float:
    """Derivative of a series at a time."""
    total: float = ORDER * c[ORDER]
    for n in range(ORDER - 1, 0, -1):
        total = total * t + n * c[n]
    return total


@inlined_kernel
def centre(p: Coefficients, w: Series) -> tuple[Array, Array]:
    """Series of the geometric centre."""
    return (w.gx, w.gy) if has_unbalance(p) else (w.x, w.y)


@inlined_kernel
def motion_at(w: Series, t: float) -> Motion:
    """Motion of the cage at a time."""
    x = y = vx = vy = s = vs = 0.0
    for n in range(ORDER, -1, -1):
        x, y, vx = x * t + w[n].x, y * t + w[n].y, vx * t + w[n].vx
        vy, s, vs = vy * t + w[n].vy, s * t + w[n].s, vs * t + w[n].vs
    return x, y, vx, vy, s, vs


@inlined_kernel
def grip_at(w: Series, t: float) -> tuple[float, float, float, float]:
    """What linear pockets in touch follow, at a time: E_x, E_y, E_s and e, see `expand`."""
    ex = ey = es = kept = 0.0
    for n in range(ORDER, -1, -1):
        ex, ey = ex * t + w[n].ex, ey * t + w[n].ey
        es, kept = es * t + w[n].es, kept * t + w[n].kept
    return ex, ey, es, kept


@inlined_kernel
def tail_at(c: Array, first: int, t: float) -> tuple[float, float]:
    r"""Value and slope at a time of :math:`\sum_m c_{first + m} t^m`; even and odd powers side by side."""
    m = ORDER - first
    square = t * t
    even = odd = even_slope = odd_slope = 0.0
    if m % 2 == 0:
        even, even_slope = c[first + m], m * c[first + m]
        m -= 1
    while m > 1:
        odd, odd_slope = odd * square + c[first + m], odd_slope * square + m * c[first + m]
        even = even * square + c[first + m - 1]
        even_slope = even_slope * square + (m - 1) * c[first + m - 1]
        m -= 2
    odd, odd_slope = odd * square + c[first + 1], odd_slope * square + c[first + 1]
    return even * square + c[first] + t * odd, odd_slope + t * even_slope


@inner_kernel
def first_zero(c: Array, start: float, sign: float, end: float, noise: float) -> float:
    r"""First time up to `end` at which :math:`g = start + sign \sum_{n \ge 1} c_n t^n` has fallen to zero.

    From any time, :math:`g` lies above the parabola with its value, its slope and minus a bound of its
    curvature up to `end`. The zero of that parabola is a time up to which there is no zero of g; from
    there the next parabola starts. So the march converges to the first zero from below, quadratically, and
    cannot pass over it, however short the touch. A zero at the start (a contact that has just changed) is
    divided out; the first coefficient that is more than rounding then decides which way g goes.

    Parameters
    ----------
    c : ndarray
        The series, shape (power,).
    start, sign : float
        As above; `start` is the first coefficient, computed without cancellation.
    end : float
        Time after which a zero is of no interest.
    noise : float
        Size of the numbers whose difference the series is: their rounding is not a zero.

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
    power = 1.0
    for n in range(out + 2, ORDER + 1):
        bend += (n - out) * (n - out - 1) * abs(c[n]) * power
        power *= end
    t = 0.0
    for _ in range(MOST_MARCHES):
        g, d = tail_at(c, out + 1, t)
        d = sign * (d * t + g)
        g = lead + sign * g * t
        if g <= tiny:
            return t
        root = np.sqrt(d * d + 2.0 * bend * g)
        if d < 0.0:
            t += 2.0 * g / (root - d)
        elif bend > 0.0:  # the same, without the difference of root and slope: rounding where g is small
            t += (root + d) / bend
        else:
            return NEVER
        if t > end:
            return NEVER
    return t


@inlined_kernel
def larger(a: float, b: float) -> float:
    """Larger of two numbers, without a branch."""
    return a if a > b else b


@inlined_kernel
def smaller(a: float, b: float) -> float:
    """Smaller of two numbers, without a branch."""
    return a if a < b else b


@inlined_kernel
def knots(c: Array) -> Knots:
    """Knots of a series."""
    middle = last = c[0]
    turn = fall = 0.0
    for n in range(1, ORDER + 1):
        middle, last = middle + HALVES[n] * c[n], last + c[n]
        turn, fall = turn + HALF_SLOPES[n] * c[n], fall + 0.5 * n * c[n]
    return c[0], 0.5 * c[1], middle, turn, last, fall


@inlined_kernel
def fourths(a: Array, b: Array, c: Array, kept: Array, most: float) -> tuple[float, float]:
    """Bound, in each half of the step, of the fourth derivative of what any pocket makes of three series.

    With `most` times what is kept of a penetration.
    """
    early = late = 0.0
    for n in range(4, ORDER + 1):
        size = abs(a[n]) + abs(b[n]) + abs(c[n])
        if most > 0.0:
            size += most * abs(kept[n])
        early += EARLY[n] * size
        late += LATE[n] * size
    return early, late


@inlined_kernel
def bends(c: Array) -> tuple[float, float]:
    """Bound of the fourth derivative of a series in each half of the step."""
    early = late = 0.0
    for n in range(4, ORDER + 1):
        early, late = early + EARLY[n] * abs(c[n]), late + LATE[n] * abs(c[n])
    return early, late


@inlined_kernel
def gone_at(p: Coefficients, balls: Balls, knot: Array, j: int) -> float:
    """How far ball j has gone at a knot by its free speed, or how fast it goes."""
    total = 0.0
    for k in range(2 * harmonics(p)):
        total += balls.drive[k, j] * knot[k]
    return total


@inlined_kernel
def falling(
    start: float, start_slope: float, last: float, last_slope: float, fourth: float, tiny: float
) -> int:
    """What a function does between two knots, from its values and its slopes times their distance there.

    Values up to `tiny` are no more than rounding.

    The cubic through them stays between the corners of its Bezier polygon. The function differs from that
    cubic by no more than 1/384 of its fourth derivative (`fourth`: times the fourth power of the distance),
    its slope by sqrt(3)/216, its curvature by 1/12 (Birkhoff and Priver 1967): falling, or concave,
    throughout, it has one zero. At a share t of the way it differs by no more than
    fourth t^2 (1 - t)^2 / 24, less than 1/144 of it in both inner corners make up for.
    """
    one, two = start + THIRD * start_slope, last - THIRD * last_slope
    inner, outer = min(one, two), min(start, last)
    if min(inner, outer) > fourth * (1.0 / 384.0) or (outer > 0.0 and inner > fourth * (1.0 / 144.0)):
        return STAYS
    if start > 0.0 and last < -tiny:
        if max(one - start, two - one, last - two) < -THIRD * SLOPE_OFF * fourth:
            return FALLS
        if max(start - 2.0 * one + two, one - 2.0 * two + last) < -fourth * (1.0 / 72.0):
            return FALLS
    return MAY_FALL


@inlined_kernel
def top(start: float, start_slope: float, last: float, last_slope: float, fourth: float) -> float:
    """Bound from above of a function between two knots, as in `falling`."""
    return max(start, last, start + THIRD * start_slope, last - THIRD * last_slope) + fourth * (1.0 / 384.0)


@inlined_kernel
def cubic_zero(start: float, start_slope: float, last: float, last_slope: float) -> float:
    """Share of the way between two knots at which the cubic through them last is about zero.

    A function that rises first may begin within rounding of zero: its zero is looked for from behind.
    """
    square = 3.0 * (last - start) - 2.0 * start_slope - last_slope
    cube = 2.0 * (start - last) + start_slope + last_slope
    x = 1.0 if start_slope > 0.0 else start / (start - last)
    for _ in range(4):
        f = ((cube * x + square) * x + start_slope) * x + start
        rate = (3.0 * cube * x + 2.0 * square) * x + start_slope
        x = min(1.0, max(0.0, x - f / rate)) if rate != 0.0 else x
    return x


@inlined_kernel
def earliest_zero(c: Array, at: Knots, sign: float, early: int, late: int, end: float, noise: float) -> float:
    """First zero as by `first_zero`, from the knots and what each half of the step does."""
    start, rise, middle, turn, last, fall = at
    if early == FALLS:
        guess = 0.5 * cubic_zero(start, rise, middle, turn)
        return single_zero(c, start, sign, 0.0, min(0.5, end), guess, noise)
    if early == MAY_FALL:
        t = first_zero(c, start, sign, min(end, 0.5), noise)
        if t < NEVER:
            return t
    if late == STAYS or end <= 0.5:
        return NEVER
    if late == FALLS:
        guess = 0.5 + 0.5 * cubic_zero(middle, turn, last, fall)
        return single_zero(c, start, sign, 0.5, end, guess, noise)
    return first_zero(c, start, sign, end, noise)


@inner_kernel
def single_zero(
    c: Array, start: float, sign: float, low: float, high: float, guess: float, noise: float
) -> float:
    r"""Zero of :math:`start + sign \sum_{n \ge 1} c_n t^n` up to `high`, if its only one is before."""
    tiny = ROUNDING * (abs(start) + noise)
    for n in range(1, ORDER + 1):
        tiny += ROUNDING * abs(c[n])
    limit = high
    t = min(guess, limit)
    for _ in range(MOST_MARCHES):
        g, d = tail_at(c, 1, t)
        d = sign * (d * t + g)
        g = start + sign * g * t
        if abs(g) <= tiny:
            break
        if g > 0.0 and t == limit:
            return NEVER
        if g > 0.0:
            low = t
        else:
            high = t
        t -= g / d
        if abs(g) < NEAR * abs(d) and low < t < high:
            break
        if t >= limit and high == limit:
            t = limit
        elif not low < t < high:
            t = 0.5 * (low + high)
            if not low < t < high:
                break
    return t


@inner_kernel
def copy_column(column: Array, c: Array) -> None:
    """Copy a column of `Series` into a series of its own."""
    for n in range(ORDER + 1):
        c[n] = column[n]


@inner_kernel
def peak(c: Array, sign: float, end: float) -> float:
    """Largest value of a series times `sign` up to a time: at its ends, or where it turns once between.

    Where it turns is found by Newton's steps, the last of which is followed by its parabola.
    """
    last, last_slope = c[ORDER], 0.0
    for n in range(ORDER - 1, -1, -1):
        last_slope = last_slope * end + last
        last = last * end + c[n]
    largest: float = max(sign * c[0], sign * last)
    if sign * c[1] <= 0.0 or sign * last_slope >= 0.0:
        return largest
    low, high, step = 0.0, end, 0.0
    t = end * c[1] / (c[1] - last_slope)
    g = d = 0.0
    for _ in range(MOST_MARCHES):
        g, d, bend = c[ORDER], 0.0, 0.0
        for n in range(ORDER - 1, -1, -1):
            bend = bend * t + d
            d = d * t + g
            g = g * t + c[n]
        if sign * d > 0.0:
            low = t
        else:
            high = t
        step = -0.5 * d / bend if bend != 0.0 else NEVER
        if not low <= t + step <= high:
            step = 0.5 * (low + high) - t
        if abs(step) < LAST_TURN:
            break
        t += step
    return max(largest, float(sign * (g + 0.5 * d * step)))
