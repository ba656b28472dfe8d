"""What a run begins with: size and direction of its initial disturbance, leads of the balls, imperfections.

Each is drawn by seed and number of the run alone: the same for any cage, disturbance and number of workers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage import rows
from separatrix.cage.numbers import ball_level, pocket_rectangle
from separatrix.cage.rows import of
from separatrix.chain.pocket_friction import REFERENCE, pocket_speed
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, MetrePerSecond, Ratio
from separatrix.study.study import LEAST_KICK, NO_KICK, StabilitySettings

if TYPE_CHECKING:
    from separatrix.cage.moving_cage import MovingCage

SPAN: tuple[Ratio, ...] = (0.2, 1.0, 4.0)
"""Disturbances over the reference: 0.5, 2.5 and 10 times the pocket speed [-]."""

DIGITS = 3
"""Significant digits of a default disturbance, so that a reader can repeat it."""


class Starts(NamedTuple):
    """Where runs begin.

    Per run directions of the disturbance and of its tilt [rad] and sense of its axial part; then per ball,
    shape (run, ball), its lead, what half its clearance has more than the nominal [m], and its angle [rad].
    """

    direction: Array
    tilt_direction: Array
    axial_sense: Array
    lead: Array
    more: Array
    angle: Array


def settings_for(settings: StabilitySettings, cage: MovingCage) -> StabilitySettings:
    """Return the settings with the disturbances and the reference of this cage; given ones stay."""
    return with_kicks(settings, pocket_speed(cage.cage_speed, cage.pocket_clearance))


def with_kicks(settings: StabilitySettings, speed: MetrePerSecond) -> StabilitySettings:
    """Return the settings with numbers for disturbances and reference, from the pocket speed [m/s].

    The reference is 2.5 times the pocket speed unless it is given, for any list: thresholds and
    margins belong to the bearing, not to the list. Without a list it is 0.2, 1 and 4 times the reference.
    """
    reference = settings.reference_kick or _rounded(REFERENCE * speed)
    spanned = tuple(reference if part == 1.0 else _rounded(part * reference) for part in SPAN)
    return replace(settings, kicks=settings.kicks or spanned, reference_kick=reference)


def _rounded(speed: MetrePerSecond) -> MetrePerSecond:
    return float(f"{speed:.{DIGITS}g}")


def chosen(
    settings: StabilitySettings, kicks: Sequence[MetrePerSecond] | None, runs: int | None
) -> tuple[Array, int]:
    """Disturbances, shape (kick,), and runs: those given, else the settings'; refuse an empty ensemble."""
    speeds = np.array(settings.kicks if kicks is None else kicks, dtype=np.float64)
    count = settings.runs if runs is None else runs
    if speeds.size == 0 or not np.all(np.isfinite(speeds) & (speeds > LEAST_KICK)):
        rule = f"must be one or more speeds > {LEAST_KICK:g} [m/s]"
        raise InputError("[stability] kicks", rule, str(speeds.tolist()), NO_KICK)
    if count < 1:
        raise InputError("[stability] runs", "must be at least 1 [-]", str(count))
    return speeds, count


def random_starts(cage: MovingCage, settings: StabilitySettings, first_run: int, runs: int) -> Starts:
    """Starts of runs, by their numbers.

    A lead is random within the clearance, times `ball_scatter`, about the ball's free place among those that
    a radial load speeds up and slows down; no ball starts beyond its clearance. With `balls_at_walls` it is
    where the orbit that its diameter makes has brought it. A pocket out of its place is a lead of its ball.
    """
    angles, half, pitch = np.array(cage.ball_angles), cage.half_play, 2.0 * math.pi / cage.ball_count
    drawn = np.stack([random_start(settings.seed, first_run + i, cage.ball_count) for i in range(runs)])
    ways = np.array([tilt_start(settings.seed, first_run + i) for i in range(runs)])
    more = -0.5 * cage.ball_diameter_scatter * drawn[:, 2]
    lead = settings.ball_scatter * (half + more) * drawn[:, 1] + cage.free_leads(angles)
    if cage.balls_at_walls:
        lead = np.copysign(half + more, -more * cage.orbit_by_diameter)
    lead = np.clip(lead - cage.pocket_position_scatter * drawn[:, 3], -half - more, half + more)
    return Starts(
        direction=drawn[:, 0, 0],
        tilt_direction=ways[:, 0],
        axial_sense=ways[:, 1],
        lead=lead,
        more=more,
        angle=angles + cage.pocket_spacing_scatter * pitch * drawn[:, 4],
    )


