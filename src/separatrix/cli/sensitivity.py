"""The verb `sensitivity`: verdicts over the uncertain inputs, what decides them, what to test next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.errors import InputError

if TYPE_CHECKING:
    from separatrix.answers import SensitivityAnswer
    from separatrix.cli.answers import Work
    from separatrix.study import Study

SAMPLES = 512
FEWEST, MOST = 64, 65_536


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityOptions:
    """What follows the verb.

    Raises
    ------
    InputError
        It is not a sensible number of bearings.
    """

    samples: int = SAMPLES

    def __post_init__(self) -> None:
        if not FEWEST <= self.samples <= MOST or self.samples.bit_count() != 1:
            near = 1 << max(0, self.samples - 1).bit_length()
            cure = f"Try {min(max(near, FEWEST), MOST)}."
            rule = f"must be a power of two from {FEWEST} to {MOST}"
            raise InputError("--samples", rule, got=str(self.samples), cure=cure)

    def compute(self, study: Study, work: Work) -> SensitivityAnswer:
        """Answer the verb."""
        return sensitivity(study, work, self.samples)


def sensitivity(study: Study, work: Work, samples: int = SAMPLES) -> SensitivityAnswer:
    """Draw bearings from the uncertain inputs and judge the cages of every candidate."""
    from separatrix.answers import SensitivityAnswer
    from separatrix.cage_choice import reference_candidate, reference_friction, required_environment
    from separatrix.chain import cage_state
    from separatrix.cli.expected import expected_uncertain
    from separatrix.draws import uncertain_inputs
    from separatrix.explore import uncertain_study
    from separatrix.ranking import ranking_question
    from separatrix.ranking.friction import as_pockets_see, cage_seen

    asked = ranking_question(study)
    required_environment(study, asked)
    seen = cage_seen(study, marked=True)
    own = reference_candidate(study, asked)
    state = cage_state(seen, material=own.material, friction=reference_friction(seen, asked))
    uncertain_inputs(as_pockets_see(study))  # refused before anything is timed
    work.expect(lambda: expected_uncertain(study, samples, jobs=work.jobs))
    found = uncertain_study(study, samples, jobs=work.jobs, progress=work.progress, ledger=work.ledger)
    film = study.film
    return SensitivityAnswer(
        cage=state, uncertain=found, film_thickness=film.thickness, race_friction=film.race_friction
    )
