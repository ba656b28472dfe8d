r"""What a cage has in closed form: the linear limit, one impact, and what frame and loads give it.

Without clearance every ball stays in touch, and with :math:`z = x + iy`, :math:`\omega_0^2 = Zk/2M` and
:math:`\kappa = k/C_\mu` the translation obeys
:math:`(\lambda + i\Omega)^2 (\lambda + \kappa) + (1 - i\sigma f)\,\omega_0^2 \lambda = 0`:
pocket friction drives the whirl.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from separatrix.ground.units import (
    Array,
    Hertz,
    Joule,
    Kilogram,
    Metre,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    PerSecond,
    Ratio,
    Second,
)
from separatrix.study.cage_design import PocketShape, end_half_play

if TYPE_CHECKING:
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.chain.race_traction import BallTraction

LOWEST_RESTITUTION = 1e-4
REAL = 1e-9
"""Imaginary over whole of a root that counts as real."""

MOST_FRICTION: Ratio = 100.0
"""Above it no friction is searched."""


def linear_whirl_frequency(cage: MovingCage) -> Hertz:
    r"""Whirl without clearance at the stability limit, :math:`\sqrt{Zk/2M}/2\pi`, ball set at rest [Hz]."""
    return whirl_rate(cage) / (2.0 * math.pi)


def whirl_rate(cage: MovingCage) -> float:
    r""":math:`\omega_0 = \sqrt{Zk/2M}` [rad/s]."""
    return math.sqrt(cage.ball_count * cage.ball_cage_stiffness / (2.0 * moving_mass(cage)))


def linear_critical_friction(cage: MovingCage) -> Ratio:
    r"""Friction above which it whirls without clearance, ball set at rest: `damped_critical_friction` [-].

    With balls of inertia that of small motions, from the roots of their polynomial.
    """
    if cage.traction is None:
        return damped_critical_friction(cage, cage.race_damping)
    return (_wrapped_critical_friction if cage.is_wrapped else _inertial_critical_friction)(
        cage, cage.traction
    )


def damped_critical_friction(cage: MovingCage, damping: NewtonSecondPerMetre) -> Ratio:
    r"""The same among dampers: :math:`\kappa/\omega_0 = \sqrt{2kM/Z}/C`, and of spherical pockets less [-].

    These hold the cage along the radius too, without damping. From
    :math:`\lambda^2(\lambda + \kappa) + (1 - i\sigma f)\,\omega_0^2(2\lambda + \kappa + i\sigma f\kappa) = 0`
    it whirls at :math:`\sqrt2\,\omega_0` and
    :math:`f = \kappa/(\sqrt2\,\omega_0 + \sqrt{2\omega_0^2 + \kappa^2})`.
    """
    stiff = 2.0 * cage.ball_cage_stiffness * moving_mass(cage) / cage.ball_count
    over_rate = math.sqrt(stiff) / damping  # kappa / omega_0
    return (
        over_rate / (math.sqrt(2.0) + math.hypot(math.sqrt(2.0), over_rate)) if cage.is_wrapped else over_rate
    )


def _inertial_critical_friction(cage: MovingCage, law: BallTraction) -> Ratio:
    r"""Friction at which a whirl of small motions lasts among balls of inertia, ball set at rest.

    With :math:`\lambda = i\omega`, :math:`G = m_e^2\omega^2 + C^2`: the real part of the polynomial is
    :math:`\omega^2 (G - k m_e) = \omega_0^2 G`, and :math:`f = kC/\omega (G - k m_e)`.
    """
    k, C, m, w0 = cage.ball_cage_stiffness, law.slope, law.mass, whirl_rate(cage)
    # in units of omega_0
    mass, inert, held = (m * w0) ** 2, C * C, C * C - k * m
    rates = np.roots([mass, 0.0, held - mass, 0.0, -inert])
    real = rates[np.abs(rates.imag) < REAL * np.abs(rates)].real
    frictions = k * C / (w0 * real * (mass * real**2 + held))
    return float(min((f for f in frictions if f > 0.0), default=math.inf))


def _wrapped_critical_friction(cage: MovingCage, law: BallTraction) -> Ratio:
    r"""The same in spherical pockets: where the first root of their polynomial begins to grow.

    :math:`\lambda^2(\lambda D + k) + (1 - if)\,\omega_0^2(2\lambda D + (1 + if)k) = 0`,
    :math:`D = m_e\lambda + C`.
    """
    from scipy.optimize import brentq

    k, w0 = cage.ball_cage_stiffness, whirl_rate(cage)
    yields = np.array([law.mass * w0**2, law.slope * w0, 0.0])  # in units of omega_0

    def growth(friction: Ratio) -> float:
        held = np.append(yields[:2], [k, 0.0, 0.0])
        driven = (1.0 - 1j * friction) * (2.0 * yields + np.array([0.0, 0.0, (1.0 + 1j * friction) * k]))
        return float(np.roots(np.polyadd(held, driven)).real.max())

    high = damped_critical_friction(cage, law.slope)
    while growth(high) <= 0.0 and high < MOST_FRICTION:
        high *= 2.0
    return float(brentq(growth, 0.0, high, xtol=1e-12)) if growth(high) > 0.0 else math.inf


def room(cage: MovingCage) -> Metre:
    """Offset that the cage centre has: to its land, or half its pocket clearance without a land [m]."""
    return cage.half_play if math.isinf(cage.land_gap) else cage.land_gap


def moving_mass(cage: MovingCage) -> Kilogram:
    """Mass that moves across the axis: of the cage and of the fluid that moves with it [kg]."""
    return cage.mass + cage.added_mass


def centrifugal_stiffness(cage: MovingCage) -> NewtonPerMetre:
    r"""Pull away from the axis over the offset, :math:`m\Omega^2 + m_a(\Omega - W)^2` in a fluid [N/m]."""
    fluid = cage.added_mass * (cage.cage_speed - cage.fluid_speed) ** 2
    return cage.mass * cage.cage_speed**2 + fluid


def drive_energy(cage: MovingCage) -> Joule:
    r"""Kinetic energy that the frame and the loads can give the cage over its room, without any kick [J].

    .. math:: \tfrac12 M (\Omega w)^2 + 2 w (M g + U \Omega^2) + \tfrac12 (M + J/R^2) (2 V)^2
              + 2 w_z (M |g_z| + |J_p - J_t| \Omega^2 \delta / R)

    with the room :math:`w`: the depth of the centrifugal potential, which is also the energy, in the turning
    frame, of a cage that rests on its land at a place fixed in space; the fall across the room under
    gravity and unbalance; and an impact of balls that lead and lag at speeds up to V. The fluid that moves
    with the cage counts in the first term by its own speed, and in the last M. In space gravity along the
    axis and dynamic unbalance act over half the axial clearance :math:`w_z` of the pockets, and the tilt
    :math:`w_z/R`.
    """
    w, M, speed, R = room(cage), moving_mass(cage), cage.cage_speed, cage.pitch_radius
    fall = 2.0 * w * (cage.mass * cage.gravity + cage.unbalance * speed**2)
    pairs = zip(cage.orbital_cosines, cage.orbital_sines, strict=True)
    V = sum(math.hypot(*pair) for pair in pairs)
    across = (
        0.5 * centrifugal_stiffness(cage) * w**2
        + fall
        + 0.5 * (M + cage.moment_of_inertia / R**2) * (2.0 * V) ** 2
    )
    if not cage.is_in_space:
        return across
    leaning = abs(cage.moment_of_inertia - cage.transverse) * cage.dynamic_unbalance
    along = 0.0 if cage.is_axially_held else cage.mass * abs(cage.axial_gravity)
    tilting = 0.0 if cage.is_tilt_held else leaning * speed**2 / R
    return across + 2.0 * axial_half_play(cage) * (along + tilting)


def axial_half_play(cage: MovingCage) -> Metre:
    """Half the clearance of a pocket along the axis [m]: as along the orbit, unless it is elongated."""
    if cage.pocket_shape is not PocketShape.SQUARE:
        return end_half_play(cage)
    return cage.pocket_clearance / 2.0


def drifts(cage: MovingCage) -> bool:
    """Whether nothing guides the centre, and the turning of the ball set or gravity moves it."""
    return not cage.is_guided and (cage.cage_speed != 0.0 or cage.gravity > 0.0)


def drift_rate_law(cage: MovingCage) -> PerSecond:
    r"""Growth rate of an unguided cage's offset in the turning frame, :math:`2M\Omega^2/(ZC_\mu)` [1/s].

    The slow root of the polynomial, for :math:`\Omega \ll \omega_0` and a small friction; 0 of a guided one.
    """
    law = 2.0 * centrifugal_stiffness(cage) / (cage.ball_count * cage.slow_damping)
    return 0.0 if cage.is_guided else law


def felt_mass(cage: MovingCage, *, may_turn: bool = True) -> float:
    """Mass that an impact feels: M, or 1/(1/M + R^2/J) where the cage may turn, M/2 for a thin ring [kg]."""
    turning = cage.pitch_radius**2 / cage.moment_of_inertia if may_turn else 0.0
    return 1.0 / (1.0 / moving_mass(cage) + turning)


LONG = 50.0
"""Half periods of the pocket's spring for which an impact is followed."""


