"""A free ball, as the engine has it: spin-up, pivoting and sliding.

E1 and E3 are numbers of dynamics3d.md. The engine integrates a contact in six strips, each with one
mean slip: exact where the slip is the same everywhere, within some percent where it pivots.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from separatrix import BallModel, MotionModel, PocketShape, read_study, solve
from separatrix.cage import moving_cage, rows
from separatrix.cage.ball import race_force, slip_field
from separatrix.cage.motion import ball_rates, held_spins, hold_spins, stage_end
from separatrix.cage.numbers import numbers_of, pocket_rectangle
from separatrix.cage.rows import LANES, RACE_ROWS
from separatrix.chain.slip_friction import chebyshev_nodes, friction_resultants

M, RADIUS, ORBIT, SPEED, Q, MU = 2.029805e-3, 3.969e-3, 19.25e-3, 50_000 * math.pi / 30.0, 600.0, 0.1
V, J = SPEED * (ORBIT - RADIUS), 0.4 * M * RADIUS**2


def race(outward: float) -> np.ndarray:
    """Numbers of a race at no contact angle, a point; 1e-5 of V rounds Coulomb."""
    numbers = np.zeros((RACE_ROWS // LANES, LANES))
    numbers[1], numbers[2], numbers[8] = outward, MU * Q, (1e-5 * V) ** 2
    return numbers.ravel()


def test_a_ball_is_spun_up_by_the_driving_race():
    """E1: u = (10/7)(mu Q/m) t up to V/2 at 7 m V/(20 mu Q); the other race rolls, and carries 3/7 mu Q."""
    inner, outer = race(-1.0), race(1.0)

    def forces(y):
        return [race_force.py_func(p, 0, 0, y[0], y[1], 0.0, 0.0, RADIUS) for p in (inner, outer)]

    def rates(_, y):
        (f, couple, *_), (g, other, *_) = forces(y)
        return np.array([(f + g) / M, (couple + other) / J])

    end = 7.0 * M * V / (20.0 * MU * Q)
    times = np.array((0.5, 1.1)) * end
    start = np.array([-0.5 * V, 0.5 * V / RADIUS])
    how = {"method": "Radau", "rtol": 1e-9, "atol": (1e-6, 1e-4), "t_eval": times}
    speed, turn = solve_ivp(rates, (0.0, times[-1]), start, **how).y
    # From rest, which is V/2 below free rolling. The rolling race creeps by some 5e-6 of V.
    assert speed[0] + 0.5 * V == pytest.approx(10.0 / 7.0 * MU * Q / M * times[0], rel=1e-5)
    assert abs(speed[1]) < 1e-5 * V
    (driven, *_), (rolled, *_) = forces((speed[0], turn[0]))
    assert driven == pytest.approx(MU * Q, rel=1e-8)
    assert rolled == pytest.approx(3.0 / 7.0 * MU * Q, rel=1e-5)


PIVOTING = [
    (0.01, 0.01178068, 0.58898972), (0.1, 0.11751520, 0.58318023), (0.25, 0.28992237, 0.55309595),
    (0.5, 0.55223308, 0.45559229), (1.0, 0.88357293, 0.22089323), (2.0, 0.97427858, 0.10190933),
    (5.0, 0.99598266, 0.04011545),
]  # fmt: skip
"""v/(a w), F/(mu N), M/(mu N a) of E3 by quadrature about the instant centre; the notes have the same six
digits, but for two forces: .117516 and .289921."""


def pivot(slide: float, spin: float = 1.0) -> tuple[float, float]:
    """Force and moment of a circular contact of unit radius by whole slip fields, extrapolated."""
    found, out = [], np.empty((5, 7))
    for cells in (100, 200):
        c = np.array((spin, 0.0, slide, 0.0))
        friction_resultants(c, 1.0, 1.0, 50.0, 1e13, 1e-9, chebyshev_nodes(cells // 2), out)
        found.append(out[[2, 0], 0].copy())
    force, moment = (4.0 * found[1] - found[0]) / 3.0
    return float(force), float(moment)


@pytest.mark.parametrize(("slide", "force", "moment"), PIVOTING)
def test_sliding_and_pivoting_share_the_friction(slide, force, moment):
    """E3, Contensou, on a circular Hertz contact: 4e-6 is what the extrapolation of slip fields leaves."""
    # The engine's six strips are off by 7.7 % of the force and 15.4 % of the moment.
    assert pivot(slide) == pytest.approx((force, moment), abs=4e-6)
    found = slip_field.py_func(np.float64(slide), 1.0, 0.0, 0.0, 0.25, 1e-18)
    assert found[0] == pytest.approx(force, rel=0.08)
    assert found[1] == pytest.approx(moment, rel=0.16)


def test_a_pivoting_ball_stops():
    """E3: after 16 J w/(3 pi mu N a), .716749 s, as the moment does not depend on the spin."""
    moments = [pivot(0.0, spin)[1] for spin in (1.0, 1e-3)]
    # 3e-6 is what the extrapolation of slip fields leaves
    assert moments == pytest.approx([3.0 * math.pi / 16.0] * 2, rel=3e-6)
    assert 4.222e-9 * 1000.0 / (0.1 * 1.0 * 1e-4 * moments[0]) == pytest.approx(0.716749, rel=3e-6)


def field_slopes(race, side):
    """Rates of (traction, moment over a, side force) of a whole slip field with (slip, pivoting, side)."""
    e, z = np.meshgrid((np.arange(400) + 0.5) / 200 - 1.0, (np.arange(64) + 0.5) / 32 - 1.0, indexing="ij")
    along = race.axis_ratio * z * np.sqrt(1.0 - e * e)
    load = (1.0 - e * e) * np.sqrt(1.0 - z * z)

    def forces(slip, pivoting, across):
        v, w = slip + pivoting * e - race.heathcote * e * e, across - pivoting * along
        share = load / load.sum() / np.sqrt(v * v + w * w + race.elastic_slip**2)
        return np.array([(share * v).sum(), (share * (e * v - along * w)).sum(), (share * w).sum()])

    at = np.array([race.slip, race.pivoting, side])
    return np.stack([(forces(*(at + d)) - forces(*(at - d))) / 2e-5 for d in 1e-5 * np.eye(3)], axis=1)


@pytest.mark.parametrize(
    ("study", "error"), [("cryogenic-turbopump", 0.02), ("lox-turbopump", 0.07), ("momentum-wheel", 0.13)]
)
def test_a_slow_push_meets_the_damping_of_whole_slip_fields(study, error):
    """Six strips resist a push that all spins follow by 1.4, 6 and 11 % more than a field of 400 x 64 points.

    Their four rates differ by 0.4 to 14 %. The most in a wheel, which rolls nearly freely, so that elastic
    slip decides. With its contact plane held a ball of the first study has C_eff = 188.0 N s/m
    (docs/theory/mobility.md).
    """
    cage = moving_cage(solve(read_study(study)), 0.1, BallModel.FREE)
    (damping, rates), (strips, strip_rates) = (
        damping_and_rates(cage, slopes(cage)) for slopes in (slopes_of_fields, slopes_of_engine)
    )
    if study == "cryogenic-turbopump":
        assert damping == pytest.approx(188.0, rel=0.005)  # a film's elastic slip for that of bare steel
    assert damping < strips < (1.0 + error) * damping
    assert strip_rates == pytest.approx(rates, rel=0.15)


def test_a_ball_that_no_race_holds_keeps_its_spin_in_space():
    """In the turning frame, to the rounding of differences of a millionth: its spin turns back by as much."""
    held = moving_cage(solve(read_study("cryogenic-turbopump")), 0.1, BallModel.FREE)
    races = {name: replace(getattr(held.free_ball, name), limit=1e-15) for name in ("inner", "outer")}
    cage, (_, o_r, o_t) = replace(held, free_ball=replace(held.free_ball, **races)), held.spin
    om, R = held.cage_speed, held.pitch_radius
    back = [[0, 0, 0, 0], [0, 0, 0, 0], [o_t / R, 0, 0, om], [-o_r / R, 0, -om, 0]]
    assert slopes_of_engine(cage) == pytest.approx(np.array(back), rel=1e-6, abs=1e-6 * om)


def damping_and_rates(cage, slopes):
    """Force of a slow push over its speed, and how fast speed and spins decay, from slopes of their rates."""
    push = np.array([1.0, -1.0 / cage.pitch_radius, 0.0, 0.0]) / cage.free_ball.mass
    return -1.0 / np.linalg.solve(slopes, push)[0], np.sort(-np.linalg.eigvals(slopes).real)


def slopes_of_fields(cage):
    """Slopes of the rates of a ball's speed and spins (z, r, t) with them, by whole slip fields."""
    ball, (_, o_r, o_t), om, R = cage.free_ball, cage.spin, cage.cage_speed, cage.pitch_radius
    h, J = cage.lever, ball.inertia
    forces = J * np.array([[0, 0, 0, 0], [0, 0, 0, 0], [o_t / R, 0, 0, om], [-o_r / R, 0, -om, 0]])
    for race in (ball.inner, ball.outer):
        nz, nr, a = race.normal_axial, race.normal_radial, race.semi_major
        slips = np.array(
            [[1.0 + h * nr / R, h * nr, -h * nz, 0], [a * nz / R, a * nz, a * nr, 0], [0, 0, 0, h]]
        )
        arms = np.array([[1.0, 0, 0], [h * nr, a * nz, 0], [-h * nz, a * nr, 0], [0, 0, h]])
        forces = forces - race.limit * arms @ field_slopes(race, h * o_t) @ slips
    gains = np.diag([1.0 / ball.mass, 1.0 / J, 1.0 / J, 1.0 / J])
    gains[1, 0] = -1.0 / (ball.mass * R)
    return gains @ forces


