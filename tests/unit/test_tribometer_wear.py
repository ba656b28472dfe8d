"""Wear coefficient from the wear depth of a log."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from separatrix.friction.logs.column_map import Conditions
from separatrix.friction.logs.log import RawLog
from separatrix.friction.reduction import reduce_log
from separatrix.friction.wear import NO_GROWTH, NO_WAY, TOO_FEW, sample_wear
from separatrix.verbs.tribometer import _worn

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
    assert found.wear_share == pytest.approx(0.75, abs=1e-3)


def test_way_by_speed_and_time():
    """The same of a log without a distance: of its speeds, or of a stated one."""
    rows, whole = slice(900, 3601), sample_wear(LOG, LOG.conditions, slice(900, 3601))
    moving = replace(LOG, distance=None, slip_speed=np.full(TIME.size, -0.5))
    stated = replace(LOG, distance=None)
    for log, conditions in ((moving, LOG.conditions), (stated, Conditions(pressure=2e6, slip_speed=0.5))):
        found = sample_wear(log, conditions, rows)
        assert found.wear_coefficient == pytest.approx(whole.wear_coefficient, rel=1e-9)


@pytest.mark.parametrize(
    "log",
    [
        replace(LOG, wear_depth=None),
        replace(LOG, conditions=Conditions()),
        replace(LOG, distance=None, time=None, cycles=TIME),
    ],
)
def test_what_is_not_known_gives_none(log):
    """Neither a depth, nor a pressure, nor a way is guessed."""
    assert sample_wear(log, log.conditions, slice(900, 3601)).wear_coefficient is None


def test_a_depth_that_only_drifts_with_heat_is_said():
    """A pin that grows longer, or noise alone, is no wear; the test has a flag."""
    for depth in (-1e-9 * TIME, 1e-7 * NOISE):
        found = reduce_log(replace(LOG, wear_depth=depth))
        assert found.wear.wear_coefficient is None
        assert NO_GROWTH in found.flags
    assert NO_GROWTH not in reduce_log(LOG).flags


@pytest.mark.parametrize(
    ("changes", "flag"),
    [
        ({"distance": None}, NO_WAY),
        ({"distance": None, "time": None, "cycles": TIME}, NO_WAY),
        ({"wear_depth": np.full(TIME.size, np.nan)}, TOO_FEW),
    ],
)
def test_why_there_is_no_coefficient_is_said(changes, flag):
    """A depth without a way, or with gaps, is not one that does not grow."""
    found = reduce_log(replace(LOG, **changes))
    assert found.wear.wear_coefficient is None
    assert flag in found.flags
    assert NO_GROWTH not in found.flags


def test_share_of_a_way_with_gaps():
    """A way that is not known at its end has the share of the rows that have one."""
    way = np.where(TIME > 3500.0, np.nan, LOG.distance)
    found = sample_wear(replace(LOG, distance=way), LOG.conditions, slice(900, 3601))
    assert found.wear_share == pytest.approx(2600.0 / 3500.0, abs=1e-3)


class Worn(SimpleNamespace):
    """A test of an answer: an attribute is also `in` it."""

    def __contains__(self, name):
        """Whether it has this number."""
        return hasattr(self, name)


def test_scatter_of_few_tests_is_that_of_another_test():
    """By Student: 12.706 sqrt(3/2) deviations of two tests, 3.182 sqrt(5/4) of four; not 1.96."""
    ratio = 10.0 ** (0.1 / np.sqrt(1.5))
    for tests, times in (((1.0, ratio), 7.9), ((1.0, ratio, 1.0, ratio), 1.5)):
        found = [Worn(wear_coefficient=1e-15 * one, conditions={"material": "PEEK"}) for one in tests]
        (line,) = _worn(found)
        assert f"a factor of {times} either way" in line
        assert f"({len(tests)} tests)" in line
