"""Equilibrium of the inner ring over balls that are each in balance (paper, 2.2, and its reference 3).

Ring displacement q = (x, y, z) and small turns about y and z times d_m/2 [m]; y lies along the radial load,
ball j at azimuth psi_j from y towards z. Loads are conjugate to q, moments over d_m/2 [N].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.chain.contact_table import contact_table
from separatrix.chain.grooved_ball import (
    CONTROLLED,
    FREE,
    HELD,
    KINEMATIC,
    SMOOTHING,
    STATIC,
    STEEPEST,
    Problem,
    eliminate,
    problem,
    solve_balls,
)
from separatrix.chain.hertz import ContactEllipse, contact_ellipse, contact_modulus, race_curvatures
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Metre, Newton, NewtonMetre, PerSecond, Radian, Ratio
from separatrix.study.study import BallBearing, KinematicModel, Operation, Race

LIMIT = 80
"""Newton steps of the ring; a usual case takes 3 to 8."""

BALANCED = 1e-9
"""Unbalance over the largest load at which the search ends; a thousand times as much is accepted."""

LEAST = 1e-6
"""The same over the smallest load, which must not drown in the others."""

HEAVY = 1e-5
"""Load of a ball over E* D^2 from which light loads are reached: about a quarter of a GPa."""

LARGER = 1e-5
"""Share by which a ball is larger where orbits are compared: a tenth of a micrometre, as of a good grade."""

BOLD = 1e4
"""Factor by which one step of the ring may raise the unbalance; monotone steps are the second choice."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Equilibrium:
    """Loads, angles and speeds of every ball, and where the inner ring stands; arrays have shape (ball,).

    `azimuth` is counted from the radial load, turning as the +x axis says; x is the bearing axis along
    positive axial load. Angles [rad], loads [N], speeds [rad/s] or [m/s]. `ball_spin`, shape (ball, 3), is
    the spin in the frame that turns with the ball's orbit: along x, outward, and along the orbit [rad/s].
    `pitch_angle` leans the spin axis in the plane of the ball, positive as a contact angle is; `yaw_angle`
    out of it, along the orbit. `spin_roll_ratio_*` are the paper's Eq. 16, `rolling_speed_*` the mean speed
    of both surfaces through the contact. `gyroscopic_moment` is a magnitude [N m].

    A contact that carries nothing has `inner_contact` or `outer_contact` False and load 0. Its angle is
    nominal: that of the line from the ball to the centre of the groove, turned towards the radial direction
    as the gap opens, and within 90 degrees; orbit and spin are those of the first touch.
    `axial_displacement` counts from first contact at the free angle. `moment` is what the balls carry: the
    load, or the reaction to rings that are held (`is_tilt_held`, parallel or at a given tilt); positive loads
    the balls at azimuth 0, as positive `tilt` does. `cross_tilt` (about the radial load) and
    `transverse_displacement` lie across the plane of the radial load. `residual` is the unbalanced force of
    the ring [N]. `race_control` says which race Jones's criterion would let control the ball.
    """

    model: KinematicModel  # what fixes the ball's spin axis
    azimuth: Annotated[Array, "rad", ("ball",)]
    contact_angle_inner: Annotated[Array, "rad", ("ball",)]
    contact_angle_outer: Annotated[Array, "rad", ("ball",)]
    load_inner: Annotated[Array, "N", ("ball",)]
    load_outer: Annotated[Array, "N", ("ball",)]
    inner_contact: Annotated[NDArray[np.bool_], ("ball",)]  # whether the ball touches the inner race
    outer_contact: Annotated[NDArray[np.bool_], ("ball",)]  # whether it touches the outer race
    orbital_speed: Annotated[Array, "rad/s", ("ball",)]
    pitch_angle: Annotated[Array, "rad", ("ball",)]
    yaw_angle: Annotated[Array, "rad", ("ball",)]  # of the spin axis out of the plane of ball and axis
    ball_spin: Annotated[Array, "rad/s", ("ball", "axis")]  # own rotation: axial, outward, along the orbit
    spin_roll_ratio_inner: Annotated[Array, "-", ("ball",)]
    spin_roll_ratio_outer: Annotated[Array, "-", ("ball",)]
    rolling_speed_inner: Annotated[Array, "m/s", ("ball",)]  # mean speed of both surfaces through the contact
    rolling_speed_outer: Annotated[Array, "m/s", ("ball",)]  # the same at the outer race
    centrifugal_force: Annotated[Array, "N", ("ball",)]  # of a ball
    gyroscopic_moment: Annotated[Array, "N m", ("ball",)]  # of a ball
    heat_inner: Annotated[Array, "W", ("ball",)]  # of friction in the contact
    heat_outer: Annotated[Array, "W", ("ball",)]  # the same at the outer race
    race_control: Annotated[tuple[Race, ...], ("ball",)]
    """Race that controls the ball's spin by Jones's criterion."""
    axial_displacement: Metre
    radial_displacement: Metre
    transverse_displacement: Metre  # of the inner ring across axis and radial load
    tilt: Radian
    is_tilt_held: bool  # whether the rings are held, parallel or at a given tilt
    cross_tilt: Radian  # of the inner ring about the radial load
    moment: NewtonMetre
    friction_torque: NewtonMetre
    """Of balls on races: their heat over the difference of the speeds of the rings."""
    iterations: int  # steps of the solver
    residual: Newton  # unbalanced force on the inner ring

    @property
    def most_loaded(self) -> int:
        """Number of the ball with the largest inner load, the outer load deciding where none touches."""
        largest = self.load_inner if self.load_inner.any() else self.load_outer
        return int(np.argmax(np.round(largest / (largest.max() or 1.0), 9)))


