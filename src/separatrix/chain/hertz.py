"""Hertz contact of a ball on a race, from the exact elliptic integrals, and the creep across its ellipse.

Creep: spin, rolling (Heathcote), uniform part (paper, Eqs 3-5, 14 and 16).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from separatrix.ground.compiled import kernel
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Array,
    Metre,
    Newton,
    NewtonPerMetre,
    Pascal,
    PerMetre,
    PerMetre2,
    Radian,
    Ratio,
    SquareMetre,
)
from separatrix.study.study import BallBearing, Material, Race


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactEllipse:
    """One Hertz contact: `semi_major` lies across the groove, `semi_minor` along rolling (paper, 4.1)."""

    load: Newton  # normal to the contact
    semi_major: Metre
    semi_minor: Metre
    max_pressure: Pascal
    approach: Metre
    curvature_rolling: PerMetre  # of the gap, along rolling
    curvature_transverse: PerMetre  # of the gap, across the groove
    contact_modulus: Pascal  # E*: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2

    @property
    def stiffness(self) -> NewtonPerMetre:
        """Slope of load against approach, 3 Q / (2 approach); 0 without load."""
        return 1.5 * self.load / self.approach if self.load > 0.0 else 0.0


def contact_modulus(first: Material, second: Material) -> Pascal:
    """Pair modulus E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 [Pa]."""
    return 1.0 / sum((1.0 - m.poisson_ratio**2) / m.elastic_modulus for m in (first, second))


def race_curvatures(bearing: BallBearing, race: Race, contact_angle: Radian) -> tuple[PerMetre, PerMetre]:
    """Gap curvatures 1/R_x (along rolling) and 1/R_y (across the groove) at the operating angle.

    The gap is h = x^2/(2 R_x) + y^2/(2 R_y), the contact angle that under load, not the free one.

    Notes
    -----
    1/R_x = (2/D)/(1 -+ gamma) with gamma = D cos(alpha)/d_m, minus for the inner race;
    1/R_y = 2/D - 1/(f D) (docs/theory/hertz.md).
    """
    D, gamma = bearing.ball_diameter, bearing.ball_diameter * math.cos(contact_angle) / bearing.pitch_diameter
    side, f = (-1.0, bearing.inner_conformity) if race is Race.INNER else (1.0, bearing.outer_conformity)
    return 2.0 / (D * (1.0 + side * gamma)), (2.0 - 1.0 / f) / D


def contact_ellipse(
    load: Newton, curvature_rolling: PerMetre, curvature_transverse: PerMetre, contact_modulus: Pascal
) -> ContactEllipse:
    r"""Hertz contact of a load and the gap curvatures of two bodies.

    Parameters
    ----------
    load : float
        Normal load, >= 0 [N]; 0 gives an ellipse of no size.
    curvature_rolling, curvature_transverse : float
        Gap curvatures 1/R_x and 1/R_y, the first not below the second, both > 0 [1/m].
    contact_modulus : float
        E* of the pair [Pa].

    Raises
    ------
    InputError
        A negative or non-finite number, or curvatures in the wrong order.

    Notes
    -----
    With k = b/a and q = k^2, R_y/R_x = (E/q - K)/(K - E); a^3 = 3 Q R_y (K - E)/(pi E* (1 - q));
    p0 = 3 Q/(2 pi a b); approach = p0 b K/E* (paper, 4.1, after Hertz; docs/theory/hertz.md).
    Half-spaces: the semi-axes should be small beside the radii of the bodies.

    Examples
    --------
    >>> ellipse = contact_ellipse(100.0, 200.0, 200.0, 110e9)
    >>> ellipse.semi_major == ellipse.semi_minor
    True
    """
    rolling, transverse, positive = curvature_rolling, curvature_transverse, "must be finite and > 0"
    groove = "The groove radius must exceed the ball radius."
    swap = "Swap the two: the ellipse is long where the gap curves less."
    above = f"must lie from {transverse:g} up [1/m]"
    for name, value, is_right, rule, cure in (
        ("load", load, 0.0 <= load < math.inf, "must be finite and >= 0 [N]", ""),
        ("contact_modulus", contact_modulus, 0.0 < contact_modulus < math.inf, f"{positive} [Pa]", ""),
        ("curvature_transverse", transverse, 0.0 < transverse < math.inf, f"{positive} [1/m]", groove),
        ("curvature_rolling", rolling, transverse <= rolling < math.inf, above, swap),
    ):
        if not is_right:
            raise InputError(f"contact_ellipse: {name}", rule, f"{value:g}", cure)
    k, K, D = ellipse_shape(rolling / transverse, 0.0)
    a = math.cbrt(3.0 * load * D / (math.pi * contact_modulus * transverse))
    return _made(load, (k * a, a), (rolling, transverse), contact_modulus, K)


def _made(
    load: Newton,
    half_lengths: tuple[Metre, Metre],
    curvatures: tuple[PerMetre, PerMetre],
    modulus: Pascal,
    K: float,
) -> ContactEllipse:
    """Contact of half lengths and curvatures along rolling and across, with K of its shape."""
    b, a = half_lengths
    p0 = 1.5 * load / (math.pi * a * b) if load > 0.0 else 0.0
    return ContactEllipse(
        load=load,
        semi_major=a,
        semi_minor=b,
        max_pressure=p0,
        approach=p0 * min(a, b) * K / modulus,
        curvature_rolling=curvatures[0],
        curvature_transverse=curvatures[1],
        contact_modulus=modulus,
    )


def ellipse_of_axes(load: Newton, rolling: Metre, lateral: Metre, modulus: Pascal) -> ContactEllipse:
    """Hertz contact whose half lengths along rolling and across are known [m]; either may be the longer.

    The curvatures of the gap are those that give these half lengths under this load [N] with this pair
    modulus [Pa].
    """
    short, long = min(rolling, lateral), max(rolling, lateral)
    k = short / long
    K, D, N = elliptic_integrals(k)
    flat = 3.0 * load * D / (math.pi * modulus * long**3)
    curved = flat * (N / (k**2 * D))
    curvatures = (curved, flat) if rolling <= lateral else (flat, curved)
    return _made(load, (rolling, lateral), curvatures, modulus, K)


def ellipse_of_curvatures(
    load: Newton, rolling: PerMetre, transverse: PerMetre, modulus: Pascal
) -> ContactEllipse:
    """As `contact_ellipse` of one contact; the gap may curve less along rolling than across [1/m]."""
    if rolling >= transverse:
        return contact_ellipse(load, rolling, transverse, modulus)
    turned = contact_ellipse(load, transverse, rolling, modulus)
    return ellipse_of_axes(load, turned.semi_major, turned.semi_minor, modulus)


@kernel
def elliptic_integrals(k: float) -> tuple[float, float, float]:
    """K(m), (K - E)/m and (E - k^2 K)/m for m = 1 - k^2 from k in (0, 1]: AGM, without cancellation."""
    # K = pi/(2 agm); K - E = K S, S = sum 2^(n-1) c_n^2, c_0^2 = m; terms are divided by m = (1-k)(1+k).
    a, g = 0.5 * (1.0 + k), math.sqrt(k)
    c2 = 0.25 * (1.0 - k) / (1.0 + k)  # c_1^2 / m
    tail, weight, c = c2, 2.0, 0.5 * (1.0 - k)
    while c > 1e-9 * a:  # the next c is c^2/(4a): below rounding
        c = 0.25 * c * c / (0.5 * (a + g))
        a, g = 0.5 * (a + g), math.sqrt(a * g)
        c2 = c * c / ((1.0 - k) * (1.0 + k))
        tail += weight * c2
        weight *= 2.0
    K = 0.5 * math.pi / (0.5 * (a + g))
    return K, K * (0.5 + tail), K * (0.5 - tail)


@kernel
def ellipse_shape(ratio: float, guess: float) -> tuple[float, float, float]:
    """Ratio k = b/a, K and (K - E)/(1 - k^2) for R_y/R_x = `ratio`; `guess` for k, or 0 if there is none."""
    log_ratio = math.log(ratio)
    t = math.log(guess) if guess > 0.0 else -log_ratio / 1.5
    k, K, D, N = 1.0, 0.0, 0.0, 0.0
    for _ in range(60):
        k = min(math.exp(t), 1.0)
        K, D, N = elliptic_integrals(k)
        q = k * k
        m = (1.0 - k) * (1.0 + k)
        slope = (K - m * D) / (m * D) - q * K / (m * N) - 2.0 if m > 1e-3 else -1.5
        step = (math.log(N / (q * D)) - log_ratio) / slope
        if abs(step) < 1e-15:
            break
        t = min(t - step, 0.0)
        if abs(step) < 1e-8 and m > 1e-3:  # Newton has converged: the error left is step^2
            k = math.exp(t)
            K, D, N = elliptic_integrals(k)
            break
    return k, K, D


@kernel
def approach_coefficient(
    curvature_rolling: float, curvature_transverse: float, modulus: float, guess: float
) -> tuple[float, float, float]:
    """Stiffness kappa of Q = kappa approach^1.5 [N/m^1.5], semi-major axis per load^(1/3), and k = b/a."""
    k, K, D = ellipse_shape(curvature_rolling / curvature_transverse, guess)
    c = (3.0 * D / (math.pi * modulus * curvature_transverse)) ** (1.0 / 3.0)  # a = c Q^(1/3)
    return (math.pi * modulus * c / (1.5 * K)) ** 1.5, c, k


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
