"""Critical friction in the plane against that in space, over speed, pocket shape, pitch angle and kick.

python benchmarks/plane_or_space.py > docs/theory/plane-or-space.csv: about half an hour on two cores. The
cage is that of the shipped turbopump with its outer land; its balls spin as they do at full speed.

python benchmarks/plane_or_space.py STUDY ...: other bearings as they run, with bores, a few minutes each.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import separatrix
from separatrix.cage import MovingCage
from separatrix.limits.point import critical_friction
from separatrix.limits.response import GrowthCounter
from separatrix.study import BallModel, MotionModel, PocketShape, StabilitySettings

SPEEDS = (669.0, 400.0, 200.0, 100.0, 50.0, 0.0)
ROUND, SQUARE = PocketShape.CYLINDRICAL, PocketShape.SQUARE
KINDS = (
    *((ROUND, 25.4, 0.5), (SQUARE, 25.4, 0.5), (ROUND, 14.0, 0.5)),
    *((ROUND, 25.4, 0.1), (ROUND, 25.4, 2.0), (ROUND, 5.0, 0.5)),
)
"""Shape of the pockets, pitch of the balls' spin [deg], and kick [m/s]."""

RUNS = 24
HEAD = "ball,pocket_shape,pitch_deg,kick_m_s,cage_speed_rad_s"
ENDS = "plane,plane_low,plane_high,space,space_low,space_high"


def in_space(name: str, ball: BallModel, **changes: object) -> MovingCage:
    """Cage of a study in space, with its design changed."""
    study = separatrix.read_study(name)
    if study.cage is None:
        raise LookupError(name)
    design = replace(study.cage, motion=MotionModel.SPACE, ball=ball, **changes)
    return separatrix.solve(replace(study, cage=design)).cage_with(0.1)


def case(cage: MovingCage, speed: float, shape: PocketShape, pitch: float) -> MovingCage:
    """The cage at another speed, with other pockets and another pitch of the balls' spin."""
    if cage.space is None:
        raise LookupError
    spin, lean = math.hypot(*cage.space.ball_spin[:2]), math.radians(pitch)
    turned = (-spin * math.cos(lean), spin * math.sin(lean), 0.0)
    space = replace(cage.space, ball_spin=turned, axial_play=cage.pocket_clearance / 2.0)
    ring = cage.inner_speed * speed / cage.cage_speed
    return replace(cage, pocket_shape=shape, cage_speed=speed, inner_speed=ring or 1.0, space=space)


def row(cage: MovingCage, kick: float) -> str:
    """Critical friction of both, with 95 % intervals; empty where there is none."""
    if cage.space is None:
        raise LookupError
    settings = StabilitySettings(kicks=(kick,), reference_kick=kick, runs=RUNS)
    lean = math.atan2(cage.space.ball_spin[1], -cage.space.ball_spin[0])
    cells: list[str] = []
    # in the plane only the outward part of the friction acts
    for one, share in ((replace(cage, space=None), 1.0 / math.cos(lean)), (cage, 1.0)):
        found = critical_friction(one, None, settings, counter=GrowthCounter(one, settings), band=False)
        values = (found.critical_friction, found.scatter_low, found.scatter_high)
        cells += ["" if value is None else f"{value * share:.4f}" for value in values]
    return ",".join(cells)


def rows(ball: BallModel) -> Iterator[str]:
    """All cases, in order."""
    cage = in_space("cryogenic-turbopump", ball)
    cases = [(*kind, speed) for kind, speed in itertools.product(KINDS, SPEEDS)]
    with ThreadPoolExecutor(max_workers=2) as pool:
        done = pool.map(lambda c: row(case(cage, c[3], c[0], c[1]), c[2]), cases)
        for (shape, pitch, kick, speed), cells in zip(cases, done, strict=True):
            yield f"{ball.value},{shape.value},{pitch:g},{kick:g},{speed:g},{cells}"


def bearing_rows(name: str) -> Iterator[str]:
    """Bores in one bearing: both models of a ball, kicks of 0.5, 2.5 and 10 pocket speeds."""
    for ball, times in itertools.product(BallModel, (0.5, 2.5, 10.0)):
        cage = in_space(name, ball, pocket_shape=ROUND, pocket_axial_clearance=None, pocket_axial_offset=0.0)
        kick = times * abs(cage.cage_speed) * cage.pocket_clearance / 2.0
        yield f"{name},{ball.value},{times:g},{kick:.3g},{row(cage, kick)}"


if __name__ == "__main__":
    bearings = sys.argv[1:]
    print(f"bearing,ball,kick_pocket_speeds,kick_m_s,{ENDS}" if bearings else f"{HEAD},{ENDS}", flush=True)
    found = itertools.chain(*map(bearing_rows, bearings)) if bearings else rows(BallModel.DAMPER)
    for line in found:
        print(line, flush=True)
