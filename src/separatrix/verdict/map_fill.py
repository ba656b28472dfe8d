"""Which points of a map are run, when one is decided and how often wrongly, and where the answer changes.

The points are found from a coarse grid to the full one: all of them, or those near a change.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import comb

from separatrix.ground.units import Ratio
from separatrix.verdict.judgement import CLEAR, FEW, Verdict, wilson_interval
from separatrix.verdict.long_jobs import Interrupted, Runner
from separatrix.verdict.map_records import EITHER, MapPoint, MapQuestion, side

AGREEING = 6
"""A point is decided once this number of runs agree from the first on; otherwise when it is settled."""

LOOK_AFTER = 2
"""Runs after which a point is judged again, whose first runs did not agree; more for a very long one."""

MOST_WRONG: Ratio = 1e-3
"""Largest probability that all the runs of such a point would have the other majority."""


def first_look(runs: int) -> int:
    """Runs after which a point is judged: the fewest that keep to `MOST_WRONG`, and to `AGREEING`."""
    enough = next(n for n in range(1, runs + 1) if wrong_side_probability(runs, n) <= MOST_WRONG)
    return min(max(enough, AGREEING), runs)


def wrong_side_probability(runs: int, agreeing: int) -> Ratio:
    r"""Largest probability that a point which is ended early would lie on the other side with all its runs.

    Runs are exchangeable. If :math:`K` of :math:`R` are of one kind, the first :math:`n` are all of the
    other with probability :math:`\binom{R-K}{n} / \binom{R}{n}`, which is largest for the smallest
    majority, :math:`K = \lfloor R/2 \rfloor + 1`.

    Parameters
    ----------
    runs : int
        R, all the runs of a point.
    agreeing : int
        n, runs that agree before it is ended.
    """
    return _all_of_the_others(runs, runs // 2 + 1, agreeing)


def other_decision_probability(runs: int, agreeing: int) -> Ratio:
    """Largest probability that a point which is ended early would be decided otherwise with all its runs.

    Most of these are points that all the runs would leave undecided.
    """
    if agreeing >= runs:
        return 0.0
    calm = max(_all_of_the_others(runs, k, agreeing) for k in range(runs + 1) if not _is_calm(runs - k, runs))
    wild = max(_all_of_the_others(runs, k, agreeing) for k in range(runs + 1) if not _is_wild(runs - k, runs))
    return max(calm, wild)


def _all_of_the_others(runs: int, kind: int, agreeing: int) -> Ratio:
    """Probability that none of the first `agreeing` of `runs` is one of the `kind`; 0 if all are made."""
    return comb(runs - kind, agreeing) / comb(runs, agreeing) if agreeing < runs else 0.0


def _is_calm(settles: int, runs: int) -> bool:
    return settles / runs >= CLEAR and wilson_interval(settles, runs)[0] > FEW


def _is_wild(whirls: int, runs: int) -> bool:
    return wilson_interval(whirls, runs)[0] > FEW


@dataclass(frozen=True, slots=True, kw_only=True)
class Tally:
    """What the runs of a point did: how many were made, whirl, and settle or roll."""

    runs: int
    whirls: int
    settles: int


def settled(now: Tally, most: int) -> bool:
    """Whether decision and side of a point are the same however the rest of its `most` runs end.

    This is exact: shares only rise with the runs that do so. A point that may still become STABLE is not
    settled, for that needs more than counts.
    """
    left = most - now.runs
    calmest = Tally(runs=most, whirls=now.whirls, settles=now.settles + left)
    wildest = Tally(runs=most, whirls=now.whirls + left, settles=now.settles)
    if _is_calm(calmest.settles, most):
        return left == 0
    return _answer(now) == _answer(calmest) == _answer(wildest)


def _answer(tally: Tally) -> tuple[int, bool]:
    """Side of one half, and whether the point is unstable."""
    return side(*wilson_interval(tally.whirls, tally.runs)), _is_wild(tally.whirls, tally.runs)


def further(made: int, most: int) -> int:
    """Runs to make before a point is judged again."""
    return min(max(LOOK_AFTER, made // 8), most - made)


def changes(sides: Sequence[int]) -> list[tuple[int, int]]:
    """Places (last of one side, first of the other) between which a row of sides changes."""
    decided = [place for place, at in enumerate(sides) if at != EITHER]
    return [(a, b) for a, b in pairwise(decided) if sides[a] != sides[b]]


def margins(values: Sequence[float], sides: Sequence[int]) -> list[float | None]:
    """Distance of each point to the nearest band in which its row changes sides.

    Positive where the motion settles, negative where it whirls, 0 inside the band; None in a row that does
    not change, and where nothing was decided outside a band.
    """
    bands = [(values[a], values[b]) for a, b in changes(sides)]
    return [_margin(value, at, bands) for value, at in zip(values, sides, strict=True)]


def _margin(value: float, at: int, bands: Sequence[tuple[float, float]]) -> float | None:
    if not bands:
        return None
    distance = min(max(low - value, value - high, 0.0) for low, high in bands)
    if at == EITHER:
        return 0.0 if distance == 0.0 else None
    return -at * distance + 0.0


Place = tuple[int, int]
Lattice = list[list[int]]  # places of the columns and rows of a coarse grid
STRIDES = (8, 4, 2, 1)


def rounds(columns: int, rows: int) -> Iterator[tuple[Lattice | None, list[Place]]]:
    """Each finer grid's new places, and the coarser grid between whose places they lie."""
    seen: set[Place] = set()
    coarser: Lattice | None = None
    for stride in STRIDES:
        finer: Lattice = [sorted({*range(0, count, stride), count - 1}) for count in (columns, rows)]
        places = [(i, j) for i in finer[0] for j in finer[1] if (i, j) not in seen]
        seen.update(places)
        yield coarser, places
        coarser = finer


