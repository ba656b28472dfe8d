"""The uncertain ranking: probabilities of every verdict and of being best, with intervals and convergence."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from separatrix.distribution import described
from separatrix.draws import Draws, sample
from separatrix.errors import InputError
from separatrix.ranking import ranking_question
from separatrix.ranking.friction import MeanFriction, as_pockets_see, overall, with_scatter
from separatrix.ranking.lowest import lowest_among
from separatrix.ranking.reason import not_measured
from separatrix.study import Study
from separatrix.uncertainty.boundary import STABLE, UNDECIDED, UNSTABLE, VERDICTS, Boundary, own_draws
from separatrix.uncertainty.model import (
    Case,
    Evaluated,
    Factors,
    Model,
    Stage,
    by_environment,
    lacks_alone,
    uncertain_model,
)
from separatrix.uncertainty.probability import (
    best_credit,
    mixed_interval,
    prefix_counts,
    quantiles,
    sizes,
    tie_groups,
)
from separatrix.uncertainty.records import (
    BoundaryAnswer,
    BoundaryLine,
    Cloud,
    ConvergenceRow,
    InputRow,
    UncertainEnvironment,
    UncertainMaterial,
    UncertainRanking,
)
from separatrix.units import Array, Ratio

BOUNDARIES = 64
"""Boundaries that the runs allow, behind every interval of a verdict's probability."""

ORDERED = 8
"""Of them, those behind the interval of the probability of being best: it hardly depends on them."""

CLOUD = 256
"""Samples that are kept for the pictures."""

LINE = 65
"""Restitution factors of the line that is drawn."""

FEWEST_SAMPLES = 64


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sampled:
    """Samples that have an answer, and what it is.

    Attributes
    ----------
    values : ndarray
        Shape (sample, input).
    friction, factor, threshold : ndarray
        Shape (sample, case) [-]; each sample's threshold for a boundary of its own.
    verdicts : ndarray
        For every boundary that is tried, shape (draw, sample, case).
    orders : ndarray
        Credit of being best among its environment, for a few boundaries, shape (draw, sample, case) [-].
    """

    values: Array
    friction: Array
    factor: Array
    threshold: Array
    verdicts: NDArray[np.int8]
    orders: Array


def uncertain_ranking(
    study: Study,
    samples: int,
    *,
    jobs: int = 1,
    stage: Stage | None = None,
    stop: Event | None = None,
) -> tuple[UncertainRanking, Model, Sampled]:
    """Sample a study through the chain and its boundary.

    Parameters
    ----------
    study : Study
        With candidates.
    samples : int
        Best a power of two, at least `FEWEST_SAMPLES`.
    jobs : int
        Threads; the numbers do not depend on it.
    stage : callable, optional
        Gives the progress of the stages "boundary", "surrogate", "chain" and "verdicts".
    stop : Event, optional
        Ends the work.

    Returns
    -------
    tuple
        The answer; the model behind it, for questions of sensitivity; the samples that the chain solved.

    Raises
    ------
    InputError
        Too few samples, or no candidates, or nothing is uncertain.
    KeyboardInterrupt
        Interrupted.
    """
    ranking_question(study)
    if samples < FEWEST_SAMPLES:
        cure = "Powers of two spread most evenly: 4096."
        raise InputError("--samples", f"must be at least {FEWEST_SAMPLES}", value=str(samples), cure=cure)
    asked = as_pockets_see(study)
    draws = sample(asked, samples)
    told = stage or (lambda _: None)
    model = uncertain_model(asked, jobs=jobs, stage=told, stop=stop)
    factors = model.factors(draws.values, progress=told("chain"), stop=stop)
    solved = draws.values[factors.solved]
    found = _sampled(model, solved, factors, told)
    return _answer(model, draws, factors, found), model, found


def _sampled(model: Model, values: Array, factors: Factors, stage: Stage) -> Sampled:
    """Frictions, thresholds and verdicts of the samples that the chain solved."""
    friction = model.frictions(model.in_pockets(values))
    places = [case.place for case in model.cases]
    factor = factors.restitution_factor[factors.solved][:, places]
    progress = stage("verdicts")
    verdicts = np.empty((BOUNDARIES, *friction.shape), dtype=np.int8)
    orders = np.empty((ORDERED, *friction.shape))
    for draw in range(BOUNDARIES):
        verdicts[draw] = model.verdicts(values, friction, factor, draw)
        if draw < ORDERED:
            alone = np.full(len(values), draw)
            orders[draw] = _credit(model.cases, model.thresholds(values, friction, alone))
        if progress is not None:
            progress(draw + 1, BOUNDARIES)
    own = own_draws(len(values), BOUNDARIES)
    return Sampled(
        values=values,
        friction=friction,
        factor=factor,
        threshold=model.thresholds(values, friction, own),
        verdicts=verdicts,
        orders=orders,
    )


