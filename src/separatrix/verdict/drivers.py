r"""What decides whether a bearing settles.

The runs of a case are described by a regression

.. math:: \operatorname{logit} P(\text{settles}) = b_0 + \sum_i b_i z_i

with the draws :math:`z_i` as standard normal numbers. The inputs are independent, so :math:`b_i^2` is what
input i adds to the variance of the logit, beside the :math:`\pi^2/3` of a logistic variable that is the
chance of the single run: its disturbance and the leads of its balls. The regression is tested on bearings
that it was not fitted to.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import expit, stdtrit, xlogy

from separatrix.ground.units import Array, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Part of a variance that one input brings, and its 95 % interval [-]."""

    name: str  # the input; chance is that of the single run
    share: Ratio  # of the variance
    share_low: Ratio  # lower end of the 95 % interval
    share_high: Ratio  # upper end of the 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Drivers:
    """Which inputs decide whether a bearing with a candidate's cage settles."""

    name: str  # of the candidate
    shares: tuple[Share, ...]
    """Of the variance of the logit of P(settles), largest first, chance last; empty where `reason` states
    why."""
    reason: str  # why there are no shares; empty otherwise
    skill: Ratio | None  # part of the deviance that the fit removes, on bearings left out


PRIOR = 3.0  # standard deviation of the coefficients beforehand: a separation by one input alone stays finite
FOLDS = 8  # parts of the bearings, each left out of one fit
FEWEST = 30  # bearings of the rarer outcome below which the inputs are not compared
LEAST_SKILL: Ratio = 0.02  # part of the deviance below which the inputs explain nothing that counts
CHANCE = "chance of the single run"
CHANCE_VARIANCE = math.pi**2 / 3.0


def drivers(name: str, names: Sequence[str], scores: Array, settled: Array) -> Drivers:
    """Shares of the inputs in the variance of a candidate's logit, with the skill on bearings left out.

    `names` are the inputs, `scores` their draws as standard normal numbers, shape (bearing, input); `settled`
    is 1 where the bearing settles, shape (bearing,).
    """
    rare = int(min(settled.sum(), settled.size - settled.sum()))
    skill: Ratio | None = None
    shares: tuple[Share, ...] = ()
    reason = f"{rare} of {settled.size} bearings end otherwise: too few to compare; draw more"
    if rare >= FEWEST and names:
        of_mean = _deviance(np.full(settled.size, settled.mean()), settled)
        skill = 1.0 - _deviance(_left_out(scores, settled), settled) / of_mean
        shares = _shares(names, scores, settled) if skill >= LEAST_SKILL else ()
        reason = f"the inputs explain {max(0.0, 100.0 * skill):.1f} % of the deviance only"
    return Drivers(
        name=name,
        shares=shares,
        reason="" if shares else reason,
        skill=skill,
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
