"""Sobol indices of functions whose indices are known in closed form."""

import numpy as np
import pytest
from asked import (
    ISHIGAMI,
    LINEAR_KNOWN,
    as_arrays,
    ishigami_indices,
    linear,
    linear_shares,
    question,
)

from separatrix.distribution import LogNormal, Normal, Uniform
from separatrix.sensitivity import Case, Factor, sobol_indices

UNIT = Uniform(low=0.0, high=1.0)


def both(asked, samples=4096, case=0, of="margin", **options):
    """First-order and total indices, shape (3, factor) each: values, low and high ends."""
    found = sobol_indices(asked, samples, seed=3, **options).cases[case]
    return as_arrays(getattr(found, of))


def test_ishigami_has_its_indices():
    """First-order and total in closed form; 0.03 is the width of the interval of the widest at this n."""
    first, total = both(ISHIGAMI)
    exact_first, exact_total = ishigami_indices()
    np.testing.assert_allclose(first[0], exact_first, atol=0.03)
    np.testing.assert_allclose(total[0], exact_total, atol=0.03)


def test_the_error_falls_faster_than_that_of_random_samples():
    """From n to 16 n the mean error over seeds falls by more than the 4 of random samples."""
    exact = np.array(ishigami_indices())

    def error(samples):
        return np.mean(
            [
                np.abs(
                    np.array(
                        [x[0] for x in as_arrays(sobol_indices(ISHIGAMI, samples, seed=s).cases[0].margin)]
                    )
                    - exact
                )
                for s in range(8)
            ]
        )

    assert error(4096) < error(256) / 4.0


def test_the_g_function_has_its_indices():
    """Product of (|4 x - 2| + a) / (1 + a): V_i = 1 / (3 (1 + a_i)^2); Saltelli & Sobol' 1995.

    0.02 is the width of the widest interval.
    """
    a = np.array([0.0, 1.0, 4.5, 9.0])
    g = question([UNIT] * 4, lambda x: np.prod((np.abs(4.0 * x - 2.0) + a) / (1.0 + a), axis=1))
    parts = 1.0 / (3.0 * (1.0 + a) ** 2)
    variance = np.prod(1.0 + parts) - 1.0
    first, total = both(g)
    np.testing.assert_allclose(first[0], parts / variance, atol=0.02)
    np.testing.assert_allclose(total[0], parts * np.prod(1.0 + parts) / (1.0 + parts) / variance, atol=0.02)


def test_in_a_sum_every_input_has_its_share_and_nothing_beside():
    """Total equals first-order equals a_i^2 s_i^2 / sum; 5e-3 is the interval's half width at n = 4096."""
    first, total = both(question(LINEAR_KNOWN, linear))
    np.testing.assert_allclose(first[0], linear_shares(), atol=5e-3)
    np.testing.assert_allclose(total[0], linear_shares(), atol=5e-3)


def test_an_input_that_does_nothing_has_none():
    """Both indices of an idle input are 0 and their intervals hold it."""
    idle = question([*LINEAR_KNOWN, Normal(mean=5.0, standard_deviation=2.0)], linear)
    first, total = both(idle)
    assert first[0][3] == total[0][3] == 0.0
    assert (first[1][3], total[1][3]) == (0.0, 0.0)
    assert first[2][3] < 1e-3
    assert total[2][3] < 1e-3


def test_two_inputs_that_act_only_together_have_no_first_order():
    """x1 x2 with means 0: first-order 0, total 1, both inside their intervals."""
    symmetric = Uniform(low=-1.0, high=1.0)
    first, total = both(question([symmetric, symmetric], lambda x: x[:, 0] * x[:, 1]))
    assert (first[1] == 0.0).all()
    assert ((total[1] <= 1.0) & (total[2] >= 1.0 - 1e-12)).all()


def test_a_verdict_of_two_conditions_has_the_indices_of_their_product():
    """STABLE where both x > 1/2: S = 1/3, T = 2/3 of the variance 3/16; 0.02 is the interval's half width."""
    asked = question([UNIT, UNIT], lambda x: np.minimum(x[:, 0], x[:, 1]) - 0.5)
    first, total = both(asked, of="verdict")
    np.testing.assert_allclose(first[0], 1.0 / 3.0, atol=0.02)
    np.testing.assert_allclose(total[0], 2.0 / 3.0, atol=0.02)


