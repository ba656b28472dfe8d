"""Many cases of a study, each with other values: the chain and, if asked, margin and verdict."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from separatrix.cage import Judgement, judge, linear_whirl_frequency
from separatrix.cage_choice import require_friction
from separatrix.chain.contacts import BearingState
from separatrix.chain.solution import Solution, solve
from separatrix.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.explore.envelope import TIME_SHARE, Duty, WorstCase, duty, orders, time_shares, worst_case
from separatrix.limits import own_threshold
from separatrix.limits.map_parameters import KICK, RESTITUTION, Parameter, parameters, varied
from separatrix.runner import Runner
from separatrix.study import Study
from separatrix.units import (
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

if TYPE_CHECKING:
    import pandas as pd

MOST_CASES = 100_000

# Values of some numbers of a study, by their names in a study file, in SI units.
Case = Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweptCase:
    """What the chain gives for a case; None from where it was refused, with the reason.

    Loads, contacts and slopes are those of the most loaded ball, clearances those of the running cage.
    Threshold and margin, and the verdict with its evidence (`Judgement`), are None unless asked for.
    Frequencies are those that a sensor on the housing would see (`explore.envelope.orders`).
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
    race_damping: NewtonSecondPerMetre | None = None
    damping_ratio: Ratio | None = None
    restitution_factor: Ratio | None = None
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
    restitution_threshold_low: Ratio | None = None
    restitution_threshold_high: Ratio | None = None
    margin: Ratio | None = None
    verdict: str | None = None  # STABLE, UNSTABLE or UNDECIDED
    probability_stable: Ratio | None = None  # from the worst kick
    probability_low: Ratio | None = None
    probability_high: Ratio | None = None
    cage_motion: str | None = None  # what the cage does at the end
    largest_offset: Metre | None = None
    drift_rate: PerSecond | None = None
    largest_contact_force: Newton | None = None
    largest_land_force: Newton | None = None
    runs: int | None = None  # of the verdict
    time_share: Ratio | None = None  # of a duty cycle; null without one
    reason: str = ""  # why the case was refused; empty if it was not


EVIDENCE = {f.name for f in fields(SweptCase)} & {f.name for f in fields(Judgement)} - {
    "verdict",
    "cage_motion",
}
"""What a case takes from its judgement as it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Cases in their order, and the parameters that they vary; an interrupt leaves some out.

    `worst` is None where no case has an answer, `duty` without shares of time.
    """

    parameters: tuple[Parameter, ...]  # the varied inputs
    cases: tuple[SweptCase, ...]  # a row for each
    verdicts: bool  # whether verdicts were asked for
    margins: bool  # whether thresholds and margins were asked for
    worst: WorstCase | None  # least margin, P(stable), or largest eta; null without an answer
    duty: Duty | None  # time in each verdict; null without shares of time
    complete: bool  # false if an interrupt left cases out

    def to_dataframe(self) -> pd.DataFrame:
        """One row a case: its values and what came out, in SI units."""
        import pandas as pd

        return pd.DataFrame(self.rows()).set_index("case")

    def rows(self) -> list[dict[str, Any]]:
        """Cases with the same keys: number, values by the parameters' names, what came out."""
        names = [one.name for one in self.parameters]
        out = [f.name for f in fields(SweptCase) if f.name not in ("case", "values")]
        return [
            {"case": one.case}
            | dict(zip(names, one.values, strict=True))
            | {name: getattr(one, name) for name in out}
            for one in self.cases
        ]


def sweep(
    study: Study,
    cases: Sequence[Case],
    *,
    verdicts: bool = False,
    margins: bool = False,
    runner: Runner | None = None,
) -> Sweep:
    """Run the chain for each case of a study.

    Parameters
    ----------
    study : Study
        Where a case says nothing.
    cases : sequence of mapping
        Values by the names of a study file, in SI units, and perhaps ``"time_share"`` (shares, hours: any
        unit, for they are divided by their sum); every case has the same names.
    verdicts : bool
        Whether to run the whole ensemble of each case, too.
    margins : bool
        Whether to compute the threshold of each case, too.
    runner : Runner, optional
        How the runs are made; the numbers do not depend on it.

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

    with warnings.catch_warnings():  # thousands of cases would repeat the same
        warnings.simplefilter("ignore", ValidityWarning)
        return runner.work_out(run, range(len(cases)), into=table)


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
    try:
        asked = varied(study, case)
        solution = solve(asked)
        found = replace(found, **_of_bearing(solution.bearing))
        turning: dict[str, Any] = orders(
            asked.operation, asked.bearing.ball_count, solution.bearing.cage_speed
        )
        found = replace(found, **turning)
        traction = solution.slopes
        found = replace(found, slope_inner=traction.inner.slope, slope_outer=traction.outer.slope)
        if study.cage is None:
            return found
        found = replace(found, **_of_restitution(solution))
        friction = solution.friction
        found = replace(found, ball_cage_friction=None if friction is None else friction.mean)
        if margins:
            found = replace(found, **_margin(solution, runner))
        return replace(found, **_verdict(solution, runner)) if verdicts else found
    except SeparatrixError as error:
        return replace(found, reason=str(error))


def _of_bearing(state: BearingState) -> dict[str, Any]:
    races = {"inner": state.inner, "outer": state.outer}
    found = {"cage_speed": state.cage_speed}
    for race, at in races.items():
        found[f"load_{race}"], found[f"contact_angle_{race}"] = at.load, at.contact_angle
        found[f"max_pressure_{race}"] = at.ellipse.max_pressure
        found[f"spin_roll_ratio_{race}"] = at.spin_roll_ratio
    return found


def _of_restitution(solution: Solution) -> dict[str, Any]:
    """Restitution factor, running clearances, and the whirl without clearance."""
    names = ("ball_cage_stiffness", "race_damping", "damping_ratio", "restitution_factor")
    found: dict[str, Any] = {name: getattr(solution.restitution, name) for name in names}
    found |= {name: getattr(solution.design, name) for name in ("pocket_clearance", "land_clearance")}
    return found | {"linear_whirl_frequency": linear_whirl_frequency(solution.cage_with(0.0))}


def _margin(solution: Solution, runner: Runner) -> dict[str, Any]:
    """Threshold at the pocket's friction, and the distance to it."""
    require_friction(solution.study)
    friction, eta = solution.cage.ball_cage_friction, solution.restitution.restitution_factor
    found = own_threshold(solution.cage_with(0.0), solution.stability, friction, runner)
    ends = {f"restitution_threshold_{end}": getattr(found, end) for end in ("low", "high")}
    return {"restitution_threshold": found.value, **ends, "margin": found.value - eta}


def _verdict(solution: Solution, runner: Runner) -> dict[str, Any]:
    """Verdict of the whole ensemble, with its evidence; the orbit of the runs that whirl."""
    cage = solution.cage
    judged = judge(cage, runner.whole_ensemble(cage, solution.stability))
    found = {name: getattr(judged, name) for name in EVIDENCE}
    whirls = any(count.whirls and count.kick == judged.worst_kick for count in judged.by_kick)
    if whirls and judged.whirl_ratio is not None:
        found["orbit_frequency"] = judged.whirl_ratio * abs(solution.bearing.cage_speed) / (2.0 * math.pi)
    motion = None if judged.cage_motion is None else judged.cage_motion.value
    return found | {"verdict": judged.verdict.name, "cage_motion": motion}
