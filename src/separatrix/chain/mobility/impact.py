"""An impact of the cage on one ball that the races hold: whole slip fields, linear modes, law of traction."""

from __future__ import annotations

import math

import numpy as np

from separatrix.chain.ball_traction import BallTraction
from separatrix.chain.equilibrium.problem import Problem, solve_linear
from separatrix.chain.mobility.field import ball_balance
from separatrix.chain.mobility.modes import Modes
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import ConvergenceError
from separatrix.ground.units import Array, Kilogram, NewtonPerMetre, Ratio

TOLERANCE = 1e-4
"""Error of a step over the speed of the impact and the depth that belongs to it."""

STAYS = 1e-4
"""An impact whose cage moves against the ball, and bounces on the pocket's spring, with less than this share
of its first speed has no end: the races stop the ball before the pocket opens, and it returns nothing."""

MOST_STEPS, LAW_STEPS = 5000, 200_000

SIZE = 8
"""Unknowns of an impact: V (2), orbit, spin (3), speed of the cage, approach."""


@part
def _rates(
    p: Problem,
    rings: Array,
    y: Array,
    start: Array,
    slips: tuple[float, float],
    cells: int,
    nodes: Array,
    mass: float,
    stiffness: float,
    sense: float,
    f: Array,
    jacobian: Array,
) -> None:
    """Right sides, shape (8,), and slopes, (8, 8): balance of the plane, momenta, cage, approach."""
    balance, slopes = np.empty(6), np.empty((6, 6))
    ball_balance(p, rings, y[:6].copy(), slips, cells, nodes, balance, slopes)
    f[:6] = balance
    jacobian[:, :] = 0.0
    jacobian[:6, :6] = slopes
    pushed = stiffness if y[7] >= 0.0 else 0.0
    unit = 0.5 * p.pitch_diameter * p.speed
    f[2] += sense * pushed * y[7]
    jacobian[2, 7] = sense * pushed
    f[6] = -pushed * y[7] / mass
    jacobian[6, 7] = -pushed / mass
    f[7] = y[6] - sense * unit * (y[2] - start[2])
    jacobian[7, 6], jacobian[7, 2] = 1.0, -sense * unit


@part
def _masses(p: Problem, masses: Array) -> None:
    """Mass matrix, shape (8, 8); that of the plane is 0."""
    masses[:, :] = 0.0
    masses[2, 2] = p.ball_mass * 0.5 * p.pitch_diameter * p.speed
    masses[3, 2] = p.ball_inertia * p.speed
    for k in range(3, 6):
        masses[k, k] = p.ball_inertia * p.speed
    masses[6, 6] = masses[7, 7] = 1.0


@part
def _scales(p: Problem, speed: float, period: float, scales: Array) -> None:
    """What counts as one unit of each unknown in the error of a step."""
    turn = speed / (0.5 * p.ball_diameter * abs(p.speed))
    scales[:2] = 1e-6 * p.ball_diameter
    scales[2], scales[3:6] = turn * p.ball_diameter / p.pitch_diameter, turn
    scales[6], scales[7] = speed, speed * period / math.pi


@part
def _stage(stage: int, M: Array, J: Array, f: Array, step: float, K: Array) -> bool:
    """One stage of RODAS3: (2 M/h - J) K = f + M (earlier stages)/h; False if the matrix is singular."""
    right, matrix = np.empty((SIZE, 1)), 2.0 * M / step - J
    for row in range(SIZE):
        total = f[row]
        for k in range(SIZE):
            if stage == 1:
                total += M[row, k] * 4.0 * K[0, k] / step
            elif stage > 1:
                total += M[row, k] * (K[0, k] - K[1, k]) / step
            if stage == 3:
                total -= M[row, k] * 8.0 / 3.0 * K[2, k] / step
        right[row, 0] = total
    solved = solve_linear(matrix, right)
    K[stage] = right[:, 0]
    return bool(solved)


