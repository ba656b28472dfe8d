"""Reduction of a log: what is cut, averaged, told, kept and refused; wear from its depth."""

from dataclasses import replace

import numpy as np
import pytest
from commands import refusal_line
from synthetic_friction import Recipe, made

from separatrix.friction import steady
from separatrix.friction.friction_file import Place, place
from separatrix.friction.logs.column_map import Conditions
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction import TestFriction, reduce_log
from separatrix.friction.wear import FALLS, NO_GROWTH, NO_PRESSURE, NO_WAY, TOO_FEW, sample_wear
from separatrix.ground.plain_data import Part
from separatrix.verbs.tribometer import _worn

MEASURED = {"slip_speed": 1.0, "normal_force": 10.0, "temperature": 150.0}
QUIET = Recipe(rows=4000, noise=0.004)


def log(recipe=QUIET, seed=0, *, knows_cycle=True, **changes):
    """A synthetic log; changes are columns, or functions of the time."""
    one = made(recipe, np.random.default_rng(seed), knows_cycle=knows_cycle).log
    return replace(one, **{k: v(one.time) if callable(v) else v for k, v in changes.items()})


def _noise(size):
    return np.random.default_rng(8).standard_normal(size)


def noisy(friction, **changes):
    """A log of this friction of the time, with white noise of 0.004."""
    return log(friction=lambda t: friction(t) + 0.004 * _noise(t.size), **changes)


def told(test: TestFriction, words: str) -> str:
    """The one flag that begins with these words; empty if there is none."""
    assert all(len(flag) < 400 for flag in test.flags)  # a friction file keeps 500 characters of each
    found = [flag for flag in test.flags if flag.startswith(words)]
    assert len(found) <= 1
    return found[0] if found else ""


def test_a_quiet_test_draws_no_flag():
    """Steady friction with white noise has nothing to tell; its mean is within 4 standard errors."""
    one = log()
    test = reduce_log(one)
    assert (test.source, test.checksum, test.conditions) == (one.source, one.checksum, one.conditions)
    assert test.flags == ()
    assert abs(test.friction - 0.12) < 4 * test.standard_error
    assert test.run_in_axis == "time"
    assert test.cycles == 197  # 4000 rows of 20.3 a cycle are 197.04


def test_the_cut_can_be_given_in_time_distance_or_cycles():
    """The same cut in three units gives the same mean; its method says that it was given."""
    one = log(knows_cycle=True)
    one = replace(one, distance=0.5 * one.time, cycles=one.time / one.conditions.cycle_time)
    cycle = one.conditions.cycle_time
    texts = (f"{30 * cycle:.6f} s", f"{15 * cycle:.6f} m", "30 cycles")
    found = [reduce_log(one, place(text, "")) for text in texts]
    assert {test.run_in_method for test in found} == {"given"}
    assert [test.run_in_axis for test in found] == ["time", "distance", "cycles"]
    assert found[0].friction == found[1].friction == found[2].friction
    assert found[2].run_in_end == pytest.approx(30, abs=0.06)  # of the first row behind it


def failed(share, ratio, **changes):
    """A log whose friction of 0.08 is multiplied at a share of its length, and stays there."""
    return log(
        replace(QUIET, friction=0.08, **changes),
        friction=lambda t: 0.08 * np.where(t > share * t[-1], ratio, 1.0) + 0.004 * _noise(t.size),
    )


@pytest.mark.parametrize("share", [0.05, 0.1, 0.15])
def test_a_film_that_fails_in_running_in_is_told_with_both_levels(share):
    """Friction from 0.08 to 0.25 that is cut as running-in: the sentence has both, the place and the cure."""
    test = reduce_log(failed(share, 3.125))
    assert test.friction == pytest.approx(0.25, abs=0.002)  # 10 times its error: what is after the rise
    flag = told(test, "Friction rises from 0.0")
    low, high = (float(flag.split(word)[1].split()[0]) for word in ("from", "to"))
    assert low == pytest.approx(0.08, abs=0.002)  # median of ten spans of 16 rows or more, four times over
    assert high == pytest.approx(test.friction, rel=0.005)  # three digits
    assert float(flag.split("near ")[1].split()[0]) == pytest.approx(400 * share, abs=2.1)  # a cycle
    for words in ("a failed film, or a genuine rise", "Look at the plot", "run_in_end in the column map"):
        assert words in flag