def test_races_hold_a_ball_of_less_load_less():
    """In proportion to its share; what is left without any are the gyroscopic terms, which damp nothing."""
    cage = moving_cage(solve(read_study("cryogenic-turbopump")), 0.1, BallModel.FREE)
    none, third, whole = (slopes_of_engine(cage, share) for share in (0.0, 1.0 / 3.0, 1.0))
    # rounding of differences of 1e-5 m/s
    np.testing.assert_allclose(third, none + (whole - none) / 3.0, rtol=1e-9, atol=1e-7 * np.abs(whole).max())
    assert np.trace(none) == pytest.approx(0.0, abs=1e-9 * np.abs(np.trace(whole)))
    assert np.trace(whole) < 0.0


@pytest.mark.parametrize("share", [1.0, 0.3])
@pytest.mark.parametrize("study", ["cryogenic-turbopump", "momentum-wheel"])
def test_spins_are_held_by_the_slopes_of_the_races(study, share):
    """Inverse of I - h J/4 about free rolling: J but for gyroscopic terms and couplings of the spin ahead."""
    # To 5e-3 of the largest slope, 3.5e-3 measured: what the spin's slip across adds is left out as well.
    cage = moving_cage(solve(read_study(study)), 0.1, BallModel.FREE)
    p = np.repeat(numbers_of(cage, 0.1, 0.3).numbers, LANES)
    s, places, found = np.zeros(rows.SPACE_STATES), np.zeros((1, rows.BALL_ROWS)), np.zeros((1, 10 * LANES))
    s[rows.RAMP : rows.RAMP + LANES] = 1.0
    places[0, rows.CAPACITY_SHARE : rows.CAPACITY_SHARE + LANES] = share
    hold_spins.py_func(s, np.zeros((1, 5 * LANES)), p, places, found, False)
    inverse = np.zeros((4, 4))
    inverse[:3, :3], inverse[3, 3] = found[0, : 9 * LANES : LANES].reshape(3, 3), found[0, 9 * LANES]
    units = np.array([1.0, *(3 * (cage.pitch_radius,))])  # spins as speeds at the pitch circle
    slopes = (slopes_of_engine(cage, share) - slopes_of_engine(cage, 0.0)) * units[:, None] / units
    held = (np.eye(4) - np.linalg.inv(inverse * units[:, None] / units)) / (0.25 * p[rows.STEP])
    slopes[3, :3] = slopes[:3, 3] = 0.0
    assert np.abs(held - slopes).max() < 5e-3 * np.abs(slopes).max()


