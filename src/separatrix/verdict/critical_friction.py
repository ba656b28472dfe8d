"""Critical friction of a cage, from whirling runs that are counted, and the safety factor against it.

Near a target P is taken as logistic in the logarithm of friction. Place and slope of the crossing are
unknown; both are summed over on a grid, weighted with the probability of the counts. So the estimate has an
interval from the first run on, and the next runs are counted where the target most likely is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from math import inf
from operator import itemgetter
from typing import Any

import numpy as np

from separatrix.cage.closed_forms import damped_critical_friction
from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.outcome import Cause, RunOutcome
from separatrix.cage.rows import LANES
from separatrix.chain.impact_restitution import damping_for
from separatrix.chain.solution import Solution
from separatrix.ground.units import Array, MetrePerSecond, Ratio
from separatrix.study.study import BallModel, StabilitySettings
from separatrix.verdict.judgement import (
    ENOUGH,
    NORMAL_95,
    UNEVEN,
    has_uneven_orbits,
    is_taken_by_land,
    kick_counts,
    transmitted_force,
    whirl_share,
    wilson_interval,
)
from separatrix.verdict.long_jobs import FEWER, Runner, cost
from separatrix.verdict.reasons import ball_words, driven_by_land

UNRESOLVED = (
    "Curve: {} of {} runs from {:g} m/s at friction {:.3g} are unresolved; they count as not whirling."
)
BY_LAND = (
    "Critical friction: friction on the land drives {} of {} runs from {:g} m/s at friction {:.3g}. It "
    "leaves these out, as friction in the pockets slows them; a verdict counts them."
)

ALIKE: Ratio = 0.08
"""Chance by which runs that all agree may hide a share at the target: 8 runs for one half (0.4 %), 24 for a
tenth."""


@dataclass(frozen=True, slots=True)
class Count:
    """Number of whirling runs among the runs made, and sentences on those that do not show where they end."""

    whirling: int
    runs: int
    notes: tuple[str, ...] = ()

    @property
    def share(self) -> Ratio:
        """Estimate of P(whirl)."""
        return self.whirling / self.runs

    def interval(self) -> tuple[Ratio, Ratio]:
        """Wilson's 95 % interval of P(whirl)."""
        return wilson_interval(self.whirling, self.runs)

    def unanimous(self, target: Ratio) -> bool:
        """Whether all runs agree, more than would do so by chance where P is at a target."""
        agree = self.runs > 0 and self.whirling in (0, self.runs)
        return agree and max(target, 1.0 - target) ** self.runs < ALIKE

    def __add__(self, other: Count) -> Count:
        return Count(self.whirling + other.whirling, self.runs + other.runs, self.notes + other.notes)


def cage_at(cage: MovingCage, restitution_factor: Ratio | None, friction: Ratio) -> MovingCage:
    """Return the same cage with the race damping of this restitution factor, and this pocket friction.

    None keeps its own damping. Balls with traction yield faster or slower by the same ratio, with the
    capacity of their own races; at 1 the races grip them.
    """
    cage = replace(cage, ball_cage_friction=friction)
    if restitution_factor is None:
        return cage
    if restitution_factor >= 1.0:
        return replace(cage, race_damping=inf, traction=None, free_ball=None)
    damping = damping_for(restitution_factor, cage.ball_cage_stiffness, cage.mass)
    ratio = damping / cage.race_damping
    law, ball = cage.traction, cage.free_ball
    return replace(
        cage,
        race_damping=damping,
        traction=law and law.stiffened(ratio),
        free_ball=ball and ball.stiffened(ratio),
    )


