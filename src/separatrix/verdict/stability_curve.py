"""The stability curve: critical friction against restitution factor, and its inverse, the threshold."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

from separatrix.cage.closed_forms import drift_rate_law, drifts, linear_critical_friction
from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import MovingCage
from separatrix.chain.impact_restitution import damping_ratio
from separatrix.chain.impact_restitution import restitution_factor as nominal
from separatrix.ground.units import MetrePerSecond, PerSecond, Ratio, Rows, Second
from separatrix.study.study import StabilitySettings
from separatrix.verdict.critical_friction import (
    BATCH,
    END_RUNS,
    SEARCHED_FRICTION,
    Found,
    Side,
    cage_at,
    ends_of,
    notes_of,
    outermost,
    powers_between,
    responses,
)
from separatrix.verdict.long_jobs import Load, Runner, scattered

FACTORS: tuple[Ratio, ...] = (0.0, 1 / 16, *(i / 8 for i in range(1, 8)), 15 / 16, 1.0)
"""Restitution factors of a curve, unless a study states them: closer where it bends. Towards 0 the damping
ratio, which the linear limit follows, rises steeply; before 1, where balls gripped by their races damp
nothing, the critical friction falls to zero."""

OUTER_FACTORS: tuple[Ratio, ...] = (0.0, 0.98, 1.0)
"""Restitution factors beside those that a study gives, so that thresholds are solved over all of 0 to 1."""

BAND_FEW, BAND_MOST = 0.1, 0.9  # shares of whirling runs at which a kick counts as settling, and as whirling
MIDDLE_RUNS = 1.5  # runs spent on a critical friction that has its band, in parts of those of the settings
APART = 1.4  # a guess of the ratio between two crossings of one kick; it costs or saves time only
ETA = "restitution_factor"


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalFriction:
    """Critical friction at one restitution factor; None where there is none, with the reason.

    The intervals come from the number of runs. The ends of the band are None, too, where it was not computed.
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
    side: Side | None = None  # of one half on which P(whirl) lies throughout, if `critical_friction` is None
    reason: str | None = None  # why one of the first three frictions is None
    notes: tuple[str, ...] = ()  # on runs that do not show where their motion ends, a sentence each

    @property
    def height(self) -> Ratio:
        """Critical friction, with 0 or the top of the searched range where there is none."""
        if self.critical_friction is not None:
            return self.critical_friction
        return 0.0 if self.side is Side.ABOVE else SEARCHED_FRICTION

    def between(self, stiff: CriticalFriction, share: Ratio) -> CriticalFriction | None:
        """That of a pocket a share of the way to the stiffer one of `stiff`; None if only one has a value.

        Without the band.
        """
        if self.side is not stiff.side:
            return None
        return replace(self, notes=(), **powers_between(self, stiff, share, _VALUES[0]))


_VALUES = (
    ("critical_friction", "scatter_low", "scatter_high"),
    ("critical_friction_low", "low_scatter_low", "low_scatter_high"),
    ("critical_friction_high", "high_scatter_low", "high_scatter_high"),
)
"""Fields with value and interval of the critical friction, and of the lower and the upper end of its band."""

_REASONS = {
    Side.ABOVE: "{0:.0f} % of the runs from {1:g} m/s whirl even at zero pocket friction",
    Side.BELOW: "under {0:.0f} % of the runs from {1:g} m/s whirl by friction in the pockets, at "
    f"{SEARCHED_FRICTION:g}",
}


