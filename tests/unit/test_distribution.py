"""Distributions of one number: moments and quantiles by a second road, refusals, words."""

import math

import numpy as np
import pytest
from scipy import stats

from separatrix.ground.errors import InputError
from separatrix.study.distribution import (
    CUT,
    log_normal,
    log_uniform,
    normal,
    samples,
    uniform,
)

POINTS = (np.arange(2**16) + 0.5) / 2**16
"""Midpoints: the mean of a function of them is its integral, to 1e-9 for what is smooth inside."""

LAW = normal(mean=0.5, standard_deviation=0.05)
LOG_SIGMA = math.sqrt(math.log1p(0.4**2))
CASES = {
    "normal": (LAW, stats.truncnorm(-CUT, CUT, loc=0.5, scale=0.05)),
    "uniform": (uniform(low=2.0, high=5.0), stats.uniform(2.0, 3.0)),
    "log-uniform": (log_uniform(low=0.2, high=5.0), stats.loguniform(0.2, 5.0)),
    "log-normal": (
        log_normal(mean=2.0, standard_deviation=0.8),
        stats.lognorm(LOG_SIGMA, scale=2.0 * math.exp(-0.5 * LOG_SIGMA**2)),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_quantiles_and_moments_are_those_of_scipy_and_of_their_integrals(name):
    """To rounding; the log-normal of scipy has no end, which moves 2.9e-7 of probability.

    The cut at 5 standard deviations takes 8e-6 of a normal one's and 3e-5 of this log-normal one's. The
    outermost points that a sampling can give stay between the stated ends.
    """
    ours, theirs = CASES[name]
    u = np.linspace(0.01, 0.99, 99)
    assert ours.quantile(u) == pytest.approx(theirs.ppf(u), rel=1e-5 if name == "log-normal" else 1e-12)
    assert float(np.mean(ours.quantile(POINTS))) == pytest.approx(ours.mean, rel=1e-5)
    assert ours.mean == pytest.approx(theirs.mean(), rel=1e-12)
    assert float(np.std(ours.quantile(POINTS))) == pytest.approx(ours.standard_deviation, rel=1e-4)
    assert ours.standard_deviation == pytest.approx(theirs.std(), rel=1e-4)
    ends = ours.quantile(np.array([2.0**-31, 1.0 - 2.0**-31]))
    assert ours.low <= ends[0] < ends[1] <= ours.high


@pytest.mark.parametrize("ratio", [1.0001, 1.05, math.exp(0.0999), math.exp(0.1001), 30.0])
def test_the_width_of_a_log_uniform_distribution_is_exact_on_both_sides_of_its_series(ratio):
    """Gauss points integrate the variance about the mean without cancellation; to rounding they agree."""
    law = log_uniform(low=1.0, high=ratio)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    values = ratio ** (0.5 + 0.5 * nodes)
    variance = 0.5 * float(weights @ (values - law.mean) ** 2)
    assert law.standard_deviation == pytest.approx(math.sqrt(variance), rel=1e-10)


def test_samples_are_drawn_with_equal_weights_in_rising_order():
    """Each of n values takes one n-th of the probability; moments are those of the list."""
    law = samples(values=(0.3, 0.1, 0.2, 0.2))
    drawn = law.quantile(np.array([0.0, 0.24, 0.26, 0.74, 0.76, 1.0]))
    assert drawn.tolist() == [0.1, 0.1, 0.2, 0.2, 0.3, 0.3]
    assert law.mean == pytest.approx(np.mean([0.1, 0.2, 0.2, 0.3]), rel=1e-15)
    assert law.standard_deviation == pytest.approx(np.std([0.1, 0.2, 0.2, 0.3]), rel=1e-14)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: normal(mean=1.0, standard_deviation=0.0), "standard_deviation must be > 0; got 0.0."),
        (lambda: normal(mean=math.nan, standard_deviation=1.0), "mean must be a finite number"),
        (lambda: log_normal(mean=0.0, standard_deviation=1.0), "mean must be > 0"),
        (lambda: uniform(low=2.0, high=1.0), "high must be > 2; got 1.0."),
        (lambda: uniform(low=-math.inf, high=1.0), "low must be a finite number"),
        (lambda: log_uniform(low=0.0, high=1.0), "low must be > 0"),
        (lambda: samples(values=(1.0,)), "values must have 2 to 10000 samples; got 1."),
        (lambda: samples(values=(1.0, math.inf)), "values must be a finite number"),
        (lambda: samples(values=(2.0, 2.0)), "values must differ"),
    ],
)
def test_a_record_refuses_what_is_no_distribution(make, words):
    """A distribution of Python is checked as that of a file."""
    with pytest.raises(InputError, match="must") as error:
        make()
    assert words in str(error.value)
