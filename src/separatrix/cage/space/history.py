"""The course of one run in space: orbit, tilt, axial motion, balls, forces and energies against time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from separatrix.cage.closed_forms import time_unit
from separatrix.cage.ending import run_limits
from separatrix.cage.history import MOST_SAMPLES
from separatrix.cage.planar import Cause, RunOutcome
from separatrix.cage.records import dtype_of
from separatrix.cage.space.ensemble import (
    check_length,
    kick_speeds,
    random_starts,
    run_rows,
    turned_forward_in_space,
)
from separatrix.cage.space.records import (
    SpaceEvidence,
    Works,
    body_of,
    books_for,
    land_strips,
    numbers,
    parts_of,
)
from separatrix.cage.space.run import FIRST_LEAD, follow_run
from separatrix.cage.space_body import pocket_plays
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape
from separatrix.study import StabilitySettings
from separatrix.units import Array, MetrePerSecond, Ratio, Second

if TYPE_CHECKING:
    from separatrix.cage.planar import PlanarCage

SOURCES = tuple(name for name in Works.__annotations__ if name != "gross")
MOTIONS = 14
"""Columns of a row before the work: motion, kinetic and held energy."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpaceHistory:
    """One run in space, sampled, seen in the frame that turns with the ball set.

    A bearing that turns backward is shown as its mirror image, as it is run.

    Attributes
    ----------
    time : ndarray
        Shape (time,) [s]; a run that grows without limit ends early.
    position, velocity : ndarray
        Centre of mass of the cage across and along the bearing axis, shape (time, axis) [m], [m/s].
    tilt, tilt_rate : ndarray
        Rotation about the axes x and y of the plane, shape (time, tilt_axis) [rad], [rad/s]; the cage's axis
        leans towards (tilt_y, -tilt_x).
    rotation, rotation_rate : ndarray
        Of the cage against the ball set, shape (time,) [rad] and [rad/s].
    ball_lead, ball_axial : ndarray
        Lead of each ball, and its place along the groove, shape (time, ball) [m].
    contact_force, contact_angle : ndarray
        Force of each pocket on its ball [N]; where on the ball it acts: 0 in front of it, 90 deg along the
        axis, 0 without force, shape (time, ball) [rad].
    land_force : ndarray
        Normal force of every strip of the lands, shape (time, strip) [N].
    strip_height : ndarray
        Where they are over the pockets, shape (strip,) [m].
    kinetic_energy, stored_energy : ndarray
        Of the cage in the turning frame; of springs and of balls that move, shape (time,) [J].
    work : dict of str to ndarray
        Work done since the start by each of `SOURCES`, shape (time,) [J].
    outcome, cause
        As in the ensemble.
    judged_from, judged_until : float
        The last part of the run, by which it was judged [s].
    """

    time: Annotated[Array, "s", ("time",)]
    position: Annotated[Array, "m", ("time", "axis")]
    velocity: Annotated[Array, "m/s", ("time", "axis")]
    tilt: Annotated[Array, "rad", ("time", "tilt_axis")]
    tilt_rate: Annotated[Array, "rad/s", ("time", "tilt_axis")]
    rotation: Annotated[Array, "rad", ("time",)]
    rotation_rate: Annotated[Array, "rad/s", ("time",)]
    ball_lead: Annotated[Array, "m", ("time", "ball")]
    ball_axial: Annotated[Array, "m", ("time", "ball")]
    contact_force: Annotated[Array, "N", ("time", "ball")]
    contact_angle: Annotated[Array, "rad", ("time", "ball")]
    land_force: Annotated[Array, "N", ("time", "strip")]
    strip_height: Annotated[Array, "m", ("strip",)]
    kinetic_energy: Annotated[Array, "J", ("time",)]
    stored_energy: Annotated[Array, "J", ("time",)]
    work: Annotated[dict[str, Array], "J", ("time",)]
    pocket_angle: Annotated[Array, "rad", ("ball",)]
    outcome: RunOutcome
    cause: Cause
    judged_from: Second
    judged_until: Second


