r"""The hard-impact form: pockets are walls, and an impact is over at once.

The normal velocity is reversed times eta and the friction impulse is f times the normal one, along
-sigma N e_r; between impacts the cage flies freely, in the turning frame. Landless: pockets only. The balls
hold their places.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from separatrix.cage import slots
from separatrix.cage.ending import GROWN, energy_scale
from separatrix.cage.ensemble import (
    Ensemble,
    chosen,
    gathered,
    random_starts,
    spread,
)
from separatrix.cage.kicks import settings_for
from separatrix.cage.planar import Cause, PlanarCage, RunOutcome, turned_forward
from separatrix.cage.slots import (
    CAUSE,
    DIRECTION,
    END_ENERGY,
    FORCE,
    GROWTH_RATE,
    IMBALANCE,
    LARGEST_OFFSET,
    OUTCOME,
    WHIRL,
)
from separatrix.compiled import kernel
from separatrix.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from separatrix.study import StabilitySettings
    from separatrix.units import MetrePerSecond, Ratio

MOST_BLOWS = 2_000_000
STALL = 1_000
"""So many events in a billionth of the run each, one after the other, are an inelastic collapse."""

STILL = 1e-12
"""Share of the cage's speed at which a pocket slides along its ball instead of striking it."""

CHUNK_RUNS = 8
X, Y, VX, VY, THETA, SPIN = range(6)
TIME, WORK, DONE, FAR, LATE_ENERGY, SWEPT, AREA, PEAK = range(8)
NOTES = 8
UNKNOWN = -1
SETTLES, WHIRLS, DRIFTS, UNRESOLVED = (int(outcome) for outcome in RunOutcome)
IMPACTS = int(Cause.IMPACTS)


class Walls(NamedTuple):
    """Numbers of the cage as the kernels want them, in SI units."""

    mass: float
    inertia: float
    radius: float
    turning: float
    stiffness: float
    half_play: float
    friction: float  # sigma f


def felt_mass(cage: PlanarCage, *, may_turn: bool = True) -> float:
    """Mass that an impact feels: M, or 1/(1/M + R^2/J) where the cage may turn, M/2 for a thin ring [kg]."""
    turning = cage.pitch_radius**2 / cage.moment_of_inertia if may_turn else 0.0
    return 1.0 / (1.0 / cage.mass + turning)


def impact_restitution(cage: PlanarCage, *, may_turn: bool = True) -> Ratio:
    r"""Restitution of an impact of the series spring and damper on the mass that it feels [-].

    :math:`\eta = \exp(-\pi\zeta/\sqrt{1-\zeta^2})` with :math:`\zeta = \sqrt{km}/2C_\mu`, 0 from :math:`\zeta
    = 1`. The nominal eta has m = M; a thin ring that may turn returns more: 0.928 for 0.90, 0.698 for 0.60.
    """
    m = felt_mass(cage, may_turn=may_turn)
    zeta = math.sqrt(cage.ball_cage_stiffness * m) / (2.0 * cage.race_damping)
    return math.exp(-math.pi * zeta / math.sqrt((1.0 - zeta) * (1.0 + zeta))) if zeta < 1.0 else 0.0


@kernel
def fly(p, s, dt):  # type: ignore[no-untyped-def]
    """Advance the free motion exactly: a line in space, seen in the turning frame."""
    W = p.turning
    c, i = np.cos(W * dt), np.sin(W * dt)
    ux, uy = s[VX] - W * s[Y], s[VY] + W * s[X]
    x, y = s[X] + ux * dt, s[Y] + uy * dt
    s[X], s[Y] = c * x + i * y, c * y - i * x
    s[VX] = c * ux + i * uy + W * s[Y]
    s[VY] = c * uy - i * ux - W * s[X]
    s[THETA] += s[SPIN] * dt


@kernel
def energy_of(p, s):  # type: ignore[no-untyped-def]
    """Kinetic energy in the turning frame [J]."""
    return 0.5 * (p.mass * (s[VX] ** 2 + s[VY] ** 2) + p.inertia * s[SPIN] ** 2)


