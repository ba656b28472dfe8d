"""Speed of the motion of a cage on one core: simulated seconds per second as they are followed.

Run with ``pytest benchmarks/test_cage.py``; each round is 64 runs from one disturbance. A run that ends early
counts until then, and with `whole` for its whole duration of 0.3 s.
"""

from dataclasses import replace

import pytest
from cages import ON_A_LAND

from separatrix.cage import MovingCage, moving_cage, run_ensemble
from separatrix.chain.race_traction import BallTraction
from separatrix.chain.solution import solve
from separatrix.study.cage_design import PocketShape
from separatrix.study.reading import read_study
from separatrix.study.study import BallModel, Guidance, MotionModel, StabilitySettings

SETTINGS = StabilitySettings(kicks=(0.5,), runs=64, duration=0.3)
SHIPPED = replace(
    ON_A_LAND, moment_of_inertia=26.4e-6, transverse_inertia=13.8e-6, inner_speed=1570.8, race_damping=600.0,
    ball_cage_friction=0.1,
)  # fmt: skip
LAW = BallTraction(mass=6.567e-3, slope=188.0, speed=73.0 / 188.0)
INERTIA = replace(SHIPPED, traction=LAW)
SPACE = replace(
    SHIPPED, motion=MotionModel.SPACE, ball_spin=(-4083.218, 1942.614, -3.53), ball_diameter=11.1125e-3,
    groove_damping=766.0, groove_stiffness=5.05e6, pivot_speed=0.05, race_damping=356.0,
    ball_cage_friction=0.08,
)  # fmt: skip
CASES = {
    "plane, settles": SHIPPED,
    "plane, whirls": replace(SHIPPED, race_damping=2000.0, ball_cage_friction=0.2),
    "plane, no land": replace(SHIPPED, guidance=Guidance.BALL),
    "plane, one state, settles": INERTIA,
    "plane, one state, near its limit": replace(INERTIA, ball_cage_friction=0.3),
    "plane, one state, whirls": replace(INERTIA, ball_cage_friction=0.5),
    "space, settles": SPACE,
    "space, whirls": replace(SPACE, ball_cage_friction=0.3),
    "space, bores, settles": replace(SPACE, pocket_shape=PocketShape.CYLINDRICAL),
    "space, one state, settles": replace(SPACE, traction=LAW),
}


def measured(benchmark, cage: MovingCage) -> None:
    """Time one ensemble, and note the seconds that it simulates in a second."""
    run_ensemble(cage, SETTINGS, runs=1)
    found = benchmark(run_ensemble, cage, SETTINGS)
    mean = benchmark.stats["mean"]
    benchmark.extra_info["followed_seconds_per_second"] = found.followed.sum() / mean
    benchmark.extra_info["whole_seconds_per_second"] = SETTINGS.duration * found.outcome.size / mean


@pytest.mark.parametrize("name", CASES)
def test_a_cage(benchmark, name):
    """A cage of the class of the shipped study."""
    measured(benchmark, CASES[name])


@pytest.mark.parametrize("study", ["cryogenic-turbopump", "momentum-wheel"])
def test_a_free_ball(benchmark, study):
    """A shipped cage that whirls among free balls, in the plane."""
    measured(benchmark, moving_cage(solve(read_study(study)), 0.6, BallModel.FREE))
