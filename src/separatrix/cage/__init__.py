"""The motion of the cage among its balls, from the forces to the evidence of an ensemble."""

from separatrix.cage.closed_forms import linear_critical_friction, linear_whirl_frequency
from separatrix.cage.course import CourseAnalysis, History, analyse, simulate
from separatrix.cage.disturbance import settings_for
from separatrix.cage.ensemble import Ensemble, Stop, longest_duration, run_ensemble
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.outcome import Cause, RunOutcome

__all__ = [
    "Cause",
    "CourseAnalysis",
    "Ensemble",
    "History",
    "MovingCage",
    "RunOutcome",
    "Stop",
    "analyse",
    "linear_critical_friction",
    "linear_whirl_frequency",
    "longest_duration",
    "moving_cage",
    "run_ensemble",
    "settings_for",
    "simulate",
]
