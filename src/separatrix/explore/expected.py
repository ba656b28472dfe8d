"""What a long verb will take: some of its runs are timed before it starts, and counted."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace

from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.rows import LANES
from separatrix.chain.solution import Solution, solve
from separatrix.ground.units import Ratio, Second
from separatrix.limits.map import PointFinder, require_cage_friction
from separatrix.limits.map_records import MapQuestion
from separatrix.limits.point import linear_guess
from separatrix.limits.response import GrowthCounter
from separatrix.ranking.reason import pocket_of
from separatrix.study.candidates import ranking_question
from separatrix.study.study import StabilitySettings, Study
from separatrix.verdict.long_jobs import Runner

LONGEST_SAMPLE = 0.5  # time after which nothing more is timed [s]
FACTORS = (0.7, 1.5)
"""Frictions at which runs of a curve are timed, as multiples of the linear limit."""

MAP_POINTS_NOT_TIMED = 30  # a map of so few points needs no estimate
PICTURES = 5.0  # time of a ranking's figures and files [s]
CURVE_POINTS = 16.0  # of a curve whose restitution factors are chosen where it bends: 5 to 18
SOBOL_DRAWS = 256  # draws of each matrix behind the shares of what the chain computes smoothly (`shares`)
SHARE_RUN = 0.7  # of the runs of all cases, those that are made, with what the inverse questions take


def expected_curve(cage: MovingCage, settings: StabilitySettings, *, jobs: int, band: bool) -> Second:
    """Time of a stability curve, with its band at every point or only at the cage's own damping."""
    counts = GrowthCounter(cage, settings)
    some = (counts.cage_at(None, factor * linear_guess(counts, None)) for factor in FACTORS)
    points = float(len(settings.restitution_factors)) or CURVE_POINTS
    # of a critical friction: both ends of the ladder, the bracket, and those near the crossing
    runs = points * (4.0 * LANES + (1.5 if band else 0.75) * settings.runs)
    # of a band: a first look at three crossings of every kick, and more at the ends
    runs += (points + 1.0 if band else 1.0) * len(counts.settings.kicks) * (2.0 * LANES + 1.5 * settings.runs)
    return _time_of_a_run(some, counts.settings) * runs / jobs


def expected_ranking(study: Study, *, jobs: int) -> Second:
    """Time of a ranking: a curve for every pocket, and a verdict for every friction.

    Timed is the middle cage, by mass and stiffness, for all.
    """
    solutions = [solve(study, candidate) for candidate in ranking_question(study).candidates]
    pockets = {pocket_of(one): one for one in solutions}
    middle = pockets[sorted(pockets)[len(pockets) // 2]]
    curve = expected_curve(moving_cage(middle, 0.0), study.stability, jobs=jobs, band=False)
    verdicts = _of_verdicts(middle, _frictions(solutions), study.stability.runs, jobs=jobs)
    total = PICTURES + len(pockets) * curve + verdicts
    return total + verdicts + _of_chains(study, study.stability.runs) if study.distributions else total


def expected_uncertain(study: Study, bearings: int, *, jobs: int) -> Second:
    """Time of an uncertain study: half the cases run all bearings, and the inverse questions a third more."""
    solutions = [solve(study, candidate) for candidate in ranking_question(study).candidates]
    known = _frictions(solutions)
    smooth = SOBOL_DRAWS * (2 + sum(1 for key in study.distributions if not key.startswith("ranking.")))
    whole = SHARE_RUN * _of_verdicts(solutions[0], known, bearings, jobs=jobs)
    return PICTURES + _of_chains(study, bearings + smooth) + whole


def _frictions(solutions: Iterable[Solution]) -> list[Ratio]:
    """Friction of every candidate in every environment, rising."""
    return sorted(found.mean for one in solutions for found in one.frictions.values() if found is not None)


def _of_verdicts(solution: Solution, frictions: Sequence[Ratio], runs: int, *, jobs: int) -> Second:
    """Time of the whole ensembles at rising frictions, by the least, the quartiles and the largest."""
    if not frictions:
        return 0.0
    some = {frictions[n * (len(frictions) - 1) // 4] for n in range(5)}
    cages = (moving_cage(solution, friction) for friction in sorted(some))
    settings = settings_for(solution.study.stability, moving_cage(solution, 0.0))
    return _time_of_a_run(cages, settings) * len(frictions) * len(settings.kicks) * runs / jobs


def _of_chains(study: Study, count: int) -> Second:
    """Time of the chains of as many drawn bearings, by one; none where only frictions are drawn."""
    if all(key.startswith("ranking.") for key in study.distributions):
        return 0.0
    _ = solve(study).restitution  # loads compiled code
    bearing = replace(study.bearing, ball_diameter=study.bearing.ball_diameter * (1.0 + 1e-6))
    start = time.perf_counter()
    _ = solve(replace(study, bearing=bearing)).restitution
    return count * (time.perf_counter() - start)


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
    runner = Runner()
    finder = PointFinder(question, runner)

    def timed(x: float, y: float) -> Second:
        begun = time.perf_counter()
        finder((x, y))
        return time.perf_counter() - begun

    def each() -> Second:
        for x in xs:
            finder((x, ys[0]))
        for y in ys[1:]:
            finder((xs[0], y))
        return _mean(timed(x, y) for x in xs[1:] for y in ys[1:])

    return runner.alone(each) * points / jobs


def _some(values: Sequence[float]) -> list[float]:
    """Three of the values of an axis, evenly chosen, or both of two."""
    return list(dict.fromkeys(values[round(i * (len(values) - 1) / 2)] for i in range(3)))


def _mean(times: Iterable[Second]) -> Second:
    """Mean of times, of which no more is taken once they have taken long themselves."""
    begun, found = time.perf_counter(), list[Second]()
    for one in times:
        found.append(one)
        if time.perf_counter() - begun > LONGEST_SAMPLE:
            break
    return sum(found) / len(found)


def _time_of_a_run(cages: Iterable[MovingCage], settings: StabilitySettings) -> Second:
    """Mean time of a run from the reference kick, by some of each cage side by side."""
    runner, cages = Runner(), list(cages)

    def run(cage: MovingCage, runs: int) -> Second:
        begun = time.perf_counter()
        runner.ensemble(cage, settings, kicks=(settings.middle_kick,), runs=runs)
        return time.perf_counter() - begun

    runner.alone(lambda: run(cages[0], 1))  # loads compiled code
    return runner.alone(lambda: _mean(run(cage, LANES) for cage in cages)) / LANES
