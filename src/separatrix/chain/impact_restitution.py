r"""Restitution factor of a ball/cage impact, from the damping that the races give the ball (Eqs 17-18).

The cage, of mass :math:`M_C`, meets a massless ball through the spring :math:`k_{BC}`; the races hold
the ball through the damper :math:`C_\mu`, in series with the spring. docs/theory/restitution.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import exp, hypot, log, pi, sqrt
from typing import Annotated

import numpy as np

from separatrix.chain.contacts import RaceContact
from separatrix.chain.film_compliance import film_compliance
from separatrix.chain.hertz import contact_modulus
from separatrix.chain.traction_curve import traction_slope
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Array,
    Kilogram,
    Metre,
    MetrePerSecond,
    NewtonPerMetre,
    NewtonPerMetre1_5,
    NewtonSecondPerMetre,
    Ratio,
)
from separatrix.study.study import Film, Material

SOLID_LUBRICATION_LIMIT: Ratio = 0.6
"""The paper, section 5: "a fairly low restitution factor (eta < 0.6). This threshold value is too low to
be reached using solid lubrication"."""

EQUAL_ENERGY = 0.8 * 1.25**0.2
r"""k of the linear spring of equal energy and depth, over :math:`K^{4/5} (M v^2)^{1/5}` [-]."""

FORGOTTEN = 6.0
"""Damping group of a Hertzian impact from which its end forgets its start: what is left of the difference is
below 1e-38 (docs/theory/restitution.md)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Restitution:
    """Restitution factor of the cage's impact on a ball, and what it is made of.

    The plain names follow the paper's Eq. 18 (damping of both races added); the ones ending in
    `_free_spin` let the ball change its spin within the impact.
    """

    ball_cage_stiffness: NewtonPerMetre
    cage_mass: Kilogram  # M_C
    inner_damping: NewtonSecondPerMetre
    outer_damping: NewtonSecondPerMetre
    race_damping: NewtonSecondPerMetre  # C_mu as printed, Eq. 18: of a ball that cannot change its spin
    damping_ratio: Ratio  # sqrt(k_BC M_C) over 2 C_mu
    restitution_factor: Ratio  # eta: speed of the cage after an impact over that before, Eq. 1
    race_damping_free_spin: NewtonSecondPerMetre
    damping_ratio_free_spin: Ratio
    restitution_factor_free_spin: Ratio

    @property
    def restitution_factor_hertz(self) -> Ratio:
        """Restitution factor with a Hertzian pocket, at the speed to which `ball_cage_stiffness` belongs [-].

        It has the same energy at the same depth.
        """
        return hertzian_restitution_factor(self.damping_ratio)

    @property
    def least_damping(self) -> NewtonSecondPerMetre:
        """C_mu from which an impact returns anything, sqrt(k M)/2; below it the impact is overdamped."""
        return 0.5 * sqrt(self.ball_cage_stiffness * self.cage_mass)


def contact_damping(slope: Ratio, contact: RaceContact) -> NewtonSecondPerMetre:
    """One race's share of C_mu, alpha N / V (Eq. 18)."""
    return slope * contact.load / contact.rolling_speed


def race_damping_free_spin(inner: NewtonSecondPerMetre, outer: NewtonSecondPerMetre) -> NewtonSecondPerMetre:
    """C_mu of a ball whose spin follows the impact, 4 C_I C_E / (C_I + C_E): both contacts carry half."""
    return 4.0 * inner * outer / (inner + outer)


def damping_ratio(stiffness: NewtonPerMetre, mass: Kilogram, damping: NewtonSecondPerMetre) -> Ratio:
    r"""Damping ratio of the impact, :math:`\zeta = \sqrt{k_{BC} M_C} / (2 C_\mu)`."""
    if not damping > 0.0:
        cure = "A race friction above 0 and a rolling bearing give one."
        raise InputError("race_damping", "must be > 0 [N s/m]", f"{damping:.6g}", cure)
    return sqrt(stiffness * mass) / (2.0 * damping)


def restitution_factor(damping_ratio: Ratio) -> Ratio:
    r"""Restitution factor :math:`\eta = \exp(-\pi\zeta/\sqrt{1-\zeta^2})`; 0 from :math:`\zeta = 1`.

    This stands for the paper's Eq. 17, which is lost in the text at hand (docs/deviations.md).
    """
    zeta = damping_ratio
    return exp(-pi * zeta / sqrt((1.0 - zeta) * (1.0 + zeta))) if zeta < 1.0 else 0.0