@kernel
def next_impact(p, cos, sin, lead, s, longest):  # type: ignore[no-untyped-def]
    """Time in which no wall is passed, and the ball and side that may be reached then.

    From the gap g, the speed u towards the wall and a bound A on the acceleration that the frame gives:
    t = 2 g/(u + sqrt(u^2 + 2 A g)), exact for A = 0. Ball -1: none within the longest time.
    """
    W = abs(p.turning)
    vx, vy = s[VX] - p.turning * s[Y], s[VY] + p.turning * s[X]
    straight = np.sqrt(vx * vx + vy * vy)
    rim = np.sqrt(s[X] * s[X] + s[Y] * s[Y]) + straight * longest
    bound = 2.0 * W * (straight + W * rim) + W * W * rim
    still = STILL * np.sqrt(2.0 * energy_of(p, s) / p.mass)
    first, ball, side = longest, -1, 1.0
    for j in range(cos.size):
        u = s[Y] * cos[j] - s[X] * sin[j] + p.radius * s[THETA] - lead[j]
        rate = s[VY] * cos[j] - s[VX] * sin[j] + p.radius * s[SPIN]
        for sign in (1.0, -1.0):
            gap, speed = max(p.half_play - sign * u, 0.0), sign * rate
            if bound == 0.0 and speed <= still:
                continue
            reach = speed + np.sqrt(speed * speed + 2.0 * bound * gap)
            if reach > 0.0 and 2.0 * gap < first * reach:
                first, ball, side = 2.0 * gap / reach, j, sign
    return first, ball, side


@kernel
def coast(p, s, note, dt, late):  # type: ignore[no-untyped-def]
    """Fly freely for a time, and note the frame's work and the mean energy since the time `late`."""
    before, swept, far = energy_of(p, s), s[X] * s[VY] - s[Y] * s[VX], s[X] * s[X] + s[Y] * s[Y]
    fly(p, s, dt)
    note[TIME] += dt
    farther = s[X] * s[X] + s[Y] * s[Y]
    work = 0.5 * p.mass * p.turning * p.turning * (farther - far)
    note[WORK] += work
    note[DONE] += abs(work)
    note[FAR] = max(note[FAR], farther)
    part = 0.5 * max(0.0, note[TIME] - max(late, note[TIME] - dt))
    note[LATE_ENERGY] += part * (before + energy_of(p, s))
    note[SWEPT] += dt * (swept + s[X] * s[VY] - s[Y] * s[VX])
    note[AREA] += dt * (far + farther)


@kernel
def impact(p, c, i, s, note, side, eta, mass):  # type: ignore[no-untyped-def]
    """Impact of the ball in direction (c, i), if its pocket comes at it, and note its work."""
    before = energy_of(p, s)
    speed = side * (s[VY] * c - s[VX] * i + p.radius * s[SPIN])
    if speed <= STILL * np.sqrt(2.0 * before / p.mass):
        return
    impulse = side * (1.0 + eta) * mass * speed
    push = p.friction * impulse
    s[VX] += (impulse * i - push * c) / p.mass
    s[VY] -= (impulse * c + push * i) / p.mass
    s[SPIN] -= impulse * p.radius / p.inertia
    # Normal part: the felt mass goes on with eta times the speed; friction: impulse times the mean radial
    # speed.
    radial = s[VX] * c + s[VY] * i + 0.5 * push / p.mass
    normal = -0.5 * mass * speed * speed * (1.0 - eta * eta)
    note[WORK] += normal - push * radial
    note[DONE] += abs(normal) + abs(push * radial)
    note[PEAK] = max(note[PEAK], speed * np.sqrt(p.stiffness * mass))


@kernel
def follow(p, cos, sin, lead, s, note, eta, mass, duration, grows_above):  # type: ignore[no-untyped-def]
    """Go from impact to impact until the time is over, the energy has grown, or impacts come in no time."""
    horizon = duration if p.turning == 0.0 else min(duration, 0.1 / abs(p.turning))
    late, idle = 0.8 * duration, 0
    for _ in range(MOST_BLOWS):
        dt, ball, side = next_impact(p, cos, sin, lead, s, min(horizon, duration - note[TIME]))
        coast(p, s, note, dt, late)
        if note[TIME] >= duration:
            return UNKNOWN
        idle = idle + 1 if dt < 1e-9 * duration else 0
        if idle > STALL:
            return UNRESOLVED
        if ball >= 0:
            u = s[Y] * cos[ball] - s[X] * sin[ball] + p.radius * s[THETA] - lead[ball]
            if p.half_play - side * u <= 1e-10 * p.half_play:
                impact(p, cos[ball], sin[ball], s, note, side, eta, mass)
        if energy_of(p, s) > grows_above:
            return WHIRLS
    return UNRESOLVED


