"""Cautions about a valid study: outside the range of the model, or of real bearings."""

from __future__ import annotations

import math
from collections.abc import Iterator

from separatrix.ground.units import Kilogram, format_quantity
from separatrix.study.library import contradictions
from separatrix.study.pocket_shape import half_play, tilt
from separatrix.study.study import CageDesign, Guidance, MotionModel, Study

STEEP = 0.5
"""Sine of the lean of a pocket's contact from which the cage is pushed along the axis as well: 30 deg."""

NAMED = 3
"""Materials with the same caution that are named; `check --full` shows all."""

MOST_DN = 3e6
"""Bore in mm times speed in rpm; the fastest turbopump bearings reach about this."""

MOST_RACE_FRICTION = 1.0
"""Dry metals in vacuum reach it; a solid lubricant stays below 0.3."""

POLYMER = (900.0, 2200.0)
"""Densities from polyethylene to filled PTFE [kg/m3]."""

SECTION = ((0.2, 1.1), (0.7, 2.2))
"""Height and width of a cage's section over the ball diameter: the lightest and the heaviest."""


def cautions(study: Study) -> Iterator[str]:
    """Sentences to warn with."""
    cage, operation = study.cage, study.operation
    yield from _materials(study)
    if study.fluid is not None and operation.temperature is not None:
        for sentence in contradictions(study.fluid, operation.temperature):
            yield f"[operation] fluid {sentence}"
    if cage is not None:
        yield from _cage(study, cage)
    yield from beyond_bearings(study)


def _materials(study: Study) -> Iterator[str]:
    """One sentence on materials whose sources state another temperature, or none."""
    acting = [study.bearing.ball_material, study.bearing.ring_material, study.film.body]
    if study.cage is not None and study.cage.ball_cage_stiffness is None:
        candidates = study.ranking.candidates if study.ranking is not None else ()
        acting += [study.cage.material, *(candidate.material for candidate in candidates)]
    alike: dict[tuple[str, ...], list[str]] = {}
    for material in acting:
        if material is not None and material.cautions:
            names = alike.setdefault(material.cautions, [])
            names += [] if material.name in names else [material.name]
    said = []
    for sentences, names in alike.items():
        properties: dict[str, list[str]] = {}  # by their caution
        for sentence in sentences:
            name, _, words = sentence.partition(": ")
            properties.setdefault(words, []).append(name)
        short = "; ".join(f"{', '.join(each)}: {words}" for words, each in properties.items())
        more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
        said.append(f"{', '.join(names[:NAMED])}{more} ({short})")
    if said:
        yield f"Data of the library: {'; '.join(said)}. Consider your own."


def _cage(study: Study, cage: CageDesign) -> Iterator[str]:
    """Sentences on numbers of the land that the study does not state, and on a pocket that leans."""
    assumed = {
        "land_stiffness": format_quantity(cage.land_stiffness, "N/m"),
        "land_restitution": f"{cage.land_restitution:g}",
        "land_friction": f"{cage.land_friction:g}",
    }
    absent = [f"{key} {text}" for key, text in assumed.items() if f"cage.{key}" not in study.origins]
    if absent and cage.guidance is not Guidance.BALL:
        verb = "is assumed: a guess" if len(absent) == 1 else "are assumed: guesses"
        yield f"[cage] {', '.join(absent)} {verb}, on which the motion on the land depends."
    if cage.motion_model is MotionModel.PLANE and abs(tilt(cage)[1]) > STEEP:
        play = format_quantity(half_play(cage), "m", 3)
        yield (
            "[cage] pocket_axial_offset: the contacts lean by more than 30 deg towards the bearing axis; the "
            f"model holds the cage in its plane and keeps only the play along the circumference, +/- {play}."
        )


def beyond_bearings(study: Study) -> Iterator[str]:
    """Sentences on a speed, a race friction or a cage mass that real bearings do not have."""
    bearing, operation, cage, friction = study.bearing, study.operation, study.cage, study.film.race_friction
    rpm = abs(operation.inner_speed - operation.outer_speed) * (30.0 / math.pi)
    if (dn := 1e3 * (bearing.bore or bearing.pitch_diameter) * rpm) > MOST_DN:
        which = "pitch diameter" if bearing.bore is None else "bore"
        yield (
            f"[operation] DN {dn / 1e6:.3g} million ({which} in mm times speed in rpm) exceeds "
            f"{MOST_DN / 1e6:g} million: no ball bearing is known to run so fast."
        )
    if friction > MOST_RACE_FRICTION:
        yield (
            f"[film] race_friction {friction:g} exceeds {MOST_RACE_FRICTION:g}: solid lubricants stay below "
            "0.3, dry metal below about 1."
        )
    low, high = plausible_cage_masses(study)
    if cage is not None and cage.mass is not None and not low <= cage.mass <= high:
        named = cage.material is not None and cage.material.density is not None
        what = f"a ring of {cage.material.name}" if named and cage.material else "a polymer ring"
        (thin, narrow), (thick, wide) = SECTION
        yield (
            f"[cage] mass {format_quantity(cage.mass, 'kg')} does not fit the bearing: {what} around these "
            f"balls, {thin:g} to {thick:g} ball diameters high and {narrow:g} to {wide:g} wide, has "
            f"{format_quantity(low, 'kg', 2)} to {format_quantity(high, 'kg', 2)}."
        )


def plausible_cage_masses(study: Study) -> tuple[Kilogram, Kilogram]:
    """Least and largest mass of a ring around the balls, of its material's density or of a polymer's.

    Its volume is that of a ring at the pitch circle less a hole for each ball.
    """
    material = study.cage.material if study.cage is not None else None
    density = material.density if material is not None else None
    masses, D, bearing = [], study.bearing.ball_diameter, study.bearing
    for rho, (height, width) in zip(POLYMER if density is None else (density, density), SECTION, strict=True):
        full = math.pi * bearing.pitch_diameter * width * D
        volume = max(full - bearing.ball_count * math.pi / 4.0 * D**2, 0.25 * full) * height * D
        masses.append(rho * volume)
    return masses[0], masses[1]
