"""The course of one run in space: orbit, tilt, axial motion, balls, forces and energies against time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np

from separatrix.cage.closed_forms import moving_mass, time_unit
from separatrix.cage.ending import run_limits
from separatrix.cage.ensemble import check_length
from separatrix.cage.history import MOST_SAMPLES
from separatrix.cage.planar import Cause, RunOutcome
from separatrix.cage.records import dtype_of
from separatrix.cage.space.ensemble import (
    kick_speeds,
    random_starts,
    run_rows,
    turned_forward_in_space,
)
from separatrix.cage.space.inputs import fastest_in_space, land_strips, numbers, parts_of
from separatrix.cage.space.records import (
    SpaceEvidence,
    Works,
    body_of,
    books_for,
)
from separatrix.cage.space.run import FIRST_LEAD, follow_run
from separatrix.cage.space_body import pocket_plays, wall_margin
from separatrix.errors import InputError
from separatrix.pocket_shape import PocketShape
from separatrix.study import StabilitySettings
from separatrix.units import Array, Joule, MetrePerSecond, Newton, PerSecond, Ratio, Second, Watt

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from separatrix.cage.planar import PlanarCage

SOURCES = tuple(name for name in Works.__annotations__ if name != "gross")
MOTIONS = 14
"""Columns of a row before the work: motion, kinetic and held energy."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpaceHistory:
    """One run in space, sampled, seen in the frame that turns with the ball set.

    A bearing that turns backward is shown as its mirror image, as it is run. Forces and work are samples and
    sums over the whole history; extremes of forces, impacts and rubbing are those of the engine's steps, none
    of which falls between two samples.

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
    centre, centre_velocity : ndarray
        Geometric centre of the cage across the axis, shape (time, across) [m], [m/s]: of position without
        unbalance.
    lean, lean_rate : ndarray
        Where its geometric axis leans to: the way of a point on it over its height, shape (time, across)
        [rad], [rad/s].
    ball_lead, ball_axial : ndarray
        Lead of each ball, and its place along the groove, shape (time, ball) [m].
    contact_force, contact_angle : ndarray
        Force of each pocket on its ball [N]; where on the ball it acts: 0 in front of it, 90 deg along the
        axis, 0 without force, shape (time, ball) [rad].
    contact_tilt : ndarray
        How far that place is outward of the ball's equator, where an edge of the pocket touches; 0 at a wall,
        shape (time, ball) [rad].
    land_force : ndarray
        Normal force of every strip of the lands, shape (time, strip) [N].
    strip_height : ndarray
        Where they are over the pockets, shape (strip,) [m].
    kinetic_energy, stored_energy : ndarray
        Of the cage in the turning frame; of springs and of balls that move, shape (time,) [J].
    work : dict of str to ndarray
        Work done since the start by each of `SOURCES`, shape (time,) [J].
    half_play : ndarray
        Half the clearance along the orbit that each pocket has, shape (ball,) [m].
    pocket_impacts, pocket_rubbing : ndarray
        Impacts of each pocket, and its force times sliding speed over time, shape (ball,) [-], [J].
    land_impacts, land_impulse, land_rubbing : float
        Impacts of the strips of the lands, the integral of their force, and of that times the sliding speed.
    largest_contact_force, largest_land_force : float
        Of a pocket, and of a strip of a land [N].
    outcome, cause, end_energy, growth_rate, drift_rate, pocket_power, land_power, energy_imbalance
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
    centre: Annotated[Array, "m", ("time", "across")]
    centre_velocity: Annotated[Array, "m/s", ("time", "across")]
    lean: Annotated[Array, "rad", ("time", "across")]
    lean_rate: Annotated[Array, "rad/s", ("time", "across")]
    ball_lead: Annotated[Array, "m", ("time", "ball")]
    ball_axial: Annotated[Array, "m", ("time", "ball")]
    contact_force: Annotated[Array, "N", ("time", "ball")]
    contact_angle: Annotated[Array, "rad", ("time", "ball")]
    contact_tilt: Annotated[Array, "rad", ("time", "ball")]
    land_force: Annotated[Array, "N", ("time", "strip")]
    strip_height: Annotated[Array, "m", ("strip",)]
    kinetic_energy: Annotated[Array, "J", ("time",)]
    stored_energy: Annotated[Array, "J", ("time",)]
    work: Annotated[dict[str, Array], "J", ("time",)]
    pocket_angle: Annotated[Array, "rad", ("ball",)]  # place of each pocket in the turning frame
    half_play: Annotated[Array, "m", ("ball",)]
    pocket_impacts: Annotated[Array, "-", ("ball",)]
    pocket_rubbing: Annotated[Array, "J", ("ball",)]
    land_impacts: int
    land_impulse: Annotated[float, "N s"]
    land_rubbing: Joule
    largest_contact_force: Newton
    largest_land_force: Newton
    outcome: RunOutcome
    cause: Cause
    judged_from: Second
    judged_until: Second
    end_energy: Joule
    growth_rate: PerSecond
    drift_rate: PerSecond
    pocket_power: Watt
    land_power: Watt
    energy_imbalance: Ratio


FROM_ENSEMBLE = (
    *("end_energy", "growth_rate", "drift_rate", "pocket_power", "land_power"),
    "energy_imbalance",
)
"""Numbers of the ensemble's run that its history has, too."""


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
    Of a run that grows without limit all samples are before that.

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
    check_length(duration, fastest_in_space(cage))
    starts = random_starts(cage, settings, run, 1)
    evidence = np.zeros(1, dtype_of(SpaceEvidence))
    hits, heat = np.zeros((1, cage.ball_count), np.int64), np.zeros((1, cage.ball_count))
    run_rows(cage, settings, kick, starts, evidence, hits, heat)
    length = until or max(duration, float(evidence["followed"][0]))
    found = _followed(cage, kick, starts[0], np.linspace(0.0, length, samples), duration)
    if (
        until is None and 2 <= found.time.size < samples // 2
    ):  # it grew without limit: all rows for its course
        times = np.linspace(0.0, float(found.time[-1]), samples)
        found = _followed(cage, kick, starts[0], times, duration)
    return _history(cage, starts[0], found, evidence[0])


