"""From a study to its cage: equilibrium, contacts, traction, restitution, pocket, cage."""

from separatrix.chain.contacts import BearingState, RaceContact, RaceTraction
from separatrix.chain.solution import Solution, solve

__all__ = ["BearingState", "RaceContact", "RaceTraction", "Solution", "solve"]
