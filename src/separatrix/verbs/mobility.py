"""`mobility`: how the races let a ball be pushed along its orbit."""

from __future__ import annotations

from separatrix.chain.ball_mobility import SlipLaw, linear_mobility
from separatrix.chain.solution import solve
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers


def compute(study: Study) -> answers.MobilityAnswer:
    """How the races let a ball be pushed along its orbit."""
    records = (study.bearing, study.operation, study.kinematics.model, study.film, study.traction)
    solution = solve(study)
    found, rigid = solution.mobility, linear_mobility(*records, SlipLaw.RIGID)
    return answers.MobilityAnswer(mobility=found, rigid=rigid, notes=solution.notes)
