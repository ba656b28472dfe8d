r"""Clearances of the cage at temperature and speed, from those of its parts at 293 K at rest.

Every part is isotropic, free of stress before it turns, and at one temperature (docs/theory/clearances.md).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

from separatrix.ground.errors import InputError, together
from separatrix.ground.units import (
    Kelvin,
    Kilogram,
    KilogramPerMetre3,
    Metre,
    PerKelvin,
    RadianPerSecond,
    Ratio,
    format_quantity,
)
from separatrix.study.ball_bearing import ROOM, BallBearing, Material
from separatrix.study.cage_body import ring_of
from separatrix.study.cage_design import CageDesign, ClearanceState, Guidance, PocketShape
from separatrix.study.study import Operation

NEAR: Kelvin = 10.0
"""An expansion serves this far beyond the temperatures that its source states."""

DENSITY: KilogramPerMetre3 = 1500.0
"""Of a cage whose density is not known: between PEEK (1300) and filled PTFE (2200)."""

AT_ROOM = "is missing: [cage] clearances are those at 293 K"
AS_RUNNING = 'Or state the running clearances: clearances = "as running".'


@dataclass(frozen=True, slots=True, kw_only=True)
class Clearances:
    """Clearances of the cage as it runs, and the growth of the parts behind them."""

    temperature: Kelvin  # of all parts
    cage_speed: RadianPerSecond  # mean orbital speed of the balls
    pocket_at_rest: Metre  # clearance along the circumference, stop to stop, at 293 K at rest
    pocket: Metre  # the same as it runs
    pocket_axial_at_rest: Metre | None  # clearance along the axis, of an elongated pocket
    pocket_axial: Metre | None
    pocket_radial_offset: Metre  # of spherical pockets from their balls, outward; 0 of others
    land_at_rest: Metre | None  # diametral clearance of the land, None without one
    land: Metre | None
    ball_strain: Ratio  # thermal strain from 293 K
    ring_strain: Ratio | None  # of the rings, where the cage has a land or spherical pockets
    cage_strain: Ratio
    hoop_strain: Ratio  # of the cage's pitch circle by its rotation
    pitch_radius_growth: Metre  # of the cage, by both
    cage_land_growth: Metre | None  # of the radius of the cage's land, by its rotation
    ring_land_growth: Metre | None  # of the radius of the ring's, by its rotation
    guesses: tuple[str, ...]  # numbers behind the clearances that no source states

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence where they rest on guesses."""
        at = format_quantity(self.temperature, "K")
        return (f"Clearances at {at} rest on guesses: {'; '.join(self.guesses)}.",) if self.guesses else ()


def mean_expansion(material: Material, temperature: Kelvin) -> tuple[PerKelvin, str] | None:
    """Mean thermal expansion from 293 K to a temperature, and why it is a guess; None if it is not known.

    Between two data of the library it is linear in the temperature; beyond them the nearest serves.
    """
    if material.thermal_expansion is not None:
        return material.thermal_expansion, ""
    data = material.expansions
    if not data:
        return None
    guess = "a guess of the library"
    for one in data:
        if one.low <= temperature <= one.high:
            return one.mean, guess * one.confidence.startswith("guess")
    for below, above in pairwise(data):
        if below.high < temperature < above.low:
            share = (temperature - below.high) / (above.low - below.high)
            guessed = any(one.confidence.startswith("guess") for one in (below, above))
            return below.mean + share * (above.mean - below.mean), guess * guessed
    nearest = data[0] if temperature < data[0].low else data[-1]
    end = nearest.low if temperature < nearest.low else nearest.high
    why = guess * nearest.confidence.startswith("guess")
    return nearest.mean, f"that at {end:g} K" if abs(end - temperature) > NEAR else why


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningRing:
    """A ring that turns freely, of a material; alike radii are those of a thin one."""

    inner: Metre  # radii
    outer: Metre
    material: Material
    density: KilogramPerMetre3
    speed: RadianPerSecond

    def growth(self, radius: Metre) -> Metre:
        r"""Radial displacement at a radius from `inner` to `outer`, in plane stress (Lame).

        .. math::
            u = \frac{\rho\omega^2 r}{E}\frac{(3+\nu)(1-\nu)}{8}\left[a^2 + b^2
            + \frac{1+\nu}{1-\nu}\frac{a^2b^2}{r^2} - \frac{1+\nu}{3+\nu}r^2\right]

        In a thin ring that is rho w^2 r^3 / E.
        """
        a, b, r = self.inner, self.outer, radius
        nu, E = self.material.poisson_ratio, self.material.elastic_modulus
        shape = a * a + b * b + (1.0 + nu) / (1.0 - nu) * (a * b / r) ** 2 - (1.0 + nu) / (3.0 + nu) * r * r
        return self.density * self.speed**2 * r / E * (3.0 + nu) * (1.0 - nu) / 8.0 * shape


