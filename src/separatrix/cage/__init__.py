"""Cage motion in the bearing plane, and the verdict on it (the paper's 2.1; Kannel and Bupara's approach)."""

from separatrix.cage.ensemble import Ensemble, run_ensemble

from separatrix.cage.history import History, follow, simulate
from separatrix.cage.interval import wilson_interval
from separatrix.cage.kicks import settings_for
from separatrix.cage.linear import (
    drift_law,
    linear_critical_friction,
    linear_roots,
    linear_whirl_frequency,
    turning_critical_friction,
)
from separatrix.cage.orbit import CageMotion
from separatrix.cage.planar import Cause, PlanarCage, RunOutcome, Verdict
from separatrix.cage.verdict import Judgement, KickCount, judge, whirl_probability

__all__ = [
    "CageMotion",
    "Cause",
    "Ensemble",
    "History",
    "Judgement",
    "KickCount",
    "PlanarCage",
    "RunOutcome",
    "Verdict",
    "drift_law",
    "follow",
    "judge",
    "linear_critical_friction",
    "linear_roots",
    "linear_whirl_frequency",
    "run_ensemble",
    "settings_for",
    "simulate",
    "turning_critical_friction",
    "whirl_probability",
    "wilson_interval",
]
