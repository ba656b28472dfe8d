"""Draws of the uncertain inputs of a study, and runs that draw their own bearing.

Run n of an uncertain study has draw n of its uncertain inputs. Such runs are judged as any others: the share
of them that settles is the probability that a bearing of this kind, made and loaded with the stated
uncertainties, runs stably. The draws are scrambled Sobol' points through the quantiles of the inputs.

The inputs are assumed to be independent: a study states no correlations. Where two inputs are correlated, as
a film's thickness and its modulus after wear, the computed spread may be too wide or too narrow.

Sobol' (1967) with the digital shift and linear scrambling of Matousek (1998), as `scipy.stats.qmc` has it.
For a smooth function the error of a mean falls nearly as 1/n, against the root of 1/n of random draws; it is
best at powers of two (Owen 2022, "On dropping the first Sobol' point").
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import exp, expm1, sqrt
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from separatrix.cage.disturbance import settings_for
from separatrix.cage.ensemble import Ensemble, Runs
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.chain.solution import Solution, solve
from separatrix.friction.friction_file import FRICTION_LIMIT
from separatrix.friction.friction_fit import TestedFriction
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import Array, MetrePerSecond, Ratio
from separatrix.study.candidates import environment_of
from separatrix.study.keys import Setter, setter, settled_in, study_numbers
from separatrix.study.study import BallModel, Friction, Study
from separatrix.study.uncertain import Distribution, log_normal
from separatrix.verdict.judgement import Judgement, judge_solution
from separatrix.verdict.long_jobs import Runner

MOST_SAMPLES = 2**20
STREAM = 0x50B0
"""Separates the draws of the inputs from other draws with a study's seed."""

BITS = 30
MOST_VARIANCE = 100.0
"""Largest variance of the logarithm of a friction from tests that are of use."""


class Case(NamedTuple):
    """A candidate in the bearing's own environment."""

    candidate: str


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainInput:
    """One uncertain number: its name and SI unit in a study, and its distribution.

    `source` of the distribution: ``"study"``, ``"measured"`` (the scatter of a measured friction), or
    ``"assumed"`` (that of an unrepeated test).
    """

    key: str
    unit: str
    distribution: Distribution
    source: str = "study"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Draws:
    """Draws of the uncertain inputs of a study, which has their means.

    `values` are in the SI units of the inputs, shape (sample, input); `probabilities` are the points behind
    them, the share of each distribution below a value, same shape [-].
    """

    study: Study
    inputs: tuple[UncertainInput, ...]
    values: Array
    probabilities: Array

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return tuple(one.key for one in self.inputs)

    def setter(self) -> Setter:
        """Return a function from one row of values to the study that has them."""
        return setter(self.study, self.names)


def uncertain_inputs(
    study: Study, frictions: Mapping[Case, Friction] | None = None
) -> tuple[UncertainInput, ...]:
    """Every uncertain number of a study: those with a distribution, then the frictions of the candidates.

    `frictions` are those measured in the bearing's own environment, by default as the study states them.

    Raises
    ------
    InputError
        A friction of 0 has a scatter, or one from tests has a scatter of ten times its mean.
    """
    known, found = study_numbers(study), list[UncertainInput]()
    for key, one in study.distributions.items():
        found.append(UncertainInput(key=key, unit=known[key].unit, distribution=one))
    return (*found, *_frictions(study, stated_frictions(study) if frictions is None else frictions))


def stated_frictions(study: Study) -> dict[Case, Friction]:
    """Measured friction of each case, as the study states it."""
    candidates, own = study.ranking.candidates if study.ranking else (), own_environment(study)
    return {Case(one.name): found for one in candidates if (found := one.friction.get(own)) is not None}


def own_environment(study: Study) -> str:
    """Return the environment of the bearing; empty where the study has none."""
    return (study.ranking and environment_of(study.ranking)) or ""


def _frictions(study: Study, frictions: Mapping[Case, Friction]) -> Iterator[UncertainInput]:
    """Measured frictions without a distribution in the study, log-normal, as the fit to tests assumes."""
    environment = own_environment(study)
    for (candidate,), friction in frictions.items():
        key = f"ranking.{candidate}.{environment}"
        if key in study.distributions:
            continue
        scatter = study.ranking.friction_scatter if study.ranking else 0.0
        deviation, source = next_cage_deviation(friction, scatter)
        if deviation > 0.0:
            where = f"Friction from tests of {candidate} in {environment}"
            law = settled_in(study, key, _next_cage(friction, deviation, where))
            yield UncertainInput(key=key, unit="-", distribution=law, source=source)