def _credit(cases: Sequence[Case], threshold: Array) -> Array:
    """Credit of being best in its environment, shape (sample, case)."""
    found = np.empty(threshold.shape)
    for own in by_environment(cases).values():
        found[:, own] = best_credit(threshold[:, own])
    return found


def _answer(model: Model, draws: Draws, factors: Factors, found: Sampled) -> UncertainRanking:
    asked = ranking_question(model.study)
    rows = _rows(model, found)
    environments = tuple(
        UncertainEnvironment(name=name, materials=_ordered(model, rows, name)) for name in asked.environments
    )
    total = len(draws.values)
    return UncertainRanking(
        samples=total,
        failed=total - int(factors.solved.sum()),
        notes=(*factors.notes, *(model.pockets.notes(found.values) if model.pockets else ())),
        default_scatter=asked.friction_scatter,
        inputs=tuple(_input_rows(model)),
        environments=environments,
        overall=_ordered(model, rows, ""),
        sizes=tuple(sizes(len(found.values))),
        convergence=tuple(_convergence(model, found)),
        clouds=tuple(_clouds(model, found)),
        boundaries=tuple(_boundaries(model)),
        boundary_draws=BOUNDARIES,
        kicks=model.kinds[0].boundary.traced.kicks,
        runs=sum(kind.runs for kind in model.kinds),
    )


def _input_rows(model: Model) -> list[InputRow]:
    moving = {name for kind in model.kinds for name in kind.names}
    return [
        InputRow(
            name=one.key,
            unit=one.unit,
            distribution=one.distribution.text or described(one.distribution, one.unit),
            source=one.source,
            mean=one.distribution.mean,
            standard_deviation=one.distribution.standard_deviation,
            moves_boundary=one.key in moving,
            moves_friction=model.pockets is not None and model.pockets.move_with(i, model.inputs),
        )
        for i, one in enumerate(model.inputs)
    ]


def _rows(model: Model, found: Sampled) -> list[UncertainMaterial]:
    """Row of every case."""
    samples, cases = found.friction.shape
    numbers = _interval("restitution_factor", found.factor)
    numbers |= _interval("restitution_threshold", found.threshold)
    numbers |= _interval("margin", found.threshold - found.factor)
    for name, verdict in (("stable", STABLE), ("undecided", UNDECIDED), ("unstable", UNSTABLE)):
        counts = (found.verdicts == verdict).sum(axis=1)
        numbers |= _probability(f"probability_{name}", counts, samples)
    numbers |= _probability("probability_best", found.orders.sum(axis=1), samples)
    lowest: dict[int, Ratio] = {}
    groups = np.zeros(cases, dtype=np.int_)
    for own in by_environment(model.cases).values():
        lowest |= _lowest(model, own)
        groups[own] = tie_groups(found.threshold[:, own], numbers["probability_best"][own])
    nominal = _nominal(model)
    rows = [
        _row(model, i, {name: float(column[i]) for name, column in numbers.items()}) for i in range(cases)
    ]
    rows = [
        replace(
            row,
            friction=float(nominal_friction),
            friction_deviation=_deviation(model, i),
            verdict=VERDICTS[int(nominal.verdict[0, i])],
            nominal_threshold=float(nominal.threshold[0, i]),
            nominal_margin=float(nominal.margin[0, i]),
            probability_lowest_friction=lowest.get(i),
            tie_group=int(groups[i]),
        )
        for i, (row, nominal_friction) in enumerate(
            zip(rows, model.frictions(model.central_values)[0], strict=True)
        )
    ]
    return [replace(row, reason=_reason(row)) for row in rows]


def _deviation(model: Model, place: int) -> float:
    """Standard deviation of the friction of a case, whose parts are independent [-]."""
    case = model.cases[place]
    parts = [model.inputs[column].deviation for column in case.columns]
    return math.hypot(*parts) / case.count


def _nominal(model: Model) -> Evaluated:
    """Answer with every input at its central value."""
    factors = model.central[None, [case.place for case in model.cases]]
    return model.judge(model.central_values, factors)


def _lowest(model: Model, own: Sequence[int]) -> dict[int, Ratio]:
    """Probability of the lowest mean friction by case, as `rank` has it; empty if there is no other."""
    means = {i: _mean_friction(model, model.cases[i]) for i in own}
    known = {model.cases[i].candidate: mean for i, mean in means.items() if mean is not None}
    found = lowest_among(known).probabilities
    return {i: share for i in own if (share := found.get(model.cases[i].candidate)) is not None}


def _mean_friction(model: Model, case: Case) -> MeanFriction | None:
    """Mean friction of a case with its standard error."""
    asked = ranking_question(model.study)
    friction = asked.candidates[case.place].friction
    places = (case.environment,) if case.environment else asked.environments
    known = [one for place in places if (one := friction.get(place)) is not None]
    return overall(with_scatter(one, asked.friction_scatter) for one in known)