@kernel
def follow_impact(
    p: Problem,
    rings: Array,
    state: Array,
    slips: tuple[float, float],
    cells: int,
    nodes: Array,
    mass: float,
    stiffness: float,
    speed: float,
    sense: float,
    tolerance: float,
) -> tuple[float, float, float, int]:
    """Speed of the cage after an impact, largest force, duration, and steps; steps -1 without an end.

    A cage that stays on the ball (`STAYS`) has the speed 0. It comes from behind the ball with `sense` 1,
    from the front with -1. RODAS3 of Sandu et al. (1997): Rosenbrock, order 3, L-stable and stiffly
    accurate, with the exact slopes; the balance in the plane of the contacts is algebraic.
    """
    period = math.pi * math.sqrt(mass / stiffness)
    y, f, J, M = np.zeros(SIZE), np.empty(SIZE), np.empty((SIZE, SIZE)), np.empty((SIZE, SIZE))
    K, trial, unused, scales = np.zeros((4, SIZE)), np.empty(SIZE), np.empty((SIZE, SIZE)), np.empty(SIZE)
    y[:6], y[6] = state, speed
    _masses(p, M)
    _scales(p, speed, period, scales)
    time, step, peak = 0.0, 1e-3 * period, 0.0
    for count in range(MOST_STEPS):
        _rates(p, rings, y, state, slips, cells, nodes, mass, stiffness, sense, f, J)
        for stage in range(4):
            if stage > 1:
                trial[:] = y + 2.0 * K[0]
                if stage == 3:
                    trial += K[2]
                _rates(p, rings, trial, state, slips, cells, nodes, mass, stiffness, sense, f, unused)
            if not _stage(stage, M, J, f, step, K):
                return 0.0, peak, time, -1
        error = np.max(np.abs(K[3, 2:]) / scales[2:])
        if error <= tolerance or step < 1e-9 * period:
            before, approach = y[6], y[7]
            y += 2.0 * K[0] + K[2] + K[3]
            time += step
            peak = max(peak, stiffness * y[7])
            if y[7] <= 0.0:  # the contact opened within the step
                share = approach / (approach - y[7])
                return before + share * (y[6] - before), peak, time - (1.0 - share) * step, count
            if y[6] ** 2 + stiffness / mass * y[7] ** 2 < (STAYS * speed) ** 2:
                return 0.0, peak, time, count
        step *= min(2.0, max(0.2, 0.8 * (tolerance / max(error, 1e-30)) ** (1.0 / 3.0)))
        step = min(step, 0.05 * max(period, 0.25 * time))  # longer where a cage comes to rest on the ball
    return 0.0, peak, time, -1


def linear_return(found: Modes, mass: Kilogram, stiffness: NewtonPerMetre) -> Ratio:
    """Restitution of an impact on a ball with linear modes, whatever its speed [-]."""
    n = len(found.masses)
    A, pushed = np.zeros((n + 2, n + 2)), np.linalg.solve(found.masses, np.eye(n)[0])
    A[:n, :n] = np.linalg.solve(found.masses, found.slopes)
    A[:n, n + 1], A[n, n + 1] = stiffness * pushed, -stiffness / mass
    A[n + 1, n], A[n + 1, 0] = 1.0, -1.0
    rates, patterns = np.linalg.eig(A)
    shares = np.linalg.solve(patterns, np.eye(n + 2)[n])

    def at(time: float, row: int) -> float:
        return float((patterns[row] @ (shares * np.exp(rates * time))).real)

    step = 0.01 * math.pi * math.sqrt(mass / stiffness)
    time = step
    while at(time, n + 1) > 0.0:
        time += step
        if at(time, n) ** 2 + stiffness / mass * at(time, n + 1) ** 2 < STAYS**2:
            return 0.0
    low, high = time - step, time
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at(middle, n + 1) > 0.0 else (low, middle)
    return -at(low, n)


def law_returns(law: BallTraction, mass: Kilogram, stiffness: NewtonPerMetre, speeds: Array) -> Array:
    """Restitution by m_e u' = N - F(u), same shape as `speeds`; Runge and Kutta's fourth order."""
    step = 0.02 * math.sqrt(1.0 / (stiffness * (1.0 / mass + 1.0 / law.mass)))
    step = min(step, 0.1 * law.mass / law.slope)

    def rates(y: Array) -> Array:
        force = stiffness * np.maximum(y[2], 0.0)
        return np.stack(((force - law.force(y[0])) / law.mass, -force / mass, y[1] - y[0]))

    y, returned = np.stack((0.0 * speeds, speeds, 0.0 * speeds)), np.full(speeds.shape, np.nan)
    for _ in range(LAW_STEPS):
        k1 = rates(y)
        k2 = rates(y + 0.5 * step * k1)
        k3 = rates(y + 0.5 * step * k2)
        k4 = rates(y + step * k3)
        y = y + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        parted = np.isnan(returned) & (y[2] <= 0.0)
        returned[parted] = -(y[1] / speeds)[parted]
        stays = y[1] ** 2 + stiffness / mass * y[2] ** 2 < (STAYS * speeds) ** 2
        returned[np.isnan(returned) & stays] = 0.0
        if not np.isnan(returned).any():
            return returned
    slowest = float(speeds[np.isnan(returned)].min())
    raise ConvergenceError(f"Mobility: an impact at {slowest:.3g} m/s does not end.", LAW_STEPS, step)
