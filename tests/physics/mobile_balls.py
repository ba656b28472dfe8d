"""Bearings of dynamics3d.md whose balls are pushed: `cryo`, `le7` and two wheels, and their held balls."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import separatrix
from separatrix.chain.ball_mobility import HeldBall, Modes, SlipLaw, friction_slopes, held_ball, modes
from separatrix.study.study import BallBearing, Film, KinematicModel, Kinematics, Material, Operation, Study

RPM = math.pi / 30.0
STEEL = Material(name="steel", elastic_modulus=207e9, poisson_ratio=0.30, density=7810.0)
WHEEL = BallBearing(
    ball_diameter=6.35e-3,
    pitch_diameter=31e-3,
    ball_count=11,
    contact_angle=math.radians(15.0),
    inner_conformity=0.53,
    outer_conformity=0.53,
    ball_material=STEEL,
    ring_material=STEEL,
)
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


def records(name: str) -> tuple:
    """What `held_ball` and `mobility` take, before the slip law."""
    asked = study_of(name)
    return asked.bearing, asked.operation, asked.kinematics.model, asked.film, asked.traction


@lru_cache
def held(name: str, law: SlipLaw = SlipLaw.RIGID) -> HeldBall:
    """The ball in its slip fields; rigid, as the check numbers are."""
    return held_ball(*records(name), law)


@lru_cache
def modes_of(name: str, law: SlipLaw = SlipLaw.RIGID) -> Modes:
    """Its linear modes."""
    ball = held(name, law)
    return modes(friction_slopes(ball), ball.masses)
