"""Bearings of dynamics3d.md whose balls are pushed: `cryo`, `le7` and two wheels, and their held balls."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp

import separatrix
from separatrix.chain.ball_mobility import HeldBall, Modes, SlipLaw, friction_slopes, held_ball, modes
from separatrix.chain.contacts import Rolling
from separatrix.ground.units import Array
from separatrix.study.study import BallBearing, Film, KinematicModel, Kinematics, Material, Operation, Study

RPM = math.pi / 30.0
STEEL = Material(name="steel", elastic_modulus=207e9, poisson_ratio=0.30, density=7810.0)
WHEEL = BallBearing(
    ball_diameter=6.35e-3, pitch_diameter=31e-3, ball_count=11, contact_angle=math.radians(15.0),
    inner_conformity=0.53, outer_conformity=0.53, ball_material=STEEL, ring_material=STEEL,
)  # fmt: skip
NAMES = ("cryo", "le7", "wheel 2000", "wheel 6000")


@lru_cache
def study_of(name: str) -> Study:
    """One of the bearings, without race control."""
    if name == "cryo":
        return separatrix.read_study("cryogenic-turbopump")
    le7 = replace(separatrix.read_study("le7"), kinematics=Kinematics(model=KinematicModel.FREE))
    if name == "le7":
        return le7
    operation = Operation(inner_speed=float(name.split()[1]) * RPM, axial_load=40.0)
    return replace(le7, bearing=WHEEL, operation=operation, film=Film(race_friction=0.05))


def records(name: str) -> Rolling:
    """What `held_ball` and `mobility` take, before the slip law."""
    asked = study_of(name)
    return Rolling(asked.bearing, asked.operation, asked.kinematics.model, asked.film, asked.traction)


@lru_cache
def held(name: str, law: SlipLaw = SlipLaw.RIGID) -> HeldBall:
    """The ball in its slip fields; rigid, as the check numbers are."""
    return held_ball(records(name), law)


@lru_cache
def modes_of(name: str, law: SlipLaw = SlipLaw.RIGID) -> Modes:
    """Its linear modes."""
    ball = held(name, law)
    return modes(friction_slopes(ball), ball.masses)


def impact(
    moved: Callable[[Array, float], Array], size: int, ring: tuple[float, float], speed: float, **how: object
) -> tuple[float, float, float]:
    """Restitution, largest force and duration of an impact of a mass and spring on a ball.

    The ball's states obey x' = moved(x, force); the first is its speed.
    """
    mass, k = ring

    def rates(_: float, z: Array) -> Array:
        force = k * z[size + 1]
        return np.append(moved(z[:size], force), (-force / mass, z[size] - z[0]))

    def parted(t: float, z: Array) -> float:
        return float(z[size + 1]) if t > 1e-7 else 1.0

    parted.terminal = True
    start = np.zeros(size + 2)
    start[size] = speed
    how = {"events": parted, "rtol": 1e-6, "atol": 1e-13, "method": "LSODA"} | how
    end = solve_ivp(rates, (0.0, 0.1), start, **how)
    return -end.y[size, -1] / speed, k * end.y[size + 1].max(), end.t[-1]