class Followed(NamedTuple):
    """What the kernel filled and counted, in its units."""

    time: Array
    rows: Array
    look: np.void
    hits: NDArray[np.int64]
    heat: Array


def row_length(cage: PlanarCage) -> int:
    """Numbers in a row of `follow_run`."""
    edges = 4 if wall_margin(cage, body_of(cage)) < np.inf else 0
    return MOTIONS + len(SOURCES) + (2 + edges) * cage.ball_count + land_strips(cage)[0].size


def _followed(
    cage: PlanarCage, kick: MetrePerSecond, start: Array, times: Array, duration: Second
) -> Followed:
    """Follow a run from its start to times [s], or until it grows without limit."""
    rows, books = np.zeros((times.size, row_length(cage))), books_for(1)
    hits, heat = np.zeros(cage.ball_count, np.int64), np.zeros(cage.ball_count)
    filled = follow_run(
        numbers(cage, kick),
        parts_of(cage),
        start,
        kick_speeds(cage, kick),
        cage.pocket_axial_offset,
        books,
        times / time_unit(cage),
        run_limits(cage, kick, duration).grown,
        rows,
        hits,
        heat,
    )
    return Followed(times[:filled], rows[:filled], np.asarray(books.looks)[0], hits, heat)


def _history(cage: PlanarCage, start: Array, found: Followed, evidence: np.void) -> SpaceHistory:
    """Record of the rows that the kernel filled and of what it counted, back in SI units."""
    T, R, Z, M = time_unit(cage), cage.pitch_radius, cage.ball_count, moving_mass(cage)
    energy, at, (times, rows, look, hits, heat) = M / T**2, MOTIONS + len(SOURCES), found
    counted = {name: float(evidence[name]) for name in FROM_ENSEMBLE}
    counted["land_impulse"] = float(look["pressed"]) * M / T
    forces = {
        "land_rubbing": "rubbed",
        "largest_contact_force": "force_max",
        "largest_land_force": "land_max",
    }
    counted |= {name: float(look[key]) * energy for name, key in forces.items()}
    lead, axial = rows[:, at : at + Z], rows[:, at + Z : at + 2 * Z]
    more, angles = start[FIRST_LEAD + Z : FIRST_LEAD + 2 * Z], start[FIRST_LEAD + 2 * Z :]
    force, angle, tilt = contact_forces(cage, rows, lead, axial, more, angles)
    place, rate = geometric(cage, rows)
    return SpaceHistory(
        time=times,
        position=rows[:, :3].copy(),
        velocity=rows[:, 6:9] / T,
        tilt=rows[:, 4:6] / R,
        tilt_rate=rows[:, 10:12] / (R * T),
        rotation=rows[:, 3] / R,
        rotation_rate=rows[:, 9] / (R * T),
        centre=place[:, :2].copy(),
        centre_velocity=rate[:, :2] / T,
        lean=np.stack([place[:, 3], -place[:, 2]], axis=1) / R,
        lean_rate=np.stack([rate[:, 3], -rate[:, 2]], axis=1) / (R * T),
        ball_lead=lead.copy(),
        ball_axial=axial.copy(),
        contact_force=force,
        contact_angle=angle,
        contact_tilt=tilt,
        land_force=rows[:, at + 2 * Z : at + 2 * Z + land_strips(cage)[0].size] * energy,
        strip_height=land_strips(cage)[0],
        kinetic_energy=rows[:, 12] * energy,
        stored_energy=rows[:, 13] * energy,
        work={name: rows[:, MOTIONS + i] * energy for i, name in enumerate(SOURCES)},
        pocket_angle=angles,
        half_play=cage.half_play + more,
        pocket_impacts=hits.astype(np.float64),
        pocket_rubbing=heat * energy,
        land_impacts=int(look["land_hits"]),
        outcome=RunOutcome(int(evidence["outcome"])),
        cause=Cause(int(evidence["cause"])),
        judged_from=float(evidence["judged_from"]),
        judged_until=float(evidence["followed"]),
        **counted,
    )