def _next_cage(friction: Friction, deviation: Ratio, where: str) -> Distribution:
    """Friction of a new cage; a fit to tests predicts the median, and the scatter of the logarithm."""
    if not isinstance(friction.law, TestedFriction):
        return log_normal(mean=friction.mean, standard_deviation=deviation)
    variance = (deviation / friction.mean) ** 2
    if variance > MOST_VARIANCE:
        got = f"{friction.mean:.3g} with a standard deviation of {deviation:.3g}"
        cure = "Test it nearer to the speed and pressure of the pocket, or state a friction."
        raise InputError(where, "must not scatter by ten times its mean [-]", got, cure)
    mean = friction.mean * exp(0.5 * variance)
    return log_normal(mean=mean, standard_deviation=mean * sqrt(expm1(variance)))


def next_cage_deviation(friction: Friction, default_scatter: Ratio) -> tuple[Ratio, str]:
    r"""Standard deviation of the friction of a new cage, and its source.

    Of a new cage, not of the mean: the scatter of single samples and the standard error of their mean
    together, :math:`s \sqrt{1 + 1/n}` for n samples; without a count the scatter alone; without a scatter
    `default_scatter` times the mean. The source is ``"measured"`` or ``"assumed"``.
    """
    if friction.standard_deviation is None:
        return default_scatter * friction.mean, "assumed"
    error, count = friction.standard_error, friction.count
    if error is None:
        error = friction.standard_deviation / sqrt(count) if count else 0.0
    deviation = sqrt(friction.standard_deviation**2 + error**2)
    return deviation, "assumed" if friction.assumed_scatter else "measured"


def sample(
    study: Study,
    samples: int,
    seed: int | None = None,
    *,
    frictions: Mapping[Case, Friction] | None = None,
) -> Draws:
    """Draw the uncertain inputs of a study, by default with the measured frictions that it states.

    A measured friction scatters up to the largest that a study takes: without its last draws it would be too
    low. `samples` is from 1 to `MOST_SAMPLES`, best a power of two; the first of more are the same as fewer.
    The draws of a seed of the scrambling, by default the study's, are the same on every machine.

    Raises
    ------
    InputError
        Nothing is uncertain, or the number of samples is out of range.
    """
    if not 1 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"must be a whole number from 1 to {MOST_SAMPLES}", str(samples))
    inputs = uncertain_inputs(study, frictions)
    if not inputs:
        cure = 'Write one like "0.5 um +- 20 %".'
        raise InputError(study.name, "has no uncertain number to draw", cure=cure)
    points = sobol_points(samples, len(inputs), STREAM, study.stability.seed if seed is None else seed)
    columns = [one.distribution.quantile(points[:, i]) for i, one in enumerate(inputs)]
    most = [
        FRICTION_LIMIT if one.key.startswith("ranking.") and one.unit == "-" else np.inf for one in inputs
    ]
    values = np.minimum(np.stack(columns, axis=1), most)
    return Draws(study=study, inputs=inputs, values=values, probabilities=points)


def sobol_points(samples: int, dimensions: int, *seed: int) -> Array:
    """Scrambled Sobol' points inside the unit cube, shape (sample, dimension) [-].

    Each is in the middle of its cell of 2**-`BITS`, so that none is on a face.
    """
    from scipy.stats import qmc

    generator = np.random.default_rng(seed)
    engine = qmc.Sobol(dimensions, scramble=True, bits=BITS, rng=generator)
    points: Array = engine.random_base2(max(samples - 1, 0).bit_length())[:samples]
    return points + 2.0 ** -(BITS + 1)


Solutions = Mapping[str, Solution]  # by the name of the candidate


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnBearings:
    """A bearing with its cages for each run."""

    study: Study  # as it is stated
    stated: Mapping[Case, Friction]
    """Friction of each measured case that is drawn: from tests as the central pocket sees it."""
    inputs: tuple[UncertainInput, ...]  # what is drawn
    scores: Array  # draws as standard normal numbers of the same probability, shape (run, input) [-]
    central: Solutions  # chain of each candidate with every input at its central value
    runs: tuple[int, ...]  # numbers of the runs whose draw makes a bearing
    solved: tuple[Solutions, ...]  # chains of each of them
    friction: Mapping[Case, Array]  # pocket friction of each case, shape (run,) [-]
    failures: tuple[str, ...]  # why the other draws make no bearing, one reason each

    def judge(self, case: Case, kicks: Sequence[MetrePerSecond], runner: Runner) -> Judgement:
        """Judge all the runs of a case by the ball that decides, offsets by the central cage."""
        every = range(len(self.runs))
        run = partial(self.ensemble, case, kicks, every, runner)
        return judge_solution(self.central[case.candidate], self.stated[case].mean, run)

    @property
    def kicks(self) -> tuple[MetrePerSecond, ...]:
        """Kicks of the central cages [m/s]."""
        cage = moving_cage(next(iter(self.central.values())), 0.0)
        return settings_for(self.study.stability, cage).kicks

    def ensemble(
        self,
        case: Case,
        kicks: Sequence[MetrePerSecond],
        places: Iterable[int],
        runner: Runner,
        central: MovingCage,
    ) -> Ensemble:
        """Run the bearings at these places once from each kick [m/s], among such balls as the central cage.

        Their frictions are as many times those drawn as its own is the central one.
        `Interrupted` if the work was interrupted before the last run.
        """
        asked, ball = [], None if central.free_ball is None else BallModel.FREE
        more = central.ball_cage_friction / (self.stated[case].mean or 1.0)
        for place in places:
            own = self.solved[place][case.candidate]
            cage = moving_cage(own, min(more * float(self.friction[case][place]), FRICTION_LIMIT), ball)
            asked.append(Runs(cage, own.study.stability, self.runs[place], 1))
        return runner.ensemble_of(asked, kicks)


