r"""Where the power of a bearing goes: friction, drag of the fluid, temperatures; the fluid in a land gap.

Seen from the outer ring, whose speed is taken off all others, the shaft gives what friction and fluid take,

.. math:: M\,(\omega_i - \omega_o) = \sum H + F_D v Z + M_s \Omega Z + M_o \omega_c
          + M_i (\omega_i - \omega_c)

with the heat H of every contact, the drag :math:`F_D` on a ball that orbits at v, the moment on its spin, and
those on both faces of the cage. Drag is small beside what the races hold: it does not move the equilibrium.
The inner ring turns a fluid that is faster than the balls; v is then their speed behind that ring.
docs/theory/heat.md has the sources.

Of the fluid in the gap of a land a part moves with the cage across the axis. The gap is a thin annulus, open
at both ends, without flow along the axis. A cage that moves across the axis squeezes the fluid round and out;
the pressure that this takes (potential flow, of the mean over the gap) is that of an added mass,

.. math:: m_a = \rho \pi R^3 \frac{L}{c} \Bigl(1 - \frac{\tanh(L/2R)}{L/2R}\Bigr)
          \to \rho \pi R \frac{L^3}{12 c}.

The mean flow is held by both walls, against which it turns at half their difference in speed: turbulent by
Hirs (1973, p. 143: :math:`\tau = 0.066\,Re^{-1/4} \rho U^2/2`), else laminar. So it decays at the rate
:math:`0.066\,Re^{-1/4} U/c`, or :math:`12 \nu/c^2`, whichever is faster.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.chain.hertz import track_area
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Kelvin,
    Kilogram,
    KilogramPerMetre3,
    KilogramPerSecond,
    Metre,
    MetrePerSecond,
    Newton,
    NewtonMetre,
    NewtonSecondPerMetre,
    PascalSecond,
    RadianPerSecond,
    Ratio,
    Watt,
    WattPerMetre2,
    format_quantity,
)
from separatrix.study.study import CageDesign, Cooling, Guidance, Study

if TYPE_CHECKING:
    from separatrix.chain.contacts import BearingState, RaceContact
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


NEEDED = ("density", "viscosity", "heat_capacity")
"""Properties of a fluid."""

CRISIS = 2e5
"""Reynolds number from which the drag of a smooth sphere falls."""

GRAVITY = 9.80665


class Fluid(NamedTuple):
    """What drag needs of a fluid."""

    density: KilogramPerMetre3
    viscosity: PascalSecond


def ball_drag(fluid: Fluid, diameter: Metre, speed: MetrePerSecond) -> Newton:
    """Drag of a sphere in a stream, against it.

    24/Re (1 + 0.15 Re^0.687) below a Reynolds number of 1000, 0.44 above; beyond the drag crisis at some 2e5
    a smooth sphere has 0.1 to 0.2 instead.
    """
    reynolds = fluid.density * abs(speed) * diameter / fluid.viscosity
    if reynolds == 0.0:
        return 0.0
    slow = 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687)
    factor = slow if reynolds < 1000.0 else 0.44
    return math.copysign(factor * 0.125 * math.pi * diameter**2 * fluid.density * speed**2, speed)


def spin_moment(fluid: Fluid, diameter: Metre, spin: RadianPerSecond) -> NewtonMetre:
    """Moment of the fluid on a sphere that spins (as Gupta has it for balls)."""
    r = 0.5 * diameter
    reynolds = fluid.density * spin * r**2 / fluid.viscosity
    if reynolds == 0.0:
        return 0.0
    factor = 3.87 / math.sqrt(reynolds) if reynolds < 3e5 else 0.146 / reynolds**0.2
    return 0.5 * fluid.density * spin**2 * r**5 * factor


def cylinder_moment(fluid: Fluid, radius: Metre, width: Metre, speed: RadianPerSecond) -> NewtonMetre:
    """Moment of the fluid on a cylinder whose wall turns at this speed against the wall beside it."""
    reynolds = fluid.density * abs(speed) * radius**2 / fluid.viscosity
    if reynolds == 0.0:
        return 0.0
    if reynolds <= 170.0:
        factor = 8.0 / reynolds
    else:
        factor = 0.616 / math.sqrt(reynolds) if reynolds < 4000.0 else 0.063 / reynolds**0.225
    return factor * math.pi * fluid.density * speed**2 * radius**4 * width


class Temperatures(NamedTuple):
    """Steady temperatures of the parts, and of the coolant as it leaves; none without a flow."""

    inner_ring_temperature: Kelvin | None = None
    ball_temperature: Kelvin | None = None
    outer_ring_temperature: Kelvin | None = None
    cage_temperature: Kelvin | None = None
    coolant_out_temperature: Kelvin | None = None


class Heat(NamedTuple):
    """Heat that is set free in each part, and in the fluid itself."""

    inner_ring: Watt
    balls: Watt
    outer_ring: Watt
    cage: Watt
    fluid: Watt


def temperatures(
    heat: Heat, cooling: Cooling, flow: KilogramPerSecond, heat_capacity: float, inlet: Kelvin
) -> Temperatures:
    """Steady temperatures with a coolant at the mean of what enters and what leaves."""
    rise = sum(heat) / (flow * heat_capacity)
    race = cooling.race_conductance or 0.0
    hold = np.diag([cooling.inner_cooling or 0.0, cooling.ball_cooling or 0.0, cooling.outer_cooling or 0.0])
    hold += race * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    middle = inlet + 0.5 * rise
    inner, balls, outer = (middle + np.linalg.solve(hold, np.array(heat[:3]))).tolist()
    cage = middle + heat.cage / cooling.cage_cooling if cooling.cage_cooling else None
    return Temperatures(inner, balls, outer, cage, inlet + rise)


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatBalance:
    """Power that the shaft gives to a bearing with a fluid, where it goes, and what becomes warm."""

    shaft_torque: NewtonMetre  # friction and fluid
    shaft_power: Watt
    cage_power: Watt  # of the friction at pockets and lands; 0 where no cage was followed
    ball_drag: Newton  # of the fluid on a ball along its orbit; below 0 it drives the ball
    drag_share: Ratio | None  # of it in what the races hold of a ball; null of races without friction
    ball_drag_power: Watt  # of all balls; never below 0
    spin_power: Watt  # of the fluid's moment on the spin of all balls
    cage_drag_power: Watt | None  # of the fluid on both faces of the cage; null without its sizes
    inner_ring_temperature: Kelvin | None
    ball_temperature: Kelvin | None
    outer_ring_temperature: Kelvin | None
    cage_temperature: Kelvin | None
    coolant_out_temperature: Kelvin | None
    flash_inner: Kelvin | None  # rise of a surface in the contact with the inner race, most loaded ball
    flash_outer: Kelvin | None  # the same at the outer race
    track_heat: WattPerMetre2  # that the ring takes in, over its track; of the hotter one
    boiling_limit: WattPerMetre2 | None  # above which a surface dries, at the library's pressure
    notes: tuple[str, ...] = ()  # where a model leaves its range, a sentence each


def heat_balance(
    study: Study, state: BearingState, *, pocket_power: Watt = 0.0, land_power: Watt = 0.0
) -> HeatBalance | None:
    """Balance of a bearing with its fluid; None without [cooling].

    The powers are those of friction at pockets and lands. Half of each contact's heat goes to either side.

    Raises
    ------
    InputError
        The library does not know the fluid near this temperature.
    """
    cooling, at = study.cooling, study.operation.temperature
    if cooling is None or at is None:
        return None
    density, viscosity, capacity = (_required(study, name, at) for name in NEEDED)
    fluid, found, bearing = Fluid(density, viscosity), state.equilibrium, study.bearing
    D, Z, R = bearing.ball_diameter, bearing.ball_count, 0.5 * bearing.pitch_diameter
    ring, orbit = (
        one - study.operation.outer_speed for one in (study.operation.inner_speed, state.cage_speed)
    )
    drag = ball_drag(fluid, D, math.copysign(1.0, orbit) * R * (orbit - cooling.swirl * ring))
    drag_power = Z * R * abs(drag) * abs(orbit if drag > 0.0 else ring - orbit)
    spin_power = sum(
        spin_moment(fluid, D, one) * one for one in np.linalg.norm(found.ball_spin, axis=1).tolist()
    )
    faces = _cage_faces(study.cage, fluid, orbit, ring)
    in_fluid = drag_power + spin_power + (faces or 0.0)
    inner, outer = (0.5 * float(one.sum()) for one in (found.heat_inner, found.heat_outer))
    on_inner = study.cage is not None and study.cage.guidance is Guidance.INNER
    heat = Heat(
        inner_ring=inner + 0.5 * land_power * on_inner,
        balls=inner + outer + 0.5 * pocket_power,
        outer_ring=outer + 0.5 * land_power * (not on_inner),
        cage=0.5 * (pocket_power + land_power),
        fluid=in_fluid,
    )
    known = temperatures(heat, cooling, cooling.flow, capacity, at) if cooling.flow else Temperatures()
    races = ((state.inner, -1.0, inner), (state.outer, 1.0, outer))
    tracks = [heat / track_area(bearing, one.ellipse, one.contact_angle, side) for one, side, heat in races]
    limit = boiling_limit(study, at)
    held = study.film.race_friction * (state.inner.load + state.outer.load)
    flash_inner, flash_outer = (
        _flash(study, found_heat[state.inner.ball], one)
        for found_heat, one in ((found.heat_inner, state.inner), (found.heat_outer, state.outer))
    )
    return HeatBalance(
        shaft_torque=sum(heat) / abs(ring) if ring else 0.0,
        shaft_power=sum(heat),
        cage_power=pocket_power + land_power,
        ball_drag=drag,
        drag_share=abs(drag) / held if held else None,
        ball_drag_power=drag_power,
        spin_power=spin_power,
        cage_drag_power=faces,
        **known._asdict(),
        flash_inner=flash_inner,
        flash_outer=flash_outer,
        track_heat=max(tracks),
        boiling_limit=limit,
        notes=(
            *_beyond(fluid, D, R * abs(orbit - cooling.swirl * ring), max(tracks), limit, study),
            *_skids(study, state, abs(drag)),
            *_warmer(study, at, known, 1.0 - in_fluid / sum(heat) if in_fluid else 1.0),
            *_hot(at, max(flash_inner or 0.0, flash_outer or 0.0)),
        ),
    )


def _required(study: Study, name: str, temperature: Kelvin) -> float:
    """Property of the study's fluid near its temperature, refused where the library has none."""
    found = fluid_property(study, name, temperature)
    if found is None:
        rule = f"has no {name.replace('_', ' ')} near {format_quantity(temperature, 'K')} in the library"
        cure = "Leave [cooling] out, or state it in a library file of your own."
        if study.fluid is None:
            rule = "is not a fluid of the library, which [cooling] needs"
            cure = (
                'Write "liquid nitrogen" or "GHe", with the state; `separatrix materials list` has the names.'
            )
        where = f"{study.place('operation.fluid')}: [operation] fluid"
        raise InputError(where, rule, str(study.operation.fluid), cure)
    return found


