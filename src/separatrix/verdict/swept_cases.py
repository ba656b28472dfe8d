"""Many cases of a study, each with other values: the chain and, if asked, margin and verdict."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import partial
from typing import Any

from separatrix.cage.closed_forms import linear_whirl_frequency
from separatrix.cage.disturbance import settings_for
from separatrix.cage.moving_cage import moving_cage
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import (
    Hertz,
    Metre,
    Newton,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    Pascal,
    PerSecond,
    Radian,
    RadianPerSecond,
    Ratio,
)
from separatrix.study.candidates import require_friction
from separatrix.study.study import Operation, Study
from separatrix.verdict.critical_friction import SafetyFactor, cage_limit, safety_factor
from separatrix.verdict.judgement import Judgement, judge_solution
from separatrix.verdict.long_jobs import Runner, scattered
from separatrix.verdict.parameter_axes import (
    KICK,
    MOST_CASES,
    RESTITUTION,
    TIME_SHARE,
    Case,
    Parameter,
    parameters,
    varied,
)
from separatrix.verdict.ranking_records import MeanFriction, measured
from separatrix.verdict.reasons import CageMotion
from separatrix.verdict.stability_curve import own_threshold

ROUNDING = 1e-9  # share of their value by which cases that are alike may differ


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstCase:
    """The case nearest to instability, or farthest beyond it."""

    case: int  # its number
    quantity: str
    """Which decides: safety_factor, margin, probability_stable (lowest) or restitution_factor (highest)."""
    value: Ratio  # of that quantity
    compared: int  # cases that have it; the others were refused
    alike: int  # cases that are as bad, this one included


@dataclass(frozen=True, slots=True, kw_only=True)
class Duty:
    """Shares of the time of a duty cycle [-]; None where the quantity was not computed."""

    below_margin: Ratio | None  # with a safety factor below 1, or a margin below zero
    stable: Ratio | None  # with this verdict
    unstable: Ratio | None  # with this verdict
    undecided: Ratio | None  # with this verdict
    refused: Ratio  # without the number that decides


def orders(operation: Operation, ball_count: int, cage_speed: RadianPerSecond) -> dict[str, Hertz]:
    """Return the frequencies of shaft and cage, and of balls that pass a place of a ring.

    The shaft is the ring that turns faster; the cage turns with the ball set.
    """
    speeds = operation.inner_speed, operation.outer_speed, cage_speed
    inner, outer, cage = (speed / (2.0 * math.pi) for speed in speeds)
    return {
        "shaft_frequency": max(abs(inner), abs(outer)),
        "cage_frequency": abs(cage),
        "outer_pass_frequency": ball_count * abs(cage - outer),
        "inner_pass_frequency": ball_count * abs(inner - cage),
    }


def time_shares(cases: Sequence[Mapping[str, float]]) -> list[Ratio]:
    """Share of each case in the time of all, none where no case has one; `InputError` if they have no sum."""
    if TIME_SHARE not in cases[0]:
        return []
    given = [case[TIME_SHARE] for case in cases]
    for place, one in enumerate(given):
        if not 0.0 <= one < math.inf:
            raise InputError(f"Case {place}, {TIME_SHARE}", "must be a finite share or time >= 0", f"{one:g}")
    total = math.fsum(given)
    if not 0.0 < total < math.inf:
        raise InputError(TIME_SHARE, "must be above 0 in some case", f"a sum of {total:g}")
    return [one / total for one in given]


LOWEST = ("safety_factor", "margin", "probability_stable")
"""What the worst case has the least of, the first that is known."""


def worst_case(cases: Iterable[SweptCase]) -> WorstCase | None:
    """Return the worst case, the first of those that are alike; None where no case has an answer.

    A case that its land makes unstable has a safety factor of 0 here.
    """
    known = list(cases)
    for quantity, sign in (*((name, 1.0) for name in LOWEST), ("restitution_factor", -1.0)):
        values = ((getattr(one, quantity), one) for one in known)
        found = [(sign * value, one.case) for value, one in values if value is not None]
        if quantity == "safety_factor":
            found += [(0.0, one.case) for one in known if one.is_below_margin and one.is_by_land]
        if found:
            value, case = min(found)
            alike = sum(math.isclose(one, value, rel_tol=ROUNDING) for one, _ in found)
            counts = {"compared": len(found), "alike": alike}
            return WorstCase(case=case, quantity=quantity, value=sign * value, **counts)
    return None


def duty(cases: Iterable[SweptCase]) -> Duty | None:
    """Return the time spent below a margin of zero and in each verdict; None without shares of time."""
    known = [(one, one.time_share) for one in cases if one.time_share is not None]
    if not known:
        return None
    has_margins = any(one.is_below_margin is not None for one, _ in known)
    has_verdicts = any(one.verdict is not None for one, _ in known)
    decides = "is_below_margin" if has_margins else "verdict" if has_verdicts else "restitution_factor"

    def in_verdict(name: str) -> Ratio | None:
        return math.fsum(share for one, share in known if one.verdict == name) if has_verdicts else None

    below = math.fsum(share for one, share in known if one.is_below_margin)
    return Duty(
        below_margin=below if has_margins else None,
        stable=in_verdict("STABLE"),
        unstable=in_verdict("UNSTABLE"),
        undecided=in_verdict("UNDECIDED"),
        refused=math.fsum(share for one, share in known if getattr(one, decides) is None),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class SweptCase:
    """What the chain gives for a case; None from where it was refused, with the reason.

    Loads, contacts and slopes are those of the most loaded ball, clearances those of the running cage.
    Threshold and margin, and the verdict with its evidence (`Judgement`), are None unless requested.
    Frequencies are those that a sensor on the housing would see (`orders`).
    """

    case: int  # number of the case, from 0
    values: tuple[float, ...]  # of the parameters, in their order
    cage_speed: RadianPerSecond | None = None  # of the ball set about the bearing axis
    load_inner: Newton | None = None
    load_outer: Newton | None = None
    contact_angle_inner: Radian | None = None
    contact_angle_outer: Radian | None = None
    max_pressure_inner: Pascal | None = None  # Hertz, inner race
    max_pressure_outer: Pascal | None = None  # Hertz, outer race
    spin_roll_ratio_inner: Ratio | None = None
    spin_roll_ratio_outer: Ratio | None = None
    slope_inner: Ratio | None = None  # alpha of the inner race
    slope_outer: Ratio | None = None  # alpha of the outer race
    ball_cage_stiffness: NewtonPerMetre | None = None
    race_damping: NewtonSecondPerMetre | None = None  # C_mu, of both races together
    damping_ratio: Ratio | None = None  # sqrt(k_BC M_C) over 2 C_mu
    restitution_factor: Ratio | None = None  # eta of the chain
    ball_cage_friction: Ratio | None = None
    pocket_clearance: Metre | None = None  # running, along the circumference, stop to stop
    land_clearance: Metre | None = None  # running, diametral; null without a land
    shaft_frequency: Hertz | None = None
    cage_frequency: Hertz | None = None
    outer_pass_frequency: Hertz | None = None
    inner_pass_frequency: Hertz | None = None
    linear_whirl_frequency: Hertz | None = None
    orbit_frequency: Hertz | None = None
    restitution_threshold: Ratio | None = None
    restitution_threshold_low: Ratio | None = None  # lower end of its 95 % interval
    restitution_threshold_high: Ratio | None = None  # upper end of it
    margin: Ratio | None = None
    own_critical_friction: Ratio | None = None  # in the full model, in place of a threshold
    own_critical_friction_low: Ratio | None = None  # of its 95 % interval
    own_critical_friction_high: Ratio | None = None  # upper end of it
    safety_factor: Ratio | None = None
    """Critical friction over friction; null as the critical friction is, and where the land drives it."""
    safety_factor_low: Ratio | None = None  # of its 95 % interval
    safety_factor_high: Ratio | None = None  # upper end of it
    verdict: str | None = None  # STABLE, UNSTABLE or UNDECIDED
    probability_stable: Ratio | None = None  # from the worst disturbance
    probability_low: Ratio | None = None  # lower end of its 95 % interval
    probability_high: Ratio | None = None  # upper end of it
    cage_motion: str | None = None  # what the cage does at the end
    largest_offset: Metre | None = None
    drift_rate: PerSecond | None = None  # growth rate of the mean offset, median over the runs
    largest_contact_force: Newton | None = None
    force_limit: Newton | None = None  # pocket force up to which the balls of the verdict have a meaning
    force_exceeds_races: bool | None = None  # whether the largest contact force is beyond that
    driven_by_land: bool | None = None  # whether friction on the land drives most of the runs that whirl
    largest_land_force: Newton | None = None
    runs: int | None = None  # of the verdict
    time_share: Ratio | None = None  # of a duty cycle; null without one
    reason: str = ""  # why the case was refused; empty if it was not

    @property
    def is_by_land(self) -> bool:
        """Whether friction on the land, and not in the pockets, makes the cage unstable."""
        return self.verdict == "UNSTABLE" and bool(self.driven_by_land)

    @property
    def is_below_margin(self) -> bool | None:
        """Whether safety factor or margin say that the cage whirls; None where neither was computed."""
        if self.margin is not None:
            return self.margin < 0.0
        if self.own_critical_friction_low is not None and self.is_by_land:
            return True
        least = self.safety_factor_low if self.safety_factor is None else self.safety_factor
        return None if least is None else least < 1.0


# what a case takes from its judgement as it is
EVIDENCE = {f.name for f in fields(SweptCase)} & {f.name for f in fields(Judgement)}
EVIDENCE -= {"verdict", "cage_motion"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Cases in their order, and the parameters that they vary; an interrupt leaves some out."""

    parameters: tuple[Parameter, ...]  # the varied inputs
    cases: tuple[SweptCase, ...]  # a row for each
    verdicts: bool  # whether verdicts were computed
    margins: bool  # whether thresholds and margins were computed
    worst: WorstCase | None  # least margin, P(stable), or largest eta; null without an answer
    duty: Duty | None  # time in each verdict; null without shares of time
    complete: bool  # false if an interrupt left cases out
    notes: tuple[str, ...] = ()  # on the study itself, whose cases would repeat them, a sentence each


