"""Pocket friction of a candidate as its cage sees it, in one environment or over all of them."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot, sqrt

from separatrix.cage_choice import cage_candidate, cage_friction, environment_of
from separatrix.chain import CageState, cage_state, impact_speed
from separatrix.errors import ValidityWarning
from separatrix.friction.fit import TestedFriction
from separatrix.pocket_contact import PocketConditions, pocket_conditions
from separatrix.study import Candidate, Friction, Operation, Study
from separatrix.units import Ratio


@dataclass(frozen=True, slots=True)
class MeanFriction:
    """Mean friction, its standard error (None if no scatter is known), and what is to be said of it.

    The error holds what was not tested: outside the tests the mean is known less well. `deviation` is the
    standard deviation of a new sample; `assumed` tells a scatter that nobody measured.
    """

    mean: Ratio
    error: Ratio | None = None
    deviation: Ratio | None = None
    assumed: bool = False
    extrapolation: tuple[str, ...] = ()

    def interval(self) -> tuple[Ratio, Ratio]:
        """95 % interval of the mean; the mean twice if its scatter is not known."""
        half = 1.96 * (self.error or 0.0)
        return max(0.0, self.mean - half), self.mean + half


def measured(friction: Friction) -> MeanFriction:
    """Mean and standard error of one measurement, with the widening for what was not tested."""
    error = _standard_error(friction)
    return MeanFriction(
        friction.mean,
        None if error is None else hypot(error, friction.widening),
        friction.standard_deviation,
        friction.assumed_scatter,
        friction.extrapolation,
    )


def _standard_error(friction: Friction) -> Ratio | None:
    """Of the mean under the conditions tested; without a count the scatter is taken as it is."""
    error, deviation = friction.standard_error, friction.standard_deviation
    return deviation / sqrt(friction.count or 1) if error is None and deviation is not None else error


def overall(frictions: Iterable[Friction | None]) -> MeanFriction | None:
    """Mean over the measured environments, each counting once; None if there is none."""
    found = [measured(friction) for friction in frictions if friction is not None]
    if not found:
        return None
    mean = sum(one.mean for one in found) / len(found)
    errors = [one.error for one in found if one.error is not None]
    return MeanFriction(
        mean,
        sqrt(sum(e * e for e in errors)) / len(found) if errors else None,
        assumed=any(one.assumed for one in found),
        extrapolation=tuple(dict.fromkeys(text for one in found for text in one.extrapolation)),
    )


def frictions_seen(study: Study) -> Study:
    """The study with the friction of every candidate as its cage sees it.

    Each friction is asked for at the sliding speed and pressure of the pocket, the temperature and the fluid
    of the study. It comes back with its standard error, the standard deviation of a new sample, and
    what was not tested; a number without scatter gets that of an unrepeated test. Log-normal about `mean`.

    Raises
    ------
    InputError
        The study has no cage, or nothing to compute a pocket's stiffness from.
    """
    if study.ranking is None:
        return study
    seen = (
        candidate_seen(study, candidate, cage_state(study, material=candidate.material, friction=0.0))
        for candidate in study.ranking.candidates
    )
    return replace(study, ranking=replace(study.ranking, candidates=tuple(seen)))


def as_pockets_see(study: Study) -> Study:
    """Return the study with the frictions of its tests asked for at the conditions of the pockets.

    A friction that is stated without its tests keeps its scatter, that of an unrepeated test if none is
    given: how much it differs in the pocket is not known. `extrapolation` says for both what was not tested.
    """
    asked = study.ranking
    if asked is None:
        return study
    every = [one for candidate in asked.candidates for one in candidate.friction.values()]
    if all(one is None or one.law is None for one in every):
        return study
    seen = frictions_seen(study).ranking
    candidates = tuple(
        replace(old, friction={name: _seen(one, new.friction[name]) for name, one in old.friction.items()})
        for old, new in zip(asked.candidates, seen.candidates if seen else (), strict=True)
    )
    return replace(study, ranking=replace(asked, candidates=candidates))


def _seen(stated: Friction | None, seen: Friction | None) -> Friction | None:
    """Friction of the tests as the pocket sees it; a stated one as it is, with what was not tested."""
    if stated is None or seen is None or isinstance(stated.law, TestedFriction):
        return seen
    return replace(stated, extrapolation=seen.extrapolation)


def candidate_seen(study: Study, candidate: Candidate, state: CageState) -> Candidate:
    """One candidate with its frictions as the cage of `state` sees them."""
    scatter = study.ranking.friction_scatter if study.ranking else 0.0
    pocket = conditions_of(study, state)
    names = names_of_fluid(study)
    friction = {
        environment: None if one is None else friction_seen(one, pocket, study.operation, scatter, names)
        for environment, one in candidate.friction.items()
    }
    return replace(candidate, friction=friction)


def cage_seen(study: Study, *, marked: bool = False) -> Study:
    """The study with the frictions of its cage's candidate as the pocket sees them; a given one stays.

    Warns
    -----
    ValidityWarning
        The friction is asked for where nothing was tested; not if that is `marked` in the answer.
    """
    if study.cage is None or study.cage.ball_cage_friction is not None or study.ranking is None:
        return study
    own, friction, environment = cage_candidate(study), cage_friction(study), environment_of(study.ranking)
    if own is None or environment is None or friction is None or friction.law is None:
        return study
    seen = candidate_seen(study, own, cage_state(study, material=own.material, friction=0.0))
    if not marked:
        _say_what_was_not_tested(own.name, environment, seen.friction[environment])
    candidates = tuple(seen if candidate is own else candidate for candidate in study.ranking.candidates)
    return replace(study, ranking=replace(study.ranking, candidates=candidates))


def _say_what_was_not_tested(candidate: str, environment: str, friction: Friction | None) -> None:
    if friction is not None and friction.extrapolation:
        warnings.warn(
            f"Pocket friction {friction.mean:.3g} of {candidate} in {environment}, extrapolated beyond the "
            f"tests: {'; '.join(friction.extrapolation)}. [cage] ball_cage_friction gives another.",
            ValidityWarning,
            stacklevel=3,
        )


def conditions_of(study: Study, state: CageState) -> PocketConditions:
    """Sliding speed and pressure in the pockets of a cage."""
    return pocket_conditions(
        state.restitution.traction.bearing.equilibrium,
        ball_diameter=study.bearing.ball_diameter,
        ball_cage_stiffness=state.cage.ball_cage_stiffness,
        cage_mass=state.cage.mass,
        damping_ratio=state.restitution.restitution.damping_ratio,
        impact_speed=impact_speed(study, state.cage.cage_speed),
    )


def names_of_fluid(study: Study) -> tuple[str, ...]:
    """The fluid as the study writes it, and its other names in the library: tests may have any of them."""
    record = study.records.get("operation.fluid")
    known = (record["name"], *(record["aliases"] or ())) if record is not None else ()
    return tuple(filter(None, (study.operation.fluid, *known)))


def friction_seen(
    friction: Friction,
    pocket: PocketConditions,
    operation: Operation,
    scatter: Ratio,
    media: Sequence[str] = (),
) -> Friction:
    """One friction as a pocket sees it.

    `scatter` is that of an unrepeated test; `media` are the names of the fluid, if there are several.
    """
    if friction.law is None:
        return with_scatter(friction, scatter)
    found = friction.law.at(
        slip_speed=pocket.slip_speed or None,
        pressure=pocket.pressure,
        temperature=operation.temperature,
        medium=media or operation.fluid,
    )
    return replace(
        friction,
        mean=found.mean,
        standard_error=found.standard_error,
        standard_deviation=found.standard_deviation,
        assumed_scatter=found.assumed_scatter,
        extrapolation=found.extrapolation,
        widening=found.widening,
    )


def with_scatter(friction: Friction, scatter: Ratio) -> Friction:
    """Return a friction with the scatter that it states; without any, with that of an unrepeated test."""
    error, deviation = _standard_error(friction), friction.standard_deviation
    if error is not None:
        deviation = error if deviation is None else deviation
        return replace(friction, standard_error=error, standard_deviation=deviation)
    assumed = scatter * friction.mean
    return replace(friction, standard_error=assumed, standard_deviation=assumed, assumed_scatter=True)


def errors_of(frictions: Mapping[str, Friction | None], scatter: Ratio) -> dict[str, MeanFriction]:
    """Mean and standard error of those that were measured; without any scatter that of an unrepeated test."""
    return {name: measured(with_scatter(f, scatter)) for name, f in frictions.items() if f is not None}
