"""`sensitivity`: draw bearings from the uncertain inputs and judge the cages of every candidate."""

from __future__ import annotations

from separatrix.ground.errors import InputError
from separatrix.study.study import Study
from separatrix.verbs import answer_records as answers
from separatrix.verbs.parts.cage_of_study import (
    reference,
)
from separatrix.verdict.drawn_frictions import frictions_to_draw
from separatrix.verdict.draws import uncertain_inputs
from separatrix.verdict.input_shares import uncertain_study
from separatrix.verdict.long_jobs import Runner, made_into

SAMPLES, FEWEST_SAMPLES, MOST_SAMPLES = 512, 64, 65_536
"""Bearings that `sensitivity` draws."""


def compute(study: Study, runner: Runner, *, samples: int = SAMPLES) -> answers.SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate.

    Parameters
    ----------
    samples : int
        Bearings drawn, a power of two.
    """
    if not FEWEST_SAMPLES <= samples <= MOST_SAMPLES or samples.bit_count() != 1:
        near = 1 << max(0, samples - 1).bit_length()
        cure = f"Try {min(max(near, FEWEST_SAMPLES), MOST_SAMPLES)}."
        rule = f"must be a power of two from {FEWEST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("--samples", rule, got=str(samples), cure=cure)
    solution, cage = reference(study)
    uncertain_inputs(study, frictions_to_draw(study))  # refused before anything is timed
    return made_into(
        lambda found: answers.SensitivityAnswer(
            solution=solution,
            cage=cage,
            uncertain=found,
            film_thickness=study.film.thickness,
            race_friction=study.film.race_friction,
            notes=(*solution.notes, *cage.notes, *found.notes),
        ),
        lambda: uncertain_study(study, samples, runner=runner),
    )
