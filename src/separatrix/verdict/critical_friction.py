"""Critical friction at one restitution factor, the band over the kicks, and the limits drawn beside it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

from separatrix.cage.closed_forms import linear_critical_friction
from separatrix.cage.moving_cage import MovingCage
from separatrix.chain.impact_restitution import damping_ratio
from separatrix.chain.impact_restitution import restitution_factor as nominal
from separatrix.ground.units import MetrePerSecond, Ratio
from separatrix.study.study import StabilitySettings
from separatrix.verdict.response import (
    BATCH,
    SEARCHED_FRICTION,
    Count,
    Crossing,
    GrowthCounter,
    Look,
    Response,
    Side,
    cage_at,
    ends_of,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearLimit:
    """Critical friction without clearance in a ball set at rest, in closed form."""

    restitution_factor: Ratio  # at which the limit is taken
    critical_friction: Ratio  # above which every disturbance grows


def linear_limit(cage: MovingCage, restitution_factor: Ratio) -> LinearLimit:
    """Critical friction of the linear law, 2 zeta sqrt(2/Z), at one restitution factor."""
    critical = linear_critical_friction(cage_at(cage, restitution_factor, 0.0))
    return LinearLimit(restitution_factor=restitution_factor, critical_friction=critical)


BAND_FEW, BAND_MOST = 0.1, 0.9  # shares of whirling runs at which a kick counts as settling, and as whirling
MIDDLE_RUNS, END_RUNS, FIRST_RUNS = 1.5, 0.75, 0.25
"""Runs spent near a crossing, in parts of those of the settings: on the critical friction; on an end of the
band, for kicks that may set it, and on a critical friction without its band; on a first look at where each
kick's crossings are."""

APART = 1.4  # a guess of the ratio between two crossings of one kick; it costs or saves time only
Found = Crossing | Side


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalFriction:
    """Critical friction at one restitution factor; None where there is none, with the reason.

    The intervals come from the number of runs. The frictions of each kick by itself are None, too, where the
    band was not computed.
    """

    restitution_factor: Ratio  # nominal, of the whole cage mass
    critical_friction: Ratio | None = None  # at which half the runs whirl from the reference disturbance
    critical_friction_low: Ratio | None = None  # below it nine in ten runs settle from every disturbance
    critical_friction_high: Ratio | None = None  # above it nine in ten runs whirl from every disturbance
    scatter_low: Ratio | None = None  # lower end of the 95 % interval of `critical_friction`
    scatter_high: Ratio | None = None  # upper end of the 95 % interval of `critical_friction`
    low_scatter_low: Ratio | None = None  # lower end of the interval of `critical_friction_low`
    low_scatter_high: Ratio | None = None  # upper end of the interval of `critical_friction_low`
    high_scatter_low: Ratio | None = None  # lower end of the interval of `critical_friction_high`
    high_scatter_high: Ratio | None = None  # upper end of the interval of `critical_friction_high`
    kick_low: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()  # at which a tenth of its runs whirl
    kick_critical_friction: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()  # at which half do
    kick_high: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()  # at which nine tenths do
    side: Side | None = None  # of one half on which P(whirl) lies throughout, if `critical_friction` is None
    reason: str | None = None  # why one of the first three frictions is None
    notes: tuple[str, ...] = ()  # on runs that do not show where their motion ends, a sentence each


