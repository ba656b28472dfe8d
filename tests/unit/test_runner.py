"""The runner of long jobs: order, threads, interrupts, and what the ledger keeps of a killed one."""

import contextlib
import json
import math
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
import zlib
from collections import defaultdict
from dataclasses import fields, replace
from pathlib import Path

import distributed
import numpy as np
import pytest
from commands import COMMAND, pieces, refusal_line
from hypothesis import given
from hypothesis import strategies as st

from separatrix import InputError, MotionModel, PocketShape, read_study, solve, stability_curve
from separatrix.cage import Ensemble, moving_cage, run_ensemble, settings_for
from separatrix.cage.ensemble import Runs, follow_alike
from separatrix.front import console, main
from separatrix.front.console import Pace
from separatrix.ground.compiling import COMPILING
from separatrix.verdict import cluster as clusters
from separatrix.verdict import long_jobs as jobs
from separatrix.verdict.cluster import cluster
from separatrix.verdict.long_jobs import NAME, PART, Interrupted, Ledger, Load, Runner, Work

WHEEL = read_study("momentum-wheel")
CAGE = moving_cage(solve(WHEEL), 0.2)
QUICK = replace(settings_for(WHEEL.stability, CAGE), runs=PART + 5, duration=0.01)


def test_places_that_follow_are_computed_once():
    """A place that two others ask for is computed once, and progress counts it."""
    computed, told = [], []

    def compute(place):
        computed.append(place)
        return place

    runner = Runner(progress=lambda *at: told.append(at))
    found = runner.work_out(compute, [1, 2], into=dict, more=lambda place, _: [3] if place < 3 else [])
    assert sorted(computed) == sorted(found) == [1, 2, 3]
    assert told[0] == (0.0, math.inf)  # nothing is known yet
    assert told[-1][0] == told[-1][1] > 0.0


def work_of(**loads):
    """Work of places by name."""
    work = Work()
    work.loads |= loads
    return work


def test_what_is_left_goes_on_at_the_pace_of_what_was_made():
    """Nothing is known before the first run; a run counts 0.7 while its place is under way."""
    work = work_of(a=Load(100), b=Load(100), c=Load(100, dear=2.0))
    assert work.so_far(1) == (0.0, math.inf)
    work.spend("a", 3.0, 70)
    work.finish("a")
    assert work.so_far(1) == (3.0, 3.0 + 3.0 + 6.0)
    work.spend("b", 1.0, 50)
    assert work.so_far(1) == (4.0, pytest.approx(4.0 + 250.0 * 4.0 / 135.0))


def test_kept_runs_say_nothing_of_the_others():
    """They took no time."""
    work = work_of(kept=Load(100), new=Load(100), next=Load(100))
    work.keep("kept")
    work.end("kept", 0.001)
    work.finish("kept")
    assert work.so_far(1)[1] == math.inf
    work.spend("new", 6.0, 50)
    assert work.so_far(1)[1] == pytest.approx(0.001 + 6.0 + 150.0 * 6.0 / 35.0)


def test_the_first_tenth_of_scattered_places_resembles_all():
    """Of 100 places whose time grows a hundredfold, ten in their order and ten as they are scattered."""
    times = [100.0 ** (i / 99.0) for i in range(100)]
    mean = sum(times) / 100
    assert sum(times[:10]) / 10 < mean / 10.0
    assert 0.7 < sum(jobs.scattered(times)[:10]) / 10 / mean < 1.3  # 0.77; the first ten in order: 0.06
    assert sorted(jobs.scattered(times)) == times


def test_an_interrupt_is_noticed_and_breaks_in_nowhere():
    """One signal lets the item under way end; what handled signals before does so again."""
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)

    def work(item):
        if item == 2:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(0.05)
        return item

    runner = Runner()
    with pytest.raises(Interrupted) as caught:
        runner.work_out(work, range(100), into=dict)
    found = caught.value.finished
    assert [found[i] for i in range(3)] == [0, 1, 2]
    assert len(found) < 100
    assert runner.stop.is_set
    assert not [thread for thread in threading.enumerate() if "ThreadPool" in thread.name]
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before
    with pytest.raises(Interrupted) as caught:
        runner.work_out(work, [7], into=dict)
    assert caught.value.finished is None  # nothing is begun afterwards


def test_a_second_interrupt_breaks_in():
    """It is raised once the item under way has ended."""
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)  # a test worker may ignore it

    def work(item):
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.2)

    try:
        with pytest.raises(KeyboardInterrupt):
            Runner().work_out(work, range(50), into=dict)
    finally:
        signal.signal(signal.SIGINT, usual)