def contact(result: Equilibrium, bearing: BallBearing, race: Race, ball: int) -> ContactEllipse:
    """Ellipse of one ball on one race, curvatures at its operating angle; no size where it is unloaded."""
    inner = race is Race.INNER
    load = (result.load_inner if inner else result.load_outer)[ball]
    angle = (result.contact_angle_inner if inner else result.contact_angle_outer)[ball]
    rolling, transverse = race_curvatures(bearing, race, float(angle))
    modulus = contact_modulus(bearing.ball_material, bearing.ring_material)
    return contact_ellipse(float(load), rolling, transverse, modulus)


def equilibrium(
    bearing: BallBearing,
    operation: Operation,
    model: KinematicModel,
    race_friction: Ratio,
    *,
    cross_moment: NewtonMetre = 0.0,
) -> Equilibrium:
    r"""Quasi-static equilibrium of the balls and of the inner ring.

    Each ball balances its two Hertz contacts, its centrifugal force and its gyroscopic moment; the inner ring
    balances axial and radial load, and is held parallel or at `operation.tilt` or balances a given moment.

    The friction of ball on race is > 0 in the free model and unused in the others [-]. With a `cross_moment`
    about the direction of the radial load [N m] the inner ring tilts freely.

    Raises
    ------
    InputError
        No friction in the free model, no density, or loads that leave a ball beside its grooves.
    ConvergenceError
        The forces on a ball or on the ring did not balance.

    Notes
    -----
    Jones and Harris for race control, the gyroscopic friction split 0 to 2; without it the slip fields over
    both ellipses decide (docs/theory/equilibrium.md). Rigid rings, steady speeds, dry Coulomb friction, no
    force of the cage.
    """
    p, ring, at = _solved(bearing, operation, model, race_friction, cross_moment)
    return _finished(p, ring, model, at)


@kernel
def balls_in_balance(
    p: Problem, A: Array, u: Array, model: int, force: float, push: Array, by_rings: Array
) -> tuple[float, int]:
    """`solve_balls` for a caller that is not compiled."""
    return solve_balls(p, A, u, model, force, push, by_rings)


