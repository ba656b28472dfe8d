"""Compile, once before the tests, the kernels that most of them use: of `plane` or of `space`."""

import sys
import warnings
from dataclasses import replace

import separatrix
from separatrix.cage import moving_cage, run_ensemble
from separatrix.study import BallModel, MotionModel, StabilitySettings


def main(where: str) -> None:
    """Run one cage among each ball that the tests use there, for a moment."""
    warnings.simplefilter("ignore")
    study = separatrix.read_study("cryogenic-turbopump")
    balls = {"plane": [BallModel.DAMPER, BallModel.TRACTION], "space": [BallModel.TRACTION, BallModel.DAMPER]}
    solution = separatrix.solve(replace(study, cage=replace(study.cage, motion=MotionModel(where))))
    for ball in balls[where]:
        run_ensemble(moving_cage(solution, 0.05, ball), StabilitySettings(kicks=(0.1,), runs=1))


if __name__ == "__main__":
    main(sys.argv[1])
