"""Rolling contact of two layered half-spaces in three dimensions, with partial slip."""

from separatrix.chain.exact.influence import Body, Layer, Solid, solid
from separatrix.chain.exact.rolling import (
    ContactProblem,
    ContactSolution,
    RollingContact,
    gap_contact,
    rigid_slip,
    rolling_contact,
    solve,
    solve_each,
)
from separatrix.chain.exact.slip import FrictionLaw
from separatrix.chain.exact.slope import RaceSlope, traction_slope
from separatrix.chain.exact.transient import shift, transient
from separatrix.chain.exact.two_way import solve_two_way
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
    "gap_contact",
    "rigid_slip",
    "rolling_contact",
    "shift",
    "solid",
    "solve",
    "solve_each",
    "solve_two_way",
    "traction_slope",
    "transient",
    "worn_band",
]