@pytest.mark.parametrize("shape", PocketShape)
def test_friction_takes_from_cage_and_ball_what_it_turns_to_heat(shape):
    """Power on pocket and ball in space, without a hold by races: f N |v|^2 over the softened |v|."""
    held = moving_cage(solve(read_study("cryogenic-turbopump")), 0.1, BallModel.FREE)
    races = {name: replace(getattr(held.free_ball, name), limit=1e-15) for name in ("inner", "outer")}
    cage = replace(
        held, free_ball=replace(held.free_ball, **races), motion=MotionModel.SPACE, cage_speed=0.0,
        pocket_shape=shape, pocket_axial_clearance=4e-4 if shape is PocketShape.ELONGATED else None,
        orbital_cosines=(), orbital_sines=(), capacity_waves=(), slope_waves=(), groove_damping=700.0,
    )  # fmt: skip
    p = np.repeat(numbers_of(cage, 0.1, 0.3).numbers, LANES)
    s, a = np.zeros(rows.SPACE_STATES), np.zeros(rows.SUMS)
    s[rows.RAMP : rows.RAMP + LANES] = a[rows.PER_RAMP : rows.PER_RAMP + LANES] = 1.0
    places, found = np.zeros((1, rows.BALL_ROWS)), np.zeros((1, 6 * LANES))
    apart, _, around = pocket_rectangle(cage)
    place = {
        rows.COSINE: 0.6,
        rows.SINE: 0.8,
        rows.APART: apart,
        rows.AROUND: around,
        rows.CAPACITY_SHARE: 1.0,
    }
    moved = {rows.GX: 5e-4, rows.GY: 7e-5, rows.GVX: 3.0, rows.GVY: -2.0, rows.GWA: 70.0, rows.GWB: -40.0}
    for into, values in ((places[0], place), (a, moved), (s, {rows.Z: 4e-4, rows.VZ: 1.5, rows.VS: 2.5})):
        for row, value in values.items():
            into[row : row + LANES] = value
    spins = np.array([900.0, -500.0, 300.0])
    state = np.repeat([[0.0, 0.0, 0.0, *spins]], LANES, axis=1)
    ball_rates.py_func(s, state, found, a, p, places, rows.FREE, True, False)
    gain, *turns = found[0, 2 * LANES :: LANES]
    turns[0] += gain / cage.pitch_radius  # in the frame of the housing
    on_ball = cage.free_ball.inertia * np.dot(turns, np.add(cage.spin, spins))
    push, slide = places[0, rows.FORCE], places[0, rows.HEAT] / places[0, rows.FORCE]
    heat = 0.1 * push * (slide**2 - p[rows.PIVOT]) / slide
    assert push > 1.0
    assert a[rows.RUB] + on_ball == pytest.approx(-heat, rel=1e-12)  # rounding


