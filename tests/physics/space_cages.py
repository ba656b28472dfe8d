# ruff: noqa: E501 - a draft
"""Cages in space from which the tests start, balls on which they are pushed, and the equations at one moment."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from cages import AT_REST, TURNING

from separatrix.ball_traction import BallTraction
from separatrix.cage import MovingCage, outcome, rows
from separatrix.cage.disturbance import Starts, ball_places, start_states
from separatrix.cage.ensemble import Stop, run_rows
from separatrix.cage.numbers import numbers_of
from separatrix.cage.rows import of
from separatrix.pocket_shape import PocketShape
from separatrix.study import MotionModel
from separatrix.units import Array

PITCH = math.radians(25.44303)
SPUN = {"ball_spin": (-4083.218, 1942.614, -3.53), "ball_diameter": 11.1125e-3}
"""Spin of a turbopump's balls; without it friction acts along the radius."""

CRYO = BallTraction(mass=6.567e-3, slope=188.0, speed=73.0 / 188.0)
"""A turbopump's ball: 73 N at most."""

WHEEL = BallTraction(mass=1.289e-3, slope=74.3, speed=1.3 / 74.3)
"""A momentum wheel's: 1.3 N at most."""

LEADS = 9e-5 * np.array([0.02, 0.9, -0.71, 0.9, -0.38, -0.15, 0.65, -0.18, 0.1, -0.94, 0.51, 0.08, -0.34])


def in_space(cage: MovingCage, **changes: object) -> MovingCage:
    """Return the cage in space, half as inert about a diameter as about its axis, among a turbopump's balls."""
    given = SPUN | {"groove_damping": 766.0, "groove_stiffness": 5.05e6, "motion": MotionModel.SPACE}
    return replace(cage, **(given | changes))


ROUND = in_space(
    replace(TURNING, race_damping=356.58, ball_cage_friction=0.2, pocket_shape=PocketShape.CYLINDRICAL)
)
"""A turbopump's cage with bores, without a land."""


def ring(friction: float, *, clearance: float = 3e-4, eta: float = 0.8, **changes: object) -> MovingCage:
    """Return the thin ring of dynamics3d's E9 and E10, in a ball set at rest; friction has no lever."""
    damping_ratio = -math.log(eta) / math.hypot(math.pi, math.log(eta))
    plane = replace(
        AT_REST,
        race_damping=math.sqrt(AT_REST.ball_cage_stiffness * AT_REST.mass) / (2.0 * damping_ratio),
        pocket_clearance=clearance,
        ball_cage_friction=friction,
        pocket_shape=PocketShape.CYLINDRICAL if clearance else PocketShape.SQUARE,
    )
    spin = (-1e15 * math.cos(PITCH), 1e15 * math.sin(PITCH), 0.0)
    return in_space(plane, **({"ball_spin": spin, "ball_diameter": 0.0, "groove_damping": 370.0} | changes))


def starts_at(
    cage: MovingCage, direction: float = 0.3, lead: Array | None = None, tilt_way: float = 0.0
) -> Starts:
    """Start of one run: direction of the disturbance and of its tilt [rad], leads [m]."""
    Z = cage.ball_count
    return Starts(
        direction=np.array([direction]),
        tilt_direction=np.array([tilt_way]),
        axial_sense=np.ones(1),
        lead=np.zeros((1, Z)) if lead is None else np.array([lead]),
        more=np.zeros((1, Z)),
        angle=np.array([cage.ball_angles]),
    )


class Moment(NamedTuple):
    """What the equations give at one state: rates of the cage's state by row, forces of pockets and of the land [N]."""

    rate: Array
    contact_force: Array
    land_force: float


def moment_at(
    cage: MovingCage, state: Mapping[int, float], ball: Mapping[int, Array] | None = None
) -> Moment:
    """Equations of the engine at a state of the cage, by row, and of its balls: by one step of a picosecond."""
    numbers, starts = numbers_of(cage, 0.5, 1.0), starts_at(cage)
    begun, first = start_states(cage, 0.5, starts), rows.cage_states(space=cage.is_in_space)
    begun[:, :first] = 0.0
    begun[0, [of(row) for row in state]] = list(state.values())
    one = (begun.shape[1] - first) // cage.ball_count
    for row, values in (ball or {}).items():
        begun[0, first + of(row) :: one] = values
    n, limits = numbers.numbers.copy(), numbers.limits.copy()
    n[of(rows.STEP)], limits[outcome.MOST], limits[outcome.LEAST] = 1e-12, 2, 2
    numbers = numbers._replace(kind=numbers.kind._replace(steps=1), numbers=n, limits=limits)
    record = np.zeros((2, 2 + begun.shape[1] + of(rows.GWB) + 1 - of(rows.GX) + cage.ball_count))
    run_rows(numbers.kind, [numbers], begun, ball_places(cage, starts), Stop(), np.float64, record=record)
    rate = (record[1, 1 : 1 + first] - record[0, 1 : 1 + first]) / 1e-12
    return Moment(rate, record[0, -1 - cage.ball_count : -1], float(record[0, -1]))
