"""One run from a kick to its outcome and its evidence, and a chunk of such runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from numpy.random import Generator, Philox

from separatrix.cage.ending import (
    BY_NOTHING,
    FEWEST_LOOKS,
    SETTLES,
    UNKNOWN,
    UNRESOLVED,
    Limits,
    Look,
    Memory,
    after_look,
    book,
    mean_energy,
    with_cause,
)
from separatrix.cage.evidence import pocket_energy
from separatrix.cage.features import is_gripped
from separatrix.cage.motion import advance, kinetic, land_energy
from separatrix.cage.planar import Cause, RunOutcome
from separatrix.cage.records import (
    CLEAR,
    Balls,
    Coefficients,
    Evidence,
    Ledger,
    Room,
    Samples,
    Series,
    State,
    Whole,
    records,
    room_for,
    series,
)
from separatrix.cage.traction import ball_energy
from separatrix.cage.work import total_work
from separatrix.compiled import kernel, part, unfolded
from separatrix.units import Array

DRIFTS = int(RunOutcome.DRIFTS)
IMPACTS, NOT_FINITE = int(Cause.IMPACTS), int(Cause.NOT_FINITE)
NOTHING_LEFT = 2.0**-104
"""Share of the kick's energy below which speeds are rounding: growth rates count no further."""


class Scales(Protocol):
    """What the kernels' numbers are in SI units, of a cage in the plane or in space."""

    @property
    def unit(self) -> float:
        """Unit of time [s]."""

    @property
    def turning(self) -> float:
        """Angle by which the frame turns in it."""


class Books(NamedTuple):
    """What a chunk of runs keeps while it runs: a row a run, but for the looks and the room of a step."""

    state: Sequence[State]
    ledger: Sequence[Ledger]
    memory: Sequence[Memory]
    looks: Sequence[Look]  # as many as a run may have, and one more that stays zero
    series: Series
    room: Room


def books_for(balls: int, lobes: int, runs: int, most: int) -> Books:
    """Books of a number of runs with at most `most` looks each."""
    return Books(
        state=records(State, runs),
        ledger=records(Ledger, runs),
        memory=records(Memory, runs),
        looks=records(Look, most + 1),
        series=series(),
        room=room_for(balls, lobes),
    )


@part
def held_energy(p: Coefficients, balls: Balls, state: State) -> float:
    """Energy in the pockets' springs and in the speeds of the balls, over the mass."""
    held = ball_energy(p, balls, state)
    for i in range(state.touching):
        held += pocket_energy(p, balls.penetration[balls.touching[i]])
    return held


@unfolded
def watch(
    p: Coefficients,
    balls: Balls,
    state: State,
    ledger: Ledger,
    memory: Memory,
    looks: Sequence[Look],
    w: Series,
    hits: Whole,
    limits: Limits,
    samples: Samples,
    room: Room,
) -> tuple[int, int, int]:
    """Run, look by look, until the end of the motion is plain.

    Returns
    -------
    tuple
        Outcome, the looks up to which it was judged, and the cause.
    """
    outcome, judged, touches, touched = UNKNOWN, 0, 0, state.touching > 0
    for i in range(limits.most):
        looks[i] = looks[limits.most]  # type: ignore[index]
        look = looks[i]
        book(looks, i, ledger, -1.0, limits)
        going, beat = True, 0
        while going and beat < limits.beats and kinetic(p, state) < limits.grown:
            going = advance(p, balls, state, w, ledger, look, hits, limits.beat, limits.grown, samples, room)
            beat += 1
        book(looks, i, ledger, 1.0, limits)
        energy = kinetic(p, state)
        held = held_energy(p, balls, state)
        if not (going and np.isfinite(energy + look.kinetic)):
            cause = NOT_FINITE if going else IMPACTS
            return (UNRESOLVED, i + 1, cause) if outcome == UNKNOWN else (outcome, judged, BY_NOTHING)
        hit = int(np.sum(hits))
        met = bool(state.touching > 0 or hit > touches)
        touches = hit
        touched = touched or met or look.land_hits > 0.0
        if outcome == UNKNOWN:
            judged = i + 1
            outcome = after_look(
                looks, i, energy + held, met, touched, state.clock >= p.ramp_time, limits, memory
            )
        if outcome != UNKNOWN and (i + 1 >= limits.least or energy + held > limits.grown):
            break
    return with_cause(looks, outcome, judged, touched, limits)


@part
def offset_of(looks: Sequence[Look], first: int, last: int, limits: Limits) -> float:
    """Offset in some looks, times their time: see `drift_rate`."""
    x = y = offset = 0.0
    for i in range(first, last):
        x += looks[i].mean_x
        y += looks[i].mean_y
        offset += looks[i].offset
    return float(np.hypot(x, y)) if limits.drifts else offset


