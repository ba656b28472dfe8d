"""The whole ensemble behind a verdict, run in parts so that an interrupt need not wait for all of it."""

from __future__ import annotations

from dataclasses import fields
from threading import Event
from typing import Any

import numpy as np

from separatrix.cage import Ensemble, PlanarCage, run_ensemble
from separatrix.stability.pool import Stopped
from separatrix.study import StabilitySettings

PART = 16
"""Runs from each kick between two looks at whether to stop."""


def whole_ensemble(cage: PlanarCage, settings: StabilitySettings, stop: Event) -> Ensemble:
    """Every run of the settings from every kick.

    Raises
    ------
    Stopped
        `stop` was set before the last part.
    """
    parts: list[Ensemble] = []
    for first in range(0, settings.runs, PART):
        if stop.is_set():
            raise Stopped
        parts.append(run_ensemble(cage, settings, runs=min(PART, settings.runs - first), first_run=first))
    return joined(parts)


def joined(parts: list[Ensemble]) -> Ensemble:
    """One ensemble of the runs of several, from the same kicks."""

    def column(name: str) -> Any:
        values = [getattr(part, name) for part in parts]
        return np.concatenate(values, axis=1) if np.ndim(values[0]) > 1 else values[0]

    return Ensemble(**{field.name: column(field.name) for field in fields(Ensemble)})
