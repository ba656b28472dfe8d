"""What a long verb will take: a few runs of its points are timed before it starts, and scaled."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from separatrix.cage import PlanarCage, run_ensemble, settings_for
from separatrix.cage_choice import ranking_question, required_environment
from separatrix.chain.contacts import race_tracks
from separatrix.chain.race_curve import exact_slope, strips
from separatrix.chain.solution import Solution, solve
from separatrix.limits.map import PointFinder, require_cage_friction
from separatrix.limits.map_records import MapQuestion
from separatrix.limits.point import linear_guess
from separatrix.limits.response import GrowthCounter
from separatrix.ranking.reason import (
    NOTICED,
    Pocket,
    no_second,
    pocket_of,
    transmitted_force,
    with_other_ball,
)
from separatrix.runner import PART, Runner
from separatrix.study import StabilitySettings, Study, TractionModel
from separatrix.units import Ratio, Second

LONGEST_SAMPLE = 5.0  # time after which no further friction is timed [s]
SHARES = (1e-3, 1e-2, 1e-1, 1.0)
"""Parts of the duration for which one run from each kick is timed. The first is timed twice, for it may wait
for compiled code to be loaded. More runs at a friction take longer and tell no more."""

SLOW = 0.1  # part of `LONGEST_SAMPLE` from which on the time of a brief run is scaled up
DAMPINGS = (None, 0.0, 0.5, 1.0)
"""Restitution factors at which runs of a curve are timed; None is the cage's own damping."""

FACTORS = (0.0, 0.7, 1.5)
"""Frictions at which runs of a curve are timed, as multiples of the linear limit: the work is done below it
and about it, for runs far above end soon."""

QUARTERS = 4
"""Parts into which the frictions of verdicts are divided by those that are timed: runs near the critical
friction may take ten times as long as those far from it."""

MAP_POINTS_NOT_TIMED = 30  # a map of so few points needs no estimate
PICTURES = 5.0  # time of a ranking's figures and files [s]
CURVE_POINTS = 16.0
"""Points of a curve whose restitution factors are chosen where it bends: 5 to 18, 9 on average. Where
it bends more, its points take longer, too."""


def expected_curve(cage: PlanarCage, settings: StabilitySettings, *, jobs: int, band: bool) -> Second:
    """Time of a stability curve, with its band at every point or only at the cage's own damping."""
    counts = GrowthCounter(cage, settings)
    some = [counts.cage_at(eta, factor * linear_guess(counts, eta)) for eta in DAMPINGS for factor in FACTORS]
    each = _mean(_time_of_a_run(one, settings) for one in some)
    points = float(len(settings.restitution_factors)) or CURVE_POINTS
    banded = points + 1.0 if band else 1.0
    # of a critical friction: both ends of the ladder, the bracket, and those near the crossing
    of_a_point = 32.0 + (1.5 if band else 0.75) * settings.runs
    # of a band: a first look at three crossings of every kick, and more at the ends
    of_a_band = len(settings.kicks) * (16.0 + 1.5 * settings.runs)
    runs = points * of_a_point + banded * of_a_band
    return each * runs / jobs


