"""What the reduction of a log refuses, and what its one line says."""

from __future__ import annotations

import numpy as np
import pytest

from separatrix.errors import InputError
from separatrix.friction.logs.log import Conditions, RawLog
from separatrix.friction.reduction import ReductionOptions, reduce_log

NAN = float("nan")


def log(rows=400, **changes):
    """A log that reduces well, with changes; columns may be functions of the time."""
    time = np.arange(rows) * 0.5
    friction = 0.1 + 0.01 * np.random.default_rng(1).standard_normal(rows)
    columns = {"friction": friction, "time": time, "conditions": Conditions(cycle_time=5.0)}
    made = {key: value(time) if callable(value) else value for key, value in (columns | changes).items()}
    return RawLog(source="test.csv", checksum="0" * 64, format="made", **made)


def with_row(row, value):
    """Return a change of one row of a column that is like the time."""

    def change(time):
        return np.where(np.arange(time.size) == row, value, time)

    return change


OPTIONS = [
    ("no unit", {"run_in_end": "200"}, "must be a time, a distance or a number of cycles"),
    ("an unknown unit", {"run_in_end": "200 parsec"}, 'Write it like "10 min"'),
    ("a force", {"run_in_end": "200 N"}, 'got "200 N"'),
    ("nothing", {"run_in_end": ""}, "must be a time, a distance"),
    ("only a unit", {"run_in_end": "min"}, "must be one number and one unit"),
    ("a number", {"run_in_end": 200.0}, "got 200.0"),
    ("a decimal comma", {"run_in_end": "1,5 min"}, "needs a decimal point, not a comma"),
    ("a negative time", {"run_in_end": "-5 s"}, "must not be negative"),
    ("a negative distance", {"run_in_end": "-5 m"}, "must not be negative"),
    ("negative cycles", {"run_in_end": "-5 cycles"}, "must be a time, a distance"),
    ("an expression", {"run_in_end": "2*30 min"}, "must be one number and one unit"),
    ("no number", {"run_in_end": "nan s"}, "must be a time, a distance"),
    ("an endless one", {"run_in_end": "inf cycles"}, "must be a time, a distance"),
    ("too large a number", {"run_in_end": "1e999 s"}, "must be a number that a computer can hold"),
    ("too long a text", {"run_in_end": "1" * 100 + " s"}, "must be a time, a distance"),
    ("control characters", {"run_in_end": "5\n min"}, "must be"),
    ("an unknown axis", {"axis": "temperature"}, "must be one of time, distance, cycles"),
    ("an axis that is no text", {"axis": 3}, "must be one of time, distance, cycles"),
    ("text for a switch", {"whole_cycles": "yes"}, "must be true or false"),
    ("a number for a switch", {"find_cycle": 1}, "must be true or false"),
    ("a seizure at the usual friction", {"seizure_ratio": 1.0}, "must be > 1"),
    ("a seizure below it", {"seizure_ratio": -2.0}, "must be > 1"),
    ("no number for a ratio", {"seizure_ratio": NAN}, "must be a finite number"),
    ("a loss of all force", {"force_loss": 1.0}, "must be >= 0 and < 1"),
    ("a negative loss", {"force_loss": -0.1}, "must be >= 0 and < 1"),
    ("a negative oscillation", {"stick_slip_ratio": -0.1}, "must lie between 0 and 100"),
    ("text for a ratio", {"stick_slip_ratio": "0.1"}, "must be a finite number"),
    ("a negative drift", {"drift_ratio": -1.0}, "must lie between 0 and 100"),
    ("an endless drift", {"drift_ratio": float("inf")}, "must be a finite number"),
    ("one value is no test", {"fewest_effective": 1.0}, "must lie between 2 and"),
]

LOGS = [
    ("time that falls", {"time": with_row(7, 0.0)}, {}, "time must not fall; got 0 after 3 in row 8"),
    ("time that is no number", {"time": with_row(7, NAN)}, {}, "must be a finite number in each row"),
    ("time without end", {"time": with_row(399, float("inf"))}, {}, "none in row 400"),
    ("time that stands", {"time": lambda time: 0.0 * time}, {}, "time must rise; got 0 in every row"),
    ("friction that is no number", {"friction": with_row(7, NAN)}, {}, "friction must be a finite number"),
    ("cycles that fall", {"cycles": with_row(7, 0.0)}, {}, "cycles must not fall"),
    ("cycles that are no number", {"cycles": with_row(9, NAN)}, {}, "cycles must be a finite number"),
    ("too few rows", {"rows": 3}, {}, "needs at least 4 rows of steady friction; got 3"),
    ("an axis that is not there", {}, {"axis": "distance"}, "needs a column of distance"),
    ("a cut in what is not there", {}, {"run_in_end": "20 m"}, "the log has time"),
    ("a cut in cycles that are not there", {}, {"run_in_end": "20 cycles"}, "needs a column of cycles"),
    ("a cut behind the end", {}, {"run_in_end": "1 h"}, "must lie before the end of the test, 3.325 min"),
    ("a cut at the end", {}, {"run_in_end": "199.5 s"}, "must lie before the end of the test"),
    ("a cut that leaves little", {}, {"run_in_end": "198.5 s"}, "rows of steady friction"),
]


@pytest.mark.parametrize(("options", "words"), [row[1:] for row in OPTIONS], ids=[row[0] for row in OPTIONS])
def test_a_wrong_option_is_refused_in_one_line(options, words):
    """Each wrong option names itself, its rule, its value and, where there is one, the cure."""
    with pytest.raises(InputError) as caught:
        ReductionOptions(**options)
    line = str(caught.value)
    assert line.startswith(f"ReductionOptions.{next(iter(options))} ")
    assert words in line
    assert "\n" not in line


@pytest.mark.parametrize(
    ("changes", "options", "words"), [row[1:] for row in LOGS], ids=[row[0] for row in LOGS]
)
def test_a_wrong_log_is_refused_in_one_line(changes, options, words):
    """Each log that cannot be reduced says why; nothing is repaired or guessed."""
    with pytest.raises(InputError) as caught:
        reduce_log(log(**changes), ReductionOptions(**options))
    line = str(caught.value)
    assert words in line
    assert "\n" not in line


def test_the_log_without_a_fault_is_reduced():
    """The log that the wrong ones are changed from is right."""
    assert 0.09 < reduce_log(log()).friction < 0.11
