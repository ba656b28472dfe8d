"""The course of one run: orbit, rotation, balls, forces and energies against time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from separatrix.cage.closed_forms import fastest_rate, time_unit
from separatrix.cage.ensemble import check_length, chosen, other_way_round, random_starts, run_rows
from separatrix.cage.planar import Cause, PlanarCage, RunOutcome, turned_forward
from separatrix.cage.records import SOURCES, Evidence, Samples, dtype_of, samples_for
from separatrix.errors import InputError
from separatrix.study import StabilitySettings
from separatrix.units import Array, Joule, MetrePerSecond, Newton, PerSecond, Radian, Ratio, Second, Watt

MOST_SAMPLES = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class History:
    """One run, sampled.

    Positions and velocities are those seen in the frame that turns with the ball set.

    Attributes
    ----------
    time : ndarray
        Shape (time,) [s]; a run that grows without limit ends early, and a long flight is not sampled within.
    position, velocity : ndarray
        Geometric centre of the cage [m], and velocity of its centre of mass [m/s], shape (time, 2).
    rotation, rotation_rate : ndarray
        Of the cage against the ball set, shape (time,) [rad] and [rad/s].
    ball_lead, contact_force : ndarray
        Lead y of each ball [m], and force N with which the pocket pushes it forward [N], shape (time, ball).
    ball_speed : ndarray
        Speed u of each ball beyond its free orbit, shape (time, ball) [m/s].
    land_force : ndarray
        Normal force of the land, shape (time,) [N].
    kinetic_energy, spring_energy : ndarray
        Of the cage in the turning frame, and of the pockets' springs, shape (time,) [J].
    ball_energy : ndarray
        Of the balls with inertia, m_e u^2/2, shape (time,) [J]; 0 without.
    work : dict of str to ndarray
        Work done on the cage since the start by each of `SOURCES`, shape (time,) [J].
    outcome : RunOutcome
        Where the motion ends; the same as in an ensemble with this kick, seed and run.
    cause : Cause
        Why the run is unresolved, if it is.
    judged_from, judged_until : float
        The last part of the run, by which it was judged [s]; the history goes on to its duration.
    end_energy : float
        Mean kinetic energy in that part [J]; all that follow are as in the ensemble.
    growth_rate, drift_rate : float
        Half the logarithmic rate of the kinetic energy, and the growth rate of the mean offset [1/s].
    pocket_power, land_power : float
        Fed into the cage by friction in the pockets and on the land, in that part [W].
    rubbing_force, rubbing_speed : float
        Of the land, in that part [N] and [m/s].
    """

    time: Annotated[Array, "s", ("time",)]
    position: Annotated[Array, "m", ("time", "axis")]
    velocity: Annotated[Array, "m/s", ("time", "axis")]
    rotation: Annotated[Array, "rad", ("time",)]
    rotation_rate: Annotated[Array, "rad/s", ("time",)]
    ball_lead: Annotated[Array, "m", ("time", "ball")]
    ball_speed: Annotated[Array, "m/s", ("time", "ball")]
    contact_force: Annotated[Array, "N", ("time", "ball")]
    land_force: Annotated[Array, "N", ("time",)]
    kinetic_energy: Annotated[Array, "J", ("time",)]
    spring_energy: Annotated[Array, "J", ("time",)]
    ball_energy: Annotated[Array, "J", ("time",)]
    land_energy: Annotated[Array, "J", ("time",)]  # stored in the land's spring
    work: Annotated[dict[str, Array], "J", ("time",)]
    pocket_angle: Annotated[Array, "rad", ("ball",)]  # place of each pocket in the turning frame
    half_play: Annotated[Array, "m", ("ball",)]
    outcome: RunOutcome
    cause: Cause
    judged_from: Second
    judged_until: Second
    end_energy: Joule
    growth_rate: PerSecond
    drift_rate: PerSecond
    pocket_power: Watt
    land_power: Watt
    rubbing_force: Newton
    rubbing_speed: MetrePerSecond


def simulate(
    cage: PlanarCage,
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
    cage : PlanarCage
        The cage.
    kick, run, seed, duration, ball_scatter
        As in the ensemble: speed of the kick [m/s], number of the run, seed, length [s], scatter [-].
    samples : int
        Largest number of rows, evenly spaced; the memory is bounded by it.
    until : float, optional
        Time of the last row [s]; by default the duration, or the time up to which the run is judged.

    Raises
    ------
    InputError
        A setting is out of range.
    """
    settings = StabilitySettings(
        kicks=(kick,), runs=1, duration=duration, ball_scatter=ball_scatter, seed=seed
    )
    forward = turned_forward(cage)
    start = random_starts(forward, settings, run, 1)[0]
    lead, play, angles = start[1:].reshape(3, -1)
    history = follow(
        forward,
        kick=kick,
        direction=float(start[0]),
        ball_lead=lead,
        duration=duration,
        samples=samples,
        until=until,
        half_play=play,
        pocket_angle=angles,
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
        ball_lead=-other_way_round(history.ball_lead),
        ball_speed=-other_way_round(history.ball_speed),
        contact_force=-other_way_round(history.contact_force),
        pocket_angle=-other_way_round(history.pocket_angle),
        half_play=other_way_round(history.half_play),
    )


