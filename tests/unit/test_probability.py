"""Probabilities out of samples: intervals, being best, tie groups, prefixes."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import beta

from separatrix.draws import sobol_points
from separatrix.ranking.lowest import lowest_of
from separatrix.study import Candidate, Friction, RankingQuestion
from separatrix.study_file import read_study
from separatrix.uncertainty.answer import _lowest
from separatrix.uncertainty.boundary import STABLE, UNDECIDED, UNSTABLE, Limits, own_draws
from separatrix.uncertainty.model import Case
from separatrix.uncertainty.probability import (
    best_credit,
    mixed_interval,
    prefix_counts,
    quantiles,
    sizes,
    tie_groups,
)

STUDY = read_study("cryogenic-turbopump")


@pytest.mark.parametrize(("true", "of"), [(1, 64), (32, 64), (400, 1024), (1023, 1024)])
def test_one_boundary_has_the_interval_of_jeffreys(true, of):
    """Quantiles of the beta distribution with half a count more on either side."""
    value, low, high = mixed_interval(np.array([[float(true)]]), of)
    known = beta(true + 0.5, of - true + 0.5).ppf([0.025, 0.975])
    assert value[0] == true / of
    # 41 levels stand for the distribution: their 2.5 % point misses the true one by a tenth of its width
    assert (low[0], high[0]) == pytest.approx(known, abs=0.1 * float(known[1] - known[0]))


def test_boundaries_that_disagree_widen_the_interval():
    """Half of them say 20 %, half 60 %: the interval holds both, though each by itself is narrow."""
    apart = mixed_interval(np.array([[205.0], [614.0]]), 1024)
    alike = mixed_interval(np.array([[410.0], [410.0]]), 1024)
    assert apart[1][0] < 0.2
    assert apart[2][0] > 0.6
    assert alike[2][0] - alike[1][0] < 0.1
    assert apart[0][0] == pytest.approx(alike[0][0], abs=1e-3)  # 409.5 and 410 of 1024


def test_none_and_all_reach_their_ends():
    """What never happened may be impossible, what always happened certain."""
    _, low, high = mixed_interval(np.array([[0.0, 64.0]]), 64)
    assert (low[0], high[1]) == (0.0, 1.0)
    assert 0.0 < high[0] < 0.06
    assert 0.94 < low[1] < 1.0


def test_more_samples_narrow_the_interval_as_the_root_of_their_number():
    """A hundred times as many: a tenth of the width."""
    few, many = (mixed_interval(np.array([[0.3 * n]]), n) for n in (100, 10_000))
    assert (few[2] - few[1]) / (many[2] - many[1]) == pytest.approx(10.0, rel=0.02)  # skewness of the few


def test_the_best_share_their_credit():
    """Two at the same largest threshold have half each."""
    assert best_credit(np.array([[0.5, 0.5, 0.1], [0.2, 0.3, 0.1]])).tolist() == [[0.5, 0.5, 0.0], [0, 1, 0]]


def test_those_that_cannot_be_told_from_the_leader_are_in_its_group():
    """The second loses in 90 % of the samples only, the third in all; the fourth ties with the third."""
    leader = np.full(100, 0.8)
    second = np.where(np.arange(100) < 10, 0.9, 0.5)
    third, fourth = np.full(100, 0.3), np.full(100, 0.3)
    table = np.stack([third, second, leader, fourth], axis=1)
    assert tie_groups(table, best_credit(table).mean(axis=0)) == [2, 1, 1, 2]


def test_a_leader_that_wins_95_percent_stands_alone():
    """Nineteen of twenty are enough, eighteen are not."""
    leader = np.full(20, 0.8)
    for wins, group in ((19, 2), (18, 1)):
        other = np.where(np.arange(20) < wins, 0.5, 0.9)
        table = np.stack([leader, other], axis=1)
        assert tie_groups(table, np.array([0.9, 0.1])) == [1, group]


def test_groups_are_led_from_the_best_on():
    """Three apart are three groups, in the order of their medians, whatever the order of the columns."""
    table = np.tile([0.2, 0.9, 0.5], (64, 1))
    assert tie_groups(table, best_credit(table).mean(axis=0)) == [3, 1, 2]


def test_sizes_double_up_to_all():
    """The last one is all samples, also if that is no power of two."""
    assert sizes(256) == [64, 128, 256]
    assert sizes(200) == [64, 128, 200]
    assert sizes(64) == [64]


def test_prefixes_count_the_first_samples():
    """The first two, three and five of a column."""
    true = np.array([[1, 0], [0, 0], [1, 1], [1, 1], [0, 1]], dtype=bool)
    assert prefix_counts(true, [2, 3, 5]).tolist() == [[1, 0], [2, 1], [3, 3]]


def test_nine_in_ten_lie_between_the_ends():
    """Median, 5 and 95 % of a column."""
    assert np.ravel(quantiles(np.arange(101.0)[:, None])).tolist() == [50.0, 5.0, 95.0]


def test_verdicts_follow_the_limits():
    """At the lower limit still STABLE, at the upper one still UNDECIDED, above it UNSTABLE."""
    limits = Limits(stable_from=np.array([0.0]), stable_up_to=np.array([0.1]), unstable_above=np.array([0.2]))
    friction = np.array([[0.05, 0.1, 0.15, 0.2, 0.21]])
    expected = [[STABLE, STABLE, UNDECIDED, UNDECIDED, UNSTABLE]]
    assert limits.verdicts(friction).tolist() == expected
    drifting = [[UNDECIDED, UNDECIDED, UNDECIDED, UNDECIDED, UNSTABLE]]
    assert limits.verdicts(friction, drifts=True).tolist() == drifting


def test_limits_that_cross_are_unstable_first():
    """Where all kicks change over at once, scatter may put the upper limit below the lower."""
    limits = Limits(stable_from=np.array([0.0]), stable_up_to=np.array([0.2]), unstable_above=np.array([0.1]))
    assert limits.verdicts(np.array([[0.05, 0.15]])).tolist() == [[STABLE, UNSTABLE]]


def test_every_boundary_has_its_share_of_the_samples():
    """As often as any other, whatever the number of samples."""
    assert sorted(np.bincount(own_draws(6, 4))) == [1, 1, 2, 2]
    assert np.bincount(own_draws(4096, 64)).tolist() == [64] * 64


def test_the_boundary_of_a_sample_tells_nothing_of_its_inputs():
    """Sobol' points in turn have the same first digits every 64: the boundary would be the first input's."""
    points, own = sobol_points(4096, 4, 0), own_draws(4096, 64)
    within = np.array([points[own == draw].mean(axis=0) for draw in range(64)])
    share = within.var(axis=0) / points.var(axis=0)
    # by chance 63 of 4095 of the variance lie between the boundaries, give or take 2/4095 sqrt(63/2)
    assert share == pytest.approx(63 / 4095, abs=5 * 2 / 4095 * (63 / 2) ** 0.5)


def test_the_lowest_friction_over_all_environments_is_that_of_the_means():
    """As `rank` has it: the standard errors of the means tell, not the scatter of single cages."""
    mean, error = {"A": 0.1, "B": 0.12}, 0.01
    candidates = tuple(
        Candidate(
            name=name,
            friction=dict.fromkeys("gl", Friction(mean=f, standard_error=error, standard_deviation=0.05)),
        )
        for name, f in mean.items()
    )
    study = replace(STUDY, ranking=RankingQuestion(environments=("g", "l"), candidates=candidates))
    cases = [
        Case(candidate=name, environment=place, place=i, columns=(), certain=0.0, count=1)
        for place in ("g", "")
        for i, name in enumerate(mean)
    ]
    found = _lowest(SimpleNamespace(study=study, cases=cases), (2, 3))
    log_error = np.hypot(error / 0.1, error / 0.12) / 2.0**0.5
    assert found[2] == pytest.approx(ndtr(np.log(1.2) / log_error), abs=1e-9)  # rounding of the quadrature
    assert found[2] + found[3] == pytest.approx(1.0, abs=1e-9)
    assert _lowest(SimpleNamespace(study=study, cases=cases), (0, 1))[0] < found[2]


def test_the_probability_of_the_lowest_friction_never_exceeds_one():
    """A leader far below the others: the quadrature's rounding is not passed on."""
    assert lowest_of([-2.62, -1.97, -1.31], [0.0459, 0.0457, 0.0647])[0] == 1.0
