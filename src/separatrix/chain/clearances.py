r"""Clearances of the cage at temperature and speed, from those of its parts at 293 K at rest.

Every part is isotropic, free of stress before it turns, and at one temperature (docs/theory/clearances.md).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from separatrix.ground.errors import InputError, together
from separatrix.ground.units import (
    Kelvin,
    Kilogram,
    KilogramPerMetre3,
    Metre,
    Pascal,
    PerKelvin,
    RadianPerSecond,
    Ratio,
    format_quantity,
)
from separatrix.study.ball_bearing import ROOM, BallBearing, Material
from separatrix.study.cage_body import ring_of
from separatrix.study.cage_design import CageDesign, ClearanceState, Guidance
from separatrix.study.study import Operation

NEAR: Kelvin = 10.0
"""An expansion serves this far beyond the temperatures that its source states."""

DENSITY: KilogramPerMetre3 = 1500.0
"""Of a cage whose density is not known: between PEEK (1300) and filled PTFE (2200)."""

AT_ROOM = "is missing: [cage] clearances are those at 293 K"
AS_RUNNING = 'Or state the running clearances: clearances = "as running".'


@dataclass(frozen=True, slots=True, kw_only=True)
class Clearances:
    """Clearances of the cage as it runs, and the growth of the parts behind them.

    Attributes
    ----------
    temperature, cage_speed : float
        Of all parts [K], and the mean orbital speed of the balls [rad/s].
    pocket_at_rest, pocket : float
        Clearance along the circumference, stop to stop, at 293 K at rest and as it runs [m].
    pocket_axial_at_rest, pocket_axial : float or None
        The same along the axis, of an elongated pocket [m].
    land_at_rest, land : float or None
        Diametral clearance of the land, None without one [m].
    ball_strain, ring_strain, cage_strain : float
        Thermal strain from 293 K; None for a ring without the land of the cage [-].
    hoop_strain : float
        Of the cage's pitch circle by its rotation [-].
    pitch_radius_growth : float
        Of the cage, by both [m].
    cage_land_growth, ring_land_growth : float or None
        Of the radius of the cage's land and of the ring's, by their rotation [m].
    guesses : tuple of str
        Numbers behind the clearances that no source states.
    """

    temperature: Kelvin
    cage_speed: RadianPerSecond
    pocket_at_rest: Metre
    pocket: Metre
    pocket_axial_at_rest: Metre | None
    pocket_axial: Metre | None
    land_at_rest: Metre | None
    land: Metre | None
    ball_strain: Ratio
    ring_strain: Ratio | None
    cage_strain: Ratio
    hoop_strain: Ratio
    pitch_radius_growth: Metre
    cage_land_growth: Metre | None
    ring_land_growth: Metre | None
    guesses: tuple[str, ...]

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


def ring_growth(
    radius: Metre,
    *,
    inner: Metre,
    outer: Metre,
    density: KilogramPerMetre3,
    elastic_modulus: Pascal,
    poisson_ratio: Ratio,
    speed: RadianPerSecond,
) -> Metre:
    r"""Radial displacement in a ring that turns freely, in plane stress (Lame).

    .. math::
        u = \frac{\rho\omega^2 r}{E}\frac{(3+\nu)(1-\nu)}{8}\left[a^2 + b^2
        + \frac{1+\nu}{1-\nu}\frac{a^2b^2}{r^2} - \frac{1+\nu}{3+\nu}r^2\right]

    Parameters
    ----------
    radius : float
        Where the displacement is wanted, from `inner` to `outer` [m].
    inner, outer : float
        Radii of the ring; alike for a thin one, which grows by rho w^2 r^3 / E [m].
    """
    a, b, r, nu = inner, outer, radius, poisson_ratio
    shape = a * a + b * b + (1.0 + nu) / (1.0 - nu) * (a * b / r) ** 2 - (1.0 + nu) / (3.0 + nu) * r * r
    return density * speed**2 * r / elastic_modulus * (3.0 + nu) * (1.0 - nu) / 8.0 * shape


def running_clearances(
    bearing: BallBearing,
    operation: Operation,
    design: CageDesign,
    material: Material | None,
    *,
    cage_mass: Kilogram,
    cage_speed: RadianPerSecond,
) -> Clearances:
    """Clearances of a cage as it runs, from those of `design` at 293 K at rest.

    Parameters
    ----------
    material : Material or None
        Of the cage.
    cage_speed : float
        Mean orbital speed of the balls [rad/s].

    Raises
    ------
    InputError
        The temperature or the expansion of a part is not known, or a clearance closes.
    """
    T, guesses = operation.temperature, list[str]()
    if T is None:
        cure = f"Give it. {AS_RUNNING}"
        raise InputError("[operation] temperature", AT_ROOM, cure=cure)
    if material is None:
        cure = f"Give it, with its thermal_expansion. {AS_RUNNING}"
        raise InputError("[cage] material", AT_ROOM, cure=cure)
    ball = _strain(bearing.ball_material, T, "[bearing] ball_material", guesses)
    cage = _strain(material, T, "[cage] material", guesses)
    turning = _Turning.of_cage(bearing, design, material, cage_mass, cage_speed, guesses)
    middle, D = bearing.pitch_diameter / 2.0, bearing.ball_diameter
    hoop, nu = turning.growth(middle) / middle, material.poisson_ratio

    def pocket(clearance: Metre, strain: Ratio) -> Metre:
        # the pocket is as wide as ball and clearance
        return clearance + (D + clearance) * strain - D * ball

    axial = design.pocket_axial_clearance
    ring, cage_land, ring_land, land = None, None, None, None
    if design.guidance is not Guidance.BALL and design.land_clearance is not None:
        ring = _strain(bearing.ring_material, T, "[bearing] ring_material", guesses)
        cage_land, ring_land, land = _land(bearing, operation, design, turning, (cage, ring), guesses)
    found = Clearances(
        temperature=T,
        cage_speed=cage_speed,
        pocket_at_rest=design.pocket_clearance,
        pocket=pocket(design.pocket_clearance, cage + hoop),
        pocket_axial_at_rest=axial,
        pocket_axial=None if axial is None else pocket(axial, cage - nu * hoop),
        land_at_rest=design.land_clearance,
        land=land,
        ball_strain=ball,
        ring_strain=ring,
        cage_strain=cage,
        hoop_strain=hoop,
        pitch_radius_growth=middle * (cage + hoop),
        cage_land_growth=cage_land,
        ring_land_growth=ring_land,
        guesses=tuple(guesses),
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


def _strain(material: Material, temperature: Kelvin, where: str, guesses: list[str]) -> Ratio:
    """Thermal strain from 293 K; at 293 K no expansion is needed."""
    if temperature == ROOM:
        return 0.0
    found = mean_expansion(material, temperature)
    if found is None:
        rule = f"needs its thermal expansion from 293 K to {temperature:g} K"
        cure = f'Add thermal_expansion = "12 um/m/K", the mean. {AS_RUNNING}'
        raise InputError(where, rule, material.name, cure)
    alpha, why = found
    if why:
        shown = format_quantity(alpha, "m/m/K", 3)
        guesses.append(f"thermal expansion of {where}, {shown} ({why})")
    return alpha * (temperature - ROOM)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Turning:
    """A ring that turns."""

    inner: Metre
    outer: Metre
    material: Material
    density: KilogramPerMetre3
    speed: RadianPerSecond

    @staticmethod
    def of_cage(
        bearing: BallBearing,
        design: CageDesign,
        material: Material,
        mass: Kilogram,
        speed: RadianPerSecond,
        guesses: list[str],
    ) -> _Turning:
        """The cage: of its shape, else a thin ring at the pitch circle."""
        shape, density = ring_of(design, bearing), material.density
        if density is None:
            density = DENSITY if shape is None else mass / shape.volume
            if shape is None and speed != 0.0:
                guesses.append(f"density of the cage, {DENSITY:g} kg/m3")
        inner, outer = design.inner_diameter, design.outer_diameter
        if (inner is None or outer is None) and speed != 0.0:
            guesses.append("section of the cage: a thin ring at the pitch circle")
        return _Turning(
            inner=(inner or bearing.pitch_diameter) / 2.0,
            outer=(outer or bearing.pitch_diameter) / 2.0,
            material=material,
            density=density,
            speed=speed,
        )

    def growth(self, radius: Metre) -> Metre:
        """Radial growth by the rotation."""
        E, nu = self.material.elastic_modulus, self.material.poisson_ratio
        size = {"inner": self.inner, "outer": self.outer, "elastic_modulus": E, "poisson_ratio": nu}
        return ring_growth(radius, density=self.density, speed=self.speed, **size)


def _land(
    bearing: BallBearing,
    operation: Operation,
    design: CageDesign,
    cage: _Turning,
    strains: tuple[Ratio, Ratio],
    guesses: list[str],
) -> tuple[Metre, Metre, Metre]:
    """Growth of the land's radius on the cage and on its ring by rotation, and the running clearance."""
    is_outer, c = design.guidance is Guidance.OUTER, design.land_clearance or 0.0
    own = design.outer_diameter if is_outer else design.inner_diameter
    if own is None and design.land_diameter is None:
        guesses.append("diameter of the cage's land: the pitch diameter")
    d = own or design.land_diameter or bearing.pitch_diameter
    D = d + c if is_outer else d - c
    on_cage = cage.growth(d / 2.0 if cage.inner <= d / 2.0 <= cage.outer else cage.outer)
    on_ring = _ring_growth(bearing, operation, D / 2.0, guesses, is_outer=is_outer)
    growth = D * strains[1] + 2.0 * on_ring - d * strains[0] - 2.0 * on_cage
    return on_cage, on_ring, c + growth if is_outer else c - growth


