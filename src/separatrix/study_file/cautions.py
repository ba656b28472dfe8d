"""What a valid study asks of the model beyond the range where it is good: said, and answered all the same."""

from __future__ import annotations

from collections.abc import Iterator

from separatrix.pocket_shape import half_play, tilt
from separatrix.study import Study
from separatrix.units import format_quantity

JUDGED_FROM = 0.8
"""Share of a run after which its growth is judged."""

STEEP = 0.5
"""Sine of the lean of a pocket's contact from which the cage is pushed along the axis as well: 30 deg."""


def cautions(study: Study) -> Iterator[str]:
    """Sentences to warn with."""
    yield from _ramp(study)
    yield from _leaning_pocket(study)


def _ramp(study: Study) -> Iterator[str]:
    ramp, duration = study.operation.ramp_time, study.stability.duration
    if study.cage is not None and ramp > JUDGED_FROM * duration:
        given, run = format_quantity(ramp, "s"), format_quantity(duration, "s")
        yield (
            f"[operation] ramp_time {given}: runs of {run} are judged over their last fifth, before full "
            "speed is reached. Give [stability] a longer duration."
        )


def _leaning_pocket(study: Study) -> Iterator[str]:
    if study.cage is None or abs(tilt(study.cage)[1]) <= STEEP:
        return
    play = format_quantity(half_play(study.cage), "m", 3)
    yield (
        "[cage] pocket_axial_offset: the contacts lean by more than 30 deg towards the bearing axis; the "
        f"model holds the cage in its plane and keeps only the play along the circumference, +/- {play}."
    )
