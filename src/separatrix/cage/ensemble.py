"""An ensemble of runs: kicks and seeds, over threads, the same numbers for any number of them."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np

from separatrix.cage.closed_forms import fastest_rate, time_unit
from separatrix.cage.ending import run_limits
from separatrix.cage.inputs import balls_of, coefficients
from separatrix.cage.planar import PlanarCage, RunOutcome, turned_forward
from separatrix.cage.records import PLAIN, Evidence, Samples, dtype_of, samples_for
from separatrix.cage.run import books_for, random_start, run_chunk, run_plain_chunk
from separatrix.errors import InputError
from separatrix.study import LEAST_KICK, NO_KICK, StabilitySettings
from separatrix.units import Array, Metre, MetrePerSecond, RadianPerSecond, Ratio, Second, format_quantity

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray


Scalar = TypeVar("Scalar", bound=np.generic)

REFERENCE: Ratio = 2.5
"""Reference kick over the pocket speed [-]."""

SPAN: tuple[Ratio, ...] = (0.2, 1.0, 4.0)
"""Kicks over the reference kick: 0.5, 2.5 and 10 times the pocket speed [-]."""

LEAST_POCKET_SPEED: MetrePerSecond = 0.02
"""Pocket speed of a ball set at rest or a pocket without clearance: the reference kick is then 0.05 m/s."""

DIGITS = 3
"""Significant digits of a default kick, so that a reader can repeat it."""


CHUNK_RADIANS = 200_000.0
"""Time of the runs that one call of the kernel takes, in radians of the fastest motion: some tenths of a
second of work."""

PER_MASS = (
    "largest_contact_force",
    "largest_land_force",
    "rubbing_force",
    "end_energy",
    "pocket_power",
    "land_power",
)
"""Evidence that the kernels give over the mass."""

MOST_RADIANS = 1e8
"""Longest run, in radians of the fastest motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ensemble:
    """Outcome and evidence of every run; arrays have shape (kick, run) unless stated.

    Attributes
    ----------
    kicks : ndarray
        Speeds of the kicks, shape (kick,) [m/s].
    outcome : ndarray
        `RunOutcome` of each run, integer.
    cause : ndarray
        `Cause` of each run that is unresolved, or that friction on the land keeps moving, integer; else 0.
    end_energy : ndarray
        Mean kinetic energy in the last part of the run: the last fifth, or the last window by which its end
        was plain [J].
    growth_rate : ndarray
        Half the logarithmic rate of the mean kinetic energy from half way to the last fifth; from the kick in
        a run that ends within five looks [1/s].
    largest_offset : ndarray
        Largest offset of the cage centre [m].
    mean_offset, offset_spread : ndarray
        Mean and standard deviation of the offset over the last part [m].
    orbit_speed : ndarray
        Mean angular speed of the centre about the bearing's axis in the fixed frame, weighted with the
        squared offset, over the last part; positive as the ball set turns [rad/s].
    drift_rate : ndarray
        Growth rate of the mean offset late in the run, of a cage free to drift that of its mean place [1/s].
    whirl_frequency, whirl_direction : ndarray
        Mean turning rate of the velocity at the end in the turning frame, weighted with its square [Hz], and
        its sense: 1 forward (as the ball set turns), -1 backward, 0 none.
    largest_contact_force, largest_land_force : ndarray
        Largest force between a ball and its pocket, and between cage and land [N].
    pocket_impacts, land_impacts : ndarray
        How often each pocket met its ball, shape (kick, run, ball), and the cage its land.
    energy_imbalance : ndarray
        What the ledger of sources and sinks leaves unexplained, over the work done [-].
    pocket_power, land_power : ndarray
        Mean power that the friction of pockets and of the land feeds into the cage in the last part; 0 where
        the run ended before it was known [W].
    rubbing_force, rubbing_speed : ndarray
        Mean normal force on the land over the last part [N], and the sliding speed there weighted with it
        [m/s].
    followed, judged_from : ndarray
        Time up to which the run was judged, and at which its last part begins [s].
    duration : float
        Of a run whose end is plain by then; others go on, to `ending.LONGEST` times as long at most [s].
    """

    kicks: Array
    outcome: NDArray[np.int64]
    cause: NDArray[np.int64]
    end_energy: Array
    growth_rate: Array
    largest_offset: Array
    mean_offset: Array
    offset_spread: Array
    orbit_speed: Array
    drift_rate: Array
    whirl_frequency: Array
    whirl_direction: NDArray[np.int64]
    largest_contact_force: Array
    largest_land_force: Array
    pocket_impacts: NDArray[np.int64]
    land_impacts: NDArray[np.int64]
    energy_imbalance: Array
    pocket_power: Array
    land_power: Array
    rubbing_force: Array
    rubbing_speed: Array
    followed: Array
    judged_from: Array
    duration: Second

    def count(self, outcome: RunOutcome) -> NDArray[np.int64]:
        """Runs that ended so at each kick, shape (kick,)."""
        return np.asarray(np.count_nonzero(self.outcome == outcome, axis=1), dtype=np.int64)