def _ring_growth(
    bearing: BallBearing, operation: Operation, land: Metre, guesses: list[str], *, is_outer: bool
) -> Metre:
    """Growth of the land's radius on a ring; a ring between its land and its bore, or outside diameter."""
    speed = operation.outer_speed if is_outer else operation.inner_speed
    if speed == 0.0:
        return 0.0
    material, bore = bearing.ring_material, bearing.bore
    if material.density is None:
        cure = f'Add density = "7650 kg/m3" or the like. {AS_RUNNING}'
        raise InputError("[bearing] ring_material", "needs a density, for the growth of its land", cure=cure)
    far = land
    if bore is None:
        guesses.append("section of the ring with the land: thin, because the bore is not given")
    else:
        far = bearing.pitch_diameter - bore / 2.0 if is_outer else bore / 2.0
        if is_outer:
            guesses.append("outside diameter of the bearing: as far from the pitch diameter as the bore")
    return _Turning(
        inner=min(far, land), outer=max(far, land), material=material, density=material.density, speed=speed
    ).growth(land)


def _closed(found: Clearances, cage: str) -> Iterator[InputError]:
    """Clearances that are gone, each as a line with its numbers."""
    at = f"{found.temperature:g} K and a cage speed of {format_quantity(found.cage_speed, 'rad/s')}"
    strains = f"{cage}: strain {found.cage_strain + found.hoop_strain:.3g}; balls: {found.ball_strain:.3g}"
    lands = f"{cage}: strain {found.cage_strain:.3g}; ring: {found.ring_strain or 0.0:.3g}"
    cure = "Give a larger clearance at 293 K, or another material."
    for key, rest, runs, why, least in (
        ("pocket_clearance", found.pocket_at_rest, found.pocket, strains, 0.0),
        ("pocket_axial_clearance", found.pocket_axial_at_rest, found.pocket_axial, strains, 1e-9),
        ("land_clearance", found.land_at_rest, found.land, lands, 1e-9),
    ):
        if rest is not None and runs is not None and runs < least:
            rule = f"closes to {format_quantity(runs, 'm')} at {at} ({why})"
            yield InputError(f"[cage] {key}", rule, f"{format_quantity(rest, 'm')} at 293 K", cure)
