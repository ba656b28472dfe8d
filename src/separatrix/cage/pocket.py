"""Ball and pocket: spring and race damper in series, with play, and the memory of each ball's lead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from separatrix.cage.flight import centre
from separatrix.cage.slots import GROSS, POCKET_FRICTION, SPIN, THETA, VX, VY
from separatrix.compiled import kernel


class Press(NamedTuple):
    """What the balls' forces on their pockets sum to."""

    cos: float  # sums of N cos, N sin and N [N]
    sin: float
    total: float
    edge_cos: float  # the same of what a touch or a parting inside the step takes off the trapezium rule
    edge_sin: float
    edge: float
    squares: float  # sum of N^2 [N2]
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
def press(p, cos, sin, s, place, slack, load, a, kept, followed):  # type: ignore[no-untyped-def]
    """Let every ball yield to the cage's new place; return what its forces sum to.

    Parameters
    ----------
    cos, sin : ndarray
        Directions of the balls, shape (ball,) [-].
    s : ndarray
        State of the cage.
    place : ndarray
        Centre and R theta at the start of the step, shape (3,) [m]; brought up to date.
    slack, load : ndarray
        Place u of each pocket against its ball [m], and its force N on it [N], shape (ball,); brought up to
        date.
    a, kept, followed : float
        As in `settle`, for the step.

    Returns
    -------
    Press
        What the forces sum to at the end of the step.
    """
    x, y = centre(p, s)
    turned = p.radius * s[THETA]
    dx, dy, dr = x - place[0], y - place[1], turned - place[2]
    place[0], place[1], place[2] = x, y, turned
    c = p.half_play
    sum_cos = sum_sin = total = squares = peak = 0.0
    edge_cos = edge_sin = edge = 0.0
    touching = changes = 0
    for j in range(cos.size):
        old, was = slack[j], load[j]
        new = old + (dy * cos[j] - dx * sin[j] + dr)
        slack[j] = new
        if was == 0.0 and c > 0.0 and -c <= new <= c:
            continue
        if c == 0.0:
            slack[j] = old * kept + (new - old) * followed
            n = p.stiffness * slack[j]
        else:
            side = 1.0 if (was if was != 0.0 else new) > 0.0 else -1.0
            q = (side * old - c) * kept + side * (new - old) * followed
            if was != 0.0 and q > 0.0:
                slack[j] = side * (c + q)
                n = side * p.stiffness * q
            else:
                q, gave, share = settle(side * old - c, side * new - c, a, kept, followed)
                slack[j] = new - side * gave
                n = side * p.stiffness * q
                miss = (n + was) * (share - 1.0)
                edge_cos += miss * cos[j]
                edge_sin += miss * sin[j]
                edge += miss
                changes += 1
        load[j] = n
        if n != 0.0:
            sum_cos += n * cos[j]
            sum_sin += n * sin[j]
            total += n
            squares += n * n
            peak = max(peak, abs(n))
            touching += 1
    return Press(sum_cos, sum_sin, total, edge_cos, edge_sin, edge, squares, peak, touching, changes)


@kernel
def kick(p, s, ledger, sum_cos, sum_sin, total, dt):  # type: ignore[no-untyped-def]
    """Kick the cage with -N e_t and the moment -N R of every ball, and the friction -sigma f N e_r."""
    rub_x, rub_y, rub_moment = -p.friction * sum_cos * dt, -p.friction * sum_sin * dt, 0.0
    impulse_x, impulse_y = sum_sin * dt + rub_x, -sum_cos * dt + rub_y
    moment = -total * p.radius * dt
    e = p.eccentricity
    if e != 0.0:
        c, i = e * np.cos(s[THETA]), e * np.sin(s[THETA])
        moment -= c * impulse_y - i * impulse_x
        rub_moment = i * rub_x - c * rub_y
    dvx, dvy, dw = impulse_x * p.lightness, impulse_y * p.lightness, moment * p.swiftness
    rubbed = rub_x * (s[VX] + 0.5 * dvx) + rub_y * (s[VY] + 0.5 * dvy) + rub_moment * (s[SPIN] + 0.5 * dw)
    s[VX] += dvx
    s[VY] += dvy
    s[SPIN] += dw
    ledger[POCKET_FRICTION] += rubbed
    ledger[GROSS] += abs(rubbed)
