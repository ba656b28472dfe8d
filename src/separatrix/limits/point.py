"""Critical friction at one restitution factor, and the band over the kicks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Annotated

from separatrix.cage import PlanarCage, linear_critical_friction
from separatrix.chain.restitution import damping_ratio
from separatrix.chain.restitution import restitution_factor as nominal
from separatrix.limits.growth import Count, GrowthCounter
from separatrix.limits.response import SEARCHED_FRICTION, Crossing, Look, Response, Side
from separatrix.study import StabilitySettings
from separatrix.units import MetrePerSecond, Ratio

BAND_FEW, BAND_MOST = 0.1, 0.9
"""Shares of whirling runs at which a kick is said to settle, and to whirl."""

MIDDLE_RUNS, END_RUNS, FIRST_RUNS = 1.5, 0.75, 0.25
"""Runs spent near a crossing, in parts of those of the settings: on the critical friction; on an end of the
band, for kicks that may set it, and on a critical friction without its band; on a first look at where each
kick's crossings are."""

APART = 1.4
"""A guess of the ratio between two crossings of one kick; it costs or saves time only."""

Found = Crossing | Side


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalFriction:
    """Critical friction at one restitution factor; None where there is none, with the reason.

    Attributes
    ----------
    restitution_factor : float
        eta [-].
    critical_friction : float or None
        Friction at which half the runs whirl from the reference kick [-].
    critical_friction_low, critical_friction_high : float or None
        The sub-critical band: below the first nine in ten runs settle from every kick, above the second nine
        in ten whirl from every kick [-].
    scatter_low, scatter_high : float or None
        95 % interval of `critical_friction` from the number of runs [-].
    low_scatter_low, low_scatter_high, high_scatter_low, high_scatter_high : float or None
        The same of the ends of the band [-].
    kick_low, kick_critical_friction, kick_high : tuple
        Frictions at which a tenth, half, nine tenths of the runs whirl, for each kick by itself; None where
        there is none, or the band was not asked for [-].
    side : Side or None
        Where `critical_friction` is None: whether P(whirl) lies above one half throughout, or below.
    reason : str or None
        Why one of the first three is None.
    """

    restitution_factor: Ratio
    critical_friction: Ratio | None = None
    critical_friction_low: Ratio | None = None
    critical_friction_high: Ratio | None = None
    scatter_low: Ratio | None = None
    scatter_high: Ratio | None = None
    low_scatter_low: Ratio | None = None
    low_scatter_high: Ratio | None = None
    high_scatter_low: Ratio | None = None
    high_scatter_high: Ratio | None = None
    kick_low: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()
    kick_critical_friction: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()
    kick_high: Annotated[tuple[Ratio | None, ...], ("kick",)] = ()
    side: Side | None = None
    reason: str | None = None


