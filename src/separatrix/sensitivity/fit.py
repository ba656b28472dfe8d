r"""The restitution factor fitted to samples of the chain, with its error measured and carried.

The chain takes milliseconds a sample; threshold and verdict take microseconds. So the logarithm of the
damping ratio, a smooth function of few inputs, is fitted by polynomials of them, and the verdict is asked of
the model itself. The error is that of samples that a fit has not seen: each left out in turn.

With :math:`g` the fitted quantity and :math:`e` its error, the variance that goes with a factor is a squared
norm of a projection :math:`P`, and :math:`\|Pg\| - \|e\| \le \|P(g + e)\| \le \|Pg\| + \|e\|`. So

.. math:: \frac{\sqrt{S} - \delta}{1 + \delta} \le \sqrt{S'} \le \frac{\sqrt{S} + \delta}{1 - \delta},
    \quad \delta^2 = \operatorname{Var} e / \operatorname{Var} g,

for first-order and total indices alike. That is a bound, not a guess.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from separatrix.sensitivity.design import is_stable
from separatrix.sensitivity.question import Evaluated, Question
from separatrix.sensitivity.records import CaseSobol, Estimate, SobolAnswer, SobolIndex
from separatrix.sensitivity.region import damping_ratios, restitution_factors
from separatrix.uncertainty.polynomial import Basis, best_basis
from separatrix.units import Array, Ratio


@dataclass(frozen=True, slots=True, kw_only=True)
class FitError:
    """How well the restitution factor was fitted, told by samples that the fit had not seen.

    Attributes
    ----------
    restitution_factor : float
        Root of the mean squared error over all cases [-].
    missed : float
        Share of the variance of the restitution factor that is missed, the largest of all cases [-].
    margin : tuple of float
        Mean squared error of each case's margin [-].
    verdict : tuple of float
        Share of samples whose verdict changes from STABLE or to it, of each case [-].
    degree : int
        Of the polynomial.
    logarithmic : bool
        Whether positive inputs enter by their logarithm.
    samples : int
        Behind it.
    """

    restitution_factor: Ratio
    missed: Ratio
    margin: tuple[float, ...]
    verdict: tuple[Ratio, ...]
    degree: int
    logarithmic: bool
    samples: int


def fitted_question(question: Question, values: Array, answers: Evaluated) -> tuple[Question, FitError]:
    """The question with a fitted restitution factor in the place of the chain's.

    Parameters
    ----------
    question : Question
        With `judge`.
    values : ndarray
        Samples that were evaluated, shape (sample, input) [SI].
    answers : Evaluated
        What the model said of them.

    Returns
    -------
    Question, FitError
        The new question asks `judge` alone; the error of its restitution factor, margin and verdict.

    Raises
    ------
    InputError
        No `judge`, or too few samples for a straight line.
    """
    judge, factor = question.judged(), answers.threshold - answers.margin
    target = np.log(damping_ratios(factor))
    basis, unseen = best_basis(values, _shared(question, values), target)
    weights = basis.fitted(values, target)

    def evaluate(asked: Array) -> Evaluated:
        factors = restitution_factors(np.exp(basis.of(asked) @ weights))
        return judge(question.in_pockets(asked), factors)

    told = judge(question.in_pockets(values), restitution_factors(np.exp(unseen)))
    return replace(question, evaluate=evaluate), _error(basis, answers, told)


def _error(basis: Basis, true: Evaluated, told: Evaluated) -> FitError:
    factor = true.threshold - true.margin
    squares = np.mean((factor - (told.threshold - told.margin)) ** 2, axis=0)
    spread = np.var(factor, axis=0)
    margin = np.mean((true.margin - told.margin) ** 2, axis=0)
    changed = np.mean(is_stable(true) != is_stable(told), axis=0)
    return FitError(
        restitution_factor=float(np.sqrt(squares.mean())),
        missed=float(np.max(np.divide(squares, spread, out=np.zeros_like(squares), where=spread > 0.0))),
        margin=tuple(margin.tolist()),
        verdict=tuple(changed.tolist()),
        degree=basis.degree,
        logarithmic=any(basis.logarithmic),
        samples=len(factor),
    )


def _shared(question: Question, values: Array) -> tuple[int, ...]:
    """Inputs that vary and on which the restitution factor may depend: no pocket friction, no boundary."""
    others = {question.boundary, *(case.friction for case in question.cases)}
    return tuple(i for i in range(values.shape[1]) if i not in others and np.ptp(values[:, i]) > 0.0)


def with_fit_error(answer: SobolAnswer, error: FitError) -> SobolAnswer:
    """Sobol indices with their intervals widened by what the fit may have moved them."""
    cases = tuple(
        _widened(case, margin, verdict)
        for case, margin, verdict in zip(answer.cases, error.margin, error.verdict, strict=True)
    )
    return replace(answer, cases=cases, fit_error=error.missed)


def _widened(case: CaseSobol, margin: float, verdict: Ratio) -> CaseSobol:
    share = case.probability_stable.value
    spread = share * (1.0 - share)
    return replace(
        case,
        margin=tuple(_wider(one, margin, case.margin_deviation**2) for one in case.margin),
        verdict=tuple(_wider(one, verdict, spread) for one in case.verdict),
    )


def _wider(index: SobolIndex, error: float, variance: float) -> SobolIndex:
    delta = float(np.sqrt(error / variance))
    return replace(index, first=_bound(index.first, delta), total=_bound(index.total, delta))


def _bound(one: Estimate, delta: float) -> Estimate:
    low = max(0.0, one.low**0.5 - delta) / (1.0 + delta)
    high = (one.high**0.5 + delta) / (1.0 - delta) if delta < 1.0 else 1.0
    return replace(one, low=low**2, high=min(1.0, high**2))
