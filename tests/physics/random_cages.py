"""Cages with every input of the motion drawn at random."""

import numpy as np

from separatrix.cage import MovingCage
from separatrix.chain.ball_traction import BallTraction
from separatrix.study.study import Guidance, MotionModel, PocketShape

LAW = BallTraction(mass=6.5e-3, slope=207.0, speed=0.435)


def random_cage(rng: np.random.Generator, space: bool) -> MovingCage:
    """A cage with every feature drawn; ranges of real bearings."""
    draw = rng.uniform
    mass, radius, balls = 10.0 ** draw(-3.0, -0.8), draw(0.01, 0.06), int(rng.integers(7, 16))
    shape = PocketShape(rng.choice(["square", "cylindrical", "elongated"]))
    clearance, speed = draw(1e-4, 6e-4), draw(20.0, 900.0)
    return MovingCage(
        mass=mass, moment_of_inertia=mass * radius**2, ball_count=balls, pitch_radius=radius,
        cage_speed=speed, inner_speed=2.3 * speed, outer_speed=0.0,
        ball_spin=(-6.0 * speed, 2.0 * speed, draw(-1.0, 1.0)),
        ball_diameter=0.3 * radius, pocket_clearance=clearance, pocket_shape=shape,
        pocket_axial_clearance=0.6 * clearance if shape is PocketShape.ELONGATED else None,
        ball_cage_stiffness=10.0 ** draw(5.5, 6.8), race_damping=10.0 ** draw(1.7, 3.2),
        traction=LAW if draw() < 0.5 else None, ball_cage_friction=draw(0.02, 0.4),
        guidance=Guidance(rng.choice(["outer", "inner"])), land_clearance=draw(1e-4, 1e-3),
        land_out_of_round=draw(0.0, 5e-6), land_count=2, land_spacing=0.2 * radius, land_width=0.05 * radius,
        unbalance=1e-5 * mass, dynamic_unbalance=1e-4, gravity=draw(0.0, 10.0), axial_gravity=draw(0.0, 10.0),
        added_mass=0.1 * mass, pivot_speed=0.05, groove_damping=700.0, groove_stiffness=4e6,
        orbital_cosines=(draw(-0.02, 0.02),), orbital_sines=(draw(-0.02, 0.02),),
        capacity_waves=(0.7, draw(-0.3, 0.3), draw(-0.3, 0.3)),
        slope_waves=(0.6, draw(-0.3, 0.3), 0.0, 0.05, 0.1),
        ramp_time=2e-3, ramp_start=0.3, pocket_spacing_scatter=0.05, ball_diameter_scatter=1e-6,
        pocket_position_scatter=1e-6, axial_kick=0.1, tilt_kick=0.1,
        motion=MotionModel.SPACE if space else MotionModel.PLANE,
    )  # fmt: skip