def returned_share(law: BallTraction, mass: Kilogram, stiffness: NewtonPerMetre, speed: float) -> Ratio:
    r"""Speed that a cage gets back from an impact on a ball of one state, over that before [-].

    With the depth d of the pocket in the ball: :math:`\dot d = v - u`, :math:`m \dot v = -kd`,
    :math:`m_e \dot u = kd - F(u)`, until d is 0 again; 0 where cage and ball move on together.

    Parameters
    ----------
    law : BallTraction
        Of the ball.
    mass, stiffness, speed : float
        Mass that the impact feels (`felt_mass`) [kg], k_BC [N/m], and speed of the pocket before [m/s].
    """
    from scipy.integrate import solve_ivp

    period = math.pi * math.sqrt(mass / stiffness)

    def rates(_: float, y: Array) -> list[float]:
        force = stiffness * y[0]
        return [y[1] - y[2], -force / mass, (force - float(law.force(y[2]))) / law.mass]

    def depth(_: float, y: Array) -> float:
        return float(y[0])

    depth.terminal, depth.direction = True, -1.0  # type: ignore[attr-defined]
    start = [0.0, speed, 0.0]
    course = solve_ivp(rates, (0.0, LONG * period), start, "Radau", events=depth, rtol=1e-8, atol=1e-12)
    return max(0.0, -float(course.y[1, -1]) / speed)


