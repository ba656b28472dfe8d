"""The course of one run against time: orbit, tilt, balls, forces, energies, and what they show."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from separatrix.cage import rows, run
from separatrix.cage.disturbance import Starts, ball_places, chosen, random_starts, start_states
from separatrix.cage.ensemble import (
    Ensemble,
    Piece,
    Raw,
    Stop,
    check_length,
    evidence_of,
    other_way_round,
    run_rows,
)
from separatrix.cage.moving_cage import MovingCage, turned_forward
from separatrix.cage.numbers import look_time, numbers_of, pocket_rectangle
from separatrix.cage.outcome import Cause, RunOutcome
from separatrix.cage.rows import of
from separatrix.ground.errors import InputError
from separatrix.ground.units import (
    Array,
    Hertz,
    Joule,
    Metre,
    MetrePerSecond,
    Newton,
    PerSecond,
    Radian,
    RadianPerSecond,
    Ratio,
    Second,
    Watt,
)
from separatrix.study.study import StabilitySettings

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.numbers import Numbers

MOST_SAMPLES = 1_000_000

FEWEST = 16
"""Samples of the judged part below which the whole run is taken."""

WHIRL_TURNS = 50
"""Turns of a whirl that a history shows at least, whenever its end was plain."""

SOURCES = {
    "pocket_friction": (rows.POCKET_WORK, rows.WORK_POCKET),
    "land_friction": (rows.LAND_WORK, rows.WORK_LAND),
    "land_normal": (rows.LAND_PRESS_WORK, rows.WORK_PRESS),
    "balls": (rows.BALL_WORK, rows.WORK_BALL),
    "frame_and_loads": (rows.FRAME_WORK, rows.WORK_FRAME),
}
"""Works that change the energy of cage and pocket springs, as a state and as a sum of a look. Balls: what the
races take, less what they drive."""


@dataclass(frozen=True, slots=True, kw_only=True)
class History:
    """One run, sampled, seen in the frame that turns with the ball set.

    Numbers without an array are those of the ensemble's run with this disturbance, seed and number; what only
    a cage in space has is None in the plane.
    """

    time: Annotated[Array, "s", ("time",)]  # a run that grows without limit ends early
    position: Annotated[Array, "m", ("time", "across")]  # of the geometric centre, across the axis
    velocity: Annotated[Array, "m/s", ("time", "across")]  # of the same
    rotation: Annotated[Array, "rad", ("time",)]  # of the cage against the ball set
    rotation_rate: Annotated[Array, "rad/s", ("time",)]  # of the same
    axial_place: Annotated[Array | None, "m", ("time",)]  # of the centre of mass
    axial_speed: Annotated[Array | None, "m/s", ("time",)]  # of the same
    lean: Annotated[Array | None, "rad", ("time", "across")]  # way of a point on the axis over its height
    lean_rate: Annotated[Array | None, "rad/s", ("time", "across")]  # of the lean
    ball_lead: Annotated[Array, "m", ("time", "ball")]  # beyond its place in the ball set
    ball_speed: Annotated[Array, "m/s", ("time", "ball")]  # beyond its free orbit; 0 of a damper
    ball_axial: Annotated[Array | None, "m", ("time", "ball")]  # place along its groove
    contact_force: Annotated[Array, "N", ("time", "ball")]  # of each pocket on its ball
    contact_angle: Annotated[Array, "rad", ("time", "ball")]
    """Where on the ball it acts: 0 in front of it, 90 deg along the axis, 180 deg behind it, 0 without."""
    land_force: Annotated[Array, "N", ("time",)]  # normal force of all lands
    kinetic_energy: Annotated[Array, "J", ("time",)]  # of the cage in the turning frame
    stored_energy: Annotated[Array, "J", ("time",)]  # of the pockets' springs
    work: Annotated[dict[str, Array], "J", ("time",)]  # on cage and pocket springs, by each of `SOURCES`
    pocket_angle: Annotated[Array, "rad", ("ball",)]  # in the turning frame
    half_play: Annotated[Array, "m", ("ball",)]  # half the clearance of each pocket along the orbit
    pocket_impacts: Annotated[Array, "-", ("ball",)]
    pocket_rubbing: Annotated[Array, "J", ("ball",)]  # integral of force times sliding speed
    pocket_sliding: Watt  # mean of force times sliding speed in all pockets at the end
    outcome: RunOutcome  # SETTLES, ROLLS, WHIRLS, DRIFTS or UNRESOLVED
    cause: Cause  # why the run is unresolved, or that friction on the land drives its whirl
    judged_from: Second  # the last part of the run, by which it was judged
    followed: Second  # its end; the history may go on
    end_energy: Joule  # mean kinetic energy at the end
    growth_rate: PerSecond
    drift_rate: PerSecond  # growth rate of the mean offset
    largest_offset: Metre
    mean_offset: Metre
    offset_spread: Metre  # standard deviation of the offset at the end
    orbit_speed: RadianPerSecond  # of the centre about the axis in the fixed frame, at the end
    whirl_frequency: Hertz  # in the judged part, from which a whirl may still grow
    whirl_direction: int  # of the centre's velocity, seen from the balls: 1 forward, -1 backward
    pocket_power: Watt  # that pocket friction feeds into the cage; below 0 it takes from it
    land_power: Watt  # the same of the land
    rubbing_force: Newton  # mean normal force on the land
    rubbing_speed: MetrePerSecond  # sliding speed there, weighted with the force
    largest_contact_force: Newton
    largest_land_force: Newton
    land_impacts: int  # impacts of the cage on its land
    left_ball: int  # first ball, from 1, that reached the edge of its pocket's wall; 0 if none did
    left_time: Second  # at which a ball reaches the edge of its pocket's wall
    energy_imbalance: Ratio  # unexplained part of the energy balance, over the work done
    largest_tilt: Radian | None  # between the axes of cage and bearing
    cone_speed: RadianPerSecond | None  # of the lean of the axis, in the fixed frame
    axial_low: Metre | None  # extremes of the axial place
    axial_high: Metre | None  # of the axial place


def simulate(
    cage: MovingCage,
    *,
    kick: MetrePerSecond,
    run: int = 0,
    seed: int = 1,
    duration: Second = 0.3,
    ball_scatter: Ratio = 0.3,
    samples: int = 4000,
    until: Second | None = None,
) -> History:
    """Follow one run of the ensemble; the motion is the same to the last bit, however it is sampled.

    Speed of the disturbance [m/s], number of the run, seed, length [s] and scatter [-] are as in the
    ensemble. There are at most `samples` rows, evenly spaced, up to `until` [s]: by default the time to which
    the run is judged, or 50 turns of its whirl.

    Raises
    ------
    InputError
        A setting is out of range.
    """
    settings = StabilitySettings(
        kicks=(kick,), runs=1, duration=duration, ball_scatter=ball_scatter, seed=seed
    )
    forward = turned_forward(cage)
    history = follow_start(forward, kick, random_starts(forward, settings, run, 1), duration, samples, until)
    return history if forward is cage else _mirrored(history)


def follow_start(
    cage: MovingCage,
    kick: MetrePerSecond,
    starts: Starts,
    duration: Second,
    samples: int,
    until: Second | None,
    *,
    real: type = np.float32,
    refine: int = 1,
) -> History:
    """Follow one run of a cage that turns forward: once to its end, once more to sample it."""
    if not 2 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"must lie between 2 and {MOST_SAMPLES} [-]", str(samples))
    chosen(StabilitySettings(kicks=(kick,), runs=1, duration=duration), None, None)
    check_length(max(duration, until or 0.0), cage)
    states, places = start_states(cage, kick, starts), ball_places(cage, starts)
    piece, length = Piece(cage, kick, numbers_of(cage, kick, duration, refine=refine), states, places), until
    if length is None:
        kind = piece.numbers.kind
        found = evidence_of([piece], run_rows(kind, [piece.numbers], states, places, Stop(), real))
        length = float(found["followed"][0])
        if found["outcome"][0] == RunOutcome.WHIRLS and found["whirl_frequency"][0] > 0.0:
            length = max(length, WHIRL_TURNS / float(found["whirl_frequency"][0]))
    numbers = numbers_of(cage, kick, duration, least=length, refine=refine)
    step = numbers.numbers[of(rows.STEP)]
    every = max(1, math.ceil(length / step / (samples - 1)))
    columns = 4 + states.shape[1] + of(rows.GWB - rows.GX) + 1 + cage.ball_count
    record = np.zeros((math.ceil(length / step / every) + 1, columns))  # the last row where a look reaches it
    raw = run_rows(numbers.kind, [numbers], states, places, Stop(), real, record=record, every=every)
    return _history(piece._replace(numbers=numbers), starts, raw)


def _history(piece: Piece, starts: Starts, raw: Raw) -> History:
    """Record of the rows that the queue wrote."""
    cage, numbers, record = piece.cage, piece.numbers, raw.record
    kind, in_space = numbers.kind, numbers.kind.space
    filled = np.isfinite(record[:, 1 + of(rows.VX)]) & (record[:, 1 + of(rows.RAMP)] > 0.0)
    record = record[: np.count_nonzero(filled)]
    first, one = rows.cage_states(space=in_space), rows.ball_states(kind.ball, space=in_space)
    parts = np.cumsum([1, piece.states.shape[1], of(rows.GWB - rows.GX) + 1, cage.ball_count])
    time, state, pose, force, rest = np.split(record, parts, axis=1)
    lead, speed = state[:, first::one], first + (2 if in_space else 1)
    angle = _angles(cage, *_places_of_pockets(cage, state, pose, lead, starts, one), piece.places)
    found = evidence_of([piece], raw)
    return History(
        time=time[:, 0].copy(),
        position=pose[:, :2].copy(),
        velocity=pose[:, 2:4].copy(),
        rotation=state[:, of(rows.S)] / cage.pitch_radius,
        rotation_rate=state[:, of(rows.VS)] / cage.pitch_radius,
        axial_place=state[:, of(rows.Z)].copy() if in_space else None,
        axial_speed=state[:, of(rows.VZ)].copy() if in_space else None,
        lean=np.stack([pose[:, 5], -pose[:, 4]], axis=1) if in_space else None,
        lean_rate=np.stack([pose[:, 7], -pose[:, 6]], axis=1) if in_space else None,
        ball_lead=lead.copy(),
        ball_speed=(0.0 * lead if kind.ball == rows.DAMPER else state[:, speed::one]).copy(),
        ball_axial=state[:, first + 1 :: one].copy() if in_space else None,
        contact_force=force.copy(),
        contact_angle=angle * (force > 0.0),
        land_force=rest[:, 2].copy(),
        kinetic_energy=rest[:, 0].copy(),
        stored_energy=rest[:, 1].copy(),
        work=_works(record, state, numbers, raw),
        pocket_angle=starts.angle[0],
        half_play=cage.half_play + starts.more[0],
        outcome=RunOutcome(int(found["outcome"][0])),
        cause=Cause(int(found["cause"][0])),
        pocket_impacts=found["pocket_impacts"][0].astype(np.float64),
        pocket_rubbing=found["pocket_rubbing"][0],
        **_numbers_of_the_run(found),
    )


def _numbers_of_the_run(found: dict[str, Array]) -> dict[str, Any]:
    """Numbers of a history that are those of the ensemble; None of what only space has."""
    own = {"outcome", "cause", "pocket_impacts", "pocket_rubbing"}
    both = {one.name for one in fields(History)} & {one.name for one in fields(Ensemble)} - own
    return {name: found[name][0].item() if name in found else None for name in both}


def _places_of_pockets(
    cage: MovingCage, state: Array, pose: Array, lead: Array, starts: Starts, one: int
) -> tuple[Array, Array]:
    """Place of each pocket less that of its ball, along orbit and axis, shape (time, ball) [m]."""
    c, n = np.cos(starts.angle), np.sin(starts.angle)
    along = pose[:, [1]] * c - pose[:, [0]] * n + state[:, [of(rows.S)]] - lead
    if not cage.is_in_space:
        return along, np.full_like(along, cage.pocket_axial_offset)
    a, b = (pose[:, [of(row - rows.GX)]] for row in (rows.GA, rows.GB))
    groove = state[:, of(rows.SPACE_STATES + rows.GROOVE) :: one]
    return along, state[:, [of(rows.Z)]] - cage.pitch_radius * (b * c - a * n) - groove


def _angles(cage: MovingCage, along: Array, across: Array, places: Array) -> Array:
    """Where on each ball its pocket touches, shape (time, ball) [rad]: see `contact_force.pocket_depth`."""
    beside, apart = pocket_rectangle(cage)[1], places[0, :, of(rows.APART)]
    t, z = along - np.clip(along, -apart, apart), across - np.clip(across, -beside, beside)
    return np.asarray(np.arctan2(0.0 - z, -t))


def _works(record: Array, state: Array, numbers: Numbers, raw: Raw) -> dict[str, Array]:
    """Work of each source since the start: of the looks before, and since.

    A run that had grown too far was judged within a look, where its works began anew.
    """
    look = np.minimum(
        (record[:, 0] / numbers.numbers[of(rows.STEP)] / numbers.kind.steps + 1e-9).astype(int),
        raw.looks.shape[1],
    )
    looks = raw.looks[0].astype(np.float64)
    before = np.concatenate([np.zeros((1, looks.shape[1])), np.cumsum(looks, axis=0)])
    judged = raw.evidence[0, run.JUDGED] * numbers.numbers[of(rows.STEP)] * numbers.kind.steps
    later = record[:, 0] > judged * (1.0 + 1e-9)
    cut = int(np.count_nonzero(~later)) - 1
    works = {}
    for name, (row, column) in SOURCES.items():
        works[name] = before[look, of(column)] + state[:, of(row)]
        if later.any() and raw.evidence[0, run.JUDGED] % 1.0:
            works[name] += later * state[cut, of(row)]
    return works


def _mirrored(history: History) -> History:
    """Return the motion seen from the other side, where the ball set turns the other way."""
    flip = np.array([1.0, -1.0])
    left = history.left_ball
    return replace(
        history,
        position=history.position * flip,
        velocity=history.velocity * flip,
        rotation=-history.rotation,
        rotation_rate=-history.rotation_rate,
        lean=None if history.lean is None else history.lean * flip,
        lean_rate=None if history.lean_rate is None else history.lean_rate * flip,
        ball_lead=-other_way_round(history.ball_lead),
        ball_speed=-other_way_round(history.ball_speed),
        ball_axial=None if history.ball_axial is None else other_way_round(history.ball_axial),
        contact_force=other_way_round(history.contact_force),
        contact_angle=other_way_round(
            np.mod(math.pi - history.contact_angle, 2.0 * math.pi) * (history.contact_force > 0)
        ),
        pocket_angle=-other_way_round(history.pocket_angle),
        half_play=other_way_round(history.half_play),
        pocket_impacts=other_way_round(history.pocket_impacts),
        pocket_rubbing=other_way_round(history.pocket_rubbing),
        left_ball=history.pocket_angle.size + 2 - left if left > 1 else left,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class CourseAnalysis:
    """What the samples of one run show beside what the engine counts."""

    run_length: Second  # of the samples
    whirl_speed: MetrePerSecond  # root of the mean square speed of the centre at the end, seen from the balls
    grown_speed: MetrePerSecond  # the same in the last fifth of the samples: a whirl grows after it is judged
    cage_slip: Ratio | None
    """By how much the cage turns slower than the ball set at the end, over that; None at rest."""
    tilt_phase: Radian | None  # from offset to lean at the end; 0: the axis leans outward where the centre is
    tilt_coherence: Ratio | None  # how far the lean keeps that angle: 1 always, 0 not at all
    impact_rate: Annotated[Array, "1/s", ("ball",)]  # in each pocket
    impacts_per_turn: Annotated[Array | None, "-", ("ball",)]  # of the cage; None at rest
    pocket_rubbing_power: Annotated[Array, "W", ("ball",)]  # heat of friction in each pocket, mean of the run
    front_share: Ratio | None  # of the impulse of pockets on balls, within 45 deg of the front of the ball
    rear_share: Ratio | None  # the same of its rear
    axial_share: Ratio | None  # near both axial poles


def analyse(cage: MovingCage, history: History) -> CourseAnalysis:
    """Analyse a run of a cage."""
    time, speed, sense = history.time, ball_set_speed(cage, history.time), cage.rotation_sense
    judged = (time >= history.judged_from) & (time <= history.followed)
    part = np.flatnonzero(judged | (judged.sum() < FEWEST))
    here = slice(int(part[0]), int(part[-1]) + 1)
    look = look_time(cage)  # of which the engine counts whole ones
    ended = math.ceil(time[-1] / look - 1e-9) * look or math.inf
    turns = abs(integral(time, speed + history.rotation_rate)) / (2.0 * math.pi)
    by_balls = integral(time[here], speed[here])
    phase, coherence = None, None
    if history.lean is not None:
        phase, coherence = phase_of(history.position[here], history.lean[here], time[here])
    step = np.gradient(time) if time.size > 1 else np.ones(1)
    impulse, along = history.contact_force * step[:, np.newaxis], sense * np.cos(history.contact_angle)
    total, pole = float(impulse.sum()), math.cos(math.pi / 4.0)
    squares = np.sum(history.velocity**2, axis=1)

    def share(near: NDArray[np.bool_]) -> Ratio | None:
        return float(impulse[near].sum()) / total if total > 0.0 else None

    return CourseAnalysis(
        run_length=float(time[-1]),
        whirl_speed=math.sqrt(float(np.mean(squares[here]))),
        grown_speed=math.sqrt(float(np.mean(squares[time >= 0.8 * time[-1]]))),
        cage_slip=-integral(time[here], history.rotation_rate[here]) / by_balls if by_balls else None,
        tilt_phase=None if phase is None else sense * phase,
        tilt_coherence=coherence,
        impact_rate=history.pocket_impacts / ended,
        impacts_per_turn=history.pocket_impacts / turns if turns > 0.0 else None,
        pocket_rubbing_power=cage.ball_cage_friction * history.pocket_rubbing / ended,
        front_share=share(along >= pole),
        rear_share=share(along <= -pole),
        axial_share=share(np.abs(along) < pole),
    )


def ball_set_speed(cage: MovingCage, time: Array) -> Array:
    """Angular speed of the ball set at times, with its ramp [rad/s]."""
    missing = 1.0 - cage.ramp_start if cage.ramp_time else 0.0
    return cage.cage_speed * (1.0 - missing * np.maximum(0.0, 1.0 - time / (cage.ramp_time or 1.0)))


def integral(time: Array, values: Array) -> float:
    """Integral over time by trapezoids."""
    return float(np.trapezoid(values, time))


def phase_of(offset: Array, lean: Array, time: Array) -> tuple[Radian | None, Ratio | None]:
    """Angle from one vector to another, weighted by both, and how steadily it is that; shape (time, 2)."""
    along = integral(time, np.sum(offset * lean, axis=1))
    across = integral(time, offset[:, 0] * lean[:, 1] - offset[:, 1] * lean[:, 0])
    both = math.sqrt(integral(time, np.sum(offset**2, axis=1)) * integral(time, np.sum(lean**2, axis=1)))
    if not both > 0.0:
        return None, None
    return math.atan2(across, along), min(1.0, math.hypot(along, across) / both)
