"""What the text of a simulation compares the offset with."""

from dataclasses import replace

from separatrix.cage import moving_cage
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study
from separatrix.study.study import Guidance
from separatrix.told.cage import clearance_fact


def test_the_offset_is_compared_with_land_and_pockets():
    """Both clearances as radii; or that of the pockets alone."""
    cage = moving_cage(solve(read_study("cryogenic-turbopump")), 0.1)
    assert clearance_fact(cage) == ("Clearance", "outer land 500 um radial, pockets 300 um each way")
    free = replace(cage, guidance=Guidance.BALL, land_clearance=None)
    assert clearance_fact(free)[1] == "pockets 300 um each way; no land"