def drawn_bearings(study: Study, runs: int) -> DrawnBearings:
    """Draw a bearing of a study with candidates for each run.

    Frictions without a distribution in the study scatter as their tests do: drawn is that of a new cage. A
    friction from tests follows the slip speed and the pressure in the pocket of its own draw.

    Raises
    ------
    InputError
        Nothing is uncertain, or no draw makes a bearing.
    """
    made: list[tuple[int, Study, Solutions]] = []
    failures = []
    central = _solutions(study)
    stated = frictions_to_draw(study, central)
    draws, numbers = sample(study, runs, frictions=stated), study_numbers(study)
    put = draws.setter()
    alike = all(numbers[key].is_friction for key in draws.names if key in numbers)
    for run, row in enumerate(draws.values.tolist()):
        try:
            drawn = put(row)
            own = central if alike else _solutions(drawn)
            for one in own.values():
                moving_cage(one, 0.0)  # refused here, not in a thread
            made.append((run, drawn, own))
        except SeparatrixError as error:
            failures.append(str(error))
    if not made:
        rule = "makes no bearing in any draw of its uncertain inputs"
        raise InputError(study.name, rule, failures[0])
    friction = _pocket_frictions(stated, central, made)
    return DrawnBearings(
        study=study,
        stated=stated,
        inputs=draws.inputs,
        scores=ndtri(draws.probabilities[[run for run, _, _ in made]]),
        central=central,
        runs=tuple(run for run, _, _ in made),
        solved=tuple(own for _, _, own in made),
        friction=friction,
        failures=tuple(failures),
    )


def frictions_to_draw(study: Study, central: Solutions | None = None) -> dict[Case, Friction]:
    """Measured friction of each case; one from tests as the pocket sees it, with its scatter there.

    A friction that is stated without tests keeps its own scatter: how much it differs in the pocket is not
    known. `extrapolation` names for both what was not tested.
    """
    found = stated_frictions(study)
    for case, friction in found.items():
        if friction.law is None:
            continue
        solution = (central or _solutions(study))[case.candidate]
        seen = solution.frictions[own_environment(study)] or friction
        of_tests = isinstance(friction.law, TestedFriction)
        found[case] = seen if of_tests else replace(friction, extrapolation=seen.extrapolation)
    return found


def _solutions(study: Study) -> Solutions:
    """Chain of each candidate."""
    ranking = study.ranking
    return {one.name: solve(study, one) for one in (ranking.candidates if ranking else ())}


def _pocket_frictions(
    stated: Mapping[Case, Friction], central: Solutions, made: Sequence[tuple[int, Study, Solutions]]
) -> dict[Case, Array]:
    """Pocket friction of each case in each bearing that was made."""
    drawn = [stated_frictions(one) for _, one, _ in made]
    return {
        case: np.array([one[case].mean for one in drawn]) * _moved(friction, case.candidate, central, made)
        for case, friction in stated.items()
    }


def _moved(
    friction: Friction, name: str, central: Solutions, made: Sequence[tuple[int, Study, Solutions]]
) -> Array:
    """Friction from tests in the pocket of each bearing, over that in the central one; else ones."""
    if not isinstance(friction.law, TestedFriction):
        return np.ones(len(made))
    fit = friction.law.fitted(central[name].study.operation.temperature)
    pockets = [central[name].pocket, *(own[name].pocket for _, _, own in made)]
    speed, pressure = (np.array([getattr(p, key) for p in pockets]) for key in ("slip_speed", "pressure"))
    log = fit.log_mean(slip_speed=speed, pressure=pressure)
    return np.asarray(np.exp(log[1:] - log[0]))