def geometric(cage: PlanarCage, rows: Array) -> tuple[Array, Array]:
    """Geometric centre and tilt of the cage, and their rates: x, y, a and b of each row, shape (time, 4)."""
    body, R = body_of(cage), cage.pitch_radius
    e, lean = cage.unbalance / moving_mass(cage), body.dynamic_unbalance * R
    cos, sin, turn = np.cos(rows[:, 3] / R), np.sin(rows[:, 3] / R), rows[:, 9] / R
    away = np.stack([-e * cos, -e * sin, lean * sin, -lean * cos], axis=1)
    rate = np.stack([e * sin * turn, -e * cos * turn, lean * cos * turn, lean * sin * turn], axis=1)
    columns = [0, 1, 4, 5]
    return rows[:, columns] + away, rows[:, [c + 6 for c in columns]] + rate


def contact_forces(
    cage: PlanarCage, rows: Array, lead: Array, axial: Array, more: Array, angles: Array
) -> tuple[Array, Array, Array]:
    """Force of each pocket on its ball [N], its angle on the ball and its tilt [rad], shape (time, ball)."""
    body = body_of(cage)
    around, apart, beside = pocket_plays(cage, body)
    cos, sin = np.cos(angles), np.sin(angles)
    x, y, a, b = (column[:, np.newaxis] for column in geometric(cage, rows)[0].T)
    z, s = rows[:, [2]], rows[:, [3]]
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
    force, angle = cage.ball_cage_stiffness * np.hypot(t, w), np.arctan2(-w, -t) * (np.hypot(t, w) > 0.0)
    edges = rows[:, MOTIONS + len(SOURCES) + 2 * lead.shape[1] + land_strips(cage)[0].size :]
    if edges.size == 0:
        return force, angle, np.zeros_like(force)
    push, axial, outward, along = np.split(edges, 4, axis=1)
    unit = moving_mass(cage) / time_unit(cage) ** 2
    pressed, near = push > 0.0, push >= 0.0
    angle = np.where(near, np.arctan2(axial, along) * pressed, angle)
    return np.where(near, push * unit, force), angle, np.arcsin(outward) * pressed
