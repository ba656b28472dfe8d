"""Compile the kernels once, before the tests: else each of their workers would compile the same.

`python tests/kernels.py plane` and, beside it, `python tests/kernels.py space` have about equal work. Kernels
that share functions are compiled by one process, where the shared ones are compiled once.
"""

import contextlib
import os
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "physics"))

from cages import TURNING
from space_cages import ROUND, course
from test_equilibrium import FREE, test_at_rest_both_angles_are_equal

from separatrix import StabilitySettings, run_ensemble, run_hard_ensemble
from separatrix.cli import main

FEW = StabilitySettings(kicks=(0.5,), runs=1, duration=1e-3)


def plane() -> None:
    """Equilibrium and traction, then the cage in the plane."""
    _answer("traction")
    test_at_rest_both_angles_are_equal(FREE)
    for cage in (TURNING, replace(TURNING, gravity=9.81)):
        run_ensemble(cage, FEW)
    run_hard_ensemble(TURNING, FEW)


def space() -> None:
    """The cage in space, then the ball's mobility: by then the other process has the equilibrium."""
    run_ensemble(ROUND, FEW)
    course(ROUND, 1e-3)
    _answer("mobility")


def _answer(verb: str) -> None:
    with open(os.devnull, "w", encoding="utf-8") as nowhere, contextlib.redirect_stdout(nowhere):
        if code := main([verb, "cryogenic-turbopump", "--json", "--quiet"]):
            sys.exit(code)


if __name__ == "__main__":
    {"plane": plane, "space": space}[sys.argv[1]]()
