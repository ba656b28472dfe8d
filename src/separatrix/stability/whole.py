"""The whole ensemble behind a verdict, run in parts so that an interrupt need not wait for all of it."""

from __future__ import annotations

from dataclasses import fields
from math import isfinite
from threading import Event
from typing import Any

import numpy as np

from separatrix.cage import Ensemble, PlanarCage, run_ensemble
from separatrix.stability.pool import Stopped
from separatrix.study import StabilitySettings

PART = 16
"""Runs from each kick between two looks at whether to stop."""

LEDGERS, FOLLOWED = 2, 4
"""Runs from each kick whose ledger of work is kept, and those that are followed to their end also where it is
known to be rest on the land: the fewest whose Wilson interval lies above one half, 0.51 to 1, if all end
alike."""


def whole_ensemble(cage: PlanarCage, settings: StabilitySettings, stop: Event) -> Ensemble:
    """Every run of the settings from every kick.

    The first `LEDGERS` have their ledger, the first `FOLLOWED` are followed to their end. Where a land holds
    the cage, which cannot drift then, the others end as soon as it is known how (`Ensemble.cut`): fewer than
    one outcome in 1000 changes by it (`ensemble.DIES_OUT`).

    Raises
    ------
    Stopped
        `stop` was set before the last part.
    """
    parts: list[Ensemble] = []
    first, size = 0, LEDGERS
    while first < settings.runs:
        if stop.is_set():
            raise Stopped
        runs, cut = min(size, settings.runs - first), first >= FOLLOWED and isfinite(cage.land_gap)
        found = run_ensemble(
            cage, settings, runs=runs, first_run=first, growth_only=cut, ledger=first < LEDGERS
        )
        parts.append(found)
        first += runs
        size = FOLLOWED - first if first < FOLLOWED else PART
    return joined(parts)


def joined(parts: list[Ensemble]) -> Ensemble:
    """One ensemble of the runs of several, from the same kicks."""

    def column(name: str) -> Any:
        values = [getattr(part, name) for part in parts]
        return np.concatenate(values, axis=1) if np.ndim(values[0]) > 1 else values[0]

    return Ensemble(**{field.name: column(field.name) for field in fields(Ensemble)})
