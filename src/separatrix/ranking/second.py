"""The verdict by the other model of a ball, where the first leaves the range in which both agree."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from separatrix.cage import Judgement, PlanarCage, judge
from separatrix.chain.solution import Solution, solve
from separatrix.ranking.plausible import transmitted_force
from separatrix.runner import PART, Runner
from separatrix.study import BallModel, StabilitySettings
from separatrix.units import Metre, NewtonPerMetre, Ratio

NOTICED: Ratio = 0.1
"""Pocket force over the races' capacity from which the models of a ball may differ: there the law of
traction still has its slope, and at the capacity itself a fifth less."""


class Pocket(NamedTuple):
    """What the cages of candidates differ in besides friction; 0 without a land."""

    stiffness: NewtonPerMetre
    clearance: Metre
    land: Metre


def pocket_of(solution: Solution) -> Pocket:
    """Stiffness and running clearances of the cage."""
    design = solution.design
    return Pocket(solution.ball_cage_stiffness, design.pocket_clearance, design.land_clearance or 0.0)


@dataclass(frozen=True, slots=True)
class Second:
    """What a second verdict is about."""

    pocket: Pocket
    friction: Ratio


def is_beyond(solution: Solution, judgement: Judgement) -> bool:
    """Whether a run pressed a pocket with more than a tenth of what the races can transmit to its ball."""
    return judgement.largest_contact_force > NOTICED * transmitted_force(solution)


def with_other_ball(solution: Solution, friction: Ratio) -> PlanarCage:
    """Return the cage with the model of a ball that its study does not ask for."""
    is_damper = solution.stated_design.ball is BallModel.DAMPER
    other = BallModel.TRACTION if is_damper else BallModel.DAMPER
    study = replace(solution.study, cage=replace(solution.stated_design, ball=other))
    return solve(study, solution.candidate).cage_with(friction)


def second_verdict(
    solution: Solution, friction: Ratio, settings: StabilitySettings, runner: Runner
) -> Judgement:
    """Verdict by the other model of a ball, of the first 16 runs from each kick."""
    cage = with_other_ball(solution, friction)
    few = replace(settings, runs=min(PART, settings.runs))
    return judge(cage, runner.whole_ensemble(cage, few))
