"""How long a verb takes, before anything is run: the runs that it expects, at the pace of this program."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import moving_cage, turned_forward
from separatrix.cage.numbers import numbers_of
from separatrix.cage.outcome import MOST
from separatrix.chain.solution import Solution
from separatrix.ground.units import Second
from separatrix.verdict.long_jobs import Load, Runner

PACE, UNEVEN = 1e8, 0.22
"""Steps of a ball that one core computes in a second, and the part of them that it does among uneven orbits,
where a verdict also asks for two frictions.

From 0.55e8 in space to 1.7e8 of balls that are dampers, on a server of 2026.
"""


class Foreseen(Exception):  # noqa: N818 - an answer, not an error
    """The number of runs that a job would make."""

    def __init__(self, runs: float) -> None:
        super().__init__(runs)
        self.runs = runs


class Counting(Runner):
    """Runs nothing: a job ends with what it would make, in `Foreseen`."""

    def work_out(  # type: ignore[override]
        self, _compute: object, places: Iterable[Any], *, load: Callable[[Any], Load], **_: object
    ) -> NoReturn:
        """Count the runs of these places."""
        raise Foreseen(sum(load(place).runs for place in places))


def time_of_runs(solution: Solution, runs: float) -> Second:
    """Time that one core takes for runs of a cage, within a factor of 3.

    A motion that the balls damp little is followed through more of its longest time. With even orbits
    the time of `rank` was 0.7 to 1.9 times the true one, of 15 to 180 s; with uneven ones 0.4 to 3.2 times,
    of 15 to 375 s (six bearings).
    """
    cage = turned_forward(moving_cage(solution, 0.0))
    settings = settings_for(solution.study.stability, cage)
    kind, *_, limits = numbers_of(cage, settings.middle_kick, settings.duration)
    share = 0.06 / (1.2 - solution.restitution.restitution_factor)
    pace = PACE * (UNEVEN if kind.harmonics else 1.0)
    return float(runs * share * limits[MOST] * kind.steps * kind.balls / pace)