def run_in_plane(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    jobs: int = 1,
) -> Ensemble:
    """Run the cage in the plane from every kick and seed; one that turns backward as its mirror image.

    Parameters
    ----------
    cage, settings, kicks, runs, first_run, jobs
        As in `cage.run_ensemble`.

    Raises
    ------
    InputError
        No kick or no run, or a run would need more steps than can be waited for.
    """
    forward = cage.rotation_sense > 0
    cage = turned_forward(cage)
    speeds, runs = chosen(settings_for(settings, cage), kicks, runs)
    check_length(settings.duration, fastest_rate(cage))
    starts = random_starts(cage, settings, first_run, runs)
    evidence = np.zeros((len(speeds), runs), dtype_of(Evidence))
    hits = np.zeros((len(speeds), runs, cage.ball_count), dtype=np.int64)

    def work(i: int, rows: slice) -> None:
        run_rows(cage, settings.duration, speeds[i], starts[rows], evidence[i, rows], hits[i, rows])

    size = max(1, int(CHUNK_RADIANS / (settings.duration * fastest_rate(cage))))
    spread(work, len(speeds), runs, size, jobs)
    return gathered(speeds, evidence, hits if forward else other_way_round(hits), settings.duration)


def run_rows(
    cage: PlanarCage,
    duration: Second,
    kick: MetrePerSecond,
    starts: Array,
    evidence: NDArray[np.void],
    hits: NDArray[np.int64],
    *,
    samples: Samples | None = None,
) -> None:
    """Run from one kick and every row of `starts`, into rows of `evidence` and `hits`.

    With samples of a history a run goes on to the last of them, even where its end is plain before.
    """
    balls, limits = cage.ball_count, run_limits(cage, kick, duration, least=samples is not None)
    numbers = coefficients(cage, kick)
    follow = run_plain_chunk if PLAIN in (cast("np.void", numbers).dtype.names or ()) else run_chunk
    follow(
        numbers,
        balls_of(cage),
        starts,
        kick * time_unit(cage),
        books_for(balls, cage.land_lobes, len(starts), limits.most),
        limits,
        samples or samples_for(0, balls),
        cast("Sequence[Evidence]", evidence),
        hits,
    )
    for name in PER_MASS:
        evidence[name] *= cage.mass


def check_length(duration: Second, fastest: RadianPerSecond) -> None:
    """Refuse a run of a cage with this fastest motion that would take longer than anyone waits.

    Raises
    ------
    InputError
        It would need too many steps.
    """
    longest = MOST_RADIANS / fastest
    if not duration <= longest:
        cure = "Shorten the run, or check the cage's stiffnesses, damping, mass and moments of inertia."
        rule = f"must be at most {format_quantity(longest, 's', 3)} for this cage"
        raise InputError("[stability] duration", rule, format_quantity(duration, "s"), cure)