def sweep(
    study: Study,
    cases: Sequence[Case],
    *,
    verdicts: bool = False,
    margins: bool = False,
    runner: Runner | None = None,
) -> Sweep:
    """Run the chain for each case of a study; on request its threshold and the whole ensemble, too.

    Each case has values by the names of a study file, in SI units, and perhaps a ``"time_share"`` (shares,
    hours: any unit, for they are divided by their sum); every case has the same names. The numbers do not
    depend on the runner.

    Raises
    ------
    InputError
        No cases or too many, a name that a sweep cannot vary, cases that differ in their names, or shares
        of time below zero.
    Interrupted
        With the cases that were finished, if any was.
    """
    names, shares = _names(cases), time_shares(cases)
    known = parameters()
    runner = runner or Runner()

    def run(place: int) -> SweptCase:
        values = {name: cases[place][name] for name in names}
        found = SweptCase(
            case=place, values=tuple(values.values()), time_share=shares[place] if shares else None
        )
        return _swept(study, found, values, runner, verdicts=verdicts, margins=margins)

    def table(found: Mapping[int, SweptCase]) -> Sweep:
        done = tuple(found[place] for place in sorted(found))
        return Sweep(
            parameters=tuple(known[name] for name in names),
            cases=done,
            verdicts=verdicts,
            margins=margins,
            worst=worst_case(done),
            duty=duty(done),
            complete=len(found) == len(cases),
        )

    return runner.work_out(run, scattered(range(len(cases))), into=table)


