r"""The hard-impact form: pockets are walls, and an impact is over at once.

The normal velocity is reversed times eta and the friction impulse is f times the normal one, along
-sigma N e_r; between impacts the cage flies freely, in the turning frame. Without a land: pockets only. The
balls keep their places.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from separatrix.cage.closed_forms import felt_mass, impact_restitution
from separatrix.cage.ending import GROWN, energy_scale
from separatrix.cage.ensemble import Ensemble, chosen, gathered, random_starts, settings_for, spread
from separatrix.cage.planar import Cause, PlanarCage, RunOutcome, turned_forward
from separatrix.cage.records import Evidence, dtype_of, records
from separatrix.compiled import kernel, part
from separatrix.errors import InputError
from separatrix.units import Array

if TYPE_CHECKING:
    from separatrix.study import StabilitySettings
    from separatrix.units import MetrePerSecond, Ratio

MOST_IMPACTS = 2_000_000
STALL = 1_000
"""This number of events, each within a billionth of the run of the one before, is an inelastic collapse."""

STILL = 1e-12
"""Share of the cage's speed at which a pocket slides along its ball instead of striking it."""

CHUNK_RUNS = 8
UNKNOWN = -1
SETTLES, WHIRLS, DRIFTS, UNRESOLVED = (int(outcome) for outcome in RunOutcome)
IMPACTS = int(Cause.IMPACTS)


class Walls(NamedTuple):
    """Numbers of the cage and the ensemble as the kernels want them, in SI units."""

    mass: float
    inertia: float
    radius: float
    turning: float
    stiffness: float
    half_play: float
    friction: float  # sigma f
    struck: float  # mass that an impact feels
    restitution: float
    duration: float


class Flight:
    """State of a run, and what is noted of it."""

    x: float
    y: float
    vx: float
    vy: float
    theta: float
    spin: float
    time: float
    work: float  # of impacts, friction and frame, and the sum of the magnitudes
    done: float
    far: float  # largest squared offset
    late_energy: float  # integral over the last fifth
    swept: float  # integrals of r x v and r^2, twice
    area: float
    peak: float  # largest force of an undamped spring


@part
def fly(p: Walls, s: Flight, dt: float) -> None:
    """Advance the free motion exactly: a line in space, seen in the turning frame."""
    W = p.turning
    c, i = np.cos(W * dt), np.sin(W * dt)
    ux, uy = s.vx - W * s.y, s.vy + W * s.x
    x, y = s.x + ux * dt, s.y + uy * dt
    s.x, s.y = c * x + i * y, c * y - i * x
    s.vx = c * ux + i * uy + W * s.y
    s.vy = c * uy - i * ux - W * s.x
    s.theta += s.spin * dt


@part
def energy_of(p: Walls, s: Flight) -> float:
    """Kinetic energy in the turning frame [J]."""
    return 0.5 * (p.mass * (s.vx**2 + s.vy**2) + p.inertia * s.spin**2)


@part
def next_impact(
    p: Walls, cos: Array, sin: Array, lead: Array, s: Flight, longest: float
) -> tuple[float, int, float]:
    """Time in which no wall is passed, and the ball and side that may be reached then.

    From the gap g, the speed u towards the wall and a bound A on the acceleration that the frame gives:
    t = 2 g/(u + sqrt(u^2 + 2 A g)), exact for A = 0. Ball -1: none within the longest time.
    """
    W = abs(p.turning)
    vx, vy = s.vx - p.turning * s.y, s.vy + p.turning * s.x
    straight = np.sqrt(vx * vx + vy * vy)
    rim = np.sqrt(s.x * s.x + s.y * s.y) + straight * longest
    bound = 2.0 * W * (straight + W * rim) + W * W * rim
    still = STILL * np.sqrt(2.0 * energy_of(p, s) / p.mass)
    first, ball, side = longest, -1, 1.0
    for j in range(cos.size):
        u = s.y * cos[j] - s.x * sin[j] + p.radius * s.theta - lead[j]
        rate = s.vy * cos[j] - s.vx * sin[j] + p.radius * s.spin
        for sign in (1.0, -1.0):
            gap, speed = max(p.half_play - sign * u, 0.0), sign * rate
            if bound == 0.0 and speed <= still:
                continue
            reach = speed + np.sqrt(speed * speed + 2.0 * bound * gap)
            if reach > 0.0 and 2.0 * gap < first * reach:
                first, ball, side = 2.0 * gap / reach, j, sign
    return first, ball, side