def simulate_in_space(
    cage: PlanarCage,
    *,
    kick: MetrePerSecond,
    run: int = 0,
    seed: int = 1,
    duration: Second = 0.3,
    ball_scatter: Ratio = 0.3,
    samples: int = 4000,
    until: Second | None = None,
) -> SpaceHistory:
    """Follow one run of the ensemble in space.

    Sampling ends steps, so that a chaotic motion may part from that of the ensemble after some cage turns.

    Parameters
    ----------
    cage : PlanarCage
        The cage, with its `space`.
    kick, run, seed, duration, ball_scatter, samples, until
        As in `cage.history.simulate`.

    Raises
    ------
    InputError
        A setting is out of range, or the cage has no body in space.
    """
    if not 2 <= samples <= MOST_SAMPLES:
        raise InputError("samples", f"must lie between 2 and {MOST_SAMPLES} [-]", str(samples))
    settings = StabilitySettings(
        kicks=(kick,), runs=1, duration=duration, ball_scatter=ball_scatter, seed=seed
    )
    cage = turned_forward_in_space(cage)
    check_length(cage, duration)
    starts = random_starts(cage, settings, run, 1)
    evidence = np.zeros(1, dtype_of(SpaceEvidence))
    hits, heat = np.zeros((1, cage.ball_count), np.int64), np.zeros((1, cage.ball_count))
    run_rows(cage, settings, kick, starts, evidence, hits, heat)
    length = until or max(duration, float(evidence["followed"][0]))
    unit, limits = time_unit(cage), run_limits(cage, kick, duration)
    times = np.linspace(0.0, length, samples)
    rows = np.zeros((samples, MOTIONS + len(SOURCES) + 2 * cage.ball_count + land_strips(cage)[0].size))
    filled = follow_run(
        numbers(cage, kick),
        parts_of(cage),
        starts[0],
        kick_speeds(cage, kick),
        cage.pocket_axial_offset,
        books_for(1),
        times / unit,
        limits.grown,
        rows,
        hits[0],
        heat[0],
    )
    return _history(cage, starts[0], times[:filled], rows[:filled], evidence[0])


def _history(cage: PlanarCage, start: Array, times: Array, rows: Array, evidence: np.void) -> SpaceHistory:
    """Record of the rows that the kernel filled, back in SI units."""
    T, R, Z, M = time_unit(cage), cage.pitch_radius, cage.ball_count, cage.mass + body_of(cage).added_mass
    energy, at = M / T**2, MOTIONS + len(SOURCES)
    lead, axial = rows[:, at : at + Z], rows[:, at + Z : at + 2 * Z]
    more, angles = start[FIRST_LEAD + Z : FIRST_LEAD + 2 * Z], start[FIRST_LEAD + 2 * Z :]
    force, angle = contact_forces(cage, rows, lead, axial, more, angles)
    return SpaceHistory(
        time=times,
        position=rows[:, :3].copy(),
        velocity=rows[:, 6:9] / T,
        tilt=rows[:, 4:6] / R,
        tilt_rate=rows[:, 10:12] / (R * T),
        rotation=rows[:, 3] / R,
        rotation_rate=rows[:, 9] / (R * T),
        ball_lead=lead.copy(),
        ball_axial=axial.copy(),
        contact_force=force,
        contact_angle=angle,
        land_force=rows[:, at + 2 * Z :] * energy,
        strip_height=land_strips(cage)[0],
        kinetic_energy=rows[:, 12] * energy,
        stored_energy=rows[:, 13] * energy,
        work={name: rows[:, MOTIONS + i] * energy for i, name in enumerate(SOURCES)},
        pocket_angle=angles,
        outcome=RunOutcome(int(evidence["outcome"])),
        cause=Cause(int(evidence["cause"])),
        judged_from=float(evidence["judged_from"]),
        judged_until=float(evidence["followed"]),
    )


def contact_forces(
    cage: PlanarCage, rows: Array, lead: Array, axial: Array, more: Array, angles: Array
) -> tuple[Array, Array]:
    """Force of each pocket on its ball [N], and its angle on the ball [rad], both shape (time, ball)."""
    body, R = body_of(cage), cage.pitch_radius
    around, apart, beside = pocket_plays(cage, body)
    cos, sin = np.cos(angles), np.sin(angles)
    x, y, z, s, a, b = (rows[:, [i]] for i in range(6))
    e, lean = cage.unbalance / (cage.mass + body.added_mass), body.dynamic_unbalance * R
    x, y = x - e * np.cos(s / R), y - e * np.sin(s / R)
    a, b = a + lean * np.sin(s / R), b - lean * np.cos(s / R)
    along = y * cos - x * sin + s - lead
    across = z - (b * cos - a * sin) - axial
    if cage.pocket_shape is PocketShape.SQUARE:
        t = np.sign(along) * np.maximum(0.0, np.abs(along) - around - more)
        w = np.sign(across) * np.maximum(0.0, np.abs(across) - beside)
        t = along if around == 0.0 else t
    else:
        t = np.sign(along) * np.maximum(0.0, np.abs(along) - apart)
        far = np.hypot(t, across)
        share = np.maximum(0.0, far - around - more) / np.where(far > 0.0, far, 1.0)
        t, w = t * share, across * share
    return cage.ball_cage_stiffness * np.hypot(t, w), np.arctan2(-w, -t) * (np.hypot(t, w) > 0.0)
