r"""First-order and total Sobol indices of what the chain computes smoothly: restitution factor, race damping.

With matrices A and B of n draws each, and A with column i of B (Saltelli et al. 2010, Computer Physics
Communications 181, 259-270, table 2, rows b and f; the second is Jansen's, 1999):

.. math:: S_i \approx \frac{\overline{f(B)\,(f(A_B^{(i)}) - f(A))}}{\operatorname{Var} f}, \qquad
          T_i \approx \frac{\overline{(f(A) - f(A_B^{(i)}))^2}}{2 \operatorname{Var} f}

The draws are independent scramblings of Sobol' points; what changes when one of them is left out is the
scatter of an index.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.special import stdtrit

from separatrix.explore.records import Share
from separatrix.units import Array

BLOCKS, EACH = 8, 32
"""Independent scramblings, and draws in each."""

HALF_STEP = 2.0**-31
"""Half the step of the points: keeps them off 0 and 1."""

# Answers rows of probabilities, shape (draw, input), with shape (draw, quantity).
Model = Callable[[Array], Array]


def sobol_shares(
    model: Model, names: Sequence[str], *, seed: int
) -> list[tuple[tuple[Share, ...], tuple[Share, ...]]]:
    """First-order and total indices for each quantity of a model, largest total first.

    Parameters
    ----------
    model : callable
        Takes points in the unit cube.
    names : sequence of str
        Its inputs, independent of each other.
    seed : int
        Of the scramblings.
    """
    count = len(names)
    points = np.concatenate([_points(2 * count, (seed, block)) for block in range(BLOCKS)])
    a, b = points[:, :count], points[:, count:]
    mixed = []
    for i in range(count):
        rows = a.copy()
        rows[:, i] = b[:, i]
        mixed.append(rows)
    answers = np.array([model(rows) for rows in (a, b, *mixed)])  # shape (matrix, draw, quantity)
    return [_indices(names, answers[:, :, q]) for q in range(answers.shape[2])]


def _points(dimensions: int, seed: tuple[int, int]) -> Array:
    from scipy.stats import qmc  # dear to import, and only this needs it

    engine = qmc.Sobol(dimensions, scramble=True, rng=np.random.default_rng(seed))
    return np.asarray(engine.random(EACH)) + HALF_STEP


def _indices(names: Sequence[str], values: Array) -> tuple[tuple[Share, ...], tuple[Share, ...]]:
    """Indices of one quantity from its values, shape (matrix, draw)."""
    block = np.arange(values.shape[1]) // EACH
    whole = _estimates(values)
    others = np.array([_estimates(values[:, block != k]) for k in range(BLOCKS)])
    scatter = np.sqrt((BLOCKS - 1.0) / BLOCKS * np.sum((others - others.mean(axis=0)) ** 2, axis=0))
    half = float(stdtrit(BLOCKS - 1, 0.975)) * scatter
    order = np.argsort(-whole[1], kind="stable")
    first, total = (
        tuple(_share(names[i], float(whole[kind, i]), float(half[kind, i])) for i in order) for kind in (0, 1)
    )
    return first, total


def _estimates(values: Array) -> Array:
    """First-order and total indices, shape (2, input); 0 where nothing varies."""
    centred = values - values[:2].mean()
    a, b, mixed = centred[0], centred[1], centred[2:]
    variance = float(np.mean(centred[:2] ** 2))
    if variance == 0.0:
        return np.zeros((2, len(mixed)))
    first = np.mean(b * (mixed - a), axis=1)
    total = 0.5 * np.mean((mixed - a) ** 2, axis=1)
    return np.array([first, total]) / variance


def _share(name: str, value: float, half: float) -> Share:
    value = min(max(value, 0.0), 1.0)
    return Share(name=name, share=value, share_low=max(0.0, value - half), share_high=min(1.0, value + half))
