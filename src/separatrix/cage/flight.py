"""Free motion of the cage in the frame that turns with the balls, exact, and the work done in it."""

from __future__ import annotations

import numpy as np

from separatrix.cage.slots import GRAVITY, GROSS, MOVING_FRAME, SPIN, THETA, UNBALANCE, VX, VY, X, Y
from separatrix.compiled import kernel


@kernel
def fly(p, t, s, dt, c, i):  # type: ignore[no-untyped-def]
    """Advance the free motion exactly: a line in space (or a parabola), seen in the turning frame."""
    W = p.turning
    ux, uy = s[VX] - W * s[Y], s[VY] + W * s[X]
    x, y = s[X] + ux * dt, s[Y] + uy * dt
    if p.gravity != 0.0:
        gx, gy = p.gravity * np.cos(W * t), -p.gravity * np.sin(W * t)
        x, y = x + 0.5 * gx * dt * dt, y + 0.5 * gy * dt * dt
        ux, uy = ux + gx * dt, uy + gy * dt
    s[X], s[Y] = c * x + i * y, c * y - i * x
    s[VX] = c * ux + i * uy + W * s[Y]
    s[VY] = c * uy - i * ux - W * s[X]
    s[THETA] += s[SPIN] * dt


@kernel
def centre(p, s):  # type: ignore[no-untyped-def]
    """Geometric centre of the cage, which the unbalance parts from its centre of mass [m]."""
    e = p.eccentricity
    if e == 0.0:
        return s[X], s[Y]
    return s[X] - e * np.cos(s[THETA]), s[Y] - e * np.sin(s[THETA])


@kernel
def drift(p, t, s, ledger, dt, c, i):  # type: ignore[no-untyped-def]
    """Advance the free motion and enter the work of gravity, moving frame and unbalance."""
    W2 = p.mass * p.turning * p.turning
    x, y = s[X], s[Y]
    cx, cy = centre(p, s)
    fly(p, t, s, dt, c, i)
    dx, dy = s[X] - x, s[Y] - y
    frame = 0.5 * W2 * ((s[X] + x) * dx + (s[Y] + y) * dy)
    unbalance = 0.0
    if p.eccentricity != 0.0:
        nx, ny = centre(p, s)
        unbalance = frame - 0.5 * W2 * ((nx + cx) * dx + (ny + cy) * dy)
        frame -= unbalance
    pull = 0.0
    if p.gravity != 0.0:
        middle = p.turning * (t + 0.5 * dt)
        pull = p.mass * p.gravity * (np.cos(middle) * dx - np.sin(middle) * dy)
    ledger[MOVING_FRAME] += frame
    ledger[UNBALANCE] += unbalance
    ledger[GRAVITY] += pull
    ledger[GROSS] += abs(frame) + abs(unbalance) + abs(pull)


@kernel
def lean(p, s, impulse_x, impulse_y, moment):  # type: ignore[no-untyped-def]
    """Kick the cage with an impulse at its geometric centre and a moment about that; return the work done."""
    e = p.eccentricity
    if e != 0.0:
        moment -= e * (np.cos(s[THETA]) * impulse_y - np.sin(s[THETA]) * impulse_x)
    dvx, dvy, dw = impulse_x * p.lightness, impulse_y * p.lightness, moment * p.swiftness
    work = impulse_x * (s[VX] + 0.5 * dvx) + impulse_y * (s[VY] + 0.5 * dvy) + moment * (s[SPIN] + 0.5 * dw)
    s[VX] += dvx
    s[VY] += dvy
    s[SPIN] += dw
    return work


@kernel
def clear_time(p, s, slack, longest):  # type: ignore[no-untyped-def]
    """Time in which nothing can touch, from the gaps left and a bound on the speed; at most `longest` [s]."""
    x, y = centre(p, s)
    reach = 0.0
    for u in slack:
        reach = max(reach, abs(u))
    gap = min(p.half_play - reach, p.land_gap - np.sqrt(x * x + y * y))
    if gap <= 0.0:
        return 0.0
    W = abs(p.turning)
    ux, uy = s[VX] - p.turning * s[Y], s[VY] + p.turning * s[X]
    speed = 1.1 * np.sqrt(ux * ux + uy * uy) + W * np.sqrt(s[X] * s[X] + s[Y] * s[Y])
    speed += abs(s[SPIN]) * (p.radius + p.eccentricity) + 1.1 * p.gravity * longest
    return min(longest, gap / speed) if speed > 0.0 else longest


@kernel
def near_land(p, s, dt):  # type: ignore[no-untyped-def]
    """Whether the cage may touch its land within a step."""
    x, y = centre(p, s)
    reach = (abs(s[VX]) + abs(s[VY]) + p.eccentricity * abs(s[SPIN]) + p.gravity * dt) * dt
    return p.land_side != 0.0 and np.sqrt(x * x + y * y) + 1.5 * reach > p.land_gap