def responses(
    cage: MovingCage, settings: StabilitySettings, kicks: Iterable[MetrePerSecond], runner: Runner
) -> dict[MetrePerSecond, Response]:
    """Counts of a cage from each kick, none yet, at any pocket friction.

    A run counts that whirls or brings a ball to the edge of its wall; not one that friction on the land
    drives, which friction in the pockets slows. Run number r begins alike whatever damping, friction and
    kick are (common random numbers).
    """

    def look(kick: MetrePerSecond, friction: Ratio, first_run: int, runs: int) -> Count:
        at = replace(cage, ball_cage_friction=friction)
        found = runner.ensemble(at, settings, kicks=(kick,), runs=runs, first_run=first_run)
        left = found.cause == Cause.LEFT_POCKET
        unresolved = (found.outcome == RunOutcome.UNRESOLVED) & ~left
        # a motion that still falls does not whirl
        open_ends = int(np.count_nonzero(unresolved & (found.cause != Cause.FALLING)))
        whirling = (found.outcome == RunOutcome.WHIRLS) & ~driven_by_land(found)
        (ends,) = kick_counts(found)
        notes = [UNRESOLVED.format(open_ends, runs, kick, friction)] if open_ends else []
        if is_taken_by_land(ends):
            notes.append(BY_LAND.format(ends.whirls_by_land, runs, kick, friction))
        return Count(int(np.count_nonzero(left | whirling)), runs, tuple(notes))

    return {kick: Response(partial(look, kick), settings.runs) for kick in kicks}


SEARCHED_FRICTION: Ratio = 1.0  # critical friction is searched from 0 up to here
_STEPS_A_DECADE = 24  # neighbours differ by 10 %, well inside the band
LADDER: tuple[Ratio, ...] = (
    0.0,
    *(SEARCHED_FRICTION * 10 ** (-i / _STEPS_A_DECADE) for i in range(2 * _STEPS_A_DECADE + 12, -1, -1)),
)
"""Frictions at which runs are counted."""

LAST = len(LADDER) - 1
STEP = math.log(10.0) / _STEPS_A_DECADE
BATCH = LANES  # runs counted at a time, as many as go side by side; or a twelfth of all if that is more
TURNS = 40
"""Counts for one crossing at most, where a dozen do: a centre may move away from what was counted before."""

NEAR = 4.0  # steps of the ladder on either side in which P is taken as logistic: a factor of 1.5
SLOPES: Array = np.geomspace(1.0, 100.0, 17)
"""Slopes of logit P in ln f that are thought possible, equally likely each. The shipped turbopump has 5
to 50; of a light cage whose start decides P rises over a decade of friction, a slope of 2."""

PLACES: Array = np.linspace(-1.3 * NEAR, 1.3 * NEAR, 81) * STEP
EITHER_SIDE = (0.1, 0.9)
ENDS_95 = (0.025, 0.975)
Look = Callable[[Ratio, int, int], Count]
"""Whirling runs at a friction: number of the first run, and how many."""

FIRST_RUNS, END_RUNS = 0.25, 0.75
"""Runs spent near a crossing, in parts of those of the settings: on a first look from each kick; then on a
crossing that may be the outermost, or that of one kick alone."""


class Side(Enum):
    """Why there is no crossing: P is above the target everywhere, or below it."""

    ABOVE = "above"
    BELOW = "below"


@dataclass(frozen=True, slots=True)
class Crossing:
    """Friction at which P rises through its target, with the 95 % interval that the counts leave."""

    value: Ratio
    low: Ratio
    high: Ratio


Found = Crossing | Side


def ends_of(found: Found | None) -> tuple[Ratio, Ratio, Ratio] | tuple[None, None, None]:
    """Value and interval of a crossing; None where there is none."""
    return (found.value, found.low, found.high) if isinstance(found, Crossing) else (None, None, None)


def notes_of(counts: Mapping[MetrePerSecond, Response]) -> tuple[str, ...]:
    """Those of the counts from each kick, the weakest first."""
    return tuple(note for _, response in sorted(counts.items()) for note in response.notes)