def same_bits(*ensembles):
    """Every field has the same kind of number, shape and bits; None, of the plane, is the same too."""
    for field in fields(Ensemble):
        values = [getattr(one, field.name) for one in ensembles]
        if any(value is not None for value in values):
            values = [np.asarray(value) for value in values]
            assert len({(one.dtype, one.shape, one.tobytes()) for one in values}) == 1, field.name


def test_runs_in_space_are_kept_with_all_their_columns(tmp_path):
    """Tilt and axial motion too, which are None in the plane."""
    cage = replace(CAGE, motion=MotionModel.SPACE, pocket_shape=PocketShape.CYLINDRICAL)
    ledger = Ledger(tmp_path / NAME)
    asked = {"kicks": (0.5,), "runs": 3}
    first, second = (Runner(ledger=ledger).ensemble(cage, QUICK, **asked) for _ in range(2))
    assert ledger.taken == 3
    assert second.largest_tilt.shape == (1, 3)
    same_bits(run_ensemble(cage, QUICK, **asked), first, second)
    ledger.close()


def test_runs_of_many_places_go_side_by_side_with_the_same_bits(monkeypatch):
    """Twelve cages that turn this way or that, 3 runs each: few calls of the engine, the same runs."""
    batches = []

    def follow(kind, pieces, stop):
        batches.append(len(pieces))
        return follow_alike(kind, pieces, stop)

    monkeypatch.setattr("separatrix.verdict.side_by_side.follow_alike", follow)
    cages = [replace(CAGE, ball_cage_friction=0.05 * i) for i in range(6)]
    cages += [replace(one, cage_speed=-one.cage_speed, inner_speed=-one.inner_speed) for one in cages]

    def compute(place):
        return runner.ensemble(cages[place], QUICK, kicks=(0.1, 0.5), runs=3, first_run=place)

    runner = Runner(jobs=2)
    found = runner.work_out(compute, range(12), into=dict)
    assert len(batches) < sum(batches) == 24
    for place, cage in enumerate(cages):
        alone = run_ensemble(cage, QUICK, kicks=(0.1, 0.5), runs=3, first_run=place)
        same_bits(found[place], alone)


def test_bearings_of_their_own_are_run_as_each_by_itself():
    """Three cages, one of which turns backward, each with its number of a run: their columns, in order."""
    back = replace(CAGE, cage_speed=-CAGE.cage_speed, inner_speed=-CAGE.inner_speed)
    asked = [Runs(cage, QUICK, 7 + i, 1) for i, cage in enumerate((CAGE, back, replace(CAGE, mass=0.004)))]
    whole, how = Runner().ensemble_of(asked, (0.1, 0.5)), {"kicks": (0.1, 0.5), "runs": 1}
    parts = [run_ensemble(one.cage, QUICK, first_run=one.first_run, **how) for one in asked]
    same_bits(whole, jobs.joined(parts))


def test_a_fault_in_the_engine_is_raised_where_the_runs_were_asked_for(monkeypatch):
    """And nobody waits for ever."""

    def fails(*_):
        raise MemoryError

    monkeypatch.setattr("separatrix.verdict.side_by_side.follow_alike", fails)
    runner = Runner(jobs=2)
    with pytest.raises(MemoryError):
        runner.work_out(lambda n: runner.ensemble(CAGE, QUICK, kicks=(0.5,), runs=n), [1, 2, 3], into=dict)


def test_an_interrupt_ends_runs_under_way_within_two_seconds():
    """Runs of four minutes of simulated time, in two threads: what was finished before is kept."""
    long = replace(QUICK, duration=250.0)
    whirls = replace(CAGE, ball_cage_friction=0.25, land_stiffness=1e5)

    def compute(place):
        if place == 0:
            return "done"
        os.kill(os.getpid(), signal.SIGTERM)
        begun.append(time.monotonic())
        return runner.ensemble(whirls, long, kicks=(0.5,), runs=64)

    runner, begun = Runner(jobs=2), []
    Runner().ensemble(whirls, QUICK, kicks=(0.5,), runs=1)  # compiled before
    with pytest.raises(Interrupted) as caught:
        runner.work_out(compute, [0, 1], into=dict)
    assert time.monotonic() - begun[0] < 2.0
    assert caught.value.finished == {0: "done"}


