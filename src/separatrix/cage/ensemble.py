"""An ensemble of runs: kicks and seeds, over threads, the same numbers for any number of them."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import run as single
from separatrix.cage.motion import ball_directions, coefficients, step_counts, unit_step
from separatrix.cage.planar import PlanarCage, RunOutcome
from separatrix.errors import InputError
from separatrix.units import Array, MetrePerSecond, Ratio, Second

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from separatrix.cage.motion import Coefficients
    from separatrix.study import StabilitySettings

CHUNK_STEPS = 2_000_000
MOST_STEPS = 2_000_000_000
GROWN = 100.0
DEAD = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Ensemble:
    """Outcome and evidence of every run; arrays have shape (kick, run) unless said.

    Attributes
    ----------
    kicks : ndarray
        Speeds of the kicks, shape (kick,) [m/s].
    outcome : ndarray
        `RunOutcome` of each run, integer.
    energy_growth : ndarray
        Mean kinetic energy at the end (last fifth; last fiftieth if ended early) over the kick's [-].
    largest_offset : ndarray
        Largest offset of the cage centre [m].
    drift_rate : ndarray
        Growth rate of the mean offset between the last two fifths; 0 if the run ended early [1/s].
    whirl_frequency, whirl_direction : ndarray
        Mean turning rate of the velocity at the end in the turning frame, weighted with its square [Hz], and its
        sense: 1 forward (as the ball set turns), -1 backward, 0 none.
    largest_contact_force : ndarray
        Largest force between a ball and its pocket [N].
    energy_imbalance : ndarray
        What the ledger of sources and sinks leaves unexplained, over the work done [-].
    duration : float
        Length of a run that is not ended early [s].
    """

    kicks: Array
    outcome: NDArray[np.int64]
    energy_growth: Ratio | Array
    largest_offset: Array
    drift_rate: Array
    whirl_frequency: Array
    whirl_direction: NDArray[np.int64]
    largest_contact_force: Array
    energy_imbalance: Array
    duration: Second

    def count(self, outcome: RunOutcome) -> NDArray[np.int64]:
        """Runs that ended so at each kick, shape (kick,)."""
        return np.asarray(np.count_nonzero(self.outcome == outcome, axis=1), dtype=np.int64)


def run_ensemble(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    jobs: int = 1,
) -> Ensemble:
    """Run the cage from every kick and seed.

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

    Raises
    ------
    InputError
        No kick or no run, or a run would need more steps than can be waited for.
    """
    kicks = tuple(settings.kicks if kicks is None else kicks)
    runs = settings.runs if runs is None else runs
    _check(kicks, runs, settings.duration)
    p, fifth = _steps(cage, settings.duration)
    starts = np.array(
        [
            single.random_start(settings.seed, run, cage.ball_count)
            for run in range(first_run, first_run + runs)
        ]
    )
    evidence = np.zeros((len(kicks), runs, single.EVIDENCE))
    size = max(1, CHUNK_STEPS // (5 * fifth))
    chunks = [(i, slice(first, first + size)) for i in range(len(kicks)) for first in range(0, runs, size)]
    cos, sin = ball_directions(cage.ball_count)
    counts = step_counts(cage, p.unit)
    scatter = settings.ball_scatter * cage.half_play

    def work(chunk: tuple[int, slice]) -> None:
        i, rows = chunk
        single.run_chunk(
            p, cos, sin, counts, starts[rows], scatter, kicks[i], fifth, _limits(cage, kicks[i]), cage.rotation_sense,
            evidence[i, rows],
        )  # fmt: skip

    _each(work, chunks, jobs)
    return _ensemble(np.asarray(kicks, dtype=np.float64), evidence, settings.duration)


def _check(kicks: Sequence[float], runs: int, duration: float) -> None:
    if not kicks:
        raise InputError("[stability] kicks", "must hold at least one speed", "m/s")
    if any(not (math.isfinite(kick) and kick >= 0) for kick in kicks):
        raise InputError("[stability] kicks", "must be finite and >= 0", "m/s", str(list(kicks)))
    if runs < 1:
        raise InputError("[stability] runs", "must be at least 1", "-", str(runs))
    if not (math.isfinite(duration) and duration > 0):
        raise InputError("[stability] duration", "must be finite and > 0", "s", str(duration))


def _steps(cage: PlanarCage, duration: Second) -> tuple[Coefficients, int]:
    """Kernel's numbers at the step that divides a fifth of the duration, and the steps in it."""
    count = duration / single.FIFTHS / unit_step(cage)
    if not count <= MOST_STEPS:
        cure = "Shorten [stability] duration, or check the cage's stiffnesses and inertia."
        raise InputError("[stability] duration", "needs too many steps", "s", f"{duration}", cure)
    fifth = max(1, math.ceil(count))
    return coefficients(cage, duration / single.FIFTHS / fifth), fifth


def _limits(cage: PlanarCage, kick: float) -> tuple[float, float, float]:
    """Offset of drift, and the energies that decide a run early."""
    landless = math.isinf(cage.land_gap)
    unforced = landless and cage.cage_speed == 0 and cage.gravity == 0
    dead = DEAD * 0.5 * cage.mass * kick**2 if unforced else -1.0
    drift = 2.0 * cage.half_play if landless and cage.half_play > 0 else math.inf
    return drift, GROWN * single.energy_scale(cage, kick), dead


def _each(work, chunks, jobs):  # type: ignore[no-untyped-def]
    if jobs <= 1 or len(chunks) == 1:
        for chunk in chunks:
            work(chunk)
        return
    pool = ThreadPoolExecutor(max_workers=jobs)
    try:
        for _ in pool.map(work, chunks):
            pass
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _ensemble(kicks: Array, evidence: Array, duration: Second) -> Ensemble:
    def column(slot: int) -> Array:
        return np.ascontiguousarray(evidence[..., slot])

    return Ensemble(
        kicks=kicks,
        outcome=column(single.OUTCOME).astype(np.int64),
        energy_growth=column(single.GROWTH),
        largest_offset=column(single.OFFSET),
        drift_rate=column(single.DRIFT_RATE),
        whirl_frequency=column(single.WHIRL),
        whirl_direction=column(single.DIRECTION).astype(np.int64),
        largest_contact_force=column(single.FORCE),
        energy_imbalance=column(single.IMBALANCE),
        duration=duration,
    )
