"""The chain from equilibrium to restitution factor, evaluated on many samples of the uncertain inputs.

Every stage is the chain's own, so that a sample at the means gives the chain's answer to the last bit. What
an input does not touch is not computed again: samples that agree in bearing and load share their equilibrium,
those that agree in the film too their traction; the cage's mass acts on the last formula only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from threading import Event
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.chain import (
    BearingState,
    bearing_state,
    cage_design,
    impact_speed,
    pocket_stiffness,
    require_rolling,
)
from separatrix.draws import Draws, candidates_of
from separatrix.errors import ConvergenceError, InputError
from separatrix.orbit import HIGHEST, orbital_waves
from separatrix.pocket_contact import PocketConditions, pocket_conditions
from separatrix.restitution import Restitution, contact_damping, restitution
from separatrix.stability.pool import work_through
from separatrix.study import Candidate, KinematicModel, Study
from separatrix.study_numbers import Setter, setter
from separatrix.traction import film_compliance, traction_slope
from separatrix.traction.curve import THIN
from separatrix.units import Array, NewtonSecondPerMetre, RadianPerSecond

CHUNK = 32
"""Samples that one thread takes at a time."""

INTERRUPTED = "not computed: the work was interrupted"

_EQUILIBRIUM, _TRACTION, _LATER = range(3)
"""Stages, from the first that an input touches; what follows the traction is computed for each sample."""

_UNUSED = ("bearing.bore", "operation.temperature", "operation.ramp_time", "operation.ramp_start")
"""Numbers of bearing and operation that neither equilibrium nor traction takes."""

_PER_SAMPLE = (
    "race_damping",
    "race_damping_free_spin",
    "inner_damping",
    "outer_damping",
    "cage_speed",
    "film_over_semi_minor",
)
_PER_CANDIDATE = (
    "ball_cage_stiffness",
    "restitution_factor",
    "restitution_factor_hertz",
    "restitution_factor_free_spin",
)

IntArray = NDArray[np.int64]
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A sample that has no answer: its number, the kind of error, and the reason in one sentence."""

    sample: int
    kind: str
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChainSamples:
    """Answers of the chain, a row for each sample; rows that are not `solved` hold NaN and have a `Failure`.

    Attributes
    ----------
    candidates : tuple of str
        Names of the candidates, or ``("",)`` for the cage as it is.
    solved : ndarray of bool
        Shape (sample,).
    race_damping, race_damping_free_spin, inner_damping, outer_damping : ndarray
        C_mu and its parts, shape (sample,) [N s/m].
    cage_speed : ndarray
        Mean orbital speed of the balls, shape (sample,) [rad/s].
    film_over_semi_minor : ndarray
        Thickness of the film over the smaller of the two semi-minor axes, shape (sample,) [-].
    slip_speed : ndarray
        Mean sliding speed of balls on pockets, shape (sample,) [m/s].
    pocket_pressure : ndarray
        Mean contact pressure in the pocket at an impact of the impact speed, shape (sample, candidate) [Pa].
    ball_cage_stiffness : ndarray
        k_BC, shape (sample, candidate) [N/m].
    restitution_factor, restitution_factor_hertz, restitution_factor_free_spin : ndarray
        Shape (sample, candidate) [-].
    orbital_cosines, orbital_sines : ndarray
        Harmonics of the balls' speeds, shape (sample, harmonic) [m/s]; 0 beyond those of a sample.
    failures : tuple of Failure
        In the order of the samples.
    """

    candidates: tuple[str, ...]
    solved: NDArray[np.bool_]
    race_damping: Array
    race_damping_free_spin: Array
    inner_damping: Array
    outer_damping: Array
    cage_speed: Array
    film_over_semi_minor: Array
    ball_cage_stiffness: Array
    restitution_factor: Array
    restitution_factor_hertz: Array
    restitution_factor_free_spin: Array
    slip_speed: Array
    pocket_pressure: Array
    orbital_cosines: Array
    orbital_sines: Array
    failures: tuple[Failure, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether every sample was tried."""
        return not any(failure.reason == INTERRUPTED for failure in self.failures)

    @property
    def failure_counts(self) -> dict[str, int]:
        """How many samples failed, by kind, most frequent first."""
        kinds = [failure.kind for failure in self.failures]
        return {kind: kinds.count(kind) for kind in sorted(set(kinds), key=kinds.count, reverse=True)}

    def notes(self) -> Iterator[str]:
        """Sentences on what a reader must know of these samples."""
        if self.failures:
            kinds = ", ".join(f"{count} {kind}" for kind, count in self.failure_counts.items())
            first = self.failures[0]
            yield (
                f"{self.solved.size} samples: {int(self.solved.sum())} solved, {len(self.failures)} not "
                f"({kinds}). Sample {first.sample}: {first.reason}"
            )
        thick = int((self.film_over_semi_minor[self.solved] > THIN).sum())
        if thick:
            yield (
                f"In {thick} of {self.solved.size} samples the film is thicker than {THIN:g} of the semi-"
                "minor axis, up to which a film in series with the races holds (docs/theory/traction.md)."
            )


class _Traction(NamedTuple):
    """What a sample takes from the stages before the impact."""

    inner: NewtonSecondPerMetre
    outer: NewtonSecondPerMetre
    thin: float


class _Answer(NamedTuple):
    """What one sample gives."""

    impacts: tuple[Restitution, ...]
    pockets: tuple[PocketConditions, ...]
    cage_speed: float
    film_over_semi_minor: float
    cosines: tuple[float, ...]
    sines: tuple[float, ...]


class _Plan(NamedTuple):
    """Samples in the order in which they share most, and which of them share what."""

    order: IntArray
    same_equilibrium: IntArray
    same_traction: IntArray


def chain_samples(
    study: Study,
    draws: Draws,
    *,
    jobs: int = 1,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> ChainSamples:
    """Evaluate equilibrium, traction and restitution of every sample.

    Parameters
    ----------
    study : Study
        With a [cage]; what is not drawn is as it says.
    draws : Draws
        From `sample`, or other values of its inputs.
    jobs : int
        Threads; they change nothing but the time.
    progress : callable, optional
        Called with (done, total) samples now and then.
    stop : Event, optional
        Set where an interrupt comes.

    Returns
    -------
    ChainSamples
        A sample that fails is a row with its reason; an interrupt leaves out the rest, with that reason.

    Raises
    ------
    InputError
        The study has no cage, or its bearing does not roll.
    """
    cage_design(study)
    require_rolling(study)
    plan = _plan(study, draws)
    columns = [i for i, key in enumerate(draws.names) if not _is_friction(key)]
    put = setter(study, [draws.names[i] for i in columns])
    chunks = [plan.order[i : i + CHUNK] for i in range(0, len(plan.order), CHUNK)]

    def told(done: int, total: int) -> None:
        if progress is not None:
            progress(min(done * CHUNK, len(plan.order)), min(total * CHUNK, len(plan.order)))

    def compute(chunk: IntArray) -> list[_Answer | Failure]:
        return _chunk(put, draws.values[:, columns], plan, chunk)

    found = work_through(compute, chunks, jobs=jobs, progress=told, stop=stop)
    answers: dict[int, _Answer | Failure] = {}
    for chunk, rows in zip(chunks, found, strict=True):
        for place, number in enumerate(chunk):
            left_out = Failure(sample=int(number), kind="interrupted", reason=INTERRUPTED)
            answers[int(number)] = left_out if rows is None else rows[place]
    return _collected(study, [answers[i] for i in range(len(draws.values))])


def _stage(study: Study, key: str) -> int:
    """First stage of the chain that an input touches; the first of all for one that is not known here."""
    section = key.partition(".")[0]
    if key in _UNUSED or section in ("cage", "stability", "ranking"):
        return _LATER
    if section == "film" and not (key == "film.race_friction" and study.kinematics is KinematicModel.FREE):
        return _TRACTION
    return _EQUILIBRIUM


def _is_friction(key: str) -> bool:
    """Whether a number is the friction of a candidate: it fits any study, others may not fit together."""
    return key.startswith("ranking.") and ".material." not in key


def _plan(study: Study, draws: Draws) -> _Plan:
    stages = np.array([_stage(study, key) for key in draws.names])
    equilibrium = _alike(draws.values[:, stages == _EQUILIBRIUM])
    traction = _alike(draws.values[:, stages <= _TRACTION])
    order = np.lexsort((traction, equilibrium))
    return _Plan(order, equilibrium, traction)


def _alike(values: Array) -> IntArray:
    """Number of the group of samples with the same values that each belongs to, shape (sample,)."""
    if values.shape[1] == 0:
        return np.zeros(len(values), dtype=np.int64)
    groups: IntArray = np.unique(values, axis=0, return_inverse=True)[1].reshape(-1)
    return groups


def _chunk(put: Setter, values: Array, plan: _Plan, chunk: IntArray) -> list[_Answer | Failure]:
    """Answers of some samples in turn, each with what it shares with the one before."""
    rows: list[_Answer | Failure] = []
    bearing = traction = None
    last = (-1, -1)
    for number in chunk:
        now = int(plan.same_equilibrium[number]), int(plan.same_traction[number])
        if now[0] != last[0]:
            bearing = None
        if now != last:
            traction = None
        last = now
        try:
            study = put(values[number].tolist())
            bearing = bearing or _bearing(study)
            traction = traction or _traction(study, bearing)
            rows.append(_answer(study, bearing, traction))
        except (InputError, ConvergenceError) as error:
            rows.append(Failure(sample=int(number), kind=type(error).__name__, reason=str(error)))
    return rows


def _bearing(study: Study) -> BearingState:
    require_rolling(study)
    return bearing_state(study)


def _traction(study: Study, state: BearingState) -> _Traction:
    """Damping of both races; that the film is thin enough is asked for all samples together."""
    compliance, friction = film_compliance(study.film), study.film.race_friction
    inner, outer = (
        contact_damping(
            traction_slope(at.ellipse, at.creep, race_friction=friction, film_compliance=compliance)[0],
            at.load,
            at.rolling_speed,
        )
        for at in (state.inner, state.outer)
    )
    least = min(state.inner.ellipse.semi_minor, state.outer.ellipse.semi_minor)
    thickness = study.film.thickness or 0.0
    return _Traction(inner, outer, thickness / least if least > 0.0 else 0.0)


def _answer(study: Study, state: BearingState, traction: _Traction) -> _Answer:
    found = state.equilibrium
    waves = orbital_waves(found.orbital_speed, found.azimuth, study.bearing.pitch_diameter / 2.0)
    impacts = _impacts(study, traction, state.cage_speed)
    return _Answer(
        impacts=impacts,
        pockets=_pockets(study, state, impacts),
        cage_speed=state.cage_speed,
        film_over_semi_minor=traction.thin,
        cosines=waves.cosines,
        sines=waves.sines,
    )


def _impacts(study: Study, traction: _Traction, cage_speed: RadianPerSecond) -> tuple[Restitution, ...]:
    """Impact on the pocket of each candidate; candidates of the same stiffness share one."""
    mass, known = cage_design(study).mass, {}
    impacts = []
    for candidate in candidates_of(study):
        stiffness = pocket_stiffness(study, cage_speed, candidate.material if candidate else None)[0]
        if stiffness not in known:
            known[stiffness] = restitution(
                traction.inner, traction.outer, ball_cage_stiffness=stiffness, cage_mass=mass
            )
        impacts.append(known[stiffness])
    return tuple(impacts)


def _pockets(
    study: Study, state: BearingState, impacts: Sequence[Restitution]
) -> tuple[PocketConditions, ...]:
    """What rubs in the pocket of each candidate; those of the same stiffness share it."""
    known = {
        impact.ball_cage_stiffness: pocket_conditions(
            state.equilibrium,
            ball_diameter=study.bearing.ball_diameter,
            ball_cage_stiffness=impact.ball_cage_stiffness,
            cage_mass=cage_design(study).mass,
            damping_ratio=impact.damping_ratio,
            impact_speed=impact_speed(study, state.cage_speed),
        )
        for impact in dict.fromkeys(impacts)
    }
    return tuple(known[impact.ball_cage_stiffness] for impact in impacts)


def _collected(study: Study, answers: Sequence[_Answer | Failure]) -> ChainSamples:
    """Columns of the answers; NaN where there is none."""
    names = tuple(_name(candidate) for candidate in candidates_of(study))
    n = len(answers)
    slip_speed, pressure = np.full(n, np.nan), np.full((n, len(names)), np.nan)
    one = {name: np.full(n, np.nan) for name in _PER_SAMPLE}
    each = {name: np.full((n, len(names)), np.nan) for name in _PER_CANDIDATE}
    waves = {name: np.full((n, HIGHEST), np.nan) for name in ("orbital_cosines", "orbital_sines")}
    for i, answer in enumerate(answers):
        if isinstance(answer, Failure):
            continue
        first = answer.impacts[0]
        for name in _PER_SAMPLE:
            one[name][i] = getattr(first if hasattr(first, name) else answer, name)
        for name in _PER_CANDIDATE:
            each[name][i] = [getattr(impact, name) for impact in answer.impacts]
        slip_speed[i] = answer.pockets[0].slip_speed
        pressure[i] = [pocket.pressure for pocket in answer.pockets]
        for name, held in (("orbital_cosines", answer.cosines), ("orbital_sines", answer.sines)):
            waves[name][i] = [*held, *[0.0] * (HIGHEST - len(held))]
    failures = tuple(answer for answer in answers if isinstance(answer, Failure))
    solved = np.array([isinstance(answer, _Answer) for answer in answers], dtype=bool)
    return ChainSamples(
        candidates=names,
        solved=solved,
        slip_speed=slip_speed,
        pocket_pressure=pressure,
        failures=failures,
        **one,
        **each,
        **waves,
    )


def _name(candidate: Candidate | None) -> str:
    return candidate.name if candidate else ""
