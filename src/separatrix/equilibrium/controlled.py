"""A ball under race control, solved from wherever it starts."""

from __future__ import annotations

import math

from separatrix.compiled import kernel
from separatrix.equilibrium.ball import TOLERANCE, newton_ball
from separatrix.equilibrium.groove import static_split, touch
from separatrix.equilibrium.problem import Method, Problem, Work
from separatrix.equilibrium.race_control import (
    controlled_kinematics,
    inertia_loads,
    inner_share,
    rest_on_outer,
)
from separatrix.units import Array


@kernel
def wedged(p: Problem, A: Array, load_i: float, load_o: float, state: Array) -> None:
    """Put the ball where it is pressed into both grooves by these loads: where two circles meet."""
    D, trial = p.ball_diameter, 1e-3 * p.ball_diameter
    rest_i, rest_o = (p.inner_conformity - 0.5) * D, (p.outer_conformity - 0.5) * D
    hard_i = touch(p, -1.0, 0.0, rest_i + trial, 0.0).load
    hard_o = touch(p, 1.0, 0.0, rest_o + trial, 0.0).load
    r_i = rest_i + trial * (load_i / hard_i) ** (2.0 / 3.0)
    r_o = rest_o + trial * (load_o / hard_o) ** (2.0 / 3.0)
    span = math.hypot(A[0], A[1])
    s, c = A[0] / span, A[1] / span
    along = 0.5 * (span + (r_o * r_o - r_i * r_i) / span)
    across = math.sqrt(max(r_o * r_o - along * along, 0.0))
    lean = -1.0 if A[0] >= 0.0 else 1.0  # towards the radial direction
    state[0], state[1] = along * s + lean * across * c, along * c - lean * across * s


@kernel
def controlled_start(p: Problem, A: Array, attempt: int, state: Array) -> None:
    """Put the ball where the search may start: at rest, on its static line, or wedged."""
    static_x, static_r, load = static_split(p, A[0], A[1])
    F, _ = inertia_loads(p, 0.45, 0.0)
    if attempt == 0:
        if not rest_on_outer(p, A, state) and load > 0.0:
            state[0], state[1] = static_x, static_r
        return
    share = 0.2 ** (attempt - 1)
    wedged(p, A, load + share * F, load + (1.0 + share) * F, state)


@kernel
def solve_controlled(p: Problem, A: Array, state: Array, method: Method, out: Work) -> bool:
    """Ball under race control: from `state`, then from the starts above."""
    for attempt in range(-1, 7):
        if attempt >= 0:
            controlled_start(p, A, attempt, state)
        limit = 15 if attempt < 0 else 40
        if newton_ball(p, A, state, 0.0, True, method, out, limit, TOLERANCE) <= TOLERANCE:
            return True
    return False


@kernel
def kinematic_start(p: Problem, A: Array, state: Array) -> None:
    """Give a free ball the orbit and spin of race control at its place."""
    i = touch(p, -1.0, A[0] - state[0], A[1] - state[1], 0.0)
    o = touch(p, 1.0, state[0], state[1], 0.0)
    angle_i, angle_o = math.atan2(i.sine, i.cosine), math.atan2(o.sine, o.cosine)
    share, _ = inner_share(p, i.load)
    state[2], state[3], state[4] = controlled_kinematics(p, angle_i, angle_o, share)
    state[5] = 0.0
