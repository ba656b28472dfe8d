"""What must hold of friction files and fits, whatever the tests."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from separatrix.friction.friction_file import FrictionFile, FrictionTest, Place, friction_text
from separatrix.friction.friction_fit import fit_friction
from separatrix.ground.errors import InputError
from separatrix.ground.reader import read_text

FRICTION = st.floats(0.01, 1.0)
POSITIVE = st.floats(1e-3, 100.0)
TEXT = st.text(st.characters(codec="utf-8"), min_size=1, max_size=20).filter(
    lambda t: t.isprintable() and t == t.strip() and "," not in t
)
ENVIRONMENT = {"material": "A", "counterface": "440C", "medium": "air"}


def group(frictions, speeds):
    """Tests of one material at these speeds, each of its own sample."""
    return [
        FrictionTest(friction=f, slip_speed=(v, v), **ENVIRONMENT)
        for f, v in zip(frictions, speeds, strict=True)
    ]


TESTS = st.lists(st.tuples(FRICTION, POSITIVE), min_size=1, max_size=8)


@given(
    TEXT, TEXT, TEXT, FRICTION, POSITIVE, POSITIVE, POSITIVE, st.sampled_from(["time", "distance", "cycles"])
)
@settings(max_examples=60, deadline=None)
def test_what_is_written_is_read(material, sample, flag, friction, v, p, end, axis):
    """Any printable words and any numbers come back as they were."""
    test = FrictionTest(
        material=material, counterface="440C", medium="air", friction=friction, slip_speed=(v, 2.0 * v),
        pressure=(1e6 * p, 1e6 * p), sample=sample, flags=(flag, "f" * 500), run_in_end=Place(axis, end),
        standard_error=friction / 7.0, standard_deviation=friction / 3.0, effective_count=10.0 + p, test=flag,
        temperature=(77.0 + p, 300.0), source="a.csv", checksum="ab" * 32, reduced_by="separatrix 0.1.0",
    )  # fmt: skip
    both = test, replace(test, source="a.csv, step 2", sample=None)  # two steps of one log
    assert read_text(FrictionFile, friction_text(both), "friction.toml").value.test == both
    with pytest.raises(InputError, match=r"flags\[1\] must be one line of 1 to 500"):
        replace(test, flags=("f" * 501,))


@given(TESTS, st.floats(0.2, 5.0), POSITIVE)
@settings(max_examples=40, deadline=None)
def test_friction_in_other_units_scales_the_answer_alone(tests, factor, speed):
    """All frictions times a factor: mean and errors take it on, relative scatter and words do not change."""
    frictions, speeds = zip(*tests, strict=True)
    scaled = [min(f * factor, 2.0) for f in frictions]
    factors = {s / f for s, f in zip(scaled, frictions, strict=True)}
    if max(factors) - min(factors) > 1e-9 or min(scaled) < 1e-4:
        return  # beyond what a friction may be
    factor = max(factors)  # a single friction may have been cut
    one, other = (
        fit_friction(group(f, speeds)).of("A", "air, 440C").at(slip_speed=speed) for f in (frictions, scaled)
    )
    assert other.extrapolation == one.extrapolation
    for name in ("mean", "standard_error", "standard_deviation", "widening"):
        # least squares of nearly equal speeds loses some digits
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=1e-6, abs=1e-12)


@given(TESTS, st.randoms(use_true_random=False))
@settings(max_examples=40, deadline=None)
def test_the_order_of_the_tests_does_not_matter(tests, random):
    """Shuffled tests: the same friction and scatter."""
    shuffled = list(tests)
    random.shuffle(shuffled)
    one, other = (
        fit_friction(group(*zip(*t, strict=True))).of("A", "air, 440C").at() for t in (tests, shuffled)
    )
    assert other.mean == pytest.approx(one.mean, rel=1e-6)
    assert other.standard_deviation == pytest.approx(one.standard_deviation, rel=1e-6)


@given(TESTS, st.floats(1.0, 1e4))
@settings(max_examples=40, deadline=None)
def test_farther_from_the_tests_the_scatter_only_grows(tests, factor):
    """Beyond the largest speed the mean stays and the deviation rises with the distance."""
    frictions, speeds = zip(*tests, strict=True)
    one = fit_friction(group(frictions, speeds)).of("A", "air, 440C")
    edge, beyond, far = (one.at(slip_speed=max(speeds) * f) for f in (1.0, factor, 2.0 * factor))
    assert beyond.mean == pytest.approx(edge.mean, rel=1e-9)
    assert edge.standard_deviation <= beyond.standard_deviation * (1 + 1e-12)
    assert beyond.standard_deviation <= far.standard_deviation * (1 + 1e-12)
    assert far.extrapolation
