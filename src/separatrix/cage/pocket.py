"""Ball and pocket: spring and race damper in series, with play, and the memory of each ball's lead."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

kernel: Any = nb.njit(cache=True, nogil=True, error_model="numpy")


@kernel
def relaxation(a):  # type: ignore[no-untyped-def]
    """Share of a penetration that is left after the time a (in units of C_mu/k), and of an even travel."""
    return np.exp(-a), (-np.expm1(-a) / a if a > 0.0 else 1.0)


@kernel
def settle(gap_start, gap_end, a, kept, followed):  # type: ignore[no-untyped-def]
    r"""Penetration at the end of a step in which one side of a pocket presses its ball.

    The ball yields by :math:`C_\mu \dot y = k q`, so that :math:`\dot q = \dot w - (k/C_\mu) q`; with the cage
    moving evenly through the step this is solved exactly, the touch and the parting inside the step included,
    and so it is stable for any :math:`C_\mu`.

    Parameters
    ----------
    gap_start, gap_end : float
        Penetration q at the start, and what it would be at the end if the ball did not yield [m]; negative is play.
    a, kept, followed : float
        k dt / C_mu, step over the ball's own time, and `relaxation` of it [-].

    Returns
    -------
    tuple of float
        Penetration at the end (0 if parted), how far the ball has yielded [m], and the share of the step in touch [-].
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
