"""From the runs of an ensemble to a verdict, its probability, its evidence and its reason."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage import reason
from separatrix.cage.drive import drift_rate_law, drifts, drive_energy
from separatrix.cage.interval import mean_half_width, wilson_interval
from separatrix.cage.orbit import CageMotion, cage_motion, driven, left_pockets, sustained
from separatrix.cage.planar import PlanarCage, RunOutcome, Verdict
from separatrix.units import Array, Hertz, Joule, Metre, MetrePerSecond, Newton, Ratio, Second

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble

Counts = NDArray[np.int64]
Mask = NDArray[np.bool_]

CLEAR = 0.9
FEW = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """Verdict on a cage with its evidence.

    Attributes
    ----------
    verdict : Verdict
        STABLE, UNSTABLE or UNDECIDED.
    probability_stable, probability_low, probability_high : float
        Share of all runs that die, and its 95 % Wilson interval [-].
    reason : str
        One sentence.
    cage_motion : CageMotion
        STABLE, CIRCLING or UNSTABLE: what the centre does at the end of the runs from the worst kick.
    growth_rate : float
        Mean over the runs from `growth_kick` of half the logarithmic rate of the kinetic energy [1/s].
    growth_rate_low, growth_rate_high : float or None
        Student's 95 % interval of that mean; None where fewer than two runs tell none [1/s].
    growth_kick : float
        The kick with the largest mean growth rate [m/s].
    largest_offset, mean_offset : float
        Largest offset of the cage centre in any run; median over the runs of the mean offset at the end [m].
    orbit_evenness : float
        Median over the runs of the offset's spread over its mean: 0 on a circle about the axis, 0.52 in a
        motion without any preferred radius [-].
    drift_rate, drift_rate_law : float
        Median growth rate of the mean offset over the runs that went to the end, and the linear law's for a
        cage without a land; 0 with one [1/s].
    largest_contact_force, largest_land_force : float
        Largest force between a ball and its pocket, and of the land, in any run [N].
    pocket_impact_shares : ndarray
        Share of each pocket in the impacts of balls, all runs, shape (ball,); zeros if there was none [-].
    land_impact_share : float
        Share of the land in all impacts [-].
    whirl_frequency, whirl_direction
        Medians over the runs that grow, over all runs if none does [Hz]; 1 forward, -1 backward, 0 none.
    whirl_ratio : float or None
        Speed at which the centre orbits the bearing axis, in the fixed frame, over the ball set's; median
        over the same runs. 1 goes round with the balls. None if the ball set is at rest [-].
    drive_energy : float
        Kinetic energy that frame and loads can give the cage without a kick [J].
    energy_growth, energy_imbalance : float
        Median of the first over all runs, and the worst of the second over those whose ledger was kept [-].
    duration : float
        Of a run [s].
    runs : int
        Runs at each kick.
    """

    verdict: Verdict
    probability_stable: Ratio
    probability_low: Ratio
    probability_high: Ratio
    reason: str
    cage_motion: CageMotion
    growth_rate: float
    growth_rate_low: float | None
    growth_rate_high: float | None
    growth_kick: MetrePerSecond
    largest_offset: Metre
    mean_offset: Metre
    orbit_evenness: Ratio
    drift_rate: float
    drift_rate_law: float
    largest_contact_force: Newton
    largest_land_force: Newton
    pocket_impact_shares: Array
    land_impact_share: Ratio
    whirl_frequency: Hertz
    whirl_direction: int
    whirl_ratio: Ratio | None
    drive_energy: Joule
    energy_growth: Ratio
    energy_imbalance: Ratio
    duration: Second
    runs: int


def growth_probability(ensemble: Ensemble) -> Array:
    """Share of the runs that grow at each kick, shape (kick,) [-]."""
    return np.asarray(ensemble.count(RunOutcome.GROWS) / ensemble.outcome.shape[1], dtype=np.float64)


def judge(cage: PlanarCage, ensemble: Ensemble) -> Judgement:
    """Judge a cage by its ensemble.

    STABLE: at every kick at least 90 % of the runs die, the lower end of that share's 95 % interval is above
    one half, and the cage neither drifts, nor keeps circling, nor ends outside its pockets' play. UNSTABLE:
    at every kick the 95 % interval of the share that grows, beyond what frame and loads give by themselves,
    lies above one half. UNDECIDED otherwise. The rule is ours; it asks more of a stable cage than of an
    unstable one.
    """
    grows = ensemble.outcome == RunOutcome.GROWS
    verdict, because = decide(cage, ensemble)
    dies = int(ensemble.count(RunOutcome.DIES).sum())
    low, high = wilson_interval(dies, ensemble.outcome.size)
    told = ~ensemble.cut
    whirling = grows if grows.any() else told
    kick, rate, rate_low, rate_high = _fastest_growth(ensemble)
    pockets, land = _impact_shares(ensemble)
    return Judgement(
        verdict=verdict,
        probability_stable=dies / ensemble.outcome.size,
        probability_low=low,
        probability_high=high,
        reason=because,
        cage_motion=cage_motion(cage, ensemble),
        growth_rate=rate,
        growth_rate_low=rate_low,
        growth_rate_high=rate_high,
        growth_kick=kick,
        largest_offset=float(ensemble.largest_offset.max()),
        mean_offset=float(np.median(ensemble.mean_offset[told])),
        orbit_evenness=_evenness(ensemble),
        drift_rate=drift_rate(ensemble),
        drift_rate_law=drift_rate_law(cage),
        largest_contact_force=float(ensemble.largest_contact_force.max()),
        largest_land_force=float(ensemble.largest_land_force.max()),
        pocket_impact_shares=pockets,
        land_impact_share=land,
        whirl_frequency=float(np.median(ensemble.whirl_frequency[whirling])),
        whirl_direction=int(np.sign(np.median(ensemble.whirl_direction[whirling]))),
        whirl_ratio=_whirl_ratio(cage, ensemble, whirling),
        drive_energy=drive_energy(cage),
        energy_growth=float(np.median(ensemble.energy_growth[told])),
        energy_imbalance=float(ensemble.energy_imbalance.max()),
        duration=ensemble.duration,
        runs=ensemble.outcome.shape[1],
    )


def _fastest_growth(ensemble: Ensemble) -> tuple[float, float, float | None, float | None]:
    """Kick with the largest mean growth rate, that mean, and its interval."""
    means = ensemble.growth_rate.mean(axis=1)
    worst = int(np.argmax(means))
    mean, half = float(means[worst]), mean_half_width(ensemble.growth_rate[worst])
    low, high = (None, None) if half is None else (mean - half, mean + half)
    return float(ensemble.kicks[worst]), mean, low, high


def _evenness(ensemble: Ensemble) -> Ratio:
    """Median of spread over mean of the offset, over the runs that left the axis at all."""
    off = (ensemble.mean_offset > 0.0) & ~ensemble.cut
    return float(np.median(ensemble.offset_spread[off] / ensemble.mean_offset[off])) if off.any() else 0.0


def _impact_shares(ensemble: Ensemble) -> tuple[Array, Ratio]:
    """Share of each pocket in the impacts of pockets, and of the land in all."""
    pockets, land = ensemble.pocket_impacts.sum(axis=(0, 1)), int(ensemble.land_impacts.sum())
    met = int(pockets.sum())
    return np.asarray(pockets / max(met, 1), dtype=np.float64), land / max(met + land, 1)


def _whirl_ratio(cage: PlanarCage, ensemble: Ensemble, whirling: Mask) -> Ratio | None:
    if cage.cage_speed == 0.0:
        return None
    return float(np.median(ensemble.orbit_speed[whirling])) / abs(cage.cage_speed)  # runs are turned forward


def drift_rate(ensemble: Ensemble) -> float:
    """Median growth rate of the mean offset over the runs that do not grow; 0 if all do [1/s]."""
    held = (ensemble.outcome != RunOutcome.GROWS) & ~ensemble.cut
    return float(np.median(ensemble.drift_rate[held])) if held.any() else 0.0


def decide(cage: PlanarCage, ensemble: Ensemble) -> tuple[Verdict, str]:
    """Verdict and the sentence that gives its reason: `judge` without the rest of the evidence."""
    runs = ensemble.outcome.shape[1]
    quiet = ensemble.kicks[~_touched(ensemble)]
    if quiet.size:
        return Verdict.UNDECIDED, reason.untouched(ensemble, quiet)
    if wilson_interval(runs, runs)[0] <= FEW:
        return Verdict.UNDECIDED, f"Too few runs to decide: {runs} at each kick."
    explained = driven(cage, ensemble)
    gains = ensemble.count(RunOutcome.GROWS) - explained.sum(axis=1)
    if _mostly(gains, runs):
        return Verdict.UNSTABLE, reason.at_every_kick("The motion grows", gains, runs)
    why = _not_stable(cage, ensemble, explained)
    dies = ensemble.count(RunOutcome.DIES)
    if why:
        return Verdict.UNDECIDED, why
    return Verdict.STABLE, reason.at_every_kick("The motion dies", dies, runs)


def _not_stable(cage: PlanarCage, ensemble: Ensemble, explained: Mask) -> str:
    """Return why a cage that does not grow at every kick is not stable either; empty if it is stable."""
    runs = ensemble.outcome.shape[1]
    dies, grows = ensemble.count(RunOutcome.DIES), ensemble.count(RunOutcome.GROWS)
    if not _clear(runs - grows, runs):
        by_drive = explained.sum(axis=1)
        if _clear(runs - grows + by_drive, runs):
            return reason.too_weak(cage, ensemble, explained)
        calm, wild = dies / runs >= CLEAR, (grows - by_drive) / runs >= CLEAR
        return reason.mixed(ensemble.kicks, calm, wild, grows, by_drive, runs)
    if ensemble.count(RunOutcome.STALLED).any():
        return reason.stalled(ensemble)
    if drifts(cage) or not _clear(dies, runs):
        return reason.drift(cage, ensemble, drift_rate(ensemble))
    return _odd_end(cage, ensemble)


def _odd_end(cage: PlanarCage, ensemble: Ensemble) -> str:
    """Return what else keeps a motion that lost energy from being stable; empty if nothing does."""
    runs = ensemble.outcome.shape[1]
    circles, left = sustained(cage, ensemble), left_pockets(cage, ensemble)
    if not _clear(_without(ensemble, circles), runs):
        return reason.keeps_circling(cage, ensemble, circles)
    if not _clear(_without(ensemble, left), runs):
        return reason.out_of_pockets(cage, ensemble, left)
    return ""


def _without(ensemble: Ensemble, doing: Mask) -> Counts:
    """Runs at each kick that do not end so, shape (kick,)."""
    runs = ensemble.outcome.shape[1]
    return np.asarray(runs - np.ceil(runs * ensemble.share(doing) - 1e-9), dtype=np.int64)


def _touched(ensemble: Ensemble) -> Mask:
    """Whether any run from each kick met a ball or the land, shape (kick,): flight alone decides nothing."""
    met = (ensemble.largest_contact_force > 0.0) | (ensemble.largest_land_force > 0.0)
    return np.asarray(met.any(axis=1))


def _mostly(counts: Counts, runs: int) -> bool:
    """Whether more than half of the runs do so at every kick, beyond the scatter of so few."""
    return all(wilson_interval(int(n), runs)[0] > FEW for n in counts)


def _clear(counts: Counts, runs: int) -> bool:
    return _mostly(counts, runs) and all(n / runs >= CLEAR for n in counts)
