"""Cage motion in the bearing plane, and the verdict on it (the paper's 2.1; Kannel and Bupara's approach)."""

from separatrix.cage.closed_forms import (
    drift_law,
    impact_restitution,
    linear_critical_friction,
    linear_whirl_frequency,
)
from separatrix.cage.ensemble import Ensemble, settings_for
from separatrix.cage.hard import run_hard_ensemble
from separatrix.cage.history import History, follow, simulate
from separatrix.cage.planar import Cause, PlanarCage, RunOutcome, Verdict
from separatrix.cage.reason import CageMotion
from separatrix.cage.runs import longest_duration, run_ensemble
from separatrix.cage.space.analysis import SpaceAnalysis, analyse
from separatrix.cage.space.ensemble import SpaceEnsemble
from separatrix.cage.space.history import SpaceHistory, simulate_in_space
from separatrix.cage.space_body import SpaceBody
from separatrix.cage.verdict import Judgement, KickCount, judge, wilson_interval

__all__ = [
    "CageMotion",
    "Cause",
    "Ensemble",
    "History",
    "Judgement",
    "KickCount",
    "PlanarCage",
    "RunOutcome",
    "SpaceAnalysis",
    "SpaceBody",
    "SpaceEnsemble",
    "SpaceHistory",
    "Verdict",
    "analyse",
    "drift_law",
    "follow",
    "impact_restitution",
    "judge",
    "linear_critical_friction",
    "linear_whirl_frequency",
    "longest_duration",
    "run_ensemble",
    "run_hard_ensemble",
    "settings_for",
    "simulate",
    "simulate_in_space",
    "wilson_interval",
]
