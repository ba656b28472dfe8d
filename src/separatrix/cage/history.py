"""The course of one run: orbit, rotation, balls, forces and energies against time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from separatrix.cage import slots
from separatrix.cage.ensemble import chosen, prepare, random_starts, run_limits
from separatrix.cage.planar import PlanarCage, RunOutcome, turned_forward
from separatrix.cage.run import FIFTHS, run_chunk
from separatrix.errors import InputError
from separatrix.study import StabilitySettings
from separatrix.units import Array, MetrePerSecond, Radian, Ratio, Second

MOST_SAMPLES = 1_000_000
SOURCES = ("pocket_friction", "race_dampers", "land", "gravity", "moving_frame", "unbalance")


@dataclass(frozen=True, slots=True, kw_only=True)
class History:
    """One run, sampled.

    Positions and velocities are those seen in the frame that turns with the ball set.

    Attributes
    ----------
    time : ndarray
        Shape (time,) [s]; a run that is decided early ends early, and a long flight is not sampled within.
    position, velocity : ndarray
        Geometric centre of the cage [m], and velocity of its centre of mass [m/s], shape (time, 2).
    rotation, rotation_rate : ndarray
        Of the cage against the ball set, shape (time,) [rad] and [rad/s].
    ball_lead, contact_force : ndarray
        Lead y of each ball [m], and force N with which the pocket pushes it forward [N], shape (time, ball).
    land_force : ndarray
        Normal force of the land, shape (time,) [N].
    kinetic_energy, spring_energy : ndarray
        Of the cage in the turning frame, and of the pockets' springs, shape (time,) [J].
    work : dict of str to ndarray
        Work done on the cage since the start by each of `SOURCES`, shape (time,) [J].
    outcome : RunOutcome
        How the run ended; the same as in an ensemble with this kick, seed and run.
    energy_growth : float
        As in the ensemble [-].
    """

    time: Array
    position: Array
    velocity: Array
    rotation: Array
    rotation_rate: Array
    ball_lead: Array
    contact_force: Array
    land_force: Array
    kinetic_energy: Array
    spring_energy: Array
    work: dict[str, Array]
    outcome: RunOutcome
    energy_growth: Ratio


def simulate(
    cage: PlanarCage,
    *,
    kick: MetrePerSecond,
    run: int = 0,
    seed: int = 1,
    duration: Second = 0.3,
    ball_scatter: Ratio = 0.3,
    samples: int = 4000,
) -> History:
    """Follow one run of the ensemble; the motion is the same to the last bit, however it is sampled.

    Parameters
    ----------
    cage : PlanarCage
        The cage.
    kick, run, seed, duration, ball_scatter
        As in the ensemble: speed of the kick [m/s], number of the run, seed, length [s], scatter [-].
    samples : int
        At most so many rows, evenly spaced; the memory is bounded by it.

    Raises
    ------
    InputError
        A setting is out of range.
    """
    settings = StabilitySettings(
        kicks=(kick,), runs=1, duration=duration, ball_scatter=ball_scatter, seed=seed
    )
    forward = turned_forward(cage)
    start = random_starts(forward, settings, run, 1)
    history = follow(
        forward,
        kick=kick,
        direction=float(start[0, 0]),
        ball_lead=start[0, 1:],
        duration=duration,
        samples=samples,
    )
    return history if forward is cage else _mirrored(history)


def _mirrored(history: History) -> History:
    """Return the motion seen from the other side, where the ball set turns the other way."""
    flip = np.array([1.0, -1.0])
    return replace(
        history,
        position=history.position * flip,
        velocity=history.velocity * flip,
        rotation=-history.rotation,
        rotation_rate=-history.rotation_rate,
        ball_lead=-_other_way_round(history.ball_lead),
        contact_force=-_other_way_round(history.contact_force),
    )


def _other_way_round(by_ball: Array) -> Array:
    """Return columns of balls counted the other way round, shape (time, ball); ball 0 stays."""
    return np.roll(by_ball[:, ::-1], 1, axis=1)


def follow(
    cage: PlanarCage,
    *,
    kick: MetrePerSecond,
    direction: Radian,
    ball_lead: Array,
    duration: Second,
    samples: int = 4000,
) -> History:
    """Follow the run that starts with this direction of the kick [rad] and these leads, shape (ball,) [m].

    Raises
    ------
    InputError
        A setting is out of range.
    """
    if not 2 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"must lie between 2 and {MOST_SAMPLES}", "-", str(samples))
    lead = np.asarray(ball_lead, dtype=np.float64)
    if lead.shape != (cage.ball_count,) or not np.all(np.abs(lead) <= cage.half_play):
        rule = f"must be {cage.ball_count} numbers within the pockets' play"
        raise InputError("ball_lead", rule, "m", f"{lead.tolist()}")
    settings = StabilitySettings(kicks=(kick,), runs=1, duration=duration)
    chosen(settings, None, None)
    engine = prepare(cage, duration)
    rows = np.zeros((samples, slots.BALLS + 2 * cage.ball_count))
    rows[:, 0] = np.linspace(0.0, FIFTHS * engine.fifth, samples)
    out = np.zeros((1, slots.EVIDENCE))
    starts = np.concatenate([[direction], lead])[np.newaxis]
    run_chunk(
        *engine.kernel_arguments,
        starts,
        kick,
        engine.fifth,
        run_limits(cage, kick),
        cage.rotation_sense,
        rows,
        out,
    )
    return _history(cage, rows[: int(out[0, slots.ROWS])], out[0])


def _history(cage: PlanarCage, rows: Array, evidence: Array) -> History:
    """Record of the rows that the kernel filled."""
    velocity = rows[:, [slots.VX, slots.VY]]
    turned, rate = rows[:, slots.THETA], rows[:, slots.SPIN]
    eccentricity = cage.unbalance / cage.mass
    position = rows[:, [slots.X, slots.Y]] - eccentricity * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    ledger = rows[:, slots.STATE : slots.LAND_FORCE]
    count = cage.ball_count
    return History(
        time=rows[:, slots.STEP].copy(),
        position=position,
        velocity=velocity,
        rotation=turned.copy(),
        rotation_rate=rate.copy(),
        ball_lead=rows[:, slots.BALLS : slots.BALLS + count].copy(),
        contact_force=rows[:, slots.BALLS + count :].copy(),
        land_force=rows[:, slots.LAND_FORCE].copy(),
        kinetic_energy=0.5 * (cage.mass * (velocity**2).sum(axis=1) + cage.moment_of_inertia * rate**2),
        spring_energy=ledger[:, slots.STORED].copy(),
        work={name: ledger[:, i].copy() for i, name in enumerate(SOURCES)},
        outcome=RunOutcome(int(evidence[slots.OUTCOME])),
        energy_growth=float(evidence[slots.GROWTH]),
    )
