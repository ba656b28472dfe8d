"""Numbers of a study beyond those of real bearings: said with their limit, and answered all the same."""

from __future__ import annotations

import math
from collections.abc import Iterator

from separatrix.study import Study
from separatrix.units import Kilogram, format_quantity

MOST_DN = 3e6
"""Bore in mm times speed in rpm; the fastest turbopump bearings reach about this."""

MOST_RACE_FRICTION = 1.0
"""Dry metals in vacuum reach it; a solid lubricant stays below 0.3."""

POLYMER = (900.0, 2200.0)
"""Densities from polyethylene to filled PTFE [kg/m3]."""

SECTION = ((0.2, 1.1), (0.7, 2.2))
"""Height and width of a cage's section over the ball diameter: the lightest and the heaviest."""

_SPEED = 1e3 * 30.0 / math.pi


def beyond_bearings(study: Study) -> Iterator[str]:
    """Sentences to warn with."""
    yield from _fast(study)
    friction = study.film.race_friction
    if friction > MOST_RACE_FRICTION:
        yield (
            f"[film] race_friction {friction:g} exceeds {MOST_RACE_FRICTION:g}: solid lubricants stay below "
            "0.3, dry metal below about 1."
        )
    yield from _cage_mass(study)


def _fast(study: Study) -> Iterator[str]:
    bearing, operation = study.bearing, study.operation
    diameter = bearing.bore or bearing.pitch_diameter
    dn = diameter * abs(operation.inner_speed - operation.outer_speed) * _SPEED
    if dn > MOST_DN:
        which = "pitch diameter" if bearing.bore is None else "bore"
        yield (
            f"[operation] DN {dn / 1e6:.3g} million ({which} in mm times speed in rpm) exceeds "
            f"{MOST_DN / 1e6:g} million: no ball bearing is known to run so fast."
        )


def _cage_mass(study: Study) -> Iterator[str]:
    cage = study.cage
    if cage is None:
        return
    low, high = plausible_cage_masses(study)
    if not low <= cage.mass <= high:
        named = cage.material is not None and cage.material.density is not None
        what = f"a ring of {cage.material.name}" if named and cage.material else "a polymer ring"
        (thin, narrow), (thick, wide) = SECTION
        yield (
            f"[cage] mass {format_quantity(cage.mass, 'kg')} does not fit the bearing: {what} around these "
            f"balls, {thin:g} to {thick:g} ball diameters high and {narrow:g} to {wide:g} wide, has "
            f"{format_quantity(low, 'kg', 2)} to {format_quantity(high, 'kg', 2)}."
        )


def plausible_cage_masses(study: Study) -> tuple[Kilogram, Kilogram]:
    """Least and largest mass of a ring around the balls, of its material's density or of a polymer's."""
    material = study.cage.material if study.cage is not None else None
    density = material.density if material is not None else None
    low, high = POLYMER if density is None else (density, density)
    light, heavy = (_ring_volume(study, height, width) for height, width in SECTION)
    return low * light, high * heavy


def _ring_volume(study: Study, height: float, width: float) -> float:
    """Volume of a ring at the pitch circle less a hole for each ball; sizes over the ball diameter [m3]."""
    D, bearing = study.bearing.ball_diameter, study.bearing
    full = math.pi * bearing.pitch_diameter * width * D
    return max(full - bearing.ball_count * math.pi / 4.0 * D**2, 0.25 * full) * height * D