@part
def coast(p: Walls, s: Flight, dt: float) -> None:
    """Fly freely for a time, and note the frame's work and the energy in the last fifth of the run."""
    before, swept, far = energy_of(p, s), s.x * s.vy - s.y * s.vx, s.x * s.x + s.y * s.y
    fly(p, s, dt)
    s.time += dt
    farther = s.x * s.x + s.y * s.y
    work = 0.5 * p.mass * p.turning * p.turning * (farther - far)
    s.work += work
    s.done += abs(work)
    s.far = max(s.far, farther)
    part = 0.5 * max(0.0, s.time - max(0.8 * p.duration, s.time - dt))
    s.late_energy += part * (before + energy_of(p, s))
    s.swept += dt * (swept + s.x * s.vy - s.y * s.vx)
    s.area += dt * (far + farther)


@part
def impact(p: Walls, c: float, i: float, s: Flight, side: float) -> None:
    """Impact of the ball in direction (c, i), if its pocket comes at it, and note its work."""
    before = energy_of(p, s)
    speed = side * (s.vy * c - s.vx * i + p.radius * s.spin)
    if speed <= STILL * np.sqrt(2.0 * before / p.mass):
        return
    # impulse (1 + eta) m u, and sigma f of it across
    impulse = side * (1.0 + p.restitution) * p.struck * speed
    push = p.friction * impulse
    s.vx += (impulse * i - push * c) / p.mass
    s.vy -= (impulse * c + push * i) / p.mass
    s.spin -= impulse * p.radius / p.inertia
    # Normal part: the felt mass goes on with eta times the speed; friction: impulse times the mean radial
    # speed.
    radial = s.vx * c + s.vy * i + 0.5 * push / p.mass
    normal = -0.5 * p.struck * speed * speed * (1.0 - p.restitution * p.restitution)
    s.work += normal - push * radial
    s.done += abs(normal) + abs(push * radial)
    s.peak = max(s.peak, speed * np.sqrt(p.stiffness * p.struck))


@part
def go(p: Walls, cos: Array, sin: Array, lead: Array, s: Flight, grown: float) -> int:
    """Go from impact to impact until the time is over, the energy has grown, or impacts come in no time."""
    horizon = p.duration if p.turning == 0.0 else min(p.duration, 0.1 / abs(p.turning))
    idle = 0
    for _ in range(MOST_IMPACTS):
        dt, ball, side = next_impact(p, cos, sin, lead, s, min(horizon, p.duration - s.time))
        coast(p, s, dt)
        if s.time >= p.duration:
            return UNKNOWN
        idle = idle + 1 if dt < 1e-9 * p.duration else 0
        if idle > STALL:
            return UNRESOLVED
        if ball >= 0:
            u = s.y * cos[ball] - s.x * sin[ball] + p.radius * s.theta - lead[ball]
            if p.half_play - side * u <= 1e-10 * p.half_play:
                impact(p, cos[ball], sin[ball], s, side)
        if energy_of(p, s) > grown:
            return WHIRLS
    return UNRESOLVED


@kernel
def hard_chunk(
    p: Walls, cos: Array, sin: Array, starts: Array, kick: float, grown: float, flights: Sequence[Flight],
    evidence: Sequence[Evidence],
) -> None:  # fmt: skip
    """Run from every row of `starts`, as in `run_chunk`; the state of each run in `flights` is zero."""
    for i in range(starts.shape[0]):
        s, out = flights[i], evidence[i]
        s.vx, s.vy = kick * np.cos(starts[i, 0]), kick * np.sin(starts[i, 0])
        start = energy_of(p, s)
        outcome = go(p, cos, sin, starts[i, 1 : 1 + cos.size], s, grown)
        late = s.time - 0.8 * p.duration
        out.end_energy = s.late_energy / late if late > 0.0 else energy_of(p, s)
        growth = out.end_energy / start  # walls have no scale of energy: what has grown goes on growing
        out.largest_offset = np.sqrt(s.far)
        out.growth_rate = 0.5 * np.log(growth) / (0.9 * p.duration if late > 0.0 else s.time)
        if outcome == UNKNOWN:
            settled = DRIFTS if out.largest_offset > 2.0 * p.half_play else SETTLES
            outcome = WHIRLS if growth > 1.0 else settled
        whirl = s.swept / s.area if s.area > 0.0 else 0.0
        out.outcome, out.cause = outcome, IMPACTS if outcome == UNRESOLVED else 0
        out.whirl_frequency, out.whirl_direction = abs(whirl) / (2.0 * np.pi), int(np.sign(whirl))
        out.largest_contact_force = s.peak
        out.energy_imbalance = abs(energy_of(p, s) - start - s.work) / (s.done + start)


