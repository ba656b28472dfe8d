"""How the races hold a pushed ball: dampings, effective mass, capacity, and the law that the cage takes.

The most loaded ball is held between its rings by the slip fields of both contacts. Its motion is x = (u,
spin): u [m/s] its speed along the orbit beyond the free one, and its spin (axial, radial, orbital) in the
orbiting frame [rad/s]. Its place in the plane of the contacts, V, follows the balance of forces at once: the
contact planes are slaved. M x' = S x + e_1 F, and the mobility is Y(s) = u/F = e_1^T (s M - S)^-1 e_1 =
sum_i c_i lambda_i/(s + lambda_i), so that sum c_i = Y(0) = 1/C_eff. docs/theory/mobility.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.chain.contacts import RaceContact, Rolling, of_both_races
from separatrix.chain.grooved_ball import (
    LEAST_SHARE,
    Problem,
    contact_friction,
    free_balance,
    problem,
    touches,
    turning_loads,
)
from separatrix.chain.hertz import Creep
from separatrix.chain.race_traction import SLOPE_ALONE, BallTraction, FreeBall, SlipField, contact_traction
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


class SlipLaw(Spelled):
    """Which slip speed rounds the corner of Coulomb's law in a contact."""

    ELASTIC = "elastic creep"
    """The slip at which elastic creep alone, without spin, would transmit all friction."""

    RIGID = "rigid"
    """A ten-thousandth of a quarter of the speed difference times d_m: rigid bodies, no film."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearMobility:
    """Small motion of the most loaded ball about its steady rolling.

    Modes by rising rate: `rates` are those at which they decay, `oscillations` their angular frequencies (0
    of an overdamped one), `shares` what each adds to the speed of a slow push. `damping` is C_f: it holds the
    slowest mode, the attitude of the spin axis; `effective_mass` is `damping` over the next rate. A pocket
    that rubs with friction f on the ball it pushes changes the speed by 1 - `pocket_friction_effect` f behind
    the ball, and 1 + in front of it. The groove values are those of the ball centre across its orbit.
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


SETTLED, CLOSED = 1e-10, 1e-8
"""Unbalance of a settled and of a pushed ball over the capacity; rounding of the slip fields allows 1e-13."""

LADDER = (1.0, 300.0, 100.0, 30.0, 10.0, 3.0, 1.0)
"""Factors of the slip speeds on the way to the asked ones, where the first attempt does not settle."""

RIGID = 1e-4
"""Slip speed of rigid contacts over the speed difference of the rings times d_m/4."""

CELLS = {SlipLaw.ELASTIC: 48, SlipLaw.RIGID: 96}
"""Strips across an ellipse; half as many places along rolling. Those of 4 times as many are within 1e-3."""


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
    def units(self) -> Array:
        """One unit of the speeds of a state in x, shape (4,) [m/s and rad/s]."""
        return self.problem.speed * np.array((0.5 * self.problem.pitch_diameter, 1.0, 1.0, 1.0))

    @property
    def scales(self) -> Array:
        """Capacity, and its couple on the ball, of the rows of a balance, shape (6,) [N and N m]."""
        return self.capacity * np.array((1.0, 1.0, 1.0, *(0.5 * self.problem.ball_diameter,) * 3))

    @property
    def masses(self) -> Array:
        """Mass matrix of x, shape (4, 4): a ball that runs ahead turns about the bearing axis, too."""
        p = self.problem
        masses = np.diag((p.ball_mass, p.ball_inertia, p.ball_inertia, p.ball_inertia))
        masses[1, 0] = p.ball_inertia / (0.5 * p.pitch_diameter)
        return masses


@kernel
def _balanced(p: Problem, rings: Array, state: Array, slips: tuple[float, float], nodes: Array) -> Array:
    rows = np.empty((12, 9))
    free_balance(p, rings, state, slips, nodes, rows)
    return rows


def balanced(ball: HeldBall, state: Array) -> tuple[Array, Array]:
    """Forces and couples on the ball with its inertia, shape (6,), and slopes with its state, (6, 6)."""
    rows = _balanced(ball.problem, ball.rings, state, ball.slips, ball.nodes)
    return rows[:6, 0], rows[:6, 1:7]