def critical_friction(
    cage: MovingCage,
    restitution_factor: Ratio | None,
    settings: StabilitySettings,
    *,
    counter: GrowthCounter | None = None,
    band: bool = True,
    guess: Ratio | None = None,
) -> CriticalFriction:
    """Friction at which half the runs whirl from the reference kick, and the band over all kicks.

    Parameters
    ----------
    cage, settings
        The friction of the cage is replaced, and its race damping unless `restitution_factor` is None.
    restitution_factor : float or None
        Nominal, of the whole cage mass [-]; None for the cage's own race damping.
    counter : GrowthCounter, optional
        Counts the runs.
    band : bool
        Whether the other kicks and the band are wanted; without it half the runs are enough.
    guess : float, optional
        A friction near the critical one, to save time; by default from the linear law.
    """
    counts = counter or GrowthCounter(cage, settings)
    settings = counts.settings
    eta = own_restitution_factor(cage) if restitution_factor is None else restitution_factor
    start = linear_guess(counts, restitution_factor) if guess is None else guess
    reference, kicks = settings.middle_kick, settings.kicks
    responses = {
        kick: Response(_look(counts, restitution_factor, kick), settings.runs) for kick in {*kicks, reference}
    }
    most = max(1, round((MIDDLE_RUNS if band else END_RUNS) * settings.runs))
    found = responses[reference].crossing(0.5, most, start)
    if not band:
        return replace(_point(eta, settings, found, {}, {}, {}), notes=_notes(responses))
    start = found.value if isinstance(found, Crossing) else start
    few, more = (max(1, round(part * settings.runs)) for part in (FIRST_RUNS, END_RUNS))
    each = {kick: _crossings(responses[kick], few, start) for kick in kicks}
    middles = {kick: three[1] for kick, three in each.items()} | {reference: found}
    lows = _first_settled(responses, BAND_FEW, more, {kick: three[0] for kick, three in each.items()}, 1)
    highs = _first_settled(responses, BAND_MOST, more, {kick: three[2] for kick, three in each.items()}, -1)
    return replace(_point(eta, settings, found, lows, middles, highs), notes=_notes(responses))


def lowest_crossing(counter: GrowthCounter, guess: Ratio) -> tuple[Found, MetrePerSecond, tuple[str, ...]]:
    """Friction at which half the runs whirl from the disturbance from which it is lowest; that, and notes.

    The race damping is the cage's own. Disturbances whose crossing may come first get most of the runs.
    """
    settings = counter.settings
    responses = {kick: Response(_look(counter, None, kick), settings.runs) for kick in settings.kicks}
    few, more = (max(1, round(part * settings.runs)) for part in (FIRST_RUNS, END_RUNS))
    each: dict[MetrePerSecond, Found] = {}
    for kick, response in responses.items():
        each[kick] = response.crossing(0.5, few, guess)
        known = [one.value for one in each.values() if isinstance(one, Crossing)]
        guess = min(known, default=guess)
    found, kick = _outermost(_first_settled(responses, 0.5, more, each, 1), 1)
    if found is None:
        raise LookupError("no disturbance")
    return found, kick, _notes(responses)


def _notes(responses: Mapping[MetrePerSecond, Response]) -> tuple[str, ...]:
    return tuple(note for _, response in sorted(responses.items()) for note in response.notes)


def expected_runs(settings: StabilitySettings, *, band: bool) -> float:
    """Runs that one critical friction takes, about; the first counts find where it is."""
    first = min(BATCH, settings.runs)
    if not band:
        return 4.0 * first + END_RUNS * settings.runs
    each = 5.0 * first + END_RUNS * settings.runs
    return 4.0 * first + MIDDLE_RUNS * settings.runs + len(settings.kicks) * each


def own_restitution_factor(cage: MovingCage) -> Ratio:
    """Nominal restitution factor of a cage's own race damping."""
    if not math.isfinite(cage.race_damping):
        return 1.0
    return nominal(damping_ratio(cage.ball_cage_stiffness, cage.mass, cage.race_damping))


def linear_guess(counts: GrowthCounter, restitution_factor: Ratio | None) -> Ratio:
    """Friction to start from, by the linear law."""
    eta = None if restitution_factor is None else min(restitution_factor, 0.9)
    return 0.8 * linear_critical_friction(counts.cage_at(eta, 0.0))


def _look(counts: GrowthCounter, eta: Ratio | None, kick: MetrePerSecond) -> Look:
    def look(friction: Ratio, first_run: int, runs: int) -> Count:
        return counts.count(eta, friction, kick, first_run=first_run, runs=runs)

    return look