def damping_ratio_for(restitution_factor: Ratio) -> Ratio:
    """Damping ratio that returns this share of the speed; 1 (the least that returns none) for 0.

    Raises
    ------
    InputError
        Outside 0 <= eta < 1: an impact that returns everything needs infinite damping.
    """
    eta = restitution_factor
    if not 0.0 <= eta < 1.0:
        cure = "An impact that returns all its speed would need races that grip without any creep."
        raise InputError("restitution_factor", "must lie in 0 <= eta < 1 [-]", f"{eta:.6g}", cure)
    return -log(eta) / hypot(pi, log(eta)) if eta > 0.0 else 1.0


def damping_for(restitution_factor: Ratio, stiffness: NewtonPerMetre, mass: Kilogram) -> NewtonSecondPerMetre:
    """C_mu that gives this restitution factor; for 0, the largest one that does."""
    return sqrt(stiffness * mass) / (2.0 * damping_ratio_for(restitution_factor))


def ball_pocket_stiffness(
    ball_diameter: Metre,
    ball_material: Material,
    cage_material: Material,
    *,
    cage_mass: Kilogram,
    impact_speed: MetrePerSecond,
) -> NewtonPerMetre:
    r"""Linear stiffness of a ball on a flat pocket wall that stores the same energy at the same depth.

    Hertz: :math:`F = K \delta^{3/2}`, :math:`K = \frac43 E^* \sqrt{D/2}`. The cage's kinetic energy
    :math:`\frac12 M_C v^2 = \frac25 K \delta_m^{5/2}` sets the depth :math:`\delta_m`, and
    :math:`k = \frac45 K \delta_m^{1/2}` stores it there too.

    It goes as the fifth root of the mass, the whole one as in Eq. 17, and as the speed to the power 2/5.

    Notes
    -----
    A flat wall, because the conformity of a bored pocket to its ball wears and is rarely known; a
    cylindrical bore with 5 % of play is stiffer by 2.1 (docs/theory/restitution.md).
    """
    K = hertz_coefficient(ball_diameter, ball_material, cage_material)
    return equal_energy_stiffness(K, cage_mass, impact_speed)


def hertz_coefficient(
    ball_diameter: Metre, ball_material: Material, cage_material: Material
) -> NewtonPerMetre1_5:
    r"""K of :math:`F = K \delta^{3/2}` for a ball on a flat pocket wall, :math:`\frac43 E^*\sqrt{D/2}`."""
    return 4.0 / 3.0 * contact_modulus(ball_material, cage_material) * sqrt(ball_diameter / 2.0)


def equal_energy_stiffness(
    hertz_coefficient: NewtonPerMetre1_5, mass: Kilogram, speed: MetrePerSecond
) -> NewtonPerMetre:
    r"""Linear spring that an impact of this mass and speed presses as deep as Hertz's, with the same energy.

    :math:`k = \frac45 K \delta_m^{1/2}` with :math:`\frac12 M v^2 = \frac25 K \delta_m^{5/2}`.
    """
    k: float = EQUAL_ENERGY * hertz_coefficient**0.8 * (mass * speed**2) ** 0.2
    return k


def hertz_coefficient_for(
    stiffness: NewtonPerMetre, mass: Kilogram, speed: MetrePerSecond
) -> NewtonPerMetre1_5:
    """K whose `equal_energy_stiffness` is this: Hertz's contact behind a linear stiffness that was given."""
    K: float = (stiffness / (EQUAL_ENERGY * (mass * speed**2) ** 0.2)) ** 1.25
    return K


def hertzian_restitution_factor(damping_ratio: Ratio) -> Ratio:
    r"""Restitution factor of a Hertzian contact in series with the races' damper; it is never quite 0.

    The damping ratio is that of the linear spring of equal energy and depth at the speed of the impact
    (`equal_energy_stiffness`); with Hertz it goes as the speed to the power 1/5.

    Notes
    -----
    The impact has one dimensionless group beta: h' = u - beta h^3, u' = -2 h^4 from h = 0, u = 1 until h, the
    approach's root, is 0 again (docs/theory/restitution.md).
    """
    beta = 2.0 * damping_ratio / sqrt(EQUAL_ENERGY)
    if beta == 0.0:
        return 1.0
    return _speed_returned(min(beta, FORGOTTEN)) * min(FORGOTTEN / beta, 1.0) ** 5


