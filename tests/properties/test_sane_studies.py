"""The random studies are what they promise to be: readable, repeatable, and plausible."""

import math
from pathlib import Path

import pytest
from sane_studies import CLASSES, LOADS, MOST_SPEED, bearing_study, bearing_text, sane_study


def test_the_same_seed_is_the_same_study_whatever_its_cost(tmp_path: Path) -> None:
    """A failure can be run again by its seed; the caller says duration and runs alone."""
    assert bearing_text(5) == bearing_text(5) != bearing_text(6)
    short = sane_study(3, tmp_path, duration="20 ms", runs=4)
    assert (short.stability.duration, short.stability.runs) == (0.02, 4)
    assert short.cage == sane_study(3, tmp_path).cage != sane_study(4, tmp_path).cage


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_cages_are_rings_of_a_polymer_with_usual_plays(name: str, tmp_path: Path) -> None:
    """Mass over the volume of a full ring is below a polymer's density; plays are at most 5 % of a ball."""
    for seed in range(30):
        study = sane_study(seed, tmp_path, name=name)
        cage, ball = study.cage, study.bearing.ball_diameter
        assert 0.0 < cage.pocket_clearance <= 0.05 * ball
        full = math.pi * study.bearing.pitch_diameter * ball**2 * 1.75 * 0.4
        assert 400.0 < cage.mass / full < 2200.0
        assert len(study.ranking.candidates) == 2


def test_bearings_take_every_kind_of_load(tmp_path: Path) -> None:
    """Axial, radial, combined and moment in turn; speeds within the limit."""
    for seed in range(40):
        at, kind = bearing_study(seed, tmp_path).operation, LOADS[seed % len(LOADS)]
        assert (at.radial_load > 0.0) == (kind in ("radial", "combined"))
        assert ((at.moment or 0.0) > 0.0) == (kind == "moment")
        assert 0.0 <= at.inner_speed <= MOST_SPEED * math.pi / 30.0 * 1.0001
