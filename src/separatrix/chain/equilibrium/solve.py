"""From bearing and operation to the equilibrium: checks, starting points, and the three models in turn."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from separatrix.chain.equilibrium.balance import STEEPEST, inertia_loads
from separatrix.chain.equilibrium.ball_set import Equilibrium
from separatrix.chain.equilibrium.groove import chebyshev_nodes, static_split
from separatrix.chain.equilibrium.problem import Method, Problem, problem
from separatrix.chain.equilibrium.ring import (
    FREE,
    STATIC,
    Balls,
    ball_table,
    controlled_states,
    settle_free_states,
    solve_ring,
)
from separatrix.ground.errors import ConvergenceError, InputError
from separatrix.ground.units import Array, Newton, NewtonMetre, Radian, Ratio
from separatrix.study.study import BallBearing, KinematicModel, Operation, Race

CELLS, NODES, COARSE_CELLS, COARSE_NODES = 48, chebyshev_nodes(24), 16, chebyshev_nodes(8)
"""Quadrature over an ellipse: strips across the groove, places along rolling; the same, coarse."""

LIMIT = 80
"""Newton steps of the ring; a usual case takes 3 to 8."""

BALANCED = 1e-9
"""Unbalance over the largest load at which the search ends; a thousand times as much is accepted."""

LEAST = 1e-6
"""The same over the smallest load, which must not drown in the others."""

HEAVY = 1e-5
"""Load of a ball over E* D^2 from which light loads are reached: about a quarter of a GPa."""

BOLD = 1e4
"""Factor by which one step of the ring may raise the unbalance; monotone steps are the second choice."""


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

    Parameters
    ----------
    bearing : BallBearing
        Geometry and materials; the ball material needs a density unless the speeds are 0.
    operation : Operation
        Speeds and loads on the inner ring.
    model : KinematicModel
        How the spin axis of a ball is found.
    race_friction : float
        Coulomb friction of ball on race, > 0 in the free model and unused in the others [-].
    cross_moment : float
        Moment about the direction of the radial load [N m]; with one the inner ring tilts freely.

    Returns
    -------
    Equilibrium
        Per ball, shape (ball,), and for the ring.

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
    _check(model, race_friction)
    share = 2.0 if model is KinematicModel.INNER_RACE_CONTROL else 0.0
    p = problem(bearing, operation, share, race_friction)
    setup = _setup(bearing, operation, p, cross_moment)
    q, iterations, rest, states = _static(p, setup)
    if p.inertia_factor > 0.0:
        q, iterations, rest, states = _controlled(p, setup, q, states[:, :2].copy(), iterations)
        if model is KinematicModel.FREE:
            q, iterations, rest, states = _free(p, setup, q, states, iterations)
    solved = states
    if states.shape[1] != FREE:
        states = controlled_states(p, q, setup.balls.azimuths, states)
        if model is KinematicModel.FREE:
            ball = settle_free_states(p, q, setup.balls.azimuths, states, setup.method)
            if ball >= 0:
                raise _failure(p, setup, q, states, _not_free(math.inf, ball), iterations, rest)
    return _finished(p, setup, model, q, states, solved, iterations, rest)


class _Setup(NamedTuple):
    """The ring and its balls, how to solve them, and what counts as balanced."""

    balls: Balls
    method: Method
    held_tilt: Radian
    ball_count: int
    tolerance: Newton


def _setup(bearing: BallBearing, operation: Operation, p: Problem, cross_moment: NewtonMetre) -> _Setup:
    """Collect the loads; one ball represents all where load and ring make them alike."""
    Z, arm = bearing.ball_count, 0.5 * bearing.pitch_diameter
    loads = np.array(
        (operation.axial_load, operation.radial_load, 0.0, cross_moment, -(operation.moment or 0.0)),
        dtype=float,
    )
    tilt = float(operation.tilt or 0.0)
    held = operation.tilt is not None or (operation.is_tilt_held and cross_moment == 0.0)
    alike = not loads[1:].any() and tilt == 0.0
    dofs = [0] if alike else [0, 1, 2] if held else [0, 1, 2, 3, 4]
    sizes = np.abs(loads / (1.0, 1.0, 1.0, arm, arm))
    carried = float(sizes.max())
    given = sizes[sizes > 1e-10 * carried]  # less is rounding
    force = float(carried / Z + inertia_loads(p, 0.45, 0.0)[0])
    azimuths = 2.0 * np.pi * np.arange(1 if alike else Z) / Z
    return _Setup(
        balls=Balls(loads, np.array(dofs, dtype=np.int64), azimuths, float(Z) if alike else 1.0),
        method=Method(force, CELLS, NODES, COARSE_CELLS, COARSE_NODES),
        held_tilt=tilt,
        ball_count=Z,
        tolerance=min(BALANCED * carried, LEAST * float(given.min()) if given.size else 0.0),
    )


def _solve(
    p: Problem, setup: _Setup, q: Array, states: Array, limit: int = LIMIT, boldness: float = BOLD
) -> tuple[float, int, float, int]:
    answer: tuple[float, int, float, int] = solve_ring(
        p, q, setup.balls, states, setup.method, setup.tolerance, limit, boldness, np.empty(5)
    )
    return answer


def _first_place(p: Problem, setup: _Setup, angle: Radian) -> Array:
    """Where the ring would be if every ball took an even share along the load, and ball 0 at `angle`."""
    arm, loads = 0.5 * p.pitch_diameter, setup.balls.loads
    units = np.array([1.0, 1.0, 1.0, arm, arm])
    size, trial = float(np.abs(loads / units).max()), 1e-3 * p.ball_diameter
    span = (p.inner_conformity + p.outer_conformity - 1.0) * p.ball_diameter
    hard = static_split(p, (span + trial) * p.free_sine, (span + trial) * p.free_cosine)[2]
    q: Array = loads / units**2 / size * trial * (2.0 * size / setup.ball_count / hard) ** (2.0 / 3.0)
    q[0] += span * (math.sin(angle) - p.free_sine)
    q[1] += span * (math.cos(angle) - p.free_cosine)
    if setup.held_tilt:
        q[4] = -setup.held_tilt
    held = [k for k in range(4) if k not in setup.balls.dofs]
    q[held] = 0.0
    return q


def _static(p: Problem, setup: _Setup) -> tuple[Array, int, Newton, Array]:
    """Ring and balls without inertia: a convex problem, from several places of the ring.

    Where the radial load prevails the ring leaves the free angle for the middle of its axial clearance, along
    a curved valley that Newton's method follows slowly: then it starts nearer.
    """
    free, total = math.asin(p.free_sine), 0
    leaning = math.atan2(setup.balls.loads[0], setup.balls.loads[1])
    angles = [free] if len(setup.balls.dofs) == 1 else [free, min(leaning, free), 0.0]
    for limit, boldness in ((40, BOLD), (LIMIT, 1.0)):
        for angle in angles:
            q, states = _first_place(p, setup, angle), np.zeros((setup.balls.azimuths.size, STATIC))
            rest, iterations, _, _ = _solve(p, setup, q, states, limit, boldness)
            total += iterations
            if rest <= 1e3 * setup.tolerance:
                return q, total, rest, states
    return _relieved(p, setup, total)


def _relieved(p: Problem, setup: _Setup, iterations: int) -> tuple[Array, int, Newton, Array]:
    """Ring and balls without inertia under loads that fall from heavy ones in steps.

    Contacts that hardly give turn the valley into a gorge with a bend at each ball; heavy loads fill it.
    """
    balls, size = setup.balls, setup.tolerance / BALANCED
    factor = max(HEAVY * p.modulus * p.ball_diameter**2 * setup.ball_count / size, 1.0)
    heavy = setup._replace(balls=balls._replace(loads=factor * balls.loads))
    q, states = _first_place(p, heavy, math.asin(p.free_sine)), np.zeros((balls.azimuths.size, STATIC))
    while True:
        now = setup._replace(
            balls=balls._replace(loads=factor * balls.loads), tolerance=factor * setup.tolerance
        )
        rest, count, _, _ = _solve(p, now, q, states)
        iterations += count
        if rest > 1e3 * now.tolerance:
            raise ConvergenceError(_unbalanced(rest / factor, iterations, setup), iterations, rest / factor)
        if factor == 1.0:
            return q, iterations, rest, states
        factor = max(0.1 * factor, 1.0)


def _controlled(
    p: Problem, setup: _Setup, q: Array, states: Array, iterations: int
) -> tuple[Array, int, Newton, Array]:
    """Ring and balls under race control: at once, or from the static answer by raising the inertia."""
    good_q, good_states = q.copy(), states.copy()
    factor, step = 0.0, 1.0
    while factor < 1.0:
        trial = min(factor + step, 1.0)
        for boldness in (BOLD, 1.0):
            q, states = good_q.copy(), good_states.copy()
            rest, count, _, _ = _solve(p._replace(inertia_factor=trial), setup, q, states, LIMIT, boldness)
            iterations += count
            if rest <= 1e3 * setup.tolerance:
                break
        if rest <= 1e3 * setup.tolerance:
            factor, step = trial, 1.5 * step
            good_q, good_states = q, states
        elif step > 0.03:
            step *= 0.3
        else:
            message = _unbalanced(rest, iterations, setup)
            raise _failure(p, setup, good_q, good_states, message, iterations, rest)
    return q, iterations, rest, states


def _free(
    p: Problem, setup: _Setup, q: Array, states: Array, iterations: int
) -> tuple[Array, int, Newton, Array]:
    """Ring and balls without race control, from the answer under outer race control."""
    start = q
    for boldness in (BOLD, 1.0):
        q, full = start.copy(), controlled_states(p, start, setup.balls.azimuths, states)
        rest, count, failed, ball = _solve(p, setup, q, full, LIMIT, boldness)
        iterations += count
        if rest <= 1e3 * setup.tolerance:
            return q, iterations, rest, full
    message = _not_free(failed, ball) if failed > 0.0 else _unbalanced(rest, iterations, setup)
    raise _failure(p, setup, start, states, message, iterations, rest)


def _failure(
    p: Problem, setup: _Setup, q: Array, states: Array, message: str, iterations: int, rest: Newton
) -> InputError | ConvergenceError:
    """Why nothing balances: the last answer has a ball beside its grooves; else what did not converge."""
    azimuths = setup.balls.azimuths
    outside = _beside_grooves(ball_table(p, q, azimuths, controlled_states(p, q, azimuths, states)))
    return outside or ConvergenceError(message, iterations, rest)


def _unbalanced(rest: Newton, iterations: int, setup: _Setup) -> str:
    return (
        f"Inner ring: loads did not balance in {iterations} iterations (residual {rest:.3g} N, limit "
        f"{1e3 * setup.tolerance:.3g} N). Start from a lower speed or a larger axial load."
    )


def _not_free(reached: float, ball: int) -> str:
    where = f"stopped at {reached:.2g}" if math.isfinite(reached) else "found no start at 3"
    return (
        f"Ball {ball + 1}: sliding friction without race control did not settle (smoothing of the slip speed "
        f"{where} of w d_m/4, limit 0.0001). Lower the speed, raise race_friction or the axial load, or use "
        "race control."
    )


def _check(model: KinematicModel, race_friction: Ratio) -> None:
    if model is KinematicModel.FREE and not 0.0 < race_friction < math.inf:
        rule, cure = (
            "must be > 0 without race control [-]",
            "Without friction nothing turns the balls; use race control.",
        )
        raise InputError("[film] race_friction", rule, f"{race_friction:g}", cure)


def _beside_grooves(table: Array) -> InputError | None:
    """Refusal of balls that press beside their grooves: an angle or an ellipse that no groove reaches."""
    steepest, edge = np.abs(table[:, :2] * table[:, 17:19]).max(), table[:, 19:21].max()
    if steepest > STEEPEST:
        rule = f"press balls out of their grooves: a contact angle reaches {math.degrees(steepest):.0f} deg"
        cure = "The limit is 80 deg. Lower the loads or the speed, or raise the axial load."
        return InputError("[operation] loads and speed", rule, "", cure)
    if edge >= 0.5 * math.pi:
        rule = "press balls over the edges of their grooves: a contact ellipse is wider than a groove can be"
        cure = (
            "It would end more than 90 deg from the bottom. Lower the loads, or raise inner_conformity and "
            "outer_conformity."
        )
        return InputError("[operation] loads", rule, "", cure)
    return None


def _carried_moment(p: Problem, setup: _Setup, q: Array, solved: Array) -> NewtonMetre:
    """The given moment, or what the balls return to a fixed tilt [N m]."""
    if 4 in setup.balls.dofs or len(setup.balls.dofs) == 1:
        return float(-setup.balls.loads[4])
    balance = np.empty(5)
    solve_ring(p, q.copy(), setup.balls, solved.copy(), setup.method, setup.tolerance, 0, BOLD, balance)
    return float(balance[4] - setup.balls.loads[4])


def _finished(
    p: Problem,
    setup: _Setup,
    model: KinematicModel,
    q: Array,
    states: Array,
    solved: Array,
    iterations: int,
    rest: Newton,
) -> Equilibrium:
    """Put the answer into a record, one row for each ball of the bearing."""
    table = ball_table(p, q, setup.balls.azimuths, states)
    outside = _beside_grooves(table)
    if outside is not None:
        raise outside
    Z = setup.ball_count
    rows = np.broadcast_to(table, (Z, table.shape[1])) if table.shape[0] == 1 else table
    column = [np.ascontiguousarray(rows[:, k]) for k in range(rows.shape[1])]
    return Equilibrium(
        model=model,
        azimuth=2.0 * np.pi * np.arange(Z) / Z,
        contact_angle_inner=column[0],
        contact_angle_outer=column[1],
        load_inner=column[2],
        load_outer=column[3],
        inner_contact=column[17] > 0.0,
        outer_contact=column[18] > 0.0,
        orbital_speed=column[4],
        pitch_angle=column[8],
        yaw_angle=column[9],
        ball_spin=np.stack(column[5:8], axis=1),
        spin_roll_ratio_inner=column[10],
        spin_roll_ratio_outer=column[11],
        rolling_speed_inner=column[12],
        rolling_speed_outer=column[13],
        centrifugal_force=column[14],
        gyroscopic_moment=column[15],
        race_control=tuple(Race.OUTER if grip > 0.0 else Race.INNER for grip in column[16]),
        axial_displacement=float(q[0]),
        radial_displacement=float(q[1]),
        transverse_displacement=float(q[2]),
        tilt=float(-q[4]),
        is_tilt_held=4 not in setup.balls.dofs,
        cross_tilt=float(q[3]),
        moment=_carried_moment(p, setup, q, solved),
        iterations=iterations,
        residual=float(rest),
    )
