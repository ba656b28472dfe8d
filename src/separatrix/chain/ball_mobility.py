"""Mobility of the most loaded ball along its orbit: rates, dampings, law of traction.

The ball is held between its rings by the slip fields of both contacts. Its motion is x = (u, spin): u [m/s]
its speed along the orbit beyond the free one, and its spin (axial, radial, orbital) in the orbiting frame
[rad/s]. Its place in the plane of the contacts, V, follows the balance of forces at once: the contact planes
are slaved. M x' = S x + e_1 F, and the mobility is Y(s) = u/F = e_1^T (s M - S)^-1 e_1 =
sum_i c_i lambda_i/(s + lambda_i), so that sum c_i = Y(0) = 1/C_eff. docs/theory/mobility.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, NamedTuple

import numpy as np

from separatrix.chain.ball_modes import Modes, modes
from separatrix.chain.ball_traction import BallTraction, FreeBall, SlipField
from separatrix.chain.contacts import BearingState, bearing_state, of_both_races, race_tracks
from separatrix.chain.creep import Creep
from separatrix.chain.grooved_ball import (
    Problem,
    contact_friction,
    free_balance,
    problem,
    touches,
    turning_loads,
)
from separatrix.chain.race_curve import race_slope
from separatrix.chain.slip_friction import chebyshev_nodes
from separatrix.ground.compiled import kernel
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.schema import Spelled
from separatrix.ground.units import (
    Array,
    Kilogram,
    MetrePerSecond,
    Newton,
    NewtonPerMetre,
    NewtonSecondPerMetre,
    PerSecond,
    Radian,
    RadianPerSecond,
    Ratio,
)
from separatrix.study.study import BallBearing, Film, KinematicModel, Operation, TractionSettings


class SlipLaw(Spelled):
    """Which slip speed rounds the corner of Coulomb's law in a contact."""

    ELASTIC = "elastic creep"
    """The slip at which elastic creep alone, without spin, would transmit all friction."""

    RIGID = "rigid"
    """A ten-thousandth of a quarter of the speed difference times d_m: rigid bodies, no film."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearMobility:
    """Small motion of the most loaded ball about its steady rolling.

    Modes by rising rate, arrays of shape (mode,): `rates` are those at which they decay, `oscillations` their
    angular frequencies (0 of an overdamped one), `shares` what each adds to the speed of a slow push.
    `damping` holds the slowest mode, the attitude of the spin axis; `damping_relaxed` lets it follow too;
    `damping_locked` holds all spin. `effective_mass` is `damping` over the next rate. A pocket that rubs with
    friction f on the ball it pushes changes the speed by 1 - `pocket_friction_effect` f behind the ball,
    and 1 + in front of it. The groove values are those of the ball centre across its orbit.
    """

    slip_law: SlipLaw  # which slip speed rounds the corner of Coulomb's law
    slip_speed_inner: MetrePerSecond
    slip_speed_outer: MetrePerSecond
    pitch_angle: Radian
    rates: Annotated[Array, "1/s", ("mode",)]
    oscillations: Annotated[Array, "rad/s", ("mode",)]
    shares: Annotated[Array, "-", ("mode",)]
    damping: NewtonSecondPerMetre
    damping_relaxed: NewtonSecondPerMetre  # C_eff, the attitude of the spin axis following too
    damping_locked: NewtonSecondPerMetre  # all spin held
    effective_mass: Kilogram  # of the ball with the spin that follows a push at once
    pocket_friction_effect: Ratio
    groove_damping: NewtonSecondPerMetre
    groove_stiffness: NewtonPerMetre


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mobility:
    """How the races let the most loaded ball be pushed along its orbit.

    `capacity` is race friction times both loads. F(u) at speeds beyond the free orbit, shape (push,), is
    forward and backward that of the slip fields, the slowest mode held; `force_law` is that of `traction`.
    `law_error` is the largest difference of the law from their mean, `asymmetry` half their largest
    difference, both over the capacity.
    """

    ball: int  # number of the most loaded ball, from 0
    linear: LinearMobility  # small motion about steady rolling
    capacity: Newton
    traction: BallTraction  # law of traction fitted to the forces
    law_error: Ratio
    asymmetry: Ratio
    speed: Annotated[Array, "m/s", ("push",)]  # of the push, beyond the free orbit
    force_forward: Annotated[Array, "N", ("push",)]  # of the races on a ball faster than its free orbit
    force_backward: Annotated[Array, "N", ("push",)]  # of the races on a slower ball
    force_law: Annotated[Array, "N", ("push",)]
    notes: tuple[str, ...] = ()  # where the slip fields leave the range of their model, a sentence each


SETTLED = 1e-10
"""Unbalanced friction of a settled ball over mu (Q_i + Q_o); rounding of the slip fields allows 1e-13."""

LADDER = (1.0, 300.0, 100.0, 30.0, 10.0, 3.0, 1.0)
"""Factors of the slip speeds on the way to the asked ones, where the first attempt does not settle."""


class HeldBall(NamedTuple):
    """A ball between rings that stand still relative to each other.

    `rings`, shape (2,), leads from the outer to the inner groove's centre [m]; `slips` are the slip speeds
    that round Coulomb's corner at the inner and outer race over the speed difference of the rings [m].
    `state`, shape (6,), is the steady one: V [m], orbit and spin over the speed difference.
    """

    problem: Problem
    rings: Array
    state: Array
    slips: tuple[float, float]
    nodes: Array
    capacity: Newton
    notes: tuple[str, ...] = ()

    @property
    def orbit_radius(self) -> float:
        """Radius of the orbit [m]."""
        return 0.5 * self.problem.pitch_diameter

    @property
    def units(self) -> Array:
        """One unit of the speeds of a state in x, shape (4,) [m/s and rad/s]."""
        speed = self.problem.speed
        return np.array((self.orbit_radius * speed, speed, speed, speed))

    @property
    def masses(self) -> Array:
        """Mass matrix of x, shape (4, 4): a ball that runs ahead turns about the bearing axis, too."""
        p = self.problem
        masses = np.diag((p.ball_mass, p.ball_inertia, p.ball_inertia, p.ball_inertia))
        masses[1, 0] = p.ball_inertia / self.orbit_radius
        return masses


@kernel
def ball_balance(
    p: Problem, rings: Array, state: Array, slips: tuple[float, float], nodes: Array, rows: Array
) -> None:
    """Forces and couples on the ball with its inertia, and their slopes: `rows`, (12, 9)."""
    free_balance(p, rings, state, slips, nodes, rows)


@kernel
def groove_slopes(
    p: Problem,
    rings: Array,
    state: Array,
    slips: tuple[float, float],
    nodes: Array,
    lateral: Array,
    along: Array,
) -> None:
    """Friction against a speed of the ball across each groove, shape (2,) [N s/m], and y of each, (2, 2)."""
    i, o = touches(p, rings, state)
    load_o, load_i, _ = turning_loads(p, i, o)
    r = np.empty((5, 7))
    contact_friction(p, -1.0, i, load_i, state, slips[0], nodes, r)
    lateral[0] = p.friction * load_i * r[4, 6] / abs(p.speed)
    along[0, 0], along[0, 1] = i.cosine, -i.sine
    contact_friction(p, 1.0, o, load_o, state, slips[1], nodes, r)
    lateral[1] = p.friction * load_o * r[4, 6] / abs(p.speed)
    along[1, 0], along[1, 1] = -o.cosine, o.sine


def balanced(ball: HeldBall, state: Array) -> tuple[Array, Array]:
    """Balance of the ball in a state, shape (6,), and its slopes, (6, 6)."""
    rows = np.empty((12, 9))
    ball_balance(ball.problem, ball.rings, state, ball.slips, ball.nodes, rows)
    return rows[:6, 0], rows[:6, 1:7]


def settle(ball: HeldBall) -> HeldBall:
    """The same ball in its steady state: Newton's method, if need be down from larger slip speeds.

    Raises
    ------
    ConvergenceError
        The friction of both races does not balance.
    """
    for steps in (LADDER[:1], LADDER[1:]):
        state, rest = ball.state.copy(), np.inf
        for factor in steps:
            slips = (factor * ball.slips[0], factor * ball.slips[1])
            state, rest = _newton(ball._replace(slips=slips), state)
        if rest <= SETTLED:
            return ball._replace(state=state)
    message = f"Mobility: friction of the races does not balance (unbalance {rest:.2g}, limit {SETTLED:g})."
    raise ConvergenceError(message, len(LADDER), rest)


def _newton(ball: HeldBall, state: Array) -> tuple[Array, float]:
    """Newton with step halving; the state and its largest unbalance over the capacity."""
    scales = ball.capacity * np.array((1.0, 1.0, 1.0, *(0.5 * ball.problem.ball_diameter,) * 3))
    balance, slopes = balanced(ball, state)
    norm = float(np.linalg.norm(balance / scales))
    for _ in range(60):
        if norm <= 0.1 * SETTLED:
            break
        step = np.asarray(np.linalg.solve(slopes / scales[:, None], balance / scales))
        for stride in 0.5 ** np.arange(12):
            trial = state - stride * step
            there, slopes_there = balanced(ball, trial)
            now = float(np.linalg.norm(there / scales))
            if now <= (1.0 - 0.1 * stride) * norm:
                break
        else:
            break
        state, balance, slopes, norm = trial, there, slopes_there, now
    return state, norm


def friction_slopes(ball: HeldBall) -> Array:
    """Slopes of (force, couples) with x, shape (4, 4), the contact planes slaved."""
    _, slopes = balanced(ball, ball.state)
    follows = np.linalg.solve(slopes[:2, :2], slopes[:2, 2:])
    return np.asarray(slopes[2:, 2:] - slopes[2:, :2] @ follows) / ball.units


def groove(ball: HeldBall) -> tuple[NewtonSecondPerMetre, NewtonPerMetre]:
    """Damping and stiffness of the ball centre along its grooves, where both contacts give least."""
    _, slopes = balanced(ball, ball.state)
    stiffness, directions = np.linalg.eigh(-0.5 * (slopes[:2, :2] + slopes[:2, :2].T))
    lateral, along = np.empty(2), np.empty((2, 2))
    groove_slopes(ball.problem, ball.rings, ball.state, ball.slips, ball.nodes, lateral, along)
    return float(lateral @ (along @ directions[:, 0]) ** 2), float(stiffness[0])


def pitch_angle(ball: HeldBall) -> float:
    """Angle of the spin axis from the bearing axis, in the plane of the ball, as contact angles count."""
    spin = ball.state[3:]
    sense = -1.0 if spin[0] > 0.0 else 1.0
    return float(np.arctan2(sense * spin[1], -sense * spin[0]))


def pocket_friction_effect(ball: HeldBall) -> float:
    """Share k by which pocket friction f changes what a push from in front of the ball moves, 1 + k f.

    Friction at the pole of the orbit brakes the spin with a couple of half the diameter times its force,
    whichever pole it is; what it pushes across the orbit is left out.
    """
    spin = ball.state[3:5] * ball.problem.speed
    couple = -0.5 * ball.problem.ball_diameter * spin / np.hypot(*spin)
    moved = np.linalg.inv(-friction_slopes(ball))[0]
    return -float(moved[1:3] @ couple) / float(moved[0])


def fitted_law(speed: Array, force: Array, *, slope: NewtonSecondPerMetre, mass: Kilogram) -> BallTraction:
    """Law with the exact slope at rest, nearest to F(u) in its largest difference.

    Where F falls again at large speeds, the law stays at the largest force before.
    """
    from scipy.optimize import minimize_scalar  # dear to import

    target = np.maximum.accumulate(force)
    knee = float(target.max()) / slope

    def law(log_speed: float) -> BallTraction:
        own = math.exp(log_speed)
        return BallTraction(mass=mass, slope=float(slope), speed=own)

    def error(log_speed: float) -> float:
        return float(np.abs(law(log_speed).force(speed) - target).max())

    bounds = math.log(0.1 * knee), math.log(10.0 * knee)
    return law(float(minimize_scalar(error, bounds=bounds, method="bounded", options={"xatol": 1e-9}).x))


FIRST, LAST, MOST, POINTS = 0.02, 6.0, 0.25, 25
"""Speeds of a curve: first and last over capacity/C_f, the most over the rolling speed, and how many."""

CLOSED = 1e-8
"""Unbalance over the capacity of a point of the curve."""

DEEPEST = 8
"""Halvings of the way from one point to the next."""


def pushed(ball: HeldBall, found: Modes, speeds: Array) -> Array:
    """F(u) at speeds beyond the free orbit that grow in size from 0, as far as friction balances [N].

    The slowest mode stays; without its pattern the spin relaxes for good.
    """
    unknown, at, forces = np.zeros(6), 0.0, []
    for speed in speeds:
        try:
            force, unknown = _follow(ball, found, unknown, at, float(speed))
        except ConvergenceError:
            break
        forces.append(force)
        at = float(speed)
    return np.array(forces)


def _follow(ball: HeldBall, found: Modes, start: Array, at: float, speed: float) -> tuple[float, Array]:
    """Force at a speed from the solution at the last one, in as many steps as Newton's method needs."""
    unknown, step, depth = start, speed - at, 0
    while True:
        trial = speed if abs(speed - at) <= abs(step) * (1.0 + 1e-12) else at + step
        force, there, rest = _pushed_balance(ball, found, unknown, trial)
        if rest <= CLOSED:
            unknown, at = there, trial
            if at == speed:
                return force, unknown
        elif depth < DEEPEST:
            step, depth = 0.5 * step, depth + 1
        else:
            message = f"Mobility: a push at {trial:.3g} m/s finds no balance of friction."
            raise ConvergenceError(message, DEEPEST, rest)


