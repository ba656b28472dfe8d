"""Runs that draw their own bearing: run n of an uncertain study has draw n of its uncertain inputs.

Such runs are judged as any others. The share of them that settles is the probability that a bearing of this
kind, made and loaded with the stated uncertainties, runs stably.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from threading import Event
from typing import NamedTuple

import numpy as np

from separatrix.cage import Judgement, judge, run_ensemble
from separatrix.chain import CageState, cage_state, traction_state
from separatrix.draws import sample
from separatrix.errors import InputError, SeparatrixError, ValidityWarning
from separatrix.friction_fit import TestedFriction
from separatrix.ranking.friction import as_pockets_see, conditions_of
from separatrix.stability.pool import Stopped
from separatrix.stability.whole import joined
from separatrix.study import Friction, Study
from separatrix.study_numbers import study_numbers
from separatrix.units import Array, MetrePerSecond, Ratio


class Case(NamedTuple):
    """A candidate in an environment; "" for the mean friction over all."""

    candidate: str
    environment: str


States = Mapping[str, CageState]
"""Cage of each candidate, by its name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnBearings:
    """A bearing with its cages for each run.

    Attributes
    ----------
    inputs : tuple of str
        Names of the uncertain inputs.
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

    inputs: tuple[str, ...]
    central: States
    runs: tuple[int, ...]
    states: tuple[States, ...]
    friction: Mapping[Case, Array]
    failures: tuple[str, ...]

    def judge(self, case: Case, kicks: Sequence[MetrePerSecond], stop: Event) -> Judgement:
        """Judge the runs of a case: one from each kick with each bearing, offsets by the central cage.

        Raises
        ------
        Stopped
            `stop` was set before the last run.
        """
        parts = []
        for run, states, friction in zip(self.runs, self.states, self.friction[case].tolist(), strict=True):
            if stop.is_set():
                raise Stopped
            state = states[case.candidate]
            cage = replace(state.cage, ball_cage_friction=friction)
            parts.append(run_ensemble(cage, state.stability, kicks=kicks, runs=1, first_run=run))
        return judge(self.central[case.candidate].cage, joined(parts))


def drawn_bearings(study: Study, runs: int) -> DrawnBearings | None:
    """Draw a bearing for each run; None if the study states no uncertain input.

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
        No draw makes a bearing.
    """
    if not study.distributions:
        return None
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
        raise InputError(study.name, "makes no bearing in any draw of its uncertain inputs", "", failures[0])
    return DrawnBearings(
        inputs=draws.names,
        central=central,
        runs=tuple(run for run, _, _ in made),
        states=tuple(states for _, _, states in made),
        friction=_frictions(asked, central, made),
        failures=tuple(failures),
    )


def _states(study: Study) -> States:
    """Cage of each candidate, without friction."""
    traction, ranking = traction_state(study), study.ranking
    return {
        one.name: cage_state(study, material=one.material, traction=traction, friction=0.0)
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
