"""The cage's motion by another program: the equations as written, Runge-Kutta at a fixed small step."""

import math
from dataclasses import replace

import numba
import numpy as np
import pytest

from separatrix.cage import PlanarCage, RunOutcome, follow, run_ensemble
from separatrix.cage.ensemble import random_starts
from separatrix.cage.land import rebound_damping
from separatrix.study import Guidance, StabilitySettings

CAGE = PlanarCage(
    mass=0.025,
    moment_of_inertia=0.025 * 0.0325**2,
    ball_count=13,
    pitch_radius=0.0325,
    cage_speed=669.0,
    inner_speed=1570.8,
    outer_speed=0.0,
    pocket_clearance=6e-4,
    ball_cage_stiffness=3e6,
    race_damping=800.0,
    ball_cage_friction=0.12,
    guidance=Guidance.OUTER,
    land_clearance=1e-3,
)


@numba.njit
def rates(z, out, n, f):
    """Rates of the state (x, y, vx, vy, theta, omega, y_j) in the turning frame."""
    M, J, R, k, C, c, W, gap, K, damping, mu, ring = n
    x, y, vx, vy, theta, omega = z[:6]
    fx, fy, moment = M * (2 * W * vy + W * W * x), M * (-2 * W * vx + W * W * y), 0.0
    Z = z.size - 6
    for j in range(Z):
        cos, sin = math.cos(2 * math.pi * j / Z), math.sin(2 * math.pi * j / Z)
        u = y * cos - x * sin + R * theta - z[6 + j]
        N = k * max(abs(u) - c, 0.0) * np.sign(u)
        fx += N * sin - f * N * cos
        fy += -N * cos - f * N * sin
        moment -= N * R
        out[6 + j] = N / C
    r = math.hypot(x, y)
    if r > gap:
        nx, ny = x / r, y / r
        F = max(0.0, K * (r - gap) + damping * (nx * vx + ny * vy))
        tangent = -mu * F * math.tanh((nx * vy - ny * vx + R * (omega - ring)) / 1e-3)
        fx += -F * nx - tangent * ny
        fy += -F * ny + tangent * nx
        moment += tangent * R
    out[:6] = (vx, vy, fx / M, fy / M, omega, moment / J)


@numba.njit
def runge_kutta(z, steps, dt, n, f, kick):
    """Take the steps in place; return the mean kinetic energy of the last fifth over the kick's."""
    M, J = n[0], n[1]
    a, b, c, d = np.zeros_like(z), np.zeros_like(z), np.zeros_like(z), np.zeros_like(z)
    mean = 0.0
    for i in range(steps):
        rates(z, a, n, f)
        rates(z + 0.5 * dt * a, b, n, f)
        rates(z + 0.5 * dt * b, c, n, f)
        rates(z + dt * c, d, n, f)
        z += dt / 6 * (a + 2 * b + 2 * c + d)
        energy = 0.5 * M * (z[2] ** 2 + z[3] ** 2) + 0.5 * J * z[5] ** 2
        if energy > 1e3 * M:
            return np.inf  # of some 100 J: it grows without end
        if i >= 0.8 * steps:
            mean += energy
    return mean / (0.2 * steps) / (0.5 * M * kick**2)


def numbers(cage):
    """Numbers of a cage for `rates`."""
    damping = 2 * rebound_damping(cage.land_restitution) * math.sqrt(cage.land_stiffness * cage.mass)
    return (
        *(cage.mass, cage.moment_of_inertia, cage.pitch_radius, cage.ball_cage_stiffness, cage.race_damping),
        *(cage.half_play, cage.cage_speed, cage.land_gap, cage.land_stiffness, damping, cage.land_friction),
        cage.outer_speed - cage.cage_speed,
    )


def start(cage, kick, direction, lead):
    """State right after the kick."""
    return np.concatenate(
        ([0.0, 0.0, kick * math.cos(direction), kick * math.sin(direction), 0.0, 0.0], lead)
    )


@pytest.mark.parametrize("friction", [0.0, 0.12])
def test_the_first_blows_are_the_same(friction):
    """Place and velocity after 2 ms: blows on pockets and land, before chaos takes over."""
    cage = replace(CAGE, ball_cage_friction=friction, land_clearance=4e-4)
    lead = np.linspace(-1e-4, 1e-4, 13)
    ours = follow(cage, kick=2.0, direction=0.4, ball_lead=lead, duration=0.002, samples=500)
    z = start(cage, 2.0, 0.4, lead)
    runge_kutta(z, 20_000, 1e-7, numbers(cage), cage.friction_sense * friction, 2.0)
    assert ours.land_force.max() > 0.0
    assert ours.contact_force.max() > 100.0
    # The engine takes some 4 us a step, with an error of second order: 0.6 um and 1 mm/s were measured here.
    assert ours.position[-1] == pytest.approx(z[:2], abs=2e-6)
    assert ours.velocity[-1] == pytest.approx(z[2:4], abs=5e-3)


@pytest.mark.slow
def test_as_many_runs_grow():
    """P(grow) near the threshold, on a land, with the same starts: within 3 standard errors."""
    friction, kick, runs = CAGE.ball_cage_friction, 0.5, 96
    settings = StabilitySettings(kicks=(kick,), runs=runs)
    ours = np.mean(run_ensemble(CAGE, settings).outcome == RunOutcome.GROWS)
    begun = random_starts(CAGE, settings, 0, runs)
    ends = [
        runge_kutta(start(CAGE, kick, s[0], s[1:]), 150_000, 2e-6, numbers(CAGE), friction, kick)
        for s in begun
    ]
    theirs = np.mean(np.array(ends) > 1.0)
    assert 0.1 < ours < 0.9
    assert abs(ours - theirs) < 3 * math.sqrt(2 * 0.25 / runs), (ours, theirs)