def near_a_change(place: Place, coarser: Lattice, answers: Mapping[Place, object]) -> bool:
    """Whether the answers of the coarser grid around a place differ."""
    found = [answers[corner] for corner in _around(place, coarser)]
    return any(answer != found[0] for answer in found)


def _around(place: Place, coarser: Lattice) -> list[Place]:
    """Places of the coarser grid that are not further away than one of its steps, along each axis."""
    near = []
    for at, marks in zip(place, coarser, strict=True):
        step = marks[1] - marks[0] if marks[1:] else 1
        near.append(marks[bisect_left(marks, at - step) : bisect_right(marks, at + step)])
    return [(i, j) for i in near[0] for j in near[1]]


CHECK_EVERY = 20
"""Of the points that an adaptive map does not want, one in this number is run nevertheless, as a check."""


@dataclass(slots=True, kw_only=True)
class Filled:
    """Points by their place in the grid."""

    found: dict[Place, MapPoint] = field(default_factory=dict)  # points that were run or refused
    inferred: dict[Place, Verdict | None] = field(default_factory=dict)
    """Decision of the points around one that was not run."""
    checked: dict[Place, Verdict | None] = field(default_factory=dict)
    """The same of points run as a check; these are among `found`, too."""
    complete: bool = True  # false if an interrupt left points out


def fill(question: MapQuestion, finder: Callable[[tuple[float, float]], MapPoint], runner: Runner) -> Filled:
    """Find the points that the question wants; `finder` computes one at (x, y).

    An adaptive map runs those near a change of the decision, infers the others, and runs a sample of these.
    `Interrupted` has the points that were found, if any was.
    """
    xs, ys = question.x.values, question.y.values
    filled = Filled()

    def find(wanted: Iterable[Place]) -> None:
        before, report = len(filled.found), runner.progress

        def so_far(done: float, _: float) -> None:
            found = before + done
            if report is not None:
                report(found, max(found, len(xs) * len(ys) - len(filled.inferred)))

        runner.work_out(
            lambda place: finder((xs[place[0]], ys[place[1]])),
            wanted,
            into=filled.found.update,
            progress=so_far,
        )

    try:
        for coarser, places in rounds(len(xs), len(ys)):
            find(_near_changes(filled, places, coarser) if question.adaptive and coarser else places)
        sample = sorted(filled.inferred)[CHECK_EVERY // 2 :: CHECK_EVERY]
        find(sample)
        filled.checked = {place: filled.inferred.pop(place) for place in sample if place in filled.found}
    except Interrupted:
        filled.complete = False
        raise Interrupted(filled if filled.found else None) from None
    return filled


def _near_changes(filled: Filled, places: list[Place], coarser: Lattice) -> list[Place]:
    """Places near a change of the decision; the others are inferred."""
    decisions = {place: point.decision for place, point in filled.found.items()} | filled.inferred
    wanted = [place for place in places if near_a_change(place, coarser, decisions)]
    others = set(places).difference(wanted)
    filled.inferred |= {place: decisions[_around(place, coarser)[0]] for place in others}
    return wanted
