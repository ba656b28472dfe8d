"""Ball and pocket: spring and race damper in series, with play, and the memory of each ball's lead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from separatrix.cage.compiled import kernel
from separatrix.cage.flight import centre, lean
from separatrix.cage.slots import GROSS, POCKET_FRICTION, THETA


class Press(NamedTuple):
    """What the balls' forces on their pockets sum to."""

    cos: float  # sums of N cos, N sin and N [N]
    sin: float
    total: float
    edge_cos: float  # the same of what a touch or a parting inside the step takes off the trapezium rule
    edge_sin: float
    edge: float
    squares: float  # sum of N^2 [N2]
    reach: float  # largest excursion |u| of a ball in its pocket [m]
    peak: float  # largest |N| [N]
    touching: int
    changes: int  # balls that touched or parted inside the step


@kernel
def relaxation(a):  # type: ignore[no-untyped-def]
    """Share of a penetration that is left after the time a (in units of C_mu/k), and of an even travel."""
    return np.exp(-a), (-np.expm1(-a) / a if a > 0.0 else 1.0)


@kernel
def settle(gap_start, gap_end, a, kept, followed):  # type: ignore[no-untyped-def]
    r"""Penetration at the end of a step in which one side of a pocket presses its ball.

    The ball yields by :math:`C_\mu \dot y = k q`, so that :math:`\dot q = \dot w - (k/C_\mu) q`; with the
    cage moving evenly through the step this is solved exactly, the touch and the parting inside the step
    included, and so it is stable for any :math:`C_\mu`.

    Parameters
    ----------
    gap_start, gap_end : float
        Penetration q at the start, and what it would be at the end if the ball did not yield [m]; negative is
        play.
    a, kept, followed : float
        k dt / C_mu, step over the ball's own time, and `relaxation` of it [-].

    Returns
    -------
    tuple of float
        Penetration at the end (0 if parted), how far the ball has yielded [m], and the share of the step in
        touch [-].
    """
    share = 1.0
    start = gap_start
    travel = gap_end - gap_start
    if gap_start <= 0.0:
        if gap_end <= 0.0:
            return 0.0, 0.0, 0.0
        share = gap_end / travel
        a *= share
        kept, followed = relaxation(a)
        start, travel = 0.0, gap_end
    end = start * kept + travel * followed
    if end > 0.0:
        return end, start + travel - end, share
    ratio = -a * start / travel if travel != 0.0 else 0.0
    parted = np.log1p(ratio) / a if a > 0.0 else -start / travel
    return 0.0, start + travel * parted, parted


@kernel
def press(p, cos, sin, s, seat, lead, load, a, kept, followed):  # type: ignore[no-untyped-def]
    """Let every ball yield to the cage's new place; return what its forces sum to.

    Parameters
    ----------
    cos, sin : ndarray
        Directions of the balls, shape (ball,) [-].
    s : ndarray
        State of the cage.
    seat : ndarray
        Circumferential place of each pocket, w = r.e_t + R theta, shape (ball,) [m]; brought up to date.
    lead, load : ndarray
        Lead y of each ball [m] and force N of the pocket on it [N], shape (ball,); brought up to date.

    Returns
    -------
    Press
        What the forces sum to at the end of the step.
    """
    x, y = centre(p, s)
    turned = p.radius * s[THETA]
    c = p.half_play
    sum_cos = sum_sin = total = squares = reach = peak = 0.0
    edge_cos = edge_sin = edge = 0.0
    touching = changes = 0
    for j in range(cos.size):
        w = y * cos[j] - x * sin[j] + turned
        old, new = seat[j] - lead[j], w - lead[j]
        seat[j] = w
        n = 0.0
        if c == 0.0:
            q = old * kept + (new - old) * followed
            lead[j] = w - q
            n = p.stiffness * q
        elif abs(old) > c or abs(new) > c:
            side = 1.0 if (old > c or (new > c and old >= -c)) else -1.0
            q, gave, share = settle(side * old - c, side * new - c, a, kept, followed)
            lead[j] += side * gave
            n = side * p.stiffness * q
            if share < 1.0:
                miss = (n + load[j]) * (share - 1.0)
                edge_cos += miss * cos[j]
                edge_sin += miss * sin[j]
                edge += miss
                changes += 1
        reach = max(reach, abs(w - lead[j]))
        load[j] = n
        if n != 0.0:
            sum_cos += n * cos[j]
            sum_sin += n * sin[j]
            total += n
            squares += n * n
            peak = max(peak, abs(n))
            touching += 1
    return Press(sum_cos, sum_sin, total, edge_cos, edge_sin, edge, squares, reach, peak, touching, changes)


@kernel
def kick(p, s, ledger, sum_cos, sum_sin, total, dt):  # type: ignore[no-untyped-def]
    """Kick the cage with -N e_t and the moment -N R of every ball, and the friction -sigma f N e_r."""
    f = p.friction
    normal = lean(p, s, sum_sin * dt, -sum_cos * dt, -total * p.radius * dt)
    rubbed = lean(p, s, -f * sum_cos * dt, -f * sum_sin * dt, 0.0)
    ledger[POCKET_FRICTION] += rubbed
    ledger[GROSS] += abs(rubbed)
    return normal
