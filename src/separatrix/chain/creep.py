"""Creep across the contact ellipse: spin, rolling (Heathcote), uniform part (paper, Eqs 3-5, 14 and 16)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from separatrix.chain.hertz import ContactEllipse, race_curvatures
from separatrix.ground.units import Array, Metre, PerMetre, PerMetre2, Radian, Ratio, SquareMetre
from separatrix.study.study import BallBearing, Race


@dataclass(frozen=True, slots=True, kw_only=True)
class Creep:
    """The part of the creep that the kinematics fix: spin s [1/m] and Heathcote's curvature q [1/m2]."""

    spin: PerMetre  # s, creep that grows with y; Kalker's spin is -s
    curvature: PerMetre2  # q, creep that grows with the square of y

    def ratio(self, across: Array, offset: Ratio = 0.0) -> Array:
        """Creep ratio xi = offset + s y + q y^2 at the places `across` [m] from the centre line [-]."""
        y = across
        return offset + self.spin * y + self.curvature * y**2


def contact_creep(bearing: BallBearing, race: Race, contact_angle: Radian, spin_roll_ratio: Ratio) -> Creep:
    """Creep that the ball's kinematics make in one contact.

    The contact angle is that under load at this race, the ratio the pivoting to the rolling speed of ball
    relative to race, signed (paper, Eq. 16). Spin s = (spin/roll ratio)/R_x, curvature q = -1/(2 R_d R_x) at
    the inner race, + at the outer.

    Notes
    -----
    xi = (V_ball - V_race)/V_roul (paper, Eq. 3). 1/R_x is the gap curvature along rolling, R_d = 2 f D/(2 f
    + 1) the radius of the pressed surface across the groove (docs/theory/creep.md).
    """
    D = bearing.ball_diameter
    per_rx = race_curvatures(bearing, race, contact_angle)[0]
    sign, f = (-1.0, bearing.inner_conformity) if race is Race.INNER else (1.0, bearing.outer_conformity)
    return Creep(spin=spin_roll_ratio * per_rx, curvature=sign * per_rx / (2.0 * deformed_radius(D, f)))


def deformed_radius(ball_diameter: Metre, conformity: Ratio) -> Metre:
    """Radius R_d = 2 f D/(2 f + 1) across the groove of the surface pressed between ball and race [m]."""
    D, f = ball_diameter, conformity
    return 2.0 * f * D / (2.0 * f + 1.0)


def track_area(
    bearing: BallBearing, ellipse: ContactEllipse, contact_angle: Radian, side: Ratio
) -> SquareMetre:
    """Area of the track that a contact leaves on its race; side -1 of the inner, 1 of the outer race."""
    radius = 0.5 * (bearing.pitch_diameter + side * bearing.ball_diameter * math.cos(contact_angle))
    return 4.0 * math.pi * ellipse.semi_major * radius
