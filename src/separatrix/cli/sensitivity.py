"""The verb `sensitivity`: verdicts over the uncertain inputs, what decides them, what to test next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from separatrix.errors import InputError

if TYPE_CHECKING:
    from separatrix.answers import SensitivityAnswer
    from separatrix.runner import Runner
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

    def compute(self, study: Study, runner: Runner) -> SensitivityAnswer:
        """Answer the verb."""
        from separatrix.verbs import sensitivity

        return sensitivity(study, self.samples, runner)