def _pushed_balance(ball: HeldBall, found: Modes, unknown: Array, speed: float) -> tuple[float, Array, float]:
    """Newton on (V - V_0, spin - spin_0, drift of the held mode), all scaled; force and unbalance, too."""
    force, best, rest = 0.0, unknown, np.inf
    for _ in range(25):
        force, rows, matrix = _equations(ball, found, unknown, speed)
        rest, best = float(np.abs(rows).max()), unknown
        if not np.isfinite(rest) or rest <= 0.01 * CLOSED:
            break
        try:
            unknown = unknown - np.linalg.solve(matrix, rows)
        except np.linalg.LinAlgError:
            return force, best, np.inf
    return force, best, rest


def _equations(ball: HeldBall, found: Modes, unknown: Array, speed: float) -> tuple[float, Array, Array]:
    """Force of a push, what is not yet 0, shape (6,), and its slopes with the unknowns, (6, 6).

    Balance in the plane of the contacts, couples less the drift, and the held mode's coordinate.
    """
    arm, acts = 0.5 * ball.problem.ball_diameter, [0, 1, 3, 4, 5]
    scales = ball.capacity * np.array((1.0, 1.0, arm, arm, arm))
    units = np.array((1e-6 * ball.problem.ball_diameter,) * 2 + (abs(ball.units[1]),) * 3)
    moved = unknown[:5] * units
    state = ball.state.copy()
    state[:2] += moved[:2]
    state[2] += speed / ball.units[0]
    state[3:] += moved[2:] / ball.units[1:]
    balance, slopes = balanced(ball, state)
    drift, row = np.zeros(4), np.zeros(4)
    if found.right is not None and found.left is not None:
        drift = _over_spin(found.masses @ found.right) * ball.capacity * arm
        row = _over_spin(found.left)
    balance[2:] -= unknown[5] * drift
    matrix = np.zeros((6, 6))
    matrix[:5, :2] = slopes[acts, :2]
    matrix[:5, 2:5] = slopes[acts, 3:] / ball.units[1:]
    matrix[:5, :5] *= units / scales[:, None]
    matrix[2:5, 5] = -drift[1:] / scales[2:]
    matrix[5, 2:5], matrix[5, 5] = row[1:], float(found.right is None)
    coordinate = (row[0] * speed + row[1:] @ moved[2:]) / units[2]
    last = unknown[5] if found.right is None else coordinate
    return -float(balance[2]), np.append(balance[acts] / scales, last), matrix


