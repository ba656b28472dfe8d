"""Quasi-random draws of the uncertain inputs of a study: scrambled Sobol' points through their quantiles.

The inputs are taken as independent of each other. A study says nothing of correlations; where two inputs go
together, a film's thickness and its modulus after wear, say, the spread that comes out may be too wide or too
narrow.

Sobol' (1967) with the digital shift and linear scrambling of Matousek (1998), as `scipy.stats.qmc` has it.
For a smooth function the error of a mean falls nearly as 1/n, against the root of 1/n of random draws; it is
best at powers of two (Owen 2022, "On dropping the first Sobol' point").
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import exp, expm1, isclose, sqrt
from typing import NamedTuple

import numpy as np

from separatrix.distribution import Distribution, LogNormal
from separatrix.errors import InputError
from separatrix.friction.fit import TestedFriction
from separatrix.study import Candidate, Friction, Study
from separatrix.study_numbers import Setter, setter, settled_in, study_numbers, value_of
from separatrix.units import Array, Ratio

MOST_SAMPLES = 2**20
STREAM = 0x50B0
"""Sets the draws of the inputs apart from whatever else is drawn from a study's seed."""

BITS = 30
MOST_VARIANCE = 100.0
"""Of the logarithm of a friction from tests: with more of it the tests tell nothing."""


class Case(NamedTuple):
    """A candidate in an environment; "" for the mean friction over all."""

    candidate: str
    environment: str


@dataclass(frozen=True, slots=True, kw_only=True)
class UncertainInput:
    """One uncertain number: its name and SI unit in a study, what is known of it, and its value there.

    `source` says where the distribution comes from: ``"study"`` wrote it, ``"measured"`` is the scatter of a
    measured friction, ``"assumed"`` the one that an unrepeated test is assumed to have.
    """

    key: str
    unit: str
    distribution: Distribution
    central: float
    source: str = "study"

    @property
    def deviation(self) -> float:
        """Standard deviation; of a friction from tests that of its logarithm, times the median."""
        law = self.distribution
        if isinstance(law, LogNormal) and isclose(self.central, law.median):
            return self.central * law.log_deviation
        return law.standard_deviation


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Draws:
    """Draws of the uncertain inputs of a study.

    Attributes
    ----------
    study : Study
        Which holds the mean of each input.
    inputs : tuple of UncertainInput
        In the order of the columns.
    values : ndarray
        Shape (sample, input), each in its SI unit.
    probabilities : ndarray
        The points behind the values: share of each distribution below them, shape (sample, input) [-].
    seed : int
        Of the scrambling.
    """

    study: Study
    inputs: tuple[UncertainInput, ...]
    values: Array
    probabilities: Array
    seed: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return tuple(one.key for one in self.inputs)

    @property
    def units(self) -> tuple[str, ...]:
        """SI units of the inputs."""
        return tuple(one.unit for one in self.inputs)

    @property
    def is_balanced(self) -> bool:
        """Whether the number of samples is a power of two, for which the points are spread most evenly."""
        return len(self.values).bit_count() == 1

    def column(self, key: str) -> Array:
        """Values of one input, shape (sample,)."""
        return self.values[:, self.names.index(key)]

    def first(self, samples: int) -> Draws:
        """Return the first samples: those that a smaller question would have drawn."""
        part = slice(samples)
        return replace(self, values=self.values[part], probabilities=self.probabilities[part])

    def with_values(self, values: Array) -> Draws:
        """Return other values of the same inputs, shape (sample, input); their points are not known."""
        return replace(self, values=values, probabilities=np.empty((0, len(self.inputs))))

    def setter(self) -> Setter:
        """Return a function from one row of values to the study that has them."""
        return setter(self.study, self.names)


def uncertain_inputs(
    study: Study, frictions: Mapping[Case, Friction] | None = None
) -> tuple[UncertainInput, ...]:
    """Every uncertain number of a study: those that it states so, then the frictions of the candidates.

    `frictions` are those of the candidates that were measured, by default as the study states them.

    Raises
    ------
    InputError
        A friction of 0 has a scatter, or one from tests scatters by ten times its mean.
    """
    known = study_numbers(study)
    found = [
        UncertainInput(
            key=key, unit=known[key].unit, distribution=one, central=value_of(study, known[key]) or 0.0
        )
        for key, one in study.distributions.items()
    ]
    return (*found, *_frictions(study, stated_frictions(study) if frictions is None else frictions))