def expected_verdicts(
    cage: PlanarCage, settings: StabilitySettings, frictions: Iterable[Ratio], *, jobs: int
) -> Second:
    """Time of the whole ensembles at these frictions, by the least, the quartiles and the largest."""
    asked = sorted(frictions)
    if not asked:
        return 0.0
    some = {asked[n * (len(asked) - 1) // QUARTERS] for n in range(QUARTERS + 1)}
    each = _mean(_time_of_a_run(replace(cage, ball_cage_friction=f), settings) for f in sorted(some))
    return each * len(asked) * len(settings.kicks) * settings.runs / jobs


def expected_ranking(study: Study, *, jobs: int) -> Second:
    """Time of a ranking: a curve for every pocket, and a verdict for every friction.

    Timed is the middle cage, by mass and stiffness, for all: to time each took a tenth of the ranking.
    """
    asked = ranking_question(study)
    environment = required_environment(study, asked)
    keys: set[tuple[Pocket, Ratio]] = set()
    own: set[tuple[Pocket, Ratio]] = set()
    solutions: dict[Pocket, Solution] = {}
    for candidate in asked.candidates:
        solution = solve(study, candidate)
        pocket = pocket_of(solution)
        solutions[pocket] = solution
        keys |= {(pocket, found.mean) for found in solution.frictions.values() if found is not None}
        here = solution.frictions.get(environment)
        own |= {(pocket, here.mean)} if here is not None else set()
    middle = solutions[sorted(solutions)[len(solutions) // 2]]
    cage, settings = middle.cage_with(0.0), middle.stability
    curves = len(solutions) * expected_curve(cage, settings, jobs=jobs, band=False)
    verdicts = expected_verdicts(cage, settings, [friction for _, friction in keys], jobs=jobs)
    verdicts += _expected_seconds(middle, [friction for _, friction in own], jobs=jobs)
    if not study.distributions:
        return PICTURES + curves + verdicts
    return PICTURES + curves + 2.0 * verdicts + _expected_chains(study, settings.runs)


def _expected_seconds(solution: Solution, frictions: Collection[Ratio], *, jobs: int) -> Second:
    """Time of the verdicts by the other model of a ball; none if the races transmit the kick's impact."""
    cage = solution.cage_with(0.0)
    settings = settings_for(solution.stability, cage)
    force = max(settings.kicks) * math.sqrt(cage.ball_cage_stiffness * cage.mass / 2.0)
    if force < NOTICED * transmitted_force(solution) or no_second(solution):
        return 0.0
    few = replace(settings, runs=min(PART, settings.runs))
    other = with_other_ball(solution, 0.0)
    asked = sorted(frictions)
    some = asked[len(asked) // 2 :: max(1, (len(asked) - 1) // 2)]  # two: such runs may take long to time
    return expected_verdicts(other, few, some, jobs=jobs) * len(asked) / max(1, len(some))


def expected_uncertain(study: Study, bearings: int, *, jobs: int) -> Second:
    """Time of an uncertain study: half the cases run all bearings, and the inverse questions a third more."""
    asked = ranking_question(study)
    smooth = SOBOL_DRAWS * (2 + sum(1 for key in study.distributions if not key.startswith("ranking.")))
    total = PICTURES + _expected_chains(study, bearings + smooth)
    for candidate in asked.candidates:
        solution = solve(study, candidate)
        known = [found.mean for found in solution.frictions.values() if found is not None]
        settings = replace(solution.stability, runs=bearings)
        whole = expected_verdicts(solution.cage_with(0.0), settings, known, jobs=jobs)
        total += SHARE_RUN * whole
    return total


def _expected_chains(study: Study, count: int) -> Second:
    """Time of the chains of as many drawn bearings; none where only frictions are drawn."""
    if all(key.startswith("ranking.") for key in study.distributions):
        return 0.0
    tracks = race_tracks(study.bearing, study.film, solve(study).bearing)
    start = time.perf_counter()
    for track in tracks:
        if study.traction.model is TractionModel.STRIPS:
            strips(track, study.traction.pressure)
        else:
            exact_slope.__wrapped__(track, study.traction)  # not the one that is remembered
    return count * (time.perf_counter() - start)


SOBOL_DRAWS = 256  # draws of each matrix behind the shares of what the chain computes smoothly (`shares`)
SHARE_RUN = 0.7  # of the runs of all cases, those that are made, with what the inverse questions take


def expected_map(question: MapQuestion, *, jobs: int) -> Second:
    """Time of the points of a map, by some of them on an even lattice.

    Those of its first row and column are not timed: with them the links of the chain are made that others
    share.
    """
    require_cage_friction(question)
    xs, ys = (_some(axis.values) for axis in (question.x, question.y))
    points = len(question.x.values) * len(question.y.values)
    if points <= MAP_POINTS_NOT_TIMED:
        return 0.0
    finder = PointFinder(question, Runner())
    for x in xs:
        finder((x, ys[0]))
    for y in ys[1:]:
        finder((xs[0], y))

    def timed(x: float, y: float) -> Second:
        begun = time.perf_counter()
        finder((x, y))
        return time.perf_counter() - begun

    return _mean(timed(x, y) for x in xs[1:] for y in ys[1:]) * points / jobs


def _some(values: Sequence[float]) -> list[float]:
    """Three of the values of an axis, evenly chosen, or both of two."""
    return list(dict.fromkeys(values[round(i * (len(values) - 1) / 2)] for i in range(3)))


def _mean(times: Iterable[Second]) -> Second:
    """Mean of times, of which no more is taken once they have taken long themselves."""
    begun, found = time.monotonic(), []
    for one in times:
        found.append(one)
        if time.monotonic() - begun > LONGEST_SAMPLE:
            break
    return sum(found) / len(found)


def _time_of_a_run(cage: PlanarCage, settings: StabilitySettings) -> Second:
    """Time of a run, the mean over the kicks; the compiled code is loaded beforehand.

    Where runs are slow, as of balls that the races of a slow bearing stop within nanoseconds, a brief one is
    timed in place of the whole.
    """

    def taken(share: Ratio) -> Second:
        some = replace(settings, duration=share * settings.duration)
        begun = time.perf_counter()
        run_ensemble(cage, some, runs=1)
        return (time.perf_counter() - begun) / len(settings.kicks)

    taken(SHARES[0])
    whole = 0.0
    for share in SHARES:
        brief = taken(share)
        whole = brief / share
        if brief * len(settings.kicks) > SLOW * LONGEST_SAMPLE:
            break
    return whole
