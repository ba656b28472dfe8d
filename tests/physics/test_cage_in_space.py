"""The cage in space: contacts of pockets and lands at one moment, symmetry, an impact, play and tilting.

P1 to P4 and E10 are numbers of dynamics3d.md, of exact rotations; there x is the axis, here z. Tilts of the
engine are of first order: its contacts differ by some R tilt^2/2, 0.4 um here.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from cages import AT_REST, TURNING, damping_of, follow

from separatrix import BallTraction, Guidance, MotionModel, PocketShape, StabilitySettings
from separatrix.cage import MovingCage, outcome, rows
from separatrix.cage.disturbance import Starts, ball_places, random_starts, start_states
from separatrix.cage.ensemble import Stop, run_rows
from separatrix.cage.numbers import look_time, numbers_of
from separatrix.cage.rows import of
from separatrix.ground.units import Array

R, Z, OMEGA = 32.5e-3, 13, 668.9886
SPACE = {
    "ball_spin": (-4083.218, 1942.614, -3.53), "ball_diameter": 11.1125e-3, "motion": MotionModel.SPACE,
    "pocket_shape": PocketShape.CYLINDRICAL, "groove_damping": 766.0, "groove_stiffness": 5.05e6,
}  # fmt: skip
ROUND = replace(TURNING, **SPACE, cage_speed=OMEGA, race_damping=356.58, ball_cage_friction=0.2)
"""A turbopump's cage with bores, without a land."""

AT_ONCE = 1e-9
"""Length of a step that shows the equations at one moment [s]."""


class Moment(NamedTuple):
    """Rates of the cage's state, by row; forces of pockets [N] and their rates; force of the lands [N]."""

    rate: Array
    push: Array
    push_rate: Array
    land_force: float

    def force(self, cage: MovingCage) -> Array:
        """Force on a cage in a ball set at rest (x, y, z) and its moment about x and y, as it speeds up."""
        along = (rows.VX, rows.VY, rows.VZ), (rows.WX, rows.WY)
        across = [cage.mass * self.rate[of(row)] for row in along[0]]
        return np.array(across + [cage.transverse * self.rate[of(row)] for row in along[1]])


def moment_at(cage: MovingCage, state: Mapping[int, float], ball: Mapping[int, Array]) -> Moment:
    """What the engine has at a state of the cage, by row, and of its balls: by one short step."""
    none = np.zeros((1, cage.ball_count))
    starts = Starts(np.zeros(1), np.zeros(1), np.ones(1), none, none, np.array([cage.ball_angles]))
    numbers, begun = numbers_of(cage, 0.5, 1.0), start_states(cage, 0.5, starts)
    first = rows.cage_states(space=True)
    one = (begun.shape[1] - first) // cage.ball_count
    begun[:] = 0.0
    begun[0, [of(row) for row in state]] = list(state.values())
    for row, values in ball.items():
        begun[0, first + of(row) :: one] = values
    n, limits = numbers.numbers.copy(), numbers.limits.copy()
    n[of(rows.STEP)], limits[outcome.MOST], limits[outcome.LEAST] = AT_ONCE, 2, 2
    numbers = numbers._replace(kind=numbers.kind._replace(steps=1), numbers=n, limits=limits)
    record = np.zeros((2, 4 + begun.shape[1] + of(rows.GWB - rows.GX) + 1 + cage.ball_count))
    run_rows(numbers.kind, [numbers], begun, ball_places(cage, starts), Stop(), np.float64, record=record)
    change = (record[1] - record[0]) / AT_ONCE
    pockets = slice(-3 - cage.ball_count, -3)
    return Moment(change[1 : 1 + first], record[0, pockets], change[pockets], float(record[0, -1]))


# P1 and P2: pocket 3 of 13, of a cage that is displaced and tilted, and its ball.

LANDS = replace(
    ROUND, cage_speed=0.0, inner_speed=0.0, pocket_clearance=1e-2, guidance=Guidance.OUTER, land_friction=0.0,
    land_restitution=1.0, land_count=2, land_spacing=12e-3, land_width=4e-3, land_stiffness=4e6,
    land_clearance=1e-3,
)  # fmt: skip
"""Two lands of P4: 1e9 N/m2, 4 mm wide, 6 mm from the middle."""


def test_two_wide_lands_hold_a_tilted_cage():
    """P4: offset .52 in a clearance of .5 mm, tilt 2 mrad towards it: 160 N and .59733333 N m."""
    now = moment_at(LANDS, {rows.X: 0.52e-3, rows.TY: 2e-3}, {})
    expected = [-160.0, 0.0, 0.0, 0.0, -0.59733333]
    # the digits given; the step of 1 ns and rounding leave less
    np.testing.assert_allclose(now.force(LANDS), expected, rtol=1e-8, atol=1e-7)
    assert now.land_force == pytest.approx(160.0, rel=1e-12)