def orbit_by_diameter(
    bearing: BallBearing, operation: Operation, model: KinematicModel, race_friction: Ratio
) -> PerSecond:
    """How much faster a larger ball runs round its orbit among the others, over what its diameter is larger.

    The rings stay where the other balls hold them, and the grooves as they are: the larger ball is loaded
    more, and its angles follow. Mean over the balls [m/s of the pitch circle per m]; 0 for a bearing at rest.

    Raises
    ------
    InputError, ConvergenceError
        As `equilibrium`.
    """
    p, ring, at = _solved(bearing, operation, model, race_friction, 0.0)
    kind = FREE if model is KinematicModel.FREE else CONTROLLED
    orbits = []
    for ratio in (1.0 - LARGER, 1.0 + LARGER) if p.ball_mass > 0.0 else ():
        one = p._replace(
            ball_diameter=ratio * p.ball_diameter,
            inner_conformity=p.inner_conformity / ratio,
            outer_conformity=p.outer_conformity / ratio,
            ball_mass=ratio**3 * p.ball_mass,
            ball_inertia=ratio**5 * p.ball_inertia,
        )
        states, slopes = at.states.copy(), np.zeros((len(at.states), 6, 2))
        push = np.zeros((len(states), 6))
        reached, ball = balls_in_balance(one, at.grooves.copy(), states, kind, ring.force, push, slopes)
        if reached > SMOOTHING:
            message = (
                f"Ball {ball + 1}: its motion did not settle with a diameter {100 * (ratio - 1):+.2g} %."
            )
            raise ConvergenceError(message)
        orbits.append(p.speed * float(states[:, 2].mean()) * 0.5 * p.pitch_diameter)
    return (orbits[1] - orbits[0]) / (2.0 * LARGER * p.ball_diameter) if orbits else 0.0


def _solved(
    bearing: BallBearing,
    operation: Operation,
    model: KinematicModel,
    race_friction: Ratio,
    cross_moment: NewtonMetre,
) -> tuple[Problem, _Ring, _Place]:
    """The problem, the loads on its ring, and where ring and balls are in balance."""
    free = model is KinematicModel.FREE
    if free and not 0.0 < race_friction < math.inf:
        cure = "Without friction nothing turns the balls; use race control."
        raise InputError(
            "[film] race_friction", "must be > 0 without race control [-]", f"{race_friction:g}", cure
        )
    share = 2.0 if model is KinematicModel.INNER_RACE_CONTROL else 0.0
    p = problem(bearing, operation, share, race_friction)
    ring = _ring(bearing, operation, p, cross_moment)
    at = _static(p, ring)
    if p.ball_mass > 0.0:
        at = _controlled(p, ring, at)
        if free:
            at = _free(p, ring, at)
    return p, ring, at


class _Ring(NamedTuple):
    """Loads on the ring, and the balls to solve; turns are times d_m/2 [m] and moments over it [N]."""

    loads: Array  # along x, y, z, about y, z
    dofs: NDArray[np.int64]  # of the five, those in which the ring moves
    rest: Array  # A of a ball before the ring moves, (2,) [m]
    moved: Array  # how A of every ball moves with the ring, (ball, 2, 5)
    carried: Array  # what a ball makes of the ring's loads of what its inner race gives it, (ball, 5, 6)
    held: Array  # where the ring is held, (5,)
    ball_count: int
    force: Newton  # what counts as one unit
    tolerance: Newton


class _Place(NamedTuple):
    """Where ring and balls are, and how well the loads balance there."""

    q: Array
    states: Array  # of the balls, (ball, 6)
    grooves: Array  # A of the balls, (ball, 2)
    carried: Array  # what the balls carry, (5,) [N]
    unbalance: Newton
    iterations: int
    stuck: str = ""  # a sentence on the ball that found no balance

    def is_good(self, ring: _Ring) -> bool:
        """Whether the loads balance to what is accepted."""
        return self.unbalance <= 1e3 * ring.tolerance


