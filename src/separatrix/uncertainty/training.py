"""Single runs of changed cages near their boundary, and the law fitted to them.

Cages come from a quasi-random sequence in all uncertain inputs; each is run at its own restitution factor and
at others, from every kick, at frictions where the outcome is open. Run number k is run at point k alone, and
begins as run k does everywhere (common random numbers).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from threading import Event

import numpy as np
from scipy.stats import qmc

from separatrix.cage import PlanarCage, RunOutcome, run_ensemble
from separatrix.chain import CageState, cage_state
from separatrix.draws import UncertainInput
from separatrix.errors import InputError, SeparatrixError
from separatrix.ranking import ranking_question
from separatrix.stability.growth import cage_at
from separatrix.stability.pool import Progress, Stopped, work_through
from separatrix.study import StabilitySettings, Study
from separatrix.study_numbers import setter
from separatrix.uncertainty.held_out import misfit, surrogate_error
from separatrix.uncertainty.records import SurrogateError
from separatrix.uncertainty.regime import Play
from separatrix.uncertainty.surrogate import Points, Surrogate, fitted
from separatrix.uncertainty.terms import scale_of
from separatrix.uncertainty.traced import TracedBoundary
from separatrix.units import Array, Ratio

MOVES: Ratio = 0.01
"""Share by which a size of the cage must change with an input, within its middle two thirds, to count."""

ROUNDS, RUNS = 4, 9000
"""Rounds of runs, each placed by what those before it say: so many at least, and so many runs in all."""

HIGHEST: Ratio = 0.97
"""Restitution factor up to which runs are placed: beyond, the boundary falls to nothing."""

LEAST_FRICTION: Ratio = 1e-6
"""Friction below which nothing is run."""

FIRST_REACH, REACH = 0.6, 3.0
"""How far from the boundary runs are placed: in ln f at first, then in logits of P(whirl)."""

LEAST_WIDTH = 0.08
"""Width of logit P in ln f below which runs are not drawn together: the tails must be seen too."""

SEARCHED = 32
"""So many times the cages are drawn in search of those whose land takes over."""

HELD_OUT = 5
"""One run in so many is held out of the fit that is tried."""

SLICE = 8
"""Cages that a thread runs before it looks whether to stop."""

NUMBERS = (int, float)
_NOT_OF_THE_BOUNDARY = {"race_damping", "ball_cage_friction"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Trainee:
    """A changed cage: its place in the plan, uncertain parameters, restitution factor, and its ensemble."""

    place: int
    parameters: tuple[float, ...]
    restitution_factor: Ratio
    cage: PlanarCage
    settings: StabilitySettings


def moving_inputs(study: Study, inputs: Sequence[UncertainInput], place: int) -> tuple[str, ...]:
    """Names of the uncertain inputs that change a candidate's cage itself, beside race damping and friction.

    Parameters
    ----------
    study : Study
        With candidates.
    inputs : sequence of UncertainInput
        From `uncertain_inputs`.
    place : int
        Of the candidate in the ranking.
    """
    middle = _sizes(changed_cage(study, place).cage)
    return tuple(one.key for one in inputs if _moves(study, one, place, middle))


def changed_cage(study: Study, place: int) -> CageState:
    """Cage of a candidate, without friction."""
    return cage_state(study, material=ranking_question(study).candidates[place].material, friction=0.0)


def enters(study: Study, name: str, place: int) -> bool:
    """Whether an input may matter to a candidate's cage or restitution factor: all but others' materials."""
    own = f"ranking.{ranking_question(study).candidates[place].name}.material."
    return not name.startswith("ranking.") or name.startswith(own)


def _moves(study: Study, one: UncertainInput, place: int, middle: Array) -> bool:
    """Whether an input changes a size of the cage by more than `MOVES` of itself."""
    if one.key.startswith("stability."):
        return True
    if not enters(study, one.key, place):
        return False
    for value in one.distribution.quantile(np.array([0.16, 0.84])).tolist():
        sizes = _sizes(changed_cage(setter(study, [one.key])([value]), place).cage)
        if sizes.shape != middle.shape or np.any(np.abs(sizes[0] - middle[0]) > MOVES * middle[1]):
            return True
    return False


def _sizes(cage: PlanarCage) -> Array:
    """Numbers of a cage but its race damping and friction, and the size of each; shape (2, number).

    Waves of the balls' speed are as large as the largest of them.
    """
    rows: list[tuple[float, float]] = []
    for name in (f.name for f in fields(cage) if f.name not in _NOT_OF_THE_BOUNDARY):
        value = getattr(cage, name)
        numbers = [float(x) for x in (value if isinstance(value, tuple) else (value,)) if type(x) in NUMBERS]
        rows += [(x, max(map(abs, numbers))) for x in numbers]
    return np.array(rows).T


def trained(
    study: Study,
    inputs: Sequence[UncertainInput],
    place: int,
    names: Sequence[str],
    traced: TracedBoundary,
    *,
    play: Play | None,
    seed: int,
    jobs: int = 1,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> tuple[Surrogate, SurrogateError]:
    """Fit how the boundary of a candidate's cage moves with uncertain inputs.

    Parameters
    ----------
    study, inputs, place
        As in `moving_inputs`.
    names : sequence of str
        Inputs that move the boundary: `moving_inputs`.
    traced : TracedBoundary
        Of the cage as it is, or `Play.opened`.
    play : Play or None
        Where the boundary bends.
    seed : int
        Of the plan; the runs have the study's.
    jobs, progress, stop
        As in `stability.pool.work_out`.

    Raises
    ------
    KeyboardInterrupt
        Interrupted: the fit needs all runs.
    """
    halt = stop or Event()
    known = [one for one in inputs if enters(study, one.key, place)]
    laws = {one.key: one.distribution for one in known}
    scale = scale_of(names, [laws[name] for name in names], play)
    count = cage_count(len(names))
    values = drawn(known, names, count, play, seed)
    cages = trainees(study, [one.key for one in known], values, place, names, jobs=jobs, stop=halt)
    plan = _Plan(traced.kicks, traced, cages, seed)
    points, law = None, None
    rounds = max(ROUNDS, -(-RUNS // plan.size))
    for turn in range(rounds):
        wanted = plan.points(turn, law)
        told = None if progress is None else _part(progress, turn, rounds)
        grew = _run(cages, wanted, traced, first=turn * plan.size, jobs=jobs, progress=told, stop=halt)
        new = replace(wanted, grew=grew)
        points = new if points is None else points + new
        law = fitted(points, scale, traced, seed=seed, near=law)
    if points is None or law is None:
        raise KeyboardInterrupt
    return _judged(points, law, traced, cages, count)


def _judged(
    points: Points, law: Surrogate, traced: TracedBoundary, cages: Sequence[Trainee], count: int
) -> tuple[Surrogate, SurrogateError]:
    """Return the law with the misfit that held-out runs show, and the record of its error."""
    out = np.arange(points.grew.size) % HELD_OUT == HELD_OUT - 1
    tried = fitted(points.of(~out), law.scale, traced, seed=law.seed, near=law)
    final = replace(law, misfit=misfit(tried, points.of(out)))
    as_drawn = [one for one in cages if one.place < count]
    eta = np.array([one.restitution_factor for one in as_drawn])
    known = np.array([one.parameters for one in as_drawn]).reshape(len(as_drawn), -1)
    error = surrogate_error(tried, points.of(out), final, eta, known, runs=points.grew.size, cages=len(cages))
    return final, error


def cage_count(parameters: int) -> int:
    """Different cages that are run: more of them, the more parameters move."""
    return 64 if parameters <= 1 else 128 if parameters <= 3 else 256 if parameters <= 8 else 512


def drawn(
    inputs: Sequence[UncertainInput], names: Sequence[str], count: int, play: Play | None, seed: int
) -> Array:
    """Return values of so many quasi-random cages, and of more where few lie on a side of the first bend.

    Shape (cage, input), the additional ones last.
    """
    points = count if play is None else SEARCHED * count
    unit = qmc.Sobol(max(1, len(inputs)), rng=np.random.default_rng([seed, 1])).random(points)
    unit = np.clip(unit, 1e-9, 1.0 - 1e-9)
    values = np.empty((points, len(inputs)))
    for j, one in enumerate(inputs):
        values[:, j] = one.distribution.quantile(unit[:, j])
    if play is None:
        return values
    keys = [one.key for one in inputs]
    bent = play.hinges(values[:, [keys.index(name) for name in names]])[:, 0] > 0.0
    chosen = np.arange(points) < count
    for side in (bent, ~bent):
        lacking = max(0, count // 2 - np.count_nonzero(chosen & side))
        chosen[np.flatnonzero(side & ~chosen)[:lacking]] = True
    return values[chosen]


def trainees(
    study: Study,
    keys: Sequence[str],
    values: Array,
    place: int,
    names: Sequence[str],
    *,
    jobs: int,
    stop: Event,
) -> list[Trainee]:
    """Cages of rows of values of these inputs; those that cannot be built are left out."""
    count = len(values)
    put, columns = setter(study, keys), [keys.index(name) for name in names]

    def build(row: int) -> Trainee | None:
        try:
            changed = put(values[row].tolist())
            state = changed_cage(changed, place)
        except SeparatrixError:
            return None
        return Trainee(
            place=row,
            parameters=tuple(values[row, columns].tolist()),
            restitution_factor=state.restitution.restitution.restitution_factor,
            cage=state.cage,
            settings=state.stability,
        )

    built = work_through(build, range(count), jobs=jobs, stop=stop)
    if stop.is_set():
        raise KeyboardInterrupt
    found = [one for one in built if one is not None]
    if len(found) < count // 2:
        cure = "Make the distributions of its inputs narrower."
        rule = f"cannot be built in {count - len(found)} of {count} samples"
        raise InputError("The uncertain cage", rule, cure=cure)
    return found


class _Plan:
    """Where the runs of each round are placed.

    In a round every cage is run once from every kick near its boundary at its own restitution factor, once at
    another, and once at its own with less friction, down to none: what grows there grows by the land.
    """

    def __init__(
        self, kicks: Sequence[float], traced: TracedBoundary, cages: Sequence[Trainee], seed: int
    ) -> None:
        self.kicks, self.traced, self.cages, self.seed = len(kicks), traced, cages, seed
        self.size = 3 * len(kicks) * len(cages)

    def points(self, turn: int, law: Surrogate | None) -> Points:
        """Points of a round, with nothing run yet; `law` is what the rounds before say."""
        passes, cage = np.divmod(np.arange(self.size), len(self.cages))
        kick, own, low = passes % self.kicks, passes < 2 * self.kicks, passes < self.kicks
        unit = qmc.Sobol(2, rng=np.random.default_rng([self.seed, 2, turn])).random(_power(self.size))
        etas = np.array([one.restitution_factor for one in self.cages])[cage]
        # Densest at both ends, as Chebyshev's points: there a fit has neighbours on one side only.
        spread = 0.5 * HIGHEST * (1.0 - np.cos(np.pi * unit[: self.size, 0]))
        eta = np.minimum(np.where(own, etas, spread), HIGHEST)
        parameters = np.array([one.parameters for one in self.cages]).reshape(len(self.cages), -1)[cage]
        way = 2.0 * unit[: self.size, 1] - 1.0
        none = np.zeros(self.size)
        blank = Points(
            kick=kick, restitution_factor=eta, parameters=parameters, offset=none, friction=none, grew=none
        )
        way = np.where(low, -1.0, 2.0 * unit[: self.size, 1] - 1.0)
        half = np.maximum(_half(self.traced, blank), LEAST_FRICTION)
        offset = FIRST_REACH * way if law is None else _near(law, blank, way)
        friction = np.minimum(half * np.exp(offset), 1.0) * np.where(low, unit[: self.size, 1], 1.0)
        friction = np.maximum(friction, LEAST_FRICTION)
        return replace(blank, offset=np.log(friction / half), friction=friction)


def _near(law: Surrogate, blank: Points, way: Array) -> Array:
    """Offsets at which the law leaves the outcome open, from `REACH` below (way -1) to as far above (1)."""
    found = law.coefficients(None)
    eta, known, kick = blank.restitution_factor, blank.parameters, blank.kick.astype(np.int_)
    pieces = law.scale.width(eta, known)
    side = np.where((way < 0.0)[:, None], found.below[kick], found.above[kick])
    width = np.maximum(np.exp(np.sum(side * pieces, axis=1)), LEAST_WIDTH)
    return np.asarray(np.sum(found.shift[kick] * law.terms(eta, known), axis=1) + REACH * way * width)


def _half(traced: TracedBoundary, points: Points) -> Array:
    """Traced critical friction at points, shape (run,) [-]."""
    lines = np.stack(
        [
            np.interp(points.restitution_factor, traced.restitution_factors, traced.friction[i, 1])
            for i in range(len(traced.kicks))
        ]
    )
    return np.asarray(lines[points.kick.astype(np.int_), np.arange(points.kick.size)])


def _power(count: int) -> int:
    return 1 << max(0, (count - 1).bit_length())


def _part(progress: Progress, turn: int, turns: int) -> Progress:
    """Progress of one of several rounds of equal work."""

    def told(done: int, total: int) -> None:
        progress(turn * total + done, turns * total)

    return told


def _run(
    cages: Sequence[Trainee],
    points: Points,
    traced: TracedBoundary,
    *,
    first: int,
    jobs: int,
    progress: Progress | None,
    stop: Event,
) -> Array:
    """Whether each run grew, shape (run,): run number `first` + k at point k."""
    grew = np.zeros(points.kick.size)
    parts = [range(k, min(k + SLICE, grew.size)) for k in range(0, grew.size, SLICE)]

    def work(part: range) -> int:
        if stop.is_set():
            raise Stopped
        for k in part:
            one, eta = cages[k % len(cages)], float(points.restitution_factor[k])
            kick = traced.kicks[int(points.kick[k])]
            found = run_ensemble(
                cage_at(one.cage, eta, float(points.friction[k])),
                one.settings,
                kicks=(kick,),
                runs=1,
                first_run=first + k,
            )
            grew[k] = found.outcome[0, 0] == RunOutcome.WHIRLS
        return len(part)

    done = work_through(work, parts, jobs=jobs, progress=progress, stop=stop)
    if None in done:
        raise KeyboardInterrupt
    return grew
