"""Quasi-static equilibrium: loads, angles, spin and orbit of every ball (paper, 2.2, and its ref. 3)."""

from separatrix.chain.equilibrium.ball_set import Equilibrium, contact
from separatrix.chain.equilibrium.solve import equilibrium

__all__ = ["Equilibrium", "contact", "equilibrium"]
