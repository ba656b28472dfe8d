"""Drawn bearings counted, compared and searched: closed forms, calibration, early ends."""

import contextlib
import io
import json
import os
import signal
from dataclasses import fields, make_dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from commands import document, wait_until
from scipy.special import expit

from separatrix.cage import Ensemble, RunOutcome
from separatrix.front import main
from separatrix.verdict import uncertain_study
from separatrix.verdict import uncertain_study as uncertain
from separatrix.verdict.draws import Case
from separatrix.verdict.judgement import KickCount, Verdict
from separatrix.verdict.uncertain_study import CHANCE, drivers, fitted, is_plain, settles_more

CASE = Case("A")
NAMES = ["x", "y", "z"]


def simulated(coefficients, count, seed=0):
    """Scores, and outcomes that a logistic law with these coefficients draws."""
    random = np.random.default_rng(seed)
    scores = random.standard_normal((count, len(coefficients) - 1))
    p = expit(coefficients[0] + scores @ np.array(coefficients[1:]))
    return scores, (random.random(count) < p).astype(float)


def test_the_regression_finds_the_law_that_drew_the_outcomes():
    """Standard errors of the coefficients are below 0.05 with 16 384 bearings: within 4 of them."""
    b = fitted(*simulated((0.5, 1.5, -0.7, 0.0), 16_384))
    assert b == pytest.approx([0.5, 1.5, -0.7, 0.0], abs=0.2)


def test_shares_are_squares_of_coefficients_beside_chance():
    """X 2, y 1: 4 and 1 against pi^2/3 of the chance of a single run; the interval holds it."""
    found = drivers("A", NAMES, *simulated((0.0, 2.0, 1.0, 0.0), 4096))
    total = 4.0 + 1.0 + np.pi**2 / 3.0
    shares = {one.name: one for one in found.shares}
    assert list(shares) == ["x", "y", "z", CHANCE]
    for name, true in (("x", 4.0), ("y", 1.0), ("z", 0.0), (CHANCE, np.pi**2 / 3.0)):
        assert shares[name].share == pytest.approx(true / total, abs=0.06)
        assert shares[name].share_low <= shares[name].share <= shares[name].share_high
    assert sum(one.share for one in found.shares) == pytest.approx(1.0, abs=1e-12)


def test_an_interval_holds_the_true_share_about_as_often_as_it_says():
    """100 repeats of 512 bearings; of 95 % at least 85 (binomial: 85 or fewer in 1 of 10 000)."""
    true = 2.25 / (2.25 + 0.49 + np.pi**2 / 3.0)
    inside = 0
    for seed in range(100):
        shares = drivers("A", NAMES, *simulated((0.0, 1.5, 0.7, 0.0), 512, seed)).shares
        (share,) = [one for one in shares if one.name == "x"]
        inside += share.share_low <= true <= share.share_high
    assert inside >= 85


def test_what_the_runs_cannot_tell_is_said():
    """Too few of the rarer outcome; and inputs that explain nothing."""
    scores, settled = simulated((4.5, 0.5, 0.0, 0.0), 512)
    rare = drivers("A", NAMES, scores, settled)
    assert (rare.shares, rare.skill) == ((), None)
    assert "too few to compare" in rare.reason
    idle = drivers("A", NAMES, *simulated((0.0, 0.0, 0.0, 0.0), 512))
    assert idle.shares == ()
    assert "explain" in idle.reason


def test_a_separation_by_one_input_stays_finite():
    """Every bearing with x above 0 settles: the prior keeps the coefficient from growing without end."""
    scores = np.random.default_rng(1).standard_normal((512, 2))
    b = fitted(scores, (scores[:, 0] > 0.0).astype(float))
    assert np.all(np.isfinite(b))
    assert b[1] > 5.0
    assert abs(b[2]) < 2.0


Judged = make_dataclass("Judged", ("verdict", "by_kick", "worst_kick", "is_by_land"))
"""What counting reads of a judgement."""


