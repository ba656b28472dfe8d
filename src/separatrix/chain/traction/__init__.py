"""Traction of a rolling ball/race contact: strips with film and friction; curve and slope at the origin."""

from separatrix.chain.traction.curve import TractionCurve, traction_curve, traction_slope
from separatrix.chain.traction.film import Track, film_compliance, track_of
from separatrix.chain.traction.profile import Profile, worn_band
from separatrix.chain.traction.shear import ShearField, shear_field
from separatrix.chain.traction.strip import StripSolution, solve_strip

__all__ = [
    "Profile",
    "ShearField",
    "StripSolution",
    "Track",
    "TractionCurve",
    "film_compliance",
    "shear_field",
    "solve_strip",
    "track_of",
    "traction_curve",
    "traction_slope",
    "worn_band",
]
