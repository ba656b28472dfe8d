"""Classes of cage motion: what the cage does at the end of its runs."""

from __future__ import annotations

import math
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from separatrix.cage.drive import room
from separatrix.cage.planar import PlanarCage, RunOutcome
from separatrix.units import Metre

if TYPE_CHECKING:
    from separatrix.cage.ensemble import Ensemble

Mask = NDArray[np.bool_]

LEFT = 2.0
"""Mean offset, in half plays of the pockets, at which a cage that a land holds has left its pockets."""

BEYOND = 2.0
"""Offset, over the room of the cage centre (land or half play, the larger), that no cage survives."""


class CageMotion(Enum):
    """What the cage does at the end of the runs."""

    CENTRED = "CENTRED"
    ON_THE_LAND = "ON THE LAND"
    WHIRLING = "WHIRLING"
    DRIFTING = "DRIFTING"


def cage_motion(ensemble: Ensemble, kick: int) -> CageMotion | None:
    """Class of the motion that most runs from one kick end in; None if most are unresolved.

    Parameters
    ----------
    ensemble : Ensemble
        The runs.
    kick : int
        Place of the kick in the ensemble.
    """
    outcome, rubbing = ensemble.outcome[kick], ensemble.rubbing_force[kick] > 0.0
    settled = outcome == RunOutcome.SETTLES
    shares = {
        CageMotion.WHIRLING: outcome == RunOutcome.WHIRLS,
        CageMotion.DRIFTING: outcome == RunOutcome.DRIFTS,
        CageMotion.ON_THE_LAND: settled & rubbing,
        CageMotion.CENTRED: settled & ~rubbing,
    }
    counts = {motion: int(np.count_nonzero(runs)) for motion, runs in shares.items()}
    most = max(counts, key=lambda motion: counts[motion])
    unresolved = int(np.count_nonzero(outcome == RunOutcome.UNRESOLVED))
    return most if counts[most] >= max(1, unresolved) else None


def left_pockets(cage: PlanarCage, ensemble: Ensemble) -> Mask:
    """Runs whose centre ended beyond twice the half play of the pockets, shape (kick, run)."""
    limit = LEFT * cage.half_play if cage.half_play > 0.0 else math.inf
    return np.asarray(ensemble.mean_offset > limit)


def largest_room(cage: PlanarCage) -> Metre:
    """Offset beyond which the model of land and pockets has no meaning [m]."""
    wide = max(room(cage), cage.half_play)
    return BEYOND * wide if wide > 0.0 else math.inf
