"""Which pocket friction a new material may have at most."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from separatrix.distribution import LogNormal
from separatrix.errors import InputError
from separatrix.sensitivity.design import BLOCKS, central_values, evaluated, is_stable
from separatrix.sensitivity.question import Question
from separatrix.sensitivity.records import AllowedFriction, Estimate, Span
from separatrix.sensitivity.scatter import by_block, jackknife
from separatrix.sensitivity.spans import largest, spans_above
from separatrix.stability import SEARCHED_FRICTION
from separatrix.units import Array, Ratio, shown

PROBABILITY: Ratio = 0.95
POINTS = 97
"""Frictions at which samples are judged; between them the probability is a straight line."""

FINER = 8
"""Parts of a step in which the probability crosses what is asked; they are judged as well."""

NOMINAL_POINTS = 2049

TOGETHER = 16
"""Frictions that are judged together."""

_Ask = Callable[[Array], tuple[Array, Array]]


def allowed_friction(
    question: Question,
    values: Array,
    *,
    probability: Ratio = PROBABILITY,
    scatter: Ratio = 0.0,
    searched: Ratio = SEARCHED_FRICTION,
) -> tuple[AllowedFriction, ...]:
    """Largest pocket friction that is still STABLE, in place of each case's own, all else as it is.

    Every friction from 0 to `searched` is looked at, and every stretch that is stable is told. Cases that
    differ in their friction only (in the environment of its test, too) have the same answer, given once.

    Parameters
    ----------
    question : Question
        Cases without a friction input are left out; if all are, there is no answer.
    values : ndarray
        Samples of all inputs, best from `sampled_values`, shape (sample, input) [SI].
    probability : float
        Of STABLE, wanted [-].
    scatter : float
        Standard deviation of the new material's friction, as a share of it [-].
    searched : float
        Up to which friction [-].

    Raises
    ------
    InputError
        A number outside its range.
    """
    _require(probability, scatter, searched)
    if len(values) < 2 * BLOCKS:
        raise InputError("values", f"must be at least {2 * BLOCKS} samples", "", str(len(values)))
    fine, coarse = _frictions(searched, NOMINAL_POINTS), _frictions(searched, POINTS)
    ask = _asked(question, values, _scattered(len(values), scatter))
    first = ask(coarse)
    more = _crossed(coarse, *first, probability)
    both = zip(first, ask(more), strict=True) if more.size else ((one, one[:0]) for one in first)
    frictions, places = np.unique(np.concatenate((coarse, more)), return_index=True)
    share, half = (np.concatenate(parts)[places] for parts in both)
    nominal = _nominal(question, fine)
    answers: dict[AllowedFriction, list[str]] = {}
    for c, case in enumerate(question.cases):
        if case.friction is not None:
            spans = spans_above(frictions, share[:, c], probability)
            spans_nominal = spans_above(fine, nominal[:, c], 1.0)
            found = AllowedFriction(
                probability=probability,
                scatter=scatter,
                searched=searched,
                most=_most(frictions, share[:, c], half[:, c], probability, spans),
                reason=_reason(spans, frictions, share[:, c], probability),
                spans=spans,
                most_nominal=largest(spans_nominal) if spans_nominal else None,
                reason_nominal=_reason_nominal(spans_nominal, searched),
                spans_nominal=spans_nominal,
            )
            answers.setdefault(found, []).append(case.candidate)
    return _alike(answers)


def _alike(answers: Mapping[AllowedFriction, Sequence[str]]) -> tuple[AllowedFriction, ...]:
    """Answers with the candidates whose pockets they hold for."""
    return tuple(
        replace(one, like=tuple(dict.fromkeys(names)), all_alike=len(answers) == 1)
        for one, names in answers.items()
    )


def _require(probability: Ratio, scatter: Ratio, searched: Ratio) -> None:
    require_within("probability", probability, 0.5, 0.9999)
    require_within("scatter", scatter, 0.0, 1.0)
    require_within("searched", searched, 1e-3, 2.0)


def require_within(name: str, value: object, low: float, high: float) -> None:
    """Refuse what is no number from `low` to `high`."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise InputError(name, f"must lie between {low:g} and {high:g}", "-", shown(value))


def _frictions(searched: Ratio, points: int) -> Array:
    """0, then equal ratios up to the end of the search."""
    return np.concatenate(([0.0], np.geomspace(searched / 1000.0, searched, points - 1)))