def running_clearances(
    bearing: BallBearing,
    operation: Operation,
    design: CageDesign,
    material: Material | None,
    *,
    cage_mass: Kilogram,
    cage_speed: RadianPerSecond,
) -> Clearances:
    """Clearances of a cage of this material as it runs, from those of `design` at 293 K at rest.

    Raises
    ------
    InputError
        The temperature or the expansion of a part is not known, or a clearance closes.
    """
    T = operation.temperature
    if T is None:
        cure = f"Give it. {AS_RUNNING}"
        raise InputError("[operation] temperature", AT_ROOM, cure=cure)
    if material is None:
        cure = f"Give it, with its thermal_expansion. {AS_RUNNING}"
        raise InputError("[cage] material", AT_ROOM, cure=cure)
    parts = _Parts(bearing=bearing, operation=operation, design=design, temperature=T)
    ball = parts.strain(bearing.ball_material, "[bearing] ball_material")
    cage = parts.strain(material, "[cage] material")
    turning = parts.cage(material, cage_mass, cage_speed)
    middle, D = bearing.pitch_diameter / 2.0, bearing.ball_diameter
    hoop, nu = turning.growth(middle) / middle, material.poisson_ratio

    def pocket(clearance: Metre, strain: Ratio) -> Metre:
        # the pocket is as wide as ball and clearance
        return clearance + (D + clearance) * strain - D * ball

    axial = design.pocket_axial_clearance
    ring, cage_land, ring_land, land, outward = None, None, None, None, 0.0
    is_wrapped = design.pocket_shape is PocketShape.SPHERICAL
    has_land = design.guidance is not Guidance.BALL and design.land_clearance is not None
    if is_wrapped or has_land:
        ring = parts.strain(bearing.ring_material, "[bearing] ring_material")
        outward = middle * (cage + hoop - ring) if is_wrapped else 0.0
    if ring is not None and has_land and design.land_clearance is not None:
        cage_land, ring_land, land = parts.land(turning, design.land_clearance, cage, ring)
    found = Clearances(
        temperature=T,
        cage_speed=cage_speed,
        pocket_at_rest=design.pocket_clearance,
        pocket=pocket(design.pocket_clearance, cage + hoop),
        pocket_axial_at_rest=axial,
        pocket_axial=None if axial is None else pocket(axial, cage - nu * hoop),
        pocket_radial_offset=outward,
        land_at_rest=design.land_clearance,
        land=land,
        ball_strain=ball,
        ring_strain=ring,
        cage_strain=cage,
        hoop_strain=hoop,
        pitch_radius_growth=middle * (cage + hoop),
        cage_land_growth=cage_land,
        ring_land_growth=ring_land,
        guesses=tuple(parts.guesses),
    )
    if closed := list(_closed(found, material.name)):
        raise together(closed)
    return found


def as_it_runs(design: CageDesign, found: Clearances | None) -> CageDesign:
    """The cage with its clearances as it runs; None where it states these."""
    if found is None:
        return design
    return replace(
        design,
        clearances=ClearanceState.RUNNING,
        pocket_clearance=found.pocket,
        pocket_axial_clearance=found.pocket_axial,
        land_clearance=found.land,
    )


