"""Mobility of a ball along its orbit: rates, dampings, law of traction."""

from separatrix.chain.mobility.closure import free_ball, held_ball
from separatrix.chain.mobility.record import LinearMobility, Mobility, SlipLaw
from separatrix.chain.mobility.solve import linear_mobility, mobility

__all__ = [
    "LinearMobility",
    "Mobility",
    "SlipLaw",
    "free_ball",
    "held_ball",
    "linear_mobility",
    "mobility",
]
