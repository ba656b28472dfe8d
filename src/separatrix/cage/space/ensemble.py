"""An ensemble of runs in space: kicks and seeds, over threads, the same numbers for any number of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.closed_forms import moving_mass, time_unit
from separatrix.cage.ending import run_limits
from separatrix.cage.ensemble import (
    CHUNK_RADIANS,
    PER_MASS,
    Ensemble,
    check_length,
    chosen,
    free_leads,
    other_way_round,
    settings_for,
    spread,
)
from separatrix.cage.planar import turned_forward
from separatrix.cage.records import dtype_of
from separatrix.cage.run import random_start
from separatrix.cage.space.inputs import fastest_in_space, numbers, parts_of
from separatrix.cage.space.records import (
    SpaceEvidence,
    body_of,
    books_for,
)
from separatrix.cage.space.run import AXIAL_WAY, DIRECTION, FIRST_LEAD, TILT_WAY, run_chunk
from separatrix.units import Array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage
    from separatrix.study import StabilitySettings
    from separatrix.units import MetrePerSecond


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceEnsemble(Ensemble):
    """Outcome and evidence of every run in space; arrays have shape (kick, run) unless stated.

    Attributes
    ----------
    largest_tilt, mean_tilt : ndarray
        Of the cage's axis: the largest, and the mean over the last part [rad].
    cone_speed, cone_phase : ndarray
        Mean angular speed of the lean of the axis about the bearing's axis in the fixed frame [rad/s]; angle
        from the offset of the centre to the lean, the same if 0 [rad].
    axial_low, axial_high, axial_place, axial_spread : ndarray
        Extremes of the axial place, its mean and standard deviation over the last part [m].
    strike_rate : ndarray
        Impacts of all pockets in the last part [1/s].
    pocket_rubbing : ndarray
        Integral of force times sliding speed in each pocket, shape (kick, run, ball) [J].
    """

    largest_tilt: Array
    mean_tilt: Array
    cone_speed: Array
    cone_phase: Array
    axial_low: Array
    axial_high: Array
    axial_place: Array
    axial_spread: Array
    strike_rate: Array
    pocket_rubbing: Array


def run_in_space(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    jobs: int = 1,
) -> SpaceEnsemble:
    """Run the cage in space from every kick and seed; one that turns backward as its mirror image.

    Parameters
    ----------
    cage : PlanarCage
        The cage.
    settings, kicks, runs, first_run, jobs
        As in `cage.run_ensemble`; in the plane the starts are the same.

    Raises
    ------
    InputError
        No kick or no run, or a run would need more steps than can be waited for.
    """
    forward = cage.rotation_sense > 0
    cage = turned_forward_in_space(cage)
    speeds, runs = chosen(settings_for(settings, cage), kicks, runs)
    check_length(settings.duration, fastest_in_space(cage))
    starts = random_starts(cage, settings, first_run, runs)
    evidence = np.zeros((len(speeds), runs), dtype_of(SpaceEvidence))
    hits = np.zeros((len(speeds), runs, cage.ball_count), dtype=np.int64)
    heat = np.zeros(hits.shape)

    def work(i: int, rows: slice) -> None:
        here = (i, rows)
        run_rows(cage, settings, speeds[i], starts[rows], evidence[here], hits[here], heat[here])

    size = max(1, int(CHUNK_RADIANS / 4.0 / (settings.duration * fastest_in_space(cage))))
    spread(work, len(speeds), runs, size, jobs)
    if not forward:
        hits, heat = other_way_round(hits), other_way_round(heat)
    names = [field.name for field in fields(SpaceEnsemble) if field.name in (evidence.dtype.names or ())]
    return SpaceEnsemble(
        kicks=speeds,
        pocket_impacts=hits,
        pocket_rubbing=heat,
        duration=settings.duration,
        **{name: np.ascontiguousarray(evidence[name]) for name in names},
    )


def run_rows(
    cage: PlanarCage,
    settings: StabilitySettings,
    kick: MetrePerSecond,
    starts: Array,
    evidence: NDArray[np.void],
    hits: NDArray[np.int64],
    heat: Array,
) -> None:
    """Run from one kick and every row of `starts`, into rows of `evidence`, `hits` and `heat`."""
    limits = run_limits(cage, kick, settings.duration)
    run_chunk(
        numbers(cage, kick),
        parts_of(cage),
        starts,
        kick_speeds(cage, kick),
        cage.pocket_axial_offset,
        books_for(limits.most),
        limits,
        cast("Sequence[SpaceEvidence]", evidence),
        hits,
        heat,
    )
    mass = moving_mass(cage)
    for name in PER_MASS:
        evidence[name] *= mass
    heat *= mass / time_unit(cage) ** 2


def kick_speeds(cage: PlanarCage, kick: MetrePerSecond) -> Array:
    """Speeds of the kick across the axis, along it and of the rim's tilt, in metres by the unit of time."""
    body = body_of(cage)
    return np.array([1.0, body.axial_kick, body.tilt_kick]) * kick * time_unit(cage)


def turned_forward_in_space(cage: PlanarCage) -> PlanarCage:
    """Return the cage, or its mirror image where its ball set turns backward, as `cage.planar`."""
    if cage.rotation_sense > 0:
        return cage
    body = body_of(cage)
    axial, outward, along = body.ball_spin
    mirrored = replace(body, ball_spin=(0.0 - axial, 0.0 - outward, along))
    return replace(turned_forward(cage), space=mirrored)


def random_starts(cage: PlanarCage, settings: StabilitySettings, first_run: int, runs: int) -> Array:
    """Start of every run, shape (run, 3 + 3 ball).

    Directions of the kick and of the tilt's [rad] and sense of the axial one; then by pocket the lead of its
    ball [m], what half its clearance has more than the nominal [m], and its angle [rad]. In the plane they
    are those of `cage.ensemble.random_starts`.
    """
    angles, half, pitch = np.array(cage.ball_angles), cage.half_play, 2.0 * math.pi / cage.ball_count
    free = free_leads(cage, angles)
    starts = np.empty((runs, FIRST_LEAD + 3 * cage.ball_count))
    for i in range(runs):
        drawn = random_start(settings.seed, first_run + i, cage.ball_count)
        more = -0.5 * cage.ball_diameter_scatter * drawn[2]
        lead = (
            settings.ball_scatter * (half + more) * drawn[1] + free - cage.pocket_position_scatter * drawn[3]
        )
        starts[i, DIRECTION] = drawn[0, 0]
        starts[i, TILT_WAY], starts[i, AXIAL_WAY] = tilt_start(settings.seed, first_run + i)
        by_pocket = starts[i, FIRST_LEAD:].reshape(3, -1)
        by_pocket[0] = np.clip(lead, -half - more, half + more)
        by_pocket[1] = more
        by_pocket[2] = angles + cage.pocket_spacing_scatter * pitch * drawn[4]
    return starts


@lru_cache(maxsize=512)
def tilt_start(seed: int, run: int) -> tuple[float, float]:
    """Direction of the tilt's kick [rad] and sense of the axial one, from a stream of the run's own."""
    stream = Generator(Philox(key=np.array([seed, run], dtype=np.uint64)).jumped())
    return 2.0 * math.pi * stream.random(), math.copysign(1.0, stream.random() - 0.5)
