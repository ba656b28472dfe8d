"""How much friction, and which restitution factor, drawn bearings bear: the engine is asked, nothing fitted.

P(settles) is followed with the same counts and the same search as the critical friction of one cage
(`stability.response`), at the share of bearings that may fail.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from separatrix.cage import PlanarCage, RunOutcome
from separatrix.chain.lubrication import LubricationCurve
from separatrix.distribution import LogNormal
from separatrix.draws import Case
from separatrix.explore.records import AllowedFilm, AllowedFriction
from separatrix.limits.growth import Count, race_damping_at
from separatrix.limits.response import SEARCHED_FRICTION, Crossing, Response, Side
from separatrix.ranking.drawn import DrawnBearings
from separatrix.runner import Runner
from separatrix.units import MetrePerSecond, Ratio

PROBABILITY: Ratio = 0.95
"""Wanted share of bearings that settle."""

RUNS = 96
"""Bearings counted near the answer."""

NONE_LOW = "fewer settle even without pocket friction"
ALL_SETTLE = f"more settle at every friction up to {SEARCHED_FRICTION:g}"
NO_ETA = "fewer settle at any restitution factor"
EVERY_ETA = "more settle at every restitution factor"


def allowed_friction(
    bearings: DrawnBearings,
    names: Sequence[str],
    scatter: Ratio,
    kicks: Sequence[MetrePerSecond],
    runner: Runner,
) -> AllowedFriction:
    """Largest mean friction of a new material that scatters by `scatter`, in the pockets of some candidates.

    Raises
    ------
    Interrupted
        The work was interrupted.
    """
    own = next(case for case in bearings.friction if case.candidate == names[0])
    law = LogNormal(mean=1.0, standard_deviation=scatter) if scatter > 0.0 else None
    random = np.random.default_rng((bearings.study.stability.seed, len(bearings.runs)))
    places = (random.permutation(len(bearings.runs)) + 0.5) / len(bearings.runs)
    shares = np.ones(len(bearings.runs)) if law is None else law.quantile(places)

    def at(friction: Ratio, place: int, cage: PlanarCage) -> PlanarCage:
        return replace(cage, ball_cage_friction=friction * float(shares[place]))

    found = _worst([_crossing(bearings, own, kick, at, 0.1, runner) for kick in kicks])
    known = isinstance(found, Crossing)
    return AllowedFriction(
        names=tuple(names),
        probability=PROBABILITY,
        scatter=scatter,
        friction=found.value if isinstance(found, Crossing) else None,
        friction_low=found.low if isinstance(found, Crossing) else None,
        friction_high=found.high if isinstance(found, Crossing) else None,
        reason="" if known else NONE_LOW if found is Side.ABOVE else ALL_SETTLE,
    )


def allowed_film(
    bearings: DrawnBearings,
    case: Case,
    kicks: Sequence[MetrePerSecond],
    films: LubricationCurve | None,
    runner: Runner,
) -> AllowedFilm:
    """Largest restitution factor of the central bearing, the dampings of all bearings scaled with its own.

    A film acts on the cage by the race damping alone, so the films that keep below it are read off the
    central bearing's curve over film thickness and race friction.

    Raises
    ------
    Interrupted
        The work was interrupted.
    """
    central = bearings.cage(case)
    own = bearings.central[case.candidate].restitution.restitution_factor

    def at(eta: Ratio, _place: int, cage: PlanarCage) -> PlanarCage:
        return replace(cage, race_damping=cage.race_damping * _ratio(central, eta))

    found = _worst([_crossing(bearings, case, kick, at, max(own, 0.05), runner) for kick in kicks])
    empty = np.zeros(0)
    return AllowedFilm(
        name=case.candidate,
        probability=PROBABILITY,
        restitution_factor=found.value if isinstance(found, Crossing) else None,
        restitution_factor_low=found.low if isinstance(found, Crossing) else None,
        restitution_factor_high=found.high if isinstance(found, Crossing) else None,
        reason="" if isinstance(found, Crossing) else NO_ETA if found is Side.ABOVE else EVERY_ETA,
        film_thickness=empty if films is None else films.film_thickness,
        race_friction=empty if films is None else films.race_friction,
        film_restitution_factor=np.zeros((0, 0)) if films is None else films.restitution_factor,
    )


# Cage of a bearing at a value that is searched, by its place.
Changed = Callable[[Ratio, int, PlanarCage], PlanarCage]


def _crossing(
    bearings: DrawnBearings, case: Case, kick: MetrePerSecond, at: Changed, guess: Ratio, runner: Runner
) -> Crossing | Side:
    """Value at which the share of bearings that do not settle from a kick passes what may fail."""
    total = len(bearings.runs)

    def look(value: Ratio, first: int, runs: int) -> Count:
        places = [place % total for place in range(first, first + runs)]
        found = bearings.ensemble(case, (kick,), places, runner, lambda place, cage: at(value, place, cage))
        return Count(runs - int(found.count(RunOutcome.SETTLES)[0]), runs)

    return Response(look, RUNS).crossing(1.0 - PROBABILITY, RUNS, guess)


def _worst(found: Sequence[Crossing | Side]) -> Crossing | Side:
    """Crossing of the worst kick: the least; none is left where more fail from one kick throughout."""
    if Side.ABOVE in found:
        return Side.ABOVE
    crossings = [one for one in found if isinstance(one, Crossing)]
    return min(crossings, key=lambda one: one.value) if crossings else Side.BELOW


def _ratio(central: PlanarCage, eta: Ratio) -> float:
    """Race damping at a restitution factor, over that of the central cage; infinite for 1."""
    return race_damping_at(central, eta) / central.race_damping
