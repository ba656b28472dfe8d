"""Cages at the edge of what can be: each command answers, or refuses in one line and writes nothing."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cages import ON_A_LAND
from commands import refused

from separatrix.cage import Cause, RunOutcome, run_ensemble
from separatrix.chain.impact_restitution import damping_for
from separatrix.front import main
from separatrix.ground.document import part_of
from separatrix.present.text import text
from separatrix.study.reading import read_study
from separatrix.study.study import StabilitySettings
from separatrix.verbs import Computed, simulate
from separatrix.verbs.answer_files import document
from separatrix.verdict.judgement import Verdict, judge
from separatrix.verdict.reasons import outcome_sentence

BASE = """
extends = "cryogenic-turbopump"

[kinematics]
model = "outer race control"

[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "4 ms"
"""

CAGE = replace(ON_A_LAND, race_damping=400.0, ball_cage_friction=0.1)
SHORT = StabilitySettings(kicks=(0.5,), runs=4, duration=0.01)

ANSWERED = {
    "land tighter than the pockets": '[cage]\nland_clearance = "20 um"',
    "no pocket clearance": '[cage]\npocket_clearance = "0 mm"',
    "no friction in the pockets": "[cage]\nball_cage_friction = 0",
    "no friction on the land": "[cage]\nland_friction = 0",
    "a land that returns nothing": "[cage]\nland_restitution = 0",
    "a land that returns all": "[cage]\nland_restitution = 1",
    "no land": '[cage]\nguidance = "ball"',
    "three balls": "[bearing]\nball_count = 3",
    "100 balls": '[bearing]\nball_count = 100\nball_diameter = "1.6 mm"\n'
    '[operation]\naxial_load = "300 N"\n[cage]\npocket_clearance = "0.1 mm"',
    "a ramp longer than the run": '[operation]\nramp_time = "50 ms"',
    "a radial load": '[operation]\nradial_load = "500 N"',
    "races that hardly hold the balls": "[film]\nrace_friction = 0.001",
    "races that grip the balls": "[film]\nrace_friction = 2",
}

REFUSED = {  # others: test_study_cage
    "no friction on the races": (
        "[film]\nrace_friction = 0",
        "race_friction must be > 0 for traction [-]; got 0. Without friction the races hold no ball.",
    ),
}

SETTINGS = {
    "run of a week": ('duration = "168 h"', "duration must be <= 10000 s; got"),
    "run of an hour": ('duration = "1 h"', "for this cage; got 3600 s. Shorten the run"),
    "run of no time": ('duration = "1e-12 s"', "duration must be >= 0.001 us; got"),
}


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def study(text: str, base: str = BASE) -> str:
    """Write the small study with some sections more; return its name."""
    Path("case.toml").write_text(base + text, encoding="utf-8")
    return "case.toml"


@pytest.mark.parametrize("case", ANSWERED)
def test_an_odd_cage_is_answered(case, capsys):
    """One document, an outcome with its sentence, and nothing said on standard error."""
    assert main(["simulate", study(ANSWERED[case]), "--json"]) == 0
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert (err, found["outcome"] in RunOutcome.__members__) == ("", True)
    assert found["outcome_sentence"]


@pytest.mark.parametrize("verb", ["simulate", "map"])
@pytest.mark.parametrize("case", REFUSED)
def test_a_cage_that_cannot_be_is_refused_in_one_line(case, verb, capsys):
    """The same line whoever asks."""
    text, said = REFUSED[case]
    assert said in refused(capsys, verb, study(text))


@pytest.mark.parametrize("verb", ["simulate", "stability", "rank", "map"])
@pytest.mark.parametrize("case", SETTINGS)
def test_an_ensemble_that_cannot_be_is_refused_in_one_line(case, verb, capsys):
    """Neither waited for nor begun."""
    text, said = SETTINGS[case]
    lines = [line for line in BASE.splitlines() if not line.startswith(text.partition(" ")[0])]
    few = ["--points", "8"] * (verb == "map")  # 10 000 points, each refused, may take longer than is silent
    assert said in refused(capsys, verb, study(text, "\n".join([*lines, ""])), *few)


@pytest.mark.parametrize(
    "changes",
    [
        {"ball_count": 1},
        {"ball_count": 100, "pocket_clearance": 1e-4},
        {"race_damping": damping_for(0.0, 3e6, 0.025)},
        {"race_damping": math.inf},
        {"ball_cage_friction": 0.0},
        {"land_friction": 0.0},
        {"pocket_clearance": 0.0},
        {"land_clearance": 1e-9},
    ],
)
def test_an_odd_cage_has_a_verdict_and_a_reason(changes):
    """One ball, a hundred, eta 0 and 1, no friction, no play: numbers, and a sentence that says why."""
    cage = replace(CAGE, **changes)
    found = judge(cage, run_ensemble(cage, SHORT))
    assert found.verdict in Verdict
    assert found.reason.endswith(".")
    assert np.isfinite(found.growth_rate)


def test_an_unresolved_run_says_so():
    """Table and document give the outcome and its sentence, and the time up to which it was followed."""
    asked = read_study(study(""))
    answer = simulate.compute(asked, simulate.Options())
    lost = replace(answer.history, outcome=RunOutcome.UNRESOLVED, cause=Cause.FALLING)
    sentence = outcome_sentence(lost, limit=None, rubbing_power=0.0)
    answer = replace(answer, history=lost, outcome_sentence=sentence)
    made = Computed(record=answer, study=asked, options=simulate.Options(), is_complete=True)
    found = document(simulate.VERB, made)
    said = " ".join(text(simulate.page(part_of(found))).split())
    assert (found["outcome"], found["cause"]) == ("UNRESOLVED", "FALLING")
    assert "UNRESOLVED" in said
    assert "The run does not show where the motion ends." in said
