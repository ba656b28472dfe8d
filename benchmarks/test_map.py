"""Speed of the stability map of the shipped study, up to 16 runs a point, on two threads.

The aim: 100 by 100 points in under 60 s on two cores that have nothing else to do. Printed beside it: runs
a point.
"""

import pytest

from separatrix.study.reading import read_study
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.parameter_axes import MapAxis
from separatrix.verdict.stability_map import MapQuestion, stability_map

JOBS = 2


def question(points: int) -> MapQuestion:
    """The default map of the verb, with this number of points along each axis."""
    steps = range(points)
    return MapQuestion(
        study=read_study("cryogenic-turbopump"),
        x=MapAxis(parameter="restitution_factor", unit="-", values=tuple(i / (points - 1) for i in steps)),
        y=MapAxis(
            parameter="ball_cage_friction", unit="-", values=tuple(i / (points - 1) / 2 for i in steps)
        ),
        kick=0.5,
    )


@pytest.mark.parametrize("points", [24, 100])
def test_map(benchmark, points):
    """The whole map; every kernel compiled before."""
    stability_map(question(2))
    asked = question(points)
    found = benchmark.pedantic(
        lambda: stability_map(asked, runner=Runner(jobs=JOBS)), rounds=1, warmup_rounds=0
    )
    benchmark.extra_info["runs_a_point"] = sum(p.runs for p in found.points) / len(found.points)
    assert found.complete