def random_starts(cage: PlanarCage, settings: StabilitySettings, first_run: int, runs: int) -> Array:
    """Start of every run, shape (run, 1 + 3 ball).

    Direction of the kick [rad]; then by pocket the lead of its ball [m], half its clearance [m] and its angle
    [rad]. A lead is random within the clearance, times `ball_scatter`, about the ball's free place among
    those that a radial load speeds up and slows down; no ball starts beyond its clearance. A pocket out of
    its place is a lead of its ball.
    """
    angles, half = np.array(cage.ball_angles), cage.half_play
    free = free_leads(cage, angles)
    starts = np.empty((runs, 1 + 3 * cage.ball_count))
    for i in range(runs):
        drawn = random_start(settings.seed, first_run + i, cage.ball_count)
        play = half - 0.5 * cage.ball_diameter_scatter * drawn[2]
        lead = settings.ball_scatter * play * drawn[1] + free - cage.pocket_position_scatter * drawn[3]
        pitch = 2.0 * math.pi / cage.ball_count
        starts[i, 0] = drawn[0, 0]
        by_pocket = starts[i, 1:].reshape(3, -1)
        by_pocket[0] = np.clip(lead, -play, play)
        by_pocket[1] = play
        by_pocket[2] = angles + cage.pocket_spacing_scatter * pitch * drawn[4]
    return starts


def free_leads(cage: PlanarCage, angles: Array) -> Array:
    """Lead of each ball in its free orbit at the start, which a radial load makes uneven [m]."""
    lead = np.zeros(angles.size)
    for h, (a, b) in enumerate(zip(cage.orbital_cosines, cage.orbital_sines, strict=True), start=1):
        lead += (a * np.sin(h * angles) - b * np.cos(h * angles)) / (h * cage.cage_speed)
    return lead


def pocket_speed(cage_speed: RadianPerSecond, pocket_clearance: Metre) -> MetrePerSecond:
    """Cage speed times half the pocket clearance, but not below `LEAST_POCKET_SPEED`.

    The cage centre has this speed in space where it is half a pocket clearance off the axis.
    """
    return max(abs(cage_speed) * 0.5 * pocket_clearance, LEAST_POCKET_SPEED)


def settings_for(settings: StabilitySettings, cage: PlanarCage) -> StabilitySettings:
    """Return the settings with the kicks and the reference kick of this cage; given ones stay."""
    return with_kicks(settings, pocket_speed(cage.cage_speed, cage.pocket_clearance))


def with_kicks(settings: StabilitySettings, speed: MetrePerSecond) -> StabilitySettings:
    """Return the settings with numbers for kicks and reference kick, from the pocket speed [m/s].

    The reference kick is 2.5 times the pocket speed unless it is given, for any kicks: thresholds and
    margins belong to the bearing, not to the list. Without kicks they are 0.2, 1 and 4 times it.
    """
    reference = settings.reference_kick or _rounded(REFERENCE * speed)
    spanned = tuple(reference if part == 1.0 else _rounded(part * reference) for part in SPAN)
    return replace(settings, kicks=settings.kicks or spanned, reference_kick=reference)


def _rounded(speed: MetrePerSecond) -> MetrePerSecond:
    return float(f"{speed:.{DIGITS}g}")


def chosen(
    settings: StabilitySettings, kicks: Sequence[MetrePerSecond] | None, runs: int | None
) -> tuple[Array, int]:
    """Kicks, shape (kick,), and runs: those given, else those of the settings; refuse an empty ensemble."""
    speeds = np.array(settings.kicks if kicks is None else kicks, dtype=np.float64)
    count = settings.runs if runs is None else runs
    if speeds.size == 0 or not np.all(np.isfinite(speeds) & (speeds > LEAST_KICK)):
        rule = f"must be one or more speeds > {LEAST_KICK:g} [m/s]"
        raise InputError("[stability] kicks", rule, str(speeds.tolist()), NO_KICK)
    if count < 1:
        raise InputError("[stability] runs", "must be at least 1 [-]", str(count))
    return speeds, count


def other_way_round(by_ball: NDArray[Scalar]) -> NDArray[Scalar]:
    """Columns of balls counted the other way round, shape (..., ball); ball 0 stays."""
    return np.roll(by_ball[..., ::-1], 1, axis=-1)


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


def gathered(kicks: Array, evidence: NDArray[np.void], hits: NDArray[np.int64], duration: Second) -> Ensemble:
    """Record of the evidence of all runs, shape (kick, run)."""
    names = [field.name for field in fields(Ensemble) if field.name in Evidence.__annotations__]
    return Ensemble(
        kicks=kicks,
        pocket_impacts=hits,
        duration=duration,
        **{name: np.ascontiguousarray(evidence[name]) for name in names},
    )
