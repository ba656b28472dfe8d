"""Critical friction in the plane against that in space, over speed, pocket shape, pitch angle and kick.

python benchmarks/plane_or_space.py > docs/theory/plane-or-space.csv: about an hour on two cores. The cage is that
of the shipped turbopump with its outer land, the speeds of its balls in proportion to that of the ball set.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import separatrix
from separatrix.cage import PlanarCage
from separatrix.limits import critical_friction
from separatrix.limits.growth import GrowthCounter
from separatrix.study import BallModel, MotionModel, PocketShape, StabilitySettings

SPEEDS = (0.0, 50.0, 100.0, 200.0, 400.0, 669.0)
KICKS = (0.1, 0.5, 2.0)
PITCHES = (5.0, 14.0, 25.4)
SHAPES = (PocketShape.CYLINDRICAL, PocketShape.SQUARE)
RUNS = 48


def turbopump(ball: BallModel) -> PlanarCage:
    """Cage of the shipped turbopump in space."""
    study = separatrix.read_study("cryogenic-turbopump")
    if study.cage is None:
        raise LookupError(study.name)
    design = replace(study.cage, motion=MotionModel.SPACE, ball=ball)
    return separatrix.solve(replace(study, cage=design)).cage_with(0.1)


def case(cage: PlanarCage, speed: float, shape: PocketShape, pitch: float) -> PlanarCage:
    """The cage at another speed, with other pockets and another pitch of the balls' spin."""
    if cage.space is None:
        raise LookupError
    spin, lean = math.hypot(*cage.space.ball_spin[:2]), math.radians(pitch)
    space = replace(
        cage.space,
        ball_spin=(-spin * math.cos(lean), spin * math.sin(lean), 0.0),
        axial_play=cage.pocket_clearance / 2.0,
    )
    ring = cage.inner_speed * speed / cage.cage_speed
    return replace(cage, pocket_shape=shape, cage_speed=speed, inner_speed=ring or 1.0, space=space)


def row(cage: PlanarCage, kick: float) -> str:
    """Critical friction of both, with 95 % intervals; empty where there is none."""
    settings = StabilitySettings(kicks=(kick,), reference_kick=kick, runs=RUNS)
    cells = []
    lean = 1.0 if cage.space is None else math.atan2(cage.space.ball_spin[1], -cage.space.ball_spin[0])
    for one in (replace(cage, space=None), cage):
        found = critical_friction(one, None, settings, counter=GrowthCounter(one, settings), band=False)
        # in the plane only the radial part of the friction acts
        share = 1.0 / math.cos(lean) if one.space is None else 1.0
        for value in (found.critical_friction, found.scatter_low, found.scatter_high):
            cells.append("" if value is None else f"{value * share:.4f}")
    return ",".join(cells)


def rows(ball: BallModel) -> Iterator[str]:
    """All cases, in order."""
    cage = turbopump(ball)
    cases = list(itertools.product(SHAPES, PITCHES, KICKS, SPEEDS))
    with ThreadPoolExecutor(max_workers=2) as pool:
        done = pool.map(lambda c: row(case(cage, c[3], c[0], c[1]), c[2]), cases)
        for (shape, pitch, kick, speed), cells in zip(cases, done, strict=True):
            yield f"{ball.value},{shape.value},{pitch:g},{kick:g},{speed:g},{cells}"


if __name__ == "__main__":
    print(
        "ball,pocket_shape,pitch_deg,kick_m_s,cage_speed_rad_s,plane,plane_low,plane_high,space,space_low,space_high"
    )
    for line in rows(BallModel(sys.argv[1]) if len(sys.argv) > 1 else BallModel.DAMPER):
        print(line, flush=True)