def _ring(bearing: BallBearing, operation: Operation, p: Problem, cross_moment: NewtonMetre) -> _Ring:
    """Collect the loads; one ball represents all where load and ring make them alike."""
    Z, arm = bearing.ball_count, 0.5 * p.pitch_diameter
    forces = operation.axial_load or 0.0, operation.radial_load, 0.0
    loads = np.array((*forces, cross_moment / arm, -(operation.moment or 0.0) / arm), dtype=float)
    tilt = float(operation.tilt or 0.0)
    held = operation.tilt is not None or (operation.is_tilt_held and cross_moment == 0.0)
    alike = not loads[1:].any() and tilt == 0.0
    largest = float(np.abs(loads).max())
    given = np.abs(loads)[np.abs(loads) > 1e-10 * largest]  # less is rounding
    psi = 2.0 * np.pi * np.arange(1 if alike else Z) / Z
    s, c, one, no = np.sin(psi), np.cos(psi), np.ones(psi.size), np.zeros(psi.size)
    moved = [[one, no, no, s, -c], [no, c, s, no, no]]
    couples = [[no, no, no], [no, no, no], [no, no, no], [no, c / arm, -s / arm], [no, s / arm, c / arm]]
    pushes = [[one, no, no], [no, c, -s], [no, s, c], [s, no, no], [-c, no, no]]
    carried = np.concatenate((pushes, couples), axis=1) * (Z / psi.size)
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    fastest = 0.45 * p.speed + p.outer_speed
    return _Ring(
        loads=loads,
        dofs=np.arange(1 if alike else 3 if held else 5),
        rest=span * np.array((math.sin(bearing.free_angle), math.cos(bearing.free_angle))),
        moved=np.moveaxis(np.array(moved), -1, 0).copy(),
        carried=np.moveaxis(carried, -1, 0).copy(),
        held=np.array((0.0, 0.0, 0.0, 0.0, -arm * tilt)),
        ball_count=Z,
        force=largest / Z + 0.5 * p.ball_mass * p.pitch_diameter * fastest**2,
        tolerance=min(BALANCED * largest, LEAST * float(given.min()) if given.size else 0.0),
    )


@part
def _keep(into: tuple[Array, Array, Array, Array], values: tuple[Array, Array, Array, Array]) -> None:
    """Copy q, u, A and the left loads with their slopes: an assignment of slices takes seconds to compile."""
    for n in range(4):
        for j in range(values[n].shape[0]):
            for k in range(values[n].shape[1]):
                into[n][j, k] = values[n][j, k]


@part
def _loads_left(ring: _Ring, push: Array, by_rings: Array, left: Array) -> float:
    """Loads less what the balls carry, shape (5, 6): slopes of what is carried with q, then the values.

    Returns the root of their squares where the ring can move [N].
    """
    for a in range(5):
        for k in range(6):
            left[a, k] = ring.loads[a] if k == 5 else 0.0
    for j in range(push.shape[0]):
        for a in range(5):
            for b in range(6):
                share = ring.carried[j, a, b]
                left[a, 5] -= share * push[j, b]
                for k in range(5):
                    moved = ring.moved[j, 0, k], ring.moved[j, 1, k]
                    left[a, k] += share * (by_rings[j, b, 0] * moved[0] + by_rings[j, b, 1] * moved[1])
    total = 0.0
    for d in ring.dofs:
        total += left[d, 5] ** 2
    return math.sqrt(total)


