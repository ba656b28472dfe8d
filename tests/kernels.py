"""Compile, once before the tests, the kernels that most of them use: of the `chain`, or of the `cage`."""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

import separatrix
from separatrix.cage import MovingCage, moving_cage, run_ensemble
from separatrix.chain.ball_traction import BallTraction
from separatrix.study.study import (
    BallModel,
    MotionModel,
    StabilitySettings,
    TractionModel,
    TractionSettings,
)

MOMENT = StabilitySettings(kicks=(0.1,), runs=1, duration=1e-3)


def chain() -> None:
    """A bearing from its loads to the mobility of its balls, exact contacts, and a cage among such balls."""
    study = separatrix.read_study("cryogenic-turbopump")
    solution = separatrix.solve(study)
    _ = solution.restitution, solution.mobility, solution.orbit_by_diameter
    exact = TractionSettings(model=TractionModel.EXACT)
    _ = separatrix.solve(replace(study, traction=exact)).traction
    run_ensemble(moving_cage(solution, 0.05, BallModel.FREE), MOMENT)


def cage() -> None:
    """A cage among balls of two levels, in plane and space, and in the double precision of `follow`."""
    sys.path.append(str(Path(__file__).parent / "physics"))
    from cages import TURNING, follow

    space = {"motion": MotionModel.SPACE, "groove_damping": 766.0, "groove_stiffness": 5e6}
    law = BallTraction(mass=6.5e-3, slope=207.0, speed=0.435)
    plane: tuple[MovingCage, ...] = (TURNING, replace(TURNING, traction=law))
    lead = np.zeros(TURNING.ball_count)
    for one in (*plane, *(replace(each, **space) for each in plane)):
        run_ensemble(one, MOMENT)
        follow(one, kick=0.1, direction=0.0, ball_lead=lead, duration=1e-3, until=1e-3)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    {"chain": chain, "cage": cage}[sys.argv[1]]()