def judged(verdict, *settles, runs=64):
    """As a judgement: its verdict, counts by kick (the rest whirling) and worst kick."""
    known = dict.fromkeys(("drifts", "unresolved", "whirls_by_land"), 0)
    known |= {"probability_low": 0.0, "probability_high": 1.0}
    ends = [{"settles": n - n // 2, "rolls": n // 2, "whirls": runs - n} for n in settles]
    found = tuple(
        KickCount(kick=0.1 * (1 + i), probability_stable=1.0 - one["whirls"] / runs, **one, **known)
        for i, one in enumerate(ends)
    )
    worst = min(found, key=lambda one: one.calm)
    return Judged(verdict, found, worst.kick, False)


@pytest.mark.parametrize(
    ("verdict", "settles", "runs", "plain"),
    [
        (Verdict.STABLE, (64, 64), 64, False),  # 64 of 64 leave 0.85 open at 99.9 %
        (Verdict.STABLE, (128, 128), 128, True),
        (Verdict.UNSTABLE, (0,), 64, True),
        (Verdict.UNSTABLE, (22,), 64, False),
        (Verdict.UNDECIDED, (45,), 64, False),
    ],
)
def test_a_case_ends_early_only_where_more_would_hardly_decide_otherwise(verdict, settles, runs, plain):
    """By Wilson's interval at the risk of 1e-3."""
    assert is_plain(judged(verdict, *settles, runs=runs)) is plain


def test_a_kick_that_plainly_settles_more_is_not_run_further():
    """60 of 64 against 20; not 45 against 40."""
    far, near = judged(Verdict.UNDECIDED, 60, 20), judged(Verdict.UNDECIDED, 45, 40)
    assert [settles_more(one, far) for one in far.by_kick] == [True, False]
    assert [settles_more(one, near) for one in near.by_kick] == [False, False]


def test_a_kick_that_is_left_out_leaves_every_column_of_runs_in_space(monkeypatch):
    """The second block runs the worst kick alone; columns that only space has are as long as the others."""

    def ensemble(_case, kicks, places, *_):
        columns = {f.name: np.zeros((len(kicks), len(places))) for f in fields(Ensemble)}
        return Ensemble(**columns | {"kicks": np.array(kicks), "duration": 0.1})

    total = 2 * uncertain_study.BLOCK
    looks = iter([judged(Verdict.UNDECIDED, *counts) for counts in ((60, 20), (20,), (40,))])
    monkeypatch.setattr(uncertain_study, "judge", lambda *_, **__: next(looks))
    monkeypatch.setattr(uncertain_study, "transmitted_force", lambda _: 1.0)
    bearings = SimpleNamespace(runs=range(total), kicks=(0.1, 0.2), ensemble=ensemble, central={"A": None})
    _, found = uncertain_study.counted_among(bearings, CASE, None, SimpleNamespace(free_ball=None))
    assert found.largest_tilt.shape == found.outcome.shape == (1, total)


def test_outcomes_are_counted_where_they_settle_or_roll():
    """From the worst kick alone."""
    ends = [RunOutcome.WHIRLS, RunOutcome.SETTLES, RunOutcome.ROLLS]
    found = SimpleNamespace(kicks=np.array([0.1, 0.5]), outcome=np.array([[0, 0, 0], ends]))
    assert uncertain_study.settles(found, SimpleNamespace(worst_kick=0.5)).tolist() == [0.0, 1.0, 1.0]


# The verb `sensitivity`: keys, text, files, threads, interrupts.

SMALL = """
extends = "cryogenic-turbopump"
title = "A small uncertain ranking"
[film]
thickness = { between = ["0.4 um", "0.6 um"] }
[stability]
kicks = ["0.5 m/s"]
runs = 8
duration = "2 ms"
restitution_factors = [0.2, 0.5, 0.8]
[ranking]
environment = "air"
candidates = [
  { name = "A", friction = { air = { mean = 0.1, standard_deviation = 0.02, count = 4 }, vacuum = 0.15 } },
  { name = "B", friction = { air = "0.3 +- 10 %" } },
  { name = "C", friction = { vacuum = 0.2 } },
]
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The document of the small study, from two threads."""
    place = tmp_path_factory.mktemp("small")
    (place / "small.toml").write_text(SMALL)
    options = ["--samples", "64", "--jobs", "2", "--json"]
    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert main(["sensitivity", str(place / "small.toml"), *options]) == 0
    return json.loads(out.getvalue(), parse_constant=pytest.fail)


@pytest.fixture(autouse=True)
def _small(elsewhere):
    """Run in a folder with nothing but the small study."""
    Path("small.toml").write_text(SMALL)


def asked(capsys, *options: str) -> dict:
    """Return the document of the small study."""
    return document(capsys, "sensitivity", "small.toml", "--samples", "64", *options)


def row(document, name):
    """Return the row of a candidate."""
    return next(row for row in document["materials"] if row["name"] == name)


def test_each_friction_has_its_scatter_with_any_number_of_threads(small, capsys):
    """A measured one that of a new cage, a stated one its own; what was not measured is null, with why."""
    missing = row(small, "C")
    assert missing["reason"] == "not measured in air"
    assert missing["friction"] is missing["probability_stable"] is missing["verdict"] is None
    expected = {"A": 0.02 * (1 + 1 / 4) ** 0.5, "B": 0.015}
    for name, deviation in expected.items():
        known = row(small, name)
        assert known["friction_deviation"] == pytest.approx(deviation, rel=0.05)  # of 64 spread draws
        assert known["friction_scatter_assumed"] is False
    sources = {one["name"]: one["source"] for one in small["inputs"]}
    known = {"film.thickness": "study", "ranking.A.air": "measured"}
    assert known.items() <= sources.items()
    # threads change nothing, to the last bit
    assert asked(capsys, "--jobs", "1") == small


def test_certain_inputs_and_frictions_alone_are_answered(capsys):
    """A study without a distribution: the frictions scatter, eta does not."""
    Path("small.toml").write_text(SMALL.replace('thickness = { between = ["0.4 um", "0.6 um"] }', ""))
    found = asked(capsys)
    known = row(found, "A")
    assert known["restitution_factor_low"] == known["restitution_factor_high"]


def test_an_interrupt_keeps_the_cases_that_were_counted(capsys, monkeypatch):
    """Status 130, complete: false; what was left out is null with its reason."""
    counted = uncertain.counted

    def count(drawn, case, runner):
        found = counted(drawn, case, runner)
        if case == ("A",):
            os.kill(os.getpid(), signal.SIGINT)
            wait_until(lambda: runner.stop.is_set)  # the main thread may be late to it
        return found

    monkeypatch.setattr(uncertain, "counted", count)
    found = document(capsys, "sensitivity", "small.toml", "--samples", "64", "--jobs", "1", status=130)
    assert found["complete"] is False
    assert row(found, "A")["probability_stable"] is not None
    assert main(["sensitivity", "small.toml", "--samples", "64", "--jobs", "1", "--quiet"]) == 130
    out, err = capsys.readouterr()
    assert "Interrupted: only what was finished is here." in out
    assert err.endswith("Run the same command to resume.\n")
