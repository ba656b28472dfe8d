"""Speed of the cage in the plane and in space: simulated seconds and impacts per second and core.

Run with ``pytest benchmarks/test_cage.py``; each round is `RUNS` runs of 0.3 s, so the simulated seconds per
second are 0.3 `RUNS` over the mean time; they are printed as `simulated_seconds_per_second`, with the impacts
on pockets and land. Runs whose end is plain before count as whole ones. The small steps of the second road,
on the same class of cage in the same session, are there to compare.
"""

from dataclasses import replace

import numpy as np
import pytest
import small_step
from separatrix.cage.space_body import SpaceBody

from separatrix.ball_traction import BallTraction
from separatrix.cage import MovingCage, run_ensemble, run_hard_ensemble
from separatrix.pocket_shape import PocketShape
from separatrix.study import Guidance, StabilitySettings

RUNS = 16
SHIPPED = MovingCage(
    mass=0.025,
    moment_of_inertia=26.4e-6,
    ball_count=13,
    pitch_radius=0.0325,
    cage_speed=670.0,
    inner_speed=1570.8,
    outer_speed=0.0,
    pocket_clearance=6e-4,
    ball_cage_stiffness=3e6,
    race_damping=600.0,
    ball_cage_friction=0.1,
    guidance=Guidance.OUTER,
    land_clearance=1e-3,
)
TURBOPUMP = BallTraction(mass=6.567e-3, slope=188.0, speed=73.0 / 188.0)
WHEEL = BallTraction(mass=1.289e-3, slope=74.3, speed=1.3 / 74.3)
CASES = {
    "shipped class, settles": SHIPPED,
    "shipped class, whirls": replace(SHIPPED, race_damping=2000.0, ball_cage_friction=0.2),
    "no land": replace(SHIPPED, guidance=Guidance.BALL),
    "ball set at rest": replace(SHIPPED, guidance=Guidance.BALL, cage_speed=0.0),
    "balls on 188 N s/m, settle": replace(SHIPPED, race_damping=188.0),
    "balls with inertia, settle": replace(SHIPPED, traction=TURBOPUMP),
    "balls on 188 N s/m, whirl": replace(SHIPPED, race_damping=188.0, ball_cage_friction=0.5),
    "balls with inertia, whirl": replace(SHIPPED, traction=TURBOPUMP, ball_cage_friction=0.5),
    "balls of a wheel": replace(SHIPPED, traction=WHEEL),
    "balls with inertia, at rest": replace(
        SHIPPED, guidance=Guidance.BALL, cage_speed=0.0, traction=TURBOPUMP
    ),
}
BODY = SpaceBody(
    transverse_inertia=13.8e-6,
    ball_spin=(-4083.218, 1942.614, -3.53),
    ball_diameter=11.1125e-3,
    axial_play=3e-4,
    groove_damping=766.0,
    groove_stiffness=5.05e6,
    pivot_speed=0.05,
)
SPACE_RUNS = 4
LIKELY = replace(SHIPPED, race_damping=356.0, ball_cage_friction=0.08)
IN_SPACE = {
    "in space, settles": LIKELY,
    "in space, whirls": replace(LIKELY, ball_cage_friction=0.3),
    "in space, round pockets, settle": replace(LIKELY, pocket_shape=PocketShape.CYLINDRICAL),
    "in space, balls with inertia, settle": replace(LIKELY, traction=TURBOPUMP),
}


@pytest.mark.parametrize("name", IN_SPACE)
def test_motion_in_space(benchmark, name):
    """Runs of 0.3 s on one core, as long as they are followed."""
    settings = StabilitySettings(kicks=(0.5,), runs=SPACE_RUNS, duration=0.3)
    cage = replace(IN_SPACE[name], space=BODY)
    run_ensemble(cage, settings, runs=1)
    found = benchmark(run_ensemble, cage, settings)
    impacts = int(found.pocket_impacts.sum() + found.land_impacts.sum())
    benchmark.extra_info["simulated_seconds_per_second"] = found.followed.sum() / benchmark.stats["mean"]
    benchmark.extra_info["impacts_per_second"] = impacts / benchmark.stats["mean"]


@pytest.mark.parametrize("name", CASES)
def test_planar_motion(benchmark, name):
    """Runs of 0.3 s on one core."""
    settings = StabilitySettings(kicks=(0.5,), runs=RUNS, duration=0.3)
    run_ensemble(CASES[name], settings, runs=1)
    found = benchmark(run_ensemble, CASES[name], settings)
    impacts = int(found.pocket_impacts.sum() + found.land_impacts.sum())
    benchmark.extra_info["simulated_seconds_per_second"] = 0.3 * RUNS / benchmark.stats["mean"]
    benchmark.extra_info["impacts_per_second"] = impacts / benchmark.stats["mean"]


def test_small_steps(benchmark):
    """The second road with steps of 1 us, 3 ms of the shipped class, on one core."""
    lead = np.linspace(-1e-4, 1e-4, SHIPPED.ball_count)

    def follow():
        small_step.follow(SHIPPED, kick=0.5, direction=1.0, ball_lead=lead, duration=3e-3, step=1e-6)

    follow()
    benchmark(follow)
    benchmark.extra_info["simulated_seconds_per_second"] = 3e-3 / benchmark.stats["mean"]


def test_hard_impacts(benchmark):
    """Runs of 0.3 s on one core."""
    settings = StabilitySettings(kicks=(0.5,), runs=RUNS, duration=0.3)
    cage = replace(SHIPPED, guidance=Guidance.BALL, cage_speed=0.0)
    run_hard_ensemble(cage, settings, runs=1)
    benchmark(run_hard_ensemble, cage, settings)
    benchmark.extra_info["simulated_seconds_per_second"] = 0.3 * RUNS / benchmark.stats["mean"]