class Response:
    """Counts on the ladder for one restitution factor and kick; no run is counted twice.

    `look` counts runs; `runs` of the settings limit those at an end of the ladder.
    """

    def __init__(self, look: Look, runs: int) -> None:
        self.counts: dict[int, Count] = {}
        self.look, self._runs, self._next = look, runs, 0

    @property
    def notes(self) -> list[str]:
        """Those of its counts, rising frictions first."""
        return [note for _, count in sorted(self.counts.items()) for note in count.notes]

    def add(self, cell: int, runs: int) -> Count:
        """Count more runs at a place of the ladder."""
        found = self.look(LADDER[cell], self._next, runs)
        self._next += runs
        self.counts[cell] = self.counts.get(cell, Count(0, 0)) + found
        return self.counts[cell]

    def first(self, cell: int) -> Count:
        """Return the count at a place, after a first look."""
        return self.counts.get(cell) or self.add(cell, min(BATCH, self._runs))

    def reaches(self, cell: int, target: Ratio) -> bool:
        """True if P reaches the target at an end of the ladder; a first look that agrees is enough."""
        count = self.first(cell)
        while 0 < count.whirling < count.runs < self._runs:
            low, high = count.interval()
            if not low <= target <= high:
                break
            count = self.add(cell, min(count.runs, self._runs - count.runs))
        return count.share >= target

    def crossing(self, target: Ratio, runs: int, guess: Ratio) -> Found:
        """Friction at which P passes the target, or the side on which P lies all along.

        Both ends of the ladder are counted first, since P need not rise. Where P wavers through the target
        more than once, one of the crossings is found. `runs` are spent near it. `guess`, a friction near it,
        changes the time, and the result only within its interval.
        """
        if self.reaches(0, target):
            return Side.ABOVE
        if not self.reaches(LAST, target):
            return Side.BELOW
        low, high = self._bracket(target, cell_of(guess))
        if low == 0:
            return Crossing(0.5 * LADDER[1], 0.0, LADDER[1])
        return self._refined(target, runs, 0.5 * (math.log(LADDER[low]) + math.log(LADDER[high])))

    def _bracket(self, target: Ratio, start: int) -> tuple[int, int]:
        """Places not far apart, P below the target at the first and not at the second."""
        low = high = start
        step = 2
        if self.first(start).share >= target:
            while low > 0 and self.first(low).share >= target:
                low, high, step = max(0, low - step), low, 2 * step
        else:
            while high < LAST and self.first(high).share < target:
                low, high, step = high, min(LAST, high + step), 2 * step
        while high - low > (NEAR if low > 0 else 1):  # what is farther off does not show the middle
            middle = (low + high) // 2
            low, high = (low, middle) if self.first(middle).share >= target else (middle, high)
        return low, high

    def _refined(self, target: Ratio, runs: int, centre: float) -> Crossing:
        """Count where the target may lie, in turn on either side of it, until the runs are spent."""
        for turn in range(TURNS):
            near = self._near(centre)
            place = centre + PLACES
            weight = posterior(near, place, target)
            centre = quantile(place, weight, 0.5)
            jump = self._jump(centre, target)
            if jump is not None:
                return jump
            if sum(count.runs for count in self._near(centre).values()) >= runs:
                break
            wanted = math.exp(quantile(place, weight, EITHER_SIDE[turn % 2]))
            self.add(cell_of(wanted), max(min(BATCH, runs), runs // 12))
        low, high = (math.exp(quantile(place, weight, q)) for q in ENDS_95)
        return Crossing(math.exp(centre), low, min(high, SEARCHED_FRICTION))

    def steepness(self, friction: Ratio, target: Ratio) -> float:
        """Slope of logit P in ln f near a crossing [-]."""
        centre = math.log(friction)
        return steepness(self._near(centre), centre + PLACES, target)

    def _near(self, centre: float) -> dict[float, Count]:
        """Counts around a logarithm of friction."""
        return {
            math.log(LADDER[cell]): count
            for cell, count in sorted(self.counts.items())
            if cell > 0 and abs(math.log(LADDER[cell]) - centre) <= (NEAR + 0.01) * STEP
        }

    def _jump(self, centre: float, target: Ratio) -> Crossing | None:
        """Return the whole cell if P jumps inside it from none to all."""
        high = next((i for i in range(1, LAST) if math.log(LADDER[i]) > centre), LAST)
        below, above = (self.counts.get(i, Count(0, 0)) for i in (high - 1, high))
        agree = below.unanimous(target) and above.unanimous(target)
        if high == 1 or not agree or below.share >= above.share:
            return None
        low, top = LADDER[high - 1], LADDER[high]
        return Crossing(math.sqrt(low * top), low, top)


def cell_of(friction: Ratio) -> int:
    """Place of the ladder nearest to a friction, neither its first nor its last."""
    steps = round(math.log(max(friction, LADDER[1]) / SEARCHED_FRICTION) / STEP)
    return min(max(LAST + steps, 1), LAST - 1)


def posterior(counts: Mapping[float, Count], place: Array, target: Ratio) -> Array:
    """Probability that P passes the target at each place, from counts against ln f; shape (place,) [-]."""
    weight = _likelihood(counts, place, target).sum(axis=-1)
    return np.asarray(weight / weight.sum())


def steepness(counts: Mapping[float, Count], place: Array, target: Ratio) -> float:
    """Slope of logit P in ln f by the same counts: the mean of what they leave possible [-]."""
    weight = _likelihood(counts, place, target).sum(axis=0)
    return float(SLOPES @ weight / weight.sum())


def _likelihood(counts: Mapping[float, Count], place: Array, target: Ratio) -> Array:
    """Likelihood of each place with each of `SLOPES`, shape (place, slope), over the largest [-]."""
    x = np.array(list(counts))
    whirling = np.array([count.whirling for count in counts.values()], dtype=np.float64)
    runs = np.array([count.runs for count in counts.values()], dtype=np.float64)
    logit = math.log(target / (1.0 - target)) + SLOPES[:, None] * (x - place[:, None])[:, None, :]
    likelihood = whirling * logit - runs * np.logaddexp(0.0, logit)
    total = likelihood.sum(axis=-1)
    return np.asarray(np.exp(total - total.max()))


def quantile(place: Array, weight: Array, share: Ratio) -> float:
    """Place below which a share of the weight lies."""
    return float(np.interp(share, np.cumsum(weight) - 0.5 * weight, place))


def outermost(
    responses: Mapping[MetrePerSecond, Response], target: Ratio, runs: int, guess: Ratio, way: int = 1
) -> tuple[Found, MetrePerSecond]:
    """Crossing that comes first over the kicks, going up (`way` 1) or down (-1) in friction, and its kick.

    A side where a kick has no crossing but would come first, or where none has one. After a first look at
    each kick, `runs` of the settings are spent on those whose crossing may come first.
    """
    few, more = (max(1, round(part * runs)) for part in (FIRST_RUNS, END_RUNS))
    found: dict[MetrePerSecond, Found] = {}
    for kick, response in responses.items():
        found[kick] = response.crossing(target, few, guess)
        known = [way * one.value for one in found.values() if isinstance(one, Crossing)]
        guess = way * min(known, default=way * guess)
    before_all, farthest = Side.ABOVE if way > 0 else Side.BELOW, math.inf
    crossings = [(way * one.value, kick, one) for kick, one in found.items() if isinstance(one, Crossing)]
    for _, kick, one in () if before_all in found.values() else sorted(crossings, key=itemgetter(0)):
        if min(way * one.low, way * one.high) <= farthest:
            again = found[kick] = responses[kick].crossing(target, more, one.value)
            if isinstance(again, Crossing):
                farthest = min(farthest, max(way * again.low, way * again.high))
    if before_all in found.values():
        return before_all, next(kick for kick, one in found.items() if one is before_all)
    ends = [(way * one.value, way * kick) for kick, one in found.items() if isinstance(one, Crossing)]
    first = way * (min(ends)[1] if ends else max(way * kick for kick in found))
    return found[first], first


def powers_between(soft: object, stiff: object, share: Ratio, names: Sequence[str]) -> dict[str, Any]:
    """Return amounts between those of two pockets, a power of stiffness each; None where an end has none.

    `share` of the way between the logarithms of stiffness.
    """
    ends = {name: (getattr(soft, name), getattr(stiff, name)) for name in names}
    return {
        name: None if low is None or high is None else low ** (1.0 - share) * high**share
        for name, (low, high) in ends.items()
    }


HAND: Ratio = 0.42
"""Critical friction over the linear limit, sqrt(2 k M/Z)/C, within 0.1 for turbopumps (15 bearings,
docs/theory/ranking.md)."""

AMPLE: Ratio = 1.5
"""Safety factor by balls of one state from which free balls are not asked."""

POWERS = (
    "own_critical_friction",
    "own_critical_friction_low",
    "own_critical_friction_high",
    "estimated_critical_friction",
)
"""What a power of stiffness gives between two."""

TINY: Ratio = 1e-12
"""Least friction whose logarithm is taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CageLimit:
    """Critical friction of a cage at its own race damping, among the balls of its model.

    Where no searched friction makes half the runs whirl, the value is None and `low` is the highest that was
    searched; it is 0 where they whirl without friction.
    """

    own_critical_friction: Ratio | None
    """At which it whirls half the runs, from the disturbance from which that is lowest."""
    own_critical_friction_low: Ratio  # of its 95 % interval, from the number of runs
    own_critical_friction_high: Ratio | None  # upper end of it
    critical_kick: MetrePerSecond  # disturbance from which the critical friction is lowest
    critical_ball: str  # that decided the critical friction
    estimated_critical_friction: Ratio  # by the closed law, to check the order
    steepness: float | None = None  # slope of the logit of P(whirl) in ln f there
    notes: tuple[str, ...] = ()  # on runs that do not show where they end

    @property
    def own(self) -> dict[str, Any]:
        """Critical friction with the ends of its interval, by their names."""
        return {name: getattr(self, name) for name in POWERS[:3]}

    def between(self, stiff: CageLimit, share: Ratio) -> CageLimit | None:
        """That of a pocket a share of the way to the stiffer one of `stiff`; None if one has no value."""
        values = powers_between(self, stiff, share, POWERS)
        if not all(values.values()):
            return None
        balls = dict.fromkeys((self.critical_ball, stiff.critical_ball))
        nearer = stiff if share > 0.5 else self
        return replace(nearer, critical_ball=" and ".join(balls), notes=(), **values)


@dataclass(frozen=True, slots=True, kw_only=True)
class SafetyFactor:
    """Critical friction over the friction in the pocket, with its 95 % interval."""

    safety_factor: Ratio | None = None  # critical friction over friction; null beyond what was searched
    safety_factor_low: Ratio | None = None  # of its 95 % interval
    safety_factor_high: Ratio | None = None  # upper end of it


def cage_limit(
    solution: Solution,
    settings: StabilitySettings,
    runner: Runner,
    *,
    highest: Ratio = inf,
    change: Mapping[str, Any] | None = None,
) -> CageLimit:
    """Critical friction of a solved study's cage, by the ball that its model asks for.

    With the ball "auto", by balls of one state, which may be up to a quarter too low but, with even orbits,
    not too high; by free balls where the friction of a whirl there exceeds a quarter of what the races hold,
    or orbits are uneven, unless the critical friction is `AMPLE` times the `highest` friction that it will be
    compared with, `UNEVEN` times more with uneven orbits.
    `change` has other values of fields of the cage.
    """

    def cage(friction: Ratio, ball: BallModel | None = None) -> MovingCage:
        return replace(moving_cage(solution, friction, ball), **(change or {}))

    found = _limit(cage(0.0), settings, runner)
    at = found.own_critical_friction
    if at is None or not asks_free(solution, cage(at), highest):
        return found
    return _limit(cage(0.0, BallModel.FREE), settings, runner, at)


def asks_free(solution: Solution, cage: MovingCage, highest: Ratio) -> bool:
    """Whether free balls decide, for a cage whose friction is its critical one with balls of one state."""
    is_uneven, at = has_uneven_orbits(cage), cage.ball_cage_friction
    if solution.design.ball_model is not BallModel.AUTO:
        return False
    if at >= AMPLE * (UNEVEN if is_uneven else 1.0) * highest:
        return False
    return is_uneven or whirl_share(cage, transmitted_force(solution)) > ENOUGH


def free_work(solution: Solution, settings: StabilitySettings, highest: Ratio) -> float:
    """Work among free balls over that with balls of one state, as far as it can be foreseen [-]."""
    estimate = hand_estimate(moving_cage(solution, 0.0))
    if not asks_free(solution, moving_cage(solution, estimate), highest):
        return 0.0
    return FEWER * cost(moving_cage(solution, estimate, BallModel.FREE), settings.middle_kick)


def _limit(
    cage: MovingCage, settings: StabilitySettings, runner: Runner, guess: Ratio | None = None
) -> CageLimit:
    estimate, settings = hand_estimate(cage), settings_for(settings, cage)
    counts = responses(cage, settings, settings.kicks, runner)
    found, kick = outermost(counts, 0.5, settings.runs, estimate if guess is None else guess)
    value, low, high = ends_of(found)
    if isinstance(found, Side):
        value, low, high = (0.0, 0.0, 0.0) if found is Side.ABOVE else (None, SEARCHED_FRICTION, None)
    return CageLimit(
        steepness=counts[kick].steepness(value, 0.5) if value else None,
        own_critical_friction=value,
        own_critical_friction_low=low or 0.0,
        own_critical_friction_high=high,
        critical_kick=kick,
        critical_ball=ball_words(cage),
        estimated_critical_friction=estimate,
        notes=notes_of(counts),
    )


def hand_estimate(cage: MovingCage) -> Ratio:
    """Critical friction by the closed law, 0.42 of the linear limit among dampers of a slow push [-]."""
    return HAND * damped_critical_friction(cage, cage.slow_damping)


def spread(drawn: Sequence[Solution]) -> float:
    """Half the 95 % interval of what uncertain inputs do to the logarithm of the critical friction [-].

    By the closed law, which follows mass, stiffness and damping of the drawn cages.
    """
    logs = [math.log(hand_estimate(moving_cage(one, 0.0))) for one in drawn]
    return NORMAL_95 * float(np.std(logs, ddof=1)) if len(logs) > 1 else 0.0


def safety_factor(
    limit: CageLimit, friction: Ratio, interval: tuple[Ratio, Ratio], spread: float = 0.0
) -> SafetyFactor:
    """Safety factor of a friction in the pocket; without friction the factor has no value.

    Deviations of the logarithms add as squares. `spread` is half the 95 % interval of what uncertain inputs
    do to the logarithm of the critical friction. Beyond what was searched only the lower end is known, and
    of a friction whose interval begins at 0.
    """
    value = limit.own_critical_friction
    low, high = limit.own_critical_friction_low, limit.own_critical_friction_high
    least, most = interval
    if value == 0.0:
        return SafetyFactor(safety_factor=0.0, safety_factor_low=0.0, safety_factor_high=0.0)
    if friction <= 0.0:
        return SafetyFactor()
    if value is None:
        return SafetyFactor(safety_factor_low=low / most)

    def reach(of_limit: Ratio, of_friction: Ratio) -> float:
        ratios = (max(of_limit, TINY) / value, of_friction / friction)
        return math.hypot(*map(math.log, ratios), spread)

    factor, upper = value / friction, value if high is None else high
    return SafetyFactor(
        safety_factor=factor,
        safety_factor_low=factor * math.exp(-reach(low, most)),
        safety_factor_high=factor * math.exp(reach(upper, least)) if least > 0.0 else None,
    )
