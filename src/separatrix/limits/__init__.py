"""When a cage is stable: critical pocket friction against restitution factor, and its inverse."""

from separatrix.limits.curve import StabilityCurve, restitution_threshold, stability_curve
from separatrix.limits.point import critical_friction

__all__ = ["StabilityCurve", "critical_friction", "restitution_threshold", "stability_curve"]