@pytest.mark.parametrize(
    ("settings", "cage", "how"),
    [
        *[(change, {}, {}) for change in ({"seed": 5}, {"duration": 0.02}, {"ball_scatter": 0.5})],
        *[({}, change, {}) for change in ({"mass": CAGE.mass * (1.0 + 1e-15)}, {"ball_cage_friction": 0.3})],
        *[({}, {}, change) for change in ({"kicks": (0.7,)}, {"runs": 3}, {"first_run": 1})],
    ],
    ids=str,
)
def test_runs_are_taken_only_for_the_same_question(tmp_path, settings, cage, how):
    """A change of anything that a run depends on: nothing is taken."""
    ledger = Ledger(tmp_path / NAME)
    asked = {"kicks": (0.5,), "runs": 2, "first_run": 0}
    Runner(ledger=ledger).ensemble(CAGE, QUICK, **asked)
    Runner(ledger=ledger).ensemble(replace(CAGE, **cage), replace(QUICK, **settings), **asked | how)
    assert ledger.taken == 0
    Runner(ledger=ledger).ensemble(CAGE, QUICK, **asked)
    assert ledger.taken == 2
    ledger.close()


@pytest.mark.parametrize("damaged", [b"", b"nonsense", zlib.compress(bytes(10**7)), "text"], ids=len)
def test_a_damaged_piece_is_run_again(tmp_path, damaged):
    """Nothing, no compressed bytes, ten million of them, a text: the runs are made anew, and kept."""
    asked = {"kicks": (0.5,), "runs": 2}
    ledger = Ledger(tmp_path / NAME)
    first = Runner(ledger=ledger).ensemble(CAGE, QUICK, **asked)
    ledger.close()
    with contextlib.closing(sqlite3.connect(tmp_path / NAME)) as connection, connection:
        connection.execute("UPDATE piece SET found = ?", (damaged,))
    ledger = Ledger(tmp_path / NAME)
    again = Runner(ledger=ledger).ensemble(CAGE, QUICK, **asked)
    assert ledger.taken == 0
    assert again.end_energy.tobytes() == first.end_energy.tobytes()
    Runner(ledger=ledger).ensemble(CAGE, QUICK, **asked)
    assert ledger.taken == 2
    ledger.close()


def test_pieces_are_bound_to_their_keys_and_written_at_once(tmp_path):
    """Another reader has them before the file is closed; two that changed places, or a bit, are absent."""
    ledger, keys = Ledger(tmp_path / NAME), (jobs.key_of(1), jobs.key_of(2))
    for key, found in zip(keys, (b"one", b"two"), strict=True):
        ledger.put(key, found)
    other = Ledger(tmp_path / NAME)
    assert [other.get(key) for key in keys] == [b"one", b"two"]
    with contextlib.closing(sqlite3.connect(tmp_path / NAME)) as connection, connection:
        rows = dict(connection.execute("SELECT key, found FROM piece"))
        connection.execute("UPDATE piece SET found = ? WHERE key = ?", (rows[keys[1]], keys[0]))
        connection.execute("UPDATE piece SET found = ? WHERE key = ?", (rows[keys[1]][:-1] + b"x", keys[1]))
    assert [other.get(key) for key in keys] == [None, None]
    for one in (ledger, other):
        one.close()


def test_a_file_that_is_no_ledger_is_refused(tmp_path):
    """With its name; it is left as it was."""
    path = tmp_path / NAME
    path.write_text("mine" * 1000)
    with pytest.raises(InputError, match="cannot be used to keep runs"):
        Ledger(path)
    assert path.read_text() == "mine" * 1000


STUDY = """
extends = "momentum-wheel"
[stability]
kicks = ["0.4 m/s"]
duration = "5 ms"
runs = 16
"""


@pytest.mark.usefixtures("undrawn")
def test_a_killed_job_goes_on_to_the_same_bytes(elsewhere, tmp_path, capsys):
    """SIGKILL with some of the runs kept: no other file is left, and the next call takes those runs."""
    Path("s.toml").write_text(STUDY)
    given = "sweep s.toml --vary ball_cage_friction=0.1..0.4:6 --verdicts --json --jobs 1"
    call = given.split()
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen([*COMMAND, *call, "--out", "k"], **pipes)
    while pieces(tmp_path / "k") < 3 and process.poll() is None:
        time.sleep(0.02)
    process.kill()
    process.communicate()
    # The ledger is the same for every verb; those of rank and map that are interrupted go on in test_ranking
    # and test_stability_map.
    assert {path.name.removesuffix("-wal").removesuffix("-shm") for path in Path("k").iterdir()} == {NAME}
    assert main([*call, "--out", "k"]) == 0
    resumed, said = capsys.readouterr()
    assert "runs were taken from" in said
    assert main(call) == 0
    assert json.loads(resumed) == json.loads(capsys.readouterr().out)


# Runs on a Dask cluster: the same numbers as here; and what is refused.

FEW = replace(WHEEL.stability, runs=4, duration=0.005, restitution_factors=(0.2, 0.8))


@pytest.fixture(scope="module")
def two():
    """Two worker processes; another Dask on this machine may have port 8787."""
    settings = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "silence_logs": 50}
    port = {"dashboard_address": "127.0.0.1:0"}
    with distributed.LocalCluster(dashboard_address=None, scheduler_kwargs=port, **settings) as found:
        yield found