def test_a_group_has_the_index_of_its_sum():
    """Two inputs of a sum varied as one: their shares together, and the third keeps its own."""
    groups = [Factor(name="pair", words="the pair", inputs=(0, 2))]
    found = sobol_indices(question(LINEAR_KNOWN, linear), 4096, factors=groups).cases[0].margin
    by_name = {one.factor: one.first.value for one in found}
    shares = linear_shares()
    assert set(by_name) == {"pair", "x1"}
    assert by_name["pair"] == pytest.approx(shares[0] + shares[2], abs=5e-3)  # as in the sum above
    assert by_name["x1"] == pytest.approx(shares[1], abs=5e-3)


def test_a_group_holds_what_its_inputs_do_together():
    """The total of (x1, x3) of Ishigami is all but x2's share, and so is its first-order index."""
    groups = [Factor(name="pair", words="the pair", inputs=(0, 2))]
    found = sobol_indices(ISHIGAMI, 4096, factors=groups).cases[0].margin
    pair = next(one for one in found if one.factor == "pair")
    rest = 1.0 - ishigami_indices()[0][1]
    assert pair.first.value == pytest.approx(rest, abs=0.02)  # half the interval's width
    assert pair.total.value == pytest.approx(rest, abs=0.02)


def shared(entering=True):
    """Two cases with a friction each and a film that enters both; a third friction enters both as well."""
    known = [
        LogNormal(mean=1.0, standard_deviation=0.2),
        Normal(mean=0.0, standard_deviation=0.3),
        Normal(mean=0.0, standard_deviation=0.5),
        Normal(mean=0.0, standard_deviation=0.2),
    ]
    places = ((0, 1, 3), (0, 2, 3)) if entering else (None, None)
    cases = [
        Case(candidate=name, environment="gas", inputs=own) for name, own in zip("AB", places, strict=True)
    ]
    return question(
        known,
        lambda x: x[:, 0] + x[:, 1] + x[:, 3],
        lambda x: x[:, 0] + 2.0 * x[:, 2] - x[:, 3],
        cases=cases,
    )


def test_inputs_that_share_no_case_share_a_matrix():
    """Own frictions together: 2 + 3 matrices, where 2 + 4 stand without that knowledge; the same indices."""
    short, long = (sobol_indices(shared(entering), 1024) for entering in (True, False))
    assert (short.evaluations, long.evaluations) == (5 * 1024, 6 * 1024)
    for a, b in zip(short.cases, long.cases, strict=True):
        known = {one.factor: one for one in b.margin}
        for one in a.margin:
            assert one.total == known[one.factor].total
            assert one.first == known[one.factor].first


def test_an_input_that_enters_two_candidates_has_its_share_in_each():
    """The fourth input: s^2 = 0.04 of 0.04 + 0.09 + 0.04 in A, of 0.04 + 1 + 0.04 in B; 5e-3 as in a sum."""
    for case, others in ((0, 0.09), (1, 1.0)):
        found = sobol_indices(shared(), 4096).cases[case].margin
        index = next(one for one in found if one.factor == "x3")
        assert index.first.value == pytest.approx(0.04 / (0.08 + others), abs=5e-3)


def test_intervals_of_ishigami_hold_what_they_promise():
    """80 repeats of 6 indices: the share inside is 95 %, give or take three of its standard errors.

    Indices of one repeat are not independent, so the error is that of 80 repeats;
    benchmarks/sobol_coverage.py counts 1000.
    """
    exact = ishigami_indices()
    inside = []
    for seed in range(80):
        found = as_arrays(sobol_indices(ISHIGAMI, 512, seed=seed).cases[0].margin)
        inside.append(
            [(one[1] <= true + 1e-12) & (one[2] >= true) for one, true in zip(found, exact, strict=True)]
        )
    assert abs(np.mean(inside) - 0.95) < 3.0 * np.sqrt(0.95 * 0.05 / 80)