def critical_friction(
    cage: MovingCage,
    restitution_factor: Ratio | None,
    settings: StabilitySettings,
    *,
    runner: Runner | None = None,
    band: bool = True,
) -> CriticalFriction:
    """Friction at which half the runs whirl from the reference kick, and the band over all kicks.

    The friction of the cage is replaced, and its race damping by that of a nominal restitution factor, of
    the whole cage mass [-]; None keeps its own. Without the other kicks and the `band` half the runs are
    enough.
    """
    settings, eta = settings_for(settings, cage), restitution_factor
    guess = 0.8 * linear_critical_friction(cage_at(cage, None if eta is None else min(eta, 0.9), 0.0))
    reference = settings.middle_kick
    counts = responses(cage_at(cage, eta, 0.0), settings, {*settings.kicks, reference}, runner or Runner())
    most = max(1, round((MIDDLE_RUNS if band else END_RUNS) * settings.runs))
    found = counts[reference].crossing(0.5, most, guess)
    ends: list[tuple[Found, Ratio, MetrePerSecond]] = [(found, 0.5, reference)]
    if band:
        at, of_kicks = ends_of(found)[0] or guess, {kick: counts[kick] for kick in settings.kicks}
        for share, way in ((BAND_FEW, 1), (BAND_MOST, -1)):
            end, kick = outermost(of_kicks, share, settings.runs, at / APART**way, way)
            ends.append((end, share, kick))
    values: dict[str, Any] = {}
    for names, (end, *_) in zip(_VALUES, ends, strict=False):
        values |= zip(names, ends_of(end), strict=True)
    reasons = [
        _REASONS[end].format(100.0 * share, kick) for end, share, kick in ends if isinstance(end, Side)
    ]
    return CriticalFriction(
        restitution_factor=own_restitution_factor(cage) if eta is None else eta,
        **values,
        side=found if isinstance(found, Side) else None,
        reason="; ".join(dict.fromkeys(reasons)) or None,
        notes=notes_of(counts),
    )


def expected_load(settings: StabilitySettings, eta: Ratio | None = None, *, band: bool) -> Load:
    """Work of one critical friction, about; the first counts find where it is.

    Of ten bearings, a run at a restitution factor of 1 took 0.5 to 12 times as long as one at 0, the median
    1.5, by how fast its motion decays: 3 times by this formula.
    """
    first = min(BATCH, settings.runs)
    dear = 2.0 if eta is None else 1.5 / (1.06 - eta) ** 0.4
    if not band:
        return Load(4.0 * first + END_RUNS * settings.runs, dear)
    each = 5.0 * first + END_RUNS * settings.runs
    return Load(4.0 * first + MIDDLE_RUNS * settings.runs + len(settings.kicks) * each, dear)


def own_restitution_factor(cage: MovingCage) -> Ratio:
    """Nominal restitution factor of a cage's own race damping."""
    if not math.isfinite(cage.race_damping):
        return 1.0
    return nominal(damping_ratio(cage.ball_cage_stiffness, cage.mass, cage.race_damping))


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearLimit:
    """Critical friction without clearance in a ball set at rest, in closed form."""

    restitution_factor: Ratio  # at which the limit is taken
    critical_friction: Ratio  # above which every disturbance grows


def linear_limit(cage: MovingCage, restitution_factor: Ratio) -> LinearLimit:
    """Critical friction of the linear law, 2 zeta sqrt(2/Z), at one restitution factor."""
    critical = linear_critical_friction(cage_at(cage, restitution_factor, 0.0))
    return LinearLimit(restitution_factor=restitution_factor, critical_friction=critical)


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCurve:
    """Stability curve, its limits, and its ensemble."""

    curve: Annotated[tuple[CriticalFriction, ...], Rows(ETA, label=ETA)]  # rising restitution factors
    here: CriticalFriction | None = None
    """The same at the cage's own race damping; None if an interrupt left it out."""
    linear_limit: Annotated[tuple[LinearLimit, ...], Rows(ETA, "linear_limit_", label=ETA)]
    """Beside each point: without clearance, ball set at rest, in closed form."""
    band_few: Ratio  # share of whirling runs at the lower end of the band
    band_most: Ratio  # share of whirling runs at the upper end of the band
    band: bool  # whether the points of `curve` have their band; `here` always has
    kicks: Annotated[tuple[MetrePerSecond, ...], ("kick",)]  # disturbances of the runs
    middle_kick: MetrePerSecond  # of the critical friction
    runs: int  # from each disturbance
    duration: Second  # of a run
    ball_scatter: Ratio  # initial lead or lag of the balls, over half the pocket clearance
    searched_friction: Ratio  # highest friction that was searched
    drifts: bool  # whether nothing returns the cage centre: a run may settle, but no verdict is STABLE
    drift_rate_law: PerSecond  # growth of the offset by the linear law; 0 with a land or a ball set at rest
    complete: bool  # false if an interrupt left points out

    @property
    def notes(self) -> tuple[str, ...]:
        """Those of its points."""
        points = self.curve if self.here is None else (*self.curve, self.here)
        return tuple(note for point in points for note in point.notes)


