r"""A law for F(u) with the exact slope at rest: :math:`C u/(1 + (u/v)^4)^{1/4}`.

The slip fields of bearings have a sharper knee than :math:`C u/\sqrt{1 + (u/v)^2}`: with the power 2 the
largest difference is 8 to 9 % of the capacity, with 4 it is 1 to 2 %, with 6 it is 4 % again.
"""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.ball_traction import BallTraction
from separatrix.ground.units import Array, Kilogram, NewtonSecondPerMetre


def fitted_law(speed: Array, force: Array, *, slope: NewtonSecondPerMetre, mass: Kilogram) -> BallTraction:
    """Law with the exact slope at rest, nearest to F(u) in its largest difference.

    Where F falls again at large speeds, the law stays at the largest force before.
    """
    from scipy.optimize import minimize_scalar  # dear to import

    target = np.maximum.accumulate(force)
    knee = float(target.max()) / slope

    def law(log_speed: float) -> BallTraction:
        own = math.exp(log_speed)
        return BallTraction(mass=mass, slope=float(slope), speed=own)

    def error(log_speed: float) -> float:
        return float(np.abs(law(log_speed).force(speed) - target).max())

    bounds = math.log(0.1 * knee), math.log(10.0 * knee)
    return law(float(minimize_scalar(error, bounds=bounds, method="bounded", options={"xatol": 1e-9}).x))