def _crossed(frictions: Array, share: Array, half: Array, probability: Ratio) -> Array:
    """Frictions inside each step in which the probability of a case, or an end of its interval, crosses."""
    above = np.stack([one >= probability for one in (share - half, share, share + half)])
    steps = np.flatnonzero((above[:, 1:] != above[:, :-1]).any(axis=(0, 2)))
    inside = [np.linspace(frictions[i], frictions[i + 1], FINER + 1)[1:-1] for i in steps]
    return np.concatenate([np.empty(0), *inside])


def _scattered(samples: int, scatter: Ratio) -> Array:
    """Friction of each sample as a share of its mean: log-normal as any friction of a next cage.

    At equally likely places in a fixed random order.
    """
    if scatter == 0.0:
        return np.ones(samples)
    places = np.random.default_rng(samples).permutation(samples)
    return LogNormal(mean=1.0, standard_deviation=scatter).quantile((places + 0.5) / samples)


def _asked(question: Question, values: Array, scattered: Array) -> _Ask:
    """Probability of STABLE and half its interval at frictions, shape (friction, case) each.

    The restitution factor does not depend on the friction, so it is asked for once.
    """
    first, judge = evaluated(question, values), question.judged()
    factor = first.threshold - first.margin

    def ask(frictions: Array) -> tuple[Array, Array]:
        found = []
        for part in np.array_split(frictions, -(-frictions.size // TOGETHER)):
            rows = np.tile(values, (part.size, 1))
            changed = _with_friction(question, rows, np.outer(part, scattered).ravel())
            stable = is_stable(judge(changed, np.tile(factor, (part.size, 1))))
            found += [_share(one) for one in np.split(stable, part.size)]
        share, half = zip(*found, strict=True)
        return np.array(share), np.array(half)

    return ask


def _with_friction(question: Question, values: Array, friction: Array) -> Array:
    changed = values.copy()
    for case in question.cases:
        if case.friction is not None:
            changed[:, case.friction] = friction
    return changed


def _share(stable: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Probability of STABLE of each case, and half its interval from the scatter between blocks."""
    sums = by_block(np.column_stack((np.ones(len(stable)), stable)), BLOCKS)
    return jackknife(sums, lambda of: np.asarray(of[1:] / of[0]))


def _nominal(question: Question, frictions: Array) -> Array:
    """1 where the verdict with every input at its centre is STABLE, shape (friction, case)."""
    values = np.repeat(central_values(question), len(frictions), axis=0)
    at_centre = evaluated(question, values[:1])
    factor = np.tile(at_centre.threshold - at_centre.margin, (len(frictions), 1))
    return is_stable(question.judged()(_with_friction(question, values, frictions), factor)).astype(float)


def _most(
    frictions: Array, share: Array, half: Array, probability: Ratio, spans: tuple[Span, ...]
) -> Estimate | None:
    """Largest allowed friction; its interval is where the ends of the probability's own cross."""
    if not spans:
        return None
    value = largest(spans)
    surely, perhaps = (spans_above(frictions, one, probability) for one in (share - half, share + half))
    return Estimate(
        value=value, low=min(largest(surely), value) if surely else 0.0, high=max(largest(perhaps), value)
    )


def _reason(spans: tuple[Span, ...], frictions: Array, share: Array, probability: Ratio) -> str:
    if not spans:
        best = int(np.argmax(share))
        return (
            f"No pocket friction is stable with a probability of {percent(probability)}: the best is "
            f"{percent(float(share[best]))}, at {frictions[best]:.3g}; the film must return less."
        )
    if spans[-1].to_edge:
        return f"No end of it was found up to a friction of {frictions[-1]:g}."
    return _gaps(spans)


def _reason_nominal(spans: tuple[Span, ...], searched: Ratio) -> str:
    if not spans:
        return "With every input at its mean no pocket friction is stable."
    if spans[-1].to_edge:
        return f"No end of it was found up to a friction of {searched:g}."
    return _gaps(spans)


def _gaps(spans: tuple[Span, ...]) -> str:
    """Say that not every friction below the largest is allowed."""
    if len(spans) == 1 and spans[0].from_edge:
        return ""
    stretches = ", ".join(f"{span.low:.3g} to {span.high:.3g}" for span in spans)
    return f"Not every friction below is: only {stretches}."


def percent(share: Ratio) -> str:
    """A share as a percentage that is never rounded up to certainty."""
    if 0.995 <= share < 1.0:
        return "over 99 %"
    return "under 1 %" if 0.0 < share < 0.005 else f"{100.0 * share:.0f} %"