def stepped(rate, slope, start, time, steps):
    """y(time) of y' = rate(y) as the engine holds a spin of this slope, at each step's beginning."""
    size, h = 5 * LANES, time / steps
    s, q = np.full(size, float(start)), np.zeros(size)
    for _ in range(steps):
        t, stiff, before = s.copy(), np.zeros((1, 10 * LANES)), np.zeros((1, 8 * LANES))
        for row in (0, 4, 8, 9):  # of a diagonal inverse
            stiff[0, row * LANES : (row + 1) * LANES] = 1.0 / (1.0 - 0.25 * h * slope(s[-1]))
        for stage in range(4):
            d = rate(t)
            held_spins.py_func(stage, d.reshape(1, size), stiff, before, False)
            stage_end.py_func(stage, s, t, d, q, np.full(size, h), 1.0 / 6.0)
    return s


def falling(y):
    """Rate of 1/(1 + t)."""
    return -y * y


@pytest.mark.parametrize(("of_own", "order"), [(0.0, 16.0), (1.0, 8.0), (2.0, 8.0)])
def test_a_step_is_of_the_third_order_whatever_the_slope(of_own, order):
    """The error falls by 8 for half the step, with a wrong slope too; with none, classically, by 16."""
    errors = [abs(stepped(falling, lambda y: -2.0 * of_own * y, 1.0, 1.0, n)[-1] - 0.5) for n in (40, 80)]
    assert errors[0] / errors[1] == pytest.approx(order, rel=0.05)  # the next order at 40 steps


def test_a_step_leaves_nothing_of_a_stiff_motion():
    """The rational function of its tableau, of one of so many time constants; rest is rest."""
    for rate, left in ((10.0, 0.0622), (30.0, 0.0864), (1e4, 5.3e-4)):

        def decaying(y, rate=rate):
            return -rate * (y - 3.0)

        def slope(_, rate=rate):
            return -rate

        assert stepped(decaying, slope, 4.0, 1.0, 1)[-1] - 3.0 == pytest.approx(left, rel=0.01)  # its digits
        assert stepped(decaying, slope, 3.0, 1.0, 1)[-1] == 3.0


def slopes_of_engine(cage, share=1.0):
    """The same by the engine's equations about free rolling, of a ball with a share of the races' hold."""
    p = np.repeat(numbers_of(cage, 0.1, 0.3).numbers, LANES)
    R = cage.pitch_radius
    step = 1e-5 * np.array([1.0, 1.0 / R, 1.0 / R, 1.0 / R])
    s, a, places = np.zeros(rows.SPACE_STATES), np.zeros(rows.SUMS), np.zeros((1, rows.BALL_ROWS))
    s[rows.RAMP : rows.RAMP + LANES] = a[rows.PER_RAMP : rows.PER_RAMP + LANES] = 1.0
    for row, value in ((rows.COSINE, 1.0), (rows.APART, 1.0), (rows.CAPACITY_SHARE, share)):
        places[0, row : row + LANES] = value

    def rates(speeds):
        state, found = np.repeat([[0.0, *speeds]], LANES, axis=1), np.zeros((1, 5 * LANES))
        ball_rates.py_func(s, state, found, a, p, places, rows.FREE, False, True)
        return found[0, LANES::LANES]

    return np.stack([(rates(d) - rates(-d)) / (2.0 * d.sum()) for d in np.diag(step)], axis=1)