def critical_friction(
    cage: PlanarCage,
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
    cage : PlanarCage
        Its friction is replaced, and its race damping unless that is asked for.
    restitution_factor : float or None
        Nominal, of the whole cage mass [-]; None for the cage's own race damping.
    settings : StabilitySettings
        Kicks, runs and seed.
    counter : GrowthCounter, optional
        To share counts with other questions about the same cage and settings.
    band : bool
        Whether the other kicks and the band are wanted; without it half the runs do.
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
        return _point(eta, settings, found, {})
    start = found.value if isinstance(found, Crossing) else start
    few, more = (max(1, round(part * settings.runs)) for part in (FIRST_RUNS, END_RUNS))
    each = {kick: _crossings(responses[kick], few, start) for kick in kicks}
    middles = {kick: three[1] for kick, three in each.items()} | {reference: found}
    lows = _first_settled(responses, BAND_FEW, more, {kick: three[0] for kick, three in each.items()}, 1)
    highs = _first_settled(responses, BAND_MOST, more, {kick: three[2] for kick, three in each.items()}, -1)
    return _point(eta, settings, found, {kick: (lows[kick], middles[kick], highs[kick]) for kick in kicks})


def own_restitution_factor(cage: PlanarCage) -> Ratio:
    """Nominal restitution factor of a cage's own race damping."""
    if not isfinite(cage.race_damping):
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
    settled = dict(found)
    crossings = {kick: end for kick, end in found.items() if isinstance(end, Crossing)}
    if len(crossings) < len(found) and (Side.ABOVE if way > 0 else Side.BELOW) in found.values():
        return settled
    farthest = math.inf
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
    each: Mapping[MetrePerSecond, tuple[Found, Found, Found]],
) -> CriticalFriction:
    """Record of the crossings, with the reasons of those that are missing."""
    none: tuple[Ratio | None, ...] = () if each else (None,) * len(settings.kicks)
    lows = {kick: three[0] for kick, three in each.items()}
    highs = {kick: three[2] for kick, three in each.items()}
    low, high = _first(lows), _last(highs)
    middle = (found, 0.5, settings.middle_kick)
    band = [(low[0], BAND_FEW, low[1]), (high[0], BAND_MOST, high[1])] if each else []
    return CriticalFriction(
        restitution_factor=eta,
        critical_friction=_value(found),
        critical_friction_low=_value(low[0]),
        critical_friction_high=_value(high[0]),
        scatter_low=_low(found),
        scatter_high=_high(found),
        low_scatter_low=_low(low[0]),
        low_scatter_high=_high(low[0]),
        high_scatter_low=_low(high[0]),
        high_scatter_high=_high(high[0]),
        kick_low=none or tuple(_value(three[0]) for three in each.values()),
        kick_critical_friction=none or tuple(_value(three[1]) for three in each.values()),
        kick_high=none or tuple(_value(three[2]) for three in each.values()),
        side=found if isinstance(found, Side) else None,
        reason=_reason([middle, *band]),
    )


def _first(found: Mapping[MetrePerSecond, Found]) -> tuple[Found | None, MetrePerSecond]:
    """Smallest crossing over the kicks; ABOVE if one kick is above its target without friction."""
    if not found:
        return None, 0.0
    above = [kick for kick, end in found.items() if end is Side.ABOVE]
    if above:
        return Side.ABOVE, above[0]
    crossings = [(end.value, kick) for kick, end in found.items() if isinstance(end, Crossing)]
    kick = min(crossings)[1] if crossings else max(found)
    return found[kick], kick


def _last(found: Mapping[MetrePerSecond, Found]) -> tuple[Found | None, MetrePerSecond]:
    """Largest crossing over the kicks; BELOW if one kick is below its target at the top."""
    if not found:
        return None, 0.0
    below = [kick for kick, end in found.items() if end is Side.BELOW]
    if below:
        return Side.BELOW, below[0]
    crossings = [(end.value, kick) for kick, end in found.items() if isinstance(end, Crossing)]
    kick = max(crossings)[1] if crossings else min(found)
    return found[kick], kick


def _value(found: Found | None) -> Ratio | None:
    return found.value if isinstance(found, Crossing) else None


def _low(found: Found | None) -> Ratio | None:
    return found.low if isinstance(found, Crossing) else None


def _high(found: Found | None) -> Ratio | None:
    return found.high if isinstance(found, Crossing) else None


def _reason(ends: Sequence[tuple[Found | None, Ratio, MetrePerSecond]]) -> str | None:
    """Return why a crossing is missing; None if none is."""
    reasons = [_REASONS[side].format(target, kick) for side, target, kick in ends if isinstance(side, Side)]
    return "; ".join(dict.fromkeys(reasons)) or None


_REASONS = {
    Side.ABOVE: "{0:.0%} of the runs from {1:g} m/s whirl even at zero pocket friction",
    Side.BELOW: f"under {{0:.0%}} of the runs from {{1:g}} m/s whirl below friction {SEARCHED_FRICTION:g}",
}
