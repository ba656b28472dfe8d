"""From the runs of an ensemble to a verdict, its probability and its reason."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.linear import drift_law
from separatrix.cage.planar import PlanarCage, RunOutcome, Verdict
from separatrix.units import Array, Hertz, Metre, Newton, Ratio, Second

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble

Counts = NDArray[np.int64]

CLEAR = 0.9
FEW = 0.5
NORMAL_95 = 1.959963984540054


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
    largest_offset : float
        Largest offset of the cage centre in any run [m].
    drift_rate : float
        Median growth rate of the mean offset over the runs that went to the end [1/s].
    largest_contact_force : float
        Largest force between a ball and its pocket in any run [N].
    whirl_frequency, whirl_direction
        Medians over the runs that grow, over all runs if none does [Hz]; 1 forward, -1 backward, 0 none.
    energy_growth, energy_imbalance : float
        Median of the first over all runs, and the worst of the second [-].
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
    largest_offset: Metre
    drift_rate: float
    largest_contact_force: Newton
    whirl_frequency: Hertz
    whirl_direction: int
    energy_growth: Ratio
    energy_imbalance: Ratio
    duration: Second
    runs: int


def wilson_interval(successes: int, count: int) -> tuple[Ratio, Ratio]:
    """Wilson's 95 % interval of a share [-]; 0 to 1 without a trial."""
    if count == 0:
        return 0.0, 1.0
    p, z2 = successes / count, NORMAL_95**2
    middle = (p + z2 / (2 * count)) / (1 + z2 / count)
    half = NORMAL_95 / (1 + z2 / count) * math.sqrt(p * (1 - p) / count + z2 / (4 * count * count))
    return max(0.0, middle - half), min(1.0, middle + half)


def growth_probability(ensemble: Ensemble) -> Array:
    """Share of the runs that grow at each kick, shape (kick,) [-]."""
    return np.asarray(ensemble.count(RunOutcome.GROWS) / ensemble.outcome.shape[1], dtype=np.float64)


def judge(cage: PlanarCage, ensemble: Ensemble) -> Judgement:
    """Judge a cage by its ensemble.

    STABLE: at every kick at least 90 % of the runs die, the lower end of that share's 95 % interval is above
    one half, and the cage cannot drift. UNSTABLE: at every kick the 95 % interval of the share that grows
    lies above one half. UNDECIDED otherwise. The rule is ours; it asks more of a stable cage than of an
    unstable one.
    """
    runs = ensemble.outcome.shape[1]
    verdict, reason = _decide(cage, ensemble, runs)
    dies = int(ensemble.count(RunOutcome.DIES).sum())
    low, high = wilson_interval(dies, ensemble.outcome.size)
    grows = ensemble.outcome == RunOutcome.GROWS
    whirling = grows if grows.any() else np.ones_like(grows)
    return Judgement(
        verdict=verdict,
        probability_stable=dies / ensemble.outcome.size,
        probability_low=low,
        probability_high=high,
        reason=reason,
        largest_offset=float(ensemble.largest_offset.max()),
        drift_rate=float(np.median(ensemble.drift_rate[~grows])) if not grows.all() else 0.0,
        largest_contact_force=float(ensemble.largest_contact_force.max()),
        whirl_frequency=float(np.median(ensemble.whirl_frequency[whirling])),
        whirl_direction=int(np.sign(np.median(ensemble.whirl_direction[whirling]))),
        energy_growth=float(np.median(ensemble.energy_growth)),
        energy_imbalance=float(ensemble.energy_imbalance.max()),
        duration=ensemble.duration,
        runs=runs,
    )


def _decide(cage: PlanarCage, ensemble: Ensemble, runs: int) -> tuple[Verdict, str]:
    """Verdict and the sentence that gives its reason."""
    dies, grows = ensemble.count(RunOutcome.DIES), ensemble.count(RunOutcome.GROWS)
    stalled, drifted = ensemble.count(RunOutcome.STALLED), ensemble.count(RunOutcome.DRIFT)
    quiet = ensemble.kicks[~_touched(cage, ensemble)]
    if quiet.size:
        duration = f"{ensemble.duration:.3g} s"
        return (
            Verdict.UNDECIDED,
            f"Too short to decide: from {quiet[0]:g} m/s nothing touches within {duration}.",
        )
    if wilson_interval(runs, runs)[0] <= FEW:
        return Verdict.UNDECIDED, f"Too few runs to decide: {runs} at each kick."
    if _mostly(grows, runs):
        return Verdict.UNSTABLE, f"The motion grows in {_percent(grows, runs)} of the runs at every kick."
    if not _clear(dies + drifted + stalled, runs):
        return Verdict.UNDECIDED, _mixed_reason(ensemble.kicks, dies, grows, runs)
    if stalled.any():
        count, total = int(stalled.sum()), ensemble.outcome.size
        return Verdict.UNDECIDED, f"{count} of {total} runs met too many impacts in no time and were ended."
    if drifts(cage) or not _clear(dies, runs):
        return Verdict.UNDECIDED, _drift_reason(cage, ensemble)
    return Verdict.STABLE, f"The motion dies in {_percent(dies, runs)} of the runs at every kick."


def _touched(cage: PlanarCage, ensemble: Ensemble) -> NDArray[np.bool_]:
    """Whether any run from each kick met a ball or the land, shape (kick,): flight alone decides nothing."""
    met = (ensemble.largest_contact_force > 0.0) | (ensemble.largest_offset >= cage.land_gap)
    return np.asarray(met.any(axis=1))


def drifts(cage: PlanarCage) -> bool:
    """Whether nothing holds the cage centre: no land, and the turning of the ball set or gravity moves it."""
    return math.isinf(cage.land_gap) and (cage.cage_speed != 0.0 or cage.gravity > 0.0)


def _mostly(counts: Counts, runs: int) -> bool:
    """Whether more than half of the runs do so at every kick, beyond the scatter of so few."""
    return all(wilson_interval(int(n), runs)[0] > FEW for n in counts)


def _clear(counts: Counts, runs: int) -> bool:
    return _mostly(counts, runs) and all(n / runs >= CLEAR for n in counts)


def _percent(counts: Counts, runs: int) -> str:
    least = int(counts.min())
    return "all" if least == runs else f"at least {100 * least // runs} %"


def _drift_reason(cage: PlanarCage, ensemble: Ensemble) -> str:
    passed, total = int(ensemble.count(RunOutcome.DRIFT).sum()), ensemble.outcome.size
    seen = f"its offset passed the play of its pockets in {passed} of {total} runs"
    rate = drift_law(cage)
    if rate > 0.0 and math.isinf(cage.land_gap):
        return (
            f"The motion dies, but the cage has no land and drifts: {seen}, and by the linear law it grows "
            f"e-fold every {1.0 / rate:.3g} s."
        )
    return f"The motion dies, but the cage has no land and drifts: {seen}."


def _mixed_reason(kicks: Array, dies: Counts, grows: Counts, runs: int) -> str:
    order = np.argsort(kicks)
    calm = [kicks[i] for i in order if dies[i] / runs >= CLEAR]
    wild = [kicks[i] for i in order if grows[i] / runs >= CLEAR]
    if calm and wild and max(calm) < min(wild):
        return f"Sub-critical: the motion dies from {max(calm):g} m/s and grows from {min(wild):g} m/s."
    shares = ", ".join(f"{100 * grows[i] / runs:.0f} % from {kicks[i]:g} m/s" for i in order)
    return f"No clear answer: the motion grows in {shares}."
