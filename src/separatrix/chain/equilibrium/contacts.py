"""The Hertz contacts of a solved bearing."""

from __future__ import annotations

from separatrix.chain.equilibrium.record import Equilibrium
from separatrix.chain.hertz import ContactEllipse, contact_ellipse, contact_modulus, race_curvatures
from separatrix.study import BallBearing, Race


def contact(result: Equilibrium, bearing: BallBearing, race: Race, ball: int) -> ContactEllipse:
    """Ellipse of one ball on one race, curvatures at its operating angle; no size where it is unloaded."""
    inner = race is Race.INNER
    load = (result.load_inner if inner else result.load_outer)[ball]
    angle = (result.contact_angle_inner if inner else result.contact_angle_outer)[ball]
    rolling, transverse = race_curvatures(bearing, race, float(angle))
    modulus = contact_modulus(bearing.ball_material, bearing.ring_material)
    return contact_ellipse(float(load), rolling, transverse, modulus)
