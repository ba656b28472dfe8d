"""Cages at the edge of what can be: each command answers, or refuses in one line and writes nothing."""

import json
from pathlib import Path

import pytest
from commands import refused

from separatrix.cage import RunOutcome
from separatrix.front import main

BASE = """
extends = "cryogenic-turbopump"

[kinematics]
model = "outer race control"

[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "4 ms"
"""

ANSWERED = {
    "land tighter than the pockets": '[cage]\nland_clearance = "20 um"',
    "a land that returns nothing": "[cage]\nland_restitution = 0",
    "a land that returns all": "[cage]\nland_restitution = 1",
    "no land": '[cage]\nguidance = "ball"',
    "three balls": "[bearing]\nball_count = 3",
    "a ramp longer than the run": '[operation]\nramp_time = "50 ms"',
    "races that hardly hold the balls": "[film]\nrace_friction = 0.001",
    "races that grip the balls": "[film]\nrace_friction = 2",
}

SETTINGS = {
    "run of a week": ('duration = "168 h"', "duration must be <= 10000 s; got"),
    "run of an hour": ('duration = "1 h"', "for this cage; got 3600 s. Shorten the run"),
    "run of no time": ('duration = "1e-12 s"', "duration must be >= 0.001 us; got"),
}


pytestmark = pytest.mark.usefixtures("elsewhere")


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


@pytest.mark.parametrize("verb", ["simulate", "stability", "rank", "map"])
@pytest.mark.parametrize("case", SETTINGS)
def test_an_ensemble_that_cannot_be_is_refused_in_one_line(case, verb, capsys):
    """Neither waited for nor begun."""
    text, said = SETTINGS[case]
    lines = [line for line in BASE.splitlines() if not line.startswith(text.partition(" ")[0])]
    few = ["--points", "8"] * (verb == "map")  # 10 000 points, each refused, may take longer than is silent
    assert said in refused(capsys, verb, study(text, "\n".join([*lines, ""])), *few)
