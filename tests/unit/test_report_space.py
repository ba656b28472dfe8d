"""What a report shows of a cage in space, and only of that."""

from dataclasses import replace

import pytest

import separatrix
from separatrix.reporting.evidence import evidence
from separatrix.reporting.record import Kept, Table
from separatrix.study.study import MotionModel

WHEEL = separatrix.read_study("momentum-wheel")


def ranked(motion: MotionModel) -> separatrix.Answer:
    """Return a ranking of two candidates from four runs of 2 ms."""
    few = replace(WHEEL.stability, runs=4, duration=0.002, kicks=(0.5,), restitution_factors=(0.3, 0.6))
    two = replace(WHEEL.ranking, candidates=WHEEL.ranking.candidates[:2])
    return separatrix.rank(
        replace(WHEEL, cage=replace(WHEEL.cage, motion=motion), stability=few, ranking=two), jobs=1
    )


@pytest.mark.parametrize("motion", MotionModel)
def test_tilt_and_axial_travel_are_in_the_evidence_of_a_cage_in_space(motion):
    """A table with a row for each candidate; a cage in the plane has neither."""
    document = ranked(motion).document()
    blocks = evidence(Kept(document)).blocks
    tables = [one for one in blocks if isinstance(one, Table) and "largest tilt" in one.head]
    if motion is MotionModel.PLANE:
        assert tables == []
        return
    (table,) = tables
    own = next(one for one in document["environments"] if one["name"] == document["environment"])
    assert [row[0] for row in table.rows] == [one["name"] for one in own["materials"]]
    travels = [f"{1e6 * one['axial_travel']:.3g} \N{MICRO SIGN}m" for one in own["materials"]]
    assert [row[2] for row in table.rows] == travels
