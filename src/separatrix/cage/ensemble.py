"""An ensemble of runs: kicks and seeds, over threads, the same numbers for any number of them."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import slots
from separatrix.cage.coefficients import Coefficients, ball_directions, coefficients, step_counts, unit_step
from separatrix.cage.planar import PlanarCage, RunOutcome, turned_forward
from separatrix.cage.run import FIFTHS, Limits, random_start, run_chunk
from separatrix.errors import InputError
from separatrix.units import Array, Joule, MetrePerSecond, Second

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from separatrix.study import StabilitySettings

CHUNK_UNITS = 10_000_000
"""Time of the runs that one call of the kernel takes, in units: some tenths of a second of work."""

MOST_UNITS = 1_000_000_000
"""Longest run, in units."""

GROWN, DEAD = 100.0, 1e-4
"""A run ends early, as growing or dying, at these multiples of the energy scale; it changes no outcome."""

GROWS_ON, DIES_OUT = 10.0, 1e-3
"""A run also ends when its mean energy over a fifth, from the second on, is above, or (where only growth is
asked for) below these multiples of the kick's. Of 14 256 runs the first bounds to change one were 3, 1e-2."""


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
        Mean turning rate of the velocity at the end in the turning frame, weighted with its square [Hz], and
        its sense: 1 forward (as the ball set turns), -1 backward, 0 none.
    largest_contact_force : ndarray
        Largest force between a ball and its pocket [N].
    energy_imbalance : ndarray
        What the ledger of sources and sinks leaves unexplained, over the work done [-].
    duration : float
        Length of a run that is not ended early [s].
    """

    kicks: Array
    outcome: NDArray[np.int64]
    energy_growth: Array
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
    growth_only: bool = False,
    jobs: int = 1,
) -> Ensemble:
    """Run the cage from every kick and seed; one that turns backward as its mirror image.

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
    growth_only : bool
        End a run that dies as soon as it is known; its evidence, drift among it, is then that of the part
        which was run.
    jobs : int
        Threads. The result is the same to the last bit for any number.

    Raises
    ------
    InputError
        No kick or no run, or a run would need more steps than can be waited for.
    """
    cage = turned_forward(cage)
    speeds, runs = chosen(settings, kicks, runs)
    engine = prepare(cage, settings.duration)
    starts = random_starts(cage, settings, first_run, runs)
    evidence = np.zeros((len(speeds), runs, slots.EVIDENCE))
    nothing = np.zeros((0, slots.BALLS))

    def work(i: int, rows: slice) -> None:
        limits = run_limits(cage, speeds[i], growth_only=growth_only)
        run_chunk(*engine.kernel_arguments, starts[rows], speeds[i], engine.fifth, limits,
        cage.rotation_sense,
                  nothing, evidence[i, rows])  # fmt: skip

    spread(work, len(speeds), runs, max(1, CHUNK_UNITS // (FIFTHS * engine.fifth)), jobs)
    return gathered(speeds, evidence, settings.duration)


@dataclass(frozen=True, slots=True)
class Engine:
    """One cage made ready for the kernel: its numbers, and the units in a fifth of a run."""

    coefficients: Coefficients
    fifth: int
    cos: Array
    sin: Array
    counts: NDArray[np.int64]

    @property
    def kernel_arguments(self) -> tuple[Coefficients, Array, Array, NDArray[np.int64]]:
        """The first arguments of every kernel."""
        return self.coefficients, self.cos, self.sin, self.counts


def prepare(cage: PlanarCage, duration: Second) -> Engine:
    """Choose the unit of time from the cage, so that it divides a fifth of the duration."""
    unit = unit_step(cage)
    if not duration / unit <= MOST_UNITS:
        cure = "Shorten the run, or check the cage's stiffnesses, mass and moment of inertia."
        longest = f"must be at most {MOST_UNITS * unit:.3g} for this cage"
        raise InputError("[stability] duration", longest, "s", f"{duration:g}", cure)
    fifth = max(1, math.ceil(duration / FIFTHS / unit))
    p = coefficients(cage, duration / FIFTHS / fifth)
    return Engine(p, fifth, *ball_directions(cage.ball_count), step_counts(cage, p.unit))


def random_starts(cage: PlanarCage, settings: StabilitySettings, first_run: int, runs: int) -> Array:
    """Direction of the kick [rad] and lead of each ball [m] of every run, shape (run, 1 + ball)."""
    numbers = range(first_run, first_run + runs)
    starts = np.array([random_start(settings.seed, run, cage.ball_count) for run in numbers])
    starts[:, 1:] *= settings.ball_scatter * cage.half_play
    return starts


def chosen(
    settings: StabilitySettings, kicks: Sequence[MetrePerSecond] | None, runs: int | None
) -> tuple[Array, int]:
    """Kicks, shape (kick,), and runs: those given, else those of the settings; refuse what is no ensemble."""
    speeds = np.array(settings.kicks if kicks is None else kicks, dtype=np.float64)
    count = settings.runs if runs is None else runs
    if speeds.size == 0 or not np.all(np.isfinite(speeds) & (speeds > 0)):
        cure = "A kick of zero starts nothing that could grow or die."
        raise InputError(
            "[stability] kicks", "must be one or more speeds > 0", "m/s", str(speeds.tolist()), cure
        )
    if count < 1:
        raise InputError("[stability] runs", "must be at least 1", "-", str(count))
    return speeds, count


def run_limits(cage: PlanarCage, kick: MetrePerSecond, *, growth_only: bool = False) -> Limits:
    """Offset that is drift, and the energies at which a run's end is known.

    The land holds a guided cage, so its offset is no drift. Only a cage that nothing drives can be known to
    die from its energy at one time.
    """
    landless = math.isinf(cage.land_gap)
    driven = not landless or cage.cage_speed != 0 or cage.gravity > 0
    scale, given = energy_scale(cage, kick), 0.5 * cage.mass * kick**2
    return Limits(
        drift=2.0 * cage.half_play if landless and cage.half_play > 0 else math.inf,
        grows_above=GROWN * scale,
        dies_below=-1.0 if driven else DEAD * scale,
        mean_grows_above=GROWS_ON * given,
        mean_dies_below=DIES_OUT * given if growth_only else -1.0,
    )


def energy_scale(cage: PlanarCage, kick: MetrePerSecond) -> Joule:
    """Energy beside which growth is judged early [J].

    The kick's, and what the frame and gravity do over the way that the cage has.
    """
    way = 2.0 * cage.half_play if math.isinf(cage.land_gap) else cage.land_gap
    return cage.mass * (0.5 * kick**2 + 0.5 * (cage.cage_speed * way) ** 2 + cage.gravity * way)


def spread(work: Callable[[int, slice], None], kicks: int, runs: int, size: int, jobs: int) -> None:
    """Do the work on chunks of `size` runs of every kick, by threads; an interrupt waits for these only."""
    chunks = [
        (i, slice(first, min(first + size, runs))) for i in range(kicks) for first in range(0, runs, size)
    ]
    if jobs <= 1 or len(chunks) == 1:
        for chunk in chunks:
            work(*chunk)
        return
    pool = ThreadPoolExecutor(max_workers=jobs)
    try:
        for done in [pool.submit(work, *chunk) for chunk in chunks]:
            done.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def gathered(kicks: Array, evidence: Array, duration: Second) -> Ensemble:
    """Record of the evidence of all runs, shape (kick, run, evidence)."""

    def column(slot: int) -> Array:
        return np.ascontiguousarray(evidence[..., slot])

    return Ensemble(
        kicks=kicks,
        outcome=column(slots.OUTCOME).astype(np.int64),
        energy_growth=column(slots.GROWTH),
        largest_offset=column(slots.OFFSET),
        drift_rate=column(slots.DRIFT_RATE),
        whirl_frequency=column(slots.WHIRL),
        whirl_direction=column(slots.DIRECTION).astype(np.int64),
        largest_contact_force=column(slots.FORCE),
        energy_imbalance=column(slots.IMBALANCE),
        duration=duration,
    )