def _interval(name: str, values: Array) -> dict[str, Array]:
    middle, low, high = quantiles(values)
    return {name: middle, f"{name}_low": low, f"{name}_high": high}


def _probability(name: str, counts: Array, samples: int) -> dict[str, Array]:
    value, low, high = mixed_interval(counts, samples)
    return {name: value, f"{name}_low": low, f"{name}_high": high}


def _row(model: Model, place: int, numbers: dict[str, Any]) -> UncertainMaterial:
    case = model.cases[place]
    assumed = any(model.inputs[column].source == "assumed" for column in case.columns)
    friction = ranking_question(model.study).candidates[case.place].friction
    asked = [friction.get(case.environment)] if case.environment else list(friction.values())
    words = [text for one in asked if one is not None for text in one.extrapolation]
    return UncertainMaterial(
        name=case.candidate,
        friction_scatter_assumed=assumed,
        extrapolation=tuple(dict.fromkeys(words)),
        **(numbers | lacks_alone(model.cases).get(place, {})),
    )


def _reason(row: UncertainMaterial) -> str:
    """Return the answer of a row in a sentence."""
    parts = {
        "stable": row.probability_stable,
        "undecided": row.probability_undecided,
        "unstable": row.probability_unstable,
    }
    shares = ", ".join(f"{name} in {100.0 * (share or 0.0):.0f} %" for name, share in parts.items())
    return (
        f"Of the samples it is {shares}; margin {row.margin:+.2f}, nine in ten between "
        f"{row.margin_low:+.2f} and {row.margin_high:+.2f}."
    )


def _ordered(
    model: Model, rows: Sequence[UncertainMaterial], environment: str
) -> tuple[UncertainMaterial, ...]:
    """Rows of an environment, best group first, then by threshold; those not measured last."""
    own = [row for row, case in zip(rows, model.cases, strict=True) if case.environment == environment]
    own.sort(key=lambda row: (row.tie_group or 0, -(row.restitution_threshold or 0.0), row.friction or 0.0))
    known = {row.name for row in own}
    absent = [one.name for one in ranking_question(model.study).candidates if one.name not in known]
    missing = [UncertainMaterial(name=name, reason=not_measured(environment)) for name in absent]
    return (*own, *missing)


def _convergence(model: Model, found: Sampled) -> list[ConvergenceRow]:
    """Probabilities of STABLE and of being best with ever more samples."""
    ends = sizes(len(found.values))
    stable = np.stack([prefix_counts(one == STABLE, ends) for one in found.verdicts])
    best = np.stack([prefix_counts(one, ends) for one in found.orders])
    parts: dict[str, list[Any]] = {}
    for name, counts in (("probability_stable", stable), ("probability_best", best)):
        columns = [mixed_interval(counts[:, k], size) for k, size in enumerate(ends)]
        for suffix, place in (("", 0), ("_low", 1), ("_high", 2)):
            parts[name + suffix] = [np.array([column[place][i] for column in columns]) for i in
                                    range(len(model.cases))]  # fmt: skip
    return [
        ConvergenceRow(
            name=case.candidate,
            environment=case.environment,
            **({key: value[i] for key, value in parts.items()} | lacks_alone(model.cases).get(i, {})),
        )
        for i, case in enumerate(model.cases)
    ]


def _clouds(model: Model, found: Sampled) -> list[Cloud]:
    return [
        Cloud(
            name=case.candidate,
            environment=case.environment,
            restitution_factor=found.factor[:CLOUD, i],
            friction=found.friction[:CLOUD, i],
        )
        for i, case in enumerate(model.cases)
        if case.environment
    ]


def _boundaries(model: Model) -> list[BoundaryAnswer]:
    candidates = ranking_question(model.study).candidates
    return [
        BoundaryAnswer(
            candidates=tuple(candidates[place].name for place in kind.places),
            parameters=kind.names,
            runs=kind.runs,
            line=line_of(kind.boundary, model.central_values[:, list(kind.columns)]),
            surrogate=kind.error,
            drifts=kind.boundary.traced.drifts,
        )
        for kind in model.kinds
    ]


def line_of(boundary: Boundary, parameters: Array) -> BoundaryLine:
    """Critical friction and limits of the cage as it is, with the scatter that the runs leave."""
    eta = np.union1d(np.linspace(0.0, 1.0, LINE), boundary.traced.restitution_factors)
    known = np.tile(parameters, (eta.size, 1))
    middles = np.stack([boundary.critical_friction(eta, known, draw) for draw in range(BOUNDARIES)])
    limits = boundary.limits(eta, known)
    low, high = np.quantile(middles, (0.025, 0.975), axis=0)
    middle = boundary.critical_friction(eta, known)
    return BoundaryLine(
        restitution_factor=eta,
        critical_friction=middle,
        critical_friction_low=np.minimum(low, middle),
        critical_friction_high=np.maximum(high, middle),
        stable_up_to=limits.stable_up_to,
        unstable_above=limits.unstable_above,
    )