FALL = 0.08 + 0.12 * np.exp(-np.arange(4000) / 100.0)
LOST = log(normal_force=lambda t: np.where((t > 40.0) & (t < 350.0), 10.0, 0.5))
CURE = "Look at the plot; if the film failed, use the log only up to the rise."
FAILS = noisy(lambda t: np.where(t > 80.0, 0.25, FALL))
SEIZES = noisy(lambda t: np.where(t > 300.0, 0.6, 0.12))
SPIKE = noisy(lambda t: np.where((t > 200) & (t < 202), 0.6, 0.12))
BELOW = noisy(lambda t: -0.1 + 0.0 * t)
COARSE = log(friction=lambda t: np.round(0.123 + 0.002 * _noise(t.size), 2), knows_cycle=False)
LOADED = {"The normal force reaches its 10 N only at 40": "", "The normal force falls from 10 N": ""}
TOLD = {  # a log, begin of a flag and words in it (None: no such flag), and what holds for the steady part
    "running-in that does not end, with the place of the last cut": (
        *(log(replace(QUIET, run_in=0.9, excess=0.2)), {"Running-in does not end": ""}),
        lambda test: test.run_in_end > 0.5 * 400,
    ),
    "a cut behind the middle": (noisy(lambda t: 0.12 + 0.1 * (t < 240.0)), {"Running-in takes 6": ""}),
    "a film that fails after a fall, at its own level": (FAILS, {"Friction rises from 0.08": "to 0.25 near"}),
    "fewer than four rows a cycle": (
        *(log(replace(QUIET, rows_of_a_cycle=2.5)), {"The log has 2.5 rows a cycle": ""}),
        lambda test: test.cycles == 0,
    ),
    "fewer whole cycles than have a mean": (
        *(log(Recipe(rows=200, rows_of_a_cycle=60.0)), {"The steady part holds 3 whole cycles": ""}),
        lambda test: test.cycles == 0,
    ),
    "a seizure, before which the steady part ends": (
        *(SEIZES, {"Seizure or a failed film": "at 5"}),
        lambda test: test.steady_end <= 300.0 and abs(test.friction - 0.12) < 4 * test.standard_error,
    ),
    "no seizure in a spike": (
        SPIKE,
        {"Seizure or a failed film": None},
        lambda test: test.steady_end > 390.0,
    ),
    "a load late and lost": (LOST, LOADED, lambda test: test.run_in_end >= 40.0 and test.steady_end <= 350.0),
    "fewer independent values than twenty": (
        log(replace(QUIET, correlation=0.03), knows_cycle=False),
        {"The steady part holds 12 independent values": "fewer than 20"},
    ),
    "a mean that no contact has": (BELOW, {"Friction is outside 0 to 2": "check zero, sign and units"}),
    "friction that never varies, without an error and without NaN": (
        *(log(friction=lambda t: np.full(t.size, 0.125)), {"Friction is 0.125 in every row": ""}),
        lambda test: (test.friction, test.standard_error, test.half_width) == (0.125, 0.0, 0.0),
    ),
    "steps whose mean is 0.1216": (COARSE, {}, lambda test: test.interval[0] < 0.123 < test.interval[1]),
}


@pytest.mark.parametrize("what", TOLD)
def test_what_is_wrong_with_a_test_is_told(what):
    """In a sentence with its numbers, once; what it means for the steady part."""
    one, flags, *holds = TOLD[what]
    test = reduce_log(one)
    for start, words in flags.items():
        flag = told(test, start)
        assert bool(flag) == (words is not None)
        assert (words or "") in flag
    assert all(one_holds(test) for one_holds in holds)


