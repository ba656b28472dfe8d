"""Warnings on a valid study: beyond the range of the model, or of real bearings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from separatrix.library.fluids import contradictions
from separatrix.pocket_shape import half_play, tilt
from separatrix.study import Guidance, Material, Study
from separatrix.units import Kilogram, format_quantity

LONGEST, JUDGED_FROM = 4, 3.2
"""Durations that a run may go on for (`cage.ending`), and after which such a run is judged: a fifth less."""

STEEP = 0.5
"""Sine of the lean of a pocket's contact from which the cage is pushed along the axis as well: 30 deg."""


def cautions(study: Study) -> Iterator[str]:
    """Sentences to warn with."""
    yield from _ramp(study)
    yield from _materials(study)
    yield from _fluid(study)
    yield from _land(study)
    yield from _leaning_pocket(study)
    yield from beyond_bearings(study)


def _ramp(study: Study) -> Iterator[str]:
    ramp, duration = study.operation.ramp_time, study.stability.duration
    if study.cage is not None and ramp > JUDGED_FROM * duration:
        given, run = format_quantity(ramp, "s"), format_quantity(duration, "s")
        yield (
            f"[operation] ramp_time {given}: runs of {run}, or up to {LONGEST} times that, are judged before "
            "full speed is reached. Give [stability] a longer duration."
        )


NAMED = 3
"""Materials of which the same is said that are named; `check --full` shows all."""


def _some(names: Sequence[str]) -> str:
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(names[:NAMED]) + more


def _materials(study: Study) -> Iterator[str]:
    """One sentence on the data of materials whose sources state another temperature, or none."""
    alike: dict[tuple[str, ...], dict[str, None]] = {}
    for material in _acting(study):
        if material.cautions:
            alike.setdefault(material.cautions, {})[material.name] = None
    if alike:
        each = (f"{_some(list(names))} ({_short(cautions)})" for cautions, names in alike.items())
        yield f"Data of the library: {'; '.join(each)}. Consider your own."


def _short(cautions: Sequence[str]) -> str:
    """Cautions that differ only in the property, which stands before the colon, as one."""
    properties: dict[str, list[str]] = {}
    for caution in cautions:
        name, _, words = caution.partition(": ")
        properties.setdefault(words, []).append(name)
    return "; ".join(f"{', '.join(names)}: {words}" for words, names in properties.items())


def _acting(study: Study) -> Iterator[Material]:
    """Materials on whose numbers an answer depends."""
    yield study.bearing.ball_material
    yield study.bearing.ring_material
    if study.film.material is not None:
        yield study.film.material
    if study.cage is None or study.cage.ball_cage_stiffness is not None:
        return
    if study.cage.material is not None:
        yield study.cage.material
    for candidate in study.ranking.candidates if study.ranking is not None else ():
        if candidate.material is not None:
            yield candidate.material


def _fluid(study: Study) -> Iterator[str]:
    """A fluid that cannot be what its name says at the temperature of the study."""
    record, temperature = study.records.get("operation.fluid"), study.operation.temperature
    if record is not None and temperature is not None:
        yield from (f"[operation] fluid {sentence}" for sentence in contradictions(record, temperature))


def _land(study: Study) -> Iterator[str]:
    """Numbers of the land that the study does not state: the defaults are guesses, not data of this cage."""
    cage = study.cage
    if cage is None or cage.guidance is Guidance.BALL:
        return
    assumed = {
        "land_stiffness": format_quantity(cage.land_stiffness, "N/m"),
        "land_restitution": f"{cage.land_restitution:g}",
        "land_friction": f"{cage.land_friction:g}",
    }
    absent = [f"{key} {text}" for key, text in assumed.items() if f"cage.{key}" not in study.origins]
    if absent:
        verb = "is" if len(absent) == 1 else "are"
        yield f"[cage] {', '.join(absent)} {verb} assumed: guesses, on which the motion on the land depends."


def _leaning_pocket(study: Study) -> Iterator[str]:
    if study.cage is None or abs(tilt(study.cage)[1]) <= STEEP:
        return
    play = format_quantity(half_play(study.cage), "m", 3)
    yield (
        "[cage] pocket_axial_offset: the contacts lean by more than 30 deg towards the bearing axis; the "
        f"model holds the cage in its plane and keeps only the play along the circumference, +/- {play}."
    )


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
