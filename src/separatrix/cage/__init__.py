"""Cage motion in the bearing plane, and the verdict on it (the paper's 2.1; Kannel and Bupara's approach)."""

from separatrix.cage.ensemble import Ensemble, run_ensemble
from separatrix.cage.hard import blow_restitution, run_hard_ensemble
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
from separatrix.cage.planar import PlanarCage, RunOutcome, Verdict
from separatrix.cage.verdict import Judgement, growth_probability, judge

__all__ = [
    "CageMotion",
    "Ensemble",
    "History",
    "Judgement",
    "PlanarCage",
    "RunOutcome",
    "Verdict",
    "blow_restitution",
    "drift_law",
    "follow",
    "growth_probability",
    "judge",
    "linear_critical_friction",
    "linear_roots",
    "linear_whirl_frequency",
    "run_ensemble",
    "run_hard_ensemble",
    "settings_for",
    "simulate",
    "turning_critical_friction",
    "wilson_interval",
]