def _crossings(response: Response, runs: int, start: Ratio) -> tuple[Found, Found, Found]:
    """Crossings of a tenth, one half and nine tenths, from one kick; the runs go to the ends."""
    middle = response.crossing(0.5, runs, start)
    near = middle.value if isinstance(middle, Crossing) else start
    low = response.crossing(BAND_FEW, runs, near / APART)
    high = response.crossing(BAND_MOST, runs, near * APART)
    return low, response.crossing(0.5, 0, near), high


def _first_settled(
    responses: Mapping[MetrePerSecond, Response],
    target: Ratio,
    runs: int,
    found: Mapping[MetrePerSecond, Found],
    way: int,
) -> dict[MetrePerSecond, Found]:
    """Spend runs on the kicks whose crossing may come first, going up (`way` 1) or down (-1) in friction."""
    settled, farthest = dict(found), math.inf
    if _side(way) in found.values():
        return settled
    crossings = {kick: end for kick, end in found.items() if isinstance(end, Crossing)}
    for kick, end in sorted(crossings.items(), key=lambda item: way * item[1].value):
        if min(way * end.low, way * end.high) > farthest:
            continue
        again = responses[kick].crossing(target, runs, end.value)
        settled[kick] = again
        if isinstance(again, Crossing):
            farthest = min(farthest, max(way * again.low, way * again.high))
    return settled


def _point(
    eta: Ratio,
    settings: StabilitySettings,
    found: Found,
    lows: Mapping[MetrePerSecond, Found],
    middles: Mapping[MetrePerSecond, Found],
    highs: Mapping[MetrePerSecond, Found],
) -> CriticalFriction:
    """Record of the crossings, those of the band by kick, with the reasons of those that are missing."""
    none: tuple[Ratio | None, ...] = () if lows else (None,) * len(settings.kicks)
    (low, low_kick), (high, high_kick) = _outermost(lows, 1), _outermost(highs, -1)
    value, scatter_low, scatter_high = ends_of(found)
    low_value, low_low, low_high = ends_of(low)
    high_value, high_low, high_high = ends_of(high)
    targets = (found, 0.5, settings.middle_kick), (low, BAND_FEW, low_kick), (high, BAND_MOST, high_kick)
    reasons = [_REASONS[end].format(share, kick) for end, share, kick in targets if isinstance(end, Side)]
    return CriticalFriction(
        restitution_factor=eta,
        critical_friction=value,
        critical_friction_low=low_value,
        critical_friction_high=high_value,
        scatter_low=scatter_low,
        scatter_high=scatter_high,
        low_scatter_low=low_low,
        low_scatter_high=low_high,
        high_scatter_low=high_low,
        high_scatter_high=high_high,
        kick_low=none or tuple(ends_of(end)[0] for end in lows.values()),
        kick_critical_friction=none or tuple(ends_of(middles[kick])[0] for kick in lows),
        kick_high=none or tuple(ends_of(end)[0] for end in highs.values()),
        side=found if isinstance(found, Side) else None,
        reason="; ".join(dict.fromkeys(reasons)) or None,
    )


def _side(way: int) -> Side:
    """Side of a kick without a crossing that comes before all crossings, going up (1) or down in friction."""
    return Side.ABOVE if way > 0 else Side.BELOW


def _outermost(found: Mapping[MetrePerSecond, Found], way: int) -> tuple[Found | None, MetrePerSecond]:
    """Crossing that comes first, going up (`way` 1) or down (-1) in friction, and its kick; or a side."""
    if not found:
        return None, 0.0
    if _side(way) in found.values():
        return _side(way), next(kick for kick, end in found.items() if end is _side(way))
    crossings = [(way * end.value, way * kick) for kick, end in found.items() if isinstance(end, Crossing)]
    kick = way * (min(crossings)[1] if crossings else max(way * kick for kick in found))
    return found[kick], kick


_REASONS = {
    Side.ABOVE: "{0:.0%} of the runs from {1:g} m/s whirl even at zero pocket friction",
    Side.BELOW: f"under {{0:.0%}} of the runs from {{1:g}} m/s whirl below friction {SEARCHED_FRICTION:g}",
}
