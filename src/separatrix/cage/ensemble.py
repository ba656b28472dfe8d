"""An ensemble of runs: from starts, side by side, to one record of evidence."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.cage import outcome, rows, run
from separatrix.cage.closed_forms import moving_mass
from separatrix.cage.disturbance import ball_places, chosen, random_starts, settings_for, start_states
from separatrix.cage.moving_cage import turned_forward
from separatrix.cage.numbers import Kind, Numbers, look_time, numbers_of
from separatrix.cage.outcome import RunOutcome
from separatrix.cage.rows import of
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Second, format_quantity

if TYPE_CHECKING:
    from separatrix.cage.moving_cage import MovingCage
    from separatrix.ground.units import MetrePerSecond
    from separatrix.study.study import StabilitySettings

MOST_LOOKS = 100_000
"""Longest run, in looks: beyond it nobody waits."""

FIFTH, LAST = 5, 10
"""A run is described by its last fifth, or its last ten looks if they are more."""


Whole = NDArray[np.int64]
Mean = Callable[[Array, Array], Array]  # means of all columns over looks, by row


class Stop:
    """A flag that ends runs under way at their next look."""

    def __init__(self) -> None:
        self.flag = np.zeros(1, np.int64)

    def set(self) -> None:
        """End all runs that look at it."""
        self.flag[0] = 1

    @property
    def is_set(self) -> bool:
        """Whether runs are to end."""
        return bool(self.flag[0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Ensemble:
    """Outcome and evidence of every run; arrays have shape (kick, run) unless stated.

    "At the end": over the last part of the run, its last fifth or its last ten looks if they are more.
    """

    kicks: Array  # speeds of the initial disturbances, shape (kick,) [m/s]
    outcome: Whole  # `RunOutcome`
    cause: Whole  # `Cause` of a run that is unresolved, or that friction on the land whirls; else 0
    end_energy: Array  # mean kinetic energy at the end [J]
    growth_rate: Array
    """Half the logarithmic rate of the mean kinetic energy from half way to the last fifth; from the start in
    a run that ends within five looks [1/s]."""
    largest_offset: Array  # of the cage centre [m]
    mean_offset: Array  # at the end [m]
    offset_spread: Array  # its standard deviation [m]
    orbit_speed: Array
    """Mean angular speed of the centre about the bearing's axis in the fixed frame, weighted with the squared
    offset, at the end; positive as the ball set turns [rad/s]."""
    drift_rate: Array  # of the mean offset over the last two fifths; adrift of the mean place [1/s]
    whirl_frequency: Array  # mean turning rate of the velocity in the turning frame at the end [Hz]
    whirl_direction: Whole  # 1 forward (as the ball set turns), -1 backward, 0 none
    largest_contact_force: Array  # between ball and pocket [N]
    largest_land_force: Array  # of cage and land [N]
    pocket_impacts: Whole  # how often each pocket met its ball, shape (kick, run, ball)
    pocket_rubbing: Array  # integral of force times sliding speed, shape (kick, run, ball) [J]
    pocket_sliding: Array  # mean of force times sliding speed in all pockets at the end [W]
    land_impacts: Whole  # how often the cage met its land
    strike_rate: Array  # impacts of all pockets at the end [1/s]
    energy_imbalance: Array  # what the works leave open, over the work done and the energy at the start [-]
    pocket_power: Array  # that pocket friction feeds into the cage at the end [W]
    land_power: Array  # the same of the land [W]
    rubbing_force: Array  # mean normal force on the land at the end [N]
    rubbing_speed: Array  # sliding speed there, weighted with the force [m/s]
    left_ball: Whole  # the first ball, from 1, at which the wall of a pocket ended; 0: none
    left_time: Array  # when [s]
    followed: Array  # time up to which the run was judged [s]
    judged_from: Array  # time at which its last part begins [s]
    largest_tilt: Array | None = None  # of its axis [rad]; from here on in space only
    cone_speed: Array | None = None  # of the lean of the axis in the fixed frame, at the end [rad/s]
    axial_low: Array | None = None  # extremes of the axial place [m]
    axial_high: Array | None = None
    duration: Second
    """Time for which a motion whose end is not plain is followed, if that is longer than 160 looks; below
    20 ms fewer looks."""

    def count(self, one: RunOutcome) -> Whole:
        """Runs that ended so at each kick, shape (kick,)."""
        return np.asarray(np.count_nonzero(self.outcome == one, axis=1), dtype=np.int64)


BY_BALL = ("pocket_impacts", "pocket_rubbing")


class Piece(NamedTuple):
    """Runs of one cage from one size of disturbance: their starts, shape (run, state), and numbers."""

    cage: MovingCage
    kick: MetrePerSecond
    numbers: Numbers
    states: Array
    places: Array


def run_ensemble(
    cage: MovingCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    stop: Stop | None = None,
) -> Ensemble:
    """Run the cage from every disturbance and seed; one that turns backward as its mirror image.

    Kicks and runs are those of the settings if not given. Runs 0 to 11 and then, with `first_run`, 12 to 63
    are the same as 0 to 63 at once, to the last bit. `stop` ends the runs at their next look; what is then
    returned has no meaning.

    Raises
    ------
    InputError
        No disturbance or no run, or a run would need more steps than can be waited for.
    """
    speeds, count = chosen(settings_for(settings, turned_forward(cage)), kicks, runs)
    asked = [Runs(cage, settings, first_run, count)]
    return ensemble_of(asked, speeds, follow(pieces_of(asked, speeds), stop=stop))


class Runs(NamedTuple):
    """Runs of one cage by their numbers: the first, and how many."""

    cage: MovingCage
    settings: StabilitySettings
    first_run: int
    runs: int
    whole: bool = False  # whether each is followed for the whole duration, unless it runs away


def pieces_of(asked: Sequence[Runs], kicks: Sequence[MetrePerSecond] | Array) -> list[Piece]:
    """What the engine takes of these runs from every kick, kick by kick."""
    for one in asked:
        check_length(one.settings.duration, one.cage)
    each = [one._replace(cage=turned_forward(one.cage)) for one in asked]
    return [piece_of(one, float(kick)) for kick in kicks for one in each]


def piece_of(asked: Runs, kick: MetrePerSecond) -> Piece:
    """Runs of a cage that turns forward, from one disturbance, by their numbers."""
    cage, settings = asked.cage, asked.settings
    starts = random_starts(cage, settings, asked.first_run, asked.runs)
    numbers = numbers_of(cage, kick, settings.duration, whole=asked.whole)
    return Piece(cage, kick, numbers, start_states(cage, kick, starts), ball_places(cage, starts))


def ensemble_of(
    asked: Sequence[Runs], kicks: Sequence[MetrePerSecond] | Array, found: dict[str, Array]
) -> Ensemble:
    """Ensemble of runs from every kick by their evidence, that of a backward cage from its mirror image."""
    backward = np.concatenate([np.full(one.runs, one.cage.rotation_sense < 0) for one in asked])
    columns = np.tile(backward, len(kicks))
    if backward.any():
        for name in BY_BALL:
            found[name][columns] = other_way_round(found[name][columns])
        left, balls = found["left_ball"], asked[0].cage.ball_count
        found["left_ball"] = np.where(columns & (left > 1), balls + 2 - left, left)
    shaped: dict[str, Any] = {
        name: values.reshape(len(kicks), backward.size, *values.shape[1:]) for name, values in found.items()
    }
    duration = asked[0].settings.duration
    return Ensemble(kicks=np.array(kicks, dtype=np.float64), duration=duration, **shaped)


def other_way_round(by_ball: Array) -> Array:
    """Columns of balls counted the other way round, shape (..., ball); ball 0 stays."""
    return np.roll(by_ball[..., ::-1], 1, axis=-1)


def longest_duration(cage: MovingCage) -> Second:
    """Duration above which a run of this cage is refused."""
    return MOST_LOOKS * look_time(cage)


def check_length(duration: Second, cage: MovingCage) -> None:
    """Refuse a run of a cage that would take longer than anyone waits.

    Raises
    ------
    InputError
        It would need too many looks.
    """
    longest = longest_duration(cage)
    if not duration <= longest:
        cure = "Shorten the run, or check the cage's stiffnesses, mass and moments of inertia."
        rule = f"must be at most {format_quantity(longest, 's', 3)} for this cage"
        raise InputError("[stability] duration", rule, format_quantity(duration, "s"), cure)


def follow(pieces: Sequence[Piece], *, stop: Stop | None = None, real: type = np.float32) -> dict[str, Array]:
    """Evidence of the runs of all pieces, one after the other, by name; each array has shape (run, ...)."""
    sizes = [len(piece.states) for piece in pieces]
    at = np.concatenate([[0], np.cumsum(sizes)])
    groups: dict[Kind, list[int]] = {}
    for i, piece in enumerate(pieces):
        groups.setdefault(piece.numbers.kind, []).append(i)
    whole: dict[str, Array] = {}
    for kind, members in groups.items():
        found = follow_alike(kind, [pieces[i] for i in members], stop or Stop(), real)
        rows_of = np.concatenate([np.arange(at[i], at[i + 1]) for i in members])
        for name, values in found.items():
            whole.setdefault(name, np.zeros((at[-1], *values.shape[1:]), values.dtype))[rows_of] = values
    return whole


CHUNK = 512
"""Runs that are followed at a time, at most: their looks fit into the memory of a thread."""


def follow_alike(
    kind: Kind, pieces: Sequence[Piece], stop: Stop, real: type = np.float32
) -> dict[str, Array]:
    """Evidence of the runs of pieces of one kind."""
    of = np.repeat(np.arange(len(pieces)), [len(piece.states) for piece in pieces])
    states, places = np.concatenate([p.states for p in pieces]), np.concatenate([p.places for p in pieces])
    found = []
    for first in range(0, len(of), CHUNK):
        part = slice(first, first + CHUNK)
        mine = [pieces[i] for i in of[part]]
        raw = run_rows(kind, [piece.numbers for piece in mine], states[part], places[part], stop, real)
        found.append(evidence_of(mine, raw))
    return {name: np.concatenate([one[name] for one in found]) for name in found[0]}


class Raw(NamedTuple):
    """What the queue wrote: looks, shape (run, look, column), numbers of every run, samples of the first."""

    looks: Array
    evidence: Array
    hits: Array
    heat: Array
    record: Array


def run_rows(
    kind: Kind,
    numbers: Sequence[Numbers],
    states: Array,
    places: Array,
    stop: Stop,
    real: type = np.float32,
    *,
    record: Array | None = None,
    every: int = 1,
) -> Raw:
    """Put runs of one kind through the queue."""
    count = len(numbers)
    most = int(max(max(one.limits[outcome.MOST], one.limits[outcome.LEAST]) for one in numbers))
    raw = Raw(
        looks=np.zeros((count, most, of(rows.LOOK_COLUMNS)), np.float32),
        evidence=np.zeros((count, run.EVIDENCE_COLUMNS)),
        hits=np.zeros((count, kind.balls)),
        heat=np.zeros((count, kind.balls)),
        record=np.zeros((0, 1)) if record is None else record,
    )
    raw.evidence[:, run.OUTCOME] = outcome.UNKNOWN
    values, strips, waves, limits = (np.stack(each) for each in list(zip(*numbers, strict=True))[1:])
    follow_queue = run.queue(kind.ball, kind.space, kind.level, real)
    follow_queue(
        states, values, places, strips, waves, limits, kind.steps, raw.looks, raw.evidence, raw.hits,
        raw.heat, kind.lobes, raw.record, every, stop.flag,
    )  # fmt: skip
    return raw


def evidence_of(pieces: Sequence[Piece], raw: Raw) -> dict[str, Array]:
    """Evidence by name from the looks of runs; a row a run."""
    at, looks = raw.evidence, raw.looks
    end = np.maximum(np.ceil(at[:, run.JUDGED]).astype(np.int64), 1)
    looks = looks[:, : end.max()]
    sums = np.concatenate(
        [np.zeros((len(looks), 1, looks.shape[2])), np.cumsum(looks, axis=1, dtype=np.float64)], axis=1
    )
    each = np.arange(len(looks))

    def mean(first: Array, last: Array) -> Array:
        return np.asarray((sums[each, last] - sums[each, first]) / (last - first)[:, np.newaxis])

    length = np.array([piece.numbers.numbers[of(rows.STEP)] * piece.numbers.kind.steps for piece in pieces])
    speed = np.array([piece.cage.cage_speed for piece in pieces])
    start = np.array([0.5 * moving_mass(piece.cage) * piece.kick**2 for piece in pieces])
    fifth = np.maximum(1, end // FIFTH)
    part = np.maximum(fifth, np.minimum(end, LAST))
    whole_part = mean(end - part, end)

    def last(row: int) -> Array:
        return np.asarray(whole_part[:, of(row)])

    def most(row: int) -> Array:
        return np.asarray(at[:, run.extreme(row)])

    curl = _share(last(rows.CURL), last(rows.SPEED_SQUARE))
    found = {
        "outcome": at[:, run.OUTCOME].astype(np.int64),
        "cause": at[:, run.CAUSE].astype(np.int64),
        "end_energy": last(rows.ENERGY),
        "growth_rate": _growth(mean, end, fifth, start) / length,
        "largest_offset": most(rows.PEAK_OFFSET),
        "mean_offset": last(rows.OFFSET_MEAN),
        "offset_spread": np.sqrt(np.maximum(0.0, last(rows.OFFSET_SQUARE) - last(rows.OFFSET_MEAN) ** 2)),
        "orbit_speed": _share(last(rows.SWEPT), last(rows.OFFSET_SQUARE)) + speed,
        "drift_rate": _drift(pieces, mean, end, fifth) / length,
        "whirl_frequency": np.abs(curl) / (2.0 * math.pi),
        "whirl_direction": np.sign(curl).astype(np.int64),
        "largest_contact_force": most(rows.PEAK_FORCE),
        "largest_land_force": most(rows.PEAK_LAND),
        "pocket_impacts": raw.hits.astype(np.int64),
        "pocket_rubbing": raw.heat,
        "pocket_sliding": last(rows.RUBBING),
        "land_impacts": most(rows.LAND_STRIKES).astype(np.int64),
        "strike_rate": last(rows.STRIKES),
        "energy_imbalance": at[:, run.OPEN] / np.maximum(at[:, run.DONE] + start, 1e-300),
        "pocket_power": last(rows.WORK_POCKET) / length,
        "land_power": last(rows.WORK_LAND) / length,
        "rubbing_force": last(rows.PRESSED),
        "rubbing_speed": _share(last(rows.HEATED), last(rows.PRESSED)),
        "left_ball": most(rows.LEFT_BALL).astype(np.int64),
        "left_time": at[:, run.LEFT_AT],
        "followed": at[:, run.JUDGED] * length,
        "judged_from": (end - part) * length,
    }
    if pieces[0].cage.is_in_space:
        found["largest_tilt"] = most(rows.PEAK_TILT)
        found["cone_speed"] = _share(last(rows.CONE), last(rows.TILT_SQUARE)) + speed
        found["axial_low"], found["axial_high"] = most(rows.AXIAL_LOW), most(rows.AXIAL_HIGH)
    return found


def _share(part: Array, whole: Array) -> Array:
    """Part over whole, 0 where there is none."""
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0.0)


LEAST_SHARE = 2.0**-104
"""Share of the energy at the start below which speeds are rounding: growth rates count no further."""


def _growth(mean: Mean, end: Array, fifth: Array, start: Array) -> Array:
    """Half the logarithmic growth of the mean energy from half way to the last fifth, per look."""
    last = mean(end - fifth, end)[:, of(rows.ENERGY)]
    first = np.maximum(0, end // 2 - fifth // 2)
    is_short = end < FIFTH
    before = np.where(is_short, start, mean(first, first + fifth)[:, of(rows.ENERGY)])
    span = np.where(is_short, end - 0.5 * fifth, end - fifth - first)
    least = LEAST_SHARE * start
    return 0.5 * np.log(np.maximum(last, least) / np.maximum(before, least)) / np.maximum(span, 0.5)


def _drift(pieces: Sequence[Piece], mean: Mean, end: Array, fifth: Array) -> Array:
    """Logarithmic growth of the mean offset between the last two fifths, per look; 0 where there is none."""
    late, early = mean(end - fifth, end), mean(np.maximum(0, end - 2 * fifth), np.maximum(end - fifth, 1))
    adrift = np.array([piece.numbers.limits[outcome.IS_ADRIFT] > 0.0 for piece in pieces])

    def size(part: Array) -> Array:
        place = np.hypot(part[:, of(rows.MEAN_X)], part[:, of(rows.MEAN_Y)])
        return np.where(adrift, place, part[:, of(rows.OFFSET_MEAN)])

    is_moved = (size(early) > 0.0) & (size(late) > 0.0)
    ratio = np.divide(size(late), size(early), out=np.ones(len(end)), where=is_moved)
    return np.where(end > 1, np.log(ratio) / fifth, 0.0)