@kernel
def groove_slopes(
    p: Problem, rings: Array, state: Array, slips: tuple[float, float], nodes: Array
) -> tuple[Array, Array]:
    """Friction against a speed of the ball across each groove, shape (2,) [N s/m], and y of each, (2, 2)."""
    i, o = touches(p, rings, state)
    load_o, load_i, _ = turning_loads(p, i, o)
    r, lateral, along = np.empty((5, 7)), np.empty(2), np.empty((2, 2))
    for k in range(2):
        side, at, load = (-1.0, i, load_i) if k == 0 else (1.0, o, load_o)
        contact_friction(p, side, at, load, state, slips[k], nodes, r)
        lateral[k] = p.friction * load * r[4, 6] / abs(p.speed)
        along[k, 0], along[k, 1] = -side * at.cosine, side * at.sine
    return lateral, along


Equations = Callable[[Array], tuple[Array, Array]]
"""From unknowns, what is not yet 0, shape (n,), and its slopes with them, (n, n)."""


def newton(equations: Equations, start: Array, scales: Array, goal: float) -> tuple[Array, float]:
    """Newton's method with step halving; the unknowns, and the norm of what is left over the scales."""
    here, (rest, slopes) = start, equations(start)
    norm = float(np.linalg.norm(rest / scales))
    for _ in range(60):
        if norm <= goal:
            break
        try:
            step = np.linalg.solve(slopes / scales[:, None], rest / scales)
        except np.linalg.LinAlgError:  # no way on: what is left tells the caller
            break
        for stride in 0.5 ** np.arange(12):
            trial = here - stride * step
            trial_rest, trial_slopes = equations(trial)
            now = float(np.linalg.norm(trial_rest / scales))
            if now <= (1.0 - 0.1 * stride) * norm:
                break
        else:
            break
        here, rest, slopes, norm = trial, trial_rest, trial_slopes, now
    return here, norm


def settle(ball: HeldBall) -> HeldBall:
    """The same ball in its steady state: Newton's method, if need be down from larger slip speeds.

    Raises
    ------
    ConvergenceError
        The friction of both races does not balance.
    """
    for steps in (LADDER[:1], LADDER[1:]):
        state, rest = ball.state, np.inf
        for factor in steps:
            eased = ball._replace(slips=(factor * ball.slips[0], factor * ball.slips[1]))
            state, rest = newton(partial(balanced, eased), state, ball.scales, 0.1 * SETTLED)
        if rest <= SETTLED:
            return ball._replace(state=state)
    message = f"Mobility: friction of the races does not balance (unbalance {rest:.2g}, limit {SETTLED:g})."
    raise ConvergenceError(message, len(LADDER), rest)


def friction_slopes(ball: HeldBall) -> Array:
    """Slopes of (force, couples) with x, shape (4, 4), the contact planes slaved."""
    _, slopes = balanced(ball, ball.state)
    follows = np.linalg.solve(slopes[:2, :2], slopes[:2, 2:])
    return np.asarray(slopes[2:, 2:] - slopes[2:, :2] @ follows) / ball.units


REAL = 1e-9
"""Imaginary part of a rate over its size below which it is rounding."""


class Modes(NamedTuple):
    """Modes of M x' = S x by rising rate, shape (4,), and the dampings of a slow push [N s/m]."""

    slopes: Array  # S
    masses: Array  # M
    rates: NDArray[np.complex128]
    shares: NDArray[np.complex128]  # of 1/C_eff
    relaxed: NewtonSecondPerMetre  # C_eff, every mode relaxed
    held: NewtonSecondPerMetre  # C_f, the slowest mode held
    locked: NewtonSecondPerMetre  # all spin held
    mass: Kilogram  # of the motion that the slowest mode does not follow, C_f over the next rate
    right: Array | None  # the slowest mode's pattern in x; None where it is not overdamped
    left: Array | None  # and the row that measures it


