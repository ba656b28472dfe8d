"""Runs that draw their own bearing: run n of an uncertain study has draw n of its uncertain inputs.

Such runs are judged as any others. The share of them that settles is the probability that a bearing of this
kind, made and loaded with the stated uncertainties, runs stably.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.special import ndtri

from separatrix.cage import Ensemble, Judgement, PlanarCage, judge
from separatrix.chain import CageState, cage_state
from separatrix.draws import UncertainInput, sample
from separatrix.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.friction.fit import TestedFriction
from separatrix.ranking.friction import as_pockets_see, conditions_of
from separatrix.runner import Runner, joined
from separatrix.study import Friction, Study
from separatrix.study_numbers import study_numbers
from separatrix.units import Array, MetrePerSecond, Ratio


class Case(NamedTuple):
    """A candidate in an environment; "" for the mean friction over all."""

    candidate: str
    environment: str


# Gives another cage for the one of a bearing, by its place.
Change = Callable[[int, PlanarCage], PlanarCage]

# Cage of each candidate, by its name.
States = Mapping[str, CageState]


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnBearings:
    """A bearing with its cages for each run.

    Attributes
    ----------
    study : Study
        With the frictions of its tests as the central pockets see them.
    inputs : tuple of UncertainInput
        What is drawn.
    scores : ndarray
        Draws as standard normal numbers of the same probability, shape (run, input) [-].
    central : mapping
        Cage of each candidate with every input at its central value.
    runs : tuple of int
        Numbers of the runs whose draw makes a bearing.
    states : tuple
        Cages of each of them.
    friction : mapping
        Pocket friction of each case, shape (run,) [-].
    failures : tuple of str
        Why the other draws make no bearing, one reason each.
    """

    study: Study
    inputs: tuple[UncertainInput, ...]
    scores: Array
    central: States
    runs: tuple[int, ...]
    states: tuple[States, ...]
    friction: Mapping[Case, Array]
    failures: tuple[str, ...]

    def judge(self, case: Case, kicks: Sequence[MetrePerSecond], runner: Runner) -> Judgement:
        """Judge all the runs of a case, offsets by the central cage: see `ensemble`."""
        return judge(self.cage(case), self.ensemble(case, kicks, range(len(self.runs)), runner))

    @property
    def kicks(self) -> tuple[MetrePerSecond, ...]:
        """Kicks of the central cages [m/s]."""
        return next(iter(self.central.values())).stability.kicks

    def cage(self, case: Case) -> PlanarCage:
        """Cage of a case with every input at its central value, without friction."""
        return self.central[case.candidate].cage

    def ensemble(
        self,
        case: Case,
        kicks: Sequence[MetrePerSecond],
        places: Iterable[int],
        runner: Runner,
        change: Change | None = None,
    ) -> Ensemble:
        """Run some of the bearings of a case once from each kick.

        Parameters
        ----------
        case : Case
            Whose.
        kicks : sequence of float
            From each of them [m/s].
        places : iterable of int
            Which bearings.
        runner : Runner
            Runs them.
        change : callable, optional
            Gives another cage for the one of a place.

        Raises
        ------
        Stopped
            The work was interrupted before the last run.
        """
        parts = []
        for place in places:
            state = self.states[place][case.candidate]
            cage = replace(state.cage, ball_cage_friction=float(self.friction[case][place]))
            cage = cage if change is None else change(place, cage)
            parts.append(
                runner.ensemble(cage, state.stability, kicks=kicks, runs=1, first_run=self.runs[place])
            )
        return joined(parts)


def drawn_bearings(study: Study, runs: int) -> DrawnBearings:
    """Draw a bearing for each run.

    Frictions that the study gives no distribution for scatter as their tests do: drawn is that of a new cage.
    A friction from tests follows the slip speed and the pressure in the pocket of its own draw.

    Parameters
    ----------
    study : Study
        With candidates.
    runs : int
        How many.

    Raises
    ------
    InputError
        Nothing is uncertain, or no draw makes a bearing.
    """
    asked = as_pockets_see(study)
    draws, numbers = sample(asked, runs), study_numbers(asked)
    put, failures = draws.setter(), []
    made: list[tuple[int, Study, States]] = []
    with warnings.catch_warnings():  # each draw would repeat those of the central values
        warnings.simplefilter("ignore", ValidityWarning)
        central = _states(asked)
        alike = all(numbers[key].is_friction for key in draws.names if key in numbers)
        for run, row in enumerate(draws.values.tolist()):
            try:
                drawn = put(row)
                made.append((run, drawn, central if alike else _states(drawn)))
            except SeparatrixError as error:
                failures.append(str(error))
    if not made:
        raise InputError(study.name, "makes no bearing in any draw of its uncertain inputs", failures[0])
    return DrawnBearings(
        study=asked,
        inputs=draws.inputs,
        scores=ndtri(draws.probabilities[[run for run, _, _ in made]]),
        central=central,
        runs=tuple(run for run, _, _ in made),
        states=tuple(states for _, _, states in made),
        friction=_frictions(asked, central, made),
        failures=tuple(failures),
    )


def _states(study: Study) -> States:
    """Cage of each candidate, without friction."""
    ranking = study.ranking
    return {
        one.name: cage_state(study, material=one.material, friction=0.0)
        for one in (ranking.candidates if ranking else ())
    }


def _frictions(study: Study, central: States, made: Sequence[tuple[int, Study, States]]) -> dict[Case, Array]:
    """Pocket friction of each case and made bearing; the mean over the environments as case ""."""
    found: dict[Case, Array] = {}
    for place, candidate in enumerate(study.ranking.candidates if study.ranking else ()):
        for environment, friction in candidate.friction.items():
            if friction is not None:
                drawn = [_mean(one, place, environment) for _, one, _ in made]
                moved = _moved(study, friction, candidate.name, central, made)
                found[Case(candidate.name, environment)] = np.array(drawn) * moved
        own = [values for case, values in found.items() if case.candidate == candidate.name]
        if own:
            found[Case(candidate.name, "")] = np.mean(own, axis=0)
    return found


def _mean(study: Study, place: int, environment: str) -> Ratio:
    """Mean friction of a candidate in a drawn study."""
    friction = study.ranking.candidates[place].friction[environment] if study.ranking else None
    if friction is None:
        raise LookupError(environment)
    return friction.mean


def _moved(
    study: Study, friction: Friction, name: str, central: States, made: Sequence[tuple[int, Study, States]]
) -> Array:
    """Friction from tests in the pocket of each bearing, over that in the central one; else ones."""
    if not isinstance(friction.law, TestedFriction):
        return np.ones(len(made))
    fit = friction.law.fitted(study.operation.temperature)
    pockets = [conditions_of(study, central[name])]
    pockets += [conditions_of(drawn, states[name]) for _, drawn, states in made]
    speed, pressure = (np.array([getattr(p, key) for p in pockets]) for key in ("slip_speed", "pressure"))
    log = fit.log_mean(slip_speed=speed, pressure=pressure)
    return np.asarray(np.exp(log[1:] - log[0]))


def over_inputs(found: Judgement) -> dict[str, Any]:
    """Return what a row of a ranking takes from the judgement over the uncertain inputs."""
    return {
        "uncertain_verdict": found.verdict.name,
        "uncertain_probability_stable": found.probability_stable,
        "uncertain_probability_low": found.probability_low,
        "uncertain_probability_high": found.probability_high,
        "uncertain_runs": found.runs,
    }
