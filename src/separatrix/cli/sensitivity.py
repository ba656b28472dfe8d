"""The verb `sensitivity`: probabilities of stable and of best, sources of uncertainty, what to test next."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING

from separatrix.errors import InputError

if TYPE_CHECKING:
    from separatrix.chain import CageState
    from separatrix.cli.answers import Work
    from separatrix.sensitivity import (
        AllowedFriction,
        Evidence,
        NextTest,
        Question,
        SobolAnswer,
        StableRegion,
    )
    from separatrix.stability.pool import Progress
    from separatrix.study import Study
    from separatrix.uncertainty.answer import Sampled
    from separatrix.uncertainty.model import Model
    from separatrix.uncertainty.records import UncertainRanking
    from separatrix.units import Array

SAMPLES = 4096
FEWEST, MOST = 64, 65_536

DESIGN = 1024
"""Samples of each matrix behind the Sobol indices and the next test."""

FITTED = 1024
"""Samples of the chain that its fit takes; its error is told by leaving each of them out."""

INVERSE = 512
"""Samples behind the inverse answers; a film's are asked at every point of its plane."""

STAGES = {
    "boundary": 0.25,
    "surrogate": 0.25,
    "chain": 0.2,
    "verdicts": 0.05,
    "evidence": 0.15,
    "drivers": 0.1,
}
"""Parts of the work, and what share of the time each takes, roughly."""

STEPS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Doubt:
    """The main sources of uncertainty, which test to run next, and the inverse answers."""

    sobol: SobolAnswer
    next_test: NextTest
    allowed_friction: tuple[AllowedFriction, ...]
    films: tuple[StableRegion, ...]
    films_reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityAnswer:
    """The uncertain ranking, single runs and the doubt behind it, and the first cage.

    Evidence and doubt are None if an interrupt left them out.
    """

    cage: CageState
    ranking: UncertainRanking
    evidence: Evidence | None
    doubt: Doubt | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SensitivityOptions:
    """What follows the verb.

    Raises
    ------
    InputError
        It is not a sensible number of samples.
    """

    samples: int = SAMPLES

    def __post_init__(self) -> None:
        if not FEWEST <= self.samples <= MOST or self.samples.bit_count() != 1:
            near = 1 << max(0, self.samples - 1).bit_length()
            cure = f"Try {min(max(near, FEWEST), MOST)}."
            rule = f"must be a power of two from {FEWEST} to {MOST}"
            raise InputError("--samples", rule, value=str(self.samples), cure=cure)

    def compute(self, study: Study, work: Work) -> SensitivityAnswer:
        """Answer the verb."""
        return sensitivity(study, work, self.samples)


def sensitivity(study: Study, work: Work, samples: int = SAMPLES) -> SensitivityAnswer:
    """Sample the study through the chain; the sources of uncertainty follow from the same model.

    Raises
    ------
    KeyboardInterrupt
        Interrupted before the probabilities were there; later they are the answer.
    """
    from separatrix.cage_choice import reference_candidate, reference_friction
    from separatrix.chain import cage_state
    from separatrix.ranking import ranking_question
    from separatrix.ranking.friction import cage_seen
    from separatrix.sensitivity import evidence_of
    from separatrix.uncertainty.answer import uncertain_ranking

    asked, seen = ranking_question(study), cage_seen(study, marked=True)
    own = reference_candidate(study, asked)
    state = cage_state(seen, material=own.material, friction=reference_friction(seen, asked))
    stop = Event()
    stage = stages(work.progress)
    ranking, model, found = uncertain_ranking(study, samples, jobs=work.jobs, stage=stage, stop=stop)
    evidence, doubt = None, None
    with contextlib.suppress(KeyboardInterrupt):
        evidence = evidence_of(model, jobs=work.jobs, progress=stage("evidence"))
        doubt = doubt_of(model, found, stage("drivers"))
    return SensitivityAnswer(cage=state, ranking=ranking, evidence=evidence, doubt=doubt)


def stages(progress: Progress | None) -> Callable[[str], Progress | None]:
    """Return what gives each stage its part of one progress."""
    starts, total = {}, 0.0
    for name, share in STAGES.items():
        starts[name] = total
        total += share

    def stage(name: str) -> Progress | None:
        if progress is None:
            return None
        begun, told = STEPS * starts[name], progress

        def part(done: int, of: int) -> None:
            told(round(begun + STEPS * STAGES[name] * done / max(of, 1)), STEPS)

        part(0, 1)
        return part

    return stage


def doubt_of(model: Model, found: Sampled, progress: Progress | None) -> Doubt:
    """Sobol indices, next test and inverse answers of the model behind a ranking."""
    from separatrix import sensitivity as doubts

    told = progress or (lambda _done, _of: None)
    question, error = doubts.fitted_to(model, found.values[:FITTED], found.factor[:FITTED])
    design = doubts.sampled_design(question, DESIGN, seed=model.study.stability.seed)
    told(1, 4)
    sobol = doubts.indices_of(question, design)
    tests = doubts.default_measurements(question, reducible=doubts.reducible_shares(model))
    following = doubts.next_test(question, design, tests)
    told(2, 4)
    some = doubts.sampled_values(question, INVERSE, seed=model.study.stability.seed)
    ranking = model.study.ranking
    scatter = ranking.friction_scatter if ranking else 0.0
    allowed = doubts.allowed_friction(question, some, scatter=scatter)
    told(3, 4)
    films, reason = _films(model, question, some)
    told(4, 4)
    return Doubt(
        sobol=sobol if error is None else doubts.with_fit_error(sobol, error),
        next_test=following,
        allowed_friction=allowed,
        films=films,
        films_reason=reason,
    )


def _films(model: Model, question: Question, values: Array) -> tuple[tuple[StableRegion, ...], str]:
    """Which films keep each case stable; the reason if there is no film to choose."""
    from separatrix import sensitivity as doubts
    from separatrix.cage_choice import reference_candidate
    from separatrix.chain import restitution_state
    from separatrix.ranking import ranking_question

    if model.study.film.material is None:
        return (), "The races are bare: there is no film to choose."
    own = reference_candidate(model.study, ranking_question(model.study))
    grid = doubts.friction_grid(model.study, restitution_state(model.study, material=own.material))
    return doubts.stable_regions(question, values, grid), ""