@kernel
def balance_ring(
    p: Problem,
    ring: _Ring,
    model: int,
    q: Array,
    u: Array,
    A: Array,
    left: Array,
    limit: int,
    boldness: float,
) -> tuple[float, int, float, int]:
    """Damped Newton (Levenberg) on the ring, its balls kept in balance.

    In place: q, shape (5, 1), u, (ball, 6), A, (ball, 2), and `left`, (5, 6), as `_loads_left` has it. A step
    may raise the unbalance by the factor `boldness`: along a curved valley that is faster. Returns the
    unbalance [N], the steps, the smoothing of friction reached by a ball that failed at last, and its number.
    """
    dofs, n, balls, span = ring.dofs, ring.dofs.size, len(u), math.hypot(ring.rest[0], ring.rest[1])
    push, by_rings, matrix = np.zeros((balls, 6)), np.zeros((balls, 6, 2)), np.zeros((n, n + 1))
    here, good = (q, u, A, left), (q.copy(), u.copy(), A.copy(), left.copy())
    unbalance, damping, lost, step = math.inf, 0.0, 0, 0
    while True:
        for j in range(balls):
            for k in range(2):
                A[j, k] = ring.rest[k]
                for d in range(5):
                    A[j, k] += ring.moved[j, k, d] * q[d, 0]
        reached, ball = solve_balls(p, A, u, model, ring.force, push, by_rings)
        lost = 0 if reached <= SMOOTHING else lost + 1
        now = _loads_left(ring, push, by_rings, left) if lost == 0 else math.inf
        if now < boldness * unbalance:
            unbalance, damping = now, 0.1 * damping if damping > 1e-9 else 0.0
            _keep(good, here)
        elif step == 0 or damping > 1e4 or lost > 6:
            break
        else:
            damping = max((6.0 if lost == 0 else 100.0) * damping, 1e-5)
        if unbalance <= ring.tolerance or step == limit:
            break
        step += 1
        _keep(here, good)
        stiffness = ring.force / span
        for d in dofs:
            stiffness = max(stiffness, abs(left[d, d]))
        for i in range(n):
            for k in range(n):
                matrix[i, k] = left[dofs[i], dofs[k]]
            matrix[i, i] += (1e-14 + damping) * stiffness
            matrix[i, n] = left[dofs[i], 5]
        if not eliminate(matrix):
            break
        longest = 1e-300
        for i in range(n):
            longest = max(longest, abs(matrix[i, n]))
        stride = min(1.0, 0.2 * span / longest)
        for i in range(n):
            q[dofs[i], 0] += stride * matrix[i, n]
    _keep(here, good)
    return unbalance, step, reached, ball


def _balanced(p: Problem, ring: _Ring, model: int, start: _Place, limit: int, boldness: float) -> _Place:
    """Ring and balls from a place; the last place that was taken."""
    q, u, A, left = start.q.copy(), start.states.copy(), start.grooves.copy(), np.zeros((5, 6))
    rest, steps, reached, ball = balance_ring(p, ring, model, q[:, None], u, A, left, limit, boldness)
    where = f"stopped at {reached:.2g}" if math.isfinite(reached) else "found no start at 3"
    stuck = (
        f"Ball {ball + 1}: sliding friction without race control did not settle (smoothing of the slip speed "
        f"{where} of w d_m/4, limit 0.0001). Lower the speed, raise race_friction or the axial load, or use "
        "race control."
    )
    failed = reached > SMOOTHING and model in (FREE, HELD)
    return _Place(q, u, A, ring.loads - left[:, 5], rest, start.iterations + steps, stuck if failed else "")


def _settled(p: Problem, ring: _Ring, model: int, starts: list[_Place], bold_steps: int = LIMIT) -> _Place:
    """From the first start that leads there: by bold steps, then by steps that never raise the unbalance."""
    total = starts[0].iterations
    for limit, boldness in ((bold_steps, BOLD), (LIMIT, 1.0)):
        for start in starts:
            at = _balanced(p, ring, model, start._replace(iterations=total), limit, boldness)
            if at.is_good(ring):
                return at
            total = at.iterations
    return at


def _first_place(p: Problem, ring: _Ring, angle: Radian) -> _Place:
    """Where the ring would be if every ball took an even share along the load, and ball 0 at `angle`."""
    D, size, span = p.ball_diameter, float(np.abs(ring.loads).max()), math.hypot(*ring.rest)
    q: Array = D * (2.0 * size / (ring.ball_count * p.modulus * D**2)) ** (2.0 / 3.0) * ring.loads / size
    q[:2] += span * np.array((math.sin(angle), math.cos(angle))) - ring.rest
    held = [k for k in range(5) if k not in ring.dofs]
    q[held] = ring.held[held]
    balls = len(ring.moved)
    return _Place(q, np.zeros((balls, 6)), np.zeros((balls, 2)), np.zeros(5), math.inf, 0)


