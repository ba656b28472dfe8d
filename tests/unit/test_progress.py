"""How far a long job is: the told share never falls, and the time left is about right from a tenth on.

The files in `recorded_work` are events of `rank dry-reaction-wheel` and `map cryogenic-turbopump` in one
thread: what the job announced to `Work` (load, spend, keep, end, finish) of a place, by its kind and number,
and when it reported, by the processor time of the process, which no neighbour on the machine changes:
``report`` [s] with the time spent on runs under way [s], or for a map, which counts its points, ``pace`` [s]
with done and total.
"""

import json
import math
from collections import defaultdict
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from separatrix.front import console
from separatrix.front.console import Pace
from separatrix.ground.compiling import COMPILING
from separatrix.verdict.long_jobs import Load, Work

RECORDED = sorted((Path(__file__).parent / "recorded_work").glob("*.json"))
SOME_WORK = st.floats(0.0, 1e3)


@given(st.lists(st.tuples(SOME_WORK, SOME_WORK), min_size=1))
def test_the_share_never_falls_however_much_work_is_found(steps):
    """Any amounts done, any rest expected after each: the share rises within 0 and 1, and ends at 1."""
    pace, done, before = Pace(), 0.0, 0.0
    for made, rest in [*steps, (1.0, 0.0)]:
        done += made
        pace(done, done + rest)
        assert before <= pace.share <= 1.0
        before = pace.share
    assert pace.share == 1.0


@given(st.lists(SOME_WORK, min_size=1))
def test_the_share_is_done_by_total_while_the_total_stays(parts):
    """Whatever the steps; 1e-9 is the rounding of a hundred products."""
    pace, done, total = Pace(), 0.0, sum(parts) + 1.0
    for part in parts:
        done += part
        pace(done, total)
        assert pace.share == pytest.approx(done / total, abs=1e-9)


@pytest.mark.parametrize("path", RECORDED, ids=lambda path: path.stem)
def test_a_real_job_tells_its_end_within_a_factor_of_two(path, monkeypatch):
    """After a tenth of its time, until the middle; the share never falls."""
    now = [0.0]
    monkeypatch.setattr(COMPILING, "clock", lambda: now[0])
    monkeypatch.setattr(console, "ENOUGH", 1.0)  # these jobs are short
    kinds = defaultdict[str, type](lambda: type("Kind", (str,), {}))
    events = json.loads(path.read_text())
    begun, end = (
        next(one[1] for one in way if one[0] in ("report", "pace")) for way in (events, events[::-1])
    )
    work, pace, shares, told = Work(), Pace(), [0.0], []
    for kind, *given_to in events:
        place = given_to[0]
        if isinstance(place, str):
            place = kinds[place.split()[0]](place)
        if kind == "load":
            work.loads[place] = Load(*given_to[1:])
        elif kind in ("report", "pace"):
            now[0] = place
            pace(*(given_to[1:] if kind == "pace" else work.so_far(1, *given_to[1:])))
            shares.append(pace.share)
            if 0.1 < (now[0] - begun) / (end - begun) < 0.5 and pace.left is not None:
                told.append(pace.left / (end - now[0]))
        else:
            getattr(work, kind)(place, *given_to[1:])
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(told) > 10
    assert all(0.5 < one < 2.0 for one in told), (min(told), max(told), told[:5])


def test_what_is_left_of_a_kind_goes_on_at_its_own_pace():
    """Runs of one kind take ten times as long; its pace and that of all count alike, by one load each."""
    work = Work()
    work.loads.update(dict.fromkeys(("slow", "slow too", 1, 2), Load(10.0)))
    for place, spent in (("slow", 10.0), (1, 1.0)):
        work.spend(place, spent, 10.0)
        work.finish(place)
    done, total = work.so_far(1)
    slow, fast = (10.0 + 5.5) / 20.0, (1.0 + 5.5) / 20.0
    assert (done, total - done) == (11.0, pytest.approx(10.0 * slow + 10.0 * fast))  # rounding


def test_a_kind_of_which_nothing_was_made_leaves_the_end_open():
    """A number and a word are two kinds."""
    work = Work()
    work.loads.update(dict.fromkeys((1, 2, "slow"), Load(10.0)))
    work.spend(1, 1.0, 10.0)
    assert work.so_far(1)[1] == math.inf
    work.spend("slow", 5.0, 5.0)
    assert work.so_far(1)[1] < math.inf


def test_work_for_runs_that_have_not_ended_counts():
    """Of 10 s left 10 s under way may be all or little: half of it is left; the end is never passed."""
    work = Work()
    work.loads.update(dict.fromkeys((1, 2), Load(10.0)))
    work.spend(1, 10.0, 10.0)
    work.finish(1)
    assert work.so_far(1) == (10.0, 20.0)
    assert work.so_far(1, 10.0) == (20.0, 25.0)
    work.spend(2, 10.0, 10.0)
    work.finish(2)
    assert work.so_far(1, 1.0) == (21.0, 21.0)