def _over_spin(values: Array) -> Array:
    """A pattern over its largest part of spin."""
    return np.asarray(values / float(np.abs(values[1:]).max()))


REMEMBERED = 256
"""Balls that are kept, by the records they are made of."""

RIGID = 1e-4
"""Slip speed of rigid contacts over the speed difference of the rings times d_m/4."""

CELLS = {SlipLaw.ELASTIC: 48, SlipLaw.RIGID: 96}
"""Strips across an ellipse; half as many places along rolling. Those of 4 times as many are within 1e-3."""


@lru_cache(maxsize=REMEMBERED)
def held_ball(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw,
) -> HeldBall:
    """Most loaded ball at rest in its two slip fields, remembered by the value of these records.

    It orbits in the positive sense: a bearing that turns the other way is mirrored.

    Raises
    ------
    InputError
        The ball does not touch both races.
    ConvergenceError
        The friction of both races does not balance.
    """
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    ball = state.inner.ball
    if state.equilibrium.orbital_speed[ball] < 0.0:
        turned = replace(operation, inner_speed=-operation.inner_speed, outer_speed=-operation.outer_speed)
        return held_ball(bearing, turned, kinematics, film, settings, slip_law)
    if not (state.inner.load > 0.0 and state.outer.load > 0.0):
        cure = "Raise the axial load or lower the speed."
        raise InputError("[operation] loads and speed", "must press a ball on both races", "", cure)
    p = problem(bearing, operation, 0.0, film.race_friction)
    inner, outer = (
        (0.5 * p.ball_diameter * (2.0 * f - 1.0) + at.ellipse.approach)
        * np.array((math.sin(at.contact_angle), math.cos(at.contact_angle)))
        for f, at in ((p.inner_conformity, state.inner), (p.outer_conformity, state.outer))
    )
    orbit = (state.equilibrium.orbital_speed[ball] - p.outer_speed) / p.speed
    slips, notes = (RIGID * 0.25 * p.pitch_diameter,) * 2, tuple[str, ...]()
    if slip_law is SlipLaw.ELASTIC:
        inner_slip, outer_slip, notes = elastic_slip_speeds(bearing, film, settings, state)
        slips = inner_slip / abs(p.speed), outer_slip / abs(p.speed)
    return settle(
        HeldBall(
            problem=p,
            rings=outer + inner,
            state=np.array((*outer, orbit, *(state.equilibrium.ball_spin[ball] / p.speed))),
            slips=slips,
            nodes=chebyshev_nodes(CELLS[slip_law] // 2),
            capacity=film.race_friction * (state.inner.load + state.outer.load),
            notes=notes,
        )
    )


def elastic_slip_speeds(
    bearing: BallBearing, film: Film, settings: TractionSettings, state: BearingState
) -> tuple[MetrePerSecond, MetrePerSecond, tuple[str, ...]]:
    r"""Slip at which the elastic creep of the inner and of the outer race would transmit all friction [m/s].

    :math:`v_e = f_{BT} V/\alpha_0` with the slope :math:`\alpha_0` of contact and film without spin and
    Heathcote's slip, by the traction model of the settings; with the notes of that.
    """
    tracks = [replace(one, creep=Creep(spin=0.0, curvature=0.0)) for one in race_tracks(bearing, film, state)]
    found = of_both_races(lambda track: race_slope(track, settings), (tracks[0], tracks[1]))
    speeds = state.inner.rolling_speed, state.outer.rolling_speed
    inner, outer = (film.race_friction * abs(v) / one.slope for v, one in zip(speeds, found, strict=True))
    return inner, outer, (*found[0].notes, *found[1].notes)


def free_ball(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    fastest_rate: PerSecond,
) -> tuple[FreeBall, tuple[RadianPerSecond, RadianPerSecond, RadianPerSecond]]:
    """The most loaded ball with its slip fields at free rolling, and its spin; it orbits positively."""
    held = held_ball(bearing, operation, kinematics, film, settings, SlipLaw.ELASTIC)
    state, p = bearing_state(bearing, operation, kinematics, film.race_friction), held.problem
    spin, outer_speed = held.state[3:] * p.speed, p.outer_speed
    orbit = held.state[2] * p.speed + outer_speed
    fields = []
    inner_ring, to_inner = p.speed + outer_speed, held.rings - held.state[:2]
    for side, race, contact, f, ring, slip in (
        (-1.0, to_inner, state.inner, p.inner_conformity, inner_ring, held.slips[0]),
        (1.0, held.state[:2], state.outer, p.outer_conformity, outer_speed, held.slips[1]),
    ):
        normal, a = side * race / np.hypot(*race), contact.ellipse.semi_major
        pivoting = (spin[0] - ring + orbit) * normal[0] + spin[1] * normal[1]
        rolling = (spin[0] - ring + orbit) * normal[1] - spin[1] * normal[0]
        fields.append(
            SlipField(
                normal_axial=float(normal[0]),
                normal_radial=float(normal[1]),
                limit=film.race_friction * contact.load,
                semi_major=a,
                axis_ratio=contact.ellipse.semi_minor / a,
                slip=float(0.5 * rolling * p.ball_diameter - (ring - orbit) * held.orbit_radius),
                pivoting=float(a * pivoting),
                heathcote=float(rolling * a * a * (2.0 * f + 1.0) / (4.0 * f * p.ball_diameter)),
                elastic_slip=float(slip * abs(p.speed)),
            )
        )
    ball = FreeBall(
        mass=p.ball_mass, inertia=p.ball_inertia, inner=fields[0], outer=fields[1], fastest_rate=fastest_rate
    )
    return ball, (float(spin[0]), float(spin[1]), float(spin[2]))


@lru_cache(maxsize=REMEMBERED)
def mobility(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw = SlipLaw.ELASTIC,
) -> Mobility:
    """Mobility of the most loaded ball along its orbit, remembered by the value of these records.

    Raises
    ------
    InputError
        The ball does not touch both races.
    ConvergenceError
        The friction of both races does not balance at rest or in a push.

    Notes
    -----
    docs/theory/mobility.md. Whole slip fields of both contacts, quasi-steady; contact planes slaved.
    """
    ball = held_ball(bearing, operation, kinematics, film, settings, slip_law)
    found = modes(friction_slopes(ball), ball.masses)
    state = bearing_state(bearing, operation, kinematics, film.race_friction)
    speed, forward, backward = _push_curve(ball, found, state.inner.rolling_speed)
    mean = 0.5 * (forward + backward)
    law = fitted_law(speed, mean, slope=found.held, mass=found.mass)
    return Mobility(
        ball=state.inner.ball,
        linear=_linear(ball, found, slip_law),
        capacity=ball.capacity,
        traction=law,
        law_error=float(np.abs(law.force(speed) - mean).max()) / ball.capacity,
        asymmetry=0.5 * float(np.abs(forward - backward).max()) / ball.capacity,
        speed=speed,
        force_forward=forward,
        force_backward=backward,
        force_law=law.force(speed),
        notes=ball.notes,
    )


def linear_mobility(
    bearing: BallBearing,
    operation: Operation,
    kinematics: KinematicModel,
    film: Film,
    settings: TractionSettings,
    slip_law: SlipLaw,
) -> LinearMobility:
    """Small motion of the most loaded ball alone."""
    ball = held_ball(bearing, operation, kinematics, film, settings, slip_law)
    return _linear(ball, modes(friction_slopes(ball), ball.masses), slip_law)


def _linear(ball: HeldBall, found: Modes, slip_law: SlipLaw) -> LinearMobility:
    damping, stiffness = groove(ball)
    speed = abs(ball.problem.speed)
    return LinearMobility(
        slip_law=slip_law,
        slip_speed_inner=ball.slips[0] * speed,
        slip_speed_outer=ball.slips[1] * speed,
        pitch_angle=pitch_angle(ball),
        rates=found.rates.real,
        oscillations=np.abs(found.rates.imag),
        shares=found.shares.real * found.relaxed,
        damping=found.held,
        damping_relaxed=found.relaxed,
        damping_locked=found.locked,
        effective_mass=found.mass,
        pocket_friction_effect=pocket_friction_effect(ball),
        groove_damping=damping,
        groove_stiffness=stiffness,
    )


def _push_curve(ball: HeldBall, found: Modes, rolling_speed: MetrePerSecond) -> tuple[Array, Array, Array]:
    """Speeds, forces forward and backward; the curve ends where a push finds no balance beyond the knee."""
    knee = ball.capacity / found.held
    last = min(LAST * knee, MOST * abs(rolling_speed))
    speed = np.geomspace(min(FIRST * knee, 0.5 * last), last, POINTS)
    forward, backward = pushed(ball, found, speed), -pushed(ball, found, -speed)
    count = min(forward.size, backward.size)
    if speed[count - 1] < min(knee, 0.5 * last):
        message = f"Mobility: a push at {speed[count]:.3g} m/s finds no balance of friction."
        raise ConvergenceError(message, count, speed[count])
    return speed[:count], forward[:count], backward[:count]