def _names(cases: Sequence[Case]) -> list[str]:
    if not 1 <= len(cases) <= MOST_CASES:
        raise InputError("A sweep", f"must have between 1 and {MOST_CASES} cases", got=str(len(cases)))
    all_names = list(cases[0])
    names = [name for name in all_names if name != TIME_SHARE]
    known = parameters()
    for name in names:
        if name not in known or name in (RESTITUTION, KICK):
            raise InputError(name, "is not a numeric input that a sweep can vary")
    for place, case in enumerate(cases):
        if list(case) != all_names:
            raise InputError(f"Case {place}", f"must give {', '.join(all_names)}", got=", ".join(case))
    return names


def _swept(
    study: Study, found: SweptCase, case: Case, runner: Runner, *, verdicts: bool, margins: bool
) -> SweptCase:
    """One case, as far as the chain goes."""
    known: dict[str, Any] = {}
    try:
        asked = varied(study, case)
        solution = solve(asked)
        bearing = solution.bearing
        for race in ("inner", "outer"):
            at = getattr(bearing, race)
            known[f"load_{race}"] = at.load
            known[f"contact_angle_{race}"] = at.contact_angle
            known[f"max_pressure_{race}"] = at.ellipse.max_pressure
            known[f"spin_roll_ratio_{race}"] = at.spin_roll_ratio
        known |= orders(asked.operation, asked.bearing.ball_count, bearing.cage_speed)
        known["cage_speed"] = bearing.cage_speed
        known |= {f"slope_{race}": getattr(solution.slopes, race).slope for race in ("inner", "outer")}
        if study.cage is not None:
            known |= _of_cage(solution)
            if margins or verdicts:
                require_friction(asked)
            known |= _margin(solution, runner) if margins else {}
            known |= _verdict(solution, runner) if verdicts else {}
    except SeparatrixError as error:
        known["reason"] = str(error)
    return replace(found, **known)


