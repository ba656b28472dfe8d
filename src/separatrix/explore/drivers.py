r"""Which uncertain inputs decide whether a bearing settles: a regression of the runs themselves.

.. math:: \operatorname{logit} P(\text{settles}) = b_0 + \sum_i b_i z_i

with the draws :math:`z_i` as standard normal numbers. The inputs are independent, so :math:`b_i^2` is what
input i brings to the variance of the logit, beside the :math:`\pi^2/3` of a logistic variable that is the
chance of the single run: its disturbance and the leads of its balls. What the regression is worth is measured
on bearings that it has not seen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import expit, stdtrit, xlogy

from separatrix.draws import Case
from separatrix.explore.records import Drivers, Share
from separatrix.units import Array, Ratio

PRIOR = 3.0
"""Standard deviation of the coefficients beforehand: a separation by one input alone stays finite."""

FOLDS = 8
"""Parts of the bearings, each left out of one fit."""

FEWEST = 30
"""Bearings of the rarer outcome without which nothing is said."""

LEAST_SKILL: Ratio = 0.02
"""Part of the deviance below which the inputs explain nothing that counts."""

BINS = 5
CHANCE = "chance of the single run"
CHANCE_VARIANCE = math.pi**2 / 3.0


def drivers(case: Case, names: Sequence[str], scores: Array, settled: Array) -> Drivers:
    """Shares of the inputs in the variance of a case's logit, with calibration on bearings left out.

    Parameters
    ----------
    case : Case
        Whose.
    names : sequence of str
        Inputs of the columns.
    scores : ndarray
        Draws as standard normal numbers, shape (bearing, input).
    settled : ndarray
        1 where the bearing settles, shape (bearing,).
    """
    rare = int(min(settled.sum(), settled.size - settled.sum()))
    if rare < FEWEST or not names:
        return _silent(case, f"{rare} of {settled.size} bearings end otherwise: too few to compare")
    unseen = _left_out(scores, settled)
    skill = 1.0 - _deviance(unseen, settled) / _deviance(np.full(settled.size, settled.mean()), settled)
    predicted, counted, bearings = _bins(unseen, settled)
    shares = _shares(names, scores, settled) if skill >= LEAST_SKILL else ()
    return Drivers(
        name=case.candidate,
        environment=case.environment,
        shares=shares,
        reason="" if shares else f"the inputs explain {max(0.0, 100.0 * skill):.1f} % of the deviance only",
        predicted=predicted,
        counted=counted,
        bearings=bearings,
        skill=float(skill),
    )


def _silent(case: Case, reason: str) -> Drivers:
    none = np.zeros(0)
    return Drivers(
        name=case.candidate,
        environment=case.environment,
        shares=(),
        reason=reason,
        predicted=none,
        counted=none,
        bearings=none,
        skill=None,
    )


def fitted(scores: Array, settled: Array) -> Array:
    """Coefficients of the regression, the constant first, shape (1 + input,): Newton's steps."""
    design = np.column_stack((np.ones(len(scores)), scores))
    penalty = np.full(design.shape[1], PRIOR**-2)
    penalty[0] = 0.0
    share = np.clip(settled.mean(), 0.5 / settled.size, 1.0 - 0.5 / settled.size)
    b = np.zeros(design.shape[1])
    b[0] = math.log(share / (1.0 - share))
    for _ in range(MOST_STEPS):
        p = expit(design @ b)
        gradient = design.T @ (settled - p) - penalty * b
        curvature = (design.T * (p * (1.0 - p))) @ design + np.diag(penalty)
        step = np.linalg.solve(curvature, gradient)
        b += step * min(1.0, LONGEST_STEP / max(np.abs(step).max(), 1e-300))
        if np.abs(step).max() < 1e-10:
            break
    return b


MOST_STEPS, LONGEST_STEP = 100, 2.0


def _left_out(scores: Array, settled: Array) -> Array:
    """Prediction for each bearing by a fit to the others, shape (bearing,)."""
    fold = np.arange(settled.size) % FOLDS
    found = np.empty(settled.size)
    for k in range(FOLDS):
        b = fitted(scores[fold != k], settled[fold != k])
        found[fold == k] = expit(b[0] + scores[fold == k] @ b[1:])
    return found


def _deviance(predicted: Array, settled: Array) -> float:
    return float(-2.0 * np.sum(xlogy(settled, predicted) + xlogy(1.0 - settled, 1.0 - predicted)))


def _bins(predicted: Array, settled: Array) -> tuple[Array, Array, Array]:
    """Mean prediction, counted share and number of bearings of each bin, as many bearings in each."""
    parts = np.array_split(np.argsort(predicted, kind="stable"), BINS)
    rows = [(predicted[one].mean(), settled[one].mean(), float(one.size)) for one in parts]
    columns = np.array(rows).T
    return columns[0], columns[1], columns[2]


def _shares(names: Sequence[str], scores: Array, settled: Array) -> tuple[Share, ...]:
    """Share of each input, largest first, and of chance; intervals by the jackknife over the folds."""
    fold = np.arange(settled.size) % FOLDS
    whole = _parts(fitted(scores, settled))
    others = np.array([_parts(fitted(scores[fold != k], settled[fold != k])) for k in range(FOLDS)])
    scatter = np.sqrt((FOLDS - 1.0) / FOLDS * np.sum((others - others.mean(axis=0)) ** 2, axis=0))
    half = float(stdtrit(FOLDS - 1, 0.975)) * scatter
    rows = [
        Share(name=name, share=float(x), share_low=max(0.0, float(x - h)), share_high=min(1.0, float(x + h)))
        for name, x, h in zip((*names, CHANCE), whole, half, strict=True)
    ]
    return (*sorted(rows[:-1], key=lambda one: -one.share), rows[-1])


def _parts(b: Array) -> Array:
    """Shares of the inputs and of chance in the variance of the logit."""
    parts = np.append(b[1:] ** 2, CHANCE_VARIANCE)
    return np.asarray(parts / parts.sum())