def test_a_given_end_is_told_of_a_film_that_fails_before_it_but_not_behind():
    """It hides no failed film, and whoever gave it needs no word of how; behind it the test is too short."""
    flag = told(reduce_log(failed(0.1, 3.125), Place("time", 60.0)), "Friction rises from 0.0")
    assert flag.endswith(CURE)
    assert "run_in_end" not in flag
    behind = reduce_log(failed(0.3, 2.5), Place("time", 60.0))
    assert told(behind, "Friction is correlated over")
    assert told(behind, "Friction rises from") == ""


@pytest.mark.parametrize("excess", [-0.048, -0.03, 0.12, 0.24])
def test_ordinary_running_in_is_no_failed_film(excess):
    """Friction that falls, or rises from six tenths of its end, is cut and not told."""
    test = reduce_log(log(replace(QUIET, run_in=0.15, excess=excess)))
    assert test.run_in_end > 10.0
    assert told(test, "Friction rises from") == ""


def test_modulation_within_a_cycle_does_not_shift_the_mean():
    """Half a turn too much shifts the mean of rows by 2 A/pi over the turns; whole cycles keep it."""
    recipe = Recipe(rows=250, noise=1e-4, modulation=0.05, rows_of_a_cycle=20.0)
    time = np.arange(250) * recipe.step
    friction = 0.12 + 0.05 * np.sin(2 * np.pi * time / 2.0)
    one = log(recipe, friction=friction)
    assert reduce_log(one).cycles == 12
    assert abs(reduce_log(one).friction - 0.12) < 1e-15  # sines over whole turns cancel to rounding
    rows = reduce_log(replace(one, conditions=replace(one.conditions, cycle_time=None))).friction
    assert rows - 0.12 == pytest.approx(0.05 * 2 / np.pi * 0.5 / 12.5, rel=0.05)  # 20 rows a turn: 1 %


def test_drift_is_told_per_hour_and_per_kilometre():
    """0.05 over 400 s are 0.45 an hour, over 200 m 0.25 a kilometre."""
    one = log(replace(QUIET, drift=0.05))
    test = reduce_log(one)
    assert abs(test.drift_rate - 0.05 / 399.9) < 4 * test.drift_error
    assert " per h " in told(test, "Friction drifts by 0.4")
    test = reduce_log(replace(one, distance=0.5 * one.time))
    assert " per km " in told(test, "Friction drifts by 0.2")


def test_white_noise_of_few_spans_seldom_passes_for_a_long_correlation():
    """In a short steady part most of the weight of all spectra is seldom on long ones."""
    rng = np.random.default_rng(17)
    means = [steady.steady_mean(rng.standard_normal(16)) for _ in range(400)]
    assert sum(mean.is_long for mean in means) < 12  # by chance 4; a Poisson count above 11 once in 4000


@pytest.mark.parametrize(
    ("name", "column", "words"),
    [
        ("slip_speed", lambda t: np.where(t < 250.0, 1.0, 1.2), "between 1 m/s and 1.2 m/s"),
        ("normal_force", lambda t: 10.0 + 10.0 * (t > 380.0), "between 10 N and 20 N"),
        ("temperature", lambda t: 295.0 + 0.1 * t, "between 29"),
        ("slip_speed", lambda t: np.abs(np.sin(1.7 * t)) + 0.05, ""),  # strokes
        ("slip_speed", lambda t: 10.0 + 2.0 * np.random.default_rng(5).standard_normal(t.size), ""),
        ("normal_force", lambda t: 1.0 + 0.00022 * t, ""),  # 8.1 % between the middles of the first and last
        ("temperature", lambda t: 295.0 + 0.045 * t, ""),  # 16.5 K
    ],
    ids=["step", "late step", "warming", "strokes", "noise", "slow rise", "less warming"],
)
def test_a_condition_that_changes_in_the_steady_part_is_reported(name, column, words):
    """More than a tenth, or 20 K; neither strokes nor noise nor a little less."""
    flag = told(reduce_log(log(**{name: column})), f"The {name.replace('_', ' ')} changes")
    assert words in flag
    assert bool(flag) == bool(words)


