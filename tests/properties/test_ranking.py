"""Ranks for thresholds nobody thought of."""

from hypothesis import given
from hypothesis import strategies as st

from separatrix.verdict.ranking_records import ranks

threshold = st.tuples(st.floats(0, 1), st.floats(0, 0.2), st.floats(0, 0.2)).map(
    lambda t: (t[0], t[0] - t[1], t[0] + t[2])
)
thresholds = st.lists(threshold, max_size=8)


@given(thresholds)
def test_ranks_are_shared_and_then_skipped(given_ones):
    """Each rank is one more than the number of candidates ranked better: 1, 1, 3, never 1, 1, 2."""
    found = ranks(given_ones)
    assert len(found) == len(given_ones)
    assert all(rank == 1 + sum(other < rank for other in found) for rank in found)


@given(thresholds)
def test_a_better_threshold_never_ranks_worse(given_ones):
    """Ranks follow the thresholds."""
    pairs = [(t[0], rank) for t, rank in zip(given_ones, ranks(given_ones), strict=True)]
    assert all(r1 <= r2 for v1, r1 in pairs for v2, r2 in pairs if v1 > v2)


@given(thresholds, st.randoms(use_true_random=False))
def test_the_order_of_the_candidates_does_not_matter(given_ones, random):
    """Shuffled candidates keep their ranks, if no two have the same threshold and different scatter."""
    order = list(range(len(given_ones)))
    random.shuffle(order)
    shuffled = ranks([given_ones[i] for i in order])
    values = [t[0] for t in given_ones]
    if len(set(values)) == len(values):
        assert shuffled == [ranks(given_ones)[i] for i in order]


@given(thresholds)
def test_equal_ones_tie(given_ones):
    """A candidate and its double share a rank."""
    doubled = ranks([t for t in given_ones for _ in (0, 1)])
    assert doubled[::2] == doubled[1::2]
