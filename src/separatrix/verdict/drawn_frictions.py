"""Runs that draw their own bearing: run n of an uncertain study has draw n of its uncertain inputs.

Such runs are judged as any others. The share of them that settles is the probability that a bearing of this
kind, made and loaded with the stated uncertainties, runs stably.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from separatrix.cage.disturbance import settings_for
from separatrix.cage.ensemble import Ensemble, Runs
from separatrix.cage.moving_cage import MovingCage, moving_cage
from separatrix.chain.solution import Solution, solve
from separatrix.friction.friction_fit import TestedFriction
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import Array, MetrePerSecond, Ratio
from separatrix.study.keys import study_numbers
from separatrix.study.study import BallModel, Friction, Study
from separatrix.verdict.draws import Case, UncertainInput, sample, stated_frictions
from separatrix.verdict.judgement import Judgement, judge
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.which_ball import asks_free_balls, transmitted_force, whirl_share, with_reason

Change = Callable[[int, MovingCage], MovingCage]  # from the cage of a bearing, by its place, to another
Solutions = Mapping[str, Solution]  # by the name of the candidate


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnBearings:
    """A bearing with its cages for each run."""

    study: Study  # as it is stated
    stated: Mapping[Case, Friction]
    """Friction of each measured case that is drawn: from tests as the central pocket sees it."""
    inputs: tuple[UncertainInput, ...]  # what is drawn
    scores: Array  # draws as standard normal numbers of the same probability, shape (run, input) [-]
    central: Solutions  # chain of each candidate with every input at its central value
    runs: tuple[int, ...]  # numbers of the runs whose draw makes a bearing
    solved: tuple[Solutions, ...]  # chains of each of them
    friction: Mapping[Case, Array]  # pocket friction of each case, shape (run,) [-]
    failures: tuple[str, ...]  # why the other draws make no bearing, one reason each

    def judge(self, case: Case, kicks: Sequence[MetrePerSecond], runner: Runner) -> Judgement:
        """Judge all the runs of a case by the ball that decides: see `ensemble`."""
        every = range(len(self.runs))

        def judged(ball: BallModel | None) -> Judgement:
            return self.judged(case, self.ensemble(case, kicks, every, runner, ball=ball), ball)

        return self.by_ball(case, judged)

    def judged(self, case: Case, found: Ensemble, ball: BallModel | None) -> Judgement:
        """Judge runs of a case, offsets by the central cage among such balls."""
        capacity = transmitted_force(self.central[case.candidate])
        return judge(self.cage(case, ball), found, capacity=capacity)

    def by_ball(self, case: Case, judged: Callable[[BallModel | None], Judgement]) -> Judgement:
        """Verdict on a case by the ball of the study, or by free balls where they have to be asked."""
        solution = self.central[case.candidate]
        level, share = solution.design.ball_model, whirl_share(self.cage(case), transmitted_force(solution))
        first = judged(None)
        if not asks_free_balls(level, first, share):
            return with_reason(level, first, share)
        return with_reason(level, judged(BallModel.FREE), share, first)

    @property
    def kicks(self) -> tuple[MetrePerSecond, ...]:
        """Kicks of the central cages [m/s]."""
        cage = moving_cage(next(iter(self.central.values())), 0.0)
        return settings_for(self.study.stability, cage).kicks

    def cage(self, case: Case, ball: BallModel | None = None) -> MovingCage:
        """Cage of a case with every input at its central value, and its stated friction."""
        own = [self.stated[one].mean for one in self.stated if one.candidate == case.candidate]
        friction = self.stated[case].mean if case.environment else float(np.mean(own))
        return moving_cage(self.central[case.candidate], friction, ball)

    def ensemble(
        self,
        case: Case,
        kicks: Sequence[MetrePerSecond],
        places: Iterable[int],
        runner: Runner,
        change: Change | None = None,
        ball: BallModel | None = None,
    ) -> Ensemble:
        """Run the bearings at these places once from each kick [m/s], perhaps each with a changed cage.

        `Interrupted` if the work was interrupted before the last run.
        """
        asked = []
        for place in places:
            own = self.solved[place][case.candidate]
            cage = moving_cage(own, float(self.friction[case][place]), ball)
            cage = cage if change is None else change(place, cage)
            asked.append(Runs(cage, own.study.stability, self.runs[place], 1))
        return runner.ensemble_of(asked, kicks)


def drawn_bearings(study: Study, runs: int) -> DrawnBearings:
    """Draw a bearing of a study with candidates for each run.

    Frictions without a distribution in the study scatter as their tests do: drawn is that of a new cage. A
    friction from tests follows the slip speed and the pressure in the pocket of its own draw.

    Raises
    ------
    InputError
        Nothing is uncertain, or no draw makes a bearing.
    """
    made: list[tuple[int, Study, Solutions]] = []
    failures = []
    central = _solutions(study)
    stated = frictions_to_draw(study, central)
    draws, numbers = sample(study, runs, frictions=stated), study_numbers(study)
    put = draws.setter()
    alike = all(numbers[key].is_friction for key in draws.names if key in numbers)
    for run, row in enumerate(draws.values.tolist()):
        try:
            drawn = put(row)
            own = central if alike else _solutions(drawn)
            for one in own.values():
                moving_cage(one, 0.0)  # refused here, not in a thread
            made.append((run, drawn, own))
        except SeparatrixError as error:
            failures.append(str(error))
    if not made:
        rule = "makes no bearing in any draw of its uncertain inputs"
        raise InputError(study.name, rule, failures[0])
    friction = _frictions(stated, central, made)
    return DrawnBearings(
        study=study,
        stated=stated,
        inputs=draws.inputs,
        scores=ndtri(draws.probabilities[[run for run, _, _ in made]]),
        central=central,
        runs=tuple(run for run, _, _ in made),
        solved=tuple(own for _, _, own in made),
        friction=friction,
        failures=tuple(failures),
    )


def frictions_to_draw(study: Study, central: Solutions | None = None) -> dict[Case, Friction]:
    """Measured friction of each case; one from tests as the pocket sees it, with its scatter there.

    A friction that is stated without tests keeps its own scatter: how much it differs in the pocket is not
    known. `extrapolation` names for both what was not tested.
    """
    found = stated_frictions(study)
    for case, friction in found.items():
        if friction.law is None:
            continue
        solution = (central or _solutions(study))[case.candidate]
        seen = solution.frictions[case.environment] or friction
        of_tests = isinstance(friction.law, TestedFriction)
        found[case] = seen if of_tests else replace(friction, extrapolation=seen.extrapolation)
    return found


def _solutions(study: Study) -> Solutions:
    """Chain of each candidate."""
    ranking = study.ranking
    return {one.name: solve(study, one) for one in (ranking.candidates if ranking else ())}


def _frictions(
    stated: Mapping[Case, Friction], central: Solutions, made: Sequence[tuple[int, Study, Solutions]]
) -> dict[Case, Array]:
    """Pocket friction of each case and made bearing; the mean over the environments as case ""."""
    found: dict[Case, Array] = {}
    for name in central:
        own = [case for case in stated if case.candidate == name]
        for case in own:
            drawn = [_mean(one, case) for _, one, _ in made]
            found[case] = np.array(drawn) * _moved(stated[case], name, central, made)
        if own:
            found[Case(name, "")] = np.mean([found[case] for case in own], axis=0)
    return found


def _mean(study: Study, case: Case) -> Ratio:
    """Mean friction of a case in a drawn study."""
    candidates = study.ranking.candidates if study.ranking else ()
    friction = next(one.friction[case.environment] for one in candidates if one.name == case.candidate)
    if friction is None:
        raise LookupError(case)
    return friction.mean


def _moved(
    friction: Friction, name: str, central: Solutions, made: Sequence[tuple[int, Study, Solutions]]
) -> Array:
    """Friction from tests in the pocket of each bearing, over that in the central one; else ones."""
    if not isinstance(friction.law, TestedFriction):
        return np.ones(len(made))
    fit = friction.law.fitted(central[name].study.operation.temperature)
    pockets = [central[name].pocket, *(own[name].pocket for _, _, own in made)]
    speed, pressure = (np.array([getattr(p, key) for p in pockets]) for key in ("slip_speed", "pressure"))
    log = fit.log_mean(slip_speed=speed, pressure=pressure)
    return np.asarray(np.exp(log[1:] - log[0]))
