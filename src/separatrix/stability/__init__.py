"""When a cage is stable: critical pocket friction against restitution factor, and its inverse."""

from separatrix.stability.crossing import Side
from separatrix.stability.curve import (
    SEARCHED_FRICTION,
    CriticalFriction,
    LinearLimit,
    StabilityCurve,
    critical_friction,
    curve_of_points,
    linear_limit,
    stability_curve,
)
from separatrix.stability.growth import Count, GrowthCounter, cage_at, race_damping_at
from separatrix.stability.threshold import (
    RestitutionThreshold,
    restitution_threshold,
    threshold_factors,
    threshold_points,
)

__all__ = [
    "SEARCHED_FRICTION",
    "Count",
    "CriticalFriction",
    "GrowthCounter",
    "LinearLimit",
    "RestitutionThreshold",
    "Side",
    "StabilityCurve",
    "cage_at",
    "critical_friction",
    "curve_of_points",
    "linear_limit",
    "race_damping_at",
    "restitution_threshold",
    "stability_curve",
    "threshold_factors",
    "threshold_points",
]