@lru_cache(maxsize=1024)
def _speed_returned(beta: Ratio) -> Ratio:
    from scipy.integrate import solve_ivp  # dear to import

    def motion(_: float, state: Array) -> list[float]:
        h, u = state.tolist()
        return [u - beta * h**3, -2.0 * h**4]

    def leaves(_: float, state: Array) -> float:
        return float(state[0])

    leaves.terminal, leaves.direction = True, -1.0  # type: ignore[attr-defined]
    span = 0.0, 1e4
    found = solve_ivp(motion, span, [0.0, 1.0], method="DOP853", events=leaves, rtol=3e-14, atol=1e-15)
    return -float(found.y[1, -1])  # an event that ends it is its last point


def restitution(
    inner: NewtonSecondPerMetre,
    outer: NewtonSecondPerMetre,
    *,
    ball_cage_stiffness: NewtonPerMetre,
    cage_mass: Kilogram,
) -> Restitution:
    """Restitution factors of an impact, from the damping of each race (`contact_damping`)."""
    both, free = inner + outer, race_damping_free_spin(inner, outer)
    zeta = damping_ratio(ball_cage_stiffness, cage_mass, both)
    zeta_free = damping_ratio(ball_cage_stiffness, cage_mass, free)
    return Restitution(
        ball_cage_stiffness=ball_cage_stiffness,
        cage_mass=cage_mass,
        inner_damping=inner,
        outer_damping=outer,
        race_damping=both,
        damping_ratio=zeta,
        restitution_factor=restitution_factor(zeta),
        race_damping_free_spin=free,
        damping_ratio_free_spin=zeta_free,
        restitution_factor_free_spin=restitution_factor(zeta_free),
    )


FILM_THICKNESSES: tuple[Metre, ...] = (0.0, *(float(h) for h in np.geomspace(1e-9, 1e-5, 41)))
"""Bare, then 1 nm to 10 um, ten to a decade."""

RACE_FRICTIONS: tuple[Ratio, ...] = (0.02, 0.05, 0.1, 0.2, 0.4)
"""From burnished MoS2 in vacuum to nearly unlubricated steel."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LubricationCurve:
    """Restitution factor against film thickness and race friction, bare to thick (the paper's Fig. 8)."""

    film_thickness: Annotated[Array, "m", ("film_thickness",)]  # 0 is bare
    race_friction: Annotated[Array, "-", ("race_friction",)]  # friction of ball on race of each curve
    restitution_factor: Annotated[Array, "-", ("race_friction", "film_thickness")]  # with dampings summed
    restitution_factor_free_spin: Annotated[Array, "-", ("race_friction", "film_thickness")]
    film_material: str  # whose modulus the film has


def lubrication_curve(
    inner: RaceContact,
    outer: RaceContact,
    film_material: Material,
    *,
    ball_cage_stiffness: NewtonPerMetre,
    cage_mass: Kilogram,
    film_thicknesses: Sequence[Metre] = FILM_THICKNESSES,
    race_frictions: Sequence[Ratio] = RACE_FRICTIONS,
) -> LubricationCurve:
    """Restitution factor for each race friction and film thickness, the kinematics held.

    A thickness is the total over ball and race, 0 for bare [m].

    Notes
    -----
    The film is in series with the half-planes at every thickness; beyond some 3 % of the semi-minor axis that
    departs from a bonded layer (docs/theory/traction.md). Without race control the ball's spin depends on the
    race friction too; here it is that of the contacts given.
    """

    def under(h: Metre, f: Ratio) -> tuple[Ratio, Ratio]:
        compliance = film_compliance(Film(race_friction=f, material=film_material, thickness=h)) if h else 0.0
        shares = []
        for at in (inner, outer):
            slope, _ = traction_slope(at.ellipse, at.creep, race_friction=f, film_compliance=compliance)
            shares.append(contact_damping(slope, at))
        found = restitution(*shares, ball_cage_stiffness=ball_cage_stiffness, cage_mass=cage_mass)
        return found.restitution_factor, found.restitution_factor_free_spin

    factors = np.array([[under(h, f) for h in film_thicknesses] for f in race_frictions])
    return LubricationCurve(
        film_thickness=np.array(film_thicknesses),
        race_friction=np.array(race_frictions),
        restitution_factor=np.ascontiguousarray(factors[..., 0]),
        restitution_factor_free_spin=np.ascontiguousarray(factors[..., 1]),
        film_material=film_material.name,
    )
