"""One ball in its two grooves: contact angles and normal loads from where the groove centres lie.

In the plane of a ball, (x, r) are the axial and outward components. V leads from the outer groove's centre of
curvature to the ball centre, A to the inner groove's; A - V leads from the ball to the inner groove's centre.

A groove is half a circle that goes on as two straight walls: no ball meets the missing half of the circle,
and the room of a ball stays convex. Contact angles so steep are refused once a bearing is solved.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from separatrix.chain.equilibrium.problem import Problem
from separatrix.chain.hertz import approach_coefficient
from separatrix.compiled import kernel


class Touch(NamedTuple):
    """One contact: angle as sine and cosine, load, its slopes, and the ellipse per load^(1/3)."""

    sine: float
    cosine: float
    length: float  # from ball centre to groove centre; infinite at a straight wall, where no angle changes
    load: float
    load_slope: float  # dQ/d(length)
    major_coefficient: float  # a = major_coefficient Q^(1/3)
    axis_ratio: float  # b/a


@kernel
def touch(p: Problem, side: float, axial: float, radial: float, guess: float) -> Touch:
    """Contact of a ball whose centre lies (axial, radial) from the groove's; side -1 inner, +1 outer."""
    D = p.ball_diameter
    f = p.inner_conformity if side < 0.0 else p.outer_conformity
    at_wall = radial < 0.0
    radial = max(radial, 0.0)
    length = math.hypot(axial, radial)
    approach = length - (f - 0.5) * D
    # Without contact the angle is only nominal: turn it towards the radial direction as the gap opens.
    nominal_radial = radial - 2.0 * min(approach, 0.0)
    nominal = math.hypot(axial, nominal_radial)
    s, c = axial / nominal, nominal_radial / nominal
    rolling = 2.0 / (D * (1.0 + side * D * c / p.pitch_diameter))
    kappa, major, k = approach_coefficient(rolling, (2.0 - 1.0 / f) / D, p.modulus, guess)
    root = math.sqrt(max(approach, 0.0))
    length = math.inf if at_wall else length
    return Touch(s, c, length, kappa * root * max(approach, 0.0), 1.5 * kappa * root, major, k)


@kernel
def static_split(p: Problem, axial: float, radial: float) -> tuple[float, float, float]:
    """Ball centre V and load where both contacts lie on one line (no inertia); A = (axial, radial)."""
    D, below = p.ball_diameter, 0.5 * min(radial, 0.0)  # between straight walls any height balances
    radial = max(radial, 0.0)
    length = math.hypot(axial, radial)
    s, c = (axial / length, radial / length) if length > 0.0 else (0.0, 1.0)
    approach = length - (p.inner_conformity + p.outer_conformity - 1.0) * D
    share = approach
    if approach > 0.0:
        gamma = D * c / p.pitch_diameter
        curved_i, curved_o = (2.0 - 1.0 / p.inner_conformity) / D, (2.0 - 1.0 / p.outer_conformity) / D
        k_i = approach_coefficient(2.0 / (D * (1.0 - gamma)), curved_i, p.modulus, 0.0)[0]
        k_o = approach_coefficient(2.0 / (D * (1.0 + gamma)), curved_o, p.modulus, 0.0)[0]
        soft_i, soft_o = k_i ** (-2.0 / 3.0), k_o ** (-2.0 / 3.0)
        share = approach * soft_o / (soft_i + soft_o)
        load = (approach / (soft_i + soft_o)) ** 1.5
    else:
        load = 0.0
    reach = (p.outer_conformity - 0.5) * D + share
    return reach * s, reach * c + below, load
