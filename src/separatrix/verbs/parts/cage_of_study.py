"""The cage that a study asks about, what a user must know of it, and what no cage is computed of.

What the chain refuses is found in a second, for the verbs that need it and for `check`: a link solved with
strips takes milliseconds; of the exact contact only what refuses it is computed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from separatrix.cage import MovingCage, moving_cage
from separatrix.chain.exact.rolling import rolling_contact
from separatrix.chain.heat_balance import heat_balance
from separatrix.chain.impact_restitution import Restitution
from separatrix.chain.race_traction import contact_problem
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import MetrePerSecond, format_quantity, parse
from separatrix.study import candidates
from separatrix.study.study import LEAST_KICK, MOST_KICK, NO_KICK, Study, TractionModel, TractionSettings

if TYPE_CHECKING:
    from separatrix.verbs.cage_answers import OfCage

Found = TypeVar("Found")
Answer = TypeVar("Answer", bound="OfCage")

MOST_RUNS = 1_000_000
FEWEST_SAMPLES, MOST_SAMPLES = 64, 65_536
"""Bearings that are drawn."""

COARSE = 8
"""Cells along and across in which an exact contact is put for its refusals."""


def cage_of(solution: Solution) -> MovingCage:
    """Cage of an answer; without friction where none is known."""
    return moving_cage(solution, solution.friction.mean if solution.friction else 0.0)


def reference(study: Study) -> Solution:
    """Return the chain of the candidate that a ranking is computed for first."""
    asked = candidates.ranking_question(study)
    candidates.required_environment(study, asked)
    return solve(study, candidates.reference_candidate(study, asked))


def answer_of_cage(
    kind: type[Answer], name: str, solution: Solution, compute: Callable[[], Found], *notes: str
) -> Answer:
    """Return the answer about a cage whose field `name` a long job computes, also what an interrupt left.

    Its notes are those of the result, of chain and cage, and `notes`.
    """
    from separatrix.verdict.long_jobs import made_into

    cage = cage_of(solution)

    def made(found: Any) -> Answer:
        every = (*found.notes, *solution.notes, *cage.notes, *notes)
        return kind(solution=solution, cage=cage, notes=every, **{name: found})

    return made_into(made, compute)


def refuse_outside(option: str, value: float, low: float, high: float) -> None:
    """Refuse a number of an option that does not lie between two others."""
    if not low <= value <= high:
        raise InputError(option, f"must lie between {low:g} and {high:.7g}", got=f"{value:.7g}")


def refuse_samples(samples: int) -> None:
    """Refuse a number of bearings to draw that is not a power of two, or too small or large."""
    if not FEWEST_SAMPLES <= samples <= MOST_SAMPLES or samples.bit_count() != 1:
        near = 1 << max(0, samples - 1).bit_length()
        cure = f"Try {min(max(near, FEWEST_SAMPLES), MOST_SAMPLES)}."
        rule = f"must be a power of two from {FEWEST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("--samples", rule, got=str(samples), cure=cure)


def kick_speed(kick: str | MetrePerSecond) -> MetrePerSecond:
    """Speed of a kick that a study may have, from text with a unit or a number [m/s]."""
    speed = parse(kick, "m/s", "--kick") if isinstance(kick, str) else float(kick)
    if not LEAST_KICK < speed < MOST_KICK:
        rule = f"must be > {LEAST_KICK:g} and < {MOST_KICK:g} [m/s]"
        raise InputError("--kick", rule, f"{speed:g}", NO_KICK)
    return speed


def extrapolation_notes(solution: Solution) -> tuple[str, ...]:
    """A sentence where the friction of the cage comes from tests at other conditions."""
    friction, own = solution.friction, candidates.cage_candidate(solution.study)
    if friction is not None and own is not None and friction.law is not None and friction.extrapolation:
        ranking = solution.study.ranking
        place = candidates.environment_of(ranking) if ranking else ""
        return (
            f"Pocket friction {friction.mean:.3g} of {own.name} in {place}, extrapolated beyond the "
            f"tests: {'; '.join(friction.extrapolation)}. [cage] ball_cage_friction overrides it.",
        )
    return ()


def overdamped_notes(found: Restitution) -> tuple[str, ...]:
    """A sentence where the races brake a ball so much that an impact returns nothing."""
    if found.restitution_factor != 0.0:
        return ()
    damping, least = (format_quantity(c, "N s/m", 3) for c in (found.race_damping, found.least_damping))
    return (
        f"eta = 0: impacts are overdamped, because C_mu = {damping} is below the limit sqrt(k_BC M_C)/2 "
        f"= {least}; every material whose cage has this k_BC and M_C has its full threshold as margin. "
        "C_mu falls as race friction falls and as speed rises. Test experience may differ: "
        "docs/theory/restitution.md.",
    )


# What is refused.


def refused(study: Study, *links: Callable[[Solution], object]) -> Iterator[str]:
    """Yield why the first of these links of a chain that has no answer is refused."""
    solution = solve(study)
    try:
        for link in links:
            link(solution)
    except SeparatrixError as error:
        yield str(error)


def rolling(solution: Solution) -> None:
    """Refuse what no traction is computed of: a bearing that does not roll, contacts out of their range."""
    asked, tracks = solution.study.traction, solution.rolling.tracks
    if asked.model is TractionModel.STRIPS:
        _ = solution.slopes
        return
    for track in tracks:
        if not track.is_idle:
            rolling_contact(contact_problem(track, asked), columns=COARSE, rows=COARSE)


def impact(solution: Solution) -> None:
    """Refuse what no restitution factor is computed of: a pocket without stiffness, no running clearance."""
    _ = solution.clearances, solution.ball_cage_stiffness, solution.inertia


def coolant(solution: Solution) -> None:
    """Refuse a fluid that the library does not know at the temperature of the bearing."""
    if solution.study.cooling is not None:
        heat_balance(solution.study, solution.bearing)


def push(solution: Solution) -> None:
    """Refuse what no mobility is computed of."""
    _ = by_strips(solution).mobility


def known_friction(solution: Solution) -> None:
    """Refuse a pocket of unknown friction."""
    candidates.require_friction(solution.study)


def cage_motion(solution: Solution) -> None:
    """Refuse what no cage is moved of: no restitution factor, no clearance, no body."""
    if solution.study.traction.model is TractionModel.EXACT:
        rolling(solution)
        solution = by_strips(solution)
    cage_of(solution)


def worn_cage(solution: Solution) -> None:
    """Refuse what a cage that wears has no life of; of one whose wear is not stated none is asked."""
    from separatrix.verdict.wear_life import wear_rates

    study = solution.study
    if study.wear is not None:
        cage_motion(solution)
        candidate = candidates.reference_candidate(study, study.ranking) if study.ranking else None
        wear_rates(study, study.wear, candidate)


def candidate_cages(solution: Solution) -> None:
    """Refuse what no candidate is judged in: no environment of the bearing, no cage that could move."""
    study = solution.study
    asked = candidates.ranking_question(study)
    candidates.required_environment(study, asked)
    for one in (candidates.reference_candidate(study, asked), *asked.candidates):
        cage_motion(solve(study, one))


def drawn_bearings(solution: Solution) -> None:
    """Refuse inputs and frictions of which no bearing can be drawn."""
    from separatrix.verdict.draws import frictions_to_draw, uncertain_inputs

    uncertain_inputs(solution.study, frictions_to_draw(solution.study))


def by_strips(solution: Solution) -> Solution:
    """Return the same chain with strips, which have no refusals of their own and take milliseconds."""
    return solve(replace(solution.study, traction=TractionSettings()), solution.candidate)