@part
def drift_rate(looks: Sequence[Look], end: int, limits: Limits) -> float:
    """Logarithmic growth of the mean offset between the last two fifths; 0 where there is no offset.

    Between the halves of the window by which a short run was judged: before it the kick still had its effect.
    A cage that is free to drift creeps under a fast whirl, which the distance of its mean place leaves out.
    Any other goes round on its land or swings about its place, so that its mean distance tells; of a run that
    is all window, the last half only, for the first has the kick.
    """
    half = min(end, limits.window) // 2
    n = max(end // FEWEST_LOOKS, half if limits.drifts else min(half, max(1, end // 4)))
    if n == 0:
        return 0.0
    last, before = offset_of(looks, end - n, end, limits), offset_of(looks, end - 2 * n, end - n, limits)
    return float(np.log(last / before) / n) if last > 0.0 and before > 0.0 else 0.0


@part
def growth(looks: Sequence[Look], end: int, length: float, start: float) -> float:
    """Half the logarithmic rate of the mean energy from half way to the last fifth.

    From the kick's energy, `start`, in a run that ends within five looks.
    """
    n = max(1, end // FEWEST_LOOKS)
    last = mean_energy(looks, end - n, end, length)
    if end < FEWEST_LOOKS:
        before, span = start, end - 0.5 * n
    else:
        first = end // 2 - n // 2
        before, span = mean_energy(looks, first, first + n, length), float(end - n - first)
    least = NOTHING_LEFT * start
    return float(0.5 * np.log(max(last, least) / max(before, least)) / (span * length))


@part
def imbalance(
    p: Coefficients, balls: Balls, state: State, w: Series, ledger: Ledger, start: float, room: Room
) -> float:
    """Energy that the ledger does not explain, over the work done and the kick's energy [-]."""
    held = held_energy(p, balls, state)
    if state.land != CLEAR:
        held += land_energy(p, balls, state, w, room)
    unexplained = kinetic(p, state) + held - start - total_work(ledger)
    return abs(unexplained) / (ledger.gross + start)


@unfolded
def run_one(
    p: Coefficients,
    balls: Balls,
    direction: float,
    kick: float,
    books: Books,
    run: int,
    limits: Limits,
    samples: Samples,
    out: Evidence,
    hits: Whole,
) -> None:
    """Run from one kick; write outcome and evidence into `out` and the impacts of every pocket into `hits`.

    `kick` is in units of the engine; the state and the ledger of this run in the `books` are zero.
    """
    state, ledger, looks, w = books.state[run], books.ledger[run], books.looks, books.series
    balls.side[:], balls.touching[:], balls.own_speed[:] = 0, 0, 0.0
    if is_gripped(p):
        balls.side[:] = 2
        balls.penetration[:] = -balls.lead
        balls.touching[:] = np.arange(balls.play.size)
        state.touching = balls.play.size
    state.x, state.vx, state.vy = p.eccentricity, kick * np.cos(direction), kick * np.sin(direction)
    start = kinetic(p, state)
    outcome, end, cause = watch(
        p, balls, state, ledger, books.memory[run], looks, w, hits, limits, samples, books.room
    )
    out.outcome, out.cause = DRIFTS if limits.drifts and outcome == SETTLES else outcome, cause
    out.energy_imbalance = imbalance(p, balls, state, w, ledger, start, books.room)
    out.rows = state.rows
    if cause == NOT_FINITE:
        return
    enter_looks(p, looks, end, start, limits, out)


@part
def enter_looks(
    p: Scales, looks: Sequence[Look], end: int, start: float, limits: Limits, out: Evidence
) -> None:
    """Write what the looks up to `end` tell of a run that began with this energy."""
    length = limits.beats * limits.beat
    farthest, force, land_force, land_hits = 0.0, 0.0, 0.0, 0.0
    for i in range(end):
        farthest, force = max(farthest, looks[i].offset_max), max(force, looks[i].force_max)
        land_force = max(land_force, looks[i].land_max)
        land_hits += looks[i].land_hits
    out.largest_offset, out.land_impacts = np.sqrt(farthest), int(land_hits)
    out.followed = end * length * p.unit
    out.growth_rate = growth(looks, end, length, start) / p.unit
    out.drift_rate = drift_rate(looks, end, limits) / (length * p.unit)
    unit_force = 1.0 / p.unit**2
    out.largest_contact_force, out.largest_land_force = force * unit_force, land_force * unit_force
    enter_end(p, looks, end, length, limits, out)


@part
def last_part(end: int, limits: Limits) -> int:
    """Number of looks by whose motion a run is described: the last fifth, or the last window."""
    return max(1, end // FEWEST_LOOKS, min(end, limits.window))


@part
def enter_end(
    p: Scales, looks: Sequence[Look], end: int, length: float, limits: Limits, out: Evidence
) -> None:
    """Write what the motion is in the last part of the looks."""
    n = last_part(end, limits)
    first, time = end - n, n * length
    kinetic_, turning, squared, offset, offset_squared, swept = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    pocket, land, pressed, rubbed = 0.0, 0.0, 0.0, 0.0
    for i in range(first, end):
        look = looks[i]
        kinetic_ += look.kinetic
        turning += look.turning
        squared += look.speed_squared
        offset += look.offset
        offset_squared += look.offset_squared
        swept += look.swept
        pocket += look.pocket_work
        land += look.land_work
        pressed += look.pressed
        rubbed += look.rubbed
    out.judged_from = first * length * p.unit
    out.end_energy = kinetic_ / time / p.unit**2
    whirl = turning / squared / p.unit if squared > 0.0 else 0.0
    out.whirl_frequency = abs(whirl) / (2.0 * np.pi)
    out.whirl_direction = int(np.sign(whirl))
    out.mean_offset = offset / time
    out.offset_spread = np.sqrt(max(0.0, offset_squared / time - out.mean_offset**2))
    orbit = swept / offset_squared if offset_squared > 0.0 else 0.0
    out.orbit_speed = (orbit + p.turning) / p.unit
    out.pocket_power, out.land_power = pocket / time / p.unit**3, land / time / p.unit**3
    out.rubbing_force = pressed / time / p.unit**2
    out.rubbing_speed = rubbed / pressed / p.unit if pressed > 0.0 else 0.0


@unfolded
def follow_all(
    p: Coefficients,
    balls: Balls,
    starts: Array,
    kick: float,
    books: Books,
    limits: Limits,
    samples: Samples,
    out: Sequence[Evidence],
    hits: Whole,
) -> None:
    """Run from every row of `starts`; evidence into `out`, impacts into `hits`.

    A row of `starts`, of length 1 + 3 ball: direction of the kick [rad], then for each pocket its ball's lead
    [m], half its clearance [m] and its angle [rad].
    """
    count = hits.shape[1]
    for i in range(starts.shape[0]):
        start = starts[i]
        angle = start[1 + 2 * count :]
        balls.cosine[:], balls.sine[:], balls.penetration[:] = np.cos(angle), np.sin(angle), 0.0
        balls.lead[:], balls.play[:] = start[1 : 1 + count], start[1 + count : 1 + 2 * count]
        run_one(p, balls, start[0], kick, books, i, limits, samples, out[i], hits[i])


@kernel
def run_chunk(
    p: Coefficients,
    balls: Balls,
    starts: Array,
    kick: float,
    books: Books,
    limits: Limits,
    samples: Samples,
    out: Sequence[Evidence],
    hits: Whole,
) -> None:
    """Run any cage, see `follow_all`."""
    follow_all(p, balls, starts, kick, books, limits, samples, out, hits)


@kernel
def run_plain_chunk(
    p: Coefficients,
    balls: Balls,
    starts: Array,
    kick: float,
    books: Books,
    limits: Limits,
    samples: Samples,
    out: Sequence[Evidence],
    hits: Whole,
) -> None:
    """Run a plain cage, see `features` and `follow_all`: a kernel that is cached has one signature only."""
    follow_all(p, balls, starts, kick, books, limits, samples, out, hits)


@lru_cache(maxsize=512)
def random_start(seed: int, run: int, ball_count: int) -> Array:
    """Numbers drawn for a run, shape (4, ball).

    First the direction of the kick [rad] (repeated) and the lead of each ball (share of the scatter, -1 to
    1), then normal deviations of ball diameters and of pocket positions, cut at 3, then displacements of
    pockets with their balls (-1 to 1). They depend on the seed and the number of the run only: the same for
    any cage, kick and number of workers, so they are kept, read-only.
    """
    stream = Generator(Philox(key=np.array([seed, run], dtype=np.uint64)))
    numbers = stream.random(1 + ball_count)
    rows = np.empty((5, ball_count))
    rows[0] = 2.0 * math.pi * numbers[0]
    rows[1] = 2.0 * numbers[1:] - 1.0
    for row in (2, 3):
        rows[row] = _cut_normal(stream, ball_count)
    rows[4] = 2.0 * stream.random(ball_count) - 1.0
    rows.flags.writeable = False
    return rows


def _cut_normal(stream: Generator, count: int) -> Array:
    """Normal deviations, those beyond 3 drawn again."""
    drawn = stream.standard_normal(count)
    while (far := np.abs(drawn) > 3.0).any():
        drawn[far] = stream.standard_normal(int(far.sum()))
    return drawn