def modes(slopes: Array, masses: Array) -> Modes:
    """Modes of M x' = S x from S and M, shape (4, 4) each."""
    found, patterns = np.linalg.eig(np.linalg.solve(masses, slopes))
    order = np.argsort(np.abs(found), kind="stable")
    rates, patterns = -found[order].astype(complex), patterns[:, order]
    measures = np.linalg.inv(patterns)
    pushed = np.linalg.solve(masses, np.eye(len(masses))[0])
    shares = patterns[0] * (measures @ pushed) / rates
    first = int(abs(rates[0].imag) <= REAL * abs(rates[0]))  # of the modes that follow
    held = 1.0 / float(np.sum(shares[first:]).real)
    return Modes(
        slopes=slopes,
        masses=masses,
        rates=rates,
        shares=shares,
        relaxed=1.0 / float(np.sum(shares).real),
        held=held,
        locked=float(-slopes[0, 0]),
        mass=held / float(np.abs(rates[first])),
        right=patterns[:, 0].real if first else None,
        left=measures[0].real if first else None,
    )


def groove(ball: HeldBall) -> tuple[NewtonSecondPerMetre, NewtonPerMetre]:
    """Damping and stiffness of the ball centre along its grooves, where both contacts give least."""
    _, slopes = balanced(ball, ball.state)
    stiffness, directions = np.linalg.eigh(-0.5 * (slopes[:2, :2] + slopes[:2, :2].T))
    lateral, along = groove_slopes(ball.problem, ball.rings, ball.state, ball.slips, ball.nodes)
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
        return BallTraction(mass=mass, slope=float(slope), speed=math.exp(log_speed))

    def error(log_speed: float) -> float:
        return float(np.abs(law(log_speed).force(speed) - target).max())

    bounds = math.log(0.1 * knee), math.log(10.0 * knee)
    return law(float(minimize_scalar(error, bounds=bounds, method="bounded", options={"xatol": 1e-9}).x))


FIRST, LAST, MOST, POINTS = 0.02, 6.0, 0.25, 25
"""Speeds of a curve: first and last over capacity/C_f, the most over the rolling speed, and how many."""

DEEPEST = 8
"""Halvings of the way from one point to the next."""

ACTS = [0, 1, 3, 4, 5]
"""Rows of a balance that a pushed ball keeps: all but the force along the orbit."""


def push_curve(ball: HeldBall, found: Modes, rolling_speed: MetrePerSecond) -> tuple[Array, Array, Array]:
    """Speeds, forces forward and backward; the curve ends where a push finds no balance beyond the knee."""
    knee = ball.capacity / found.held
    last = min(LAST * knee, MOST * abs(rolling_speed))
    speed = np.geomspace(min(FIRST * knee, 0.5 * last), last, POINTS)
    forward, backward = pushed(ball, found, speed), -pushed(ball, found, -speed)
    count = min(forward.size, backward.size)
    if count == 0 or speed[count - 1] < min(knee, 0.5 * last):
        message = f"Mobility: a push at {speed[count]:.3g} m/s finds no balance of friction."
        raise ConvergenceError(message, count, speed[count])
    return speed[:count], forward[:count], backward[:count]


def pushed(ball: HeldBall, found: Modes, speeds: Array) -> Array:
    """F(u) at speeds beyond the free orbit that grow in size from 0, as far as friction balances [N].

    The slowest mode stays; without its pattern the spin relaxes for good.
    """
    unknown, at, forces = np.zeros(6), 0.0, []
    for speed in map(float, speeds):
        there = _follow(ball, found, unknown, at, speed)
        if there is None:
            break
        unknown, at = there, speed
        forces.append(_pushed(ball, found, unknown, speed)[0])
    return np.array(forces)


def _follow(
    ball: HeldBall, found: Modes, start: Array, at: float, speed: float, depth: int = 0
) -> Array | None:
    """Balance at a speed from that at another, by halves of a way that is too far; None if none is found."""
    scales = np.append(ball.scales[ACTS], 1.0)
    there, rest = newton(lambda x: _pushed(ball, found, x, speed)[1:], start, scales, 0.01 * CLOSED)
    if rest <= CLOSED or depth == DEEPEST:
        return there if rest <= CLOSED else None
    middle = 0.5 * (at + speed)
    halfway = _follow(ball, found, start, at, middle, depth + 1)
    return None if halfway is None else _follow(ball, found, halfway, middle, speed, depth + 1)