def test_measured_conditions_are_those_of_the_steady_part():
    """Before 100 s another speed, load and temperature; the pressure goes with the load, and words stay."""
    step = {name: lambda t, a=a: np.where(t < 300.0, a, 2 * a) for name, a in MEASURED.items()}
    whole = Conditions(slip_speed=1.0, normal_force=10.0, temperature=150.0, pressure=1e6, medium="air")
    one = log(conditions=whole, measured=frozenset({*MEASURED, "pressure"}), **step)
    test = reduce_log(one, Place("time", 300.0))
    doubled = Conditions(slip_speed=2.0, normal_force=20.0, temperature=300.0, pressure=2e6, medium="air")
    assert test.conditions == doubled
    assert reduce_log(replace(one, measured=frozenset())).conditions == whole  # stated, not measured


@pytest.mark.parametrize("noise", [1e-4, 0.4, 1.0])
def test_the_last_digit_of_a_log_is_in_the_error(noise):
    """Steps of 0.01: a step over root 12, times exp(-2 pi^2 (noise/step)^2), the noise in steps."""
    friction = np.round(0.123 + 0.01 * noise * _noise(4000), 2)
    error = steady.last_digit(np.append(friction, 0.13))  # one more, so that the step is seen
    left = np.exp(-2 * np.pi**2 * noise**2)
    assert error == pytest.approx(0.01 / 12**0.5 * left, abs=0.05 * 0.01 / 12**0.5)  # noise to 3 %, twice


def test_an_interval_is_students():
    """Half of it is t(0.975) of the degrees of freedom times the standard error: 2.571 for five."""
    test = replace(reduce_log(log()), standard_error=0.01, degrees_of_freedom=5)
    assert test.half_width == pytest.approx(0.02571, abs=5e-6)  # the table's digits
    assert test.interval == (test.friction - test.half_width, test.friction + test.half_width)


LOGS = [
    ("time that stands", {"time": lambda time: 0.0 * time}, None, "time must rise; got 0 in every row"),
    ("too few rows", {"recipe": Recipe(rows=3)}, None, "needs at least 4 rows of steady friction; got 3"),
    ("a cut in what is not there", {}, "20 m", "the log has time"),
    ("a cut in cycles that are not there", {}, "20 cycles", "needs a column of cycles"),
    ("a cut behind the end", {}, "1 h", "must lie before the end of the test, 6.665 min"),
    ("a cut at the end", {"time": lambda time: np.arange(time.size)}, "3999 s", "must lie before the end"),
    ("a cut that leaves little", {}, "399.7 s", "rows of steady friction"),
]


@pytest.mark.parametrize("end", [200.0, "inf cycles", "1" * 100 + " s"])
def test_a_wrong_end_of_running_in_is_refused_in_one_line(end):
    """More in reader_mutants.json."""
    line = refusal_line(end, lambda end: place(end, "run_in_end"))
    assert line.startswith("run_in_end must be a time, a distance or a number of cycles")


@pytest.mark.parametrize(("changes", "end", "words"), [row[1:] for row in LOGS], ids=[row[0] for row in LOGS])
def test_a_wrong_log_is_refused_in_one_line(changes, end, words):
    """Each log that cannot be reduced says why; nothing is repaired or guessed."""
    cut = end and place(end, "run_in_end")
    assert words in refusal_line(cut, lambda cut: reduce_log(log(**changes), cut))


# Wear coefficient from the wear depth of a log.

TIME = np.linspace(0.0, 3600.0, 3601)
NOISE = np.random.Generator(np.random.Philox(7)).normal(size=TIME.size)
LOG = RawLog(
    source="pin.csv", checksum="", format="", friction=0.1 + 1e-3 * NOISE, time=TIME, distance=0.5 * TIME,
    wear_depth=1e-6 * np.minimum(TIME, 600.0) / 600.0 + 2e-9 * 0.5 * TIME + 1e-7 * NOISE,
    conditions=Conditions(pressure=2e6),
)  # fmt: skip


