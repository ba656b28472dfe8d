"""What the reduction of a log refuses, and what its one line says."""

from __future__ import annotations

import numpy as np
import pytest
from commands import refusal_line

from separatrix.friction.friction_file import place
from separatrix.friction.logs.log import Conditions, RawLog
from separatrix.friction.reduction import reduce_log

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


LOGS = [
    ("time that falls", {"time": with_row(7, 0.0)}, None, "time must not fall; got 0 after 3 in row 8"),
    ("time that is no number", {"time": with_row(7, NAN)}, None, "must be a finite number in each row"),
    ("time without end", {"time": with_row(399, float("inf"))}, None, "none in row 400"),
    ("time that stands", {"time": lambda time: 0.0 * time}, None, "time must rise; got 0 in every row"),
    ("friction that is no number", {"friction": with_row(7, NAN)}, None, "friction must be a finite number"),
    ("cycles that fall", {"cycles": with_row(7, 0.0)}, None, "cycles must not fall"),
    ("cycles that are no number", {"cycles": with_row(9, NAN)}, None, "cycles must be a finite number"),
    ("too few rows", {"rows": 3}, None, "needs at least 4 rows of steady friction; got 3"),
    ("a cut in what is not there", {}, "20 m", "the log has time"),
    ("a cut in cycles that are not there", {}, "20 cycles", "needs a column of cycles"),
    ("a cut behind the end", {}, "1 h", "must lie before the end of the test, 3.325 min"),
    ("a cut at the end", {}, "199.5 s", "must lie before the end of the test"),
    ("a cut that leaves little", {}, "198.5 s", "rows of steady friction"),
]


@pytest.mark.parametrize("end", [200.0, "inf cycles", "1" * 100 + " s"])
def test_a_wrong_end_of_running_in_is_refused_in_one_line(end):
    """More in reader_mutants.json."""
    line = refusal_line(end, lambda end: place(end, "run_in_end"))
    assert line.startswith("run_in_end must be a time, a distance or a number of cycles")


@pytest.mark.parametrize(("changes", "end", "words"), [row[1:] for row in LOGS], ids=[row[0] for row in LOGS])
def test_a_wrong_log_is_refused_in_one_line(changes, end, words):
    """Each log that cannot be reduced says why; nothing is repaired or guessed. Without a fault it is."""
    assert 0.09 < reduce_log(log()).friction < 0.11
    cut = end and place(end, "run_in_end")
    assert words in refusal_line(cut, lambda cut: reduce_log(log(**changes), cut))