def _cage_faces(
    cage: CageDesign | None, fluid: Fluid, orbit: RadianPerSecond, ring: RadianPerSecond
) -> Watt | None:
    """Power of the fluid between both faces of the cage and the rings; None without its sizes."""
    if cage is None or cage.width is None or cage.inner_diameter is None or cage.outer_diameter is None:
        return None
    faces = ((0.5 * cage.outer_diameter, orbit), (0.5 * cage.inner_diameter, ring - orbit))
    return sum(cylinder_moment(fluid, radius, cage.width, one) * abs(one) for radius, one in faces)


def _flash(study: Study, heat: Watt, at: RaceContact) -> Kelvin | None:
    r"""Rise of a surface as it passes through a contact, half of whose heat goes into it.

    :math:`(2/\sqrt\pi)\,(q/2)\,\sqrt{2b/V}/e`: a half-space heated for the time of a pass by the mean of
    the heat over the ellipse, with the effusivity e of the rings' steel.
    """
    cooling, steel = study.cooling, study.bearing.ring_material
    a, b = at.ellipse.semi_major, at.ellipse.semi_minor
    if cooling is None or cooling.steel_conductivity is None or cooling.steel_heat_capacity is None:
        return None
    if steel.density is None or not (a * b * at.rolling_speed):
        return None
    effusivity = math.sqrt(cooling.steel_conductivity * steel.density * cooling.steel_heat_capacity)
    flux = float(heat) / (math.pi * a * b)
    return 2.0 / math.sqrt(math.pi) * 0.5 * flux * math.sqrt(2.0 * b / at.rolling_speed) / effusivity


