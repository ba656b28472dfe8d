"""Rolling contact of two layered half-spaces in three dimensions, with partial slip."""

from separatrix.chain.exact.influence import Body, Layer, Solid, solid
from separatrix.chain.exact.rolling import (
    ContactProblem,
    ContactSolution,
    RollingContact,
    creep_of_force,
    gap_contact,
    rigid_slip,
    rolling_contact,
    solve,
    solve_each,
)
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import RaceSlope, traction_slope
from separatrix.chain.film_compliance import Profile, worn_band

__all__ = [
    "Body",
    "ContactProblem",
    "ContactSolution",
    "FrictionLaw",
    "Layer",
    "Profile",
    "RaceSlope",
    "RollingContact",
    "Solid",
    "creep_of_force",
    "gap_contact",
    "rigid_slip",
    "rolling_contact",
    "solid",
    "solve",
    "solve_each",
    "traction_slope",
    "worn_band",
]
