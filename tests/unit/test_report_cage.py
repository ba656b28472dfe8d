"""What the text of a simulation shows of the orbit."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from separatrix.chain.solution import solve
from separatrix.present.text.cage import clearance_fact, orbit_facts
from separatrix.study import Guidance
from separatrix.study_file import read_study

CAGE = solve(read_study("cryogenic-turbopump")).cage


def test_the_orbit_of_a_run_is_read_from_the_part_by_which_it_is_judged():
    """Mean and spread of 3 and 5 mm, not of the 1 m before."""
    run = SimpleNamespace(
        time=np.array([0.0, 0.5, 0.79, 0.8, 1.0]),
        position=np.array([[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [3e-3, 0.0], [0.0, -5e-3]]),
        drift_rate=1.97,
        judged_from=0.8,
    )
    lines = dict(orbit_facts(run, CAGE))
    assert lines["Largest offset"] == "1 m"
    assert lines["Mean offset"] == "4 mm, from 800 ms to the end"
    assert lines["Relative spread"] == "0.25 (0: a circle about the axis)"
    assert lines["Drift rate"] == "1.97 1/s"


def test_the_offset_is_compared_with_land_and_pockets():
    """Both clearances as radii; or that of the pockets alone."""
    assert clearance_fact(CAGE) == ("Clearance", "outer land 500 um radial, pockets 300 um each way")
    free = replace(CAGE, guidance=Guidance.BALL, land_clearance=None)
    assert clearance_fact(free)[1] == "pockets 300 um each way; no land"