def test_a_cluster_gives_the_same_curve(two):
    """To the last bit."""
    with cluster(two.scheduler_address) as (executor, threads):
        assert threads == 4  # two for each worker
        runner = Runner(jobs=threads, executor=executor)
        far = stability_curve(CAGE, FEW, runner=runner)
    assert far == stability_curve(CAGE, FEW)


def refused(address):
    """Return the line with which an address is refused: with the option, and the address."""
    text = refusal_line(address, lambda one: cluster(one).__enter__())
    assert text.startswith("--cluster ")
    return text


def test_workers_of_another_version_are_refused(two, monkeypatch):
    """Their runs would be another engine's; the worker is named."""
    monkeypatch.setattr(clusters, "program", lambda: str(os.getpid()).encode())
    text = refused(two.scheduler_address)
    assert "has workers with another version" in text
    assert "tcp://" in text


WRONG = {
    "local:0": "must be local:N with N from 1 to 1024",
    "local:many": "must be local:N",
    "local:2000": "must be local:N",
    "nowhere": "is not the address of a running Dask scheduler",
    "tcp://127.0.0.1:1": "is not the address of a running Dask scheduler",
}


@pytest.mark.parametrize(("address", "words"), WRONG.items(), ids=WRONG.keys())
def test_a_wrong_address_is_refused_in_one_line(address, words, monkeypatch):
    """With the option, the rule and what was given."""
    monkeypatch.setattr(clusters, "PATIENCE", 0.5)
    text = refused(address)
    assert words in text
    assert f'"{address}"' in text


def test_without_the_extra_the_refusal_names_it(monkeypatch):
    """dask[distributed] is not among the requirements."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    text = refused("local:1")
    assert "needs the extra cluster" in text
    assert "separatrix[cluster]" in text


# How far a long job is: the told share never falls, and the time left is about right from a tenth on.
# The files in `recorded_work` are events of `rank dry-reaction-wheel` and `map cryogenic-turbopump` in one
# thread: what the job announced to `Work` (load, spend, keep, end, finish) of a place, by kind and number,
# and when it reported, by the processor time of the process, which no neighbour on the machine changes:
# ``report`` [s] with the time spent on runs under way [s], or for a map, which counts its points, ``pace``
# [s] with done and total.

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
    """After a tenth of its time, until nine tenths; the share never falls."""
    now = [0.0]
    monkeypatch.setattr(COMPILING, "clock", lambda: now[0])
    monkeypatch.setattr(console, "ENOUGH", 1.0)  # these jobs are short
    kinds = defaultdict[str, type](lambda: type("Kind", (str,), {}))
    events = json.loads(path.read_text())
    begun, *_, end = (one[1] for one in events if one[0] in ("report", "pace"))
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
            if 0.1 < (now[0] - begun) / (end - begun) < 0.9 and pace.left is not None:
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


def test_a_kind_of_which_little_was_made_leaves_the_end_open():
    """Numbers and words are two kinds, None is alone; a run of ten counts 0.07 of a place under way."""
    work = Work()
    work.loads.update(dict.fromkeys((1, 2, "slow", "slow too", None), Load(10.0)))
    work.spend(1, 1.0, 10.0)
    for _ in range(2):
        assert work.so_far(1)[1] == math.inf
        work.spend("slow", 1.0, 1.0)
    assert work.so_far(1)[1] < math.inf


def test_a_place_that_turns_to_free_balls_takes_longer():
    """Its first ten such runs count sixfold, and three quarters as many as of one state are expected.

    Of a place for which they were foreseen no more are.
    """
    work = work_of(a=Load(100), b=Load(100), foreseen=Load(550, has_free=True))
    for place in ("a", "foreseen"):
        work.spend(place, 10.0, 100)
    for place, runs, dear in (("a", 60.0, 6.0), ("a", 60.0, 6.0), ("b", 120.0, 1.0), ("foreseen", 60.0, 6.0)):
        work.ask(place, runs, dear)
    assert [work.loads[place].runs for place in work.loads] == [100.0 + 6.0 * 75.0, 120.0, 550.0]


def test_places_of_other_loads_are_another_kind():
    """A long one that ended after few runs, in no time, does not make the short ones look quick."""
    ends = work_of(long=Load(500), short=Load(100), next=Load(100))
    for place, spent in (("long", 0.0), ("short", 10.0)):
        ends.spend(place, spent, 100)
        ends.finish(place)
    pace = (10.0 + 100.0 * 10.0 / 600.0) / 200.0
    assert ends.so_far(1)[1] == pytest.approx(10.0 + 100.0 * pace)  # rounding


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
