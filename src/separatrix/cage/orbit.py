"""Classes of cage motion, by the orbit of the cage centre: stable, circling, unstable."""

from __future__ import annotations

import math
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.drive import drive_energy, room
from separatrix.cage.planar import PlanarCage, RunOutcome
from separatrix.units import Array

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble

Mask = NDArray[np.bool_]

EVEN = 0.25
"""Spread over mean of the offset below which an orbit is round: half of what a motion without any preferred
radius has (0.523, Rayleigh), and what an ellipse of axes 1 to 2 has (0.227)."""

NEAR = 0.5
"""Share of its room beyond which a cage centre circles the axis; nearer to the axis it is held there."""

WINDOW = 0.2
"""Share of a run that its last window is."""

KEPT = 0.1
"""Share of the kick's energy that a circling run must have kept to be called neither dying nor growing."""

LEFT = 2.0
"""Mean offset in half plays of the pockets at which the cage has left them, as the mark of DRIFT."""


class CageMotion(Enum):
    """What the cage centre does at the end of the runs."""

    STABLE = "The cage centre stays near the axis, or rests where its loads hold it."
    CIRCLING = "The cage centre circles the axis at an even distance."
    UNSTABLE = "The cage gains energy, or its centre leaves the play of its pockets."


def cage_motion(cage: PlanarCage, ensemble: Ensemble) -> CageMotion:
    """Class of the motion from the kick that is worst: what at least half of its runs do."""
    wild = unstable(cage, ensemble)
    if _half(ensemble, wild):
        return CageMotion.UNSTABLE
    even = wild | circling(cage, ensemble)
    return CageMotion.CIRCLING if _half(ensemble, even) else CageMotion.STABLE


def _half(ensemble: Ensemble, runs: Mask) -> bool:
    """Whether at least half of the runs do so from any kick."""
    return bool(np.any(ensemble.share(runs) >= 0.5))


def unstable(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs that gain more energy than their drive explains, or leave their pockets, shape (kick, run)."""
    gained = (ensemble.outcome == RunOutcome.GROWS) & ~driven(cage, ensemble)
    away = (ensemble.outcome == RunOutcome.DRIFT) | left_pockets(cage, ensemble)
    return np.asarray(gained | away)


def left_pockets(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs whose centre ended beyond twice the half play of the pockets, shape (kick, run)."""
    limit = LEFT * cage.half_play if cage.half_play > 0.0 else math.inf
    return np.asarray(ensemble.mean_offset > limit)


def circling(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs whose centre goes round the axis at an even distance, in the outer half of its room."""
    far = (ensemble.mean_offset > 0.0) & (ensemble.mean_offset >= NEAR * room(cage))
    round_ = ensemble.offset_spread <= EVEN * ensemble.mean_offset
    turns = np.abs(ensemble.orbit_speed) * WINDOW * ensemble.duration / (2.0 * math.pi)
    return np.asarray(far & round_ & (turns >= 1.0))


def end_energy(cage: PlanarCage, ensemble: Ensemble) -> Array:
    """Mean kinetic energy at the end of each run, shape (kick, run) [J]."""
    return np.asarray(ensemble.energy_growth * kick_energy(cage, ensemble)[:, np.newaxis], dtype=np.float64)


def kick_energy(cage: PlanarCage, ensemble: Ensemble) -> Array:
    """Kinetic energy of each kick, shape (kick,) [J]."""
    return np.asarray(0.5 * cage.mass * ensemble.kicks**2, dtype=np.float64)


def driven(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs that have more energy than the kick, but no more than the drive gives without any kick."""
    no_more = end_energy(cage, ensemble) <= drive_energy(cage)
    return np.asarray((ensemble.outcome == RunOutcome.GROWS) & no_more)


def sustained(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs that lost energy but keep circling on more than a tenth of it, and more than the drive gives."""
    energy = end_energy(cage, ensemble)
    kept = (energy > KEPT * kick_energy(cage, ensemble)[:, np.newaxis]) & (energy > drive_energy(cage))
    return np.asarray((ensemble.outcome == RunOutcome.DIES) & circling(cage, ensemble) & kept)