@dataclass(frozen=True, kw_only=True)
class _Parts:
    """Bearing and cage at a temperature, and the guesses made on the way."""

    bearing: BallBearing
    operation: Operation
    design: CageDesign
    temperature: Kelvin
    guesses: list[str] = field(default_factory=list)

    def strain(self, material: Material, where: str) -> Ratio:
        """Thermal strain from 293 K; at 293 K no expansion is needed."""
        if self.temperature == ROOM:
            return 0.0
        found = mean_expansion(material, self.temperature)
        if found is None:
            rule = f"needs its thermal expansion from 293 K to {self.temperature:g} K"
            cure = f'Add thermal_expansion = "12 um/m/K", the mean. {AS_RUNNING}'
            raise InputError(where, rule, material.name, cure)
        alpha, why = found
        if why:
            shown = format_quantity(alpha, "m/m/K", 3)
            self.guesses.append(f"thermal expansion of {where}, {shown} ({why})")
        return alpha * (self.temperature - ROOM)

    def cage(self, material: Material, mass: Kilogram, speed: RadianPerSecond) -> TurningRing:
        """The cage that turns: of its shape, else a thin ring at the pitch circle."""
        shape, density = ring_of(self.design, self.bearing), material.density
        if density is None:
            density = DENSITY if shape is None else mass / shape.volume
            if shape is None and speed != 0.0:
                self.guesses.append(f"density of the cage, {DENSITY:g} kg/m3")
        inner, outer = self.design.inner_diameter, self.design.outer_diameter
        if (inner is None or outer is None) and speed != 0.0:
            self.guesses.append("section of the cage: a thin ring at the pitch circle")
        inner, outer = ((one or self.bearing.pitch_diameter) / 2.0 for one in (inner, outer))
        return TurningRing(inner=inner, outer=outer, material=material, density=density, speed=speed)

    def land(
        self, cage: TurningRing, clearance: Metre, on_cage: Ratio, on_ring: Ratio
    ) -> tuple[Metre, Metre, Metre]:
        """Growth of the land's radius on the cage and on its ring by rotation, and the running clearance.

        From the clearance at rest and the thermal strains of cage and ring.
        """
        design, is_outer = self.design, self.design.guidance is Guidance.OUTER
        own = design.outer_diameter if is_outer else design.inner_diameter
        if own is None and design.land_diameter is None:
            self.guesses.append("diameter of the cage's land: the pitch diameter")
        d = own or design.land_diameter or self.bearing.pitch_diameter
        D = d + clearance if is_outer else d - clearance
        cage_land = cage.growth(d / 2.0 if cage.inner <= d / 2.0 <= cage.outer else cage.outer)
        ring_land = self.ring_growth(D / 2.0, is_outer=is_outer)
        growth = D * on_ring + 2.0 * ring_land - d * on_cage - 2.0 * cage_land
        return cage_land, ring_land, clearance + growth if is_outer else clearance - growth

    def ring_growth(self, land: Metre, *, is_outer: bool) -> Metre:
        """Growth of the land's radius on a ring between its land and its bore, or outside diameter."""
        speed = self.operation.outer_speed if is_outer else self.operation.inner_speed
        if speed == 0.0:
            return 0.0
        material, bore, far = self.bearing.ring_material, self.bearing.bore, land
        if material.density is None:
            cure = f'Add density = "7650 kg/m3" or the like. {AS_RUNNING}'
            rule = "needs a density, for the growth of its land"
            raise InputError("[bearing] ring_material", rule, cure=cure)
        if bore is None:
            self.guesses.append("section of the ring with the land: thin, because the bore is not given")
        elif is_outer:
            far = self.bearing.pitch_diameter - bore / 2.0
            self.guesses.append("outside diameter of the bearing: as far from the pitch diameter as the bore")
        else:
            far = bore / 2.0
        inner, outer = min(far, land), max(far, land)
        ring = TurningRing(inner=inner, outer=outer, material=material, density=material.density, speed=speed)
        return ring.growth(land)


def _closed(found: Clearances, cage: str) -> Iterator[InputError]:
    """Clearances that are gone, each as a line with its numbers."""
    at = f"{found.temperature:g} K and a cage speed of {format_quantity(found.cage_speed, 'rad/s')}"
    strains = f"{cage}: strain {found.cage_strain + found.hoop_strain:.3g}; balls: {found.ball_strain:.3g}"
    lands = f"{cage}: strain {found.cage_strain:.3g}; ring: {found.ring_strain or 0.0:.3g}"
    cure = "Give a larger clearance at 293 K, or another material."
    around = found.pocket - 2.0 * abs(found.pocket_radial_offset)  # a ball in a sphere off its place
    for key, rest, runs, why, least in (
        ("pocket_clearance", found.pocket_at_rest, around, strains, 0.0),
        ("pocket_axial_clearance", found.pocket_axial_at_rest, found.pocket_axial, strains, 1e-9),
        ("land_clearance", found.land_at_rest, found.land, lands, 1e-9),
    ):
        if rest is not None and runs is not None and runs < least:
            rule = f"closes to {format_quantity(runs, 'm')} at {at} ({why})"
            yield InputError(f"[cage] {key}", rule, f"{format_quantity(rest, 'm')} at 293 K", cure)