def stated_frictions(study: Study) -> dict[Case, Friction]:
    """Measured friction of each case, as the study states it."""
    return {
        Case(candidate.name, environment): friction
        for candidate in (study.ranking.candidates if study.ranking else ())
        for environment, friction in candidate.friction.items()
        if friction is not None
    }


def _frictions(study: Study, frictions: Mapping[Case, Friction]) -> Iterator[UncertainInput]:
    """Measured frictions whose distribution the study does not give, with their scatter.

    Log-normal, as the fit to tests and `probability_lowest` take them: friction scatters by a share of
    itself.
    """
    for (candidate, environment), friction in frictions.items():
        key = f"ranking.{candidate}.{environment}"
        if key in study.distributions:
            continue
        scatter = study.ranking.friction_scatter if study.ranking else 0.0
        deviation, source = next_cage_deviation(friction, scatter)
        if deviation > 0.0:
            scattered = _next_cage(
                friction, deviation, f"Friction from tests of {candidate} in {environment}"
            )
            yield UncertainInput(
                key=key,
                unit="-",
                distribution=settled_in(study, key, scattered),
                central=friction.mean,
                source=source,
            )


def _next_cage(friction: Friction, deviation: Ratio, where: str) -> LogNormal:
    """Friction of the next cage; what a fit to tests foretells is the median, and the logarithm's scatter."""
    if not isinstance(friction.law, TestedFriction):
        return LogNormal(mean=friction.mean, standard_deviation=deviation)
    variance = (deviation / friction.mean) ** 2
    if variance > MOST_VARIANCE:
        got = f"{friction.mean:.3g} with a standard deviation of {deviation:.3g}"
        cure = "Test it nearer to how the pocket rubs, or state a friction."
        raise InputError(where, "must not scatter by ten times its mean [-]", got, cure)
    mean = friction.mean * exp(0.5 * variance)
    return LogNormal(mean=mean, standard_deviation=mean * sqrt(expm1(variance)))


def next_cage_deviation(friction: Friction, default_scatter: Ratio) -> tuple[Ratio, str]:
    r"""Standard deviation of the friction of the next cage, and where it comes from.

    Of the next cage, not of the mean: the scatter of single samples and the standard error of their mean
    together, :math:`s \sqrt{1 + 1/n}` for n samples. Without a count the scatter is taken as it is.

    Parameters
    ----------
    friction : Friction
        Mean with what is known of its scatter.
    default_scatter : float
        Standard deviation over mean where nothing is known [-].

    Returns
    -------
    tuple
        Standard deviation [-], and ``"measured"`` or ``"assumed"``.
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
    """Draw the uncertain inputs of a study.

    Parameters
    ----------
    study : Study
        With distributions, or with candidates whose friction was measured.
    samples : int
        1 to `MOST_SAMPLES`, best a power of two. The first of more samples are the same as fewer samples.
    seed : int, optional
        Of the scrambling; without it the study's.
    frictions : mapping, optional
        Measured friction of each case; by default as the study states it.

    Returns
    -------
    Draws
        The same for the same study, number and seed, whatever computes them.

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
    chosen = study.stability.seed if seed is None else seed
    points = sobol_points(samples, len(inputs), chosen)
    columns = [one.distribution.quantile(points[:, i]) for i, one in enumerate(inputs)]
    return Draws(
        study=study,
        inputs=inputs,
        values=np.stack(columns, axis=1),
        probabilities=points,
        seed=chosen,
    )


def sobol_points(samples: int, dimensions: int, seed: int) -> Array:
    """Scrambled Sobol' points inside the unit cube, shape (sample, dimension) [-].

    Each stands in the middle of its cell of 2**-`BITS`, so that none lies on a face.
    """
    from scipy.stats import qmc

    generator = np.random.default_rng(np.random.SeedSequence([STREAM, seed]))
    engine = qmc.Sobol(dimensions, scramble=True, bits=BITS, rng=generator)
    points: Array = engine.random_base2(max(samples - 1, 0).bit_length())[:samples]
    return points + 2.0 ** -(BITS + 1)


def candidates_of(study: Study) -> tuple[Candidate | None, ...]:
    """Return the candidates of a study; None, the cage as it is, if it ranks nothing."""
    return study.ranking.candidates if study.ranking else (None,)
