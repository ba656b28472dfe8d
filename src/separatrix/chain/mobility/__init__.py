"""Mobility of a ball along its orbit: rates, dampings, law of traction, restitution of impacts."""

from separatrix.chain.mobility.closure import free_ball, held_ball
from separatrix.chain.mobility.record import Impacts, LinearMobility, Mobility, SlipLaw
from separatrix.chain.mobility.solve import impacts, linear_mobility, mobility

__all__ = [
    "Impacts",
    "LinearMobility",
    "Mobility",
    "SlipLaw",
    "free_ball",
    "held_ball",
    "impacts",
    "linear_mobility",
    "mobility",
]