def run_hard_ensemble(
    cage: PlanarCage,
    settings: StabilitySettings,
    *,
    kicks: Sequence[MetrePerSecond] | None = None,
    runs: int | None = None,
    first_run: int = 0,
    jobs: int = 1,
    restitution: Ratio | None = None,
    may_turn: bool = True,
) -> Ensemble:
    """Run the cage from every kick and seed with instantaneous impacts.

    Parameters
    ----------
    cage : PlanarCage
        The cage; it must have clearance and neither land, gravity nor unbalance. Its race damping gives the
        restitution.
    settings, kicks, runs, first_run, jobs
        As in `run_ensemble`, and the same starts.
    restitution : float, optional
        Of an impact [-]; default: `impact_restitution`, from the mass that the impact feels.
    may_turn : bool
        False fixes the cage's rotation to that of the ball set.

    Returns
    -------
    Ensemble
        With the force that an undamped spring would reach at each impact, the whirl as the mean turning rate
        of the offset, and no drift rate. Runs that meet too many events in no time are UNRESOLVED.

    Raises
    ------
    InputError
        The cage has a land, gravity, unbalance or no clearance, or the ensemble is empty.
    """
    _refuse(cage)
    cage = turned_forward(cage)
    speeds, runs = chosen(settings_for(settings, cage), kicks, runs)
    p = walls(cage, restitution=restitution, may_turn=may_turn, duration=settings.duration)
    angles, starts = np.array(cage.ball_angles), random_starts(cage, settings, first_run, runs)
    directions = np.cos(angles), np.sin(angles)
    evidence = np.zeros((speeds.size, runs), dtype_of(Evidence))

    def work(i: int, rows: slice) -> None:
        flights, out = records(Flight, len(starts[rows])), cast("Sequence[Evidence]", evidence[i, rows])
        grown = GROWN * energy_scale(cage, speeds[i])
        hard_chunk(p, *directions, starts[rows], speeds[i], grown, flights, out)

    spread(work, speeds.size, runs, CHUNK_RUNS, jobs)
    hits = np.zeros((speeds.size, runs, cage.ball_count), dtype=np.int64)
    return gathered(speeds, evidence, hits, settings.duration)


def walls(cage: PlanarCage, *, restitution: Ratio | None, may_turn: bool, duration: float) -> Walls:
    """Numbers of a cage and its runs; without a restitution that of its race damping."""
    return Walls(
        mass=cage.mass,
        inertia=cage.moment_of_inertia,
        radius=cage.pitch_radius if may_turn else 0.0,
        turning=cage.cage_speed,
        stiffness=cage.ball_cage_stiffness,
        half_play=cage.half_play,
        friction=cage.friction_sense * cage.ball_cage_friction,
        struck=felt_mass(cage, may_turn=may_turn),
        restitution=impact_restitution(cage, may_turn=may_turn)
        if restitution is None
        else float(restitution),
        duration=duration,
    )


def _refuse(cage: PlanarCage) -> None:
    """Refuse what the hard form leaves out."""
    cure = "Use run_ensemble, which has lands, gravity, unbalance and pockets without clearance."
    if not math.isinf(cage.land_gap):
        raise InputError("PlanarCage.guidance", "must be ball in the hard-impact form", "", cure)
    if cage.gravity > 0 or cage.unbalance > 0:
        rule = "must be free of gravity and unbalance in the hard-impact form"
        raise InputError("PlanarCage", rule, cure=cure)
    if cage.half_play <= 0:
        raise InputError("PlanarCage.pocket_clearance", "must be > 0 in the hard-impact form [m]", "0", cure)