def boiling_limit(study: Study, temperature: Kelvin) -> WattPerMetre2 | None:
    r"""Heat flux above which a boiling liquid leaves a surface dry; None for what does not boil.

    Zuber's :math:`0.131\,h_{fg} \sqrt{\rho_v}\,(\sigma g (\rho_l - \rho_v))^{1/4}`, of a pool at rest at
    the pressure of the library's properties.
    """
    names = ("latent_heat", "vapour_density", "surface_tension", "density")
    latent, vapour, tension, liquid = (fluid_property(study, name, temperature) for name in names)
    if latent is None or vapour is None or tension is None or liquid is None:
        return None
    return float(0.131 * latent * math.sqrt(vapour) * (tension * GRAVITY * (liquid - vapour)) ** 0.25)


def _skids(study: Study, state: BearingState, drag: Newton) -> Iterator[str]:
    """Yield that the races cannot push a ball through the fluid; both push alike: its spin is steady."""
    holds = 2.0 * study.film.race_friction * min(state.inner.load, state.outer.load)
    if drag > holds:
        takes, most = format_quantity(drag, "N", 3), format_quantity(holds, "N", 3)
        yield (
            f"The drag on a ball, {takes}, exceeds twice the friction of the race with less load, {most}: "
            "the balls skid, and torque, heat and temperatures are not those of this bearing."
        )


