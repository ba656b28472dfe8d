"""From the runs of an ensemble to a verdict, its probability, its evidence and its reason."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from separatrix.cage.closed_forms import drift_rate_law, drifts, drive_energy, felt_mass
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.cage.outcome import Cause, RunOutcome
from separatrix.chain.pocket_friction import REFERENCE
from separatrix.friction.friction_file import FRICTION_LIMIT
from separatrix.ground.units import (
    Array,
    Hertz,
    Joule,
    Metre,
    MetrePerSecond,
    Newton,
    PerSecond,
    Radian,
    Ratio,
    Rows,
    Second,
    Watt,
)
from separatrix.study.study import BallModel
from separatrix.verdict import reasons
from separatrix.verdict.reasons import CageMotion, cage_motion, driven_by_land, largest_room, left_pockets

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble
    from separatrix.chain.solution import Solution


class Verdict(Enum):
    """What an ensemble of runs says of the cage."""

    STABLE = "The cage is stable."
    UNSTABLE = "The cage is unstable."
    UNDECIDED = "The runs do not decide."


CLEAR = 0.9
"""Share of runs that settle or roll, at least, of a stable cage."""

FEW = 0.5
"""Share that the interval of whirling runs lies above, of an unstable cage."""

NORMAL_95 = 1.959963984540054


@dataclass(frozen=True, slots=True, kw_only=True)
class KickCount:
    """Where the runs from one initial disturbance end."""

    kick: MetrePerSecond
    settles: int  # runs of this outcome, as those that follow
    rolls: int  # runs of this outcome
    whirls: int  # runs of this outcome
    drifts: int  # runs of this outcome
    unresolved: int  # runs of this outcome
    whirls_by_land: int
    """Of those that whirl: friction on the land drives them, and the pockets take energy from them."""
    probability_stable: Ratio  # share of the runs that settle or roll
    probability_low: Ratio  # of its 95 % Wilson interval
    probability_high: Ratio  # upper end of it

    @property
    def runs(self) -> int:
        """Runs from this kick."""
        return self.calm + self.whirls + self.drifts + self.unresolved

    @property
    def calm(self) -> int:
        """Runs that settle or roll."""
        return self.settles + self.rolls

    @property
    def is_by_land(self) -> bool:
        """Whether friction on the land drives most of the runs that whirl."""
        return 2 * self.whirls_by_land > self.whirls


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """Verdict on a cage with its evidence: that of the worst disturbance, but for what says "any run".

    Medians are over the last part of the runs that end in `cage_motion`, or of all if that is None.
    """

    verdict: Verdict  # STABLE, UNSTABLE or UNDECIDED
    probability_stable: Ratio  # share of the runs that settle or roll
    probability_low: Ratio  # of its 95 % Wilson interval
    probability_high: Ratio  # upper end of it
    worst_kick: MetrePerSecond
    """Of the disturbances from which most runs whirl, if any, the one from which fewest settle or roll."""
    by_kick: Annotated[tuple[KickCount, ...], Rows("kick", "by_kick_", label="kick")]  # where all runs end
    reason: str  # one sentence
    ball: str  # that decided: "damper", "one state" or "free"
    ball_reason: str | None = None  # why that ball decided; null where the study forces it
    cage_motion: CageMotion | None  # what most runs from the worst disturbance end in; or null
    growth_rate: PerSecond
    """Mean over all runs of half the logarithmic rate of the kinetic energy in their second half."""
    growth_rate_low: PerSecond | None  # of Student's 95 % interval; null with fewer than two runs
    growth_rate_high: PerSecond | None  # the other end
    largest_offset: Metre  # of the cage centre, any run
    mean_offset: Metre  # median
    orbit_evenness: Ratio
    """Median of the offset's spread over its mean: 0 on a circle about the axis, 0.52 in a motion without any
    preferred radius."""
    drift_rate: PerSecond  # median growth rate of the mean offset of the runs that do not whirl
    drift_rate_law: PerSecond  # of the linear law for a cage without a land; 0 with one
    largest_contact_force: Newton  # between a ball and its pocket, any run
    largest_land_force: Newton  # any run
    force_limit: Newton | None
    """Pocket force whose friction is all that the races hold, beyond which this ball has no meaning; null
    without one."""
    force_exceeds_races: bool  # whether the largest contact force is beyond that
    driven_by_land: bool  # whether friction on the land drives most of the runs that whirl
    left_pocket: int  # runs, of all, in which a ball reached the edge of its pocket's wall
    pocket_impact_shares: Annotated[tuple[Ratio, ...], ("ball",)]  # of each pocket in all, any run; or zeros
    land_impact_share: Ratio  # of the land in all impacts
    whirl_frequency: Hertz  # median
    whirl_direction: int  # 1 forward, -1 backward, 0 none
    whirl_ratio: Ratio | None
    """Median speed at which the centre orbits the bearing axis, in the fixed frame, over the ball set's: 1
    goes round with the balls; null if the ball set is at rest."""
    drive_energy: Joule  # kinetic energy that frame and loads can give the cage without friction
    end_energy: Joule  # median of what it has
    pocket_power: Watt  # median that pocket friction feeds into the cage; below 0 it takes from it
    land_power: Watt  # the same of the land
    rubbing_force: Newton  # median of the mean force on the land; 0 if none rubs
    rubbing_speed: MetrePerSecond  # median sliding speed there
    rubbing_power: Watt  # median that rubbing on the land turns to heat
    energy_imbalance: Ratio  # the worst of all runs
    duration: Second  # asked for
    longest_run: Second  # of all
    runs: int  # from each initial disturbance
    impact_rate: PerSecond  # of all pockets, median
    largest_tilt: Radian | None = None  # any run; null in the plane, as what follows
    axial_travel: Metre | None = None  # between the ends of the axial motion, any run
    cone_ratio: Ratio | None = None
    """Median speed at which the lean of the axis goes round, in the fixed frame, over the ball set's."""

    @property
    def worst(self) -> KickCount:
        """Where the runs from the worst disturbance end."""
        return next(one for one in self.by_kick if one.kick == self.worst_kick)

    @property
    def is_by_land(self) -> bool:
        """Whether friction on the land, and not in the pockets, makes the cage unstable."""
        return self.verdict is Verdict.UNSTABLE and self.driven_by_land


