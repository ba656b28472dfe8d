"""The verb `sensitivity`: keys, text, files, threads, interrupts."""

import contextlib
import io
import json
import os
import signal
from pathlib import Path

import pytest
from commands import document, wait_until

from separatrix.front import main
from separatrix.verdict import uncertain_study as uncertain

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

[[ranking.candidates]]
name = "A"
friction = { air = { mean = 0.1, standard_deviation = 0.02, count = 4 }, vacuum = 0.15 }

[[ranking.candidates]]
name = "B"
friction = { air = "0.3 +- 10 %" }

[[ranking.candidates]]
name = "C"
friction = { vacuum = 0.2 }
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


def test_each_friction_has_the_scatter_that_is_known_of_it(small):
    """A measured one that of a new cage, a stated one its own; what was not measured is null with a reason."""
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


def test_threads_change_nothing(small, capsys):
    """To the last bit."""
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
