"""Frictions from tests, moved with the inputs.

A friction from tests is a function of slip speed and pressure, and these follow from the uncertain inputs:
speed, load, geometry, mass, the pocket's stiffness. So a drawn friction is that of the pockets as the central
values have them, times what the fit to the tests says of the way from there. Both conditions are smooth
functions of the inputs; their logarithms are fitted by polynomials to samples of the chain.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import comb
from threading import Event

import numpy as np
from numpy.typing import NDArray

from separatrix.draws import UncertainInput, sample
from separatrix.friction_fit import TestedFriction
from separatrix.friction_fit.fit import MaterialFit
from separatrix.ranking import ranking_question
from separatrix.study import Study
from separatrix.uncertainty.chain_samples import chain_samples
from separatrix.uncertainty.polynomial import LEAST_FOR_A_TERM, Basis, best_basis
from separatrix.units import Array, Ratio

FEWEST, MOST = 64, 512
"""Samples of the chain behind the fit: enough for a parabola in all inputs, between these."""

WORTH_SAYING: Ratio = 1e-3
"""Share of a friction from which the error of the fit, or that an input moves frictions, is told."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Law:
    """Friction of one candidate in one environment over the conditions: its input, place and fit."""

    column: int
    place: int
    name: str
    fit: MaterialFit


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PocketFrictions:
    """How the frictions that come from tests move with the inputs.

    Attributes
    ----------
    laws : tuple of Law
        Those frictions.
    basis : Basis
        Of the inputs that change how pockets rub.
    weights : ndarray
        Of the logarithms of slip speed [m/s] and of the pressure in each candidate's pocket [Pa], shape
        (term, 1 + candidate).
    central : ndarray
        Those logarithms with every input at its centre, shape (1 + candidate,).
    error : float
        Root of the mean squared error that the fit makes in a friction, the largest of all, by samples it has
        not seen [-].
    """

    laws: tuple[Law, ...]
    basis: Basis
    weights: Array
    central: Array
    error: Ratio

    def moved(self, values: Array) -> Array:
        """Return the inputs with the frictions that their pockets see, shape (sample, input)."""
        logs, found = self._logs(values), values.copy()
        for law in self.laws:
            way = _log_mean(law, logs) - _log_mean(law, self.central[None])
            found[:, law.column] *= np.exp(way)
        return found

    def move_with(self, column: int, inputs: Sequence[UncertainInput]) -> bool:
        """Whether a standard deviation of an input moves any friction by more than `WORTH_SAYING` of it."""
        if column not in self.basis.columns:
            return False
        values = np.array([[one.central for one in inputs]] * 2)
        values[:, column] = inputs[column].distribution.quantile(np.array([0.16, 0.84]))
        others = [law.column for law in self.laws]
        return bool(np.any(np.abs(self.moved(values)[:, others] / values[:, others] - 1.0) > WORTH_SAYING))

    def notes(self, values: Array) -> Iterator[str]:
        """Sentences on what a reader must know of these frictions.

        Those not tested at the central values are marked in their rows already.
        """
        if self.error > WORTH_SAYING:
            share = f"{100.0 * self.error:.2g} %"
            yield f"How frictions from tests move with the inputs is fitted, to {share} of a friction."
        logs = self._logs(values)
        known = [law for law in self.laws if _tested(law, self.central[None])[0]]
        shares = {law.name: 1.0 - float(_tested(law, logs).mean()) for law in known}
        outside = {name: share for name, share in shares.items() if share > 0.0}
        if outside:
            worst = max(outside, key=lambda name: outside[name])
            share = f"{100.0 * outside[worst]:.2g} %"
            yield (
                f"In some samples a pocket rubs at a slip speed or pressure that was not tested, most often "
                f"{worst} ({share} of them): its friction is held at the nearest tested one."
            )

    def _logs(self, values: Array) -> Array:
        found: Array = self.basis.of(values) @ self.weights
        return found


def _log_mean(law: Law, logs: Array) -> Array:
    conditions = np.exp(logs)
    return law.fit.log_mean(slip_speed=conditions[:, 0], pressure=conditions[:, 1 + law.place])


def _tested(law: Law, logs: Array) -> NDArray[np.bool_]:
    conditions = np.exp(logs)
    return law.fit.tested_at(slip_speed=conditions[:, 0], pressure=conditions[:, 1 + law.place])


def pocket_frictions(
    study: Study,
    inputs: tuple[UncertainInput, ...],
    columns: tuple[int, ...],
    *,
    jobs: int = 1,
    stop: Event | None = None,
) -> PocketFrictions | None:
    """Fit how the pockets rub to samples of the chain; None if no friction depends on it.

    Parameters
    ----------
    study : Study
        With the frictions as `as_pockets_see` leaves them.
    inputs : tuple of UncertainInput
        From `uncertain_inputs`.
    columns : tuple of int
        Those of them that enter the chain.

    Raises
    ------
    KeyboardInterrupt
        Interrupted.
    """
    laws = tuple(_laws(study, {one.key: i for i, one in enumerate(inputs)}))
    if not laws or not columns:
        return None
    wanted = LEAST_FOR_A_TERM * comb(len(columns) + 2, 2)
    draws = sample(study, min(max(wanted, FEWEST), MOST))
    found = chain_samples(study, draws, jobs=jobs, stop=stop)
    if not found.complete:
        raise KeyboardInterrupt
    conditions = np.column_stack((found.slip_speed, found.pocket_pressure))[found.solved]
    values, logs = draws.values[found.solved], np.log(conditions)
    basis, unseen = best_basis(values, columns, logs)
    weights = basis.fitted(values, logs)
    errors = [np.mean((_log_mean(law, unseen) - _log_mean(law, logs)) ** 2) for law in laws]
    centre = np.array([[one.central for one in inputs]])
    return PocketFrictions(
        laws=laws,
        basis=basis,
        weights=weights,
        central=(basis.of(centre) @ weights)[0],
        error=float(np.sqrt(max(errors))),
    )


def _laws(study: Study, places: Mapping[str, int]) -> Iterator[Law]:
    """Frictions that depend on slip speed or pressure, by tests that tell."""
    for place, candidate in enumerate(ranking_question(study).candidates):
        for environment, friction in candidate.friction.items():
            column = places.get(f"ranking.{candidate.name}.{environment}")
            if column is None or friction is None or not isinstance(friction.law, TestedFriction):
                continue
            fit = friction.law.fitted(study.operation.temperature)
            if fit.covariates.names:
                yield Law(column=column, place=place, name=f"{candidate.name} in {environment}", fit=fit)