def _static(p: Problem, ring: _Ring) -> _Place:
    """Ring and balls without inertia: a convex problem, from several places of the ring.

    Where the radial load prevails the ring leaves the free angle for the middle of its axial clearance, along
    a curved valley that Newton's method follows slowly: then it starts nearer. Contacts that hardly give turn
    the valley into a gorge with a bend at each ball; heavy loads fill it, and fall in steps.
    """
    free, leaning = math.atan2(*ring.rest), math.atan2(ring.loads[0], ring.loads[1])
    angles = [free] if len(ring.dofs) == 1 else [free, min(leaning, free), 0.0]
    at = _settled(p, ring, STATIC, [_first_place(p, ring, angle) for angle in angles], 40)
    if at.is_good(ring):
        return at
    factor = max(HEAVY * p.modulus * p.ball_diameter**2 * ring.ball_count * BALANCED / ring.tolerance, 1.0)
    heavy = ring._replace(loads=factor * ring.loads, tolerance=factor * ring.tolerance)
    at = _first_place(p, heavy, free)._replace(iterations=at.iterations)
    while True:
        at = _balanced(p, heavy, STATIC, at, LIMIT, BOLD)
        if not at.is_good(heavy):
            raise _unbalanced(ring, at._replace(unbalance=at.unbalance / factor))
        if factor == 1.0:
            return at
        factor = max(0.1 * factor, 1.0)
        heavy = ring._replace(loads=factor * ring.loads, tolerance=factor * ring.tolerance)


def _controlled(p: Problem, ring: _Ring, good: _Place) -> _Place:
    """Ring and balls under race control: at once, or from the static answer by raising the inertia."""
    factor, step = 0.0, 1.0
    while factor < 1.0:
        trial = min(factor + step, 1.0)
        heavy = p._replace(ball_mass=trial * p.ball_mass, ball_inertia=trial * p.ball_inertia)
        at = _settled(heavy, ring, CONTROLLED, [good])
        if at.is_good(ring):
            good, factor, step = at, trial, 1.5 * step
            continue
        good, step = good._replace(iterations=at.iterations), 0.3 * step
        if step < 0.01:
            raise _failure(p, ring, good, at)
    return good


def _free(p: Problem, ring: _Ring, good: _Place) -> _Place:
    """Ring and balls without race control, from the answer under race control."""
    at = _settled(p, ring, FREE, [good])
    if not at.is_good(ring):
        raise _failure(p, ring, good, at)
    return at


def _failure(p: Problem, ring: _Ring, good: _Place, at: _Place) -> InputError | ConvergenceError:
    """Why nothing balances: the last good answer has a ball beside its grooves, or what did not converge."""
    table = contact_table(p, good.grooves, good.states)
    return _beside_grooves(p, table) or _unbalanced(ring, at)


def _unbalanced(ring: _Ring, at: _Place) -> ConvergenceError:
    message = at.stuck or (
        f"Inner ring: loads did not balance in {at.iterations} iterations (residual {at.unbalance:.3g} N, "
        f"limit {1e3 * ring.tolerance:.3g} N). Start from a lower speed or a larger axial load."
    )
    return ConvergenceError(message, at.iterations, at.unbalance)


def _beside_grooves(p: Problem, table: Array) -> InputError | None:
    """Refusal of balls that press beside their grooves: an angle or an ellipse that no groove reaches."""
    angle = np.abs(table[..., 0]) * (table[..., 1] > 0.0)
    edge = angle + np.arcsin(np.minimum(2.0 * table[..., 2] / p.ball_diameter, 1.0))
    if angle.max() > STEEPEST:
        rule = (
            f"press balls out of their grooves: a contact angle reaches {math.degrees(angle.max()):.0f} deg"
        )
        cure = "The limit is 80 deg. Lower the loads or the speed, or raise the axial load."
        return InputError("[operation] loads and speed", rule, "", cure)
    if edge.max() >= 0.5 * math.pi:
        rule = "press balls over the edges of their grooves: a contact ellipse is wider than a groove can be"
        cure = (
            "It would end more than 90 deg from the bottom. Lower the loads, or raise inner_conformity and "
            "outer_conformity."
        )
        return InputError("[operation] loads", rule, "", cure)
    return None