def _warmer(study: Study, inlet: Kelvin, known: Temperatures, by_parts: Ratio) -> Iterator[str]:
    """Yield that a coolant leaves warmer than it boils, than its properties reach, or than what heats it.

    `by_parts` is the share of its heat that the parts give.
    """
    outlet = known.coolant_out_temperature
    if outlet is None:
        return
    hottest, alone = max(filter(None, known[:4])), inlet + by_parts * (outlet - inlet)
    leaves, enters, part, to = (format_quantity(one, "K", 4) for one in (outlet, inlet, hottest, alone))
    if alone > hottest:
        yield (
            f"Parts of at most {part} cannot heat the coolant to {to}: with so little flow its mean is not "
            "halfway between inlet and outlet, and the parts are warmer than given."
        )
    is_liquid = fluid_property(study, "latent_heat", inlet) is not None
    point = study.fluid["data"].get("boiling_temperature") if study.fluid and is_liquid else None
    if point and outlet > point[0]["value"]:
        yield (
            f"The coolant leaves at {leaves}, above its boiling point at 1 atm, "
            f"{format_quantity(point[0]['value'], 'K', 4)}: it stays liquid under pressure alone."
        )
    if outlet > (1.0 + NEAR) * inlet:
        yield (
            f"The coolant leaves at {leaves} with the properties that it has at {enters}: temperatures are "
            f"estimates beyond {100.0 * NEAR:.0f} % of it. More flow keeps it cooler."
        )


def _hot(temperature: Kelvin, flash: Kelvin) -> Iterator[str]:
    """Yield that a flash leaves the temperature at which the steel's properties are stated."""
    if flash > temperature:  # at twice the temperature those of a cold steel have changed several times
        rise, cold = format_quantity(flash, "K", 3), format_quantity(temperature, "K", 4)
        yield (
            f"The flash, a rise of {rise}, has the conductivity and heat capacity of steel at {cold}: it is "
            "too high where they grow with temperature."
        )


def _beyond(
    fluid: Fluid, diameter: Metre, speed: MetrePerSecond, flux: float, limit: float | None, study: Study
) -> Iterator[str]:
    """Yield where drag or cooling leave their range."""
    reynolds = fluid.density * speed * diameter / fluid.viscosity
    if reynolds > CRISIS:
        yield (
            f"The drag of the balls is that of spheres at a Reynolds number below {CRISIS:.0e}, here "
            f"{reynolds:.2g}: beyond it smooth spheres have a quarter to half of it."
        )
    if limit is not None and flux > limit:
        takes, dry = (format_quantity(one, "W/m2", 2) for one in (flux, limit))
        yield (
            f"The hotter track takes in {takes}, and {study.operation.fluid} dries a surface above {dry}: "
            f"unless the ring spreads the heat over {flux / limit:.2g} times the area of the track, its "
            "temperature is above the one given."
        )
