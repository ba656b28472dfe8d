"""Friction of whole slip fields: full sliding, power, symmetry, and the smoothing of Coulomb's corner."""

import math

import numpy as np
import pytest
from cages import BEARING_218 as BEARING
from mobile_balls import RPM, study_of
from scipy.special import ellipe

from separatrix.chain.equilibrium import Equilibrium, contact, equilibrium
from separatrix.chain.grooved_ball import contact_actions, problem, touch
from separatrix.chain.slip_friction import NODES, chebyshev_nodes, friction_resultants
from separatrix.ground.units import Array
from separatrix.study.study import KinematicModel, Operation, Race

def resultants(c: tuple[float, ...], a: float, b: float, smoothing: float, cells: int = 48) -> Array:
    """Per unit load and friction, on a ball of 1 cm radius."""
    out = np.empty((5, 7))
    friction_resultants(np.array(c), a, b, 1e-2, 1.02e-2, smoothing, chebyshev_nodes(cells // 2), out)
    return out


@pytest.mark.parametrize("ratio", [1.0, 0.5, 0.12])
def test_spin_moment_in_full_sliding(ratio: float):
    """Pure spin: (3/8) a E(1 - b^2/a^2) per unit of friction and load."""
    a = 1e-3
    moment = resultants((1.0, 0.0, 0.0, 0.0), a, ratio * a, 1e-12)[0, 0]
    # 48 strips: the error falls as their width squared, 1/48^2
    assert moment == pytest.approx(0.375 * a * ellipe(1.0 - ratio**2), rel=1e-3)


def test_resultants_converge_with_the_strips():
    """Rolling with Heathcote slip and a line of no slip anywhere: 48 strips are within 3e-3 of 960."""
    for offset in np.linspace(0.0, 3e-6, 7):
        c = (0.02, 1.0, -1e-2 + offset, 0.0)
        coarse, fine = resultants(c, 1e-3, 2e-4, 1e-8), resultants(c, 1e-3, 2e-4, 1e-8, 960)
        # where two such lines meet at y = 0 a few strips of 48 have slip that is not linear in y
        assert coarse[2, 0] == pytest.approx(fine[2, 0], abs=3e-3)
        assert coarse[0, 0] == pytest.approx(fine[0, 0], abs=3e-3 * 1e-3)


def test_slopes_are_those_of_the_resultants():
    """Central differences of every coefficient, with rolling, spin, lateral slip and curvature at once."""
    c = np.array((0.3, 0.02, -2.1e-4, 1.5e-3))
    out = resultants(tuple(c), 1.1e-3, 2e-4, 2e-5)
    for k, step in enumerate((1e-6, 1e-8, 1e-10, 1e-8)):
        more, less = c.copy(), c.copy()
        more[k] += step
        less[k] -= step
        change = resultants(tuple(more), 1.1e-3, 2e-4, 2e-5) - resultants(tuple(less), 1.1e-3, 2e-4, 2e-5)
        # differences of 1e-16/1e-6 and a second-order step error
        assert out[:, 1 + k] == pytest.approx(change[:, 0] / (2 * step), rel=2e-4, abs=1e-9)


def free(inner: float, outer: float = 0.0, friction: float = 0.15, **loads: float) -> Equilibrium:
    """The 218 bearing without race control."""
    loads = {"axial_load": 22_250.0} | loads
    operation = Operation(inner_speed=inner * RPM, outer_speed=outer * RPM, **loads)
    return equilibrium(BEARING, operation, KinematicModel.FREE, friction)


@pytest.mark.parametrize("speeds", [(10_000.0, 0.0), (0.0, 6000.0), (8000.0, -3000.0)])
def test_reversed_rotation_mirrors_the_state(speeds):
    """Both speeds reversed: same loads and angles, speeds reversed, yaw the other way."""
    one, two = free(*speeds), free(-speeds[0], -speeds[1])
    same = {"rel": 1e-7, "abs": 1e-9}  # solver tolerance
    assert two.contact_angle_inner == pytest.approx(one.contact_angle_inner, **same)
    assert two.load_outer == pytest.approx(one.load_outer, **same)
    assert two.orbital_speed == pytest.approx(-one.orbital_speed, **same)
    assert two.spin_roll_ratio_inner == pytest.approx(one.spin_roll_ratio_inner, **same)
    assert two.ball_spin[:, :2] == pytest.approx(-one.ball_spin[:, :2], rel=1e-6, abs=1e-4)
    assert two.ball_spin[:, 2] == pytest.approx(one.ball_spin[:, 2], rel=1e-4, abs=1e-3)


def test_balls_alike_are_solved_alike():
    """One ball for all, and every ball on its own under a hair of radial load, agree."""
    one, many = free(10_000.0), free(10_000.0, radial_load=1e-3)
    assert many.load_inner == pytest.approx(one.load_inner, rel=1e-5)  # 1e-3 N over 16 balls of 1850 N
    assert many.spin_roll_ratio_inner == pytest.approx(one.spin_roll_ratio_inner, rel=1e-5)


@pytest.mark.parametrize("speeds", [(10_000.0, 0.0), (0.0, 6000.0), (-7000.0, 3000.0)])
def test_power_of_the_rings_is_lost_in_sliding(speeds):
    """What both rings put into a ball equals friction times slip: steady inertia does no work."""
    result = free(*speeds)
    operation = Operation(inner_speed=speeds[0] * RPM, outer_speed=speeds[1] * RPM, axial_load=22_250.0)
    p = problem(BEARING, operation, 0.0, 0.15)
    orbit = (result.orbital_speed[0] - p.outer_speed) / p.speed
    given, lost = 0.0, result.heat_inner[0] + result.heat_outer[0]
    rings = ((-1.0, operation.inner_speed, Race.INNER), (1.0, operation.outer_speed, Race.OUTER))
    for side, ring, race in rings:
        angle = (result.contact_angle_inner if side < 0 else result.contact_angle_outer)[0]
        load = (result.load_inner if side < 0 else result.load_outer)[0]
        length = 0.023167 * 22.23e-3 + contact(result, BEARING, race, 0).approach
        at = touch(p, side, length * math.sin(angle), length * math.cos(angle))
        state = np.array((0.0, 0.0, orbit, *(result.ball_spin[0] / p.speed)))
        smoothing, acts = 1e-4 * 0.25 * p.pitch_diameter, np.empty((6, 7))
        contact_actions(p, side, at, load, 0.0, state, smoothing, NODES, acts)
        force = acts[:, 0]
        given += ring * (0.5 * p.pitch_diameter * force[2] + force[3])
    assert lost > 0.0
    assert given == pytest.approx(lost, rel=1e-6)  # the balls balance to 1e-9 of their friction
    heat = np.sum(result.heat_inner + result.heat_outer)
    assert result.friction_torque * abs(p.speed) == pytest.approx(heat, rel=1e-12)  # rounding


@pytest.mark.parametrize(
    ("name", "inner", "outer", "torque"),
    [
        ("cryo", 17.2370, 7.1120, 0.20151),
        ("le7", 52.0184, 28.7249, 0.15421),
        ("wheel 2000", 0.00147, 0.00217, 1.91e-4),
        ("wheel 6000", 0.01031, 0.00257, 2.25e-4),
    ],
)
def test_heat_and_torque_of_an_independent_program(name, inner, outer, torque):
    """Of rigid bodies on their whole slip fields (balls integrated in space to their steady state)."""
    given = study_of(name)
    result = equilibrium(given.bearing, given.operation, KinematicModel.FREE, given.film.race_friction)
    # 24 nodes for the whole ellipse leave 1e-4, another rounding of Coulomb's corner 3e-4; near free rolling,
    # in the wheel, that counts most (a tenth of the rounding moves its damping by 9 %); and their digits
    near, digits = (1.5e-2, 5e-3) if name.startswith("wheel") else (5e-4, 2e-4)
    assert result.heat_inner[0] == pytest.approx(inner, rel=near)
    assert result.heat_outer[0] == pytest.approx(outer, rel=near)
    # three digits of the wheel, and the same reasons; five of the others
    assert result.friction_torque == pytest.approx(torque, rel=digits)


def test_friction_cannot_hold_what_it_has_not():
    """The less friction, the less pitch: the gyroscopic moment J w_m w_R sin(beta) stays below 2 mu Q D/2."""
    pitches = []
    for friction in (0.2, 0.02, 0.005):
        result = free(10_000.0, friction=friction)
        limit = 0.5 * friction * 22.23e-3 * (result.load_inner + result.load_outer)
        assert (result.gyroscopic_moment <= limit).all()
        pitches.append(result.pitch_angle[0])
    assert pitches[0] > pitches[1] > pitches[2] > 0.0


def test_much_friction_spins_least_at_the_better_held_race():
    """Jones's criterion names the race where the free ball spins less."""
    result = free(10_000.0, friction=0.3)
    assert result.race_control[0].value == "outer"
    assert abs(result.spin_roll_ratio_outer[0]) < abs(result.spin_roll_ratio_inner[0])
