"""Predicts whether the cage of a dry-lubricated ball bearing runs stably, and ranks candidate materials.

The names below are the public interface; each is imported when it is first used, so that
``import separatrix`` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import Any

_PUBLIC = {
    "cage": "Ensemble History Judgement PlanarCage RunOutcome Verdict judge linear_critical_friction "
    "CageMotion linear_whirl_frequency run_ensemble run_hard_ensemble simulate wilson_interval",
    "chain": "BearingState RaceContact RaceTraction Solution solve",
    "creep": "Creep contact_creep",
    "equilibrium": "Equilibrium contact",
    "errors": "ConvergenceError DataError InputError SeparatrixError ValidityWarning",
    "explore.sweep": "Sweep SweptCase sweep",
    "hertz": "ContactEllipse contact_ellipse contact_modulus race_curvatures",
    "ledger": "Ledger",
    "runner": "Interrupted Runner",
    "lubrication": "LubricationCurve lubrication_curve",
    "ranking": "Ranking rank",
    "restitution": "Restitution damping_ratio race_damping restitution_factor",
    "present": "dataset document load report save to_dataframe to_xarray",
    "stability": "StabilityCurve critical_friction restitution_threshold stability_curve",
    "study": "BallBearing CageDesign Candidate Film Friction Guidance KinematicModel Material Operation "
    "PocketContact PocketShape Race RankingQuestion StabilitySettings Study",
    "study_file": "read_study resolved shipped_studies template",
    "traction": "ShearField TractionCurve film_compliance shear_field traction_curve traction_slope",
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
