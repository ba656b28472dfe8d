"""What a valid study asks of the model beyond the range where it is good: said, and answered all the same."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from separatrix.library.fluids import contradictions
from separatrix.pocket_shape import half_play, tilt
from separatrix.study import Guidance, Material, Study
from separatrix.study_file.plausible import beyond_bearings
from separatrix.units import format_quantity

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