def _finished(p: Problem, ring: _Ring, model: KinematicModel, at: _Place) -> Equilibrium:
    """Put the answer into a record, one row for each ball of the bearing."""
    D, Z = p.ball_diameter, ring.ball_count
    if p.ball_mass == 0.0:
        last = _balanced(p, ring, HELD if model is KinematicModel.FREE else KINEMATIC, at, 0, BOLD)
        if last.stuck:
            raise _failure(p, ring, at, last)
        at = at._replace(states=last.states, grooves=last.grooves)
    u, table = at.states, contact_table(p, at.grooves, at.states)
    outside = _beside_grooves(p, table)
    if outside is not None:
        raise outside
    if len(u) == 1:
        table, u = np.repeat(table, Z, axis=0), np.repeat(u, Z, axis=0)
    angle, load, _, grip, heat = np.moveaxis(table, -1, 0)
    normal_x, normal_r = np.sin(angle) * (-1.0, 1.0), np.cos(angle) * (-1.0, 1.0)
    m, spin_x, spin_r = (u[:, k, None] for k in range(2, 5))
    race = np.concatenate((1.0 - m, -m), axis=1)  # turning of the rings as the ball sees it
    rolling = (spin_x - race) * normal_r - spin_r * normal_x
    ratio = ((spin_x - race) * normal_x + spin_r * normal_r) / rolling
    surfaces = D * (spin_x * normal_r - spin_r * normal_x) + race * (p.pitch_diameter + D * normal_r)
    orbit = p.outer_speed + p.speed * u[:, 2]
    forward, (axial, outward, along) = np.where(u[:, 3] >= 0.0, 1.0, -1.0), u[:, 3:].T
    moment = -ring.loads[4] if 4 in ring.dofs or len(ring.dofs) == 1 else -at.carried[4]
    return Equilibrium(
        model=model,
        azimuth=2.0 * np.pi * np.arange(Z) / Z,
        contact_angle_inner=angle[:, 0],
        contact_angle_outer=angle[:, 1],
        load_inner=load[:, 0],
        load_outer=load[:, 1],
        inner_contact=load[:, 0] > 0.0,
        outer_contact=load[:, 1] > 0.0,
        orbital_speed=orbit,
        pitch_angle=np.arctan2(-forward * outward, np.hypot(axial, along)),
        yaw_angle=np.arctan2(forward * along, np.abs(axial)),
        ball_spin=p.speed * u[:, 3:],
        spin_roll_ratio_inner=ratio[:, 0],
        spin_roll_ratio_outer=ratio[:, 1],
        rolling_speed_inner=0.25 * abs(p.speed) * np.abs(surfaces[:, 0]),
        rolling_speed_outer=0.25 * abs(p.speed) * np.abs(surfaces[:, 1]),
        centrifugal_force=0.5 * p.ball_mass * p.pitch_diameter * orbit**2,
        gyroscopic_moment=np.abs(p.ball_inertia * orbit * p.speed) * np.hypot(outward, along),
        heat_inner=heat[:, 0],
        heat_outer=heat[:, 1],
        race_control=tuple(
            Race.OUTER if outer * math.cos(turn) > inner else Race.INNER
            for (inner, outer), turn in zip(grip, angle[:, 0] - angle[:, 1], strict=True)
        ),
        axial_displacement=float(at.q[0]),
        radial_displacement=float(at.q[1]),
        transverse_displacement=float(at.q[2]),
        tilt=float(-at.q[4] / (0.5 * p.pitch_diameter)),
        is_tilt_held=4 not in ring.dofs,
        cross_tilt=float(at.q[3] / (0.5 * p.pitch_diameter)),
        moment=float(moment * 0.5 * p.pitch_diameter),
        friction_torque=float(heat.sum() / abs(p.speed)) if p.speed != 0.0 else 0.0,
        iterations=at.iterations,
        residual=float(at.unbalance),
    )