def _pushed(ball: HeldBall, found: Modes, unknown: Array, speed: float) -> tuple[float, Array, Array]:
    """Force of a push, what is not yet 0, shape (6,), and its slopes with the unknowns, (6, 6).

    The unknowns are V - V_0, spin - spin_0 and the drift of the held mode, all scaled; the rows the balance
    in the plane of the contacts, the couples less the drift, and the held mode's coordinate.
    """
    units = np.array((1e-6 * ball.problem.ball_diameter,) * 2 + (abs(ball.units[1]),) * 3)
    moved = unknown[:5] * units
    state = ball.state + np.array((*moved[:2], speed / ball.units[0], *(moved[2:] / ball.units[1:])))
    balance, slopes = balanced(ball, state)
    matrix, last = np.zeros((6, 6)), unknown[5]
    matrix[:5, :2], matrix[:5, 2:5] = slopes[ACTS, :2], slopes[ACTS, 3:] / ball.units[1:]
    matrix[:5, :5] *= units
    if found.right is None or found.left is None:
        matrix[5, 5] = 1.0
    else:
        drift, row = found.masses @ found.right, found.left / np.abs(found.left[1:]).max()
        drift *= ball.scales[-1] / np.abs(drift[1:]).max()
        balance[2:] -= unknown[5] * drift
        matrix[2:5, 5], matrix[5, 2:5] = -drift[1:], row[1:]
        last = (row[0] * speed + row[1:] @ moved[2:]) / units[2]
    return -float(balance[2]), np.append(balance[ACTS], last), matrix


REMEMBERED = 256
"""Balls that are kept, by the records they are made of."""