def test_depth_over_pressure_and_way():
    """2 nm a metre at 2 MPa: 1e-15 m3/(N m); a micrometre of bedding in lies before the steady part."""
    found = sample_wear(LOG, LOG.conditions, slice(900, 3601))
    assert found.wear_coefficient == pytest.approx(1e-15, abs=3.0 * found.wear_error)
    assert found.wear_error < 0.02e-15
    assert found.wear_share == pytest.approx(0.75, abs=1 / 3600)  # one row
    # a way that is not known at its end has the share of the rows that have one
    way = np.where(TIME > 3500.0, np.nan, LOG.distance)
    found = sample_wear(replace(LOG, distance=way), LOG.conditions, slice(900, 3601))
    assert found.wear_share == pytest.approx(2600.0 / 3500.0, abs=1 / 3500)  # one row


def test_way_by_speed_and_time():
    """The same of a log without a distance: of its speeds, or of a stated one."""
    rows, whole = slice(900, 3601), sample_wear(LOG, LOG.conditions, slice(900, 3601))
    moving = replace(LOG, distance=None, slip_speed=np.full(TIME.size, -0.5))
    stated = replace(LOG, distance=None)
    for log, conditions in ((moving, LOG.conditions), (stated, Conditions(pressure=2e6, slip_speed=0.5))):
        found = sample_wear(log, conditions, rows)
        assert found.wear_coefficient == pytest.approx(whole.wear_coefficient, rel=1e-9)  # rounding


def test_a_depth_that_only_drifts_with_heat_is_said():
    """A pin that grows longer, a sensor of the other sign, or noise alone is no wear; the test has a flag."""
    for depth, flag in ((-1e-9 * TIME, FALLS), (1e-7 * NOISE, NO_GROWTH), (-1e-7 * NOISE, NO_GROWTH)):
        found = reduce_log(replace(LOG, wear_depth=depth))
        assert found.wear.wear_coefficient is None
        assert flag in found.flags
    assert NO_GROWTH not in reduce_log(LOG).flags


@pytest.mark.parametrize(
    ("changes", "flag"),
    [
        ({"wear_depth": None}, ""),
        ({"conditions": Conditions()}, NO_PRESSURE),
        ({"distance": None}, NO_WAY),
        ({"distance": None, "time": None, "cycles": TIME}, NO_WAY),
        ({"wear_depth": np.full(TIME.size, np.nan)}, TOO_FEW),
    ],
)
def test_why_there_is_no_coefficient_is_said(changes, flag):
    """Neither a depth, nor a pressure, nor a way is guessed; without one a depth is not one that stays."""
    found = reduce_log(replace(LOG, **changes))
    assert found.wear.wear_coefficient is None
    assert flag in (*found.flags, "")
    assert NO_GROWTH not in found.flags


def test_scatter_of_few_tests_is_that_of_another_test():
    """By Student: 12.706 sqrt(3/2) deviations of two tests, 3.182 sqrt(5/4) of four; not 1.96."""
    ratio = 10.0 ** (0.1 / np.sqrt(1.5))
    for tests, times in (((1.0, ratio), 7.9), ((1.0, ratio, 1.0, ratio), 1.5)):
        found = ({"wear_coefficient": 1e-15 * one, "conditions": {"material": "PEEK"}} for one in tests)
        (line,) = _worn([Part(one, {}) for one in found])
        assert f"a factor of {times} either way" in line
        assert f"({len(tests)} tests)" in line
    alone = {"wear_coefficient": 1e-15, "wear_error": 1e-18, "conditions": {"material": "PEEK"}}
    (line,) = _worn([Part(alone, {"wear_error": "m3/(N m)"})])
    assert "by the noise of this test; tests differ more" in line