@lru_cache(maxsize=512)
def random_start(seed: int, run: int, ball_count: int) -> Array:
    """Numbers drawn for a run, shape (5, ball).

    First the direction of the disturbance [rad] (repeated) and the lead of each ball (share of the scatter,
    -1 to 1), then normal deviations of ball diameters and of pocket positions, cut at 3, then displacements
    of pockets with their balls (-1 to 1). They are kept, read-only.
    """
    stream = Generator(Philox(key=np.array([seed, run], dtype=np.uint64)))
    numbers = stream.random(1 + ball_count)
    drawn = np.empty((5, ball_count))
    drawn[0] = 2.0 * math.pi * numbers[0]
    drawn[1] = 2.0 * numbers[1:] - 1.0
    for row in (2, 3):
        drawn[row] = _cut_normal(stream, ball_count)
    drawn[4] = 2.0 * stream.random(ball_count) - 1.0
    drawn.flags.writeable = False
    return drawn


@lru_cache(maxsize=512)
def tilt_start(seed: int, run: int) -> tuple[float, float]:
    """Direction of the tilt's disturbance [rad] and sense of the axial one, from a stream of its own."""
    stream = Generator(Philox(key=np.array([seed, run], dtype=np.uint64)).jumped())
    return 2.0 * math.pi * stream.random(), math.copysign(1.0, stream.random() - 0.5)


def _cut_normal(stream: Generator, count: int) -> Array:
    """Normal deviations, those beyond 3 drawn again."""
    drawn = stream.standard_normal(count)
    while (far := np.abs(drawn) > 3.0).any():
        drawn[far] = stream.standard_normal(int(far.sum()))
    return drawn


def start_states(cage: MovingCage, kick: MetrePerSecond, starts: Starts) -> Array:
    """State of every run at its start, shape (run, state): see `rows`."""
    in_space = cage.is_in_space
    one, first = rows.ball_states(ball_level(cage), space=in_space), rows.cage_states(space=in_space)
    state = np.zeros((starts.direction.size, first + one * cage.ball_count))
    state[:, of(rows.X)] = cage.unbalance / (cage.mass + cage.added_mass)
    state[:, of(rows.VX)] = kick * np.cos(starts.direction)
    state[:, of(rows.VY)] = kick * np.sin(starts.direction)
    if in_space:
        rim = 0.0 if cage.is_tilt_held else cage.tilt_kick * kick / cage.pitch_radius
        along = 0.0 if cage.is_axially_held else cage.axial_kick * kick
        state[:, of(rows.Z)], state[:, of(rows.TY)] = cage.pocket_axial_offset, cage.dynamic_unbalance
        state[:, of(rows.VZ)] = along * starts.axial_sense
        state[:, of(rows.WX)] = rim * np.cos(starts.tilt_direction)
        state[:, of(rows.WY)] = rim * np.sin(starts.tilt_direction)
    state[:, first::one] = starts.lead
    return state


def ball_places(cage: MovingCage, starts: Starts) -> Array:
    """Numbers of every ball with its pocket, shape (run, ball, number): angle and clearance."""
    apart, _, around = pocket_rectangle(cage)
    places = np.zeros((*starts.lead.shape, of(rows.BALL_ROWS)))
    places[..., of(rows.COSINE)], places[..., of(rows.SINE)] = np.cos(starts.angle), np.sin(starts.angle)
    is_round = around > 0.0
    places[..., of(rows.AROUND)] = around + (starts.more if is_round else 0.0)
    places[..., of(rows.APART)] = apart + (0.0 if is_round else starts.more)
    speed = -2.0 * starts.more * cage.orbit_by_diameter  # half the clearance lacks half the diameter
    places[..., [of(row) for row in (rows.CAPACITY_SHARE, rows.SLOPE_SHARE, rows.KNEE_SHARE)]] = 1.0
    places[..., of(rows.BY_SIZE)] = places[..., of(rows.OWN_SPEED)] = speed
    return places
