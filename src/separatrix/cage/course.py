"""The course of one run: orbit, rotation, tilt, balls, forces and energies against time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np

from separatrix.cage import rows
from separatrix.cage.disturbance import (
    Starts,
    ball_places,
    chosen,
    random_starts,
    settings_for,
    start_states,
)
from separatrix.cage.ensemble import Piece, Raw, Stop, check_length, evidence_of, other_way_round, run_rows
from separatrix.cage.moving_cage import MovingCage, turned_forward
from separatrix.cage.numbers import ball_level, numbers_of, pocket_rectangle
from separatrix.cage.outcome import Cause, RunOutcome
from separatrix.cage.rows import of
from separatrix.errors import InputError
from separatrix.study import StabilitySettings
from separatrix.units import (
    Array,
    Hertz,
    Joule,
    Metre,
    MetrePerSecond,
    Newton,
    PerSecond,
    Radian,
    Ratio,
    Second,
    Watt,
)

if TYPE_CHECKING:
    from separatrix.cage.numbers import Numbers

MOST_SAMPLES = 1_000_000

WHIRL_TURNS = 50
"""Turns of a whirl that a history shows at least, whenever its end was plain."""

SOURCES = {
    "pocket_friction": rows.POCKET_WORK,
    "land_friction": rows.LAND_WORK,
    "land_normal": rows.LAND_PRESS_WORK,
    "balls": rows.BALL_WORK,
    "frame_and_loads": rows.FRAME_WORK,
}
"""Works that change the energy of cage and pocket springs. Balls: what the races take, less what they
drive."""


@dataclass(frozen=True, slots=True, kw_only=True)
class History:
    """One run, sampled, seen in the frame that turns with the ball set.

    Numbers without an array are those of the ensemble's run with this disturbance, seed and number; what only
    a cage in space has is None in the plane.

    Attributes
    ----------
    time : ndarray
        Shape (time,) [s]; a run that grows without limit ends early.
    position, velocity : ndarray
        Geometric centre of the cage across the axis, and its velocity, shape (time, across) [m], [m/s].
    rotation, rotation_rate : ndarray
        Of the cage against the ball set, shape (time,) [rad] and [rad/s].
    axial_place, axial_speed : ndarray or None
        Of the centre of mass along the axis, shape (time,) [m], [m/s].
    lean, lean_rate : ndarray or None
        Where the geometric axis leans to: the way of a point on it over its height, shape (time, across)
        [rad], [rad/s].
    ball_lead, ball_speed : ndarray
        Lead of each ball [m], and its speed beyond its free orbit [m/s] (0 of a damper), shape (time, ball).
    ball_axial : ndarray or None
        Place of each ball along its groove, shape (time, ball) [m].
    contact_force, contact_angle : ndarray
        Force of each pocket on its ball [N]; where on the ball it acts: 0 in front of it, 90 deg along the
        axis, 180 deg behind it, 0 without force, shape (time, ball) [rad].
    land_force : ndarray
        Normal force of all lands, shape (time,) [N].
    kinetic_energy, stored_energy : ndarray
        Of the cage in the turning frame; of the pockets' springs, shape (time,) [J].
    work : dict of str to ndarray
        Work done on cage and pocket springs since the start by each of `SOURCES`, shape (time,) [J].
    pocket_angle, half_play : ndarray
        Place of each pocket in the turning frame [rad]; half its clearance along the orbit [m], shape
        (ball,).
    outcome, cause : RunOutcome, Cause
        Where the motion ends, and why the run is unresolved, if it is.
    judged_from, judged_until : float
        The last part of the run, by which it was judged [s]; the history may go on.
    """

    time: Annotated[Array, "s", ("time",)]
    position: Annotated[Array, "m", ("time", "across")]
    velocity: Annotated[Array, "m/s", ("time", "across")]
    rotation: Annotated[Array, "rad", ("time",)]
    rotation_rate: Annotated[Array, "rad/s", ("time",)]
    axial_place: Annotated[Array | None, "m", ("time",)]
    axial_speed: Annotated[Array | None, "m/s", ("time",)]
    lean: Annotated[Array | None, "rad", ("time", "across")]
    lean_rate: Annotated[Array | None, "rad/s", ("time", "across")]
    ball_lead: Annotated[Array, "m", ("time", "ball")]
    ball_speed: Annotated[Array, "m/s", ("time", "ball")]
    ball_axial: Annotated[Array | None, "m", ("time", "ball")]
    contact_force: Annotated[Array, "N", ("time", "ball")]
    contact_angle: Annotated[Array, "rad", ("time", "ball")]
    land_force: Annotated[Array, "N", ("time",)]
    kinetic_energy: Annotated[Array, "J", ("time",)]
    stored_energy: Annotated[Array, "J", ("time",)]
    work: Annotated[dict[str, Array], "J", ("time",)]
    pocket_angle: Annotated[Array, "rad", ("ball",)]
    half_play: Annotated[Array, "m", ("ball",)]
    pocket_impacts: Annotated[Array, "-", ("ball",)]
    pocket_rubbing: Annotated[Array, "J", ("ball",)]
    outcome: RunOutcome
    cause: Cause
    judged_from: Second
    judged_until: Second
    end_energy: Joule
    growth_rate: PerSecond
    drift_rate: PerSecond
    largest_offset: Metre
    whirl_frequency: Hertz
    whirl_direction: int
    pocket_power: Watt
    land_power: Watt
    rubbing_force: Newton
    rubbing_speed: MetrePerSecond
    largest_contact_force: Newton
    largest_land_force: Newton
    land_impacts: int
    left_ball: int
    left_time: Second
    energy_imbalance: Ratio


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

    Parameters
    ----------
    cage : MovingCage
        The cage.
    kick, run, seed, duration, ball_scatter
        As in the ensemble: speed of the disturbance [m/s], number of the run, seed, length [s], scatter [-].
    samples : int
        Largest number of rows, evenly spaced; the memory is bounded by it.
    until : float, optional
        Time up to which there are rows, to within one [s]; by default that up to which the run is judged, or
        50 turns of its whirl.

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


def follow(
    cage: MovingCage,
    *,
    kick: MetrePerSecond,
    direction: Radian,
    ball_lead: Array,
    duration: Second,
    samples: int = 4000,
    until: Second | None = None,
    real: type = np.float64,
    refine: int = 1,
) -> History:
    """Follow the run that starts in this direction [rad] and with these leads, shape (ball,) [m]."""
    lead = np.asarray(ball_lead, dtype=np.float64)
    if lead.shape != (cage.ball_count,) or not np.all(np.abs(lead) <= cage.half_play):
        rule = f"must be {cage.ball_count} numbers within the pocket clearance [m]"
        raise InputError("ball_lead", rule, f"{lead.tolist()}")
    starts = Starts(
        direction=np.array([direction]),
        tilt_direction=np.zeros(1),
        axial_sense=np.ones(1),
        lead=lead[np.newaxis],
        more=np.zeros((1, cage.ball_count)),
        angle=np.array([cage.ball_angles]),
    )
    return follow_start(cage, kick, starts, duration, samples, until, real=real, refine=refine)


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
    settings = StabilitySettings(kicks=(kick,), runs=1, duration=duration)
    chosen(settings_for(settings, cage), None, None)
    check_length(max(duration, until or 0.0), cage)
    states, places = start_states(cage, kick, starts), ball_places(cage, starts)
    numbers = numbers_of(cage, kick, duration, refine=refine)
    length = until
    if length is None:
        piece = Piece(cage, kick, numbers, states, places)
        found = evidence_of([piece], run_rows(numbers.kind, [numbers], states, places, Stop(), real))
        length = float(found["followed"][0])
        if found["outcome"][0] == RunOutcome.WHIRLS and found["whirl_frequency"][0] > 0.0:
            length = max(length, WHIRL_TURNS / float(found["whirl_frequency"][0]))
    numbers = numbers_of(cage, kick, duration, least=length, refine=refine)
    step = numbers.numbers[of(rows.STEP)]
    every = max(1, math.ceil(length / step / (samples - 1)))
    columns = 2 + states.shape[1] + of(rows.GWB - rows.GX) + 1 + cage.ball_count
    record = np.zeros((math.ceil(length / step / every) + 1, columns))  # the last row where a look reaches it
    raw = run_rows(numbers.kind, [numbers], states, places, Stop(), real, record=record, every=every)
    return _history(cage, kick, numbers, starts, places, states, raw)


def _history(
    cage: MovingCage,
    kick: MetrePerSecond,
    numbers: Numbers,
    starts: Starts,
    places: Array,
    states: Array,
    raw: Raw,
) -> History:
    """Record of the rows that the queue wrote."""
    record, Z, kind = raw.record, cage.ball_count, numbers.kind
    filled = int(
        np.count_nonzero(np.isfinite(record[:, 1 + of(rows.VX)]) & (record[:, 1 + of(rows.RAMP)] > 0.0))
    )
    record = record[:filled]
    state, first = record[:, 1 : 1 + states.shape[1]], rows.cage_states(space=kind.space)
    one = rows.ball_states(kind.ball, space=kind.space)
    at = 1 + states.shape[1]
    pose, force = record[:, at : at + of(rows.GWB - rows.GX) + 1], record[:, -1 - Z : -1]
    R, speed_row = cage.pitch_radius, 2 if kind.space else 1
    centre, axis = 0, of(rows.GA - rows.GX)
    lead = state[:, first::one]
    along, across = _places_of_pockets(cage, state, pose, lead, starts, one)
    depth, angle = _touch(cage, along, across, places)
    stiffness, hertz = (numbers.numbers[of(row)] for row in (rows.STIFFNESS, rows.HERTZ))
    found = evidence_of([Piece(cage, kick, numbers, states, places)], raw)
    in_space = kind.space
    return History(
        time=record[:, 0].copy(),
        position=pose[:, centre : centre + 2].copy(),
        velocity=pose[:, centre + 2 : centre + 4].copy(),
        rotation=state[:, of(rows.S)] / R,
        rotation_rate=state[:, of(rows.VS)] / R,
        axial_place=state[:, of(rows.Z)].copy() if in_space else None,
        axial_speed=state[:, of(rows.VZ)].copy() if in_space else None,
        lean=np.stack([pose[:, axis + 1], -pose[:, axis]], axis=1) if in_space else None,
        lean_rate=np.stack([pose[:, axis + 3], -pose[:, axis + 2]], axis=1) if in_space else None,
        ball_lead=lead.copy(),
        ball_speed=np.zeros_like(lead)
        if ball_level(cage) == rows.DAMPER
        else state[:, first + speed_row :: one].copy(),
        ball_axial=state[:, first + 1 :: one].copy() if in_space else None,
        contact_force=force.copy(),
        contact_angle=angle * (force > 0.0),
        land_force=record[:, -1].copy(),
        kinetic_energy=_kinetic(cage, state, in_space),
        stored_energy=((0.5 * stiffness + 0.4 * hertz * np.sqrt(depth)) * depth**2).sum(axis=1),
        work=_works(record, state, numbers, raw),
        pocket_angle=starts.angle[0],
        half_play=cage.half_play + starts.more[0],
        judged_until=float(found["followed"][0]),
        outcome=RunOutcome(int(found["outcome"][0])),
        cause=Cause(int(found["cause"][0])),
        pocket_impacts=found["pocket_impacts"][0].astype(np.float64),
        pocket_rubbing=found["pocket_rubbing"][0],
        whirl_direction=int(found["whirl_direction"][0]),
        land_impacts=int(found["land_impacts"][0]),
        left_ball=int(found["left_ball"][0]),
        **{name: float(found[name][0]) for name in _NUMBERS},
    )


_NUMBERS = (
    *(
        "judged_from",
        "end_energy",
        "growth_rate",
        "drift_rate",
        "largest_offset",
        "whirl_frequency",
        "pocket_power",
    ),
    *(
        "land_power",
        "rubbing_force",
        "rubbing_speed",
        "largest_contact_force",
        "largest_land_force",
        "left_time",
    ),
    "energy_imbalance",
)


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


def _touch(cage: MovingCage, along: Array, across: Array, places: Array) -> tuple[Array, Array]:
    """Depth of each pocket in its ball [m], and where on the ball it touches [rad]: see `pocket_force`."""
    by_ball = places.reshape(cage.ball_count, -1)
    beside = pocket_rectangle(cage)[1]
    t = along - np.clip(along, -by_ball[:, of(rows.APART)], by_ball[:, of(rows.APART)])
    z = across - np.clip(across, -beside, beside)
    return np.maximum(np.hypot(t, z) - by_ball[:, of(rows.AROUND)], 0.0), np.arctan2(0.0 - z, -t)


def _kinetic(cage: MovingCage, state: Array, in_space: bool) -> Array:
    """Kinetic energy of the cage in the turning frame, shape (time,) [J]."""
    mass = cage.mass + cage.added_mass
    twice = mass * (state[:, of(rows.VX)] ** 2 + state[:, of(rows.VY)] ** 2)
    twice += cage.moment_of_inertia * (state[:, of(rows.VS)] / cage.pitch_radius) ** 2
    if in_space:
        twice += cage.mass * state[:, of(rows.VZ)] ** 2
        twice += cage.transverse * (state[:, of(rows.WX)] ** 2 + state[:, of(rows.WY)] ** 2)
    return np.asarray(0.5 * twice)


def _works(record: Array, state: Array, numbers: Numbers, raw: Raw) -> dict[str, Array]:
    """Work of each source since the start: of the looks before, and since."""
    look = np.minimum(
        (record[:, 0] / numbers.numbers[of(rows.STEP)] / numbers.kind.steps + 1e-9).astype(int),
        raw.looks.shape[1],
    )
    looks = raw.looks[0].astype(np.float64)
    before = np.concatenate([np.zeros((1, looks.shape[1])), np.cumsum(looks, axis=0)])
    columns = dict(
        zip(
            SOURCES,
            (rows.WORK_POCKET, rows.WORK_LAND, rows.WORK_PRESS, rows.WORK_BALL, rows.WORK_FRAME),
            strict=True,
        )
    )
    return {name: before[look, of(columns[name])] + state[:, of(row)] for name, row in SOURCES.items()}


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
