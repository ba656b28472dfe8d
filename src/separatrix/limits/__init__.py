"""When a cage is stable: critical pocket friction against restitution factor, and its inverse."""

from separatrix.limits.curve import StabilityCurve, Tracer, curve_of_points, stability_curve
from separatrix.limits.growth import Count, GrowthCounter, cage_at, race_damping_at
from separatrix.limits.limits import HardLimit, LinearLimit, closed_hard_limit, hard_limit, linear_limit
from separatrix.limits.point import CriticalFriction, critical_friction
from separatrix.limits.response import SEARCHED_FRICTION, Crossing, Response, Side
from separatrix.limits.threshold import (
    RestitutionThreshold,
    own_threshold,
    restitution_threshold,
    threshold_factors,
    threshold_points,
)

__all__ = [
    "SEARCHED_FRICTION",
    "Count",
    "CriticalFriction",
    "Crossing",
    "GrowthCounter",
    "HardLimit",
    "LinearLimit",
    "Response",
    "RestitutionThreshold",
    "Side",
    "StabilityCurve",
    "Tracer",
    "cage_at",
    "closed_hard_limit",
    "critical_friction",
    "curve_of_points",
    "hard_limit",
    "linear_limit",
    "own_threshold",
    "race_damping_at",
    "restitution_threshold",
    "stability_curve",
    "threshold_factors",
    "threshold_points",
]
