"""What elastic creep and the lateral force of spin change in the equilibrium without race control.

``python benchmarks/elastic_equilibrium.py``: the equilibrium of a ball under axial load with the friction of
rigid slip, as the program solves it, and with that of the exact contact in its place.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import root

from separatrix.chain import exact
from separatrix.chain.contacts import RaceContact, race_tracks
from separatrix.chain.equilibrium.balance import inertia_loads, slip_coefficients
from separatrix.chain.equilibrium.groove import Touch, touch
from separatrix.chain.equilibrium.problem import problem
from separatrix.chain.impact_restitution import contact_damping
from separatrix.chain.race_curve import contact_problem, exact_slope
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study
from separatrix.study.study import Film, Race, Study, TractionModel, TractionSettings

EXACT = TractionSettings(model=TractionModel.EXACT)
COLUMNS, ROWS = 24, 48
RIGID_CREEP = 1e-7  # slip over which rigid friction turns round, over the rolling speed
Array = np.ndarray


def moments(x: Array, y: Array, h: Array, tau: Array, area: float) -> Array:
    """Spin moment, moment of h along, force along, moment of h across, force across."""
    tx, ty = tau
    parts = (y * tx - x * ty, h * tx, tx, h * ty, ty)
    return np.array([float(one.sum()) * area for one in parts])


class Ball:
    """Most loaded ball of a study under an axial load."""

    def __init__(self, study: Study) -> None:
        self.study, self.state = study, solve(study).bearing
        self.p = problem(study.bearing, study.operation, 1.0, study.film.race_friction)
        self.load = study.operation.axial_load / study.bearing.ball_count
        self.made: dict[tuple[bool, bool], exact.RollingContact] = {}

    def slip(self, side: float, t: Touch, s: Array) -> tuple[Array, Array]:
        """Slip coefficients [rad/s, m/s] and the normal."""
        c, n = np.empty(4), np.empty(2)
        slip_coefficients(self.p, side, t, s, c, n)
        return c * self.p.speed, n

    def friction(self, side: float, at: RaceContact, c: Array, load: float, *, elastic: bool) -> Array:
        """Resultants on the ball of one contact, along t and y = t x n."""
        p = self.p
        race = Race.INNER if side < 0.0 else Race.OUTER
        f = p.inner_conformity if side < 0.0 else p.outer_conformity
        radius = 2.0 * f * p.ball_diameter / (2.0 * f + 1.0)
        key = side < 0.0, elastic
        if key not in self.made:  # the load changes by a few per cent: tractions are scaled with it
            film = self.study.film if elastic else Film(race_friction=p.friction)
            track = race_tracks(self.study.bearing, film, self.state)[race is Race.OUTER]
            self.made[key] = exact.rolling_contact(contact_problem(track, EXACT), columns=COLUMNS, rows=ROWS)
        made = self.made[key]
        grid = made.grid
        x, y = grid.x[None, :], grid.y[:, None]
        h = 0.5 * p.ball_diameter - radius + np.sqrt(radius**2 - y**2) + 0.0 * x
        V = abs(at.rolling_speed)
        # particles enter at the largest x: along t at the outer race, against it at the inner one
        turn = side
        along = turn * (c[0] * turn * y + c[1] * h + c[2]) / V + 0.0 * x
        across = turn * (c[3] * h - c[0] * turn * x) / V
        W = np.stack([along, across])
        if elastic:
            tau = exact.solve(made, W, tolerance=1e-7).traction
        else:
            tau = -made.bound * W / np.sqrt(W[0] ** 2 + W[1] ** 2 + RIGID_CREEP**2)
        scale = load / float(made.pressure.sum() * grid.cell_area)
        return moments(turn * x, turn * y, h, turn * tau, grid.cell_area) * scale

    def residual(self, u: Array, *, elastic: bool) -> Array:
        """Balance of the ball and of the ring over what they balance, shape (7,)."""
        p = self.p
        s = np.array([u[0] * 1e-3, u[1] * 1e-3, *u[2:6]])
        A = np.array([u[6] * 1e-3, self.reach_r])
        i = touch(p, -1.0, A[0] - s[0], A[1] - s[1], 0.0)
        o = touch(p, 1.0, s[0], s[1], 0.0)
        total, inner = np.zeros(6), np.zeros(6)
        for side, t, at in ((-1.0, i, self.state.inner), (1.0, o, self.state.outer)):
            c, n = self.slip(side, t, s)
            M, S, F, Mt, Fy = self.friction(side, at, c, t.load, elastic=elastic)
            push = np.array([-Fy * n[1], Fy * n[0], F, M * n[0] + S * n[1], M * n[1] - S * n[0], Mt])
            total += push
            inner = push if side < 0.0 else inner
        total[0] += i.load * i.sine - o.load * o.sine
        total[1] += i.load * i.cosine - o.load * o.cosine
        F, G_r = inertia_loads(p, s[2], s[4])
        _, G_t = inertia_loads(p, s[2], s[5])
        total += np.array([0.0, F, 0.0, 0.0, G_t, -G_r])
        ring = i.load * i.sine + inner[0] - self.load
        R = 0.5 * p.ball_diameter
        grip = p.friction * self.load
        return np.array([*total[:2] / self.load, total[2] / grip, *total[3:] / (grip * R), ring / self.load])

    def start(self) -> Array:
        """Unknowns at the equilibrium that the program finds."""
        p, q, b = self.p, self.state.equilibrium, self.state.inner.ball
        D = p.ball_diameter

        def reach(side: float, angle: float, load: float) -> Array:
            f = p.inner_conformity if side < 0.0 else p.outer_conformity
            low, high = (f - 0.5) * D, (f - 0.4) * D
            for _ in range(100):
                middle = 0.5 * (low + high)
                t = touch(p, side, middle * math.sin(angle), middle * math.cos(angle), 0.0)
                low, high = (middle, high) if t.load < load else (low, middle)
            return low * np.array([math.sin(angle), math.cos(angle)])

        V = reach(1.0, q.contact_angle_outer[b], q.load_outer[b])
        A = V + reach(-1.0, q.contact_angle_inner[b], q.load_inner[b])
        self.reach_r = float(A[1])
        orbit = (q.orbital_speed[b] - p.outer_speed) / p.speed
        spin = np.asarray(q.ball_spin[b]) / p.speed
        return np.array([*(V * 1e3), orbit, *spin, A[0] * 1e3])


def report(ball: Ball, u: Array, elastic: bool) -> None:
    """Print angles, loads, orbit, attitude, spin over roll, and the slopes and C_mu there."""
    p, study = ball.p, ball.study
    s = np.array([u[0] * 1e-3, u[1] * 1e-3, *u[2:6]])
    i = touch(p, -1.0, u[6] * 1e-3 - s[0], ball.reach_r - s[1], 0.0)
    o = touch(p, 1.0, s[0], s[1], 0.0)
    words, damping = [], 0.0
    for side, t, at, race in (
        (-1.0, i, ball.state.inner, Race.INNER),
        (1.0, o, ball.state.outer, Race.OUTER),
    ):
        c, _ = ball.slip(side, t, s)
        spin = c[0] / abs(at.rolling_speed)
        lateral = c[3] * 0.5 * p.ball_diameter / abs(at.rolling_speed)
        M, _, _, _, Fy = ball.friction(side, at, c, t.load, elastic=elastic)
        creep = replace(at.creep, spin=math.copysign(spin, at.creep.spin))
        track = race_tracks(study.bearing, study.film, ball.state)[race is Race.OUTER]
        track = replace(track, creep=creep)
        slope = exact_slope(track, EXACT).slope
        damping += contact_damping(slope, t.load, at.rolling_speed)
        words.append(
            f"{race.value}: angle {math.degrees(math.atan2(t.sine, t.cosine)):.3f} deg, load {t.load:.2f} N, "
            f"spin {creep.spin:.3f} 1/m, lateral creep {lateral:.2e}, lateral force {Fy:.2f} N, "
            f"spin moment {M * 1e3:.2f} N mm, slope {slope:.3f}"
        )
    pitch = math.degrees(math.atan2(-s[4], -s[3]))
    print(
        f"  {'exact' if elastic else 'rigid'}: orbit {s[2] * p.speed:.2f} rad/s, pitch {pitch:.3f} deg, ",
        end="",
    )
    print(f"spin about the orbit {s[5] * p.speed:.3f} rad/s, C_mu {damping:.1f} N s/m")
    for one in words:
        print(f"    {one}")


def main() -> None:
    """Solve both for three shipped bearings, the first one also bare and with less friction."""
    first = read_study("cryogenic-turbopump")
    studies = [first, *(read_study(name) for name in ("lox-turbopump", "momentum-wheel"))]
    studies += [replace(first, film=replace(first.film, race_friction=0.05))]
    studies += [replace(first, film=Film(race_friction=0.1))]
    for study in studies:
        film, ball = study.film, Ball(study)
        u = ball.start()
        coat = "bare" if film.material is None else f"{film.thickness * 1e6:g} um film"
        own = np.abs(ball.residual(u, elastic=False)).max()
        print(
            f"{study.name}, {coat}, friction {film.race_friction:g}: residual of the program's own {own:.1e}"
        )
        for elastic in (False, True):

            def balance(v: Array, elastic: bool = elastic, ball: Ball = ball) -> Array:
                return ball.residual(v, elastic=elastic)

            found = root(balance, u, method="hybr", options={"xtol": 1e-8, "eps": 1e-6})
            print(f"  {found.message} Residual {np.abs(found.fun).max():.1e}.")
            report(ball, found.x, elastic)


if __name__ == "__main__":
    main()
