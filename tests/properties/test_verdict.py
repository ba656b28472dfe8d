"""Verdict, probability and worst kick of counts nobody thought of; ranks of any thresholds."""

from dataclasses import replace

import numpy as np
from cages import ON_A_LAND, ensemble
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.cage import Cause, Ensemble, RunOutcome
from separatrix.verdict.judgement import ENDS, KickCount, Verdict, judge
from separatrix.verdict.ranking_records import ranks
from separatrix.verdict.reasons import CageMotion

quick = settings(max_examples=150)

CAGE = replace(ON_A_LAND, ball_count=3)
SETTLES, WHIRLS, ROLLS = int(RunOutcome.SETTLES), int(RunOutcome.WHIRLS), int(RunOutcome.ROLLS)


@st.composite
def ensembles(draw: st.DrawFn) -> Ensemble:
    """Up to four kicks and 24 runs of any outcome; most kicks have one that is frequent."""
    runs, kicks = draw(st.integers(1, 24)), draw(st.integers(1, 4))
    any_end = st.sampled_from([int(end) for end in RunOutcome])
    rows = []
    for _ in range(kicks):
        usual, few = draw(any_end), draw(st.integers(0, runs))
        others = draw(st.lists(any_end, min_size=few, max_size=few))
        rows.append(others + [usual] * (runs - few))
    rubbing = np.where(np.array(rows) == SETTLES, draw(st.sampled_from([0.0, 3.0])), 0.0)
    return ensemble(rows, CAGE.ball_count, rubbing_force=rubbing)


def with_kick(runs: Ensemble, at: int, end: int) -> Ensemble:
    """The ensemble with a kick more, from which all runs end alike."""
    rubbing = np.insert(runs.rubbing_force, at, 0.0, axis=0)
    return ensemble(np.insert(runs.outcome, at, end, axis=0), CAGE.ball_count, rubbing_force=rubbing)


@quick
@given(ensembles(), st.integers(0, 4))
def test_a_kick_from_which_all_runs_settle_changes_neither_verdict_nor_probability(runs, at):
    """Wherever it stands in the list; the other kicks keep their counts."""
    at = min(at, runs.outcome.shape[0])
    before, after = judge(CAGE, runs), judge(CAGE, with_kick(runs, at, SETTLES))
    assert after.verdict is before.verdict
    for name in ("probability_stable", "probability_low", "probability_high"):
        assert getattr(after, name) == getattr(before, name)
    ends = list(map(ends_of, after.by_kick))
    del ends[at]
    assert ends == list(map(ends_of, before.by_kick))


def ends_of(count: KickCount) -> tuple[int, ...]:
    """Runs of each outcome."""
    return count.settles, count.rolls, count.whirls, count.drifts, count.unresolved


@quick
@given(ensembles())
def test_a_run_that_rolls_counts_as_one_that_settles(runs):
    """Neither verdict nor probability tells them apart, but for how they are named."""
    found = judge(CAGE, runs)
    settled = np.where(runs.outcome == ROLLS, SETTLES, runs.outcome)
    other = judge(CAGE, replace(runs, outcome=settled))
    assert (found.verdict, found.probability_stable) == (other.verdict, other.probability_stable)


@quick
@given(ensembles())
def test_no_verdict_contradicts_its_counts(runs):
    """Probability in its interval; UNSTABLE with most runs whirling, STABLE with few and from every kick."""
    found = judge(CAGE, runs)
    assert 0.0 <= found.probability_low <= found.probability_stable <= found.probability_high <= 1.0
    kicks = {k.kick: k for k in found.by_kick}
    worst = kicks[found.worst_kick]
    assert found.probability_stable == worst.calm / worst.runs == (worst.settles + worst.rolls) / worst.runs
    assert sum(k.runs for k in found.by_kick) == runs.outcome.size
    most_whirl = any(k.whirls > 0.5 * k.runs for k in found.by_kick)
    if found.verdict is Verdict.UNSTABLE:
        assert worst.calm < 0.5 * worst.runs < worst.whirls
    if found.verdict is Verdict.STABLE:
        assert all(k.whirls <= 0.1 * k.runs and k.calm >= 0.9 * k.runs for k in found.by_kick)
        assert not most_whirl
    if worst.whirls == 0 and worst.calm == worst.runs:
        assert found.verdict is not Verdict.UNSTABLE


@quick
@given(ensembles())
def test_the_evidence_is_that_of_the_motion_that_is_named(runs):
    """Medians are of the runs that end in the motion, and that is the frequent one."""
    marked = replace(runs, end_energy=runs.outcome.astype(float))
    found = judge(CAGE, marked)
    worst = next(k for k in found.by_kick if k.kick == found.worst_kick)
    if found.cage_motion is not None:
        assert found.end_energy == ENDS[found.cage_motion]
    least = max(1, worst.calm, worst.drifts + 1, worst.unresolved)
    assert (found.cage_motion is CageMotion.WHIRLING) == (worst.whirls >= least)
    if found.cage_motion in (CageMotion.CENTRED, CageMotion.ON_THE_LAND, CageMotion.ROLLING):
        assert worst.calm > worst.whirls
        assert (found.cage_motion is CageMotion.ROLLING) == (worst.rolls > worst.settles)


@quick
@given(ensembles())
def test_a_kick_from_which_all_runs_whirl_is_the_worst(runs):
    """With four runs or more it makes the cage unstable, whatever the others do."""
    found = judge(CAGE, with_kick(runs, 0, WHIRLS))
    if runs.outcome.shape[1] >= 4:
        assert (found.verdict, found.probability_stable) == (Verdict.UNSTABLE, 0.0)
    assert found.worst_kick in {k.kick for k in found.by_kick if k.calm == 0 or k.whirls > 0.5 * k.runs}


@quick
@given(st.lists(st.integers(0, 24), min_size=1, max_size=4))
def test_a_cage_that_its_land_keeps_moving_is_not_stable(kept):
    """More than a tenth of the runs from any kick suffice; the evidence is of the kick with most of them."""
    cause = np.where(np.arange(24) < np.array(kept)[:, np.newaxis], int(Cause.LAND_FRICTION), 0)
    found = judge(CAGE, replace(ensemble(np.full(cause.shape, SETTLES), CAGE.ball_count), cause=cause))
    assert (found.verdict is Verdict.STABLE) == (max(kept) <= 0.1 * 24)
    assert found.worst_kick == found.by_kick[int(np.argmax(kept))].kick


threshold = st.tuples(st.floats(0, 1), st.floats(0, 0.2), st.floats(0, 0.2)).map(
    lambda t: (t[0], t[0] - t[1], t[0] + t[2])
)
thresholds = st.lists(threshold, max_size=8)


@given(thresholds)
def test_ranks_follow_thresholds_are_shared_and_then_skipped(given_ones):
    """Each rank is one more than the number of candidates ranked better: 1, 1, 3, never 1, 1, 2."""
    found = ranks(given_ones)
    assert len(found) == len(given_ones)
    assert all(rank == 1 + sum(other < rank for other in found) for rank in found)
    pairs = [(t[0], rank) for t, rank in zip(given_ones, found, strict=True)]
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
