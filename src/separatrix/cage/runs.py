"""Runs of a cage, in the plane or in space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from separatrix.cage.closed_forms import fastest_rate
from separatrix.cage.ensemble import MOST_RADIANS, Ensemble, run_in_plane
from separatrix.cage.space.ensemble import run_in_space
from separatrix.cage.space.inputs import fastest_in_space

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage
    from separatrix.study import StabilitySettings
    from separatrix.units import MetrePerSecond, Second


def longest_duration(cage: PlanarCage) -> Second:
    """Duration above which `run_ensemble` refuses a run of this cage."""
    return MOST_RADIANS / (fastest_rate(cage) if cage.space is None else fastest_in_space(cage))


def run_ensemble(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    jobs: int = 1,
) -> Ensemble:
    """Run the cage from every kick and seed, in the plane or, with a `space`, in space.

    Parameters
    ----------
    cage : PlanarCage
        The cage.
    settings : StabilitySettings
        Kicks, runs, duration, scatter and seed.
    kicks, runs
        Instead of those of the settings.
    first_run : int
        Number of the first run; runs 0 to 11 and then 12 to 63 are the same as 0 to 63 at once.
    jobs : int
        Threads. The result is the same to the last bit for any number.

    Returns
    -------
    Ensemble
        In space a `SpaceEnsemble`, with more evidence.

    Raises
    ------
    InputError
        No kick or no run, or a run would need more steps than can be waited for.
    """
    how = run_in_plane if cage.space is None else run_in_space
    return how(cage, settings, kicks=kicks, runs=runs, first_run=first_run, jobs=jobs)