@lru_cache(maxsize=REMEMBERED)
def held_ball(asked: Rolling, slip_law: SlipLaw) -> HeldBall:
    """Most loaded ball at rest in its two slip fields, remembered by the value of these records.

    It orbits in the positive sense: a bearing that turns the other way is mirrored.

    Raises
    ------
    InputError
        The ball does not touch both races.
    ConvergenceError
        The friction of both races does not balance.
    """
    bearing, operation, film, state = asked.bearing, asked.operation, asked.film, asked.state
    ball = state.inner.ball
    if state.equilibrium.orbital_speed[ball] < 0.0:
        turned = replace(operation, inner_speed=-operation.inner_speed, outer_speed=-operation.outer_speed)
        mirrored = None if asked.ball is None else -asked.ball % bearing.ball_count
        return held_ball(asked._replace(operation=turned, ball=mirrored), slip_law)
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
    inner_slip = outer_slip = RIGID * 0.25 * p.pitch_diameter * abs(p.speed)
    notes: tuple[str, ...] = ()
    if slip_law is SlipLaw.ELASTIC:
        inner_slip, outer_slip, notes = elastic_slip_speeds(asked)
    return settle(
        HeldBall(
            problem=p,
            rings=outer + inner,
            state=np.array((*outer, orbit, *(state.equilibrium.ball_spin[ball] / p.speed))),
            slips=(inner_slip / abs(p.speed), outer_slip / abs(p.speed)),
            nodes=chebyshev_nodes(CELLS[slip_law] // 2),
            capacity=film.race_friction * (state.inner.load + state.outer.load),
            notes=notes,
        )
    )


def elastic_slip_speeds(asked: Rolling) -> tuple[MetrePerSecond, MetrePerSecond, tuple[str, ...]]:
    r"""Slip at which the elastic creep of the inner and of the outer race would transmit all friction [m/s].

    :math:`v_e = f_{BT} V/\alpha_0` with the slope :math:`\alpha_0` of contact and film without spin and
    Heathcote's slip, by the traction model of the settings; with the notes of that.
    """
    state, friction, none = asked.state, asked.film.race_friction, Creep(spin=0.0, curvature=0.0)
    one, two = of_both_races(
        lambda track: contact_traction(replace(track, creep=none), asked.settings, SLOPE_ALONE), asked.tracks
    )
    inner, outer = (
        friction * abs(at.rolling_speed) / found.slope
        for at, found in ((state.inner, one), (state.outer, two))
    )
    return inner, outer, (*one.notes, *two.notes)


def free_ball(
    asked: Rolling, fastest_rate: PerSecond
) -> tuple[FreeBall, tuple[RadianPerSecond, RadianPerSecond, RadianPerSecond]]:
    """The most loaded ball with its slip fields at free rolling, and its spin; it orbits positively."""
    held, state, friction = held_ball(asked, SlipLaw.ELASTIC), asked.state, asked.film.race_friction
    p, place = held.problem, held.state[:2]
    spin, orbit = held.state[3:] * p.speed, held.state[2] * p.speed + p.outer_speed

    def field(side: float, to_centre: Array, contact: RaceContact, ring: float) -> SlipField:
        normal, a = side * to_centre / np.hypot(*to_centre), contact.ellipse.semi_major
        f, elastic = (
            (p.inner_conformity, held.slips[0]) if side < 0.0 else (p.outer_conformity, held.slips[1])
        )
        pivoting = (spin[0] - ring + orbit) * normal[0] + spin[1] * normal[1]
        rolling = (spin[0] - ring + orbit) * normal[1] - spin[1] * normal[0]
        return SlipField(
            normal_axial=float(normal[0]),
            normal_radial=float(normal[1]),
            limit=friction * contact.load,
            semi_major=a,
            axis_ratio=contact.ellipse.semi_minor / a,
            slip=float(0.5 * (rolling * p.ball_diameter - (ring - orbit) * p.pitch_diameter)),
            pivoting=float(a * pivoting),
            heathcote=float(rolling * a * a * (2.0 * f + 1.0) / (4.0 * f * p.ball_diameter)),
            elastic_slip=float(elastic * abs(p.speed)),
        )

    ball = FreeBall(
        mass=p.ball_mass,
        inertia=p.ball_inertia,
        inner=field(-1.0, held.rings - place, state.inner, p.speed + p.outer_speed),
        outer=field(1.0, place, state.outer, p.outer_speed),
        fastest_rate=fastest_rate,
    )
    return ball, (float(spin[0]), float(spin[1]), float(spin[2]))


@lru_cache(maxsize=REMEMBERED)
def mobility(asked: Rolling, slip_law: SlipLaw = SlipLaw.ELASTIC) -> Mobility:
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
    ball = held_ball(asked, slip_law)
    found = modes(friction_slopes(ball), ball.masses)
    speed, forward, backward = push_curve(ball, found, asked.state.inner.rolling_speed)
    mean = 0.5 * (forward + backward)
    law = fitted_law(speed, mean, slope=found.held, mass=found.mass)
    return Mobility(
        ball=asked.state.inner.ball,
        linear=linear_mobility(asked, slip_law),
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


def shares_of_balls(asked: Rolling) -> tuple[Array, Array]:
    """Capacity, and slope of its law of traction, of every ball over the most loaded one's, shape (ball,).

    A ball that the inner race hardly touches spins freely and has no slope, unless that is so of
    the most loaded one: then each has that of its loads, as under an axial load. Raises as `mobility`.
    """
    found, most = asked.state.equilibrium, asked.state.inner.ball
    loads = found.load_inner + found.load_outer
    slopes, touched = np.zeros(loads.size), found.load_inner > LEAST_SHARE * found.load_outer
    for ball in np.flatnonzero(touched if touched[most] else found.load_inner > 0.0):
        slopes[ball] = linear_mobility(asked._replace(ball=int(ball)), SlipLaw.ELASTIC).damping
    return loads / loads[most], slopes / slopes[most]


@lru_cache(maxsize=REMEMBERED)
def linear_mobility(asked: Rolling, slip_law: SlipLaw) -> LinearMobility:
    """Small motion of the most loaded ball alone; refused as `held_ball` is."""
    ball = held_ball(asked, slip_law)
    found = modes(friction_slopes(ball), ball.masses)
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
