"""The engine in the plane against another program (plane_program), on cages with many features at once.

What is left is the error of the engine's step. An impact begins and ends within one: second order. A damped
land begins to push with a jump, and friction on a land is weakened by what it would stop in one step: first
order, so that friction there is small, and all lands but one are elastic.
"""

from dataclasses import replace

import numpy as np
import pytest
from cages import EVERYTHING, ON_A_LAND, TURNING, follow
from plane_program import Course, integrate

from separatrix import BallTraction, Guidance, History, MovingCage, PocketShape

LAW = BallTraction(mass=6.567e-3, slope=188.0, speed=0.39)
BODY = {
    "ball_spin": (-4083.2, 1942.6, -300.0), "ball_diameter": 11.1125e-3, "pivot_speed": 0.05,
    "unbalance": 2e-6, "gravity": 300.0, "land_stiffness": 1e7, "land_friction": 0.05,
    "land_restitution": 1.0, "ramp_time": 2e-3, "ramp_start": 0.5,
    "orbital_cosines": (0.15, 0.05), "orbital_sines": (-0.05, 0.1),
    "capacity_waves": (0.6, 0.35, 0.1, 0.02, -0.05), "slope_waves": (0.5, 0.4, 0.05),
}  # fmt: skip
INNER = {
    "guidance": Guidance.INNER, "land_radius": 0.029,
    "added_mass": 0.008, "fluid_speed": 900.0, "fluid_damping": 20.0,
}  # fmt: skip
TIME = 3e-3
CAGES = {
    "damper, outer land": replace(ON_A_LAND, **BODY, land_clearance=3e-4),
    "one state, square": replace(TURNING, **BODY, traction=LAW, ball_cage_friction=0.25),
    "damper, bores beside their balls, round land": replace(EVERYTHING, **BODY),
    "damper, slots, inner damped land": replace(
        EVERYTHING, **BODY | INNER | {"land_restitution": 0.5}, pocket_shape=PocketShape.ELONGATED,
        pocket_axial_clearance=4e-4,
    ),
    "one state, everything": replace(EVERYTHING, **BODY | INNER, traction=LAW),
    "one state, spheres off their balls": replace(
        EVERYTHING, **BODY, traction=LAW, ball_cage_friction=0.25, pocket_shape=PocketShape.SPHERICAL,
        pocket_radial_offset=6e-5,
    ),
}  # fmt: skip


def rows(found: History | Course, cage: MovingCage) -> np.ndarray:
    """Centre, rotation at the pitch circle, leads [m], and balls' own speeds by microsecond [um], by time."""
    turned = cage.pitch_radius * found.rotation
    return np.column_stack([found.position, turned, found.ball_lead, 1e-6 * found.ball_speed])


def differences(cage: MovingCage, refined: tuple[int, ...]) -> list[float]:
    """Largest difference of the programs at these parts of the usual step [m]."""
    lead = 1e-4 * np.sin(2.0 * np.arange(cage.ball_count) + 1.0)
    start = {"kick": 0.5, "direction": 0.3, "ball_lead": lead}
    runs = [follow(cage, **start, duration=TIME, until=TIME, samples=50_000, refine=n) for n in refined]
    shown = np.arange(0, len(runs[0].time), len(runs[0].time) // 20)
    there = rows(integrate(cage, **start, times=runs[0].time[shown]), cage)
    return [
        float(np.abs(rows(here, cage)[n * shown] - there).max())
        for n, here in zip(refined, runs, strict=True)
    ]


@pytest.mark.parametrize(
    ("name", "tolerance"), list(zip(CAGES, (2e-6, 6e-6, 1e-6, 2e-6, 5e-7, 8e-7), strict=True))
)
def test_the_engine_moves_as_the_other_program(name, tolerance):
    """3 ms, 12 to 28 impacts, motions of 0.3 to 1 mm; a quarter of the step leaves a third of the error."""
    # Tolerances are twice the differences at the usual step. They fall by 4.4 to 33: by 16 in the mean, by
    # more or less with the part of a step at which a touch begins.
    usual, quarter = differences(CAGES[name], (1, 4))
    assert usual < tolerance
    assert quarter < usual / 3.0