def rebound(damping_ratio: Ratio) -> Ratio:
    r"""Restitution of a mass on a spring and a parallel damper that can push but not pull [-].

    The impact ends when the force is back at zero, before the spring is. With :math:`\beta = \zeta\omega` and
    :math:`\Omega = \omega\sqrt{|1-\zeta^2|}` (Schwager and Poeschel 2007, with their :math:`\omega_0` as unit
    of time).
    """
    zeta = damping_ratio
    if zeta == 0.0:
        return 1.0
    if zeta < 1.0:
        root = math.sqrt(1.0 - zeta * zeta)
        turned = math.atan2(2.0 * zeta * root, 2.0 * zeta * zeta - 1.0)
        return math.exp(-zeta / root * turned)
    if zeta == 1.0:
        return math.exp(-2.0)
    root = math.sqrt(zeta * zeta - 1.0)
    return math.exp(-zeta / root * 2.0 * math.log(zeta + root))


@lru_cache(maxsize=64)
def rebound_damping(restitution: Ratio) -> Ratio:
    """Damping ratio of the land whose `rebound` is this [-]; below 1e-4 that of 1e-4, close to 0."""
    if restitution >= 1.0:
        return 0.0
    target = max(restitution, LOWEST_RESTITUTION)
    low, high = 0.0, 100.0
    while low < (middle := 0.5 * (low + high)) < high:  # down to neighbouring numbers
        low, high = (middle, high) if rebound(middle) > target else (low, middle)
    return low


def time_unit(cage: MovingCage) -> Second:
    """Unit of time: a radian of the motion with one ball in touch [s]."""
    R, J = cage.pitch_radius, cage.moment_of_inertia
    return 1.0 / math.sqrt(cage.ball_cage_stiffness * (1.0 / cage.mass + R * R / J))