def stability_curve(
    cage: MovingCage, settings: StabilitySettings, *, runner: Runner | None = None
) -> StabilityCurve:
    """Critical friction against restitution factor, and at the cage's own race damping.

    The restitution factors are those of the settings, or `FACTORS`. The friction of the cage is replaced, and
    its race damping but for `here`. The numbers do not depend on the runner. `Interrupted` has the curve of
    the points that were finished, if any was.
    """
    runner = runner or Runner()
    settings = settings_for(settings, cage)
    factors = settings.restitution_factors or FACTORS

    def curve(found: dict[Ratio | None, CriticalFriction]) -> StabilityCurve:
        complete, here = len(found) == 1 + len(factors), found.pop(None, None)
        return curve_of_points(cage, settings, found.values(), here=here, complete=complete)

    return runner.work_out(
        lambda eta: critical_friction(cage, eta, settings, runner=runner),
        [None, *scattered(factors)],
        into=curve,
        load=lambda eta: expected_load(settings, eta, band=True),
    )


def curve_of_points(
    cage: MovingCage,
    settings: StabilitySettings,
    points: Iterable[CriticalFriction],
    *,
    band: bool = True,
    here: CriticalFriction | None = None,
    complete: bool = True,
) -> StabilityCurve:
    """Return the curve of the finished points, rising restitution factors first, with its limits."""
    settings = settings_for(settings, cage)
    ordered = sorted(points, key=lambda point: point.restitution_factor)
    return StabilityCurve(
        curve=tuple(ordered),
        here=here,
        linear_limit=tuple(linear_limit(cage, point.restitution_factor) for point in ordered),
        band_few=BAND_FEW,
        band_most=BAND_MOST,
        band=band,
        kicks=settings.kicks,
        middle_kick=settings.middle_kick,
        runs=settings.runs,
        duration=settings.duration,
        ball_scatter=settings.ball_scatter,
        searched_friction=SEARCHED_FRICTION,
        drifts=drifts(cage),
        drift_rate_law=drift_rate_law(cage),
        complete=complete,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RestitutionThreshold:
    """Largest restitution factor at which the cage is stable, with the 95 % interval of the runs' scatter."""

    value: Ratio
    low: Ratio
    high: Ratio


def restitution_threshold(points: Sequence[CriticalFriction], friction: Ratio) -> RestitutionThreshold:
    """Restitution factor at which the critical friction equals `friction`, f_BC of a material [-].

    Between two points, which rise from a restitution factor of 0 to 1, the critical friction is a straight
    line. The threshold is 0 if the cage is never stable, 1 if it is stable even on balls gripped by their
    races. Where the critical friction wavers, it is the first restitution factor at which it falls below
    `friction`. The interval comes from the ends of the critical friction's own, in the same way.
    """
    value = _first_below(points, friction, lambda point: point.critical_friction)
    low = _first_below(points, friction, lambda point: point.scatter_low)
    high = _first_below(points, friction, lambda point: point.scatter_high)
    return RestitutionThreshold(value=value, low=min(low, value), high=max(high, value))


def _first_below(
    points: Sequence[CriticalFriction], friction: Ratio, end: Callable[[CriticalFriction], Ratio | None]
) -> Ratio:
    """Smallest restitution factor at which a curve through the points is below `friction`; 1 if none is."""
    before: tuple[Ratio, Ratio] | None = None
    for point in points:
        known = end(point)
        eta, f = point.restitution_factor, point.height if known is None else known
        if f < friction or point.side is Side.ABOVE:
            if before is None or f >= before[1]:
                return eta
            return before[0] + (eta - before[0]) * (before[1] - friction) / (before[1] - f)
        before = eta, f
    return 1.0


def own_threshold(
    cage: MovingCage, settings: StabilitySettings, friction: Ratio, runner: Runner
) -> RestitutionThreshold:
    """Threshold of one friction; the curve is followed no further than it can lie."""
    points: list[CriticalFriction] = []
    for eta in threshold_factors(settings):
        point = critical_friction(cage, eta, settings, runner=runner, band=False)
        points.append(point)
        if max(point.height, point.scatter_high or 0.0) < friction:
            break
    return restitution_threshold(points, friction)


def threshold_factors(settings: StabilitySettings) -> Sequence[Ratio]:
    """Restitution factors of the settings and those beside them, rising; `FACTORS` if it gives none."""
    given = settings.restitution_factors
    return sorted({*given, *OUTER_FACTORS}) if given else FACTORS
