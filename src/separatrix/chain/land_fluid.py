r"""The fluid in the gap of a land: what of it moves with the cage across the axis, and how it is braked.

The gap is a thin annulus, open at both ends, without flow along the axis. A cage that moves across the axis
squeezes the fluid round and out; the pressure that this takes (potential flow, of the mean over the gap) is
that of an added mass,

.. math:: m_a = \rho \pi R^3 \frac{L}{c} \Bigl(1 - \frac{\tanh(L/2R)}{L/2R}\Bigr)
          \to \rho \pi R \frac{L^3}{12 c}.

The mean flow is held by both walls, against which it turns at half their difference in speed: turbulent by
Hirs (1973, p. 143: :math:`\tau = 0.066\,Re^{-1/4} \rho U^2/2`), else laminar. So it decays at the rate
:math:`0.066\,Re^{-1/4} U/c`, or :math:`12 \nu/c^2`, whichever is faster.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from separatrix.ground.units import (
    Kilogram,
    KilogramPerMetre3,
    Metre,
    MetrePerSecond,
    NewtonSecondPerMetre,
    Ratio,
)
from separatrix.study.study import CageDesign, Guidance, Study

HIRS: tuple[Ratio, Ratio] = (0.066, -0.25)
"""Factor and power of Hirs's friction between smooth walls, Reynolds number of the gap."""

NEAR: Ratio = 0.15
"""Share of the temperature by which that of a property of a fluid may differ."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LandFluid:
    """Fluid in the gaps of a cage's lands."""

    added_mass: Kilogram  # that moves with the cage across the axis
    damping: NewtonSecondPerMetre  # of that motion by the walls


def annulus_mass(density: KilogramPerMetre3, radius: Metre, length: Metre, gap: Metre) -> Kilogram:
    """Added mass of an annulus that is open at both ends [kg]; `gap` is radial."""
    half = 0.5 * length / radius
    thin = half**2 / 3.0 * (1.0 - 0.4 * half**2)  # of 1 - tanh(x)/x, where the difference would be rounding
    share = thin if half < 1e-2 else 1.0 - math.tanh(half) / half
    return density * math.pi * radius**3 * length / gap * share


def decay_rate(viscosity: float, density: KilogramPerMetre3, speed: MetrePerSecond, gap: Metre) -> float:
    """Rate at which both walls end the mean flow of a gap, whose fluid passes each at `speed` [1/s]."""
    reynolds = density * speed * gap / viscosity
    turbulent = HIRS[0] * reynolds ** HIRS[1] * speed / gap if reynolds > 0.0 else 0.0
    return max(turbulent, 12.0 * viscosity / (density * gap**2))


def land_fluid(study: Study, design: CageDesign, cage_speed: float) -> LandFluid | None:
    """Fluid in the lands of a cage at its running clearances; None where an input of it is not given.

    That is a land with a width, and a fluid of the library with density and viscosity near the temperature of
    the study. `cage_speed` [rad/s].
    """
    gap, operation = (design.land_clearance or 0.0) / 2.0, study.operation
    if design.guidance is Guidance.BALL or not (design.land_width and gap) or operation.temperature is None:
        return None
    density, viscosity = (
        fluid_property(study, name, operation.temperature) for name in ("density", "viscosity")
    )
    if density is None or viscosity is None:
        return None
    outer = design.outer_diameter if design.guidance is Guidance.OUTER else design.inner_diameter
    radius = 0.5 * (design.land_diameter or outer or study.bearing.pitch_diameter)
    ring = operation.inner_speed if design.guidance is Guidance.INNER else operation.outer_speed
    speed = 0.5 * abs(ring - cage_speed) * radius
    mass = design.land_count * annulus_mass(density, radius, design.land_width, gap)
    return LandFluid(added_mass=mass, damping=mass * decay_rate(viscosity, density, speed, gap))


def fluid_property(study: Study, name: str, temperature: float) -> float | None:
    """Property of the study's fluid at the nearest temperature that has one; None if that is not near."""
    data = study.fluid["data"].get(name) if study.fluid else None
    known = [one for one in data or () if one["temperature"]]
    nearest = min(known, key=lambda one: abs(one["temperature"][0] - temperature), default=None)
    if nearest is None or abs(nearest["temperature"][0] - temperature) > NEAR * temperature:
        return None
    return float(nearest["value"])
