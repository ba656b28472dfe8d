"""The whole chain as a function of its uncertain inputs: threshold, margin and verdict of many samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from threading import Event

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.kicks import settings_for, with_reference
from separatrix.draws import UncertainInput, sample, uncertain_inputs
from separatrix.errors import InputError
from separatrix.ranking import ranking_question
from separatrix.stability import GrowthCounter
from separatrix.stability.pool import Progress
from separatrix.study import Candidate, Study
from separatrix.uncertainty.boundary import Boundary, Verdicts
from separatrix.uncertainty.chain_samples import chain_samples
from separatrix.uncertainty.pocket_friction import PocketFrictions, pocket_frictions
from separatrix.uncertainty.records import SurrogateError
from separatrix.uncertainty.regime import play_of
from separatrix.uncertainty.traced import traced_boundary
from separatrix.uncertainty.training import changed_cage, enters, moving_inputs, trained
from separatrix.units import Array, Ratio

ROWS = 4096
"""Samples whose thresholds are worked out at a time: what memory they take."""

Stage = Callable[[str], Progress | None]
"""Gives the progress of a stage of the work by its name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A candidate in one environment, or ("") over all of them: the mean of its measured frictions.

    Attributes
    ----------
    candidate, environment : str
        Names.
    place : int
        Of the candidate.
    columns : tuple of int
        Inputs that are its frictions.
    certain : float
        Sum of those of its frictions that are certain [-].
    count : int
        Frictions that it is the mean of.
    """

    candidate: str
    environment: str
    place: int
    columns: tuple[int, ...]
    certain: Ratio
    count: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Evaluated:
    """What the model answers, shape (sample, case) each: margin and threshold [-], verdict (1 is STABLE)."""

    margin: Array
    threshold: Array
    verdict: Verdicts


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Factors:
    """Restitution factor of every sample and candidate.

    Attributes
    ----------
    restitution_factor : ndarray
        Shape (sample, candidate) [-]; that of the central values where a sample failed.
    solved : ndarray
        Shape (sample,).
    notes : tuple of str
        What a reader must know of them, with the reasons of failures.
    """

    restitution_factor: Array
    solved: NDArray[np.bool_]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Kind:
    """One kind of cage: its boundary, the inputs that move it, and the candidates that have it."""

    boundary: Boundary
    names: tuple[str, ...]
    columns: tuple[int, ...]
    places: tuple[int, ...]
    error: SurrogateError
    runs: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Model:
    """Uncertain inputs, cases, and the boundary of each kind of cage.

    Attributes
    ----------
    study : Study
        With the central values.
    inputs : tuple of UncertainInput
        In the order of the columns of values.
    cases : tuple of Case
        In the order of the columns of the answers.
    kinds : tuple of Kind
        A cage for each pocket stiffness, and set of inputs that move it.
    central : ndarray
        Restitution factor of each candidate with every input at its centre, shape (candidate,) [-].
    pockets : PocketFrictions, optional
        How frictions from tests move with the inputs.
    jobs : int
        Threads.
    """

    study: Study
    inputs: tuple[UncertainInput, ...]
    cases: tuple[Case, ...]
    kinds: tuple[Kind, ...]
    central: Array
    pockets: PocketFrictions | None = None
    jobs: int = 1

    def in_pockets(self, values: Array) -> Array:
        """Return the inputs with frictions from tests as the pockets of each sample see them."""
        return values if self.pockets is None else self.pockets.moved(values)

    @property
    def central_values(self) -> Array:
        """Every input at its central value, shape (1, input)."""
        return np.array([[one.central for one in self.inputs]])

    def frictions(self, values: Array) -> Array:
        """Friction of every case by inputs as `in_pockets` leaves them, shape (sample, case) [-]."""
        parts = [(values[:, list(c.columns)].sum(axis=1) + c.certain) / c.count for c in self.cases]
        return np.stack(parts, axis=1)

    def factors(
        self, values: Array, *, progress: Progress | None = None, stop: Event | None = None
    ) -> Factors:
        """Restitution factors by the chain; alike in all samples where only frictions are uncertain."""
        alike = np.tile(self.central, (len(values), 1))
        if not self.chain_varies:
            return Factors(restitution_factor=alike, solved=np.ones(len(values), dtype=np.bool_))
        draws = sample(self.study, 1).with_values(values)
        found = chain_samples(self.study, draws, jobs=self.jobs, progress=progress, stop=stop)
        if not found.complete:
            raise KeyboardInterrupt
        return Factors(
            restitution_factor=np.where(found.solved[:, None], found.restitution_factor, alike),
            solved=found.solved,
            notes=tuple(found.notes()),
        )

    @property
    def chain_varies(self) -> bool:
        """Whether any input beside the frictions is uncertain."""
        return bool(_of_the_chain(self.study, self.inputs))

    def evaluate(self, values: Array) -> Evaluated:
        """Answer for samples of the inputs, shape (sample, input), by the whole chain."""
        factors = self.factors(values).restitution_factor
        return self.judge(self.in_pockets(values), factors[:, [case.place for case in self.cases]])

    def judge(
        self, values: Array, restitution_factor: Array, draws: NDArray[np.int_] | None = None
    ) -> Evaluated:
        """Answer for samples whose restitution factor is known.

        Parameters
        ----------
        values : ndarray
            With frictions as the pockets see them, shape (sample, input).
        restitution_factor : ndarray
            Shape (sample, case) [-].
        draws : ndarray, optional
            Which of the boundaries that the runs allow each sample has, shape (sample,); without it the one
            that they say.
        """
        friction = self.frictions(values)
        threshold = self.thresholds(values, friction, draws)
        verdict = np.zeros(friction.shape, dtype=np.int_)
        for draw, rows in _by_draw(draws, len(values)):
            part = restitution_factor[rows]
            verdict[rows] = self.verdicts(values[rows], friction[rows], part, draw)
        return Evaluated(margin=threshold - restitution_factor, threshold=threshold, verdict=verdict)

    def thresholds(self, values: Array, friction: Array, draws: NDArray[np.int_] | None = None) -> Array:
        """Restitution threshold of every sample and case, shape (sample, case) [-]."""
        found = np.empty(friction.shape)
        for kind, own in self._kinds():
            for rows in (slice(k, k + ROWS) for k in range(0, len(values), ROWS)):
                known = values[rows][:, list(kind.columns)]
                part = None if draws is None else draws[rows]
                found[rows, own] = kind.boundary.thresholds(friction[rows, own], known, part)
        return found

    def verdicts(self, values: Array, friction: Array, factors: Array, draw: int | None = None) -> Verdicts:
        """Verdict of every sample and case for one boundary, shape (sample, case)."""
        found = np.zeros(friction.shape, dtype=np.int_)
        for kind, own in self._kinds():
            known, drifts = values[:, list(kind.columns)], kind.boundary.traced.drifts
            for cases in _alike(own, factors):
                limits = kind.boundary.limits(factors[:, cases[0]], known, draw)
                found[:, cases] = limits.verdicts(friction[:, cases], drifts=drifts)
        return found

    def _kinds(self) -> Iterator[tuple[Kind, list[int]]]:
        """Yield each kind with the columns of its cases."""
        for kind in self.kinds:
            own = [i for i, case in enumerate(self.cases) if case.place in kind.places]
            if own:
                yield kind, own


def _by_draw(draws: NDArray[np.int_] | None, samples: int) -> Iterator[tuple[int | None, NDArray[np.int_]]]:
    """Yield each boundary with the samples that have it."""
    if draws is None:
        yield None, np.arange(samples)
        return
    for draw in np.unique(draws):
        yield int(draw), np.flatnonzero(draws == draw)


def _alike(own: Sequence[int], factors: Array) -> list[list[int]]:
    """Cases with the same restitution factors, together."""
    groups: list[list[int]] = []
    for case in own:
        group = next((g for g in groups if np.array_equal(factors[:, g[0]], factors[:, case])), None)
        if group is None:
            groups.append([case])
        else:
            group.append(case)
    return groups


def uncertain_model(
    study: Study, *, jobs: int = 1, stage: Stage | None = None, stop: Event | None = None
) -> Model:
    """Trace and fit what is needed, and return the chain as a function of its uncertain inputs.

    Parameters
    ----------
    study : Study
        With candidates; a friction without stated scatter has the study's default one, a guess.
    jobs : int
        Threads; the numbers do not depend on it.
    stage : callable, optional
        Gives the progress of the stages "boundary" and "surrogate".
    stop : Event, optional
        Ends the runs.

    Raises
    ------
    InputError
        No candidates, or the cage cannot be built in the range of its inputs.
    KeyboardInterrupt
        Interrupted: the boundary needs all its runs.
    """
    candidates = ranking_question(study).candidates
    inputs = uncertain_inputs(study)
    states = [changed_cage(study, place) for place in range(len(candidates))]
    names = [moving_inputs(study, inputs, place) for place in range(len(candidates))]
    stiffness = [state.cage.ball_cage_stiffness for state in states]
    groups: dict[tuple[float, tuple[str, ...]], list[int]] = {}
    for place in range(len(candidates)):
        groups.setdefault((stiffness[place], names[place]), []).append(place)
    halt, told = stop or Event(), stage or (lambda _: None)
    kinds = [_kind(study, inputs, names[g[0]], g, jobs, told, halt) for g in groups.values()]
    factors = [state.restitution.restitution.restitution_factor for state in states]
    pockets = pocket_frictions(study, inputs, _of_the_chain(study, inputs), jobs=jobs, stop=halt)
    return Model(
        study=study,
        inputs=inputs,
        cases=tuple(cases_of(study, inputs)),
        kinds=tuple(kinds),
        central=np.array(factors),
        pockets=pockets,
        jobs=jobs,
    )


def _of_the_chain(study: Study, inputs: Sequence[UncertainInput]) -> tuple[int, ...]:
    """Inputs beside the frictions."""
    places = range(len(ranking_question(study).candidates))
    return tuple(i for i, one in enumerate(inputs) if any(enters(study, one.key, place) for place in places))


def _kind(
    study: Study,
    inputs: Sequence[UncertainInput],
    names: tuple[str, ...],
    places: Sequence[int],
    jobs: int,
    stage: Stage,
    stop: Event,
) -> Kind:
    """Boundary of one kind of cage."""
    cage, seed = changed_cage(study, places[0]).cage, study.stability.seed
    play = play_of(cage, names, {one.key: one.distribution for one in inputs})
    cage = cage if play is None else play.opened(cage)
    settings = with_reference(settings_for(study.stability, cage))
    counter = GrowthCounter(cage, settings, stop)
    traced = traced_boundary(cage, settings, jobs=jobs, progress=stage("boundary"), counter=counter)
    told = stage("surrogate")
    surrogate, error = trained(
        study, inputs, places[0], names, traced, play=play, seed=seed, jobs=jobs, progress=told, stop=stop
    )
    keys = [one.key for one in inputs]
    return Kind(
        boundary=Boundary(traced=traced, surrogate=surrogate, seed=seed),
        names=names,
        columns=tuple(keys.index(name) for name in names),
        places=tuple(places),
        error=error,
        runs=traced.runs + error.runs,
    )


def cases_of(study: Study, inputs: Sequence[UncertainInput]) -> Iterator[Case]:
    """Yield every measured candidate and environment, then each candidate over all its environments."""
    asked, keys = ranking_question(study), [one.key for one in inputs]
    for environment in asked.environments:
        for place, candidate in enumerate(asked.candidates):
            if candidate.friction.get(environment) is not None:
                yield _case(candidate, environment, place, (environment,), keys)
    for place, candidate in enumerate(asked.candidates):
        measured = tuple(e for e in asked.environments if candidate.friction.get(e) is not None)
        if measured:
            yield _case(candidate, "", place, measured, keys)


def by_environment(cases: Sequence[Case]) -> dict[str, list[int]]:
    """Columns of the cases of each environment, "" for all of them together."""
    groups: dict[str, list[int]] = {}
    for i, case in enumerate(cases):
        groups.setdefault(case.environment, []).append(i)
    return groups


def lacks_alone(cases: Sequence[Case]) -> dict[int, dict[str, None]]:
    """What a case lacks that is alone in its environment: it has nothing to be best among."""
    keys = ("probability_best", "probability_best_low", "probability_best_high")
    return {own[0]: dict.fromkeys(keys) for own in by_environment(cases).values() if len(own) == 1}


def _case(
    candidate: Candidate, name: str, place: int, environments: Sequence[str], keys: Sequence[str]
) -> Case:
    columns, certain = [], 0.0
    for environment in environments:
        key, friction = f"ranking.{candidate.name}.{environment}", candidate.friction[environment]
        if key in keys:
            columns.append(keys.index(key))
        elif friction is not None:
            certain += friction.mean
    if not environments:
        raise InputError(f"[ranking] {candidate.name}", "has no measured friction")
    return Case(
        candidate=candidate.name,
        environment=name,
        place=place,
        columns=tuple(columns),
        certain=certain,
        count=len(environments),
    )
