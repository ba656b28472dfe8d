"""Traction of a rolling ball/race contact: strips with film and friction, whole curve, slope at the origin."""

from separatrix.traction.curve import TractionCurve, film_compliance, traction_curve, traction_slope

__all__ = ["TractionCurve", "film_compliance", "traction_curve", "traction_slope"]