def is_calm(outcome: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each run settles, or rolls in its pockets; same shape."""
    return np.asarray((outcome == RunOutcome.SETTLES) | (outcome == RunOutcome.ROLLS))


def kick_counts(ensemble: Ensemble) -> tuple[KickCount, ...]:
    """Where the runs from each kick end."""
    runs, found = ensemble.outcome.shape[1], []
    counted = np.stack([ensemble.count(outcome) for outcome in RunOutcome], axis=1)
    driven = np.count_nonzero(driven_by_land(ensemble), axis=1)
    for kick, counts, land in zip(ensemble.kicks.tolist(), counted.tolist(), driven.tolist(), strict=True):
        settles, whirls, drifting, unresolved, rolls = counts
        low, high = wilson_interval(settles + rolls, runs)
        found.append(
            KickCount(
                kick=kick,
                settles=settles,
                rolls=rolls,
                whirls=whirls,
                drifts=drifting,
                unresolved=unresolved,
                whirls_by_land=land,
                probability_stable=(settles + rolls) / runs,
                probability_low=low,
                probability_high=high,
            )
        )
    return tuple(found)


def worst(counts: tuple[KickCount, ...]) -> int:
    """Place of the worst kick: of those from which most runs whirl, if any, the one with fewest calm runs.

    Calm runs settle or roll. Of several it is the one with most whirls, then with most that roll.
    """
    whirling = [i for i, count in enumerate(counts) if is_mostly(count.whirls, count.runs)]

    def goodness(i: int) -> tuple[int, int, int, int]:
        one = counts[i]
        return one.calm, -one.whirls, -one.rolls, i

    return min(whirling or range(len(counts)), key=goodness)


def judge(cage: MovingCage, ensemble: Ensemble, *, capacity: Newton | None = None) -> Judgement:
    """Judge a cage by its ensemble, at the worst kick.

    UNSTABLE: the 95 % interval of the share of its runs that whirl lies above one half, or above one tenth
    if friction on the land drives most of them: no factor on friction in the pockets tells how far that is
    from being stable. STABLE: at least 90 % settle or roll in their pockets, the lower end of that share's
    95 % interval is above one half, and the cage neither drifts nor ends outside its pockets nor left its
    room nor, in any run, the range of numbers. UNDECIDED otherwise. The rule is ours. `capacity` is the
    largest force that the races transmit to a ball, f_BT (Q_i + Q_o) [N], by default that of its law of
    traction.
    """
    counts = kick_counts(ensemble)
    verdict, because = decide(cage, ensemble, counts)
    at = worst(counts)
    outcome = ensemble.outcome[at]
    whirling, motion = outcome == RunOutcome.WHIRLS, cage_motion(ensemble, at)
    shown = np.ones_like(whirling) if motion is None else outcome == ENDS[motion]
    rate, rate_low, rate_high = _growth(ensemble.growth_rate[at])
    pockets, land = _impact_shares(ensemble)
    low, high = ensemble.axial_low, ensemble.axial_high
    mean, spread = ensemble.mean_offset[at][shown], ensemble.offset_spread[at][shown]
    is_off = mean > 0.0  # runs that left the axis at all

    def median(name: str) -> float:
        return float(np.median(getattr(ensemble, name)[at][shown]))

    rubbing = (ensemble.rubbing_force * ensemble.rubbing_speed)[at][shown]
    largest, limit = float(ensemble.largest_contact_force.max()), reasons.force_limit(cage, capacity)
    return Judgement(
        verdict=verdict,
        probability_stable=counts[at].probability_stable,
        probability_low=counts[at].probability_low,
        probability_high=counts[at].probability_high,
        worst_kick=counts[at].kick,
        by_kick=counts,
        reason=because,
        ball=reasons.ball_words(cage),
        cage_motion=motion,
        growth_rate=rate,
        growth_rate_low=rate_low,
        growth_rate_high=rate_high,
        largest_offset=float(ensemble.largest_offset.max()),
        mean_offset=median("mean_offset"),
        orbit_evenness=reasons.median(spread[is_off] / mean[is_off]),
        drift_rate=reasons.median(ensemble.drift_rate[at][~whirling]),
        drift_rate_law=drift_rate_law(cage),
        largest_contact_force=largest,
        largest_land_force=float(ensemble.largest_land_force.max()),
        force_limit=limit if math.isfinite(limit) else None,
        force_exceeds_races=largest > limit,
        driven_by_land=counts[at].is_by_land,
        left_pocket=int(np.count_nonzero(ensemble.left_ball)),
        pocket_impact_shares=tuple(pockets.tolist()),
        land_impact_share=land,
        whirl_frequency=median("whirl_frequency"),
        whirl_direction=int(np.sign(median("whirl_direction"))),
        whirl_ratio=_whirl_ratio(cage, median("orbit_speed")),
        drive_energy=drive_energy(cage),
        end_energy=median("end_energy"),
        pocket_power=median("pocket_power"),
        land_power=median("land_power"),
        rubbing_force=median("rubbing_force"),
        rubbing_speed=median("rubbing_speed"),
        rubbing_power=cage.land_friction * float(np.median(rubbing)),
        energy_imbalance=float(ensemble.energy_imbalance.max()),
        duration=ensemble.duration,
        longest_run=float(ensemble.followed.max()),
        runs=ensemble.outcome.shape[1],
        impact_rate=median("strike_rate"),
        largest_tilt=None if ensemble.largest_tilt is None else float(ensemble.largest_tilt.max()),
        axial_travel=None if low is None or high is None else float((high - low).max()),
        cone_ratio=None if ensemble.cone_speed is None else _whirl_ratio(cage, median("cone_speed")),
    )


ENDS = {
    CageMotion.WHIRLING: RunOutcome.WHIRLS,
    CageMotion.DRIFTING: RunOutcome.DRIFTS,
    CageMotion.ROLLING: RunOutcome.ROLLS,
    CageMotion.SETTLED: RunOutcome.SETTLES,
    CageMotion.ON_THE_LAND: RunOutcome.SETTLES,
}
"""Outcome of the runs that end in a motion."""


def wilson_interval(successes: int, count: int, normal: float = NORMAL_95) -> tuple[Ratio, Ratio]:
    """Wilson's interval of a share, 95 % or that of another normal quantile [-]; 0 to 1 without a trial."""
    if count == 0:
        return 0.0, 1.0
    p, z2 = successes / count, normal**2
    middle = (p + z2 / (2 * count)) / (1 + z2 / count)
    half = normal / (1 + z2 / count) * math.sqrt(p * (1 - p) / count + z2 / (4 * count * count))
    low, high = max(0.0, middle - half), min(1.0, middle + half)
    return min(low, p), max(high, p)  # rounding would leave none and all just outside


def _growth(rates: Array) -> tuple[float, float | None, float | None]:
    """Mean growth rate of some runs, and Student's 95 % interval of it; fewer than two runs have none."""
    mean, count = float(rates.mean()), rates.size
    if count < 2:
        return mean, None, None
    half = float(stdtrit(count - 1, 0.975) * np.std(rates, ddof=1) / math.sqrt(count))
    return mean, mean - half, mean + half


def _impact_shares(ensemble: Ensemble) -> tuple[Array, Ratio]:
    """Share of each pocket in the impacts of pockets, and of the land in all."""
    pockets, land = ensemble.pocket_impacts.sum(axis=(0, 1)), int(ensemble.land_impacts.sum())
    met = int(pockets.sum())
    return np.asarray(pockets / max(met, 1), dtype=np.float64), land / max(met + land, 1)


def _whirl_ratio(cage: MovingCage, orbit_speed: float) -> Ratio | None:
    return orbit_speed / abs(cage.cage_speed) if cage.cage_speed != 0.0 else None  # runs are turned forward


def decide(
    cage: MovingCage, ensemble: Ensemble, counts: tuple[KickCount, ...] | None = None
) -> tuple[Verdict, str]:
    """Verdict and the sentence that gives its reason: `judge` without the rest of the evidence."""
    counts = counts or kick_counts(ensemble)
    at = worst(counts)
    count = counts[at]
    if is_mostly(count.whirls, count.runs) or is_taken_by_land(count):
        return Verdict.UNSTABLE, reasons.whirls(cage, ensemble, at, by_land=count.is_by_land)
    if wilson_interval(count.runs, count.runs)[0] <= FEW:
        return Verdict.UNDECIDED, reasons.too_few(count.runs)
    if not is_clear(count.calm + count.drifts, count.runs):
        is_sure = count.probability_low > FEW and count.probability_high < CLEAR
        return Verdict.UNDECIDED, reasons.mixed(ensemble, counts, at, is_sure=is_sure)
    if (ensemble.cause == Cause.NOT_FINITE).any():
        return Verdict.UNDECIDED, reasons.not_finite(ensemble)
    if drifts(cage) or not is_clear(count.calm, count.runs):
        return Verdict.UNDECIDED, reasons.drift(cage, ensemble, at)
    left = left_pockets(cage, ensemble) & is_calm(ensemble.outcome)
    if any(not is_clear(int(n), count.runs) for n in count.runs - left.sum(axis=1)):
        return Verdict.UNDECIDED, reasons.out_of_pockets(cage, ensemble, left)
    if ensemble.largest_offset.max() > largest_room(cage):
        return Verdict.UNDECIDED, reasons.beyond_room(cage, ensemble)
    return Verdict.STABLE, reasons.settles(cage, ensemble, at)


def is_mostly(count: int, runs: int) -> bool:
    """Whether more than half of the runs do so, beyond the scatter of so few."""
    return wilson_interval(count, runs)[0] > FEW


def whirls_too_often(count: KickCount) -> bool:
    """Whether more runs whirl than a stable cage may have, beyond their scatter."""
    return wilson_interval(count.whirls, count.runs)[0] > 1.0 - CLEAR


def is_taken_by_land(count: KickCount) -> bool:
    """Whether more runs whirl than a stable cage may have, and friction on the land drives most of these."""
    return whirls_too_often(count) and count.is_by_land


def is_clear(count: int, runs: int) -> bool:
    """Whether so large a share of the runs does so as a stable cage needs, beyond their scatter."""
    return is_mostly(count, runs) and count / runs >= CLEAR


UNEVEN: Ratio = 1.5
"""Friction over its own at which a cage whose balls have uneven orbits must be stable, too, with one state:
under radial load its critical friction was 0.85 to 1.21 of that among free balls (six bearings)."""

ENOUGH: Ratio = 0.25
"""Friction of a sustained whirl over what the races hold, up to which the ball of one state decides alone."""


def transmitted_force(solution: Solution) -> Newton:
    """Largest force that the races can transmit to the most loaded ball, f_BT (Q_i + Q_o) [N]."""
    contacts = solution.bearing
    return solution.study.film.race_friction * (contacts.inner.ellipse.load + contacts.outer.ellipse.load)


def whirl_share(cage: MovingCage, capacity: Newton) -> Ratio:
    r"""Friction of a sustained whirl over what the races hold [-].

    :math:`f N / f_{BT}(Q_i + Q_o)` with the force :math:`N = 2.5\,\Omega c_p \sqrt{k m}` of an impact, whose
    mass m is that which it feels.
    """
    speed = REFERENCE * abs(cage.cage_speed) * cage.half_play
    return cage.ball_cage_friction * speed * math.sqrt(cage.ball_cage_stiffness * felt_mass(cage)) / capacity


def has_uneven_orbits(cage: MovingCage) -> bool:
    """Whether a radial load, a moment or a tilt makes the orbital speeds of the balls uneven."""
    return len(cage.orbital_cosines) > 0


def judge_by_ball(
    solution: Solution, friction: Ratio, judged: Callable[[MovingCage], Judgement]
) -> Judgement:
    """Judge the cage of a solved study at a friction by the ball that decides: see `judge_solution`."""
    level, cage = solution.design.ball_model, moving_cage(solution, friction)
    is_uneven = level is BallModel.AUTO and has_uneven_orbits(cage)
    more = moving_cage(solution, min(UNEVEN * friction, FRICTION_LIMIT)) if is_uneven else None
    is_sure = more is None or judged(more).verdict is Verdict.STABLE
    found, share = judged(cage), whirl_share(cage, transmitted_force(solution))
    if level is not BallModel.AUTO:
        return found
    part = f"{100.0 * share:.2g} % of what the races hold"
    because = f"Friction of a whirl reaches {part}"
    if share <= ENOUGH and not is_uneven:
        because += f": below {100.0 * ENOUGH:g} % one state is enough."
    elif found.verdict is Verdict.STABLE and is_sure:
        because = "A cage that is stable with one state is stable among free balls."
        if is_uneven:
            because = f"Stable with one state at {UNEVEN:g} times its friction, it is so among free balls."
    else:
        because = "The balls have uneven orbits" if is_uneven else because
        because += f"; with one state the verdict is {found.verdict.name}."
        found = judged(moving_cage(solution, friction, BallModel.FREE))
    return replace(found, ball_reason=because)


def judge_solution(solution: Solution, friction: Ratio, run: Callable[[MovingCage], Ensemble]) -> Judgement:
    """Judge the cage of a solved study at a friction by the ball that decides.

    That is the one of the study, or one state until free balls have to be asked. The critical friction with
    one state is 0.74 to 1.00 of that among free balls (ten bearings without radial load, the worse of two
    speeds; with one see `UNEVEN`): its STABLE is
    safe, its UNSTABLE may be too early. They agree while the friction of a sustained whirl stays below a
    quarter of what the races hold. `run` makes the runs of a cage, always with the same settings.
    """
    capacity = transmitted_force(solution)
    return judge_by_ball(solution, friction, lambda cage: judge(cage, run(cage), capacity=capacity))