def _of_cage(solution: Solution) -> dict[str, Any]:
    """What the chain gives for the cage of a case."""
    of_impact = ("ball_cage_stiffness", "race_damping", "damping_ratio", "restitution_factor")
    of_design = ("pocket_clearance", "land_clearance")
    known = {name: getattr(solution.restitution, name) for name in of_impact}
    known |= {name: getattr(solution.design, name) for name in of_design}
    known["linear_whirl_frequency"] = linear_whirl_frequency(moving_cage(solution, 0.0))
    return known | {"ball_cage_friction": None if solution.friction is None else solution.friction.mean}


def _margin(solution: Solution, runner: Runner) -> dict[str, Any]:
    """Safety factor of a case; in the paper's model its threshold, and the distance to it."""
    friction = measured(solution.friction) if solution.friction else MeanFriction(0.0)
    settings = solution.study.stability
    if not solution.design.is_of_paper:
        settings = settings_for(settings, moving_cage(solution, 0.0))
        limit = cage_limit(solution, settings, runner, highest=friction.mean)
        return limit.own | asdict(safety_factor(limit, friction.mean, friction.interval()))
    threshold = own_threshold(moving_cage(solution, 0.0), settings, friction.mean, runner)
    return {
        "restitution_threshold": threshold.value,
        "restitution_threshold_low": threshold.low,
        "restitution_threshold_high": threshold.high,
        "margin": threshold.value - solution.restitution.restitution_factor,
    }


def _verdict(solution: Solution, runner: Runner) -> dict[str, Any]:
    """Verdict of the whole ensemble of a case; an orbit where most runs whirl."""
    run = partial(runner.whole_ensemble, settings=solution.study.stability)
    judged = judge_solution(solution, solution.friction.mean if solution.friction else 0.0, run)
    orbit = None
    if judged.cage_motion is CageMotion.WHIRLING and judged.whirl_ratio is not None:
        orbit = judged.whirl_ratio * abs(solution.bearing.cage_speed) / (2.0 * math.pi)
    factor = asdict(SafetyFactor()) if judged.is_by_land else {}  # that of the pockets has no meaning
    found = {name: getattr(judged, name) for name in EVIDENCE}
    motion = None if judged.cage_motion is None else judged.cage_motion.value
    return found | {"verdict": judged.verdict.name, "cage_motion": motion, "orbit_frequency": orbit} | factor
