"""Predicts whether the cage of a dry-lubricated ball bearing runs stably, and ranks candidate materials.

The names below are the public interface; each is imported when it is first used, so that
``import separatrix`` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import Any

_PUBLIC = {
    "front.api": "Answer ToolAnswer bearing check compare life load map material materials mobility rank "
    "report restitution sensitivity simulate stability sweep traction tribometer",
    "cage": "Cause CourseAnalysis Ensemble History MovingCage RunOutcome analyse linear_critical_friction "
    "linear_whirl_frequency moving_cage run_ensemble",
    "chain.contacts": "BearingState RaceContact RaceTraction",
    "chain.equilibrium": "Equilibrium contact",
    "chain.hertz": "ContactEllipse Creep contact_creep contact_ellipse contact_modulus ellipse_of_axes "
    "ellipse_of_curvatures race_curvatures",
    "chain.race_traction": "BallTraction",
    "chain.ball_mobility": "LinearMobility Mobility SlipLaw",
    "chain.impact_restitution": "LubricationCurve Restitution ball_pocket_stiffness damping_ratio "
    "lubrication_curve restitution_factor",
    "chain.solution": "Solution solve",
    "chain.exact.influence": "Body Layer Solid solid",
    "chain.exact.rolling": "ContactProblem ContactSolution RollingContact creep_of_force gap_contact "
    "rigid_slip rolling_contact solve_each",
    "chain.exact.slip": "FrictionLaw",
    "chain.film_compliance": "Profile film_compliance worn_band",
    "chain.traction_curve": "ShearField TractionCurve shear_field traction_curve traction_slope",
    "ground.errors": "ConvergenceError DataError InputError SeparatrixError",
    "verdict.swept_cases": "Sweep SweptCase",
    "friction.logs": "read_log",
    "friction.reduction": "reduce_log",
    "friction.log_series": "ReducedLogs",
    "verdict.wear_life": "Life LifeTable",
    "verbs.report": "Report",
    "verdict.long_jobs": "Interrupted Ledger Runner",
    "verdict.ranking_records": "Ranking",
    "present.dataset": "dataset",
    "verbs.answer_files": "document",
    "verdict.stability_curve": "StabilityCurve critical_friction restitution_threshold stability_curve",
    "study.study": "Arrangement BallBearing BallModel CageDesign Candidate ContactPressure Film Friction "
    "Guidance KinematicModel Kinematics Material MotionModel Operation PocketContact PocketShape PreloadKind "
    "PressureSlip Race RankingQuestion StabilitySettings Study TractionModel TractionSettings Wear Worn "
    "shipped_studies",
    "verdict.judgement": "Judgement Verdict judge wilson_interval",
    "verdict.reasons": "CageMotion",
    "study.reading": "read_study",
    "study.sources": "resolved",
    "study.template": "template",
}
"""Module -> the public names it holds."""

_HOME = {name: module for module, names in _PUBLIC.items() for name in names.split()}

__all__ = sorted([*_HOME, "__version__"])


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used."""
    if name == "__version__":
        from importlib.metadata import version

        return version("separatrix")
    if name not in _HOME:
        raise AttributeError(f"module 'separatrix' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"separatrix.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return list(__all__)