def test_a_land_is_met_where_a_tilted_cage_leans():
    """P3: at 6 mm, offset (.3, .1) mm, tilt (8, 3) mrad: 322.17 um at 9.376 deg."""
    one = replace(LANDS, land_width=0.0, land_clearance=0.64e-3)  # the lower one is not met
    tilted = {rows.X: 0.3e-3, rows.Y: 0.1e-3, rows.TX: 8e-3, rows.TY: 3e-3}
    force = moment_at(one, tilted, {}).force(one)[:2]
    away = np.linalg.norm(force) / one.land_stiffness + 0.32e-3
    # 0.05 um and 0.09 deg (0.5 um) measured; R tilt^2/2 is 1.3 um.
    assert away == pytest.approx(0.5e-3 - 177.8263833e-6, abs=1.2e-7)
    assert math.degrees(math.atan2(-force[1], -force[0])) == pytest.approx(9.3763, abs=0.2)


def test_an_impact_in_space_keeps_momentum_along_the_orbit_and_about_the_axis():
    """Of a cage and a ball that the races let go, in a bore that leans; friction without a lever."""
    m, law = 6.567e-3, BallTraction(mass=6.567e-3, slope=1e-9, speed=math.inf)
    cage = replace(
        ROUND, cage_speed=0.0, ball_count=1, traction=law, pocket_axial_offset=1e-4, ball_diameter=0.0,
        groove_damping=math.inf, ball_cage_friction=0.3,
    )  # fmt: skip
    start = {"kick": 0.5, "direction": 1.2, "duration": 1.5e-3, "until": 1.5e-3}
    found = follow(cage, ball_lead=np.zeros(1), **start)
    pushed = m * found.ball_speed[:, 0]
    # Friction has a lever of 1e-9 m where no diameter is given, 0.3e-9/R of the pushed ball's momentum: 9e-9.
    assert pushed[-1] > 1e-3
    assert np.abs(found.axial_speed).max() > 0.01
    linear = cage.mass * found.velocity[:, 1] + pushed
    turning = cage.moment_of_inertia * found.rotation_rate + R * pushed
    # 4e-11: what traction takes
    np.testing.assert_allclose(linear, linear[0], rtol=1e-10)
    np.testing.assert_allclose(turning, 0.0, atol=2e-8 * R * pushed[-1])


def growing(friction: float, **change: object) -> float:
    """Share of 48 runs of the ring of E10, in bores, with more energy at 0.3 s than at their start."""
    pitch, kick = math.radians(25.44303), 0.5
    # so fast that friction follows the spin alone, and without a lever
    spin = (-1e12 * math.cos(pitch), 1e12 * math.sin(pitch), 0.0)
    ring = {"ball_spin": spin, "ball_diameter": 0.0, "groove_damping": 370.0, "race_damping": damping_of(0.8)}
    cage = replace(AT_REST, **SPACE | ring, ball_cage_friction=friction, **change)
    starts = random_starts(cage, StabilitySettings(ball_scatter=0.3), 0, 48)
    numbers = numbers_of(cage, kick, 0.3, least=0.3)
    begun, places = start_states(cage, kick, starts), ball_places(cage, starts)
    raw = run_rows(numbers.kind, [numbers] * 48, begun, places, Stop())
    energy = raw.looks[:, int(0.3 / look_time(cage)) - 1, of(rows.ENERGY)]
    return float(np.mean(~(energy < 0.5 * cage.mass * kick**2)))


@pytest.mark.parametrize(("held", "friction"), [(False, 0.062), (True, 0.119)])
def test_a_cage_in_round_bores_that_may_tilt_whirls_at_half_the_friction(held, friction):
    """E10: half of the runs grow at .062, with tilt held at .119, by another program's 48 runs: 10 %."""
    frictions = friction * np.linspace(0.85, 1.2, 5)
    shares = [growing(f, is_tilt_held=held) for f in frictions]
    slope, offset = np.polyfit(frictions, shares, 1)
    # .0640 and .1236 measured with 96 runs, each to 2 % by their number; with 48 to 3 %.
    assert (0.5 - offset) / slope == pytest.approx(friction, rel=0.10)


def test_a_free_cage_wobbles():
    """E4: J_p w / J_t, 206.6285 Hz in space, is 100.1557 Hz in the turning frame."""
    ring = {"moment_of_inertia": 2.671250e-5, "transverse_inertia": 1.376458e-5, "tilt_kick": 1.0}
    cage = replace(ROUND, **ring, pocket_clearance=0.2, dynamic_unbalance=0.0)
    free = follow(cage, kick=0.1, direction=0.0, ball_lead=np.zeros(Z), duration=0.05, until=0.05)
    in_space = free.lean_rate + OMEGA * np.stack([-free.lean[:, 1], free.lean[:, 0]], axis=1)
    angle = np.unwrap(np.arctan2(in_space[:, 1], in_space[:, 0]))
    turning = (angle[-1] - angle[0]) / (free.time[-1] - free.time[0]) / (2.0 * math.pi)
    # To half of the last digit and, as much again, what moments of seven digits leave open; to the closed
    # form by the step's error, of 0.01 rad over five turns.
    assert turning == pytest.approx(100.1557, abs=1e-4)
    wobble = cage.moment_of_inertia / cage.transverse * OMEGA / (2.0 * math.pi)
    assert turning + OMEGA / (2.0 * math.pi) == pytest.approx(wobble, rel=3e-10)  # 1e-10 measured
