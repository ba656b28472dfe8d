"""Many cases of a study, each with other values: the chain and, if asked, the verdict."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from separatrix.cage import Judgement, judge
from separatrix.chain.contacts import BearingState
from separatrix.chain.restitution import Restitution
from separatrix.chain.solution import Solution, solve
from separatrix.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.limits.map_parameters import KICK, RESTITUTION, Parameter, parameters, varied
from separatrix.runner import Runner
from separatrix.study import Study
from separatrix.units import (
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

    Loads, contacts and slopes are those of the most loaded ball. The verdict with its evidence is None unless
    it was asked for; what the names mean is said at `Judgement`.
    """

    case: int
    values: tuple[float, ...]
    cage_speed: RadianPerSecond | None = None
    load_inner: Newton | None = None
    load_outer: Newton | None = None
    contact_angle_inner: Radian | None = None
    contact_angle_outer: Radian | None = None
    max_pressure_inner: Pascal | None = None
    max_pressure_outer: Pascal | None = None
    spin_roll_ratio_inner: Ratio | None = None
    spin_roll_ratio_outer: Ratio | None = None
    slope_inner: Ratio | None = None
    slope_outer: Ratio | None = None
    ball_cage_stiffness: NewtonPerMetre | None = None
    race_damping: NewtonSecondPerMetre | None = None
    damping_ratio: Ratio | None = None
    restitution_factor: Ratio | None = None
    ball_cage_friction: Ratio | None = None
    verdict: str | None = None
    probability_stable: Ratio | None = None
    probability_low: Ratio | None = None
    probability_high: Ratio | None = None
    cage_motion: str | None = None
    largest_offset: Metre | None = None
    drift_rate: PerSecond | None = None
    largest_contact_force: Newton | None = None
    largest_land_force: Newton | None = None
    runs: int | None = None
    reason: str = ""


EVIDENCE = {f.name for f in fields(SweptCase)} & {f.name for f in fields(Judgement)} - {
    "verdict",
    "cage_motion",
}
"""What a case takes from its judgement as it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """Cases in their order, and the parameters that they vary; an interrupt leaves some out."""

    parameters: tuple[Parameter, ...]
    cases: tuple[SweptCase, ...]
    verdicts: bool
    complete: bool

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
    runner: Runner | None = None,
) -> Sweep:
    """Run the chain for each case of a study.

    Parameters
    ----------
    study : Study
        Where a case says nothing.
    cases : sequence of mapping
        Values by the names of a study file, in SI units; every case has the same names.
    verdicts : bool
        Whether to run the whole ensemble of each case, too.
    runner : Runner, optional
        How the runs are made; the numbers do not depend on it.

    Raises
    ------
    InputError
        No cases or too many, a name that a sweep cannot vary, or cases that differ in their names.
    Interrupted
        With the cases that were finished, if any was.
    """
    names = _names(cases)
    known = parameters()
    runner = runner or Runner()

    def run(place: int) -> SweptCase:
        return _swept(study, place, cases[place], runner if verdicts else None)

    def table(found: Mapping[int, SweptCase]) -> Sweep:
        return Sweep(
            parameters=tuple(known[name] for name in names),
            cases=tuple(found[place] for place in sorted(found)),
            verdicts=verdicts,
            complete=len(found) == len(cases),
        )

    with warnings.catch_warnings():  # thousands of cases would repeat the same
        warnings.simplefilter("ignore", ValidityWarning)
        return runner.work_out(run, range(len(cases)), into=table)


def _names(cases: Sequence[Case]) -> list[str]:
    if not 1 <= len(cases) <= MOST_CASES:
        raise InputError("A sweep", f"must have between 1 and {MOST_CASES} cases", got=str(len(cases)))
    names = list(cases[0])
    known = parameters()
    for name in names:
        if name not in known or name in (RESTITUTION, KICK):
            raise InputError(name, "is not a numeric input that a sweep can vary")
    for place, case in enumerate(cases):
        if list(case) != names:
            raise InputError(f"Case {place}", f"must give {', '.join(names)}", got=", ".join(case))
    return names


def _swept(study: Study, place: int, case: Case, runner: Runner | None) -> SweptCase:
    """One case, as far as the chain goes."""
    found = SweptCase(case=place, values=tuple(case.values()))
    try:
        solution = solve(varied(study, case))
        found = replace(found, **_of_bearing(solution.bearing))
        traction = solution.slopes
        found = replace(found, slope_inner=traction.inner.slope, slope_outer=traction.outer.slope)
        if study.cage is None:
            return found
        found = replace(found, **_of_restitution(solution.restitution))
        friction = solution.friction
        found = replace(found, ball_cage_friction=None if friction is None else friction.mean)
        return found if runner is None else replace(found, **_verdict(solution, runner))
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


def _of_restitution(found: Restitution) -> dict[str, Any]:
    names = ("ball_cage_stiffness", "race_damping", "damping_ratio", "restitution_factor")
    return {name: getattr(found, name) for name in names}


def _verdict(solution: Solution, runner: Runner) -> dict[str, Any]:
    """Verdict of the whole ensemble, with its evidence."""
    cage = solution.cage
    judged = judge(cage, runner.whole_ensemble(cage, solution.stability))
    found = {name: getattr(judged, name) for name in EVIDENCE}
    motion = None if judged.cage_motion is None else judged.cage_motion.value
    return found | {"verdict": judged.verdict.name, "cage_motion": motion}
