r"""Linear limit: a cage that fills its pockets, whose whirl the pocket friction drives.

Without play every ball stays in touch, and with :math:`z = x + iy`, :math:`\omega_0^2 = Zk/2M` and
:math:`\kappa = k/C_\mu` the translation obeys
:math:`(\lambda + i\Omega)^2 (\lambda + \kappa) + (1 - i\sigma f)\,\omega_0^2 \lambda = 0`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from separatrix.units import Hertz, Ratio

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage


def linear_whirl_frequency(cage: PlanarCage) -> Hertz:
    r"""Whirl without play at the stability limit, :math:`\sqrt{Zk/2M}/2\pi`, ball set at rest [Hz]."""
    return whirl_rate(cage) / (2.0 * math.pi)


def whirl_rate(cage: PlanarCage) -> float:
    r""":math:`\omega_0 = \sqrt{Zk/2M}` [rad/s]."""
    return math.sqrt(cage.ball_count * cage.ball_cage_stiffness / (2.0 * cage.mass))


def linear_critical_friction(cage: PlanarCage) -> Ratio:
    r"""Friction above which a cage without play whirls, :math:`\sqrt{2kM/Z}/C_\mu`, ball set at rest [-]."""
    return math.sqrt(2.0 * cage.ball_cage_stiffness * cage.mass / cage.ball_count) / cage.race_damping


def turning_critical_friction(cage: PlanarCage) -> Ratio:
    r"""The same with the ball set turning: :math:`f_c/(1 - \sigma\Omega/\omega_0)`, exact [-].

    The root :math:`\lambda = i\omega` of the polynomial above has :math:`\omega = \sigma\omega_0 - \Omega`,
    whence :math:`f = \kappa/|\omega|`: about :math:`1 + \Omega/\omega_0` times the limit at rest for forward
    whirl. Infinite where the ball set turns faster than the whirl, or where the balls do not spin (sigma =
    0).
    """
    apparent = whirl_rate(cage) - cage.friction_sense * cage.cage_speed
    if apparent <= 0.0 or cage.friction_sense == 0:
        return math.inf
    return cage.ball_cage_stiffness / (cage.race_damping * apparent)


def drift_law(cage: PlanarCage) -> float:
    r"""Growth rate of a landless cage's offset in the turning frame, :math:`2M\Omega^2/(ZC_\mu)` [1/s].

    The slow root of the polynomial, for :math:`\Omega \ll \omega_0` and a small friction.
    """
    return 2.0 * cage.mass * cage.cage_speed**2 / (cage.ball_count * cage.race_damping)


def linear_roots(cage: PlanarCage) -> NDArray[np.complex128]:
    """Exact rates of the translation without play, fastest growing first, shape (3,) [rad/s].

    The real part is the growth, the imaginary part the whirl in the turning frame, positive in the positive
    sense.
    """
    W, w0 = cage.cage_speed, whirl_rate(cage)
    kappa = cage.ball_cage_stiffness / cage.race_damping
    drive = (1.0 - 1j * cage.friction_sense * cage.ball_cage_friction) * w0 * w0
    scale = w0
    iw = 1j * W / scale
    square = np.array([1.0, 2.0 * iw, iw * iw])
    cubic = np.polymul(square, np.array([1.0, kappa / scale]))
    cubic = np.polyadd(cubic, np.array([drive / scale**2, 0.0]))
    roots = np.roots(cubic) * scale
    return np.asarray(roots[np.argsort(-roots.real)], dtype=np.complex128)