@kernel
def hard_run(p, cos, sin, direction, kick, lead, eta, mass, duration, limits, out):  # type: ignore[no-untyped-def]
    """Run from one kick, impact by impact; outcome and evidence into `out`, shape (evidence,)."""
    s, note = np.zeros(6), np.zeros(NOTES)
    s[VX], s[VY] = kick * np.cos(direction), kick * np.sin(direction)
    start = energy_of(p, s)
    outcome = follow(p, cos, sin, lead, s, note, eta, mass, duration, limits[1])
    late = note[TIME] - 0.8 * duration
    out[END_ENERGY] = note[LATE_ENERGY] / late if late > 0.0 else energy_of(p, s)
    growth = out[END_ENERGY] / start  # walls have no scale of energy: what has grown goes on growing
    out[LARGEST_OFFSET] = np.sqrt(note[FAR])
    out[GROWTH_RATE] = 0.5 * np.log(growth) / (0.9 * duration if late > 0.0 else note[TIME])
    if outcome == UNKNOWN:
        outcome = WHIRLS if growth > 1.0 else (DRIFTS if out[LARGEST_OFFSET] > limits[0] else SETTLES)
    whirl = note[SWEPT] / note[AREA] if note[AREA] > 0.0 else 0.0
    out[OUTCOME], out[CAUSE] = outcome, IMPACTS if outcome == UNRESOLVED else 0
    out[WHIRL] = abs(whirl) / (2.0 * np.pi)
    out[DIRECTION] = np.sign(whirl)
    out[FORCE] = note[PEAK]
    out[IMBALANCE] = abs(energy_of(p, s) - start - note[WORK]) / (note[DONE] + start)


@kernel
def hard_chunk(p, cos, sin, starts, kick, eta, mass, duration, limits, out):  # type: ignore[no-untyped-def]
    """Run from every row of `starts`, as in `run_chunk`; evidence into `out`, shape (run, evidence)."""
    for i in range(starts.shape[0]):
        lead = starts[i, 1 : 1 + cos.size]
        hard_run(p, cos, sin, starts[i, 0], kick, lead, eta, mass, duration, limits, out[i])


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
        The cage; it must have play and neither land, gravity nor unbalance. Its race damping gives the
        restitution.
    settings, kicks, runs, first_run, jobs
        As in `run_ensemble`, and the same starts.
    restitution : float, optional
        Of an impact [-]; default: `impact_restitution`, from the mass that the impact feels.
    may_turn : bool
        False holds the cage's rotation to that of the ball set.

    Returns
    -------
    Ensemble
        With the force that an undamped spring would reach at each impact, the whirl as the mean turning rate
        of the offset, and no drift rate. Runs that meet too many events in no time are UNRESOLVED.

    Raises
    ------
    InputError
        The cage has a land, gravity, unbalance or no play, or the ensemble is empty.
    """
    _refuse(cage)
    cage = turned_forward(cage)
    speeds, runs = chosen(settings_for(settings, cage), kicks, runs)
    mass = felt_mass(cage, may_turn=may_turn)
    eta = impact_restitution(cage, may_turn=may_turn) if restitution is None else restitution
    p = _walls(cage, may_turn=may_turn)
    angles, starts = np.array(cage.ball_angles), random_starts(cage, settings, first_run, runs)
    directions = np.cos(angles), np.sin(angles)
    evidence = np.zeros((speeds.size, runs, slots.EVIDENCE))

    def work(i: int, rows: slice) -> None:
        drift = 2.0 * cage.half_play
        limits = (drift, GROWN * energy_scale(cage, speeds[i]))
        hard_chunk(p, *directions, starts[rows], speeds[i], eta, mass, settings.duration, limits,
                   evidence[i, rows])  # fmt: skip

    spread(work, speeds.size, runs, CHUNK_RUNS, jobs)
    hits = np.zeros((speeds.size, runs, cage.ball_count), dtype=np.int64)
    return gathered(speeds, evidence, hits, settings.duration)


def _walls(cage: PlanarCage, *, may_turn: bool) -> Walls:
    return Walls(
        mass=cage.mass,
        inertia=cage.moment_of_inertia,
        radius=cage.pitch_radius if may_turn else 0.0,
        turning=cage.cage_speed,
        stiffness=cage.ball_cage_stiffness,
        half_play=cage.half_play,
        friction=cage.friction_sense * cage.ball_cage_friction,
    )


def _refuse(cage: PlanarCage) -> None:
    """Refuse what the hard form leaves out."""
    cure = "Use run_ensemble, which has lands, gravity, unbalance and pockets without play."
    if not math.isinf(cage.land_gap):
        raise InputError("PlanarCage.guidance", "must be ball in the hard-impact form", "", cure)
    if cage.gravity > 0 or cage.unbalance > 0:
        raise InputError(
            "PlanarCage", "must be free of gravity and unbalance in the hard-impact form", cure=cure
        )
    if cage.half_play <= 0:
        raise InputError("PlanarCage.pocket_clearance", "must be > 0 in the hard-impact form [m]", "0", cure)