def follow(
    cage: PlanarCage,
    *,
    kick: MetrePerSecond,
    direction: Radian,
    ball_lead: Array,
    duration: Second,
    samples: int = 4000,
    half_play: Array | None = None,
    pocket_angle: Array | None = None,
    until: Second | None = None,
) -> History:
    """Follow the run that starts with this direction of the kick [rad] and these leads, shape (ball,) [m].

    Rows are spread over the duration, or as far as the run is judged; or over the time `until` [s].

    Raises
    ------
    InputError
        A setting is out of range.
    """
    if not 2 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"must lie between 2 and {MOST_SAMPLES} [-]", str(samples))
    lead = np.asarray(ball_lead, dtype=np.float64)
    play = np.full(cage.ball_count, cage.half_play) if half_play is None else half_play
    if lead.shape != (cage.ball_count,) or not np.all(np.abs(lead) <= play):
        rule = f"must be {cage.ball_count} numbers within the pocket clearance [m]"
        raise InputError("ball_lead", rule, f"{lead.tolist()}")
    settings = StabilitySettings(kicks=(kick,), runs=1, duration=duration)
    chosen(settings, None, None)
    check_length(duration, fastest_rate(cage))
    angles = np.array(cage.ball_angles) if pocket_angle is None else pocket_angle
    starts = np.concatenate([[direction], lead, play, angles])[np.newaxis]
    evidence = np.zeros(1, dtype_of(Evidence))
    hits = np.zeros((1, cage.ball_count), dtype=np.int64)
    run_rows(cage, duration, kick, starts, evidence, hits)
    length = until or max(duration, float(evidence["followed"][0]))
    rows = samples_for(samples, cage.ball_count)
    np.asarray(rows.row)["clock"] = np.linspace(0.0, length / time_unit(cage), samples)
    run_rows(cage, duration, kick, starts, evidence, hits, samples=rows)
    return _history(cage, rows, evidence[0], play, angles)


def _history(cage: PlanarCage, samples: Samples, evidence: np.void, play: Array, angles: Array) -> History:
    """Record of the rows that the kernel filled, back in SI units."""
    T, M, R, filled = time_unit(cage), cage.mass, cage.pitch_radius, int(evidence["rows"])
    row, work = np.asarray(samples.row)[:filled], np.asarray(samples.work)[:filled]
    velocity, rate = np.stack([row["vx"], row["vy"]], axis=1) / T, row["vs"] / (R * T)
    energy, force, speed = M / T**2, M / T**2, samples.speed[:filled] / T
    ball_mass = 0.0 if cage.traction is None else cage.traction.mass
    shared = ("end_energy", "growth_rate", "drift_rate", "pocket_power", "land_power", "rubbing_force")
    return History(
        time=row["clock"] * T,
        position=np.stack([row["x"], row["y"]], axis=1),
        velocity=velocity,
        rotation=row["s"] / R,
        rotation_rate=rate,
        ball_lead=samples.lead[:filled].copy(),
        ball_speed=speed,
        contact_force=samples.force[:filled] * force,
        land_force=row["land_force"] * force,
        kinetic_energy=0.5 * (M * (velocity**2).sum(axis=1) + cage.moment_of_inertia * rate**2),
        spring_energy=row["pocket_energy"] * energy,
        ball_energy=0.5 * ball_mass * (speed**2).sum(axis=1),
        land_energy=row["land_energy"] * energy,
        work={name: work[name] * energy for name in SOURCES},
        pocket_angle=angles,
        half_play=play,
        outcome=RunOutcome(int(evidence["outcome"])),
        cause=Cause(int(evidence["cause"])),
        judged_from=float(evidence["judged_from"]),
        judged_until=float(evidence["followed"]),
        rubbing_speed=float(evidence["rubbing_speed"]),
        **{name: float(evidence[name]) for name in shared},
    )
