"""One ball held between its rings by the slip fields of both contacts: what it feels, and how that changes.

The ball's motion is x = (u, spin): u [m/s] its speed along the orbit beyond the free one, and its spin
(axial, radial, orbital) in the orbiting frame [rad/s]. Its place in the plane of the contacts, V, follows the
balance of forces at once: the contact planes are slaved.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from separatrix.chain.equilibrium.balance import contact_friction, free_ball, turning_loads
from separatrix.chain.equilibrium.groove import touch
from separatrix.chain.equilibrium.problem import Problem, copy, work
from separatrix.ground.compiled import kernel
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, Newton, NewtonPerMetre, NewtonSecondPerMetre

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
    cells: int
    nodes: Array
    capacity: Newton

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
    p: Problem,
    rings: Array,
    state: Array,
    slips: tuple[float, float],
    cells: int,
    nodes: Array,
    balance: Array,
    slopes: Array,
) -> None:
    """Forces and couples on the ball with its inertia, shape (6,), and slopes with its state, (6, 6)."""
    out = work(6)
    free_ball(p, rings, state, slips, cells, nodes, balance, out)
    for q in range(6):
        copy(slopes[q], out.by_state[q])


@kernel
def groove_slopes(
    p: Problem,
    rings: Array,
    state: Array,
    slips: tuple[float, float],
    cells: int,
    nodes: Array,
    lateral: Array,
    along: Array,
) -> None:
    """Friction against a speed of the ball across each groove, shape (2,) [N s/m], and y of each, (2, 2)."""
    i = touch(p, -1.0, rings[0] - state[0], rings[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    load_o, load_i, _ = turning_loads(p, i, o)
    r = np.empty((5, 7))
    contact_friction(p, -1.0, i, load_i, state, slips[0], cells, nodes, r)
    lateral[0] = p.friction * load_i * r[4, 6] / abs(p.speed)
    along[0, 0], along[0, 1] = i.cosine, -i.sine
    contact_friction(p, 1.0, o, load_o, state, slips[1], cells, nodes, r)
    lateral[1] = p.friction * load_o * r[4, 6] / abs(p.speed)
    along[1, 0], along[1, 1] = -o.cosine, o.sine


def balanced(ball: HeldBall, state: Array) -> tuple[Array, Array]:
    """Balance of the ball in a state, shape (6,), and its slopes, (6, 6)."""
    balance, slopes = np.empty(6), np.empty((6, 6))
    ball_balance(ball.problem, ball.rings, state, ball.slips, ball.cells, ball.nodes, balance, slopes)
    return balance, slopes


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
    return slaved(slopes) / ball.units


def slaved(slopes: Array) -> Array:
    """Slopes of the orbital force and the couples with the speeds, V eliminated, shape (4, 4)."""
    follows = np.linalg.solve(slopes[:2, :2], slopes[:2, 2:])
    return np.asarray(slopes[2:, 2:] - slopes[2:, :2] @ follows)


def groove(ball: HeldBall) -> tuple[NewtonSecondPerMetre, NewtonPerMetre]:
    """Damping and stiffness of the ball centre along its grooves, where both contacts give least."""
    _, slopes = balanced(ball, ball.state)
    stiffness, directions = np.linalg.eigh(-0.5 * (slopes[:2, :2] + slopes[:2, :2].T))
    lateral, along = np.empty(2), np.empty((2, 2))
    groove_slopes(ball.problem, ball.rings, ball.state, ball.slips, ball.cells, ball.nodes, lateral, along)
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
