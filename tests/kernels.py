"""Compile, once before the tests, the kernels that most of them use: the longest job first, one a core."""

import sys
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

import separatrix
from separatrix import BallTraction, MovingCage, moving_cage, run_ensemble
from separatrix.study.study import BallModel, MotionModel, StabilitySettings

sys.path.append(str(Path(__file__).parent / "physics"))
from cages import TURNING, follow
from exact_cases import contact, kalker

MOMENT = StabilitySettings(kicks=(0.1,), runs=1, duration=1e-3)


def bearing() -> None:
    """A bearing from its loads to the mobility of its balls, and a cage among such balls."""
    solution = separatrix.solve(separatrix.read_study("cryogenic-turbopump"))
    _ = solution.restitution, solution.mobility, solution.orbit_by_diameter
    run_ensemble(moving_cage(solution, 0.05, BallModel.FREE), MOMENT)


def exact() -> None:
    """An exact contact with a film."""
    kalker(contact(0.5, columns=8, rows=8, film_compliance=0.1), xi=1e-4)


def cage(one: MovingCage) -> None:
    """A cage, and in the double precision of `follow`."""
    run_ensemble(one, MOMENT)
    lead = np.zeros(one.ball_count)
    follow(one, kick=0.1, direction=0.0, ball_lead=lead, duration=1e-3, until=1e-3)


SPACE = replace(TURNING, motion=MotionModel.SPACE, groove_damping=766.0, groove_stiffness=5e6)
LAW = BallTraction(mass=6.5e-3, slope=207.0, speed=0.435)
CAGES = [replace(one, traction=law) for one in (SPACE, TURNING) for law in (None, LAW)]
JOBS = [bearing, exact, *(partial(cage, one) for one in CAGES)]

if __name__ == "__main__":
    with ProcessPoolExecutor(initializer=warnings.simplefilter, initargs=("ignore",)) as pool:
        for done in [pool.submit(job) for job in JOBS]:
            done.result()
