"""Critical friction of round pockets, with the tilt held and free, over starts, spacing, lands and balls.

python benchmarks/round_pockets.py: some minutes. A turbopump cage: 13 balls, 25 g, 3e6 N/m, .3 mm of play, a
kick of .5 m/s. A run counts as growing if its end energy exceeds that of its kick; weak whirls that friction
sustains do not count here.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from separatrix.ball_traction import BallTraction
from separatrix.cage import MovingCage, SpaceBody, run_ensemble
from separatrix.study import Guidance, PocketShape, StabilitySettings

KICK, RUNS, ROUNDS = 0.5, 24, 7
SETTINGS = StabilitySettings(kicks=(KICK,), reference_kick=KICK, duration=0.3, runs=RUNS)
LAND: dict[str, Any] = {
    "guidance": Guidance.OUTER, "land_clearance": 1e-3, "land_friction": 0.1, "land_stiffness": 5e6,
    "land_count": 2,
}  # fmt: skip
LAW = BallTraction(mass=6.567e-3, slope=188.0, speed=73.0 / 188.0)
AT = {"land_heights": (-6e-3, 6e-3)}
SPEEDS = (0.0, 100.0, 669.0)

CASES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "no land": ({}, {}),
    "two lands at 6 mm": (LAND, AT),
    "two lands in the middle": (LAND, {"land_heights": (0.0, 0.0)}),
    "two lands, 4 mm wide": (LAND, AT | {"land_width": 4e-3}),
    "inner lands": (LAND | {"guidance": Guidance.INNER}, AT),
    "land friction .3": (LAND | {"land_friction": 0.3}, AT),
    "pockets displaced by up to 5 % of the pitch": (LAND | {"pocket_spacing_scatter": 0.05}, AT),
    "a fifth of the kick along the axis and in tilt": (LAND, AT | {"axial_kick": 0.2, "tilt_kick": 0.2}),
    "friction without lever": (LAND, AT | {"friction_lever": 0.0}),
    "balls with traction": (LAND | {"traction": LAW}, AT),
}


def cage_of(friction: float, speed: float, plane: dict[str, Any], space: dict[str, Any]) -> MovingCage:
    """One case at one friction and speed."""
    body = SpaceBody(
        **{
            "transverse_inertia": 1.3765e-5,
            "ball_spin": (-4083.2, 1942.6, -3.5),
            "ball_diameter": 0.0111125,
            "groove_damping": 766.0,
            "groove_stiffness": 5.05e6,
            **space,
        }
    )
    return MovingCage(
        mass=0.025,
        moment_of_inertia=2.64e-5,
        ball_count=13,
        pitch_radius=0.0325,
        cage_speed=speed,
        inner_speed=1570.8,
        outer_speed=0.0,
        pocket_clearance=6e-4,
        ball_cage_stiffness=3e6,
        race_damping=356.58,
        ball_cage_friction=friction,
        pocket_shape=PocketShape.CYLINDRICAL,
        space=body,
        **plane,
    )


def share_growing(cage: MovingCage) -> float:
    """Share of the runs whose end energy exceeds that of the kick."""
    found = run_ensemble(cage, SETTINGS)
    return float(np.mean(found.end_energy > 0.5 * cage.mass * KICK**2))


def half_grows(speed: float, plane: dict[str, Any], space: dict[str, Any]) -> float:
    """Friction at which half the runs grow, by halving its logarithm."""
    low, high = 0.02, 1.0
    for _ in range(ROUNDS):
        middle = math.sqrt(low * high)
        grows = share_growing(cage_of(middle, speed, plane, space)) > 0.5
        low, high = (low, middle) if grows else (middle, high)
    return math.sqrt(low * high)


def cells(case: tuple[str, float]) -> str:
    """Both critical frictions of one case at one speed."""
    name, speed = case
    plane, space = CASES[name]
    held = half_grows(speed, plane, space | {"is_tilt_held": True})
    return f"| {name} | {speed:g} | {held:.3f} | {half_grows(speed, plane, space):.3f} |"


if __name__ == "__main__":
    print("| case | cage speed, rad/s | tilt held | tilt free |\n|---|---|---|---|", flush=True)
    with ThreadPoolExecutor(max_workers=2) as pool:
        for line in pool.map(cells, [(name, speed) for name in CASES for speed in SPEEDS]):
            print(line, flush=True)
